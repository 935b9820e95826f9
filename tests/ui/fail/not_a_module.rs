//! Keys without a module around them.

articulated::robot! {
    urdf = "urdf/arm.urdf",
}

fn main() {}
