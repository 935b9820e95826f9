//! How bodies move: columns of J, and twists.

use alloc::vec;
use alloc::vec::Vec;

use crate::Scalar;
use crate::algorithm::Placed as Bodies;
use crate::index::{BodyId, ById};
use crate::model::Model;
use crate::spatial::{Placement, Twist, Vector3};

/// A column of J of all bodies beyond a joint.
pub(super) struct Column<S> {
    pub(super) body: BodyId,
    pub(super) at: usize,
    pub(super) axis: Twist<S>,
}

/// The twists of bodies.
pub(super) type Twists<S> = ById<BodyId, Twist<S>>;

/// The point about which twists and moments are: the origin of the first body, if it floats, so
/// that numbers stay small far from the origin of the world.
pub(super) fn origin<S: Scalar>(model: &Model<S>, placed: &Bodies<'_, S>) -> Vector3<S> {
    let floats = model.bodies.get(BodyId(1)).is_some_and(|body| body.joint.is_unconstrained());
    if floats { placed.frame(BodyId(1), &Placement::identity()).position } else { Vector3::zeros() }
}

/// The columns of all degrees of freedom about the origin.
pub(super) fn columns<S: Scalar>(placed: &Bodies<'_, S>, origin: Vector3<S>) -> Vec<Column<S>> {
    placed.columns(origin).map(|(body, at, axis)| Column { body, at, axis }).collect()
}

/// The twists of all bodies at the rates x, about the origin of the columns.
pub(super) fn twists<S: Scalar>(model: &Model<S>, columns: &[Column<S>], x: &[S]) -> Twists<S> {
    let mut bodies: Twists<S> = vec![Twist::zero(); model.bodies.len()].into();
    let mut next = columns.iter().peekable();
    for body in model.outward() {
        let mut twist = bodies[model.bodies[body].parent];
        while let Some(column) = next.next_if(|column| column.body == body) {
            twist = twist + column.axis.times(x[column.at]);
        }
        bodies[body] = twist;
    }
    bodies
}
