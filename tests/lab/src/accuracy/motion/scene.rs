//! A scene as a motion to be measured.

use articulated::simulate::Settings;
use articulated_core::description::Base;
use articulated_motion::InitialState;
use articulated_scene::{Aim, Controller, Signal};

use super::subject::Subject;
use crate::error::Error;
use crate::session::Session;
use crate::table::counted;

/// The subject of a scene's motion.
pub(super) fn subject(session: &Session) -> Result<Subject, Error> {
    let scene = &session.scene;
    if scene.impact.is_some() {
        let line = format!(
            "{}: impact: found a blow, expected none for accuracy --simulate: when it falls is read off a curve between steps, and that has another order than the steps",
            scene.file
        );
        return Err(Error::input([line]));
    }
    let InitialState { q, v, controller } = session.start()?;
    let Settings { start, end, .. } = scene.simulation.as_ref().map_or_else(Settings::default, |s| s.settings.clone());
    let options = &session.request.options;
    let inside = session.model.gravity().norm() == 0.0 && options.robot.effects.is_empty() && !pushes_base(&controller);
    Ok(Subject {
        model: session.model.clone(),
        q,
        v,
        control: (controller, scene.control.period),
        start,
        seconds: end - start,
        free: options.robot.base == Base::Floating && inside,
    })
}

/// Whether a controller could push the six rates of a floating base.
fn pushes_base(controller: &Controller) -> bool {
    let some = |x: &[f64]| x.iter().take(6).any(|x| *x != 0.0);
    match controller {
        Controller::None => false,
        Controller::Torque(tau) => some(tau),
        Controller::Table(series) => series.rows.iter().any(|row| some(row)),
        Controller::Pd { kp, kd, torque, .. } => some(kp) || some(kd) || some(torque),
        Controller::Actuators { actuators, .. } => {
            actuators.laws.iter().chain(&actuators.passive).flat_map(|law| &law.drives).any(|drive| drive.v < 6)
        }
    }
}

impl Subject {
    /// Notes about its controller.
    pub(super) fn notes(&self) -> Vec<String> {
        let (controller, period) = &self.control;
        let mut notes = Vec::new();
        if let Controller::Table(series)
        | Controller::Pd { target: Aim::Moving(series), .. }
        | Controller::Actuators { controls: Signal::Moving(series), .. } = controller
        {
            notes.push(self.of_table(&series.times, period.is_some()));
        }
        if let Some(period) = period {
            notes.push(format!("the controller is sampled every {period} s: a step ends at each sample, and none is longer"));
        }
        notes
    }

    /// The note about rows at these times.
    fn of_table(&self, times: &[f64], sampled: bool) -> String {
        let rows = format!("the controller follows a table of {}", counted(times.len(), "row"));
        if sampled {
            return format!("{rows} and reads it at its samples alone: no step ends at a row as such");
        }
        let inside = times.iter().filter(|t| self.start < **t && **t < self.start + self.seconds).count();
        format!(
            "{rows}, {inside} of them within the motion: a step ends at each of these, so that no integrator meets a kink, and none takes fewer steps than that"
        )
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::control::Interpolation;
    use articulated_scene::Series;

    use super::*;

    #[test]
    fn steps_end_at_rows_within_the_motion_or_at_samples() {
        let mut subject = super::subject(&crate::session::bundled("pendulum")).expect("a scene without a blow");
        (subject.start, subject.seconds) = (0.0, 2.0);
        let times = vec![-1.0, 0.0, 0.31, 0.777, 2.0];
        let table = Controller::Table(Series { rows: vec![vec![1.0]; times.len()], times, between: Interpolation::Hold });
        subject.control = (table.clone(), None);
        let rows = "the controller follows a table of 5 rows";
        let kinks = "a step ends at each of these, so that no integrator meets a kink, and none takes fewer steps than that";
        assert_eq!(subject.notes(), [format!("{rows}, 2 of them within the motion: {kinks}")]);
        subject.control = (table, Some(0.25));
        let samples = "the controller is sampled every 0.25 s: a step ends at each sample, and none is longer";
        let sampled = format!("{rows} and reads it at its samples alone: no step ends at a row as such");
        assert_eq!(subject.notes(), [sampled, samples.to_owned()]);
    }
}
