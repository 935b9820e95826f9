//! Times and contents of records.

use articulated_core::algorithm::FunctionError;
use articulated_core::dynamics::Dynamics;

use super::curve::Point;
use super::system::System;
use super::{Control, Output, Recording, Settings, SimulateError};

/// The times of output, one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Times {
    next: usize,
}

impl Times {
    pub(crate) fn begin() -> Self {
        Self { next: 0 }
    }

    /// The next time after the start at which something is recorded; infinite if each step is, or
    /// none.
    pub(crate) fn next(&self, settings: &Settings) -> f64 {
        match &settings.output {
            Output::Every(s) => {
                let t = settings.start + (self.next + 1) as f64 * s;
                if t < settings.end - 1e-9 * s { t } else { settings.end }
            }
            Output::At(times) => times.get(self.next).copied().unwrap_or(f64::INFINITY),
            Output::Steps => f64::INFINITY,
            Output::Ends => settings.end,
        }
    }

    pub(crate) fn advance(&mut self) {
        self.next += 1;
    }

    /// Number of records, as far as it is known, and as far as memory for them is worth allocating
    /// beforehand.
    pub(crate) fn count(settings: &Settings) -> usize {
        let count = match &settings.output {
            Output::Every(s) => ((settings.end - settings.start) / s).ceil() as usize + 3,
            Output::At(times) => times.len() + 2,
            Output::Steps => 1024,
            Output::Ends => 3,
        };
        count.min(1 << 20)
    }
}

/// Known quantities of a robot's motion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    kinetic: bool,
    potential: bool,
    momentum: bool,
    tau: Vec<f64>,
    /// Energy from the maps of events since the start, J.
    pub(crate) from_events: f64,
    /// T + U where the motion began, J.
    at_start: f64,
    /// Imbalance after the last step, J, and in all steps over stiff layers.
    lacked: f64,
    left_out: f64,
}

impl Known {
    /// The functions that the robot has.
    pub(crate) fn of(system: &mut System<'_>) -> Self {
        let (q, v) = (system.origin.clone(), vec![0.0; system.nv()]);
        let (robot, ws) = (system.robot, &mut system.ws);
        let has = |r: Result<(), FunctionError>| r.is_ok();
        Self {
            kinetic: has(robot.kinetic_energy(ws, &q, &v, &mut [0.0])),
            potential: has(robot.potential_energy(ws, &q, &mut [0.0])),
            momentum: has(robot.centroidal_momentum(ws, &q, &v, &mut [0.0; 6])),
            tau: v,
            from_events: 0.0,
            at_start: 0.0,
            lacked: 0.0,
            left_out: 0.0,
        }
    }

    /// Room for a motion.
    pub(crate) fn recording(&self, system: &System<'_>, settings: &Settings) -> Recording {
        let (n, nq, nv) = (Times::count(settings), system.manifold.nq, system.manifold.nv);
        let room = |wanted: bool, each: usize| Vec::with_capacity(if wanted { n * each } else { 0 });
        let mut recording = Recording {
            t: room(true, 1),
            q: room(true, nq),
            v: room(true, nv),
            tau: room(true, nv),
            kinetic: room(self.kinetic, 1),
            potential: room(self.potential, 1),
            work: room(system.follows_work, 1),
            dissipated: room(system.follows_work, 1),
            from_events: room(self.kinetic && self.potential, 1),
            momentum: room(self.momentum, 6),
            events: Vec::with_capacity(16),
            ..Recording::default()
        };
        self.begin(system, &mut recording);
        recording
    }

    /// Starts a recording: only the robot of the motion is recorded.
    pub(crate) fn begin(&self, system: &System<'_>, recording: &mut Recording) {
        let names = [
            ("kinetic_energy", self.kinetic),
            ("potential_energy", self.potential),
            ("centroidal_momentum", self.momentum),
            ("dissipation", system.has_losses),
            ("motor_torques", system.has_motors),
        ];
        recording.clear();
        (recording.nq, recording.nv) = (system.manifold.nq, system.manifold.nv);
        recording.missing.extend(names.into_iter().filter(|(_, there)| !there).map(|(name, _)| name));
    }

    /// One more record.
    pub(crate) fn record(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        point: &Point,
        to: &mut Recording,
    ) -> Result<(), SimulateError> {
        let nv = system.nv();
        let (q, v) = (&point.q, &point.y[nv..2 * nv]);
        system.command(control, point.t, q, v, &mut self.tau);
        to.t.push(point.t);
        to.q.extend_from_slice(q);
        to.v.extend_from_slice(v);
        to.tau.extend_from_slice(&self.tau);
        if system.follows_work {
            to.work.push(point.y[2 * nv]);
            to.dissipated.push(point.y[2 * nv + 1]);
        }
        let (kinetic, potential) = self.energies(system, q, v)?;
        to.kinetic.extend(kinetic);
        to.potential.extend(potential);
        to.from_events.extend(kinetic.and(potential).map(|_| self.from_events));
        if self.momentum {
            let mut six = [0.0; 6];
            system.robot.centroidal_momentum(&mut system.ws, q, v, &mut six)?;
            to.momentum.extend_from_slice(&six);
        }
        Ok(())
    }

    /// Adds a state to the balance of energy, if that is requested; the first one is where the
    /// motion begins.
    pub(crate) fn follow(&mut self, system: &mut System<'_>, y: &[f64], q: &[f64], to: &mut Recording) -> Result<(), FunctionError> {
        if !(system.follows_work && self.kinetic && self.potential) {
            return Ok(());
        }
        let nv = system.nv();
        let (kinetic, potential) = self.energies(system, q, &y[nv..2 * nv])?;
        let (kinetic, potential) = (kinetic.unwrap_or(0.0), potential.unwrap_or(0.0));
        if to.balance.is_none() {
            (self.at_start, self.lacked, self.left_out) = (kinetic + potential, 0.0, 0.0);
        }
        let (work, dissipated) = (y[2 * nv], y[2 * nv + 1]);
        let imbalance = kinetic + potential - self.at_start - work - dissipated - self.from_events - self.left_out;
        let imbalance = if system.over_layer {
            self.left_out += imbalance - self.lacked;
            self.lacked
        } else {
            imbalance
        };
        self.lacked = imbalance;
        to.balance.get_or_insert_default().add(imbalance, [kinetic, work, dissipated, self.from_events]);
        Ok(())
    }

    /// T and U, J, as far as the robot has them.
    fn energies(&self, system: &mut System<'_>, q: &[f64], v: &[f64]) -> Result<(Option<f64>, Option<f64>), FunctionError> {
        let (robot, ws, mut t, mut u) = (system.robot, &mut system.ws, [0.0], [0.0]);
        if self.kinetic {
            robot.kinetic_energy(ws, q, v, &mut t)?;
        }
        if self.potential {
            robot.potential_energy(ws, q, &mut u)?;
        }
        Ok((self.kinetic.then_some(t[0]), self.potential.then_some(u[0])))
    }

    /// T + U, J; zero if the robot lacks one of them.
    pub(crate) fn energy(&self, system: &mut System<'_>, q: &[f64], v: &[f64]) -> Result<f64, FunctionError> {
        let (kinetic, potential) = self.energies(system, q, v)?;
        Ok(kinetic.zip(potential).map_or(0.0, |(t, u)| t + u))
    }
}
