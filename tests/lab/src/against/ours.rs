//! Our own integrators on generated code.

use articulated::Dynamics;
use articulated::simulate::{IntegratorId, NoTorque, Output, Recording, Settings, Simulation};

use super::Runner;
use super::search::{self, Effort};
use crate::straight::Straight;

/// An integrator on the generated robot, with all its room, for the effort of its last run.
pub(super) struct Ours<'r> {
    robot: &'r Straight,
    settings: Settings,
    q: Vec<f64>,
    v: Vec<f64>,
    made: Option<(Effort, Simulation<'r>, Recording)>,
}

impl<'r> Ours<'r> {
    pub(super) fn new(robot: &'r Straight, integrator: IntegratorId, settings: &Settings, (q, v): (&[f64], &[f64])) -> Self {
        let settings = Settings { integrator, start: settings.start, end: settings.end, output: Output::Ends, ..Settings::default() };
        Self { robot, settings, q: q.to_vec(), v: v.to_vec(), made: None }
    }

    fn simulation(&self, effort: Effort) -> Option<(Simulation<'r>, Recording)> {
        let mut settings = self.settings.clone();
        match effort {
            Effort::Steps(n) => settings.step = Some((settings.end - settings.start) / n as f64),
            Effort::Tolerance(tol) => (settings.rtol, settings.atol) = (tol, tol),
        }
        let simulation = Simulation::new(self.robot, settings).ok()?;
        let recording = simulation.recording();
        Some((simulation, recording))
    }
}

impl Runner for Ours<'_> {
    fn name(&self) -> String {
        format!("articulated {}", self.settings.integrator.name())
    }

    fn order(&self) -> u32 {
        self.settings.integrator.row().order
    }

    fn is_ours(&self) -> bool {
        true
    }

    fn effort(&self, level: usize) -> Option<Effort> {
        if self.settings.integrator.row().adaptive { search::tolerances(level) } else { search::steps(level) }
    }

    fn run(&mut self, effort: Effort) -> Option<Vec<f64>> {
        if self.made.as_ref().is_none_or(|m| m.0 != effort) {
            let (simulation, recording) = self.simulation(effort)?;
            self.made = Some((effort, simulation, recording));
        }
        let (_, simulation, recording) = self.made.as_mut()?;
        simulation.run_into(&self.q, &self.v, &mut NoTorque, &mut [], recording, &mut |_, _| true).ok()?;
        let last = recording.len() - 1;
        Some([recording.q_at(last), recording.v_at(last)].concat())
    }

    fn spent(&self) -> (u64, u64) {
        self.made.as_ref().map_or((0, 0), |m| (m.2.counts.steps, m.2.counts.evaluations))
    }
}

/// Generated code is measured: a robot without a workspace.
const _: fn(&Straight) = |robot| robot.workspace();
