//! From a description to the textbook's bodies.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::joint::{Joint, Law, Motion, Seat};
use super::matrix::{blocks, cross_matrix};
use super::{Link, Textbook};
use crate::Scalar;
use crate::description::{Base, ById, Description, Inertial, JointId, LinkId, Mimic, Origin};
use crate::model::{FLOATING_BASE, JointInfo, Model, ModelError};
use crate::spatial::{Placement, Reference};

impl<S: Scalar> Textbook<S> {
    /// From a description; gravity in the world frame, m/s². Fails where [`Model::new`] fails.
    pub fn new(description: &Description, base: Base, gravity: [f64; 3]) -> Result<Self, ModelError> {
        // The order and the places of coordinates are the interface's, so they are taken from the
        // model; numbers are not.
        let model = Model::new(description, base)?;
        let description = &description.in_sequence();
        let mut body_of_link: ById<LinkId, usize> = vec![0; description.links.len()].into();
        let mut bodies: Vec<Link<S>> = Vec::with_capacity(description.links.len());
        for (link, joint) in depth_first(description) {
            body_of_link[link] = bodies.len();
            let parent = joint.map(|j| body_of_link[description.joints[j].parent]);
            let placement = joint.map_or_else(Placement::identity, |j| placement(&description.joints[j].origin));
            let (locked, joint) = match joint {
                Some(j) => child_joint(description, &model, j),
                None if base == Base::Floating => (Placement::identity(), Joint::new(Motion::Free, seat(&model, FLOATING_BASE))),
                None => (Placement::identity(), Joint::fixed()),
            };
            bodies.push(Link {
                parent,
                placement: placement.compose(&locked),
                carried: joint.moves() || parent.is_some_and(|p| bodies[p].carried),
                joint,
                inertia: description.links[link].inertial.as_ref().map_or_else(Matrix6::zeros, inertia_matrix),
                is_link: !description.links[link].intermediate,
            });
        }
        let of_links = description.links.iter().zip(&body_of_link).filter(|(link, _)| !link.intermediate);
        let mut links: Vec<(String, usize)> = of_links.map(|(link, body)| (link.name.clone(), *body)).collect();
        // A frame that is no link is a body without mass, fixed to its link.
        for frame in &description.frames {
            let parent = body_of_link[frame.link];
            links.push((frame.name.clone(), bodies.len()));
            bodies.push(Link {
                parent: Some(parent),
                placement: frame.origin.placement(),
                carried: bodies[parent].carried,
                joint: Joint::fixed(),
                inertia: Matrix6::zeros(),
                is_link: false,
            });
        }
        let frames = links.iter().map(|(_, body)| *body).collect();
        let gravity = Vector3::from(gravity).map(S::from_f64);
        let Model { joints, nq, nv, .. } = model;
        Ok(Self { bodies, links, frames, gravity, wrench_reference: Reference::Body, joints, nq, nv })
    }
}

/// Joint `j` of the file: the placement at which it is locked, and what remains of it as a joint.
fn child_joint<S: Scalar>(description: &Description, model: &Model, j: JointId) -> (Placement<S>, Joint<S>) {
    let motion = Motion::of(&description.joints[j]);
    match leader(description, j) {
        Led::Still(coordinates) => (motion.placement(&motion.normalised(&coordinates)), Joint::fixed()),
        Led::By(leader, law) => {
            let mut seat = seat(model, &description.joints[leader].name);
            seat.follow = Some(law).filter(|_| leader != j);
            (Placement::identity(), Joint::new(motion, seat))
        }
    }
}

/// Driver of a joint.
enum Led<S> {
    /// Nothing: it is locked, or follows one that is, at these coordinates.
    Still(Vec<S>),
    /// The coordinate of a joint, itself perhaps, by a law.
    By(JointId, Law<S>),
}

fn leader<S: Scalar>(description: &Description, mut j: JointId) -> Led<S> {
    let mut law = Law(Vec::new());
    loop {
        let joint = &description.joints[j];
        if let Some(locked) = &joint.locked {
            return Led::Still(locked.iter().map(|&x| law.at(S::from_f64(x))).collect());
        }
        let Some(Mimic { joint, multiplier, offset, higher: [c2, c3, c4] }) = joint.mimic else { return Led::By(j, law) };
        law.0.push([offset, multiplier, c2, c3, c4].map(S::from_f64).to_vec());
        j = joint;
    }
}

fn seat<S>(model: &Model, name: &str) -> Seat<S> {
    let info: Option<&JointInfo> = model.joints.iter().find(|i| i.name == name);
    info.map_or(Seat { q: 0, v: 0, follow: None }, |i| Seat { q: i.q.0, v: i.v.0, follow: None })
}

/// (link, the joint that carries it), parents first.
fn depth_first(description: &Description) -> Vec<(LinkId, Option<JointId>)> {
    let mut order = Vec::new();
    let mut stack: Vec<(LinkId, Option<JointId>)> = description.root().map(|r| (r, None)).into_iter().collect();
    let mut children: ById<LinkId, Vec<_>> = vec![Vec::new(); description.links.len()].into();
    for (j, joint) in description.joints.with_ids() {
        children[joint.parent].push((joint.child, Some(j)));
    }
    while let Some(next) = stack.pop() {
        order.push(next);
        stack.extend(children[next.0].iter().rev());
    }
    order
}

fn placement<S: Scalar>(origin: &Origin) -> Placement<S> {
    origin.placement()
}

/// G = [I_c + m [c]×[c]×ᵀ, m [c]×; m [c]×ᵀ, m 1] with everything in the link's axes.
fn inertia_matrix<S: Scalar>(i: &Inertial) -> Matrix6<S> {
    let x = placement::<S>(&i.origin);
    let m = S::from_f64(i.mass);
    let [xx, xy, xz, yy, yz, zz] = i.inertia.map(S::from_f64);
    let central = x.rotation * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * x.rotation.transpose();
    let c = cross_matrix(x.position);
    blocks(&(central + c * c.transpose() * m), &(c * m), &(c.transpose() * m), &(Matrix3::identity() * m))
}
