//! Inverse dynamics by virtual power: no recursion, no wrench, no Coriolis term.
//!
//! Every link's placement is written as a function of time along the motion (q, v, a) and differentiated twice ([`Jet`]); a joint's torque is then the power of the
//! forces r̈ − g of all mass points for a unit of that joint's rate (d'Alembert; Lanczos, *The Variational Principles of Mechanics*, 1970, ch. IV):
//!
//! τ_k = Σ_i ∫ (r̈ − g)·∂ṙ/∂v_k dm = Σ_i m (c̈ − g)·∂ċ/∂v_k + tr(R̈ Σ_c (∂Ṙ/∂v_k)ᵀ),   Σ_c = ½ tr(I)·1 − I
//!
//! It starts from the numbers of the file and shares nothing with the crates that it judges but the scalar.

use std::f64::consts::FRAC_PI_2;

use articulated_core::Scalar;
use articulated_core::description::{Base, Description, JointKind, Origin};
use nalgebra::{Matrix3, Vector3};

use crate::jet::Jet;

/// A described robot as placements in motion.
#[derive(Clone, Debug)]
pub struct Motions<'a> {
    description: &'a Description,
    base: Base,
    gravity: [f64; 3],
    /// Joints with a coordinate or more, in the order of the vectors: file index, first index in q, first in v. `None` is the base.
    coordinates: Vec<(Option<usize>, usize, usize)>,
    /// Lengths of q and v.
    pub size: (usize, usize),
}

/// Energies and what changes them.
#[derive(Clone, Copy, Debug)]
pub struct Energy<S> {
    /// T, J.
    pub kinetic: S,
    /// U, J; 0 for mass at the origin of the base frame.
    pub potential: S,
    /// d(T + U)/dt, W.
    pub power: S,
}

type Pose<S> = (Matrix3<Jet<S>>, Vector3<Jet<S>>);

impl<'a> Motions<'a> {
    /// Of a description that is a tree; gravity in the base frame, m/s².
    pub fn new(description: &'a Description, base: Base, gravity: [f64; 3]) -> Self {
        let mut this = Self { description, base, gravity, coordinates: Vec::new(), size: (0, 0) };
        if base == Base::Floating {
            this.add(None, 7, 6);
        }
        if let Some(root) = description.root() {
            this.visit(root);
        }
        this
    }

    fn add(&mut self, joint: Option<usize>, nq: usize, nv: usize) {
        self.coordinates.push((joint, self.size.0, self.size.1));
        self.size = (self.size.0 + nq, self.size.1 + nv);
    }

    /// Depth-first, in the order of the file.
    fn visit(&mut self, link: usize) {
        for (index, joint) in self.description.joints.iter().enumerate().filter(|(_, j)| j.parent == link) {
            match joint.kind {
                _ if joint.mimic.is_some() => {}
                JointKind::Fixed => {}
                JointKind::Floating => self.add(Some(index), 7, 6),
                _ => self.add(Some(index), 1, 1),
            }
            self.visit(joint.child);
        }
    }

    /// Names of the joints that are coordinates, in their order, without the base.
    pub fn joint_names(&self) -> Vec<&str> {
        self.coordinates.iter().filter_map(|(j, ..)| j.map(|j| self.description.joints[j].name.as_str())).collect()
    }

    /// [R | p] of every link in the base frame, in the order of the file, moving as q, v and a say.
    fn poses<S: Scalar>(&self, q: &[S], v: &[S], a: &[S]) -> Vec<Option<Pose<S>>> {
        let mut poses = vec![None; self.description.links.len()];
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
                poses[joint.child] = Some(compose(&placed, &self.moved(index, q, v, a)));
                waiting.push(joint.child);
            }
        }
        poses
    }

    /// The motion of a joint.
    fn moved<S: Scalar>(&self, index: usize, q: &[S], v: &[S], a: &[S]) -> Pose<S> {
        let joint = &self.description.joints[index];
        match joint.kind {
            JointKind::Revolute | JointKind::Continuous => (turn(axis(joint.axis), self.coordinate(index, q, v, a)), Vector3::zeros()),
            JointKind::Prismatic => {
                let x = self.coordinate(index, q, v, a);
                (Matrix3::identity(), axis(joint.axis).map(|c: Jet<S>| c * x))
            }
            JointKind::Floating => {
                let (i, k) = self.seat(index);
                free(&q[i..i + 7], &v[k..k + 6], &a[k..k + 6])
            }
            JointKind::Fixed | JointKind::Planar => (Matrix3::identity(), Vector3::zeros()),
        }
    }

    fn seat(&self, joint: usize) -> (usize, usize) {
        let seat = self.coordinates.iter().find(|(j, ..)| *j == Some(joint)).expect("a joint that is a coordinate");
        (seat.1, seat.2)
    }

    /// A joint's single coordinate in motion; a follower's is its leader's times and plus.
    fn coordinate<S: Scalar>(&self, joint: usize, q: &[S], v: &[S], a: &[S]) -> Jet<S> {
        match &self.description.joints[joint].mimic {
            Some(m) => Jet::from_f64(m.multiplier) * self.coordinate(m.joint, q, v, a) + Jet::from_f64(m.offset),
            None => {
                let (i, k) = self.seat(joint);
                Jet(q[i], v[k], a[k])
            }
        }
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

/// What a link's quantities are sums of, along the way from the base: the yardsticks of rounding errors.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    /// Length of the way through the origins of the links, m.
    length: f64,
    /// Largest acceleration of an origin, m/s².
    acceleration: f64,
    /// Largest ‖R̈‖, 1/s².
    spin: f64,
}

