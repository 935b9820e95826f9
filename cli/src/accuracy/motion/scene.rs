//! A scene as a motion to be measured.

use articulated::simulate::Settings;
use articulated_core::description::Base;
use articulated_scene::{Aim, Controller};

use super::subject::Subject;
use crate::failure::Failure;
use crate::simulate::motion::{self, Begin};
use crate::simulate::stage::Stage;
use crate::table::counted;

/// The scene that a word of the command line names, a file or a bundled one, and what moves in it.
pub(super) fn find(name: &str) -> Result<(Stage, Subject), Failure> {
    let stage = Stage::find(name)?;
    let subject = subject(&stage)?;
    Ok((stage, subject))
}

fn subject(stage: &Stage) -> Result<Subject, Failure> {
    let scene = &stage.prepared.scene;
    if scene.impact.is_some() {
        let line = format!(
            "{}: impact: found a blow, expected none for accuracy --simulate: when it falls is read off a curve between steps, and that has another order than the steps",
            scene.file
        );
        return Err(Failure::input([line]));
    }
    let Begin { q, v, controller } = motion::begin(stage)?;
    let span = scene.simulation.as_ref().map_or((Settings::default().start, Settings::default().end), |s| (s.start, s.end));
    let options = &stage.prepared.request.options;
    let inside = options.gravity == [0.0; 3] && options.effects.is_empty() && !pushes_base(&controller);
    Ok(Subject {
        model: stage.model.clone(),
        q,
        v,
        control: (controller, scene.control.period),
        start: span.0,
        seconds: span.1 - span.0,
        free: options.base == Base::Floating && inside,
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
    }
}

impl Subject {
    /// What its controller means for what is measured.
    pub(super) fn notes(&self) -> Vec<String> {
        let (controller, period) = &self.control;
        let mut notes = Vec::new();
        if let Controller::Table(series) | Controller::Pd { target: Aim::Moving(series), .. } = controller {
            notes.push(format!(
                "the controller follows a table of {}: a step ends at each, so that no integrator meets a kink, and none takes fewer steps than that",
                counted(series.times.len(), "row")
            ));
        }
        if let Some(period) = period {
            notes.push(format!("the controller is sampled every {period} s: a step ends at each sample, and none is longer"));
        }
        notes
    }
}
