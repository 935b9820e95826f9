//! Added mass: the fluid that a link moves along.

use nalgebra::{Matrix3, Matrix6};

use super::Field;
use crate::Scalar;
use crate::spatial::ArticulatedInertia;

pub(super) const FIELDS: &[Field] = &[
    Field::number("angular", "kg·m²", "moments about the axes: xx, xy, xz, yy, yz, zz").part().of(6),
    Field::number("linear", "kg", "masses along the axes: xx, xy, xz, yy, yz, zz").part().of(6),
    Field::number("coupling", "kg·m", "row by row: moment about an axis at the unit acceleration along another")
        .part()
        .or(&[0.0; 9])
        .of(9)
        .rule(is_positive_semidefinite, "with angular and linear a 6×6 matrix that is positive semidefinite"),
];

/// Whether no motion has negative energy, up to rounding of written numbers.
fn is_positive_semidefinite(p: &[f64]) -> bool {
    let inertia = inertia(p);
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&inertia.angular);
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&inertia.coupling);
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&inertia.coupling.transpose());
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia.linear);
    // Squares of large numbers overflow.
    let largest = matrix.amax();
    if largest == 0.0 {
        return true;
    }
    let values = (matrix / largest).symmetric_eigenvalues();
    values.min() >= -1e-9 * values.amax()
}

/// The 6×6 matrix on [ω̇; a] in the effect's frame.
pub(super) fn inertia<S: Scalar>(p: &[S]) -> ArticulatedInertia<S> {
    let symmetric = |x: &[S]| Matrix3::new(x[0], x[1], x[2], x[1], x[3], x[4], x[2], x[4], x[5]);
    ArticulatedInertia { angular: symmetric(&p[..6]), linear: symmetric(&p[6..12]), coupling: Matrix3::from_row_slice(&p[12..21]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_give_energy_is_told_whatever_its_size() {
        let diagonal = |x: f64| [&[x, 0.0, 0.0, x, 0.0, x].repeat(2)[..], &[0.0; 9]].concat();
        for size in [0.0, 1e-300, 1.0, 1e300] {
            assert!(is_positive_semidefinite(&diagonal(size)), "{size}");
            let mut leaning = diagonal(size);
            leaning[1] = 2.0 * size;
            assert_eq!(is_positive_semidefinite(&leaning), size == 0.0, "{size}");
        }
    }

    #[test]
    fn a_mass_below_zero_is_forgiven_what_rounding_makes_of_it_and_no_more() {
        let of = |least: f64| [&[1.0, 0.0, 0.0, 1.0, 0.0, 1.0], &[1.0, 0.0, 0.0, 1.0, 0.0, least][..], &[0.0; 9]].concat();
        assert_eq!([0.0, -1e-10, -1e-8, -1e-5].map(|least| is_positive_semidefinite(&of(least))), [true, true, false, false]);
    }
}
