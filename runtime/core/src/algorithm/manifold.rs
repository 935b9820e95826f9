//! Configurations as points of a manifold: steps, differences, points at random.
//!
//! A floating joint's coordinates are a placement, a spherical one's a rotation: they have seven
//! and four numbers for six and three degrees of freedom. A step δ of the tangent space moves the
//! child along its own body twist: q ⊕ δ = T·exp(δ), R·exp(δ), and q + δ for all other joints.
//! Joints that follow others have no coordinates, so no step. Barfoot 2017, §7.1.6; Lynch & Park
//! 2017, §3.3.3.

use core::f64::consts::{PI, TAU};

use super::Workspace;
use crate::Scalar;
use crate::description::{JointKind, Limit, Quantity};
use crate::model::{JointInfo, Model};
use crate::scalar::two_to;
use crate::spatial::screw::{HalfAngle, Quaternion};
use crate::spatial::{Twist, Vector3, rotate, rotate_back};

/// q ⊕ step: where a motion with constant rates gets to in a unit of time; rates are body twists
/// where a joint has more than it can add up.
///
/// q: `[nq]` rad|m|quaternion; step: `[nv]` rad|m|twist times time; out: `[nq]`, quaternions of
/// norm one to 2u. Absolute error some (4 + |ω|)·u of a quaternion, or times |position| + |v|; one
/// rounding of a sum.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn integrate<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, q: &[S], step: &[S], out: &mut [S]) {
    for joint in &model.joints {
        let (q, step, out) = (&q[range(joint.q)], &step[range(joint.v)], &mut out[range(joint.q)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let (position, rotation) = placement(q);
                let (turn, shift) = six(step).exp_parts();
                // p + R J_l(ω) v, R exp ω
                put(out, &(position + rotate(&rotation.to_rotation(), shift)));
                put_quaternion(&mut out[3..], &rotation.product(&turn));
            }
            Space::Rotations => put_quaternion(out, &quaternion(q).product(&Quaternion::exp(three(step)))),
            Space::Numbers => plain(out, q, step, |q, step| q + step),
        }
    }
}

/// q ⊕ step for a step so small that its third power does not count: the polynomial that has the
/// value, the first and the second derivatives of [`integrate`] at step = 0. Derivatives in the
/// tangent space are those of f(q ⊕ δ) at δ = 0.
///
/// ```text
/// p + R (v + ½ ω × v),   quaternion ⊗ (½ ω, 1 − ⅛ |ω|²)
/// ```
///
/// q: `[nq]` rad|m|quaternion; step: `[nv]` rad|m|twist times time; out: `[nq]`, quaternions of
/// norm one to second order in the step.
///
/// # Panics
/// As [`integrate`].
pub fn small_step<S: Scalar>(model: &Model<S>, q: &[S], step: &[S], out: &mut [S]) {
    let half = S::from_f64(0.5);
    let turn = |omega: Vector3<S>| {
        let [x, y, z] = [0, 1, 2].map(|k| half * omega[k]);
        Quaternion::from_array([x, y, z, S::one() - half * (x * x + y * y + z * z)])
    };
    for joint in &model.joints {
        let (q, step, out) = (&q[range(joint.q)], &step[range(joint.v)], &mut out[range(joint.q)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let ((position, rotation), Twist { angular, linear }) = (placement(q), six(step));
                let shift = linear + angular.cross(&linear) * half;
                put(out, &(position + rotate(&rotation.to_rotation(), shift)));
                out[3..7].copy_from_slice(&rotation.product(&turn(angular)).to_array());
            }
            Space::Rotations => out[..4].copy_from_slice(&quaternion(q).product(&turn(three(step))).to_array()),
            Space::Numbers => plain(out, q, step, |q, step| q + step),
        }
    }
}

