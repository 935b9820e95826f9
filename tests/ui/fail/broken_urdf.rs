//! A URDF with several errors: all of them, at the path.

articulated::robot! {
    pub mod broken {
        urdf = "urdf/broken.urdf",
    }
}

fn main() {}
