//! Articulated-body inertia.

use nalgebra::Matrix3;

use super::{Placement, SpatialInertia, Twist, Wrench, rotate, rotate_back, turned_about_z};
use crate::Scalar;

/// The apparent inertia of a body with the joints beyond it free to move: the symmetric matrix [A
/// B; Bᵀ C] on [ω̇; a] (Featherstone 2008, §7.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArticulatedInertia<S> {
    /// A, kg·m², symmetric.
    pub angular: Matrix3<S>,
    /// B, kg·m.
    pub coupling: Matrix3<S>,
    /// C, kg, symmetric.
    pub linear: Matrix3<S>,
}

impl<S: Scalar> ArticulatedInertia<S> {
    /// Zero.
    pub fn zero() -> Self {
        Self { angular: Matrix3::zeros(), coupling: Matrix3::zeros(), linear: Matrix3::zeros() }
    }

    /// Of a rigid body: `A = tr(Σ)·1 − Σ, B = [h]×, C = m·1`.
    #[inline(always)]
    pub fn rigid(inertia: &SpatialInertia<S>) -> Self {
        Self {
            angular: inertia.rotational(),
            coupling: crossed(inertia.first, &Matrix3::identity()),
            linear: Matrix3::from_diagonal_element(inertia.mass),
        }
    }

    /// The wrench of an acceleration.
    #[inline(always)]
    pub fn apply(&self, a: &Twist<S>) -> Wrench<S> {
        Wrench {
            moment: rotate(&self.angular, a.angular) + rotate(&self.coupling, a.linear),
            force: rotate_back(&self.coupling, a.angular) + rotate(&self.linear, a.linear),
        }
    }

    /// The inertia after one degree of freedom is eliminated: I − U Uᵀ / D, with U = I S and 1 / D
    /// = 1 / Sᵀ I S.
    #[inline(always)]
    #[must_use]
    pub fn eliminating(&self, u: &Wrench<S>, inverse: S) -> Self {
        let (m, f) = (u.moment * inverse, u.force * inverse);
        Self {
            angular: upper(self.angular - m * u.moment.transpose()),
            coupling: self.coupling - m * u.force.transpose(),
            linear: upper(self.linear - f * u.force.transpose()),
        }
    }

    /// The same with degree of freedom `k` of the six free: zero along it.
    #[inline(always)]
    #[must_use]
    pub fn without(mut self, k: usize) -> Self {
        let (matrix, j) = if k < 3 { (&mut self.angular, k) } else { (&mut self.linear, k - 3) };
        for i in 0..3 {
            (matrix[(i, j)], matrix[(j, i)]) = (S::zero(), S::zero());
            let place = if k < 3 { (j, i) } else { (i, j) };
            self.coupling[place] = S::zero();
        }
        self
    }

    /// The same in other axes, to which `turn` takes vectors.
    #[inline(always)]
    #[must_use]
    pub fn turned(&self, turn: &Matrix3<S>) -> Self {
        let turned = |m: &Matrix3<S>| turn * m * turn.transpose();
        Self { angular: upper(turned(&self.angular)), coupling: turned(&self.coupling), linear: upper(turned(&self.linear)) }
    }

    /// The same in the axes that are turned back by an angle about z, given its sine and cosine.
    #[inline(always)]
    #[must_use]
    pub fn turned_about_z(&self, sin: S, cos: S) -> Self {
        let turned = |m: &Matrix3<S>| turned_about_z(m, sin, cos);
        Self { angular: turned(&self.angular), coupling: turned(&self.coupling), linear: turned(&self.linear) }
    }

    /// The same seen from the frame a, where `x_ab` places the frame b of this one.
    ///
    /// Turned, then `C' = C, B' = B + [p]× C, A' = A + [p]× Bᵀ − B'[p]×`.
    #[inline(always)]
    #[must_use]
    pub fn moved(&self, x_ab: &Placement<S>) -> Self {
        let p = x_ab.position;
        let Self { angular, coupling: before, linear } = self.turned(&x_ab.rotation);
        let coupling = before + crossed(p, &linear);
        // −B'[p]× = ([p]× B'ᵀ)ᵀ
        let angular = upper(angular + crossed(p, &before.transpose()) + crossed(p, &coupling.transpose()).transpose());
        Self { angular, coupling, linear }
    }
}

impl<S: Scalar> core::ops::AddAssign for ArticulatedInertia<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.angular += other.angular;
        self.coupling += other.coupling;
        self.linear += other.linear;
    }
}

/// [p]× M, column by column.
#[inline(always)]
fn crossed<S: Scalar>(p: nalgebra::Vector3<S>, m: &Matrix3<S>) -> Matrix3<S> {
    let column = |k: usize| p.cross(&m.column(k).into_owned());
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}

/// The upper triangle, mirrored.
#[inline(always)]
fn upper<S: Scalar>(m: Matrix3<S>) -> Matrix3<S> {
    Matrix3::new(m.m11, m.m12, m.m13, m.m12, m.m22, m.m23, m.m13, m.m23, m.m33)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Vector3, from_rpy};

    #[test]
    fn a_rigid_body_moves_as_its_moments_do() {
        let i = Matrix3::new(0.03, 0.001, -0.002, 0.001, 0.05, 0.0005, -0.002, 0.0005, 0.055);
        let x = Placement { rotation: from_rpy([0.4, -1.1, 2.0]), position: Vector3::new(0.15, 0.02, -0.01) };
        let y = Placement { rotation: from_rpy([-0.7, 0.2, 0.9]), position: Vector3::new(-0.4, 0.3, 0.8) };
        let g = SpatialInertia::from_central(2.0, i, &x);
        let (a, b) = (ArticulatedInertia::rigid(&g.moved(&y)), ArticulatedInertia::rigid(&g).moved(&y));
        assert!((a.angular - b.angular).amax() < 1e-14);
        assert!((a.coupling - b.coupling).amax() < 1e-14 && (a.linear - b.linear).amax() < 1e-14);
    }
}
