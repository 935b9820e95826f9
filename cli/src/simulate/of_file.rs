//! The motion that a robot's file describes: its method, step, actuators and start, with or without
//! contacts, limits and dry friction.

use std::time::Instant;

use articulated::simulate::{Balance, Counts, Output, Settings};
use articulated_core::algorithm::{Function, FunctionError, Workspace, function};
use articulated_core::control::{Controller, Signal};
use articulated_core::model::Model;
use articulated_core::step::{self, CTRL, WARM, rollout};
use articulated_formats::world::World;
use articulated_lab::session::Session;
use articulated_motion::{Ending, InitialState};

use super::constrained::Constrained;
use super::method::Method;
use super::monitor::RunMonitor;
use super::motion::Motion;
use super::recording::Recording;
use crate::console::{self, Progress};
use crate::failure::Failure;
use crate::file_motion::{Start, are_computed, put_activations, step_length, step_of_file};
use crate::touching::Touching;

/// How a file's motion is stepped.
pub(super) struct OfFile {
    method: &'static Function<f64>,
    /// s.
    step: f64,
    /// At the start.
    state: step::State,
    controls: Signal,
}

impl OfFile {
    /// The file's own motion; notes say where it starts. `settings` get its step.
    ///
    /// # Errors
    /// A keyframe that the file does not have, and constraints that are not computed.
    pub(super) fn of(
        session: &Session,
        constraints: bool,
        keyframe: Option<&str>,
        step: Option<f64>,
        settings: &mut Settings,
    ) -> Result<Self, Failure> {
        let (model, world, file) = (&session.model, &session.world, &session.scene.file);
        let method = method_of_file(world, model, constraints)?;
        if constraints {
            are_computed(file, (&session.description, world), model)?;
            articulated_codegen::defined(file, model, &articulated_codegen::massless(model), method)?;
        }
        let Start { state, ctrl, source } = Start::of_file(&session.scene.file, world, model, keyframe)?;
        let step = step_length(step, world);
        console::note(&format!("steps of {step} s by {}, starts with {source}", method.name));
        settings.step = Some(step);
        Ok(Self { method, step, state, controls: Signal::Still(ctrl) })
    }

    /// The motion of a scene with a law: its state and controls, by the method of the file.
    ///
    /// # Errors
    /// Constraints that are not computed.
    pub(super) fn of_scene(session: &Session, initial: &InitialState, settings: &mut Settings) -> Result<Self, Failure> {
        let (model, world, file) = (&session.model, &session.world, &session.scene.file);
        let method = method_of_file(world, model, true)?;
        are_computed(file, (&session.description, world), model)?;
        articulated_codegen::defined(file, model, &articulated_codegen::massless(model), method)?;
        let mut state = step::State { q: initial.q.clone(), v: initial.v.clone(), ..step::State::neutral(model) };
        let named = session.scene.initial.keyframe.as_ref().map(|(name, _)| name);
        if let Some(keyframe) = world.keyframes.iter().find(|keyframe| named == Some(&keyframe.name)) {
            put_activations(model.actuators(), keyframe, &mut state);
        }
        let controls = match &initial.controller {
            Controller::Actuators { controls, .. } => controls.clone(),
            _ => Signal::Still(vec![0.0; model.actuators().laws.len()]),
        };
        let step = step_length(settings.step, world);
        settings.step = Some(step);
        Ok(Self { method, step, state, controls })
    }

    fn has_constraints(&self) -> bool {
        self.method.takes.contains(&WARM)
    }

    /// The method in the report.
    fn method(&self) -> Method {
        Method { name: self.method.name, order: step::order(self.method), step_s: Some(self.step), rtol: 0.0, atol: 0.0 }
    }

    /// The controls at a time: a step holds those at its start.
    fn controls_at(&self, t: f64) -> Vec<f64> {
        match &self.controls {
            Signal::Still(values) => values.clone(),
            Signal::Moving(series) => {
                let mut values = vec![0.0; series.rows.first().map_or(0, Vec::len)];
                series.at(t, &mut values);
                values
            }
        }
    }

