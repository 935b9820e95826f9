//! Refused simulations, and those that cannot go on: every mistake at once, with its joint.

use std::f64::consts::{PI, TAU};

use articulated::simulate::{
    Constant, Control, Event, Hold, Impact, IntegratorId, NoTorque, Output, Pd, Settings, SimulateError, Simulation, StateError, Stiffness,
    integrators,
};
use articulated::{Base, Dynamics, FunctionError, load_bytes};
use articulated_core::algorithm::{Workspace, functions};

use crate::robots::{at, chain, free, handle, model, slider, stepping, to};

#[test]
fn what_cannot_be_simulated_is_said_at_once() {
    let settings = to(IntegratorId::dopri5, 1.0, 1e-6);
    let error = free(&handle::Robot, &settings, &[0.0, f64::NAN, 0.0, 2.0, 0.0, 0.0, 0.0], &[0.0; 5]).unwrap_err();
    let SimulateError::State(all) = &error else { panic!("{error}") };
    assert!(all.contains(&StateError::Length { vector: "v", found: 5, expected: 6 }));
    assert!(matches!(all[0], StateError::NotFinite { vector: "q", index: 1, .. }));
    let base = || Some("__floating_base__".to_owned());
    assert!(all.contains(&StateError::Quaternion { vector: "q", index: 3, norm: 2.0, joint: base() }), "{error}");
    let lacking = Simulation::new(&handle::Robot, to(IntegratorId::rodas4, 1.0, 1e-6)).err();
    let function = "forward_dynamics_derivatives";
    assert_eq!(lacking, Some(SimulateError::Function(FunctionError::NotGenerated { function })));
    let found =
        Simulation::new(&slider(), settings.clone()).unwrap().run(&[0.0], &[0.0], &mut Constant::new(vec![1.0; 2]), &mut []).unwrap_err();
    assert_eq!(found, SimulateError::State(vec![StateError::Length { vector: "tau", found: 2, expected: 1 }]));
    let mut nowhere = [Event::new("nowhere", |_, _: &[f64], _: &[f64]| f64::NAN)];
    let found = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut NoTorque, &mut nowhere).unwrap_err();
    assert_eq!(found, SimulateError::NotFinite { t: 0.0, what: "event", index: vec![0], names: vec!["nowhere".into()] });
    assert_eq!(found.to_string(), "at t = 0 s event[0] (event `nowhere`) is not finite");
    let mut burst = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = if t > 0.5 { f64::NAN } else { 0.0 };
    for id in [IntegratorId::dopri5, IntegratorId::rodas4, IntegratorId::rk4, IntegratorId::lie_midpoint] {
        let settings = if id.row().adaptive { to(id, 1.0, 1e-6) } else { stepping(id, 1.0, 0.01) };
        let error = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[1.0], &mut burst, &mut []).unwrap_err();
        let SimulateError::NotFinite { t, what: "tau", .. } = error else { panic!("{id}: {error}") };
        assert!(t <= 0.52 && t > 0.49, "{id}: {error}");
        assert!(error.to_string().ends_with(" s tau[0] (joint `joint`) is not finite"), "{id}: {error}");
    }
}

/// A robot without moving joints stays at rest, whatever would drive it.
#[test]
fn a_robot_without_a_joint_stands_still() {
    let robot = load_bytes("still.urdf", b"<robot name='still'><link name='base'/></robot>", Base::Fixed).unwrap();
    for row in integrators() {
        let settings = if row.adaptive { to(row.id, 1.0, 1e-6) } else { stepping(row.id, 1.0, 0.1) };
        let mut drive = |_: f64, _: &[f64], _: &[f64], _: &mut [f64]| {};
        let motion = Simulation::new(&robot, settings).unwrap().run(&[], &[], &mut drive, &mut []).unwrap();
        assert_eq!(motion.t, [0.0, 1.0], "{}", row.name);
    }
}

articulated::robot! {
    /// Only a base.
    mod still {
        urdf = "tests/simulate/urdf/still.urdf",
        functions = [placements, jacobians_body, mass_matrix, coriolis_matrix, gravity_torque, inverse_dynamics_derivatives, torque_regressor,
            kinetic_energy, placement_derivatives, integrate, integrate_derivatives, difference_derivatives],
    }
}

