//! How near an angle has to be to a multiple of π/2 to be taken as that.

use crate::log::{Log, Place};
use crate::problem::Kind;

/// The largest [`Options::snap_angles`](crate::Options::snap_angles), rad: an angle that is farther from a multiple of π/2 was not meant to be one.
pub const MOST_SNAPPED: f64 = 0.5;

/// What [`Options::snap_angles`](crate::Options::snap_angles) has to be, for messages.
pub const SNAP_EXPECTED: &str = "a finite number above 0, at most 0.5 rad; leave it out to snap none";

/// Whether [`Options::snap_angles`](crate::Options::snap_angles) may be so much, rad: above 0, at most [`MOST_SNAPPED`].
pub fn can_snap(tolerance: f64) -> bool {
    tolerance > 0.0 && tolerance <= MOST_SNAPPED
}

/// The tolerance that was asked for; one that cannot be is an error of the whole document.
pub(crate) fn check(asked: Option<f64>, log: &mut Log) {
    if let Some(tolerance) = asked.filter(|tolerance| !can_snap(*tolerance)) {
        let place = Place { field: "snap_angles", ..Place::DOCUMENT };
        log.error(&place, Kind::SnapAngles, format!("{tolerance}"), SNAP_EXPECTED);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_may_be_off_by_more_than_nothing_and_no_more_than_the_most() {
        let could = [f64::MIN_POSITIVE, 1e-9, MOST_SNAPPED];
        let could_not = [0.0, -0.0, -1e-9, MOST_SNAPPED * 1.01, f64::INFINITY, f64::NAN];
        assert!(could.into_iter().all(can_snap) && !could_not.into_iter().any(can_snap));
        assert!(SNAP_EXPECTED.contains(&format!("above 0, at most {MOST_SNAPPED} rad;")));
    }
}
