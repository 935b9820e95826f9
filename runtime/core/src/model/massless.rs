//! Joints whose motion carries no mass.

use alloc::vec;
use alloc::vec::Vec;

use super::Model;
use crate::joint::Joint;
use crate::spatial::SpatialInertia;

impl Model<f64> {
    /// Indices of the bodies whose joint moves nothing that has mass, whatever the configuration: the mass matrix has a zero row there, and
    /// forward dynamics is not defined.
    ///
    /// A turn moves something if its body has mass off the axis or inertia about it, or if anything farther out has mass; a slide, if anything from its
    /// body on has mass. Only exact zeros count as none. A joint that follows another adds to the other's row.
    pub fn massless_joints(&self) -> Vec<usize> {
        let mut carries = vec![false; self.nv];
        for (i, moves) in self.moves_mass() {
            carries[self.bodies[i].coordinates.v] |= moves;
        }
        self.outward().filter(|&i| self.bodies[i].coordinates.mimic.is_none() && !carries[self.bodies[i].coordinates.v]).collect()
    }

    /// For each moving body, whether its joint alone moves mass.
    fn moves_mass(&self) -> Vec<(usize, bool)> {
        // Whether anything beyond a body's joint has mass: first of what hangs on the body, then with the body itself.
        let mut beyond = vec![false; self.bodies.len()];
        let mut moves = Vec::with_capacity(self.bodies.len());
        for i in self.inward() {
            let (body, outside) = (&self.bodies[i], beyond[i]);
            let own = &body.inertia;
            let felt = match body.joint {
                // I_zz = Σ_xx + Σ_yy
                Joint::Revolute => own.second.m11 + own.second.m22 != 0.0,
                Joint::Prismatic => own.mass != 0.0,
                Joint::Helical => own.mass != 0.0 || own.second.m11 + own.second.m22 != 0.0,
                Joint::Spherical => (0..3).all(|k| own.rotational()[(k, k)] != 0.0),
                Joint::Floating => *own != SpatialInertia::zero(),
            };
            moves.push((i, felt || outside));
            beyond[body.parent] |= outside || *own != SpatialInertia::zero();
        }
        moves
    }
}
