//! Places on the axes of joints where something vanishes.

use articulated_core::Scalar;
use articulated_core::index::{BodyId, ById};
use articulated_core::model::{Body, Model};
use articulated_core::spatial::{SpatialInertia, Vector3, rotate, rotate_back};

use super::zeros::{or_zero, within};

/// Most places of one body.
const MOST: usize = 6;

/// Shifts of the frame of each body, in its axes, m; the first is zero.
pub(super) struct Places<S> {
    pub(super) all: ById<BodyId, Vec<Vector3<S>>>,
    /// How far a frame may be shifted: as far as the offsets there reach.
    reach: ById<BodyId, S>,
}

impl<S: Scalar> Places<S> {
    /// The places where the body has one moment less, is level with a child, or has one number less
    /// in its offset.
    pub(super) fn of(model: &Model<S>) -> Self {
        let length = |body: &Body<S>| body.placement.position.fold(S::zero(), |sum, x| sum + x.abs());
        let mut reach: ById<BodyId, S> = model.bodies().iter().map(length).collect();
        for i in model.inward() {
            reach[model.bodies()[i].parent] += length(&model.bodies()[i]);
        }
        let mut places = Self { all: vec![vec![Vector3::zeros()]; model.bodies().len()].into(), reach };
        for i in model.outward() {
            places.without_moments(model, i);
        }
        for i in model.inward() {
            places.level_with_child(model, i);
        }
        for i in model.outward() {
            places.without_offset(model, i);
        }
        places
    }

    fn without_moments(&mut self, model: &Model<S>, i: BodyId) {
        let (o, joint, inertia) = (S::zero(), model.bodies()[i].joint, &model.bodies()[i].inertia);
        if joint.is_rotation_about_axis() {
            // Σ_xz − h_x d = 0, Σ_yz − h_y d = 0
            for k in (0..2).filter(|&k| inertia.first[k] != o) {
                self.add(model, i, Vector3::new(o, o, inertia.second[(k, 2)] / inertia.first[k]));
            }
        } else if joint.is_translation_along_axis() && inertia.mass != o {
            // h − m d = 0
            self.add(model, i, inertia.first.map(|h| h / inertia.mass));
        }
    }

    /// Adds shifts of the parent of body `i` with which `i` lies in the parent's xy-plane.
    fn level_with_child(&mut self, model: &Model<S>, i: BodyId) {
        let x = &model.bodies()[i].placement;
        for k in 0..self.all[i].len() {
            let at = x.position + rotate(&x.rotation, self.all[i][k]);
            self.add(model, model.bodies()[i].parent, at);
        }
    }

    fn without_offset(&mut self, model: &Model<S>, i: BodyId) {
        let (o, x, parent) = (S::zero(), &model.bodies()[i].placement, model.bodies()[i].parent);
        let z = x.rotation.column(2);
        for k in 0..self.all[parent].len() {
            let from = x.position - self.all[parent][k];
            if model.bodies()[i].joint.is_translation_along_axis() {
                self.add(model, i, -rotate_back(&x.rotation, from));
            } else {
                (0..3).filter(|&c| z[c] != o).for_each(|c| self.add(model, i, Vector3::new(o, o, -from[c] / z[c])));
            }
        }
    }

    /// Adds a shift, or the part of it that the joint allows, if it is new and within reach.
    fn add(&mut self, model: &Model<S>, i: BodyId, shift: Vector3<S>) {
        let (o, joint) = (S::zero(), model.bodies()[i].joint);
        let shift = if joint.is_rotation_about_axis() && !i.is_base() {
            Vector3::new(o, o, shift.z)
        } else if joint.is_translation_along_axis() {
            shift
        } else {
            return;
        };
        let all = &mut self.all[i];
        let new = |other: &Vector3<S>| (0..3).any(|k| or_zero(shift[k] - other[k], shift[k].abs() + other[k].abs()) != o);
        if all.len() < MOST && within(shift.fold(o, |sum, x| sum + x.abs()), self.reach[i]) && all.iter().all(new) {
            all.push(shift);
        }
    }
}

/// The origin of a body in its parent when both frames are shifted, in axes of the parent.
pub(super) fn offset<S: Scalar>(body: &Body<S>, own: Vector3<S>, parent: Vector3<S>) -> Vector3<S> {
    let (position, along) = (body.placement.position, rotate(&body.placement.rotation, own));
    Vector3::from_fn(|k, _| or_zero(position[k] + along[k] - parent[k], position[k].abs() + along[k].abs() + parent[k].abs()))
}

/// The inertia of a body about its origin when its frame is shifted.
pub(super) fn shifted<S: Scalar>(inertia: &SpatialInertia<S>, shift: Vector3<S>) -> SpatialInertia<S> {
    let mut moved = inertia.shifted(-shift);
    for k in 0..3 {
        moved.first[k] = or_zero(moved.first[k], inertia.first[k].abs() + (inertia.mass * shift[k]).abs());
    }
    for k in 0..2 {
        let xz = or_zero(moved.second[(k, 2)], inertia.second[(k, 2)].abs() + (inertia.first[k] * shift.z).abs());
        (moved.second[(k, 2)], moved.second[(2, k)]) = (xz, xz);
    }
    moved
}
