//! Effects in the balance of energy: motors between command and joint, and losses.

use articulated_core::dynamics::Dynamics;

/// Torques of the motors for the commanded ones, `[nv]`; false if the robot has no such function:
/// they are then the commanded ones.
pub(crate) fn motor_torques<R: Dynamics<f64>>(robot: &R, ws: &mut R::Workspace, v: &[f64], tau: &[f64], out: &mut [f64]) -> bool {
    robot.motor_torques(ws, v, tau, out).is_ok()
}

/// Power of the effects that are not conservative, W; `None` where the robot has no such function.
pub(crate) fn dissipation<R: Dynamics<f64>>(robot: &R, ws: &mut R::Workspace, q: &[f64], v: &[f64]) -> Option<f64> {
    let mut power = [0.0];
    robot.dissipation(ws, q, v, &mut power).ok().map(|()| power[0])
}
