//! Settings of a simulation. Scenes have the same keys, and the checks apply to both.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use crate::Plain;
use crate::algorithm::Shape;
use crate::effect::Range;
use crate::integrator::IntegratorId;

/// Settings of a simulation, with the keys of scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How to integrate.
    pub integrator: IntegratorId,
    /// First time, s.
    pub start: f64,
    /// Last time, s; after `start`.
    pub end: f64,
    /// Fixed steps of this length, s, the last of a stretch shortened to end with it. `None`: steps
    /// are chosen by the tolerances, only by integrators that are `adaptive` in
    /// [`crate::integrator::integrators`].
    pub step: Option<f64>,
    /// Relative tolerance of a step's error, coordinate by coordinate.
    pub rtol: f64,
    /// Absolute tolerance of a step's error: rad, m, and those a second.
    pub atol: f64,
    /// Absolute tolerances one by one, `[2·nv]`: of the steps of q, then of v; empty: `atol` for
    /// all. No key of a scene.
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
    /// How sharply the time of an event is found, s; never sharper than four units of rounding of
    /// t.
    pub event_tolerance: f64,
    /// The action if an explicit integrator meets a stiff motion.
    pub stiffness: Stiffness,
}

/// When to record.
#[derive(Clone, Debug, PartialEq)]
pub enum Output {
    /// At the start, at this interval in seconds, and at the end.
    Every(f64),
    /// At the start, and at these times, in order.
    At(Vec<f64>),
    /// At the start and after each step.
    Steps,
    /// At the start and at the end.
    Ends,
}

/// Actions if an explicit integrator meets a stiff motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Stiffness {
    /// End with `SimulateError::Unstable`, or with `SimulateError::Stiff` if more than 20 000 steps
    /// of the length that stability admits remain to the end. If fewer remain, they are made, and
    /// the time is recorded as by [`Self::Note`].
    #[default]
    Refuse,
    /// Note the time in `Counts::stiff_at` and go on.
    Note,
    /// Never check, and spend no evaluation on it: for loops with a step known to be stable. A
    /// motion that is not stable ends where its numbers are not finite.
    Ignore,
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
    /// The keys that conflict with it; empty if it is invalid by itself.
    pub with: &'static [&'static str],
    /// The value found.
    pub found: String,
    /// The expected value, in words.
    pub right: String,
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: {}", self.key, self.found, self.right)
    }
}

impl core::error::Error for SettingError {}

/// Most numbers that the records of `Output::Every` may have together: 8 GB.
const MOST_RECORDED: f64 = 1e9;

/// Keys of the times of a motion.
const TIMES: &[&str] = &["end", "start"];

/// A numeric setting: its key, its range, its unit, and its value.
type Number = (&'static str, Range, &'static str, fn(&Settings) -> Option<f64>);

const NUMBERS: &[Number] = &[
    ("start", Range::ALL, ", s", |s| Some(s.start)),
    ("end", Range::ALL, ", s", |s| Some(s.end)),
    ("step", Range::POSITIVE, ", s", |s| s.step),
    ("atol", Range::NOT_NEGATIVE, "", |s| Some(s.atol)),
    ("min_step", Range::NOT_NEGATIVE, ", s", |s| Some(s.min_step)),
    ("max_step", Range::POSITIVE, ", s", |s| bounded(s.max_step)),
    ("first_step", Range::POSITIVE, ", s", |s| s.first_step),
    ("event_tolerance", Range::NOT_NEGATIVE, ", s", |s| Some(s.event_tolerance)),
    ("output", Range::POSITIVE, ", s", |s| if let Output::Every(every) = s.output { bounded(every) } else { None }),
];

/// An infinite bound means no bound.
fn bounded(x: f64) -> Option<f64> {
    Some(x).filter(|x| *x != f64::INFINITY)
}

