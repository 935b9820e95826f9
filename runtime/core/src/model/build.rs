//! From a description to a model: order, merge, and turn frames so that joint axes are z.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use nalgebra::{Matrix3, Vector3};

use super::{Body, FLOATING_BASE, Frame, GRAVITY, JointInfo, Model};
use crate::description::{self, Base, Description, Inertial, JointKind, Mimic, Origin};
use crate::joint::{Coordinates, Follow, Joint};
use crate::spatial::{Placement, SpatialInertia, from_rpy, to_z_axis};

/// Why a description is not a model. A description that the URDF reader accepted gives only `UnsupportedJoint`.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelError {
    /// A joint of a kind that the algorithms do not know yet.
    UnsupportedJoint {
        /// Name of the joint.
        joint: String,
        /// Its kind.
        kind: JointKind,
    },
    /// The links and joints are not one tree: there is no root, or some links cannot be reached from it.
    NotATree {
        /// Names of the links that are not reached.
        unreached: Vec<String>,
    },
    /// A joint follows a joint that is not a coordinate with one degree of freedom, or follows itself.
    BadMimic {
        /// Name of the joint.
        joint: String,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnsupportedJoint { joint, kind } => {
                let kind = kind.name();
                write!(f, "joint {joint:?}: type: found {kind}, expected one of revolute, continuous, prismatic, fixed, floating")
            }
            Self::NotATree { unreached } => {
                write!(f, "links and joints are not one tree: not reached from a root: {}", unreached.join(", "))
            }
            Self::BadMimic { joint } => {
                write!(f, "joint {joint:?}: mimic: expected a leader with one degree of freedom that does not follow this joint")
            }
        }
    }
}

impl core::error::Error for ModelError {}

impl Model<f64> {
    /// The model of a described robot, with standard gravity.
    ///
    /// Joints are ordered depth-first, in the order of the file among the children of a link. Body frames are the link frames turned so that
    /// the joint's axis is z.
    pub fn new(description: &Description, base: Base) -> Result<Self, ModelError> {
        let mut builder = Builder::new(description);
        let root = description.root().ok_or_else(|| builder.not_a_tree())?;
        builder.add_root(root, base);
        builder.add_tree(root)?;
        builder.finish()
    }
}

/// A link's place in the model: the body that it belongs to and its frame in that body.
type Seat = (usize, Placement<f64>);

struct Builder<'a> {
    description: &'a Description,
    /// Joints under each link, in the order of the file.
    children: Vec<Vec<usize>>,
    seats: Vec<Option<Seat>>,
    /// The body of each moving joint.
    body_of: Vec<Option<usize>>,
    model: Model<f64>,
}

impl<'a> Builder<'a> {
    fn new(description: &'a Description) -> Self {
        let mut children = vec![Vec::new(); description.links.len()];
        for (index, joint) in description.joints.iter().enumerate() {
            if let Some(list) = children.get_mut(joint.parent) {
                list.push(index);
            }
        }
        let model = Model {
            name: description.name.clone(),
            gravity: Vector3::from(GRAVITY),
            bodies: Vec::new(),
            frames: Vec::new(),
            joints: Vec::new(),
            nq: 0,
            nv: 0,
        };
        let (links, joints) = (description.links.len(), description.joints.len());
        Self { description, children, seats: vec![None; links], body_of: vec![None; joints], model }
    }

    fn add_root(&mut self, root: usize, base: Base) {
        let name = self.description.links[root].name.clone();
        self.push_body(name, 0, Placement::identity(), Joint::Floating, Coordinates { q: 0, v: 0, mimic: None });
        let body = match base {
            Base::Fixed => 0,
            Base::Floating => {
                let coordinates = self.push_joint(FLOATING_BASE, JointKind::Floating, Joint::Floating, None);
                self.push_body(FLOATING_BASE.to_string(), 0, Placement::identity(), Joint::Floating, coordinates)
            }
        };
        self.seat(root, body, Placement::identity());
    }

    /// Depth-first, with a stack of its own: a chain may be as long as it likes.
    fn add_tree(&mut self, root: usize) -> Result<(), ModelError> {
        let mut stack: Vec<usize> = self.children[root].iter().rev().copied().collect();
        while let Some(index) = stack.pop() {
            let joint = &self.description.joints[index];
            if self.seats.get(joint.child).is_none_or(Option::is_some) {
                return Err(self.not_a_tree());
            }
            self.add_joint(index, joint)?;
            stack.extend(self.children[joint.child].iter().rev());
        }
        Ok(())
    }

