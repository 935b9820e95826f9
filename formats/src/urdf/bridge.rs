//! From `urdf-rs`'s robot to a [`Description`], which must equal this crate's own result.

use articulated_core::description::{
    Description, Inertial, Joint, JointDynamics, JointId, JointKind, Limit, Link, LinkId, Mimic, Origin, Rotation,
};
use articulated_core::diagnostic::{Code, Diagnostics, Place};
use urdf_rs::{JointType, Pose, Robot};

use super::ast::Draft;
use super::plain::{self, Piece};
use super::tree::Tree;

/// An internal error, if the robot that `urdf-rs` reads from the plain documents differs from
/// `found`.
pub(crate) fn compare(found: &Description, draft: &Draft, tree: &Tree, leaders: &[Option<usize>], log: &mut Diagnostics) {
    let mut description = Description { name: draft.name.clone(), ..Description::default() };
    for piece in plain::pieces(draft, tree, leaders) {
        let robot = match urdf_rs::read_from_string(&piece.text) {
            Ok(robot) => robot,
            Err(error) => return internal(format!("an error of urdf-rs: {error}"), log),
        };
        if read_back(&robot, &piece, draft, &mut description).is_none() {
            return internal("a robot of another shape read by urdf-rs".to_owned(), log);
        }
    }
    // It reads only one leader of a joint.
    let mut found = found.clone();
    found.joints.iter_mut().for_each(|joint| joint.also.clear());
    if with_angles(description) != with_angles(found) {
        internal("another robot read by urdf-rs".to_owned(), log);
    }
}

/// The same robot with each rotation as roll, pitch and yaw, the only form that `urdf-rs` has.
fn with_angles(mut robot: Description) -> Description {
    let inertials = robot.links.iter_mut().filter_map(|link| link.inertial.as_mut().map(|inertial| &mut inertial.origin));
    for origin in inertials.chain(robot.joints.iter_mut().map(|joint| &mut joint.origin)) {
        origin.rotation = Rotation::RollPitchYaw(origin.rotation.rpy());
    }
    robot
}

fn internal(found: String, log: &mut Diagnostics) {
    let expected = "two readers that agree; this is a mistake of articulated-formats: please report it";
    log.error(Place::DOCUMENT, Code::Internal, found, expected);
}

/// Adds the links and joints that `urdf-rs` read from a piece. The names are the draft's: the piece
/// has indices instead.
fn read_back(robot: &Robot, piece: &Piece, draft: &Draft, into: &mut Description) -> Option<()> {
    if robot.links.len() != piece.links || robot.joints.len() != piece.joints {
        return None;
    }
    for link in &robot.links {
        into.links.push(read_link(link, into.links.len(), draft)?);
    }
    for joint in &robot.joints {
        into.joints.push(read_joint(joint, into.joints.len(), draft)?);
    }
    Some(())
}

fn read_link(link: &urdf_rs::Link, index: usize, draft: &Draft) -> Option<Link> {
    let found = draft.links.get(read_index(&link.name)?)?;
    let name = found.name.clone()?;
    // urdf-rs does not distinguish a missing inertial from zeros.
    let inertial = found.inertial.is_some().then(|| read_inertial(&link.inertial));
    // The plain documents have neither collision geometry nor appearance.
    let (collision, visual) = (found.collision.clone(), found.visual.clone());
    (read_index(&link.name)? == index).then_some(Link { name, inertial, collision, visual, ..Link::default() })
}

fn read_joint(joint: &urdf_rs::Joint, index: usize, draft: &Draft) -> Option<Joint> {
    let found = draft.joints.get(read_index(&joint.name)?)?;
    let name = found.name.clone()?;
    let mimic = match &joint.mimic {
        Some(mimic) => Some(read_mimic(mimic)?),
        None => None,
    };
    (read_index(&joint.name)? == index).then_some(Joint {
        name,
        kind: read_kind(&joint.joint_type, found.kind?),
        parent: LinkId(read_index(&joint.parent.link)?),
        child: LinkId(read_index(&joint.child.link)?),
        origin: read_origin(&joint.origin),
        axis: *joint.axis.xyz,
        // urdf-rs does not read these: there is nothing to compare.
        second_axis: found.second_axis,
        pitch: found.pitch,
        locked: None,
        mimic,
        also: Vec::new(),
        // Nor a missing limit from zeros.
        limit: found.limit.map(|found| read_limit(&joint.limit, found)),
        dynamics: joint.dynamics.as_ref().map_or(JointDynamics { damping: None, friction: None, ..found.dynamics }, |d| JointDynamics {
            damping: Some(d.damping),
            friction: Some(d.friction),
            ..found.dynamics
        }),
    })
}

fn read_index(name: &str) -> Option<usize> {
    name.parse().ok()
}

/// The kind that was read; `drafted`, if only this crate knows that kind and [`plain`] wrote its
/// stand-in.
fn read_kind(kind: &JointType, drafted: JointKind) -> JointKind {
    match kind {
        JointType::Fixed if plain::is_unknown_to_urdf_rs(drafted) => drafted,
        JointType::Fixed => JointKind::Fixed,
        JointType::Revolute => JointKind::Revolute,
        JointType::Continuous => JointKind::Continuous,
        JointType::Prismatic => JointKind::Prismatic,
        JointType::Floating => JointKind::Floating,
        JointType::Planar => JointKind::Planar,
        JointType::Spherical => JointKind::Spherical,
    }
}

fn read_origin(pose: &Pose) -> Origin {
    Origin::new(*pose.xyz, *pose.rpy)
}

fn read_inertial(inertial: &urdf_rs::Inertial) -> Inertial {
    let i = &inertial.inertia;
    Inertial { origin: read_origin(&inertial.origin), mass: inertial.mass.value, inertia: [i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz] }
}

fn read_limit(limit: &urdf_rs::JointLimit, found: Limit) -> Limit {
    Limit { lower: limit.lower, upper: limit.upper, effort: limit.effort, velocity: limit.velocity, ..found }
}

fn read_mimic(mimic: &urdf_rs::Mimic) -> Option<Mimic> {
    Some(Mimic::linear(JointId(read_index(&mimic.joint)?), mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0)))
}
