//! A loaded scene with its robot: its start, its code, and its motion.

use std::ops::Deref;
use std::path::{Path, PathBuf};

use articulated::Dynamics;
use articulated::simulate::{Counts, IntegratorId, Settings};
use articulated_codegen::scene::Prepared;
use articulated_codegen::{Generated, Request};
use articulated_core::description::Base;
use articulated_core::diagnostic::summary;
use articulated_motion::{InitialState, MotionErrors, Outcome, Sunk};
use articulated_scene::{BuiltRobot, Robot, beyond_sense};

use crate::console;
use crate::error::Error;

/// A scene with its moving robot, and further data for the command.
pub struct Session {
    /// Of the scene, without folder and ending.
    pub name: String,
    /// The request for the generated code of the robot.
    pub request: Request,
    /// Warnings about the robot.
    pub robot_warnings: Vec<String>,
    /// Folders of the files that the robot was read from, its own first.
    pub folders: Vec<PathBuf>,
    session: articulated_motion::Session,
}

impl Deref for Session {
    type Target = articulated_motion::Session;

    fn deref(&self) -> &Self::Target {
        &self.session
    }
}

impl Session {
    /// Refuses a level with functions of `f32`, which the callers here do not have.
    pub fn is_of_doubles(&self) -> Result<(), Error> {
        let level = self.request.options.level;
        if !level.is_single() {
            return Ok(());
        }
        Err(Error::input([format!("{}: level: found {level}, expected one whose functions take f64, as states here are", self.scene.file)]))
    }

    /// The session of a scene that was read. `folder`: the folder of its file, for other files that
    /// it names.
    pub fn new(name: String, prepared: Prepared, folder: PathBuf) -> Result<Self, Error> {
        let Prepared { scene, mut request, robot, files } = prepared;
        let BuiltRobot { reading, model, resolved, effects, .. } = robot;
        // Variants of the request replace its effects.
        (request.scene, request.options.robot.effects) = (None, effects.clone());
        request.options.robot.frames = None;
        // Bundled robots have unusual content on purpose.
        let robot_warnings = reading.warnings.iter().filter(|_| !matches!(scene.robot, Robot::Bundled(_)));
        let robot_warnings = summary(robot_warnings.chain(&reading.snapped));
        let mut session =
            articulated_motion::Session::new(scene, reading.description, model, effects).in_world(reading.world).in_folder(folder);
        session.report = resolved.report;
        // The first file is the scene's; a bundled scene has none.
        let folders = files.iter().skip(1).chain(files.first()).filter_map(|file| file.parent()).map(Path::to_owned).collect();
        Ok(Self { name, request, robot_warnings, folders, session })
    }

    /// The initial state and the control of the motion; warnings are printed. Errors: all data that
    /// do not fit the robot, and unreadable tables.
    pub fn start(&self) -> Result<InitialState, Error> {
        let initial = self.initial_state()?;
        self.warnings(&initial).iter().for_each(|line| console::warn(line));
        Ok(initial)
    }

    /// Warnings about the state at the start.
    pub fn warnings(&self, initial: &InitialState) -> Vec<String> {
        let beyond = self.beyond(&initial.q).iter().map(ToString::to_string).collect::<Vec<_>>();
        let file = &self.scene.file;
        let senseless = beyond_sense(&self.model, &initial.q).into_iter().map(|line| format!("{file}: initial: {line}"));
        let sunk = summary_of_sunk(&self.sunk(&initial.q));
        beyond.into_iter().chain(senseless).chain(sunk).chain(self.warning_of_penetrations_at_start(&initial.q)).collect()
    }

    /// The code that a simulation of the scene needs, and its frames.
    pub fn generate(&self, integrator: IntegratorId) -> Result<(Generated, Vec<String>), Error> {
        self.is_of_doubles()?;
        let frames = self.frames();
        let mut request = self.request.clone();
        request.options.functions = self.functions(integrator).into_iter().map(Into::into).collect();
        request.set_frames(&frames);
        (request.options.rust_mut().runtime, request.options.stages) = (None, false);
        (request.options.parameters, request.options.batch) = (Vec::new(), Vec::new());
        Ok((articulated_codegen::generate(&request)?, frames))
    }