    /// Steps to the end, in whole steps. A state that is not finite ends the motion.
    pub(super) fn run(
        &self,
        session: &Session,
        settings: &Settings,
        progress: &Progress,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Motion, Failure> {
        let model = &session.model;
        let length = (settings.end - settings.start) / self.step;
        let needed = (length - ROUNDING).ceil().max(1.0);
        let count = needed.min(settings.max_steps as f64) as usize;
        let torques = vec![0.0; model.nv()];
        let is_actuated = self.method.takes.contains(&CTRL);
        let constraints = self.has_constraints().then(Constrained::default);
        let mut own = Own {
            of_file: self,
            model,
            ws: Workspace::new(model),
            torques: torques.clone(),
            ctrl: self.controls_at(settings.start),
            constraints,
        };
        let mut recording = Recording::of(model);
        let mut energy = Sums::start(own.energies(&self.state)?, self.has_constraints());
        own.record(settings.start, &self.state, &energy, &mut recording)?;
        let (mut monitor, mut counts) = (RunMonitor::new(session, settings, progress), Counts::default());
        let (mut last, mut error, mut is_stopped) = (settings.start, None, false);
        let (mut state, clock) = (self.state.clone(), Instant::now());
        let mut ws = Workspace::new(model);
        for k in 1..=count {
            let held = if is_actuated { &own.ctrl } else { &torques };
            rollout(self.method, (model, &mut ws), &mut state, self.step, [held.as_slice()], |_, _| {}).map_err(of_function)?;
            let t = settings.start + k as f64 * self.step;
            (counts.steps, last) = (k as u64, t);
            if state.q.iter().chain(&state.v).chain(&state.act).any(|x| !x.is_finite()) {
                error = Some(format!(
                    "the state at t = {t} s is not finite: the step of {} s is too long, or the motion has no bound",
                    self.step
                ));
                break;
            }
            own.ctrl = self.controls_at(t);
            energy.add(own.energies(&state)?, self.step);
            if k == count || is_recorded(&settings.output, settings.start, t, self.step) {
                own.record(t, &state, &energy, &mut recording)?;
            }
            monitor.look(t, &counts);
            if !go_on() {
                is_stopped = true;
                break;
            }
        }
        if error.is_none() && !is_stopped && needed > count as f64 {
            let most = settings.max_steps;
            error = Some(format!("{needed:.1e} steps to the end, of which {most} are made: expected longer steps, or an earlier end"));
        }
        counts.evaluations = counts.steps * self.method.contains.len() as u64;
        (counts.largest_step, counts.smallest_step) = (self.step, self.step);
        let ending = match (&error, is_stopped) {
            (Some(_), _) => Ending::ByError,
            (None, true) => Ending::ByObserver,
            (None, false) => Ending::AtEnd,
        };
        Ok(Motion {
            recording,
            counts,
            balance: energy.balance,
            creep: Vec::new(),
            slides: Vec::new(),
            reached: last,
            ending,
            wall: clock.elapsed(),
            ball: None,
            error,
            of_file: Some(self.method()),
            warnings: own.constraints.iter().flat_map(|constraints| constraints.warning(&session.scene.file)).collect(),
            constraints: own.constraints,
        })
    }
}

/// The step that a file requests, with torques, actuators or constraints.
fn method_of_file(world: &World, model: &Model<f64>, constraints: bool) -> Result<&'static Function<f64>, Failure> {
    let [plain, actuated] = step_of_file(world.stepping.as_ref());
    let name = match constraints {
        true => format!("constrained_{plain}"),
        false if model.actuators().is_empty() => plain.to_owned(),
        false => actuated.to_owned(),
    };
    step::step(&name).ok_or_else(|| Failure::usage(format!("--constraints: found no step {name}")))
}

/// Part of a step that a motion may end before its end: times are sums of rounded steps.
const ROUNDING: f64 = 1e-6;

/// Whether the step that ends at t, s, is the first at a time of output or after it.
fn is_recorded(output: &Output, start: f64, t: f64, step: f64) -> bool {
    let slack = ROUNDING * step;
    match output {
        Output::Steps => true,
        Output::Ends => false,
        Output::Every(every) => ((t - start + slack) / every).floor() > ((t - start - step + slack) / every).floor(),
        Output::At(times) => times.iter().any(|at| *at <= t + slack && *at > t - step + slack),
    }
}

