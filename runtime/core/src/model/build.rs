//! From a description to a model: order, merge, and turn frames so that joint axes are z.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use nalgebra::{Matrix3, Vector3};

use super::leaders::{Leads, leads, others};
use super::{Body, BodyLink, FLOATING_BASE, Frame, GRAVITY, JointInfo, Model};
use crate::actuator::Actuators;
use crate::constraint::Constraints;
use crate::description::{self, Base, ById, Description, Inertial, JointId, JointKind, Limit, LinkId, Mimic};
use crate::effect::Effects;
use crate::index::{BodyId, FrameId};
use crate::joint::with_pose;
use crate::joint::{Coordinates, Follow, Joint, JointLaw};
use crate::spatial::{Placement, Reference, SpatialInertia, nearest_rotation, to_z_axis};

/// Why a description is not a model. Of a description that a reader accepted: numbers that
/// are too large together ([`Self::TooLarge`]), and a joint of the name of a floating base's.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelError {
    /// A joint locked at coordinates of another number than it has, or at one that is not finite.
    BadLock {
        /// Name of the joint.
        joint: String,
        /// Its kind.
        kind: JointKind,
        /// How many coordinates were given.
        found: usize,
    },
    /// The links and joints are not one tree: there is no root, or some links cannot be reached
    /// from it.
    NotATree {
        /// Names of the links that are not reached.
        unreached: Vec<String>,
    },
    /// A joint is called as the joint of a floating base is.
    NamedAsBase,
    /// A joint follows a joint that is not a coordinate with one degree of freedom, or follows
    /// itself.
    BadMimic {
        /// Name of the joint.
        joint: String,
    },
    /// A joint follows the last of its leaders by a polynomial of a degree above
    /// [`MOST_DEGREE`](description::MOST_DEGREE): the product of the degrees on the way.
    Degree {
        /// Name of the joint.
        joint: String,
    },
    /// A floating base is requested for a robot whose root has a free joint
    /// ([`Description::free_joint_of_root`]). [`Model::new`] accepts such a robot; loaders refuse
    /// it.
    SecondBase {
        /// Name of the link that floats.
        link: String,
        /// Name of its joint.
        joint: String,
    },
    /// Masses and lengths, or multipliers of joints that follow each other, whose products are
    /// beyond the range of doubles.
    TooLarge {
        /// Names of the joints after which they are, and of the links that are too far away.
        names: Vec<String>,
    },
    /// Parts that do not fit together ([`Model::from_parts`]).
    Structure {
        /// The body, joint or frame.
        part: String,
        /// Its content.
        found: String,
        /// Its expected content.
        expected: &'static str,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadLock { joint, kind, found } => {
                let (name, nq) = (kind.name(), kind.sizes().0);
                write!(f, "joint {joint:?}: locked at: found {found} coordinates, expected {nq} finite ones for a {name} joint")
            }
            Self::NotATree { unreached } => {
                write!(f, "links and joints are not one tree: not reached from a root: {}", unreached.join(", "))
            }
            Self::NamedAsBase => {
                write!(f, "joint {FLOATING_BASE:?}: found the name of the joint by which a floating base moves, expected another")
            }
            Self::BadMimic { joint } => {
                write!(
                    f,
                    "joint {joint:?}: mimic: expected a leader with one degree of freedom that follows neither this joint nor several"
                )
            }
            Self::Degree { joint } => {
                write!(
                    f,
                    "joint {joint:?}: mimic: found polynomials of followers of each other, expected at most {} as the product of their degrees",
                    description::MOST_DEGREE
                )
            }
            Self::SecondBase { link, joint } => {
                write!(f, "link {link:?} has the free joint {joint:?} already: leave out --floating (base = \"floating\", Base::Floating)")
            }
            Self::TooLarge { names } => {
                write!(
                    f,
                    "{}: found masses, lengths or multipliers that overflow, expected m·r², r and products of multipliers below 1e308, in kg and m",
                    names.join(", ")
                )
            }
            Self::Structure { part, found, expected } => write!(f, "{part}: found {found}, expected {expected}"),
        }
    }
}

impl core::error::Error for ModelError {}

impl ModelError {
    /// Refuses a floating base for a robot that floats already.
    pub fn of_base(description: &Description, base: Base) -> Result<(), Self> {
        match description.free_joint_of_root().filter(|_| base == Base::Floating) {
            Some(joint) => {
                let link = description.links.get(joint.child).map(|link| link.name.clone()).unwrap_or_default();
                Err(Self::SecondBase { link, joint: joint.name.clone() })
            }
            None => Ok(()),
        }
    }
}

