//! Joints as the file writes them.

use std::f64::consts::TAU;

use articulated_core::description::{JointDynamics, JointKind, Limit};
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::suggest::Suggester;

use super::grammar::{DYNAMICS, subject};
use super::names::{Reference, Version, WORLD_NAME};
use super::values::{bound, exactly, name, number, only, yes};
use crate::pose::Vector;
use crate::xml::tree::Element;

/// The types of the format.
const TYPES: [(&str, Type); 9] = [
    ("revolute", Type::Revolute),
    ("continuous", Type::Continuous),
    ("prismatic", Type::Prismatic),
    ("fixed", Type::Fixed),
    ("ball", Type::Ball),
    ("universal", Type::Universal),
    ("revolute2", Type::Revolute2),
    ("screw", Type::Screw),
    ("gearbox", Type::Gearbox),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Type {
    Revolute,
    Continuous,
    Prismatic,
    Fixed,
    Ball,
    Universal,
    Revolute2,
    Screw,
    Gearbox,
}

impl Type {
    /// How many axes it has.
    pub(crate) fn axes(self) -> usize {
        match self {
            // A gearbox is read only if it is cut.
            Self::Fixed | Self::Ball | Self::Gearbox => 0,
            Self::Universal | Self::Revolute2 => 2,
            Self::Revolute | Self::Continuous | Self::Prismatic | Self::Screw => 1,
        }
    }
}

pub(crate) struct Joint<'a> {
    pub(crate) element: &'a Element,
    pub(crate) node: usize,
    pub(crate) kind: Type,
    pub(crate) parent: Reference<'a>,
    /// The node of the parent; the world until names are resolved.
    pub(crate) parent_node: usize,
    pub(crate) child: Reference<'a>,
    pub(crate) axes: Vec<Axis<'a>>,
    /// For a screw, m per revolution.
    pub(crate) pitch: f64,
    /// Whether the file cuts the tree here.
    pub(crate) is_cut: bool,
}

/// Data of each axis of a joint.
pub(crate) struct Axis<'a> {
    pub(crate) element: &'a Element,
    /// In the frame of `expressed_in`, or of the joint.
    pub(crate) direction: Vector,
    pub(crate) expressed_in: Option<Reference<'a>>,
    /// The node of `expressed_in`, when names are resolved.
    pub(crate) frame: Option<usize>,
    pub(crate) kind: JointKind,
    pub(crate) limit: Option<Limit>,
    pub(crate) dynamics: JointDynamics,
    pub(crate) mimic: Option<Mimic<'a>>,
}

impl Axis<'_> {
    /// Whether it has only a direction.
    pub(crate) fn is_plain(&self) -> bool {
        self.limit.is_none() && self.dynamics == JointDynamics::default() && self.mimic.is_none()
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Mimic<'a> {
    pub(crate) leader: Reference<'a>,
    /// Index of the leader's axis, from 0.
    pub(crate) axis: usize,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

/// A joint; `None` if it has too many errors.
pub(crate) fn joint<'a>(
    element: &'a Element,
    scope: usize,
    version: Version,
    suggester: &mut Suggester,
    log: &mut Diagnostics,
) -> Option<Joint<'a>> {
    let about = &subject(element);
    let end = |field: &'static str, log: &mut Diagnostics| {
        let (element, name) = name(element, field, about, log)?;
        Some(Reference { element, field, name, scope })
    };
    let (parent, child) = (end("parent", log), end("child", log));
    let physics = only(element, "physics", about, log).and_then(|physics| only(physics, "simbody", about, log));
    let is_cut = physics.and_then(|simbody| yes(simbody, "must_be_loop_joint", about, log)).unwrap_or(false);
    let kind = kind(element, is_cut, about, suggester, log);
    if let Some(child) = child.filter(|child| child.name == WORLD_NAME) {
        let expected = "a link: the world is a parent, never a child";
        child.element.error((about, "child"), Code::UnknownLink, quote(WORLD_NAME), expected, log);
        return None;
    }
    if parent.zip(child).is_some_and(|(parent, child)| parent.name == child.name) {
        let found = format!("{}, which is the parent too", quote(child.map_or("", |child| child.name)));
        element.error((about, "child"), Code::Ring, found, "two links", log);
        return None;
    }
    let kind = kind?;
    let (mut axes, mut is_good) = (Vec::new(), true);
    for field in ["axis", "axis2"].into_iter().take(kind.axes()) {
        let Some(tag) = only(element, field, about, log) else {
            element.error((about, field), Code::MissingTag, "none", format!("<{field}> inside <joint>"), log);
            is_good = false;
            continue;
        };
        match axis(tag, kind, scope, version, about, log) {
            Some(axis) => axes.push(axis),
            None => is_good = false,
        }
    }
    for field in ["axis", "axis2"].into_iter().skip(kind.axes()) {
        if let Some(tag) = only(element, field, about, log) {
            tag.unused(about, None, "the joint has no such axis", log);
        }
    }
    let pitch = pitch(element, kind, about, log);
    if let [axis] = axes.as_mut_slice() {
        axis.dynamics.armature = armature(element, about, log);
    } else {
        let rotor = element.children.iter().filter(|child| ROTOR.contains(&child.name.as_str()));
        rotor.for_each(|tag| tag.unused(about, None, "a joint of one axis alone has a rotor", log));
    }
    is_good.then_some(Joint { element, node: 0, kind, parent: parent?, parent_node: 0, child: child?, axes, pitch, is_cut })
}