impl Motions<'_> {
    /// The way to each link.
    fn ways(&self, poses: &[Option<Pose<f64>>]) -> Vec<Way> {
        let mut ways = vec![Way::default(); poses.len()];
        for link in self.outward() {
            let parent = self.description.joints.iter().find(|j| j.child == link).map(|j| j.parent);
            let before = parent.map_or_else(Way::default, |p| ways[p]);
            let (Some((r, p)), from) = (poses[link], parent.and_then(|p| poses[p])) else { continue };
            let step = p.map(|c| c.0) - from.map_or_else(Vector3::zeros, |(_, p)| p.map(|c| c.0));
            ways[link] = Way {
                length: before.length + step.norm(),
                acceleration: before.acceleration.max(p.map(|c| c.2).norm()),
                spin: before.spin.max(r.map(|c| c.2).norm()),
            };
        }
        ways
    }

    /// Links, parents first.
    fn outward(&self) -> Vec<usize> {
        let mut order: Vec<usize> = self.description.root().into_iter().collect();
        let mut next = 0;
        while let Some(&link) = order.get(next) {
            order.extend(self.description.joints.iter().filter(|j| j.parent == link).map(|j| j.child));
            next += 1;
        }
        order
    }

    /// For each torque, the sum of what it would be if nothing cancelled: forces m (|r̈| + |g|) times the way from the joint to the mass, and
    /// ‖Σ_c‖ ‖R̈‖; for a slide, the forces alone. |r̈| and ‖R̈‖ are the largest on the way. No choice of axes changes it much.
    pub fn torque_scale(&self, q: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
        let poses = self.poses(q, v, a);
        let (ways, g) = (self.ways(&poses), Vector3::from(self.gravity).norm());
        let mut scale = vec![0.0; self.size.1];
        let root = self.description.root();
        if let (Base::Floating, Some(root)) = (self.base, root) {
            self.add_scale(root, &ways, g, [1.0; 6], (0, ways[root].length), &mut scale);
        }
        for (index, joint) in self.description.joints.iter().enumerate() {
            let (end, multiplier) = self.leader(index);
            let share = match joint.kind {
                JointKind::Revolute | JointKind::Continuous => [multiplier.abs(), 0.0, 0.0, 0.0, 0.0, 0.0],
                JointKind::Prismatic => [0.0, 0.0, 0.0, multiplier.abs(), 0.0, 0.0],
                JointKind::Floating => [1.0; 6],
                JointKind::Fixed | JointKind::Planar => continue,
            };
            let from = ways[joint.child].length;
            self.add_scale(joint.child, &ways, g, share, (self.seat(end).1, from), &mut scale);
        }
        scale
    }

    /// Adds the moment three times and the force three times, each with its share, for everything that `top` carries; shares of a single
    /// coordinate all count for that one.
    fn add_scale(&self, top: usize, ways: &[Way], g: f64, share: [f64; 6], (at, from): (usize, f64), scale: &mut [f64]) {
        let free = share == [1.0; 6];
        let mut waiting = vec![top];
        while let Some(link) = waiting.pop() {
            waiting.extend(self.description.joints.iter().filter(|j| j.parent == link).map(|j| j.child));
            let Some(body) = self.description.links[link].inertial else { continue };
            let (way, arm) = (ways[link], Vector3::from(body.origin.xyz).norm());
            let force = body.mass * (way.acceleration + way.spin * arm + g);
            let moment = force * (way.length - from + arm) + second_moments::<f64>(body.inertia).norm() * way.spin;
            for (k, share) in share.iter().enumerate() {
                scale[if free { at + k } else { at }] += share * if k < 3 { moment } else { force };
            }
        }
    }

    /// The joint at the end of a chain of followers, and how far it moves this one.
    fn leader(&self, joint: usize) -> (usize, f64) {
        match &self.description.joints[joint].mimic {
            None => (joint, 1.0),
            Some(m) => {
                let (end, multiplier) = self.leader(m.joint);
                (end, m.multiplier * multiplier)
            }
        }
    }

    /// For each number of a placement: 1 in a rotation, in a position the length of the way from the base, both times the number of joints on it.
    pub fn placement_scale(&self, q: &[f64]) -> Vec<f64> {
        let rest = vec![0.0; self.size.1];
        let ways = self.ways(&self.poses(q, &rest, &rest));
        let mut depth = vec![1.0; ways.len()];
        for link in self.outward() {
            for joint in self.description.joints.iter().filter(|j| j.parent == link) {
                depth[joint.child] = depth[link] + 1.0;
            }
        }
        let one = |(way, depth): (&Way, &f64)| [[*depth; 9].as_slice(), &[depth * way.length; 3]].concat();
        ways.iter().zip(&depth).flat_map(one).collect()
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

fn compose<S: Scalar>(a: &Pose<S>, b: &Pose<S>) -> Pose<S> {
    (a.0 * b.0, a.0 * b.1 + a.1)
}

fn place<S: Scalar>(origin: &Origin) -> Pose<S> {
    let e = [Vector3::x(), Vector3::y(), Vector3::z()];
    let about = |k: usize| {
        let (s, c) = written(origin.rpy[k]);
        from_axis(e[k], Jet::still(s), Jet::still(c))
    };
    (about(2) * about(1) * about(0), Vector3::from(origin.xyz).map(Jet::from_f64))
}

/// (sin, cos); the double nearest to a right angle is a right angle: that is a convention and no matter of dynamics.
fn written<S: Scalar>(angle: f64) -> (S, S) {
    let turns = (angle / FRAC_PI_2).round();
    if turns * FRAC_PI_2 != angle || turns.abs() > 4.0 {
        return S::from_f64(angle).sin_cos();
    }
    let exact = |x: f64| S::from_f64(x.round());
    (exact(angle.sin()), exact(angle.cos()))
}

fn turn<S: Scalar>(axis: Vector3<Jet<S>>, angle: Jet<S>) -> Matrix3<Jet<S>> {
    let (sin, cos) = angle.sin_cos();
    from_axis(axis, sin, cos)
}

/// cos·1 + sin·[e]× + (1 − cos)·e eᵀ.
fn from_axis<S: Scalar>(e: Vector3<Jet<S>>, sin: Jet<S>, cos: Jet<S>) -> Matrix3<Jet<S>> {
    let o = Jet::still(S::zero());
    let cross = Matrix3::new(o, -e.z, e.y, e.z, o, -e.x, -e.y, e.x, o);
    Matrix3::from_diagonal_element(cos) + cross * sin + e * e.transpose() * (Jet::still(S::one()) - cos)
}

fn axis<S: Scalar>(written: [f64; 3]) -> Vector3<Jet<S>> {
    let v: Vector3<S> = Vector3::from(written).map(S::from_f64);
    let norm = v.dot(&v).sqrt();
    v.map(|c| Jet::still(c / norm))
}

/// A free body: q = (position; quaternion x, y, z, w), v = body twist [ω; v], a = v̇.
fn free<S: Scalar>(q: &[S], v: &[S], a: &[S]) -> Pose<S> {
    let three = |x: &[S], at: usize| Vector3::new(x[at], x[at + 1], x[at + 2]);
    let o = S::zero();
    let half = |x: [S; 4]| x.map(|c| S::from_f64(0.5) * c);
    let pure = |w: Vector3<S>| [w.x, w.y, w.z, o];
    let x = [q[3], q[4], q[5], q[6]];
    // ẋ = ½ x ω;  ẍ = ½ (ẋ ω + x ω̇)
    let first = half(product(x, pure(three(v, 0))));
    let (one, other) = (product(first, pure(three(v, 0))), product(x, pure(three(a, 0))));
    let second = half([0, 1, 2, 3].map(|k| one[k] + other[k]));
    let moving = [0, 1, 2, 3].map(|k| Jet(x[k], first[k], second[k]));
    let rotation = from_quaternion(moving);
    // ṗ = R v;  p̈ = Ṙ v + R v̇
    let (r, rate) = (rotation.map(|c| c.0), rotation.map(|c| c.1));
    let speed = r * three(v, 3);
    let change = rate * three(v, 3) + r * three(a, 3);
    (rotation, Vector3::from_fn(|k, _| Jet(q[k], speed[k], change[k])))
}

/// Hamilton's product of (x, y, z, w).
fn product<S: Scalar>([ax, ay, az, aw]: [S; 4], [bx, by, bz, bw]: [S; 4]) -> [S; 4] {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// (w² − |u|²)·1 + 2 u uᵀ + 2 w [u]×, divided by the norm squared: a rotation, whatever the norm.
fn from_quaternion<S: Scalar>([x, y, z, w]: [Jet<S>; 4]) -> Matrix3<Jet<S>> {
    let u = Vector3::new(x, y, z);
    let (length, two, o) = (u.dot(&u), Jet::from_f64(2.0), Jet::still(S::zero()));
    let cross = Matrix3::new(o, -z, y, z, o, -x, -y, x, o);
    let r = Matrix3::from_diagonal_element(w * w - length) + u * u.transpose() * two + cross * (two * w);
    let norm = w * w + length;
    r.map(|c| c / norm)
}
