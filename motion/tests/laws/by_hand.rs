//! Scenes against simulations that are put together by hand.

use articulated::Dynamics;
use articulated::simulate::{Constant, Control, Dependence, Event, IntegratorId, Output, Settings, Simulation, TorqueTable};
use articulated_core::algorithm::Workspace;

use articulated_core::control::Interpolation;
use articulated_motion::{Detectors, Drive, InitialState};
use articulated_scene::{Aim, Controller, Series};

use super::{ARM, CART, moved, session};

#[test]
fn a_scene_moves_as_a_simulation_put_together_by_hand_to_the_bit() {
    let scene = "
        gravity = [0.0, 0.0, -3.7]
        initial = { q = { shoulder = 0.7, wrist = [0.0, 0.6, 0.0, 0.8] }, v = { elbow = -1.5, wrist = [0.1, 0.2, 0.3] } }
        control = { kind = 'pd', target = { shoulder = -0.2, elbow = 0.1 }, kp = { shoulder = 40.0, elbow = 15.0, wrist = 2.0 }, kd = 0.9, torque = { elbow = 0.25 } }
        simulation = { start = 0.5, end = 1.75, integrator = 'dop853', rtol = 1e-8, atol = 1e-10, max_step = 0.05, output = 0.125 }";
    let session = session(scene, ARM);
    let found = moved(&session).recording;

    let settings = Settings {
        integrator: IntegratorId::dop853,
        start: 0.5,
        end: 1.75,
        rtol: 1e-8,
        atol: 1e-10,
        max_step: 0.05,
        output: Output::Every(0.125),
        ..Settings::default()
    };
    let robot = articulated::load_bytes("arm.urdf", ARM.as_bytes(), articulated::Base::Fixed).unwrap().with_gravity([0.0, 0.0, -3.7]);
    let (target, kp) = ([-0.2, 0.1, 0.0, 0.0, 0.0, 1.0], [40.0, 15.0, 2.0, 2.0, 2.0]);
    let (torque, kd) = ([0.0, 0.25, 0.0, 0.0, 0.0], 0.9);
    let (mut ws, mut error) = (Workspace::new(&robot), vec![0.0; 5]);
    let mut control = |_: f64, q: &[f64], v: &[f64], tau: &mut [f64]| {
        robot.difference(&mut ws, q, &target, &mut error).unwrap();
        (0..5).for_each(|i| tau[i] = kp[i] * error[i] + kd * (0.0 - v[i]) + torque[i]);
    };
    let (q, v) = ([0.7, 0.0, 0.0, 0.6, 0.0, 0.8], [0.0, -1.5, 0.1, 0.2, 0.3]);
    // A scene requests the balance of energy.
    let mut simulation = Simulation::new(&robot, settings).unwrap().with_energy_balance();
    let expected = simulation.run(&q, &v, &mut control, &mut []).unwrap();

    assert!(expected.len() == 11 && (expected.q_at(0)[0] - expected.q_at(10)[0]).abs() > 0.1);
    assert_eq!(found, expected);
}

#[test]
fn given_torques_and_tables_are_those_of_the_library() {
    let settings = || Settings { end: 1.5, ..Settings::default() };
    let run = |control: &mut dyn articulated::simulate::Control| {
        let robot = articulated::load_bytes("cart.urdf", CART.as_bytes(), articulated::Base::Fixed).unwrap();
        let mut simulation = Simulation::new(&robot, settings()).unwrap().with_energy_balance();
        simulation.run(&[0.0], &[0.0], control, &mut []).unwrap()
    };
    let found = moved(&session("control = { kind = 'torque', torque = 0.75 }\nsimulation = { end = 1.5 }", CART)).recording;
    assert_eq!(found, run(&mut Constant::new(vec![0.75])));
    let rows = "columns = ['slide'], rows = [[0.0, 1.0], [0.3, -2.0], [1.0, 0.5]]";
    let found = moved(&session(&format!("control = {{ kind = 'table', {rows} }}\nsimulation = {{ end = 1.5 }}"), CART)).recording;
    let mut table = TorqueTable::new(vec![0.0, 0.3, 1.0], &[1.0, -2.0, 0.5], 1).unwrap();
    let expected = run(&mut table);
    let far = found.q.iter().zip(&expected.q).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(found.t == expected.t && far < 1e-14, "{far:e}");
}

