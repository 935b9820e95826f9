//! The checked form: its errors, its accepted inputs, and the robots that it runs on.

use articulated::algorithm::checked::{Factor, Measure, Solver, Unsolved, least_pivot};
use articulated::{Dynamics, Workspace, algorithm};
use articulated_core::description::{Base, JointId, JointKind, Mimic, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;
use articulated_lab::stress::robots::{Shape, built, chain, rods, state, states};
use articulated_tests::case::Case;

fn mass_matrix(model: &Model<f64>, q: &[f64]) -> Vec<f64> {
    let mut m = vec![0.0; model.nv() * model.nv()];
    algorithm::mass_matrix(model, &mut Workspace::new(model), q, &mut m);
    m
}

/// On generated robots and on models, by the same code; the solution is that of the unchecked form.
#[test]
fn a_solver_runs_on_whatever_has_dynamics() {
    fn solve<R: Dynamics>(robot: &R, [q, v, tau]: [&[f64]; 3]) -> (Vec<f64>, f64) {
        let mut a = vec![0.0; robot.shape().nv];
        let mut solver = Solver::new(robot.shape());
        let left = solver.forward_dynamics(robot, &mut robot.workspace(), [q, v, tau], &mut a).unwrap();
        assert!(solver.backward_error() <= 4.0 * f64::EPSILON, "{}", solver.backward_error());
        (a, left)
    }
    let model = Case::bundled(articulated_models::robot("panda_like").unwrap()).model;
    for s in states(&model, 4, 1, 20.0) {
        let given = [&s.q[..], &s.v, &s.tau];
        let ((a, left), (b, same)) = (solve(&model, given), solve(&articulated_models::panda_like::Robot, given));
        let mut c = vec![0.0; model.nv()];
        let by_aba = algorithm::checked_forward_dynamics(&model, &mut Workspace::new(&model), &s.q, &s.v, &s.tau, &mut c).unwrap();
        let size = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for k in 0..a.len() {
            assert!((a[k] - b[k]).abs() <= 1e-11 * size && (a[k] - c[k]).abs() <= 1e-11 * size, "{a:?} {b:?} {c:?}");
        }
        let names =
            |k| (Dynamics::joint_of(&model, k).map(str::to_owned), articulated_models::panda_like::Robot.joint_of(k).map(str::to_owned));
        (0..=model.nv()).map(names).for_each(|(a, b)| assert_eq!(a, b));
        assert!((left / same - 1.0).abs() < 1e-9 && left > 1e-4 && by_aba > 1e-4, "{left} {same} {by_aba}");
    }
}

/// Only the torques that a motor delivers accelerate: for a model, and for code generated for it.
#[test]
fn a_solver_solves_with_what_motors_give() {
    articulated::robot! {
        pub mod driven {
            urdf = "../models/urdf/simple_pendulum.urdf",
            functions = [bias_forces, mass_matrix, motor_torques, forward_dynamics],
            effects = { motor = { "*" = { torque = 2.0, speed = 30.0, gear = 3.0, smooth = 1e-3 } } },
        }
    }
    fn both<R: Dynamics>(robot: &R) -> [f64; 2] {
        let (mut ws, given) = (robot.workspace(), [[0.3], [5.0], [100.0]]);
        let [q, v, tau] = given.each_ref().map(|x| &x[..]);
        let (mut expected, mut found) = ([0.0], [0.0]);
        robot.forward_dynamics(&mut ws, q, v, tau, &mut expected).unwrap();
        Solver::new(robot.shape()).forward_dynamics(robot, &mut ws, [q, v, tau], &mut found).unwrap();
        [found[0], expected[0]]
    }
    let bare = Case::bundled(articulated_models::robot("simple_pendulum").unwrap()).model;
    let on = bare.joints()[0].name.clone();
    let motor = Applied { effect: EffectId::motor, on, at: Origin::default(), parameters: vec![2.0, 30.0, 3.0, 1.0, 1e-3] };
    let model = bare.clone().with_effects(&[motor]).unwrap();
    assert!(Dynamics::has_motors(&model) && driven::Robot.has_motors() && !Dynamics::has_motors(&bare));
    for [found, expected] in [both(&model), both(&driven::Robot)] {
        assert!((found - expected).abs() <= 1e-12 * expected.abs() && (expected - both(&bare)[1]).abs() > 1.0, "{found} {expected}");
    }
}

/// Against ABA with the same wrenches.
#[test]
fn a_solver_solves_with_wrenches() {
    let model = Case::bundled(articulated_models::robot("panda_like").unwrap()).model;
    let mut ws = Workspace::new(&model);
    for s in states(&model, 2, 5, 20.0) {
        let wrenches: Vec<f64> = (0..6 * model.frames().len()).map(|k| (k as f64).sin()).collect();
        let (mut a, mut b, mut free) = (vec![0.0; model.nv()], vec![0.0; model.nv()], vec![0.0; model.nv()]);
        algorithm::articulated_body_with_wrenches(&model, &mut ws, &s.q, &s.v, &s.tau, &wrenches, &mut a);
        let (mut solver, given) = (Solver::new(Dynamics::shape(&model)), [&s.q[..], &s.v, &s.tau]);
        solver.forward_dynamics_with_wrenches(&model, &mut ws, given, &wrenches, &mut b).unwrap();
        solver.forward_dynamics(&model, &mut ws, given, &mut free).unwrap();
        let size = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-11 * size), "{a:?} {b:?}");
        assert!(a.iter().zip(&free).any(|(a, b)| (a - b).abs() > 1e-3 * size), "{a:?} {free:?}");
        let wrong = solver.forward_dynamics_with_wrenches(&model, &mut ws, given, &wrenches[1..], &mut b);
        assert!(matches!(wrong, Err(Unsolved::Function(_))));
    }
}

