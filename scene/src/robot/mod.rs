//! The robot that a scene or a request describes: its document read and edited, and its model.
//!
//! [`Loader`] reads the files. [`RobotOptions`] (from a scene: [`crate::Scene::fill_robot`]) and a
//! document make a [`RobotRequest`]; [`RobotRequest::build`] makes the robot and reports all
//! findings at once.

mod append;
mod build;
mod load;
mod options;
mod warnings;

pub use build::BuiltRobot;
pub use load::{Bundled, Loader, Opened, beside, folder_of, open, open_in, open_in_into, open_into};
pub use options::{Appended, RobotOptions, RobotRequest};
pub use warnings::beyond_sense;
