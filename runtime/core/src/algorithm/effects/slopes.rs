//! First derivatives of effects, by dual numbers: each law is evaluated once more with the
//! derivative of its arguments.
//!
//! For a small motion of a joint k on the way from body i to the base, in axes of the body (Singh,
//! Russell & Wensing, *IEEE Robot. Autom. Lett.* 7, 2022): ∂V/∂q_k = ψ̇_k, ∂V̇/∂q_k = ψ̈_k − V ×
//! ψ̇_k, ∂V/∂v_k = S_k, ∂V̇/∂v_k = ψ̇_k + Ṡ_k − V × S_k.

use super::joints;
use super::{duals, on_body, station_in_base};
use crate::Scalar;
use crate::algorithm::Workspace;
use crate::algorithm::common::on_the_way;
use crate::dual::Dual;
use crate::effect::{BodyEffect, Law};
use crate::index::BodyId;
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Twist, Vector3, Wrench, rotate};

/// ∂τ/∂q, ∂τ/∂v and ∂τ/∂a of effects on joints; of `by_v` and `by_a` only where they are given.
pub(in crate::algorithm) fn on_joints<S: Scalar>(
    model: &Model<S>,
    [q, v, a]: [&[S]; 3],
    by_q: &mut [S],
    mut others: Option<(&mut [S], &mut [S])>,
) {
    for one in joints::all(model) {
        if let Some(ball) = one.on_ball() {
            for (k, (by_angle, by_rate)) in ball.slopes(q, v, others.is_some()).into_iter().enumerate() {
                let place = |i: usize| (one.at + i) * model.nv + one.at + k;
                (0..3).for_each(|i| by_q[place(i)] -= by_angle[i]);
                if let (Some((by_v, _)), Some(by_rate)) = (&mut others, by_rate) {
                    (0..3).for_each(|i| by_v[place(i)] -= by_rate[i]);
                }
            }
            continue;
        }
        let p = &one.effect.parameters;
        match (one.effect.effect.law::<S>(), &mut others) {
            (Law::Force { slope, force, .. }, others) => {
                let (d, own_q, own_v) = (&duals(p)[..p.len()], one.coordinate(q), one.rate(q, v));
                let own_by_q = slope(d, Dual::variable(own_q), Dual::constant(own_v)).slope;
                let with_rate = others.is_some() || one.is_bent();
                let own_by_v = with_rate.then(|| slope(d, Dual::constant(own_q), Dual::variable(own_v)).slope);
                // Of each coordinate by each: the torque on the one, the rate of the other.
                for row in one.terms(q) {
                    for column in one.terms(q) {
                        let at = row.at * model.nv + column.at;
                        by_q[at] -= column.scaled(row.scaled(own_by_q));
                        if let (Some([bend, _]), Some(own)) = (column.bends, own_by_v) {
                            by_q[at] -= row.scaled(own * bend * v[column.at]);
                        }
                        if let (Some((by_v, _)), Some(own)) = (&mut *others, own_by_v) {
                            by_v[at] -= column.scaled(row.scaled(own));
                        }
                    }
                    if let Some([bend, _]) = row.bends {
                        by_q[row.at * (model.nv + 1)] -= bend * force(p, own_q, own_v);
                    }
                }
            }
            (Law::Inertia(inertia), others) => {
                let (term, inertia, at) = (one.term(q), inertia(p), one.at * (model.nv + 1));
                if let Some([bend, rate]) = term.bends {
                    // f′ (f′ a + f″ v²)
                    let (v, a, twice) = (v[one.at], a[one.at], S::from_f64(2.0));
                    let square = v * v;
                    let own = term.scaled(a) + bend * square;
                    by_q[at] += inertia * (bend * own + term.scaled(bend * a + rate * square));
                    others.iter_mut().for_each(|(by_v, _)| by_v[at] += inertia * term.scaled(bend * v) * twice);
                }
                others.iter_mut().for_each(|(_, by_a)| by_a[at] += term.scaled(term.scaled(inertia)));
            }
            _ => {}
        }
    }
}

