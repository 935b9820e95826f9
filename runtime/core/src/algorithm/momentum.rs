//! Centre of mass and centroidal momentum of the moving links.
//!
//! Momentum and its rate are what the base passes on in the recursion of inverse dynamics without
//! gravity, at rest for the momentum itself; the matrix has for its columns the momenta of
//! composite bodies. Orin, Goswami & Lee, *Auton. Robots* 35, 2013, 161–176.

use super::Workspace;
use super::common::{Axes, inertias, positions};
use super::effects::LoadCase;
use super::rnea::{momentum, recursion};
use crate::Scalar;
use crate::index::BodyId;
use crate::model::Model;
use crate::spatial::{Vector3, Wrench, rotate};

/// Centre of mass of the moving links, world axes.
///
/// q: `[nq]`; out: `[3]` m. Links fixed to the base do not count. Without any mass the result is
/// not finite.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn center_of_mass<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    let first = places(model, ws, q);
    let (_, center) = center(model, ws);
    out.copy_from_slice((first + center).as_slice());
}

/// Velocity of the centre of mass, world axes.
///
/// q: `[nq]`; v: `[nv]`; out: `[3]` m/s.
///
/// # Panics
/// As [`center_of_mass`].
pub fn center_of_mass_velocity<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    places(model, ws, q);
    generalised(model, ws, q, v);
    // ċ = l / m
    let (inverse, center) = center(model, ws);
    out.copy_from_slice((at_the_roots(model, ws, center).force * inverse).as_slice());
}

/// Acceleration of the centre of mass, world axes, gravity not added.
///
/// q: `[nq]`; v, a: `[nv]`; out: `[3]` m/s².
///
/// # Panics
/// As [`center_of_mass`].
pub fn center_of_mass_acceleration<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], out: &mut [S]) {
    let (inverse, rate) = rate(model, ws, q, v, a);
    // c̈ = l̇ / m
    out.copy_from_slice((rate.force * inverse).as_slice());
}

/// J with ċ = J v, world axes.
///
/// q: `[nq]`; out: `[3][nv]`. The column of a degree of freedom is the momentum of all that it
/// carries, over the whole mass.
///
/// # Panics
/// As [`center_of_mass`].
pub fn center_of_mass_jacobian<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    places(model, ws, q);
    inertias(model, ws);
    let (inverse, _) = center(model, ws);
    out.fill(S::zero());
    composites(model, ws, |at, wrench, _| add(out, model.nv, at, &(wrench.force * inverse)));
}

/// Momentum [k; l] of the moving links about their centre of mass, world axes.
///
/// q: `[nq]`; v: `[nv]`; out: `[6]` N·m·s and N·s.
///
/// # Panics
/// As [`center_of_mass`].
pub fn centroidal_momentum<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    places(model, ws, q);
    generalised(model, ws, q, v);
    let (_, center) = center(model, ws);
    out.copy_from_slice(&at_the_roots(model, ws, center).to_array());
}

/// A with [k; l] = A v, world axes.
///
/// q: `[nq]`; out: `[6][nv]`.
///
/// # Panics
/// As [`center_of_mass`].
pub fn centroidal_momentum_matrix<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    places(model, ws, q);
    inertias(model, ws);
    let (_, center) = center(model, ws);
    out.fill(S::zero());
    let (angular, linear) = out.split_at_mut(3 * model.nv);
    composites(model, ws, |at, wrench, position| {
        add(angular, model.nv, at, &wrench.shifted(position - center).moment);
        add(linear, model.nv, at, &wrench.force);
    });
}

/// d/dt [k; l], world axes: the wrench about the centre of mass that gravity, the base and the
/// surroundings must exert together.
///
/// q: `[nq]`; v, a: `[nv]`; out: `[6]` N·m and N.
///
/// # Panics
/// As [`center_of_mass`].
pub fn centroidal_momentum_rate<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], out: &mut [S]) {
    let (_, rate) = rate(model, ws, q, v, a);
    out.copy_from_slice(&rate.to_array());
}

/// Positions of all bodies about the origin of the first, which it returns, in world axes: however
/// far from the base a robot is, its momentum about its centre of mass has all its digits.
fn places<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> Vector3<S> {
    positions(model, ws, Axes::Base, q);
    let first = model.outward().next().map_or_else(Vector3::zeros, |i| ws.common[i].shift);
    for i in model.outward() {
        let (parent, shift) = (model.bodies[i].parent, ws.common[i].shift);
        ws.common[i].position = if parent == BodyId::BASE { shift - first } else { ws.common[parent].position + shift };
    }
    first
}

/// (1 / mass, centre of mass) of the moving links, about the origin that [`places`] chose.
fn center<S: Scalar>(model: &Model<S>, ws: &Workspace<S>) -> (S, Vector3<S>) {
    let (mut mass, mut first) = (S::zero(), Vector3::zeros());
    for i in model.outward() {
        let (state, inertia) = (&ws.common[i], &model.bodies[i].inertia);
        mass += inertia.mass;
        first += rotate(&state.rotation, inertia.first) + state.position * inertia.mass;
    }
    let inverse = S::one() / mass;
    (inverse, first * inverse)
}

/// Leaves in each body the momentum of all that it carries, as the wrench that would bring it about
/// in a unit of time.
fn generalised<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S]) {
    let mut row = core::mem::take(&mut ws.row);
    momentum(model, ws, q, v, &LoadCase::bare(), &mut row);
    ws.row = row;
}

/// The wrenches that the base passes to the bodies that hang on it, together, about `point` in
/// world axes.
fn at_the_roots<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, point: Vector3<S>) -> Wrench<S> {
    let one = |i: BodyId| {
        let (wrench, state) = (&ws.bodies[i].wrench, &ws.common[i]);
        wrench.turned(&state.rotation).shifted(state.position - point)
    };
    model.outward().filter(|&i| model.bodies[i].parent == BodyId::BASE).fold(Wrench::zero(), |sum, i| sum + one(i))
}

/// (1 / mass, Σ F about the centre of mass).
fn rate<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S]) -> (S, Wrench<S>) {
    places(model, ws, q);
    let mut row = core::mem::take(&mut ws.row);
    recursion(model, ws, q, v, a, &LoadCase::bare(), &mut row);
    ws.row = row;
    let (inverse, center) = center(model, ws);
    (inverse, at_the_roots(model, ws, center))
}

/// For each degree of freedom (its index in v, I^C S, the origin that is about), with I^C the
/// inertia of all that it carries.
fn composites<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, mut visit: impl FnMut(usize, &Wrench<S>, Vector3<S>)) {
    for i in model.inward() {
        let state = ws.common[i];
        for c in ws.columns_of(i) {
            visit(ws.columns[c].at, &state.inertia.apply(&ws.columns[c].axis), state.position);
        }
        let parent = model.bodies[i].parent;
        if parent != BodyId::BASE {
            ws.common[parent].inertia += state.inertia.shifted(state.shift);
        }
    }
}

fn add<S: Scalar>(out: &mut [S], nv: usize, at: usize, x: &Vector3<S>) {
    (0..3).for_each(|row| out[row * nv + at] += x[row]);
}
