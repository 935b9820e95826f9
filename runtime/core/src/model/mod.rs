//! A robot made ready for the algorithms: bodies joined by moving joints, in depth-first order.

mod build;
mod leaders;
mod massless;
mod parts;
mod regroup;

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::Vector3;

pub use build::ModelError;
pub use parts::ModelParts;
pub use regroup::{regroup, regroup_body, subtract};

use crate::Scalar;
use crate::actuator::Actuators;
use crate::constraint::Constraints;
use crate::description::{ById, Description, EditError, JointKind, Limit, LinkId};
use crate::effect::Effects;
use crate::index::{BodyId, FrameId};
use crate::joint::{Coordinates, Joint};
use crate::spatial::{Placement, Reference, SpatialInertia};
use crate::suggest::nearest;

/// The name under which the joint of a floating base is listed.
pub const FLOATING_BASE: &str = "__floating_base__";

/// Standard gravity in the world frame, m/s².
pub const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// A tree of bodies. Body 0 is the base; every other body hangs on its parent by one moving joint,
/// parents before children.
///
/// Links behind fixed joints are part of the body they are fixed to; each link of the file remains
/// as a frame. [`Model::new`] builds one of a description. [`Model::into_parts`] and
/// [`Model::from_parts`] change one.
#[derive(Clone, Debug)]
pub struct Model<S = f64> {
    pub(crate) name: String,
    pub(crate) gravity: Vector3<S>,
    pub(crate) wrench_reference: Reference,
    pub(crate) bodies: ById<BodyId, Body<S>>,
    pub(crate) frames: ById<FrameId, Frame<S>>,
    pub(crate) joints: Vec<JointInfo>,
    pub(crate) nq: usize,
    pub(crate) nv: usize,
    pub(crate) actuators: Actuators<S>,
    pub(crate) constraints: Constraints<S>,
}

/// A body and the joint that carries it.
#[derive(Clone, Debug)]
pub struct Body<S> {
    /// Name of the joint (of the root link for the base).
    pub name: String,
    /// The body that it hangs on; the base for the base itself.
    pub parent: BodyId,
    /// The joint's frame in the parent's frame.
    pub placement: Placement<S>,
    /// The kind of joint.
    pub joint: Joint,
    /// Its place in the vectors.
    pub coordinates: Coordinates<S>,
    /// Mass properties in the body's frame, everything that is fixed to the body included.
    pub inertia: SpatialInertia<S>,
    /// The link of the file that the body is. `None` for the base, and for a body without mass
    /// between two joints in sequence or inside a planar or universal joint.
    pub link: Option<BodyLink<S>>,
    /// The effects on it and on its joint.
    pub effects: Effects<S>,
}

/// The link that a body is named after where results are given for each link: the first link of the
/// file that is fixed in the body, [intermediate](crate::description::Link::intermediate) ones left
/// out.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyLink<S> {
    /// Name of the link.
    pub name: String,
    /// The link's frame in the body's frame. The origins differ where the joint is not at the
    /// origin of the link.
    pub placement: Placement<S>,
}

/// A named frame fixed in a body: a link of the file.
#[derive(Clone, Debug)]
pub struct Frame<S> {
    /// Name of the link.
    pub name: String,
    /// The body that it is fixed in.
    pub body: BodyId,
    /// The frame in the body's frame.
    pub placement: Placement<S>,
}

/// Name, kind and limits of a joint with coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct JointInfo {
    /// Name of the joint; [`FLOATING_BASE`] for that of a floating base.
    pub name: String,
    /// Its kind in the file.
    pub kind: JointKind,
    /// First index and number of its coordinates in q.
    pub q: (usize, usize),
    /// First index and number of its rates in v.
    pub v: (usize, usize),
    /// Limits, where the file gives them; none for a continuous joint.
    pub limit: Option<Limit>,
    /// The largest angle of a ball joint's rotation from the identity, rad, above 0 and below π.
    /// `None`: it has no such bound, or is not a ball joint.
    pub cone: Option<f64>,
}

/// A joint of any robot, generated or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointRow<'a> {
    /// Its name; [`FLOATING_BASE`] for that of a floating base.
    pub name: &'a str,
    /// Its kind in the file.
    pub kind: JointKind,
    /// First index and number of its coordinates in q.
    pub q: (usize, usize),
    /// First index and number of its rates in v.
    pub v: (usize, usize),
    /// Its limits; infinite where the file gives none.
    pub limit: Limit,
}

impl JointInfo {
    /// Where in q its unit quaternion (x, y, z, w) is, if it has one.
    pub fn quaternion(&self) -> Option<core::ops::Range<usize>> {
        let first = self.q.0 + self.kind.quaternion()?;
        Some(first..first + 4)
    }

    /// The same, with a limit in any case.
    pub fn row(&self) -> JointRow<'_> {
        JointRow { name: &self.name, kind: self.kind, q: self.q, v: self.v, limit: self.limit.unwrap_or(Limit::NONE) }
    }
}

