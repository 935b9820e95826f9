//! Base parameters: what a joint cannot feel goes to its parent.

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;
use crate::joint::Joint;
use crate::model::{Body, Model};
use crate::spatial::SpatialInertia;

/// Moves inertial parameters along the joints that cannot feel them, from the tips inward.
///
/// Mass on the axis of a revolute joint moves with the parent whatever the angle: m, h_z and Σ_zz go there, and what is left has Σ_zz = 0 and no
/// mass. A prismatic joint does not turn its body: Σ goes to the parent. A spherical joint's centre moves with the parent: m goes there. Exact for all joint torques and for the mass
/// matrix (Khalil & Dombre, *Modeling, Identification and Control of Robots*, 2002, §9.4); placements do not change.
pub fn regroup<S: Scalar>(mut model: Model<S>) -> Model<S> {
    for i in model.inward() {
        let Some((given, kept)) = split(&model.bodies[i]) else { continue };
        let moved = given.moved(&model.bodies[i].placement);
        let parent = model.bodies[i].parent;
        model.bodies[i].inertia = kept;
        model.bodies[parent].inertia += moved;
    }
    model.bodies[0].inertia = SpatialInertia::zero();
    model
}

/// (what the parent gets, in the joint's frame; what the body keeps).
fn split<S: Scalar>(body: &Body<S>) -> Option<(SpatialInertia<S>, SpatialInertia<S>)> {
    let o = S::zero();
    let own = body.inertia;
    match body.joint {
        Joint::Floating | Joint::Helical => None,
        Joint::Spherical => {
            let given = SpatialInertia { mass: own.mass, first: Vector3::zeros(), second: Matrix3::zeros() };
            Some((given, subtract(own, given)))
        }
        Joint::Revolute => {
            let first = Vector3::new(o, o, own.first.z);
            let second = Matrix3::from_diagonal(&Vector3::new(o, o, own.second.m33));
            let given = SpatialInertia { mass: own.mass, first, second };
            Some((given, subtract(own, given)))
        }
        Joint::Prismatic => {
            let given = SpatialInertia { mass: o, first: Vector3::zeros(), second: own.second };
            Some((given, subtract(own, given)))
        }
    }
}

fn subtract<S: Scalar>(a: SpatialInertia<S>, b: SpatialInertia<S>) -> SpatialInertia<S> {
    SpatialInertia { mass: a.mass - b.mass, first: a.first - b.first, second: a.second - b.second }
}
