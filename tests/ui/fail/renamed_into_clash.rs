//! A new name that is taken: at the new name.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        rename = { "elbow" = SHOULDER },
    }
}

fn main() {}
