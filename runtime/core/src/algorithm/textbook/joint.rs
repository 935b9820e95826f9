//! Joints: a placement T(q), the screws S(q) that its rates move the child along, and Ṡ v. In axes
//! of the child.

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3, Vector6};

use super::kinematics::twist;
use super::matrix::{rodrigues, stack};
use super::varied;
use crate::Scalar;
use crate::description::{self, JointKind};
use crate::dual::Dual;
use crate::spatial::{Placement, Reference, from_quaternion};

/// The motion that a joint allows, with unit axes in its frame: the definitions of [`JointKind`].
#[derive(Clone, Debug)]
pub(super) enum Motion<S> {
    Fixed,
    /// R = exp([axis]× q).
    Turn(Vector3<S>),
    /// p = axis q.
    Slide(Vector3<S>),
    /// R = exp([axis]× q), p = h axis q, with h in m/rad.
    Screw(Vector3<S>, S),
    /// R = exp([first]× q_0) exp([second]× q_1).
    Cardan(Vector3<S>, Vector3<S>),
    /// p = x q_0 + y q_1, R = exp([x × y]× q_2).
    Plane(Vector3<S>, Vector3<S>),
    /// R of a unit quaternion.
    Ball,
    /// p, and R of a unit quaternion.
    Free,
}

/// Where a joint's numbers are, and the law if it follows.
#[derive(Clone, Debug)]
pub(super) struct Seat<S> {
    pub(super) q: usize,
    pub(super) v: usize,
    pub(super) follow: Option<Law<S>>,
}

/// Polynomials by which joints follow each other, the own one first, each by its coefficients from
/// power zero on: its derivatives are those of dual numbers.
#[derive(Clone, Debug)]
pub(super) struct Law<S>(pub(super) Vec<Vec<S>>);

impl<S: Scalar> Law<S> {
    /// Own coordinate at the leader's.
    pub(super) fn at(&self, leader: S) -> S {
        let one = |x: S, powers: &Vec<S>| powers.iter().rev().fold(S::zero(), |sum, &c| sum * x + c);
        self.0.iter().rev().fold(leader, one)
    }

    fn lift(&self) -> Law<Dual<S>> {
        Law(self.0.iter().map(|powers| powers.iter().map(|&c| Dual::constant(c)).collect()).collect())
    }

    /// The derivative at the leader's coordinate.
    fn slope(&self, leader: S) -> S {
        self.lift().at(Dual::variable(leader)).slope
    }
}

/// A joint with its place in the vectors.
#[derive(Clone, Debug)]
pub(super) struct Joint<S> {
    pub(super) motion: Motion<S>,
    pub(super) seat: Seat<S>,
}

impl<S: Scalar> Motion<S> {
    /// Of a joint of the file.
    pub(super) fn of(joint: &description::Joint) -> Self {
        match joint.kind {
            JointKind::Fixed => Self::Fixed,
            JointKind::Revolute | JointKind::Continuous => Self::Turn(unit(joint.axis)),
            JointKind::Prismatic => Self::Slide(unit(joint.axis)),
            // The double nearest to 2π is a turn.
            JointKind::Helical => Self::Screw(unit(joint.axis), S::from_f64(joint.pitch) / S::from_f64(TAU)),
            JointKind::Universal => Self::Cardan(unit(joint.axis), unit(joint.second_axis)),
            JointKind::Planar => {
                let (x, y) = plane(joint.axis);
                Self::Plane(x, y)
            }
            JointKind::Spherical => Self::Ball,
            JointKind::Floating => Self::Free,
        }
    }

    /// Number of coordinates and of rates.
    fn sizes(&self) -> (usize, usize) {
        match self {
            Self::Fixed => (0, 0),
            Self::Turn(_) | Self::Slide(_) | Self::Screw(..) => (1, 1),
            Self::Cardan(..) => (2, 2),
            Self::Plane(..) => (3, 3),
            Self::Ball => (4, 3),
            Self::Free => (7, 6),
        }
    }

