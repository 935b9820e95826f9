//! A new name for an item that the robot does not have: at the old name.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/arm.urdf",
        rename = { "wrist" = WRIST },
    }
}

fn main() {}
