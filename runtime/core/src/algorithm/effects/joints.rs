//! Effects on joints.

use alloc::vec::Vec;

use super::{LoadCase, duals};
use crate::Scalar;
use crate::algorithm::Workspace;
use crate::dual::Dual;
use crate::effect::{BallLaw, JointEffect, Law};
use crate::index::BodyId;
use crate::joint::Coordinates;
use crate::model::{Body, Model};
use crate::spatial::Vector3;
use crate::spatial::screw::{Quaternion, right_jacobian_inverse};

/// One effect on one degree of freedom: the effect, and its place in v.
pub(super) struct Acting<'a, S: 'static> {
    pub(super) effect: &'a JointEffect<S>,
    pub(super) at: usize,
    body: &'a Body<S>,
    model: &'a Model<S>,
}

/// A coordinate that an effect moves with.
#[derive(Clone, Copy)]
pub(super) struct Term<S> {
    /// Its place in v.
    pub(super) at: usize,
    /// The rate of the effect over the rate there: f′ of a joint that follows.
    pub(super) ratio: Option<S>,
    /// f″ and f‴ of a follower that is not linear.
    pub(super) bends: Option<[S; 2]>,
}

impl<'a, S: Scalar> Acting<'a, S> {
    /// Its own coordinate; meaningless if the joint does not have one for each degree of freedom.
    pub(super) fn coordinate(&self, q: &[S]) -> S {
        let at = &self.body.coordinates;
        match self.body.joint.quaternion() {
            Some(_) => S::zero(),
            None if at.mimic.is_some() => self.before().fold(at.coordinate(q), |sum, body| sum + body.coordinates.coordinate(q)),
            None => q[at.q + self.effect.freedom],
        }
    }

    /// The other bodies of a joint that follows several: q = Σ fᵢ(qᵢ).
    fn before(&self) -> impl Iterator<Item = &'a Body<S>> + use<'a, S> {
        self.model.series(self.body).skip(1)
    }

    /// The coordinates that it moves with at q: one, or several.
    pub(super) fn terms<'q>(&self, q: &'q [S]) -> impl Iterator<Item = Term<S>> + use<'a, 'q, S> {
        let others = self.before().map(move |body| Term::of(body.coordinates.v, &body.coordinates, q));
        core::iter::once(self.term(q)).chain(others)
    }

    /// Its law of the rotation, if it acts on a ball joint and has one.
    #[inline(always)]
    pub(super) fn on_ball(&self) -> Option<OnBall<'_, S>> {
        let Law::Force { ball: Some(law), .. } = self.effect.effect.law::<S>() else { return None };
        self.effect.effect.row().is_of_rotation(self.body.joint).then(|| OnBall {
            law,
            p: &self.effect.parameters,
            at: &self.body.coordinates,
        })
    }

    /// Its own rate.
    pub(super) fn rate(&self, q: &[S], v: &[S]) -> S {
        let own = |term: Term<S>| term.scaled(v[term.at]);
        self.terms(q).skip(1).fold(own(self.term(q)), |sum, term| sum + own(term))
    }

    /// The first of them; the only one of a rotor.
    pub(super) fn term(&self, q: &[S]) -> Term<S> {
        Term::of(self.at, &self.body.coordinates, q)
    }

    /// Whether its joint follows others, and not linearly.
    pub(super) fn is_bent(&self) -> bool {
        self.model.series(self.body).any(|body| body.coordinates.is_bent())
    }

    /// Whether it is a motor: a joint that follows another has none.
    pub(super) fn is_motor(&self) -> bool {
        self.body.coordinates.mimic.is_none() && matches!(self.effect.effect.law::<S>(), Law::Drive { .. })
    }
}

impl<S: Scalar> Term<S> {
    fn of(at: usize, own: &Coordinates<S>, q: &[S]) -> Self {
        Self { at, ratio: own.rate_of_one(q), bends: own.bend(q).zip(own.rate_of_bend(q)).map(<[S; 2]>::from) }
    }

    /// Times f′: a rate there as the effect's, or a torque of the effect as one there.
    pub(super) fn scaled(&self, x: S) -> S {
        self.ratio.map_or(x, |ratio| x * ratio)
    }
}

/// An effect on a ball joint whose law depends on φ = log(q₀⁻¹ q), the rotation vector from rest in
/// axes of the child: |φ| ≤ π, and at π one of two ([`Quaternion::log`]).
pub(super) struct OnBall<'a, S: 'static> {
    law: &'static BallLaw<S>,
    p: &'a [S],
    at: &'a Coordinates<S>,
}

