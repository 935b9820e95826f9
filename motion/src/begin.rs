//! What a motion begins with: a state, and what drives the joints.

use std::fmt;

use articulated_scene::Controller;

use crate::error::MotionErrors;
use crate::freedom::Freedom;
use crate::stage::Stage;

/// The state that a motion starts from, and what drives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Begin {
    /// Coordinates, `[nq]` rad|m|unit quaternion.
    pub q: Vec<f64>,
    /// Rates, `[nv]` rad/s|m/s.
    pub v: Vec<f64>,
    /// What drives the joints, with vectors in the order of the robot.
    pub controller: Controller,
}

/// A joint that starts beyond its limits: odd, and used as asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// The scene's file.
    pub file: String,
    /// The joint's name.
    pub joint: String,
    /// Its coordinate at the start, rad or m.
    pub found: f64,
    /// Its lower limit, rad or m.
    pub lower: f64,
    /// Its upper limit, rad or m.
    pub upper: f64,
}

impl Stage {
    /// Start and control as the scene has them. Errors: all that does not fit the robot, and tables that cannot be read.
    pub fn begin(&self) -> Result<Begin, MotionErrors> {
        let start = self.scene.start(&self.model).map_err(MotionErrors::from);
        let controller = self.scene.controller(&self.model, &mut |file| self.file(file)).map_err(MotionErrors::from);
        let ((q, v), controller) = MotionErrors::both(start, controller)?;
        Ok(Begin { q, v, controller })
    }

    /// The joints of one coordinate that are beyond the limits of the file at q `[nq]`, where a motion starts; those that follow others too.
    pub fn beyond(&self, q: &[f64]) -> Vec<Beyond> {
        let beyond = |at: Freedom<'_>| {
            let ((lower, upper), found) = (self.of_the_file(at.body)?, at.own(*q.get(at.q)?));
            let beyond = || Beyond { file: self.scene.file.clone(), joint: at.joint().to_owned(), found, lower, upper };
            (found < lower || found > upper).then(beyond)
        };
        self.freedoms().filter_map(beyond).collect()
    }
}

impl fmt::Display for Beyond {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, joint, found, lower, upper } = self;
        write!(f, "{file}: initial.q.{joint}: found {found}, beyond its limits, expected {lower} to {upper}; used as asked for")
    }
}
