//! `[initial]`: the state that a simulation starts from.

use articulated_core::algorithm;
use articulated_core::description::Base;
use articulated_core::diagnostic::{At, Code, Diagnostics};
use articulated_core::model::{FLOATING_BASE, Model};
use articulated_core::spatial::normalise_input;

use crate::edits::{coordinates, name};
use crate::scene::Scene;
use crate::slots::Side;
use crate::table::{Cursor, Row};
use crate::tree::Value;
use crate::world::RobotInWorld;

/// The state at the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Initial {
    /// Coordinates, rad or m.
    pub q: Coordinates,
    /// Rates, rad/s or m/s.
    pub v: Coordinates,
    /// Pose and velocity of a floating base.
    pub base: Option<BaseState>,
    /// The state of the robot's file that the others change, and where the scene names it.
    pub keyframe: Option<(String, At)>,
}

/// Numbers of joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Coordinates {
    /// 0; the identity for a quaternion.
    #[default]
    Neutral,
    /// All of them, in the order of the robot.
    All {
        /// The numbers.
        values: Vec<f64>,
        /// Place of the list in the scene.
        place: At,
    },
    /// Those of some joints; the others are neutral.
    Named(Vec<Named>),
}

impl Coordinates {
    /// The place of a joint's coordinates in the scene.
    pub(crate) fn place(&self, joint: &str) -> At {
        match self {
            Self::All { place, .. } => *place,
            Self::Named(named) => named.iter().find(|n| n.joint == joint).map_or(At::Nowhere, |n| n.place),
            Self::Neutral => At::Nowhere,
        }
    }
}

/// The numbers of one joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Named {
    /// The joint.
    pub joint: String,
    /// As many as it has.
    pub values: Vec<f64>,
    /// Place in the scene.
    pub place: At,
}

/// Place and velocity of a floating base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseState {
    /// Its origin in the world frame, m.
    pub xyz: [f64; 3],
    /// Its orientation, x, y, z, w, of norm one.
    pub quaternion: [f64; 4],
    /// Angular velocity in its own axes, rad/s.
    pub angular: [f64; 3],
    /// Velocity of its origin in its own axes, m/s.
    pub linear: [f64; 3],
    /// Place in the scene.
    pub place: At,
}

impl Default for BaseState {
    fn default() -> Self {
        Self { xyz: [0.0; 3], quaternion: [0.0, 0.0, 0.0, 1.0], angular: [0.0; 3], linear: [0.0; 3], place: At::Nowhere }
    }
}

pub(crate) const KEYS: &[Row<Initial>] = &[
    Row {
        name: "q",
        required: false,
        value: "numbers, or table: joint = number or numbers; rad, m",
        default: "those of the robot's file (MJCF), or else 0",
        what: "coordinates: all in the robot's order (a floating base's position and quaternion x, y, z, w first), or by joint",
        read: |x, s, log| x.q = values(s, log),
    },
    Row {
        name: "v",
        required: false,
        value: "numbers, or table: joint = number or numbers; rad/s, m/s",
        default: "0",
        what: "rates: all in the robot's order (a floating base's ω and v in its own axes first), or by joint",
        read: |x, s, log| x.v = values(s, log),
    },
    Row {
        name: "keyframe",
        required: false,
        value: "text",
        default: "none",
        what: "a state of the robot's file (MJCF), which `q`, `v` and `base` change",
        read: |x, s, log| x.keyframe = name(s, log, "the name of a keyframe of the robot's file").map(|name| (name, s.at)),
    },
    Row {
        name: "base",
        required: false,
        value: "table",
        default: "at the origin, at rest",
        what: "a floating base, see below",
        read: |x, s, log| {
            let mut base = BaseState { place: s.at, ..BaseState::default() };
            s.read(BASE, &mut base, log);
            if let (Some(_), Some(spot)) = (s.get("rpy"), s.get("quaternion")) {
                spot.clash(log, "rpy and quaternion", "one of them");
            }
            x.base = Some(base);
        },
    },
];