/// Evaluations of functions of a state.
struct Own<'a> {
    of_file: &'a OfFile,
    model: &'a Model<f64>,
    ws: Workspace<f64>,
    /// Of actuators, N·m or N.
    torques: Vec<f64>,
    /// Controls from the present time on.
    ctrl: Vec<f64>,
    constraints: Option<Constrained>,
}

/// Energies of a state, J, and their rates, W.
#[derive(Clone, Copy)]
struct Energies {
    kinetic: f64,
    potential: f64,
    /// Power of the actuators.
    power: f64,
    /// Power of effects that are not conservative.
    loss: f64,
}

impl Own<'_> {
    fn call(&mut self, name: &str, inputs: &[&[f64]], out: &mut [f64]) -> Result<(), Failure> {
        let row = function::<f64>(name).or_else(|| step::step(name));
        let row = row.ok_or_else(|| Failure::tool(&format!("no function {name}")))?;
        row.call(self.model, &mut self.ws, inputs, out).map_err(of_function)
    }

    fn energies(&mut self, state: &step::State) -> Result<Energies, Failure> {
        let (q, v) = (state.q.as_slice(), state.v.as_slice());
        let mut one = |name: &str, inputs: &[&[f64]]| {
            let mut out = [0.0];
            self.call(name, inputs, &mut out).map(|()| out[0])
        };
        let (kinetic, potential) = (one("kinetic_energy", &[q, v])?, one("potential_energy", &[q])?);
        let loss = one("dissipation", &[q, v])?;
        let mut tau = vec![0.0; v.len()];
        if self.of_file.method.takes.contains(&CTRL) {
            let ctrl = self.ctrl.clone();
            self.call("actuator_torques", &[q, v, &state.act, &ctrl], &mut tau)?;
        }
        let power = tau.iter().zip(v).map(|(tau, v)| tau * v).sum();
        self.torques = tau;
        Ok(Energies { kinetic, potential, power, loss })
    }

    /// Adds a record. The torques are those of the last energies.
    fn record(&mut self, t: f64, state: &step::State, energy: &Sums, to: &mut Recording) -> Result<(), Failure> {
        let mut momentum = [0.0; 6];
        // Without mass there is no centre of mass.
        if self.model.moving_mass() > 0.0 {
            self.call("centroidal_momentum", &[&state.q, &state.v], &mut momentum)?;
        }
        if let Some(constraints) = &mut self.constraints {
            let touching = Touching::of(self.model, &mut self.ws, state, &self.ctrl).map_err(of_function)?;
            constraints.add(t, &touching);
            to.contacts.push(touching.contacts.iter().map(|contact| [contact.point, contact.force]).collect());
        }
        to.t.push(t);
        to.q.extend(&state.q);
        to.v.extend(&state.v);
        to.tau.extend(&self.torques);
        to.kinetic.push(energy.now.kinetic);
        to.potential.push(energy.now.potential);
        to.work.push(energy.work);
        to.dissipated.push(energy.dissipated);
        to.from_events.push(energy.from_constraints);
        to.momentum.push(momentum);
        Ok(())
    }
}

/// Work since the start, by the trapezoidal rule, and the balance of energy.
///
/// With constraints there is no balance: their energy is all that work and dissipation do not
/// explain, errors of steps included.
struct Sums {
    now: Energies,
    has_constraints: bool,
    from_constraints: f64,
    /// T + U at the start, J.
    before: f64,
    work: f64,
    dissipated: f64,
    balance: Balance,
}

impl Sums {
    fn start(now: Energies, has_constraints: bool) -> Self {
        let before = now.kinetic + now.potential;
        Self { now, has_constraints, from_constraints: 0.0, before, work: 0.0, dissipated: 0.0, balance: Balance::default() }
    }

    fn add(&mut self, next: Energies, step: f64) {
        self.work += 0.5 * step * (self.now.power + next.power);
        self.dissipated += 0.5 * step * (self.now.loss + next.loss);
        self.now = next;
        let imbalance = next.kinetic + next.potential - self.before - self.work - self.dissipated;
        if self.has_constraints {
            self.from_constraints = imbalance;
            return;
        }
        self.balance.add(imbalance, [next.kinetic, self.work, self.dissipated, 0.0]);
    }
}

fn of_function(error: FunctionError) -> Failure {
    Failure::tool(&error)
}
