//! Regrouping of inertial parameters that a joint cannot distinguish from its parent's.

use crate::Scalar;
use crate::index::BodyId;
use crate::model::{Body, Model};
use crate::spatial::SpatialInertia;

/// Moves the inertial parameters of each body that its joint cannot distinguish from the parent's
/// to the parent, from the tips inward.
///
/// Mass on the axis of a revolute joint moves with the parent whatever the angle: m, h_z and Σ_zz
/// go there, and the rest has Σ_zz = 0 and no mass. A prismatic joint does not turn its body: Σ
/// goes to the parent. A spherical joint's centre moves with the parent: m goes there. Exact for
/// all joint torques and for the mass matrix (Khalil & Dombre, *Modeling, Identification and
/// Control of Robots*, 2002, §9.4); placements do not change.
pub fn regroup<S: Scalar>(mut model: Model<S>) -> Model<S> {
    for i in model.inward() {
        regroup_body(&mut model, i);
    }
    model.bodies[BodyId::BASE].inertia = SpatialInertia::zero();
    model
}

/// The same for the joint of body `i` alone.
pub fn regroup_body<S: Scalar>(model: &mut Model<S>, i: BodyId) {
    let Body { joint, parent, placement, inertia, .. } = &model.bodies[i];
    let (parent, Some(given)) = (*parent, joint.regroupable(inertia)) else { return };
    let (kept, moved) = (subtract(*inertia, given), given.moved(placement));
    model.bodies[i].inertia = kept;
    model.bodies[parent].inertia += moved;
}

/// a − b, of moments about one point in the same axes.
pub fn subtract<S: Scalar>(a: SpatialInertia<S>, b: SpatialInertia<S>) -> SpatialInertia<S> {
    SpatialInertia { mass: a.mass - b.mass, first: a.first - b.first, second: a.second - b.second }
}
