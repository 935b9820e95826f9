//! Results of Pinocchio and MuJoCo; the format is described in `tests/oracles/README.md`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use articulated_core::description::{Base, Description, Inertial, Joint, JointId, JointKind, Link, LinkId, Mimic, Origin};
use articulated_core::spatial::Reference;
use serde::Deserialize;

use crate::case::{Case, read};

/// The answers about one robot.
#[derive(Clone, Debug, Deserialize)]
pub struct Answers {
    /// The robot's name.
    pub robot: String,
    /// The engine, with versions.
    pub engine: String,
    /// `fixed` or `floating`.
    pub base: String,
    /// m/s², world frame.
    pub gravity: [f64; 3],
    /// Names of the joints in the order of the coordinates.
    pub joints: Vec<String>,
    /// Names of the joints that move, followers included, in the order of the bodies.
    pub links: Vec<String>,
    /// Length of q.
    pub nq: usize,
    /// Length of v.
    pub nv: usize,
    /// For a robot that is not bundled.
    pub description: Option<Drawn>,
    /// The states.
    pub states: Vec<Answered>,
}

/// One state and the answers in it.
#[derive(Clone, Debug, Deserialize)]
pub struct Answered {
    /// The links that functions of frames are about.
    pub frames: Vec<String>,
    /// `body`, `world` or `world_aligned`.
    pub wrench_reference: String,
    /// By the name of the function.
    pub results: BTreeMap<String, Vec<f64>>,
    /// By the name of the argument.
    #[serde(flatten)]
    pub arguments: BTreeMap<String, Vec<f64>>,
}

/// A description without content that the dynamics do not use.
#[derive(Clone, Debug, Deserialize)]
pub struct Drawn {
    links: Vec<DrawnLink>,
    joints: Vec<DrawnJoint>,
}

#[derive(Clone, Debug, Deserialize)]
struct DrawnLink {
    name: String,
    mass: f64,
    xyz: [f64; 3],
    rpy: [f64; 3],
    inertia: [f64; 6],
}

#[derive(Clone, Debug, Deserialize)]
struct DrawnJoint {
    name: String,
    kind: String,
    parent: usize,
    child: usize,
    xyz: [f64; 3],
    rpy: [f64; 3],
    axis: [f64; 3],
    second_axis: [f64; 3],
    pitch: f64,
    mimic: Option<DrawnMimic>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
struct DrawnMimic {
    joint: usize,
    multiplier: f64,
    offset: f64,
}

impl Drawn {
    fn description(&self, name: &str) -> Description {
        let link = |l: &DrawnLink| Link {
            name: l.name.clone(),
            inertial: Some(Inertial { origin: Origin::new(l.xyz, l.rpy), mass: l.mass, inertia: l.inertia }),
            ..Link::default()
        };
        Description {
            name: name.to_owned(),
            links: self.links.iter().map(link).collect(),
            joints: self.joints.iter().map(DrawnJoint::joint).collect(),
            frames: Vec::new(),
        }
    }
}

impl DrawnJoint {
    fn joint(&self) -> Joint {
        Joint {
            name: self.name.clone(),
            kind: *JointKind::ALL.iter().find(|k| k.name() == self.kind).expect("a kind of joint"),
            parent: LinkId(self.parent),
            child: LinkId(self.child),
            origin: Origin::new(self.xyz, self.rpy),
            axis: self.axis,
            second_axis: self.second_axis,
            pitch: self.pitch,
            mimic: self.mimic.map(|m| Mimic::linear(JointId(m.joint), m.multiplier, m.offset)),
            ..Joint::default()
        }
    }
}

impl Answers {
    /// The robot of the question.
    ///
    /// # Panics
    /// If it is neither described nor bundled.
    pub fn case(&self) -> Case {
        let base = if self.base == "floating" { Base::Floating } else { Base::Fixed };
        let description = match &self.description {
            Some(drawn) => drawn.description(&self.robot),
            None => read(articulated_models::robot(&self.robot).expect("a bundled robot").urdf),
        };
        Case::new(format!("{}, {}", self.robot, self.engine), description, base).with_gravity(self.gravity)
    }
}

impl Answered {
    /// The robot with this state's frames, and wrenches in this state's reference.
    ///
    /// # Panics
    /// If it has no such frames.
    pub fn of(&self, case: &Case) -> Case {
        let reference = [Reference::Body, Reference::World, Reference::WorldAligned];
        let reference = *reference.iter().find(|r| r.name() == self.wrench_reference).expect("a reference");
        let model = case.model.clone().with_frames(&self.frames).expect("links of the robot").with_wrenches_in(reference);
        Case { model, ..case.clone() }
    }
}

/// All answers, by name of the file.
///
/// # Panics
/// If a file cannot be read.
pub fn answers() -> Vec<Answers> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let files = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<_> = files.map(|f| f.expect("an entry").path()).filter(|f| f.extension().is_some_and(|e| e == "json")).collect();
    files.sort();
    let read = |file: &PathBuf| {
        let text = fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
    };
    files.iter().map(read).collect()
}
