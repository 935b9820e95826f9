//! The tag `<joint>`.

use crate::xml::markup::hint;
use articulated_core::description::{JointDynamics, JointKind};
use articulated_core::diagnostic::{Code, Diagnostics, Place, Subject, quote};
use articulated_core::suggest::nearest;

use super::ast::{DRAKE_JOINT, DraftJoint, Reference, has_one_coordinate};
use super::mimic_tag::{DRAKE_MIMIC, mimics};
use super::robot::{Context, Version};
use super::{frame, limits, unused};
use crate::xml::element::Tag;
use crate::xml::number::{self, attribute_list};

const TAGS: [&str; 10] = ["origin", "parent", "child", "axis", "axis2", "thread", "limit", "dynamics", "mimic", DRAKE_MIMIC];

/// Tags that only `<drake:joint>` has.
const DRAKE_TAGS: [&str; 3] = [DRAKE_PARENT, DRAKE_CHILD, DRAKE_PITCH];

const DRAKE_PARENT: &str = "drake:parent";
const DRAKE_CHILD: &str = "drake:child";
const DRAKE_PITCH: &str = "drake:screw_thread_pitch";

/// The types of `<drake:joint>`.
const DRAKE_KINDS: [(&str, JointKind); 4] =
    [("ball", JointKind::Spherical), ("planar", JointKind::Planar), ("screw", JointKind::Helical), ("universal", JointKind::Universal)];

/// The default axis of a joint.
const DEFAULT_AXIS: [f64; 3] = [1.0, 0.0, 0.0];

/// Range of components that can be squared without underflow or overflow.
const AXIS: std::ops::RangeInclusive<f64> = 1e-150..=1e150;

/// A joint as the file writes it.
pub(crate) fn joint(tag: &Tag<'_>, context: &Context<'_>, log: &mut Diagnostics) -> DraftJoint {
    let subject = Subject::Joint(tag.name_for_messages());
    let tag = tag.of(&subject);
    let name = tag.required_name("name", log);
    name.iter().for_each(|name| unused::warn_of_blanks(&tag, name, log));
    let drake = if tag.is(DRAKE_JOINT) { &DRAKE_TAGS[..] } else { &[] };
    unused::rest(&tag, &[&TAGS, drake].concat(), &["name", "type"], log);
    let kind = if tag.is(DRAKE_JOINT) { drake_kind(&tag, log) } else { kind(&tag, log) };
    let mut mimics = if kind.is_some_and(JointKind::is_fixed) { Vec::new() } else { mimics(&tag, log) }.into_iter();
    let mut joint = DraftJoint {
        name,
        at: tag.at(),
        kind,
        parent: reference(&tag, "parent", log),
        child: reference(&tag, "child", log),
        origin: frame::origin(&tag, context, log),
        axis: DEFAULT_AXIS,
        second_axis: [0.0; 3],
        pitch: 0.0,
        mimic: mimics.next(),
        also: mimics.collect(),
        limit: None,
        dynamics: JointDynamics::default(),
    };
    match kind {
        Some(kind) => motion(&tag, kind, context.version, &mut joint, log),
        None => of_any_kind(&tag, context.version, log),
    }
    joint
}

/// Errors of a joint of any type.
fn of_any_kind(tag: &Tag<'_>, version: Version, log: &mut Diagnostics) {
    for name in ["axis", "axis2"] {
        if let Some(given) = tag.only(name, log) {
            axis(&given, log);
        }
    }
    if tag.children().any(|child| child.is("limit")) {
        limits::limit(tag, JointKind::Revolute, version, log);
    }
    limits::dynamics(tag, log);
}

fn kind(tag: &Tag<'_>, log: &mut Diagnostics) -> Option<JointKind> {
    let (name, at) = tag.required_attribute("type", log)?;
    let kind = JointKind::ALL.iter().copied().find(|kind| kind.name() == name);
    if kind.is_none() && !number::is_expression(name) {
        let hint = hint(elsewhere(name).map(str::to_owned).or_else(|| nearest(name, JointKind::ALL.iter().map(|k| k.name()))).as_deref());
        let expected = format!("{}{hint}", kinds_with(|_| true));
        let place = Place { at, ..tag.place("type") };
        log.error(place, Code::UnknownJointType, format!("the type {}", quote(name)), expected);
    }
    kind
}