    /// T(x) for its own coordinates x.
    pub(super) fn placement(&self, x: &[S]) -> Placement<S> {
        let turned = |rotation: Matrix3<S>| Placement { rotation, position: Vector3::zeros() };
        match *self {
            Self::Fixed => Placement::identity(),
            Self::Turn(axis) => turned(rodrigues(axis, x[0])),
            Self::Slide(axis) => Placement { rotation: Matrix3::identity(), position: axis * x[0] },
            Self::Screw(axis, h) => Placement { rotation: rodrigues(axis, x[0]), position: axis * (h * x[0]) },
            Self::Cardan(first, second) => turned(rodrigues(first, x[0]) * rodrigues(second, x[1])),
            Self::Plane(e, f) => Placement { rotation: rodrigues(e.cross(&f), x[2]), position: e * x[0] + f * x[1] },
            Self::Ball => turned(from_quaternion([x[0], x[1], x[2], x[3]])),
            Self::Free => Placement { rotation: from_quaternion([x[3], x[4], x[5], x[6]]), position: Vector3::new(x[0], x[1], x[2]) },
        }
    }

    /// The same coordinates with a normalised quaternion: for those that are written in a file.
    pub(super) fn normalised(&self, x: &[S]) -> Vec<S> {
        let at = match self {
            Self::Ball => 0,
            Self::Free => 3,
            _ => return x.to_vec(),
        };
        let norm = x[at..].iter().fold(S::zero(), |sum, &c| sum + c * c).sqrt();
        x.iter().enumerate().map(|(k, &c)| if k < at { c } else { c / norm }).collect()
    }

    /// The columns of S at its own coordinates x.
    fn screws(&self, x: &[S]) -> Vec<Vector6<S>> {
        let zero = Vector3::zeros();
        match *self {
            Self::Fixed => vec![],
            // T = exp([S] q): the screw is the same at every q.
            Self::Turn(axis) => vec![stack(axis, zero)],
            Self::Slide(axis) => vec![stack(zero, axis)],
            Self::Screw(axis, h) => vec![stack(axis, axis * h)],
            // [S_k] = T⁻¹ ∂T/∂q_k
            Self::Cardan(..) | Self::Plane(..) => {
                let unit = |k: usize| (0..x.len()).map(|i| if i == k { S::one() } else { S::zero() }).collect::<Vec<_>>();
                (0..x.len()).map(|k| twist(Reference::Body, &self.lift().placement(&varied(x, &unit(k))))).collect()
            }
            // The rates are the twist.
            Self::Ball => (0..3).map(basis).collect(),
            Self::Free => (0..6).map(basis).collect(),
        }
    }

    /// Ṡ·x˙, at its own coordinates x and rates x˙.
    fn bias(&self, x: &[S], rates: &[S]) -> Vector6<S> {
        match self {
            Self::Cardan(..) | Self::Plane(..) => {
                let columns = self.lift().screws(&varied(x, rates));
                columns.iter().zip(rates).fold(Vector6::zeros(), |sum, (s, &rate)| sum + s.map(|c| c.slope) * rate)
            }
            _ => Vector6::zeros(),
        }
    }

    /// x˙ of its own coordinates x that turns the child by these rates.
    fn coordinate_rates(&self, x: &[S], rates: &[S]) -> Vec<S> {
        let half = S::from_f64(0.5);
        // ẋ = ½ x ω
        let turning = |x: &[S], w: &[S]| product([x[0], x[1], x[2], x[3]], [w[0], w[1], w[2], S::zero()]).map(|c| c * half);
        match self {
            Self::Ball => turning(x, rates).to_vec(),
            // ṗ = R v
            Self::Free => {
                let velocity = self.placement(x).rotation * Vector3::new(rates[3], rates[4], rates[5]);
                [velocity.as_slice(), &turning(&x[3..], rates)].concat()
            }
            _ => rates.to_vec(),
        }
    }

    fn lift(&self) -> Motion<Dual<S>> {
        let constant = |v: Vector3<S>| v.map(Dual::constant);
        match *self {
            Self::Fixed => Motion::Fixed,
            Self::Turn(axis) => Motion::Turn(constant(axis)),
            Self::Slide(axis) => Motion::Slide(constant(axis)),
            Self::Screw(axis, h) => Motion::Screw(constant(axis), Dual::constant(h)),
            Self::Cardan(first, second) => Motion::Cardan(constant(first), constant(second)),
            Self::Plane(x, y) => Motion::Plane(constant(x), constant(y)),
            Self::Ball => Motion::Ball,
            Self::Free => Motion::Free,
        }
    }
}

impl<S: Scalar> Joint<S> {
    pub(super) fn new(motion: Motion<S>, seat: Seat<S>) -> Self {
        Self { motion, seat }
    }

    pub(super) fn fixed() -> Self {
        Self::new(Motion::Fixed, Seat { q: 0, v: 0, follow: None })
    }

