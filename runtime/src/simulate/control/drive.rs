//! Controllers defined by data.

use std::borrow::Cow;

use articulated_core::actuator::Actuators;
use articulated_core::algorithm::{FunctionError, FunctionId};
use articulated_core::control::{Aim, Controller, Series, Signal};
use articulated_core::dynamics::Dynamics;
use articulated_core::joint::Coordinates;

use super::{Control, Dependence};
use crate::simulate::{SimulateError, StateError, manifold::Manifold};

/// A controller on a robot.
///
/// ```text
/// none      τ = 0
/// torque    τ = the given one
/// table     τ = that of the table at the time
/// pd        τ = kp (target ⊖ q) + kd (target' − v) + torque
/// actuators τ = Σ gear · force(control, q, v)
/// ```
pub struct Drive<'r, R: Dynamics<f64>> {
    controller: Cow<'r, Controller>,
    period: Option<f64>,
    pub(super) pursuit: Pursuit<'r, R>,
    /// The controls of actuators at one time.
    controls: Vec<f64>,
}

/// The tracking error.
pub(super) struct Pursuit<'r, R: Dynamics<f64>> {
    robot: &'r R,
    ws: R::Workspace,
    target: Vec<f64>,
    /// target ⊖ q.
    error: Vec<f64>,
    /// target'; unchanged for a constant target.
    pub(super) rate: Vec<f64>,
    step: Vec<f64>,
}

impl<'r, R: Dynamics<f64>> Drive<'r, R> {
    /// A controller, and its sampling period, s, if it is sampled. Errors: all vectors and tables
    /// that do not fit the robot; or else a missing function: control of kind `pd` needs
    /// `difference`, and for quaternion joints `integrate`.
    pub fn new(robot: &'r R, controller: &'r Controller, period: Option<f64>) -> Result<Self, SimulateError> {
        let names = ["control.target", "control.kp", "control.kd", "control.torque"];
        let mut drive = Self::called(robot, Cow::Borrowed(controller), names)?;
        if matches!(controller, Controller::Pd { .. }) {
            robot.check_function(&mut drive.pursuit.ws, FunctionId::difference)?;
        }
        Ok(Self { period, ..drive })
    }

    /// The same, with the caller's names of target, gains and torques for messages.
    pub(super) fn called(robot: &'r R, controller: Cow<'r, Controller>, names: [&'static str; 4]) -> Result<Self, SimulateError> {
        StateError::none(wrong(&controller, robot, names)?.into_iter())?;
        let mut pursuit = Pursuit::new(robot);
        if matches!(*controller, Controller::Pd { .. }) && !pursuit.is_flat() {
            robot.check_function(&mut pursuit.ws, FunctionId::difference)?;
        }
        let controls = match &*controller {
            Controller::Actuators { actuators, .. } => vec![0.0; actuators.laws.len()],
            _ => Vec::new(),
        };
        Ok(Self { controller, period: None, pursuit, controls })
    }
}

impl<'r, R: Dynamics<f64>> Pursuit<'r, R> {
    fn new(robot: &'r R) -> Self {
        let (shape, zeros) = (robot.shape(), || vec![0.0; robot.shape().nv]);
        Self { robot, ws: robot.workspace(), target: vec![0.0; shape.nq], error: zeros(), rate: zeros(), step: zeros() }
    }

    /// Whether every coordinate is plain: each quaternion is one more than its rates.
    fn is_flat(&self) -> bool {
        self.target.len() == self.rate.len()
    }

    /// Error and rate at time t.
    fn aim(&mut self, aim: &Aim, t: f64, q: &[f64]) -> Result<(), FunctionError> {
        match aim {
            Aim::Still(still) => self.target.copy_from_slice(still),
            Aim::Moving(series) => self.follow(series, t)?,
        }
        difference(self.robot, &mut self.ws, q, &self.target, &mut self.error)
    }

    /// Target and rate at time t.
    fn follow(&mut self, series: &Series, t: f64) -> Result<(), FunctionError> {
        series.at(t, &mut self.target);
        if self.is_flat() && series.rates(t, &mut self.rate) {
            return Ok(());
        }
        let Some(([since, span], [from, to])) = series.between(t) else {
            self.rate.fill(0.0);
            return Ok(());
        };
        difference(self.robot, &mut self.ws, from, to, &mut self.rate)?;
        self.rate.iter_mut().for_each(|r| *r /= span);
        // from ⊕ (t − t_from) target': the shortest way at a constant rate, which plain coordinates
        // take anyway.
        if !self.is_flat() {
            self.step.iter_mut().zip(&self.rate).for_each(|(step, rate)| *step = since * rate);
            self.robot.integrate(&mut self.ws, from, &self.step, &mut self.target)?;
        }
        Ok(())
    }
}

/// target ⊖ q; a robot of plain coordinates needs no function for it.
fn difference<R: Dynamics<f64>>(robot: &R, ws: &mut R::Workspace, q: &[f64], target: &[f64], out: &mut [f64]) -> Result<(), FunctionError> {
    if q.len() != out.len() {
        return robot.difference(ws, q, target, out);
    }
    out.iter_mut().zip(target).zip(q).for_each(|((out, target), q)| *out = target - q);
    Ok(())
}

impl<R: Dynamics<f64>> Control for Drive<'_, R> {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        match &*self.controller {
            Controller::None => {}
            Controller::Torque(given) => tau.copy_from_slice(given),
            Controller::Table(series) => series.at(t, tau),
            Controller::Pd { target, kp, kd, torque } => {
                if self.pursuit.aim(target, t, q).is_err() {
                    return tau.fill(f64::NAN); // its functions were tried when this was made
                }
                let Pursuit { error, rate, .. } = &self.pursuit;
                for i in 0..tau.len() {
                    tau[i] = kp[i] * error[i] + kd[i] * (rate[i] - v[i]) + torque[i];
                }
            }
            Controller::Actuators { actuators, controls } => {
                match controls {
                    Signal::Still(still) => self.controls.copy_from_slice(still),
                    Signal::Moving(series) => series.at(t, &mut self.controls),
                }
                actuators.add_torques(&actuators.inputs(&[], &self.controls, None), q, v, tau);
            }
        }
    }

    fn period(&self) -> Option<f64> {
        self.period
    }

    fn next_kink(&self, t: f64) -> f64 {
        match &*self.controller {
            Controller::Table(series)
            | Controller::Pd { target: Aim::Moving(series), .. }
            | Controller::Actuators { controls: Signal::Moving(series), .. } => series.next(t),
            _ => f64::INFINITY,
        }
    }

    fn count(&self) -> Option<usize> {
        Some(self.pursuit.rate.len())
    }

    fn depends_on(&self) -> Dependence {
        match &*self.controller {
            _ if self.period.is_some() => Dependence::NOTHING,
            Controller::None | Controller::Torque(_) => Dependence::NOTHING,
            Controller::Table(_) => Dependence { time: true, state: false },
            Controller::Pd { target, .. } => Dependence { time: matches!(target, Aim::Moving(_)), state: true },
            Controller::Actuators { actuators, controls } => {
                Dependence { time: matches!(controls, Signal::Moving(_)), state: actuators.depend_on_state() }
            }
        }
    }
}