impl Model<f64> {
    /// The model of a described robot, with standard gravity.
    ///
    /// Joints are ordered depth-first, in the order of the file among the children of a link. Body
    /// frames are the link frames turned so that the joint's axis is z.
    pub fn new(description: &Description, base: Base) -> Result<Self, ModelError> {
        if description.joints.iter().any(|j| j.name == FLOATING_BASE) {
            return Err(ModelError::NamedAsBase);
        }
        check_frames(description)?;
        let mut builder = Builder::new(description);
        let root = description.root().ok_or_else(|| builder.not_a_tree())?;
        builder.add_root(root, base);
        builder.add_tree(root)?;
        builder.finish()
    }
}

/// A frame is on a link that exists; an intermediate link carries no mass and no geometry.
fn check_frames(description: &Description) -> Result<(), ModelError> {
    let refused = |part: String, found: String, expected: &'static str| Err(ModelError::Structure { part, found, expected });
    if let Some(frame) = description.frames.iter().find(|frame| description.links.get(frame.link).is_none()) {
        return refused(format!("frame {:?}", frame.name), format!("link {}", frame.link), "the index of a link");
    }
    let full = |link: &&description::Link| link.intermediate && (link.inertial.is_some() || !link.collision.is_empty());
    match description.links.iter().find(full) {
        Some(link) => refused(format!("link {:?}", link.name), "mass or collision geometry".into(), "none on an intermediate link"),
        None => Ok(()),
    }
}

/// A link's place in the model: the body that it belongs to and its frame in that body.
type Seat = (BodyId, Placement<f64>);

struct Builder<'a> {
    description: &'a Description,
    /// Joints under each link, in the order of the file.
    children: ById<LinkId, Vec<JointId>>,
    seats: ById<LinkId, Option<Seat>>,
    /// The body of each moving joint.
    body_of: ById<JointId, Option<BodyId>>,
    /// For each joint that follows another, its final leader.
    leads: Leads,
    /// The bodies of joints that follow several: the joint, and the final leader of each body.
    followers: Vec<(BodyId, JointId, Mimic)>,
    model: Model<f64>,
}

/// The overflowed parts: joints by the masses and multipliers that they move with, links by their
/// places.
fn too_large(model: &Model<f64>) -> Vec<String> {
    let is_finite = |x: &Placement<f64>| x.position.iter().all(|x| x.is_finite());
    let all = |f: Follow<f64>| f.higher.unwrap_or_default().into_iter().chain([f.multiplier, f.offset]).all(f64::is_finite);
    let follows = |body: &Body<f64>| body.coordinates.mimic.is_none_or(all);
    let heavy =
        |body: &&Body<f64>| !(is_finite(&body.placement) && follows(body) && body.inertia.parameters().iter().all(|x| x.is_finite()));
    let joints = model.bodies.iter().skip(1).filter(heavy).map(|body| format!("joint {:?}", body.name));
    let links = model.frames.iter().filter(|frame| !is_finite(&frame.placement)).map(|frame| format!("link {:?}", frame.name));
    joints.chain(links).collect()
}

impl<'a> Builder<'a> {
    fn new(description: &'a Description) -> Self {
        let mut children: ById<LinkId, Vec<JointId>> = vec![Vec::new(); description.links.len()].into();
        for (index, joint) in description.joints.with_ids() {
            if let Some(list) = children.get_mut(joint.parent) {
                list.push(index);
            }
        }
        let model = Model {
            name: description.name.clone(),
            gravity: Vector3::from(GRAVITY),
            wrench_reference: Reference::Body,
            bodies: ById::default(),
            frames: ById::default(),
            joints: Vec::new(),
            nq: 0,
            nv: 0,
            actuators: Actuators::default(),
            constraints: Constraints::default(),
        };
        let (links, joints) = (description.links.len(), description.joints.len());
        Self {
            description,
            children,
            seats: vec![None; links].into(),
            body_of: vec![None; joints].into(),
            leads: leads(&description.joints),
            followers: Vec::new(),
            model,
        }
    }

    fn add_root(&mut self, root: LinkId, base: Base) {
        let name = self.description.links[root].name.clone();
        self.push_body(name, BodyId::BASE, Placement::identity(), Joint::Floating, AT_ZERO);
        let body = match base {
            Base::Fixed => BodyId::BASE,
            Base::Floating => {
                let coordinates = self.push_joint(FLOATING_BASE, JointKind::Floating, None);
                self.push_body(FLOATING_BASE.to_string(), BodyId::BASE, Placement::identity(), Joint::Floating, coordinates)
            }
        };
        self.seat(root, body, Placement::identity());
    }