impl<S: Scalar> Model<S> {
    /// The robot's name.
    #[inline(always)]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Gravity in the world frame, m/s².
    #[inline(always)]
    pub fn gravity(&self) -> Vector3<S> {
        self.gravity
    }

    /// The reference of the wrench arguments of functions.
    #[inline(always)]
    pub fn wrench_reference(&self) -> Reference {
        self.wrench_reference
    }

    /// Bodies; the first is the base and has no joint of its own.
    #[inline(always)]
    pub fn bodies(&self) -> &ById<BodyId, Body<S>> {
        &self.bodies
    }

    /// A frame for each link of the file and for each of its other frames, in the order of the
    /// file, or the frames that were chosen.
    #[inline(always)]
    pub fn frames(&self) -> &ById<FrameId, Frame<S>> {
        &self.frames
    }

    /// The joints that have coordinates of their own, in the order of these coordinates: all but
    /// followers.
    #[inline(always)]
    pub fn joints(&self) -> &[JointInfo] {
        &self.joints
    }

    /// Number of coordinates.
    #[inline(always)]
    pub fn nq(&self) -> usize {
        self.nq
    }

    /// Number of degrees of freedom.
    #[inline(always)]
    pub fn nv(&self) -> usize {
        self.nv
    }

    /// The actuators of the robot's file, and the springs and dampers of its tendons. Functions of
    /// the group `actuators` have their forces; all others have torques as an argument.
    #[inline(always)]
    pub fn actuators(&self) -> &Actuators<S> {
        &self.actuators
    }
}

impl<S: Scalar> Model<S> {
    /// Indices of the moving bodies, from the base outward.
    #[inline(always)]
    pub fn outward(&self) -> impl ExactSizeIterator<Item = BodyId> + DoubleEndedIterator + Clone + use<S> {
        (1..self.bodies.len()).map(BodyId)
    }

    /// Indices of the moving bodies, from the tips inward.
    #[inline(always)]
    pub fn inward(&self) -> impl ExactSizeIterator<Item = BodyId> + DoubleEndedIterator + Clone + use<S> {
        self.outward().rev()
    }

    /// Indices of the bodies that are moving links of the file ([`Body::link`]): all bodies with
    /// mass but the base. A link that is fixed to another belongs to its body.
    pub fn links(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.outward().filter(|&i| self.bodies[i].link.is_some())
    }

    /// The body that each link of the model's description is part of, intermediate links too:
    /// `[links]`. The base for links that no joint moves.
    pub fn bodies_of_links(&self, description: &Description) -> ById<LinkId, BodyId> {
        // Of a joint of several bodies the last.
        let of_joints: BTreeMap<&str, BodyId> = self.outward().map(|i| (self.bodies[i].name.as_str(), i)).collect();
        let root = of_joints.get(FLOATING_BASE).copied().unwrap_or(BodyId::BASE);
        let mut children: ById<LinkId, Vec<_>> = vec![Vec::new(); description.links.len()].into();
        for joint in &description.joints {
            children[joint.parent].push(joint);
        }
        let mut bodies: ById<LinkId, BodyId> = vec![root; description.links.len()].into();
        let mut open: Vec<LinkId> = description.root().into_iter().collect();
        while let Some(link) = open.pop() {
            for joint in core::mem::take(&mut children[link]) {
                bodies[joint.child] = of_joints.get(joint.name.as_str()).copied().unwrap_or(bodies[link]);
                open.push(joint.child);
            }
        }
        bodies
    }

    /// Whether a joint follows another.
    pub fn has_followers(&self) -> bool {
        self.bodies.iter().any(|b| b.coordinates.mimic.is_some())
    }