/// For matrices without rows, generated code agrees with the library: empty results, and no panic.
#[test]
fn a_generated_robot_without_a_joint_answers_as_the_library_does() {
    let (model, mut answered) = (model("still", Base::Fixed), 0);
    for row in functions::<f64>() {
        let arguments: Vec<Vec<f64>> = row.takes.iter().map(|argument| vec![0.5; argument.len(model.shape())]).collect();
        let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
        let [mut found, mut expected] = [(); 2].map(|()| vec![f64::NAN; row.len(model.shape())]);
        match still::Robot.call(row.id, &mut (), &arguments, &mut found) {
            Err(error) => assert!(matches!(error, FunctionError::NotGenerated { .. }), "{error}"),
            Ok(()) => {
                model.call(row.id, &mut Workspace::new(&model), &arguments, &mut expected).unwrap();
                assert_eq!(found, expected, "{}", row.name);
                answered += 1;
            }
        }
    }
    assert_eq!(answered, 12);
}

/// A longest step that time cannot resolve, and a shortest one that is too long for the tolerances.
#[test]
fn bounds_of_steps_are_kept_or_told() {
    let far = Settings { start: 1.7e9, end: 1.7e9 + 0.01, max_step: 1e-6, ..to(IntegratorId::dopri5, 1.0, 1e-6) };
    let told = Simulation::new(&slider(), far).map(drop).unwrap_err().to_string();
    assert_eq!(told, "max_step = 1e-6: at least 6.0e-6 s, sixteen units of rounding of the time");
    let some = Settings { min_step: 0.3, first_step: Some(0.3), output: Output::Steps, ..to(IntegratorId::dopri5, 0.5, 1e-6) };
    let motion = Simulation::new(&slider(), some).unwrap().run(&[0.0], &[0.0], &mut NoTorque, &mut []).unwrap();
    assert!(motion.counts.largest_step >= 0.3 && motion.t.len() <= 3, "{:?}", motion.t);
    let mut jerk = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = 1e6 * (1e3 * t).sin();
    let some = Settings { min_step: 0.1, ..to(IntegratorId::dopri5, 0.5, 1e-9) };
    let told = Simulation::new(&slider(), some).unwrap().run(&[0.0], &[0.0], &mut jerk, &mut []).map(drop).unwrap_err().to_string();
    assert!(told.contains("shorter than min_step = 1.000e-1 s"), "{told}");
}

#[test]
fn a_period_that_is_no_length_of_time_is_refused() {
    for period in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let told = Hold::new(NoTorque, period).map(drop).unwrap_err().to_string();
        assert!(told.ends_with("cannot be used; it should be a finite number above 0, s"), "{told}");
    }
}

/// Samples that are not distinct in time, or that are more than the allowed steps of a motion.
#[test]
fn a_period_that_a_motion_cannot_have_is_an_error_that_says_which_it_can() {
    let refused = |start: f64, period: f64| {
        let settings = Settings { start, end: start + 1.0, max_steps: 1000, ..to(IntegratorId::dopri5, 1.0, 1e-6) };
        let mut drive = Hold::new(NoTorque, period).unwrap();
        Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut drive, &mut []).map(drop).map_err(|e| e.to_string())
    };
    let told = |right: &str| Err(right.to_owned());
    assert_eq!(
        refused(0.0, 1e-20),
        told("period = 1e-20 cannot be used; it should be at least 3.6e-15 s, sixteen units of rounding of the time")
    );
    assert_eq!(
        refused(0.0, 1e-4),
        told("period = 0.0001 cannot be used; it should be at least 0.001 s, for no more samples than max_steps = 1000")
    );
    assert_eq!(
        refused(1e9, 1e-8),
        told("period = 1e-8 cannot be used; it should be at least 3.6e-6 s, sixteen units of rounding of the time")
    );
    assert_eq!(refused(0.0, 2e-3), Ok(()));
    // Just as many samples as there may be steps.
    let just = Settings { max_steps: 10, ..stepping(IntegratorId::rk4, 1.0, 0.1) };
    let motion = Simulation::new(&slider(), just).unwrap().run(&[0.0], &[0.0], &mut Hold::new(NoTorque, 0.1).unwrap(), &mut []);
    assert_eq!(motion.map(|motion| motion.counts.steps), Ok(10));
}

#[test]
fn what_is_wrong_with_a_state_its_events_and_its_torques_is_said_at_once() {
    let mut simulation = Simulation::new(&chain::Robot, to(IntegratorId::dopri5, 1.0, 1e-6)).unwrap();
    let mut events = [Event::limit("end", 7, 2.0, -1.0), Event::stick_slip("slide", 3, 0.1)];
    let mut torques = Constant::new(vec![1.0; 2]);
    let error = simulation.run(&[0.0, f64::NAN, 0.0], &[0.0, 0.0, f64::INFINITY], &mut torques, &mut events).unwrap_err();
    let names: Vec<_> = (0..3).map(|k| chain::Robot.joint_of(k).unwrap().to_owned()).collect();
    let expected = [
        format!("q[1] (joint `{}`) = NaN is not finite", names[1]),
        format!("v[2] (joint `{}`) = inf is not finite", names[2]),
        "the event `end` is about q[7], and q has 3 numbers".into(),
        "the event `end` has the bounds 2 and -1; the first should be less than the second".into(),
        "the event `slide` is about v[3], and v has 3 numbers".into(),
        "tau has 2 numbers, expected 3".into(),
    ];
    assert_eq!(error.to_string().lines().collect::<Vec<_>>(), expected);
}

