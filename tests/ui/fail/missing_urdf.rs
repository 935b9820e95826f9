//! No URDF: at the name of the module.

articulated::robot! {
    pub mod arm {
        base = floating,
    }
}

fn main() {}
