//! From bodies to a [`Description`].

use std::collections::BTreeMap;

use articulated_core::description::{Base, Collision, Description, Frame, Inertial, Joint, JointKind, Link, LinkId, Origin, Visual};
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::bodies::{self, Body, Kind, at_reference};
use super::grammar::subject;
use super::mass::Mass;
use crate::Options;
use crate::pose::{Pose, scale, subtract};
use crate::reading::HELD;
use crate::taken::Taken;
use crate::world::ContactMask;

/// The link that does not move.
const WORLD: &str = "world";

/// A description, with what became of the bodies.
pub(crate) struct Lowered {
    pub(crate) description: Description,
    /// Names of joints, in the order of the bodies.
    pub(crate) joints: Vec<String>,
    /// The name of the link of each body.
    pub(crate) links: Vec<String>,
    /// For each link, the contact masks of its collision geometry.
    pub(crate) masks: BTreeMap<String, Vec<ContactMask>>,
}

/// The description of all bodies with their masses.
pub(crate) fn lower(name: &str, bodies: &[Body<'_>], inertials: &[Option<Mass>], options: &Options, log: &mut Diagnostics) -> Lowered {
    let mut lower = Lower {
        description: Description { name: name.to_owned(), ..Description::default() },
        links: Taken::with(WORLD),
        joints: Taken::default(),
        link_of: Vec::with_capacity(bodies.len()),
        is_fixed: Vec::with_capacity(bodies.len()),
        names: Vec::new(),
        masks: BTreeMap::new(),
    };
    lower.reserve(bodies, log);
    for (index, (body, own)) in bodies.iter().zip(inertials).enumerate() {
        if index == 0 {
            let world = lower.description.links.push(Link { name: WORLD.to_owned(), ..Link::default() });
            lower.link_of.push(world);
            lower.is_fixed.push(true);
        } else {
            lower.body(index, body, own.as_ref().map(Mass::inertial), options, log);
        }
        lower.content(index, body);
    }
    lower.sites(bodies, log);
    let links = lower.link_of.iter().map(|link| lower.description.links[*link].name.clone()).collect();
    Lowered { description: lower.description, joints: lower.names, links, masks: lower.masks }
}

struct Lower {
    description: Description,
    /// Names of links and frames, and of joints, that are taken.
    links: Taken,
    joints: Taken,
    link_of: Vec<LinkId>,
    /// Whether the body cannot move.
    is_fixed: Vec<bool>,
    /// Names of joints of the file, or made for them.
    names: Vec<String>,
    masks: BTreeMap<String, Vec<ContactMask>>,
}

pub(crate) const KEPT: &str = "kept for scenes that turn on such forces; no part of the rigid-body dynamics";

/// Reports the numbers of a joint that only effects use, under the effects' names for them.
fn keep_dynamics(joint: &bodies::Joint<'_>, name: &str, log: &mut Diagnostics) {
    let own = joint.dynamics;
    let [damping, stiffness] = [own.damping_terms, own.stiffness_terms].map(|terms| [0, 1].map(|k| terms.map(|own| own[k])));
    let numbers = [
        ("joint damping, quadratic", "damping", damping[0]),
        ("joint damping, cubic", "damping", damping[1]),
        ("joint stiffness, quadratic", "stiffness", stiffness[0]),
        ("joint stiffness, cubic", "stiffness", stiffness[1]),
        ("dynamics damping", "damping", own.damping),
        ("dynamics friction", "frictionloss", own.friction),
        ("joint armature", "armature", own.armature),
        ("joint stiffness", "stiffness", own.stiffness),
        ("joint springref", "springref", own.rest),
    ];
    for (tag, attribute, _) in numbers.iter().filter(|(_, _, number)| number.is_some()) {
        let place = (joint.element.attribute(attribute), (*tag).to_owned());
        joint.element.unused_part(&Subject::Joint(name.to_owned()), place, KEPT, log);
    }
}

impl Lower {
    /// Reserves the names of the file, which have precedence over generated ones.
    fn reserve(&mut self, bodies: &[Body<'_>], log: &mut Diagnostics) {
        for (index, body) in bodies.iter().enumerate() {
            if let Some(name) = body.name.as_ref().filter(|_| index > 0)
                && !self.links.insert(name.clone())
            {
                let expected = "a name of its own; the world is called \"world\"";
                body.element.error(
                    (&subject(body.element), "name"),
                    Code::DuplicateName,
                    format!("a second body {}", quote(name)),
                    expected,
                    log,
                );
            }
            for joint in &body.joints {
                if let Some(name) = &joint.name
                    && !self.joints.insert(name.clone())
                {
                    let found = format!("a second joint {}", quote(name));
                    joint.element.error((&subject(joint.element), "name"), Code::DuplicateName, found, "a name of its own", log);
                }
            }
        }
    }

    fn body(&mut self, index: usize, body: &Body<'_>, inertial: Option<Inertial>, options: &Options, log: &mut Diagnostics) {
        let name = body.name.clone().unwrap_or_else(|| self.links.free(format!("body_{index}")));
        let parent = self.link_of[body.parent];
        self.is_fixed.push(self.is_fixed[body.parent] && body.joints.is_empty());
        if self.is_fixed[index] && options.base == Base::Fixed && inertial.is_some_and(|inertial| inertial.mass != 0.0) {
            body.element.unused(&subject(body.element), None, HELD, log);
        }
        let link = Link { name: name.clone(), inertial, ..Link::default() };
        let free_joint = body.joints.iter().find(|joint| joint.kind == Kind::Free);
        if let Some(joint) = free_joint {
            self.free_joint(body, joint, link, log);
        } else if body.joints.is_empty() {
            let joint = self.joints.free(format!("{name}_fixed"));
            let child = self.add_link(link);
            self.add_joint(Joint { name: joint, kind: JointKind::Fixed, parent, child, origin: body.pose.origin(), ..Joint::default() });
        } else {
            self.sequence(body, parent, link, log);
        }
        self.link_of.push(LinkId(self.description.links.len() - 1));
    }

    fn add_link(&mut self, link: Link) -> LinkId {
        self.description.links.push(link)
    }

    fn add_joint(&mut self, joint: Joint) {
        self.description.joints.push(joint);
    }

    fn free_joint(&mut self, body: &Body<'_>, joint: &bodies::Joint<'_>, link: Link, log: &mut Diagnostics) {
        let subject = subject(joint.element);
        if body.parent != 0 || body.joints.len() > 1 {
            let found = if body.parent == 0 { "a free joint beside others" } else { "a free joint inside a moving body" };
            joint.element.error((&subject, "type"), Code::Misplaced, found, "it alone, in a body directly inside the world", log);
        }
        let name = joint.name.clone().unwrap_or_else(|| self.joints.free(format!("{}_free", link.name)));
        // A free joint with others is an error.
        self.names.extend(body.joints.iter().map(|_| name.clone()));
        keep_dynamics(joint, &name, log);
        let (child, dynamics) = (self.add_link(link), joint.dynamics);
        self.add_joint(Joint { name, kind: JointKind::Floating, parent: LinkId(0), child, dynamics, ..Joint::default() });
    }

    /// Hinges, slides and balls, one after the other. The frame of each link in between is at the
    /// anchor of its joint.
    fn sequence(&mut self, body: &Body<'_>, mut parent: LinkId, link: Link, log: &mut Diagnostics) {
        let mut link = Some(link);
        let body_name = link.as_ref().map(|link| link.name.clone()).unwrap_or_default();
        let mut anchor = [0.0; 3];
        for (k, joint) in body.joints.iter().enumerate() {
            let is_last = k + 1 == body.joints.len();
            let frame = match k {
                0 => body.pose.then(&Pose::at(joint.anchor)),
                _ => Pose::at(subtract(joint.anchor, anchor)),
            };
            anchor = joint.anchor;
            let (kind, word) = match joint.kind {
                Kind::Slide => (JointKind::Prismatic, "slide"),
                Kind::Ball => (JointKind::Spherical, "ball"),
                _ if joint.is_limited => (JointKind::Revolute, "hinge"),
                _ => (JointKind::Continuous, "hinge"),
            };
            let child = match link.take_if(|_| is_last && anchor == [0.0; 3]) {
                Some(link) => self.add_link(link),
                None => {
                    let name = self.links.free(format!("{body_name}_{}", k + 1));
                    self.add_link(Link { name, intermediate: true, ..Link::default() })
                }
            };
            let name = joint.name.clone().unwrap_or_else(|| self.joints.free(format!("{body_name}_{word}")));
            keep_dynamics(joint, &name, log);
            self.names.push(name.clone());
            let origin = at_reference(joint, frame).origin();
            let axis = if kind == JointKind::Spherical { Joint::default().axis } else { joint.axis };
            self.add_joint(Joint {
                name,
                kind,
                parent,
                child,
                origin,
                axis,
                limit: joint.limit,
                dynamics: joint.dynamics,
                ..Joint::default()
            });
            parent = child;
        }
        if let Some(link) = link {
            let name = self.joints.free(format!("{body_name}_fixed"));
            let child = self.add_link(link);
            self.add_joint(Joint {
                name,
                kind: JointKind::Fixed,
                parent,
                child,
                origin: Origin::at(scale(anchor, -1.0)),
                ..Joint::default()
            });
        }
    }

    /// Shapes for contact and drawings.
    fn content(&mut self, index: usize, body: &Body<'_>) {
        let link = &mut self.description.links[self.link_of[index]];
        for geom in &body.geoms {
            let Some((pose, shape)) = geom.shape() else { continue };
            let origin = pose.origin();
            if geom.collides() {
                link.collision.push(Collision { origin, shape: shape.clone() });
                self.masks.entry(link.name.clone()).or_default().push(geom.mask);
            }
            link.visual.push(Visual { origin, shape, material: String::new(), color: geom.color });
        }
    }

    /// Sites become frames.
    fn sites(&mut self, bodies: &[Body<'_>], log: &mut Diagnostics) {
        for (index, body) in bodies.iter().enumerate() {
            let link = self.link_of[index];
            for site in &body.sites {
                let name = match &site.name {
                    Some(name) if self.links.insert(name.clone()) => name.clone(),
                    Some(name) => {
                        let own = self.links.free(format!("{name}_site"));
                        let why = format!("a body or site has this name: the frame is called {}", quote(&own));
                        site.element.unused(&subject(site.element), site.element.attribute("name"), &why, log);
                        own
                    }
                    None => self.links.free(format!("{}_site", self.description.links[link].name)),
                };
                self.description.frames.push(Frame { name, link, origin: site.pose.origin() });
            }
        }
    }
}
