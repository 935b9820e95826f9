//! `[simulation]`: from when to when, by which integrator, how exactly, and what is recorded.

use articulated_core::integrator::{IntegratorId, integrators, least_step, meant};

use crate::error::Kind;
use crate::log::Log;
use crate::table::{Row, Spot};
use crate::tree::Value;

/// How to simulate.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Time at the start, s.
    pub start: f64,
    /// Time at the end, s.
    pub end: f64,
    /// The integrator.
    pub integrator: IntegratorId,
    /// Steps of this length, s; `None`: chosen by the integrator, if it can.
    pub step: Option<f64>,
    /// Error of a step, in parts of the state.
    pub rtol: f64,
    /// Error of a step beside that, in units of the state.
    pub atol: f64,
    /// No step is shorter, s, but the last; 0: what the clock can tell.
    pub min_step: f64,
    /// No step is longer, s; infinite where the scene does not say.
    pub max_step: f64,
    /// The first step, s; `None`: chosen.
    pub first_step: Option<f64>,
    /// So many steps at most.
    pub max_steps: u64,
    /// When the state is recorded.
    pub output: Output,
    /// How exactly events are found, s.
    pub event_tolerance: f64,
    /// What is looked for on the way.
    pub events: Vec<Watched>,
    /// What happens where an explicit integrator is outside its stable step.
    pub stiffness: Stiffness,
}

/// When the state is recorded.
#[derive(Clone, Debug, PartialEq)]
pub enum Output {
    /// At the start and every so many seconds.
    Every(f64),
    /// At these times, s, in order.
    At(Vec<f64>),
    /// After each step.
    Steps,
    /// At the start and the end.
    Ends,
}

/// What is looked for on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Watched {
    /// Joints that reach a bound.
    Limits,
    /// Contacts made and lost.
    Contacts,
    /// Joints with dry friction that come to rest or start.
    StickSlip,
}

/// What happens where an explicit integrator is outside its stable step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Stiffness {
    /// The simulation ends with an error that says so.
    #[default]
    Refuse,
    /// It is noted.
    Note,
}

impl Watched {
    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        WATCHED.iter().find(|(_, w)| *w == self).map_or("", |(name, _)| name)
    }
}

const WATCHED: &[(&str, Watched)] = &[("limits", Watched::Limits), ("contacts", Watched::Contacts), ("stick_slip", Watched::StickSlip)];
const STIFFNESS: &[(&str, Stiffness)] = &[("refuse", Stiffness::Refuse), ("note", Stiffness::Note)];

impl Default for Simulation {
    fn default() -> Self {
        Self {
            start: 0.0,
            end: 1.0,
            integrator: IntegratorId::dopri5,
            step: None,
            rtol: 1e-6,
            atol: 1e-9,
            min_step: 0.0,
            max_step: f64::INFINITY,
            first_step: None,
            max_steps: 10_000_000,
            output: Output::Every(0.01),
            event_tolerance: 1e-12,
            events: Vec::new(),
            stiffness: Stiffness::Refuse,
        }
    }
}

