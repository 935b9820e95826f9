//! Spatial algebra: 6-vectors are (angular; linear).
//!
//! Sources: Lynch & Park, *Modern Robotics*, 2017, ch. 3 and 8; Featherstone, *Rigid Body Dynamics
//! Algorithms*, 2008, ch. 2.

mod articulated;
mod coriolis;
mod inertia;
mod input_quaternion;
mod motion;
mod placement;
mod reference;
mod rotation;
pub mod screw;
mod twist;
mod wrench;

pub use articulated::ArticulatedInertia;
pub use coriolis::CoriolisInertia;
pub use inertia::SpatialInertia;
pub use input_quaternion::{NORM_TOLERANCE, input_norm, normalise_input};
pub use motion::{Motion, rate_matrix, rates_about};
pub use placement::Placement;
pub use reference::Reference;
pub use rotation::{from_quaternion, from_rpy, nearest_rotation, rotate, rotate_back, sin_cos_of_written_angle, to_z_axis, turned_about_z};
pub use twist::Twist;
pub use wrench::Wrench;

pub use nalgebra::{Matrix3, Vector3};
