//! Masses that no link has.

use articulated_core::Plain;

/// Greatest plausible mass of a link, kg: a thousand tonnes.
const MOST: f64 = 1e6;

/// The found and the expected text for an implausible mass, kg, of a link; `None` for a plausible
/// one.
///
/// ```
/// assert!(articulated_formats::beyond_any_mass(1e6).is_none());
/// let (found, _) = articulated_formats::beyond_any_mass(2e6).unwrap();
/// assert!(found.starts_with("a mass of 2000000 kg"));
/// ```
#[must_use]
pub fn beyond_any_mass(mass: f64) -> Option<(String, &'static str)> {
    (mass > MOST).then(|| (format!("a mass of {} kg, more than any link has", Plain(mass)), "kg, of which 1 g is 1e-3; used as written"))
}
