//! Derivatives of inverse and forward dynamics, by dual numbers.

use alloc::vec::Vec;

use super::{Textbook, constant, slopes, varied};
use crate::Scalar;

/// A matrix by its columns.
type Columns<S> = Vec<Vec<S>>;

/// Row by row.
fn rows<S: Scalar>(columns: &Columns<S>) -> Vec<S> {
    (0..columns.len()).flat_map(|i| columns.iter().map(move |c| c[i])).collect()
}

impl<S: Scalar> Textbook<S> {
    /// Columns of ∂τ/∂q, in the tangent space, wrenches constant in their reference.
    fn by_configuration(&self, q: &[S], v: &[S], a: &[S], wrenches: &[S]) -> Columns<S> {
        let (lifted, [v, a, w]) = (self.lift(), [v, a, wrenches].map(constant));
        (0..self.nv).map(|k| slopes(&lifted.inverse_dynamics_with_wrenches(&self.along(q, &self.unit(k)), &v, &a, &w))).collect()
    }

    /// Columns of ∂τ/∂v.
    fn by_rates(&self, q: &[S], v: &[S]) -> Columns<S> {
        let (lifted, q, a) = (self.lift(), constant(q), constant(&self.rest()));
        (0..self.nv).map(|k| slopes(&lifted.inverse_dynamics(&q, &varied(v, &self.unit(k)), &a))).collect()
    }

    /// ∂τ/∂q, ∂τ/∂v, ∂τ/∂a = M: `[3][nv][nv]`.
    pub fn inverse_dynamics_derivatives(&self, q: &[S], v: &[S], a: &[S], wrenches: &[S]) -> Vec<S> {
        let parts = [rows(&self.by_configuration(q, v, a, wrenches)), rows(&self.by_rates(q, v)), self.mass_matrix(q)];
        parts.concat()
    }

    /// ∂(static torque)/∂q: `[nv][nv]`.
    pub fn static_torque_derivative(&self, q: &[S], wrenches: &[S]) -> Vec<S> {
        rows(&self.by_configuration(q, &self.rest(), &self.rest(), wrenches))
    }

    /// ∂a/∂q = −M⁻¹ ∂τ/∂q, ∂a/∂v = −M⁻¹ ∂τ/∂v, ∂a/∂τ = M⁻¹: `[3][nv][nv]`. For M a + h = τ,
    /// differentiated with τ constant.
    pub fn forward_dynamics_derivatives(&self, q: &[S], v: &[S], tau: &[S], wrenches: &[S]) -> Vec<S> {
        let factor = self.factored_mass_matrix(q);
        let a = self.forward_dynamics_with_wrenches(q, v, tau, wrenches);
        let solved =
            |columns: Columns<S>| -> Vec<S> { rows(&columns.iter().map(|c| factor.solve(c).into_iter().map(|x| -x).collect()).collect()) };
        [solved(self.by_configuration(q, v, &a, wrenches)), solved(self.by_rates(q, v)), factor.inverse()].concat()
    }
}
