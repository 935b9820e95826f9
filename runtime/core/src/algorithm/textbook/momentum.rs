//! Momentum about the centre of mass.

use alloc::vec::Vec;

use nalgebra::Vector3;

use super::matrix::{halves, stack};
use super::{Textbook, slopes, varied};
use crate::Scalar;
use crate::spatial::{Placement, Reference};

impl<S: Scalar> Textbook<S> {
    /// [k; l] of the links that move: Σ (R k_i + p × R l_i) with [k_i; l_i] = G V, then about the
    /// centre of mass. `[6]`.
    pub fn centroidal_momentum(&self, q: &[S], v: &[S]) -> Vec<S> {
        let (mut k, mut l) = (Vector3::zeros(), Vector3::zeros());
        let (poses, twists) = (self.poses(q), self.body_twists(Reference::Body, q, v));
        for (i, body) in self.bodies.iter().enumerate().filter(|(_, b)| b.carried) {
            let (angular, linear) = halves(&(body.inertia * twists[i]));
            let Placement { rotation, position } = &poses[i];
            let linear = rotation * linear;
            k += rotation * angular + position.cross(&linear);
            l += linear;
        }
        // k_c = k_0 − c × l; where nothing that moves has mass there is no centre, and no momentum
        // about any point.
        let (heavy, centre) = (self.masses(q).0.positive(), Vector3::from_iterator(self.center_of_mass(q)));
        let centre = centre.map(|c| S::select(heavy, c, S::zero()));
        stack(k - centre.cross(&l), l).iter().copied().collect()
    }

    /// It for every unit of rate, `[6][nv]`.
    pub fn centroidal_momentum_matrix(&self, q: &[S]) -> Vec<S> {
        let columns: Vec<Vec<S>> = (0..self.nv).map(|k| self.centroidal_momentum(q, &self.unit(k))).collect();
        (0..6).flat_map(|i| columns.iter().map(move |c| c[i])).collect()
    }

    /// d/dt of it, `[6]`.
    pub fn centroidal_momentum_rate(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        slopes(&self.lift().centroidal_momentum(&self.along(q, v), &varied(v, a)))
    }
}