/// A norm with a rounding error of four digits is accepted, and normalised.
#[test]
fn quaternions_have_norm_one_to_four_digits() {
    let started = |w: f64| free(&handle::Robot, &to(IntegratorId::dopri5, 0.1, 1e-6), &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, w], &[0.0; 6]);
    for w in [1.01, 0.99, 0.0] {
        let told = started(w).map(drop).unwrap_err();
        let SimulateError::State(wrong) = &told else { panic!("{told}") };
        assert!(matches!(wrong[..], [StateError::Quaternion { index: 3, norm, .. }] if norm == w), "{told}");
    }
    assert!([1.0005, 0.9995].into_iter().all(|w| started(w).unwrap().q_at(1)[6] == 1.0));
}

/// A coordinate's joint is found after quaternions too.
#[test]
fn coordinates_are_told_with_their_joints() {
    let robot = model("satellite", Base::Floating);
    for (k, joint) in robot.joints().iter().enumerate() {
        for index in joint.q.0..joint.q.0 + joint.q.1 {
            let mut q = [0.3, -0.2, 0.5, 0.5, -0.5, 0.5, 0.5, 0.7, 0.1, 0.7, -0.1, 0.7];
            q[index] = f64::NAN;
            let error = free(&robot, &to(IntegratorId::dopri5, 0.1, 1e-6), &q, &[0.0; 10]).unwrap_err();
            assert_eq!(error.to_string(), format!("q[{index}] (joint `{}`) = NaN is not finite", joint.name), "{k}");
        }
    }
}

/// Links without mass after the elbow: no acceleration is a number, and the cause is the last
/// joint, which moves no mass.
#[test]
fn a_joint_that_moves_no_mass_is_named() {
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/><origin xyz='0.5 0 0'/><axis xyz='0 0 1'/></joint>"
        )
    };
    let upper =
        "<link name='upper'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>";
    let urdf = format!(
        "<robot name='arm'><link name='base'/>{upper}<link name='lower'/>{}{}</robot>",
        joint("shoulder", "base", "upper"),
        joint("elbow", "upper", "lower")
    );
    let robot = articulated::load_bytes("arm", urdf.as_bytes(), Base::Fixed).unwrap();
    for row in integrators() {
        let settings = if row.adaptive { to(row.id, 1.0, 1e-6) } else { stepping(row.id, 1.0, 0.01) };
        let error = free(&robot, &settings, &[0.1, 0.2], &[0.5, 0.5]).unwrap_err();
        let SimulateError::NoMass { t: 0.0, cause } = &error else { panic!("{}: {error}", row.name) };
        assert_eq!((cause.joint.as_str(), cause.freedom), ("elbow", 1), "{}", row.name);
        assert!(error.to_string().starts_with("at t = 0 s the mass matrix is singular at v[1] (joint `elbow`): "), "{error}");
    }
}

/// Torques that are finite and no motion: all accelerations that are not finite are reported, with
/// their joints.
#[test]
fn accelerations_that_are_not_finite_are_all_told() {
    let robot = model("chain", Base::Fixed);
    let mut huge = |_: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau.fill(f64::MAX);
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 1.0, 1e-6)).unwrap();
    let error = simulation.run(&[0.4, -0.7, 0.5], &[0.0; 3], &mut huge, &mut []).unwrap_err();
    let SimulateError::NotFinite { t: 0.0, what: "acceleration", index, names } = &error else { panic!("{error}") };
    let expected: Vec<_> = index.iter().map(|&k| robot.joint_of(k).to_owned()).collect();
    assert!(index.len() > 1 && *names == expected, "{error}");
    let told = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    assert!(error.to_string().ends_with(&format!(" (joints {told}) are not finite")), "{error}");
}