pub(crate) const BASE: &[Row<BaseState>] = &[
    Row {
        name: "xyz",
        required: false,
        value: "3 numbers, m",
        default: "[0, 0, 0]",
        what: "its origin in the world frame",
        read: |b, s, log| b.xyz = s.numbers(log).unwrap_or_default(),
    },
    Row {
        name: "rpy",
        required: false,
        value: "3 numbers, rad",
        default: "[0, 0, 0]",
        what: "roll, pitch, yaw about fixed axes",
        read: |b, s, log| b.quaternion = s.numbers(log).map_or(b.quaternion, from_rpy),
    },
    Row {
        name: "quaternion",
        required: false,
        value: "4 numbers, 1",
        default: "[0, 0, 0, 1]",
        what: "its orientation, x, y, z, w, of norm one; instead of `rpy`",
        read: |b, s, log| b.quaternion = unit(s, log).unwrap_or(b.quaternion),
    },
    Row {
        name: "angular",
        required: false,
        value: "3 numbers, rad/s",
        default: "[0, 0, 0]",
        what: "angular velocity in its own axes",
        read: |b, s, log| b.angular = s.numbers(log).unwrap_or_default(),
    },
    Row {
        name: "linear",
        required: false,
        value: "3 numbers, m/s",
        default: "[0, 0, 0]",
        what: "velocity of its origin in its own axes",
        read: |b, s, log| b.linear = s.numbers(log).unwrap_or_default(),
    },
];

pub(crate) fn read(spot: &Cursor<'_>, log: &mut Diagnostics) -> Initial {
    let mut initial = Initial::default();
    spot.read(KEYS, &mut initial, log);
    base_once(&initial.q, "q", &["xyz", "rpy", "quaternion"], spot, log);
    base_once(&initial.v, "v", &["angular", "linear"], spot, log);
    initial
}

/// A list contains the numbers of a floating base, so `base` must not give them again.
fn base_once(coordinates: &Coordinates, key: &str, of_base: &[&str], initial: &Cursor<'_>, log: &mut Diagnostics) {
    let has_base = match coordinates {
        Coordinates::Neutral => false,
        Coordinates::All { .. } => true,
        Coordinates::Named(named) => named.iter().any(|one| one.joint == FLOATING_BASE),
    };
    let (Some(spot), Some(base)) = (initial.get(key).filter(|_| has_base), initial.get("base")) else { return };
    if let Some(there) = of_base.iter().find_map(|name| base.get(name)) {
        spot.clash(log, format!("numbers of the base, and {}", there.key), "one of them");
    }
}

pub(crate) fn values(spot: &Cursor<'_>, log: &mut Diagnostics) -> Coordinates {
    match &spot.node.value {
        Value::List(_) => {
            spot.some_numbers(log, "numbers").map_or(Coordinates::Neutral, |values| Coordinates::All { values, place: spot.node.at })
        }
        Value::Table(entries) => Coordinates::Named(
            entries
                .iter()
                .filter_map(|e| Some(Named { joint: e.name.clone(), values: coordinates(&spot.of(e), log)?, place: e.at }))
                .collect(),
        ),
        _ => {
            spot.wrong(log, "a list of numbers, or a table of joints, as { elbow = 0.5 }");
            Coordinates::Neutral
        }
    }
}

/// R = Rz(yaw)·Ry(pitch)·Rx(roll).
fn from_rpy(rpy: [f64; 3]) -> [f64; 4] {
    let [(sr, cr), (sp, cp), (sy, cy)] = rpy.map(|x| (x / 2.0).sin_cos());
    [sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy]
}

