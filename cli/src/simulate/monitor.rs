//! Progress of a running motion: a bar, and a warning if it is slow.

use std::time::{Duration, Instant};

use articulated::simulate::{Counts, Settings};

use crate::console::Progress;
use crate::table::number;
use articulated_lab::session::{Session, joint_of};

/// Time after which a slow motion is reported, and the minimum remaining time then.
const PATIENCE: Duration = Duration::from_secs(8);
const LONG: Duration = Duration::from_secs(30);

/// Steps between two looks at the clock.
const EVERY: u64 = 16;

pub(super) struct RunMonitor<'a> {
    session: &'a Session,
    settings: &'a Settings,
    progress: &'a Progress,
    clock: Instant,
    looked: u64,
    warned: bool,
}

impl<'a> RunMonitor<'a> {
    pub(super) fn new(session: &'a Session, settings: &'a Settings, progress: &'a Progress) -> Self {
        Self { session, settings, progress, clock: Instant::now(), looked: 0, warned: false }
    }

    /// After a step, to the time t, s.
    pub(super) fn look(&mut self, t: f64, counts: &Counts) {
        let tries = counts.steps + counts.rejected;
        // The bar moves once every few steps, so its cost is negligible.
        if tries < self.looked + EVERY {
            return;
        }
        self.looked = tries;
        let part = (t - self.settings.start) / (self.settings.end - self.settings.start);
        self.progress.at(part);
        let passed = self.clock.elapsed();
        if !self.warned && passed >= PATIENCE {
            self.warned = true;
            let left = passed.as_secs_f64() * (1.0 - part) / part;
            if left.is_nan() || left > LONG.as_secs_f64() {
                self.progress.warn(&self.slow(t, counts, passed.as_secs_f64(), left));
            }
        }
    }

    /// How slow the motion is, and why.
    fn slow(&self, t: f64, counts: &Counts, passed: f64, left: f64) -> String {
        let (file, end) = (&self.session.scene.file, self.settings.end);
        let tries = (counts.steps + counts.rejected) as f64;
        let mean = (t - self.settings.start) / tries;
        let limit = counts.limited_by.and_then(|index| Some((index, joint_of(self.session, index)?)));
        let limit = limit.map_or_else(String::new, |(index, joint)| {
            let what = if index < self.session.model.nv() { "coordinate" } else { "velocity" };
            format!(", limited most by the {what} of joint `{joint}`")
        });
        format!(
            "{file}: the motion is at t = {} s of {} s after {passed:.0} s; at this pace it takes {} more. Steps of {mean:.1e} s{limit}",
            number(t),
            number(end),
            long(left)
        )
    }
}

/// Seconds in the largest unit that fits.
fn long(seconds: f64) -> String {
    let units = [(86400.0 * 365.0, "years"), (86400.0, "days"), (3600.0, "h"), (60.0, "min")];
    units.into_iter().find(|(unit, _)| seconds >= 2.0 * unit).map_or_else(
        || format!("{seconds:.0} s"),
        |(unit, name)| if seconds.is_finite() { format!("{} {name}", number((seconds / unit).round())) } else { "for ever".to_owned() },
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn times_are_told_in_the_largest_unit_that_fits() {
        let told = [59.0, 150.0, 7200.0, 3e5, 1e9, f64::INFINITY].map(super::long);
        assert_eq!(told, ["59 s", "3 min", "2 h", "3 days", "32 years", "for ever"]);
    }
}