/// The inertia of a rotor about its own axis, kg·m², and its gear ratio, as Drake has them.
const ROTOR: [&str; 2] = ["drake:rotor_inertia", "drake:gear_ratio"];

/// The inertia of the rotor, seen behind its gear.
fn armature(element: &Element, about: &Subject, log: &mut Diagnostics) -> Option<f64> {
    let [inertia, gear] = ROTOR.map(|name| number(element, name, about, log));
    let tag = element.children.iter().find(|child| child.is(ROTOR[0]))?;
    let (inertia, gear) = (inertia?, gear.unwrap_or(1.0));
    if inertia < 0.0 || gear == 0.0 {
        let found = format!("the inertia {inertia} behind the gear ratio {gear}");
        let expected = "an inertia of at least 0 and a gear ratio other than 0: the inertia of the rotor is not used";
        tag.warning((about, ROTOR[0]), Code::Negative, found, expected, log);
        return None;
    }
    tag.unused_part(about, (None, "joint armature".to_owned()), DYNAMICS, log);
    Some(inertia * gear * gear)
}

fn kind(element: &Element, is_cut: bool, about: &Subject, suggester: &mut Suggester, log: &mut Diagnostics) -> Option<Type> {
    let Some(name) = element.text("type") else {
        element.error((about, "type"), Code::MissingAttribute, "none", "the attribute type in <joint>", log);
        return None;
    };
    let names = TYPES.iter().map(|(name, _)| *name);
    let found = TYPES.iter().find(|(own, _)| *own == name).map(|(_, kind)| *kind);
    match found {
        None => {
            let near = suggester.nearest(name, names.clone()).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
            let expected = format!("one of {}{near}", names.collect::<Vec<_>>().join(", "));
            element.error((about, "type"), Code::UnknownJointType, format!("the type {}", quote(name)), expected, log);
        }
        Some(Type::Gearbox) if !is_cut => {
            let expected = "two revolute joints, of which one follows the other: <mimic> inside its <axis>; \
                            <physics><simbody><must_be_loop_joint>true leaves this joint out";
            element.error((about, "type"), Code::Unsupported, "a gearbox, which couples two joints", expected, log);
            return None;
        }
        Some(_) => {}
    }
    found
}

