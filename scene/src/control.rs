//! `[control]`: the controller of the joints.

use articulated_core::actuator::Actuators;
use articulated_core::control::{Aim, Controller, Signal};
use articulated_core::diagnostic::{At, Code, Diagnostics};
use articulated_core::effect::Range;
use articulated_core::model::{FLOATING_BASE, Model};

use crate::edits::{name, places};
use crate::initial::{Coordinates, Named, counted, fill, neutral, no_joint, normalise, values};
use crate::scene::Scene;
use crate::series::{Between, Reader, Source, unreadable};
use crate::simulation::set;
use crate::slots::{Side, Slots};
use crate::table::{Cursor, Row};
use crate::tree::Value;
use crate::world::RobotInWorld;

/// The controller of the joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Control {
    /// Its kind.
    pub drive: Drive,
    /// Sampling period, s, over which torques are held; `None`: continuous control.
    pub period: Option<f64>,
    /// Actuators, springs and dampers of tendons of the robot's file that are left out, each with
    /// its place in the scene.
    pub without: Vec<(String, At)>,
    /// Place of the control in the scene.
    pub place: At,
    /// The file of its table and its place in the scene, even if other keys are wrong.
    pub table: Option<(String, At)>,
}

/// Kinds of control.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Drive {
    /// No torque.
    #[default]
    None,
    /// Constant torques.
    Torque(PerJoint),
    /// Torques over time.
    Table(Source),
    /// τ = kp (target ⊖ q) + kd (target' − v) + torque.
    Pd {
        /// The target.
        target: Target,
        /// Gain of the position, N·m/rad or N/m.
        kp: PerJoint,
        /// Gain of the rate, N·m·s/rad or N·s/m.
        kd: PerJoint,
        /// Torque besides, N·m or N.
        torque: PerJoint,
    },
    /// The actuators of the robot's file.
    Actuators(Controls),
}

/// Controls of the actuators of the robot's file.
#[derive(Clone, Debug, PartialEq)]
pub enum Controls {
    /// Constant: the controls of a keyframe, or 0, then these values.
    Still {
        /// The state of the file, and where the scene names it.
        keyframe: Option<(String, At)>,
        /// Controls by actuator.
        control: Coordinates,
    },
    /// Over time.
    Moving(Source),
}

/// The target of a controller.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Coordinates that do not change.
    Still(Coordinates),
    /// Coordinates over time; their rates are those between the rows.
    Moving(Source),
}

/// Numbers of degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
pub enum PerJoint {
    /// The same for all.
    Same(f64),
    /// Values by name, and `*` for the others (0 if missing).
    Named {
        /// The value of joints that are not named.
        rest: f64,
        /// The others, without `*`.
        named: Coordinates,
    },
    /// All of them, in the order of the robot.
    All(Coordinates),
}

impl Default for PerJoint {
    fn default() -> Self {
        Self::Same(0.0)
    }
}

