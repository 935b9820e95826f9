//! What is asked of a robot before anything is computed.

use articulated_core::description::{Base, Origin, Payload, Shaft};
use articulated_core::effect::Applied;
use articulated_core::model::GRAVITY;
use articulated_core::spatial::Reference;
use articulated_urdf::Problem;

/// The robot as it is wanted: base, gravity, edits, frames and effects.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotOptions {
    /// Whether the root link is fixed.
    pub base: Base,
    /// Gravity in the world frame, m/s².
    pub gravity: [f64; 3],
    /// Names of the links whose frames the functions of frames give, in this order; `None`: all of them, in the order of the file.
    pub frames: Option<Vec<String>>,
    /// What the wrenches that functions take refer to.
    pub wrench_reference: Reference,
    /// Robots to append, one after the other.
    pub append: Vec<Appended>,
    /// Loads to attach; to links of appended robots too.
    pub payloads: Vec<Payload>,
    /// Fixed joints whose rigid offsets bend, see [`shaft`](articulated_core::description::Description::shaft). Their springs and dampings have to be among the effects.
    pub shafts: Vec<Shaft>,
    /// Joints to lock and their coordinates, see [`lock`](articulated_core::description::Description::lock); joints of appended robots too.
    pub lock: Vec<(String, Vec<f64>)>,
    /// What the robot is subject to besides gravity; on joints and links of appended robots too.
    pub effects: Vec<Applied>,
    /// What is odd about the effects ([`Resolved::warnings`](crate::Resolved::warnings)): told with
    /// the warnings of the robot's document.
    pub warnings: Vec<Problem>,
    /// Accept negative principal moments, with a warning. (Moments that break the triangle inequality are always accepted with a warning.)
    pub allow_unphysical_inertia: bool,
    /// Take angles this near (rad, above 0, at most [`MOST_SNAPPED`](articulated_urdf::MOST_SNAPPED)) to a multiple of π/2 as that multiple; every one is reported. `None`: never.
    pub snap_angles: Option<f64>,
}

/// Another robot, a gripper say, to be fixed to a link. Its links and joints get a prefix before their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appended {
    /// The URDF's bytes.
    pub urdf: Vec<u8>,
    /// The file's name, for messages and for the header of a generated file; not opened.
    pub file: String,
    /// The link that carries it.
    pub at: String,
    /// What stands before its names.
    pub prefix: String,
    /// Its root in the frame of that link.
    pub origin: Origin,
}

/// A robot's document and what is asked of it.
#[derive(Clone, Copy, Debug)]
pub struct RobotAsked<'a> {
    /// The file's name, for messages; not opened.
    pub file: &'a str,
    /// The URDF's bytes.
    pub urdf: &'a [u8],
    /// What is asked.
    pub options: &'a RobotOptions,
}

impl Default for RobotOptions {
    fn default() -> Self {
        Self {
            base: Base::Fixed,
            gravity: GRAVITY,
            frames: None,
            wrench_reference: Reference::Body,
            append: Vec::new(),
            payloads: Vec::new(),
            shafts: Vec::new(),
            lock: Vec::new(),
            effects: Vec::new(),
            warnings: Vec::new(),
            allow_unphysical_inertia: false,
            snap_angles: None,
        }
    }
}
