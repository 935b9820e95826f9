//! Of the inward sweep of inverse dynamics.

use alloc::vec;
use alloc::vec::Vec;

use crate::Scalar;
use crate::algorithm::{Workspace, inverse_dynamics};
use crate::index::{BodyId, ById};
use crate::model::Model;
use crate::spatial::Vector3;

/// How wrenches grow on their way inward: for each moving body the moment and the force that its
/// joint passes to it, over the largest that any one body from there on needs for itself.
///
/// q: `[nq]`; v, a: `[nv]`; returns `[moving bodies]` of (moment's, force's); zero where no wrench
/// is needed. N equal bodies in a straight row at rest give N for forces and N² for moments:
/// rounding errors of a torque are relative to the largest wrench that was passed on, and not to
/// the torque. Allocates.
///
/// # Panics
/// If a slice is shorter than stated.
pub fn wrench_growth<S: Scalar<Mask = bool>>(model: &Model<S>, ws: &mut Workspace<S>, [q, v, a]: [&[S]; 3]) -> Vec<(S, S)> {
    let mut tau = vec![S::zero(); model.nv];
    inverse_dynamics(model, ws, q, v, a, &mut tau);
    let mut largest: ById<BodyId, _> = vec![(S::zero(), S::zero()); model.bodies.len()].into();
    let mut growth = Vec::with_capacity(model.bodies.len());
    for i in model.inward() {
        let (own, passed) = ws.wrenches_of(model, i);
        let beyond = &mut largest[i];
        *beyond = (larger(beyond.0, length(own.moment)), larger(beyond.1, length(own.force)));
        let (moment, force) = *beyond;
        growth.push((over(length(passed.moment), moment), over(length(passed.force), force)));
        let parent = &mut largest[model.bodies[i].parent];
        *parent = (larger(parent.0, moment), larger(parent.1, force));
    }
    growth.reverse();
    growth
}

/// √(x·x), of whatever size.
fn length<S: Scalar<Mask = bool>>(x: Vector3<S>) -> S {
    let most = x.iter().fold(S::zero(), |most, x| larger(x.abs(), most));
    if most.is_zero() { most } else { x.iter().fold(S::zero(), |sum, x| sum + *x / most * (*x / most)).sqrt() * most }
}

fn over<S: Scalar>(x: S, y: S) -> S {
    if x.is_zero() { x } else { x / y }
}

fn larger<S: Scalar<Mask = bool>>(a: S, b: S) -> S {
    if (a - b).positive() { a } else { b }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;
    use alloc::vec::Vec;

    use super::*;
    use crate::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};

    /// Weights of 1 N in a level row, 8 m from one to the next: each needs a force of 1 and a
    /// moment of 4.
    #[test]
    fn moments_are_measured_by_moments_and_forces_by_forces() {
        let at = |x: f64| Origin { xyz: [x, 0.0, 0.0], ..Origin::default() };
        let inertial = Some(Inertial { origin: at(4.0), mass: 1.0, inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] });
        let link = |k: usize| Link { name: k.to_string(), inertial: inertial.filter(|_| k > 0), ..Link::default() };
        let hinge = Joint { kind: JointKind::Revolute, axis: [0.0, 1.0, 0.0], ..Joint::default() };
        let joint = |k: usize| Joint {
            name: k.to_string(),
            parent: LinkId(k),
            child: LinkId(k + 1),
            origin: at(if k > 0 { 8.0 } else { 0.0 }),
            ..hinge.clone()
        };
        let (links, joints): (Vec<Link>, Vec<Joint>) = ((0..4).map(link).collect(), (0..3).map(joint).collect());
        let mut model =
            Model::new(&Description { name: "row".into(), links: links.into(), joints: joints.into(), frames: Vec::new() }, Base::Fixed)
                .unwrap();
        model.gravity = Vector3::new(0.0, 0.0, -1.0);
        let growth = wrench_growth(&model, &mut Workspace::new(&model), [&[0.0; 3][..]; 3]);
        assert_eq!(growth, [(9.0, 3.0), (4.0, 2.0), (1.0, 1.0)]);
    }
}
