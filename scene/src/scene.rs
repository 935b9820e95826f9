//! A scene, and the keys at its top.

use std::collections::BTreeSet;

use articulated_core::Plain;
use articulated_core::description::Base;
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, quote};
use articulated_core::effect::EffectId;
use articulated_core::integrator::IntegratorId;
use articulated_core::lanes::Real;
use articulated_core::precision::Precision;
use articulated_core::spatial::Reference;
use articulated_formats::world::{GivenContact, MOST_GIVEN};
use articulated_formats::{LeaveOut, SNAP_EXPECTED, can_snap};

use crate::control::{self, Control, Drive};
use crate::document;
use crate::edits::{self, APPEND, Append, Follower, LOAD, Load, Lock};
use crate::effects::{self, EffectRequest};
use crate::impact::{self, Impact};
use crate::initial::{self, Initial};
use crate::shaft::ShaftRequest;
use crate::simulation::{self, Law, Simulation};
use crate::table::{Cursor, Row};
use crate::tree::{Node, Value};

/// A scene in the form of its file: names are not looked up yet, files not opened.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The file's name when it was read.
    pub file: String,
    /// Summary, one line.
    pub summary: String,
    /// The robot.
    pub robot: Robot,
    /// The base; `None`: the intended one of a bundled robot, fixed for others.
    pub base: Option<Base>,
    /// Gravity in the world frame, m/s²; `None`: that of the robot's file, or else
    /// standard gravity.
    pub gravity: Option<[f64; 3]>,
    /// Edits of the robot, and options of its generated code.
    pub code: CodeOptions,
    /// Requested effects.
    pub effects: Vec<EffectRequest>,
    /// Shafts that bend.
    pub shafts: Vec<ShaftRequest>,
    /// Settings of the simulation; `None`: the scene has none.
    pub simulation: Option<Simulation>,
    /// The state that a simulation starts from.
    pub initial: Initial,
    /// Actuation of the joints.
    pub control: Control,
    /// A ball to be hit.
    pub impact: Option<Impact>,
    /// Paths of the keys that are invalid in its text and were left out: see
    /// [`Scene::keep_certain`]. Empty for a scene without errors.
    pub left_out: Vec<String>,
}

/// Source of the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Robot {
    /// Supplied by the program that uses the scene.
    #[default]
    Given,
    /// A bundled robot, by its name.
    Bundled(String),
    /// A robot's file, relative to the scene's folder.
    File(String),
}

/// Edits of the robot, and choices of the code that is generated for it. `None`: the generating
/// program's default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CodeOptions {
    /// The functions wanted.
    pub functions: Option<Vec<String>>,
    /// Constants of the model that stay inputs.
    pub parameters: Option<Vec<String>>,
    /// Links whose frames the functions of frames return.
    pub frames: Option<Vec<String>>,
    /// Reference of the wrenches that functions take.
    pub wrenches_in: Option<Reference>,
    /// Joints that follow others.
    pub coupling: Vec<Follower>,
    /// Joints that follow others by linear equations of the robot's file.
    pub file_coupling: bool,
    /// Joints to lock.
    pub lock: Vec<Lock>,
    /// Loads.
    pub payload: Vec<Load>,
    /// Robots to append.
    pub append: Vec<Append>,
    /// Rust names to use: (name in the robot's file, name in Rust).
    pub rename: Vec<(String, String)>,
    /// Arguments of the robot's file: (name, value).
    pub args: Vec<(String, String)>,
    /// Packages that the robot's file includes files from: (name, folder).
    pub packages: Vec<(String, String)>,
    /// Accept inertias with a principal moment below zero.
    pub allow_unphysical_inertia: Option<bool>,
    /// If a unique tag of a URDF is repeated, take the first.
    pub first_of_duplicates: Option<bool>,
    /// Elements of an MJCF that are not read, to leave out.
    pub leave_out: Option<BTreeSet<LeaveOut>>,
    /// Pairs of geoms of an MJCF whose contacts a caller finds, each with its place.
    pub given_contacts: Vec<(GivenContact, At)>,
    /// Read a URDF of an unknown version.
    pub allow_unknown_version: Option<bool>,
    /// Rounds angles that are this near to a multiple of π/2, rad.
    pub snap_angles: Option<f64>,
    /// Limbs that are alike at once.
    pub limbs: Option<bool>,
    /// Types of numbers for functions of many states.
    pub batch: Option<Vec<Real>>,
    /// How accurate the functions are.
    pub level: Option<Precision>,
    /// No `unsafe` in the generated code.
    pub forbid_unsafe: Option<bool>,
    /// Maximum size of the functions' code, MB.
    pub max_code_size: Option<u64>,
    /// Places of these in the scene.
    pub places: Places,
}