    /// Runs the motion by this implementation of its functions, and its frames.
    pub(crate) fn run_by<R: Dynamics<f64>, S: AsRef<str>>(
        &self,
        initial: &InitialState,
        (robot, frames): (&R, &[S]),
        settings: &Settings,
        look: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<(Outcome, Vec<String>), MotionErrors> {
        let mut motion = self.motion(robot, frames, settings.clone())?;
        let unavailable: Vec<String> = motion.unavailable_events().iter().map(ToString::to_string).collect();
        unavailable.iter().for_each(|line| console::warn(line));
        let outcome = motion.run(initial, look)?;
        Ok((outcome, unavailable))
    }

    /// Whether the base is fixed or floats.
    pub fn base(&self) -> Base {
        self.request.options.robot.base
    }
}

/// Implementation of the functions of a motion. All runs are compiled in this crate, which is
/// optimised more than the command.
pub trait Code {
    /// Runs the motion of a scene; `look` gets the time and the counts after each step, and returns
    /// false to stop the run. Returns the outcome, and events of the scene that the code lacks.
    fn run(
        &self,
        session: &Session,
        initial: &InitialState,
        settings: &Settings,
        look: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<(Outcome, Vec<String>), MotionErrors>;
}

/// The generic library.
#[derive(Clone, Copy, Debug)]
pub struct Generic;

impl Code for Generic {
    fn run(
        &self,
        session: &Session,
        initial: &InitialState,
        settings: &Settings,
        look: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<(Outcome, Vec<String>), MotionErrors> {
        session.run_by(initial, (&session.model, &session.frame_names()), settings, look)
    }
}

/// The deepest contact that starts under its plane, and how many more there are.
fn summary_of_sunk(sunk: &[Sunk]) -> Option<String> {
    let deepest = sunk.iter().max_by(|a, b| a.depth.total_cmp(&b.depth))?;
    let more = if sunk.len() == 1 { String::new() } else { format!(" (and {} more, less deep)", sunk.len() - 1) };
    Some(format!("{deepest}{more}"))
}

/// The joint that a number of a step belongs to: steps of q first, then v.
pub fn joint_of(session: &Session, number: usize) -> Option<String> {
    let freedom = number % session.model.nv().max(1);
    Dynamics::joint_of(&session.model, freedom).filter(|name| !name.is_empty()).map(str::to_owned)
}

/// The bundled robots, as scenes name them.
#[cfg(all(test, feature = "measure"))]
fn robots() -> Vec<articulated_codegen::scene::Bundled<'static>> {
    let all = articulated_models::ROBOTS.iter();
    all.map(|robot| articulated_codegen::scene::Bundled { name: robot.name, document: robot.urdf, base: robot.base }).collect()
}

/// A bundled scene.
#[cfg(all(test, feature = "measure"))]
pub(crate) fn bundled(name: &str) -> Session {
    use articulated_codegen::scene::{Scene, open_in};
    let scene = articulated_models::scene(name).expect("a bundled scene");
    let read = Scene::read(&scene.file(), scene.toml).expect("a scene that can be read");
    let prepared = open_in(read, std::path::Path::new(""), &robots()).expect("a scene that can be opened");
    Session::new(name.to_owned(), prepared, PathBuf::new()).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene of a file.
#[cfg(all(test, feature = "measure"))]
pub(crate) fn opened(path: &std::path::Path) -> Session {
    let prepared = articulated_codegen::scene::open(path, &robots()).expect("a scene that can be opened");
    let folder = path.parent().expect("a folder").to_owned();
    Session::new(path.display().to_string(), prepared, folder).unwrap_or_else(|error| panic!("{error}"))
}