    /// Depth-first, with a stack of its own: a chain may be of any length.
    fn add_tree(&mut self, root: LinkId) -> Result<(), ModelError> {
        let mut stack: Vec<JointId> = self.children[root].iter().rev().copied().collect();
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

    fn add_joint(&mut self, index: JointId, joint: &description::Joint) -> Result<(), ModelError> {
        let (mut parent, x_parent) = self.seats[joint.parent].expect("a parent is seated before its children");
        let mut x_joint = x_parent.compose(&joint.origin.placement());
        let stages = stages(joint);
        if let ([stage], false, None) = (stages.as_slice(), joint.also.is_empty(), &joint.locked) {
            return self.add_coupled(index, joint, (parent, x_joint), stage);
        }
        if let Some(coordinates) = self.locked_at(index)? {
            let x = stages.iter().fold(x_joint, |x, stage| stage.locked(x, &coordinates, joint));
            self.seat(joint.child, parent, x);
            return Ok(());
        }
        if stages.is_empty() {
            self.seat(joint.child, parent, x_joint);
            return Ok(());
        }
        let first = match joint.mimic {
            Some(_) => AT_ZERO,
            None => {
                let coordinates = self.push_joint(&joint.name, joint.kind, limit_of_coordinates(joint));
                self.model.joints.last_mut().into_iter().for_each(|info| info.cone = cone(joint));
                coordinates
            }
        };
        for stage in &stages {
            // Turn the frames so that the axis is z; the link's frame stays where it was.
            let turned = x_joint.compose(&turned(stage.turn));
            let coordinates = Coordinates { q: first.q + stage.at, v: first.v + stage.at, pitch: per_radian(joint), ..AT_ZERO };
            parent = self.push_body(joint.name.clone(), parent, turned, stage.joint, coordinates);
            x_joint = turned_back(stage.turn);
        }
        self.body_of[index] = Some(parent);
        self.seat(joint.child, parent, x_joint);
        Ok(())
    }

    /// A joint that follows several: for each of them a body, all on one axis, since
    /// R(Σ qᵢ) = Π R(qᵢ), and so for slides and screws. All have the joint's name.
    fn add_coupled(&mut self, index: JointId, joint: &description::Joint, seat: Seat, stage: &Stage) -> Result<(), ModelError> {
        let joints = &self.description.joints;
        let terms: Option<Vec<Mimic>> = core::iter::once(self.leads[index]).chain(others(joints, &self.leads, joint)).collect();
        let terms = terms.ok_or_else(|| self.refused(joint))?;
        let (mut parent, mut x) = seat;
        // The contribution of locked leaders to the coordinate.
        let mut still = 0.0;
        for lead in &terms {
            let leader = &joints[lead.joint];
            if let Some(at) = &leader.locked {
                let [at] = at.as_slice() else {
                    return Err(ModelError::BadLock { joint: leader.name.clone(), kind: leader.kind, found: at.len() });
                };
                still += lead.law().value(*at);
            }
        }
        let mut moving: Vec<Mimic> = terms.into_iter().filter(|lead| joints[lead.joint].locked.is_none()).collect();
        match moving.first_mut() {
            Some(first) => first.offset += still,
            None => x = stage.locked(x, &[still], joint),
        }
        let mut at = x.compose(&turned(stage.turn));
        for lead in moving {
            let coordinates = Coordinates { pitch: per_radian(joint), ..AT_ZERO };
            parent = self.push_body(joint.name.clone(), parent, at, stage.joint, coordinates);
            // The next one is on the same axis.
            (at, x) = (Placement::identity(), turned_back(stage.turn));
            self.followers.push((parent, index, lead));
            self.body_of[index] = Some(parent);
        }
        self.seat(joint.child, parent, x);
        Ok(())
    }

    /// The coordinates at which a joint is locked, because it is or because one that it follows is.
    fn locked_at(&self, index: JointId) -> Result<Option<Vec<f64>>, ModelError> {
        let (joints, lead) = (&self.description.joints, self.leads[index]);
        let joint = &joints[lead.map_or(index, |lead| lead.joint)];
        let Some(coordinates) = &joint.locked else { return Ok(None) };
        let (found, kind) = (coordinates.len(), joint.kind);
        if found != kind.sizes().0 || coordinates.iter().any(|x| !x.is_finite()) {
            return Err(ModelError::BadLock { joint: joint.name.clone(), kind, found });
        }
        Ok(Some(coordinates.iter().map(|x| lead.map_or(*x, |lead| lead.law().value(*x))).collect()))
    }

    fn push_joint(&mut self, name: &str, kind: JointKind, limit: Option<description::Limit>) -> Coordinates<f64> {
        let model = &mut self.model;
        let coordinates = Coordinates { q: model.nq, v: model.nv, ..AT_ZERO };
        let limit = limit.filter(|_| kind.has_bounds());
        let (nq, nv) = kind.sizes();
        model.joints.push(JointInfo { name: name.to_string(), kind, q: (model.nq, nq), v: (model.nv, nv), limit, cone: None });
        model.nq += nq;
        model.nv += nv;
        coordinates
    }

    fn push_body(
        &mut self,
        name: String,
        parent: BodyId,
        placement: Placement<f64>,
        joint: Joint,
        coordinates: Coordinates<f64>,
    ) -> BodyId {
        let inertia = SpatialInertia::zero();
        self.model.bodies.push(Body { name, parent, placement, joint, coordinates, inertia, link: None, effects: Effects::none() })
    }

    /// Seats a link in a body and adds its mass to it. The first link of a moving body defines the
    /// axes and origin of the body in results for each link.
    fn seat(&mut self, link: LinkId, body: BodyId, placement: Placement<f64>) {
        self.seats[link] = Some((body, placement));
        let (of_file, to) = (&self.description.links[link], &mut self.model.bodies[body]);
        if body != BodyId::BASE && to.link.is_none() && !of_file.intermediate {
            to.link = Some(BodyLink { name: of_file.name.clone(), placement });
        }
        if let Some(inertial) = &of_file.inertial {
            to.inertia += inertial.spatial_inertia().moved(&placement);
        }
    }

    fn finish(mut self) -> Result<Model<f64>, ModelError> {
        if self.seats.iter().any(Option::is_none) {
            return Err(self.not_a_tree());
        }
        for (index, joint) in self.description.joints.with_ids() {
            if let (Some(mimic), Some(body), true) = (&joint.mimic, self.body_of[index], joint.also.is_empty()) {
                let lead = self.leads[index];
                let follow = lead.and_then(|lead| self.follow(index, mimic, lead)).ok_or_else(|| self.refused(joint))?;
                self.model.bodies[body].coordinates = follow;
            }
        }
        for (body, index, lead) in core::mem::take(&mut self.followers) {
            let joint = &self.description.joints[index];
            let follow = self.follow(index, &lead, lead).ok_or_else(|| self.refused(joint))?;
            self.model.bodies[body].coordinates = follow;
        }
        self.model.frames = self.frames();
        self.sharpen();
        let names = too_large(&self.model);
        if names.is_empty() { Ok(self.model) } else { Err(ModelError::TooLarge { names }) }
    }

    /// The frames of the links, then those that coincide with no link.
    fn frames(&self) -> ById<FrameId, Frame<f64>> {
        let seated = |link: LinkId| self.seats.get(link).copied().flatten();
        let links = self.description.links.with_ids().filter(|(_, link)| !link.intermediate);
        let of_links = links.filter_map(|(index, link)| {
            let (body, placement) = seated(index)?;
            Some(Frame { name: link.name.clone(), body, placement })
        });
        let others = self.description.frames.iter().filter_map(|frame| {
            let (body, placement) = seated(frame.link)?;
            Some(Frame { name: frame.name.clone(), body, placement: placement.compose(&frame.origin.placement()) })
        });
        of_links.chain(others).collect()
    }

    /// Removes the rounding of the products from the rotations that they gave.
    fn sharpen(&mut self) {
        let Model { bodies, frames, .. } = &mut self.model;
        let placements = bodies.iter_mut().map(|b| &mut b.placement).chain(frames.iter_mut().map(|f| &mut f.placement));
        placements.for_each(|x| x.rotation = nearest_rotation(&x.rotation));
    }

    /// The coordinate that moves a follower. Its leader must move; since each follower is checked,
    /// so must all leaders down to the last.
    fn follow(&self, follower: JointId, mimic: &Mimic, lead: Mimic) -> Option<Coordinates<f64>> {
        let joints = &self.description.joints;
        self.body_of[mimic.joint]?;
        let body = self.body_of[lead.joint].filter(|_| joints[lead.joint].kind.sizes() == (1, 1))?;
        let Coordinates { q, v, .. } = self.model.bodies[body].coordinates;
        let mimic = Some(lead.law());
        Some(Coordinates { q, v, mimic, pitch: per_radian(&joints[follower]) })
    }

    /// Why a joint cannot follow.
    fn refused(&self, joint: &description::Joint) -> ModelError {
        let joints = &self.description.joints;
        let is_too_high = |law: &Mimic| description::degree_of_chain(joints, law) > description::MOST_DEGREE;
        let name = joint.name.clone();
        match joint.mimic.iter().chain(&joint.also).any(is_too_high) {
            true => ModelError::Degree { joint: name },
            false => ModelError::BadMimic { joint: name },
        }
    }

    fn not_a_tree(&self) -> ModelError {
        let lost = self.description.links.iter().zip(&self.seats).filter(|(_, seat)| seat.is_none());
        ModelError::NotATree { unreached: lost.map(|(link, _)| link.name.clone()).collect() }
    }
}

const AT_ZERO: Coordinates<f64> = Coordinates { q: 0, v: 0, mimic: None, pitch: 0.0 };

/// An elementary joint as part of a joint of the file.
struct Stage {
    joint: Joint,
    /// Axes of its frame, z along its axis, in axes of the file's joint frame.
    turn: Matrix3<f64>,
    /// Its first coordinate among those of the file's joint.
    at: usize,
}

impl Stage {
    /// The frame x after the stage, which is locked at its part of the coordinates.
    fn locked(&self, x: Placement<f64>, coordinates: &[f64], joint: &description::Joint) -> Placement<f64> {
        let at = Coordinates { q: self.at, pitch: per_radian(joint), ..AT_ZERO };
        let x = x.compose(&turned(self.turn));
        with_pose!(self.joint.pose(&at, coordinates), p => p.compose(x)).compose(&turned_back(self.turn))
    }
}

/// A joint of the file as a chain of elementary ones; none for a fixed joint.
fn stages(joint: &description::Joint) -> Vec<Stage> {
    let stage = |at: usize, elementary: Joint, axis: [f64; 3]| Stage { joint: elementary, turn: to_z_axis(axis), at };
    let free = |elementary: Joint| Stage { joint: elementary, turn: Matrix3::identity(), at: 0 };
    match joint.kind {
        JointKind::Fixed => vec![],
        JointKind::Revolute | JointKind::Continuous => vec![stage(0, Joint::Revolute, joint.axis)],
        JointKind::Prismatic => vec![stage(0, Joint::Prismatic, joint.axis)],
        JointKind::Helical => vec![stage(0, Joint::Helical, joint.axis)],
        JointKind::Universal => vec![stage(0, Joint::Revolute, joint.axis), stage(1, Joint::Revolute, joint.second_axis)],
        JointKind::Planar => {
            let plane = to_z_axis(joint.axis);
            let axis = |k: usize| plane.column(k).into_owned().into();
            vec![stage(0, Joint::Prismatic, axis(0)), stage(1, Joint::Prismatic, axis(1)), stage(2, Joint::Revolute, joint.axis)]
        }
        JointKind::Spherical => vec![free(Joint::Spherical)],
        JointKind::Floating => vec![free(Joint::Floating)],
    }
}

/// m/rad of a helical joint; zero for others.
fn per_radian(joint: &description::Joint) -> f64 {
    if joint.kind.has_pitch() { joint.pitch / core::f64::consts::TAU } else { 0.0 }
}

/// The largest angle of a ball joint. A bound of 0 comes from a `<limit>` without one.
fn cone(joint: &description::Joint) -> Option<f64> {
    let upper = joint.limit.filter(|_| joint.kind == JointKind::Spherical)?.upper;
    Some(upper).filter(|upper| *upper > 0.0 && *upper < core::f64::consts::PI)
}

/// The limits of each coordinate: that of a ball joint is of the angle of its rotation, its
/// [`JointInfo::cone`].
fn limit_of_coordinates(joint: &description::Joint) -> Option<Limit> {
    let open = |limit: Limit| Limit { lower: f64::NEG_INFINITY, upper: f64::INFINITY, ..limit };
    match joint.kind {
        JointKind::Spherical => joint.limit.map(open).filter(|limit| *limit != Limit::NONE),
        _ => joint.limit,
    }
}

fn turned(turn: Matrix3<f64>) -> Placement<f64> {
    Placement { rotation: turn, position: Vector3::zeros() }
}

fn turned_back(turn: Matrix3<f64>) -> Placement<f64> {
    turned(turn.transpose())
}

impl Inertial {
    /// About the origin of the link's frame, in its axes.
    pub fn spatial_inertia(&self) -> SpatialInertia<f64> {
        let [xx, xy, xz, yy, yz, zz] = self.inertia;
        let central = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        SpatialInertia::from_central(self.mass, central, &self.origin.placement())
    }
}
