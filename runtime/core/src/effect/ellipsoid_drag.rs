//! An ellipsoid in a fluid: drag, lift and added momentum.
//!
//! ```text
//! v, ω: of the frame, v less the wind;  u = v/|v|
//! s_i: semi-axes, s the longest;  V = 4/3 π s₁ s₂ s₃;  D = 2/3 (s₁ + s₂ + s₃)
//! N = diag(s_j² s_k²)/s⁴,  n = uᵀ N u,  d = uᵀ N² u
//! projected area:   A = π s² √(d/n);  A_max: of the two longest semi-axes
//! drag:             f = −(3 π D β + ρ |v| (c_b A + c_s (A_max − A))) v
//! Magnus lift:      f = c_m ρ V ω × v
//! Kutta lift:       f = c_k ρ π s² √(n/d) |v|² ((N u) × u) × u
//! drag of turns:    I_i = 8/15 π s_i max(s_j, s_k)⁴;  C_i = c_a I_i + c_s (I_max − I_i)
//!                   m = −(π D³ β + ρ |C ω|) ω
//! added momentum:   p = ρ M v, l = ρ J ω:  m = p × v + l × ω,  f = p × ω
//! ```
//!
//! Source: MuJoCo documentation, Fluid forces, Ellipsoid model; M and J: Lamb, Hydrodynamics, 1932,
//! ch. V.

use core::f64::consts::PI;

use super::{Field, FrameForce, Slopes, Station};
use crate::Scalar;
use crate::scalar::{greater, root};
use crate::spatial::{Matrix3, Twist, Vector3, Wrench, rotate_back};

pub(super) const FIELDS: &[Field] = &[
    Field::number("semi_axes", "m", "along the axes of the frame").positive().of(3),
    Field::number("density", "kg/m³", "of the fluid").at_least_zero().part(),
    Field::number("viscosity", "Pa·s", "of the fluid").at_least_zero().part().or(&[0.0]),
    Field::number("blunt", "1", "coefficient of drag of the projected area").or(&[0.5]),
    Field::number("slender", "1", "coefficient of drag of what the largest area exceeds the projected one by").or(&[0.25]),
    Field::number("angular", "1", "coefficient of drag of turns").or(&[1.5]),
    Field::number("kutta", "1", "coefficient of lift normal to the velocity").or(&[1.0]),
    Field::number("magnus", "1", "coefficient of lift by turns").or(&[1.0]),
    Field::number("virtual_mass", "m³", "fluid moved with the ellipsoid along each axis, over the density").or(&[0.0; 3]).of(3),
    Field::number("virtual_inertia", "m⁵", "inertia of that fluid about each axis, over the density").or(&[0.0; 3]).of(3),
    Field::number("wind", "m/s", "velocity of the fluid in the world frame").or(&[0.0; 3]).of(3),
];

pub(super) struct Law;

/// Below this speed, m/s, the velocity has no direction, as in MuJoCo.
const LEAST: f64 = 1e-15;

#[inline(always)]
fn length<S: Scalar>(x: &Vector3<S>) -> S {
    root(x.dot(x))
}

/// The numbers of a body in a fluid.
struct Body<'a, S> {
    /// The parameters.
    p: &'a [S],
    /// N.
    squares: Vector3<S>,
    /// π s².
    unit_area: S,
    largest_area: S,
    /// C.
    turning: Vector3<S>,
    /// 3 π D β and π D³ β.
    viscous: [S; 2],
    /// ρ M and ρ J.
    added: [Vector3<S>; 2],
    /// c_m ρ V.
    magnus: S,
    speed: S,
    /// u.
    direction: Vector3<S>,
    /// n and d; without a direction 1 and 0.
    projections: [S; 2],
}