    fn add_joint(&mut self, index: usize, joint: &description::Joint) -> Result<(), ModelError> {
        let (parent, x_parent) = self.seats[joint.parent].expect("a parent is seated before its children");
        let x_joint = x_parent.compose(&placement(&joint.origin));
        let Some(kind) = moving(joint)? else {
            self.seat(joint.child, parent, x_joint);
            return Ok(());
        };
        // Turn the frames so that the axis is z; the link's frame stays where it was.
        let turn = match kind {
            Joint::Floating => Matrix3::identity(),
            _ => to_z_axis(joint.axis),
        };
        let turned = x_joint.compose(&Placement { rotation: turn, position: Vector3::zeros() });
        let coordinates = match joint.mimic {
            Some(_) => Coordinates { q: 0, v: 0, mimic: None },
            None => self.push_joint(&joint.name, joint.kind, kind, joint.limit),
        };
        let body = self.push_body(joint.name.clone(), parent, turned, kind, coordinates);
        self.body_of[index] = Some(body);
        self.seat(joint.child, body, Placement { rotation: turn.transpose(), position: Vector3::zeros() });
        Ok(())
    }

    fn push_joint(&mut self, name: &str, kind: JointKind, joint: Joint, limit: Option<description::Limit>) -> Coordinates<f64> {
        let model = &mut self.model;
        let coordinates = Coordinates { q: model.nq, v: model.nv, mimic: None };
        let limit = limit.filter(|_| kind != JointKind::Continuous);
        model.joints.push(JointInfo { name: name.to_string(), kind, q: (model.nq, joint.nq()), v: (model.nv, joint.nv()), limit });
        model.nq += joint.nq();
        model.nv += joint.nv();
        coordinates
    }

    fn push_body(&mut self, name: String, parent: usize, placement: Placement<f64>, joint: Joint, coordinates: Coordinates<f64>) -> usize {
        self.model.bodies.push(Body { name, parent, placement, joint, coordinates, inertia: SpatialInertia::zero() });
        self.model.bodies.len() - 1
    }

    /// Seats a link in a body and adds its mass to it.
    fn seat(&mut self, link: usize, body: usize, placement: Placement<f64>) {
        self.seats[link] = Some((body, placement));
        if let Some(inertial) = &self.description.links[link].inertial {
            self.model.bodies[body].inertia += inertia(inertial).moved(&placement);
        }
    }

    fn finish(mut self) -> Result<Model<f64>, ModelError> {
        if self.seats.iter().any(Option::is_none) {
            return Err(self.not_a_tree());
        }
        for (index, joint) in self.description.joints.iter().enumerate() {
            if let (Some(mimic), Some(body)) = (&joint.mimic, self.body_of[index]) {
                let follow = self.follow(index, mimic).ok_or_else(|| ModelError::BadMimic { joint: joint.name.clone() })?;
                self.model.bodies[body].coordinates = follow;
            }
        }
        let frame = |(link, seat): (&description::Link, &Option<Seat>)| {
            let (body, placement) = seat.expect("every link was seated");
            Frame { name: link.name.clone(), body, placement }
        };
        self.model.frames = self.description.links.iter().zip(&self.seats).map(frame).collect();
        Ok(self.model)
    }

    /// Resolves a chain of joints that follow each other down to a coordinate.
    fn follow(&self, follower: usize, mimic: &Mimic) -> Option<Coordinates<f64>> {
        let joints = &self.description.joints;
        let (mut leader, mut multiplier, mut offset) = (mimic.joint, mimic.multiplier, mimic.offset);
        for _ in 0..joints.len() {
            let joint = joints.get(leader).filter(|_| leader != follower)?;
            let body = &self.model.bodies[self.body_of[leader]?];
            match &joint.mimic {
                None if body.joint.nv() == 1 => {
                    let Coordinates { q, v, .. } = body.coordinates;
                    return Some(Coordinates { q, v, mimic: Some(Follow { multiplier, offset }) });
                }
                None => return None,
                // multiplier · (m q + o) + offset
                Some(next) => {
                    (leader, multiplier, offset) = (next.joint, multiplier * next.multiplier, multiplier * next.offset + offset);
                }
            }
        }
        None
    }

    fn not_a_tree(&self) -> ModelError {
        let lost = self.description.links.iter().zip(&self.seats).filter(|(_, seat)| seat.is_none());
        ModelError::NotATree { unreached: lost.map(|(link, _)| link.name.clone()).collect() }
    }
}

fn moving(joint: &description::Joint) -> Result<Option<Joint>, ModelError> {
    match joint.kind {
        JointKind::Fixed => Ok(None),
        JointKind::Revolute | JointKind::Continuous => Ok(Some(Joint::Revolute)),
        JointKind::Prismatic => Ok(Some(Joint::Prismatic)),
        JointKind::Floating => Ok(Some(Joint::Floating)),
        kind @ JointKind::Planar => Err(ModelError::UnsupportedJoint { joint: joint.name.clone(), kind }),
    }
}

fn placement(origin: &Origin) -> Placement<f64> {
    Placement { rotation: from_rpy(origin.rpy), position: Vector3::from(origin.xyz) }
}

fn inertia(i: &Inertial) -> SpatialInertia<f64> {
    let [xx, xy, xz, yy, yz, zz] = i.inertia;
    let central = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    SpatialInertia::from_central(i.mass, central, &placement(&i.origin))
}