/// target ⊖ q for a target so near that the third power of the step does not count: the polynomial
/// that has the value, the first and the second derivatives of [`difference`] at target = q.
///
/// ```text
/// ω = 2 vec(quaternion* ⊗ target),   v = d − ½ ω × d with d = Rᵀ (p_target − p)
/// ```
///
/// q, target: `[nq]` rad|m|quaternion; out: `[nv]` rad|m|twist times time.
///
/// # Panics
/// As [`integrate`].
pub fn small_difference<S: Scalar>(model: &Model<S>, q: &[S], target: &[S], out: &mut [S]) {
    let two = S::from_f64(2.0);
    let turn = |from: &Quaternion<S>, to: &Quaternion<S>| three(&from.conjugate().product(to).to_array()) * two;
    for joint in &model.joints {
        let (q, target, out) = (&q[range(joint.q)], &target[range(joint.q)], &mut out[range(joint.v)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let ((from, rotation), (to, other)) = (placement(q), placement(target));
                let (omega, way) = (turn(&rotation, &other), rotate_back(&rotation.to_rotation(), to - from));
                put(out, &omega);
                put(&mut out[3..], &(way - omega.cross(&way) * S::from_f64(0.5)));
            }
            Space::Rotations => put(out, &turn(&quaternion(q), &quaternion(target))),
            Space::Numbers => plain(out, q, target, |q, target| target - q),
        }
    }
}

/// Divides each quaternion of a configuration by its length: q/|q|. Derivatives in coordinates are
/// those of f(q/|q|). Other coordinates stay as they are.
///
/// q: `[nq]` rad|m|quaternion. The squares of a quaternion must be in the range of numbers, and
/// their sum not zero: this is the plain formula, of which derivatives are traced.
///
/// # Panics
/// If `q` is shorter than that.
pub fn divide_by_length<S: Scalar>(model: &Model<S>, q: &mut [S]) {
    for quaternion in model.joints.iter().filter_map(JointInfo::quaternion) {
        let square = q[quaternion.clone()].iter().fold(S::zero(), |sum, x| sum + *x * *x);
        let inverse = S::one() / square.sqrt();
        q[quaternion].iter_mut().for_each(|x| *x *= inverse);
    }
}

/// target ⊖ q: the step that takes q to the target, with no rotation beyond half a turn.
///
/// q, target: `[nq]` rad|m|quaternion; out: `[nv]` rad|m|twist times time. Absolute error some 8u
/// of a rotation, that times the distance of a translation, up to half a turn; there the step is
/// one of two, see [`Quaternion::log`]. Angles are subtracted as they are, not taken modulo a turn.
///
/// # Panics
/// As [`integrate`].
pub fn difference<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, q: &[S], target: &[S], out: &mut [S]) {
    for joint in &model.joints {
        let (q, target, out) = (&q[range(joint.q)], &target[range(joint.q)], &mut out[range(joint.v)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let step = way_between(q, target);
                put(out, &step.angular);
                put(&mut out[3..], &step.linear);
            }
            Space::Rotations => put(out, &turn_between(q, target)),
            Space::Numbers => plain(out, q, target, |q, target| target - q),
        }
    }
}

/// A configuration from numbers in [0, 1): uniform if they are.
///
/// uniform: `[nq]`, the last of each quaternion's four is ignored; out: `[nq]` rad|m|quaternion.
/// Coordinates in their boxes ([`coordinate_box`]). Rotations uniform: Shoemake, *Uniform random
/// rotations*, Graphics Gems III, 1992. Those of a ball joint with a range are uniform among the
/// rotations by at most that angle ([`JointInfo::cone`]).
///
/// # Panics
/// As [`integrate`].
pub fn random_configuration<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, uniform: &[S], out: &mut [S]) {
    for joint in &model.joints {
        let (uniform, out) = (&uniform[range(joint.q)], &mut out[range(joint.q)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                out.iter_mut().zip(&uniform[..3]).for_each(|(out, u)| *out = between(-1.0, 1.0, *u));
                put_quaternion(&mut out[3..], &rotation_from(&uniform[3..]));
            }
            Space::Rotations => {
                let rotation = joint.cone.map_or_else(|| rotation_from(uniform), |largest| rotation_within(largest, uniform));
                put_quaternion(out, &rotation);
            }
            Space::Numbers => {
                for (k, (out, u)) in out.iter_mut().zip(uniform).enumerate() {
                    let (lower, upper) = coordinate_box(joint, k);
                    *out = between(lower, upper, *u);
                }
            }
        }
    }
}

