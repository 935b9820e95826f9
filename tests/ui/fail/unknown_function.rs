//! A function that does not exist: at its name, and the rest is generated all the same.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        functions = [placements, inverse_dynamic],
    }
}

fn main() {
    let _ = arm::placements(&[0.0; arm::NQ]);
}
