//! Proportional and derivative action about a target.

use articulated_core::dynamics::Dynamics;

use super::{Control, Dependence};
use crate::simulate::{SimulateError, StateError, manifold::Manifold};

/// τ = k_p·(target ⊖ q) + k_d·(rates − v), coordinate by coordinate; for a joint that turns freely the difference is a rotation vector.
pub struct Pd<'r, R: Dynamics<f64>> {
    robot: &'r R,
    ws: R::Workspace,
    flat: bool,
    target: Vec<f64>,
    rates: Vec<f64>,
    proportional: Vec<f64>,
    derivative: Vec<f64>,
}

impl<'r, R: Dynamics<f64>> Pd<'r, R> {
    /// target: `[nq]`; gains: `[nv]`, N·m/rad|N/m and N·m·s/rad|N·s/m; all that is wrong with them is told at once. The robot needs the function `difference` if one of its coordinates is a quaternion.
    pub fn new(robot: &'r R, target: Vec<f64>, proportional: Vec<f64>, derivative: Vec<f64>) -> Result<Self, SimulateError> {
        let (manifold, shape) = (Manifold::of(robot)?, robot.shape());
        let rates = vec![0.0; shape.nv];
        let gains = [("proportional gains", &proportional), ("derivative gains", &derivative)];
        let gains = gains.into_iter().flat_map(|(vector, x)| StateError::of_freedoms(vector, x, robot));
        StateError::none(manifold.wrong(robot, "target", &target).chain(gains))?;
        let mut pd = Self { robot, ws: robot.workspace(), flat: manifold.is_flat(), target, rates, proportional, derivative };
        let (q, mut out) = (pd.target.clone(), vec![0.0; shape.nv]);
        pd.difference(&q, &mut out)?;
        Ok(pd)
    }

    /// The same with rates to follow, `[nv]` finite numbers.
    pub fn with_rates(mut self, rates: &[f64]) -> Result<Self, SimulateError> {
        StateError::none(StateError::of_freedoms("rates", rates, self.robot))?;
        self.rates.copy_from_slice(rates);
        Ok(self)
    }

    fn difference(&mut self, q: &[f64], out: &mut [f64]) -> Result<(), SimulateError> {
        if self.flat {
            out.iter_mut().zip(&self.target).zip(q).for_each(|((out, target), q)| *out = target - q);
            return Ok(());
        }
        Ok(self.robot.difference(&mut self.ws, q, &self.target, out)?)
    }
}

impl<R: Dynamics<f64>> Control for Pd<'_, R> {
    fn torques(&mut self, _: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        if self.difference(q, tau).is_err() {
            tau.fill(f64::NAN); // it was tried when this was made
        }
        for (i, tau) in tau.iter_mut().enumerate() {
            *tau = self.proportional[i] * *tau + self.derivative[i] * (self.rates[i] - v[i]);
        }
    }

    fn count(&self) -> Option<usize> {
        Some(self.rates.len())
    }

    fn depends_on(&self) -> Dependence {
        Dependence { time: false, state: true }
    }
}
