//! The equations of motion in the chart of a step: y = (u, v, work, dissipated) and its derivative.

use articulated_core::algorithm::FunctionError;
use articulated_core::algorithm::checked::{Measure, Singular, Solver, Unsolved};
use articulated_core::dynamics::Dynamics;

use super::erased::{Erased, Functions};
use super::error::joint;
use super::manifold::Manifold;
use super::{Control, Counts, SimulateError};

/// Rates below are zero after a step, rad/s or m/s. A damper brings a joint to rest through numbers
/// whose squares are subnormal, which are slow on many processors.
pub(crate) const AT_REST: f64 = 1e-140;

/// A robot with all the room that an evaluation of its equations needs.
///
/// y: `[2·nv + 2]`: step vector from the chart's origin, velocities, work of the torques and energy
/// of the effects that are not conservative, J.
pub(crate) struct System<'r> {
    pub(crate) robot: Erased<'r>,
    pub(crate) ws: Box<dyn Functions + 'r>,
    pub(crate) manifold: Manifold,
    /// Origin of the chart, `[nq]`.
    pub(crate) origin: Vec<f64>,
    /// The torques of the controller if it is sampled, `[nv]`.
    pub(crate) held: Vec<f64>,
    pub(crate) holds: bool,
    /// The next time at which the torques have a kink or a jump, s: up to it, they are those before
    /// it.
    pub(crate) kink: f64,
    pub(crate) counts: Counts,
    /// Configuration and torques of the last evaluation.
    pub(crate) q: Vec<f64>,
    pub(crate) tau: Vec<f64>,
    applied: Vec<f64>,
    /// Since the last step that was accepted: when, s, and which commanded torque was not finite,
    /// at a state that was.
    pub(crate) no_torque: Option<(f64, usize)>,
    pub(crate) has_motors: bool,
    pub(crate) has_losses: bool,
    has_energies: bool,
    /// Whether the last two numbers of y are integrated; they are zero otherwise.
    pub(crate) follows_work: bool,
    /// Whether the last step went over a stiff layer.
    pub(crate) over_layer: bool,
}

impl<'r> System<'r> {
    pub(crate) fn new(robot: Erased<'r>) -> Result<Self, FunctionError> {
        let (shape, manifold) = (robot.shape(), Manifold::of(&robot)?);
        let (nq, nv) = (shape.nq, shape.nv);
        let mut system = Self {
            robot,
            ws: robot.workspace(),
            manifold,
            origin: vec![0.5; nq],
            held: vec![0.0; nv],
            holds: false,
            kink: f64::INFINITY,
            counts: Counts::default(),
            q: vec![0.5; nq],
            tau: vec![0.0; nv],
            applied: vec![0.0; nv],
            no_torque: None,
            has_motors: false,
            has_losses: false,
            has_energies: false,
            follows_work: false,
            over_layer: false,
        };
        let zero = vec![0.0; nv];
        system.has_motors = super::effects::motor_torques(&robot, &mut system.ws, &zero, &zero, &mut system.applied);
        system.has_losses = super::effects::dissipation(&robot, &mut system.ws, &system.origin, &zero).is_some();
        system.has_energies = system.energy_here(&zero).is_some();
        Ok(system)
    }

    /// Number of degrees of freedom.
    pub(crate) fn nv(&self) -> usize {
        self.manifold.nv
    }

    /// Length of y.
    pub(crate) fn len(&self) -> usize {
        2 * self.manifold.nv + 2
    }

    /// q = origin ⊕ u.
    pub(crate) fn configuration(&mut self, u: &[f64], q: &mut [f64]) -> Result<(), FunctionError> {
        self.manifold.step(&self.robot, &mut self.ws, &self.origin, u, q)
    }

    /// The commanded torques of a state, in `tau`.
    pub(crate) fn command(&mut self, control: &mut dyn Control, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        command(self.holds.then_some(&self.held), control, t, (q, v), tau);
        self.no_torque = self.no_torque.or(not_finite(t, (q, v), tau));
    }

    /// The configuration u of the chart and the commanded torques there, in `q` and `tau`. If a
    /// step ends at a jump, the torques are those before it.
    fn command_at(&mut self, control: &mut dyn Control, t: f64, u: &[f64], v: &[f64]) -> Result<(), FunctionError> {
        self.place(u)?;
        command(self.holds.then_some(&self.held), control, self.within(t), (&self.q, v), &mut self.tau);
        self.no_torque = self.no_torque.or(not_finite(t, (&self.q, v), &self.tau));
        Ok(())
    }

    /// t, or the last time before a jump that a step ends with.
    fn within(&self, t: f64) -> f64 {
        if t >= self.kink { self.kink.next_down() } else { t }
    }

    /// f = dy/dt.
    pub(crate) fn rate(&mut self, control: &mut dyn Control, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), SimulateError> {
        let nv = self.nv();
        let (u, v) = (&y[..nv], &y[nv..2 * nv]);
        self.command_at(control, t, u, v)?;
        self.manifold.rates(u, v, &mut f[..nv]);
        self.robot.forward_dynamics(&mut self.ws, &self.q, v, &self.tau, &mut f[nv..2 * nv])?;
        self.counts.evaluations += 1;
        [f[2 * nv], f[2 * nv + 1]] = self.powers(v);
        Ok(())
    }

    /// Power of the torques and of the effects that are not conservative, W, of a state without its
    /// acceleration.
    pub(crate) fn power(&mut self, control: &mut dyn Control, t: f64, y: &[f64]) -> Result<[f64; 2], SimulateError> {
        let nv = self.nv();
        let (u, v) = (&y[..nv], &y[nv..2 * nv]);
        self.command_at(control, t, u, v)?;
        Ok(self.powers(v))
    }

