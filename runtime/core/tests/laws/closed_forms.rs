//! Robots whose equations can be written on one line; the parameters are in the headers of their
//! URDF files.

use articulated_test_support::case::{Case, State};
use articulated_test_support::random::Random;

const G: f64 = 9.81;

fn holds(name: &str, closed_form: impl Fn(&State) -> Vec<f64>) {
    let case = Case::bundled(articulated_models::robot(name).unwrap());
    let mut random = Random::new(3);
    for _ in 0..100 {
        let state = case.state(&mut random);
        let (found, expected) = (case.inverse_dynamics(&state), closed_form(&state));
        for (f, e) in found.iter().zip(&expected) {
            assert!((f - e).abs() < 2e-14, "{name} {state:?}: {found:?} {expected:?}");
        }
        assert_eq!(found.len(), expected.len());
    }
}

#[test]
fn simple_pendulum() {
    // τ = (m l² + I) a + m g l sin q
    let (m, l, i) = (1.0, 1.0, 0.001);
    holds("simple_pendulum", |s| vec![(m * l * l + i) * s.a[0] + m * G * l * s.q[0].sin()]);
}

#[test]
fn double_pendulum() {
    let (m1, l1, i1) = (1.0, 1.0, 0.083_433_333_333_3);
    let (m2, l2, i2) = (0.5, 0.7, 0.020_466_666_666_7);
    let b = m2 * l1 * l2 / 2.0;
    let a1 = i1 + m1 * l1 * l1 / 4.0 + m2 * l1 * l1;
    let a2 = i2 + m2 * l2 * l2 / 4.0;
    holds("double_pendulum", |s| {
        let (sin, cos) = s.q[1].sin_cos();
        let (lower, upper) = (m2 * l2 / 2.0 * G * (s.q[0] + s.q[1]).sin(), (m1 / 2.0 + m2) * l1 * G * s.q[0].sin());
        let first = (a1 + a2 + 2.0 * b * cos) * s.a[0] + (a2 + b * cos) * s.a[1];
        let second = (a2 + b * cos) * s.a[0] + a2 * s.a[1];
        vec![first - b * sin * (2.0 * s.v[0] * s.v[1] + s.v[1] * s.v[1]) + upper + lower, second + b * sin * s.v[0] * s.v[0] + lower]
    });
}

#[test]
fn cart_pole() {
    let (cart, pole, half, i) = (1.0, 0.1, 0.5, 0.008_335_833_333_33);
    holds("cart_pole", |s| {
        let (sin, cos) = s.q[1].sin_cos();
        let force = (cart + pole) * s.a[0] + pole * half * (cos * s.a[1] - sin * s.v[1] * s.v[1]);
        let moment = pole * half * cos * s.a[0] + (i + pole * half * half) * s.a[1] - pole * half * G * sin;
        vec![force, moment]
    });
}
