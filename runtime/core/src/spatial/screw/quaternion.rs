//! Quaternions.

use nalgebra::{Matrix3, Vector3};

use super::coefficients::{HalfAngle, rotation_over_vector};
use crate::Scalar;
use crate::spatial::from_quaternion;

/// (v, w) = (x, y, z, w). A unit quaternion stands for a rotation, and −q for the same one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion<S> {
    /// (x, y, z); for a rotation by θ, sin(θ/2) times its axis.
    pub vector: Vector3<S>,
    /// w; for a rotation by θ, cos(θ/2).
    pub scalar: S,
}

impl<S: Scalar> Quaternion<S> {
    /// No rotation: (0, 0, 0, 1).
    pub fn identity() -> Self {
        Self { vector: Vector3::zeros(), scalar: S::one() }
    }

    /// From (x, y, z, w), as in a configuration.
    #[inline(always)]
    pub fn from_array([x, y, z, w]: [S; 4]) -> Self {
        Self { vector: Vector3::new(x, y, z), scalar: w }
    }

    /// (x, y, z, w).
    #[inline(always)]
    pub fn to_array(&self) -> [S; 4] {
        let Self { vector, scalar } = self;
        [vector.x, vector.y, vector.z, *scalar]
    }

    /// p ⊗ q: the rotation q, then p.
    #[inline(always)]
    #[must_use]
    pub fn product(&self, q: &Self) -> Self {
        let (p, a, b) = (self, self.vector, q.vector);
        Self { vector: b * p.scalar + a * q.scalar + a.cross(&b), scalar: p.scalar * q.scalar - a.dot(&b) }
    }

    /// (−v, w): for a unit quaternion, the rotation back.
    #[inline(always)]
    #[must_use]
    pub fn conjugate(&self) -> Self {
        Self { vector: -self.vector, scalar: self.scalar }
    }

    /// The sum of the squares.
    #[inline(always)]
    pub fn norm_squared(&self) -> S {
        self.vector.dot(&self.vector) + self.scalar * self.scalar
    }

    /// q/|q|, if the square of |q| is in range: from 1e-150 to 1e150. Its norm is off by at most
    /// 2u.
    #[inline(always)]
    #[must_use]
    pub fn normalised(&self) -> Self {
        let norm = self.norm_squared().sqrt();
        Self { vector: self.vector.map(|c| c / norm), scalar: self.scalar / norm }
    }

    /// The rotation about ω by |ω| rad: (sin(θ/2)/θ·ω, cos(θ/2)) with θ = |ω|.
    ///
    /// Each number is off by at most (2 + θ)·u times its own size or, near its zeros, the norm's.
    /// Lynch & Park 2017, §B.3.
    #[inline(always)]
    pub fn exp(omega: Vector3<S>) -> Self {
        let half = HalfAngle::new(omega.dot(&omega));
        Self { vector: omega * (S::from_f64(0.5) * half.sinc()), scalar: half.cosine() }
    }

    /// The rotation vector, rad, of length θ ≤ π: the one that [`Self::exp`] takes back to q or −q.
    /// The norm need not be one, only from 1e-150 to 1e150.
    ///
    /// θ = 2 atan2(|v|, w) with the sign of q that has w > 0: a few u from θ = 0 to π, relative to
    /// θ. At w = 0, half a turn, the first component of the axis that is not zero is positive.
    #[inline(always)]
    pub fn log(&self) -> Vector3<S> {
        let sign = self.sign();
        let square = self.vector.dot(&self.vector);
        self.vector * (sign * rotation_over_vector(square, sign * self.scalar))
    }

    /// The angle of the rotation, rad, from 0 to π: the length of [`Self::log`]. The norm need not
    /// be one.
    pub fn angle(&self) -> S {
        let half = self.vector.dot(&self.vector).sqrt().atan2(self.scalar.abs());
        half + half
    }

    /// The sign of the first of w, x, y, z that is not zero: ±1.
    #[inline(always)]
    fn sign(&self) -> S {
        let (one, v) = (S::one(), &self.vector);
        [v.z, v.y, v.x, self.scalar].into_iter().fold(one, |rest, c| {
            let negative = S::select((-c).positive(), -one, rest);
            S::select(c.positive(), one, negative)
        })
    }

    /// Of a rotation matrix: of the four formulas, the one that divides by the largest component
    /// (Shepperd 1978), which is then at least 1/2 and not negative. Absolute error 3u for a matrix
    /// that is a rotation; one that is only nearly orthogonal also gives a unit quaternion.
    pub fn from_rotation(r: &Matrix3<S>) -> Self {
        let one = S::one();
        // 4 q_k q for q_k = w, x, y, z.
        let (wx, wy, wz) = (r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
        let (yz, xz, xy) = (r.m32 + r.m23, r.m13 + r.m31, r.m21 + r.m12);
        let by_w = [wx, wy, wz, one + r.m11 + r.m22 + r.m33];
        let by_x = [one + r.m11 - r.m22 - r.m33, xy, xz, wx];
        let by_y = [xy, one - r.m11 + r.m22 - r.m33, yz, wy];
        let by_z = [xz, yz, one - r.m11 - r.m22 + r.m33, wz];
        let larger = |(a, qa): ([S; 4], S), (b, qb): ([S; 4], S)| {
            let mask = (qb - qa).positive();
            (core::array::from_fn(|k| S::select(mask, b[k], a[k])), S::select(mask, qb, qa))
        };
        let rest = larger((by_y, by_y[1]), (by_z, by_z[2]));
        let (largest, _) = larger(larger((by_w, by_w[3]), (by_x, by_x[0])), rest);
        Self::from_array(largest).normalised()
    }

    /// The rotation matrix, of a unit quaternion; see [`from_quaternion`].
    #[inline(always)]
    pub fn to_rotation(&self) -> Matrix3<S> {
        from_quaternion(self.to_array())
    }
}
