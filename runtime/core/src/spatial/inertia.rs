//! Spatial inertia by moments of mass.

use nalgebra::{Matrix3, Vector3};

use super::{Placement, Wrench, rotate};
use crate::Scalar;

/// The mass properties of a body as the moments of its mass about the origin of its frame, in axes
/// of that frame: m = ∫dm, h = ∫r dm = m·c and Σ = ∫r rᵀ dm.
///
/// The rotational inertia about the origin is tr(Σ)·1 − Σ. In these ten numbers all of dynamics is
/// linear, bodies add up by adding them, and a shift of the origin never subtracts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialInertia<S> {
    /// m, kg.
    pub mass: S,
    /// h = m·c, kg·m.
    pub first: Vector3<S>,
    /// Σ, kg·m², symmetric.
    pub second: Matrix3<S>,
}

impl<S: Scalar> SpatialInertia<S> {
    /// Zero.
    pub fn zero() -> Self {
        Self { mass: S::zero(), first: Vector3::zeros(), second: Matrix3::zeros() }
    }

    /// From the mass, the rotational inertia about the centre of mass, and the frame that inertia
    /// is given in (its origin is the centre).
    pub fn from_central(mass: S, inertia: Matrix3<S>, frame: &Placement<S>) -> Self {
        let half = S::from_f64(0.5) * inertia.trace();
        // Σ_c = ½ tr(I_c)·1 − I_c
        let second = Matrix3::from_diagonal_element(half) - inertia;
        Self { mass, first: Vector3::zeros(), second }.moved(frame)
    }

    /// The same body seen from the frame a, where `x_ab` places the frame b that the moments are
    /// given in.
    ///
    /// m' = m, h' = R h + m p, Σ' = R Σ Rᵀ + (R h) pᵀ + p (R h)ᵀ + m p pᵀ.
    #[inline(always)]
    #[must_use]
    pub fn moved(&self, x_ab: &Placement<S>) -> Self {
        let r = &x_ab.rotation;
        Self { mass: self.mass, first: rotate(r, self.first), second: turned(&self.second, r) }.shifted(x_ab.position)
    }

    /// The wrench that moves the body, about its origin: f = m a + U h, n = h × a + ∫ r × (U r) dm.
    ///
    /// `acceleration`: of the origin, gravity subtracted, m/s²; `u`: the rate matrix. All in body
    /// axes.
    #[inline(always)]
    pub fn wrench(&self, acceleration: Vector3<S>, u: &Matrix3<S>) -> Wrench<S> {
        let (s, h) = (&self.second, self.first);
        // ∫ r × (U r) dm has the components (UΣ)_zy − (UΣ)_yz and so on cyclically, with the
        // factors of Σ's off-diagonals collected.
        let spin = Vector3::new(
            sum([(u.m31, s.m12), (-u.m21, s.m13), (u.m33 - u.m22, s.m23), (u.m32, s.m22), (-u.m23, s.m33)]),
            sum([(u.m12, s.m23), (-u.m32, s.m12), (u.m11 - u.m33, s.m13), (u.m13, s.m33), (-u.m31, s.m11)]),
            sum([(u.m23, s.m13), (-u.m13, s.m23), (u.m22 - u.m11, s.m12), (u.m21, s.m11), (-u.m12, s.m22)]),
        );
        Wrench { moment: h.cross(&acceleration) + spin, force: acceleration * self.mass + rotate(u, h) }
    }

    /// G V = [I ω + h × v; m v − h × ω]: the momentum of the body with twist V, or the wrench for
    /// an acceleration of it at rest.
    #[inline(always)]
    pub fn apply(&self, v: &super::Twist<S>) -> Wrench<S> {
        let h = self.first;
        // (tr(Σ)·1 − Σ) ω
        Wrench { moment: rotate(&self.rotational(), v.angular) + h.cross(&v.linear), force: v.linear * self.mass + v.angular.cross(&h) }
    }