/// The keys as they are read.
#[derive(Default)]
pub(crate) struct Keys {
    kind: Sort,
    torque: PerJoint,
    target: Option<Coordinates>,
    kp: PerJoint,
    kd: PerJoint,
    source: Source,
    period: Option<f64>,
    ctrl: Option<Coordinates>,
    keyframe: Option<(String, At)>,
    without: Vec<(String, At)>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Sort {
    #[default]
    None,
    Torque,
    Table,
    Pd,
    Actuators,
}

const SORTS: &[(&str, Sort)] =
    &[("none", Sort::None), ("torque", Sort::Torque), ("table", Sort::Table), ("pd", Sort::Pd), ("actuators", Sort::Actuators)];

/// Keys of each kind, besides `kind`.
const OF_SORT: &[(Sort, &[&str])] = &[
    (Sort::None, &[]),
    (Sort::Torque, &["torque"]),
    (Sort::Table, &["file", "columns", "rows", "interpolation", "period"]),
    (Sort::Pd, &["target", "kp", "kd", "torque", "file", "columns", "rows", "interpolation", "period"]),
    (Sort::Actuators, &["ctrl", "keyframe", "without", "file", "columns", "rows", "interpolation", "period"]),
];

pub(crate) const KEYS: &[Row<Keys>] = &[
    Row {
        name: "kind",
        required: true,
        value: "`\"none\"`, `\"torque\"`, `\"table\"`, `\"pd\"` or `\"actuators\"`",
        default: "",
        what: "no torque; the same torques all the time; torques over time; τ = kp (target ⊖ q) + kd (target' − v) + torque; the actuators of the robot's file (MJCF)",
        read: |x, s, log| set(&mut x.kind, s.word(log, SORTS)),
    },
    Row {
        name: "torque",
        required: false,
        value: "number, numbers, or table: joint = number, or numbers where it has several; N·m, N",
        default: "0",
        what: "`torque`, `pd`: the torques",
        read: |x, s, log| x.torque = per_joint(s, Range::ALL, log),
    },
    Row {
        name: "target",
        required: false,
        value: "numbers, or table: joint = number or numbers; rad, m",
        default: "0",
        what: "`pd`: where to; or a table over time, by the keys below",
        read: |x, s, log| x.target = Some(values(s, log)),
    },
    Row {
        name: "kp",
        required: false,
        value: "number, numbers, or table: joint = number, for all that it has, or numbers; N·m/rad, N/m",
        default: "0",
        what: "`pd`: gain of the position, at least 0",
        read: |x, s, log| x.kp = per_joint(s, Range::NOT_NEGATIVE, log),
    },
    Row {
        name: "kd",
        required: false,
        value: "number, numbers, or table: joint = number, for all that it has, or numbers; N·m·s/rad, N·s/m",
        default: "0",
        what: "`pd`: gain of the rate, at least 0",
        read: |x, s, log| x.kd = per_joint(s, Range::NOT_NEGATIVE, log),
    },
    Row {
        name: "ctrl",
        required: false,
        value: "numbers, or table: actuator = number",
        default: "0",
        what: "`actuators`: their controls; or a table over time, by the keys below",
        read: |x, s, log| x.ctrl = Some(values(s, log)),
    },
    Row {
        name: "keyframe",
        required: false,
        value: "text",
        default: "none",
        what: "`actuators`: a state of the robot's file, whose controls `ctrl` changes",
        read: |x, s, log| x.keyframe = name(s, log, "the name of a keyframe of the robot's file").map(|name| (name, s.at)),
    },
    Row {
        name: "without",
        required: false,
        value: "texts",
        default: "none",
        what: "`actuators`: names of actuators, or of tendons with a spring or damper, to leave out, as those of a locked joint",
        read: |x, s, log| {
            let names = s.texts(log, "a list of actuators, as [\"wrist_servo\"]").unwrap_or_default();
            x.without = names.into_iter().zip(places(s)).collect();
        },
    },
    Row {
        name: "file",
        required: false,
        value: "text",
        default: "none",
        what: "`table`, `pd`, `actuators`: a CSV, a regular file of at most 10 000 000 rows, seen from the scene's folder; its first line names the columns, the first of which is `t`, s; the others, at least one, are joints (`joint[k]` for the k-th number of one that has several), or actuators",
        read: |x, s, log| {
            x.source.file = name(s, log, "the path of a CSV");
            x.source.place = s.at;
        },
    },
    Row {
        name: "columns",
        required: false,
        value: "texts",
        default: "none",
        what: "`table`, `pd`, `actuators`: instead of a file: names of the columns after the time",
        read: |x, s, log| {
            x.source.columns = s.texts(log, "a list of joints").unwrap_or_default();
            x.source.column_places = places(s);
            x.source.place = s.at;
        },
    },
    Row {
        name: "rows",
        required: false,
        value: "list of lists of numbers",
        default: "none",
        what: "`table`, `pd`, `actuators`: instead of a file: the time, s, and a number for each column",
        read: |x, s, log| {
            x.source.rows = rows(s, log);
            x.source.row_places = places(s);
        },
    },
    Row {
        name: "interpolation",
        required: false,
        value: "`\"linear\"`, `\"hold\"` or `\"cubic\"`",
        default: "`\"linear\"`",
        what: "`table`, `pd`, `actuators`: between rows: linear (a quaternion by the shortest rotation, at one rate), the row before, or a cubic spline without kinks, at rest at its ends (targets without quaternions); before the first and after the last the nearest row holds",
        read: |x, s, log| {
            x.source.between_place = s.at;
            set(&mut x.source.between, s.word(log, &[("linear", Between::Linear), ("hold", Between::Hold), ("cubic", Between::Cubic)]));
        },
    },
    Row {
        name: "period",
        required: false,
        value: "number, s",
        default: "none",
        what: "`table`, `pd`, `actuators`: the torques are kept for so long, above 0, as by a digital controller",
        read: |x, s, log| x.period = s.positive(log),
    },
];

pub(crate) fn read(spot: &Cursor<'_>, log: &mut Diagnostics) -> Control {
    let mut keys = Keys::default();
    let before = log.count();
    spot.read(KEYS, &mut keys, log);
    let right = log.right(&spot.key, KEYS.iter().map(|row| row.name), before);
    if right.contains(&"kind") && spot.get("kind").is_some() {
        check(&keys, spot, &right, log);
    }
    let file = keys.source.file.clone().filter(|file| !file.is_empty());
    let table = file.zip(spot.get("file").map(|file| file.at));
    if log.count() > before {
        return Control { table, ..Control::default() };
    }
    let Keys { kind, torque, target, kp, kd, source, period, ctrl, keyframe, without } = keys;
    let moving = source.file.is_some() || !source.rows.is_empty();
    let drive = match kind {
        Sort::None => Drive::None,
        Sort::Torque => Drive::Torque(torque),
        Sort::Table => Drive::Table(source),
        Sort::Pd if moving => Drive::Pd { target: Target::Moving(source), kp, kd, torque },
        Sort::Pd => Drive::Pd { target: Target::Still(target.unwrap_or_default()), kp, kd, torque },
        Sort::Actuators if moving => Drive::Actuators(Controls::Moving(source)),
        Sort::Actuators => Drive::Actuators(Controls::Still { keyframe, control: ctrl.unwrap_or_default() }),
    };
    Control { drive, period, without, place: spot.at, table }
}

/// Checks that the keys are those of the kind; `right`: the accepted keys of a table.
fn check(keys: &Keys, spot: &Cursor<'_>, right: &[&str], log: &mut Diagnostics) {
    let of_sort = OF_SORT.iter().find(|(sort, _)| *sort == keys.kind).map_or(&[][..], |(_, keys)| keys);
    let word = SORTS.iter().find(|(_, sort)| *sort == keys.kind).map_or("", |(word, _)| word);
    for row in KEYS.iter().filter(|row| row.name != "kind" && !of_sort.contains(&row.name)) {
        if let Some(there) = spot.get(row.name) {
            there.clash(log, format!("a key that control of kind {word:?} does not have"), listed(of_sort));
        }
    }
    let is_there = |key: &str| spot.get(key).is_some();
    let over_time = ["file", "columns", "rows", "interpolation"].into_iter().any(is_there);
    if keys.kind == Sort::Table || (matches!(keys.kind, Sort::Pd | Sort::Actuators) && over_time) {
        match (is_there("file"), is_there("rows") || is_there("columns")) {
            (true, true) => spot.clash(log, "a file and rows", "one of them"),
            (false, false) => spot.clash(log, "neither file nor rows", "one of them"),
            (false, true) => keys.source.check(&spot.key, right, log),
            (true, false) => {}
        }
        if keys.kind == Sort::Pd && is_there("target") {
            spot.clash(log, "a target and a table of targets", "one of them");
        }
        if keys.kind == Sort::Actuators && (is_there("ctrl") || is_there("keyframe")) {
            spot.clash(log, "controls and a table of controls", "one of them");
        }
    }
}

fn listed(keys: &[&str]) -> String {
    if keys.is_empty() { "no other key".into() } else { format!("one of {}", keys.join(", ")) }
}

fn rows(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<Vec<f64>> {
    match spot.list() {
        Some(list) => list.iter().filter_map(|row| row.some_numbers(log, "a list of numbers: the time and one for each column")).collect(),
        None => {
            spot.wrong(log, "a list of rows, as [[0.0, 1.5], [0.2, 3.0]]");
            Vec::new()
        }
    }
}

fn per_joint(spot: &Cursor<'_>, range: Range, log: &mut Diagnostics) -> PerJoint {
    match &spot.node.value {
        Value::Number(_) => PerJoint::Same(spot.within(log, range).unwrap_or_default()),
        Value::Table(_) => {
            let rest = spot.get("*").map_or(0.0, |all| same(&all, log));
            let Coordinates::Named(mut named) = values(spot, log) else { return PerJoint::default() };
            named.retain(|one| one.joint != "*");
            all_within(spot, range, log);
            PerJoint::Named { rest, named: Coordinates::Named(named) }
        }
        Value::List(_) => {
            all_within(spot, range, log);
            PerJoint::All(values(spot, log))
        }
        _ => {
            spot.wrong(log, "a number, a list of numbers, or a table of joints, as { \"*\" = 10, elbow = 20 }");
            PerJoint::default()
        }
    }
}

/// The number for all joints. Other errors are reported by the reader of the numbers, which may be
/// lists there.
fn same(spot: &Cursor<'_>, log: &mut Diagnostics) -> f64 {
    match spot.node.value {
        Value::Number(x) => x,
        Value::List(_) => spot.number(log).unwrap_or_default(),
        _ => 0.0,
    }
}

/// Checks the range of every finite number. Other errors are reported by the reader of the numbers.
fn all_within(spot: &Cursor<'_>, range: Range, log: &mut Diagnostics) {
    match &spot.node.value {
        Value::Number(x) if x.is_finite() => {
            let _ = spot.within(log, range);
        }
        Value::List(_) => spot.list().iter().flatten().for_each(|item| all_within(item, range, log)),
        Value::Table(entries) => entries.iter().for_each(|entry| all_within(&spot.of(entry), range, log)),
        _ => {}
    }
}

impl Scene {
    /// The control with names resolved and files read by `read`, which receives their names as in
    /// the scene. Errors: all entries that do not fit the robot.
    pub fn controller<'a>(&self, robot: impl Into<RobotInWorld<'a>>, read: &mut Reader<'_>) -> Result<Controller, Diagnostics> {
        let mut log = Diagnostics::new(&self.file);
        let controller = self.controlled(robot.into(), Some(read), &mut log);
        log.result(controller)
    }

    /// Without `read`, files are not opened.
    fn controlled(&self, robot: RobotInWorld<'_>, read: Option<&mut Reader<'_>>, log: &mut Diagnostics) -> Controller {
        let model = robot.model;
        let vector = |from: &PerJoint, key: &str, log: &mut Diagnostics| self.vector(from, key, model, log);
        match &self.control.drive {
            Drive::None => Controller::None,
            Drive::Torque(torque) => Controller::Torque(vector(torque, TORQUE, log)),
            Drive::Table(source) => Controller::Table(source.series(&Slots::of_joints(model, Side::V), read, log)),
            Drive::Pd { target, kp, kd, torque } => Controller::Pd {
                kp: vector(kp, "control.kp", log),
                kd: vector(kd, "control.kd", log),
                torque: vector(torque, TORQUE, log),
                target: match target {
                    Target::Still(target) => {
                        let mut q = neutral(model);
                        fill(target, "control.target", model, Side::Q, &mut q, log);
                        normalise(model, &mut q, ("control.target", &|joint| target.place(joint)), log);
                        Aim::Still(q)
                    }
                    Target::Moving(source) if source.between == Between::Cubic && model.nq() != model.nv() => {
                        let found = format!("\"cubic\" for targets of {} coordinates with quaternions", model.nq());
                        log.error((source.between_place, "control.interpolation"), Code::Word, found, "\"linear\" or \"hold\"");
                        Aim::Still(neutral(model))
                    }
                    Target::Moving(source) => Aim::Moving(source.series(&Slots::of_joints(model, Side::Q), read, log)),
                },
            },
            Drive::Actuators(controls) => {
                let (actuators, controls) = self.actuators(robot, controls, read, log);
                Controller::Actuators { actuators, controls }
            }
        }
    }
}

impl Scene {
    /// Checks that the initial state and control fit the robot, without opening files. Errors: all
    /// entries that do not.
    pub fn fits<'a>(&self, robot: impl Into<RobotInWorld<'a>>) -> Result<(), Diagnostics> {
        let (mut log, robot) = (Diagnostics::new(&self.file), robot.into());
        self.started(robot, &mut log);
        self.controlled(robot, None, &mut log);
        log.result(())
    }