/// m per revolution.
fn pitch(element: &Element, kind: Type, about: &Subject, log: &mut Diagnostics) -> f64 {
    /// The format's default.
    const DEFAULT: f64 = 1.0;
    let tags = ["screw_thread_pitch", "thread_pitch"];
    let given = tags.iter().filter_map(|name| element.children.iter().find(|child| child.is(name)));
    if kind != Type::Screw {
        given.for_each(|tag| tag.unused(about, None, "it belongs to joints of the type screw", log));
        return 0.0;
    }
    let pitch = match (number(element, tags[0], about, log), number(element, tags[1], about, log)) {
        (Some(pitch), old) => {
            if old.is_some() {
                given.skip(1).for_each(|tag| tag.unused(about, None, "screw_thread_pitch says more", log));
            }
            pitch
        }
        // rad/m, positive for a left-handed thread.
        (None, Some(old)) => -TAU / old,
        (None, None) => {
            if given.count() == 0 {
                let expected = "<screw_thread_pitch> inside <joint>: the format's default is used, 1 m per revolution";
                element.warning((about, "screw_thread_pitch"), Code::MissingTag, "none", expected, log);
            }
            DEFAULT
        }
    };
    if pitch == 0.0 || !pitch.is_finite() {
        let expected = "a pitch that is neither zero nor infinite";
        element.error((about, "screw_thread_pitch"), Code::ZeroPitch, format!("{pitch} m per revolution"), expected, log);
    }
    pitch
}

/// Sizes of axes that can be squared: a smaller one underflows, and a larger one overflows.
const SIZES: std::ops::RangeInclusive<f64> = 1e-150..=1e150;

fn axis<'a>(tag: &'a Element, kind: Type, scope: usize, version: Version, about: &Subject, log: &mut Diagnostics) -> Option<Axis<'a>> {
    let xyz = only(tag, "xyz", about, log);
    let direction = match xyz {
        Some(xyz) => exactly::<3>(xyz, about, log)?,
        None => [0.0, 0.0, 1.0],
    };
    if !SIZES.contains(&direction.iter().fold(0.0_f64, |most, x| most.max(x.abs()))) {
        let [x, y, z] = direction;
        xyz.unwrap_or(tag).error((about, "xyz"), Code::ZeroAxis, format!("({x:?} {y:?} {z:?})"), "a vector that is not zero", log);
        return None;
    }
    let limit = limit(tag, kind, about, log);
    let has_bounds = limit.is_some_and(|limit| limit.lower.is_finite() || limit.upper.is_finite());
    let is_turn = !matches!(kind, Type::Prismatic | Type::Screw);
    let kind = match kind {
        Type::Prismatic => JointKind::Prismatic,
        Type::Screw => JointKind::Helical,
        _ if is_turn && has_bounds => JointKind::Revolute,
        _ => JointKind::Continuous,
    };
    Some(Axis {
        element: tag,
        direction,
        expressed_in: expressed_in(tag, xyz, scope, version, about, log),
        frame: None,
        kind,
        limit,
        dynamics: dynamics(tag, about, log),
        mimic: mimic(tag, scope, about, log),
    })
}

fn expressed_in<'a>(
    tag: &'a Element,
    xyz: Option<&'a Element>,
    scope: usize,
    version: Version,
    about: &Subject,
    log: &mut Diagnostics,
) -> Option<Reference<'a>> {
    const FLAG: &str = "use_parent_model_frame";
    let model = |element: &'a Element| Reference { element, field: FLAG, name: "__model__", scope };
    let in_model = yes(tag, FLAG, about, log);
    let own = only(tag, FLAG, about, log).unwrap_or(tag);
    if version < Version::V1_5 {
        // The older versions know no other frame.
        if in_model == Some(false) {
            own.unused(about, None, "up to version 1.4 the axis is in the frame of the model", log);
        }
        return Some(model(tag));
    }
    if version >= Version::V1_7 && in_model.is_some() {
        own.unused(about, None, "since version 1.7 expressed_in of <xyz> says it", log);
    } else if in_model == Some(true) {
        return Some(model(own));
    }
    let element = xyz?;
    let name = element.text("expressed_in").map(str::trim).filter(|name| !name.is_empty())?;
    Some(Reference { element, field: "expressed_in", name, scope })
}

