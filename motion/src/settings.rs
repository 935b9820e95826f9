//! How a scene is simulated, as it says itself.

use articulated::simulate::{Output, Settings, Stiffness};
use articulated_scene::{Kind, Output as Recorded, SceneError, Simulation, Stiffness as Stiff, When};

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
        atol_each: Vec::new(),
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

#[cfg(test)]
mod tests {
    use articulated::simulate::IntegratorId;
    use articulated_scene::Scene;

    use super::*;

    #[test]
    fn defaults_of_scenes_are_those_of_the_library() {
        assert_eq!(settings(&Simulation::default()), Settings::default());
    }

    fn said(keys: &str) -> Settings {
        let scene = Scene::read("s.toml", &format!("[simulation]\n{keys}")).unwrap_or_else(|e| panic!("{e}"));
        settings(&scene.simulation.unwrap())
    }

    #[test]
    fn every_key_of_a_scene_is_a_setting() {
        let keys =
            "start = 0.5\nend = 2.5\nintegrator = 'rodas4'\nrtol = 1e-4\natol = 1e-5\nmin_step = 1e-7\nmax_step = 0.25\nfirst_step = 1e-3
            max_steps = 77\noutput = [0.75, 1.5]\nevent_tolerance = 1e-6\nstiffness = 'note'";
        let expected = Settings {
            integrator: IntegratorId::rodas4,
            start: 0.5,
            end: 2.5,
            step: None,
            rtol: 1e-4,
            atol: 1e-5,
            atol_each: Vec::new(),
            min_step: 1e-7,
            max_step: 0.25,
            first_step: Some(1e-3),
            max_steps: 77,
            output: Output::At(vec![0.75, 1.5]),
            event_tolerance: 1e-6,
            stiffness: Stiffness::Note,
        };
        assert_eq!(said(keys), expected);
        assert_eq!(said("end = 1\nstep = 0.125").step, Some(0.125));
        for (word, output) in [("0.5", Output::Every(0.5)), ("'steps'", Output::Steps), ("'ends'", Output::Ends)] {
            assert_eq!(said(&format!("end = 1\noutput = {word}")).output, output);
        }
    }
}
