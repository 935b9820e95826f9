//! Twists and wrenches from frame to frame, screws, chains of screws.

use std::f64::consts::PI;

use articulated_core::dual::Dual;
use articulated_core::nalgebra::Vector6;
use articulated_core::spatial::screw::{Screw, product_of_exponentials_in_body, product_of_exponentials_in_space};
use articulated_core::spatial::{Matrix3, Placement, Twist, Vector3, Wrench, from_rpy};
use articulated_reference::Big;
use articulated_test_support::measure::U;
use articulated_test_support::random::Random;

use super::{angles, far, moved, series, six, twist};

fn six_of(w: &Wrench<f64>) -> Vector6<f64> {
    six(&Twist { angular: w.moment, linear: w.force })
}

#[test]
fn adjoint_of_an_exponential_is_the_exponential_of_the_bracket() {
    let random = &mut Random::new(17);
    for angle in angles(random, 15, 6.0) {
        Big::scope(|| {
            let xi = moved(random, angle);
            let expected = series(&twist::<Big>(&xi).ad(), 0);
            assert!(far(&xi.exp().adjoint(), &expected) <= 4.0 + 3.0 * angle, "{angle}: {}", far(&xi.exp().adjoint(), &expected));
        });
    }
}

#[test]
fn twists_and_wrenches_change_with_the_frame_and_power_does_not() {
    let random = &mut Random::new(18);
    for _ in 0..100 {
        let [x, y] = [(); 2].map(|()| moved(random, 2.0).exp());
        let [v, u] = [(); 2].map(|()| moved(random, 1.5));
        let Twist { angular: moment, linear: force } = moved(random, 1.5);
        let f = Wrench { moment, force };
        let close = |a: Vector6<f64>, b: Vector6<f64>| assert!((a - b).amax() <= 16.0 * U, "{}", (a - b).amax() / U);
        close(x.adjoint() * six(&v), six(&x.transform_twist(&v)));
        close(x.inverse().adjoint() * six(&v), six(&x.transform_twist_back(&v)));
        close(x.coadjoint() * six_of(&f), six_of(&x.transform_wrench(&f)));
        close(x.adjoint().transpose() * six_of(&f), six_of(&x.transform_wrench_back(&f)));
        close(x.compose(&y).adjoint() * six(&v), x.adjoint() * (y.adjoint() * six(&v)));
        close(v.ad() * six(&u), six(&v.cross(&u)));
        close(v.coad() * six_of(&f), six_of(&v.cross_wrench(&f)));
        close(v.coad() * six_of(&f), -(v.ad().transpose() * six_of(&f)));
        assert!((x.transform_wrench(&f).power(&x.transform_twist(&v)) - f.power(&v)).abs() <= 32.0 * U);
        let one = x.compose(&x.inverse());
        assert!((one.rotation - Matrix3::identity()).amax() <= 8.0 * U && one.position.amax() <= 8.0 * U);
    }
}

/// A screw whose turn goes to zero is a translation, with a finite slope there.
#[test]
fn a_screw_without_turn_is_a_translation() {
    let direction = Vector3::new(0.6, 0.0, 0.8);
    let point = Vector3::new(0.3, -0.2, 0.5);
    let way = 0.7;
    let placed = |turn: f64| {
        let Twist { angular, linear } = Screw { point, direction, turn, slide: 1.0 }.twist();
        Twist { angular: angular * way, linear: linear * way }.exp()
    };
    let limit = placed(0.0);
    assert_eq!(limit, Placement { rotation: Matrix3::identity(), position: direction * way });
    assert_eq!(Screw::translation(direction).twist(), Twist { angular: Vector3::zeros(), linear: direction });
    for turn in [1e-2, 1e-5, 1e-8, 1e-12, 1e-100, 1e-300] {
        let near = placed(turn);
        assert!((near.position - limit.position).amax() <= turn + 2.0 * U && (near.rotation - limit.rotation).amax() <= turn, "{turn}");
    }
    let turn = Dual::variable(0.0);
    let still = |x: Vector3<f64>| x.map(Dual::constant);
    let xi = Screw { point: still(point), direction: still(direction), turn, slide: Dual::constant(1.0) }.twist();
    let slope = xi.exp().position.map(|d| d.slope);
    // d/dt of p at t = 0: point × direction, since the slide is along the axis.
    assert!((slope - point.cross(&direction)).amax() <= 2.0 * U);
}

