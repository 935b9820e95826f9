//! Records of a motion.

use std::sync::Arc;

use super::Direction;

/// Counts of the work done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counts {
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Evaluations of forward dynamics for steps and curves.
    pub evaluations: u64,
    /// Evaluations of forward dynamics that check whether a fixed step is stable; not included in
    /// the others.
    pub checks: u64,
    /// Evaluations of its derivatives.
    pub derivatives: u64,
    /// Matrices factorised.
    pub factorizations: u64,
    /// Rounds of the solution of implicit steps.
    pub iterations: u64,
    /// Events that happened.
    pub events: u64,
    /// The longest step, s.
    pub largest_step: f64,
    /// The shortest step, s.
    pub smallest_step: f64,
    /// Steps over a stiff layer: the motion has a decay that is faster than the step, and the
    /// integrator does not resolve it. Work and losses in such a step are those of the change of
    /// energy, and the step is left out of the balance. Counted if the balance is requested.
    pub layers: u64,
    /// When an explicit integrator was first held back by stiffness, s.
    pub stiff_at: Option<f64>,
    /// For steps chosen by tolerances: which of the 2·nv numbers of a step (step of q, then v) had
    /// the largest error in most steps so far, if one had it in more than half of them.
    pub limited_by: Option<usize>,
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            steps: 0,
            rejected: 0,
            evaluations: 0,
            checks: 0,
            derivatives: 0,
            factorizations: 0,
            iterations: 0,
            events: 0,
            layers: 0,
            largest_step: 0.0,
            smallest_step: f64::INFINITY,
            stiff_at: None,
            limited_by: None,
        }
    }
}

/// An event that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// Index of the event.
    pub event: usize,
    /// Its name.
    pub name: Arc<str>,
    /// When, s.
    pub t: f64,
    /// Which way its function went through zero.
    pub direction: Direction,
    /// The result of the map of the event.
    pub value: Option<f64>,
}

/// Why a motion ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ended {
    /// It did not: an error came first.
    #[default]
    Not,
    /// At the last time.
    AtEnd,
    /// By an event; its index.
    ByEvent(usize),
    /// The observer stopped the run.
    ByObserver,
}

/// The balance of energy over all steps of a motion, whatever is recorded, but for steps over a
/// stiff layer ([`Counts::layers`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Largest |T + U − (T + U at the start) − work − dissipated − from events| after any step, J.
    pub largest_imbalance: f64,
    /// Largest |T|, |work|, |dissipated| or |from events| after any step, J.
    pub largest_moved: f64,
}

impl Balance {
    /// Largest imbalance over the largest energy moved; 0 if nothing moved.
    pub fn relative(&self) -> f64 {
        if self.largest_moved == 0.0 { 0.0 } else { self.largest_imbalance / self.largest_moved }
    }

    /// One more state: its imbalance, J, and [T, work, dissipated, from events], J. A NaN is larger
    /// than every number.
    pub fn add(&mut self, imbalance: f64, moved: [f64; 4]) {
        fn larger(most: f64, x: f64) -> f64 {
            if x.abs() > most || x.is_nan() { x.abs() } else { most }
        }
        self.largest_imbalance = larger(self.largest_imbalance, imbalance);
        self.largest_moved = moved.into_iter().fold(self.largest_moved, larger);
    }
}

/// A motion at the times of output, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Number of coordinates.
    pub nq: usize,
    /// Number of degrees of freedom.
    pub nv: usize,
    /// Times, s.
    pub t: Vec<f64>,
    /// Configurations, `[n][nq]`.
    pub q: Vec<f64>,
    /// Velocities, `[n][nv]`.
    pub v: Vec<f64>,
    /// Commanded torques, `[n][nv]`.
    pub tau: Vec<f64>,
    /// Kinetic energy, J; empty for a robot without the function.
    pub kinetic: Vec<f64>,
    /// Potential energy, J; empty for a robot without the function.
    pub potential: Vec<f64>,
    /// Work of the torques since the start, J: of the torques of motors, if there are any. Empty
    /// unless requested by
    /// [`Simulation::with_energy_balance`](super::Simulation::with_energy_balance).
    pub work: Vec<f64>,
    /// Energy of the effects that are not conservative since the start, J; negative if they took
    /// some. Empty unless requested, as `work`.
    pub dissipated: Vec<f64>,
    /// Energy from the maps of events since the start, J: change of T + U, negative if they took
    /// some; empty for a robot without one of the two.
    pub from_events: Vec<f64>,
    /// Momentum about the centre of mass [k; l], `[n][6]`, N·m·s and N·s, world axes; empty for a
    /// robot without the function.
    pub momentum: Vec<f64>,
    /// Functions that the robot lacks; their records are empty.
    pub missing: Vec<&'static str>,
    /// Events, in order.
    pub events: Vec<Hit>,
    /// The balance of energy over all steps, if requested by
    /// [`Simulation::with_energy_balance`](super::Simulation::with_energy_balance) and the robot
    /// has both energies.
    pub balance: Option<Balance>,
    /// Counts of the work done.
    pub counts: Counts,
    /// Why it ended.
    pub ended: Ended,
}

impl Recording {
    /// Number of records.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether there are no records.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Configuration i, `[nq]`.
    ///
    /// # Panics
    /// This and the following if there is no record i.
    pub fn q_at(&self, i: usize) -> &[f64] {
        &self.q[i * self.nq..(i + 1) * self.nq]
    }

    /// Velocity i, `[nv]`.
    pub fn v_at(&self, i: usize) -> &[f64] {
        &self.v[i * self.nv..(i + 1) * self.nv]
    }

    /// Torques i, `[nv]`.
    pub fn tau_at(&self, i: usize) -> &[f64] {
        &self.tau[i * self.nv..(i + 1) * self.nv]
    }

    /// Momentum i, `[6]`, if it is there.
    pub fn momentum_at(&self, i: usize) -> Option<&[f64]> {
        self.momentum.get(i * 6..(i + 1) * 6)
    }

    /// T + U of record i, J, if both are there.
    pub fn energy(&self, i: usize) -> Option<f64> {
        Some(self.kinetic.get(i)? + self.potential.get(i)?)
    }

    /// Imbalance of energy in record i, J: T + U − (T + U at the start) − work − dissipated −
    /// energy from events. `None` if one of them is not recorded.
    pub fn imbalance(&self, i: usize) -> Option<f64> {
        Some(self.energy(i)? - self.energy(0)? - self.work.get(i)? - self.dissipated.get(i)? - self.from_events.get(i)?)
    }

    /// Removes everything but the memory.
    pub(crate) fn clear(&mut self) {
        let columns = [
            &mut self.t,
            &mut self.q,
            &mut self.v,
            &mut self.tau,
            &mut self.kinetic,
            &mut self.potential,
            &mut self.work,
            &mut self.dissipated,
            &mut self.from_events,
            &mut self.momentum,
        ];
        columns.into_iter().for_each(Vec::clear);
        self.events.clear();
        self.missing.clear();
        (self.counts, self.ended, self.balance) = (Counts::default(), Ended::Not, None);
    }
}