/// The configuration of zeros, with identity quaternions: `[nq]` rad|m|quaternion.
///
/// # Panics
/// If `out` is shorter than that.
pub fn neutral<S: Scalar>(model: &Model<S>, out: &mut [S]) {
    for joint in &model.joints {
        out[range(joint.q)].fill(S::zero());
        if let Some(quaternion) = joint.quaternion() {
            out[quaternion.end - 1] = S::one();
        }
    }
}

/// The space of a joint's coordinates.
pub(crate) enum Space {
    /// Numbers, to which steps are added.
    Numbers,
    /// Rotations, as unit quaternions.
    Rotations,
    /// Placements, as positions and unit quaternions.
    Placements,
}

impl Space {
    pub(crate) fn of(kind: JointKind) -> Self {
        use JointKind::{Continuous, Fixed, Floating, Helical, Planar, Prismatic, Revolute, Spherical, Universal};
        match kind {
            Fixed | Revolute | Continuous | Prismatic | Helical | Universal | Planar => Self::Numbers,
            Spherical => Self::Rotations,
            Floating => Self::Placements,
        }
    }
}

pub(crate) fn range((first, n): (usize, usize)) -> core::ops::Range<usize> {
    first..first + n
}

fn plain<S: Scalar>(out: &mut [S], a: &[S], b: &[S], f: impl Fn(S, S) -> S) {
    out.iter_mut().zip(a).zip(b).for_each(|((out, a), b)| *out = f(*a, *b));
}

pub(crate) fn three<S: Scalar>(x: &[S]) -> Vector3<S> {
    Vector3::new(x[0], x[1], x[2])
}

pub(crate) fn quaternion<S: Scalar>(x: &[S]) -> Quaternion<S> {
    Quaternion::from_array([x[0], x[1], x[2], x[3]])
}

/// A floating joint's step.
pub(crate) fn six<S: Scalar>(step: &[S]) -> Twist<S> {
    Twist { angular: three(step), linear: three(&step[3..]) }
}

/// log of T⁻¹ T_target, of a floating joint.
pub(super) fn way_between<S: Scalar>(q: &[S], target: &[S]) -> Twist<S> {
    let ((from, rotation), (to, other)) = (placement(q), placement(target));
    let way = rotate_back(&rotation.to_rotation(), to - from);
    Twist::log_of_parts(&rotation.conjugate().product(&other), way)
}

/// log of R⁻¹ R_target, of a spherical joint.
pub(super) fn turn_between<S: Scalar>(q: &[S], target: &[S]) -> Vector3<S> {
    quaternion(q).conjugate().product(&quaternion(target)).log()
}

/// Position and rotation of a floating joint.
pub(crate) fn placement<S: Scalar>(q: &[S]) -> (Vector3<S>, Quaternion<S>) {
    (three(q), quaternion(&q[3..]))
}

pub(crate) fn put<S: Scalar>(out: &mut [S], x: &Vector3<S>) {
    out[..3].copy_from_slice(x.as_slice());
}

pub(crate) fn put_quaternion<S: Scalar>(out: &mut [S], q: &Quaternion<S>) {
    out[..4].copy_from_slice(&q.normalised().to_array());
}

/// The box of coordinate `k` of a joint, its lower end first, rad or m: its limits, if any, in
/// whichever order they are written. An open bound is 2π or 2 m from the other; if both are open,
/// as they may be for a sliding joint, ±π and ±1 m. For a floating joint ±1 m, and ±1 for the
/// numbers of a quaternion.
pub fn coordinate_box(joint: &JointInfo, k: usize) -> (f64, f64) {
    if joint.kind.quaternion().is_some() {
        return (-1.0, 1.0);
    }
    bounds(joint.limit, if joint.kind.coordinates().get(k) == Some(&Quantity::Length) { 1.0 } else { PI })
}