    /// Reports errors of the control's table file; without the robot only that it cannot be opened.
    /// For a scene with other errors; [`Scene::controller`] reports the same.
    pub fn check_table(&self, robot: Option<RobotInWorld<'_>>, read: &mut Reader<'_>, log: &mut Diagnostics) {
        let Some((file, place)) = &self.control.table else { return };
        let mut own = Diagnostics::new(&self.file);
        let world = robot.map(|robot| robot.world_without(&self.control.without, &mut Diagnostics::new("")));
        let table = robot.zip(world.as_ref()).and_then(|(robot, world)| match &self.control.drive {
            Drive::Table(source) => Some((source, Slots::of_joints(robot.model, Side::V))),
            Drive::Pd { target: Target::Moving(source), .. } => Some((source, Slots::of_joints(robot.model, Side::Q))),
            Drive::Actuators(Controls::Moving(source)) => Some((source, Slots::of_actuators(&world.actuators))),
            _ => None,
        });
        match table {
            Some((source, slots)) => drop(source.series(&slots, Some(read), &mut own)),
            None => {
                if let Err(reason) = read(file) {
                    unreadable(file, *place, &reason, &mut own);
                }
            }
        }
        self.keep_certain(&mut own);
        log.take(own);
    }

    /// The actuators of the robot's file, with the scene's controls.
    fn actuators(
        &self,
        robot: RobotInWorld<'_>,
        controls: &Controls,
        read: Option<&mut Reader<'_>>,
        log: &mut Diagnostics,
    ) -> (Actuators, Signal) {
        let place = (self.control.place, "control.kind");
        if robot.world.actuators.is_empty() && robot.world.passive.is_empty() {
            log.error(place, Code::Robot, "actuators, of which the robot's file has none", "another kind of control");
        }
        let world = robot.world_without(&self.control.without, log);
        let robot = RobotInWorld { world: &world, ..robot };
        let actuators = &robot.world.actuators;
        let signal = match controls {
            Controls::Moving(source) => Signal::Moving(source.series(&Slots::of_actuators(actuators), read, log)),
            Controls::Still { keyframe, control } => {
                let mut still = vec![0.0; actuators.len()];
                if let Some((name, place)) = keyframe
                    && let Some(keyframe) = robot.keyframe(name, (*place, "control.keyframe"), log)
                {
                    still.iter_mut().zip(&keyframe.control).for_each(|(still, u)| *still = *u);
                }
                robot.put_controls(control, &mut still, log);
                Signal::Still(still)
            }
        };
        (robot.actuators(place, log), signal)
    }

