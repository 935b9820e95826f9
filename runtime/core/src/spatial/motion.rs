//! The second-order motion of a body, with classical accelerations.

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;

/// How a body turns and how its origin accelerates, in axes of the body.
///
/// The acceleration is the classical one of the point (d²r/dt²), not the linear part of a spatial
/// acceleration: no linear velocity is needed to carry it outward. Gravity enters as an
/// acceleration −g of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S> {
    /// ω, rad/s.
    pub omega: Vector3<S>,
    /// ω̇, rad/s².
    pub alpha: Vector3<S>,
    /// r̈ − g of the origin, m/s².
    pub acceleration: Vector3<S>,
}

impl<S: Scalar> Motion<S> {
    /// The same in other axes, to which `turn` takes vectors.
    #[inline(always)]
    pub(crate) fn turned(self, turn: impl Fn(Vector3<S>) -> Vector3<S>) -> Self {
        Self { omega: turn(self.omega), alpha: turn(self.alpha), acceleration: turn(self.acceleration) }
    }
}

/// `U = [ω̇]× + [ω]×[ω]×`: a point at r from the origin accelerates by U·r more than the origin
/// does.
#[inline(always)]
pub fn rate_matrix<S: Scalar>(omega: Vector3<S>, alpha: Vector3<S>) -> Matrix3<S> {
    let (xx, yy, zz) = (omega.x * omega.x, omega.y * omega.y, omega.z * omega.z);
    let (xy, xz, yz) = (omega.x * omega.y, omega.x * omega.z, omega.y * omega.z);
    Matrix3::new(
        -(yy + zz),
        xy - alpha.z,
        xz + alpha.y, //
        xy + alpha.z,
        -(xx + zz),
        yz - alpha.x, //
        xz - alpha.y,
        yz + alpha.x,
        -(xx + yy),
    )
}

/// ω̇ and U of a body from `omega` = ω, rad/s, `alpha_z` = ω̇_z, rad/s², and `axis` = ë = U e_z,
/// 1/s², the second derivative of its z-axis. All in axes of the body.
///
/// ë = [ω_x ω_z + ω̇_y; ω_y ω_z − ω̇_x; −(ω_x² + ω_y²)], so that the third row of U and its third
/// column add up to 2 ω_z ω. `diagonal`: the diagonal from ë_z, in two squares, not in three.
#[inline(always)]
pub fn rates_about<S: Scalar>(omega: Vector3<S>, alpha_z: S, axis: Vector3<S>, diagonal: bool) -> (Vector3<S>, Matrix3<S>) {
    let (w, twice) = (omega, omega.z + omega.z);
    let alpha = Vector3::new(w.y * w.z - axis.y, axis.x - w.x * w.z, alpha_z);
    let (xx, yy, zz, xy) = (w.x * w.x, w.y * w.y, w.z * w.z, w.x * w.y);
    let (m11, m33) = if diagonal { (axis.z + (xx - zz), axis.z) } else { (-(yy + zz), -(xx + yy)) };
    let u = Matrix3::new(
        m11,
        xy - alpha.z,
        axis.x, //
        xy + alpha.z,
        -(xx + zz),
        axis.y, //
        w.x * twice - axis.x,
        w.y * twice - axis.y,
        m33,
    );
    (alpha, u)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_about_an_axis_are_those_of_its_second_derivative() {
        let (w, d) = (Vector3::new(0.3, -1.2, 0.7), Vector3::new(2.0, 0.5, -0.9));
        let u: Matrix3<f64> = rate_matrix(w, d);
        for diagonal in [false, true] {
            let (alpha, found) = rates_about(w, d.z, u.column(2).into_owned(), diagonal);
            assert!((alpha - d).amax() < 1e-15 && (found - u).amax() < 1e-15, "{diagonal}: {alpha} {found}");
        }
    }

    #[test]
    fn rate_matrix_times_r_is_euler_plus_centripetal_acceleration() {
        let (w, d, r) = (Vector3::new(0.3, -1.2, 0.7), Vector3::new(2.0, 0.5, -0.9), Vector3::new(0.4, 0.1, -0.6));
        let expected: Vector3<f64> = d.cross(&r) + w.cross(&w.cross(&r));
        assert!((rate_matrix(w, d) * r - expected).amax() < 1e-15);
    }
}
