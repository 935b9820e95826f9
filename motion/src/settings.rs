//! How a scene is simulated, as it says itself.

use articulated::simulate::{Output, Settings, Stiffness};
use articulated_scene::{Output as Recorded, Simulation, Stiffness as Stiff, When};

use crate::error::{Fault, MotionErrors};
use crate::stage::Stage;

/// The settings that a scene's `[simulation]` says.
pub fn settings(s: &Simulation) -> Settings {
    let output = match &s.output {
        Recorded::Every(seconds) => Output::Every(*seconds),
        Recorded::At(times) => Output::At(times.clone()),
        Recorded::Steps => Output::Steps,
        Recorded::Ends => Output::Ends,
    };
    Settings {
        integrator: s.integrator,
        start: s.start,
        end: s.end,
        step: s.step,
        rtol: s.rtol,
        atol: s.atol,
        min_step: s.min_step,
        max_step: s.max_step,
        first_step: s.first_step,
        max_steps: s.max_steps,
        output,
        event_tolerance: s.event_tolerance,
        stiffness: match s.stiffness {
            Stiff::Refuse => Stiffness::Refuse,
            Stiff::Note => Stiffness::Note,
        },
        ..Settings::default()
    }
}

impl Stage {
    /// The settings that the scene says. Errors: a scene without `[simulation]`.
    pub fn settings(&self) -> Result<Settings, MotionErrors> {
        self.scene.simulation.as_ref().map(settings).ok_or_else(|| MotionErrors::one(&self.scene.file, Fault::NoSimulation))
    }

    /// Whether the scene can be simulated so. Errors: all settings that its robot cannot be simulated by, or else a ball that is hit while nothing moves.
    pub fn check(&self, settings: &Settings) -> Result<(), MotionErrors> {
        MotionErrors::none(&self.scene.file, self.faults_of(settings))
    }

    pub(crate) fn faults_of(&self, settings: &Settings) -> Vec<Fault> {
        let problems: Vec<Fault> = settings.problems(self.model.shape()).into_iter().map(Fault::Setting).collect();
        // Of times that are none nothing is to be said.
        if problems.is_empty() { self.in_time(settings).into_iter().collect() } else { problems }
    }

    /// Whether the ball is hit while the robot moves.
    fn in_time(&self, &Settings { start, end, .. }: &Settings) -> Option<Fault> {
        match self.scene.impact.as_ref()?.when {
            When::Time(found) if found < start || found >= end => Some(Fault::Time { found, start, end }),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_of_scenes_are_those_of_the_library() {
        assert_eq!(settings(&Simulation::default()), Settings::default());
    }
}