#[test]
fn a_twist_is_that_of_its_screw() {
    let random = &mut Random::new(19);
    for rate in [2.0, 1e-3, 1e-8, 0.0] {
        for _ in 0..20 {
            let xi = moved(random, rate);
            let screw = Screw::of(&xi);
            let back = screw.twist();
            assert!((six(&back) - six(&xi)).amax() <= 2.0 * U * (1.0 + xi.linear.norm()), "{xi:?} {back:?}");
            assert!((screw.direction.norm() - 1.0).abs() <= 4.0 * U && screw.turn >= 0.0);
        }
    }
    for scale in [1e-300, 1e-170, 1e160] {
        let xi = moved(random, 0.7);
        let (screw, scaled) = (Screw::of(&xi), Screw::of(&Twist { angular: xi.angular * scale, linear: xi.linear * scale }));
        let far = [scaled.turn / scale - screw.turn, scaled.slide / scale - screw.slide, (scaled.point - screw.point).amax()];
        assert!(far.iter().all(|x| x.abs() <= 1e-14 * (1.0 + screw.point.norm())), "{scale:e}: {scaled:?} {screw:?}");
    }
    // Lynch & Park 2017, example 3.23: a car that turns with 2 rad/s about (2, −1, 0).
    let screw = Screw::with_pitch(Vector3::new(2.0, -1.0, 0.0), -Vector3::z(), 0.0).twist();
    assert_eq!(six(&screw) * 2.0, Vector6::new(0.0, 0.0, -2.0, 2.0, 4.0, 0.0));
}

#[test]
fn both_products_of_exponentials_are_the_chain_of_placements() {
    let random = &mut Random::new(20);
    for _ in 0..30 {
        // A chain of links, each with a screw along its own z.
        let links: Vec<Placement<f64>> =
            (0..6).map(|_| Placement { rotation: from_rpy(random.three(PI)), position: Vector3::from(random.three(0.6)) }).collect();
        let own: Vec<Screw<f64>> = (0..6)
            .map(|_| match random.below(3) {
                0 => Screw::translation(Vector3::z()),
                1 => Screw::with_pitch(Vector3::zeros(), Vector3::z(), 0.05),
                _ => Screw::with_pitch(Vector3::zeros(), Vector3::z(), 0.0),
            })
            .collect();
        let angles = random.vector(6, -2.0, 2.0);
        let scaled = |s: &Screw<f64>, angle: f64| Twist { angular: s.twist().angular * angle, linear: s.twist().linear * angle };
        let (mut home, mut expected) = (Placement::identity(), Placement::identity());
        let mut in_space = Vec::new();
        for k in 0..6 {
            home = home.compose(&links[k]);
            expected = expected.compose(&links[k]).compose(&scaled(&own[k], angles[k]).exp());
            in_space.push((home.transform_twist(&own[k].twist()), angles[k]));
        }
        let in_body: Vec<_> = in_space.iter().map(|(s, angle)| (home.transform_twist_back(s), *angle)).collect();
        for found in [product_of_exponentials_in_space(&in_space, &home), product_of_exponentials_in_body(&home, &in_body)] {
            assert!((found.rotation - expected.rotation).amax() <= 30.0 * U, "{}", (found.rotation - expected.rotation).amax() / U);
            assert!((found.position - expected.position).amax() <= 80.0 * U, "{}", (found.position - expected.position).amax() / U);
        }
    }
}
