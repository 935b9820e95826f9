//! Magnitudes of the terms of a torque that do not depend on the axes in which they are written.
//!
//! Each number of a vector that is turned from body to body adds up |cos| + |sin| times more with
//! every joint, so that sums of magnitudes of numbers grow exponentially along a chain. Norms do
//! not: along a long chain this scale is the smaller one, and the one that counts.

use articulated_core::algorithm::FunctionId;
use articulated_core::index::{BodyId, ById};
use articulated_core::joint::Joint;
use articulated_core::model::{Body, Model};
use articulated_core::nalgebra::Vector3;

/// Norms of a function's results. Empty for other functions, with effects, whose terms are not
/// included, and if joints follow others, whose angles are sums themselves.
pub fn norms(function: FunctionId, model: &Model<f64>, arguments: &[&[f64]]) -> Vec<f64> {
    let n = model.nv();
    if !is_plain(model) {
        return Vec::new();
    }
    match (function, arguments) {
        (FunctionId::inverse_dynamics, [q, v, a]) => torque(model, q, v, a, model.gravity().norm()),
        (FunctionId::mass_matrix, [q]) => {
            let unit = |k: usize| (0..n).map(|i| f64::from(u8::from(i == k))).collect::<Vec<f64>>();
            let columns: Vec<Vec<f64>> = (0..n).map(|k| torque(model, q, &vec![0.0; n], &unit(k), 0.0)).collect();
            (0..n * n).map(|k| columns[k % n][k / n].max(columns[k / n][k % n])).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether no joint follows another, and gravity is the only effect.
pub fn is_plain(model: &Model<f64>) -> bool {
    model.bodies().iter().all(|body| body.coordinates.mimic.is_none() && body.effects.joint.is_empty() && body.effects.body.is_empty())
}

/// Norms of the terms of a body's motion and wrench.
#[derive(Clone, Copy, Default)]
struct Norms {
    spin: f64,
    spin_rate: f64,
    acceleration: f64,
    moment: f64,
    force: f64,
    arm: f64,
}

/// Of inverse dynamics: accelerations add up outward, wrenches and their arms inward.
fn torque(model: &Model<f64>, q: &[f64], v: &[f64], a: &[f64], gravity: f64) -> Vec<f64> {
    let mut norms: ById<BodyId, Norms> = vec![Norms::default(); model.bodies().len()].into();
    norms[BodyId::BASE].acceleration = gravity;
    for i in model.outward() {
        norms[i] = carried(&model.bodies()[i], &norms[model.bodies()[i].parent], q, v, a);
    }
    let mut tau = vec![0.0; model.nv()];
    for i in model.inward() {
        let (body, own) = (&model.bodies()[i], norms[i]);
        for k in 0..body.joint.nv() {
            tau[body.coordinates.v + k] = along(body, k, own.moment, own.force);
        }
        let parent = &mut norms[body.parent];
        parent.moment += own.moment + own.arm * own.force;
        parent.force += own.force;
    }
    tau
}

/// The motion of a body from its parent's, and its own wrench.
fn carried(body: &Body<f64>, parent: &Norms, q: &[f64], v: &[f64], a: &[f64]) -> Norms {
    let at = &body.coordinates;
    let (rates, derivatives) = (&v[at.v..at.v + body.joint.nv()], &a[at.v..at.v + body.joint.nv()]);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (turn, turn_rate, slide, slide_rate) = match body.joint {
        Joint::Revolute | Joint::Spherical => (norm(rates), norm(derivatives), 0.0, 0.0),
        Joint::Prismatic => (0.0, 0.0, norm(rates), norm(derivatives)),
        Joint::Helical => (norm(rates), norm(derivatives), at.pitch.abs() * norm(rates), at.pitch.abs() * norm(derivatives)),
        Joint::Floating => (norm(&rates[..3]), norm(&derivatives[..3]), norm(&rates[3..]), norm(&derivatives[3..])),
    };
    let moved = match body.joint {
        Joint::Prismatic => at.coordinate(q).abs(),
        Joint::Helical => (at.pitch * at.coordinate(q)).abs(),
        Joint::Floating => Vector3::from_column_slice(&q[at.q..at.q + 3]).norm(),
        Joint::Revolute | Joint::Spherical => 0.0,
    };
    // The base does not move: no result depends on a body's distance from it.
    let arm = if body.parent == BodyId::BASE { 0.0 } else { body.placement.position.norm() + moved };
    let spin = parent.spin + turn;
    let spin_rate = parent.spin_rate + parent.spin * turn + turn_rate;
    let u = |rate: f64, spin: f64| rate + spin * spin;
    let acceleration = parent.acceleration + u(parent.spin_rate, parent.spin) * arm + 2.0 * spin * slide + slide_rate;
    let (m, h, s) = (body.inertia.mass.abs(), sum(body.inertia.first.as_slice()), sum(body.inertia.second.as_slice()));
    let turning = u(spin_rate, spin);
    let (moment, force) = (h * acceleration + 2.0 * turning * s, m * acceleration + turning * h);
    Norms { spin, spin_rate, acceleration, moment, force, arm }
}

/// Squares of small numbers underflow: a sum of magnitudes instead of a root of a sum of squares.
fn sum(x: &[f64]) -> f64 {
    x.iter().map(|x| x.abs()).sum()
}

/// The joint's component of a wrench.
fn along(body: &Body<f64>, k: usize, moment: f64, force: f64) -> f64 {
    match body.joint {
        Joint::Revolute | Joint::Spherical => moment,
        Joint::Prismatic => force,
        Joint::Helical => moment + body.coordinates.pitch.abs() * force,
        Joint::Floating => [moment, force][usize::from(k >= 3)],
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base;

    use super::*;
    use crate::magnitude::scales;

    /// Of forty joints in general position the sums of magnitudes of numbers are so large that any
    /// result would pass; of two they are the smaller ones.
    #[test]
    fn along_a_chain_norms_do_not_grow_as_numbers_do() {
        let chain = |n: usize| {
            let mut urdf = String::from("<robot name='chain'><link name='l0'/>");
            for k in 1..=n {
                urdf += &format!(
                    "<link name='l{k}'><inertial><origin xyz='0.05 0 0.1'/><mass value='1'/>\
                     <inertia ixx='0.02' ixy='0' ixz='0' iyy='0.03' iyz='0' izz='0.01'/></inertial></link>\
                     <joint name='j{k}' type='continuous'><parent link='l{}'/><child link='l{k}'/><origin xyz='0.1 0 0.2' rpy='0.4 -0.7 1.1'/>\
                     <axis xyz='0.1 -1 0.4'/></joint>",
                    k - 1
                );
            }
            let reading = articulated_formats::read((urdf + "</robot>").as_bytes(), &articulated_formats::Options::default()).unwrap();
            Model::new(&reading.description, Base::Fixed).unwrap()
        };
        let over_the_largest = |n: usize| {
            let (model, state) = (chain(n), vec![0.3; n]);
            let arguments = [&state[..], &state, &state];
            let mut tau = vec![0.0; n];
            articulated_core::algorithm::inverse_dynamics(
                &model,
                &mut articulated_core::algorithm::Workspace::new(&model),
                &state,
                &state,
                &state,
                &mut tau,
            );
            let scales = scales(&model, "inverse_dynamics", &arguments).unwrap();
            assert!(scales.iter().zip(&tau).all(|(scale, tau)| *scale >= tau.abs()), "{n} joints");
            scales.iter().copied().fold(0.0, f64::max) / tau.iter().map(|t| t.abs()).fold(0.0, f64::max)
        };
        let (short, long) = (over_the_largest(2), over_the_largest(40));
        assert!(short < 20.0 && long < 2e3, "{short} {long}");
    }
}
