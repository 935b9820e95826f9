//! Simulation settings of a scene, and their checks.

use articulated::simulate::Settings;
use articulated_core::diagnostic::{Code, Diagnostic};
use articulated_core::effect::{Applied, EffectId};
use articulated_scene::When;

use crate::error::{Fault, MotionErrors};
use crate::session::{Session, field};

/// A smoothing speed is at least this many times the absolute tolerance of velocities.
const RESOLVED: f64 = 10.0;

impl Session {
    /// The scene's settings. Errors: a scene without `[simulation]`.
    pub fn settings(&self) -> Result<Settings, MotionErrors> {
        let simulation = self.scene.simulation.as_ref().ok_or_else(|| MotionErrors::one(&self.scene.file, Fault::NoSimulation))?;
        Ok(simulation.settings.clone())
    }

    /// Checks settings for this scene. Errors: settings that do not suit its robot; otherwise a
    /// ball hit outside the motion and smoothing speeds that the tolerances do not resolve.
    pub fn check(&self, settings: &Settings) -> Result<(), MotionErrors> {
        MotionErrors::none(&self.scene.file, self.faults_of(settings))
    }

    pub(crate) fn faults_of(&self, settings: &Settings) -> Vec<Fault> {
        let problems: Vec<Fault> = settings.problems(self.model.shape()).into_iter().map(Fault::Setting).collect();
        if !problems.is_empty() {
            // Invalid times are not checked further.
            return problems;
        }
        self.in_time(settings).into_iter().chain(self.unresolved_speeds(settings)).collect()
    }

    /// Smoothing speeds of friction and contact that the tolerance of velocities does not resolve:
    /// steps by tolerance would never end.
    fn unresolved_speeds(&self, settings: &Settings) -> Vec<Fault> {
        let expected = RESOLVED * settings.atol;
        let smoothed = self.effects.iter().filter(|applied| matches!(applied.effect, EffectId::friction | EffectId::contact));
        let speeds = smoothed.filter_map(|applied| Some((applied, *field(applied, "speed").first()?)));
        let unresolved = speeds.filter(|(_, speed)| settings.step.is_none() && *speed < expected);
        let fault = |(applied, found): (&Applied, f64)| {
            let key = format!("effects.{}.{}.speed", applied.effect.row().name, applied.on);
            Fault::Speed { key, found, expected, atol: settings.atol }
        };
        unresolved.map(fault).collect()
    }

    /// Whether the ball is hit while the robot moves.
    fn in_time(&self, &Settings { start, end, .. }: &Settings) -> Option<Fault> {
        let impact = self.scene.impact.as_ref()?;
        let When::Time(found) = impact.when else { return None };
        let told = || {
            let (place, expected) = ((impact.when_place, "impact.time"), format!("a time from {start:?} s on and before {end:?} s"));
            Diagnostic::error(&self.scene.file, place, Code::Together, format!("{found:?}"), expected)
        };
        (found < start || found >= end).then(|| Fault::Scene(told()))
    }
}