    /// Whether it moves at all.
    pub(super) fn moves(&self) -> bool {
        self.motion.sizes().1 > 0
    }

    /// Its own coordinates, of q.
    pub(super) fn coordinates(&self, q: &[S]) -> Vec<S> {
        match &self.seat.follow {
            Some(law) => vec![law.at(q[self.seat.q])],
            None => q[self.seat.q..][..self.motion.sizes().0].to_vec(),
        }
    }

    /// Its own rates.
    fn rates(&self, q: &[S], v: &[S]) -> Vec<S> {
        match &self.seat.follow {
            Some(law) => vec![v[self.seat.v] * law.slope(q[self.seat.q])],
            None => v[self.seat.v..][..self.motion.sizes().1].to_vec(),
        }
    }

    /// T(q).
    pub(super) fn placement(&self, q: &[S]) -> Placement<S> {
        self.motion.placement(&self.coordinates(q))
    }

    /// The columns of S(q), one for each of its own rates.
    pub(super) fn screws(&self, q: &[S]) -> Vec<Vector6<S>> {
        self.motion.screws(&self.coordinates(q))
    }

    /// Ṡ v, S being the screws per unit of the rates in v.
    pub(super) fn bias(&self, q: &[S], v: &[S]) -> Vector6<S> {
        let own = self.motion.bias(&self.coordinates(q), &self.rates(q, v));
        let Some(law) = &self.seat.follow else { return own };
        // d(f′)/dt = f″ q̇
        let (leader, rate) = (q[self.seat.q], v[self.seat.v]);
        let slope = law.lift().slope(Dual::new(leader, rate)).slope;
        self.screws(q).iter().fold(own, |sum, screw| sum + screw * (slope * rate))
    }

    /// Writes q̇ of the coordinates that are its own.
    pub(super) fn write_coordinate_rates(&self, q: &[S], v: &[S], out: &mut [S]) {
        if self.seat.follow.is_none() {
            let rates = self.motion.coordinate_rates(&self.coordinates(q), &self.rates(q, v));
            out[self.seat.q..][..rates.len()].copy_from_slice(&rates);
        }
    }

    /// Its own rates for a rate of one: the slope of the law of a joint that follows another, or
    /// one.
    pub(super) fn multiplier(&self, q: &[S]) -> S {
        self.seat.follow.as_ref().map_or_else(S::one, |law| law.slope(q[self.seat.q]))
    }

    pub(super) fn lift(&self) -> Joint<Dual<S>> {
        let Seat { q, v, ref follow } = self.seat;
        let follow = follow.as_ref().map(Law::lift);
        Joint { motion: self.motion.lift(), seat: Seat { q, v, follow } }
    }
}

fn basis<S: Scalar>(k: usize) -> Vector6<S> {
    Vector6::from_fn(|i, _| if i == k { S::one() } else { S::zero() })
}

/// Hamilton's product of (x, y, z, w).
pub(super) fn product<S: Scalar>(a: [S; 4], b: [S; 4]) -> [S; 4] {
    let (u, v) = (Vector3::new(a[0], a[1], a[2]), Vector3::new(b[0], b[1], b[2]));
    let vector = v * a[3] + u * b[3] + u.cross(&v);
    [vector.x, vector.y, vector.z, a[3] * b[3] - u.dot(&v)]
}

fn unit<S: Scalar>(axis: [f64; 3]) -> Vector3<S> {
    let largest = axis.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let v = Vector3::from(axis).map(|x| S::from_f64(x) / S::from_f64(largest));
    let norm = v.dot(&v).sqrt();
    v.map(|x| x / norm)
}

/// Directions of x and y in the plane across an axis, as [`JointKind::Planar`] has them.
fn plane<S: Scalar>(axis: [f64; 3]) -> (Vector3<S>, Vector3<S>) {
    let z = unit(axis);
    let e = |k: usize| Vector3::from_fn(|i, _| if i == k { S::one() } else { S::zero() });
    let x = match axis.map(|x| x != 0.0) {
        [true, false, false] => e(1),
        [false, true, false] => e(if axis[1] > 0.0 { 2 } else { 0 }),
        [false, false, true] => e(0),
        // Across the coordinate axis that is least along the joint's, the first of these.
        _ => {
            let least = (1..3).fold(0, |least, k| if axis[k].abs() < axis[least].abs() { k } else { least });
            let x = e(least).cross(&z);
            let norm = x.dot(&x).sqrt();
            x.map(|c| c / norm)
        }
    };
    (x, z.cross(&x))
}
