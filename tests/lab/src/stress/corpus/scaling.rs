//! Units: masses, lengths and times by powers of two.

use articulated_codegen::model_pass::View;
use articulated_core::algorithm::FunctionId;
use articulated_core::description::{Base, Description};

use super::Effort;
use crate::stress::judge::{State, call_on_view};
use crate::stress::robots::{built, mixed, states};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "scaling";

/// Powers of two by which masses, lengths and times grow.
const SCALES: [[i32; 3]; 5] = [[10, 0, 0], [0, -12, 0], [0, 0, 7], [-40, 9, -3], [100, -30, 11]];

pub(super) fn rows(_: Effort) -> Vec<Row> {
    SCALES.iter().flat_map(|powers| one(*powers)).collect()
}

fn one([m, l, t]: [i32; 3]) -> Vec<Row> {
    let case = Case::new(
        NAME,
        format!("kilogram · 2^{m}, metre · 2^{l}, second · 2^{t}"),
        "a threshold with a unit, or a sum of numbers of different units, changes digits",
    );
    let (plain, powers) = (mixed(), [m, l, t]);
    let gravity = |l: i32, t: i32| [0.0, 0.3 * two(l - 2 * t), -9.81 * two(l - 2 * t)];
    let small = built(&plain, Base::Fixed).with_gravity(gravity(0, 0));
    let large = built(&scaled(&plain, m, l), Base::Fixed).with_gravity(gravity(l, t));
    let states = states(&small, 5, 31, 3.0);
    let functions = [FunctionId::inverse_dynamics, FunctionId::forward_dynamics, FunctionId::mass_matrix, FunctionId::kinetic_energy];
    let alike = |f: FunctionId, a: &View<f64>, b: &View<f64>| states.iter().filter(|s| !same(f, a, b, s, powers)).count() as f64;
    let [plain_small, plain_large] = [&small, &large].map(|m| View::new(m.clone()));
    let [small_passed, large_passed] = [&plain_small, &plain_large].map(|view| view.clone().passed());
    let mut rows: Vec<Row> = Vec::new();
    for f in functions {
        rows.push(case.row(
            format!("{}: states of 5 with another digit, f64", f.name()),
            alike(f, &plain_small, &plain_large),
            0.0,
            "states",
        ));
        let after = alike(f, &small_passed, &large_passed);
        rows.push(case.row(format!("{} after all model passes: states of 5 with another digit, f64", f.name()), after, 0.0, "states"));
    }
    rows
}

fn two(power: i32) -> f64 {
    2.0_f64.powi(power)
}

fn scaled(plain: &Description, m: i32, l: i32) -> Description {
    let mut out = plain.clone();
    for joint in &mut out.joints {
        joint.origin.xyz = joint.origin.xyz.map(|x| x * two(l));
    }
    for inertial in out.links.iter_mut().filter_map(|l| l.inertial.as_mut()) {
        inertial.mass *= two(m);
        inertial.origin.xyz = inertial.origin.xyz.map(|x| x * two(l));
        inertial.inertia = inertial.inertia.map(|x| x * two(m + 2 * l));
    }
    out
}

/// Whether a function returns the same digits for both.
fn same(function: FunctionId, small: &View<f64>, large: &View<f64>, state: &State, [m, l, t]: [i32; 3]) -> bool {
    let slides: Vec<i32> = small.model.joints().iter().map(|j| if j.kind.is_linear() { l } else { 0 }).collect();
    let units = |x: &[f64], per_time: i32| x.iter().zip(&slides).map(|(x, s)| x * two(s - per_time * t)).collect::<Vec<f64>>();
    let torque = |k: usize| m + 2 * l - 2 * t - slides[k];
    let tau: Vec<f64> = state.tau.iter().enumerate().map(|(k, x)| x * two(torque(k))).collect();
    let arguments = |q: Vec<f64>, v: Vec<f64>, a: Vec<f64>, tau: Vec<f64>| match function {
        FunctionId::inverse_dynamics => vec![q, v, a],
        FunctionId::forward_dynamics => vec![q, v, tau],
        FunctionId::kinetic_energy => vec![q, v],
        _ => vec![q],
    };
    let n = slides.len();
    let unit = |k: usize| match function {
        FunctionId::inverse_dynamics => torque(k),
        FunctionId::forward_dynamics => slides[k] - 2 * t,
        FunctionId::kinetic_energy => m + 2 * l - 2 * t,
        _ => m + 2 * l - slides[k / n] - slides[k % n],
    };
    let first = call_on_view(function, small, &arguments(state.q.clone(), state.v.clone(), state.a.clone(), state.tau.clone()));
    let second = call_on_view(function, large, &arguments(units(&state.q, 0), units(&state.v, 1), units(&state.a, 2), tau));
    first.iter().zip(&second).enumerate().all(|(k, (x, y))| x * two(unit(k)) == *y)
}