#[test]
fn an_error_names_the_joint_and_says_what_is_left() {
    let model = built(&rods(), Base::Fixed);
    let (mut ws, mut a) = (Workspace::new(&model), [0.0; 3]);
    let error = algorithm::checked_forward_dynamics(&model, &mut ws, &[0.4, 0.0, 0.0], &[0.1; 3], &[1.0; 3], &mut a).unwrap_err();
    assert_eq!((error.joint.as_str(), error.freedom, error.measure), ("joint_1", 0, Measure::Pivot));
    assert!(error.found < error.least && error.least == least_pivot::<f64>());
    assert!(error.to_string().starts_with("joint \"joint_1\" (degree of freedom 0): the mass matrix is singular"), "{error}");
}

/// How much of the pivot is left follows the bend: sin² of it.
#[test]
fn the_measure_goes_down_with_the_square_of_the_bend_until_it_is_an_error() {
    let model = built(&rods(), Base::Fixed);
    let (mut ws, mut a) = (Workspace::new(&model), [0.0; 3]);
    let mut left = |bend: f64| algorithm::checked_forward_dynamics(&model, &mut ws, &[0.4, bend, 0.0], &[0.0; 3], &[1.0; 3], &mut a);
    let measures: Vec<f64> = [1e-2, 1e-3, 1e-4, 1e-5].map(|b| left(b).unwrap()).into();
    measures.windows(2).for_each(|w| assert!((w[0] / w[1] / 100.0 - 1.0).abs() < 0.01, "{measures:?}"));
    assert!(left(1e-8).is_err() && left(0.0).is_err());
}

#[test]
fn what_overflows_or_is_not_a_number_is_an_error_too() {
    let model = built(&chain(3, 1.0), Base::Fixed);
    let (mut ws, mut a) = (Workspace::new(&model), [0.0; 3]);
    let mut solve = |q: f64, tau: f64| algorithm::checked_forward_dynamics(&model, &mut ws, &[q, 0.3, 0.1], &[0.0; 3], &[tau; 3], &mut a);
    assert_eq!(solve(0.2, 1e308).unwrap_err().measure, Measure::Finite);
    for (q, tau) in [(0.2, f64::NAN), (f64::NAN, 1.0), (f64::INFINITY, 1.0)] {
        let told = solve(q, tau).unwrap_err().to_string();
        assert!(told.contains("is not a number") && !told.contains("singular"), "{told}");
    }
    assert!(solve(0.2, 1.0).is_ok());
}