pub(crate) const KEYS: &[Row<Simulation>] = &[
    Row {
        name: "start",
        required: false,
        value: "number, s",
        default: "0",
        what: "time at the start",
        read: |x, s, log| set(&mut x.start, s.number(log)),
    },
    Row {
        name: "end",
        required: true,
        value: "number, s",
        default: "",
        what: "time at the end, after the start",
        read: |x, s, log| set(&mut x.end, s.number(log)),
    },
    Row {
        name: "integrator",
        required: false,
        value: "`\"semi_implicit_euler\"`, `\"rk4\"`, `\"dopri5\"`, `\"dop853\"`, `\"rodas4\"` or `\"lie_midpoint\"`",
        default: "`\"dopri5\"`",
        what: "the integrator",
        read: |x, s, log| set(&mut x.integrator, integrator(s, log)),
    },
    Row {
        name: "step",
        required: false,
        value: "number, s",
        default: "chosen by the errors; has to be given for `semi_implicit_euler`, `rk4` and `lie_midpoint`",
        what: "length of all steps, above 0, and more than the time's rounding",
        read: |x, s, log| x.step = s.positive(log),
    },
    Row {
        name: "rtol",
        required: false,
        value: "number, 1",
        default: "1e-6",
        what: "error of a step, in parts of the state: 0, or at least 1e-15 and below 1",
        read: |x, s, log| set(&mut x.rtol, part(s, log)),
    },
    Row {
        name: "atol",
        required: false,
        value: "number, rad, m, rad/s, m/s",
        default: "1e-9",
        what: "error of a step beside that, at least 0; not 0 where `rtol` is",
        read: |x, s, log| set(&mut x.atol, s.not_negative(log)),
    },
    Row {
        name: "min_step",
        required: false,
        value: "number, s",
        default: "what the clock can tell",
        what: "no step by tolerance is shorter, but for what is left of a stretch, at least 0",
        read: |x, s, log| set(&mut x.min_step, s.not_negative(log)),
    },
    Row {
        name: "max_step",
        required: false,
        value: "number, s",
        default: "no bound",
        what: "no step by tolerance is longer, above 0 and above `min_step`",
        read: |x, s, log| set(&mut x.max_step, s.positive(log)),
    },
    Row {
        name: "first_step",
        required: false,
        value: "number, s",
        default: "chosen",
        what: "the first step, by tolerance, above 0",
        read: |x, s, log| x.first_step = s.positive(log),
    },
    Row {
        name: "max_steps",
        required: false,
        value: "whole number, 1 to 1099511627776",
        default: "10000000",
        what: "more are not made",
        read: |x, s, log| set(&mut x.max_steps, s.whole(log, 1, 1 << 40)),
    },
    Row {
        name: "output",
        required: false,
        value: "number, s; numbers, s; `\"steps\"` or `\"ends\"`",
        default: "0.01",
        what: "how often the state is recorded, above 0 and for at most 1e9 numbers in all (records times numbers per record), or when: the times, in order, after each step, at the ends",
        read: |x, s, log| set(&mut x.output, output(s, log)),
    },
    Row {
        name: "events",
        required: false,
        value: "list of `\"limits\"`, `\"contacts\"`, `\"stick_slip\"`",
        default: "none",
        what: "what is looked for on the way and recorded: joints at the bounds of their effect `limit`, or else of the URDF; every effect `contact`; every effect `friction`",
        read: |x, s, log| x.events = events(s, log),
    },
    Row {
        name: "event_tolerance",
        required: false,
        value: "number, s",
        default: "1e-12",
        what: "how exactly events are found, at least 0",
        read: |x, s, log| set(&mut x.event_tolerance, s.not_negative(log)),
    },
    Row {
        name: "stiffness",
        required: false,
        value: "`\"refuse\"` or `\"note\"`",
        default: "`\"refuse\"`",
        what: "what happens where an explicit integrator is outside its stable step; with steps by tolerance `\"refuse\"` ends a motion only where more than 20 000 such steps would be left",
        read: |x, s, log| set(&mut x.stiffness, s.word(log, STIFFNESS)),
    },
];

/// The value, if there is a right one.
pub(crate) fn set<T>(into: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *into = value;
    }
}

pub(crate) fn read(spot: &Spot<'_>, log: &mut Log) -> Option<Simulation> {
    let mut simulation = Simulation::default();
    let before = log.count();
    spot.read(KEYS, &mut simulation, log);
    let right = log.right(&spot.key, KEYS.iter().map(|row| row.name), before);
    check(&simulation, spot, &right, log);
    (log.count() == before).then_some(simulation)
}

impl Simulation {
    /// A sample ends a step: samples that time can tell apart, and no more than there may be steps.
    pub(crate) fn check_period(&self, period: f64, spot: &Spot<'_>, log: &mut Log) {
        let (least, shortest) = (least_step(self.start, self.end), (self.end - self.start) / self.max_steps as f64);
        if period < least {
            spot.clash(log, format!("{period:?}"), format!("at least {least:.1e} s, sixteen units of rounding of the time"));
        } else if period < shortest {
            let most = self.max_steps;
            spot.clash(log, format!("{period:?}"), format!("at least {shortest:.1e} s, for no more samples than max_steps = {most}"));
        }
    }
}

