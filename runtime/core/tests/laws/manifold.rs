//! Steps, differences and random points of the configurations' manifold.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use articulated_core::Scalar;
use articulated_core::algorithm::{Workspace, neutral, random_configuration};
use articulated_core::description::{JointId, JointKind, Limit};
use articulated_core::dual::Dual;
use articulated_core::model::{JointInfo, Model};
use articulated_core::spatial::screw::Quaternion;
use articulated_core::spatial::{Vector3, rotate};
use articulated_reference::Big;
use articulated_test_support::case::{Case, cast, for_each_bundled};
use articulated_test_support::measure::U;
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;

use crate::trees::for_each_tree;

/// Where a joint's quaternion is in q, and its angular rates in v.
fn quaternion_of(joint: &JointInfo) -> Option<(usize, usize)> {
    Some((joint.quaternion()?.start, joint.v.0))
}

fn quaternions(model: &Model<f64>) -> impl Iterator<Item = (usize, usize)> {
    model.joints().iter().filter_map(quaternion_of)
}

fn read<S: Scalar>(q: &[S], at: usize) -> Quaternion<S> {
    Quaternion::from_array(std::array::from_fn(|k| q[at + k]))
}

fn scaled(x: &[f64], by: f64) -> Vec<f64> {
    x.iter().map(|x| x * by).collect()
}

/// Largest difference of two configurations, quaternions up to their signs, in units of u.
fn apart(model: &Model<f64>, a: &[f64], b: &[f64]) -> f64 {
    let mut b = b.to_vec();
    for (at, _) in quaternions(model) {
        let same = (0..4).map(|k| a[at + k] * b[at + k]).sum::<f64>();
        b[at..at + 4].iter_mut().for_each(|x| *x *= same.signum());
    }
    largest(a, &b)
}

/// Largest difference, in units of u; NaN counts as infinite.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference = |(a, b): (&f64, &f64)| if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() / U };
    a.iter().zip(b).map(difference).fold(0.0, f64::max)
}

