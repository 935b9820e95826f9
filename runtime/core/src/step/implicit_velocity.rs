//! Semi-implicit Euler, implicit in the velocity: (M + h D) a = τ − h(q₀, v₀).
//!
//! D = −∂f/∂v of effects on joints, actuators, tendons and the medium is symmetric. Coriolis forces
//! are explicit, but for the gyroscopic ones of bodies that float alone. Source: MuJoCo
//! documentation, Numerical integration (implicitfast).

use alloc::vec;
use alloc::vec::Vec;

use super::euler::{advance, of_joints, put};
use super::{Drive, End, Start, free};
use crate::Scalar;
use crate::algorithm::ltdl::path_to_root;
use crate::algorithm::{Workspace, effects};
use crate::effect::Law;
use crate::index::BodyId;
use crate::joint::Joint;
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Matrix3, Twist, Vector3, Wrench};

/// D has the entries that M has too. Those between branches are left out, as in MuJoCo.
pub(super) fn implicit_velocity<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, end: &mut End<'_, S>) {
    let mut diagonal = of_joints(start);
    let (parents, h) = (ws.parent_dof.clone(), start.h);
    let mut coupled: Vec<(usize, usize, S)> = Vec::new();
    let mut add = |i: usize, j: usize, slope: S| {
        if i == j {
            put(&mut diagonal[i], h * slope);
        } else if path_to_root(&parents, i).any(|k| k == j) {
            coupled.push((i, j, h * slope));
        }
    };
    if let Drive::Controls(_) = start.drive {
        let rows = start.model.actuators.frame_rows(start.model, ws, start.q);
        start.model.actuators.damping(&start.inputs(start.act), &rows, (start.q, start.v), &mut add);
    }
    effects::body_damping(start.model, ws, (start.q, start.v), &mut add);
    (ws.diagonal, ws.coupled) = (diagonal, coupled);
    let mut a = vec![S::zero(); start.model.nv];
    start.acceleration(ws, (start.q, start.v, start.act), &mut a);
    free::of_origins(start.model, start.v, &mut a);
    for body in alone(start.model) {
        gyroscopic(start, ws, body, &mut a);
    }
    (ws.diagonal, ws.coupled) = (Vec::new(), Vec::new());
    advance(start, &a, end);
}

/// Whether slopes of D may be between degrees of freedom.
pub(super) fn has_coupled_rates<S: Scalar>(model: &Model<S>) -> bool {
    model.actuators.couple_rates() || effects::has_body_damping(model)
}

/// The bodies that float and carry no other body.
fn alone<S: Scalar>(model: &Model<S>) -> Vec<BodyId> {
    let carries = |i: BodyId| model.outward().any(|k| model.bodies[k].parent == i);
    let floats = |i: &BodyId| model.bodies[*i].joint == Joint::Floating && model.bodies[*i].parent == BodyId::BASE;
    model.outward().filter(floats).filter(|i| !carries(*i)).collect()
}

/// Accelerations x of a body alone with the slope of its gyroscopic forces b(ω), and with the
/// antisymmetric slopes of the medium: (M + h D + h ∂b/∂ω) x = (M + h D) x₀.
fn gyroscopic<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, body: BodyId, a: &mut [S]) {
    let (own, zero) = (&start.model.bodies[body], S::zero());
    let at = own.coordinates.v;
    let omega = Vector3::new(start.v[at], start.v[at + 1], start.v[at + 2]);
    let mut inertia = ArticulatedInertia::rigid(&own.inertia);
    for effect in &own.effects.body {
        if let Law::Added(added) = effect.effect.law::<S>() {
            inertia += added(&effect.parameters).moved(&effect.placement);
        }
    }
    let cross = |x: Vector3<S>| Matrix3::new(zero, -x[2], x[1], x[2], zero, -x[0], -x[1], x[0], zero);
    let unit = |k: usize| Vector3::from_fn(|i, _| if i == k { S::one() } else { zero });
    let six = |w: Wrench<S>| [w.moment[0], w.moment[1], w.moment[2], w.force[0], w.force[1], w.force[2]];
    let (mut implicit, mut right) = ([[zero; 6]; 6], [zero; 6]);
    for k in 0..6 {
        let (angular, linear) = if k < 3 { (unit(k), Vector3::zeros()) } else { (Vector3::zeros(), unit(k - 3)) };
        let column = six(inertia.apply(&Twist { angular, linear }));
        implicit.iter_mut().zip(column).for_each(|(row, x)| row[k] = x);
    }
    let mut damp = |i: usize, j: usize, x: S| implicit[i][j] += x;
    (0..6).for_each(|k| damp(k, k, ws.diagonal.get(at + k).copied().flatten().unwrap_or(zero)));
    for &(i, j, x) in ws.coupled.iter().filter(|(i, j, _)| *i >= at && *i < at + 6 && *j >= at && *j < at + 6) {
        damp(i - at, j - at, x);
        damp(j - at, i - at, x);
    }
    for i in 0..6 {
        right[i] = (0..6).fold(zero, |sum, k| sum + implicit[i][k] * a[at + k]);
    }
    for k in 0..3 {
        let turned = cross(unit(k)) * cross(omega) + cross(omega) * cross(unit(k));
        let slope = six(own.inertia.wrench(Vector3::zeros(), &turned));
        implicit.iter_mut().zip(slope).for_each(|(row, x)| row[k] += start.h * x);
    }
    effects::body_turning(start.model, ws, (start.q, start.v), body, |i, j, x| implicit[i - at][j - at] += start.h * x);
    eliminate(&mut implicit, &mut right);
    a[at..at + 6].copy_from_slice(&right);
}

/// A x = b by elimination, x in the place of b. A is near a positive definite matrix: no pivots.
fn eliminate<S: Scalar>(matrix: &mut [[S; 6]; 6], b: &mut [S; 6]) {
    for k in 0..6 {
        for i in k + 1..6 {
            let factor = matrix[i][k] / matrix[k][k];
            (k..6).for_each(|j| {
                let above = matrix[k][j];
                matrix[i][j] -= factor * above;
            });
            let above = b[k];
            b[i] -= factor * above;
        }
    }
    for k in (0..6).rev() {
        let known = (k + 1..6).fold(S::zero(), |sum, j| sum + matrix[k][j] * b[j]);
        b[k] = (b[k] - known) / matrix[k][k];
    }
}
