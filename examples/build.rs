//! Generates a controller of one's own, for the example `impedance`.

use articulated_codegen::Build;

#[path = "src/laws/impedance.rs"]
mod impedance;

fn main() {
    Build::new("../models/urdf/panda_like.urdf")
        .frames(["hand_tcp"])
        .functions(["placements", "twists_world_aligned", "static_torque", "stiffness = jacobian(impedance, q)"])
        .function(impedance::Impedance)
        .write("arm");
}
