//! The robot's sizes are types of its functions; constants are the indices.
#![deny(warnings, missing_docs, unreachable_pub)]

articulated::robot! {
    /// Two links on hinges.
    pub mod arm {
        urdf = "urdf/arm.urdf",
        gravity = [0, 0, -10],
        functions = [placements, inverse_dynamics, bias_forces, gravity_torque,],
        snap_angles = 1e-9,
        allow_unphysical_inertia = false,
        standalone = false
    }
}

fn main() {
    let inverse_dynamics: fn(&[f64; 2], &[f64; 2], &[f64; 2]) -> [f64; 2] = arm::inverse_dynamics;
    let placements: fn(&[f64; 2]) -> [[f64; 12]; 3] = arm::placements;
    let gravity_torque: fn(&[f64; arm::NQ]) -> [f64; arm::NV] = arm::gravity_torque;
    let bias_forces: fn(&[f64; arm::NQ], &[f64; arm::NV]) -> [f64; arm::NV] = arm::bias_forces;
    // Stretched out along x: 2 kg at 0.2 m, 1 kg at 0.55 m, and a turn about y lowers them.
    let held = [-(2.0 * 0.2 + 0.55) * 10.0, -0.15 * 10.0];
    for torque in [inverse_dynamics(&[0.0; 2], &[0.0; 2], &[0.0; 2]), gravity_torque(&[0.0; 2]), bias_forces(&[0.0; 2], &[0.0; 2])] {
        assert!((torque[arm::v_index::SHOULDER] - held[0]).abs() < 1e-12 && (torque[arm::v_index::ELBOW] - held[1]).abs() < 1e-12);
    }
    assert_eq!(placements(&[0.0; 2])[arm::frame::FORE][9], 0.4);
    assert_eq!((arm::Q_LOWER, arm::Q_UPPER), ([f64::NEG_INFINITY, -2.0], [f64::INFINITY, 2.0]));
    assert_eq!((arm::NEUTRAL, arm::V_LIMIT, arm::TAU_LIMIT), ([0.0; 2], [f64::INFINITY, 3.0], [f64::INFINITY, 10.0]));
    assert_eq!((arm::NAME, arm::DOF, arm::WARNINGS), ("arm", 2, []));
}
