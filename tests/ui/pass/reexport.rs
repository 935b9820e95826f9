//! The crate under a path of the user's.

mod parts {
    pub mod dynamics {
        pub use articulated::{Dynamics, FunctionError, Shape, check_length, exactly};
    }
}

articulated::robot! {
    mod arm {
        urdf = "ui/urdf/arm.urdf",
        crate = crate::parts::dynamics,
    }
}

fn main() {
    use parts::dynamics::{Dynamics, Shape};
    assert_eq!(arm::Robot.shape(), Shape { nq: 2, nv: 2, frames: 3 });
}