impl Settings {
    /// All errors for a robot of this shape, each key once. Settings that depend on a key with an
    /// error are not reported.
    pub fn problems(&self, shape: Shape) -> Vec<SettingError> {
        let mut found = Problems(Vec::new());
        for (key, range, unit, of) in NUMBERS {
            if let Some(x) = of(self).filter(|x| !range.has(*x)) {
                found.add((key, &[]), &Plain(x), format!("{range}{unit}"));
            }
        }
        // Less than 1e-15 is rounding.
        if !(self.rtol == 0.0 || (1e-15..1.0).contains(&self.rtol)) {
            found.add(("rtol", &[]), &Plain(self.rtol), "0, or at least 1e-15 and below 1");
        }
        if self.max_steps == 0 {
            found.add(("max_steps", &[]), &0, "at least 1");
        }
        self.check_each(shape, &mut found);
        self.check_together(&mut found);
        self.check_output(shape, &mut found);
        found.0
    }

    /// The smallest resolvable time step, s: sixteen units of rounding of the time.
    pub fn least_step(&self) -> f64 {
        16.0 * f64::EPSILON * self.start.abs().max(self.end.abs())
    }

    /// The requirement on a sampling period of a controller, s, if it is not met: samples end
    /// steps, so they must be distinct in time, and there are no more of them than steps.
    pub fn wrong_period(&self, period: f64) -> Option<String> {
        let (least, length, most) = (self.least_step(), self.end - self.start, self.max_steps);
        if !Range::POSITIVE.has(period) {
            Some(format!("{}, s", Range::POSITIVE))
        } else if period < least {
            Some(of_rounding(least))
        } else {
            let right = || format!("at least {} s, for no more samples than max_steps = {most}", short(length / most as f64));
            (length / period > most as f64).then(right)
        }
    }

    fn check_each(&self, shape: Shape, found: &mut Problems) {
        let (each, right) = (&self.atol_each, 2 * shape.nv);
        if ![0, right].contains(&each.len()) {
            found.add(("atol_each", &[]), &format!("{} numbers", each.len()), format!("{right} numbers, or none"));
        }
        if let Some(bad) = each.iter().find(|x| !Range::NOT_NEGATIVE.has(**x)) {
            found.add(("atol_each", &[]), &Plain(*bad), format!("each {}", Range::NOT_NEGATIVE));
        }
    }

    fn check_together(&self, found: &mut Problems) {
        let Self { start, end, min_step, max_step, integrator, .. } = *self;
        if end <= start {
            found.add(("end", &["start"]), &Plain(end), format!("a time after start = {}, s", Plain(start)));
        }
        if self.step.is_none() && !integrator.row().adaptive {
            found.add(("step", &["integrator"]), &"nothing", format!("the length of its steps, s: {integrator} has no error estimate"));
        }
        if self.rtol + self.atol == 0.0 {
            found.add(("rtol", &["atol"]), &0, "one of rtol and atol greater than 0");
        }
        if max_step < min_step {
            found.add(("max_step", &["min_step"]), &Plain(max_step), format!("at least min_step = {}, s", Plain(min_step)));
        }
        let least = self.least_step();
        for (key, step) in [("step", self.step), ("max_step", Some(max_step))] {
            if let Some(step) = step.filter(|step| *step < least) {
                found.add((key, TIMES), &Plain(step), of_rounding(least));
            }
        }
    }

    fn check_output(&self, shape: Shape, found: &mut Problems) {
        match &self.output {
            Output::Every(s) => self.check_every(*s, shape, found),
            Output::At(times) => {
                let (start, end) = (self.start, self.end);
                if let Some(outside) = times.iter().find(|t| !(start..=end).contains(*t)) {
                    let right = format!("times from start = {} to end = {}", Plain(start), Plain(end));
                    found.add(("output", TIMES), &format!("{} among the times", Plain(*outside)), right);
                }
                if let Some(w) = times.windows(2).find(|w| w[1] <= w[0]) {
                    found.add(("output", &[]), &format!("{} after {}", Plain(w[1]), Plain(w[0])), "times in order");
                }
            }
            Output::Steps | Output::Ends => {}
        }
    }

    /// Checks that records are distinct in time, and that memory suffices for them.
    fn check_every(&self, every: f64, shape: Shape, found: &mut Problems) {
        // t, q, v, τ, five energies, momentum
        let each = (1 + shape.nq + 2 * shape.nv + 5 + 6) as f64;
        let (rounding, room) = (self.least_step(), (self.end - self.start) * each / MOST_RECORDED);
        if every < rounding.max(room) {
            let of_room = || format!("at least {} s, for no more than {MOST_RECORDED:e} numbers in all, {each} per record", short(room));
            found.add(("output", TIMES), &Plain(every), if rounding > room { of_rounding(rounding) } else { of_room() });
        }
    }
}

