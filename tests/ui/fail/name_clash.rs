//! Names of the URDF that are the same in Rust: at the path, joints and links alike.

articulated::robot! {
    pub mod clash {
        urdf = "urdf/clash.urdf",
    }
}

fn main() {}
