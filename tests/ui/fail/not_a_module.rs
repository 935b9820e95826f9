//! Keys without a module around them.

articulated::robot! {
    urdf = "ui/urdf/arm.urdf",
}

fn main() {}