fn of_rounding(least: f64) -> String {
    format!("at least {least:.1e} s, sixteen units of rounding of the time")
}

/// To four digits.
fn short(x: f64) -> Plain {
    Plain(format!("{x:.3e}").parse().unwrap_or(x))
}

struct Problems(Vec<SettingError>);

impl Problems {
    /// Adds an error, unless its key, or one that it conflicts with, has one already.
    fn add(&mut self, (key, with): (&'static str, &'static [&'static str]), found: &dyn fmt::Display, right: impl Into<String>) {
        if !self.0.iter().any(|told| told.key == key || with.contains(&told.key)) {
            self.0.push(SettingError { key, with, found: found.to_string(), right: right.into() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn every_bad_setting_is_named_at_once() {
        let shape = Shape { nq: 1, nv: 1, frames: 1, links: 1, ..Shape::default() };
        assert_eq!(Settings::default().problems(shape), []);
        let bad = Settings {
            start: f64::NAN,
            end: f64::INFINITY,
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
        assert_eq!(fixed.problems(shape)[0].to_string(), "step = nothing: the length of its steps, s: rk4 has no error estimate");
    }

    #[test]
    fn a_step_that_the_time_cannot_take_is_refused() {
        let shape = Shape { nq: 1, nv: 1, frames: 1, links: 1, ..Shape::default() };
        let at = |start: f64, end: f64| {
            let settings =
                Settings { integrator: IntegratorId::rk4, step: Some(0.25), start, end, output: Output::Ends, ..Settings::default() };
            settings.problems(shape).iter().map(|p| p.key).collect::<Vec<_>>()
        };
        // Near 1e15 s the time is a multiple of 1/8 s, near 1e12 s of 1/8192 s.
        assert_eq!([at(1e15, 1e15 + 4.0), at(1e12, 1e12 + 4.0)], [vec!["step"], vec![]]);
        // The end that is farther from zero counts.
        assert_eq!([at(-1e15, 4.0), at(-4.0, 1e15)], [vec!["step"], vec!["step"]]);
        let settings = Settings { integrator: IntegratorId::rk4, ..Settings::default() };
        let least = settings.least_step();
        for (step, told) in [(least, 0), (0.999 * least, 1)] {
            assert_eq!(Settings { step: Some(step), ..settings.clone() }.problems(shape).len(), told, "{step:e}");
        }
    }

    /// As many numbers as memory allows, whatever the robot; and no two records at one time.
    #[test]
    fn records_are_as_many_as_there_is_room_and_time_for() {
        let told = |nv: usize, start: f64, every: f64| {
            let settings = Settings { start, end: start + 10.0, output: Output::Every(every), ..Settings::default() };
            let problems = settings.problems(Shape { nq: nv, nv, frames: 1, links: 1, ..Shape::default() });
            problems.first().map(ToString::to_string).unwrap_or_default()
        };
        assert_eq!(told(1, 0.0, 2e-7), "");
        assert_eq!(told(100, 0.0, 2e-7), "output = 2e-7: at least 3.12e-6 s, for no more than 1e9 numbers in all, 312 per record");
        assert_eq!(told(1, 1e9, 1e-6), "output = 1e-6: at least 3.6e-6 s, sixteen units of rounding of the time");
    }

    #[test]
    fn what_does_not_go_together_is_named() {
        let shape = Shape { nq: 1, nv: 1, frames: 1, links: 1, ..Shape::default() };
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
            ("rtol", Settings { rtol: 1.0, ..right.clone() }),
            ("rtol", Settings { rtol: 0.0, atol: 0.0, ..right.clone() }),
            ("atol_each", Settings { atol_each: vec![1e-9, -1e-9], ..right.clone() }),
            ("atol_each", Settings { atol_each: vec![1e-9, f64::INFINITY], ..right.clone() }),
            ("end", Settings { end: 1.0, output: Output::Ends, ..right.clone() }),
            ("end", Settings { end: f64::NAN, ..right.clone() }),
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