impl<S: Scalar> OnBall<'_, S> {
    /// φ, rad.
    fn phi(&self, q: &[S]) -> Vector3<S> {
        let at = self.at.q;
        let q = Quaternion::from_array([q[at], q[at + 1], q[at + 2], q[at + 3]]);
        (self.law.rest)(self.p).conjugate().product(&q).log()
    }

    /// ω, rad/s.
    fn omega(&self, v: &[S]) -> Vector3<S> {
        let at = self.at.v;
        Vector3::new(v[at], v[at + 1], v[at + 2])
    }

    /// The torque, N·m.
    pub(super) fn torque(&self, q: &[S], v: &[S]) -> Vector3<S> {
        (self.law.torque)(self.p, self.phi(q), self.omega(v))
    }

    /// Columns of the derivatives of the torque τ: ∂τ/∂δ along q ⊕ δ, N·m/rad, and with `by_v`
    /// ∂τ/∂v, N·m·s/rad. The chain rule takes ∂φ/∂δ = J_r(φ)⁻¹.
    pub(super) fn slopes(&self, q: &[S], v: &[S], by_v: bool) -> [(Vector3<S>, Option<Vector3<S>>); 3] {
        let (phi, omega) = (self.phi(q), self.omega(v));
        let p = &duals(self.p)[..self.p.len()];
        let constant = |x: Vector3<S>| x.map(Dual::constant);
        let slope = |phi, omega| (self.law.slope)(p, phi, omega).map(|x: Dual<S>| x.slope);
        let jacobian = right_jacobian_inverse(phi);
        core::array::from_fn(|k| {
            let moved = phi.zip_map(&jacobian.column(k), Dual::new);
            let unit = |i: usize| if i == k { S::one() } else { S::zero() };
            let faster = omega.zip_map(&Vector3::from_fn(|i, _| unit(i)), Dual::new);
            (slope(moved, constant(omega)), by_v.then(|| slope(constant(phi), faster)))
        })
    }

    /// The energy that it stores, J.
    fn energy(&self, q: &[S]) -> S {
        (self.law.energy)(self.p, self.phi(q))
    }

    /// The power that it does not store, W.
    fn dissipation(&self, q: &[S], v: &[S]) -> S {
        let (phi, omega) = (self.phi(q), self.omega(v));
        let p = &duals(self.p)[..self.p.len()];
        // φ̇ = J_r(φ)⁻¹ ω
        let moving = phi.zip_map(&(right_jacobian_inverse(phi) * omega), Dual::new);
        (self.law.torque)(self.p, phi, omega).dot(&omega) + (self.law.rise)(p, moving).slope
    }
}

/// All effects on joints.
pub(super) fn all<S: Scalar>(model: &Model<S>) -> impl Iterator<Item = Acting<'_, S>> {
    model.outward().flat_map(move |i| {
        let body = &model.bodies[i];
        let at = body.coordinates.v;
        body.effects.joint.iter().map(move |effect| Acting { effect, at: at + effect.freedom, body, model })
    })
}

/// Visits the forces of effects on joints, each with its place in v.
#[inline(always)]
fn for_each_force<S: Scalar>(model: &Model<S>, q: &[S], v: &[S], mut visit: impl FnMut(usize, S)) {
    for one in all(model) {
        if let Some(ball) = one.on_ball() {
            let torque = ball.torque(q, v);
            (0..3).for_each(|k| visit(one.at + k, torque[k]));
        } else if let Law::Force { force, .. } = one.effect.effect.law::<S>() {
            let own = force(&one.effect.parameters, one.coordinate(q), one.rate(q, v));
            one.terms(q).for_each(|term| visit(term.at, term.scaled(own)));
        }
    }
}

/// −∂f/∂v of the force f of each effect on joints that depends on the rate, with its place in v;
/// of a ball joint and of joints that follow several the diagonal.
pub(crate) fn damping<S: Scalar>(model: &Model<S>, q: &[S], v: &[S], mut visit: impl FnMut(usize, S)) {
    for one in all(model) {
        if let Some(ball) = one.on_ball() {
            for (k, (_, by_rate)) in ball.slopes(q, v, true).into_iter().enumerate() {
                by_rate.into_iter().for_each(|column| visit(one.at + k, -column[k]));
            }
        } else if let Law::Force { slope, .. } = one.effect.effect.law::<S>() {
            let p = &duals(&one.effect.parameters)[..one.effect.parameters.len()];
            let own = slope(p, Dual::constant(one.coordinate(q)), Dual::variable(one.rate(q, v))).slope;
            one.terms(q).for_each(|term| visit(term.at, -term.scaled(term.scaled(own))));
        }
    }
}

/// τ −= the forces of effects on joints, which actuators must balance.
#[inline(always)]
pub(in crate::algorithm) fn apply_joint_forces<S: Scalar>(model: &Model<S>, q: &[S], v: &[S], tau: &mut [S]) {
    for_each_force(model, q, v, |at, force| tau[at] -= force);
}

