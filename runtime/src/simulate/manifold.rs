//! Which coordinates are quaternions, and motion in a chart of step vectors.
//!
//! A step of an integrator is made in the step vector u of q = q_0 ⊕ u, where q_0 is the
//! configuration at its start: plain numbers, in which any Runge–Kutta method keeps its order and
//! no quaternion leaves its sphere. Joints that turn freely move as
//!
//! ```text
//! q = q_0·exp(u)      u̇ = J_r(u)⁻¹ v = v + ½ [u, v] + …
//! ```
//!
//! with the inverse of the right Jacobian of SO(3) or SE(3) in closed form (Munthe-Kaas, BIT 38,
//! 1998; Hairer, Lubich & Wanner 2006, §IV.8); for every other u̇ = v. J_r is regular up to a turn
//! by 2π in one step.

use std::f64::consts::TAU;
use std::ops::Range;

use articulated_core::algorithm::FunctionError;
use articulated_core::dynamics::Dynamics;
use articulated_core::nalgebra::Matrix6;
use articulated_core::spatial::screw::{cross_matrix, exp_rotation, left_jacobian_inverse, right_jacobian_inverse};
use articulated_core::spatial::{Twist, Vector3, input_norm};

use super::StateError;
use super::error::joint;

/// A joint whose coordinates are more than its rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Free {
    /// First of its coordinates.
    pub(crate) q: usize,
    /// First of its rates: the three of the angular velocity.
    pub(crate) v: usize,
    /// Whether it moves too: seven coordinates and six rates instead of four and three.
    pub(crate) moves: bool,
}

impl Free {
    /// Where its quaternion is.
    pub(crate) fn quaternion(&self) -> Range<usize> {
        let first = self.q + if self.moves { 3 } else { 0 };
        first..first + 4
    }

    /// Number of its rates.
    pub(crate) fn rates(&self) -> usize {
        if self.moves { 6 } else { 3 }
    }
}

/// The manifold of a robot's configurations.
#[derive(Clone, Debug)]
pub(crate) struct Manifold {
    pub(crate) nq: usize,
    pub(crate) nv: usize,
    /// Joints with a quaternion; all other coordinates are plain, in order.
    pub(crate) free: Vec<Free>,
}

impl Manifold {
    /// Found by the function `integrate`: q = (½, ½, …) is a configuration of any robot, and a
    /// small turn of a joint moves its quaternion alone.
    pub(crate) fn of<R: Dynamics<f64>>(robot: &R) -> Result<Self, FunctionError> {
        let shape = robot.shape();
        let mut manifold = Self { nq: shape.nq, nv: shape.nv, free: Vec::new() };
        let (mut q, mut v) = (0, 0);
        while manifold.free.len() < shape.nq.saturating_sub(shape.nv) && v < shape.nv {
            match moved(robot, v)? {
                changed if changed.len() == 1 => (q, v) = (q + 1, v + 1),
                changed => {
                    let free = Free { q, v, moves: changed.start > q };
                    (q, v) = (free.quaternion().end, v + free.rates());
                    manifold.free.push(free);
                }
            }
        }
        // One more coordinate than rates for each quaternion.
        let expected = shape.nv + manifold.free.len();
        let fits = manifold.free.last().is_none_or(|f| f.quaternion().end <= shape.nq && f.v + f.rates() <= shape.nv);
        if shape.nq != expected || !fits {
            return Err(FunctionError::Length { argument: "q", found: shape.nq, expected });
        }
        Ok(manifold)
    }

    /// Whether every coordinate is plain.
    pub(crate) fn is_flat(&self) -> bool {
        self.free.is_empty()
    }

    /// q ⊕ u.
    pub(crate) fn step<R: Dynamics<f64>>(
        &self,
        robot: &R,
        ws: &mut R::Workspace,
        q: &[f64],
        u: &[f64],
        out: &mut [f64],
    ) -> Result<(), FunctionError> {
        if u.iter().all(|u| *u == 0.0) {
            // To the last bit where it is: a quaternion that is normalised again may move by a
            // rounding.
            out.copy_from_slice(q);
            return Ok(());
        }
        self.integrate(robot, ws, q, u, out)
    }