fn drake_kind(tag: &Tag<'_>, log: &mut Diagnostics) -> Option<JointKind> {
    let (name, at) = tag.required_attribute("type", log)?;
    let kind = DRAKE_KINDS.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind);
    if kind.is_none() && !number::is_expression(name) {
        let hint = if JointKind::ALL.iter().any(|kind| kind.name() == name) { "; write this type as <joint>" } else { "" };
        let expected = format!("ball, planar, screw or universal in <drake:joint>{hint}");
        log.error(Place { at, ..tag.place("type") }, Code::UnknownJointType, format!("the type {}", quote(name)), expected);
    }
    kind
}

/// The types of these kinds, listed: a, b or c.
pub(crate) fn kinds_with(meant: impl Fn(JointKind) -> bool) -> String {
    let names: Vec<&str> = JointKind::ALL.iter().filter(|kind| meant(**kind)).map(|kind| kind.name()).collect();
    match names.as_slice() {
        [before @ .., last] if !before.is_empty() => format!("{} or {last}", before.join(", ")),
        names => names.concat(),
    }
}

/// The type here for another format's name of it.
fn elsewhere(name: &str) -> Option<&'static str> {
    let kind = match name.to_lowercase().as_str() {
        "hinge" | "rotary" | "rotational" | "pin" => JointKind::Revolute,
        "slide" | "slider" | "linear" | "translational" => JointKind::Prismatic,
        "weld" | "rigid" | "static" => JointKind::Fixed,
        "ball" => JointKind::Spherical,
        "screw" => JointKind::Helical,
        "cardan" | "hooke" => JointKind::Universal,
        "free" | "freeflyer" => JointKind::Floating,
        _ => return None,
    };
    Some(kind.name())
}

fn reference(joint: &Tag<'_>, which: &str, log: &mut Diagnostics) -> Option<Reference> {
    let drake = if which == "parent" { DRAKE_PARENT } else { DRAKE_CHILD };
    let is_drake = joint.is(DRAKE_JOINT) && !joint.children().any(|tag| tag.is(which)) && joint.children().any(|tag| tag.is(drake));
    let tag = joint.required(if is_drake { drake } else { which }, log)?;
    unused::rest(&tag, &[], &["link"], log);
    Some(Reference { name: tag.required_name("link", log)?, at: tag.at() })
}

fn motion(tag: &Tag<'_>, kind: JointKind, version: Version, joint: &mut DraftJoint, log: &mut Diagnostics) {
    match kind {
        // Drake does not read axes of it: it turns about x, then about y.
        JointKind::Universal if tag.is(DRAKE_JOINT) => {
            ["axis", "axis2"].iter().for_each(|name| report_useless(tag, name, log));
            (joint.axis, joint.second_axis) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        }
        JointKind::Universal => (joint.axis, joint.second_axis) = cross(tag, log),
        kind if kind.has_axis() => {
            let given = tag.only("axis", log);
            if kind == JointKind::Planar && given.is_none() {
                // Other readers then use the joint's own x and y for the plane.
                log.warning(tag.place("axis"), Code::NoAxis, "none", "the normal of the plane: without one it is x, and the plane y and z");
            }
            joint.axis = given.and_then(|tag| axis(&tag, log)).unwrap_or(DEFAULT_AXIS);
        }
        _ => report_useless(tag, "axis", log),
    }
    if kind.has_pitch() {
        joint.pitch = pitch(tag, log).unwrap_or_default();
    }
    if has_one_coordinate(kind) {
        joint.limit = limits::limit(tag, kind, version, log);
    }
    // One coefficient for all rates: N·m·s/rad about each axis, as in Drake.
    let has_dynamics = has_one_coordinate(kind) || matches!(kind, JointKind::Spherical | JointKind::Universal);
    if has_dynamics {
        joint.dynamics = limits::dynamics(tag, log);
    }
    let useless = [
        ("axis2", !kind.has_second_axis()),
        ("thread", !kind.has_pitch() || tag.is(DRAKE_JOINT)),
        (DRAKE_PITCH, !kind.has_pitch() && tag.is(DRAKE_JOINT)),
        ("limit", !has_one_coordinate(kind)),
        ("dynamics", !has_dynamics),
    ];
    useless.iter().filter(|(_, useless)| *useless).for_each(|(name, _)| report_useless(tag, name, log));
    if kind.is_fixed()
        && let Some(mimic) = tag.only("mimic", log)
    {
        mimic.unused(log, mimic.name(), "a fixed joint does not move");
        let expected = "none: a fixed joint does not move, and follows no other; ignored";
        log.warning(mimic.place("mimic"), Code::UnusedMimic, "<mimic> on a fixed joint", expected);
    }
}