#[test]
fn a_table_in_a_file_of_the_folder_is_one_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("way.csv"), "t,slide\n0,0.1\n0.5,0.4\n1,-0.2\n").unwrap();
    let scene = |source: &str| format!("control = {{ kind = 'pd', kp = 30, kd = 4, {source} }}\nsimulation = {{ end = 1.0 }}");
    let of_file = session(&scene("file = 'way.csv'"), CART).in_folder(folder.path());
    let inline = session(&scene("columns = ['slide'], rows = [[0.0, 0.1], [0.5, 0.4], [1.0, -0.2]]"), CART);
    let (found, expected) = (moved(&of_file).recording, moved(&inline).recording);
    assert_eq!(found, expected);
    // At the first row: kp (0.1 − 0) + kd (0.3/0.5 − 0).
    assert!((found.tau_at(0)[0] - (30.0 * 0.1 + 4.0 * 0.6)).abs() < 1e-12, "{:?}", found.tau_at(0));
}

#[test]
fn a_table_out_of_order_is_refused() {
    let session = session("simulation = { end = 1.0 }", CART);
    let mut motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
    let mut told = |times: &[f64], rows: &[f64]| {
        let series = Series { times: times.to_vec(), rows: rows.iter().map(|x| vec![*x]).collect(), between: Interpolation::Linear };
        let initial = InitialState { controller: Controller::Table(series), ..session.initial_state().unwrap() };
        motion.run(&initial, &mut |_, _| true).map(drop).map_err(|e| e.to_string())
    };
    assert_eq!(told(&[0.0, 1.0], &[1.0, 2.0]), Ok(()));
    for (times, rows, wrong) in [
        (&[1.0, 0.5][..], &[1.0, 2.0][..], "control.rows: row 1 of the table: t = 0.5 s is not after 1 s"),
        (&[1.0, 1.0], &[1.0, 2.0], "control.rows: row 1 of the table: t = 1 s is not after 1 s"),
        (&[0.0, f64::INFINITY], &[1.0, 2.0], "control.rows: row 1 of the table has a number that is not finite"),
        (&[f64::NAN, 1.0], &[1.0, 2.0], "control.rows: row 0 of the table has a number that is not finite"),
        (&[0.0, 1.0], &[1.0, f64::NAN], "control.rows: row 1 of the table has a number that is not finite"),
        (&[], &[], "control.rows: the table has no row"),
    ] {
        let told = told(times, rows).unwrap_err();
        assert!(told.contains(wrong), "{told}");
    }
}

/// At a row the next kink is the next row, and after the last there is none.
#[test]
fn every_row_of_a_table_is_a_kink() {
    let session = session("", CART);
    let series = Series { times: vec![0.25, 0.5, 1.0], rows: vec![vec![0.0], vec![1.0], vec![0.5]], between: Interpolation::Linear };
    let one = || vec![1.0];
    for controller in
        [Controller::Table(series.clone()), Controller::Pd { target: Aim::Moving(series), kp: one(), kd: one(), torque: one() }]
    {
        let drive = Drive::new(&session.model, &controller, None).unwrap();
        let kinks = [-1.0, 0.0, 0.25, 0.3, 0.5, 0.75, 1.0, 2.0].map(|t| drive.next_kink(t));
        assert_eq!(kinks, [0.25, 0.25, 0.5, 0.5, 1.0, 1.0, f64::INFINITY, f64::INFINITY]);
    }
}

