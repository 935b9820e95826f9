//! A missing comma: at the next token.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf"
        base = floating
    }
}

fn main() {}
