//! Energies and the centre of mass: sums over the links that move.

use alloc::vec::Vec;

use nalgebra::Vector3;

use super::matrix::mass_and_moment;
use super::{Textbook, slopes, varied};
use crate::Scalar;
use crate::spatial::Reference;

impl<S: Scalar> Textbook<S> {
    /// Σ m and Σ m c in the world frame, of the links that move.
    pub(super) fn masses(&self, q: &[S]) -> (S, Vector3<S>) {
        let poses = self.poses(q);
        let carried = self.bodies.iter().zip(&poses).filter(|(body, _)| body.carried);
        carried.fold((S::zero(), Vector3::zeros()), |(mass, moment), (body, x)| {
            let (m, h) = mass_and_moment(&body.inertia);
            (mass + m, moment + x.position * m + x.rotation * h)
        })
    }

    /// T = ½ Σ Vᵀ G V.
    pub fn kinetic_energy(&self, q: &[S], v: &[S]) -> S {
        let twists = self.body_twists(Reference::Body, q, v);
        let bodies = self.bodies.iter().zip(&twists).filter(|(body, _)| body.carried);
        bodies.fold(S::zero(), |sum, (body, v)| sum + v.dot(&(body.inertia * v))) * S::from_f64(0.5)
    }

    /// U = −Σ m gᵀ c.
    pub fn potential_energy(&self, q: &[S]) -> S {
        -self.gravity.dot(&self.masses(q).1)
    }

    /// Σ m c / Σ m, `[3]`.
    pub fn center_of_mass(&self, q: &[S]) -> Vec<S> {
        let (mass, moment) = self.masses(q);
        moment.iter().map(|&x| x / mass).collect()
    }

    /// d/dt of it, `[3]`.
    pub fn center_of_mass_velocity(&self, q: &[S], v: &[S]) -> Vec<S> {
        slopes(&self.lift().center_of_mass(&self.along(q, v)))
    }

    /// d²/dt² of it, `[3]`.
    pub fn center_of_mass_acceleration(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        slopes(&self.lift().center_of_mass_velocity(&self.along(q, v), &varied(v, a)))
    }

    /// Its velocity for every unit of rate, `[3][nv]`.
    pub fn center_of_mass_jacobian(&self, q: &[S]) -> Vec<S> {
        let columns: Vec<Vec<S>> = (0..self.nv).map(|k| self.center_of_mass_velocity(q, &self.unit(k))).collect();
        (0..3).flat_map(|i| columns.iter().map(move |c| c[i])).collect()
    }
}
