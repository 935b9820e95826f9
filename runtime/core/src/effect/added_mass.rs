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
        .rule(is_no_loss, "with angular and linear a 6×6 matrix that is positive semidefinite"),
];

/// Whether no motion has less than no energy, but for rounding of written numbers.
fn is_no_loss(p: &[f64]) -> bool {
    let inertia = inertia(p);
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&inertia.angular);
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&inertia.coupling);
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&inertia.coupling.transpose());
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia.linear);
    let values = matrix.symmetric_eigenvalues();
    values.min() >= -1e-9 * values.amax()
}

/// The 6×6 matrix on [ω̇; a] in the effect's frame.
pub(super) fn inertia<S: Scalar>(p: &[S]) -> ArticulatedInertia<S> {
    let symmetric = |x: &[S]| Matrix3::new(x[0], x[1], x[2], x[1], x[3], x[4], x[2], x[4], x[5]);
    ArticulatedInertia { angular: symmetric(&p[..6]), linear: symmetric(&p[6..12]), coupling: Matrix3::from_row_slice(&p[12..21]) }
}
