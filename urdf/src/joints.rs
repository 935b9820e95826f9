//! The tag `<joint>`.

use articulated_core::description::JointKind;

use crate::draft::{DraftJoint, DraftMimic, Reference, has_one_coordinate};
use crate::element::Tag;
use crate::log::{Log, Place};
use crate::number::{attribute, attribute_list};
use crate::problem::{Kind, Subject, quote};
use crate::{Options, frame, limits, suggest, unused};

const KINDS: [(&str, JointKind); 6] = [
    ("revolute", JointKind::Revolute),
    ("continuous", JointKind::Continuous),
    ("prismatic", JointKind::Prismatic),
    ("fixed", JointKind::Fixed),
    ("floating", JointKind::Floating),
    ("planar", JointKind::Planar),
];

const TAGS: [&str; 7] = ["origin", "parent", "child", "axis", "limit", "dynamics", "mimic"];

/// The axis of a joint that does not give one.
const DEFAULT_AXIS: [f64; 3] = [1.0, 0.0, 0.0];

/// Components beyond cannot be squared: nothing is left of such an axis, or it overflows.
const AXIS: std::ops::RangeInclusive<f64> = 1e-150..=1e150;

/// A joint as it stands in the file. `open`: see [`limits::limit`].
pub(crate) fn joint(tag: &Tag<'_>, open: bool, options: &Options, log: &mut Log) -> DraftJoint {
    let subject = Subject::Joint(tag.name_for_messages());
    let tag = tag.of(&subject);
    let name = tag.required_name("name", log);
    unused::rest(&tag, &TAGS, &["name", "type"], log);
    let kind = kind(&tag, log);
    let mut joint = DraftJoint {
        name,
        line: tag.line(),
        kind,
        parent: reference(&tag, "parent", log),
        child: reference(&tag, "child", log),
        origin: frame::origin(&tag, options.snap_angles, log),
        axis: DEFAULT_AXIS,
        mimic: mimic(&tag, log),
        limit: None,
        dynamics: None,
    };
    if let Some(kind) = kind {
        motion(&tag, kind, open, &mut joint, log);
    }
    joint
}

fn kind(tag: &Tag<'_>, log: &mut Log) -> Option<JointKind> {
    let (name, line) = tag.required_attribute("type", log)?;
    let kind = KINDS.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind);
    if kind.is_none() {
        let hint = suggest::Suggester::new().hint(name, KINDS.iter().map(|(known, _)| *known));
        let expected = format!("revolute, continuous, prismatic, fixed, floating or planar{hint}");
        let place = Place { line: Some(line), ..tag.place("type") };
        log.error(&place, Kind::UnknownJointType, format!("the type {}", quote(name)), expected);
    }
    kind
}

fn reference(joint: &Tag<'_>, which: &str, log: &mut Log) -> Option<Reference> {
    let tag = joint.required(which, log)?;
    unused::rest(&tag, &[], &["link"], log);
    Some(Reference { name: tag.required_name("link", log)?, line: tag.line() })
}

fn motion(tag: &Tag<'_>, kind: JointKind, open: bool, joint: &mut DraftJoint, log: &mut Log) {
    if matches!(kind, JointKind::Fixed | JointKind::Floating) {
        report_useless(tag, &["axis"], log);
    } else {
        joint.axis = axis(tag, log);
    }
    if has_one_coordinate(kind) {
        joint.limit = limits::limit(tag, kind, open, log);
        joint.dynamics = limits::dynamics(tag, log);
    } else {
        report_useless(tag, &["limit", "dynamics"], log);
    }
}

fn report_useless(joint: &Tag<'_>, names: &[&str], log: &mut Log) {
    for tag in names.iter().filter_map(|name| joint.only(name, log)).collect::<Vec<_>>() {
        log.unused(&tag, tag.name(), "a joint of this type has no use for it");
    }
}

fn axis(joint: &Tag<'_>, log: &mut Log) -> [f64; 3] {
    let Some(tag) = joint.only("axis", log) else {
        return DEFAULT_AXIS;
    };
    unused::rest(&tag, &[], &["xyz"], log);
    tag.required_attribute("xyz", log);
    let axis = attribute_list(&tag, "xyz", log).unwrap_or(DEFAULT_AXIS);
    let size = axis.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if !AXIS.contains(&size) {
        let [x, y, z] = axis;
        let expected = match size > 1.0 {
            true => "a vector of a length that can be squared",
            false => "a vector that is not zero",
        };
        log.error(&tag.place("axis"), Kind::ZeroAxis, format!("({x:?} {y:?} {z:?})"), expected);
        return DEFAULT_AXIS;
    }
    axis
}

fn mimic(joint: &Tag<'_>, log: &mut Log) -> Option<DraftMimic> {
    let tag = joint.only("mimic", log)?;
    unused::rest(&tag, &[], &["joint", "multiplier", "offset"], log);
    let multiplier = attribute(&tag, "multiplier", log);
    let offset = attribute(&tag, "offset", log);
    let name = tag.required_name("joint", log)?;
    Some(DraftMimic { leader: Reference { name, line: tag.line() }, multiplier, offset })
}
