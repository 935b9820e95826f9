//! Shifts mass on joint axes from parents to children where fewer numbers remain.

use articulated_core::Scalar;
use articulated_core::index::{BodyId, ById};
use articulated_core::model::{Body, Model, regroup_body, subtract};
use articulated_core::spatial::SpatialInertia;

use super::slide::counts_an_offset;
use super::view::View;
use super::zeros::within;

impl<S: Scalar> View<S> {
    /// The view with separate inertias for inverse dynamics
    /// ([`Formulation::torque_inertias`](articulated_core::algorithm::Formulation)).
    ///
    /// Mass that regrouping moves to the parent of a revolute joint may also be in the child,
    /// anywhere on the joint's axis: the torques are the same. The mass with which the parent's h_x
    /// or h_y vanishes is shifted to the child's origin where that takes fewer instructions, from
    /// the tips inward. It is at most twice the mass that the joint carries ([`Model::carried`],
    /// kg, before regrouping), since greater masses would cost digits. Mass matrices profit from
    /// bodies without mass, and keep their own inertias. The model must be regrouped.
    ///
    /// # Panics
    /// If `carried` does not have one entry per body.
    #[must_use]
    pub fn with_shifted_masses(mut self, carried: &ById<BodyId, S>) -> Self {
        let mut model = self.model.clone();
        let needs_force = forces_shifted_to_parents(&model);
        for i in self.model.inward() {
            regroup_body(&mut model, i);
            if let Some((child, parent)) = cheapest(&model, i, &needs_force, carried[i] + carried[i]) {
                model.set_inertia(i, child);
                model.set_inertia(self.model.bodies()[i].parent, parent);
            }
        }
        self.formulation.torque_inertias = model.bodies().iter().map(|body| body.inertia).collect();
        self
    }
}

/// Whether inverse dynamics needs the force on each body: there is a lever on its path to the root,
/// or a joint that moves its origin.
fn forces_shifted_to_parents<S: Scalar>(model: &Model<S>) -> ById<BodyId, bool> {
    let mut needs_force = ById::<BodyId, _>::from(vec![false; model.bodies().len()]);
    for i in model.outward() {
        let Body { joint, parent, .. } = model.bodies()[i];
        needs_force[i] = !joint.is_rotation_about_axis() || parent != BodyId::BASE && (needs_force[parent] || counts_an_offset(model, i));
    }
    needs_force
}

/// Whether mass may move from the parent to body `i`: it is the only child, so that isomorphic
/// limbs stay isomorphic, and more than I_zz of the parent affects torques.
fn takes_mass<S: Scalar>(model: &Model<S>, i: BodyId) -> bool {
    let parent = model.bodies()[i].parent;
    let first = model.bodies()[parent].parent == BodyId::BASE && model.bodies()[parent].joint.is_rotation_about_axis();
    let alone = model.outward().filter(|&k| model.bodies()[k].parent == parent).take(2).count() == 1;
    model.bodies()[i].joint.is_rotation_about_axis() && parent != BodyId::BASE && !first && alone
}

/// The inertias of a body and of its parent.
type Pair<S> = (SpatialInertia<S>, SpatialInertia<S>);

/// The inertias of body `i` and of its parent with the fewest instructions; `None` if these are the
/// present ones.
fn cheapest<S: Scalar>(model: &Model<S>, i: BodyId, needs_force: &ById<BodyId, bool>, most: S) -> Option<Pair<S>> {
    let (body, parent) = (&model.bodies()[i], &model.bodies()[model.bodies()[i].parent]);
    // The parent passes its own regroupable inertia on.
    let kept = |own: &SpatialInertia<S>| parent.joint.regroupable(own).map_or(*own, |given| subtract(*own, given));
    let both = |(child, own): &Pair<S>| price(child, needs_force[i]) + price(&kept(own), needs_force[body.parent]);
    let shifts = (0..2).filter(|_| takes_mass(model, i)).filter_map(|k| mass_shift(body, &parent.inertia, k, most));
    let best = shifts.min_by_key(both)?;
    (both(&best) < both(&(body.inertia, parent.inertia))).then_some(best)
}

/// The inertias of a body and of its parent, which has `own`, after the shift of the mass with
/// which the parent's h_x or h_y vanishes; `None` if there is no such mass, or it is too great.
fn mass_shift<S: Scalar>(body: &Body<S>, own: &SpatialInertia<S>, k: usize, most: S) -> Option<Pair<S>> {
    let lever = body.placement.position;
    if lever[k].is_zero() {
        return None;
    }
    // h = m l
    let shifted = SpatialInertia { mass: own.first[k] / lever[k], ..SpatialInertia::zero() };
    if !within(shifted.mass.abs(), most) {
        return None;
    }
    let (mut child, mut left) = (body.inertia, subtract(*own, shifted.moved(&body.placement)));
    child += shifted;
    left.first[k] = S::zero();
    Some((child, left))
}

/// Instructions in inverse dynamics for the numbers of a body, with or without the force on it.
fn price<S: Scalar>(inertia: &SpatialInertia<S>, needs_force: bool) -> usize {
    let SpatialInertia { mass, first, second } = inertia;
    let count = |numbers: &[S]| numbers.iter().filter(|x| !x.is_zero()).count();
    // f = m a + U h, which takes a sum on U's diagonal; n = h × a + …
    let (of_mass, of_first) = if needs_force { (3, 6) } else { (0, 2) };
    let diagonal = 2 * count(&[second.m11, second.m22, second.m33]);
    let off_diagonal = 4 * count(&[second.m12, second.m13, second.m23]);
    of_mass * count(&[*mass]) + of_first * count(first.as_slice()) + diagonal + off_diagonal
}
