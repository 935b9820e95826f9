//! A user's robot: random and hard states, generic and generated code, and the monitors.

use articulated_codegen::Precision;
use articulated_core::algorithm::{FunctionId, Workspace};
use articulated_core::index::{BodyId, ById};
use articulated_core::model::Model;
use articulated_core::monitor::{
    ADJOINT_LIMIT, adjoint_condition, pivot_cancellation, placement_orthonormality, quaternion_norms, scaled_condition, wrench_growth,
};

use super::judge::{BACKWARD, DERIVATIVES, Ends, Judge, State, call};
use super::levels::{self, BuiltRobot};
use super::machine::Machine;
use super::robots::{state, states};
use super::row::{Case, Row};
use crate::error::Error;
use crate::residual::worse;
use crate::robot::Robot;
use crate::states::quaternions;

/// The chapter of robots.
pub const NAME: &str = "robots";

const TAU: f64 = 20.0;

/// The measurements of a robot, and the ones that failed.
#[derive(Default)]
pub(super) struct Found {
    pub(super) rows: Vec<Row>,
    pub(super) notes: Vec<String>,
}

/// All rows of a robot.
pub(super) fn rows(robot: &Robot, model: &Model<f64>, given: &[State], generated: &[Precision]) -> Result<Found, Error> {
    let sets = sets(model, given);
    let made: Vec<BuiltRobot> = generated.iter().map(|level| make(robot, model, *level)).collect::<Result<_, _>>()?;
    let mut rows = Vec::new();
    for (name, why, states) in &sets {
        let case = Case::new(NAME, format!("{}: {name}", model.name()), why).by_terms();
        rows.extend(judged(&case, model, states));
        for made in &made {
            let case = Case::new(NAME, format!("{}, generated, {}: {name}", model.name(), made.level()), why).by_terms();
            rows.extend(levels::of_made(&case, model, made, states));
        }
    }
    rows.extend(watched(model, &sets));
    Ok(Found { rows, notes: left_out(robot, model, generated)? })
}

/// Which functions a robot is not judged by because it does not have them, and why.
fn left_out(robot: &Robot, model: &Model<f64>, generated: &[Precision]) -> Result<Vec<String>, Error> {
    let massless = articulated_codegen::massless(model);
    let mut functions = vec![FunctionId::forward_dynamics, FunctionId::solve_mass_matrix];
    functions.extend(generated.iter().flat_map(|level| levels::functions(model.nv(), *level)));
    let mut notes = Vec::new();
    for f in functions {
        if let Err(error) = articulated_codegen::defined(&robot.file, model, &massless, f.row::<f64>()) {
            let note = format!("{} is left out: {}", f.name(), error.found);
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
    }
    Ok(notes)
}

type Set = (&'static str, &'static str, Vec<State>);

/// Sets of states: given ones, random ones, and hard ones.
fn sets(model: &Model<f64>, given: &[State]) -> Vec<Set> {
    let alike = |x: f64| {
        let mut q = vec![x; model.nq()];
        quaternions(model).for_each(|(_, at)| q[at..at + 4].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]));
        vec![state(q, model.nv(), 72, TAU)]
    };
    let bound = |upper: bool| {
        let mut s = alike(0.0);
        for joint in model.joints().iter().filter(|j| j.q.1 == 1) {
            // A state cannot be at an infinite bound.
            s[0].q[joint.q.0] = joint.limit.map_or(0.0, |l| if upper { l.upper } else { l.lower }).clamp(-1e3, 1e3);
        }
        s
    };
    let fast = |mut s: Vec<State>| {
        s.iter_mut().for_each(|s| s.v.iter_mut().for_each(|v| *v *= 1e4));
        s
    };
    let mut sets: Vec<Set> = vec![
        ("states at random", "nothing special: what errors usually are", states(model, 8, 71, TAU)),
        ("all coordinates zero", "axes line up where whoever drew the robot stretched it out", alike(0.0)),
        ("at lower limits", "folded or stretched as far as it goes", bound(false)),
        ("at upper limits", "folded or stretched as far as it goes", bound(true)),
        (
            "all coordinates π/2",
            "right angles: axes are parallel again, cosines are what rounding left",
            alike(std::f64::consts::FRAC_PI_2),
        ),
        ("all coordinates 1e-9", "sines of the size of roundings squared", alike(1e-9)),
        ("all coordinates 1e8", "angles that need π to more digits than a double has", alike(1e8)),
        ("rates of 1e4", "velocity forces are large, and everything else the rest of their difference", fast(states(model, 2, 73, TAU))),
    ];
    if !given.is_empty() {
        sets.insert(0, ("states given", "yours", given.to_vec()));
    }
    sets
}

