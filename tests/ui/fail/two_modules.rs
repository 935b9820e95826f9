//! Two modules in one invocation: at the second.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
    }
    pub mod other {
        urdf = "urdf/arm.urdf",
    }
}

fn main() {}
