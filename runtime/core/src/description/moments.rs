//! Whether a rotational inertia is possible.
//!
//! Judged by the principal moments relative to the largest of them, so that the units do not
//! matter: a robot with lengths in nanometres has inertias of 1e-20, and a sound one passes.

use core::fmt;

use crate::eigen::eigenvalues;

/// A principal moment may be below zero by this part of the largest: rounding of written numbers.
const NEGATIVE: f64 = 1e-9;
/// The triangle inequality may be missed by this part of the largest moment: files print some six
/// digits.
const TRIANGLE: f64 = 1e-6;

/// The principal moments of a rotational inertia about the centre of mass, kg·m², the least first.
///
/// Those of a body are not negative, and none is greater than the other two together: Σ = ½ tr(I)·1
/// − I, the second moments of its mass, is positive semi-definite. Wensing, Kim & Slotine, 2018.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalMoments([f64; 3]);

impl PrincipalMoments {
    /// The condition that is broken by those that [`miss_triangle`](Self::miss_triangle).
    pub const TRIANGLE: &str = "none greater than the other two together (triangle inequality)";

    /// Of xx, xy, xz, yy, yz, zz, which are finite.
    pub fn of(inertia: [f64; 6]) -> Self {
        Self(eigenvalues(inertia))
    }

    /// Whether one is below zero, by more than rounding: with it the equations of motion may have
    /// no solution.
    pub fn are_negative(&self) -> bool {
        self.0[0] < -NEGATIVE * self.size()
    }

    /// Whether the greatest is greater than the other two together, by more than written digits,
    /// though none is negative: no body has such moments, but the equations of motion have a
    /// solution.
    pub fn miss_triangle(&self) -> bool {
        let [a, b, c] = self.0;
        !self.are_negative() && c - a - b > TRIANGLE * self.size()
    }

    /// The least of them, kg·m².
    pub fn least(&self) -> f64 {
        self.0[0]
    }

    /// The greatest of them, kg·m².
    pub fn greatest(&self) -> f64 {
        self.0[2]
    }

    fn size(&self) -> f64 {
        let [a, _, c] = self.0;
        a.abs().max(c.abs())
    }
}

impl fmt::Display for PrincipalMoments {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the principal moments ")?;
        for (k, x) in self.0.iter().enumerate() {
            f.write_str(if k == 0 { "" } else { ", " })?;
            if *x == 0.0 { f.write_str("0") } else { write!(f, "{x:.3e}") }?;
        }
        f.write_str(" kg·m²")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether one is negative, and whether one is too great.
    fn judged(inertia: [f64; 6]) -> [bool; 2] {
        let moments = PrincipalMoments::of(inertia);
        [moments.are_negative(), moments.miss_triangle()]
    }

    const SOUND: [bool; 2] = [false, false];
    const NEGATIVE: [bool; 2] = [true, false];
    const TOO_GREAT: [bool; 2] = [false, true];

    #[test]
    fn inertias_that_no_body_has_are_told_whatever_the_scale() {
        for scale in [1.0, 1e-20, 1e200] {
            let is = |i: [f64; 6]| judged(i.map(|x| x * scale));
            for sound in [
                [1.0, 0.0, 0.0, 1.0, 0.0, 1.0],
                [0.0, 0.0, 0.0, 1.0, 0.0, 1.0],
                [1.0, 0.0, 0.0, 2.0, 0.0, 3.0],
                [1.0, 0.4, 0.0, 1.0, 0.0, 1.0],
            ] {
                assert_eq!(is(sound), SOUND, "{sound:?}");
            }
            assert_eq!(is([1.0, 0.0, 0.0, 1.0, 0.0, 2.1]), TOO_GREAT);
            assert_eq!(is([-1.0, 0.0, 0.0, 1.0, 0.0, 1.0]), NEGATIVE);
            assert_eq!(is([1.0, 0.6, 0.0, 1.0, 0.0, 1.0]), TOO_GREAT);
        }
        assert_eq!(judged([0.0; 6]), SOUND);
        assert_eq!(judged([0.0, 0.1, 0.0, 0.0, 0.0, 0.0]), NEGATIVE);
    }

    #[test]
    fn what_lies_between_the_axes_counts() {
        // With 0.6 between all axes no two of them show the error, nor does one alone if there is
        // no extent along the third.
        assert_eq!([judged([2.0, -0.6, -0.6, 2.0, -0.6, 2.0]), judged([2.0, 0.6, 0.6, 2.0, 0.6, 2.0])], [SOUND, TOO_GREAT]);
        for flat in [[2.0, 0.0, 0.0, 1.0, 1.1, 1.0], [1.0, 0.0, 1.1, 2.0, 0.0, 1.0], [1.0, 1.1, 0.0, 1.0, 0.0, 2.0]] {
            assert_ne!(judged(flat), SOUND, "{flat:?}");
        }
    }

    #[test]
    fn tolerances_are_parts_of_the_largest_moment_not_of_a_minor() {
        let between = |x: f64| judged([0.0, 0.0, 0.0, 1.0, x, 1.0]);
        assert_eq!([between(0.0009), between(1e-6), between(4e-7)], [TOO_GREAT, TOO_GREAT, SOUND]);
        let along = |x: f64| judged([x, 0.0, 0.0, 1.0, 0.0, 1.0]);
        assert_eq!([along(-1e-3), along(-2e-9), along(-5e-10)], [NEGATIVE, NEGATIVE, SOUND]);
    }

    #[test]
    fn moments_are_written_with_four_digits() {
        use alloc::string::ToString;
        assert_eq!(PrincipalMoments([0.0, 0.123_456, 2e-20]).to_string(), "the principal moments 0, 1.235e-1, 2.000e-20 kg·m²");
    }
}
