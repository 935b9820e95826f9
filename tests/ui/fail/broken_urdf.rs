//! A URDF with several mistakes: all of them, at the path.

articulated::robot! {
    pub mod broken {
        urdf = "urdf/broken.urdf",
    }
}

fn main() {}
