//! Simplification: the effect of each model pass on the error of inverse dynamics.

use articulated_codegen::model_pass::{View, model_passes};
use articulated_core::description::{Base, Description};
use articulated_core::model::Model;

use super::Effort;
use super::axes::from_textbook;
use crate::residual::worse;
use crate::stress::judge::{BACKWARD, State};
use crate::stress::robots::{built, hard, states};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "passes";

/// Maximum factor by which a pass may increase an error of at least a rounding of the terms.
const FACTOR: f64 = 4.0;

const WHY: &str = "moving mass and frames adds and takes away numbers of different sizes";

pub(super) fn rows(_: Effort) -> Vec<Row> {
    let robots: Vec<(&str, Description)> = hard();
    let errors: Vec<Vec<f64>> = robots.iter().map(|(_, d)| errors(d)).collect();
    let mut rows = Vec::new();
    for (k, (name, _, _)) in model_passes::<f64>().iter().enumerate() {
        let case = Case::new(NAME, format!("pass {name}, on {} robots of the corpus", robots.len()), WHY);
        let factor = errors.iter().map(|e| e[k + 1] / e[k].max(1.0)).fold(0.0, worse);
        rows.push(case.row("error of inverse_dynamics after it, over that before or over 1u, f64", factor, FACTOR, ""));
        rows.push(case.row("error of inverse_dynamics after it, f64", errors.iter().map(|e| e[k + 1]).fold(0.0, worse), BACKWARD, "u"));
    }
    rows
}

/// The largest error before all passes and after each.
fn errors(robot: &Description) -> Vec<f64> {
    let plain = built(robot, Base::Fixed);
    let states = states(&plain, 3, 61, 1.0);
    let mut passed = View::new(plain.clone());
    let mut errors = vec![error(robot, &plain, &passed, &states)];
    for (_, pass, _) in model_passes::<f64>() {
        passed = pass(passed);
        errors.push(error(robot, &plain, &passed, &states));
    }
    errors
}

fn error(robot: &Description, plain: &Model<f64>, passed: &View<f64>, states: &[State]) -> f64 {
    states.iter().map(|s| from_textbook(robot, plain, passed, s)).fold(0.0, worse)
}
