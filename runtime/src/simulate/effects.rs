//! What effects do to the balance of energy: motors between command and joint, and losses.

use articulated_core::dynamics::Dynamics;

/// The torques that the motors give for the commanded ones, `[nv]`; false where the robot has no such function: they are then the commanded ones.
pub(crate) fn motor_torques<R: Dynamics<f64>>(_: &R, _: &mut R::Workspace, _: &[f64], _: &[f64], _: &mut [f64]) -> bool {
    false
}

/// Power of the effects that are not conservative, W; `None` where the robot has no such function: there are none then.
pub(crate) fn dissipation<R: Dynamics<f64>>(_: &R, _: &mut R::Workspace, _: &[f64], _: &[f64]) -> Option<f64> {
    None
}
