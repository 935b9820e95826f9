//! Regressors: results for a link whose only inertia is the unit of one parameter.
//!
//! Parameters of a link: m, h = m c, and I about the link's origin: xx, xy, xz, yy, yz, zz, in its
//! axes. The link is the first that a moving joint carries, with everything fixed to it.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::Textbook;
use super::matrix::{adjoint, blocks, cross_matrix, inverse_adjoint, mass_and_moment};
use super::rnea::{inward, needed, outward};
use crate::Scalar;
use crate::spatial::Reference;

/// Number of parameters of a link.
const PARAMETERS: usize = 10;

/// Rows and columns of I_xx, I_xy, I_xz, I_yy, I_yz, I_zz.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// G of a link with the unit of parameter k and nothing else.
fn unit_inertia<S: Scalar>(k: usize) -> Matrix6<S> {
    let (zero, one) = (Matrix3::zeros(), Matrix3::identity());
    match k {
        0 => blocks(&zero, &zero, &zero, &one),
        1..=3 => {
            let h = cross_matrix(Vector3::from_fn(|i, _| if i == k - 1 { S::one() } else { S::zero() }));
            blocks(&zero, &h, &h.transpose(), &zero)
        }
        _ => {
            let (i, j) = ENTRIES[k - 4];
            let mut inertia = Matrix3::zeros();
            inertia[(i, j)] = S::one();
            inertia[(j, i)] = S::one();
            blocks(&inertia, &zero, &zero, &zero)
        }
    }
}

impl<S: Scalar> Textbook<S> {
    /// (link, G) of every parameter of every moving link.
    fn unit_links(&self) -> impl Iterator<Item = (usize, Matrix6<S>)> + '_ {
        self.moving_links().into_iter().flat_map(|i| (0..PARAMETERS).map(move |k| (i, unit_inertia(k))))
    }

    /// π of the moving links, `[links][10]`.
    pub fn parameters(&self) -> Vec<S> {
        let seats = self.seats();
        let mut inertia = vec![Matrix6::<S>::zeros(); self.bodies.len()];
        for (body, seat) in self.bodies.iter().zip(&seats) {
            // Gᵖ = Ad(T_ip)ᵀ G Ad(T_ip)
            let adjoint = inverse_adjoint(&seat.1);
            inertia[seat.0] += adjoint.transpose() * body.inertia * adjoint;
        }
        let numbers = |g: &Matrix6<S>| {
            let (m, h) = mass_and_moment(g);
            let moments: Vec<S> = ENTRIES.iter().map(|&at| g[at]).collect();
            [&[m], h.as_slice(), &moments].concat()
        };
        let of_link = |i: usize| {
            let to_link = adjoint(&seats[i].1);
            to_link.transpose() * inertia[seats[i].0] * to_link
        };
        self.moving_links().into_iter().flat_map(|i| numbers(&of_link(i))).collect()
    }

    /// Y with τ = Y π, `[nv][links][10]`.
    pub fn torque_regressor(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        let tree = self.at(q, v);
        let motion = outward(&tree, v, a);
        let column = |(i, g): (usize, Matrix6<S>)| {
            let mut wrench = vec![Vector6::zeros(); self.bodies.len()];
            wrench[i] = needed(&g, &motion[i]);
            inward(&tree, &mut wrench)
        };
        let columns: Vec<Vec<S>> = self.unit_links().map(column).collect();
        (0..self.nv).flat_map(|i| columns.iter().map(move |c| c[i])).collect()
    }

    /// v, v/√(v² + s²) with s = 1e-5 and a of each degree of freedom, `[nv][3]`: per damping, dry
    /// friction and armature.
    pub fn joint_regressor(&self, v: &[S], a: &[S]) -> Vec<S> {
        let smooth = S::from_f64(1e-5);
        v.iter().zip(a).flat_map(|(&v, &a)| [v, v / (smooth * smooth + v * v).sqrt(), a]).collect()
    }

    /// y with T = y·π, `[links][10]`.
    pub fn kinetic_energy_regressor(&self, q: &[S], v: &[S]) -> Vec<S> {
        let twists = self.body_twists(Reference::Body, q, v);
        self.unit_links().map(|(i, g)| twists[i].dot(&(g * twists[i])) * S::from_f64(0.5)).collect()
    }

    /// y with U = y·π, `[links][10]`.
    pub fn potential_energy_regressor(&self, q: &[S]) -> Vec<S> {
        let poses = self.poses(q);
        let one = |(i, g): (usize, Matrix6<S>)| {
            let (m, h) = mass_and_moment(&g);
            -self.gravity.dot(&(poses[i].position * m + poses[i].rotation * h))
        };
        self.unit_links().map(one).collect()
    }
}
