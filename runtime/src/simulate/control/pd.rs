//! Proportional and derivative action about a target.

use std::borrow::Cow;

use articulated_core::control::{Aim, Controller};
use articulated_core::dynamics::Dynamics;

use super::{Control, Dependence, Drive};
use crate::simulate::{SimulateError, StateError};

/// τ = k_p·(target ⊖ q) + k_d·(rates − v), coordinate by coordinate; for a quaternion joint the
/// difference is a rotation vector.
pub struct Pd<'r, R: Dynamics<f64>> {
    robot: &'r R,
    drive: Drive<'r, R>,
}

impl<'r, R: Dynamics<f64>> Pd<'r, R> {
    /// target: `[nq]`; gains: `[nv]`, N·m/rad|N/m and N·m·s/rad|N·s/m; all errors in them are
    /// reported at once. The robot needs the function `difference` if one of its coordinates is a
    /// quaternion.
    pub fn new(robot: &'r R, target: Vec<f64>, proportional: Vec<f64>, derivative: Vec<f64>) -> Result<Self, SimulateError> {
        let torque = vec![0.0; robot.shape().nv];
        let controller = Controller::Pd { target: Aim::Still(target), kp: proportional, kd: derivative, torque };
        let names = ["target", "proportional gains", "derivative gains", "torque"];
        Ok(Self { robot, drive: Drive::called(robot, Cow::Owned(controller), names)? })
    }

    /// The same with rates to follow, `[nv]` finite numbers.
    pub fn with_rates(mut self, rates: &[f64]) -> Result<Self, SimulateError> {
        StateError::none(StateError::of_freedoms("rates", rates, self.robot))?;
        self.drive.pursuit.rate.copy_from_slice(rates);
        Ok(self)
    }
}

impl<R: Dynamics<f64>> Control for Pd<'_, R> {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        self.drive.torques(t, q, v, tau);
    }

    fn count(&self) -> Option<usize> {
        self.drive.count()
    }

    fn depends_on(&self) -> Dependence {
        self.drive.depends_on()
    }
}
