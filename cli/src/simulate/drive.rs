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
                        if let Some((span, from, to)) = rows(series, t) {
                            let told = self.robot.difference(&mut self.ws, from, to, &mut self.rate);
                            self.rate.iter_mut().for_each(|r| *r = if told.is_ok() { *r / span } else { f64::NAN });
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

/// The rows around t, if t is between two that are joined by a straight line.
fn rows(series: &Series, t: f64) -> Option<(f64, &[f64], &[f64])> {
    let next = series.times.partition_point(|x| *x <= t);
    let before = next.checked_sub(1).filter(|_| !series.hold)?;
    Some((series.times.get(next)? - series.times[before], series.rows.get(before)?, series.rows.get(next)?))
}
