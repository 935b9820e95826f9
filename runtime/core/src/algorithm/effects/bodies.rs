//! Effects on frames of bodies.

use alloc::vec::Vec;

use super::{LoadCase, any_on_bodies, on_body, places, station, station_in_base};
use crate::Scalar;
use crate::algorithm::Workspace;
use crate::algorithm::common::{Axes, on_the_way, positions};
use crate::algorithm::wrenches::place_bodies;
use crate::effect::{BodyEffect, EffectId, Law, Slopes};
use crate::index::BodyId;
use crate::joint::with_pose;
use crate::joint::{JointLaw, Mount};
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Matrix3, Twist, Vector3, Wrench, rotate, rotate_back};

/// Twists of all bodies in their own axes, into the common states; poses, origins and angular
/// velocities are known.
fn body_twists<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S]) {
    ws.common[BodyId::BASE].twist = Twist::zero();
    for i in model.outward() {
        let body = &model.bodies[i];
        let (at, carried) = (&body.coordinates, ws.common[body.parent].twist);
        // v_i = Rᵀ (v_λ + ω_λ × p) + S q̇
        let linear = with_pose!(ws.bodies[i].pose, p => {
            let mount = Mount::new(p, &body.placement);
            let mut linear = mount.outward(carried.at(mount.origin).linear);
            for k in 0..body.joint.nv() {
                let rate = at.rate_of_one(q).map_or(v[at.v + k], |m| v[at.v + k] * m);
                linear += p.subspace(&Matrix3::identity(), k).linear * rate;
            }
            linear
        });
        ws.common[i].twist = Twist { angular: ws.bodies[i].motion.omega, linear };
    }
}

/// F −= w of every effect, and F += G V̇ + V ×* G V of added mass, for the body's motion as it is
/// (RNEA).
pub(in crate::algorithm) fn apply_body_wrenches<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], load: &LoadCase<S>) {
    if !any_on_bodies(model) {
        return;
    }
    wrenches(model, ws, q, v, load);
    if !load.inertia {
        return;
    }
    added(model, ws, |ws, i, inertia| {
        let (motion, twist) = (&ws.bodies[i].motion, &ws.common[i].twist);
        let bias = bias_acceleration(ws, i, load.gravity);
        let acceleration = Twist { angular: motion.alpha, linear: motion.acceleration + bias };
        inertia.apply(&acceleration) + twist.cross_wrench(&momentum(inertia, twist))
    });
}

/// p −= w of every effect, and added mass in I and p (ABA).
pub(in crate::algorithm) fn articulate_body_effects<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    load: &LoadCase<S>,
) {
    if !any_on_bodies(model) {
        return;
    }
    wrenches(model, ws, q, v, load);
    added(model, ws, |ws, i, inertia| {
        ws.articulated[i] += *inertia;
        let bias = Twist { angular: Vector3::zeros(), linear: bias_acceleration(ws, i, load.gravity) };
        let twist = &ws.common[i].twist;
        inertia.apply(&bias) + twist.cross_wrench(&momentum(inertia, twist))
    });
}

/// Spatial acceleration that fluid at rest feels, less the classical one with gravity subtracted: g
/// − ω × v, in the body's axes.
fn bias_acceleration<S: Scalar>(ws: &Workspace<S>, i: BodyId, gravity: Vector3<S>) -> Vector3<S> {
    let twist = &ws.common[i].twist;
    rotate_back(&ws.placements[i].rotation, gravity) - twist.angular.cross(&twist.linear)
}

/// G V.
fn momentum<S: Scalar>(inertia: &ArticulatedInertia<S>, twist: &Twist<S>) -> Wrench<S> {
    inertia.apply(twist)
}

/// Poses, motions and wrenches of bodies.
fn wrenches<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], load: &LoadCase<S>) {
    place_bodies(model, ws, q);
    body_twists(model, ws, q, v);
    for i in model.outward().filter(|_| load.forces) {
        for effect in &model.bodies[i].effects.body {
            if let Law::Wrench { wrench, .. } = effect.effect.law::<S>() {
                let at = station(effect, &ws.placements[i], &ws.common[i].twist, model.gravity);
                let w = on_body(effect, &wrench(&effect.parameters, &at));
                ws.bodies[i].wrench = ws.bodies[i].wrench - w;
            }
        }
    }
}

/// Adds the result of `wrench` to the wrench of each body with added mass.
fn added<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    wrench: impl Fn(&mut Workspace<S>, BodyId, &ArticulatedInertia<S>) -> Wrench<S>,
) {
    for i in model.outward() {
        for effect in &model.bodies[i].effects.body {
            if let Law::Added(inertia) = effect.effect.law::<S>() {
                let inertia = inertia(&effect.parameters).moved(&effect.placement);
                let w = wrench(ws, i, &inertia);
                ws.bodies[i].wrench += w;
            }
        }
    }
}

