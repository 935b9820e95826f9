//! Principal axes of inertia, in the order and with the signs that MuJoCo chooses.

use crate::pose::{IDENTITY, Quaternion, Symmetric, Vector, about, conjugate, diagonal, multiply, turned};

/// Smaller off-diagonal entries count as zero, as in MuJoCo.
const LEAST: f64 = 1e-12;
const MOST_TURNS: usize = 500;

/// The moments, the largest first, and the rotation to their axes.
pub(crate) fn principal(inertia: Symmetric) -> (Vector, Quaternion) {
    jacobi(inertia, 0.0)
}

/// As [`principal`], for a mesh: MuJoCo stops before a turn with one minus its cosine below 1e-12,
/// so up to 1.5e-6 rad remain. Shapes that are fitted to the mesh have these axes.
pub(crate) fn principal_of_mesh(inertia: Symmetric) -> (Vector, Quaternion) {
    jacobi(inertia, LEAST)
}

/// Jacobi's classical method, which removes the largest off-diagonal entry by a turn; Golub & Van
/// Loan, *Matrix Computations*, §8.5.3. It stops at a turn with one minus its cosine below `least`.
fn jacobi(inertia: Symmetric, least: f64) -> (Vector, Quaternion) {
    let mut axes = IDENTITY;
    let mut moments = [inertia[0], inertia[3], inertia[5]];
    for _ in 0..MOST_TURNS {
        let [xx, xy, xz, yy, yz, zz] = turned(conjugate(axes), inertia);
        moments = [xx, yy, zz];
        let (entry, row, column, axis) = match (xy.abs(), xz.abs(), yz.abs()) {
            (a, b, c) if a > b && a > c => (xy, 0, 1, 2),
            (_, b, c) if b > c => (xz, 0, 2, 1),
            _ => (yz, 1, 2, 0),
        };
        if entry.abs() < LEAST || !entry.is_finite() {
            break;
        }
        let ratio = (moments[column] - moments[row]) / (2.0 * entry);
        let tangent = 1.0 / (ratio.abs() + ratio.hypot(1.0));
        let cosine = 1.0 / tangent.hypot(1.0);
        if cosine > 1.0 - least {
            break;
        }
        let half = (tangent.atan() / 2.0).sin();
        // The turn goes from the column to the row: about y that is the positive sense.
        let sine = if (ratio >= 0.0) == (axis == 1) { half } else { -half };
        let mut turn = [(1.0 - half * half).sqrt(), 0.0, 0.0, 0.0];
        turn[axis + 1] = sine;
        axes = of_length_one(multiply(axes, turn));
    }
    // Neighbours change places by quarter turns.
    for first in [0, 1, 0] {
        if moments[first] + LEAST < moments[first + 1] {
            moments.swap(first, first + 1);
            let mut axis = [0.0; 3];
            axis[(first + 2) % 3] = 1.0;
            axes = multiply(axes, about(axis, std::f64::consts::FRAC_PI_2));
        }
    }
    (moments, axes)
}

/// The inertia in axes of this orientation, without the remaining off-diagonal entries.
pub(crate) fn in_axes(axes: Quaternion, inertia: Symmetric) -> Symmetric {
    let [xx, _, _, yy, _, zz] = turned(conjugate(axes), inertia);
    diagonal([xx, yy, zz])
}

fn of_length_one(q: Quaternion) -> Quaternion {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_sorted_and_axes_belong_to_them() {
        let turn = of_length_one([0.3, -0.5, 0.7, 0.2]);
        for moments in [[1.0, 2.0, 2.5], [3.0, 2.0, 1.5], [2.0, 1.0, 2.9], [2.0, 2.0, 3.0], [1.0; 3]] {
            let inertia = turned(turn, diagonal(moments));
            let (found, axes) = principal(inertia);
            assert!(found[0] + LEAST >= found[1] && found[1] + LEAST >= found[2], "{found:?}");
            let rest = turned(conjugate(axes), inertia);
            assert!([1, 2, 4].iter().all(|k| rest[*k].abs() < 3e-6), "{rest:?}");
            assert!([(0, 0), (1, 3), (2, 5)].iter().all(|(k, at)| (found[*k] - rest[*at]).abs() < 1e-14), "{found:?} {rest:?}");
        }
    }

    #[test]
    fn a_diagonal_that_is_sorted_keeps_its_axes() {
        assert_eq!(principal(diagonal([3.0, 2.0, 1.0])), ([3.0, 2.0, 1.0], IDENTITY));
        assert_eq!(principal(diagonal([2.0; 3])).1, IDENTITY);
        // The largest moment is about z: x is −z by a quarter turn about y, in two steps.
        assert_eq!(principal(diagonal([1.0, 2.0, 3.0])).0, [3.0, 2.0, 1.0]);
    }
}