fn judged(case: &Case, model: &Model<f64>, states: &[State]) -> Vec<Row> {
    let double = Judge::<f64>::new(case, model);
    let mut rows = double.forward(states, model.nv() <= DERIVATIVES);
    rows.extend(double.solved(states, Ends::Either, BACKWARD));
    let single = Judge::<f32>::new(case, model);
    rows.extend(single.forward(states, false));
    rows.extend(single.solved(states, Ends::Either, BACKWARD));
    rows
}

/// The code of a robot at a level.
fn make(robot: &Robot, model: &Model<f64>, level: Precision) -> Result<BuiltRobot, Error> {
    let mut names = levels::functions(model.nv(), level);
    if !model.massless_joints().is_empty() {
        names.retain(|f| !f.row::<f64>().inverts_mass_matrix());
    }
    let names: Vec<String> = names.into_iter().map(|f| f.name().to_owned()).collect();
    let mut request = robot.request(&names);
    request.options.level = level;
    BuiltRobot::of(articulated_codegen::generate(&request)?)
}

/// The monitors, over all states.
fn watched(model: &Model<f64>, sets: &[Set]) -> Vec<Row> {
    let case = Case::new(NAME, format!("{}: monitors", model.name()), "what to look at when results look wrong");
    let states: Vec<&State> = sets.iter().flat_map(|(_, _, s)| s).collect();
    let mut ws = Workspace::new(model);
    let roundoff = <f64 as Machine>::ROUNDOFF;
    let depth = depth(model) as f64;
    let (mut turned, mut norm, mut growth, mut condition) = (0.0, 0.0, [0.0; 2], 0.0);
    let mut least = (f64::INFINITY, 0);
    for s in states {
        let mut off = vec![0.0; model.frames().len()];
        placement_orthonormality(&call(FunctionId::placements, model, std::slice::from_ref(&s.q)), &mut off);
        turned = off.into_iter().fold(turned, worse);
        norm = quaternion_norms(model, &s.q).map(|(_, n)| n.abs()).fold(norm, worse);
        for (m, f) in wrench_growth(model, &mut ws, [&s.q, &s.v, &s.a]) {
            growth = [worse(growth[0], m), worse(growth[1], f)];
        }
        condition = worse(condition, scaled_condition(model, &mut ws, &s.q));
        let mut left = vec![0.0; model.nv()];
        pivot_cancellation(model, &mut ws, &s.q, &mut left);
        // Numbers after a pivot of zero are NaN.
        least = left.into_iter().enumerate().map(|(k, x)| (x, k)).fold(least, |a, b| if b.0 < a.0 { b } else { a });
    }
    // The error of a rotation is twice that of the quaternion's norm².
    let allowed = 4.0 * (depth + 1.0) * roundoff + 2.0 * quaternions(model).count() as f64 * norm;
    let distance = model.outward().map(|i| model.bodies()[i].placement.position.norm()).fold(0.0, f64::max);
    let mut rows = vec![
        case.row(format!("|RᵀR − 1| of placements, over 4Nu and what quaternions are off, N = {depth}"), turned / allowed, 1.0, ""),
        case.row("|norm² − 1| of quaternions in q", norm / roundoff, 8.0, "u"),
        case.shown("a joint's moment over the largest of any body beyond", growth[0], ""),
        case.shown("a joint's force over the largest of any body beyond", growth[1], ""),
        case.remark(
            "condition number of Ad between neighbours; it depends on the units of length alone",
            adjoint_condition(distance),
            ADJOINT_LIMIT,
            "",
        ),
    ];
    if model.nv() > 0 {
        let name = format!(
            "what is left of the smallest pivot, of joint {:?}; less than 2¹⁰u is an error of the checked form",
            model.joint_of(least.1)
        );
        rows.push(case.shown("condition number of M scaled to a diagonal of ones", condition, ""));
        rows.push(case.shown(name, least.0, ""));
    }
    rows
}

/// The largest number of joints between a body and the base.
fn depth(model: &Model<f64>) -> usize {
    let mut depths = ById::<BodyId, _>::from(vec![0; model.bodies().len()]);
    model.outward().for_each(|i| depths[i] = depths[model.bodies()[i].parent] + 1);
    depths.into_iter().max().unwrap_or(0)
}
