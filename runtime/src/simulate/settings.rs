//! What a simulation is asked for.

use std::fmt;

use articulated_core::Plain;
use articulated_core::algorithm::Shape;
use articulated_core::integrator::least_step;

use super::IntegratorId;

/// What a simulation is asked for; keys are called as in scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How to integrate.
    pub integrator: IntegratorId,
    /// First time, s.
    pub start: f64,
    /// Last time, s; after `start`.
    pub end: f64,
    /// Fixed steps of this length, s, the last of a stretch shortened to end with it. `None`: steps are chosen by the tolerances, which only the integrators do that
    /// are `adaptive` in [`super::integrators`].
    pub step: Option<f64>,
    /// Relative tolerance of a step's error, coordinate by coordinate.
    pub rtol: f64,
    /// Absolute tolerance of a step's error: rad, m, and those a second.
    pub atol: f64,
    /// Absolute tolerances one by one, `[2·nv]`: of the steps of q, then of v; empty: `atol` for all.
    pub atol_each: Vec<f64>,
    /// No step shorter than this, s, save the last of a stretch; 0: sixteen units of rounding of t.
    pub min_step: f64,
    /// No step longer than this, s.
    pub max_step: f64,
    /// The first step to try, s; `None`: estimated.
    pub first_step: Option<f64>,
    /// Steps, rejected ones included, after which to give up.
    pub max_steps: u64,
    /// When to record.
    pub output: Output,
    /// How sharply the time of an event is found, s; never sharper than four units of rounding of t.
    pub event_tolerance: f64,
    /// What to do where an explicit integrator meets a stiff motion.
    pub stiffness: Stiffness,
}

/// When to record.
#[derive(Clone, Debug, PartialEq)]
pub enum Output {
    /// At the start, every so many seconds, and at the end.
    Every(f64),
    /// At the start, and at these times, in order.
    At(Vec<f64>),
    /// At the start and after each step.
    Steps,
    /// At the start and at the end.
    Ends,
}

/// What to do where an explicit integrator meets a stiff motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stiffness {
    /// End with [`super::SimulateError::Unstable`], or with [`super::SimulateError::Stiff`] where more than 20 000 steps of the length that stability admits would be left to
    /// the end; where they are fewer, they are made, and the time is noted as by [`Self::Note`].
    #[default]
    Refuse,
    /// Note the time in [`super::Counts::stiff_at`] and go on.
    Note,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: IntegratorId::dopri5,
            start: 0.0,
            end: 1.0,
            step: None,
            rtol: 1e-6,
            atol: 1e-9,
            atol_each: Vec::new(),
            min_step: 0.0,
            max_step: f64::INFINITY,
            first_step: None,
            max_steps: 10_000_000,
            output: Output::Every(0.01),
            event_tolerance: 1e-12,
            stiffness: Stiffness::Refuse,
        }
    }
}

/// A setting that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingError {
    /// Its key.
    pub key: &'static str,
    /// What it was.
    pub found: String,
    /// What would be right.
    pub right: String,
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: {}", self.key, self.found, self.right)
    }
}

impl std::error::Error for SettingError {}

/// Most numbers that the records of `Output::Every` may have together: 8 GB.
const MOST_RECORDED: f64 = 1e9;