/// Places of names that only the robot, or the scene's user, can check; for a list, of each item.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// A bundled robot, or a robot's file.
    pub robot: At,
    /// Of [`CodeOptions::functions`].
    pub functions: Vec<At>,
    /// Of [`CodeOptions::parameters`].
    pub parameters: Vec<At>,
    /// Of [`CodeOptions::frames`].
    pub frames: Vec<At>,
    /// Of [`CodeOptions::rename`].
    pub rename: Vec<At>,
    /// Of [`CodeOptions::packages`].
    pub packages: Vec<At>,
}

impl Scene {
    /// The scene in `text`; `file` is its name in messages and is not opened. Any text is a scene
    /// or an error; all errors at once.
    pub fn read(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let mut log = Diagnostics::new(file);
        let scene = Self::read_into(file, text, &mut log).unwrap_or_default();
        log.result(scene)
    }

    /// As [`Scene::read`], and reports to a collector. Invalid content is left out, so that the
    /// rest of the scene can be checked further. `None`: the text is not TOML.
    pub fn read_into(file: &str, text: &str, log: &mut Diagnostics) -> Option<Self> {
        let mut own = Diagnostics::new(file);
        let root = document::parse(text, &mut own);
        let scene = root.map(|root| Self::of(file, &root, &mut own));
        log.take(own);
        scene
    }

