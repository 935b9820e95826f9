//! Compatibility of a robot's dynamics with the scene's.
//!
//! Compares accelerations in a few states by the torques that they need: accelerations of an
//! ill-conditioned robot may differ where its torques do not.

use articulated::{Dynamics, FunctionError, FunctionId, Model};

use crate::error::Fault;
use crate::initial_state::InitialState;
use crate::session::Session;

/// Tolerated difference of torques, relative to the largest one: above the error of every level of
/// accuracy. Smaller effects are not detected.
const ALIKE: f64 = 1e-3;

/// Largest distances from the start, rad and m, at which accelerations are compared: the start and
/// both sides, so that stops and the ground act.
const AWAY: [f64; 3] = [0.0, 8.0, -8.0];

impl Session {
    /// The fault of a robot with other effects, gravity or masses than the scene's.
    pub(crate) fn dynamics_mismatch<R: Dynamics<f64>>(&self, robot: &R, initial: &InitialState) -> Result<Option<Fault>, FunctionError> {
        for away in AWAY {
            let pattern: Vec<f64> = (0..self.model.nv()).map(|k| 1.0 - 0.15 * (k % 4) as f64).collect();
            let step: Vec<f64> = pattern.iter().map(|x| away * x).collect();
            let v: Vec<f64> = initial.v.iter().zip(&pattern).map(|(v, x)| v + 0.5 * x).collect();
            let mut q = vec![0.0; self.model.nq()];
            self.model.integrate(&mut self.model.workspace(), &initial.q, &step, &mut q)?;
            let a = [accelerations(&self.model, &q, &v, &pattern)?, accelerations(robot, &q, &v, &pattern)?];
            if let Some((apart, largest)) = apart(&self.model, &q, &v, &a)?.filter(|(apart, largest)| *apart > ALIKE * largest) {
                return Ok(Some(Fault::Dynamics { apart, largest }));
            }
        }
        Ok(None)
    }
}

fn accelerations<R: Dynamics<f64>>(robot: &R, q: &[f64], v: &[f64], tau: &[f64]) -> Result<Vec<f64>, FunctionError> {
    let mut a = vec![0.0; v.len()];
    robot.call(FunctionId::forward_dynamics, &mut robot.workspace(), &[q, v, tau], &mut a).map(|()| a)
}

/// The largest difference of the torques of two accelerations, and the largest of these torques and
/// the bias torques; `None` if any is not finite.
fn apart(model: &Model<f64>, q: &[f64], v: &[f64], [expected, found]: &[Vec<f64>; 2]) -> Result<Option<(f64, f64)>, FunctionError> {
    let torques = |a: &[f64]| -> Result<Vec<f64>, FunctionError> {
        let mut tau = vec![0.0; v.len()];
        model.inverse_dynamics(&mut model.workspace(), q, v, a, &mut tau).map(|()| tau)
    };
    let (expected, found, bias) = (torques(expected)?, torques(found)?, torques(&vec![0.0; v.len()])?);
    let apart = expected.iter().zip(&found).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    let largest = expected.iter().chain(&found).chain(&bias).fold(0.0, |most: f64, x| most.max(x.abs()));
    Ok((expected.iter().chain(&found).all(|x| x.is_finite()) && largest.is_finite()).then_some((apart, largest)))
}
