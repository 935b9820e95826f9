//! A scene's motion: robot, state, control and events put together, and run.

use std::fmt;
use std::time::{Duration, Instant};

use articulated::Dynamics;
use articulated::simulate::{Control, Counts, Drive, Ended, Reached, Recording, Settings, SimulateError, Simulation};

use crate::creep::Creep;
use crate::detectors::{Detectors, UnavailableEvent};
use crate::error::{Fault, MotionErrors};
use crate::initial_state::InitialState;
use crate::occurrence::Occurrence;
use crate::penetration::Penetration;
use crate::rolling::Rolling;
use crate::session::Session;
use crate::slide::Slide;
use crate::statistics::{Found, Statistics};

/// A scene on a robot, with all the room that its simulation needs. It may be run again and again.
pub struct Motion<'a, R: Dynamics<f64>> {
    session: &'a Session,
    robot: &'a R,
    detectors: Detectors<'a>,
    simulation: Simulation<'a>,
}

/// The result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The motion at the output times, with work counts ([`Recording::counts`]); up to the error if
    /// one ended the run.
    pub recording: Recording,
    /// Occurrences in the order of time, one for each of [`Recording::events`].
    pub occurrences: Vec<Occurrence>,
    /// The contact and the joint with dry friction that crept furthest where smoothed friction
    /// should hold them, at most one of each kind. Like the fields below, it is a statistic over
    /// the steps and does not depend on the outputs.
    pub creep: Vec<Creep>,
    /// Links that went below a plane of contact where no contact holds them, the deepest first.
    pub penetrations: Vec<Penetration>,
    /// Links with contacts that move although friction would hold them.
    pub slides: Vec<Slide>,
    /// Spheres that roll faster than the tolerance resolves.
    pub rolling: Vec<Rolling>,
    /// How it ended.
    pub ending: Ending,
    /// The time that was reached, s.
    pub reached: f64,
    /// Kinetic energy gained by the ball of the scene's impact, J; `None` if nothing hit it.
    pub ball: Option<f64>,
    /// The error that ended the run early.
    pub error: Option<SimulateError>,
    /// Wall time of the run.
    pub wall: Duration,
}

/// How a motion ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The end time was reached.
    AtEnd,
    /// The scene's impact ended the run.
    ByBlow,
    /// The observer stopped the run.
    ByObserver,
    /// An error ended the run.
    ByError,
}

impl Session {
    /// The scene on a robot, with these settings. `frames` are the names of the robot's frames in
    /// its order: `FRAME_NAMES` of a generated module, [`Session::frame_names`] for the model.
    /// Errors, all at once: a robot that does not match the scene's or lacks required frames and
    /// functions (see [`Session::frames`], [`Session::functions`]); invalid settings.
    pub fn motion<'a, R: Dynamics<f64>, S: AsRef<str>>(
        &'a self,
        robot: &'a R,
        frames: &[S],
        settings: Settings,
    ) -> Result<Motion<'a, R>, MotionErrors>
    where
        R::Workspace: 'a,
    {
        let file = &self.scene.file;
        if self.scene.law().is_some() {
            return Err(MotionErrors::one(file, Fault::Law));
        }
        let mut faults = self.faults_of(&settings);
        faults.extend(self.shape_mismatches(robot, frames));
        faults.extend(self.missing_functions(robot, settings.integrator));
        let detectors = Detectors::new(self, robot, frames);
        let simulation = Simulation::new(robot, settings);
        // A scene's motion is checked by its energy balance.
        let simulation = simulation.map(Simulation::with_energy_balance).map_err(|e| MotionErrors::refused(file, e));
        let (_, (detectors, simulation)) = MotionErrors::both(MotionErrors::none(file, faults), MotionErrors::both(detectors, simulation))?;
        Ok(Motion { session: self, robot, detectors, simulation })
    }

    /// Runs the scene on a robot from its start to its end, with the scene's settings and control.
    /// Errors: those of [`Session::settings`], [`Session::motion`] and [`Session::initial_state`],
    /// all at once; then a robot with accelerations that differ from the scene's, for example a
    /// robot generated from the robot's file alone, without the scene's gravity and effects (use
    /// [`Session::motion`] to run such a robot). An error during the run is in [`Outcome::error`].
    pub fn run<R: Dynamics<f64>, S: AsRef<str>>(&self, robot: &R, frames: &[S]) -> Result<Outcome, MotionErrors> {
        let (mut motion, initial) = self.ready(robot, frames)?;
        motion.run(&initial, &mut |_, _| true)
    }

    /// As [`Session::run`], with a user's control in place of the scene's.
    pub fn run_with<R: Dynamics<f64>, S: AsRef<str>>(
        &self,
        robot: &R,
        frames: &[S],
        control: &mut dyn Control,
    ) -> Result<Outcome, MotionErrors> {
        let (mut motion, initial) = self.ready(robot, frames)?;
        motion.run_with(&initial, control, &mut |_, _| true)
    }

    fn ready<'a, R: Dynamics<f64>, S: AsRef<str>>(
        &'a self,
        robot: &'a R,
        frames: &[S],
    ) -> Result<(Motion<'a, R>, InitialState), MotionErrors> {
        let motion = self.settings().and_then(|settings| self.motion(robot, frames, settings));
        let (motion, initial) = MotionErrors::both(motion, self.initial_state())?;
        let another = self.dynamics_mismatch(robot, &initial).unwrap_or_else(|error| Some(Fault::Function(error)));
        MotionErrors::none(&self.scene.file, another)?;
        Ok((motion, initial))
    }
}