fn bounds(limit: Option<Limit>, most: f64) -> (f64, f64) {
    let (lower, upper) = limit.map_or((f64::NEG_INFINITY, f64::INFINITY), |l| (l.lower, l.upper));
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => (lower.min(upper), lower.max(upper)),
        (true, false) => (lower, lower + 2.0 * most),
        (false, true) => (upper - 2.0 * most, upper),
        (false, false) => (-most, most),
    }
}

/// lower + u·(upper − lower), which rounding must not take beyond the upper bound; where that
/// difference is beyond the range of numbers, from its parts.
fn between<S: Scalar>(lower: f64, upper: f64, u: S) -> S {
    let apart = (upper - lower).is_finite();
    let [lower, upper] = [lower, upper].map(S::from_f64);
    let x = if apart { lower + u * (upper - lower) } else { lower * (S::one() - u) + upper * u };
    S::select((x - upper).positive(), upper, x)
}

/// (√(1 − u_0)·(sin 2πu_1, cos 2πu_1), √u_0·(sin 2πu_2, cos 2πu_2)).
fn rotation_from<S: Scalar>(u: &[S]) -> Quaternion<S> {
    let circle = |square: S, u: S| {
        let (radius, (sin, cos)) = (square.sqrt(), (u * S::from_f64(TAU)).sin_cos());
        (radius * sin, radius * cos)
    };
    let ((x, y), (z, w)) = (circle(S::one() - u[0], u[1]), circle(u[0], u[2]));
    Quaternion::from_array([x, y, z, w])
}

/// A rotation by at most `largest` rad. If `u` is uniform, it is uniform among those: the axis is
/// uniform on the sphere, of which heights are uniform (Archimedes), and the angle θ has a density
/// proportional to 1 − cos θ.
fn rotation_within<S: Scalar>(largest: f64, u: &[S]) -> Quaternion<S> {
    let two = S::from_f64(2.0);
    let (sin, cos) = (angle_within(largest, u[0]) * S::from_f64(0.5)).sin_cos();
    let (y, x) = (u[2] * S::from_f64(TAU)).sin_cos();
    let radius = sin * two * (u[1] * (S::one() - u[1])).sqrt();
    Quaternion::from_array([radius * x, radius * y, sin * (S::one() - two * u[1]), cos])
}

/// The angle θ in [0, θ_max] with the part u of all rotations within θ_max below it:
///
/// ```text
/// θ − sin θ = u (θ_max − sin θ_max)
/// s³ γ(θ) = u γ(θ_max),   s = θ/θ_max,   γ = (θ − sin θ)/θ³,   d(s³ γ)/ds = s² β,   β = (1 − cos θ)/θ²
/// ```
///
/// by Newton's iteration for s, from a cube root of u. Each step doubles the digits, of which the
/// start has three bits.
fn angle_within<S: Scalar>(largest: f64, u: S) -> S {
    let (one, most) = (S::one(), S::from_f64(largest));
    let square = most * most;
    // The root has no derivative at 0.
    let least = S::from_f64(two_to(-120));
    let u = S::select((u - least).positive(), u, least);
    // 1/4 + 1/16 + 1/64 + 1/256 is nearly 1/3.
    let (mut power, mut root) = (u, one);
    for _ in 0..4 {
        power = power.sqrt().sqrt();
        root *= power;
    }
    let part = u * HalfAngle::new(square).excess();
    // s is ∛(6 γ_max) ∛u for small u, and 1 for u = 1.
    let small = S::from_f64(2.0 / 3.0) + S::from_f64(2.0) * HalfAngle::new(square).excess();
    let mut s = root * (small + (one - small) * (root * root));
    let mut bits = 3;
    while bits < S::BITS {
        let angle = HalfAngle::new(square * (s * s));
        s -= (s * angle.excess() - part / (s * s)) / angle.versine();
        bits *= 2;
    }
    most * S::select((s - one).positive(), one, s)
}