impl Settings {
    /// Everything that is wrong with them for a robot of this shape.
    pub fn problems(&self, shape: Shape) -> Vec<SettingError> {
        let mut found = Problems(Vec::new());
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let least = self.least_step();
        found.unless(self.start.is_finite(), "start", self.start, "a finite time, s");
        found.unless(
            self.end.is_finite() && self.end > self.start,
            "end",
            self.end,
            &format!("a finite time after start = {}", Plain(self.start)),
        );
        if let Some(step) = self.step {
            found.unless(positive(step), "step", step, "a length of time greater than zero, s");
            let told = format!("at least {least:.1e} s, sixteen units of rounding of the time");
            found.unless(!positive(step) || step >= least || !least.is_finite(), "step", step, &told);
        } else if !self.integrator.row().adaptive {
            found.unless_told(
                false,
                "step",
                || "nothing".into(),
                &format!("{} has no error estimate, so it needs a step, s", self.integrator),
            );
        }
        let rtol = self.rtol == 0.0 || (self.rtol >= 1e-15 && self.rtol < 1.0);
        found.unless(rtol, "rtol", self.rtol, "0, or at least 1e-15, below which is rounding, and less than 1");
        let atol = self.atol >= 0.0 && self.atol.is_finite();
        found.unless(atol, "atol", self.atol, "at least 0");
        found.unless(!(rtol && atol) || self.rtol + self.atol > 0.0, "rtol", self.rtol, "one of rtol and atol greater than 0");
        let each = &self.atol_each;
        let lengths = [0, 2 * shape.nv].contains(&each.len());
        found.unless_told(lengths, "atol_each", || format!("{} numbers", each.len()), &format!("{} numbers, or none", 2 * shape.nv));
        let bad = each.iter().find(|x| !(**x >= 0.0 && x.is_finite()));
        found.unless(bad.is_none(), "atol_each", bad.copied().unwrap_or(0.0), "each at least 0");
        found.unless(self.min_step >= 0.0 && self.min_step.is_finite(), "min_step", self.min_step, "finite, at least 0 s");
        let longest = self.max_step > 0.0 && self.max_step >= self.min_step;
        found.unless(longest, "max_step", self.max_step, "greater than 0 s and at least min_step");
        let told = format!("at least {least:.1e} s, sixteen units of rounding of the time");
        found.unless(!longest || self.max_step >= least || !least.is_finite(), "max_step", self.max_step, &told);
        let first = self.first_step;
        found.unless(first.is_none_or(positive), "first_step", first.unwrap_or(0.0), "a length of time greater than zero, s");
        found.unless(self.max_steps > 0, "max_steps", self.max_steps as f64, "at least 1");
        let time = self.event_tolerance >= 0.0 && self.event_tolerance.is_finite();
        found.unless(time, "event_tolerance", self.event_tolerance, "at least 0 s");
        self.check_output(shape, &mut found);
        found.0
    }

    /// The least that time can be told to go on by, s.
    pub(crate) fn least_step(&self) -> f64 {
        least_step(self.start, self.end)
    }

    fn check_output(&self, shape: Shape, found: &mut Problems) {
        match &self.output {
            Output::Every(s) => self.check_every(*s, shape, found),
            Output::At(times) => {
                let inside = |t: f64| t >= self.start && t <= self.end;
                let early = times.windows(2).find(|w| w[0] >= w[1] || w[1].is_nan()).map(|w| w[1]);
                let bad = times.iter().copied().find(|t| !inside(*t)).or(early);
                let (start, end) = (Plain(self.start), Plain(self.end));
                let expected = format!("times from start = {start} to end = {end}, each later than the one before");
                found.unless_told(bad.is_none(), "output", || format!("{} among the times", Plain(bad.unwrap_or(0.0))), &expected);
            }
            Output::Steps | Output::Ends => {}
        }
    }

    /// Records that time can tell apart, and that there is room for.
    fn check_every(&self, every: f64, shape: Shape, found: &mut Problems) {
        let length = self.end - self.start;
        if !(every > 0.0 && length > 0.0 && length.is_finite()) {
            return found.unless(every > 0.0, "output", every, "a length of time greater than zero, s");
        }
        // t, q, v, τ, five energies, momentum
        let each = (1 + shape.nq + 2 * shape.nv + 5 + 6) as f64;
        let (rounding, room) = (self.least_step(), length * each / MOST_RECORDED);
        let right = if rounding > room {
            format!("at least {rounding:.1e} s, sixteen units of rounding of the time")
        } else {
            format!("at least {} s, for no more than {MOST_RECORDED:e} numbers in all, {each} per record", short(room))
        };
        found.unless(every >= rounding.max(room), "output", every, &right);
    }
}

/// To four digits.
pub(crate) fn short(x: f64) -> Plain {
    Plain(format!("{x:.3e}").parse().unwrap_or(x))
}

struct Problems(Vec<SettingError>);

impl Problems {
    fn unless(&mut self, right: bool, key: &'static str, found: f64, would_be: &str) {
        self.unless_told(right, key, || Plain(found).to_string(), would_be);
    }