    /// The scene in a text without a file, for the robot in `file`: findings name that file and no
    /// place in it.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn made_for(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let mut log = Diagnostics::new(file);
        let root = document::parse(text, &mut log);
        let scene = root.map(|root| Self::of(file, &root.without_places(), &mut log)).unwrap_or_default();
        log.result(scene)
    }

    fn of(file: &str, root: &Node, log: &mut Diagnostics) -> Self {
        let mut scene = Self { file: file.to_owned(), ..Self::default() };
        scene.fill(root, log);
        scene.left_out = log.errors.iter().map(|error| error.field.clone()).collect();
        scene
    }

    /// As [`Scene::read`], of bytes that may not even be text.
    pub fn read_bytes(file: &str, bytes: &[u8]) -> Result<Self, Diagnostics> {
        let mut log = Diagnostics::new(file);
        let scene = Self::read_bytes_into(file, bytes, &mut log).unwrap_or_default();
        log.result(scene)
    }

    /// As [`Scene::read_into`], of bytes that may not even be text.
    pub fn read_bytes_into(file: &str, bytes: &[u8], log: &mut Diagnostics) -> Option<Self> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::read_into(file, text, log),
            Err(error) => {
                let lines = bytes[..error.valid_up_to()].iter().filter(|b| **b == b'\n').count();
                let at = At::line_of(u32::try_from(lines + 1).unwrap_or(u32::MAX));
                let found = "bytes that are not UTF-8";
                log.push(Diagnostic::error(file, (at, ""), Code::Syntax, found, "a TOML file"));
                None
            }
        }
    }

    /// The scene with the valid settings of a table in place of its own, and the table's errors.
    /// For the macro, which reads the keys `own` itself.
    pub fn overlaid(mut self, said: &Node, own: &[&str]) -> (Self, Vec<Diagnostic>) {
        let mut log = Diagnostics::new(&self.file);
        let rows: Vec<&Row<Self>> = KEYS.iter().filter(|row| !OF_MOTION.contains(&row.name)).collect();
        let spot = Cursor::root(said);
        for entry in spot.entries(&mut log, "a table") {
            let value = spot.of(entry);
            match rows.iter().find(|row| row.name == entry.name) {
                Some(row) => (row.read)(&mut self, &value, &mut log),
                None => value.unknown_key(&mut log, own.iter().copied().chain(rows.iter().map(|row| row.name))),
            }
        }
        if let (Some(file), Some(_)) = (spot.get("file"), spot.get("urdf")) {
            file.clash(&mut log, "urdf and file", "one of them");
        }
        self.choose_integrator();
        let wrong = log.result(()).err().map(|all| all.errors).unwrap_or_default();
        (self, wrong)
    }

    /// Whether it requests any effect that is not off.
    pub fn has_effects(&self) -> bool {
        self.effects.iter().any(|asked| asked.says.is_some()) || !self.shafts.is_empty()
    }

    /// The integrator of a motion that names none: `rodas4` if smoothed friction or contact makes
    /// it stiff, else `dopri5`.
    pub fn default_integrator(&self) -> IntegratorId {
        let stiff = |asked: &EffectRequest| matches!(asked.effect, EffectId::friction | EffectId::contact) && asked.says.is_some();
        if self.effects.iter().any(stiff) { IntegratorId::rodas4 } else { IntegratorId::dopri5 }
    }

    fn choose_integrator(&mut self) {
        let integrator = self.default_integrator();
        if let Some(simulation) = self.simulation.as_mut().filter(|simulation| !simulation.names_integrator) {
            simulation.settings.integrator = integrator;
        }
    }

    fn fill(&mut self, root: &Node, log: &mut Diagnostics) {
        let spot = Cursor::root(root);
        spot.read(KEYS, self, log);
        self.choose_integrator();
        for [one, other] in [["robot", "urdf"], ["robot", "file"], ["urdf", "file"]] {
            if let (Some(robot), Some(_)) = (spot.get(one), spot.get(other)) {
                robot.clash(log, format!("{one} and {other}"), "one of them");
            }
        }
        let period = spot.get("control").and_then(|control| control.get("period"));
        if let (Some(simulation), Some(period), Some(spot)) = (&self.simulation, self.control.period, period)
            && let Some(right) = simulation.settings.wrong_period(period)
        {
            spot.clash(log, Plain(period).to_string(), right);
        }
        if self.law().is_some() {
            self.beside_law(&spot, log);
        }
    }

    /// The law of limits, dry friction, equations and contacts of the robot's file, if they act.
    pub fn law(&self) -> Option<Law> {
        self.simulation.as_ref()?.law.map(|(law, _)| law)
    }

    /// Reports what does not act in steps by a law.
    fn beside_law(&self, root: &Cursor<'_>, log: &mut Diagnostics) {
        const OTHER_LAWS: [EffectId; 3] = [EffectId::friction, EffectId::limit, EffectId::contact];
        for asked in self.effects.iter().filter(|asked| OTHER_LAWS.contains(&asked.effect) && asked.says.is_some()) {
            let found = format!("{} beside simulation.law", asked.effect.row().name);
            log.error((asked.place, &asked.key), Code::Together, found, "one of them: the law has its own");
        }
        let expected = "control of kind \"none\" or \"actuators\" with `ctrl`, `keyframe` or a table";
        if !matches!(self.control.drive, Drive::None | Drive::Actuators(_)) {
            log.error((self.control.place, "control.kind"), Code::Together, "torques beside simulation.law", expected);
        }
        for key in ["period", "without"] {
            if let Some(spot) = root.get("control").and_then(|control| control.get(key)) {
                spot.clash(log, format!("{key} beside simulation.law"), expected);
            }
        }
        if let Some(spot) = root.get("impact") {
            spot.clash(log, "a ball beside simulation.law", "a scene without one of them");
        }
    }
}

const BASES: &[(&str, Base)] = &[("fixed", Base::Fixed), ("floating", Base::Floating)];
const REALS: &[(&str, Real)] = &[("f64", Real::F64), ("f32", Real::F32)];
const REFERENCES: &[(&str, Reference)] =
    &[("body", Reference::Body), ("world", Reference::World), ("world_aligned", Reference::WorldAligned)];

/// Keys without influence on the generated code, and a robot known by its name, which only files
/// have.
const OF_MOTION: [&str; 6] = ["summary", "robot", "simulation", "initial", "control", "impact"];

