//! Steps on the manifold of configurations, by the power series of the exponential and the angle of
//! a quaternion.

use alloc::vec::Vec;

use nalgebra::{Matrix3, Vector3};

use super::Textbook;
use super::joint::product;
use super::matrix::cross_matrix;
use crate::Scalar;
use crate::description::{JointKind, Limit};
use crate::model::JointInfo;
use crate::spatial::from_quaternion;

/// A unit quaternion (x, y, z, w) and a position.
type Pose<S> = ([S; 4], Vector3<S>);

/// Halvings of a step before its series, and doublings after.
pub(super) const HALVINGS: u32 = 6;

/// Terms of a series in a step of less than one: 1/72! is 10⁻¹⁰⁴.
pub(super) const TERMS: u32 = 72;

impl<S: Scalar> Textbook<S> {
    /// q ⊕ step, `[nq]`: T·exp(step) for joints that turn freely, q + step for others.
    pub fn integrate(&self, q: &[S], step: &[S]) -> Vec<S> {
        let one = |joint: &JointInfo| {
            let (q, d) = (part(q, joint.q), part(step, joint.v));
            match joint.kind {
                JointKind::Spherical => follow((four(q), Vector3::zeros()), exponential(three(d), Vector3::zeros())).0.to_vec(),
                JointKind::Floating => {
                    let (x, p) = follow((four(&q[3..]), three(q)), exponential(three(d), three(&d[3..])));
                    [p.as_slice(), &x].concat()
                }
                _ => q.iter().zip(d).map(|(&q, &d)| q + d).collect(),
            }
        };
        self.joints.iter().flat_map(one).collect()
    }

    /// The shortest step with q ⊕ step = target, `[nv]`.
    pub fn difference(&self, q: &[S], target: &[S]) -> Vec<S> {
        let one = |joint: &JointInfo| {
            let (q, t) = (part(q, joint.q), part(target, joint.q));
            match joint.kind {
                JointKind::Spherical => turn_between(four(q), four(t)).as_slice().to_vec(),
                JointKind::Floating => {
                    let omega = turn_between(four(&q[3..]), four(&t[3..]));
                    // Rᵀ (p_t − p) = V(ω) v
                    let way = from_quaternion(four(&q[3..])).transpose() * (three(t) - three(q));
                    let v = inverse(&mean_rotation(omega)) * way;
                    [omega.as_slice(), v.as_slice()].concat()
                }
                _ => q.iter().zip(t).map(|(&q, &t)| t - q).collect(),
            }
        };
        self.joints.iter().flat_map(one).collect()
    }

    /// From numbers uniform in [0, 1), `[nq]`: within limits, a turn or 2 m from the other where
    /// one is open, ±π and ±1 m where both are or there are none; of a rotation's four the first
    /// three count. A ball joint with a range turns by at most that angle.
    pub fn random_configuration(&self, uniform: &[S]) -> Vec<S> {
        let pi = S::zero().atan2(-S::one());
        let between = |u: S, lower: S, upper: S| lower + (upper - lower) * u;
        let within = |u: S, limit: &Limit, turns: bool| {
            let round = if turns { pi + pi } else { S::from_f64(2.0) };
            let [a, b] = [limit.lower.min(limit.upper), limit.lower.max(limit.upper)];
            match (a.is_finite(), b.is_finite()) {
                (true, true) => between(u, S::from_f64(a), S::from_f64(b)),
                (true, false) => between(u, S::from_f64(a), S::from_f64(a) + round),
                (false, true) => between(u, S::from_f64(b) - round, S::from_f64(b)),
                (false, false) => between(u, -round, round) * S::from_f64(0.5),
            }
        };
        let (angle, length) = (|u: S| between(u, -pi, pi), |u: S| between(u, -S::one(), S::one()));
        let one = |joint: &JointInfo| {
            let u = part(uniform, joint.q);
            match (joint.kind, &joint.limit) {
                (JointKind::Spherical, _) => joint.cone.map_or_else(|| rotation(u), |cone| rotation_within(S::from_f64(cone), u)).to_vec(),
                (kind, Some(limit)) => u.iter().map(|&u| within(u, limit, !kind.is_linear())).collect(),
                (JointKind::Prismatic, None) => alloc::vec![length(u[0])],
                (JointKind::Planar, None) => alloc::vec![length(u[0]), length(u[1]), angle(u[2])],
                (JointKind::Floating, None) => {
                    let p: Vec<S> = u[..3].iter().map(|&u| length(u)).collect();
                    [p.as_slice(), &rotation(&u[3..])].concat()
                }
                _ => u.iter().map(|&u| angle(u)).collect(),
            }
        };
        self.joints.iter().flat_map(one).collect()
    }
}

/// A joint's numbers in a vector.
pub(super) fn part<S>(x: &[S], (at, n): (usize, usize)) -> &[S] {
    &x[at..][..n]
}

pub(super) fn three<S: Scalar>(x: &[S]) -> Vector3<S> {
    Vector3::new(x[0], x[1], x[2])
}

