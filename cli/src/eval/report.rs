//! Results as data.

use articulated_core::algorithm::Function;
use articulated_core::effect::Applied;
use articulated_core::model::Model;
use articulated_reference::ROUNDOFF;
use serde::Serialize;

use super::BOUND;
use super::backward::Backward;
use super::layout::{Labelled, labelled};
use crate::effects::sorts;
use crate::robot::Robot;
use articulated_lab::residual::worse;

/// All results.
pub(super) struct Report {
    pub(super) robot: String,
    /// The scene that it is of.
    pub(super) scene: Option<String>,
    pub(super) base: &'static str,
    pub(super) gravity: [f64; 3],
    /// Names of the effects that are on.
    pub(super) effects: Vec<&'static str>,
    pub(super) compiler: Option<String>,
    pub(super) warnings: Vec<String>,
    pub(super) functions: Vec<FunctionReport>,
}

/// One function on all states.
pub(super) struct FunctionReport {
    pub(super) function: &'static Function<f64>,
    pub(super) outcomes: Vec<Outcome>,
    pub(super) largest: Option<Difference>,
    /// Of the states in which the result is judged by its torques.
    pub(super) backward: Option<Backward>,
}

/// One state's results.
pub(super) struct Outcome {
    pub(super) generic: Option<Vec<f64>>,
    pub(super) generated: Option<Vec<f64>>,
}

/// How far generic and generated results are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Difference {
    pub(super) state: usize,
    /// In the result's unit.
    pub(super) absolute: f64,
    /// In units of roundoff of the sum of the magnitudes of the terms.
    pub(super) units: f64,
}

impl Difference {
    /// The largest difference of two results in one state.
    pub(super) fn largest(state: usize, a: &[f64], b: &[f64], scale: &[f64]) -> Self {
        let mut worst = Self { state, absolute: 0.0, units: 0.0 };
        // If both are not finite, there is no difference: that is reported for the state.
        for (k, (a, b)) in a.iter().zip(b).enumerate().filter(|(_, (a, b))| a.is_finite() || b.is_finite()) {
            let absolute = (a - b).abs();
            let units = if absolute == 0.0 { 0.0 } else { absolute / (ROUNDOFF * scale.get(k).copied().unwrap_or(0.0)) };
            worst.absolute = worse(worst.absolute, absolute);
            worst.units = worse(worst.units, units);
        }
        worst
    }

    /// Whether it is more than rounding explains.
    pub(super) fn exceeded(&self) -> bool {
        self.units.is_nan() || self.units > BOUND
    }

    /// The larger difference, old or new.
    pub(super) fn larger(old: Option<Self>, new: Self) -> Option<Self> {
        Some(match old {
            Some(old) if worse(old.units, new.units).to_bits() == old.units.to_bits() => {
                Self { absolute: worse(old.absolute, new.absolute), ..old }
            }
            Some(old) => Self { absolute: worse(old.absolute, new.absolute), ..new },
            None => new,
        })
    }
}

impl FunctionReport {
    /// Whether the results are further apart than rounding explains.
    pub(super) fn exceeded(&self) -> bool {
        self.largest.is_some_and(|d| d.exceeded()) || self.backward.is_some_and(|b| b.exceeded())
    }

    fn json(&self, model: &Model<f64>) -> FunctionInJson {
        let labelled = |out: &Option<Vec<f64>>| out.as_ref().map(|x| labelled(self.function, x, model));
        let outcome = |o: &Outcome| OutcomeInJson { generic: labelled(&o.generic), generated: labelled(&o.generated) };
        FunctionInJson {
            function: self.function.name,
            summary: self.function.summary,
            gives: crate::shape::dims(self.function.gives),
            unit: self.function.unit,
            states: self.outcomes.iter().map(outcome).collect(),
            largest_difference: self.largest.map(|d| DifferenceInJson {
                state: d.state,
                absolute: d.absolute,
                in_units_of_roundoff: d.units,
                bound: BOUND,
            }),
            largest_backward_error: self.backward.map(|b| BackwardInJson {
                states: b.states,
                state: b.state,
                torque: b.residual.torque,
                in_units_of_roundoff: b.residual.units,
                bound: BOUND,
            }),
        }
    }
}

/// All results with the names of joints and links.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ReportInJson<'a> {
    robot: &'a str,
    scene: Option<&'a str>,
    base: &'static str,
    gravity: [f64; 3],
    effects: &'a [&'static str],
    compiler: Option<&'a str>,
    warnings: &'a [String],
    functions: Vec<FunctionInJson>,
}

#[derive(Clone, Debug, Serialize)]
struct FunctionInJson {
    function: &'static str,
    summary: &'static str,
    gives: String,
    unit: &'static str,
    states: Vec<OutcomeInJson>,
    largest_difference: Option<DifferenceInJson>,
    largest_backward_error: Option<BackwardInJson>,
}

#[derive(Clone, Debug, Serialize)]
struct OutcomeInJson {
    #[serde(skip_serializing_if = "Option::is_none")]
    generic: Option<Labelled>,
    #[serde(skip_serializing_if = "Option::is_none")]
    generated: Option<Labelled>,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct DifferenceInJson {
    state: usize,
    absolute: f64,
    in_units_of_roundoff: f64,
    bound: f64,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct BackwardInJson {
    /// How many states are judged by it.
    states: usize,
    state: usize,
    /// N·m or N.
    torque: f64,
    in_units_of_roundoff: f64,
    bound: f64,
}

impl Report {
    pub(super) fn new(robot: &Robot, model: &Model<f64>, effects: &[Applied], warnings: Vec<String>) -> Self {
        Self {
            robot: robot.file.clone(),
            scene: robot.scene.clone(),
            base: robot.base(),
            gravity: model.gravity().into(),
            effects: sorts(effects),
            compiler: None,
            warnings,
            functions: Vec::new(),
        }
    }

    /// With the names of joints and links.
    pub(super) fn json(&self, model: &Model<f64>) -> ReportInJson<'_> {
        ReportInJson {
            robot: &self.robot,
            scene: self.scene.as_deref(),
            base: self.base,
            gravity: self.gravity,
            effects: &self.effects,
            compiler: self.compiler.as_deref(),
            warnings: &self.warnings,
            functions: self.functions.iter().map(|f| f.json(model)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Difference;
    use articulated_reference::ROUNDOFF;

    #[test]
    fn what_is_no_number_is_the_largest_difference() {
        let scale = [1.0, 2.0];
        let small = Difference::largest(0, &[1.0, 2.0], &[1.0, 2.0 + 8.0 * ROUNDOFF], &scale);
        assert_eq!((small.units, small.absolute), (4.0, 8.0 * ROUNDOFF));
        let broken = Difference::largest(1, &[f64::NAN, 1.0], &[1.0, 1.0], &scale);
        assert!(broken.units.is_nan());
        assert_eq!(Difference::larger(Some(small), broken).unwrap().state, 1);
        assert!(Difference::larger(Some(broken), small).unwrap().units.is_nan());
        assert_eq!(Difference::largest(0, &[0.0], &[0.0], &[0.0]).units, 0.0);
        assert_eq!(Difference::largest(0, &[f64::NAN, f64::INFINITY], &[f64::NAN, f64::NAN], &scale).units, 0.0);
    }
}
