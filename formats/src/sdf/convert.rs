//! A URDF in an `<include>`, as the tags of a model with the numbers of the URDF.
//!
//! As in Gazebo, a link `world` without a parent is the world, and the root of another robot
//! floats. A floating joint leaves its child free.

use std::rc::Rc;

use articulated_core::description::{
    CollisionShape, Description, Inertial, Joint, JointDynamics, JointKind, Limit, LinkId, Origin, Rotation,
};
use articulated_core::diagnostic::{At, Code, Diagnostics, Place, Subject, quote};

use super::names::{ROOT, WORLD_NAME};
use crate::xml::tree::{Attribute, Element, File};

/// Makes tags of one file.
struct Maker<'a> {
    robot: &'a Description,
    file: &'a Rc<File>,
}

/// The root element of a document with this robot as its model. Content that a model cannot have is
/// an error.
pub(crate) fn document(robot: &Description, file: &Rc<File>, log: &mut Diagnostics) -> Element {
    let maker = Maker { robot, file };
    let root = robot.root();
    let world = root.filter(|root| robot.links[*root].name == WORLD_NAME);
    let mut parts: Vec<Element> = Vec::new();
    let others = robot.links.ids().filter(|link| Some(*link) != root);
    for link in root.into_iter().chain(others).filter(|link| Some(*link) != world) {
        let above = robot.joints.iter().find(|joint| joint.child == link);
        parts.push(maker.link(link, above, world));
    }
    for joint in &robot.joints {
        parts.extend(maker.joint(joint, log));
    }
    let model = maker.tag("model", &[("name", robot.name.clone())], parts);
    maker.tag(ROOT, &[("version", "1.12".to_owned())], vec![model])
}

