//! Options of a robot before any computation.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use articulated_core::description::{Base, Coupling, Origin, Payload, Shaft};
use articulated_core::diagnostic::Spanned;
use articulated_core::effect::Applied;
use articulated_core::model::GRAVITY;
use articulated_core::spatial::Reference;
use articulated_formats::world::{GivenContact, World};
use articulated_formats::{Formats, Included, LeaveOut};

use crate::scene::Scene;

/// The robot as requested: base, gravity, edits, frames and effects. An entry from a file carries
/// its place.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotOptions {
    /// Whether the root link is fixed.
    pub base: Base,
    /// Gravity in the world frame, m/s²; `None`: that of the robot's file, or else standard
    /// gravity.
    pub gravity: Option<[f64; 3]>,
    /// Names of the links whose frames the functions of frames return, in this order; `None`: all,
    /// in the order of the file.
    pub frames: Option<Vec<Spanned<String>>>,
    /// Reference of the wrenches that functions take.
    pub wrench_reference: Reference,
    /// Robots to append, one after the other.
    pub append: Vec<Appended>,
    /// Loads to attach; also to links of appended robots.
    pub payloads: Vec<Spanned<Payload>>,
    /// Fixed joints whose rigid offsets bend, see
    /// [`shaft`](articulated_core::description::Description::shaft). Their springs and dampings
    /// have to be among the effects. Those of the scene come first.
    pub shafts: Vec<Spanned<Shaft>>,
    /// Joints that follow others, see
    /// [`couple`](articulated_core::description::Description::couple).
    pub coupling: Vec<Spanned<Coupling>>,
    /// Lets joints follow others according to the equations of the robot's file
    /// ([`World::couplings`]).
    pub file_coupling: bool,
    /// Joints to lock and their coordinates, see
    /// [`lock`](articulated_core::description::Description::lock); also joints of appended robots.
    pub lock: Vec<Spanned<(String, Vec<f64>)>>,
    /// Pairs of geoms of an MJCF whose contacts a caller finds, and gives to functions.
    pub given_contacts: Vec<Spanned<GivenContact>>,
    /// Effects of the robot besides gravity and the scene's effects; also on joints and links of
    /// appended robots.
    pub effects: Vec<Applied>,
    /// Accept negative principal moments, with a warning. (Moments that violate the triangle
    /// inequality are always accepted with a warning.)
    pub allow_unphysical_inertia: bool,
    /// If a unique tag of a URDF or SDF is repeated, take the first, with a warning.
    pub first_of_duplicates: bool,
    /// Elements of an MJCF that change the motion and are not read, to leave out with a warning.
    pub leave_out: BTreeSet<LeaveOut>,
    /// Read a URDF of a version other than 1.0, 1.1 and 1.2 as 1.0, with a warning.
    pub allow_unknown_version: bool,
    /// Rounds angles to a multiple of π/2 that is this near (rad, above 0, at most
    /// [`MOST_SNAPPED`](articulated_formats::MOST_SNAPPED)); each is reported. `None`: never.
    pub snap_angles: Option<f64>,
    /// The formats of robot files.
    pub formats: Formats,
    /// The files that the documents of the robot and of appended robots include.
    pub included: Included,
    /// Values of arguments that the robot's document declares, by their names.
    pub arguments: BTreeMap<String, String>,
    /// Folders of packages that documents include files from, by their names.
    pub packages: BTreeMap<String, PathBuf>,
    /// Reads meshes of collision geometry, for contact.
    pub contact_meshes: bool,
}

/// Another robot, such as a gripper, to be fixed to a link or frame. Its links, joints, frames and
/// the names in its file's world get a prefix.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appended {
    /// The bytes of its file.
    pub document: Vec<u8>,
    /// The file's name, for messages and for the header of a generated file, with the place that
    /// names it. It is not opened.
    pub file: Spanned<String>,
    /// The link or frame that carries it.
    pub at: Spanned<String>,
    /// Prefix of its names.
    pub prefix: String,
    /// Its root in that frame.
    pub origin: Origin,
}

/// A robot's document and its options.
#[derive(Clone, Copy, Debug)]
pub struct RobotRequest<'a> {
    /// The file's name, for messages; not opened.
    pub file: &'a str,
    /// The bytes of the file.
    pub document: &'a [u8],
    /// The request.
    pub options: &'a RobotOptions,
    /// The scene with its effects, if there is one.
    pub scene: Option<&'a Scene>,
    /// Whether the scene's start and control have to fit the robot. They need not if there are
    /// edits beside the scene's.
    pub checks_motion: bool,
}

impl Default for RobotOptions {
    fn default() -> Self {
        Self {
            base: Base::Fixed,
            gravity: None,
            frames: None,
            wrench_reference: Reference::Body,
            append: Vec::new(),
            payloads: Vec::new(),
            shafts: Vec::new(),
            coupling: Vec::new(),
            file_coupling: false,
            lock: Vec::new(),
            effects: Vec::new(),
            allow_unphysical_inertia: false,
            first_of_duplicates: false,
            leave_out: BTreeSet::new(),
            given_contacts: Vec::new(),
            allow_unknown_version: false,
            snap_angles: None,
            formats: Formats::default(),
            included: Included::default(),
            arguments: BTreeMap::new(),
            packages: BTreeMap::new(),
            contact_meshes: false,
        }
    }
}

impl RobotOptions {
    /// Gravity in the world frame, m/s², for a robot whose file has this world.
    #[must_use]
    pub fn gravity_in(&self, world: &World) -> [f64; 3] {
        self.gravity.or(world.gravity).unwrap_or(GRAVITY)
    }

    /// Takes these frames instead, as a program chooses them.
    pub fn set_frames<N: Into<String>>(&mut self, names: impl IntoIterator<Item = N>) {
        self.frames = Some(names.into_iter().map(|name| name.into().into()).collect());
    }
}
