//! Whether a mass and its inertia can be.
//!
//! Judged by the principal moments relative to the largest of them, so that the units do not matter: a robot with
//! lengths in nanometres has inertias of 1e-20, and a sound one passes.

use crate::eigen::eigenvalues;
use crate::log::{Log, Place};
use crate::problem::Kind;

/// A principal moment may be below zero by this part of the largest: rounding of the file's numbers.
const NEGATIVE: f64 = 1e-9;
/// The triangle inequality may be missed by this part of the largest moment: files print some six digits.
const TRIANGLE: f64 = 1e-6;

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
}

fn check_moments(inertia: [f64; 6], allow: bool, place: &Place<'_>, log: &mut Log) {
    let moments = eigenvalues(inertia);
    let [a, b, c] = moments;
    let [small, middle, large] = moments.map(short);
    let found = format!("the principal moments {small}, {middle}, {large} kg·m²");
    let size = a.abs().max(c.abs());
    if a < -NEGATIVE * size {
        let expected = "an inertia that is positive semi-definite";
        match allow {
            true => log.warning(place, Kind::InertiaNotPositive, found, format!("{expected}; used as written")),
            false => log.error(place, Kind::InertiaNotPositive, found, expected),
        }
    } else if c - a - b > TRIANGLE * size {
        let expected = "none greater than the other two together (triangle inequality); used as written";
        log.warning(place, Kind::InertiaTriangle, found, expected);
    }
}

fn short(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.3e}") }
}