impl Maker<'_> {
    fn tag(&self, name: &str, attributes: &[(&str, String)], children: Vec<Element>) -> Element {
        let attribute = |(name, value): &(&str, String)| Attribute { name: (*name).to_owned(), value: value.clone(), at: At::Nowhere };
        Element {
            name: name.to_owned(),
            attributes: attributes.iter().map(attribute).collect(),
            children,
            at: At::Nowhere,
            content: None,
            file: self.file.clone(),
        }
    }

    fn text(&self, name: &str, content: &str) -> Element {
        Element { content: Some(content.to_owned()), ..self.tag(name, &[], Vec::new()) }
    }

    fn numbers(&self, name: &str, numbers: &[f64]) -> Element {
        self.text(name, &spelled(numbers))
    }

    fn pose(&self, origin: &Origin, relative_to: Option<&str>) -> Element {
        let (rotation, format) = match origin.rotation {
            Rotation::Quaternion(quaternion) => (quaternion.to_vec(), "quat_xyzw"),
            other => (other.rpy().to_vec(), "euler_rpy"),
        };
        let relative = relative_to.map(|name| ("relative_to", name.to_owned()));
        let attributes: Vec<_> = relative.into_iter().chain([("rotation_format", format.to_owned())]).collect();
        let numbers: Vec<f64> = origin.xyz.iter().copied().chain(rotation).collect();
        Element { content: Some(spelled(&numbers)), ..self.tag("pose", &attributes, Vec::new()) }
    }

    fn link(&self, index: LinkId, above: Option<&Joint>, world: Option<LinkId>) -> Element {
        let link = &self.robot.links[index];
        let mut parts = Vec::new();
        if let Some(joint) = above {
            let parent = Some(joint.parent).filter(|parent| Some(*parent) != world);
            parts.push(self.pose(&joint.origin, parent.map(|parent| self.robot.links[parent].name.as_str())));
        }
        parts.push(self.inertial(link.inertial.as_ref()));
        let shape = |name: &str, origin: &Origin, shape: &CollisionShape, more: Option<Element>| {
            let parts = [self.pose(origin, None), self.geometry(shape)].into_iter().chain(more).collect();
            self.tag(name, &[], parts)
        };
        parts.extend(link.collision.iter().map(|one| shape("collision", &one.origin, &one.shape, None)));
        parts.extend(link.visual.iter().map(|one| {
            let material = one.color.map(|color| self.tag("material", &[], vec![self.numbers("diffuse", &color)]));
            shape("visual", &one.origin, &one.shape, material)
        }));
        self.tag("link", &[("name", link.name.clone())], parts)
    }

    /// A link without an inertia gets zero, since the format's default would be 1 kg.
    fn inertial(&self, own: Option<&Inertial>) -> Element {
        let names = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
        let inertia = own.map_or([0.0; 6], |own| own.inertia);
        let moments = names.iter().zip(inertia).map(|(name, moment)| self.numbers(name, &[moment])).collect();
        let pose = own.map(|own| self.pose(&own.origin, None));
        let mass = self.numbers("mass", &[own.map_or(0.0, |own| own.mass)]);
        let parts = pose.into_iter().chain([mass, self.tag("inertia", &[], moments)]).collect();
        self.tag("inertial", &[], parts)
    }

    fn geometry(&self, shape: &CollisionShape) -> Element {
        let numbers = |name: &str, numbers: &[f64]| self.numbers(name, numbers);
        let round = |radius: f64, length: f64| vec![numbers("radius", &[radius]), numbers("length", &[length])];
        let inner = match shape {
            CollisionShape::Box { size } => self.tag("box", &[], vec![numbers("size", size)]),
            CollisionShape::Sphere { radius } => self.tag("sphere", &[], vec![numbers("radius", &[*radius])]),
            CollisionShape::Cylinder { radius, length } => self.tag("cylinder", &[], round(*radius, *length)),
            CollisionShape::Capsule { radius, length } => self.tag("capsule", &[], round(*radius, *length)),
            CollisionShape::Mesh { file, scale, .. } => self.tag("mesh", &[], vec![self.text("uri", file), numbers("scale", scale)]),
            CollisionShape::Unread { why } => self.text("unread", why),
        };
        self.tag("geometry", &[], vec![inner])
    }

    fn joint(&self, joint: &Joint, log: &mut Diagnostics) -> Option<Element> {
        let subject = Subject::Joint(joint.name.clone());
        let place = |field| Place { field, subject: &subject, ..Place::DOCUMENT };
        let kind = match joint.kind {
            JointKind::Revolute => "revolute",
            JointKind::Continuous => "continuous",
            JointKind::Prismatic => "prismatic",
            JointKind::Fixed => "fixed",
            JointKind::Spherical => "ball",
            JointKind::Helical => "screw",
            JointKind::Universal => "universal",
            JointKind::Floating => return None,
            JointKind::Planar => {
                let expected = "a joint of another type: SDF has no planar joint, so that no SDF can include it";
                log.error(place("type"), Code::UnknownJointType, "a planar joint", expected);
                return None;
            }
        };
        if let Some(second) = joint.also.first() {
            let found = format!("a joint that also follows {}", quote(&self.robot.joints[second.joint].name));
            log.error(place("mimic"), Code::Unsupported, found, "one joint to follow, in a URDF that an SDF includes");
        }
        if joint.kind == JointKind::Spherical && joint.dynamics != JointDynamics::default() {
            let expected = "none: SDF has no forces of ball joints, and they are not kept";
            log.warning(place("dynamics"), Code::LostDynamics, "forces of a ball joint in a URDF that an SDF includes", expected);
        }
        let mut parts =
            vec![self.text("parent", &self.robot.links[joint.parent].name), self.text("child", &self.robot.links[joint.child].name)];
        if joint.kind.has_axis() {
            parts.push(self.axis("axis", &joint.axis, joint));
        }
        if joint.kind.has_second_axis() {
            if !joint.kind.has_axis() {
                parts.push(self.axis("axis", &joint.axis, joint));
            }
            parts.push(self.axis("axis2", &joint.second_axis, joint));
        }
        if joint.kind.has_pitch() {
            parts.push(self.numbers("screw_thread_pitch", &[joint.pitch]));
        }
        parts.extend(joint.dynamics.armature.map(|inertia| self.numbers("drake:rotor_inertia", &[inertia])));
        Some(self.tag("joint", &[("name", joint.name.clone()), ("type", kind.to_owned())], parts))
    }

    fn axis(&self, name: &str, direction: &[f64; 3], joint: &Joint) -> Element {
        let mut parts = vec![self.numbers("xyz", direction)];
        let JointDynamics { damping, friction, stiffness, rest, .. } = joint.dynamics;
        let forces = [("damping", damping), ("friction", friction), ("spring_stiffness", stiffness), ("spring_reference", rest)];
        parts.push(self.given("dynamics", &forces.map(|(name, value)| (name, value.unwrap_or(f64::INFINITY)))));
        if let Some(Limit { lower, upper, effort, velocity, .. }) = joint.limit {
            parts.push(self.given("limit", &[("lower", lower), ("upper", upper), ("effort", effort), ("velocity", velocity)]));
        }
        if let Some(mimic) = joint.mimic {
            let leader = self.robot.joints[mimic.joint].name.clone();
            let law = vec![self.numbers("multiplier", &[mimic.multiplier]), self.numbers("offset", &[mimic.offset])];
            parts.push(self.tag("mimic", &[("joint", leader)], law));
        }
        self.tag(name, &[], parts)
    }

    /// A tag with the finite ones of these numbers.
    fn given(&self, name: &str, numbers: &[(&str, f64)]) -> Element {
        let parts = numbers.iter().filter(|(_, value)| value.is_finite()).map(|(name, value)| self.numbers(name, &[*value]));
        self.tag(name, &[], parts.collect())
    }
}

/// Each number with enough digits to read it back exactly.
fn spelled(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" ")
}
