//! The end of a motion, and its records.

use std::cell::Cell;

use articulated::simulate::{Action, Ended, Event, IntegratorId, NoTorque, Output, Settings, SimulateError, Simulation, integrators};

use crate::robots::{any, chain, one_joint, slider, stepping, to};

/// A recording belongs to the robot of its motion, whatever it contained before.
#[test]
fn a_recording_may_be_taken_from_another_robot() {
    let (robot, settings) = (one_joint("prismatic", 0.0), to(IntegratorId::dopri5, 0.1, 1e-6));
    let mut simulation = Simulation::new(&robot, settings.clone()).unwrap();
    let alone = simulation.run(&[0.2], &[0.1], &mut NoTorque, &mut []).unwrap();
    let other = Simulation::new(&chain::Robot, settings).unwrap().run(&[0.1; 3], &[0.0; 3], &mut NoTorque, &mut []).unwrap();
    for mut recording in [articulated::simulate::Recording::default(), other] {
        simulation.run_into(&[0.2], &[0.1], &mut NoTorque, &mut [], &mut recording, &mut |_, _| true).unwrap();
        assert_eq!(recording, alone);
    }
}

/// A motion that stops at a time of output has one record of it.
#[test]
fn a_stop_at_a_time_of_output_is_recorded_once() {
    let still = one_joint("prismatic", 0.0).with_gravity([0.0; 3]);
    for k in 1..20 {
        let mut stop = [Event::new("stop", move |_, q: &[f64], _: &[f64]| q[0] - 0.1 * f64::from(k)).action(Action::Stop)];
        let settings = Settings { output: Output::Every(0.1), ..to(IntegratorId::dopri5, 2.0, 1e-9) };
        let motion = Simulation::new(&still, settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut stop).unwrap();
        assert!(motion.t.windows(2).all(|w| w[1] > w[0] + 0.05) && motion.t.len() == k as usize + 1, "{k}: {:?}", motion.t);
    }
}

/// Where a map and a stop come at a time of output, the state that the map made is the last record,
/// and no record is earlier than one before it.
#[test]
fn what_a_map_made_before_a_stop_is_recorded() {
    let robot = slider();
    let now = || Event::new("now", |t: f64, _: &[f64], _: &[f64]| t - 0.3);
    for (row, output) in integrators().iter().flat_map(|row| [Output::Every(0.1), Output::Steps, Output::Ends].map(|output| (row, output)))
    {
        let settings = Settings { output, ..any(row.id, 0.5) };
        let map = now().action(Action::Map(Box::new(|_, _, v| {
            v[0] += 1.0;
            Ok(None)
        })));
        let mut events = [map, now().action(Action::Stop)];
        let motion = Simulation::new(&robot, settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut events).unwrap();
        let (last, name) = (motion.len() - 1, row.name);
        assert_eq!((motion.ended, motion.events.len()), (Ended::ByEvent(1), 2), "{name}");
        assert_eq!((motion.v_at(last)[0], motion.v_at(last - 1)[0]), (2.0, 1.0), "{name}: {:?} {:?}", motion.t, motion.v);
        assert!(motion.t.windows(2).all(|w| w[0] <= w[1]) && (motion.t[last] - 0.3).abs() < 1e-12, "{name}: {:?}", motion.t);
        assert_eq!(motion.v.iter().filter(|v| **v == 2.0).count(), 1, "{name}: {:?}", motion.v);
    }
}

#[test]
fn of_given_times_no_other_is_recorded_but_the_start() {
    for row in integrators() {
        for (times, expected) in [(vec![0.25], vec![0.0, 0.25]), (vec![0.25, 1.0], vec![0.0, 0.25, 1.0]), (vec![], vec![0.0])] {
            let settings = Settings { output: Output::At(times), ..any(row.id, 1.0) };
            let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut []).unwrap();
            assert_eq!((motion.t, motion.ended), (expected, Ended::AtEnd), "{}", row.name);
        }
    }
}

