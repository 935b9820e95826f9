//! A path that would mean something else inside the module: at the path.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        crate = self::articulated,
    }
}

fn main() {}