/// τ += I a of rotors.
#[inline(always)]
pub(in crate::algorithm) fn armature<S: Scalar>(model: &Model<S>, [q, v, a]: [&[S]; 3], tau: &mut [S]) {
    for one in all(model) {
        if let Law::Inertia(inertia) = one.effect.effect.law::<S>() {
            let term = one.term(q);
            let linear = term.scaled(a[one.at]);
            let own = term.bends.map_or(linear, |[bend, _]| linear + bend * (v[one.at] * v[one.at]));
            tau[one.at] += term.scaled(inertia(&one.effect.parameters) * own);
        }
    }
}

/// M_ii += I of rotors.
#[inline(always)]
pub(in crate::algorithm) fn armature_matrix<S: Scalar>(model: &Model<S>, q: &[S], out: &mut [S]) {
    for one in all(model) {
        if let Law::Inertia(inertia) = one.effect.effect.law::<S>() {
            out[one.at * model.nv + one.at] += one.term(q).scaled(one.term(q).scaled(inertia(&one.effect.parameters)));
        }
    }
}

/// The torques that motors give.
#[inline(always)]
pub(in crate::algorithm) fn motor_torque<S: Scalar>(model: &Model<S>, v: &[S], tau: &[S], out: &mut [S]) {
    out.copy_from_slice(tau);
    for one in all(model) {
        if let (Law::Drive { torque, .. }, true) = (one.effect.effect.law::<S>(), one.is_motor()) {
            out[one.at] = torque(&one.effect.parameters, tau[one.at], v[one.at]);
        }
    }
}

/// The torques on joints: those of motors, and the forces of effects on joints. The vector belongs
/// to the workspace and must be returned.
pub(in crate::algorithm) fn input_torque<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    load: &LoadCase<S>,
) -> Vec<S> {
    let mut driven = core::mem::take(&mut ws.driven);
    if !load.forces {
        driven.copy_from_slice(tau);
        return driven;
    }
    motor_torque(model, v, tau, &mut driven);
    for_each_force(model, q, v, |at, force| driven[at] += force);
    driven
}

/// Inertia of the rotor on degree of freedom `k` of body `i`, if there is one.
pub(in crate::algorithm) fn rotor<S: Scalar>(model: &Model<S>, i: BodyId, k: usize) -> Option<S> {
    let of = |e: &JointEffect<S>| match e.effect.law::<S>() {
        Law::Inertia(inertia) if e.freedom == k => Some(inertia(&e.parameters)),
        _ => None,
    };
    model.bodies[i].effects.joint.iter().find_map(of)
}

/// For each motor its place in v, ∂/∂v and ∂/∂τ of the torque that it gives.
pub(in crate::algorithm) fn driven_slopes<S: Scalar>(model: &Model<S>, v: &[S], tau: &[S], mut visit: impl FnMut(usize, S, S)) {
    for one in all(model) {
        if let (Law::Drive { slope, .. }, true) = (one.effect.effect.law::<S>(), one.is_motor()) {
            let p = &duals(&one.effect.parameters)[..one.effect.parameters.len()];
            let (tau, v) = (tau[one.at], v[one.at]);
            let by_v = slope(p, Dual::constant(tau), Dual::variable(v)).slope;
            let by_tau = slope(p, Dual::variable(tau), Dual::constant(v)).slope;
            visit(one.at, by_v, by_tau);
        }
    }
}

/// The power of the effects that are not conservative, W.
pub(super) fn dissipation<S: Scalar>(model: &Model<S>, q: &[S], v: &[S]) -> S {
    let mut sum = S::zero();
    for one in all(model).filter(|one| !one.effect.effect.row().conservative) {
        if let Some(ball) = one.on_ball() {
            sum += ball.dissipation(q, v);
        } else if let Law::Force { force, rise, .. } = one.effect.effect.law::<S>() {
            let (q, v) = (one.coordinate(q), one.rate(q, v));
            let p = &duals(&one.effect.parameters)[..one.effect.parameters.len()];
            // f v + dE/dt
            sum += force(&one.effect.parameters, q, v) * v + rise(p, Dual::new(q, v)).slope;
        }
    }
    sum
}

/// The energy that effects on joints store, J.
pub(super) fn energy<S: Scalar>(model: &Model<S>, q: &[S]) -> S {
    let mut sum = S::zero();
    for one in all(model) {
        if let Some(ball) = one.on_ball() {
            sum += ball.energy(q);
        } else if let Law::Force { energy, .. } = one.effect.effect.law::<S>() {
            sum += energy(&one.effect.parameters, one.coordinate(q));
        }
    }
    sum
}