/// All keys at the top of a scene, in the order of their documentation.
pub(crate) const KEYS: &[Row<Scene>] = &[
    Row {
        name: "summary",
        required: false,
        value: "text",
        default: "none",
        what: "what the scene is, in a line",
        read: |s, spot, log| s.summary = spot.text(log, "a text").unwrap_or_default().to_owned(),
    },
    Row {
        name: "robot",
        required: false,
        value: "text",
        default: "given by the user of the scene",
        what: "a bundled robot",
        read: |s, spot, log| {
            s.robot = edits::name(spot, log, "the name of a bundled robot").map_or(Robot::Given, Robot::Bundled);
            s.code.places.robot = spot.node.at;
        },
    },
    Row {
        name: "urdf",
        required: false,
        value: "text",
        default: "given by the user of the scene",
        what: "a robot file (URDF, xacro, MJCF or SDF), seen from the scene's folder; instead of `robot`",
        read: |s, spot, log| {
            s.robot = edits::name(spot, log, "the path of a robot file").map_or(Robot::Given, Robot::File);
            s.code.places.robot = spot.node.at;
        },
    },
    Row {
        name: "file",
        required: false,
        value: "text",
        default: "given by the user of the scene",
        what: "the same as `urdf`: both keys are one",
        read: |s, spot, log| {
            s.robot = edits::name(spot, log, "the path of a robot's file").map_or(Robot::Given, Robot::File);
            s.code.places.robot = spot.node.at;
        },
    },
    Row {
        name: "base",
        required: false,
        value: "`\"fixed\"` or `\"floating\"`",
        default: "that of the bundled robot, `\"fixed\"` for others",
        what: "whether the root link is the base or moves freely",
        read: |s, spot, log| s.base = spot.word(log, BASES),
    },
    Row {
        name: "gravity",
        required: false,
        value: "3 numbers, m/s²",
        default: "that of the robot's file, or else [0, 0, -9.81]",
        what: "in the world frame",
        read: |s, spot, log| s.gravity = spot.numbers(log),
    },
    Row {
        name: "functions",
        required: false,
        value: "texts",
        default: "those of the macro",
        what: "the functions to generate, as the macro's key has them; `\"motion\"` for all that the motion calls",
        read: |s, spot, log| {
            s.code.functions = spot.texts(log, "a list of functions, as [\"placements\", \"bias = inverse_dynamics(a = 0)\"]");
            s.code.places.functions = edits::places(spot);
        },
    },
    Row {
        name: "parameters",
        required: false,
        value: "texts",
        default: "none",
        what: "constants of the model that stay inputs: `\"payload(link)\"`, `\"inertia(link)\"`, `\"origin(joint)\"`, `\"gravity\"`, and numbers of an effect that is on, as `\"damping(joint)\"`, `\"contact(link)\"`",
        read: |s, spot, log| {
            s.code.parameters = spot.texts(log, "a list of what stays an input, as [\"payload(tool)\"]");
            s.code.places.parameters = edits::places(spot);
        },
    },
    Row {
        name: "frames",
        required: false,
        value: "texts",
        default: "all links",
        what: "the links whose frames the functions of frames give",
        read: |s, spot, log| {
            s.code.frames = spot.texts(log, "a list of links, as [\"tool\"]");
            s.code.places.frames = edits::places(spot);
        },
    },
    Row {
        name: "wrenches_in",
        required: false,
        value: "`\"body\"`, `\"world\"` or `\"world_aligned\"`",
        default: "`\"body\"`",
        what: "what the wrenches that functions take refer to",
        read: |s, spot, log| s.code.wrenches_in = spot.word(log, REFERENCES),
    },
    Row {
        name: "coupling",
        required: false,
        value: "table: joint = { joint, coefficients, offset } or { joint, polynomial, reference }, or `\"file\"`",
        default: "none",
        what: "joints that follow others: q = Σ coefficient · q of each + offset, or one other by a polynomial of a degree up to 4; `\"file\"`: as equations of the robot's file say (MJCF)",
        read: |s, spot, log| (s.code.coupling, s.code.file_coupling) = edits::couplings(spot, log),
    },
    Row {
        name: "lock",
        required: false,
        value: "table: joint = number or numbers, rad or m",
        default: "none",
        what: "joints that do not move, and where",
        read: |s, spot, log| s.code.lock = edits::locks(spot, log),
    },
    Row {
        name: "payload",
        required: false,
        value: "table or list of tables",
        default: "none",
        what: "rigid loads on links",
        read: |s, spot, log| s.code.payload = spot.tables(LOAD, log),
    },
    Row {
        name: "append",
        required: false,
        value: "table or list of tables",
        default: "none",
        what: "other robots on links",
        read: |s, spot, log| s.code.append = spot.tables(APPEND, log),
    },
    Row {
        name: "rename",
        required: false,
        value: "table: name in the robot's file = text",
        default: "none",
        what: "names in Rust",
        read: |s, spot, log| {
            s.code.rename = edits::renamings(spot, log);
            s.code.places.rename = edits::places(spot);
        },
    },
    Row {
        name: "args",
        required: false,
        value: "table: name = text, number, true or false",
        default: "those of the file",
        what: "values of the arguments that the robot's file declares (`<xacro:arg>`)",
        read: |s, spot, log| s.code.args = edits::arguments(spot, log),
    },
    Row {
        name: "packages",
        required: false,
        value: "table: name = text",
        default: "those around the file",
        what: "folders of packages that the robot's file includes files from (`$(find name)`), seen from the scene's folder",
        read: |s, spot, log| {
            s.code.packages = edits::packages(spot, log);
            s.code.places.packages = edits::places(spot);
        },
    },
    Row {
        name: "allow_unphysical_inertia",
        required: false,
        value: "true or false",
        default: "false",
        what: "accept negative principal moments, with a warning (moments that break the triangle inequality always are)",
        read: |s, spot, log| s.code.allow_unphysical_inertia = spot.boolean(log),
    },
    Row {
        name: "first_of_duplicates",
        required: false,
        value: "true or false",
        default: "false",
        what: "take the first of tags of a URDF or SDF that should be there once, with a warning",
        read: |s, spot, log| s.code.first_of_duplicates = spot.boolean(log),
    },
    Row {
        name: "leave_out",
        required: false,
        value: "list of `\"flex\"`, `\"composite\"`, `\"plugin\"`, `\"constraint\"`, `\"solver\"`, `\"contact\"`",
        default: "none",
        what: "leave out elements of an MJCF that change the motion and are not read, with a warning; else they are errors",
        read: |s, spot, log| s.code.leave_out = left_out(spot, log),
    },
    Row {
        name: "given_contacts",
        required: false,
        value: "list of [geom, geom] or [geom, geom, number]",
        default: "none",
        what: "pairs of geoms of an MJCF whose contacts a caller finds, in so many places, or 1: an argument of functions of the group `given_contacts`",
        read: |s, spot, log| s.code.given_contacts = given_contacts(spot, log),
    },
    Row {
        name: "allow_unknown_version",
        required: false,
        value: "true or false",
        default: "false",
        what: "read a URDF of a version other than 1.0, 1.1 and 1.2 as 1.0, with a warning",
        read: |s, spot, log| s.code.allow_unknown_version = spot.boolean(log),
    },
    Row {
        name: "snap_angles",
        required: false,
        value: "number, rad",
        default: "never",
        what: "take angles this near to a multiple of π/2 as that, above 0, at most 0.5 rad; leave it out to snap none",
        read: |s, spot, log| s.code.snap_angles = snap_angles(spot, log),
    },
    Row {
        name: "limbs",
        required: false,
        value: "true or false",
        default: "true",
        what: "compute limbs that are alike at once",
        read: |s, spot, log| s.code.limbs = spot.boolean(log),
    },
    Row {
        name: "batch",
        required: false,
        value: "list of `\"f64\"`, `\"f32\"`",
        default: "none",
        what: "functions of many states, in these numbers",
        read: |s, spot, log| s.code.batch = batch(spot, log),
    },
    Row {
        name: "level",
        required: false,
        value: "text",
        default: "`\"f64\"`",
        what: "how accurate the functions are, as `\"f32\"`, `\"compensated + two\"`",
        read: |s, spot, log| s.code.level = level(spot, log),
    },
    Row {
        name: "forbid_unsafe",
        required: false,
        value: "true or false",
        default: "false",
        what: "no `unsafe` in generated code",
        read: |s, spot, log| s.code.forbid_unsafe = spot.boolean(log),
    },
    Row {
        name: "max_code_size",
        required: false,
        value: "whole number, MB",
        default: "64",
        what: "code that all functions together may become, 1 to 1000000; more is an error",
        read: |s, spot, log| s.code.max_code_size = spot.whole(log, 1, 1_000_000),
    },
    Row {
        name: "effects",
        required: false,
        value: "table: effect = …, or \"file\"",
        default: "none",
        what: "what acts beside rigid bodies and gravity, see below; \"file\": the smooth effects of the robot's file",
        read: effects::read,
    },
    Row {
        name: "simulation",
        required: false,
        value: "table",
        default: "none",
        what: "how to simulate, see below",
        read: |s, spot, log| s.simulation = simulation::read(spot, log),
    },
    Row {
        name: "initial",
        required: false,
        value: "table",
        default: "at rest, where the robot's file begins (MJCF), or else at q = 0",
        what: "the state at the start, see below",
        read: |s, spot, log| s.initial = initial::read(spot, log),
    },
    Row {
        name: "control",
        required: false,
        value: "table",
        default: "none",
        what: "what drives the joints, see below",
        read: |s, spot, log| s.control = control::read(spot, log),
    },
    Row {
        name: "impact",
        required: false,
        value: "table",
        default: "none",
        what: "a ball to be hit, see below",
        read: |s, spot, log| s.impact = impact::read(spot, log),
    },
];

