//! The robot that a scene, or a request, asks for: its document read and edited, and the model of what comes out.
//!
//! The way: [`RobotOptions`] (from a scene: [`crate::Scene::fill_robot`]) and a document make [`RobotAsked`] → [`RobotAsked::read`] (edited) → [`RobotAsked::model`].
//! [`Opened`] does it for a scene and its files, and tells every mistake of both at once.

mod edit;
mod error;
mod faults;
mod odd;
mod open;
mod options;
mod place;

pub use error::{Edit, Reason, Refusal, RobotError};
pub use faults::{Tried, leave_out, tried};
pub use odd::beyond_sense;
pub use open::{Attempt, Bundled, Opened, Settled, beside, nearest_file, open, open_in, read_robot_file};
pub use options::{Appended, RobotAsked, RobotOptions};
pub use place::by_places;
