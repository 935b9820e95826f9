//! A simulation: steps, outputs and events one after the other.

mod pace;
mod records;
mod step_events;
mod stepping;
mod stiffness;

use std::f64::consts::TAU;

use articulated_core::algorithm::Shape;
use articulated_core::dynamics::Dynamics;

use self::pace::Pace;
use self::stiffness::Held;
use crate::simulate::control::wrong_period;
use crate::simulate::curve::Point;
use crate::simulate::erased::Erased;
use crate::simulate::event::detectors::Detectors;
use crate::simulate::integrator::{Method, Start, method};
use crate::simulate::output::{Known, Times};
use crate::simulate::stability::Stability;
use crate::simulate::step_control::{Controller, Error, Norm, first_step, rounding};
use crate::simulate::system::{AT_REST, System};
use crate::simulate::{Control, Counts, Ended, Event, Output, Recording, Settings, SimulateError, StateError, Stiffness};

/// A robot and all the memory that its simulation needs; a step allocates nothing.
pub struct Simulation<'r> {
    settings: Settings,
    shape: Shape,
    system: System<'r>,
    method: Box<dyn Method + 'r>,
    norm: Norm,
    stability: Stability,
    detectors: Detectors,
    known: Known,
    progress: Progress,
    /// Room that steps one by one take in place of records.
    unrecorded: Option<Box<Recording>>,
    /// State at the start of a step and its rate, in the step's chart; state at its end.
    t: f64,
    y: Vec<f64>,
    f: Vec<f64>,
    end: Vec<f64>,
    point: Point,
    v: Vec<f64>,
    spare: Vec<f64>,
}

/// The state that a step of a run reached.
#[derive(Clone, Copy, Debug)]
pub struct Reached<'a> {
    /// The time, s.
    pub t: f64,
    /// The configuration, `[nq]`.
    pub q: &'a [f64],
    /// The velocity, `[nv]`.
    pub v: &'a [f64],
    /// Counts since the start.
    pub counts: &'a Counts,
}

/// Inputs of a run: the controller of the joints, the events to find, and the destination of
/// records.
struct Run<'a, 'e> {
    control: &'a mut dyn Control,
    events: &'a mut [Event<'e>],
    recording: &'a mut Recording,
}

/// Progress of a motion, besides the state.
struct Progress {
    /// When to record; `None`: never.
    times: Option<Times>,
    /// The most steps, rejected ones included.
    most_steps: u64,
    /// Whether the first step is prepared.
    started: bool,
    controller: Option<Controller>,
    /// The step to try next, s.
    h: f64,
    /// For a sampled control: whether the next step is the first after a sample, and the step to
    /// try there, s, by the error of the last such step.
    after_sample: (bool, f64),
    /// Where the present stretch began, and its steps so far.
    stretch: (f64, u64),
    /// When the stretch ends, s: at the next sample, kink or the end.
    until: f64,
    /// Of a sampled control: the time between samples, s, and the samples so far.
    period: Option<f64>,
    samples: u64,
    /// The first of the recorded events that cut the last step short.
    cut: usize,
    chatter: u32,
    /// The last event that mapped the state, and when.
    last_map: (usize, f64),
    held: Held,
    pace: Pace,
}

impl Progress {
    /// A motion begins at this time, s.
    fn begin(t: f64, controller: Option<Controller>, times: Option<Times>, most_steps: u64) -> Self {
        Self {
            times,
            most_steps,
            started: false,
            controller,
            h: 0.0,
            after_sample: (false, f64::INFINITY),
            stretch: (t, 0),
            until: t,
            period: None,
            samples: 0,
            cut: 0,
            chatter: 0,
            last_map: (0, f64::NEG_INFINITY),
            held: Held::default(),
            pace: Pace::begin(t),
        }
    }
}

/// Name of the step vector of a step in errors.
const STEP: &str = "step of q";

/// Outcome of a step.
enum Outcome {
    GoOn,
    Stopped(usize),
    Mapped,
}

