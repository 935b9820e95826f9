//! `[simulation]`: start and end time, integrator, accuracy and outputs.

use articulated_core::diagnostic::{At, Code, Diagnostics};
use std::iter;

use articulated_core::algorithm::Shape;
use articulated_core::integrator::{IntegratorId, integrators, resolve_synonym};
use articulated_core::settings::{Output, SettingError, Settings, Stiffness};

use crate::table::{Cursor, Row};
use crate::tree::Value;

/// How to simulate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Simulation {
    /// Integrator, start and end time, accuracy and outputs.
    pub settings: Settings,
    /// Events to detect.
    pub events: Vec<EventClass>,
    /// Whether the scene names its integrator.
    /// [`Scene::default_integrator`](crate::Scene::default_integrator) is taken otherwise.
    pub names_integrator: bool,
    /// Whether the fixed step is that of the robot's file, and the place of this setting.
    pub file_step: Option<At>,
    /// The law of limits, dry friction, equations and contacts of the robot's file, if they act,
    /// and the place of this setting. Steps are then whole, by the method of the file.
    pub law: Option<(Law, At)>,
}

/// Laws of what touches and holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// That of MuJoCo.
    Mujoco,
}

const LAWS: &[(&str, Law)] = &[("mujoco", Law::Mujoco)];

/// Keys that say nothing of steps by a law.
const WITHOUT_LAW: [&str; 9] =
    ["integrator", "rtol", "atol", "min_step", "max_step", "first_step", "events", "event_tolerance", "stiffness"];

/// Kinds of events to detect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventClass {
    /// Joints that reach a bound.
    Limits,
    /// Contacts made and lost.
    Contacts,
    /// Joints with dry friction that come to rest or start.
    StickSlip,
}

impl EventClass {
    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        EVENT_CLASSES.iter().find(|(_, w)| *w == self).map_or("", |(name, _)| name)
    }
}

const EVENT_CLASSES: &[(&str, EventClass)] =
    &[("limits", EventClass::Limits), ("contacts", EventClass::Contacts), ("stick_slip", EventClass::StickSlip)];
const STIFFNESS: &[(&str, Stiffness)] = &[("refuse", Stiffness::Refuse), ("note", Stiffness::Note), ("ignore", Stiffness::Ignore)];

pub(crate) const KEYS: &[Row<Simulation>] = &[
    Row {
        name: "start",
        required: false,
        value: "number, s",
        default: "0",
        what: "time at the start",
        read: |x, s, log| set(&mut x.settings.start, s.any(log)),
    },
    Row {
        name: "end",
        required: true,
        value: "number, s",
        default: "",
        what: "time at the end, after the start",
        read: |x, s, log| set(&mut x.settings.end, s.any(log)),
    },
    Row {
        name: "integrator",
        required: false,
        value: "`\"semi_implicit_euler\"`, `\"rk4\"`, `\"dopri5\"`, `\"dop853\"`, `\"rodas4\"` or `\"lie_midpoint\"`",
        default: "`\"rodas4\"` with an effect `friction` or `contact`, else `\"dopri5\"`",
        what: "the integrator",
        read: |x, s, log| {
            x.names_integrator = true;
            set(&mut x.settings.integrator, integrator(s, log));
        },
    },
    Row {
        name: "law",
        required: false,
        value: "`\"mujoco\"`",
        default: "none: the effects of the scene alone",
        what: "limits, dry friction, equations and contacts of the robot's file (MJCF) act by this law, in steps by the method of the file; not beside `integrator`, tolerances, `events` and `stiffness`",
        read: |x, s, log| x.law = s.word(log, LAWS).map(|law| (law, s.at)),
    },
    Row {
        name: "step",
        required: false,
        value: "number, s, or `\"file\"`",
        default: "chosen by the errors; that of the robot's file with a `law`; has to be given for `semi_implicit_euler`, `rk4` and `lie_midpoint`",
        what: "length of all steps, above 0, and more than the time's rounding; `\"file\"`: that of the robot's file (MJCF)",
        read: |x, s, log| match &s.node.value {
            Value::Text(word) if word == "file" => x.file_step = Some(s.at),
            _ => x.settings.step = s.any(log),
        },
    },
    Row {
        name: "rtol",
        required: false,
        value: "number, 1",
        default: "1e-6",
        what: "error of a step, in parts of the state: 0, or at least 1e-15 and below 1",
        read: |x, s, log| set(&mut x.settings.rtol, s.any(log)),
    },
    Row {
        name: "atol",
        required: false,
        value: "number, rad, m, rad/s, m/s",
        default: "1e-9",
        what: "error of a step beside that, at least 0; not 0 where `rtol` is",
        read: |x, s, log| set(&mut x.settings.atol, s.any(log)),
    },
    Row {
        name: "min_step",
        required: false,
        value: "number, s",
        default: "what the clock can tell",
        what: "no step by tolerance is shorter, but for what is left of a stretch, at least 0",
        read: |x, s, log| set(&mut x.settings.min_step, s.any(log)),
    },
    Row {
        name: "max_step",
        required: false,
        value: "number, s",
        default: "no bound",
        what: "no step by tolerance is longer, above 0 and at least `min_step`",
        read: |x, s, log| set(&mut x.settings.max_step, s.any(log)),
    },
    Row {
        name: "first_step",
        required: false,
        value: "number, s",
        default: "chosen",
        what: "the first step, by tolerance, above 0",
        read: |x, s, log| x.settings.first_step = s.any(log),
    },
    Row {
        name: "max_steps",
        required: false,
        value: "whole number, 1 to 1099511627776",
        default: "10000000",
        what: "more are not made",
        read: |x, s, log| set(&mut x.settings.max_steps, s.whole(log, 1, 1 << 40)),
    },
    Row {
        name: "output",
        required: false,
        value: "number, s; numbers, s; `\"steps\"` or `\"ends\"`",
        default: "0.01",
        what: "how often the state is recorded, above 0 and for at most 1e9 numbers in all (records times numbers per record), or when: the times, in order, after each step, at the ends",
        read: |x, s, log| set(&mut x.settings.output, output(s, log)),
    },
    Row {
        name: "events",
        required: false,
        value: "list of `\"limits\"`, `\"contacts\"`, `\"stick_slip\"`",
        default: "none",
        what: "what is looked for on the way and recorded: joints at the bounds of their effect `limit`, or else of the robot's file; every effect `contact`; every effect `friction`",
        read: |x, s, log| x.events = events(s, log),
    },
    Row {
        name: "event_tolerance",
        required: false,
        value: "number, s",
        default: "1e-12",
        what: "how exactly events are found, at least 0",
        read: |x, s, log| set(&mut x.settings.event_tolerance, s.any(log)),
    },
    Row {
        name: "stiffness",
        required: false,
        value: "`\"refuse\"`, `\"note\"` or `\"ignore\"`",
        default: "`\"refuse\"`",
        what: "what happens where an explicit integrator is outside its stable step; with steps by tolerance `\"refuse\"` ends a motion only where more than 20 000 such steps would be left; `\"ignore\"` does not look",
        read: |x, s, log| set(&mut x.settings.stiffness, s.word(log, STIFFNESS)),
    },
];