impl<'a, S: Scalar> Body<'a, S> {
    /// At the velocity v.
    #[inline(always)]
    fn at(p: &'a [S], v: &Vector3<S>) -> Self {
        let (number, s) = (|x: f64| S::from_f64(x), [p[0], p[1], p[2]]);
        let square = |x: S| x * x;
        let longest = greater(greater(s[0], s[1]), s[2]);
        let shortest = -greater(greater(-s[0], -s[1]), -s[2]);
        let sum = s[0] + s[1] + s[2];
        let middle = sum - longest - shortest;
        let inertia = |along: S, across: S| number(8.0 / 15.0 * PI) * along * square(square(across));
        let most = inertia(middle, longest);
        let turning = Vector3::from_fn(|k, _| {
            let own = inertia(s[k], greater(s[(k + 1) % 3], s[(k + 2) % 3]));
            p[7] * own + p[6] * (most - own)
        });
        let diameter = number(2.0 / 3.0) * sum;
        let squares = Vector3::from_fn(|k, _| square((s[(k + 1) % 3] / longest) * (s[(k + 2) % 3] / longest)));
        let speed = length(v);
        let moves = (speed - number(LEAST)).positive();
        let inverse = S::select(moves, S::one() / S::select(moves, speed, S::one()), S::zero());
        let direction = v * inverse;
        let normal = direction.component_mul(&squares);
        Self {
            p,
            squares,
            unit_area: number(PI) * square(longest),
            largest_area: number(PI) * longest * middle,
            turning,
            viscous: [number(3.0 * PI) * diameter * p[4], number(PI) * (diameter * square(diameter)) * p[4]],
            added: [10, 13].map(|first| Vector3::from_fn(|k, _| p[3] * p[first + k])),
            magnus: p[9] * p[3] * (number(4.0 / 3.0 * PI) * s[0] * s[1] * s[2]),
            speed,
            direction,
            projections: [S::select(moves, normal.dot(&direction), S::one()), normal.dot(&normal)],
        }
    }

    /// c_b A + c_s (A_max − A).
    fn area(&self) -> S {
        let [n, d] = self.projections;
        let projected = self.unit_area * root(d / n);
        self.p[5] * projected + self.p[6] * (self.largest_area - projected)
    }

    /// 1 over a positive number; 0 without a direction.
    fn inverse(&self, x: S) -> S {
        let moves = (self.speed - S::from_f64(LEAST)).positive();
        S::select(moves, S::one() / S::select(moves, x, S::one()), S::zero())
    }
}

/// The twist relative to the fluid.
#[inline(always)]
fn relative<S: Scalar>(p: &[S], at: &Station<S>) -> Twist<S> {
    let wind = rotate_back(&at.placement.rotation, Vector3::new(p[16], p[17], p[18]));
    Twist { angular: at.twist.angular, linear: at.twist.linear - wind }
}

impl FrameForce for Law {
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let Twist { angular: omega, linear: v } = relative(p, at);
        let own = Body::at(p, &v);
        let (density, [n, d], u) = (p[3], own.projections, own.direction);
        let drag = own.viscous[0] + density * own.speed * own.area();
        let lift = p[8] * density * own.unit_area * root(n * own.inverse(d)) * (own.speed * own.speed);
        let turning = own.viscous[1] + density * length(&omega.component_mul(&own.turning));
        let (linear, angular) = (own.added[0].component_mul(&v), own.added[1].component_mul(&omega));
        let kutta = u.component_mul(&own.squares).cross(&u).cross(&u);
        Wrench {
            moment: linear.cross(&v) + angular.cross(&omega) - omega * turning,
            force: linear.cross(&omega) + omega.cross(&v) * own.magnus + kutta * lift - v * drag,
        }
    }

    const HAS_DAMPING: bool = true;

    fn damping<S: Scalar>(p: &[S], at: &Station<S>) -> Slopes<S> {
        let Twist { angular: omega, linear: v } = relative(p, at);
        let own = Body::at(p, &v);
        let added = own.added.map(|diagonal| Matrix3::from_diagonal(&diagonal));
        let (momentum, spin) = (own.added[0].component_mul(&v), own.added[1].component_mul(&omega));
        // ∂(A x × x)/∂x = [A x]× − [x]× A
        let turns = cross(&spin) - cross(&omega) * added[1] + turning_slope(&own, &omega);
        let shifts = cross(&momentum) - cross(&v) * added[0];
        let force_by_turns = cross(&momentum) - cross(&v) * own.magnus;
        let force = cross(&omega) * own.magnus - cross(&omega) * added[0] + drag_slope(&own) + lift_slope(&own);
        let blocks = [[turns, shifts], [force_by_turns, force]];
        Slopes::All(core::array::from_fn(|i| core::array::from_fn(|j| -blocks[i / 3][j / 3][(i % 3, j % 3)])))
    }
}