/// M += Σ Jᵀ G J of added mass.
pub(in crate::algorithm) fn add_inertia<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    let is_added = |e: &crate::effect::BodyEffect<S>| matches!(e.effect.law::<S>(), Law::Added(_));
    if !model.bodies.iter().any(|b| b.effects.body.iter().any(is_added)) {
        return;
    }
    positions(model, ws, Axes::Base, q);
    let n = model.nv;
    for i in model.outward() {
        for effect in &model.bodies[i].effects.body {
            let Law::Added(inertia) = effect.effect.law::<S>() else { continue };
            let inertia = inertia(&effect.parameters).moved(&effect.placement);
            columns(model, ws, i, |k, own| {
                let w = inertia.apply(&own);
                columns(model, ws, i, |l, other| out[l * n + k] += w.power(&other));
            });
        }
    }
}

/// Whether the law of an effect on a body has damping.
pub(crate) fn has_body_damping<S: Scalar>(model: &Model<S>) -> bool {
    let has_damping = |own: &BodyEffect<S>| matches!(own.effect.law::<S>(), Law::Wrench { damping: Some(_), .. });
    model.bodies.iter().any(|body| body.effects.body.iter().any(has_damping))
}

/// Visits D_ij of D = Σ Jᵀ B J, i ≥ j, for the symmetric part of the slopes B = −∂w/∂V of effects
/// in the twists of their frames.
pub(crate) fn body_damping<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    (q, v): (&[S], &[S]),
    mut visit: impl FnMut(usize, usize, S),
) {
    if !has_body_damping(model) {
        return;
    }
    places(model, ws, q, v);
    for i in model.outward() {
        each_damping(model, ws, i, |slopes, own| {
            for (i, one) in own {
                let w = slopes.symmetric(one);
                for (j, other) in own.iter().filter(|(j, _)| j <= i) {
                    visit(*i, *j, dot(&w, other));
                }
            }
        });
    }
}

/// Visits all entries of Jᵀ B J for the antisymmetric part of the slopes B of effects on one body.
pub(crate) fn body_turning<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    (q, v): (&[S], &[S]),
    body: BodyId,
    mut visit: impl FnMut(usize, usize, S),
) {
    let is_of_all = |own: &BodyEffect<S>| own.effect == EffectId::ellipsoid_drag;
    if !model.bodies[body].effects.body.iter().any(is_of_all) {
        return;
    }
    places(model, ws, q, v);
    each_damping(model, ws, body, |slopes, own| {
        for (j, other) in own {
            let Some(w) = slopes.antisymmetric(other) else { return };
            own.iter().for_each(|(i, one)| visit(*i, *j, dot(&w, one)));
        }
    });
}

fn dot<S: Scalar>(a: &[S; 6], b: &[S; 6]) -> S {
    (0..6).fold(S::zero(), |sum, k| sum + a[k] * b[k])
}

/// The twist of a frame for a unit of each rate, in its axes, with the place of the rate in v.
type Columns<S> = [(usize, [S; 6])];

/// Visits the slopes of each effect on body `i` that has them, after [`places`].
fn each_damping<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId, mut visit: impl FnMut(&Slopes<S>, &Columns<S>)) {
    for effect in &model.bodies[i].effects.body {
        let Law::Wrench { damping: Some(damping), .. } = effect.effect.law::<S>() else { continue };
        let slopes = damping(&effect.parameters, &station_in_base(model, ws, i, effect));
        let turn = ws.common[i].rotation;
        let (axes, offset) = (turn * effect.placement.rotation, rotate(&turn, effect.placement.position));
        let mut own: Vec<(usize, [S; 6])> = Vec::new();
        on_the_way(model, ws, i, Vector3::zeros(), |column, d| {
            let Twist { angular: w, linear: v } = column.axis.at(d).at(offset).turned_back(&axes);
            own.push((column.at, [w[0], w[1], w[2], v[0], v[1], v[2]]));
        });
        visit(&slopes, &own);
    }
}

/// The columns of body `i`'s Jacobian that are not zero, in its axes about its origin, each with
/// its place in v.
fn columns<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId, mut visit: impl FnMut(usize, Twist<S>)) {
    let turn = &ws.common[i].rotation;
    on_the_way(model, ws, i, Vector3::zeros(), |column, d| visit(column.at, column.axis.at(d).turned_back(turn)));
}
