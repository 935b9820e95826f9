//! Mass on the axes of joints, given back to the bodies beyond them where fewer numbers are left.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use super::pass::{counts_an_offset, within};
use super::regroup::{regroup_body, subtract};
use crate::Scalar;
use crate::model::{Body, Model};
use crate::spatial::SpatialInertia;

impl<S: Scalar> Model<S> {
    /// The model with inertias for inverse dynamics beside its own ([`Body::lent`]).
    ///
    /// What [`super::pass::regroup`] gives to the parent of a revolute joint need not all stay there: wherever on the joint's axis a mass is, and in whichever of the two bodies, the torques are the same. The mass
    /// with which the parent's h_x or h_y vanishes is lent to the child, at its origin, where that takes fewer instructions, from the tips inward; no more than twice what the joint carries ([`Model::carried`],
    /// kg, before regrouping), as greater masses would cost digits. Mass matrices want bodies without mass, and keep their own. For a model that is regrouped.
    ///
    /// # Panics
    /// If `carried` is not as long as there are bodies.
    #[must_use]
    pub fn lent(&self, carried: &[S]) -> Self {
        let mut model = self.clone();
        let handed_on = self.forces_handed_on();
        for i in self.inward() {
            regroup_body(&mut model, i);
            if let Some((child, parent)) = cheapest(&model, i, &handed_on, carried[i] + carried[i]) {
                model.bodies[i].inertia = child;
                model.bodies[self.bodies[i].parent].inertia = parent;
            }
        }
        for (lent, own) in model.bodies.iter_mut().zip(&self.bodies) {
            lent.lent = Some(Box::new(core::mem::replace(&mut lent.inertia, own.inertia)));
        }
        model
    }

    /// Whether inverse dynamics needs the force on each body, as there is a lever somewhere on its way to the base, or a joint that slides.
    fn forces_handed_on(&self) -> Vec<bool> {
        let mut handed_on = vec![false; self.bodies.len()];
        for i in self.outward() {
            let Body { joint, parent, .. } = self.bodies[i];
            handed_on[i] = !joint.is_rotation_about_axis() || parent != 0 && (handed_on[parent] || counts_an_offset(self, i));
        }
        handed_on
    }

    /// Whether body `i` can be lent something: its parent carries nothing else, so that limbs that are alike stay so, and more of the parent than I_zz is felt.
    fn borrows(&self, i: usize) -> bool {
        let parent = self.bodies[i].parent;
        let first = self.bodies[parent].parent == 0 && self.bodies[parent].joint.is_rotation_about_axis();
        let alone = self.outward().filter(|&k| self.bodies[k].parent == parent).take(2).count() == 1;
        self.bodies[i].joint.is_rotation_about_axis() && parent != 0 && !first && alone
    }
}

/// The inertias of a body and of its parent.
type Pair<S> = (SpatialInertia<S>, SpatialInertia<S>);

/// Those of body `i` and of its parent that take fewest instructions; `None` if these are what they have.
fn cheapest<S: Scalar>(model: &Model<S>, i: usize, handed_on: &[bool], most: S) -> Option<Pair<S>> {
    let (body, parent) = (&model.bodies[i], &model.bodies[model.bodies[i].parent]);
    // The parent gives away what it can in turn.
    let kept = |own: &SpatialInertia<S>| parent.joint.unfelt(own).map_or(*own, |given| subtract(*own, given));
    let both = |(child, own): &Pair<S>| price(child, handed_on[i]) + price(&kept(own), handed_on[body.parent]);
    let loans = (0..2).filter(|_| model.borrows(i)).filter_map(|k| loan(body, &parent.inertia, k, most));
    let best = loans.min_by_key(both)?;
    (both(&best) < both(&(body.inertia, parent.inertia))).then_some(best)
}

/// The inertias of a body and of its parent, which has `own`, once the mass is lent with which the parent's h_x or h_y vanishes; `None` if there is no such mass, or too great a one.
fn loan<S: Scalar>(body: &Body<S>, own: &SpatialInertia<S>, k: usize, most: S) -> Option<Pair<S>> {
    let lever = body.placement.position;
    if lever[k].is_zero() {
        return None;
    }
    // h = m l
    let lent = SpatialInertia { mass: own.first[k] / lever[k], ..SpatialInertia::zero() };
    if !within(lent.mass.abs(), most) {
        return None;
    }
    let (mut child, mut left) = (body.inertia, subtract(*own, lent.moved(&body.placement)));
    child += lent;
    left.first[k] = S::zero();
    Some((child, left))
}

/// Instructions that the numbers of a body take in inverse dynamics, by whether its force is handed on.
fn price<S: Scalar>(inertia: &SpatialInertia<S>, handed_on: bool) -> usize {
    let SpatialInertia { mass, first, second } = inertia;
    let count = |numbers: &[S]| numbers.iter().filter(|x| !x.is_zero()).count();
    // f = m a + U h, which takes a sum on U's diagonal; n = h × a + …
    let (of_mass, of_first) = if handed_on { (3, 6) } else { (0, 2) };
    let diagonal = 2 * count(&[second.m11, second.m22, second.m33]);
    let off_diagonal = 4 * count(&[second.m12, second.m13, second.m23]);
    of_mass * count(&[*mass]) + of_first * count(first.as_slice()) + diagonal + off_diagonal
}
