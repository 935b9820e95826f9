//! The initial state and controller of a motion, with warnings about them.

use std::fmt;

use articulated::Dynamics;
use articulated_core::Plain;
use articulated_core::effect::{Applied, EffectId, unit};
use articulated_core::spatial::screw::Quaternion;
use articulated_scene::{Controller, RobotInWorld};

use crate::error::MotionErrors;
use crate::freedom::Freedom;
use crate::session::{Session, field};

/// Initial state and controller.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialState {
    /// Coordinates, `[nq]` rad|m|unit quaternion.
    pub q: Vec<f64>,
    /// Rates, `[nv]` rad/s|m/s.
    pub v: Vec<f64>,
    /// The controller, with vectors in the order of the robot.
    pub controller: Controller,
}

/// A joint that starts beyond its limits: a warning; the state is used.
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

impl Session {
    /// Initial state and control of the scene. Errors: entries that do not fit the robot, and
    /// unreadable tables.
    pub fn initial_state(&self) -> Result<InitialState, MotionErrors> {
        let robot = RobotInWorld { model: &self.model, world: &self.world };
        let start = self.scene.start(robot).map_err(MotionErrors::from);
        let controller = self.scene.controller(robot, &mut |file| self.file(file)).map_err(MotionErrors::from);
        let ((q, v), controller) = MotionErrors::both(start, controller)?;
        Ok(InitialState { q, v, controller })
    }

    /// The joints of one coordinate, mimic joints included, and the ball joints that are beyond the
    /// file's limits at the initial q `[nq]`. The limit of a ball joint is on its angle.
    pub fn beyond(&self, q: &[f64]) -> Vec<Beyond> {
        let beyond = |at: Freedom<'_>| {
            let ((lower, upper), found) = (self.of_the_file(at.body)?, at.own.coordinate(q)?);
            let beyond = || Beyond { file: self.scene.file.clone(), joint: at.joint().to_owned(), found, lower, upper };
            (found < lower || found > upper).then(beyond)
        };
        let balls = self.model.bodies().iter().skip(1).filter_map(|body| {
            let (upper, at) = (self.cone_of_the_file(body)?, body.coordinates.q);
            let found = Quaternion::from_array(q.get(at..at + 4)?.try_into().ok()?).angle();
            let beyond = || Beyond { file: self.scene.file.clone(), joint: body.name.clone(), found, lower: 0.0, upper };
            (found > upper).then(beyond)
        });
        self.freedoms().filter_map(beyond).chain(balls).collect()
    }
}

/// A contact sphere that starts with its centre under the plane: a warning, since the stored energy
/// throws the robot up. A point (radius 0) rests below its plane, so it counts only if it pushes
/// with more than the robot's weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Sunk {
    /// The scene's file.
    pub file: String,
    /// The link.
    pub link: String,
    /// Depth of the centre under the plane, m.
    pub depth: f64,
}

impl Session {
    /// Spheres with centres under their planes at the coordinates q `[nq]`.
    pub fn sunk(&self, q: &[f64]) -> Vec<Sunk> {
        if self.effects_of(EffectId::contact).next().is_none() {
            return Vec::new();
        }
        let mut places = vec![0.0; 12 * self.model.frames().len()];
        if self.model.placements(&mut self.model.workspace(), q, &mut places).is_err() {
            return Vec::new();
        }
        let weight = self.model.moving_mass() * self.model.gravity().norm();
        let sunk = |contact: &Applied| {
            let frame = self.model.frames().position(|frame| frame.name == contact.on)?;
            let (x, r, normal) = (&places[12 * frame.0..][..12], contact.at.xyz, unit(field(contact, "normal").try_into().ok()?)?);
            let centre = |k: usize| x[9 + k] + (0..3).map(|c| x[3 * k + c] * r[c]).sum::<f64>();
            let depth = field(contact, "height").first()? - (0..3).map(|k| normal[k] * centre(k)).sum::<f64>();
            // A point at rest pushes with no more than the weight.
            let stands = *field(contact, "radius").first()? == 0.0 && field(contact, "stiffness").first()? * depth <= weight;
            (depth > 0.0 && !stands).then(|| Sunk { file: self.scene.file.clone(), link: contact.on.clone(), depth })
        };
        self.effects_of(EffectId::contact).filter_map(sunk).collect()
    }
}

impl fmt::Display for Sunk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, link, depth } = self;
        write!(
            f,
            "{file}: effects.contact.{link}: found the centre of the sphere {depth} m under the plane at the start, expected it above (by height, normal or initial.q); used as given"
        )
    }
}

impl fmt::Display for Beyond {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, joint, .. } = self;
        let [found, lower, upper] = [self.found, self.lower, self.upper].map(Plain);
        write!(f, "{file}: initial.q.{joint}: found {found}, beyond its limits, expected {lower} to {upper}; used as given")
    }
}
