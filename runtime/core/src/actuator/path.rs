//! Paths of straight lines over points of bodies: spatial tendons.
//!
//! ```text
//! l = Σ c Σ |p_{k+1} − p_k|            of each strand, between pulleys: c = 1/divisor
//! l̇ = Σ c Σ u · (ṗ_{k+1} − ṗ_k)        u: from p_k to p_{k+1}, of norm one
//! ```
//!
//! A line between points in one place pulls along the first axis of the world. Joints that move
//! both ends of a line have no entry in its part of ∂l/∂q. Source: MuJoCo documentation, XML
//! reference: tendon/spatial.

use alloc::vec::Vec;

use super::SiteFrame;
use crate::Scalar;
use crate::algorithm::{Placed, Workspace};
use crate::model::Model;
use crate::spatial::{Vector3, Wrench};

/// The part of a path between two pulleys.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand<S = f64> {
    /// Its points, of which the origins count.
    pub points: Vec<SiteFrame<S>>,
    /// Length of the path for a unit of this strand: one over the divisor of its pulley.
    pub factor: S,
}

impl<S: Scalar> Strand<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Strand<T> {
        Strand { points: self.points.iter().map(|point| point.map(f)).collect(), factor: f(self.factor) }
    }
}

/// Length and row of a path.
pub(crate) fn row<S: Scalar>(path: &[Strand<S>], bodies: &Placed<'_, S>) -> (S, Vec<(usize, S)>) {
    let (mut length, mut row): (S, Vec<(usize, S)>) = (S::zero(), Vec::new());
    let place = |own: &SiteFrame<S>| bodies.point(own.body, &own.placement);
    for strand in path {
        for ends in strand.points.windows(2) {
            let [from, to] = [&ends[0], &ends[1]];
            let apart = place(to) - place(from);
            let square = apart.dot(&apart);
            let is_apart = square.positive();
            let distance = S::select(is_apart, square, S::one()).sqrt();
            let first_axis = Vector3::new(S::one(), S::zero(), S::zero());
            let direction = Vector3::from_fn(|k, _| S::select(is_apart, apart[k] / distance, first_axis[k]));
            length += strand.factor * S::select(is_apart, distance, S::zero());
            if from.body == to.body {
                continue;
            }
            let w = Wrench { moment: Vector3::zeros(), force: direction * strand.factor };
            for (k, entry) in bodies.torques_between(to.parts(), from.parts(), &w) {
                match row.iter_mut().find(|(own, _)| *own == k) {
                    Some((_, sum)) => *sum += entry,
                    None => row.push((k, entry)),
                }
            }
        }
    }
    (length, row)
}

/// The length of a path at q `[nq]`, m, and ∂l/∂q: degrees of freedom, each with its entry.
pub fn path_at(model: &Model<f64>, ws: &mut Workspace<f64>, q: &[f64], path: &[Strand]) -> (f64, Vec<(usize, f64)>) {
    row(path, &Placed::at(model, ws, q))
}
