//! Exponentials, logarithms and their derivatives, against power series of matrices in 96 digits.

mod coefficients;
mod exponentials;
mod frames;
mod logarithms;

use std::f64::consts::{FRAC_PI_2, PI};

use articulated_core::Scalar;
use articulated_core::dual::Dual;
use articulated_core::nalgebra::{SMatrix, Vector6};
use articulated_core::spatial::{Twist, Vector3};
use articulated_reference::Big;
use articulated_test_support::measure::U;
use articulated_test_support::random::Random;

/// Angles over which every law here is tried: tiny, small, on both sides of each change from series
/// to closed form, half a turn, and up to `most`.
fn angles(random: &mut Random, count: usize, most: f64) -> Vec<f64> {
    let changes = [0.25, 1.0, 2.0, 6.0].map(|y: f64| 2.0 * y.sqrt()).into_iter().chain([4.0, 7.0].map(f64::sqrt));
    let special = changes.chain([PI, FRAC_PI_2, 0.5]).flat_map(|x| [x * (1.0 - 1e-12), x, x * (1.0 + 1e-12)]);
    let tiny = [0.0, 1e-300, 1e-160, 1e-30, 1e-15, 1e-9, 1e-8, 1e-5, 1e-3];
    let mut all: Vec<f64> = special.chain(tiny).filter(|x| *x < most).collect();
    all.extend((0..count).map(|_| most * random.within(0.0, 1.0).powi(if random.chance(0.5) { 1 } else { 4 })));
    all
}

fn vector<S: Scalar>(x: Vector3<f64>) -> Vector3<S> {
    x.map(S::from_f64)
}

fn twist<S: Scalar>(x: &Twist<f64>) -> Twist<S> {
    Twist { angular: vector(x.angular), linear: vector(x.linear) }
}

fn turned(random: &mut Random, angle: f64) -> Vector3<f64> {
    Vector3::from(random.unit::<3>()) * angle
}

fn moved(random: &mut Random, angle: f64) -> Twist<f64> {
    Twist { angular: turned(random, angle), linear: Vector3::from(random.three(1.0)) }
}

/// Largest difference of entries, in units of u.
fn far<const R: usize, const C: usize>(found: &SMatrix<f64, R, C>, expected: &SMatrix<Big, R, C>) -> f64 {
    let errors = found.iter().zip(expected.iter()).map(|(f, e)| (Big::from_f64(*f) - *e).to_f64().abs() / U);
    errors.fold(0.0, |worst, e| if e <= worst { worst } else { worst_of(e) })
}

fn worst_of(e: f64) -> f64 {
    if e.is_nan() { f64::INFINITY } else { e }
}

/// Σ m^k/(k + skip)!, which is exp m for `skip` 0 and its Jacobian for 1.
fn series<const N: usize>(m: &SMatrix<Big, N, N>, skip: u32) -> SMatrix<Big, N, N> {
    let mut term = SMatrix::<Big, N, N>::identity();
    let mut sum = term;
    for k in 1..120 {
        term = (term * m).map(|x| x / Big::from_f64(f64::from(k + skip)));
        sum += term;
        if term.iter().all(|x| x.to_f64().abs() < 1e-92) {
            break;
        }
    }
    sum
}

/// ξ + ε e_k with the slope of e_k.
fn along(xi: &Twist<f64>, k: usize) -> Twist<Dual<f64>> {
    let at = |x: f64, i: usize| Dual::new(x, if i == k { 1.0 } else { 0.0 });
    let (w, v) = (xi.angular, xi.linear);
    Twist { angular: Vector3::new(at(w.x, 0), at(w.y, 1), at(w.z, 2)), linear: Vector3::new(at(v.x, 3), at(v.y, 4), at(v.z, 5)) }
}

fn six<S: Scalar>(x: &Twist<S>) -> Vector6<S> {
    let (w, v) = (x.angular, x.linear);
    Vector6::new(w.x, w.y, w.z, v.x, v.y, v.z)
}
