//! The control of a scene, as a simulation asks it.

use articulated::Dynamics;
use articulated::simulate::{Control, Dependence};
use articulated_scene::{Aim, Controller, Series};

/// A scene's controller on a robot.
pub(crate) struct Drive<'r, R: Dynamics<f64>> {
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
    pub(crate) fn new(robot: &'r R, controller: Controller, period: Option<f64>) -> Self {
        let shape = robot.shape();
        Self {
            robot,
            ws: robot.workspace(),
            controller,
            period,
            target: vec![0.0; shape.nq],
            error: vec![0.0; shape.nv],
            rate: vec![0.0; shape.nv],
            step: vec![0.0; shape.nv],
        }
    }
}

impl<R: Dynamics<f64>> Control for Drive<'_, R> {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        match &self.controller {
            Controller::None => {}
            Controller::Torque(given) => tau.copy_from_slice(given),
            Controller::Table(series) => series.at(t, tau),
            Controller::Pd { target, kp, kd, torque } => {
                self.rate.fill(0.0);
                match target {
                    Aim::Still(still) => self.target.copy_from_slice(still),
                    Aim::Moving(series) => {
                        series.at(t, &mut self.target);
                        if let Some((since, span, from, to)) = rows(series, t) {
                            let robot = self.robot;
                            let mut told = robot.difference(&mut self.ws, from, to, &mut self.rate);
                            self.rate.iter_mut().for_each(|r| *r /= span);
                            // from ⊕ (t − t_from) target': the shortest way at a constant rate, which plain coordinates take anyway.
                            if from.len() != self.rate.len() {
                                self.step.iter_mut().zip(&self.rate).for_each(|(step, rate)| *step = since * rate);
                                told = told.and(robot.integrate(&mut self.ws, from, &self.step, &mut self.target));
                            }
                            if told.is_err() {
                                self.rate.fill(f64::NAN); // generated robots have both functions where they are needed
                            }
                        }
                    }
                }
                if self.robot.difference(&mut self.ws, q, &self.target, &mut self.error).is_err() {
                    self.error.fill(f64::NAN);
                }
                // τ = kp (target ⊖ q) + kd (target' − v) + torque
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
