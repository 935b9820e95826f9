//! Whether a mass and its inertia can be: the inertia by its principal moments.

use articulated_core::description::PrincipalMoments;

use crate::log::{Log, Place};
use crate::problem::Kind;

/// Reports what cannot be, or looks wrong, of what there is. `allow`: an inertia that is not positive is a warning.
pub(crate) fn check(mass: Option<f64>, inertia: Option<[f64; 6]>, allow: bool, place: &Place<'_>, log: &mut Log) {
    let place = |field| Place { field, ..*place };
    if let Some(mass) = mass.filter(|mass| *mass < 0.0) {
        log.error(&place("mass"), Kind::NegativeMass, format!("a negative mass, {mass} kg"), "a mass of zero or more");
    }
    let Some(inertia) = inertia else { return };
    if mass == Some(0.0) && inertia.iter().any(|i| *i != 0.0) {
        let found = "a mass of zero with a rotational inertia that is not";
        log.warning(&place("inertial"), Kind::InertiaWithoutMass, found, "both or neither; used as written");
    }
    check_moments(inertia, allow, &place("inertia"), log);
    check_units(mass, inertia, &place("inertia"), log);
}

/// A radius of gyration of so many metres and more is written by mistake: kg·mm² or g·mm², most often.
const WIDE: f64 = 10.0;

fn check_units(mass: Option<f64>, inertia: [f64; 6], place: &Place<'_>, log: &mut Log) {
    let Some(mass) = mass.filter(|mass| *mass > 0.0) else { return };
    let radius = (PrincipalMoments::of(inertia).greatest() / mass).sqrt();
    if radius >= WIDE {
        let expected = "kg·m², of which 1 kg·mm² is 1e-6 and 1 g·mm² is 1e-9; used as written";
        let radius = if radius < 1e6 { format!("{radius:.1}") } else { format!("{radius:.1e}") };
        log.warning(place, Kind::Units, format!("a radius of gyration of {radius} m, more than any link has"), expected);
    }
}

fn check_moments(inertia: [f64; 6], allow: bool, place: &Place<'_>, log: &mut Log) {
    let moments = PrincipalMoments::of(inertia);
    if moments.are_negative() {
        let expected = "an inertia that is positive semi-definite";
        match allow {
            true => log.warning(place, Kind::InertiaNotPositive, moments.to_string(), format!("{expected}; used as written")),
            false => log.error(place, Kind::InertiaNotPositive, moments.to_string(), expected),
        }
    } else if moments.miss_triangle() {
        let expected = format!("{}; used as written", PrincipalMoments::TRIANGLE);
        log.warning(place, Kind::InertiaTriangle, moments.to_string(), expected);
    }
}