    /// `[nv]`. One gain applies to all degrees of freedom of a joint; torques are required one by
    /// one.
    fn vector(&self, from: &PerJoint, key: &str, model: &Model<f64>, log: &mut Diagnostics) -> Vec<f64> {
        let mut all = vec![0.0; model.nv()];
        match from {
            PerJoint::Same(x) => self.spread(*x, model, &mut all),
            PerJoint::All(values) => fill(values, key, model, Side::V, &mut all, log),
            PerJoint::Named { rest, named } => {
                self.spread(*rest, model, &mut all);
                let Coordinates::Named(named) = named else { return all };
                named.iter().for_each(|one| put(one, (key, key != TORQUE), model, &mut all, log));
            }
        }
        all
    }

    /// The number for all actuated joints: not those of a shaft, nor a floating base.
    fn spread(&self, x: f64, model: &Model<f64>, all: &mut [f64]) {
        let of_shaft = |name: &str| self.shafts.iter().any(|asked| (1..=asked.shaft.segments).any(|k| name == asked.shaft.bending(k)));
        for joint in model.joints().iter().filter(|j| j.name != FLOATING_BASE && !of_shaft(&j.name)) {
            all[joint.v.0..joint.v.0 + joint.v.1].fill(x);
        }
    }
}

/// The key of torques. Other keys are gains: one gain may apply to all degrees of freedom of a
/// joint.
const TORQUE: &str = "control.torque";

fn put(one: &Named, (key, alike): (&str, bool), model: &Model<f64>, all: &mut [f64], log: &mut Diagnostics) {
    let key = format!("{key}.{}", crate::table::bare(&one.joint));
    let Some(joint) = model.joints().iter().find(|j| j.name == one.joint) else {
        no_joint(log, one.place, &key, &one.joint, model);
        return;
    };
    let (first, count) = joint.v;
    match *one.values.as_slice() {
        [x] if alike || count == 1 => all[first..first + count].fill(x),
        ref values if values.len() == count => all[first..first + count].copy_from_slice(values),
        ref values => wrong_count(log, one.place, &key, values.len(), (count, alike)),
    }
}

fn wrong_count(log: &mut Diagnostics, at: At, key: &str, found: usize, (expected, alike): (usize, bool)) {
    let expected = if expected == 1 || !alike { counted(expected) } else { format!("one number, or {}", counted(expected)) };
    log.error((at, key), Code::Number, counted(found), expected);
}
