//! A clash of names, resolved.

articulated::robot! {
    mod clash {
        urdf = "urdf/clash.urdf",
        rename = { "a-b" = A_MINUS_B, "j-1" = J_MINUS_1 },
    }
}

fn main() {
    assert_eq!(clash::FRAME_NAMES[clash::frame::A_MINUS_B], "a-b");
    assert_eq!(clash::FRAME_NAMES[clash::frame::A_B], "a_b");
    assert_eq!(clash::v_index::J_1, 0);
    assert_eq!(clash::v_index::J_MINUS_1, 1);
}
