//! Names of the URDF that are no identifiers of Rust.

articulated::robot! {
    pub mod names {
        urdf = "urdf/names.urdf",
    }
}

fn main() {
    assert_eq!(names::FRAME_NAMES[names::frame::TYPE], "type");
    assert_eq!(names::FRAME_NAMES[names::frame::_1ST_LINK], "1st-link");
    assert_eq!(names::FRAME_NAMES[names::frame::A_B], "a b");
    assert_eq!(names::JOINT_NAMES[names::joint::FN], "fn");
    assert_eq!(names::q_index::_2ND_JOINT, 1);
}
