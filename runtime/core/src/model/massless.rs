//! Joints whose motion carries no mass.

use alloc::vec;
use alloc::vec::Vec;

use super::{Body, Model};
use crate::algorithm::Workspace;
use crate::algorithm::checked::least_pivot;
use crate::effect::EffectId;
use crate::monitor::pivot_cancellation;
use crate::spatial::SpatialInertia;

impl Model<f64> {
    /// Indices of the bodies whose joint moves nothing that has mass, whatever the configuration: the mass matrix has a zero row there, and
    /// forward dynamics is not defined.
    ///
    /// A turn moves something if its body has mass off the axis or inertia about it, or if anything farther out has mass; a slide, if anything from its
    /// body on has mass, added mass of a fluid too. Only exact zeros count as none. A joint that follows another adds to the other's row. A joint that moves no mass but what others farther out
    /// can move in the same way is among them too: two coaxial joints with a body without mass between, four axes through one point.
    pub fn massless_joints(&self) -> Vec<usize> {
        let (mut carries, mut own) = (vec![false; self.nv], vec![false; self.nv]);
        for (i, felt, moves) in self.moves_mass() {
            let at = self.bodies[i].coordinates.v;
            carries[at] |= moves;
            own[at] |= felt;
        }
        let repeats = if own.contains(&false) { self.repeated() } else { vec![false; self.nv] };
        let lost = |i: &usize| {
            let at = &self.bodies[*i].coordinates;
            let repeated = (at.v..at.v + self.bodies[*i].joint.nv()).any(|k| repeats[k]);
            at.mimic.is_none() && (!carries[at.v] || !own[at.v] && repeated)
        };
        self.outward().filter(lost).collect()
    }

    /// For each degree of freedom, whether nothing is left of its pivot at two configurations that have nothing special: what is singular there is singular everywhere.
    fn repeated(&self) -> Vec<bool> {
        let (mut ws, mut left) = (Workspace::new(self), vec![1.0; self.nv]);
        let mut lost = |seed: f64| {
            pivot_cancellation(self, &mut ws, &self.configuration(seed), &mut left);
            // A pivot below zero, of an inertia that no body has and somebody accepted, is not nothing.
            left.iter().map(|x| x.is_nan() || crate::Scalar::abs(*x) < least_pivot()).collect::<Vec<bool>>()
        };
        let (first, second) = (lost(0.137), lost(0.731));
        first.iter().zip(second).map(|(a, b)| *a && b).collect()
    }

    /// A configuration without symmetries: multiples of the golden section, modulo 1.
    fn configuration(&self, seed: f64) -> Vec<f64> {
        let mut q: Vec<f64> = (0..self.nq).map(|k| 0.1 + (seed + 0.618_033_988_749_895 * k as f64) % 1.0).collect();
        for body in self.bodies.iter().skip(1) {
            let end = body.coordinates.q + body.joint.nq();
            if body.joint.nq() > 1 {
                let norm = crate::Scalar::sqrt(q[end - 4..end].iter().map(|x| x * x).sum::<f64>());
                q[end - 4..end].iter_mut().for_each(|x| *x /= norm);
            }
        }
        q
    }

    /// For each moving body, whether its own mass or a rotor is sure to be felt by all of its joint, and whether its joint alone moves mass.
    fn moves_mass(&self) -> Vec<(usize, bool, bool)> {
        // Whether anything beyond a body's joint has mass: first of what hangs on the body, then with the body itself.
        let mut beyond = vec![false; self.bodies.len()];
        let mut moves = Vec::with_capacity(self.bodies.len());
        for i in self.inward() {
            let (body, outside) = (&self.bodies[i], beyond[i]);
            let own = &body.inertia;
            let felt = body.joint.feels(own) || turns_rotors(body);
            // Added mass need not be felt along every axis: numbers tell.
            let added = has_added_mass(body);
            // Of several degrees of freedom some may be felt and others not: a point mass turns freely. What follows another may undo what that does.
            let sure = felt && body.joint.nv() == 1 && body.coordinates.mimic.is_none();
            moves.push((i, sure, felt || added || outside));
            beyond[body.parent] |= outside || added || *own != SpatialInertia::zero();
        }
        moves
    }
}

fn has_added_mass(body: &Body<f64>) -> bool {
    body.effects.body.iter().any(|e| e.effect == EffectId::added_mass)
}

/// Whether every degree of freedom of the body's joint turns a rotor, which has inertia whatever hangs on it.
fn turns_rotors(body: &Body<f64>) -> bool {
    let rotor = |k: usize| body.effects.joint.iter().any(|e| e.effect == EffectId::armature && e.freedom == k);
    (0..body.joint.nv()).all(rotor)
}