impl<'r> Simulation<'r> {
    /// Everything that is wrong with the settings, or the function that the robot lacks.
    pub fn new<R: Dynamics<f64>>(robot: &'r R, settings: Settings) -> Result<Self, SimulateError> {
        let shape = robot.shape();
        let wrong = settings.problems(shape);
        if !wrong.is_empty() {
            return Err(SimulateError::Settings(wrong));
        }
        let mut system = System::new(Erased::new(robot))?;
        let (n, nv) = (system.len(), shape.nv);
        let mut simulation = Self {
            shape,
            method: method(settings.integrator, &system.manifold, settings.step.is_some() && settings.stiffness != Stiffness::Ignore),
            norm: Norm::new(&settings, nv),
            stability: Stability::new(n),
            detectors: Detectors::default(),
            known: Known::of(&mut system),
            progress: Progress::begin(settings.start, None, None, 0),
            unrecorded: None,
            t: settings.start,
            y: vec![0.0; n],
            f: vec![0.0; n],
            end: vec![0.0; n],
            point: Point::new(shape.nq, n),
            v: vec![0.0; nv],
            spare: vec![0.0; n],
            system,
            settings,
        };
        simulation.try_functions()?;
        simulation.begin_at_rest()?;
        Ok(simulation)
    }

    /// Checks that the robot has the functions of the integrator.
    fn try_functions(&mut self) -> Result<(), SimulateError> {
        let System { robot, ws, .. } = &mut self.system;
        for function in self.settings.integrator.row().needs {
            robot.check_function(ws, *function)?;
        }
        Ok(())
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Other times for the motions from now on, s: for the caller's own loop, stretch by stretch.
    pub fn set_span(&mut self, start: f64, end: f64) -> Result<(), SimulateError> {
        let before = (self.settings.start, self.settings.end);
        (self.settings.start, self.settings.end) = (start, end);
        let wrong = self.settings.problems(self.shape);
        if wrong.is_empty() {
            return Ok(());
        }
        (self.settings.start, self.settings.end) = before;
        Err(SimulateError::Settings(wrong))
    }

    /// Requests [`Recording::work`], [`Recording::dissipated`] and [`Recording::balance`]. They
    /// need the power of the motors and of the effects at every evaluation of the dynamics, and
    /// both energies after every step. Without this request a step costs little more than its
    /// dynamics.
    #[must_use]
    pub fn with_energy_balance(mut self) -> Self {
        self.system.follows_work = true;
        self
    }

    /// Room for the records of one motion.
    pub fn recording(&self) -> Recording {
        self.known.recording(&self.system, &self.settings)
    }

    /// The motion from q `[nq]` and v `[nv]` at the start to the end, or to the first event that
    /// stops it.
    pub fn run(&mut self, q: &[f64], v: &[f64], control: &mut dyn Control, events: &mut [Event]) -> Result<Recording, SimulateError> {
        let mut recording = self.recording();
        self.run_into(q, v, control, events, &mut recording, &mut |_, _| true)?;
        Ok(recording)
    }

    /// As [`Simulation::run`], into an existing recording, which also holds the motion up to an
    /// error. `observer` receives the time and the counts after each step, and may return false to
    /// end it.
    pub fn run_into(
        &mut self,
        q: &[f64],
        v: &[f64],
        control: &mut dyn Control,
        events: &mut [Event],
        recording: &mut Recording,
        observer: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<(), SimulateError> {
        self.run_observed((q, v), control, events, recording, &mut |step| observer(step.t, step.counts))
    }

    /// As [`Simulation::run_into`], with an observer of the state after each step, whatever is
    /// recorded. The start is `q` and `v`; the observer is not called there.
    pub fn run_observed(
        &mut self,
        (q, v): (&[f64], &[f64]),
        control: &mut dyn Control,
        events: &mut [Event],
        recording: &mut Recording,
        observer: &mut dyn FnMut(&Reached<'_>) -> bool,
    ) -> Result<(), SimulateError> {
        self.known.begin(&self.system, recording);
        let state = self.system.manifold.wrong_state(&self.system.robot, q, v);
        let events_wrong = events.iter().flat_map(|event| event.wrong(self.shape));
        StateError::none(state.chain(events_wrong).chain(self.wrong_control(control)))?;
        self.begin(q, v)?;
        self.progress.times = Some(Times::begin());
        self.progress.most_steps = self.settings.max_steps;
        let mut run = Run { control, events, recording };
        let result = self.steps(&mut run, observer);
        run.recording.counts = self.system.counts;
        run.recording.ended = result.map_err(|error| self.blamed(error))?;
        Ok(())
    }

    /// Errors in a control for this robot and these settings.
    fn wrong_control(&self, control: &dyn Control) -> impl Iterator<Item = StateError> {
        let expected = self.shape.nv;
        let torques = control.count().filter(|n| *n != expected).map(|found| StateError::Length { vector: "tau", found, expected });
        let period = control.period().and_then(|period| Some(wrong_period(period, self.settings.wrong_period(period)?)));
        torques.into_iter().chain(period)
    }

    /// If a torque was not a number, it is the cause of all other such numbers; if a joint moves no
    /// mass, that is the cause of missing accelerations.
    fn blamed(&mut self, error: SimulateError) -> SimulateError {
        let nv = self.shape.nv;
        match (&error, self.system.no_torque) {
            (SimulateError::NotFinite { .. }, Some((t, index))) => self.system.named(t, "tau", vec![index]),
            (SimulateError::NotFinite { what: "event", .. }, _) => error,
            (SimulateError::NotFinite { .. } | SimulateError::Singular { .. }, _) => {
                let cause = self.system.without_mass(&self.y[nv..2 * nv]);
                cause.map_or(error, |cause| SimulateError::NoMass { t: self.t, cause })
            }
            _ => error,
        }
    }

    /// All coordinates 0, quaternions of no turn, and no velocity.
    fn begin_at_rest(&mut self) -> Result<(), SimulateError> {
        let (mut q, v) = (vec![0.0; self.shape.nq], vec![0.0; self.shape.nv]);
        for free in &self.system.manifold.free {
            q[free.quaternion().end - 1] = 1.0;
        }
        self.begin(&q, &v)
    }

    fn begin(&mut self, q: &[f64], v: &[f64]) -> Result<(), SimulateError> {
        self.system.origin.copy_from_slice(q);
        self.system.counts = Counts::default();
        let controller = if self.settings.step.is_none() { self.method.controller() } else { None };
        self.progress = Progress::begin(self.settings.start, controller, None, u64::MAX);
        (self.system.holds, self.system.no_torque, self.system.over_layer) = (false, None, false);
        self.known.from_events = 0.0;
        self.method.reset();
        self.stability.reset();
        self.t = self.settings.start;
        self.y.fill(0.0);
        self.renormalise()?;
        self.y[self.shape.nv..2 * self.shape.nv].copy_from_slice(v);
        Ok(())
    }

    /// Quaternions of norm one: the step of length zero normalises.
    fn renormalise(&mut self) -> Result<(), SimulateError> {
        let nv = self.shape.nv;
        self.y[..nv].fill(0.0);
        Ok(self.system.normalise_origin(&self.y[..nv])?)
    }

    /// Everything that the first step needs.
    fn prepare(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        self.progress.period = run.control.period();
        self.sample(run);
        self.find_stretch_end(run);
        if self.progress.times.is_some() {
            self.record_here(run)?;
        }
        self.follow_balance(run)?;
        self.detectors.begin(run.events.len());
        self.take_sides(run)?;
        if self.method.wants_rate() {
            self.rate_here(run)?;
        }
        self.progress.h = self.first_step(run)?;
        self.progress.started = true;
        Ok(())
    }

    fn steps(&mut self, run: &mut Run, observer: &mut dyn FnMut(&Reached<'_>) -> bool) -> Result<Ended, SimulateError> {
        self.prepare(run)?;
        loop {
            let (outcome, mapped) = self.one_step(run)?;
            let nv = self.shape.nv;
            let state = Reached { t: self.t, q: &self.system.origin, v: &self.y[nv..2 * nv], counts: &self.system.counts };
            let goes_on = observer(&state);
            let ended = self.ended(&outcome, goes_on);
            // The end time is recorded only if the output includes it.
            let early = ended.is_some_and(|ended| mapped || ended != Ended::AtEnd);
            if early || self.settings.output == Output::Steps {
                // The state after a map is recorded beside the state before it.
                if mapped { self.record_here(run) } else { self.record_end(run) }?;
            }
            if let Some(ended) = ended {
                return Ok(ended);
            }
        }
    }

    /// One step, up to its end or to the first event that cuts it short. Returns its outcome, and
    /// whether an event has mapped the state.
    fn one_step(&mut self, run: &mut Run) -> Result<(Outcome, bool), SimulateError> {
        self.check_count()?;
        if self.progress.controller.is_some() {
            self.check_pace()?;
        }
        match self.progress.controller {
            Some(_) => self.norm.begin(&self.system, &self.y),
            // Implicit methods control their step themselves.
            None if !self.settings.integrator.row().implicit => self.check_turn()?,
            None => {}
        }
        self.check_stability(run)?;
        let t = self.make_step(run)?;
        let (stop, outcome) = self.look(run, t)?;
        let h = stop - self.t;
        self.count_step(h);
        self.check_stiffness(h)?;
        let mapped = self.advance(run, stop, matches!(outcome, Outcome::GoOn))?;
        self.follow_balance(run)?;
        debug_assert!(self.y[..self.shape.nv].iter().all(|u| *u == 0.0));
        Ok((outcome, mapped))
    }

    fn check_count(&self) -> Result<(), SimulateError> {
        let Counts { steps, rejected, .. } = self.system.counts;
        let steps = if steps + rejected >= self.progress.most_steps { self.progress.most_steps } else { return Ok(()) };
        Err(SimulateError::TooManySteps { t: self.t, steps })
    }

    /// Whether the run ends after a step with this outcome (`goes_on`: the observer's answer).
    fn ended(&self, outcome: &Outcome, goes_on: bool) -> Option<Ended> {
        match outcome {
            Outcome::Stopped(event) => Some(Ended::ByEvent(*event)),
            Outcome::GoOn if self.t >= self.settings.end => Some(Ended::AtEnd),
            _ if !goes_on => Some(Ended::ByObserver),
            _ => (self.t >= self.settings.end).then_some(Ended::AtEnd),
        }
    }

    /// The state is at the end of a stretch where a controller is sampled.
    fn sample(&mut self, run: &mut Run) {
        if self.progress.period.is_none() {
            return;
        }
        let nv = self.shape.nv;
        self.system.held.fill(0.0);
        run.control.torques(self.t, &self.system.origin, &self.y[nv..2 * nv], &mut self.system.held);
        self.system.holds = true;
        self.progress.samples += 1;
        self.progress.after_sample.0 = true;
    }

    /// Finds the next sample or kink, or the end. Torques that are held from sample to sample have
    /// no kink between; a kink that is not after t is ignored.
    fn find_stretch_end(&mut self, run: &Run) {
        let sample = self.progress.period.map(|period| self.settings.start + self.progress.samples as f64 * period);
        let kink = if sample.is_some() { f64::INFINITY } else { run.control.next_kink(self.t) };
        self.system.kink = if kink > self.t { kink } else { f64::INFINITY };
        let next = sample.unwrap_or(f64::INFINITY).min(self.system.kink).min(self.settings.end);
        // A stretch shorter than rounding is skipped.
        let least = self.t + rounding(self.t);
        self.progress.until = if next <= least { next.max(least).min(self.settings.end) } else { next };
    }

    fn rate_here(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        self.system.rate(run.control, self.t, &self.y, &mut self.f)?;
        self.check_rate()
    }

    fn check_rate(&self) -> Result<(), SimulateError> {
        let nv = self.shape.nv;
        self.system.not_finite(self.t, "acceleration", &self.f[nv..2 * nv]).map_or(Ok(()), Err)
    }

    fn first_step(&mut self, run: &mut Run) -> Result<f64, SimulateError> {
        if let Some(h) = self.settings.step.or(self.settings.first_step) {
            return Ok(h);
        }
        self.norm.begin(&self.system, &self.y);
        let order = f64::from(self.settings.integrator.row().order);
        let room = [&mut self.end[..], &mut self.point.y[..]];
        first_step(&mut self.system, run.control, &self.norm, (self.t, &self.y, &self.f), order, room)
    }

    /// Makes a step that is accepted, to `end`; returns the time where it ends, s.
    fn make_step(&mut self, run: &mut Run) -> Result<f64, SimulateError> {
        let until = self.progress.until;
        let Some(mut controller) = self.progress.controller else { return self.fixed_step(run, until) };
        // Torques jump at samples, and a step just after a jump is shorter than one before it: each
        // kind of step has its own length.
        let after_sample = std::mem::take(&mut self.progress.after_sample.0);
        if after_sample {
            self.progress.h = self.progress.h.min(self.progress.after_sample.1);
        }
        loop {
            let left = until - self.t;
            let least = self.settings.min_step.max(rounding(self.t));
            let free = self.progress.h.min(self.settings.max_step).max(least);
            // The last steps of a stretch are made alike, where halves are not too short.
            let h = if free >= 0.999 * left {
                left
            } else if free > 0.5 * left && 0.5 * left >= least {
                0.5 * left
            } else {
                free
            };
            let start = Start { t: self.t, h, y: &self.y, f: &self.f };
            let error = match self.method.step(&mut self.system, run.control, start, &mut self.end, &self.norm) {
                // Another step has another matrix.
                Err(SimulateError::Singular { .. }) if h > 2.0 * least => Error { size: f64::NAN, index: 0 },
                result => result?,
            };
            self.progress.pace.vote(error.index);
            if let Some(factor) = controller.accept(error.size) {
                self.method.finish(&mut self.system, run.control, start, &mut self.end)?;
                self.progress.h = if h < free { free.max(h * factor) } else { h * factor };
                self.progress.controller = Some(controller);
                if after_sample {
                    self.progress.after_sample.1 = self.progress.h;
                }
                return Ok(if h == left { until } else { self.t + h });
            }
            self.system.counts.rejected += 1;
            self.progress.h = h * controller.again(error.size);
            if self.progress.h < least {
                return Err(self.too_small(error.size, self.progress.h, error.index));
            }
            self.check_count()?;
        }
    }

    fn too_small(&self, error: f64, step: f64, index: usize) -> SimulateError {
        if let Some(wrong) = self.not_finite().filter(|_| error.is_nan()) {
            return wrong;
        }
        let (what, index, joint) = self.number(index);
        let least = Some(self.settings.min_step).filter(|least| *least > rounding(self.t));
        SimulateError::StepTooSmall { t: self.t, step, what, index, joint, least }
    }

    /// The non-finite entries at the end of the step.
    fn not_finite(&self) -> Option<SimulateError> {
        let (u, v) = self.end[..2 * self.shape.nv].split_at(self.shape.nv);
        self.system.not_finite(self.t, STEP, u).or_else(|| self.system.not_finite(self.t, "v", v))
    }

    /// The next of the equal steps of a stretch.
    fn fixed_step(&mut self, run: &mut Run, until: f64) -> Result<f64, SimulateError> {
        let (begin, made) = self.progress.stretch;
        let h = self.settings.step.unwrap_or(self.progress.h);
        let next = begin + (made + 1) as f64 * h;
        let t = if next < until - 1e-9 * h { next } else { until };
        let h = t - self.t;
        let start = Start { t: self.t, h, y: &self.y, f: &self.f };
        self.method.step(&mut self.system, run.control, start, &mut self.end, &self.norm)?;
        self.method.finish(&mut self.system, run.control, start, &mut self.end)?;
        let bad = self.not_finite();
        let explicit = self.looks_for_stiffness() && !self.settings.integrator.row().implicit;
        if explicit && (bad.is_some() || self.stability.suspects(self.system.counts.steps, h * self.method.fastest().map_or(0.0, |f| f.0)))
        {
            self.check_suspect(run)?;
        }
        if let Some(bad) = bad {
            let v = &self.y[self.shape.nv..2 * self.shape.nv];
            return Err(self.system.turns_too_far((self.t, h), v, TAU).unwrap_or(bad));
        }
        self.progress.stretch.1 += 1;
        Ok(t)
    }

    /// No step may turn a joint by a whole turn or more, which charts cannot distinguish from none.
    fn check_turn(&self) -> Result<(), SimulateError> {
        let (nv, h) = (self.shape.nv, self.settings.step.unwrap_or(self.progress.h).min(self.progress.until - self.t));
        self.system.turns_too_far((self.t, h), &self.y[nv..2 * nv], TAU).map_or(Ok(()), Err)
    }

    fn count_step(&mut self, h: f64) {
        let counts = &mut self.system.counts;
        counts.steps += 1;
        counts.layers += u64::from(self.system.over_layer);
        counts.limited_by = self.progress.pace.limiting();
        counts.largest_step = counts.largest_step.max(h);
        // Events at the start of a motion cut its first step to zero length.
        if h > 0.0 {
            counts.smallest_step = counts.smallest_step.min(h);
        }
    }

    /// The end of the step becomes the state. Returns whether a map has then changed it.
    fn advance(&mut self, run: &mut Run, t: f64, whole: bool) -> Result<bool, SimulateError> {
        let nv = self.shape.nv;
        let until = self.progress.until;
        self.system.move_origin(&self.end[..nv])?;
        self.y.copy_from_slice(&self.end);
        self.y[..nv].fill(0.0);
        self.y[nv..2 * nv].iter_mut().for_each(|rate| *rate = if rate.abs() < AT_REST { 0.0 } else { *rate });
        self.t = t;
        self.system.no_torque = None;
        if self.progress.period.is_some() && t >= until && until < self.settings.end {
            self.sample(run);
        }
        self.find_stretch_end(run);
        let mapped = if whole { false } else { self.map(run)? };
        if t >= until || !whole {
            self.progress.stretch = (t, 0);
        }
        match self.method.last_rate() {
            _ if !self.method.wants_rate() => {}
            Some(rate) if whole && t < until => {
                // The same accelerations; u̇ = v in the chart that begins here.
                self.f.copy_from_slice(rate);
                self.f[..nv].copy_from_slice(&self.y[nv..2 * nv]);
                self.check_rate()?;
            }
            _ => self.rate_here(run)?,
        }
        if mapped {
            self.take_sides(run)?;
        }
        Ok(mapped)
    }
}
