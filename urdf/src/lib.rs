//! A strict URDF reader: the bytes of a file become a [`Description`], or every mistake of the file at once.
//!
//! ```
//! use articulated_urdf::{Options, read};
//!
//! let bytes = br#"<robot name="door">
//!   <link name="frame"/>
//!   <link name="leaf"><inertial><mass value="8"/>
//!     <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="0.2"/></inertial></link>
//!   <joint name="hinge" type="continuous"><parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/></joint>
//! </robot>"#;
//! let reading = read(bytes, &Options::default()).unwrap();
//! assert_eq!(reading.description.joints[0].axis, [0.0, 0.0, 1.0]);
//!
//! let problems = read(b"<robot name='nothing'/>", &Options::default()).unwrap_err();
//! assert!(problems.to_string().contains("link"));
//! ```
//!
//! The way of a file: document (bytes → XML) → links and joints (checked numbers, with their lines) → tree
//! (names, rings, roots, mimics) → [`Description`]; with the feature `second-reader` → bridge (a plain document that `urdf-rs` reads has to give the same).
//! With the feature `urdf-rs`, `from_urdf_rs` and `to_urdf_rs` convert from and to `urdf_rs::Robot`. [`write()`] is the reverse of [`read`].
//! [`read`] opens no file ([`read_file`] does), and no input makes it panic, hang or overflow its stack.
//!
//! # What files have that is accepted
//!
//! * `quat_xyzw` of an `<origin>`, from `<robot version="1.1">` on, in place of `rpy`. Its norm is 1 within 1e-3; off by more than 1e-6 it is a warning.
//! * A fixed joint with `<mimic>`, `<axis>` or `<limit>`: not used; `<mimic>` with a warning.
//! * A principal moment of inertia that is negative by rounding, at most 1e-12·m·ℓ², with a warning: ℓ is the longest distance from one frame of the
//!   file to the next, at most 1 m. A moment further below zero is an error, unless [`Options::allow_unphysical_inertia`] is set.
//! * Joints on a link `world` that the file does not declare, with a warning: the link is added, without mass.
//! * `<collision>` that cannot be read, with a warning: a scene that asks for contact of it is refused.
//! * Expressions of xacro in names of files (meshes, textures). Elsewhere each one is an error.
//!
//! What the file states about closed loops, springs, followers and gravity where it is not read (inside `<gazebo>`, under a prefix, `<loop_joint>`, links inside
//! `<group>`) is a warning of the kind [`Kind::LostDynamics`] or [`Kind::Misplaced`].
//!
//! # Beyond the format
//!
//! Three types of joints are extensions, which other readers refuse or do not know:
//!
//! * `spherical`: any turn about the joint's origin. It has no axis.
//! * `helical`: a screw. It turns about `<axis>`, within the bounds of `<limit>` in rad, and slides along it by
//!   `<thread pitch="0.005"/>` metres per revolution; negative for a left-handed thread, which has to be given. Zero is accepted with a warning.
//! * `universal`: Cardan's joint. It turns about `<axis xyz="1 0 0"/>`, then about `<axis2 xyz="0 1 0"/>`, which the first has turned; both have to be
//!   given, in the joint's frame, and not parallel.
//!
//! A joint mimics and is mimicked if it has one coordinate: `helical` does, the other two do not.

mod base;
#[cfg(feature = "second-reader")]
mod bridge;
mod collision;
mod described;
mod document;
mod draft;
mod element;
mod file;
mod frame;
mod inertia;
mod joints;
mod limits;
mod lines;
mod links;
mod log;
mod lost;
mod markup;
mod mimic;
mod number;
#[cfg(feature = "second-reader")]
mod plain;
mod problem;
mod ring;
mod robot;
mod snap;
mod summary;
mod tree;
mod unused;
#[cfg(feature = "urdf-rs")]
mod urdf_rs;
mod write;
mod xacro;

use articulated_core::description::{Base, Description};

#[cfg(feature = "urdf-rs")]
pub use self::urdf_rs::{ConversionError, from_urdf_rs, to_urdf_rs};
pub use file::{AtMost, MOST_BYTES, open_file, read_at_most, read_file};
use log::Log;
pub use problem::{Kind, Problem, Problems, Subject, quote, quote_number};
pub use snap::{MOST_SNAPPED, SNAP_EXPECTED, can_snap, nearly_right_angles};
pub use summary::{summary, summary_of_unused};
pub use unused::Unused;
pub use write::write;

/// How to read.
#[derive(Clone, Debug)]
pub struct Options {
    /// The name of the file in messages. It is not opened.
    pub file: String,
    /// Whether the root link is the base or moves freely; decides only what is reported as unused.
    pub base: Base,
    /// Makes an inertia that is not positive semi-definite a warning instead of an error. One that is negative by rounding alone always is a warning.
    pub allow_unphysical_inertia: bool,
    /// Replaces an angle of an `<origin>` that is within this many rad of a multiple of π/2 by that multiple: above 0, at most [`MOST_SNAPPED`];
    /// anything else is an error. `None` leaves every number as written.
    pub snap_angles: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { file: "<urdf>".into(), base: Base::Fixed, allow_unphysical_inertia: false, snap_angles: None }
    }
}

/// What was read, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The robot. A bound that a `<limit>` leaves open is infinite: `lower` and `upper` of a continuous joint, `effort`
    /// and `velocity` that are not given. `axis` is (1, 0, 0) and `limit` and `dynamics` are `None` for joints that have no use for them.
    pub description: Description,
    /// What looks wrong; the values were used as written.
    pub warnings: Vec<Problem>,
    /// What the file says and the description leaves out, or what only some scenes use.
    pub unused: Vec<Unused>,
    /// Every angle that was replaced because of [`Options::snap_angles`].
    pub snapped: Vec<Problem>,
}

/// Description of the robot in `bytes`. Lengths in m, masses in kg, angles in rad, as URDF has them. Exact: every number
/// is the double nearest to its spelling. Errors: all of the file's at once, at most 1000.
pub fn read(bytes: &[u8], options: &Options) -> Result<Reading, Problems> {
    let mut log = Log::new(options.file.clone());
    snap::check(options.snap_angles, &mut log);
    match read_into(bytes, options, &mut log) {
        Some(description) if log.errors.is_empty() => Ok(log.reading(description)),
        _ => Err(log.problems()),
    }
}

fn read_into(bytes: &[u8], options: &Options, log: &mut Log) -> Option<Description> {
    let draft = draft(bytes, options, log)?;
    let tree = tree::connect(&draft, log);
    let leaders = mimic::leaders(&draft.joints, log);
    let tree = tree.filter(|_| log.errors.is_empty())?;
    if options.base == Base::Fixed {
        base::report(&draft, &tree, log);
    }
    let description = described::described(&draft, &tree, &leaders)?;
    #[cfg(feature = "second-reader")]
    bridge::compare(&description, &draft, &tree, &leaders, log);
    Some(description)
}

fn draft(bytes: &[u8], options: &Options, log: &mut Log) -> Option<draft::Draft> {
    let text = document::text(bytes, log)?;
    let lines = lines::Lines::of(&text);
    let document = document::parse(&text, &lines, log)?;
    let robot = document::robot(&document, &lines, log)?;
    if xacro::report(&robot, log) {
        return None;
    }
    Some(robot::draft(&robot, options, log))
}
