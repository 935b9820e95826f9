//! Logarithms and quaternions, up to half a turn and at it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use articulated_core::Scalar;
use articulated_core::dual::Dual;
use articulated_core::spatial::screw::{Quaternion, exp_rotation, log_rotation};
use articulated_core::spatial::{Matrix3, Placement, Twist, Vector3};
use articulated_reference::Big;
use articulated_test_support::measure::U;
use articulated_test_support::random::Random;

use super::{along, angles, far, moved, six, turned, twist, vector};

#[test]
fn inverse_jacobians_are_the_derivatives_of_the_logarithm() {
    let random = &mut Random::new(10);
    for angle in angles(random, 40, PI - 1e-3).into_iter().chain([PI - 1e-6]) {
        let xi = moved(random, angle);
        let x = Placement { rotation: xi.exp().rotation.map(Dual::constant), position: xi.exp().position.map(Dual::constant) };
        for k in 0..6 {
            let step = along(&Twist::zero(), k).exp();
            for (log, expected) in
                [(step.compose(&x).log(), xi.left_jacobian_inverse()), (x.compose(&step).log(), xi.right_jacobian_inverse())]
            {
                let slope = six(&log).map(|d| d.slope);
                assert!((slope - expected.column(k)).amax() <= 24.0 * U * (1.0 + xi.linear.norm()), "{xi:?} {slope}");
            }
        }
    }
}

#[test]
fn logarithm_of_a_quaternion_is_good_to_a_few_ulps_from_nothing_to_half_a_turn() {
    let random = &mut Random::new(11);
    for angle in angles(random, 200, TAU) {
        Big::scope(|| {
            let axis = random.unit::<3>();
            // Of any length and of either sign, which must not matter.
            let length = *random.choose(&[1.0, -1.0, 1.0 + 1e-9, 3.0]);
            let (s, c) = (angle / 2.0).sin_cos();
            let q = Quaternion { vector: Vector3::from(axis) * (s * length), scalar: c * length };
            let expected = Quaternion { vector: vector::<Big>(q.vector), scalar: Big::from_f64(q.scalar) }.log();
            let found = q.log();
            let size = expected.map(|x| x.to_f64()).norm();
            assert!(far(&found, &expected) <= 3.0 * size, "{angle:e}: {} u", far(&found, &expected) / size);
            assert!(found.norm() <= PI * (1.0 + 2.0 * U));
        });
    }
}

/// By dual numbers of dual numbers: cancellation in a closed form is worse in each derivative of
/// it.
#[test]
fn second_derivatives_of_the_logarithm_hold_at_small_angles_too() {
    let random = &mut Random::new(21);
    for sine in [0.0, 1e-160, 1e-12, 1e-6, 1e-4, 1e-2, 0.1, 0.12, 0.13, 0.5, 1.0] {
        let (v, along) = (turned(random, sine), turned(random, 1.0));
        let found = curved(v, along);
        Big::scope(|| {
            let expected = curved(vector::<Big>(v), vector(along));
            for k in 0..3 {
                let (f, e) = (found[k], expected[k]);
                let (slope, bend) = (e.slope.value.error_of(f.slope.value, U), e.slope.slope.error_of(f.slope.slope, U));
                assert!(slope <= 12.0 && bend <= 100.0, "{sine:e}: {slope} {bend} u");
            }
        });
    }
}

/// log of (v + t·along, √(1 − v²)) with its first two derivatives at t = 0; w does not move, since
/// only directions count.
fn curved<S: Scalar>(v: Vector3<S>, along: Vector3<S>) -> Vector3<Dual<Dual<S>>> {
    let time = Dual::variable(Dual::variable(S::zero()));
    let still = |x: S| Dual::constant(Dual::constant(x));
    let cosine = S::select((S::one() - v.dot(&v)).positive(), S::one() - v.dot(&v), S::one()).sqrt();
    Quaternion { vector: v.map(still) + along.map(still) * time, scalar: still(cosine) }.log()
}

/// The reference of the tests before, itself: exp takes log q back to q.
#[test]
fn logarithm_undoes_the_exponential_in_many_digits() {
    let random = &mut Random::new(12);
    for angle in angles(random, 20, PI).into_iter().filter(|a| *a > 1e-30) {
        Big::scope(|| {
            let xi = twist::<Big>(&moved(random, angle));
            let half = (xi.angular.dot(&xi.angular) / Big::from_f64(4.0)).sqrt();
            // The angle itself may be rounded to beyond π.
            if half.to_f64() > FRAC_PI_2 - 1e-15 {
                return;
            }
            let difference = six(&xi.exp().log()) - six(&xi);
            assert!(difference.iter().all(|x| x.to_f64().abs() < 1e-80), "{angle:e}");
        });
    }
}

