//! Exponentials and their derivatives.

use std::f64::consts::TAU;

use articulated_core::dual::Dual;
use articulated_core::nalgebra::{Matrix6, SMatrix, Vector6};
use articulated_core::spatial::screw::{
    Quaternion, cross_matrix, exp_rotation, left_jacobian, left_jacobian_inverse, right_jacobian, right_jacobian_inverse,
};
use articulated_core::spatial::{Placement, Twist, Vector3};
use articulated_reference::Big;
use articulated_test_support::measure::U;
use articulated_test_support::random::Random;

use super::{along, angles, far, moved, series, turned, twist, vector};

#[test]
fn exponential_of_a_rotation_vector_is_the_series_of_its_matrix() {
    let random = &mut Random::new(5);
    for angle in angles(random, 60, 12.0) {
        Big::scope(|| {
            let w = turned(random, angle);
            let expected = series(&cross_matrix(vector::<Big>(w)), 0);
            let error = far(&exp_rotation(w), &expected);
            assert!(error <= 4.0 + 1.5 * angle, "{w}: {error} u");
            let q = Quaternion::exp(w);
            assert!((q.norm_squared() - 1.0).abs() <= 6.0 * U, "{}", q.norm_squared() - 1.0);
        });
    }
}

#[test]
fn exponential_of_a_twist_is_the_series_of_its_matrix() {
    let random = &mut Random::new(6);
    for angle in angles(random, 60, 12.0) {
        Big::scope(|| {
            let xi = moved(random, angle);
            let mut m = SMatrix::<Big, 4, 4>::zeros();
            m.fixed_view_mut::<3, 3>(0, 0).copy_from(&cross_matrix(vector(xi.angular)));
            m.fixed_view_mut::<3, 1>(0, 3).copy_from(&vector(xi.linear));
            let expected = series(&m, 0).fixed_view::<3, 1>(0, 3).into_owned();
            let error = far(&xi.exp().position, &expected);
            assert!(error <= (3.0 + angle) * xi.linear.norm(), "{xi:?}: {error} u");
        });
    }
}

#[test]
fn jacobians_are_the_series_of_their_matrices() {
    let random = &mut Random::new(7);
    for angle in angles(random, 30, 6.2) {
        Big::scope(|| {
            let xi = moved(random, angle);
            let minus = Twist { angular: -xi.angular, linear: -xi.linear };
            let few = 2.0 + 1.5 * angle;
            let three = [left_jacobian(xi.angular), right_jacobian(xi.angular)];
            for (sign, found, three) in [(xi, xi.left_jacobian(), three[0]), (minus, xi.right_jacobian(), three[1])] {
                let expected = series(&twist::<Big>(&sign).ad(), 1);
                assert!(far(&found, &expected) <= few, "{xi:?}: {} u", far(&found, &expected));
                let corner = expected.fixed_view::<3, 3>(0, 0).into_owned();
                assert!(far(&three, &corner) <= few, "{xi:?}: {} u", far(&three, &corner));
            }
        });
    }
}

/// Near 2π the inverse of the Jacobian of SO(3) grows as 2π/(2π − θ), that of SE(3) as its square,
/// and so does the loss.
#[test]
fn inverse_jacobians_are_inverse() {
    let random = &mut Random::new(8);
    let near_the_end = [1e-1, 1e-2, 1e-4, 1e-6].map(|d| TAU - d);
    for angle in angles(random, 30, 6.0).into_iter().chain(near_the_end) {
        Big::scope(|| {
            let xi = moved(random, angle);
            let precise = twist::<Big>(&xi);
            let one = Matrix6::<Big>::identity();
            let product = precise.left_jacobian() * precise.left_jacobian_inverse() - one;
            assert!(product.iter().all(|x| x.to_f64().abs() < 1e-70), "{xi:?}");
            let product = precise.right_jacobian_inverse() * precise.right_jacobian() - one;
            assert!(product.iter().all(|x| x.to_f64().abs() < 1e-70), "{xi:?}");
            let growth = TAU / (TAU - angle);
            let error = far(&left_jacobian_inverse(xi.angular), &left_jacobian_inverse(precise.angular));
            assert!(error <= 2.0 * growth * growth, "{angle}: {error} u");
            let error = far(&right_jacobian_inverse(xi.angular), &right_jacobian_inverse(precise.angular));
            assert!(error <= 2.0 * growth * growth, "{angle}: {error} u");
            let error = far(&xi.left_jacobian_inverse(), &precise.left_jacobian_inverse());
            assert!(error <= 4.0 * growth.powi(3), "{angle}: {error} u");
        });
    }
}

/// The twist [s; t] for which d/dε x = [[s]× t; 0 0] x.
fn rate_in_space(x: &Placement<Dual<f64>>) -> Vector6<f64> {
    let (r, p) = (x.rotation.map(|d| d.value), x.position.map(|d| d.value));
    let spin = x.rotation.map(|d| d.slope) * r.transpose();
    let w = Vector3::new(spin.m32 - spin.m23, spin.m13 - spin.m31, spin.m21 - spin.m12) / 2.0;
    let v = x.position.map(|d| d.slope) - w.cross(&p);
    Vector6::new(w.x, w.y, w.z, v.x, v.y, v.z)
}

#[test]
fn jacobians_are_the_derivatives_of_the_exponential() {
    let random = &mut Random::new(9);
    for angle in angles(random, 40, 6.0) {
        let xi = moved(random, angle);
        let ad = xi.exp().adjoint();
        for k in 0..6 {
            let rate = rate_in_space(&along(&xi, k).exp());
            assert!((rate - xi.left_jacobian().column(k)).amax() <= 24.0 * U, "{xi:?}");
            // J_l = Ad(exp ξ) J_r
            assert!((rate - ad * xi.right_jacobian().column(k)).amax() <= 24.0 * U, "{xi:?}");
        }
    }
}
