//! The robots of this crate.

use articulated_codegen::{Build, Precision, Real};

fn main() {
    let build = |robot: &str| Build::new(format!("../../models/urdf/{robot}.urdf")).no_std();
    let of_arm = ["inverse_dynamics", "forward_dynamics"];
    build("ur5_like").functions(of_arm).batch([Real::F64, Real::F32]).write("arm");
    build("ur5_like").functions(of_arm).level(level("f32")).write("arm_of_singles");
    build("ur5_like").functions(of_arm).level(level("compensated + two")).write("arm_of_pairs");
    // Square roots and arctangents.
    build("quadruped").floating().functions(["inverse_dynamics", "integrate", "difference"]).write("walker");
}

fn level(name: &str) -> Precision {
    name.parse().expect("a level")
}
