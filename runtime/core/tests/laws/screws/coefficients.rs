//! The functions of the angle.

use std::f64::consts::PI;

use articulated_core::Scalar;
use articulated_core::dual::Dual;
use articulated_core::spatial::screw::HalfAngle;
use articulated_reference::Big;
use articulated_test_support::measure::U;
use articulated_test_support::random::Random;

use super::angles;

/// sin θ and so on by the formulas that define them, from x = θ² > 0.
fn closed(x: f64) -> [Big; 8] {
    let [one, two, three] = [1.0, 2.0, 3.0].map(Big::from_f64);
    let t = Big::from_f64(x).sqrt();
    let ((s, c), (sin, cos)) = (t.sin_cos(), (t / two).sin_cos());
    let (t2, t3, t4) = (t * t, t * t * t, t * t * t * t);
    let (versine, excess) = ((one - c) / t2, (t - s) / t3);
    // d/dx = d/dθ / 2θ
    let versine_rate = (s / t2 - two * versine / t) / (t + t);
    let excess_rate = ((one - c) / t3 - three * (t - s) / t4) / (t + t);
    let inverse = one / t2 - cos / (sin * (t + t));
    let inverse_rate = (cos / (sin * two * t2) - two / t3 + one / (two * two * t * sin * sin)) / (t + t);
    [cos, sin * two / t, versine, versine_rate, excess, excess_rate, inverse, inverse_rate]
}

fn coefficients<S: Scalar>(x: S) -> [S; 8] {
    let h = HalfAngle::new(x);
    [h.cosine(), h.sinc(), h.versine(), h.versine_rate(), h.excess(), h.excess_rate(), h.inverse(), h.inverse_rate()]
}

/// In units of u of the coefficient; of the largest cosine for that. Seen: 2, 2, 3.3, 3.9, 4.1,
/// 4.2, 3.6, 4.
const COEFFICIENT: [f64; 8] = [2.5, 2.5, 4.5, 5.0, 5.0, 5.0, 4.5, 5.0];

#[test]
fn coefficients_are_good_to_a_few_ulps_up_to_half_a_turn() {
    let random = &mut Random::new(1);
    for angle in angles(random, 300, PI).into_iter().filter(|a| *a > 1e-20) {
        Big::scope(|| {
            let x = angle * angle;
            let (found, expected) = (coefficients(x), closed(x));
            for k in 0..8 {
                let size = if k == 0 { 1.0 } else { expected[k].to_f64().abs() };
                let error = expected[k].error_of(found[k], U * size);
                assert!(error <= COEFFICIENT[k], "coefficient {k} at {angle:e}: {error} u");
            }
        });
    }
}

#[test]
fn coefficients_at_zero_are_their_limits() {
    let limits = [1.0, 1.0, 1.0 / 2.0, -1.0 / 24.0, 1.0 / 6.0, -1.0 / 120.0, 1.0 / 12.0, 1.0 / 720.0];
    for x in [0.0, 5e-324, 1e-300, 1e-40] {
        for ((double, single), limit) in coefficients(x).into_iter().zip(coefficients(x as f32)).zip(limits) {
            assert!((double - limit).abs() <= f64::EPSILON * limit.abs(), "{double} {limit}");
            assert!((f64::from(single) - limit).abs() <= 2.0 * f64::from(f32::EPSILON) * limit.abs(), "{single} {limit}");
        }
    }
}

/// Beyond half a turn the only loss is that of x and its root: θ·df/dθ = 2x·df/dx a unit.
#[test]
fn coefficients_beyond_half_a_turn_are_as_good_as_their_angle() {
    let random = &mut Random::new(2);
    for angle in (0..400).map(|_| random.within(3.0, 60.0)) {
        Big::scope(|| {
            let x = angle * angle;
            let (found, expected) = (coefficients(x), closed(x));
            let slopes = coefficients(Dual::variable(x)).map(|d| d.slope);
            for k in 0..8 {
                let size = expected[k].to_f64().abs() + 2.0 * x * slopes[k].abs() + if k == 0 { 1.0 } else { 0.0 };
                let error = expected[k].error_of(found[k], U * size);
                assert!(error <= 5.0, "coefficient {k} at {angle}: {error} u");
            }
        });
    }
}

#[test]
fn coefficients_of_many_digits_are_good_to_many_digits() {
    let random = &mut Random::new(3);
    for angle in angles(random, 40, 7.0).into_iter().filter(|a| *a > 1e-4) {
        Big::scope(|| {
            let x = angle * angle;
            for (k, (found, expected)) in coefficients(Big::from_f64(x)).iter().zip(closed(x)).enumerate() {
                let error = ((*found - expected) / expected).to_f64().abs();
                assert!(error < 1e-75, "coefficient {k} at {angle}: {error:e}");
            }
        });
    }
}

/// The slopes that dual numbers find, at 0 and at every change of formula, first and second.
#[test]
fn derivatives_of_coefficients_are_as_smooth_as_they_are() {
    let random = &mut Random::new(4);
    for angle in angles(random, 60, PI) {
        let x = angle * angle;
        let found = coefficients(Dual::variable(Dual::variable(x)));
        Big::scope(|| {
            let expected = coefficients(Dual::variable(Dual::variable(Big::from_f64(x))));
            for (k, (f, e)) in found.iter().zip(&expected).enumerate() {
                let first = e.slope.value.error_of(f.slope.value, e.slope.value.to_f64().abs());
                let second = e.slope.slope.error_of(f.slope.slope, e.slope.slope.to_f64().abs());
                assert!(first <= 40.0 * U && second <= 800.0 * U, "coefficient {k} at {angle:e}: {} {} u", first / U, second / U);
            }
        });
    }
}
