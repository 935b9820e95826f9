//! How a scene is simulated, as it says itself.

use articulated::simulate::Settings;
use articulated_scene::{Kind, SceneError, When};

use crate::error::{Fault, MotionErrors};
use crate::stage::Stage;

impl Stage {
    /// The settings that the scene says. Errors: a scene without `[simulation]`.
    pub fn settings(&self) -> Result<Settings, MotionErrors> {
        let simulation = self.scene.simulation.as_ref().ok_or_else(|| MotionErrors::one(&self.scene.file, Fault::NoSimulation))?;
        Ok(simulation.settings.clone())
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
        let impact = self.scene.impact.as_ref()?;
        let When::Time(found) = impact.when else { return None };
        let told = || SceneError {
            file: self.scene.file.clone(),
            at: impact.when_place,
            key: "impact.time".to_owned(),
            kind: Kind::Together,
            found: format!("{found:?}"),
            expected: format!("a time from {start:?} s on and before {end:?} s"),
            nearest: None,
        };
        (found < start || found >= end).then(|| Fault::Scene(told()))
    }
}