/// [x]×
fn cross<S: Scalar>(x: &Vector3<S>) -> Matrix3<S> {
    let zero = S::zero();
    Matrix3::new(zero, -x[2], x[1], x[2], zero, -x[0], -x[1], x[0], zero)
}

/// ∂m/∂ω of the drag of turns: −(π D³ β + ρ |C ω|) − ρ ω (C² ω)ᵀ/|C ω|
fn turning_slope<S: Scalar>(own: &Body<'_, S>, omega: &Vector3<S>) -> Matrix3<S> {
    let moment = omega.component_mul(&own.turning);
    let size = length(&moment);
    let inverse = S::one() / S::select(size.positive(), size, S::one());
    let slope = moment.component_mul(&own.turning) * (own.p[3] * inverse);
    -(Matrix3::from_diagonal_element(own.viscous[1] + own.p[3] * size) + omega * slope.transpose())
}

/// ∂f/∂v of the drag.
fn drag_slope<S: Scalar>(own: &Body<'_, S>) -> Matrix3<S> {
    let ([n, d], u) = (own.projections, own.direction);
    let momentum = own.p[3] * own.speed;
    let quadratic = momentum * own.area();
    // |v| ∂A/∂v_i = π s² N_i u_i (N_i n − d)/√(n³ d), with N_i n − d = Σ N_j u_j² (N_i − N_j)
    let scale = momentum * (own.p[5] - own.p[6]) * own.unit_area * own.inverse(n * root(n * d));
    let by_area = Vector3::from_fn(|i, _| scale * own.squares[i] * u[i] * apart(own, i, |j| own.squares[j] * (u[j] * u[j])));
    -(Matrix3::from_diagonal_element(own.viscous[0] + quadratic) + u * u.transpose() * quadratic + u * by_area.transpose())
}

/// Σ x_j (N_i − N_j) over the other axes.
fn apart<S: Scalar>(own: &Body<'_, S>, i: usize, x: impl Fn(usize) -> S) -> S {
    let [j, k] = [(i + 1) % 3, (i + 2) % 3];
    x(j) * (own.squares[i] - own.squares[j]) + x(k) * (own.squares[i] - own.squares[k])
}