#[test]
fn robots_whose_joints_follow_others_are_checked_too() {
    let mut robot = rods();
    robot.joints[JointId(2)].mimic = Some(Mimic::linear(JointId(1), 1.0, 0.0));
    robot.joints[JointId(2)].kind = JointKind::Continuous;
    let model = built(&robot, Base::Fixed);
    let (mut ws, mut a) = (Workspace::new(&model), [0.0; 2]);
    let mut solve = |bend: f64| algorithm::checked_forward_dynamics(&model, &mut ws, &[0.4, bend], &[0.1; 2], &[1.0; 2], &mut a);
    assert_eq!(solve(0.0).unwrap_err().joint, "joint_1");
    assert!(solve(0.1).is_ok());
}

#[test]
fn a_wrong_length_is_an_error_of_the_solver() {
    let model = built(&chain(3, 1.0), Base::Fixed);
    let mut solver = Solver::new(Dynamics::shape(&model));
    let mut solve = |n: usize, out: usize| {
        solver.forward_dynamics(&model, &mut Workspace::new(&model), [&[0.0; 3], &[0.0; 3], &vec![0.0; n]], &mut vec![0.0; out])
    };
    assert!(matches!(solve(2, 3), Err(Unsolved::Function(_))) && matches!(solve(3, 4), Err(Unsolved::Function(_))));
    assert!(solve(3, 3).is_ok());
}

/// Against all eigenvalues; an estimate of the 1-norm's condition number is within a factor n of
/// the 2-norm's.
#[test]
fn the_estimate_of_the_condition_number_is_near_it() {
    for n in [1, 2, 5, 12, 30] {
        let model = built(&chain(n, 1.0), Base::Fixed);
        for shape in [Shape::Straight, Shape::ZigZag, Shape::Folded] {
            let m = mass_matrix(&model, &state(shape.angles(n), n, 1, 1.0).q);
            let mut factor = Factor::new(n);
            factor.factor(&m).unwrap();
            let scaled = nalgebra::DMatrix::from_fn(n, n, |i, k| m[i * n + k] / (m[i * n + i] * m[k * n + k]).sqrt());
            let values = scaled.clone().symmetric_eigenvalues();
            let exact = values.max() / values.min();
            let inverse = scaled.clone().try_inverse().unwrap();
            let norm = |m: &nalgebra::DMatrix<f64>| m.column_iter().map(|c| c.abs().sum()).fold(0.0, f64::max);
            let (found, one) = (factor.condition(), norm(&scaled) * norm(&inverse));
            assert!(found <= one * 1.001 && found >= one / 3.0, "{n} {shape:?}: {found:e} of {one:e}, κ₂ {exact:e}");
        }
    }
}

/// A solution of M x = b by the factor, with the original M.
#[test]
fn a_factor_solves() {
    let model = Case::bundled(articulated_models::robot("humanoid").unwrap()).model;
    let s = &states(&model, 1, 3, 1.0)[0];
    let (n, m) = (model.nv(), mass_matrix(&model, &s.q));
    let mut factor = Factor::new(n);
    factor.factor(&m).unwrap();
    let mut x = s.tau.clone();
    factor.solve(&mut x);
    for i in 0..n {
        let sum: f64 = (0..n).map(|k| m[i * n + k] * x[k]).sum();
        let size: f64 = (0..n).map(|k| (m[i * n + k] * x[k]).abs()).sum();
        assert!((sum - s.tau[i]).abs() <= 64.0 * f64::EPSILON * size, "row {i}");
    }
}
