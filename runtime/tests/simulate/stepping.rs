//! Steps one by one, and quantities that are computed only on request.

use articulated::Dynamics;
use articulated::simulate::{
    Constant, Hold, IntegratorId, NoTorque, Output, Pd, Settings, SimulateError, Simulation, Stiffness, integrators,
};

use crate::robots::{any, chain, model, satellite, slider, stepping, to};

/// The same steps as those of a run, to the last bit: for every integrator, with a control that is
/// sampled or not.
#[test]
fn steps_one_by_one_are_those_of_a_run() {
    let robot = model("satellite", articulated::Base::Floating);
    let (q, v) = (satellite::NEUTRAL, [0.8, -0.5, 1.0, 0.3, -0.2, 0.5, 0.4, 0.1, -0.1, 0.1]);
    for row in integrators() {
        for sampled in [false, true] {
            let settings = Settings { output: Output::Steps, ..any(row.id, 0.3) };
            let gentle = || Pd::new(&robot, q.to_vec(), vec![0.3; 10], vec![0.2; 10]).unwrap();
            let (mut pd, mut hold) = (gentle(), Hold::new(gentle(), 0.07).unwrap());
            let control: &mut dyn articulated::simulate::Control = if sampled { &mut hold } else { &mut pd };
            let mut simulation = Simulation::new(&robot, settings).unwrap();
            let run = simulation.run(&q, &v, control, &mut []).unwrap();
            // A second motion of the same simulation begins anew.
            for _ in 0..2 {
                simulation.start(&q, &v).unwrap();
                let mut record = 0;
                loop {
                    assert_eq!(simulation.t(), run.t[record], "{}", row.name);
                    assert_eq!((simulation.q(), simulation.v()), (run.q_at(record), run.v_at(record)), "{} {}", row.name, run.t[record]);
                    if !simulation.step(control).unwrap() {
                        break;
                    }
                    record += 1;
                }
                assert!(record == run.len() - 1 && record > 2, "{}: {record} of {}", row.name, run.len());
                assert_eq!(simulation.counts().steps, run.counts.steps);
                assert!(!simulation.step(control).unwrap() && simulation.t() == 0.3);
            }
        }
    }
}

#[test]
fn before_a_start_the_robot_rests_at_its_neutral_configuration() {
    let robot = model("satellite", articulated::Base::Floating);
    let simulation = Simulation::new(&robot, to(IntegratorId::rk4, 1.0, 1e-6));
    assert!(matches!(simulation, Err(SimulateError::Settings(_))), "rk4 has no steps by tolerance");
    let simulation = Simulation::new(&robot, stepping(IntegratorId::rk4, 1.0, 0.1)).unwrap();
    assert_eq!((simulation.t(), simulation.q(), simulation.v()), (0.0, &satellite::NEUTRAL[..], &[0.0; 10][..]));
}

#[test]
fn a_state_or_a_control_that_does_not_fit_is_an_error() {
    let robot = slider();
    let mut simulation = Simulation::new(&robot, stepping(IntegratorId::rk4, 1.0, 0.1)).unwrap();
    let wrong = simulation.start(&[0.0, 1.0], &[f64::NAN]).unwrap_err();
    assert_eq!(wrong.to_string(), "q has 2 numbers, expected 1\nv[0] (joint `joint`) = NaN is not finite");
    simulation.start(&[0.0], &[0.0]).unwrap();
    let wrong = simulation.step(&mut Constant::new(vec![1.0; 2])).unwrap_err();
    assert_eq!(wrong.to_string(), "tau has 2 numbers, expected 1");
    // A torque that is not a number is named as in a run, and the state stays.
    let mut broken = |_: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = f64::NAN;
    let wrong = simulation.step(&mut broken).unwrap_err();
    assert!(wrong.to_string().contains("tau[0] (joint `joint`) is not finite"), "{wrong}");
    assert_eq!((simulation.t(), simulation.q()), (0.0, &[0.0][..]));
}

#[test]
fn work_and_the_balance_are_there_on_request_alone() {
    let motion = |requested: bool| {
        let simulation = Simulation::new(&chain::Robot, to(IntegratorId::dopri5, 0.2, 1e-8)).unwrap();
        let mut simulation = if requested { simulation.with_energy_balance() } else { simulation };
        simulation.run(&[0.3, -0.2, 0.5], &[0.1, 0.2, -0.3], &mut Constant::new(vec![1.0, -0.5, 0.2]), &mut []).unwrap()
    };
    let (without, with) = (motion(false), motion(true));
    assert_eq!((&without.q, &without.v, &without.kinetic, without.counts), (&with.q, &with.v, &with.kinetic, with.counts));
    assert!(without.work.is_empty() && without.dissipated.is_empty() && without.balance.is_none() && without.imbalance(1).is_none());
    assert!(with.work[1].abs() > 1e-3 && with.imbalance(1).is_some_and(|joules| joules.abs() < 1e-7) && with.balance.is_some());
}

/// A spring of 1e4 1/s², steps of 25 ms: rk4 is unstable beyond 2.8/100 s, semi-implicit Euler
/// beyond 2/100 s.
#[test]
fn stability_is_not_looked_for_where_it_is_ignored() {
    let robot = slider();
    let mut spring = |_: f64, q: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = -1e4 * q[0];
    let mut run = |stiffness| {
        let settings = Settings { stiffness, ..stepping(IntegratorId::semi_implicit_euler, 2.0, 0.025) };
        Simulation::new(&robot, settings).unwrap().run(&[1e-3], &[0.0], &mut spring, &mut [])
    };
    assert!(matches!(run(Stiffness::Refuse), Err(SimulateError::Unstable { .. })));
    let ignored = run(Stiffness::Ignore).unwrap();
    assert_eq!((ignored.counts.checks, ignored.counts.stiff_at), (0, None));
    assert!(ignored.q[1].abs() > 1e3, "{:?}", ignored.q);
}

/// Checks of stability every 16 steps become rare in a slow motion: at most every 256 steps.
#[test]
fn a_slow_motion_is_looked_at_seldom() {
    let settings = stepping(IntegratorId::rk4, 4.0, 1e-3);
    let mut simulation = Simulation::new(&chain::Robot, settings).unwrap();
    let counts = simulation.run(&[0.3, -0.2, 0.5], &[0.0; 3], &mut NoTorque, &mut []).unwrap().counts;
    assert!(counts.steps == 4000 && counts.checks > 30 && counts.checks < 400, "{counts:?}");
    assert_eq!(chain::Robot.shape().nv, 3);
}
