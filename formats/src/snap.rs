//! Maximum distance of an angle from a multiple of π/2 to be replaced by it.

use articulated_core::description::Description;
use articulated_core::diagnostic::{Code, Diagnostics, Place};

use crate::urdf::right_angle;

/// The largest [`Options::snap_angles`](crate::Options::snap_angles), rad: an angle further from a
/// multiple of π/2 was not meant to be one.
pub const MOST_SNAPPED: f64 = 0.5;

/// Allowed range of [`Options::snap_angles`](crate::Options::snap_angles), for messages.
pub const SNAP_EXPECTED: &str = "a finite number above 0, at most 0.5 rad; leave it out to snap none";

/// Whether [`Options::snap_angles`](crate::Options::snap_angles) may have this value, rad: above 0,
/// at most [`MOST_SNAPPED`].
pub fn can_snap(tolerance: f64) -> bool {
    tolerance > 0.0 && tolerance <= MOST_SNAPPED
}

/// The requested tolerance; an invalid one is an error of the whole document.
pub(crate) fn check(asked: Option<f64>, log: &mut Diagnostics) {
    if let Some(tolerance) = asked.filter(|tolerance| !can_snap(*tolerance)) {
        let place = Place { field: "snap_angles", ..Place::DOCUMENT };
        log.error(place, Code::SnapAngles, format!("{tolerance}"), SNAP_EXPECTED);
    }
}

/// An angle this close, but not equal, to a multiple of π/2 was meant to be one, rad: exporters
/// print five digits and more.
const NEARLY: f64 = 1e-4;

/// Angles of joints that are nearly multiples of π/2 and could be snapped, each with the name of
/// its joint.
pub fn nearly_right_angles(description: &Description) -> Vec<(&str, f64)> {
    let angles = description.joints.iter().flat_map(|joint| joint.origin.rotation.rpy().map(|angle| (joint.name.as_str(), angle)));
    angles.filter(|(_, angle)| right_angle(*angle, NEARLY).is_some()).collect()
}

#[cfg(test)]
mod tests {
    use articulated_core::description::{Joint, Origin};

    use super::*;

    #[test]
    fn angles_that_are_nearly_right_are_listed_with_their_joints() {
        let joint = |name: &str, rpy| Joint { name: name.into(), origin: Origin::new([0.0; 3], rpy), ..Joint::default() };
        let right = std::f64::consts::FRAC_PI_2;
        let printed: f64 = "1.57079632679".parse().unwrap();
        let joints = vec![joint("a", [right, 0.0, -2.0 * right]), joint("b", [printed, 0.1, 0.0]), joint("c", [0.0, 3e-9, 1.5718])];
        let description = Description { joints: joints.into(), ..Description::default() };
        assert_eq!(nearly_right_angles(&description), [("b", printed), ("c", 3e-9)]);
    }

    #[test]
    fn an_angle_may_be_off_by_more_than_nothing_and_no_more_than_the_most() {
        let could = [f64::MIN_POSITIVE, 1e-9, MOST_SNAPPED];
        let could_not = [0.0, -0.0, -1e-9, MOST_SNAPPED * 1.01, f64::INFINITY, f64::NAN];
        assert!(could.into_iter().all(can_snap) && !could_not.into_iter().any(can_snap));
        assert!(SNAP_EXPECTED.contains(&format!("above 0, at most {MOST_SNAPPED} rad;")));
    }
}
