//! Stiff motions under explicit integrators.

use super::{Run, Simulation};
use crate::simulate::{SimulateError, Stiffness};

impl Simulation<'_> {
    /// Refuses a fixed step that an explicit integrator is not stable at.
    pub(super) fn check_stability(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        let (nv, counts) = (self.shape.nv, &self.system.counts);
        let Some(h) = self.settings.step.filter(|_| !self.settings.integrator.row().implicit) else { return Ok(()) };
        if !self.looks_for_stiffness() || !self.stability.due(counts.steps, &self.y[nv..2 * nv]) {
            return Ok(());
        }
        let h = self.longest_step(h);
        let here = (self.t, &self.y[..], &self.f[..]);
        let found = self.stability.exceeded(&mut self.system, run.control, &*self.method, here, h)?;
        self.refuse(h, found)
    }

    /// Whether to look for unstable steps: they are not ignored, and none is recorded yet.
    pub(super) fn looks_for_stiffness(&self) -> bool {
        self.settings.stiffness != Stiffness::Ignore && self.system.counts.stiff_at.is_none()
    }

    /// The same if the last step saw fast motion on its way.
    pub(super) fn check_suspect(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        let Some(h) = self.settings.step.map(|h| self.longest_step(h)) else { return Ok(()) };
        for place in 0..2 {
            let Some((rate, suspects)) = self.method.fastest() else { return Ok(()) };
            let suspect = suspects[place];
            let at = if rate == 0.0 || suspect.iter().any(|x| !x.is_finite()) { &self.y } else { suspect };
            self.point.y.copy_from_slice(at);
            self.system.rate(run.control, self.t, &self.point.y, &mut self.spare)?;
            self.stability.begin_anew();
            let here = (self.t, &self.point.y[..], &self.spare[..]);
            let found = self.stability.exceeded(&mut self.system, run.control, &*self.method, here, h)?;
            self.refuse(h, found)?;
        }
        Ok(())
    }

    /// A span shorter than the requested step is one step.
    fn longest_step(&self, asked: f64) -> f64 {
        asked.min(self.progress.until - self.progress.stretch.0)
    }

    fn refuse(&mut self, h: f64, found: Option<(f64, f64)>) -> Result<(), SimulateError> {
        let Some((admissible, rate)) = found else { return Ok(()) };
        self.stiff(SimulateError::Unstable { integrator: self.settings.integrator, t: self.t, step: h, admissible, rate })
    }

    /// Refused or noted.
    fn stiff(&mut self, error: SimulateError) -> Result<(), SimulateError> {
        if self.settings.stiffness == Stiffness::Refuse {
            return Err(error);
        }
        self.system.counts.stiff_at.get_or_insert(self.t);
        Ok(())
    }

    /// Hairer & Wanner 1996, §IV.2: fifteen steps held back by stability, with no six between that
    /// are not; looked for every thousand steps.
    pub(super) fn check_stiffness(&mut self, h: f64) -> Result<(), SimulateError> {
        let due =
            self.settings.stiffness != Stiffness::Ignore && (self.system.counts.steps.is_multiple_of(1000) || self.progress.held.steps > 0);
        if self.progress.controller.is_none() || !due {
            return Ok(());
        }
        let Some((found, most)) = self.method.stiffness(h, &self.end) else { return Ok(()) };
        if self.progress.held.steps == 0 {
            self.progress.held.since = (self.t, self.tries() - 1);
        }
        self.progress.held.count(found > most);
        if self.progress.held.steps < 15 {
            return Ok(());
        }
        let (since, before) = std::mem::take(&mut self.progress.held).since;
        let t = self.t + h;
        let step = (t - since) / (self.tries() - before) as f64;
        let left = (self.settings.end - t) / step;
        if left <= AFFORDABLE {
            self.system.counts.stiff_at.get_or_insert(self.t);
            return Ok(());
        }
        self.stiff(SimulateError::Stiff { integrator: self.settings.integrator, t: self.t, step, left })
    }

    /// Steps, rejected ones among them.
    pub(super) fn tries(&self) -> u64 {
        self.system.counts.steps + self.system.counts.rejected
    }
}

/// To make this many steps of an explicit integrator is faster than to choose another.
const AFFORDABLE: f64 = 20_000.0;

/// Steps that stability holds back.
#[derive(Default)]
pub(super) struct Held {
    steps: u32,
    /// Steps since the last of them that stability did not hold back.
    free: u32,
    /// When the first began, s, and the tries before.
    since: (f64, u64),
}

impl Held {
    fn count(&mut self, held: bool) {
        (self.steps, self.free) = if held { (self.steps + 1, 0) } else { (self.steps, self.free + 1) };
        if self.free >= 6 {
            *self = Self::default();
        }
    }
}
