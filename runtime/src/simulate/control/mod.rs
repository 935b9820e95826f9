//! Controllers: torques as functions of time and state.

mod drive;
mod pd;
mod torque_table;

use articulated_core::effect::Range;

use super::{SimulateError, StateError};

pub use drive::Drive;
pub use pd::Pd;
pub use torque_table::TorqueTable;

/// A controller, closed or open loop.
///
/// A closure `|t, q, v, tau| …` is a continuous controller. It is called for each evaluation of the
/// dynamics, also in steps that are rejected later, so it must be a pure function of its arguments.
/// A controller with state should be sampled: [`Hold`].
pub trait Control {
    /// The torques at time t, s, and state q, v: tau `[nv]`, N·m|N, is zero on entry.
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]);

    /// The period of a sampled controller, s. It is called once at the start and once every period;
    /// its torques are held until the next sample, and no step crosses a sample.
    fn period(&self) -> Option<f64> {
        None
    }

    /// The next time after t at which the torques have a kink or a jump, s. A step ends there and
    /// uses the torques before it. Not called for sampled controllers.
    fn next_kink(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// The number of torques, where that is fixed.
    fn count(&self) -> Option<usize> {
        None
    }

    /// The dependence of the torques. Linearly implicit steps differentiate them numerically.
    fn depends_on(&self) -> Dependence {
        Dependence { time: true, state: true }
    }
}

/// Dependence of torques.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dependence {
    /// On time.
    pub time: bool,
    /// On q and v.
    pub state: bool,
}

impl Dependence {
    pub(crate) const NOTHING: Self = Self { time: false, state: false };
}

impl<F: FnMut(f64, &[f64], &[f64], &mut [f64])> Control for F {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        self(t, q, v, tau);
    }
}

/// A control by reference: [`Hold`] samples `&mut control as &mut dyn Control`, and the caller
/// keeps the control. A mutable reference to a closure is a control anyway.
impl Control for &mut (dyn Control + '_) {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        (**self).torques(t, q, v, tau);
    }

    fn period(&self) -> Option<f64> {
        (**self).period()
    }

    fn next_kink(&self, t: f64) -> f64 {
        (**self).next_kink(t)
    }

    fn count(&self) -> Option<usize> {
        (**self).count()
    }

    fn depends_on(&self) -> Dependence {
        (**self).depends_on()
    }
}

/// No torque.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoTorque;

impl Control for NoTorque {
    fn torques(&mut self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn depends_on(&self) -> Dependence {
        Dependence::NOTHING
    }
}

/// Always the same torques.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant(Vec<f64>);

impl Constant {
    /// tau: `[nv]`, N·m|N.
    pub fn new(tau: Vec<f64>) -> Self {
        Self(tau)
    }
}

impl Control for Constant {
    fn torques(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) {
        tau.iter_mut().zip(&self.0).for_each(|(tau, given)| *tau = *given);
    }

    fn count(&self) -> Option<usize> {
        Some(self.0.len())
    }

    fn depends_on(&self) -> Dependence {
        Dependence::NOTHING
    }
}

/// An invalid period.
pub(crate) fn wrong_period(period: f64, right: String) -> StateError {
    StateError::Value { what: "period", found: period, right }
}

/// A controller sampled with a period: zero-order hold.
///
/// The control is called once at the start of a motion and once every `period` seconds, in the
/// order of time, with the state at that time. Its torques are constant up to the next sample. No
/// step crosses a sample, and rejected steps do not call it, so a control with memory (a filter, an
/// integral, a policy) works. Its own `period` and `next_kink` are ignored. A motion that runs in
/// several spans ([`Simulation::set_span`](super::Simulation::set_span)) samples again at the start
/// of each span.
///
/// ```
/// use articulated::simulate::{Control, Hold};
/// let mut calls = 0;
/// let mut count = |_t: f64, _q: &[f64], _v: &[f64], _tau: &mut [f64]| calls += 1;
/// let mut hold = Hold::new(&mut count as &mut dyn Control, 0.01)?;
/// assert_eq!(hold.period(), Some(0.01));
/// hold.torques(0.0, &[0.0], &[0.0], &mut [0.0]);
/// assert_eq!(calls, 1);
/// # Ok::<(), articulated::simulate::SimulateError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Hold<C> {
    control: C,
    period: f64,
}

impl<C: Control> Hold<C> {
    /// Samples every `period` seconds. Errors: a period that is not positive and finite.
    pub fn new(control: C, period: f64) -> Result<Self, SimulateError> {
        let wrong = !Range::POSITIVE.has(period);
        StateError::none(wrong.then(|| wrong_period(period, format!("{}, s", Range::POSITIVE))).into_iter())?;
        Ok(Self { control, period })
    }
}

impl<C: Control> Control for Hold<C> {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        self.control.torques(t, q, v, tau);
    }

    fn period(&self) -> Option<f64> {
        Some(self.period)
    }

    fn count(&self) -> Option<usize> {
        self.control.count()
    }

    fn depends_on(&self) -> Dependence {
        Dependence::NOTHING
    }
}
