//! The tag `<origin>`.

use std::f64::consts::{FRAC_PI_2, TAU};

use articulated_core::description::Origin;

use crate::element::Tag;
use crate::log::Log;
use crate::number::attribute_list;
use crate::problem::{Kind, quote};
use crate::unused;

/// The `<origin>` inside a tag; no tag or attribute stands for zero.
pub(crate) fn origin(parent: &Tag<'_>, snap: Option<f64>, log: &mut Log) -> Origin {
    let Some(tag) = parent.only("origin", log) else {
        return Origin::default();
    };
    refuse_quaternion(&tag, log);
    unused::rest(&tag, &[], &["xyz", "rpy", "quat_xyzw"], log);
    let xyz = attribute_list(&tag, "xyz", log).unwrap_or_default();
    let rpy = attribute_list(&tag, "rpy", log).unwrap_or_default();
    warn_of_turns(&tag, rpy, log);
    warn_of_lengths(&tag, xyz, log);
    Origin { xyz, rpy: snapped(rpy, snap, &tag, log) }
}

/// So many rad and more are written by mistake: degrees, most often.
const TURN: f64 = 1.001 * TAU;

fn warn_of_turns(tag: &Tag<'_>, rpy: [f64; 3], log: &mut Log) {
    if let Some(angle) = rpy.into_iter().find(|angle| angle.abs() > TURN) {
        let expected = "rad, of which 90° are 1.5707963267948966; used as written";
        log.warning(&tag.place("origin rpy"), Kind::MoreThanATurn, format!("{angle}, more than a turn"), expected);
    }
}

/// So many metres and more from one frame to the next are written by mistake: millimetres, most often.
const FAR: f64 = 100.0;

fn warn_of_lengths(tag: &Tag<'_>, xyz: [f64; 3], log: &mut Log) {
    if let Some(length) = xyz.into_iter().find(|length| length.abs() >= FAR) {
        let expected = "m, of which 1 mm is 0.001; used as written";
        log.warning(&tag.place("origin xyz"), Kind::Units, format!("{length} m, more than any link is long"), expected);
    }
}

/// Left out, it would be another robot.
fn refuse_quaternion(tag: &Tag<'_>, log: &mut Log) {
    if let Some((value, _)) = tag.attribute("quat_xyzw") {
        let place = tag.place("origin quat_xyzw");
        log.error(&place, Kind::Unsupported, format!("a quaternion, {}", quote(value)), "the rotation as rpy");
    }
}

fn snapped(rpy: [f64; 3], snap: Option<f64>, tag: &Tag<'_>, log: &mut Log) -> [f64; 3] {
    let Some(tolerance) = snap else {
        return rpy;
    };
    rpy.map(|angle| match right_angle(angle, tolerance) {
        Some((quarters, exact)) => {
            log.snapped(&tag.place("origin rpy"), angle, &format!("{quarters}·π/2"));
            exact
        }
        None => angle,
    })
}

/// The multiple of π/2 (and its double) that is within `tolerance` of `angle` and is not `angle` itself.
fn right_angle(angle: f64, tolerance: f64) -> Option<(f64, f64)> {
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
        // Beyond 250 turns an angle is a mistake of another sort.
        assert_eq!(right_angle(1000.0 * FRAC_PI_2 + 1e-6, 1e-5), Some((1000.0, 1000.0 * FRAC_PI_2)));
        assert_eq!(right_angle(1001.0 * FRAC_PI_2 + 1e-6, 1e-5), None);
    }
}
