//! Placements of frames (elements of SE(3)).

use nalgebra::{Matrix3, Vector3};

use super::rotate;
use crate::Scalar;

/// `x_ab`: the frame b in the frame a. A point with components r in b is at R·r + p in a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement<S> {
    /// R: its columns are the axes of b in a.
    pub rotation: Matrix3<S>,
    /// p: the origin of b in a, m.
    pub position: Vector3<S>,
}

impl<S: Scalar> Placement<S> {
    /// The frame itself.
    pub fn identity() -> Self {
        Self { rotation: Matrix3::identity(), position: Vector3::zeros() }
    }

    /// R·r + p.
    #[inline(always)]
    pub fn transform(&self, r: Vector3<S>) -> Vector3<S> {
        rotate(&self.rotation, r) + self.position
    }

    /// `x_ac = x_ab · x_bc`.
    #[inline(always)]
    pub fn compose(&self, x_bc: &Self) -> Self {
        let column = |k: usize| rotate(&self.rotation, x_bc.rotation.column(k).into_owned());
        Self { rotation: Matrix3::from_columns(&[column(0), column(1), column(2)]), position: self.transform(x_bc.position) }
    }

    /// Row-major rotation, then position: the twelve numbers of [R | p] as the interface gives
    /// them.
    pub fn to_array(&self) -> [S; 12] {
        let (r, p) = (&self.rotation, &self.position);
        [r.m11, r.m12, r.m13, r.m21, r.m22, r.m23, r.m31, r.m32, r.m33, p.x, p.y, p.z]
    }

    /// The same placement in another scalar.
    #[cfg(feature = "alloc")]
    pub(crate) fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Placement<T> {
        Placement { rotation: self.rotation.map(f), position: self.position.map(f) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::from_rpy;

    #[test]
    fn composition_is_transformation_after_transformation() {
        let a = Placement { rotation: from_rpy([0.1, 0.2, 0.3]), position: Vector3::new(1.0, 2.0, 3.0) };
        let b = Placement { rotation: from_rpy([-0.4, 0.9, 2.3]), position: Vector3::new(-0.5, 0.2, 0.7) };
        let r = Vector3::new(0.3, -0.6, 0.9);
        let difference: Vector3<f64> = a.compose(&b).transform(r) - a.transform(b.transform(r));
        assert!(difference.amax() < 1e-15);
    }
}
