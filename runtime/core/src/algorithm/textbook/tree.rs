//! A robot at one configuration, in the symbols of the recursions: λ, Ad, S, Ṡ q̇, G.

use alloc::vec::Vec;

use nalgebra::{DVector, Matrix6, Matrix6xX, Vector3, Vector6};

use super::matrix::inverse_adjoint;
use super::{Link, Textbook};
use crate::Scalar;

/// The bodies of a robot at one configuration, parents first: all that [`rnea`](super::rnea::rnea),
/// [`crba`](super::crba::crba) and [`aba`](super::aba::aba) read. Its fields are public, so that a
/// reader can build or change one.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree<S: Scalar> {
    /// The bodies; a parent comes before its children.
    pub bodies: Vec<TreeBody<S>>,
    /// g in the world frame, m/s².
    pub gravity: Vector3<S>,
    /// Number of rates: the length of q̇, q̈ and τ.
    pub nv: usize,
}

/// One body, and the joint that carries it. Vectors of six are (angular; linear), in axes of the
/// body and about its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeBody<S: Scalar> {
    /// λ(i), the body that carries this one; `None` for the world.
    pub parent: Option<usize>,
    /// Ad(T_iλ), which takes a twist in axes of the parent to axes of the body.
    pub adjoint: Matrix6<S>,
    /// S_i: one column for each rate of the joint.
    pub screws: Matrix6xX<S>,
    /// Ṡ_i q̇_i; zero for a joint whose screws are the same at every q.
    pub screw_rate: Vector6<S>,
    /// G_i about the origin of the body.
    pub inertia: Matrix6<S>,
    /// Place of the joint's first rate in q̇, q̈ and τ.
    pub at: usize,
}

impl<S: Scalar> TreeBody<S> {
    /// q̇_i of q̇, or q̈_i of q̈, or τ_i of τ.
    pub fn part(&self, all: &[S]) -> DVector<S> {
        DVector::from_column_slice(&all[self.at..][..self.screws.ncols()])
    }
}

impl<S: Scalar> Textbook<S> {
    /// The bodies at q: `[nq]`, moving at v: `[nv]`. A joint that follows another one has the
    /// screws and the place of its leader's rates, times the slope of its law.
    ///
    /// # Panics
    /// If a slice is shorter than stated.
    pub fn at(&self, q: &[S], v: &[S]) -> Tree<S> {
        let body = |b: &Link<S>| {
            let (screws, multiplier) = (b.joint.screws(q), b.joint.multiplier(q));
            TreeBody {
                parent: b.parent,
                adjoint: inverse_adjoint(&b.placement.compose(&b.joint.placement(q))),
                screws: Matrix6xX::from_fn(screws.len(), |i, k| screws[k][i] * multiplier),
                screw_rate: b.joint.bias(q, v),
                inertia: b.inertia,
                at: b.joint.seat.v,
            }
        };
        Tree { bodies: self.bodies.iter().map(body).collect(), gravity: self.gravity, nv: self.nv }
    }
}