#[test]
fn logarithm_undoes_the_exponential_up_to_half_a_turn() {
    let random = &mut Random::new(13);
    let near_half_a_turn = [1e-3, 1e-7, 1e-12].map(|d| PI - d);
    for angle in angles(random, 300, PI - 1e-2).into_iter().chain(near_half_a_turn) {
        let xi = moved(random, angle);
        let back = xi.exp().log();
        assert!((back.angular - xi.angular).amax() <= 6.0 * U * angle.max(1e-300), "{angle:e}: {}", (back.angular - xi.angular).amax() / U);
        assert!((back.linear - xi.linear).amax() <= 12.0 * U, "{angle:e}: {}", (back.linear - xi.linear).amax() / U);
    }
}

#[test]
fn exponential_undoes_the_logarithm_at_half_a_turn_too() {
    let random = &mut Random::new(14);
    for angle in angles(random, 200, TAU).into_iter().chain([PI.next_up(), PI.next_down(), PI + 1e-9]) {
        let axis = if random.chance(0.3) { [Vector3::x(), Vector3::y(), Vector3::z()][random.below(3)] } else { turned(random, 1.0) };
        let x = Placement { rotation: exp_rotation(axis * angle), position: Vector3::from(random.three(1.0)) };
        let log = x.log();
        let back = log.exp();
        assert!((back.rotation - x.rotation).amax() <= 16.0 * U, "{angle}: {}", (back.rotation - x.rotation).amax() / U);
        assert!((back.position - x.position).amax() <= 8.0 * U, "{angle}: {}", (back.position - x.position).amax() / U);
        assert!(log.angular.norm() <= PI * (1.0 + 4.0 * U));
    }
}

#[test]
fn the_axis_of_half_a_turn_is_definite() {
    for (k, signs) in [[1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].into_iter().enumerate() {
        let half_turn = Matrix3::from_diagonal(&Vector3::from(signs));
        let mut expected = Vector3::zeros();
        expected[k] = PI;
        assert_eq!(log_rotation(&half_turn), expected);
    }
    for v in [[0.6, 0.0, 0.8], [0.0, 0.6, -0.8], [0.0, 0.0, 1.0]].map(Vector3::from) {
        let plus = Quaternion { vector: v, scalar: 0.0 }.log();
        assert_eq!(plus, Quaternion { vector: -v, scalar: -0.0 }.log());
        assert!((plus - v * PI).amax() <= 4.0 * U);
    }
}

#[test]
fn a_quaternion_is_read_off_any_rotation() {
    let random = &mut Random::new(15);
    let exact = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.5; 4], [-0.5, 0.5, -0.5, 0.5]];
    for q in exact {
        let q = Quaternion::from_array(q);
        assert_eq!(Quaternion::from_rotation(&q.to_rotation()).to_array(), q.to_array());
    }
    for _ in 0..300 {
        Big::scope(|| {
            // Each of the four is the largest at times; and some are tiny.
            let mut four: [f64; 4] = random.unit();
            four[random.below(4)] *= *random.choose(&[1.0, 1e-3, 1e-9]);
            let precise = Quaternion::from_array(four.map(Big::from_f64)).normalised();
            let r = precise.to_rotation().map(|x| x.to_f64());
            let found = Quaternion::from_rotation(&r).to_array();
            let alike = found.iter().zip(four).map(|(a, b)| a * b).sum::<f64>().signum();
            for (f, e) in found.iter().zip(precise.to_array()) {
                assert!(e.error_of(alike * f, U) <= 3.0, "{four:?}: {} u", e.error_of(alike * f, U));
            }
        });
    }
}

#[test]
fn quaternions_multiply_as_rotations_do() {
    let random = &mut Random::new(16);
    for _ in 0..100 {
        let [a, b] = [(); 2].map(|()| Quaternion::from_array(random.unit::<4>()));
        let difference = a.product(&b).to_rotation() - a.to_rotation() * b.to_rotation();
        assert!(difference.amax() <= 16.0 * U, "{}", difference.amax() / U);
        let one = a.product(&a.conjugate());
        assert!(one.vector.amax() <= 2.0 * U && (one.scalar - 1.0).abs() <= 4.0 * U);
    }
}
