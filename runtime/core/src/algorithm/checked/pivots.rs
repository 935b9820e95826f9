//! Pivots of forward dynamics, and the terms whose difference they are.

use alloc::string::ToString;

use nalgebra::{Matrix3, Vector3};

use super::super::Workspace;
use super::super::aba::articulated_body_with_wrenches;
use super::super::forward_dynamics::forward_dynamics_with_wrenches;
use super::super::workspace::Column;
use super::{Measure, Singular, finite, least_pivot};
use crate::Scalar;
use crate::joint::JointLaw;
use crate::joint::with_pose;
use crate::model::{Body, Model};
use crate::spatial::{ArticulatedInertia, SpatialInertia, Twist, Wrench};

/// a = M(q)⁻¹·(τ − h(q, v)), or the joint at which M is singular to working precision.
///
/// q: `[nq]`; v: `[nv]`; tau: `[nv]` N·m|N; out: `[nv]` rad/s²|m/s², meaningless after an error. By
/// ABA, or M = Lᵀ D L if joints follow others. Returns the smallest D/(Σ|terms|) of all pivots, in
/// (0, 1]; below [`least_pivot`] it is an error. Cost: see [`super`].
///
/// # Panics
/// If a slice is shorter than stated. [`super::Solver`] returns an error.
pub fn checked_forward_dynamics<S: Scalar<Mask = bool>>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    out: &mut [S],
) -> Result<S, Singular<S>> {
    checked_forward_dynamics_with_wrenches(model, ws, q, v, tau, &[], out)
}

/// As [`checked_forward_dynamics`], with external wrenches on the frames.
///
/// wrenches: `[frames][6]` N·m and N, as [`Model::wrench_reference`] says, or empty.
///
/// # Errors
/// As [`checked_forward_dynamics`].
///
/// # Panics
/// As [`checked_forward_dynamics`].
pub fn checked_forward_dynamics_with_wrenches<S: Scalar<Mask = bool>>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    out: &mut [S],
) -> Result<S, Singular<S>> {
    let mut monitor = PivotMonitor::new();
    if model.has_followers() {
        forward_dynamics_with_wrenches(model, ws, q, v, tau, wrenches, out);
        factored_pivots(model, ws, q, |freedom, left| monitor.see(freedom, left));
    } else {
        articulated_body_with_wrenches(model, ws, q, v, tau, wrenches, out);
        articulated_body_pivots(model, ws, |freedom, left| monitor.see(freedom, left));
    }
    monitor.verdict(out, |freedom| model.joint_of(freedom).to_string())
}

/// The smallest pivot, and the first that is too small.
pub(super) struct PivotMonitor<S> {
    least: S,
    smallest: S,
    lost: Option<(usize, S)>,
}

impl<S: Scalar<Mask = bool>> PivotMonitor<S> {
    pub(super) fn new() -> Self {
        Self { least: least_pivot(), smallest: S::one(), lost: None }
    }

    pub(super) fn see(&mut self, freedom: usize, left: S) {
        // Not a number is not enough.
        let enough = left == self.least || (left - self.least).positive();
        if !enough && self.lost.is_none() {
            self.lost = Some((freedom, left));
        }
        if (self.smallest - left).positive() {
            self.smallest = left;
        }
    }

    /// The first that is too small: its index and its remaining part.
    pub(super) fn lost(&self) -> Option<(usize, S)> {
        self.lost
    }

    pub(super) fn verdict(self, out: &[S], name: impl Fn(usize) -> alloc::string::String) -> Result<S, Singular<S>> {
        let error = |freedom, measure, found| Singular { joint: name(freedom), freedom, measure, found, least: self.least };
        if let Some((freedom, left)) = self.lost {
            return Err(error(freedom, Measure::Pivot, left));
        }
        match out.iter().position(|x| !finite(*x)) {
            Some(freedom) => Err(error(freedom, Measure::Finite, out[freedom])),
            None => Ok(self.smallest),
        }
    }
}

