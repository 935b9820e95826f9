//! A file that is not there: at the path.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/amr.urdf",
    }
}

fn main() {}
