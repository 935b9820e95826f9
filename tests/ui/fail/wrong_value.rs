//! A value of another type: at the value.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        gravity = [0.0, -9.81],
    }
}

fn main() {}
