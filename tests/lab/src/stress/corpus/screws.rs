//! Screws from no turn to half a turn: exponentials, logarithms, and their coefficients.

use std::f64::consts::PI;

use articulated_core::Scalar;
use articulated_core::spatial::screw::{HalfAngle, Quaternion, exp_rotation, log_rotation};
use articulated_core::spatial::{Twist, Vector3};
use articulated_reference::Big;

use super::Effort;
use crate::residual::worse;
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "screws";

const U: f64 = f64::EPSILON / 2.0;

pub(super) fn rows(_: Effort) -> Vec<Row> {
    let mut rows = coefficients();
    rows.extend(small_turns());
    rows.extend(near_half_a_turn());
    rows.extend(half_a_turn());
    rows
}

type Coefficient<S> = fn(&HalfAngle<S>) -> S;

/// Name, coefficient, the same in many digits.
const COEFFICIENTS: [(&str, Coefficient<f64>, Coefficient<Big>); 8] = [
    ("cos(θ/2)", HalfAngle::cosine, HalfAngle::cosine),
    ("sin(θ/2)/(θ/2)", HalfAngle::sinc, HalfAngle::sinc),
    ("(1 − cos θ)/θ²", HalfAngle::versine, HalfAngle::versine),
    ("d/dθ² of it", HalfAngle::versine_rate, HalfAngle::versine_rate),
    ("(θ − sin θ)/θ³", HalfAngle::excess, HalfAngle::excess),
    ("d/dθ² of that", HalfAngle::excess_rate, HalfAngle::excess_rate),
    ("1/θ² − cot(θ/2)/(2θ)", HalfAngle::inverse, HalfAngle::inverse),
    ("d/dθ² of this", HalfAngle::inverse_rate, HalfAngle::inverse_rate),
];

/// Angles from 1e-12 to π, close to each other.
fn angles() -> impl Iterator<Item = f64> {
    let geometric = (0..=240).map(|k| 10.0_f64.powf(f64::from(k) / 20.0 - 12.0) * 3.1);
    geometric.chain((1..=60).map(|k| PI * f64::from(k) / 60.0)).filter(|x| *x <= PI)
}

fn coefficients() -> Vec<Row> {
    let one = |(name, found, expected): (&str, Coefficient<f64>, Coefficient<Big>)| {
        let case =
            Case::new(NAME, format!("{name} for angles from 1e-12 to π"), "the closed form is 0/0 at 0 and loses digits long before");
        let error = |angle: f64| {
            Big::scope(|| {
                let x = angle * angle;
                let exact = expected(&HalfAngle::new(Big::from_f64(x)));
                let size = if name.starts_with("cos") { 1.0 } else { exact.to_f64() };
                exact.error_of(found(&HalfAngle::new(x)), ulp(size))
            })
        };
        // cos(θ/2) goes through zero at π: its error is in ulps of 1, like that of the quaternion
        // that contains it.
        case.row("error, f64", angles().map(error).fold(0.0, worse), 4.0, "ulp")
    };
    COEFFICIENTS.into_iter().map(one).collect()
}

/// The spacing of doubles at x.
fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

fn axis() -> Vector3<f64> {
    Vector3::new(0.48, -0.6, 0.64)
}

/// ‖ω‖ = 10⁻ᵏ: approaches the translation without a jump.
fn small_turns() -> Vec<Row> {
    let case =
        Case::new(NAME, "screws with a turn of 10⁻ᵏ rad, k = 0 … 18", "a screw whose turn dies away must go over to the translation");
    let linear = Vector3::new(0.3, 1.1, -0.7);
    let errors = (0..=18).map(|k| {
        Big::scope(|| {
            let xi = Twist { angular: axis() * 10.0_f64.powi(-k), linear };
            let precise = Twist { angular: xi.angular.map(Big::from_f64), linear: linear.map(Big::from_f64) };
            let (found, expected) = (xi.exp(), precise.exp());
            let rotation = expected.rotation.iter().zip(found.rotation.iter()).map(|(e, f)| e.error_of(*f, U)).fold(0.0, worse);
            let position = expected.position.iter().zip(found.position.iter()).map(|(e, f)| e.error_of(*f, U * linear.norm()));
            let back = found.log();
            let turn = precise.angular.iter().zip(back.angular.iter()).map(|(e, f)| e.error_of(*f, U * xi.angular.norm())).fold(0.0, worse);
            let slide = precise.linear.iter().zip(back.linear.iter()).map(|(e, f)| e.error_of(*f, U * linear.norm())).fold(0.0, worse);
            [rotation, position.fold(0.0, worse), turn, slide]
        })
    });
    let errors: Vec<[f64; 4]> = errors.collect();
    let most = |k: usize| errors.iter().map(|e| e[k]).fold(0.0, worse);
    vec![
        case.row("exp, rotation, f64", most(0), 8.0, "u"),
        case.row("exp, position, f64", most(1), 4.0, "u"),
        case.row("log of exp, turn, of its size, f64", most(2), 8.0, "u"),
        case.row("log of exp, translation, f64", most(3), 12.0, "u"),
    ]
}

/// π − 10⁻ᵏ.
fn near_half_a_turn() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "logarithm of turns by π − 10⁻ᵏ, k = 1 … 16",
        "the axis of half a turn cannot be read off R − Rᵀ, which is nothing there",
    );
    let error = |k: i32| {
        Big::scope(|| {
            let w = axis() * (PI - 10.0_f64.powi(-k));
            let q = Quaternion::exp(w);
            let precise = Quaternion { vector: q.vector.map(Big::from_f64), scalar: Big::from_f64(q.scalar) };
            let of_quaternion = precise.log().iter().zip(q.log().iter()).map(|(e, f)| e.error_of(*f, U * PI)).fold(0.0, worse);
            // The rotation is rounded; the logarithm is that of the nearby one.
            let log = log_rotation(&exp_rotation(w));
            let of_matrix = log.iter().zip(w.iter()).map(|(f, e)| (f - e).abs() / (U * PI)).fold(0.0, worse);
            [of_quaternion, of_matrix]
        })
    };
    let errors: Vec<[f64; 2]> = (1..=16).map(error).collect();
    let most = |k: usize| errors.iter().map(|e| e[k]).fold(0.0, worse);
    vec![case.row("of a quaternion, f64", most(0), 8.0, "u"), case.row("of a matrix, there and back, f64", most(1), 8.0, "u")]
}

fn half_a_turn() -> Vec<Row> {
    let case = Case::new(NAME, "a turn by exactly π about any axis", "both ω and −ω are its logarithm, and neither may be lost");
    let axes = [Vector3::x(), Vector3::y(), Vector3::z(), axis(), Vector3::new(0.6, 0.8, 0.0), Vector3::new(-0.8, 0.0, 0.6)];
    let error = |n: &Vector3<f64>| {
        let r = n * n.transpose() * 2.0 - articulated_core::spatial::Matrix3::identity();
        let w = log_rotation(&r);
        let off = (w - n * PI).amax().min((w + n * PI).amax()) / (U * PI);
        let back = (exp_rotation(w) - r).amax() / U;
        worse(off, back / 2.0)
    };
    vec![case.row("log, and exp of it, f64", axes.iter().map(error).fold(0.0, worse), 8.0, "u")]
}
