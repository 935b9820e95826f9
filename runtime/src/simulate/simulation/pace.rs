//! Pace of a motion, and the number that limits its steps.

use super::{STEP, Simulation};
use crate::simulate::SimulateError;
use crate::simulate::error::joint;

/// Tries between two looks at the pace.
const WINDOW: u64 = 4096;

/// Number of checks in a row after which a pace counts as the motion's.
const LOOKS: u32 = 3;

/// Multiple of the allowed steps: at such a pace the end is never reached.
const HOPELESS: f64 = 100.0;

/// The pace of steps that tolerances choose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// The number that limits most tries, if one limits more than half of them, and its lead (Boyer
    /// & Moore 1991).
    limiting: (usize, u64),
    /// Time, s, and tries at the last look.
    since: (f64, u64),
    /// Looks in a row that found no hope.
    hopeless: u32,
}

impl Pace {
    /// A motion begins at this time, s.
    pub(super) fn begin(t: f64) -> Self {
        Self { limiting: (0, 0), since: (t, 0), hopeless: 0 }
    }

    /// One try, in which this number had the largest error.
    pub(super) fn vote(&mut self, index: usize) {
        let (candidate, lead) = &mut self.limiting;
        match (*candidate == index, *lead) {
            (true, _) => *lead += 1,
            (false, 0) => (*candidate, *lead) = (index, 1),
            (false, _) => *lead -= 1,
        }
    }

    /// The number that limits most tries.
    pub(super) fn limiting(&self) -> Option<usize> {
        Some(self.limiting).filter(|(_, lead)| *lead > 0).map(|(index, _)| index)
    }
}

impl Simulation<'_> {
    /// Ends a motion that would need far more steps than are allowed, as soon as that is certain.
    pub(super) fn check_pace(&mut self) -> Result<(), SimulateError> {
        let tries = self.tries();
        let pace = &mut self.progress.pace;
        if tries < pace.since.1 + WINDOW {
            return Ok(());
        }
        let way = self.t - pace.since.0;
        let left = (self.settings.end - self.t) / way * (tries - pace.since.1) as f64;
        pace.since = (self.t, tries);
        // A way of no length leaves infinitely many, or NaN.
        let goes_on = left <= HOPELESS * self.progress.most_steps as f64;
        pace.hopeless = if goes_on { 0 } else { pace.hopeless + 1 };
        if pace.hopeless < LOOKS {
            return Ok(());
        }
        let limiting = pace.limiting().map(|index| self.number(index));
        Err(SimulateError::NoProgress { t: self.t, step: way / WINDOW as f64, left, limiting })
    }

    /// Number `index` of a step: its vector, its index there, and the joint.
    pub(super) fn number(&self, index: usize) -> (&'static str, usize, Option<String>) {
        let nv = self.shape.nv;
        let (what, index) = if index < nv { (STEP, index) } else { ("v", index - nv) };
        (what, index, joint(&self.system.robot, index))
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    #[test]
    fn what_limits_more_than_half_of_the_tries_is_found() {
        let mut pace = Pace::begin(0.0);
        assert_eq!(pace.limiting(), None);
        [3, 1, 3, 2, 3, 3, 0, 3].into_iter().for_each(|index| pace.vote(index));
        assert_eq!(pace.limiting(), Some(3));
    }
}