    /// The bodies of a joint that follows several others, from its last body towards the base: its
    /// coordinate is the sum of theirs. Of any other joint the body alone.
    pub fn series<'a>(&'a self, body: &'a Body<S>) -> impl Iterator<Item = &'a Body<S>> + use<'a, S> {
        let follows = |body: &Body<S>| body.coordinates.mimic.is_some();
        core::iter::successors(Some(body), move |body| {
            let before = self.bodies.get(body.parent).filter(|before| follows(body) && follows(before));
            before.filter(|before| before.name == body.name)
        })
    }

    /// The configuration of zeros, with identity quaternions, `[nq]` rad|m|quaternion: `NEUTRAL` of
    /// a generated module.
    pub fn neutral(&self) -> Vec<S> {
        let mut q = vec![S::zero(); self.nq];
        crate::algorithm::neutral(self, &mut q);
        q
    }

    /// Mass of the moving links, kg.
    pub fn moving_mass(&self) -> S {
        self.outward().fold(S::zero(), |sum, i| sum + self.bodies[i].inertia.mass)
    }

    /// Mass that each body's joint carries, kg, including the body's own: `[bodies]`. Of the model
    /// as it was read.
    pub fn carried(&self) -> ById<BodyId, S> {
        let mut carried: ById<BodyId, S> = self.bodies.iter().map(|body| body.inertia.mass).collect();
        for i in self.inward() {
            let own = carried[i];
            carried[self.bodies[i].parent] += own;
        }
        carried
    }

    /// Name of the joint that a degree of freedom, by its index in v, belongs to; empty if there is
    /// none.
    pub fn joint_of(&self, freedom: usize) -> &str {
        self.joints.iter().find(|j| (j.v.0..j.v.0 + j.v.1).contains(&freedom)).map_or("", |j| &j.name)
    }

    /// Indices in v of the degrees of freedom that move body `i`, each once.
    pub fn freedoms_of(&self, mut i: BodyId) -> Vec<usize> {
        let mut freedoms = Vec::new();
        while !i.is_base() {
            let body = &self.bodies[i];
            freedoms.extend(body.coordinates.v..body.coordinates.v + body.joint.nv());
            i = body.parent;
        }
        freedoms.sort_unstable();
        freedoms.dedup();
        freedoms
    }

    /// The same robot with only the named frames, in this order; a name may be there twice. Errors:
    /// [`EditError::UnknownLink`] of the first name that none of its frames has.
    pub fn with_frames<N: AsRef<str>>(mut self, names: &[N]) -> Result<Self, EditError> {
        let find = |name: &N| {
            let name = name.as_ref();
            let found = self.frames.iter().find(|f| f.name == name).cloned();
            found.ok_or_else(|| EditError::UnknownLink {
                name: name.to_string(),
                nearest: nearest(name, self.frames.iter().map(|f| f.name.as_str())),
            })
        };
        self.frames = names.iter().map(find).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// Gives body `i` other mass properties, in its frame.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn set_inertia(&mut self, i: BodyId, inertia: SpatialInertia<S>) {
        self.bodies[i].inertia = inertia;
    }

    /// The same robot without frames.
    #[must_use]
    pub fn without_frames(mut self) -> Self {
        self.frames = ById::default();
        self
    }

    /// The same robot, with wrenches given in another reference.
    #[must_use]
    pub fn with_wrenches_in(mut self, reference: Reference) -> Self {
        self.wrench_reference = reference;
        self
    }

    /// The same robot with these actuators instead of its own.
    #[must_use]
    pub fn with_actuators(mut self, actuators: Actuators<S>) -> Self {
        self.actuators = actuators;
        self
    }

    /// What the robot touches: constraints of the robot's file. Functions of the group `contact`
    /// have their forces.
    #[inline(always)]
    pub fn constraints(&self) -> &Constraints<S> {
        &self.constraints
    }

    /// The same robot with these constraints instead of its own.
    #[must_use]
    pub fn with_constraints(mut self, constraints: Constraints<S>) -> Self {
        self.constraints = constraints;
        self
    }

    /// Whether a joint of body `before` moves `body`.
    pub fn is_on_the_way(&self, before: BodyId, mut body: BodyId) -> bool {
        while !body.is_base() && body != before {
            body = self.bodies[body].parent;
        }
        body == before
    }

    /// The same robot under another gravity, given in the world frame, m/s².
    #[must_use]
    pub fn with_gravity(mut self, gravity: [f64; 3]) -> Self {
        self.gravity = Vector3::from(gravity).map(S::from_f64);
        self
    }
}

impl<S: Scalar> Model<S> {
    /// The same model with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Model<T> {
        Model {
            name: self.name.clone(),
            gravity: self.gravity.map(f),
            wrench_reference: self.wrench_reference,
            bodies: self.bodies.iter().map(|b| b.map(f)).collect(),
            frames: self.frames.iter().map(|frame| frame.map(f)).collect(),
            joints: self.joints.clone(),
            nq: self.nq,
            nv: self.nv,
            actuators: self.actuators.map(f),
            constraints: self.constraints.map(f),
        }
    }
}

impl Model<f64> {
    /// The same model with its constants in another scalar.
    pub fn cast<T: Scalar>(&self) -> Model<T> {
        self.map(T::from_f64)
    }
}

impl<S: Scalar> Body<S> {
    /// The same body with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Body<T> {
        Body {
            name: self.name.clone(),
            parent: self.parent,
            placement: self.placement.map(f),
            joint: self.joint,
            coordinates: self.coordinates.map(f),
            inertia: self.inertia.map(f),
            link: self.link.as_ref().map(|link| link.map(f)),
            effects: self.effects.map(f),
        }
    }
}

impl<S: Scalar> BodyLink<S> {
    /// The same link with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> BodyLink<T> {
        BodyLink { name: self.name.clone(), placement: self.placement.map(f) }
    }
}

impl<S: Scalar> Frame<S> {
    /// The same frame with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Frame<T> {
        Frame { name: self.name.clone(), body: self.body, placement: self.placement.map(f) }
    }
}