/// Scale of errors of translations: 1 m and the longest way from one configuration to the other.
fn reach(model: &Model<f64>, q: &[f64], target: &[f64]) -> f64 {
    let floating = model.joints().iter().filter(|j| j.kind == JointKind::Floating).map(|j| j.q.0);
    1.0 + floating.map(|at| (at..at + 3).map(|k| (target[k] - q[k]).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

fn for_each(law: impl Fn(&Case, &mut Random)) {
    for_each_tree(40, Flavour::ANY, &law);
    for_each_bundled(law);
}

/// The target with its rotations `angle` radians from those of q.
fn turned_away(case: &Case, random: &mut Random, q: &[f64], target: &[f64], angle: f64) -> Vec<f64> {
    let mut target = target.to_vec();
    for (at, _) in quaternions(&case.model) {
        let axis = *random.choose(&[random.clone().unit::<3>(), [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]);
        // A right angle is a right angle here: (axis, 0) exactly.
        let (s, c) = if angle == PI { (1.0, 0.0) } else { (angle / 2.0).sin_cos() };
        let turn = Quaternion { vector: Vector3::from(axis) * s, scalar: c };
        target[at..at + 4].copy_from_slice(&read(q, at).product(&turn).normalised().to_array());
    }
    target
}

#[test]
fn the_difference_to_a_target_leads_there_from_no_turn_to_half_a_turn() {
    for_each(|case, random| {
        let state = case.state(random);
        let near = [0.0, 1e-300, 1e-9, 1e-5, 1.0, 3.0, PI - 1e-6, PI - 1e-9, PI, PI + 1e-9].map(Some);
        for angle in near.into_iter().chain([None]) {
            let target = angle.map_or(state.target.clone(), |angle| turned_away(case, random, &state.q, &state.target, angle));
            let step = case.call("difference", &[&state.q, &target]);
            let found = case.call("integrate", &[&state.q, &step]);
            let far = apart(&case.model, &target, &found) / reach(&case.model, &state.q, &target);
            assert!(far <= 10.0, "{angle:?}: {far} u");
            for (_, at) in quaternions(&case.model) {
                let turn = step[at..at + 3].iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!(turn <= PI * (1.0 + 3.0 * U), "{turn}");
                assert!(angle.is_none_or(|a| (turn - a.min(TAU - a)).abs() <= 12.0 * U), "{turn}");
            }
        }
    });
}

#[test]
fn a_step_is_the_difference_that_it_makes() {
    for_each(|case, random| {
        let state = case.state(random);
        for size in [1.0, 1.5, 1e-3, 1e-9, 1e-15, 1e-200, 0.0] {
            let step = scaled(&state.step, size);
            let there = case.call("integrate", &[&state.q, &step]);
            let found = case.call("difference", &[&state.q, &there]);
            assert!(largest(&found, &step) <= 16.0, "{size:e}: {} u", largest(&found, &step));
            for (at, _) in quaternions(&case.model) {
                assert!((read(&there, at).norm_squared() - 1.0).abs() <= 4.0 * U);
            }
        }
    });
}

/// ṗ = R v and q̇ = ½ q ⊗ ω, with rates that do not change on the way.
#[test]
fn a_step_along_time_is_a_motion_with_constant_rates() {
    for_each(|case, random| {
        let state = case.state(random);
        for time in [0.0, 1e-12, 0.7] {
            let step: Vec<Dual<f64>> = state.v.iter().map(|v| Dual::new(v * time, *v)).collect();
            let moving = case.call("integrate", &[&cast(&state.q), &step]);
            for joint in case.model.joints() {
                let Some((at, v)) = quaternion_of(joint) else {
                    (0..joint.q.1).for_each(|k| assert_eq!(moving[joint.q.0 + k].slope, state.v[joint.v.0 + k]));
                    continue;
                };
                let q = read(&moving, at);
                let (vector, scalar) = (q.vector.map(|d| d.value), q.scalar.value);
                let here = Quaternion { vector, scalar };
                let rate = Quaternion { vector: Vector3::new(state.v[v], state.v[v + 1], state.v[v + 2]) * 0.5, scalar: 0.0 };
                let slope = q.to_array().map(|d| d.slope);
                assert!(largest(&slope, &here.product(&rate).to_array()) <= 8.0, "{time}");
                if joint.kind == JointKind::Floating {
                    let linear = Vector3::new(state.v[v + 3], state.v[v + 4], state.v[v + 5]);
                    let slope: Vec<f64> = (0..3).map(|k| moving[joint.q.0 + k].slope).collect();
                    assert!(largest(&slope, rotate(&here.to_rotation(), linear).as_slice()) <= 16.0, "{time}");
                }
            }
        }
    });
}

#[test]
fn steps_along_one_direction_add_up() {
    for_each(|case, random| {
        let state = case.state(random);
        let (first, second) = (random.within(-2.0, 2.0), random.within(-2.0, 2.0));
        let at = |q: &[f64], size: f64| case.call("integrate", &[q, &scaled(&state.step, size)]);
        let found = at(&at(&state.q, first), second);
        let far = apart(&case.model, &at(&state.q, first + second), &found);
        assert!(far <= 16.0, "{far} u");
    });
}

#[test]
fn steps_and_differences_in_double_precision_are_those_in_many_digits() {
    for_each_tree(25, Flavour::ANY, |case, random| {
        let state = case.state(random);
        for (name, other) in [("integrate", &state.step), ("difference", &state.target)] {
            Big::scope(|| {
                let found = case.call::<f64>(name, &[&state.q, other]);
                let expected = case.call::<Big>(name, &[&cast(&state.q), &cast(other)]);
                let far = found.iter().zip(&expected).map(|(f, e)| e.error_of(*f, U)).fold(0.0, f64::max);
                let far = if name == "difference" { far / reach(&case.model, &state.q, other) } else { far };
                assert!(far <= 8.0, "{name}: {far} u");
            });
        }
    });
}

/// From no turn to nearly a whole one, and differences up to half a turn; a mixed joint's entries
/// grow with the way.
#[test]
fn derivatives_of_steps_and_differences_in_double_precision_are_those_in_many_digits() {
    for_each_tree(25, Flavour::ANY, |case, random| {
        let state = case.state(random);
        let sizes = [1.0, 1e-3, 1e-9, 1e-200, 0.0];
        let steps = sizes.map(|size| scaled(&state.step, size));
        let targets = [0.0, 1e-9, 1e-3, 1.0, 3.0].map(|angle| turned_away(case, random, &state.q, &state.target, angle));
        let apart = |name: &str, given: &[&[f64]]| {
            let exact: Vec<Vec<Big>> = given.iter().map(|x| cast(x)).collect();
            let exact: Vec<&[Big]> = exact.iter().map(Vec::as_slice).collect();
            let expected = case.call::<Big>(name, &exact);
            case.call::<f64>(name, given).iter().zip(&expected).map(|(f, e)| e.error_of(*f, U)).fold(0.0, f64::max)
        };
        Big::scope(|| {
            for step in &steps {
                let way = 1.0 + step.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                let far = apart("integrate_derivatives", &[step]) / way;
                assert!(far <= 4.0, "{far} u");
            }
            for target in targets.iter().chain([&state.target]) {
                let far = apart("difference_derivatives", &[&state.q, target]) / reach(&case.model, &state.q, target);
                assert!(far <= 6.0, "{far} u");
            }
        });
    });
}

/// Gives the prismatic joint other limits, and returns the index of its coordinate.
fn limit_rail(case: &mut Case, limit: Limit) -> usize {
    let rail = case.model.joints().iter().position(|j| j.kind == JointKind::Prismatic).unwrap();
    case.model = case.model.clone().changed(|parts| parts.joints[rail].limit = Some(limit));
    case.model.joints()[rail].q.0
}

/// A turn or two metres from the existing bound.
#[test]
fn a_limit_that_is_open_on_one_side_is_kept_on_the_other() {
    let mut case = Case::bundled(articulated_models::robot("cart_pole").unwrap());
    for (lower, upper, expected) in [(0.5, f64::INFINITY, [0.5, 2.5]), (f64::NEG_INFINITY, -0.5, [-2.5, -0.5])] {
        let at = limit_rail(&mut case, Limit { lower, upper, effort: 1.0, velocity: 1.0, ..Limit::NONE });
        let drawn = |u: f64| case.call("random_configuration", &[&vec![u; case.model.nq()]])[at];
        assert_eq!(drawn(0.0), expected[0]);
        assert!((drawn(1.0 - U) - expected[1]).abs() <= 4.0 * U);
    }
}

/// A metre to either side along both axes, and half a turn.
#[test]
fn a_planar_joint_without_limits_is_drawn_in_metres_and_turns() {
    let text = r#"<robot name="r"><link name="base"/><link name="puck"/>
        <joint name="slide" type="planar"><parent link="base"/><child link="puck"/><axis xyz="0 0 1"/></joint></robot>"#;
    let model = Model::new(&articulated_test_support::case::read(text), articulated_core::description::Base::Fixed).unwrap();
    let drawn = |u: f64| {
        let mut q = [0.0; 3];
        random_configuration(&model, &mut Workspace::new(&model), &[u; 3], &mut q);
        q
    };
    assert_eq!([0.0, 0.5, 1.0].map(drawn), [[-1.0, -1.0, -PI], [0.0; 3], [1.0, 1.0, PI]]);
}

/// The textbook has the same rule, of bounds that are open or the wrong way round.
#[test]
fn the_textbook_draws_within_the_same_limits() {
    let mut case = Case::bundled(articulated_models::robot("cart_pole").unwrap());
    let open = f64::INFINITY;
    for (lower, upper) in [(-1.0, open), (-open, 1.0), (-open, open), (1.0, -1.0), (-1.0, 2.0)] {
        let limit = Some(Limit { lower, upper, effort: 1.0, velocity: 1.0, ..Limit::NONE });
        case.model = case.model.clone().changed(|parts| parts.joints.iter_mut().for_each(|j| j.limit = limit));
        case.description.joints.iter_mut().for_each(|j| j.limit = limit);
        case.description.joints.iter_mut().filter(|j| j.kind == JointKind::Continuous).for_each(|j| j.kind = JointKind::Revolute);
        let uniform = vec![0.25; case.model.nq()];
        let (found, expected) =
            (case.call::<f64>("random_configuration", &[&uniform]), case.textbook::<f64>().random_configuration(&uniform));
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-15 * 8.0), "{lower} {upper}: {found:?} {expected:?}");
    }
}

/// Bounds whose difference is beyond the range of numbers.
#[test]
fn limits_as_wide_as_numbers_are_kept() {
    let mut case = Case::bundled(articulated_models::robot("cart_pole").unwrap());
    let at = limit_rail(&mut case, Limit { lower: -1e308, upper: 1.7e308, effort: 1.0, velocity: 1.0, ..Limit::NONE });
    for (u, expected) in [(0.0, -1e308), (0.5, 0.35e308), (0.25, -0.325e308)] {
        let drawn = case.call("random_configuration", &[&vec![u; case.model.nq()]])[at];
        assert!((drawn / expected - 1.0).abs() < 1e-15, "{u}: {drawn:e}");
    }
}

/// In URDF, bounds of a continuous joint have no meaning: it turns all the way round, whatever they
/// are.
#[test]
fn a_continuous_joint_has_no_limits() {
    let text = r#"<robot name="r"><link name="base"/>
        <link name="arm"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><limit lower="-0.1" upper="0.2" effort="1" velocity="1"/></joint></robot>"#;
    let mut robot = articulated_test_support::case::read(text);
    robot.joints[JointId(0)].limit = Some(Limit { lower: -0.1, upper: 0.2, effort: 1.0, velocity: 1.0, ..Limit::NONE });
    let model = Model::new(&robot, articulated_core::description::Base::Fixed).unwrap();
    assert_eq!(model.joints()[0].limit, None);
}

#[test]
fn random_configurations_keep_to_the_limits_and_are_rotations() {
    let greatest = 1.0 - U;
    for_each(|case, random| {
        let n = case.model.nq();
        for uniform in [vec![0.0; n], vec![greatest; n], vec![0.5; n], random.vector(n, 0.0, 1.0)] {
            let q = case.call("random_configuration", &[&uniform]);
            for joint in case.model.joints() {
                let own = &q[joint.q.0..joint.q.0 + joint.q.1];
                match (joint.kind, joint.limit) {
                    (JointKind::Floating, _) => assert!(own[..3].iter().all(|x| x.abs() <= 1.0)),
                    (JointKind::Spherical, _) => {
                        assert!(2.0 * own[3].abs().min(1.0).acos() <= joint.cone.unwrap_or(PI) * (1.0 + 1e-7), "{joint:?} {own:?}");
                    }
                    (_, Some(limit)) => assert!((limit.lower..=limit.upper).contains(&own[0]), "{joint:?} {own:?}"),
                    (JointKind::Prismatic, None) => assert!(own[0].abs() <= 1.0),
                    (JointKind::Planar, None) => assert!(own[0].abs() <= 1.0 && own[1].abs() <= 1.0 && own[2].abs() <= PI),
                    (_, None) => assert!(own.iter().all(|x| x.abs() <= PI)),
                }
            }
            for (at, _) in quaternions(&case.model) {
                assert!((read(&q, at).norm_squared() - 1.0).abs() <= 4.0 * U);
            }
        }
    });
}

/// Of uniform rotations, the angle is below π/2 with probability (π/2 − 1)/π, and all axes are
/// alike.
#[test]
fn random_rotations_are_uniform() {
    let robot = articulated_models::robot("quadruped").expect("bundled");
    let case = Case::bundled(robot);
    let (at, _) = quaternions(&case.model).next().expect("it floats");
    let random = &mut Random::new(3);
    let (count, mut small, mut sum, mut squares) = (20_000, 0.0, [0.0; 4], [0.0; 4]);
    for _ in 0..count {
        let q = case.call("random_configuration", &[&random.vector(case.model.nq(), 0.0, 1.0)]);
        let q: [f64; 4] = read(&q, at).to_array();
        small += f64::from(u8::from(2.0 * q[3].abs().acos() < FRAC_PI_2)) / f64::from(count);
        for k in 0..4 {
            sum[k] += q[k] / f64::from(count);
            squares[k] += q[k] * q[k] / f64::from(count);
        }
    }
    // Four standard deviations.
    assert!((small - (FRAC_PI_2 - 1.0) / PI).abs() < 0.011, "{small}");
    assert!(sum.iter().all(|x| x.abs() < 0.0142), "{sum:?}");
    assert!(squares.iter().all(|x| (x - 0.25).abs() < 0.0063), "{squares:?}");
}

/// A ball joint whose range is `upper` rad.
fn ball(upper: f64) -> Case {
    let text = r#"<robot name="r"><link name="base"/>
        <link name="arm"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="ball" type="spherical"><parent link="base"/><child link="arm"/></joint></robot>"#;
    let mut description = articulated_test_support::case::read(text);
    description.joints[JointId(0)].limit = Some(Limit { lower: 0.0, upper, ..Limit::NONE });
    Case::new("ball", description, articulated_core::description::Base::Fixed)
}

/// Rotations within a cone of θ are (θ − sin θ)/π of all, and alike about all axes.
#[test]
fn random_rotations_of_a_ball_with_a_range_are_uniform_within_it() {
    let random = &mut Random::new(11);
    let volume = |angle: f64| angle - angle.sin();
    for upper in [1e-3, 0.5, FRAC_PI_2, 3.0] {
        let case = ball(upper);
        let (count, mut below, mut sum, mut squares) = (20_000, [0.0; 3], [0.0; 3], [0.0; 3]);
        for _ in 0..count {
            let q: [f64; 4] = read(&case.call("random_configuration", &[&random.vector(4, 0.0, 1.0)]), 0).to_array();
            let sine = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt();
            let angle = 2.0 * sine.atan2(q[3]);
            assert!(angle <= upper * (1.0 + 16.0 * U), "{upper} {angle}");
            for (k, part) in [0.3, 0.6, 0.9].into_iter().enumerate() {
                below[k] += f64::from(u8::from(angle < part * upper)) / f64::from(count);
            }
            for k in 0..3 {
                sum[k] += q[k] / sine / f64::from(count);
                squares[k] += (q[k] / sine) * (q[k] / sine) / f64::from(count);
            }
        }
        // Four standard deviations.
        for (found, part) in below.into_iter().zip([0.3, 0.6, 0.9]) {
            let expected = volume(part * upper) / volume(upper);
            assert!(
                (found - expected).abs() < 4.0 * (expected * (1.0 - expected) / f64::from(count)).sqrt(),
                "{upper}: {found} {expected}"
            );
        }
        assert!(sum.iter().all(|x| x.abs() < 0.0164), "{upper}: {sum:?}");
        assert!(squares.iter().all(|x| (x - 1.0 / 3.0).abs() < 0.0085), "{upper}: {squares:?}");
    }
}

/// In doubles, and in many digits; a bound from π on, or of 0, is none.
#[test]
fn the_textbook_draws_within_the_same_cone() {
    for upper in [1e-4, 0.4, 1.0, 2.0, 3.1, PI, 7.0, f64::INFINITY, 0.0] {
        let case = ball(upper);
        for u in [0.0, 1e-9, 0.01, 0.3, 0.77, 1.0 - U] {
            let uniform = vec![u, 0.6, 0.35, 0.9];
            let expected = case.textbook::<Big>().random_configuration(&cast::<Big>(&uniform));
            let many = case.call::<Big>("random_configuration", &[&cast::<Big>(&uniform)]);
            let found = case.call::<f64>("random_configuration", &[&uniform]);
            for ((found, many), expected) in found.iter().zip(&many).zip(&expected) {
                assert!((found - expected.to_f64()).abs() < 2e-15 + 1e-11 * f64::from(u8::from(u == 0.0)), "{upper} {u}: {found}");
                assert!((*many - *expected).to_f64().abs() < 2e-15 + 1e-11 * f64::from(u8::from(u == 0.0)), "{upper} {u}");
            }
            // Height and angle have no double of π in them.
            let is_cone = case.model.joints()[0].cone.is_some();
            let exact = many.iter().zip(&expected).skip(2).all(|(many, expected)| (*many - *expected).to_f64().abs() < 1e-60);
            assert!(exact || !is_cone || u == 0.0, "{upper} {u}");
        }
    }
}

#[test]
fn the_neutral_configuration_turns_nothing() {
    for_each(|case, _| {
        let mut q = vec![f64::NAN; case.model.nq()];
        neutral(&case.model, &mut q);
        assert_eq!(q.iter().sum::<f64>(), quaternions(&case.model).count() as f64);
        assert!(quaternions(&case.model).all(|(at, _)| q[at + 3] == 1.0));
        assert_eq!(case.call("difference", &[&q, &q]), vec![0.0; case.model.nv()]);
    });
}