fn four<S: Scalar>(x: &[S]) -> [S; 4] {
    [x[0], x[1], x[2], x[3]]
}

/// T_1 T_2.
fn follow<S: Scalar>((a, p): Pose<S>, (b, r): Pose<S>) -> Pose<S> {
    (product(a, b), p + from_quaternion(a) * r)
}

/// exp of a twist: the quaternion Σ (ω/2)ᵏ/k! and the position Σ [ω]×ᵏ v/(k+1)!, of a small part of
/// the step, doubled up.
fn exponential<S: Scalar>(omega: Vector3<S>, v: Vector3<S>) -> Pose<S> {
    let part = S::from_f64(1.0 / f64::from(1_u32 << HALVINGS));
    let (omega, v) = (omega * part, v * part);
    let half = omega * S::from_f64(0.5);
    let (mut power, mut x) = ([S::zero(), S::zero(), S::zero(), S::one()], [S::zero(), S::zero(), S::zero(), S::one()]);
    for k in 1..TERMS {
        let factor = S::one() / S::from_f64(f64::from(k));
        power = product(power, [half.x, half.y, half.z, S::zero()]).map(|c| c * factor);
        x = [0, 1, 2, 3].map(|i| x[i] + power[i]);
    }
    (0..HALVINGS).fold((x, mean_rotation_of_small(omega) * v), |pose, _| follow(pose, pose))
}

/// Σ [ω]×ᵏ/(k+1)! = ∫₀¹ exp([ω]× s) ds.
fn mean_rotation_of_small<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    let w = cross_matrix(omega);
    let (mut power, mut sum) = (Matrix3::identity(), Matrix3::identity());
    for k in 1..TERMS {
        power = power * w * (S::one() / S::from_f64(f64::from(k + 1)));
        sum += power;
    }
    sum
}

/// V(ω): where exp takes the origin for each v, by its columns.
fn mean_rotation<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    let e = |k: usize| Vector3::from_fn(|i, _| if i == k { S::one() } else { S::zero() });
    Matrix3::from_columns(&[0, 1, 2].map(|k| exponential(omega, e(k)).1))
}

/// By cofactors.
pub(super) fn inverse<S: Scalar>(m: &Matrix3<S>) -> Matrix3<S> {
    let (a, b, c) = (m.column(0).into_owned(), m.column(1).into_owned(), m.column(2).into_owned());
    let rows = [b.cross(&c), c.cross(&a), a.cross(&b)];
    let determinant = a.dot(&rows[0]);
    Matrix3::from_fn(|i, j| rows[i][j] / determinant)
}

/// ω with exp(ω/2) = x⁻¹ y, of the two turns to the same rotation the shorter.
fn turn_between<S: Scalar>(x: [S; 4], y: [S; 4]) -> Vector3<S> {
    let r = product([-x[0], -x[1], -x[2], x[3]], y);
    // y and −y are the same rotation.
    let backward = (-r[3]).positive();
    let r = r.map(|c| S::select(backward, -c, c));
    let u = three(&r);
    let sine = u.dot(&u).sqrt();
    let two = S::from_f64(2.0);
    // θ/2 = atan2(|u|, w); near no turn at all u = ω/2.
    let factor = S::select(sine.positive(), two * sine.atan2(r[3]) / sine, two / r[3]);
    u * factor
}

/// A rotation by at most `largest`, rad, uniform among those: the part u of their volume θ − sin θ
/// is below its angle, which bisection finds.
fn rotation_within<S: Scalar>(largest: S, u: &[S]) -> [S; 4] {
    let (half, turn) = (S::from_f64(0.5), S::zero().atan2(-S::one()) * S::from_f64(2.0));
    let volume = |angle: S| angle - angle.sin_cos().0;
    let wanted = u[0] * volume(largest);
    let (mut lower, mut upper) = (S::zero(), largest);
    for _ in 0..S::BITS + 10 {
        let angle = half * (lower + upper);
        let is_beyond = (volume(angle) - wanted).positive();
        (lower, upper) = (S::select(is_beyond, lower, angle), S::select(is_beyond, angle, upper));
    }
    let (s, c) = (half * lower).sin_cos();
    let z = S::one() - u[1] - u[1];
    let (y, x) = (turn * u[2]).sin_cos();
    let radius = (S::one() - z * z).sqrt();
    [s * radius * x, s * radius * y, s * z, c]
}

/// A uniform rotation of three uniform numbers; Shoemake, *Graphics Gems III*, 1992, "Uniform
/// random rotations".
fn rotation<S: Scalar>(u: &[S]) -> [S; 4] {
    let turn = S::zero().atan2(-S::one()) * S::from_f64(2.0);
    let ((s1, c1), (s2, c2)) = ((turn * u[1]).sin_cos(), (turn * u[2]).sin_cos());
    let (r1, r2) = ((S::one() - u[0]).sqrt(), u[0].sqrt());
    [s1 * r1, c1 * r1, s2 * r2, c2 * r2]
}
