//! Records of the state that a simulation has reached.

use super::{Run, Simulation};
use crate::simulate::step_control::rounding;
use crate::simulate::{Output, SimulateError};

impl Simulation<'_> {
    /// The state as it is.
    pub(super) fn record_here(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        // An output may be later by a rounding.
        self.point.t = run.recording.t.last().map_or(self.t, |last| last.max(self.t));
        self.point.y.copy_from_slice(&self.y);
        self.point.q.copy_from_slice(&self.system.origin);
        self.known.record(&mut self.system, run.control, &self.point, run.recording)
    }

    /// Adds the state as it is to the balance of energy.
    pub(super) fn follow_balance(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        if self.system.follows_work && self.progress.times.is_some() {
            self.point.q.copy_from_slice(&self.system.origin);
            self.known.follow(&mut self.system, &self.y, &self.point.q, run.recording)?;
        }
        Ok(())
    }

    /// As [`Self::record_here`], unless this time is recorded already, as that of an output that is
    /// a rounding away.
    pub(super) fn record_end(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        let near = if self.settings.output == Output::Steps { 0.0 } else { rounding(self.t) };
        let recorded = run.recording.t.last().is_some_and(|t| (self.t - t).abs() <= near);
        if recorded { Ok(()) } else { self.record_here(run) }
    }
}
