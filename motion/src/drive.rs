//! The control of a scene, as a simulation asks it.

use articulated::simulate::{Control, Dependence, SimulateError, StateError};
use articulated::{Dynamics, FunctionId, Shape};
use articulated_scene::{Aim, Controller, Series};

use crate::needs::tried;

/// A scene's controller on a robot.
///
/// ```text
/// none      τ = 0
/// torque    τ = the given one
/// table     τ = that of the table at the time
/// pd        τ = kp (target ⊖ q) + kd (target' − v) + torque
/// ```
pub struct Drive<'r, R: Dynamics<f64>> {
    robot: &'r R,
    ws: R::Workspace,
    controller: Controller,
    period: Option<f64>,
    target: Vec<f64>,
    error: Vec<f64>,
    rate: Vec<f64>,
    step: Vec<f64>,
}

impl<'r, R: Dynamics<f64>> Drive<'r, R> {
    /// A controller, and the time between its samples, s, if it is sampled. Errors: all vectors that are not as long as the robot's, tables out of order; or else a function that the
    /// robot has not: control of kind `pd` needs `difference`, and for joints that turn freely and targets that move `integrate`.
    pub fn new(robot: &'r R, controller: Controller, period: Option<f64>) -> Result<Self, SimulateError> {
        let shape = robot.shape();
        let wrong = wrong_vectors(&controller, shape);
        if !wrong.is_empty() {
            return Err(SimulateError::State(wrong));
        }
        let mut ws = robot.workspace();
        for function in needed(&controller, shape) {
            tried(robot, &mut ws, *function)?;
        }
        let zeros = || vec![0.0; shape.nv];
        Ok(Self { robot, ws, controller, period, target: vec![0.0; shape.nq], error: zeros(), rate: zeros(), step: zeros() })
    }

    /// target ⊖ q and target' at time t, in `error` and `rate`.
    fn aim(&mut self, t: f64, q: &[f64]) {
        let Controller::Pd { target, .. } = &self.controller else { return };
        self.rate.fill(0.0);
        match target {
            Aim::Still(still) => self.target.copy_from_slice(still),
            Aim::Moving(series) => {
                series.at(t, &mut self.target);
                if let Some((since, span, from, to)) = rows(series, t) {
                    let mut told = self.robot.difference(&mut self.ws, from, to, &mut self.rate);
                    self.rate.iter_mut().for_each(|r| *r /= span);
                    // from ⊕ (t − t_from) target': the shortest way at a constant rate, which plain coordinates take anyway.
                    if from.len() != self.rate.len() {
                        self.step.iter_mut().zip(&self.rate).for_each(|(step, rate)| *step = since * rate);
                        told = told.and(self.robot.integrate(&mut self.ws, from, &self.step, &mut self.target));
                    }
                    if told.is_err() {
                        self.rate.fill(f64::NAN); // both were tried when this was made
                    }
                }
            }
        }
        if self.robot.difference(&mut self.ws, q, &self.target, &mut self.error).is_err() {
            self.error.fill(f64::NAN);
        }
    }
}

impl<R: Dynamics<f64>> Control for Drive<'_, R> {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        self.aim(t, q);
        match &self.controller {
            Controller::None => {}
            Controller::Torque(given) => tau.copy_from_slice(given),
            Controller::Table(series) => series.at(t, tau),
            Controller::Pd { kp, kd, torque, .. } => {
                for i in 0..tau.len() {
                    tau[i] = kp[i] * self.error[i] + kd[i] * (self.rate[i] - v[i]) + torque[i];
                }
            }
        }
    }

    fn period(&self) -> Option<f64> {
        self.period
    }

    fn next_kink(&self, t: f64) -> f64 {
        let series = match &self.controller {
            Controller::Table(series) | Controller::Pd { target: Aim::Moving(series), .. } => series,
            _ => return f64::INFINITY,
        };
        series.times.get(series.times.partition_point(|x| *x <= t)).copied().unwrap_or(f64::INFINITY)
    }

    fn count(&self) -> Option<usize> {
        Some(self.error.len())
    }

    fn depends_on(&self) -> Dependence {
        let (time, state) = match &self.controller {
            _ if self.period.is_some() => (false, false),
            Controller::None | Controller::Torque(_) => (false, false),
            Controller::Table(_) => (true, false),
            Controller::Pd { target, .. } => (matches!(target, Aim::Moving(_)), true),
        };
        Dependence { time, state }
    }
}

/// The rows around t, if t is between two that are joined by a straight way: the time since the first, s, that between them, and both.
fn rows(series: &Series, t: f64) -> Option<(f64, f64, &[f64], &[f64])> {
    let next = series.times.partition_point(|x| *x <= t);
    let before = next.checked_sub(1).filter(|_| !series.hold)?;
    let begin = series.times[before];
    Some((t - begin, series.times.get(next)? - begin, series.rows.get(before)?, series.rows.get(next)?))
}

/// The functions that a controller asks of the robot.
fn needed(controller: &Controller, shape: Shape) -> &'static [FunctionId] {
    match controller {
        Controller::Pd { target: Aim::Moving(_), .. } if shape.nq != shape.nv => &[FunctionId::difference, FunctionId::integrate],
        Controller::Pd { .. } => &[FunctionId::difference],
        _ => &[],
    }
}

/// The vectors that are not as long as they have to be, and what else is wrong with those over time.
fn wrong_vectors(controller: &Controller, Shape { nq, nv, .. }: Shape) -> Vec<StateError> {
    match controller {
        Controller::None => Vec::new(),
        Controller::Torque(torque) => wrong_length("control.torque", torque.len(), nv).into_iter().collect(),
        Controller::Table(series) => wrong_series(series, nv).collect(),
        Controller::Pd { target, kp, kd, torque } => {
            let gains = [("control.kp", kp), ("control.kd", kd), ("control.torque", torque)];
            let gains = gains.into_iter().filter_map(|(name, x)| wrong_length(name, x.len(), nv));
            match target {
                Aim::Still(still) => gains.chain(wrong_length("control.target", still.len(), nq)).collect(),
                Aim::Moving(series) => gains.chain(wrong_series(series, nq)).collect(),
            }
        }
    }
}

/// Of a table: one row at least, and one for each time; the first time that is not after the one before; the first row that has not as many numbers as there are, and the first number that is none.
fn wrong_series(series: &Series, width: usize) -> impl Iterator<Item = StateError> {
    let Series { times, rows, .. } = series;
    let count = wrong_length("control.rows", rows.len(), times.len().max(1));
    let is_late = |k: usize| times[k].is_finite() && (k == 0 || times[k] > times[k - 1]);
    let time = (0..times.len()).find(|&k| !is_late(k)).map(|k| ("a time of control.rows", times[k], "finite, after the one before"));
    let number = rows.iter().flatten().find(|x| !x.is_finite()).map(|x| ("a number of control.rows", *x, "finite"));
    let row = rows.iter().find_map(|row| wrong_length("a row of control.rows", row.len(), width));
    let value = |(what, found, right): (&'static str, f64, &str)| StateError::Value { what, found, right: right.into() };
    count.into_iter().chain(row).chain(time.map(value)).chain(number.map(value))
}

fn wrong_length(vector: &'static str, found: usize, expected: usize) -> Option<StateError> {
    (found != expected).then_some(StateError::Length { vector, found, expected })
}
