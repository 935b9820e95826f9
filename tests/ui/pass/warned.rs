//! Warnings of a robot that are silenced.
#![deny(warnings)]

articulated::robot! {
    #[allow(deprecated)]
    pub mod arm {
        urdf = "urdf/zero_effort.urdf",
    }
}

fn main() {
    assert_eq!(arm::WARNINGS.len(), 1);
}