    /// The same with quaternions of norm one for no step too.
    pub(crate) fn integrate<R: Dynamics<f64>>(
        &self,
        robot: &R,
        ws: &mut R::Workspace,
        q: &[f64],
        u: &[f64],
        out: &mut [f64],
    ) -> Result<(), FunctionError> {
        if self.is_flat() {
            out.iter_mut().zip(q).zip(u).for_each(|((out, q), u)| *out = q + u);
            return Ok(());
        }
        robot.integrate(ws, q, u, out)
    }

    /// u̇ at the rates v; not a number beyond a turn by 2π.
    pub(crate) fn rates(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
        for free in &self.free {
            let (omega, at) = (three(u, free.v), free.v);
            let turn = omega.norm_squared();
            if turn < SMALL_TURN {
                small_turn_rates(free, u, v, turn, out);
            } else if turn.is_nan() || turn >= TAU * TAU {
                out[at..at + free.rates()].fill(f64::NAN);
            } else if free.moves {
                let rate = Twist { angular: omega, linear: three(u, at + 3) }.right_jacobian_inverse()
                    * articulated_core::nalgebra::Vector6::from_column_slice(&v[at..at + 6]);
                out[at..at + 6].copy_from_slice(rate.as_slice());
            } else {
                out[at..at + 3].copy_from_slice((right_jacobian_inverse(omega) * three(v, at)).as_slice());
            }
        }
    }

    /// ∂u̇/∂u at u = 0 for one joint: −½ ad(v), in the first 3 or 6 rows and columns.
    pub(crate) fn rates_derivative(free: &Free, v: &[f64]) -> Matrix6<f64> {
        let angular = three(v, free.v);
        if free.moves {
            return Twist { angular, linear: three(v, free.v + 3) }.ad() * -0.5;
        }
        let mut all = Matrix6::zeros();
        all.fixed_view_mut::<3, 3>(0, 0).copy_from(&(cross_matrix(angular) * -0.5));
        all
    }

