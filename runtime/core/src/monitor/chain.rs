//! Of placements and rotations.

use nalgebra::Matrix3;

use crate::Scalar;
use crate::model::Model;

/// The largest entry of |RᵀR − 1|. A product of N rotations, each good to a rounding, keeps it
/// below 4Nu.
pub fn orthonormality<S: Scalar<Mask = bool>>(rotation: &Matrix3<S>) -> S {
    let off = rotation.transpose() * rotation - Matrix3::identity();
    off.iter().fold(S::zero(), |most, x| if (x.abs() - most).positive() { x.abs() } else { most })
}

/// The same of each placement that the function `placements` gives, generated or not; placements:
/// `[frames][12]`, out: `[frames]`.
pub fn placement_orthonormality<S: Scalar<Mask = bool>>(placements: &[S], out: &mut [S]) {
    for (placement, out) in placements.chunks_exact(12).zip(out) {
        *out = orthonormality(&Matrix3::from_row_slice(&placement[..9]));
    }
}

/// (index in q of the first number, norm² − 1) of each quaternion of q; `[nq]`.
///
/// Functions of the table take quaternions as they are: a norm 1 + ε turns into an error of some 2ε
/// of the rotation. `integrate` normalises what it gives.
pub fn quaternion_norms<'a, S: Scalar>(model: &'a Model<S>, q: &'a [S]) -> impl Iterator<Item = (usize, S)> + 'a {
    let all = model.bodies.iter().skip(1).filter_map(|b| Some(b.coordinates.q + b.joint.quaternion()?));
    all.filter_map(move |at| Some((at, q.get(at..at + 4)?.iter().fold(-S::one(), |sum, x| sum + *x * *x))))
}

/// Condition number of Ad from which the units deserve a check: that of frames a kilometre apart in
/// metres.
pub const ADJOINT_LIMIT: f64 = 1e6;

/// The condition number of Ad(T) in the 2-norm, ((d + √(d² + 4))/2)², where d is the distance of
/// the frames' origins.
///
/// It depends on the units of length alone: two frames 1 m apart have 2.6, and a million where the
/// metre is the unit and 1000 lie between, or the same metre is written in millimetres. No digits
/// are lost with it, since moments and forces are never added up. `stress` reports it from
/// [`ADJOINT_LIMIT`] on.
pub fn adjoint_condition<S: Scalar>(distance: S) -> S {
    // σ_max/σ_min of [1 0; [p]× 1]: σ² + 1/σ² = d² + 2
    let d = distance.abs();
    let half = (d + (d * d + S::from_f64(4.0)).sqrt()) * S::from_f64(0.5);
    half * half
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Placement, Vector3, from_rpy};

    #[test]
    fn the_closed_form_is_the_ratio_of_the_singular_values() {
        for d in [0.0, 1e-3, 0.7, 1.0, 30.0, 1000.0] {
            let position = Vector3::new(0.6, -0.48, 0.64) * d;
            let ad = Placement { rotation: from_rpy([0.3, -0.4, 2.0]), position }.adjoint();
            let values = ad.svd(false, false).singular_values;
            let found: f64 = adjoint_condition(d);
            assert!((values.max() / values.min() / found - 1.0).abs() < 1e-9 * found, "{d}: {found}");
        }
    }

    #[test]
    fn a_matrix_that_is_no_rotation_is_seen() {
        let turn: Matrix3<f64> = from_rpy([1.0, 0.2, -0.7]);
        assert!(orthonormality(&turn) < 4.0 * f64::EPSILON);
        assert!((orthonormality(&(turn * 1.01)) - 0.0201).abs() < 1e-12);
    }
}