/// D/(Σ|terms|) of each pivot of the articulated-body sweep that the workspace was last used for,
/// from the tips inward: `see(index in v, remaining part)`.
///
/// D_i = Sᵀ Iᴬ S is the sum of the body's own inertia and of the differences that its children pass
/// on. The measure is its part of the sum of the magnitudes. For models in which no joint follows
/// another.
pub fn articulated_body_pivots<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, mut see: impl FnMut(usize, S)) {
    for (size, body) in ws.sizes.iter_mut().zip(&model.bodies) {
        *size = Size::of(&body.inertia);
    }
    for i in model.inward() {
        let size = ws.sizes[i];
        let mut handed = Size::of_articulated(&ws.articulated[i]);
        for c in ws.columns_of(i) {
            let Column { at, axis, u, inverse, .. } = ws.columns[c];
            see(at, part(S::one() / inverse, size.along(&axis)));
            handed = handed.plus(&Size::of_product(&u, inverse));
        }
        let Body { parent, placement, .. } = &model.bodies[i];
        let origin = with_pose!(ws.bodies[i].pose, p => p.origin(placement));
        ws.sizes[*parent] = ws.sizes[*parent].plus(&handed.moved(&origin));
    }
}

/// The same for the elimination Lᵀ D L of M that
/// [`forward_dynamics`](super::super::forward_dynamics()) left in the workspace: D⁻¹ on the
/// diagonal of the matrix, composite inertias.
pub fn factored_pivots<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], mut see: impl FnMut(usize, S)) {
    // A coordinate that several joints follow sums √(S_iᵀ I S_i) of each at most.
    ws.row.fill(S::zero());
    for i in model.outward() {
        let (at, size) = (&model.bodies[i].coordinates, Size::of(&ws.composite[i]));
        for c in ws.columns_of(i) {
            let axis = with_pose!(ws.bodies[i].pose, p => p.subspace(&Matrix3::identity(), ws.columns[c].at - at.v));
            let rate = at.rate_of_one(q).map_or(S::one(), Scalar::abs);
            ws.row[ws.columns[c].at] += size.along(&axis).sqrt() * rate;
        }
    }
    for k in (0..model.nv).rev() {
        let pivot = S::one() / ws.matrix[k * model.nv + k];
        see(k, part(pivot, ws.row[k] * ws.row[k]));
    }
}

/// D over its terms, which are no less than D itself.
pub(super) fn part<S: Scalar>(pivot: S, terms: S) -> S {
    if pivot.is_zero() { pivot } else { pivot / S::select((terms - pivot).positive(), terms, pivot) }
}

/// Sums of magnitudes of the blocks of an inertia: of A (kg·m²), of B (kg·m), of C (kg).
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Size<S> {
    angular: S,
    coupling: S,
    linear: S,
}

impl<S: Scalar> Size<S> {
    pub(in super::super) fn zero() -> Self {
        Self { angular: S::zero(), coupling: S::zero(), linear: S::zero() }
    }

    /// The second moments are turned with their body: a rounding of the largest of them is a
    /// rounding of all.
    fn of(inertia: &SpatialInertia<S>) -> Self {
        let trace = diagonal(&inertia.second);
        Self { angular: trace, coupling: sum(&inertia.first), linear: inertia.mass.abs() }
    }

    fn of_articulated(inertia: &ArticulatedInertia<S>) -> Self {
        let all = |m: &Matrix3<S>| m.iter().fold(S::zero(), |sum, x| sum + x.abs());
        Self { angular: diagonal(&inertia.angular), coupling: all(&inertia.coupling), linear: diagonal(&inertia.linear) }
    }

    /// U Uᵀ/D.
    fn of_product(u: &Wrench<S>, inverse: S) -> Self {
        let (m, f) = (sum(&u.moment), sum(&u.force));
        let (by_m, by_f) = (m * inverse, f * inverse);
        Self { angular: by_m * m, coupling: by_m * f, linear: by_f * f }
    }

    fn plus(&self, other: &Self) -> Self {
        let Self { angular, coupling, linear } = *other;
        Self { angular: self.angular + angular, coupling: self.coupling + coupling, linear: self.linear + linear }
    }

    /// `C' = C, B' = B + [p]× C, A' = A + [p]× Bᵀ − B'[p]×`.
    fn moved(&self, position: &Vector3<S>) -> Self {
        let p = sum(position);
        let coupling = self.coupling + p * self.linear;
        Self { angular: self.angular + p * (self.coupling + coupling), coupling, linear: self.linear }
    }

    /// Of Sᵀ I S.
    fn along(&self, axis: &Twist<S>) -> S {
        let (w, v) = (sum(&axis.angular), sum(&axis.linear));
        let twice = self.coupling + self.coupling;
        w * (w * self.angular + twice * v) + v * v * self.linear
    }
}

fn sum<S: Scalar>(x: &Vector3<S>) -> S {
    x.x.abs() + x.y.abs() + x.z.abs()
}

fn diagonal<S: Scalar>(m: &Matrix3<S>) -> S {
    m.m11.abs() + m.m22.abs() + m.m33.abs()
}