impl<R: Dynamics<f64>> Motion<'_, R> {
    /// Requested classes of events that cannot occur.
    pub fn unavailable_events(&self) -> &[UnavailableEvent] {
        &self.detectors.unavailable
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        self.simulation.settings()
    }

    /// Makes the first step and discards it. Returns the error that stops the robot there, as
    /// [`Outcome::error`] of a run. Errors: a state or a control that does not fit the robot.
    pub fn first_step(&mut self, initial: &InitialState) -> Result<Option<SimulateError>, MotionErrors> {
        let refused = |e: SimulateError| MotionErrors::refused(&self.session.scene.file, e);
        let mut drive = Drive::new(self.robot, &initial.controller, self.session.scene.control.period).map_err(refused)?;
        self.simulation.start(&initial.q, &initial.v).map_err(refused)?;
        match self.simulation.step(&mut drive) {
            Ok(_) => Ok(None),
            Err(e @ (SimulateError::Settings(_) | SimulateError::State(_) | SimulateError::Function(_))) => Err(refused(e)),
            Err(e) => Ok(Some(e)),
        }
    }

    /// Runs from the start to the end, to the impact that ends the scene, or to an error, which is
    /// part of the outcome. `observer` receives the time, s, and the counts after each step, and
    /// returns false to stop the run. Errors, before the run: a state or a control that does not
    /// fit the robot.
    pub fn run(&mut self, initial: &InitialState, observer: &mut dyn FnMut(f64, &Counts) -> bool) -> Result<Outcome, MotionErrors> {
        let drive = Drive::new(self.robot, &initial.controller, self.session.scene.control.period);
        let mut drive = drive.map_err(|e| MotionErrors::refused(&self.session.scene.file, e))?;
        self.run_with(initial, &mut drive, observer)
    }

    /// As [`Motion::run`], with a user's control in place of the scene's.
    pub fn run_with(
        &mut self,
        initial: &InitialState,
        control: &mut dyn Control,
        observer: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<Outcome, MotionErrors> {
        let refused = |e: SimulateError| MotionErrors::refused(&self.session.scene.file, e);
        self.detectors.reset();
        let (over, mut reached) = (self.detectors.over(), self.simulation.settings().start);
        let mut recording = self.simulation.recording();
        let mut statistics = Statistics::from(self.session, self.simulation.settings(), &initial.q, &initial.v);
        let mut after_step = |step: &Reached<'_>| {
            reached = step.t;
            statistics.step(step.t, step.q, step.v);
            observer(step.t, step.counts) && !over()
        };
        let clock = Instant::now();
        let result =
            self.simulation.run_observed((&initial.q, &initial.v), control, &mut self.detectors.events, &mut recording, &mut after_step);
        let wall = clock.elapsed();
        let error = match result {
            Ok(()) => None,
            // The run has not started.
            Err(e @ (SimulateError::Settings(_) | SimulateError::State(_) | SimulateError::Function(_))) => return Err(refused(e)),
            Err(e) => Some(e),
        };
        let ending = Ending::of(recording.ended, over());
        let reached = match ending {
            Ending::AtEnd => self.simulation.settings().end,
            _ => recording.t.last().map_or(reached, |t| t.max(reached)),
        };
        let occurrences = recording.events.iter().map(|hit| self.detectors.occurrence(hit)).collect();
        let Found { creep, penetrations, slides, rolling } = statistics.found();
        Ok(Outcome {
            recording,
            occurrences,
            creep,
            penetrations,
            slides,
            rolling,
            ending,
            reached,
            ball: self.detectors.ball_energy(),
            error,
            wall,
        })
    }
}

impl Ending {
    /// An impact ends the run through the observer callback.
    fn of(ended: Ended, blow: bool) -> Self {
        match ended {
            Ended::Not => Self::ByError,
            Ended::AtEnd => Self::AtEnd,
            Ended::ByObserver if !blow => Self::ByObserver,
            Ended::ByObserver | Ended::ByEvent(_) => Self::ByBlow,
        }
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AtEnd => "at its end",
            Self::ByBlow => "by an event",
            Self::ByObserver => "by the observer",
            Self::ByError => "by an error",
        })
    }
}