/// Steps that are rejected count as those that are made, from the first to the last.
#[test]
fn a_motion_has_no_more_steps_than_it_may() {
    let mut jerk = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = if t > 0.3 { 1e3 * (50.0 * t).sin() } else { 0.0 };
    let mut rejected = 0;
    for max_steps in 1..40 {
        let robot = slider();
        let mut simulation = Simulation::new(&robot, Settings { max_steps, ..to(IntegratorId::dopri5, 2.0, 1e-9) }).unwrap();
        let mut recording = simulation.recording();
        let error = simulation.run_into(&[0.0], &[1.0], &mut jerk, &mut [], &mut recording, &mut |_, _| true).unwrap_err();
        assert!(matches!(error, SimulateError::TooManySteps { steps, .. } if steps == max_steps), "{error}");
        assert_eq!(recording.counts.steps + recording.counts.rejected, max_steps);
        rejected += recording.counts.rejected;
    }
    assert!(rejected > 40, "{rejected}");
}

#[test]
fn one_who_watches_is_told_of_every_step() {
    let robot = slider();
    let stop = |at: f64| Event::new("stop", move |t: f64, _: &[f64], _: &[f64]| t - at).action(Action::Stop);
    for (at, expected) in [(2.0, 4), (0.6, 3)] {
        let mut simulation = Simulation::new(&robot, stepping(IntegratorId::rk4, 1.0, 0.25)).unwrap();
        let (mut recording, mut told) = (simulation.recording(), Vec::new());
        let mut observer = |_: f64, counts: &articulated::simulate::Counts| {
            told.push(counts.steps);
            true
        };
        simulation.run_into(&[0.0], &[1.0], &mut NoTorque, &mut [stop(at)], &mut recording, &mut observer).unwrap();
        assert_eq!(told, (1..=expected).collect::<Vec<u64>>());
        assert_eq!(recording.counts.steps, expected);
    }
}

#[test]
fn one_who_watches_can_end_it() {
    let robot = one_joint("prismatic", 0.0);
    let mut simulation = Simulation::new(&robot, stepping(IntegratorId::rk4, 1.0, 0.01)).unwrap();
    let (mut recording, calls) = (simulation.recording(), Cell::new(0));
    let mut observer = |t: f64, _: &articulated::simulate::Counts| {
        calls.set(calls.get() + 1);
        t < 0.495
    };
    simulation.run_into(&[0.0], &[0.0], &mut NoTorque, &mut [], &mut recording, &mut observer).unwrap();
    assert_eq!((recording.ended, recording.counts.steps, calls.get()), (Ended::ByObserver, 50, 50));
}

/// Events at the end of the motion have happened: the state after them is recorded too, and the
/// observer is called.
#[test]
fn a_map_at_the_end_is_part_of_the_motion() {
    let robot = slider();
    let settings = Settings { output: Output::Every(0.25), ..stepping(IntegratorId::semi_implicit_euler, 0.5, 0.25) };
    for goes_on in [true, false] {
        let stop = Event::new("wall", |_, q: &[f64], _| q[0] - 0.5).action(Action::Map(Box::new(|_, _, v| {
            v[0] = 0.0;
            Ok(None)
        })));
        let mut simulation = Simulation::new(&robot, settings.clone()).unwrap();
        let mut motion = simulation.recording();
        simulation.run_into(&[0.0], &[1.0], &mut NoTorque, &mut [stop], &mut motion, &mut |t, _| goes_on || t < 0.5).unwrap();
        assert_eq!((motion.t.as_slice(), motion.v.as_slice()), (&[0.0, 0.25, 0.5, 0.5][..], &[1.0, 1.0, 1.0, 0.0][..]));
        assert_eq!(motion.ended, if goes_on { Ended::AtEnd } else { Ended::ByObserver });
    }
}
