//! Inverse inertias in the reference pose, from which MuJoCo takes the strength of constraints.
//!
//! ```text
//! of a point of a body:     tr(J_p M⁻¹ J_pᵀ) / 3 of its velocity, tr(J_ω M⁻¹ J_ωᵀ) / 3 of its turn
//! of a tendon:              J M⁻¹ Jᵀ of its length
//! of a degree of freedom:   its entry of the diagonal of M⁻¹, the mean over those of one ball, of
//!                           the turns and of the translations of a free joint
//! ```
//!
//! Source: MuJoCo documentation, XML reference: invweight0.

use alloc::vec;
use alloc::vec::Vec;

use crate::algorithm::manifold::Space;
use crate::algorithm::{Placed, Workspace, mass_matrix_inverse};
use crate::index::BodyId;
use crate::model::Model;
use crate::spatial::{Placement, Vector3};

/// Inverse inertias.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// Of each point: of its velocity, 1/kg, and of its turn, 1/(kg·m²).
    pub points: Vec<[f64; 2]>,
    /// Of each degree of freedom.
    pub freedoms: Vec<f64>,
    /// Of each sum of coordinates: J M⁻¹ Jᵀ.
    pub sums: Vec<f64>,
}

/// Inverse inertias at q `[nq]` of these points of bodies, each in the frame of its body, and of
/// these sums, each with degrees of freedom and their factors.
pub fn weights(model: &Model<f64>, q: &[f64], points: &[(BodyId, [f64; 3])], sums: &[Vec<(usize, f64)>]) -> Weights {
    let (nv, mut ws) = (model.nv(), Workspace::new(model));
    let mut inverse = vec![0.0; nv * nv];
    mass_matrix_inverse(model, &mut ws, q, &mut inverse);
    let placed = Placed::at(model, &mut ws, q);
    let of_point = |(body, point): &(BodyId, [f64; 3])| {
        let at = placed.frame(*body, &Placement { position: Vector3::from(*point), ..Placement::identity() }).position;
        let columns = placed.columns(at).filter(|(own, ..)| !body.is_base() && model.is_on_the_way(*own, *body));
        let columns: Vec<_> = columns.collect();
        let linear: Vec<_> = columns.iter().map(|(_, at, axis)| (*at, axis.linear)).collect();
        let angular: Vec<_> = columns.iter().map(|(_, at, axis)| (*at, axis.angular)).collect();
        let trace = |columns: &[(usize, Vector3<f64>)]| -> f64 {
            let row = |(i, a): &(usize, Vector3<f64>)| columns.iter().map(|(j, b)| inverse[i * nv + j] * a.dot(b)).sum::<f64>();
            columns.iter().map(row).sum::<f64>() / 3.0
        };
        [trace(&linear), trace(&angular)]
    };
    let mut freedoms: Vec<f64> = (0..nv).map(|k| inverse[k * nv + k]).collect();
    for joint in model.joints().iter().filter(|joint| !matches!(Space::of(joint.kind), Space::Numbers)) {
        for three in freedoms[joint.v.0..][..joint.v.1].chunks_mut(3) {
            three.fill(three.iter().sum::<f64>() / 3.0);
        }
    }
    let of_sum = |sum: &Vec<(usize, f64)>| {
        let row = |(i, a): &(usize, f64)| sum.iter().map(|(j, b)| a * b * inverse[i * nv + j]).sum::<f64>();
        sum.iter().map(row).sum()
    };
    Weights { points: points.iter().map(of_point).collect(), freedoms, sums: sums.iter().map(of_sum).collect() }
}