    /// The fastest of the joints that turn freely, by its first degree of freedom, and its speed,
    /// rad/s.
    pub(crate) fn fastest_turn(&self, v: &[f64]) -> Option<(usize, f64)> {
        self.free.iter().map(|free| (free.v, three(v, free.v).norm())).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Reference of the relative errors of the steps of q: the coordinate, 1 for a turn, the
    /// distance from the origin for a position.
    pub(crate) fn magnitudes(&self, q: &[f64], out: &mut [f64]) {
        let (mut at, mut free) = ((0, 0), self.free.iter());
        loop {
            let next = free.next();
            let (to_q, to_v) = next.map_or((self.nq, self.nv), |f| (f.q, f.v));
            out[at.1..to_v].iter_mut().zip(&q[at.0..to_q]).for_each(|(out, q)| *out = q.abs());
            let Some(f) = next else { return };
            out[f.v..f.v + 3].fill(1.0);
            if f.moves {
                out[f.v + 3..f.v + 6].fill(three(q, f.q).norm());
            }
            at = (f.quaternion().end, f.v + f.rates());
        }
    }

    /// Step vector u and velocity v at the end of a semi-implicit Euler step of length h, from
    /// velocity `v0` and acceleration `a` at its start.
    ///
    /// The velocity of the origin of a floating joint is stepped in axes that do not rotate, those
    /// of the joint at the start of the step:
    ///
    /// ```text
    /// ω₁ = ω₀ + h ω̇      w = v₀ + h (v̇ + ω₀ × v₀)      q₁: rotated by exp(h ω₁), moved by h w      v₁ = exp(h ω₁)ᵀ w
    /// ```
    ///
    /// v̇ + ω × v is the acceleration of the origin, which no constant velocity of the frame
    /// changes: such a velocity is kept to rounding (Galilean invariance). A step of v in body axes
    /// instead multiplies it by √(1 + h² ω²).
    pub(crate) fn semi_implicit_step(&self, v0: &[f64], a: &[f64], h: f64, u: &mut [f64], v: &mut [f64]) {
        v.iter_mut().zip(v0).zip(a).for_each(|((v, v0), a)| *v = v0 + h * a);
        u.iter_mut().zip(&*v).for_each(|(u, v)| *u = h * v);
        for at in self.free.iter().filter(|free| free.moves).map(|free| free.v) {
            let (rotation, spin) = (three(u, at), three(v0, at));
            let w = three(v, at + 3) + spin.cross(&three(v0, at + 3)) * h;
            // The translation of exp(u) is the left Jacobian of its rotation times the linear part
            // of u.
            let (along, turned) = carried(rotation, w);
            u[at + 3..at + 6].copy_from_slice((along * h).as_slice());
            v[at + 3..at + 6].copy_from_slice(turned.as_slice());
        }
    }

    /// The step vector that turns by 2 atan(½|w|) about w = step where exp turns by |w|: Cayley's
    /// map as an exponential. On SE(3) the same with dual numbers, so that its adjoint is (1 − ½
    /// ad)⁻¹(1 + ½ ad). Plain coordinates stay as they are.
    pub(crate) fn cayley(&self, step: &mut [f64]) {
        for free in &self.free {
            let (w, at) = (three(step, free.v), free.v);
            let x = w.norm_squared();
            let (f, rate) = arc(x);
            if free.moves {
                // f(x + 2ε w·s)·(w + ε s)
                let s = three(step, at + 3);
                let moved = s * f + w * (2.0 * rate * w.dot(&s));
                step[at + 3..at + 6].copy_from_slice(moved.as_slice());
            }
            step[at..at + 3].copy_from_slice((w * f).as_slice());
        }
    }

    /// The degree of freedom, or the first of those, that a coordinate belongs to.
    fn freedom_of(&self, coordinate: usize) -> usize {
        match self.free.iter().rev().find(|free| free.q <= coordinate) {
            Some(free) if coordinate < free.quaternion().end => free.v,
            Some(free) => free.v + free.rates() + coordinate - free.quaternion().end,
            None => coordinate,
        }
    }

    /// Errors in a configuration; `vector` is the caller's name of it.
    pub(crate) fn wrong<R: Dynamics<f64>>(&self, robot: &R, vector: &'static str, q: &[f64]) -> impl Iterator<Item = StateError> {
        let quaternion = move |free: &Free| {
            let norm = input_norm(&q[free.quaternion()]).err()?;
            Some(StateError::Quaternion { vector, index: free.quaternion().start, norm, joint: joint(robot, free.v) })
        };
        let quaternions =
            self.free.iter().filter(|free| q.len() == self.nq && q[free.quaternion()].iter().all(|x| x.is_finite())).filter_map(quaternion);
        StateError::of(vector, q, self.nq, |i| joint(robot, self.freedom_of(i))).chain(quaternions)
    }

    /// Errors in a state.
    pub(crate) fn wrong_state<R: Dynamics<f64>>(&self, robot: &R, q: &[f64], v: &[f64]) -> impl Iterator<Item = StateError> {
        self.wrong(robot, "q", q).chain(StateError::of_freedoms("v", v, robot))
    }
}

/// J_l(ω)⁻¹ w and exp(ω)ᵀ w.
fn carried(omega: Vector3<f64>, w: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let x = omega.norm_squared();
    if x.is_nan() || x >= SMALL_TURN {
        return (left_jacobian_inverse(omega) * w, exp_rotation(omega).transpose() * w);
    }
    // 1 − ½ [ω] + ε [ω]² and 1 − sin θ/θ [ω] + (1 − cos θ)/θ² [ω]², in powers of x = θ².
    let once = omega.cross(&w);
    let twice = omega.cross(&once);
    let epsilon = 1.0 / 12.0 + x * (1.0 / 720.0 + x * (1.0 / 30_240.0 + x * (1.0 / 1_209_600.0 + x / 47_900_160.0)));
    let sinc = 1.0 - x / 6.0 * (1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0)));
    let versine = 0.5 - x / 24.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0 * (1.0 - x / 90.0)));
    (w - once * 0.5 + twice * epsilon, w - once * sinc + twice * versine)
}

/// Up to this θ² the rates come from a series in brackets, which is shorter than the closed form.
const SMALL_TURN: f64 = 0.01;