/// What numbers have to be together, each where what it is about is `right`.
fn check(x: &Simulation, spot: &Spot<'_>, right: &[&str], log: &mut Log) {
    let key = |name: &str| spot.get(name);
    let right = |names: &[&str]| names.iter().all(|name| right.contains(name));
    let Simulation { start, end, .. } = x;
    if right(&["start", "end"])
        && end <= start
        && let Some(spot) = key("end")
    {
        spot.clash(log, format!("{end:?}, not after the start, {start:?}"), format!("a time above {start:?} s"));
    }
    if right(&["step", "integrator"]) && x.step.is_none() && !x.integrator.row().adaptive {
        let (name, at) = (x.integrator.name(), key("integrator").map_or(spot.at, |s| s.at));
        log.error(at, &spot.key, Kind::MissingKey, format!("no step for {name:?}"), "step: the length of its steps, s");
    }
    if key("step").is_some() {
        for spot in ["min_step", "max_step", "first_step", "rtol", "atol"].into_iter().filter_map(key) {
            spot.clash(log, "a fixed step and what is for steps by tolerance", "no step, or no such key");
        }
    }
    if let (true, Some(spot)) = (right(&["rtol", "atol"]) && x.rtol == 0.0 && x.atol == 0.0, key("rtol")) {
        spot.clash(log, "rtol and atol both 0", "one of them above 0");
    }
    if let (true, Some(spot)) = (right(&["min_step", "max_step"]) && x.max_step < x.min_step, key("max_step")) {
        spot.clash(log, format!("{:?}, less than min_step, {:?}", x.max_step, x.min_step), "at least that");
    }
    if right(&["start", "end"]) {
        let least = least_step(*start, *end);
        for (name, step) in [("step", x.step), ("max_step", Some(x.max_step))] {
            if let (true, Some(step), Some(spot)) = (right(&[name]), step.filter(|step| *step < least), key(name)) {
                spot.clash(log, format!("{step:?}"), format!("at least {least:.1e} s, sixteen units of rounding of the time"));
            }
        }
    }
    if right(&["start", "end", "output"]) {
        check_output(x, spot, log);
    }
}

/// Times of output against the start and the end.
fn check_output(x: &Simulation, spot: &Spot<'_>, log: &mut Log) {
    let Simulation { start, end, .. } = x;
    if let (Output::Every(every), Some(spot)) = (&x.output, spot.get("output").or(spot.get("end")))
        && end > start
        && (end - start) / every >= MOST_RECORDS
    {
        let found = format!("a record every {every:?} s up to {end:?} s, so {MOST_RECORDS:e} or more");
        spot.clash(log, found, "output: a longer time from one to the next");
    }
    if let (Output::At(times), Some(spot)) = (&x.output, spot.get("output")) {
        let outside = times.iter().find(|t| *t < start || *t > end);
        let back = times.windows(2).find(|w| w[1] <= w[0]);
        match (outside, back) {
            (Some(t), _) => spot.clash(log, format!("{t:?}"), format!("times from {start:?} s to {end:?} s")),
            (_, Some(w)) => spot.clash(log, format!("{:?} after {:?}", w[1], w[0]), "times in order"),
            _ => {}
        }
    }
}

/// So many times or more no state is recorded.
const MOST_RECORDS: f64 = 1e9;

/// A part of the state: nothing below 1e-15, which is rounding, but 0.
fn part(spot: &Spot<'_>, log: &mut Log) -> Option<f64> {
    let expected = "0, or at least 1e-15 and below 1";
    match spot.node.value {
        Value::Number(x) if x == 0.0 || (1e-15..1.0).contains(&x) => return Some(x),
        Value::Number(x) => spot.bad(log, format!("{x:?}"), expected),
        _ => spot.wrong(log, expected),
    }
    None
}

fn integrator(spot: &Spot<'_>, log: &mut Log) -> Option<IntegratorId> {
    spot.word_like(log, &words(), |found| meant(found).map_or(found, |row| row.name))
}

/// What scenes call the integrators.
fn words() -> Vec<(&'static str, IntegratorId)> {
    integrators().iter().map(|row| (row.name, row.id)).collect()
}

fn output(spot: &Spot<'_>, log: &mut Log) -> Option<Output> {
    match &spot.node.value {
        Value::Text(_) => spot.word(log, &[("steps", 0), ("ends", 1)]).map(|i| [Output::Steps, Output::Ends][i].clone()),
        Value::List(_) => spot.some_numbers(log, "times, s").map(Output::At),
        _ => spot.positive(log).map(Output::Every),
    }
}

fn events(spot: &Spot<'_>, log: &mut Log) -> Vec<Watched> {
    let Some(list) = spot.list() else {
        spot.wrong(log, "a list of events, as [\"limits\"]");
        return Vec::new();
    };
    let mut events: Vec<Watched> = Vec::new();
    for item in &list {
        match item.word(log, WATCHED) {
            Some(event) if events.contains(&event) => item.clash(log, format!("{:?} once more", event.name()), "each of them once"),
            event => events.extend(event),
        }
    }
    events
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manual_names_every_integrator_and_which_want_a_step() {
        let row = |name: &str| KEYS.iter().find(|row| row.name == name).unwrap();
        for one in integrators() {
            assert!(row("integrator").value.contains(&format!("`\"{}\"`", one.name)), "{}", one.name);
            assert_eq!(row("step").default.contains(&format!("`{}`", one.name)), !one.adaptive, "{}", one.name);
        }
    }
}
