//! A base that is neither fixed nor floating: at the base.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        base = flying,
    }
}

fn main() {}
