//! The crate under a path of the user's.

mod parts {
    pub mod dynamics {
        pub use articulated::{Dynamics, FunctionError, FunctionId, JointKind, JointRow, Limit, Shape, check_length, exactly, exactly_rows};
    }
}

articulated::robot! {
    mod arm {
        urdf = "urdf/arm.urdf",
        crate = crate::parts::dynamics,
    }
}

fn main() {
    use parts::dynamics::{Dynamics, Shape};
    assert_eq!(arm::Robot.shape(), Shape { nq: 2, nv: 2, frames: 3, links: 2, ..Shape::default() });
}
