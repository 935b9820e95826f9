//! Suspicious content of the URDF: a warning at the path, which a lint makes an error.
#![deny(deprecated)]

articulated::robot! {
    pub mod arm {
        urdf = "urdf/zero_effort.urdf",
    }
}

fn main() {}
