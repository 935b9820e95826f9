//! Readers of robot files: the bytes of a file become a [`Description`], or all errors of the file
//! at once.
//!
//! [`read_file`] reads the bytes of a file, [`read`] returns a [`Reading`] with the description,
//! and [`urdf::write`] writes a description as a URDF:
//!
//! ```
//! use articulated_core::description::JointId;
//! use articulated_formats::{Options, read};
//!
//! let bytes = br#"<robot name="door">
//!   <link name="frame"/>
//!   <link name="leaf"><inertial><mass value="8"/>
//!     <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="0.2"/></inertial></link>
//!   <joint name="hinge" type="continuous"><parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/></joint>
//! </robot>"#;
//! let reading = read(bytes, &Options::default()).unwrap();
//! assert_eq!(reading.description.joints[JointId(0)].axis, [0.0, 0.0, 1.0]);
//! let text = articulated_formats::urdf::write(&reading.description);
//! assert_eq!(read(text.as_bytes(), &Options::default()).unwrap().description, reading.description);
//!
//! let diagnostics = read(b"<robot name='nothing'/>", &Options::default()).unwrap_err();
//! assert!(diagnostics.to_string().contains("link"));
//! ```
//!
//! A file of at most [`MOST_BYTES`], with its name in all messages:
//!
//! ```no_run
//! use articulated_core::description::JointId;
//! use articulated_formats::{MOST_BYTES, Options, read, read_file};
//!
//! let bytes = read_file("arm.urdf".as_ref(), MOST_BYTES)?;
//! match read(&bytes, &Options { file: "arm.urdf".into(), ..Options::default() }) {
//!     Ok(reading) => reading.warnings.iter().for_each(|warning| eprintln!("warning: {warning}")),
//!     Err(diagnostics) => eprintln!("{diagnostics}"),
//! }
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! Invariants:
//!
//! * A format is one module and one row of [`FORMATS`]. No other crate names a type of a format.
//! * A reader reports all findings to one [`Diagnostics`] and continues as far as it can.
//! * Only [`Sources`] open files. [`read`] opens none.

mod actuation;
mod constraints;
mod contact_points;
mod cycles;
mod files;
mod format;
mod leave_out;
mod mass;
mod mesh_file;
pub mod mjcf;
mod pose;
mod reading;
pub mod sdf;
mod snap;
mod taken;
pub mod urdf;
pub mod world;
mod xacro;
mod xml;

#[cfg(doc)]
use articulated_core::description::Description;
#[cfg(doc)]
use articulated_core::diagnostic::Diagnostics;

pub use actuation::OnLockedJoint;
pub use files::{AtMost, Disk, Environment, Included, MOST_BYTES, NoFiles, Sources, nearest_file, open_file, read_at_most, read_file};
pub use format::{FORMATS, Format, Formats, Input};
pub use leave_out::{LeaveOut, NoKind};
pub use mass::beyond_any_mass;
pub use reading::{Options, Reading, included, read, read_with};
pub use snap::{MOST_SNAPPED, SNAP_EXPECTED, can_snap, nearly_right_angles};
pub use xacro::declares_package;