/// The value, if there is a right one.
pub(crate) fn set<T>(into: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *into = value;
    }
}

pub(crate) fn read(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Simulation> {
    let mut simulation = Simulation::default();
    let before = log.count();
    spot.read(KEYS, &mut simulation, log);
    let right = log.right(&spot.key, KEYS.iter().map(|row| row.name), before);
    let mut settings = simulation.settings.clone();
    if simulation.file_step.is_some() {
        settings.step = Some(A_STEP * (settings.end - settings.start));
    }
    check(&settings, spot, &right, log);
    (log.count() == before).then_some(simulation)
}

/// Reports invalid settings, each if all keys that it concerns are `right`: at its key, or else at
/// a key that conflicts with it.
fn check(settings: &Settings, spot: &Cursor<'_>, right: &[&str], log: &mut Diagnostics) {
    for SettingError { key, with, found, right: expected } in settings.problems(ANY_ROBOT) {
        let mut about = iter::once(&key).chain(with);
        if about.clone().all(|key| right.contains(key)) {
            let at = about.find_map(|key| spot.get(key)).map_or(spot.at, |there| there.at);
            let kind = if with.is_empty() { Code::Number } else { Code::Together };
            log.error((at, &format!("{}.{key}", spot.key)), kind, found, expected);
        }
    }
    if spot.get("law").is_some() {
        for spot in WITHOUT_LAW.into_iter().filter_map(|key| spot.get(key)) {
            spot.clash(log, format!("{} beside a law", spot.key), "no such key: steps are those of the robot's file");
        }
    }
    if spot.get("step").is_some() {
        for spot in ["min_step", "max_step", "first_step", "rtol", "atol"].into_iter().filter_map(|key| spot.get(key)) {
            spot.clash(log, "a fixed step and what is for steps by tolerance", "no step, or no such key");
        }
    }
}

/// A step that no check refuses, in parts of the motion: only the robot's file has the right one.
const A_STEP: f64 = 1e-3;

/// Outputs of the smallest robot fit every robot.
const ANY_ROBOT: Shape = Shape { nq: 0, nv: 0, frames: 0, links: 0, controls: 0, activations: 0, contacts: 0, given: 0 };

fn integrator(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<IntegratorId> {
    spot.word_like(log, &words(), |found| resolve_synonym(found).map_or(found, |row| row.name))
}

/// Names of the integrators in scenes.
fn words() -> Vec<(&'static str, IntegratorId)> {
    integrators().iter().map(|row| (row.name, row.id)).collect()
}

fn output(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Output> {
    match &spot.node.value {
        Value::Text(_) => spot.word(log, &[("steps", 0), ("ends", 1)]).map(|i| [Output::Steps, Output::Ends][i].clone()),
        Value::List(_) => spot.some_numbers(log, "times, s").map(Output::At),
        _ => spot.any(log).map(Output::Every),
    }
}

fn events(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<EventClass> {
    let Some(list) = spot.list() else {
        spot.wrong(log, "a list of events, as [\"limits\"]");
        return Vec::new();
    };
    let mut events: Vec<EventClass> = Vec::new();
    for item in &list {
        match item.word(log, EVENT_CLASSES) {
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