    /// The same body about the origin that lies at −`d`: h' = h + m d, Σ' = Σ + x dᵀ + d xᵀ with x
    /// = h + ½ m d.
    #[inline(always)]
    #[must_use]
    pub fn shifted(&self, d: Vector3<S>) -> Self {
        let (h, s) = (self.first, &self.second);
        let (x, twice) = (h + d * (self.mass * S::from_f64(0.5)), d + d);
        let (xy, xz, yz) = (s.m12 + x.x * d.y + x.y * d.x, s.m13 + x.x * d.z + x.z * d.x, s.m23 + x.y * d.z + x.z * d.y);
        let (xx, yy, zz) = (s.m11 + twice.x * x.x, s.m22 + twice.y * x.y, s.m33 + twice.z * x.z);
        Self { mass: self.mass, first: h + d * self.mass, second: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) }
    }

    /// The same body in other axes, to which `turn` takes vectors: h' = R h, Σ' = R Σ Rᵀ.
    #[inline(always)]
    #[must_use]
    pub fn turned(&self, turn: &Matrix3<S>) -> Self {
        let second = if self.is_axisymmetric() { symmetric(self.turned_axisymmetric(turn)) } else { turned(&self.second, turn) };
        Self { mass: self.mass, first: rotate(turn, self.first), second }
    }

    /// Whether the body is axisymmetric about z.
    #[inline(always)]
    pub fn is_axisymmetric(&self) -> bool {
        let (h, m) = (&self.first, &self.second);
        m.m11 == m.m22 && [m.m12, m.m13, m.m23, h.x, h.y].iter().all(S::is_zero)
    }

    /// R Σ Rᵀ where Σ = Σ_xx·1 + (Σ_zz − Σ_xx) e_z e_zᵀ.
    #[inline(always)]
    fn turned_axisymmetric(&self, turn: &Matrix3<S>) -> Matrix3<S> {
        let (m, z) = (&self.second, turn.column(2).into_owned());
        Matrix3::from_diagonal_element(m.m11) + z * (z * (m.m33 - m.m11)).transpose()
    }

    /// Rotational inertia about the origin, tr(Σ)·1 − Σ, kg·m².
    #[inline(always)]
    pub fn rotational(&self) -> Matrix3<S> {
        complement(&self.second)
    }

    /// From the ten inertial parameters m, m·c and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz, I about the
    /// origin; kg, kg·m, kg·m². Σ = ½ tr(I)·1 − I.
    pub fn from_parameters(p: [S; 10]) -> Self {
        let [mass, hx, hy, hz, xx, xy, xz, yy, yz, zz] = p;
        let half = S::from_f64(0.5) * (xx + yy + zz);
        let second = Matrix3::new(half - xx, -xy, -xz, -xy, half - yy, -yz, -xz, -yz, half - zz);
        Self { mass, first: Vector3::new(hx, hy, hz), second }
    }

    /// The ten inertial parameters, as [`SpatialInertia::from_parameters`] takes them.
    pub fn parameters(&self) -> [S; 10] {
        let (h, i) = (self.first, self.rotational());
        [self.mass, h.x, h.y, h.z, i.m11, i.m12, i.m13, i.m22, i.m23, i.m33]
    }

    /// The same inertia in another scalar.
    #[cfg(feature = "alloc")]
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> SpatialInertia<T> {
        SpatialInertia { mass: f(self.mass), first: self.first.map(f), second: self.second.map(f) }
    }
}

impl<S: Scalar> core::ops::AddAssign for SpatialInertia<S> {
    fn add_assign(&mut self, other: Self) {
        self.mass += other.mass;
        self.first += other.first;
        self.second += other.second;
    }
}

/// tr(M)·1 − M, with a sum of two in each place of the diagonal.
#[inline(always)]
pub(super) fn complement<S: Scalar>(m: &Matrix3<S>) -> Matrix3<S> {
    Matrix3::new(m.m22 + m.m33, -m.m12, -m.m13, -m.m21, m.m11 + m.m33, -m.m23, -m.m31, -m.m32, m.m11 + m.m22)
}

