//! Axes and frames that coincide, nearly coincide, or are not of length one.

use articulated_codegen::model_pass::View;
use articulated_core::algorithm::FunctionId;
use articulated_core::description::{Base, Description, JointKind, Origin};
use articulated_core::model::Model;
use articulated_reference::{Big, Exact};

use super::Effort;
use crate::residual::worse;
use crate::stress::judge::{BACKWARD, Ends, Judge, State, call_on_view, called, scale};
use crate::stress::machine::{Machine, cast};
use crate::stress::robots::{Body, Builder, built, state, states};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "axes";

pub(super) fn rows(_: Effort) -> Vec<Row> {
    let mut rows = wrist();
    rows.extend(unnormalised());
    rows.extend(gimbal());
    rows.extend(coincident());
    rows
}

fn body() -> Option<Body> {
    Some(Body::of_radii(1.0, [0.05, 0.02, 0.1], [0.1, 0.12, 0.07]))
}

/// Three axes through a point; in the middle the first and the last are one line, or nearly.
fn wrist() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, bend) in [("0", 0.0), ("1e-15", 1e-15), ("1e-9", 1e-9), ("1e-4", 1e-4)] {
        let case = Case::new(
            NAME,
            format!("a wrist whose first and last axes are {name} rad apart"),
            "the Jacobian loses a rank; the mass matrix does not, since links have mass",
        );
        let arm = Builder::new("wrist")
            .turn([0.0, 1.0, 0.0], [0.0; 3], body())
            .turn([0.0, 0.0, 1.0], [0.3, 0.0, 0.2], body())
            .turn([0.0, 1.0, 0.0], [0.0; 3], body())
            .turn([0.0, 0.0, 1.0], [0.0; 3], body());
        let model = arm.model();
        let states = [state(vec![0.3, -0.8, bend, 1.1], 4, 41, 2.0)];
        rows.extend(Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
        rows.extend(Judge::<f32>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
    }
    rows
}

/// Axes as files have them: of any length, nearly along a coordinate axis.
fn unnormalised() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, axis) in [
        ("[1e-200, 2e-200, 3e-200]", [1e-200, 2e-200, 3e-200]),
        ("[3e200, -1e200, 2e200]", [3e200, -1e200, 2e200]),
        ("[1, 1e-9, -1e-17]", [1.0, 1e-9, -1e-17]),
        ("[5e-324, 0, 5e-324]", [5e-324, 0.0, 5e-324]),
        ("[0.577350269, 0.577350269, 0.577350269]", [0.577_350_269; 3]),
    ] {
        let case =
            Case::new(NAME, format!("axis {name}"), "squares of its numbers overflow, underflow, or leave nothing of the small ones");
        let robot = Builder::new("axis").turn(axis, [0.1, 0.2, 0.3], body()).turn([0.0, 1.0, 0.0], [0.3, 0.0, 0.0], body()).done();
        rows.push(textbook(&case, &robot, 42));
    }
    rows
}

/// Pitch at a right angle, where roll and yaw are the same turn; exactly, nearly, and as files
/// round it.
#[allow(clippy::approx_constant)]
// Why: such numbers occur in files.
fn gimbal() -> Vec<Row> {
    let right = std::f64::consts::FRAC_PI_2;
    let pitches = [("π/2", right), ("π/2 + 1e-15", right + 1e-15), ("1.5708", 1.5708), ("−1.57079632679", -1.570_796_326_79)];
    let one = |(name, pitch): (&str, f64)| {
        let case = Case::new(
            NAME,
            format!("rpy with a pitch of {name}"),
            "roll and yaw are about the same axis; a rule that finds angles again from the matrix divides by nothing",
        );
        let origin = |roll: f64, yaw: f64| Origin::new([0.1, 0.2, 0.3], [roll, pitch, yaw]);
        let robot = Builder::new("gimbal")
            .link(None, JointKind::Continuous, [0.0, 0.0, 1.0], origin(0.4, -0.9), body())
            .link(None, JointKind::Continuous, [0.0, 1.0, 0.0], origin(-2.0, 2.5), body())
            .done();
        textbook(&case, &robot, 43)
    };
    pitches.into_iter().map(one).collect()
}

/// Inverse dynamics against the textbook's, which computes constants of the file in 96 digits too.
fn textbook(case: &Case, robot: &Description, seed: u64) -> Row {
    let model = built(robot, Base::Fixed);
    let states = states(&model, 4, seed, 1.0);
    let error = states.iter().map(|s| from_textbook(robot, &model, &View::new(model.clone()), s)).fold(0.0, worse);
    case.row("inverse_dynamics against the textbook's form, f64", error, BACKWARD, "u")
}

/// The largest error of inverse dynamics of a robot by one model, measured by the terms of another.
pub(super) fn from_textbook(robot: &Description, plain: &Model<f64>, view: &View<f64>, s: &State) -> f64 {
    let arguments = [s.q.clone(), s.v.clone(), s.a.clone()];
    let found = call_on_view(FunctionId::inverse_dynamics, view, &arguments);
    let slices: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
    let Some(scale) = scale(FunctionId::inverse_dynamics, plain, &slices) else { return f64::NAN };
    Big::scope(|| {
        let Ok(book) = Exact::textbook(robot, Base::Fixed, articulated_core::model::GRAVITY) else { return f64::NAN };
        let expected = called(&book, FunctionId::inverse_dynamics, &arguments.each_ref().map(|x| cast::<Big>(x)));
        let off = |((e, f), s): ((&Big, &f64), &f64)| e.error_of(*f, f64::ROUNDOFF * s);
        expected.iter().zip(&found).zip(&scale).map(off).fold(0.0, worse)
    })
}

/// Joints on one another, with mass between: about one axis, along one line, three about one point.
fn coincident() -> Vec<Row> {
    let case = Case::new(NAME, "coincident joints with mass between", "motions repeat but for what little lies between them");
    let light = Some(Body::of_radii(1e-6, [0.0, 0.0, 0.01], [0.01; 3]));
    let robot = Builder::new("coincident")
        .turn([0.0, 0.0, 1.0], [0.0; 3], light)
        .turn([0.0, 0.0, 1.0], [0.0; 3], light)
        .turn([1.0, 0.0, 0.0], [0.0; 3], light)
        .turn([0.0, 1.0, 0.0], [0.0; 3], body());
    let model = robot.model();
    let states = states(&model, 4, 44, 1.0);
    let mut rows = Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).all(&states, Ends::Either, BACKWARD));
    rows
}