#[test]
fn torques_depend_on_what_their_kind_says_and_on_nothing_while_they_are_held() {
    let session = session("", CART);
    let (one, series) =
        (|| vec![1.0], || Series { times: vec![0.0, 1.0], rows: vec![vec![0.0], vec![1.0]], between: Interpolation::Linear });
    let pd = |target| Controller::Pd { target, kp: one(), kd: one(), torque: one() };
    for (controller, time, state) in [
        (Controller::None, false, false),
        (Controller::Torque(one()), false, false),
        (Controller::Table(series()), true, false),
        (pd(Aim::Still(one())), false, true),
        (pd(Aim::Moving(series())), true, true),
    ] {
        let of = |period| Drive::new(&session.model, &controller, period).unwrap().depends_on();
        assert_eq!(of(None), Dependence { time, state }, "{controller:?}");
        assert_eq!(of(Some(0.1)), Dependence { time: false, state: false }, "{controller:?}");
    }
}

#[test]
fn a_sampled_controller_holds_its_torques() {
    let scene = "control = { kind = 'pd', target = { slide = 0.4 }, kp = 30, period = 0.1 }\nsimulation = { end = 0.3, output = 0.05 }";
    let r = moved(&session(scene, CART)).recording;
    // The record at a sample is of the torques before it.
    assert_eq!(r.tau[..3], [12.0; 3]);
    assert!(r.tau[3] < 12.0 && r.tau[3] == r.tau[4] && r.tau[5] < r.tau[4], "{:?}", r.tau);
}

/// The law of the scene's control by hand, with the same sampling; its events and its end are the
/// scene's.
#[test]
fn a_control_of_ones_own_moves_the_scene() {
    let scene =
        |control: &str| format!("{control}\ninitial = {{ v = {{ slide = 0.5 }} }}\nsimulation = {{ end = 1.0, events = ['limits'] }}");
    let of_scene = session(&scene("control = { kind = 'pd', target = { slide = 1.5 }, kp = 30, kd = 2 }"), CART);
    let without = session(&scene(""), CART);
    let mut law = |_: f64, q: &[f64], v: &[f64], tau: &mut [f64]| tau[0] = 30.0 * (1.5 - q[0]) + 2.0 * (0.0 - v[0]);
    let own = without.run_with(&without.model, &without.frame_names(), &mut law).unwrap();
    let expected = moved(&of_scene);
    assert_eq!((&own.recording, super::words(&own)), (&expected.recording, super::words(&expected)));
    assert_eq!(super::words(&own)[0], "slide reaches its upper limit");
    // It replaces the scene's control.
    let instead =
        of_scene.run_with(&of_scene.model, &of_scene.frame_names(), &mut |_: f64, _: &[f64], _: &[f64], _: &mut [f64]| {}).unwrap();
    assert!(instead.recording.tau.iter().all(|tau| *tau == 0.0));
}

/// Drive and detectors also serve a user's own simulation, which may have more events.
#[test]
fn the_parts_put_together_move_as_the_whole() {
    let session = session(include_str!("arm.toml").replace("restitution", "stop = true\nrestitution").as_str(), ARM);
    let whole = moved(&session);
    let (robot, settings) = (&session.model, session.settings().unwrap());
    let initial = session.initial_state().unwrap();
    let mut drive = Drive::new(robot, &initial.controller, None).unwrap();
    let mut detectors = Detectors::new(&session, robot, &session.frame_names()).unwrap();
    detectors.events.push(Event::new("half way", |_, q, _| q[0] - 0.5));
    let mut simulation = Simulation::new(robot, settings).unwrap();
    let (mut recording, over) = (simulation.recording(), detectors.over());
    simulation.run_into(&initial.q, &initial.v, &mut drive, &mut detectors.events, &mut recording, &mut |_, _| !over()).unwrap();
    assert!(recording.events.iter().map(|hit| detectors.occurrence(hit)).all(|h| h.about.is_none() == (h.what == "half way")));
    let words: Vec<String> = recording.events.iter().map(|hit| detectors.occurrence(hit).what).collect();
    assert!(over() && detectors.ball_energy() == whole.ball && words.iter().any(|what| what == "half way"), "{words:?}");
    let scenes: Vec<&str> = words.iter().map(String::as_str).filter(|what| *what != "half way").collect();
    assert_eq!((scenes, &recording.q, &recording.v), (super::words(&whole), &whole.recording.q, &whole.recording.v));
}
