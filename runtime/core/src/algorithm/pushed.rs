//! Placements of frames, and torques of wrenches on them, for code outside of the table.

use alloc::vec::Vec;

use super::Workspace;
use super::common::{Axes, on_the_way, positions};
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

    /// The columns of S of all joints, by body, each with its degree of freedom: motions about a
    /// point, in axes of the base.
    pub(crate) fn columns(&self, point: Vector3<S>) -> impl Iterator<Item = (BodyId, usize, Twist<S>)> + '_ {
        self.model.outward().flat_map(move |i| {
            let to_point = point - self.ws.common[i].position;
            self.ws.columns_of(i).map(move |c| (i, self.ws.columns[c].at, self.ws.columns[c].axis.at(to_point)))
        })
    }

    /// Jᵀ w of a wrench at the origin of this frame, in axes of the base: the degrees of freedom on
    /// the way to the base, each with its torque.
    pub(crate) fn torques(&self, body: BodyId, placement: &Placement<S>, w: &Wrench<S>) -> Vec<(usize, S)> {
        let (mut row, from) = (Vec::new(), rotate(&self.ws.common[body].rotation, placement.position));
        on_the_way(self.model, self.ws, body, from, |column, d| row.push((column.at, w.power(&column.axis.at(d)))));
        row
    }
}
