//! Joints whose motion carries no mass.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::{Body, Model};
use crate::algorithm::Workspace;
use crate::algorithm::checked::least_pivot;
use crate::effect::{EffectId, Enters, JointEffect};
use crate::index::{BodyId, ById};
use crate::monitor::pivot_cancellation;
use crate::spatial::SpatialInertia;

/// Largest number of passes over the joints, with those found before held: a robot has few of them,
/// and the search must end.
const LOOKS: usize = 64;

impl Model<f64> {
    /// Indices of the bodies whose joint moves nothing that has mass, whatever the configuration:
    /// the mass matrix has a zero row there, and forward dynamics is not defined.
    ///
    /// A turn moves something if its body has mass off the axis or inertia about it, or if anything
    /// farther out has mass; a slide, if anything from its body on has mass, added mass of a fluid
    /// too. Only exact zeros count as none. A joint that follows another adds to the other's row. A
    /// joint that moves no mass but what others farther out can move in the same way is among them
    /// too: two coaxial joints with a body without mass between, four axes through one point.
    pub fn massless_joints(&self) -> Vec<BodyId> {
        let (mut carries, mut own) = (vec![false; self.nv], vec![false; self.nv]);
        for (i, felt, moves) in self.moves_mass() {
            let at = self.own_freedoms(i);
            carries[at.clone()].iter_mut().for_each(|carries| *carries |= moves);
            own[at].iter_mut().for_each(|own| *own |= felt);
        }
        let idle = || carries.iter().map(|moves| !moves).collect();
        let repeats = if own.contains(&false) { self.repeated(idle()) } else { vec![false; self.nv] };
        let lost = |i: &BodyId| {
            let mut freedoms = self.own_freedoms(*i);
            self.bodies[*i].coordinates.mimic.is_none() && freedoms.any(|k| !carries[k] || !own[k] && repeats[k])
        };
        self.outward().filter(lost).collect()
    }

    /// The degrees of freedom of a body's joint, or of that which it follows.
    fn own_freedoms(&self, body: BodyId) -> Range<usize> {
        let Body { coordinates: at, joint, .. } = &self.bodies[body];
        at.v..at.v + joint.nv()
    }

    /// For each degree of freedom, whether its pivot is lost at two generic configurations: a robot
    /// that is singular there is singular everywhere. `idle` move nothing. Each lost one gets a
    /// rotor before the next pass, so that its 0/0 does not reach the joints that carry it.
    fn repeated(&self, idle: Vec<bool>) -> Vec<bool> {
        let (mut model, mut ws) = (self.clone(), Workspace::new(self));
        let (mut lost, mut fresh) = (idle.clone(), idle);
        for _ in 0..LOOKS {
            model.turn_rotors(&fresh);
            fresh = model.without_pivot(&mut ws);
            if !fresh.contains(&true) {
                break;
            }
            lost.iter_mut().zip(&fresh).for_each(|(lost, fresh)| *lost |= fresh);
        }
        lost
    }

    /// A rotor of 1 kg·m² (kg) for each of these degrees of freedom.
    fn turn_rotors(&mut self, of: &[bool]) {
        for body in self.bodies.iter_mut().skip(1).filter(|body| body.coordinates.mimic.is_none()) {
            let own = &of[body.coordinates.v..][..body.joint.nv()];
            let rotors = own.iter().enumerate().filter(|(_, has)| **has);
            let rotors = rotors.map(|(freedom, _)| JointEffect { effect: EffectId::armature, freedom, parameters: vec![1.0, 1.0] });
            body.effects.joint.extend(rotors);
        }
    }

    /// The degrees of freedom with a lost pivot, of each branch the farthest out: the pivots of
    /// others then mean little.
    fn without_pivot(&self, ws: &mut Workspace<f64>) -> Vec<bool> {
        let mut left = vec![1.0; self.nv];
        let mut gone = |seed: f64| {
            pivot_cancellation(self, ws, &self.configuration(seed), &mut left);
            // A pivot below zero, of an impossible inertia that was accepted, is not a lost one.
            left.iter().map(|x| x.is_nan() || crate::Scalar::abs(*x) < least_pivot()).collect::<Vec<bool>>()
        };
        let (first, second) = (gone(0.137), gone(0.731));
        let mut found: Vec<bool> = first.iter().zip(second).map(|(a, b)| *a && b).collect();
        let mut beyond: ById<BodyId, bool> = vec![false; self.bodies.len()].into();
        for i in self.inward() {
            let body = &self.bodies[i];
            // The coordinate of one that follows is that of its leader.
            let own = if body.coordinates.mimic.is_some() { 0..0 } else { self.own_freedoms(i) };
            if beyond[i] {
                found[own.clone()].fill(false);
            }
            beyond[body.parent] |= beyond[i] || found[own].contains(&true);
        }
        found
    }

    /// A configuration without symmetries: multiples of the golden section, modulo 1.
    fn configuration(&self, seed: f64) -> Vec<f64> {
        let mut q: Vec<f64> = (0..self.nq).map(|k| 0.1 + (seed + 0.618_033_988_749_895 * k as f64) % 1.0).collect();
        for body in self.bodies.iter().skip(1) {
            if let Some(first) = body.joint.quaternion() {
                let quaternion = &mut q[body.coordinates.q + first..][..4];
                let norm = crate::Scalar::sqrt(quaternion.iter().map(|x| x * x).sum::<f64>());
                quaternion.iter_mut().for_each(|x| *x /= norm);
            }
        }
        q
    }

    /// For each moving body, whether its own mass or a rotor is sure to be felt by all of its
    /// joint, and whether its joint alone moves mass.
    fn moves_mass(&self) -> Vec<(BodyId, bool, bool)> {
        // Whether anything beyond a body's joint has mass: first among its children, then with the
        // body itself.
        let mut beyond: ById<BodyId, bool> = vec![false; self.bodies.len()].into();
        let mut moves = Vec::with_capacity(self.bodies.len());
        for i in self.inward() {
            let (body, outside) = (&self.bodies[i], beyond[i]);
            let own = &body.inertia;
            let felt = body.joint.has_inertia(own) || turns_rotors(body);
            // Added mass need not be felt along every axis: the pivots decide.
            let added = has_added_mass(body);
            // Of several degrees of freedom some may be felt and others not: a point mass turns
            // freely. A follower may cancel the effect of its leader.
            let sure = felt && body.joint.nv() == 1 && body.coordinates.mimic.is_none();
            moves.push((i, sure, felt || added || outside));
            beyond[body.parent] |= outside || added || *own != SpatialInertia::zero();
        }
        moves
    }
}

fn has_added_mass(body: &Body<f64>) -> bool {
    body.effects.body.iter().any(|e| e.effect.row().enters == Enters::Added)
}

/// Whether every degree of freedom of the body's joint turns a rotor, which has inertia whatever
/// hangs on it.
fn turns_rotors(body: &Body<f64>) -> bool {
    let rotor = |k: usize| body.effects.joint.iter().any(|e| e.effect.row().enters == Enters::Inertia && e.freedom == k);
    (0..body.joint.nv()).all(rotor)
}
