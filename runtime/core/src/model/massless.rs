//! Joints whose motion carries no mass.

use alloc::vec;
use alloc::vec::Vec;

use super::Model;
use crate::joint::Joint;
use crate::spatial::{Placement, SpatialInertia};

impl Model<f64> {
    /// Indices of the bodies whose joint moves nothing that has mass, whatever the configuration: the mass matrix has a zero row there, and
    /// forward dynamics is not defined.
    ///
    /// A turn moves something if the subtree has mass off its axis or inertia about it; a slide, if the subtree has mass.
    /// A joint that follows another adds to the other's row, so only rows without any contribution count.
    pub fn massless_joints(&self) -> Vec<usize> {
        let moved = self.moved_alone();
        let mut carries = vec![false; self.nv];
        for i in self.outward() {
            let v = self.bodies[i].coordinates.v;
            carries[v] |= moved[i];
        }
        self.outward().filter(|&i| self.bodies[i].coordinates.mimic.is_none() && !carries[self.bodies[i].coordinates.v]).collect()
    }

    /// For each body: whether its joint moves mass. Exact zeros count, not small numbers.
    fn moved_alone(&self) -> Vec<bool> {
        let mut subtree_has_mass: Vec<bool> = self.bodies.iter().map(|b| b.inertia != SpatialInertia::zero()).collect();
        let mut moves = vec![false; self.bodies.len()];
        for i in self.inward() {
            let body = &self.bodies[i];
            let below = self.outward().skip(i).any(|c| self.bodies[c].parent == i && subtree_has_mass[c]);
            moves[i] = match body.joint {
                Joint::Revolute => below_moves(self, i, &subtree_has_mass) || spins(&body.inertia),
                Joint::Prismatic => below || body.inertia.mass != 0.0,
                Joint::Floating => body.inertia.mass != 0.0 || below,
            };
            if subtree_has_mass[i] {
                subtree_has_mass[body.parent] = true;
            }
        }
        moves
    }
}

/// Mass off the axis, or inertia about it: I_zz = Σ_xx + Σ_yy.
fn spins(inertia: &SpatialInertia<f64>) -> bool {
    inertia.second.m11 + inertia.second.m22 != 0.0
}

/// Whether a child's mass is moved by a turn of body `i`: always, unless the child only turns about the same axis and has nothing off it.
fn below_moves(model: &Model<f64>, i: usize, has_mass: &[bool]) -> bool {
    model.outward().skip(i).any(|c| model.bodies[c].parent == i && has_mass[c] && !only_on_axis(model, c))
}

/// A body on its parent's axis with all its mass on that axis and no child with mass.
fn only_on_axis(model: &Model<f64>, c: usize) -> bool {
    let body = &model.bodies[c];
    let x: &Placement<f64> = &body.placement;
    let along = x.rotation.m13 == 0.0 && x.rotation.m23 == 0.0 && x.position.x == 0.0 && x.position.y == 0.0;
    let leaf = model.outward().all(|k| model.bodies[k].parent != c);
    body.joint == Joint::Revolute && along && leaf && !spins(&body.inertia)
}
