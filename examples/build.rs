//! Generates functions of one's own, for the examples `impedance` and `inverse_kinematics`.

use articulated_codegen::Build;

#[path = "src/laws/impedance.rs"]
mod impedance;
#[path = "src/laws/inverse_kinematics.rs"]
mod inverse_kinematics;

fn main() {
    Build::new("../models/urdf/panda_like.urdf")
        .frames(["hand_tcp"])
        .functions(["placements", "twists_world_aligned", "static_torque", "stiffness = jacobian(impedance, q)"])
        .function(impedance::Impedance)
        .write("arm");
    Build::new("../models/urdf/panda_like.urdf")
        .frames(["hand_tcp"])
        .functions(["placements", "follow = jacobian(reach, place)"])
        .function(inverse_kinematics::Reach)
        .batch(["f64"])
        .write("reach");
}
