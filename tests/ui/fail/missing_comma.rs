//! A comma left out: at what follows.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf"
        base = floating
    }
}

fn main() {}
