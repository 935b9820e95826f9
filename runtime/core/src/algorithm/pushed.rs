//! Placements of frames, and torques of wrenches on them, for code outside of the table.

use alloc::vec::Vec;

use super::Workspace;
use super::common::{Axes, positions};
use crate::Scalar;
use crate::index::BodyId;
use crate::model::Model;
use crate::spatial::{Placement, Twist, Vector3, Wrench, rotate};

/// All bodies of a model at a configuration.
pub(crate) struct Placed<'a, S: 'static> {
    model: &'a Model<S>,
    ws: &'a Workspace<S>,
}

impl<'a, S: Scalar> Placed<'a, S> {
    /// q: `[nq]`.
    pub(crate) fn at(model: &'a Model<S>, ws: &'a mut Workspace<S>, q: &[S]) -> Self {
        positions(model, ws, Axes::Base, q);
        Self { model, ws }
    }

    /// A frame of a body in the base.
    pub(crate) fn frame(&self, body: BodyId, placement: &Placement<S>) -> Placement<S> {
        let state = &self.ws.common[body];
        Placement { rotation: state.rotation, position: state.position }.compose(placement)
    }

    /// The origin of a frame of a body, or of the base, in the base.
    pub(crate) fn point(&self, body: BodyId, placement: &Placement<S>) -> Vector3<S> {
        if body.is_base() {
            return placement.position;
        }
        let state = &self.ws.common[body];
        state.position + rotate(&state.rotation, placement.position)
    }

    /// The columns of S of all joints, by body, each with its degree of freedom: motions about a
    /// point, in axes of the base.
    pub(crate) fn columns(&self, point: Vector3<S>) -> impl Iterator<Item = (BodyId, usize, Twist<S>)> + '_ {
        self.model.outward().flat_map(move |i| {
            let to_point = point - self.ws.common[i].position;
            self.ws.columns_of(i).map(move |c| (i, self.ws.columns[c].at, self.ws.columns[c].axis.at(to_point)))
        })
    }

    /// Jᵀ w of a wrench at the origin of this frame, in axes of the base: the degrees of freedom of
    /// the joints that move this body and not `other`, each with its torque. One of several joints,
    /// of which others follow, may be there several times.
    pub(crate) fn torques(&self, (body, placement): (BodyId, &Placement<S>), other: BodyId, w: &Wrench<S>) -> Vec<(usize, S)> {
        let mut row = Vec::new();
        if body.is_base() {
            return row;
        }
        let (mut j, mut d) = (body, rotate(&self.ws.common[body].rotation, placement.position));
        while !j.is_base() && !self.model.is_on_the_way(j, other) {
            row.extend(self.ws.columns_of(j).map(|c| &self.ws.columns[c]).map(|column| (column.at, w.power(&column.axis.at(d)))));
            d += self.ws.common[j].shift;
            j = self.model.bodies[j].parent;
        }
        row
    }

    /// Jᵀ w of a wrench on one frame, and its opposite on another: what moves both has no entry.
    pub(crate) fn torques_between(&self, own: (BodyId, &Placement<S>), other: (BodyId, &Placement<S>), w: &Wrench<S>) -> Vec<(usize, S)> {
        let against = self.torques(other, own.0, w).into_iter().map(|(k, x)| (k, -x));
        self.torques(own, other.0, w).into_iter().chain(against).collect()
    }
}
