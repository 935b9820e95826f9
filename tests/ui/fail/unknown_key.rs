//! A key that does not exist: at the key, with the one that was probably meant.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        gravitiy = [0.0, 0.0, -1.62],
    }
}

fn main() {}
