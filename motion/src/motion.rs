//! A scene's motion: robot, state, control and events put together, and run.

use std::fmt;
use std::time::{Duration, Instant};

use articulated::Dynamics;
use articulated::simulate::{Control, Counts, Drive, Ended, Recording, Settings, SimulateError, Simulation};

use crate::creep::Creep;
use crate::detectors::{Detectors, UnavailableEvent};
use crate::error::{Fault, MotionErrors};
use crate::initial_state::InitialState;
use crate::occurrence::Occurrence;
use crate::session::Session;

/// A scene on a robot, with all the room that its simulation needs. It may be run again and again.
pub struct Motion<'a, R: Dynamics<f64>> {
    session: &'a Session,
    robot: &'a R,
    detectors: Detectors<'a>,
    simulation: Simulation<'a, R>,
}

/// What came of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The motion at the times of output, with what was done ([`Recording::counts`]); where an error ended it, what was up to there.
    pub recording: Recording,
    /// What happened on the way, in the order of time: one for each of [`Recording::events`].
    pub occurrences: Vec<Occurrence>,
    /// What smoothed friction did not hold, and how far it crept ([`Session::creep`]).
    pub creep: Vec<Creep>,
    /// How it ended.
    pub ending: Ending,
    /// The time that was reached, s.
    pub reached: f64,
    /// Kinetic energy that the ball of the scene's impact got, J, if its turn came.
    pub ball: Option<f64>,
    /// Why it did not go on to its end.
    pub error: Option<SimulateError>,
    /// How long the run took, by the clock of the machine.
    pub wall: Duration,
}

/// How a motion ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ending {
    /// At its last time.
    AtEnd,
    /// By a blow with which the scene ends.
    ByBlow,
    /// Who followed it wanted no more.
    ByFollower,
    /// By an error.
    ByError,
}

impl Session {
    /// The scene on a robot, to be simulated so; `frames` are the names of the robot's frames in its order: `FRAME_NAMES` of a generated module, [`Session::frame_names`] of
    /// the model. Errors: a robot that is another than the scene's, or has not the frames and functions that the scene needs (see [`Session::frames`],
    /// [`Session::functions`]); settings that cannot be used; all of it.
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
        let mut faults = self.faults_of(&settings);
        faults.extend(self.shape_mismatches(robot, frames));
        faults.extend(self.missing_functions(robot, settings.integrator));
        let detectors = Detectors::new(self, robot, frames);
        let simulation = Simulation::new(robot, settings);
        // A motion of a scene is judged by its balance of energy.
        let simulation = simulation.map(Simulation::with_energy_balance).map_err(|e| MotionErrors::refused(file, e));
        let (_, (detectors, simulation)) = MotionErrors::both(MotionErrors::none(file, faults), MotionErrors::both(detectors, simulation))?;
        Ok(Motion { session: self, robot, detectors, simulation })
    }

    /// The scene on a robot from its start to its end, all as the scene says: the simplest way. Errors: as [`Session::settings`], [`Session::motion`] and
    /// [`Session::initial_state`], all of them; then a robot that accelerates otherwise than the scene's, as one does that was made from its URDF alone, without the scene's gravity and effects
    /// (to move such a one on purpose there is [`Session::motion`]). An error on the way is in [`Outcome::error`].
    pub fn run<R: Dynamics<f64>, S: AsRef<str>>(&self, robot: &R, frames: &[S]) -> Result<Outcome, MotionErrors> {
        let (mut motion, initial) = self.ready(robot, frames)?;
        motion.run(&initial, &mut |_, _| true)
    }

    /// As [`Session::run`], by a control of one's own in place of the scene's.
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
    /// Sorts of events that the scene looks for and has nothing of.
    pub fn unavailable_events(&self) -> &[UnavailableEvent] {
        &self.detectors.unavailable
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        self.simulation.settings()
    }

    /// Makes the first step from the start and throws it away. Errors: a state, or a control, that
    /// does not fit the robot. What keeps the robot from moving is the result, as
    /// [`Outcome::error`] would be of a run.
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

    /// From the start to the end, to the blow that ends it, or to an error, which is part of what came of it. `follow` is told the time, s, and the counts after
    /// each step, and may say false to end it. Errors: a state, or a control, that does not fit the robot: nothing was done.
    pub fn run(&mut self, initial: &InitialState, follow: &mut dyn FnMut(f64, &Counts) -> bool) -> Result<Outcome, MotionErrors> {
        let drive = Drive::new(self.robot, &initial.controller, self.session.scene.control.period);
        let mut drive = drive.map_err(|e| MotionErrors::refused(&self.session.scene.file, e))?;
        self.run_with(initial, &mut drive, follow)
    }

    /// As [`Motion::run`], by a control of one's own in place of the scene's.
    pub fn run_with(
        &mut self,
        initial: &InitialState,
        control: &mut dyn Control,
        follow: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<Outcome, MotionErrors> {
        let refused = |e: SimulateError| MotionErrors::refused(&self.session.scene.file, e);
        self.detectors.reset();
        let (over, mut reached) = (self.detectors.over(), self.simulation.settings().start);
        let mut recording = self.simulation.recording();
        let mut after_step = |t: f64, counts: &Counts| {
            reached = t;
            follow(t, counts) && !over()
        };
        let clock = Instant::now();
        let result = self.simulation.run_into(&initial.q, &initial.v, control, &mut self.detectors.events, &mut recording, &mut after_step);
        let wall = clock.elapsed();
        let error = match result {
            Ok(()) => None,
            // Nothing was done yet.
            Err(e @ (SimulateError::Settings(_) | SimulateError::State(_) | SimulateError::Function(_))) => return Err(refused(e)),
            Err(e) => Some(e),
        };
        let ending = Ending::of(recording.ended, over());
        let reached = match ending {
            Ending::AtEnd => self.simulation.settings().end,
            _ => recording.t.last().map_or(reached, |t| t.max(reached)),
        };
        let occurrences = recording.events.iter().map(|hit| self.detectors.occurrence(hit)).collect();
        let creep = self.session.creep(&recording);
        Ok(Outcome { recording, occurrences, creep, ending, reached, ball: self.detectors.ball_energy(), error, wall })
    }
}

impl Ending {
    /// A blow ends a motion by who watches it.
    fn of(ended: Ended, blow: bool) -> Self {
        match ended {
            Ended::Not => Self::ByError,
            Ended::AtEnd => Self::AtEnd,
            Ended::ByWatcher if !blow => Self::ByFollower,
            Ended::ByWatcher | Ended::ByEvent(_) => Self::ByBlow,
        }
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AtEnd => "at its end",
            Self::ByBlow => "by an event",
            Self::ByFollower => "by who followed it",
            Self::ByError => "by an error",
        })
    }
}
