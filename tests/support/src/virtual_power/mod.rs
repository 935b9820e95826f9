//! Inverse dynamics by virtual power: no recursion, no wrench, no Coriolis term.
//!
//! Every link's placement is written as a function of time along the motion (q, v, a) and
//! differentiated twice ([`Jet`]); a joint's torque is then the power of the forces r̈ − g of all
//! mass points for a unit of that joint's rate (d'Alembert; Lanczos, *The Variational Principles of
//! Mechanics*, 1970, ch. IV):
//!
//! τ_k = Σ_i ∫ (r̈ − g)·∂ṙ/∂v_k dm = Σ_i m (c̈ − g)·∂ċ/∂v_k + tr(R̈ Σ_c (∂Ṙ/∂v_k)ᵀ),   Σ_c = ½ tr(I)·1 − I
//!
//! It starts from the numbers of the file and shares only the scalar with the crates that it
//! judges.

mod pose;
mod scale;

use articulated_core::Scalar;
use articulated_core::description::{Base, ById, Description, JointId, LinkId};
use nalgebra::{Matrix3, Vector3};

use crate::jet::Jet;
use pose::{Pose, compose, free, joint_pose, place};

/// A described robot as placements in motion.
#[derive(Clone, Debug)]
pub struct Motions<'a> {
    description: &'a Description,
    base: Base,
    gravity: [f64; 3],
    /// Joints with a coordinate or more, in the order of the vectors: file index, first index in q,
    /// first in v. `None` is the base.
    coordinates: Vec<(Option<usize>, usize, usize)>,
    /// Lengths of q and v.
    pub size: (usize, usize),
}

/// Energies and their rates.
#[derive(Clone, Copy, Debug)]
pub struct Energy<S> {
    /// T, J.
    pub kinetic: S,
    /// U, J; 0 for mass at the origin of the world frame.
    pub potential: S,
    /// d(T + U)/dt, W.
    pub power: S,
}

impl<'a> Motions<'a> {
    /// From a description that is a tree; gravity in the world frame, m/s².
    pub fn new(description: &'a Description, base: Base, gravity: [f64; 3]) -> Self {
        let mut this = Self { description, base, gravity, coordinates: Vec::new(), size: (0, 0) };
        if base == Base::Floating {
            this.add(None, 7, 6);
        }
        if let Some(root) = description.root() {
            this.visit(root.0);
        }
        this
    }

    fn add(&mut self, joint: Option<usize>, nq: usize, nv: usize) {
        self.coordinates.push((joint, self.size.0, self.size.1));
        self.size = (self.size.0 + nq, self.size.1 + nv);
    }

    /// Depth-first, in the order of the file.
    fn visit(&mut self, link: usize) {
        for (index, joint) in self.description.joints.iter().enumerate().filter(|(_, j)| j.parent == LinkId(link)) {
            let (nq, nv) = joint.kind.sizes();
            if joint.mimic.is_none() && joint.locked.is_none() && nv > 0 {
                self.add(Some(index), nq, nv);
            }
            self.visit(joint.child.0);
        }
    }

    /// Names of the joints that are coordinates, in their order, without the base.
    pub fn joint_names(&self) -> Vec<&str> {
        self.coordinates.iter().filter_map(|(j, ..)| j.map(|j| self.description.joints[JointId(j)].name.as_str())).collect()
    }

    /// [R | p] of every link in the world frame, in the order of the file, for the motion q, v and
    /// a.
    fn poses<S: Scalar>(&self, q: &[S], v: &[S], a: &[S]) -> ById<LinkId, Option<Pose<S>>> {
        let mut poses: ById<LinkId, Option<Pose<S>>> = vec![None; self.description.links.len()].into();
        let Some(root) = self.description.root() else { return poses };
        poses[root] = Some(match self.base {
            Base::Fixed => (Matrix3::identity(), Vector3::zeros()),
            Base::Floating => free(&q[..7], &v[..6], &a[..6]),
        });
        let mut waiting = vec![root];
        while let Some(link) = waiting.pop() {
            for (index, joint) in self.description.joints.iter().enumerate().filter(|(_, j)| j.parent == link) {
                let below = poses[link].expect("a parent before its children");
                let placed = compose(&below, &place(&joint.origin));
                poses[joint.child] = Some(compose(&placed, &joint_pose(joint, &self.numbers(index, q, v, a))));
                waiting.push(joint.child);
            }
        }
        poses
    }

    fn seat(&self, joint: usize) -> (usize, usize) {
        let seat = self.coordinates.iter().find(|(j, ..)| *j == Some(joint)).expect("a joint that is a coordinate");
        (seat.1, seat.2)
    }

