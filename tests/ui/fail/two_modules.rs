//! Two modules in one invocation: at the second.

articulated::robot! {
    pub mod arm {
        urdf = "ui/urdf/arm.urdf",
    }
    pub mod other {
        urdf = "ui/urdf/arm.urdf",
    }
}

fn main() {}