fn limit(axis: &Element, kind: Type, about: &Subject, log: &mut Diagnostics) -> Option<Limit> {
    let tag = only(axis, "limit", about, log)?;
    let [lower, upper] = ["lower", "upper"].map(|name| bound(tag, name, about, log));
    let mut limit = Limit { lower: lower.unwrap_or(f64::NEG_INFINITY), upper: upper.unwrap_or(f64::INFINITY), ..Limit::NONE };
    if kind == Type::Continuous {
        for child in tag.children.iter().filter(|child| child.is("lower") || child.is("upper")) {
            child.unused(about, None, "a continuous joint has no bounds", log);
        }
        (limit.lower, limit.upper) = (f64::NEG_INFINITY, f64::INFINITY);
    }
    if limit.lower > limit.upper {
        let found = format!("lower {} above upper {}", limit.lower, limit.upper);
        tag.warning((about, "limit"), Code::LimitOrder, found, "lower below upper; used as written", log);
    } else if limit.lower == limit.upper {
        let expected = "lower below upper: such a joint cannot move; used as written";
        tag.warning((about, "limit"), Code::LimitEqual, format!("lower and upper both {}", limit.lower), expected, log);
    }
    // A negative bound means no bound.
    let mut most = |name: &str| bound(tag, name, about, log).filter(|most| *most >= 0.0).unwrap_or(f64::INFINITY);
    (limit.effort, limit.velocity) = (most("effort"), most("velocity"));
    for (name, value) in [("effort", limit.effort), ("velocity", limit.velocity)] {
        if value == 0.0 {
            let expected = "a value above zero; leave it out where there is no limit; used as written";
            tag.warning((about, name), Code::LimitZero, "zero", expected, log);
        }
    }
    (limit != Limit::NONE).then_some(limit)
}

fn dynamics(axis: &Element, about: &Subject, log: &mut Diagnostics) -> JointDynamics {
    let Some(tag) = only(axis, "dynamics", about, log) else { return JointDynamics::default() };
    let [damping, friction, stiffness, rest] =
        ["damping", "friction", "spring_stiffness", "spring_reference"].map(|name| number(tag, name, about, log));
    for (name, value) in [("damping", damping), ("friction", friction), ("spring_stiffness", stiffness)] {
        if value.is_some_and(|value| value < 0.0) {
            let found = format!("a negative value, {}", value.unwrap_or_default());
            tag.warning((about, name), Code::Negative, found, "zero or more; used as written", log);
        }
    }
    JointDynamics { damping, friction, stiffness, rest: rest.filter(|_| stiffness.is_some()), ..JointDynamics::default() }
}

fn mimic<'a>(axis: &'a Element, scope: usize, about: &Subject, log: &mut Diagnostics) -> Option<Mimic<'a>> {
    let tag = only(axis, "mimic", about, log)?;
    let Some(name) = tag.text("joint").map(str::trim).filter(|name| !name.is_empty()) else {
        tag.error((about, "mimic"), Code::MissingAttribute, "none", "the attribute joint in <mimic>", log);
        return None;
    };
    let leads = match tag.text("axis").map_or("axis", str::trim) {
        "axis" => 0,
        "axis2" => 1,
        other => {
            tag.error((about, "axis"), Code::Word, quote(other), "axis or axis2", log);
            0
        }
    };
    let [multiplier, offset, reference] = ["multiplier", "offset", "reference"].map(|name| number(tag, name, about, log));
    let multiplier = multiplier.unwrap_or(1.0);
    if multiplier == 0.0 {
        let expected = "another number: with 0 the joint does not move; used as written";
        tag.warning((about, "mimic"), Code::MimicZero, "the multiplier 0", expected, log);
    }
    let offset = offset.unwrap_or(0.0) - reference.map_or(0.0, |reference| multiplier * reference);
    if !offset.is_finite() {
        tag.error((about, "mimic"), Code::NotFinite, format!("{offset}"), "a finite offset", log);
    }
    let leader = Reference { element: tag, field: "joint", name, scope };
    Some(Mimic { leader, axis: leads, multiplier, offset })
}
