//! The tag `<origin>`.

use articulated_core::diagnostic::{Code, Diagnostics, Place, quote};
use std::f64::consts::{FRAC_PI_2, TAU};

use articulated_core::description::{Origin, Rotation};

use super::robot::{Context, Version};
use super::unused;
use crate::xml::element::Tag;
use crate::xml::number::{attribute_list, silently};

/// The `<origin>` inside a tag; a missing tag or attribute means zero.
pub(crate) fn origin(parent: &Tag<'_>, context: &Context<'_>, log: &mut Diagnostics) -> Origin {
    let Some(tag) = parent.only("origin", log) else {
        return Origin::default();
    };
    unused::rest(&tag, &[], &["xyz", "rpy", "quat_xyzw"], log);
    let xyz = attribute_list(&tag, "xyz", log).unwrap_or_default();
    let rpy = attribute_list(&tag, "rpy", log).unwrap_or_default();
    warn_of_turns(&tag, rpy, log);
    warn_of_lengths(&tag, xyz, log);
    let (rotation, field) = match quaternion(&tag, context.version, log) {
        Some(quaternion) => (Rotation::Quaternion(quaternion), "origin quat_xyzw"),
        None => (Rotation::RollPitchYaw(rpy), "origin rpy"),
    };
    Origin { xyz, rotation: snapped(rotation, context.options.snap_angles, &tag.place(field), log) }
}

/// See [`Context::length`].
pub(crate) fn longest(robot: &Tag<'_>) -> f64 {
    let inside =
        |tag: &Tag<'_>, name: &str| -> Vec<_> { tag.children().filter(|child| child.is(name)).map(|c| silently(&c, "xyz")).collect() };
    let longest = robot.children().flat_map(|tag| {
        let holders: Vec<_> = if tag.is("joint") { vec![tag] } else { tag.children().filter(|child| child.is("inertial")).collect() };
        holders.into_iter().flat_map(|holder| inside(&holder, "origin")).collect::<Vec<_>>()
    });
    let longest = longest.flatten().map(|xyz: [f64; 3]| xyz.iter().fold(0.0, |most: f64, x| most.max(x.abs()))).fold(0.0, f64::max);
    if longest == 0.0 { 1.0 } else { longest.min(1.0) }
}

/// A quaternion with a norm further from 1 is an error.
const NORM: f64 = 1e-3;
/// A quaternion with a norm further from 1 is a warning.
const ROUNDED: f64 = 1e-6;

/// The quaternion (x, y, z, w) of `quat_xyzw`, if it is valid. Its norm may differ from 1 by
/// rounding.
fn quaternion(tag: &Tag<'_>, version: Version, log: &mut Diagnostics) -> Option<[f64; 4]> {
    let quaternion = attribute_list::<4>(tag, "quat_xyzw", log);
    let (text, _) = tag.attribute("quat_xyzw")?;
    let place = tag.place("origin quat_xyzw");
    if version < Version::V1_1 {
        let expected = "rpy, or <robot version=\"1.1\">: older versions of the format have no quaternions";
        log.error(place, Code::Unsupported, format!("a quaternion, {}", quote(text)), expected);
        return None;
    }
    if tag.attribute("rpy").is_some() {
        log.error(place, Code::TwoRotations, "a quaternion beside rpy", "one of both");
        return None;
    }
    let quaternion = quaternion?;
    let size = quaternion.iter().fold(0.0, |most: f64, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
    let norm = size * quaternion.iter().map(|x| (x / size) * (x / size)).sum::<f64>().sqrt();
    let off = (norm - 1.0).abs();
    if off > NORM {
        log.error(place, Code::QuaternionNorm, format!("the norm {norm}"), format!("1, within {NORM}"));
        return None;
    }
    if off > ROUNDED {
        log.warning(place, Code::QuaternionNorm, format!("the norm {norm}"), format!("1, within {ROUNDED}; used as if it were 1"));
    }
    Some(quaternion)
}

/// Larger angles, rad, are usually errors: degrees, most often.
const TURN: f64 = 1.001 * TAU;

fn warn_of_turns(tag: &Tag<'_>, rpy: [f64; 3], log: &mut Diagnostics) {
    if let Some(angle) = rpy.into_iter().find(|angle| angle.abs() > TURN) {
        let expected = "rad, of which 90° are 1.5707963267948966; used as written";
        log.warning(tag.place("origin rpy"), Code::MoreThanATurn, format!("{angle}, more than a turn"), expected);
    }
}

/// Lengths from one frame to the next from here on, m, are usually errors: millimetres, most often.
const FAR: f64 = 100.0;

fn warn_of_lengths(tag: &Tag<'_>, xyz: [f64; 3], log: &mut Diagnostics) {
    if let Some(length) = xyz.into_iter().find(|length| length.abs() >= FAR) {
        let expected = "m, of which 1 mm is 0.001; used as written";
        log.warning(tag.place("origin xyz"), Code::Units, format!("{length} m, more than any link is long"), expected);
    }
}

/// The rotation with angles near a multiple of π/2 replaced by that multiple. A rotation without
/// such angles keeps its form.
fn snapped(rotation: Rotation, snap: Option<f64>, place: &Place<'_>, log: &mut Diagnostics) -> Rotation {
    let Some(tolerance) = snap else {
        return rotation;
    };
    let rpy = rotation.rpy();
    let snapped = rpy.map(|angle| match right_angle(angle, tolerance) {
        Some((quarters, exact)) => {
            log.replaced(place, Code::Snapped, angle, &format!("{quarters}·π/2"));
            exact
        }
        None => angle,
    });
    if snapped == rpy { rotation } else { Rotation::RollPitchYaw(snapped) }
}

/// The multiple of π/2 (and its double) that is within `tolerance` of `angle` and is not `angle`
/// itself.
pub(crate) fn right_angle(angle: f64, tolerance: f64) -> Option<(f64, f64)> {
    let quarters = (angle / FRAC_PI_2).round();
    let exact = quarters * FRAC_PI_2;
    let near = (angle - exact).abs() <= tolerance && quarters.abs() <= 1e3;
    (near && exact != angle).then_some((quarters, exact))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn only_what_is_within_the_tolerance_snaps() {
        assert_eq!(right_angle(FRAC_PI_2 + 4e-6, 1e-5), Some((1.0, FRAC_PI_2)));
        assert_eq!(right_angle(4e-6 - PI, 1e-5), Some((-2.0, -PI)));
        assert_eq!(right_angle(50.0 * FRAC_PI_2 + 4e-6, 1e-5), Some((50.0, 50.0 * FRAC_PI_2)));
        assert_eq!(right_angle(1e-7, 1e-5), Some((0.0, 0.0)));
        assert_eq!(right_angle(FRAC_PI_2 + 4e-6, 1e-6), None);
        assert_eq!(right_angle(FRAC_PI_2, 1e-5), None);
        assert_eq!(right_angle(0.0, 1e-5), None);
        assert_eq!(right_angle(FRAC_PI_2 + 4e-6, f64::NAN), None);
        assert_eq!(right_angle(1e300, 1.0), None);
        // Beyond 250 turns an angle is an error of another kind.
        assert_eq!(right_angle(1000.0 * FRAC_PI_2 + 1e-6, 1e-5), Some((1000.0, 1000.0 * FRAC_PI_2)));
        assert_eq!(right_angle(1001.0 * FRAC_PI_2 + 1e-6, 1e-5), None);
    }
}