    fn unless_told(&mut self, right: bool, key: &'static str, found: impl FnOnce() -> String, would_be: &str) {
        if !right {
            self.0.push(SettingError { key, found: found(), right: would_be.into() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{IntegratorId, Output, Settings, Shape};

    #[test]
    fn every_bad_setting_is_named_at_once() {
        let shape = Shape { nq: 1, nv: 1, frames: 1, links: 1 };
        assert_eq!(Settings::default().problems(shape), []);
        let bad = Settings {
            start: f64::NAN,
            end: -1.0,
            step: Some(0.0),
            rtol: -1.0,
            atol: f64::INFINITY,
            atol_each: vec![1.0],
            max_step: 0.0,
            first_step: Some(-1.0),
            max_steps: 0,
            output: Output::Every(0.0),
            ..Settings::default()
        };
        let keys: Vec<_> = bad.problems(shape).iter().map(|p| p.key).collect();
        for key in ["start", "end", "step", "rtol", "atol", "atol_each", "max_step", "first_step", "max_steps", "output"] {
            assert_eq!(keys.iter().filter(|k| **k == key).count(), 1, "{key} among {keys:?}");
        }
        let late = Settings { output: Output::At(vec![0.5, 1.5]), start: 0.0, end: 1.3, ..Settings::default() };
        assert!(late.problems(shape)[0].to_string().starts_with("output = 1.5 among the times: times from start = 0 to end = 1.3"));
        let none = Settings { rtol: 0.0, atol: 0.0, ..Settings::default() };
        assert_eq!(none.problems(shape)[0].to_string(), "rtol = 0: one of rtol and atol greater than 0");
        let fixed = Settings { integrator: IntegratorId::rk4, ..Settings::default() };
        assert_eq!(fixed.problems(shape)[0].to_string(), "step = nothing: rk4 has no error estimate, so it needs a step, s");
    }

    #[test]
    fn a_step_that_the_time_cannot_take_is_refused() {
        let shape = Shape { nq: 1, nv: 1, frames: 1, links: 1 };
        let at = |start: f64, end: f64| {
            let settings =
                Settings { integrator: IntegratorId::rk4, step: Some(0.25), start, end, output: Output::Ends, ..Settings::default() };
            settings.problems(shape).iter().map(|p| p.key).collect::<Vec<_>>()
        };
        // Near 1e15 s the time is a multiple of 1/8 s, near 1e12 s of 1/8192 s.
        assert_eq!([at(1e15, 1e15 + 4.0), at(1e12, 1e12 + 4.0)], [vec!["step"], vec![]]);
    }

    /// So many numbers as there is room for, whatever the robot; and no two records at one time.
    #[test]
    fn records_are_as_many_as_there_is_room_and_time_for() {
        let told = |nv: usize, start: f64, every: f64| {
            let settings = Settings { start, end: start + 10.0, output: Output::Every(every), ..Settings::default() };
            let problems = settings.problems(Shape { nq: nv, nv, frames: 1, links: 1 });
            problems.first().map(ToString::to_string).unwrap_or_default()
        };
        assert_eq!(told(1, 0.0, 2e-7), "");
        assert_eq!(told(100, 0.0, 2e-7), "output = 2e-7: at least 3.12e-6 s, for no more than 1e9 numbers in all, 312 per record");
        assert_eq!(told(1, 1e9, 1e-6), "output = 1e-6: at least 3.6e-6 s, sixteen units of rounding of the time");
    }

    #[test]
    fn what_does_not_go_together_is_named() {
        let shape = Shape { nq: 1, nv: 1, frames: 1, links: 1 };
        let right = Settings {
            start: 1.0,
            end: 2.0,
            min_step: 1e-3,
            max_step: 1e-3,
            output: Output::At(vec![1.0, 1.5, 2.0]),
            ..Settings::default()
        };
        assert_eq!(right.problems(shape), []);
        let wrong = [
            ("min_step", Settings { min_step: -1e-3, ..right.clone() }),
            ("min_step", Settings { min_step: f64::INFINITY, max_step: f64::INFINITY, ..right.clone() }),
            ("max_step", Settings { max_step: 1e-4, ..right.clone() }),
            ("rtol", Settings { rtol: 1e-16, ..right.clone() }),
            ("rtol", Settings { rtol: 0.0, atol: 0.0, ..right.clone() }),
            ("event_tolerance", Settings { event_tolerance: -1e-12, ..right.clone() }),
            ("event_tolerance", Settings { event_tolerance: f64::INFINITY, ..right.clone() }),
            ("output", Settings { output: Output::At(vec![1.5, 1.5]), ..right.clone() }),
            ("output", Settings { output: Output::At(vec![0.5, 1.5]), ..right.clone() }),
            ("output", Settings { output: Output::At(vec![1.5, 2.5]), ..right.clone() }),
            ("output", Settings { output: Output::Every(1e-10), ..right.clone() }),
            ("output", Settings { output: Output::Every(f64::NAN), ..right.clone() }),
        ];
        for (key, settings) in wrong {
            let found: Vec<_> = settings.problems(shape).iter().map(|p| p.key).collect();
            assert_eq!(found, [key], "{settings:?}");
        }
    }
}