/// u̇ = v + ½ [u, v] + Σ B_2k/(2k)! [u, [u, … v]] of 2k brackets (Munthe-Kaas 1998): as many as
/// matter at θ², which is below [`SMALL_TURN`].
fn small_turn_rates(free: &Free, u: &[f64], v: &[f64], turn: f64, out: &mut [f64]) {
    const COEFFICIENTS: [f64; 4] = [1.0 / 12.0, -1.0 / 720.0, 1.0 / 30_240.0, -1.0 / 1_209_600.0];
    let at = free.v;
    if u[at..at + free.rates()].iter().all(|u| *u == 0.0) {
        return;
    }
    let linear = |x: &[f64]| if free.moves { three(x, at + 3) } else { Vector3::zeros() };
    let (omega, along) = (three(u, at), linear(u));
    let bracket = |(w, l): (Vector3<f64>, Vector3<f64>)| (omega.cross(&w), omega.cross(&l) + along.cross(&w));
    let mut term = bracket((three(v, at), linear(v)));
    let mut sum = (term.0 * 0.5, term.1 * 0.5);
    // Brackets grow by θ, and once by the linear part: twice its power is left of it.
    let mut size = 1.0;
    for coefficient in COEFFICIENTS {
        term = bracket(term);
        sum = (sum.0 + term.0 * coefficient, sum.1 + term.1 * coefficient);
        size *= turn;
        if size * turn < 1e-13 {
            break;
        }
        term = bracket(term);
    }
    for k in 0..3 {
        out[at + k] += sum.0[k];
        if free.moves {
            out[at + 3 + k] += sum.1[k];
        }
    }
}

/// Which coordinates a turn or shift along rate `v` changes.
fn moved<R: Dynamics<f64>>(robot: &R, v: usize) -> Result<Range<usize>, FunctionError> {
    let (shape, mut ws) = (robot.shape(), robot.workspace());
    let (half, mut range) = (vec![0.5; shape.nq], shape.nq..0);
    let (mut step, mut out) = (vec![0.0; shape.nv], vec![0.0; shape.nq]);
    for by in [0.25, -0.25] {
        step[v] = by;
        robot.integrate(&mut ws, &half, &step, &mut out)?;
        for i in (0..shape.nq).filter(|&i| (out[i] - 0.5).abs() > 1e-9) {
            range = range.start.min(i)..range.end.max(i + 1);
        }
    }
    Ok(range)
}

fn three(x: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(x[at], x[at + 1], x[at + 2])
}

/// f = 2 atan(½θ)/θ and df/dx of x = θ².
fn arc(x: f64) -> (f64, f64) {
    let y = 0.25 * x;
    if y < 1e-2 {
        // Σ (−y)ᵏ/(2k + 1), and its derivative
        let (mut f, mut rate, mut power) = (0.0, 0.0, 1.0);
        for k in 0..9 {
            let k = f64::from(k);
            f += power / (2.0 * k + 1.0);
            rate -= (k + 1.0) * power / (2.0 * k + 3.0);
            power *= -y;
        }
        return (f, 0.25 * rate);
    }
    let h = y.sqrt();
    let f = h.atan() / h;
    (f, 0.25 * (1.0 / (1.0 + y) - f) / (2.0 * y))
}

#[cfg(test)]
mod tests {
    use super::{Free, Manifold, TAU, Vector3, arc, carried, exp_rotation, left_jacobian_inverse};

    /// A slide, a floating joint, a hinge, a ball joint.
    fn mixed() -> Manifold {
        Manifold { nq: 13, nv: 11, free: vec![Free { q: 1, v: 1, moves: true }, Free { q: 9, v: 8, moves: false }] }
    }