    /// A joint's own coordinates, rates and their derivatives. A locked joint rests; a follower's
    /// coordinate is a polynomial of its leader's.
    fn numbers<S: Scalar>(&self, joint: usize, q: &[S], v: &[S], a: &[S]) -> [Vec<S>; 3] {
        let it = &self.description.joints[JointId(joint)];
        let (nq, nv) = it.kind.sizes();
        if let Some(locked) = &it.locked {
            let rest = vec![S::zero(); nv];
            return [locked.iter().map(|&x| S::from_f64(x)).collect(), rest.clone(), rest];
        }
        if it.mimic.is_some() {
            let mut own = [S::zero(); 3];
            for m in it.mimic.iter().chain(&it.also) {
                let [q, v, a] = self.numbers(m.joint.0, q, v, a);
                let leader = Jet(q[0], v[0], a[0]);
                let powers = [m.offset, m.multiplier, m.higher[0], m.higher[1], m.higher[2]];
                let Jet(x, rate, second) = powers.iter().rev().fold(Jet::from_f64(0.0), |sum, c| sum * leader + Jet::from_f64(*c));
                own = [own[0] + x, own[1] + rate, own[2] + second];
            }
            return own.map(|x| vec![x]);
        }
        let (i, k) = if nv == 0 { (0, 0) } else { self.seat(joint) };
        [q[i..i + nq].to_vec(), v[k..k + nv].to_vec(), a[k..k + nv].to_vec()]
    }

    /// Placements of all links: [12 · links] of rotation by rows, then position.
    pub fn placements<S: Scalar>(&self, q: &[S]) -> Vec<S> {
        let rest = vec![S::zero(); self.size.1];
        let poses = self.poses(q, &rest, &rest);
        let numbers = |(r, p): &Pose<S>| (0..9).map(|k| r[(k / 3, k % 3)].0).chain(p.iter().map(|c| c.0)).collect::<Vec<_>>();
        poses.iter().flatten().flat_map(numbers).collect()
    }

    /// Mass, centre and turned second moments of every link that has mass.
    fn bodies<S: Scalar>(&self, q: &[S], v: &[S], a: &[S]) -> Vec<Body<S>> {
        let poses = self.poses(q, v, a);
        let links = self.description.links.iter().zip(poses);
        links
            .filter_map(|(link, pose)| {
                let inertial = link.inertial?;
                let (rotation, centre) = compose(&pose?, &place(&inertial.origin));
                Some(Body { mass: S::from_f64(inertial.mass), moments: second_moments(inertial.inertia), rotation, centre })
            })
            .collect()
    }

    /// τ; q: `[nq]`, v and a: `[nv]`.
    pub fn inverse_dynamics<S: Scalar>(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        let bodies = self.bodies(q, v, a);
        let (g, rest) = (Vector3::from(self.gravity).map(S::from_f64), vec![S::zero(); self.size.1]);
        let one = |k: usize| {
            let mut unit = rest.clone();
            unit[k] = S::one();
            // Velocities for a unit of rate k: ∂ċ/∂v_k and ∂Ṙ/∂v_k.
            let varied = self.bodies(q, &unit, &rest);
            let powers = bodies.iter().zip(&varied).map(|(body, along)| {
                let force = (body.centre.map(|c| c.2) - g) * body.mass;
                let spin = body.rotation.map(|c| c.2) * body.moments;
                force.dot(&along.centre.map(|c| c.1)) + spin.dot(&along.rotation.map(|c| c.1))
            });
            powers.fold(S::zero(), |sum, p| sum + p)
        };
        (0..self.size.1).map(one).collect()
    }

    /// T = Σ ½ m |ċ|² + ½ tr(Ṙ Σ_c Ṙᵀ), U = −Σ m g·c, and the time derivative of their sum.
    pub fn energy<S: Scalar>(&self, q: &[S], v: &[S], a: &[S]) -> Energy<S> {
        let g = Vector3::from(self.gravity).map(S::from_f64);
        let half = S::from_f64(0.5);
        let mut energy = Energy { kinetic: S::zero(), potential: S::zero(), power: S::zero() };
        for body in self.bodies(q, v, a) {
            // As jets of the first order: value, derivative.
            let rate = body.centre.map(|c| (c.1, c.2));
            let turn = body.rotation.map(|c| c.1);
            let (speed, change) = (rate.map(|c| c.0), rate.map(|c| c.1));
            let spin = turn * body.moments;
            energy.kinetic += half * (body.mass * speed.dot(&speed) + spin.dot(&turn));
            energy.potential -= body.mass * g.dot(&body.centre.map(|c| c.0));
            energy.power += body.mass * (speed.dot(&change) - g.dot(&speed)) + spin.dot(&body.rotation.map(|c| c.2));
        }
        energy
    }
}

struct Body<S> {
    mass: S,
    /// Σ_c in axes of the inertial frame.
    moments: Matrix3<S>,
    rotation: Matrix3<Jet<S>>,
    centre: Vector3<Jet<S>>,
}

fn second_moments<S: Scalar>(inertia: [f64; 6]) -> Matrix3<S> {
    let [xx, xy, xz, yy, yz, zz] = inertia.map(S::from_f64);
    let half = S::from_f64(0.5);
    let (x, y, z) = (half * (yy + zz - xx), half * (xx + zz - yy), half * (xx + yy - zz));
    Matrix3::new(x, -xy, -xz, -xy, y, -yz, -xz, -yz, z)
}