/// ∂f/∂v of the Kutta lift: f_i = −c_k ρ π s² |v|² √(n/d) u_i g_i with g_i = Σ u_j² (N_i − N_j).
fn lift_slope<S: Scalar>(own: &Body<'_, S>) -> Matrix3<S> {
    let ([n, d], u) = (own.projections, own.direction);
    let scale = own.p[8] * own.p[3] * own.unit_area * own.speed * own.inverse(root(d * n));
    let (by_normal, two_n) = (n * own.inverse(d), S::from_f64(2.0) * n);
    let g = Vector3::from_fn(|i, _| apart(own, i, |j| u[j] * u[j]));
    Matrix3::from_fn(|i, j| {
        let (one, other) = (own.squares[i], own.squares[j]);
        let slope = two_n * (other - one) + g[i] * (other * other * by_normal - other + n);
        let diagonal = if i == j { g[i] * n } else { S::zero() };
        scale * (slope * (u[i] * u[j]) - diagonal)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::spatial::Placement;

    /// Semi-axes, density, viscosity, coefficients, virtual masses and inertias; no wind.
    const FISH: [f64; 19] =
        [0.2, 0.07, 0.11, 40.0, 0.3, 0.5, 0.25, 1.5, 0.9, 0.8, 1.1e-3, 7.3e-3, 3.1e-3, 3.8e-6, 9.3e-6, 3.4e-5, 0.0, 0.0, 0.0];

    fn at(twist: [f64; 6]) -> Station<f64> {
        let [a, b, c, x, y, z] = twist;
        let twist = Twist { angular: Vector3::new(a, b, c), linear: Vector3::new(x, y, z) };
        Station { placement: Placement::identity(), twist, gravity: Vector3::zeros() }
    }

    fn six(w: &Wrench<f64>) -> [f64; 6] {
        [w.moment.x, w.moment.y, w.moment.z, w.force.x, w.force.y, w.force.z]
    }

    const MOTIONS: [[f64; 6]; 4] = [
        [0.3, -0.7, 0.5, 0.4, 0.9, -0.6],
        [2.0, 0.0, 0.0, 0.0, -3.0, 0.0],
        [0.0, 0.0, 0.0, 0.01, 0.02, 0.3],
        [-4.0, 3.0, 1.0, 1e-6, -2e-6, 0.0],
    ];

    #[test]
    fn a_fluid_at_rest_takes_energy() {
        for motion in MOTIONS {
            let at = at(motion);
            let power = |p: &[f64]| Law::wrench(p, &at).power(&at.twist);
            assert!(power(&FISH) < 0.0, "{motion:?}");
            // Lift and added momentum do no work.
            let mut lift = FISH;
            (lift[4], lift[5], lift[6], lift[7]) = (0.0, 0.0, 0.0, 0.0);
            let size = six(&Law::wrench(&lift, &at)).iter().zip(motion).map(|(w, v)| (w * v).abs()).sum::<f64>();
            assert!(power(&lift).abs() <= 1e-14 * size, "{motion:?}");
        }
    }

    #[test]
    fn slopes_are_those_of_the_wrench() {
        for motion in MOTIONS {
            let Slopes::All(slopes) = Law::damping(&FISH, &at(motion)) else { panic!("all slopes") };
            let largest = slopes.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
            for k in 0..6 {
                let moved = |h: f64| {
                    let mut moved = motion;
                    moved[k] += h;
                    six(&Law::wrench(&FISH, &at(moved)))
                };
                let h = 1e-8;
                let (after, before) = (moved(h), moved(-h));
                for i in 0..6 {
                    let found = (before[i] - after[i]) / (2.0 * h);
                    assert!((found - slopes[i][k]).abs() < 1e-5 * largest, "{motion:?} {i} {k}: {found} {}", slopes[i][k]);
                }
            }
        }
    }

    #[test]
    fn a_body_at_rest_has_finite_slopes() {
        let still = at([0.0; 6]);
        assert_eq!(six(&Law::wrench(&FISH, &still)), [0.0; 6]);
        let viscous = [PI * (2.0 / 3.0 * 0.38_f64).powi(3) * 0.3, 3.0 * PI * 2.0 / 3.0 * 0.38 * 0.3];
        let Slopes::All(slopes) = Law::damping(&FISH, &still) else { panic!("all slopes") };
        let (parameters, slope) = (FISH.map(Dual::constant), |i: usize, k: usize| slopes[i][k]);
        for k in 0..6 {
            let one = |own: usize| Vector3::from_fn(|i, _| if own + i == k { 1.0 } else { 0.0 });
            let change = Twist { angular: one(0), linear: one(3) };
            let w = Law::wrench(&parameters, &still.moved(&Twist::zero(), &change));
            let found = [w.moment, w.force].map(|part| part.map(|x| x.slope));
            for i in 0..6 {
                let expected = if i == k { viscous[i / 3] } else { 0.0 };
                assert!((slope(i, k) - expected).abs() < 1e-15 && (found[i / 3][i % 3] + expected).abs() < 1e-15, "{i} {k}");
            }
        }
    }

    /// A disk, a ball and a needle: the area across the motion times ρ c_b v².
    #[test]
    fn blunt_drag_is_of_the_projected_area() {
        for (semi_axes, area) in [([0.3, 0.2, 0.01], 0.3 * 0.2), ([0.1; 3], 0.01), ([0.01, 0.02, 5.0], 0.01 * 0.02)] {
            let p = [&semi_axes[..], &[40.0, 0.0, 0.7], &[0.0; 13]].concat();
            let force = Law::wrench(&p, &at([0.0, 0.0, 0.0, 0.0, 0.0, 2.0])).force.z;
            let expected = -40.0 * 0.7 * PI * area * 4.0;
            assert!((force - expected).abs() < 1e-14 * expected.abs(), "{force} {expected}");
        }
    }

    #[test]
    fn a_body_that_drifts_with_the_wind_feels_nothing() {
        let mut p = FISH;
        p[16..].copy_from_slice(&[0.4, 0.9, -0.6]);
        assert_eq!(six(&Law::wrench(&p, &at([0.0, 0.0, 0.0, 0.4, 0.9, -0.6]))), [0.0; 6]);
        let (still, moving) = (Law::wrench(&p, &at([0.0; 6])), Law::wrench(&FISH, &at([0.0, 0.0, 0.0, -0.4, -0.9, 0.6])));
        assert_eq!(six(&still), six(&moving));
    }
}