#[test]
fn what_is_wrong_with_a_controller_is_called_as_its_arguments_are() {
    let all = |error: Option<SimulateError>| error.unwrap().to_string();
    let error = Pd::new(&chain::Robot, vec![0.0; 2], vec![1.0; 4], vec![1.0, f64::NAN, 1.0]).err();
    let joint = chain::Robot.joint_of(1).unwrap();
    let expected = format!(
        "target has 2 numbers, expected 3\nproportional gains has 4 numbers, expected 3\nderivative gains[1] (joint `{joint}`) = NaN is not finite"
    );
    assert_eq!(all(error), expected);
    let error = Pd::new(&handle::Robot, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], vec![1.0; 6], vec![1.0; 6]).err();
    assert_eq!(all(error), "target[3..7] (joint `__floating_base__`) is a quaternion of norm 2; it should be 1");
    assert_eq!(all(Hold::new(NoTorque, -1.0).err()), "period = -1 cannot be used; it should be a finite number above 0, s");
}

/// A step of a joint that turns freely has an end: its coordinates repeat after a whole turn, and
/// Cayley's map does not reach half of one.
#[test]
fn a_step_that_turns_too_far_says_by_how_much() {
    let robot = model("handle", Base::Floating).with_gravity([0.0; 3]);
    let spin = |integrator, rate: f64| {
        let mut settings = stepping(integrator, 1.0, 0.1);
        settings.stiffness = Stiffness::Note;
        free(&robot, &settings, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[0.0, 0.0, rate, 0.0, 0.0, 0.0])
    };
    let by_charts = [IntegratorId::rk4, IntegratorId::rodas4, IntegratorId::semi_implicit_euler].map(|id| (id, TAU));
    for (integrator, bound) in by_charts.into_iter().chain([(IntegratorId::lie_midpoint, PI)]) {
        let error = spin(integrator, 11.0 * bound).unwrap_err();
        let SimulateError::Turn { step, turn, most, .. } = error else { panic!("{integrator}: {error}") };
        assert!((step - 0.1).abs() < 1e-12 && (turn - 1.1 * bound).abs() < 1e-9 && most == bound, "{integrator}: {error}");
        assert!(error.to_string().contains(" rad (joint `__floating_base__`): a step can turn by "), "{error}");
        assert!(spin(integrator, 2.0 * bound).is_ok(), "{integrator}");
    }
}

/// Invalid numbers: a period, a ball's speed; a kink that is not in the future does not stop the
/// motion.
#[test]
fn what_a_controller_or_a_ball_says_is_looked_at() {
    struct Odd(Option<f64>, f64);
    impl Control for Odd {
        fn torques(&mut self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) {}
        fn period(&self) -> Option<f64> {
            self.0
        }
        fn next_kink(&self, _: f64) -> f64 {
            self.1
        }
    }
    let robot = slider();
    let run = |mut odd| Simulation::new(&robot, to(IntegratorId::dopri5, 1.0, 1e-6)).unwrap().run(&[0.0], &[1.0], &mut odd, &mut []);
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = run(Odd(Some(period), f64::INFINITY)).unwrap_err();
        assert!(error.to_string().starts_with("period = "), "{error}");
    }
    for kink in [0.0, -1.0, f64::NAN] {
        assert!(run(Odd(None, kink)).unwrap().counts.steps < 100);
    }
    let wide = model("planar", Base::Fixed);
    let mut blow = Impact::new(&wide, at(0, [0.0; 3], [1.0, 0.0, 0.0]), 1.0, 1.0).unwrap();
    assert!(blow.strike(&[0.1; 2], &mut [0.0; 2], f64::NAN).is_err());
}

/// 1e6 rad/s for 10 s in steps that resolve it: more than a hundred times the steps that are
/// allowed.
#[test]
fn a_motion_that_makes_no_progress_is_ended_early_and_names_the_joint() {
    let robot = slider();
    let mut spring = |_: f64, q: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = -1e12 * q[0];
    let settings = Settings { max_steps: 20_000, end: 10.0, output: Output::Ends, ..Settings::default() };
    let mut simulation = Simulation::new(&robot, settings).unwrap();
    let mut recording = simulation.recording();
    let error = simulation.run_into(&[1e-3], &[0.0], &mut spring, &mut [], &mut recording, &mut |_, _| true).unwrap_err();
    let SimulateError::NoProgress { step, left, ref limiting, .. } = error else { panic!("{error}") };
    assert!(step > 1e-8 && step < 1e-5 && left > 2e6 && left * step > 9.0 && left * step < 11.0, "{error}");
    assert!(limiting.as_ref().is_some_and(|(_, index, joint)| *index == 0 && joint.as_deref() == Some("joint")), "{error}");
    assert!(recording.counts.steps < 14_000 && error.to_string().contains("(joint `joint`)"), "{error}");
    // One that ends within its steps goes on.
    let settings = Settings { max_steps: 20_000, end: 1e-3, output: Output::Ends, ..Settings::default() };
    Simulation::new(&robot, settings).unwrap().run(&[1e-3], &[0.0], &mut spring, &mut []).unwrap();
}