/// R M Rᵀ of a symmetric matrix.
#[inline(always)]
fn turned<S: Scalar>(m: &Matrix3<S>, r: &Matrix3<S>) -> Matrix3<S> {
    // RM, by columns
    let (x, y, z) = (
        rotate(r, Vector3::new(m.m11, m.m12, m.m13)), //
        rotate(r, Vector3::new(m.m12, m.m22, m.m23)),
        rotate(r, Vector3::new(m.m13, m.m23, m.m33)),
    );
    let (xx, xy, xz) = (
        sum([(x.x, r.m11), (y.x, r.m12), (z.x, r.m13)]),
        sum([(x.x, r.m21), (y.x, r.m22), (z.x, r.m23)]),
        sum([(x.x, r.m31), (y.x, r.m32), (z.x, r.m33)]),
    );
    let (yy, yz) = (sum([(x.y, r.m21), (y.y, r.m22), (z.y, r.m23)]), sum([(x.y, r.m31), (y.y, r.m32), (z.y, r.m33)]));
    let zz = sum([(x.z, r.m31), (y.z, r.m32), (z.z, r.m33)]);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// The sum of products, from the first on.
#[inline(always)]
fn sum<S: Scalar, const N: usize>(products: [(S, S); N]) -> S {
    let [(a, b), rest @ ..] = products.as_slice() else { return S::zero() };
    rest.iter().fold(*a * *b, |sum, (a, b)| a.mul_add(*b, sum))
}

/// The upper triangle, mirrored: rounding must not make a symmetric matrix lopsided.
fn symmetric<S: Scalar>(m: Matrix3<S>) -> Matrix3<S> {
    Matrix3::new(m.m11, m.m12, m.m13, m.m12, m.m22, m.m23, m.m13, m.m23, m.m33)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{from_rpy, rate_matrix};

    fn body() -> (f64, Matrix3<f64>, Placement<f64>) {
        let i = Matrix3::new(0.03, 0.001, -0.002, 0.001, 0.05, 0.0005, -0.002, 0.0005, 0.055);
        (2.0, i, Placement { rotation: from_rpy([0.4, -1.1, 2.0]), position: Vector3::new(0.15, 0.02, -0.01) })
    }

    #[test]
    fn rotational_inertia_obeys_the_parallel_axis_theorem() {
        let (m, i, x) = body();
        let c = x.position;
        let expected = x.rotation * i * x.rotation.transpose() + (Matrix3::identity() * c.dot(&c) - c * c.transpose()) * m;
        assert!((SpatialInertia::from_central(m, i, &x).rotational() - expected).amax() < 1e-15);
    }

    #[test]
    fn parameters_and_moments_are_each_others() {
        let (m, i, x) = body();
        let g = SpatialInertia::from_central(m, i, &x);
        let back = SpatialInertia::from_parameters(g.parameters());
        assert!((back.second - g.second).amax() < 1e-15 && (back.mass, back.first) == (g.mass, g.first));
    }

    #[test]
    fn wrench_is_that_of_newton_and_euler() {
        let (m, i, x) = body();
        let g = SpatialInertia::from_central(m, i, &x);
        let (w, d, a) = (Vector3::new(0.3, -1.2, 0.7), Vector3::new(2.0, 0.5, -0.9), Vector3::new(-3.0, 0.2, 9.0));
        let (c, i) = (x.position, x.rotation * i * x.rotation.transpose());
        let f = (a + d.cross(&c) + w.cross(&w.cross(&c))) * m;
        let n = i * d + w.cross(&(i * w)) + c.cross(&f);
        let got = g.wrench(a, &rate_matrix(w, d));
        assert!((got.force - f).amax() < 1e-14 && (got.moment - n).amax() < 1e-14);
    }
}