/// Numbers of actuators that are not finite or do not fit a robot of `nq` coordinates.
fn wrong_actuators(actuators: &Actuators, controls: &Signal, nq: usize, nv: usize) -> Vec<StateError> {
    let Actuators { laws, bounds, followers, passive } = actuators;
    let mut wrong: Vec<StateError> = match controls {
        Signal::Still(u) => StateError::of("control.ctrl", u, laws.len(), |_| None).collect(),
        Signal::Moving(series) => StateError::of_table("control.rows", series, laws.len()).collect(),
    };
    let mut range = |event: &str, [lower, upper]: [f64; 2]| {
        // Also if one of them is NaN.
        if lower.partial_cmp(&upper).is_none_or(|order| order == std::cmp::Ordering::Greater) {
            wrong.push(StateError::Bounds { event: event.to_owned(), lower, upper });
        }
    };
    for law in laws.iter().chain(passive) {
        law.control_range.into_iter().chain(law.force_range).for_each(|bounds| range(&law.name, bounds));
    }
    let of_followers = followers.iter().filter_map(|follower| follower.range);
    bounds.iter().map(|(_, bounds)| *bounds).chain(of_followers).for_each(|bounds| range("bounds of torques", bounds));
    for follower in followers {
        let of_laws = follower.laws.iter().map(|(k, _)| ("actuators", *k, laws.len()));
        let of_leaders = follower.leaders.iter().flat_map(|own| [("q", own.q, nq), ("v", own.v, nv)]);
        let beyond = of_laws.chain(of_leaders).filter(|(_, index, length)| index >= length);
        let event = || "a joint that follows others".to_owned();
        wrong.extend(beyond.map(|(vector, index, length)| StateError::Beyond { event: event(), vector, index, length }));
        let of_leader = |own: &Coordinates<f64>| own.mimic.map(|law| [[law.multiplier, 0.0, 0.0], law.higher.unwrap_or_default()]);
        let factors = follower.laws.iter().map(|(_, gear)| *gear);
        let factors: Vec<f64> = factors.chain(follower.leaders.iter().filter_map(of_leader).flatten().flatten()).collect();
        wrong.extend(StateError::of("gear of an actuator", &factors, factors.len(), |_| None));
    }
    for law in laws.iter().chain(passive) {
        wrong.extend(StateError::of("gain of an actuator", &law.gain, 3, |_| None));
        wrong.extend(StateError::of("bias of an actuator", &law.bias, 3, |_| None));
        for drive in &law.drives {
            wrong.extend(StateError::of("gear of an actuator", &drive.gear, drive.gear.len(), |_| None));
            for (vector, first, count, length) in [("q", drive.q, 1, nq), ("v", drive.v, drive.gear.len(), nv)] {
                if first.saturating_add(count) > length {
                    wrong.push(StateError::Beyond { event: law.name.clone(), vector, index: first, length });
                }
            }
        }
    }
    wrong
}

/// Vectors that do not fit the robot, under these names. Errors: a robot whose coordinates are
/// unknown.
fn wrong<R: Dynamics<f64>>(
    controller: &Controller,
    robot: &R,
    [target, kp, kd, torque]: [&'static str; 4],
) -> Result<Vec<StateError>, FunctionError> {
    Ok(match controller {
        Controller::None => Vec::new(),
        Controller::Torque(given) => StateError::of_freedoms(torque, given, robot).collect(),
        Controller::Table(series) => StateError::of_table("control.rows", series, robot.shape().nv).collect(),
        Controller::Pd { target: aim, kp: p, kd: d, torque: given } => {
            let manifold = Manifold::of(robot)?;
            let aim: Vec<StateError> = match aim {
                Aim::Still(q) => manifold.wrong(robot, target, q).collect(),
                Aim::Moving(series) => StateError::of_table("control.rows", series, robot.shape().nq).collect(),
            };
            let freedoms = [(kp, p), (kd, d), (torque, given)];
            aim.into_iter().chain(freedoms.into_iter().flat_map(|(name, x)| StateError::of_freedoms(name, x, robot))).collect()
        }
        Controller::Actuators { actuators, controls } => wrong_actuators(actuators, controls, robot.shape().nq, robot.shape().nv),
    })
}
