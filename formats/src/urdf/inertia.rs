//! Checks of a mass and its inertia: of the inertia by its principal moments.

use articulated_core::description::PrincipalMoments;
use articulated_core::diagnostic::{Code, Diagnostics, Place};

use super::robot::Context;
use crate::mass::beyond_any_mass;

/// Reports an impossible or suspicious mass or inertia.
pub(crate) fn check(mass: Option<f64>, inertia: Option<[f64; 6]>, context: &Context<'_>, place: &Place<'_>, log: &mut Diagnostics) {
    let place = |field| Place { field, ..*place };
    if let Some(mass) = mass.filter(|mass| *mass < 0.0) {
        log.error(place("mass"), Code::NegativeMass, format!("a negative mass, {mass} kg"), "a mass of zero or more");
    }
    if let Some((found, expected)) = mass.and_then(beyond_any_mass) {
        log.warning(place("mass"), Code::Units, found, expected);
    }
    let Some(inertia) = inertia else { return };
    if mass == Some(0.0) && inertia.iter().any(|i| *i != 0.0) {
        let found = "a mass of zero with a rotational inertia that is not";
        log.warning(place("inertial"), Code::InertiaWithoutMass, found, "both or neither; used as written");
    }
    check_moments(mass, inertia, context, &place("inertia"), log);
    check_units(mass, inertia, &place("inertia"), log);
}

/// Radii of gyration from here on, m, are usually errors: kg·mm² or g·mm², most often.
const WIDE: f64 = 10.0;

fn check_units(mass: Option<f64>, inertia: [f64; 6], place: &Place<'_>, log: &mut Diagnostics) {
    let Some(mass) = mass.filter(|mass| *mass > 0.0) else { return };
    let radius = (PrincipalMoments::of(inertia).greatest() / mass).sqrt();
    if radius >= WIDE {
        let expected = "kg·m², of which 1 kg·mm² is 1e-6 and 1 g·mm² is 1e-9; used as written";
        let radius = if radius < 1e6 { format!("{radius:.1}") } else { format!("{radius:.1e}") };
        log.warning(place, Code::Units, format!("a radius of gyration of {radius} m, more than any link has"), expected);
    }
}

/// A negative moment up to this multiple of m·ℓ² is rounding: ℓ is [`Context::length`], from which
/// the moment was shifted. Shipped files have up to 1e-19·m·(1 m)².
const DUST: f64 = 1e-12;

fn check_moments(mass: Option<f64>, inertia: [f64; 6], context: &Context<'_>, place: &Place<'_>, log: &mut Diagnostics) {
    const EXPECTED: &str = "an inertia that is positive semi-definite";
    let moments = PrincipalMoments::of(inertia);
    if moments.are_negative() {
        let is_dust = mass.is_some_and(|mass| -moments.least() <= DUST * mass * context.length * context.length);
        let (found, kind) = (moments.to_string(), Code::InertiaNotPositive);
        if is_dust {
            log.warning(place, kind, format!("{found}, negative by rounding alone"), format!("{EXPECTED}; used as written"));
        } else if context.options.allow_unphysical_inertia {
            log.warning(place, kind, found, format!("{EXPECTED}; used as written"));
        } else {
            log.error(place, kind, found, format!("{EXPECTED}; {ALLOW_UNPHYSICAL_INERTIA} accepts it as written"));
        }
    } else if moments.miss_triangle() {
        let expected = format!("{}; used as written", PrincipalMoments::TRIANGLE);
        log.warning(place, Code::InertiaTriangle, moments.to_string(), expected);
    }
}

/// The option that accepts a negative principal moment, as the command, scenes and macro, and build
/// scripts spell it.
pub(crate) const ALLOW_UNPHYSICAL_INERTIA: &str =
    "`--allow-unphysical-inertia` (key `allow_unphysical_inertia`, method `Build::allow_unphysical_inertia`)";