fn unit(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<[f64; 4]> {
    let mut quaternion: [f64; 4] = spot.numbers(log)?;
    if let Err(norm) = normalise_input(&mut quaternion) {
        spot.bad(log, format!("a quaternion of norm {norm:.4}"), "norm one, in the order x, y, z, w");
        return None;
    }
    Some(quaternion)
}

impl Scene {
    /// The initial state: q `[nq]`, v `[nv]`. Errors, all at once: unknown joints, wrong numbers of
    /// coordinates, a base that does not float.
    pub fn start<'a>(&self, robot: impl Into<RobotInWorld<'a>>) -> Result<(Vec<f64>, Vec<f64>), Diagnostics> {
        let mut log = Diagnostics::new(&self.file);
        let state = self.started(robot.into(), &mut log);
        log.result(state)
    }

    pub(crate) fn started(&self, robot: RobotInWorld<'_>, log: &mut Diagnostics) -> (Vec<f64>, Vec<f64>) {
        let model = robot.model;
        let mut q = neutral(model);
        let mut v = vec![0.0; model.nv()];
        if let Some(home) = &robot.world.home {
            robot.put(&home.q, false, &mut q);
            robot.put(&home.v, true, &mut v);
        }
        if let Some((name, place)) = &self.initial.keyframe
            && let Some(keyframe) = robot.keyframe(name, (*place, "initial.keyframe"), log)
        {
            robot.put(&keyframe.q, false, &mut q);
            robot.put(&keyframe.v, true, &mut v);
        }
        self.place_base(model, (&mut q, &mut v), log);
        fill(&self.initial.q, "initial.q", model, Side::Q, &mut q, log);
        fill(&self.initial.v, "initial.v", model, Side::V, &mut v, log);
        normalise(model, &mut q, ("initial.q", &|joint| self.initial.q.place(joint)), log);
        (q, v)
    }

    fn place_base(&self, model: &Model<f64>, (q, v): (&mut [f64], &mut [f64]), log: &mut Diagnostics) {
        let Some(base) = &self.initial.base else { return };
        if model.joints().first().is_none_or(|j| j.name != FLOATING_BASE) {
            let fixed = if self.base == Some(Base::Floating) { "a robot without a floating base" } else { "a base that is fixed" };
            log.error((base.place, "initial.base"), Code::Robot, fixed, "base = \"floating\", or no initial.base");
            return;
        }
        q[..3].copy_from_slice(&base.xyz);
        q[3..7].copy_from_slice(&base.quaternion);
        v[..3].copy_from_slice(&base.angular);
        v[3..6].copy_from_slice(&base.linear);
    }
}

/// The neutral configuration, `[nq]`.
pub(crate) fn neutral(model: &Model<f64>) -> Vec<f64> {
    let mut q = vec![0.0; model.nq()];
    algorithm::neutral(model, &mut q);
    q
}

/// Writes the scene's numbers into `into`, `[nq]` or `[nv]`.
pub(crate) fn fill(from: &Coordinates, key: &str, model: &Model<f64>, side: Side, into: &mut [f64], log: &mut Diagnostics) {
    match from {
        Coordinates::Neutral => {}
        Coordinates::All { values, .. } if values.len() == into.len() => into.copy_from_slice(values),
        Coordinates::All { values, place } => {
            log.error((*place, key), Code::Number, counted(values.len()), format!("{} for this robot", counted(into.len())));
        }
        Coordinates::Named(named) => named.iter().for_each(|one| put(one, key, model, side, into, log)),
    }
}

fn put(one: &Named, key: &str, model: &Model<f64>, side: Side, into: &mut [f64], log: &mut Diagnostics) {
    let key = format!("{key}.{}", crate::table::bare(&one.joint));
    let Some(joint) = model.joints().iter().find(|j| j.name == one.joint) else {
        no_joint(log, one.place, &key, &one.joint, model);
        return;
    };
    let (first, count) = if side == Side::Q { joint.q } else { joint.v };
    match one.values.len() {
        found if found == count => into[first..first + count].copy_from_slice(&one.values),
        found => {
            log.error((one.place, &key), Code::Number, counted(found), format!("{} for a {} joint", counted(count), joint.kind.name()));
        }
    }
}

pub(crate) fn counted(n: usize) -> String {
    if n == 1 { "one number".into() } else { format!("{n} numbers") }
}

/// Reports that no joint with coordinates has the name.
pub(crate) fn no_joint(log: &mut Diagnostics, at: At, key: &str, name: &str, model: &Model<f64>) {
    if model.bodies().iter().any(|body| body.name == name && body.coordinates.mimic.is_some()) {
        return log.error((at, key), Code::Robot, "a joint that follows another", "the joint that it follows, whose coordinates it has");
    }
    let names = model.joints().iter().map(|j| j.name.as_str());
    log.unknown(((at, key), Code::UnknownName), ("a joint that is not there, or is locked".into(), name), "a joint that moves", names);
}

/// Normalises quaternions; `place`: where those of a joint are given.
pub(crate) fn normalise(model: &Model<f64>, q: &mut [f64], (key, place): (&str, &dyn Fn(&str) -> At), log: &mut Diagnostics) {
    for (joint, quaternion) in model.joints().iter().filter_map(|j| Some((j, j.quaternion()?))) {
        if let Err(norm) = normalise_input(&mut q[quaternion]) {
            let found = format!("a quaternion of norm {norm:.4} for joint {:?}", joint.name);
            log.error((place(&joint.name), key), Code::Number, found, "norm one, in the order x, y, z, w");
        }
    }
}