/// The same of effects on bodies, after all sweeps in world axes; adds their wrenches to the
/// bodies' forces.
pub(in crate::algorithm) fn on_bodies<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    by_q: &mut [S],
    mut others: Option<(&mut [S], &mut [S])>,
) {
    for i in model.outward() {
        for effect in &model.bodies[i].effects.body {
            match effect.effect.law::<S>() {
                Law::Wrench { .. } => pushed(model, ws, i, effect, by_q, others.as_mut().map(|(by_v, _)| &mut **by_v)),
                Law::Added(inertia) => {
                    let own = inertia(&effect.parameters).moved(&effect.placement);
                    let inertia = own.turned(&ws.common[i].rotation);
                    carried_along(model, ws, i, &inertia, by_q, others.as_mut().map(|(v, a)| (&mut **v, &mut **a)));
                }
                _ => {}
            }
        }
    }
}

/// A law's wrench on body `i`.
fn pushed<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    i: BodyId,
    effect: &BodyEffect<S>,
    by_q: &mut [S],
    mut by_v: Option<&mut [S]>,
) {
    let Law::Wrench { wrench, slope, .. } = effect.effect.law::<S>() else { return };
    let turn = ws.common[i].rotation;
    let at = station_in_base(model, ws, i, effect);
    let w = on_body(effect, &wrench(&effect.parameters, &at)).turned(&turn);
    ws.common[i].force = ws.common[i].force - w;
    let p = &duals(&effect.parameters)[..effect.parameters.len()];
    let axes = turn * effect.placement.rotation;
    let offset = rotate(&turn, effect.placement.position);
    // A twist about the body's origin, in the effect's frame.
    let there = |x: &Twist<S>| x.at(offset).turned_back(&axes);
    let change = |step: &Twist<S>, of_twist: &Twist<S>| {
        let w = slope(p, &at.moved(&there(step), &there(of_twist)));
        let slope = |x: Vector3<Dual<S>>| x.map(|x| x.slope);
        on_body(effect, &Wrench { moment: slope(w.moment), force: slope(w.force) }).turned(&turn)
    };
    on_the_way(model, ws, i, Vector3::zeros(), |k, d| {
        let (axis, psi_dot) = (k.axis.at(d), k.psi_dot.at(d));
        subtract(model, ws, i, &change(&axis, &psi_dot), k.at, by_q);
        if let Some(by_v) = &mut by_v {
            subtract(model, ws, i, &change(&Twist::zero(), &axis), k.at, by_v);
        }
    });
}

/// Added mass of body `i`, in common axes about its origin.
fn carried_along<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    i: BodyId,
    inertia: &ArticulatedInertia<S>,
    by_q: &mut [S],
    mut others: Option<(&mut [S], &mut [S])>,
) {
    let twist = ws.common[i].twist;
    // The fluid at rest does not fall.
    let gravity = Twist { angular: Vector3::zeros(), linear: model.gravity };
    let momentum = inertia.apply(&twist);
    let force = inertia.apply(&(ws.common[i].acceleration + gravity)) + twist.cross_wrench(&momentum);
    ws.common[i].force += force;
    // −δ(G V̇ + V ×* G V)
    let change = |of_twist: &Twist<S>, of_acceleration: &Twist<S>| {
        let turned = of_twist.cross_wrench(&momentum) + twist.cross_wrench(&inertia.apply(of_twist));
        Wrench::zero() - (inertia.apply(of_acceleration) + turned)
    };
    on_the_way(model, ws, i, Vector3::zeros(), |k, d| {
        let (axis, psi_dot) = (k.axis.at(d), k.psi_dot.at(d));
        let psi_ddot = (k.psi_ddot + gravity.cross(&k.axis)).at(d);
        subtract(model, ws, i, &change(&psi_dot, &(psi_ddot - twist.cross(&psi_dot))), k.at, by_q);
        if let Some((by_v, by_a)) = &mut others {
            let rate = psi_dot + k.s_dot.at(d) - twist.cross(&axis);
            subtract(model, ws, i, &change(&axis, &rate), k.at, by_v);
            subtract(model, ws, i, &change(&Twist::zero(), &axis), k.at, by_a);
        }
    });
}

/// Subtracts S_lᵀ w from element (l, k) for each column l on the way.
fn subtract<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId, w: &Wrench<S>, k: usize, matrix: &mut [S]) {
    on_the_way(model, ws, i, Vector3::zeros(), |l, d| matrix[l.at * model.nv + k] -= w.power(&l.axis.at(d)));
}
