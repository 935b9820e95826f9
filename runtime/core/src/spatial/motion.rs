//! The second-order motion of a body, with classical accelerations.

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;

/// How a body turns and how its origin accelerates, in axes of the body.
///
/// The acceleration is the classical one of the point (d²r/dt²), not the linear part of a spatial acceleration: no linear
/// velocity is needed to carry it outward. Gravity enters as an acceleration −g of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S> {
    /// ω, rad/s.
    pub omega: Vector3<S>,
    /// ω̇, rad/s².
    pub alpha: Vector3<S>,
    /// r̈ − g of the origin, m/s².
    pub acceleration: Vector3<S>,
}

/// `U = [ω̇]× + [ω]×[ω]×`: a point at r from the origin accelerates by U·r more than the origin does.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_matrix_times_r_is_euler_plus_centripetal_acceleration() {
        let (w, d, r) = (Vector3::new(0.3, -1.2, 0.7), Vector3::new(2.0, 0.5, -0.9), Vector3::new(0.4, 0.1, -0.6));
        let expected: Vector3<f64> = d.cross(&r) + w.cross(&w.cross(&r));
        assert!((rate_matrix(w, d) * r - expected).amax() < 1e-15);
    }
}
