//! A duplicate key: at the second one.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        base = fixed,
        base = floating,
    }
}

fn main() {}