    /// T + U, J, of a state of the chart; `None` if the robot lacks one of the two functions.
    pub(crate) fn energy(&mut self, y: &[f64]) -> Result<Option<f64>, FunctionError> {
        let nv = self.nv();
        if !self.has_energies {
            return Ok(None);
        }
        self.place(&y[..nv])?;
        Ok(self.energy_here(&y[nv..2 * nv]))
    }

    fn energy_here(&mut self, v: &[f64]) -> Option<f64> {
        let (mut kinetic, mut potential) = ([0.0], [0.0]);
        self.robot.kinetic_energy(&mut self.ws, &self.q, v, &mut kinetic).ok()?;
        self.robot.potential_energy(&mut self.ws, &self.q, &mut potential).ok()?;
        Some(kinetic[0] + potential[0])
    }

    /// The torques of the motors in a state, `[nv]`, in `given`.
    pub(crate) fn motor_torques(&mut self, control: &mut dyn Control, t: f64, y: &[f64], given: &mut [f64]) -> Result<(), SimulateError> {
        let nv = self.nv();
        let (u, v) = (&y[..nv], &y[nv..2 * nv]);
        self.command_at(control, t, u, v)?;
        if !(self.has_motors && super::effects::motor_torques(&self.robot, &mut self.ws, v, &self.tau, given)) {
            given.copy_from_slice(&self.tau);
        }
        Ok(())
    }

    fn place(&mut self, u: &[f64]) -> Result<(), FunctionError> {
        self.manifold.step(&self.robot, &mut self.ws, &self.origin, u, &mut self.q)
    }

    /// Quaternions of norm one, by a step of no length.
    pub(crate) fn normalise_origin(&mut self, still: &[f64]) -> Result<(), FunctionError> {
        self.manifold.integrate(&self.robot, &mut self.ws, &self.origin, still, &mut self.q)?;
        std::mem::swap(&mut self.origin, &mut self.q);
        Ok(())
    }

    /// vᵀτ of the motors, and the power of the effects, at the configuration and torques of the
    /// last evaluation.
    fn powers(&mut self, v: &[f64]) -> [f64; 2] {
        if !self.follows_work {
            return [0.0; 2];
        }
        let work = |tau: &[f64]| tau.iter().zip(v).map(|(tau, v)| tau * v).sum();
        let given = if self.has_motors && super::effects::motor_torques(&self.robot, &mut self.ws, v, &self.tau, &mut self.applied) {
            work(&self.applied)
        } else {
            work(&self.tau)
        };
        let lost = if self.has_losses { super::effects::dissipation(&self.robot, &mut self.ws, &self.q, v).unwrap_or(0.0) } else { 0.0 };
        [given, lost]
    }

    /// Which of these numbers, one for each degree of freedom, are not finite.
    pub(crate) fn not_finite(&self, t: f64, what: &'static str, x: &[f64]) -> Option<SimulateError> {
        if all_finite(x) {
            return None;
        }
        Some(self.named(t, what, (0..x.len()).filter(|&i| !x[i].is_finite()).collect()))
    }

    /// Whether a step of h s at these rates turns a joint by `most` rad or more.
    pub(crate) fn turns_too_far(&self, (t, h): (f64, f64), v: &[f64], most: f64) -> Option<SimulateError> {
        let (freedom, rate) = self.manifold.fastest_turn(v).filter(|(_, rate)| rate * h >= most)?;
        Some(SimulateError::Turn { t, step: h, turn: rate * h, most, joint: joint(&self.robot, freedom) })
    }

    /// With the names of the joints that these degrees of freedom belong to.
    pub(crate) fn named(&self, t: f64, what: &'static str, index: Vec<usize>) -> SimulateError {
        let mut names: Vec<String> = index.iter().filter_map(|&i| joint(&self.robot, i)).collect();
        names.dedup();
        SimulateError::NotFinite { t, what, index, names }
    }

    /// The joint at which the mass matrix is singular where the chart begins, at these velocities,
    /// if the robot has the functions to find it.
    pub(crate) fn without_mass(&mut self, v: &[f64]) -> Option<Singular> {
        let zero = vec![0.0; self.nv()];
        let state = [&self.origin[..], v, &zero];
        let solved = Solver::new(self.robot.shape()).forward_dynamics(&self.robot, &mut self.ws, state, &mut zero.clone());
        match solved {
            Err(Unsolved::Singular(cause)) if cause.measure == Measure::Pivot => Some(cause),
            _ => None,
        }
    }

    /// The next chart begins at the point `u` of this one.
    pub(crate) fn move_origin(&mut self, u: &[f64]) -> Result<(), FunctionError> {
        self.place(u)?;
        std::mem::swap(&mut self.origin, &mut self.q);
        Ok(())
    }
}

/// Whether every number is finite, without a branch for each.
fn all_finite(x: &[f64]) -> bool {
    x.iter().fold(true, |all, x| all & x.is_finite())
}

/// The time and the torque that is not finite, at a state that is.
fn not_finite(t: f64, (q, v): (&[f64], &[f64]), tau: &[f64]) -> Option<(f64, usize)> {
    if all_finite(tau) {
        return None;
    }
    let index = tau.iter().position(|x| !x.is_finite())?;
    q.iter().chain(v).all(|x| x.is_finite()).then_some((t, index))
}

/// The torques that are held, or otherwise those of the controller.
fn command(held: Option<&[f64]>, control: &mut dyn Control, t: f64, (q, v): (&[f64], &[f64]), tau: &mut [f64]) {
    if let Some(held) = held {
        tau.copy_from_slice(held);
        return;
    }
    tau.fill(0.0);
    control.torques(t, q, v, tau);
}
