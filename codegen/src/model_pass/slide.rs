//! Frames slid along the axes of their joints, to where offsets and moments vanish.

use articulated_core::Scalar;
use articulated_core::index::{BodyId, ById};
use articulated_core::model::{Model, regroup};
use articulated_core::spatial::Vector3;

use super::places::{Places, offset, shifted};
use super::view::View;
use super::zeros::count;

/// Slides the frame of each revolute body along its axis, and shifts that of each prismatic body,
/// to minimise the work of the inverse-dynamics recursion.
///
/// The frame of a revolute body may lie anywhere on its axis, that of a prismatic body anywhere:
/// the joint does the same. Instructions go into every non-zero number of a body's offset from its
/// parent, into Σ_xz and Σ_yz, and into a force that must be shifted to the parent because its path
/// to the root has an offset. The cheapest places where numbers vanish are chosen for all bodies
/// together, from the tips inward. Exact for all joint torques; frames of links keep their poses.
/// The model must be regrouped, and stays so.
pub fn slide<S: Scalar>(view: View<S>) -> View<S> {
    let View { model, formulation } = view;
    let shifts = Plan::of(&model).shifts();
    if shifts.iter().all(|s| *s == Vector3::zeros()) {
        return View { model, formulation };
    }
    let model = model.changed(|parts| {
        for (i, body) in parts.bodies.with_ids_mut().skip(1) {
            body.placement.position = offset(body, shifts[i], shifts[body.parent]);
            body.inertia = shifted(&body.inertia, shifts[i]);
            body.effects.body.iter_mut().for_each(|e| e.placement.position -= shifts[i]);
            body.link.iter_mut().for_each(|link| link.placement.position -= shifts[i]);
        }
        for frame in &mut parts.frames {
            frame.placement.position -= shifts[frame.body];
        }
        parts.actuators.frames_mut().for_each(|own| own.placement.position -= shifts[own.body]);
    });
    // A prismatic body that was shifted has Σ again.
    View { model: regroup(model), formulation }
}

/// Instructions for a number of an offset, for one of Σ_xz and Σ_yz, for one of h of a prismatic
/// body, and for a force shifted to the parent.
const OFFSET: u32 = 5;
const MOMENT: u32 = 4;
const FIRST: u32 = 5;
const FORCE: u32 = 10;

/// Costs without and with the force shifted to the parent.
type ByForce<T> = [T; 2];

/// The cheapest place of each body, from the tips inward.
struct Plan<'a, S> {
    model: &'a Model<S>,
    places: Places<S>,
    /// For each body and each place of its parent: its own place, and whether the force is shifted
    /// to the parent there.
    best: ById<BodyId, Vec<ByForce<(usize, bool)>>>,
}

impl<'a, S: Scalar> Plan<'a, S> {
    fn of(model: &'a Model<S>) -> Self {
        let places = Places::of(model);
        let mut best = ById::<BodyId, _>::from(vec![Vec::new(); model.bodies().len()]);
        // Cost of a body with all that it carries, by its place.
        let mut costs: ById<BodyId, Vec<ByForce<u32>>> = places.all.iter().map(|p| vec![[0; 2]; p.len()]).collect();
        for i in model.inward() {
            let parent = model.bodies()[i].parent;
            for (cost, shift) in costs[i].iter_mut().zip(&places.all[i]) {
                let own = standing(model, i, *shift);
                cost.iter_mut().for_each(|c| *c += own);
            }
            for at in 0..places.all[parent].len() {
                let numbers: Vec<u32> = places.all[i].iter().map(|shift| offsets(model, i, *shift, places.all[parent][at])).collect();
                let cheapest =
                    [false, true].map(|needed| cheapest(&costs[i], &numbers, needed || !model.bodies()[i].joint.is_rotation_about_axis()));
                costs[parent][at].iter_mut().zip(&cheapest).for_each(|(sum, (_, cost))| *sum += cost);
                best[i].push(cheapest.map(|(choice, _)| choice));
            }
        }
        Self { model, places, best }
    }

    /// The shift of each body's frame, in its axes, m.
    fn shifts(&self) -> ById<BodyId, Vector3<S>> {
        let mut chosen = ById::<BodyId, _>::from(vec![(0, false); self.model.bodies().len()]);
        for i in self.model.outward() {
            let (at, needed) = chosen[self.model.bodies()[i].parent];
            chosen[i] = self.best[i][at][usize::from(needed)];
        }
        chosen.iter().zip(&self.places.all).map(|((k, _), shifts)| shifts[*k]).collect()
    }
}

/// The cheapest place of a body, whether its force is shifted to the parent there, and the cost,
/// from the cost at each place and the numbers of its offsets. `needed`: whether the force is
/// shifted for any offset.
fn cheapest(costs: &[ByForce<u32>], numbers: &[u32], needed: bool) -> ((usize, bool), u32) {
    let at = |(k, (cost, numbers)): (usize, (&ByForce<u32>, &u32))| {
        let needs_force = needed || *numbers > 0;
        let force = if needs_force { FORCE } else { 0 };
        ((k, needs_force), cost[usize::from(needs_force)] + OFFSET * numbers + force)
    };
    costs.iter().zip(numbers).enumerate().map(at).min_by_key(|(_, cost)| *cost).unwrap_or_default()
}

/// The cost of the moments of body `i` at a place.
fn standing<S: Scalar>(model: &Model<S>, i: BodyId, shift: Vector3<S>) -> u32 {
    let (joint, inertia) = (model.bodies()[i].joint, shifted(&model.bodies()[i].inertia, shift));
    if model.bodies()[i].parent == BodyId::BASE {
        0
    } else if joint.is_rotation_about_axis() {
        MOMENT * count(&[inertia.second.m13, inertia.second.m23])
    } else if joint.is_translation_along_axis() {
        FIRST * count(inertia.first.as_slice())
    } else {
        0
    }
}

/// Number of relevant numbers of the offset of body `i`: on the base, which is fixed, none, and on
/// a body that only turns about z, none along z.
fn offsets<S: Scalar>(model: &Model<S>, i: BodyId, shift: Vector3<S>, parent: Vector3<S>) -> u32 {
    let body = &model.bodies()[i];
    let below = &model.bodies()[body.parent];
    let steady = below.parent == BodyId::BASE && below.joint.is_rotation_about_axis();
    let counted = if body.parent == BodyId::BASE { 0 } else { 3 - usize::from(steady) };
    count(&offset(body, shift, parent).as_slice()[..counted])
}

/// Whether inverse dynamics needs the lever of body `i`.
pub(super) fn counts_an_offset<S: Scalar>(model: &Model<S>, i: BodyId) -> bool {
    offsets(model, i, Vector3::zeros(), Vector3::zeros()) > 0
}