/// The bound is the readers' bound.
fn snap_angles(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<f64> {
    match spot.node.value {
        Value::Number(x) if can_snap(x) => return Some(x),
        Value::Number(x) => spot.bad(log, format!("{x:?}"), SNAP_EXPECTED),
        _ => spot.wrong(log, SNAP_EXPECTED),
    }
    None
}

/// Each type once.
fn batch(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Vec<Real>> {
    let Some(list) = spot.list() else {
        spot.wrong(log, "a list of \"f64\", \"f32\"");
        return None;
    };
    let mut reals: Vec<Real> = Vec::new();
    for item in &list {
        match item.word(log, REALS) {
            Some(real) if reals.contains(&real) => item.clash(log, "a type that is there twice", "each once"),
            real => reals.extend(real),
        }
    }
    Some(reals)
}

fn left_out(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<BTreeSet<LeaveOut>> {
    let Some(list) = spot.list() else {
        spot.wrong(log, "a list of \"flex\", \"composite\", \"plugin\"");
        return None;
    };
    Some(list.iter().filter_map(|item| item.word(log, &LeaveOut::WORDS)).collect())
}

fn given_contacts(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<(GivenContact, At)> {
    let Some(list) = spot.list() else {
        spot.wrong(log, "a list of pairs, as [[\"foot\", \"floor\", 4]]");
        return Vec::new();
    };
    let pair = |item: &Cursor<'_>| {
        let own = item.list().unwrap_or_default();
        let (Some(first), Some(second), 2..=3) = (own.first(), own.get(1), own.len()) else {
            item.wrong(log, "two names of geoms, and in how many places they touch");
            return None;
        };
        let names = [first, second].map(|name| name.text(log, "the name of a geom").map(str::to_owned));
        let places = match own.get(2) {
            Some(count) => count.whole(log, 1, MOST_GIVEN as u64)? as usize,
            None => 1,
        };
        let [Some(first), Some(second)] = names else { return None };
        Some((GivenContact { shapes: [first, second], places }, item.at))
    };
    list.iter().filter_map(pair).collect()
}

fn level(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Precision> {
    let expected = "a level of accuracy, as \"f64\", \"f32\", \"compensated + two\", \"double_double\" or \"f64 + fast_10 + no_fma\"";
    let text = spot.text(log, expected)?;
    let level = text.split_whitespace().collect::<String>().parse::<Precision>();
    level.map_err(|error| log.error((spot.node.at, &spot.key), Code::Word, quote(text), error.expected)).ok()
}