    #[test]
    fn errors_are_relative_to_coordinates_turns_and_distances() {
        let q = [-3.0, 2.0, -3.0, 6.0, 0.5, 0.5, 0.5, 0.5, -0.25, 0.5, 0.5, 0.5, 0.5];
        let mut out = [f64::NAN; 11];
        mixed().magnitudes(&q, &mut out);
        assert_eq!(out, [3.0, 1.0, 1.0, 1.0, 7.0, 7.0, 7.0, 0.25, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn coordinates_belong_to_the_joints_that_have_their_rates() {
        let freedoms: [usize; 13] = std::array::from_fn(|i| mixed().freedom_of(i));
        assert_eq!(freedoms, [0, 1, 1, 1, 1, 1, 1, 1, 7, 8, 8, 8, 8]);
        let hinge_behind = Manifold { nq: 6, nv: 5, free: vec![Free { q: 1, v: 1, moves: false }] };
        assert_eq!([0, 1, 4, 5].map(|i| hinge_behind.freedom_of(i)), [0, 1, 1, 4]);
    }

    #[test]
    fn beyond_a_whole_turn_there_are_no_rates() {
        for (at, rates) in [(1, 1..7), (8, 8..11)] {
            for (turn, known) in [(0.999 * TAU, true), (1.001 * TAU, false)] {
                let (mut u, mut out) = ([0.0; 11], [0.0; 11]);
                u[at + 1] = turn;
                mixed().rates(&u, &[0.5; 11], &mut out);
                assert!((0..11).all(|i| out[i].is_finite() == (known || !rates.contains(&i))), "{turn}: {out:?}");
            }
        }
    }

    #[test]
    fn what_a_small_turn_carries_is_that_of_the_closed_form() {
        let (axis, w) = (Vector3::new(0.6, -0.48, 0.64), Vector3::new(0.3, -2.0, 1.1));
        for turn in [0.0, 1e-9, 1e-5, 1e-3, 0.02, 0.0999, 0.1001, 2.0] {
            let (along, turned) = carried(axis * turn, w);
            assert!((along - left_jacobian_inverse(axis * turn) * w).norm() < 1e-15, "{turn}");
            assert!((turned - exp_rotation(axis * turn).transpose() * w).norm() < 2e-15, "{turn}");
        }
    }

    /// Against the closed form, from turns of zero to the largest that the series takes, with steps
    /// that move far.
    #[test]
    fn rates_of_small_turns_are_those_of_the_closed_form() {
        use articulated_core::nalgebra::Vector6;
        use articulated_core::spatial::Twist;
        use articulated_core::spatial::screw::right_jacobian_inverse;
        let v: [f64; 11] = std::array::from_fn(|i| (1.0 + 2.7 * i as f64).sin());
        for turn in [0.0, 1e-12, 1e-8, 1e-5, 1e-3, 0.02, 0.0999, 0.1001] {
            for far in [0.0, 0.1, 10.0] {
                let axis = Vector3::new(0.6, -0.48, 0.64);
                let along = Vector3::new(0.3, 0.5, -0.7) * far;
                let mut u = [0.0; 11];
                for k in 0..3 {
                    (u[1 + k], u[4 + k], u[8 + k]) = (turn * axis[k], along[k], turn * axis[k]);
                }
                let mut out = [0.0; 11];
                mixed().rates(&u, &v, &mut out);
                let twist = Twist { angular: axis * turn, linear: along };
                let free = twist.right_jacobian_inverse() * Vector6::from_column_slice(&v[1..7]);
                let ball = right_jacobian_inverse(axis * turn) * Vector3::from_column_slice(&v[8..11]);
                for (k, exact) in free.iter().chain(ball.iter()).enumerate() {
                    let found = out[if k < 6 { 1 + k } else { 2 + k }];
                    assert!((found - exact).abs() < 2e-15 * (1.0 + far), "{turn} {far} {k}: {found} {exact}");
                }
            }
        }
    }

    #[test]
    fn series_and_closed_form_of_the_arc_meet() {
        for y in [0.0099, 0.0101, 0.5, 4.0_f64] {
            let (f, rate) = arc(4.0 * y);
            let exact = y.sqrt().atan() / y.sqrt();
            let slope = (1.0 / (1.0 + y) - exact) / (8.0 * y);
            assert!((f - exact).abs() < 1e-15 && (rate - slope).abs() < 1e-14, "{y}: {f} {exact} {rate} {slope}");
        }
        assert_eq!(arc(0.0), (1.0, -1.0 / 12.0));
    }
}
