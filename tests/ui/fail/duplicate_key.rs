//! A key that is given twice: at the second.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        base = fixed,
        base = floating,
    }
}

fn main() {}
