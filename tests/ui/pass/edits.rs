//! A robot with a gripper, a load in it and a joint locked; frames chosen by name.

articulated::robot! {
    mod arm {
        urdf = "urdf/three.urdf",
        functions = [placements, gravity_torque],
        frames = [grip_finger, "grip_left thumb", load],
        wrenches_in = world_aligned,
        lock = { wrist = -0.5 },
        payload = [{ link = grip_palm, mass = 0.7, center_of_mass = [0.0, 0.0, 0.05], name = load }, { link = "tool", mass = 1 }],
        append = { urdf = "urdf/gripper.urdf", at = tool, prefix = "grip_", xyz = [0, 0, 0.1], rpy = [0.0, 0.0, 1.0] },
    }
}

fn main() {
    assert_eq!(arm::JOINT_NAMES, ["yaw", "elbow", "grip_close"]);
    assert_eq!(arm::FRAME_NAMES, ["grip_finger", "grip_left thumb", "load"]);
    // At zero the arm is upright, except the wrist: the load is 0.15 m along the tool.
    let placements = arm::placements(&[0.0; 3]);
    let load = &placements[arm::frame::LOAD];
    assert!((load[9] - 0.15 * (-0.5_f64).sin()).abs() < 1e-15 && (load[11] - 1.05 - 0.15 * 0.5_f64.cos()).abs() < 1e-15);
}
