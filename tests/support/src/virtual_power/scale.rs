//! The scales of rounding errors: the terms of a torque or a placement.

use std::f64::consts::TAU;

use articulated_core::description::{Base, ById, Joint, JointId, JointKind, LinkId, Mimic};
use nalgebra::Vector3;

use super::pose::Pose;
use super::{Motions, second_moments};

/// The terms of a link's quantities, along the path from the base: the scales of rounding errors.
#[derive(Clone, Copy, Debug, Default)]
struct Variant {
    /// Length of the way through the origins of the links, m.
    length: f64,
    /// Largest acceleration of an origin, m/s².
    acceleration: f64,
    /// Largest ‖R̈‖, 1/s².
    spin: f64,
}

/// Part of the moment and of the force beyond a joint that one of its rates feels.
type Share = (f64, f64);

const TURN: Share = (1.0, 0.0);
const SLIDE: Share = (0.0, 1.0);
const FREE: [Share; 6] = [TURN, TURN, TURN, SLIDE, SLIDE, SLIDE];

/// For each rate.
fn shares(joint: &Joint) -> Vec<Share> {
    match joint.kind {
        JointKind::Fixed => vec![],
        JointKind::Revolute | JointKind::Continuous => vec![TURN],
        JointKind::Prismatic => vec![SLIDE],
        JointKind::Helical => vec![(1.0, (joint.pitch / TAU).abs())],
        JointKind::Universal => vec![TURN; 2],
        JointKind::Planar => vec![SLIDE, SLIDE, TURN],
        JointKind::Spherical => vec![TURN; 3],
        JointKind::Floating => FREE.to_vec(),
    }
}

/// Number of turns and slides along an axis that a joint consists of, at least one.
fn elementary(kind: JointKind) -> f64 {
    match kind {
        JointKind::Helical | JointKind::Universal => 2.0,
        JointKind::Planar => 3.0,
        _ => 1.0,
    }
}

impl Motions<'_> {
    /// The way to each link.
    fn ways(&self, poses: &ById<LinkId, Option<Pose<f64>>>) -> ById<LinkId, Variant> {
        let mut ways: ById<LinkId, Variant> = vec![Variant::default(); poses.len()].into();
        for link in self.outward() {
            let parent = self.description.joints.iter().find(|j| j.child == link).map(|j| j.parent);
            let before = parent.map_or_else(Variant::default, |p| ways[p]);
            let (Some((r, p)), from) = (poses[link], parent.and_then(|p| poses[p])) else { continue };
            let step = p.map(|c| c.0) - from.map_or_else(Vector3::zeros, |(_, p)| p.map(|c| c.0));
            ways[link] = Variant {
                length: before.length + step.norm(),
                acceleration: before.acceleration.max(p.map(|c| c.2).norm()),
                spin: before.spin.max(r.map(|c| c.2).norm()),
            };
        }
        ways
    }

    /// Links, parents first.
    fn outward(&self) -> Vec<LinkId> {
        let mut order: Vec<LinkId> = self.description.root().into_iter().collect();
        let mut next = 0;
        while let Some(&link) = order.get(next) {
            order.extend(self.description.joints.iter().filter(|j| j.parent == link).map(|j| j.child));
            next += 1;
        }
        order
    }

    /// For each torque, the sum of its terms without cancellation: forces m (|r̈| + |g|) times the
    /// path from the joint to the mass, and ‖Σ_c‖ ‖R̈‖; for a slide, the forces alone. |r̈| and
    /// ‖R̈‖ are the largest on the path. It depends little on the choice of axes.
    pub fn torque_scale(&self, q: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
        let poses = self.poses(q, v, a);
        let (ways, g) = (self.ways(&poses), Vector3::from(self.gravity).norm());
        let mut scale = vec![0.0; self.size.1];
        let root = self.description.root();
        if let (Base::Floating, Some(root)) = (self.base, root) {
            self.add_scale(root, &ways, g, &FREE, (0, ways[root].length), &mut scale);
        }
        for (index, joint) in self.description.joints.iter().enumerate() {
            for (end, multiplier) in self.leaders(index, q) {
                let own: Vec<Share> = shares(joint).iter().map(|s| (s.0 * multiplier.abs(), s.1 * multiplier.abs())).collect();
                let from = ways[joint.child].length;
                self.add_scale(joint.child, &ways, g, &own, (self.seat(end).1, from), &mut scale);
            }
        }
        scale
    }

    /// Adds the moment and the force, each with its share of every rate from `at` on, for
    /// everything that `top` carries.
    fn add_scale(&self, top: LinkId, ways: &ById<LinkId, Variant>, g: f64, shares: &[Share], (at, from): (usize, f64), scale: &mut [f64]) {
        let mut waiting = vec![top];
        while let Some(link) = waiting.pop() {
            waiting.extend(self.description.joints.iter().filter(|j| j.parent == link).map(|j| j.child));
            let Some(body) = self.description.links[link].inertial else { continue };
            let (way, arm) = (ways[link], Vector3::from(body.origin.xyz).norm());
            let force = body.mass * (way.acceleration + way.spin * arm + g);
            let moment = force * (way.length - from + arm) + second_moments::<f64>(body.inertia).norm() * way.spin;
            for (k, share) in shares.iter().enumerate() {
                scale[at + k] += share.0 * moment + share.1 * force;
            }
        }
    }

    /// The joints at the ends of chains of followers, and their factors for this one at q. Empty if
    /// either is locked, or does not move.
    fn leaders(&self, joint: usize, q: &[f64]) -> Vec<(usize, f64)> {
        let it = &self.description.joints[JointId(joint)];
        if it.locked.is_some() || it.kind.is_fixed() {
            return Vec::new();
        }
        if it.mimic.is_none() {
            return vec![(joint, 1.0)];
        }
        let rest = vec![0.0; self.size.1];
        let further = |m: &Mimic| {
            let slope = m.law().slope(self.numbers(m.joint.0, q, &rest, &rest)[0][0]);
            self.leaders(m.joint.0, q).into_iter().map(move |(end, multiplier)| (end, slope * multiplier)).collect::<Vec<_>>()
        };
        it.mimic.iter().chain(&it.also).flat_map(further).collect()
    }

    /// For each number of a placement: 1 in a rotation, in a position the length of the path from
    /// the base, both times the number of joints on it.
    pub fn placement_scale(&self, q: &[f64]) -> Vec<f64> {
        let rest = vec![0.0; self.size.1];
        let ways = self.ways(&self.poses(q, &rest, &rest));
        let mut depth: ById<LinkId, f64> = vec![1.0; ways.len()].into();
        for link in self.outward() {
            for joint in self.description.joints.iter().filter(|j| j.parent == link) {
                depth[joint.child] = depth[link] + elementary(joint.kind);
            }
        }
        let one = |(way, depth): (&Variant, &f64)| [[*depth; 9].as_slice(), &[depth * way.length; 3]].concat();
        ways.iter().zip(&depth).flat_map(one).collect()
    }
}
