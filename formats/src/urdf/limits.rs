//! The tags `<limit>` and `<dynamics>` of a joint with one coordinate.

use articulated_core::diagnostic::{Code, Diagnostics};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use articulated_core::description::{JointDynamics, JointKind, Limit};

use super::ast::DRAKE_JOINT;
use super::robot::Version;
use super::unused;
use crate::xml::element::Tag;
use crate::xml::number::attribute;

const BOUNDS: [&str; 2] = ["lower", "upper"];

/// The joint's `<limit>`.
pub(crate) fn limit(joint: &Tag<'_>, kind: JointKind, version: Version, log: &mut Diagnostics) -> Option<Limit> {
    // Bounds that are left out are infinite, not zero.
    let open = version >= Version::V1_2;
    let Some(tag) = joint.only("limit", log) else {
        report_missing(joint, kind, log);
        return None;
    };
    let known = ["lower", "upper", "effort", "velocity", DRAKE_ACCELERATION, "acceleration", "deceleration", "jerk"];
    // Before version 1.2 they are no part of the format.
    unused::rest(&tag, &[], if open { &known } else { &known[..5] }, log);
    let (lower, upper) = match kind {
        JointKind::Continuous => without_bounds(&tag, log),
        _ => bounds(&tag, open, log),
    };
    warn_of_degrees(&tag, kind, lower.abs().max(upper.abs()), log);
    let effort = positive(&tag, "effort", open, log);
    let velocity = positive(&tag, "velocity", open, log);
    let mut further = |name: &str| {
        attribute(&tag, name, log).inspect(|value| report_negative(&tag, &format!("limit {name}"), *value, log)).unwrap_or(f64::INFINITY)
    };
    let from_drake = further(DRAKE_ACCELERATION);
    let [acceleration, deceleration, jerk] = if open { LATER.map(further) } else { [f64::INFINITY; 3] };
    Some(Limit { lower, upper, effort, velocity, acceleration: acceleration.min(from_drake), deceleration, jerk })
}

/// Bounds that version 1.2 adds; a missing one is infinite.
const LATER: [&str; 3] = ["acceleration", "deceleration", "jerk"];
/// The name of the first one in Drake, in all versions.
const DRAKE_ACCELERATION: &str = "drake:acceleration";

fn report_missing(joint: &Tag<'_>, kind: JointKind, log: &mut Diagnostics) {
    // Drake does not require it for its own types.
    if kind.has_bounds() && !joint.is(DRAKE_JOINT) {
        let expected = "<limit> for a revolute, helical or prismatic joint; taken as without limits";
        log.warning(joint.place("limit"), Code::LimitMissing, "none", expected);
    }
}

fn without_bounds(tag: &Tag<'_>, log: &mut Diagnostics) -> (f64, f64) {
    for name in BOUNDS.into_iter().filter(|name| tag.attribute(name).is_some()) {
        tag.unused(log, format!("limit {name}"), "a continuous joint has no bounds");
    }
    (f64::NEG_INFINITY, f64::INFINITY)
}

fn bounds(tag: &Tag<'_>, open: bool, log: &mut Diagnostics) -> (f64, f64) {
    let [lower, upper] = BOUNDS.map(|name| attribute(tag, name, log));
    let absent = BOUNDS.map(|name| tag.attribute(name).is_none());
    if absent == [true, true] && !open {
        let expected = "lower and upper; taken as zero, as the format has it";
        log.warning(tag.place("limit"), Code::LimitIncomplete, "no bounds", expected);
    }
    let (lowest, highest) = if open { (f64::NEG_INFINITY, f64::INFINITY) } else { (0.0, 0.0) };
    let (lower, upper) = (lower.unwrap_or(lowest), upper.unwrap_or(highest));
    if lower > upper {
        let found = format!("lower {lower} above upper {upper}");
        log.warning(tag.place("limit"), Code::LimitOrder, found, "lower below upper; used as written");
    } else if lower == upper && absent != [true, true] {
        let expected = "lower below upper: such a joint cannot move; used as written";
        log.warning(tag.place("limit"), Code::LimitEqual, format!("lower and upper both {lower}"), expected);
    }
    (lower, upper)
}

/// Bounds of a joint that turns, from more than three turns in rad to three turns in degrees:
/// usually degrees.
const DEGREES: RangeInclusive<f64> = 20.0..=1080.0;

fn warn_of_degrees(tag: &Tag<'_>, kind: JointKind, bound: f64, log: &mut Diagnostics) {
    if kind == JointKind::Revolute && DEGREES.contains(&bound) {
        let found = format!("a bound of {bound}, {:.1} turns", bound / TAU);
        log.warning(tag.place("limit"), Code::MoreThanATurn, found, "rad, of which 180° are 3.141592653589793; used as written");
    }
}

fn positive(tag: &Tag<'_>, name: &str, open: bool, log: &mut Diagnostics) -> f64 {
    let field = format!("limit {name}");
    match attribute(tag, name, log) {
        Some(value) => {
            report_negative(tag, &field, value, log);
            if value == 0.0 {
                let expected = "a value above zero; leave it out where there is no limit; used as written";
                log.warning(tag.place(&field), Code::LimitZero, "zero", expected);
            }
            value
        }
        None if tag.attribute(name).is_none() && !open => {
            log.warning(tag.place(&field), Code::LimitIncomplete, "none", "a value; taken as without limit");
            f64::INFINITY
        }
        None => f64::INFINITY,
    }
}

fn report_negative(tag: &Tag<'_>, field: &str, value: f64, log: &mut Diagnostics) {
    if value < 0.0 {
        let expected = "zero or more; used as written";
        log.warning(tag.place(field), Code::Negative, format!("a negative value, {value}"), expected);
    }
}

/// The coefficients of the joint's `<dynamics>`; those that the tag leaves out are zero.
pub(crate) fn dynamics(joint: &Tag<'_>, log: &mut Diagnostics) -> JointDynamics {
    let Some(tag) = joint.only("dynamics", log) else { return JointDynamics::default() };
    unused::rest(&tag, &[], &["damping", "friction"], log);
    let [damping, friction] = ["damping", "friction"].map(|name| Some(coefficient(&tag, name, log)));
    JointDynamics { damping, friction, ..JointDynamics::default() }
}

fn coefficient(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> f64 {
    let field = format!("dynamics {name}");
    if tag.attribute(name).is_some() {
        tag.unused(log, field.clone(), "kept for scenes that turn on damping or friction; no part of the rigid-body dynamics");
    }
    let value = attribute(tag, name, log).unwrap_or(0.0);
    report_negative(tag, &field, value, log);
    value
}