fn report_useless(joint: &Tag<'_>, name: &str, log: &mut Diagnostics) {
    if let Some(tag) = joint.only(name, log) {
        tag.unused(log, tag.name(), "a joint of this type has no use for it");
    }
}

/// The direction of `<axis>` or `<axis2>`, if it is valid.
fn axis(tag: &Tag<'_>, log: &mut Diagnostics) -> Option<[f64; 3]> {
    unused::rest(tag, &[], &["xyz"], log);
    tag.required_attribute("xyz", log)?;
    let axis = attribute_list(tag, "xyz", log)?;
    let size = axis.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if AXIS.contains(&size) {
        warn_of_length(tag, axis, size, log);
        return Some(axis);
    }
    let expected = if size == 0.0 { "a vector that is not zero" } else { "a vector of a length that can be squared, 1e-150 to 1e150" };
    log.error(tag.place(&tag.name()), Code::ZeroAxis, shown(axis), expected);
    None
}

/// An axis is printed with three digits at least.
const UNIT_LENGTH: f64 = 1e-3;

fn warn_of_length(tag: &Tag<'_>, axis: [f64; 3], size: f64, log: &mut Diagnostics) {
    let length = size * axis.iter().map(|x| (x / size) * (x / size)).sum::<f64>().sqrt();
    if (length - 1.0).abs() > UNIT_LENGTH {
        let length = if (1e-3..1e6).contains(&length) { format!("{length:.4}") } else { format!("{length:.3e}") };
        let expected = "a vector of length 1: the length of an axis has no meaning; only its direction is used";
        log.warning(tag.place(&tag.name()), Code::AxisLength, format!("{} of length {length}", shown(axis)), expected);
    }
}

fn shown([x, y, z]: [f64; 3]) -> String {
    format!("({x:?} {y:?} {z:?})")
}

/// The two axes of a universal joint. Both are required: a default would be arbitrary.
fn cross(joint: &Tag<'_>, log: &mut Diagnostics) -> ([f64; 3], [f64; 3]) {
    let [first, second] = ["axis", "axis2"].map(|name| joint.required(name, log).and_then(|tag| axis(&tag, log)));
    let (Some(first), Some(second)) = (first, second) else {
        return (DEFAULT_AXIS, DEFAULT_AXIS);
    };
    if sine(first, second) < PARALLEL {
        let found = format!("{}, along the first axis {}", shown(second), shown(first));
        let expected = "a second axis across the first; about one axis, the joint is revolute";
        log.error(joint.place("axis2"), Code::ParallelAxes, found, expected);
    }
    (first, second)
}

/// Two axes are parallel below this sine of their angle.
const PARALLEL: f64 = 1e-6;

/// |a × b| / (|a| |b|) of vectors that are not zero.
fn sine(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [[a, b, c], [x, y, z]] = [a, b].map(|v| {
        let size = v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let v = v.map(|x| x / size);
        let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| x / norm)
    });
    [b * z - c * y, c * x - a * z, a * y - b * x].iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Distance that a helical joint slides in one turn, m; positive for a right-handed thread. Zero is
/// allowed, with a warning.
fn pitch(joint: &Tag<'_>, log: &mut Diagnostics) -> Option<f64> {
    let (name, attribute) = if joint.is(DRAKE_JOINT) { (DRAKE_PITCH, "value") } else { ("thread", "pitch") };
    let tag = joint.required(name, log)?;
    unused::rest(&tag, &[], &[attribute], log);
    let pitch = number::required(&tag, attribute, log)?;
    if pitch == 0.0 {
        let expected = "metres per revolution; without, the joint is revolute; used as written";
        log.warning(tag.place(&format!("{name} {attribute}")), Code::ZeroPitch, "zero", expected);
    }
    Some(pitch)
}
