//! Events are found where they are, and no step misses one.

use articulated::effect::{Applied, EffectId};
use articulated::simulate::{
    Action, Direction, Ended, Event, Hit, IntegratorId, NoTorque, Output, Settings, SimulateError, Simulation, StateError, integrators,
};
use articulated::{Base, Origin, load_bytes};

use crate::robots::{any, at, chain, handle, model, one_joint, slider, stepping, to};

const G: f64 = 9.81;

/// A curve of third degree is exact for a fall, and so is every method but the first.
#[test]
fn a_falling_ball_bounces_when_it_must() {
    let robot = one_joint("prismatic", 0.0);
    let restitution = 0.8;
    for row in integrators().iter().filter(|row| row.order > 1) {
        let floor =
            Event::new("floor", |_, q: &[f64], _: &[f64]| q[0]).direction(Direction::Falling).action(Action::Map(Box::new(|_, _, v| {
                v[0] *= -restitution;
                Ok(Some(v[0]))
            })));
        let mut simulation = Simulation::new(&robot, any(row.id, 3.0)).unwrap();
        let motion = simulation.run(&[1.0], &[0.0], &mut NoTorque, &mut [floor]).unwrap();
        let (mut t, mut v) = ((2.0 / G).sqrt(), (2.0 * G).sqrt());
        assert!(motion.events.len() > 5, "{}: {}", row.name, motion.events.len());
        for hit in &motion.events {
            assert!((hit.t - t).abs() < 1e-11, "{}: {} s, not {t} s", row.name, hit.t);
            assert!((hit.value.unwrap() - restitution * v).abs() < 1e-10, "{}: {hit:?}", row.name);
            v *= restitution;
            t += 2.0 * v / G;
        }
    }
}

/// Each bounce leaves e² of the energy; at every time of output the balance includes it.
#[test]
fn what_a_map_takes_is_booked() {
    let (robot, restitution) = (one_joint("prismatic", 0.0), 0.8);
    for output in [Output::Every(0.05), Output::Steps] {
        let floor =
            Event::new("floor", |_, q: &[f64], _: &[f64]| q[0]).direction(Direction::Falling).action(Action::Map(Box::new(|_, _, v| {
                v[0] *= -restitution;
                Ok(None)
            })));
        let settings = Settings { output, ..to(IntegratorId::dopri5, 2.0, 1e-10) };
        let mut simulation = Simulation::new(&robot, settings).unwrap().with_energy_balance();
        let motion = simulation.run(&[1.0], &[0.0], &mut NoTorque, &mut [floor]).unwrap();
        let start = motion.energy(0).unwrap();
        assert!(motion.events.len() > 1 && start > 1.0, "{} events, {start} J", motion.events.len());
        for i in 0..motion.len() {
            let bounces = motion.events.iter().filter(|hit| hit.t <= motion.t[i]).count();
            let left = restitution.powi(2 * bounces as i32);
            let expected = start * (left - 1.0);
            assert!(
                (motion.from_events[i] - expected).abs() < 1e-9 * start,
                "{} s: {} J, not {expected} J",
                motion.t[i],
                motion.from_events[i]
            );
            assert!(motion.imbalance(i).unwrap().abs() < 1e-9 * start, "{} s: {:?} J", motion.t[i], motion.imbalance(i));
        }
    }
}

/// Of two that touch the floor together, both are recorded.
#[test]
fn what_happens_at_one_time_all_happens() {
    let text = r#"<robot name="two"><link name="base"/><link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <link name="b"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="x" type="prismatic"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/><limit lower="0" upper="9" effort="1" velocity="1"/></joint>
        <joint name="y" type="prismatic"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0" upper="9" effort="1" velocity="1"/></joint>
        </robot>"#;
    let robot = load_bytes("two", text.as_bytes(), Base::Fixed).unwrap();
    let mut bounces: Vec<Event> = (0..2)
        .map(|i| {
            let up = Action::Map(Box::new(move |_: f64, _: &mut [f64], v: &mut [f64]| {
                v[i] = -v[i];
                Ok(None)
            }));
            Event::limit(format!("floor {i}"), i, 0.0, f64::INFINITY).action(up)
        })
        .collect();
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 5.0, 1e-9)).unwrap();
    let motion = simulation.run(&[1.0, 1.0], &[0.0, 0.0], &mut NoTorque, &mut bounces).unwrap();
    // After (2k + 1) falls of √(2h/g).
    assert_eq!(motion.events.len(), 12);
    for (k, hit) in motion.events.iter().enumerate() {
        assert!(hit.event == k % 2 && (hit.t - (2 * (k / 2) + 1) as f64 * (2.0 / G).sqrt()).abs() < 1e-10, "{hit:?}");
    }
    assert!((motion.energy(1).unwrap() / motion.energy(0).unwrap() - 1.0).abs() < 1e-10);
}

/// A map may take the state away from the zero of its event, for example by winding a coordinate
/// back: then the event is on the side of its function. If a map leaves the state at the zero, as a
/// bounce does, the remainder of the search means nothing, however large.
#[test]
fn what_a_map_takes_away_from_a_zero_is_not_found_there_again() {
    let robot = one_joint("prismatic", 0.0);
    let still = robot.clone().with_gravity([0.0; 3]);
    for (direction, event_tolerance) in
        [(Direction::Either, 1e-12), (Direction::Rising, 1e-12), (Direction::Either, 1e-5), (Direction::Rising, 1e-5)]
    {
        let back = |_: f64, q: &mut [f64], _: &mut [f64]| {
            q[0] -= 1.0;
            Ok(None)
        };
        let wound = Event::new("wound", |_, q: &[f64], _: &[f64]| q[0] - 1.0).direction(direction).action(Action::Map(Box::new(back)));
        let settings = Settings { event_tolerance, ..to(IntegratorId::dopri5, 5.25, 1e-9) };
        let motion = Simulation::new(&still, settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut [wound]).unwrap();
        let near = |hit: &Hit, t: f64| hit.direction == Direction::Rising && (hit.t - t).abs() < 2.0 * event_tolerance;
        assert_eq!(motion.events.len(), 5, "{direction:?}: {:?}", motion.events);
        assert!(motion.events.iter().zip([1.0, 2.0, 3.0, 4.0, 5.0]).all(|(hit, t)| near(hit, t)), "{:?}", motion.events);
        assert!((motion.q[1] - 0.25).abs() < 1e-12, "{}", motion.q[1]);

        let up = |_: f64, _: &mut [f64], v: &mut [f64]| {
            v[0] = -v[0];
            Ok(None)
        };
        let direction = if direction == Direction::Either { direction } else { Direction::Falling };
        let floor = Event::new("floor", |_, q: &[f64], _: &[f64]| q[0]).direction(direction).action(Action::Map(Box::new(up)));
        let settings = Settings { event_tolerance, ..to(IntegratorId::dopri5, 5.0, 1e-9) };
        let motion = Simulation::new(&robot, settings).unwrap().run(&[1.0], &[0.0], &mut NoTorque, &mut [floor]).unwrap();
        assert_eq!(motion.events.len(), 6, "{direction:?}: {:?}", motion.events);
        assert!(motion.events.iter().all(|hit| hit.direction == Direction::Falling), "{:?}", motion.events);
    }
}

#[test]
fn a_ball_that_bounces_ever_faster_is_an_error_that_names_the_event() {
    let robot = one_joint("prismatic", 0.0);
    let floor =
        Event::new("floor", |_, q: &[f64], _: &[f64]| q[0]).direction(Direction::Falling).action(Action::Map(Box::new(|_, _, v| {
            v[0] *= -0.5;
            Ok(None)
        })));
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 5.0, 1e-9)).unwrap();
    let error = simulation.run(&[1.0], &[0.0], &mut NoTorque, &mut [floor]).unwrap_err();
    // Σ of the flights: √(2h/g)·(1 + e)/(1 − e).
    let end = (2.0 / G).sqrt() * 3.0;
    let SimulateError::Chattering { t, event } = &error else { panic!("{error}") };
    assert!((t - end).abs() < 1e-9 && event == "floor", "{t} {end}");
}

/// A map that leaves a ball at rest on the floor, which does not hold it, and a ball that lies
/// there from the start: both are noticed when they fall through.
#[test]
fn what_lies_at_zero_and_goes_on_is_an_event() {
    let robot = one_joint("prismatic", 0.0);
    let floor = |restitution: f64| {
        Event::new("floor", |_, q: &[f64], _: &[f64]| q[0]).direction(Direction::Falling).action(Action::Map(Box::new(move |_, _, v| {
            v[0] *= -restitution;
            Ok(None)
        })))
    };
    let fall = |event: Event, height: f64| {
        let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 5.0, 1e-9)).unwrap();
        simulation.run(&[height], &[0.0], &mut NoTorque, &mut [event]).map(|motion| motion.events).map_err(|e| e.to_string())
    };
    for event in [floor(0.0), floor(1e-9)] {
        let told = fall(event, 1.0).unwrap_err();
        assert!(told.starts_with("at t = 0.4515") && told.contains("`floor` happens again and again"), "{told}");
    }
    // The start of a motion on a section is not a return to it, unless the event is declared as
    // arriving there.
    let section = || Event::new("section", |_, q: &[f64], _: &[f64]| q[0]).direction(Direction::Falling);
    assert_eq!(fall(section(), 0.0).unwrap(), []);
    let arrived = fall(section().arriving(Direction::Falling), 0.0).unwrap();
    assert!(arrived.len() == 1 && arrived[0].t < 1e-9 && arrived[0].direction == Direction::Falling, "{arrived:?}");
    let limit = fall(Event::limit("limit", 0, 0.0, f64::INFINITY).action(Action::Stop), 0.0).unwrap();
    assert!(limit.len() == 1 && limit[0].t < 1e-9, "{limit:?}");
    let ball = model("ball", Base::Fixed);
    let touch = Event::contact("touch", &ball, at(1, [0.0; 3], [0.0, 0.0, 1e-200]), 0.25, 0.0).unwrap();
    let motion =
        Simulation::new(&ball, to(IntegratorId::dopri5, 1.0, 1e-9)).unwrap().run(&[0.25], &[0.0], &mut NoTorque, &mut [touch]).unwrap();
    // Where it is known to 1e-17 m: ½ g t² is as much.
    assert!(motion.events.len() == 1 && motion.events[0].t < 1e-8, "{:?}", motion.events);
    assert!(motion.counts.smallest_step > 0.0, "{:?}", motion.counts);
}

/// The ball is above for 2√(2·δ/g), far less than a step, and both times are found.
#[test]
fn a_pair_of_zeros_within_a_step_is_not_stepped_over() {
    let robot = one_joint("prismatic", 0.0);
    let (speed, delta) = (5.0_f64, 1e-5);
    let bound = speed * speed / (2.0 * G) - delta;
    for id in [IntegratorId::dop853, IntegratorId::dopri5, IntegratorId::rodas4, IntegratorId::rk4] {
        let settings = if id == IntegratorId::rk4 { stepping(id, 1.0, 0.2) } else { to(id, 1.0, 1e-8) };
        let limit = Event::limit("limit", 0, f64::NEG_INFINITY, bound).direction(Direction::Either);
        let motion = Simulation::new(&robot, settings).unwrap().run(&[0.0], &[speed], &mut NoTorque, &mut [limit]).unwrap();
        let half = (2.0 * delta / G).sqrt();
        let expected = [(speed / G - half, Direction::Falling), (speed / G + half, Direction::Rising)];
        assert_eq!(motion.events.len(), 2, "{id}");
        for (hit, (t, direction)) in motion.events.iter().zip(expected) {
            assert!((hit.t - t).abs() < 1e-10 && hit.direction == direction, "{id}: {hit:?}, {t}");
        }
    }
}

/// In the middle between two of the sample points of a step, and so near to each other that only
/// the least value leads to them.
#[test]
fn a_pair_of_zeros_is_found_wherever_it_is_in_a_step() {
    let robot = slider();
    for (middle, half) in [(0.4375, 0.01), (0.44, 0.001), (0.31, 1e-5)] {
        let pair = Event::new("pair", move |t, _, _| (t - middle) * (t - middle) - half * half).direction(Direction::Either);
        let mut simulation = Simulation::new(&robot, stepping(IntegratorId::rk4, 1.0, 1.0)).unwrap();
        let motion = simulation.run(&[0.0], &[1.0], &mut NoTorque, &mut [pair]).unwrap();
        let found: Vec<f64> = motion.events.iter().map(|hit| hit.t).collect();
        assert!(found.len() == 2, "{middle}: {found:?}");
        assert!((found[0] - (middle - half)).abs() < 1e-9 && (found[1] - (middle + half)).abs() < 1e-9, "{middle}: {found:?}");
    }
}

/// Repetition at many times is no repetition at one: pairs of maps are counted anew at each.
#[test]
fn two_maps_at_each_of_many_times_are_no_error() {
    let map = |name| {
        let keep = Action::Map(Box::new(|_: f64, _: &mut [f64], _: &mut [f64]| Ok(None)));
        Event::new(name, |t: f64, _: &[f64], _: &[f64]| (100.0 * std::f64::consts::PI * t).cos()).action(keep)
    };
    let settings = stepping(IntegratorId::rk4, 1.2, 0.01);
    let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut [map("one"), map("two")]).unwrap();
    assert_eq!(motion.events.len(), 240);
}

#[test]
fn a_body_that_slides_to_rest_stops_sliding_when_friction_says() {
    let applied = Applied { effect: EffectId::friction, on: "joint".into(), at: Origin::default(), parameters: vec![2.0, 1e-3] };
    let robot = one_joint("prismatic", 0.0).with_gravity([0.0; 3]).with_effects(&[applied]).unwrap();
    let stops = Event::stick_slip("stops", 0, 1e-3).direction(Direction::Falling).action(Action::Stop);
    let settings = to(IntegratorId::rodas4, 2.0, 1e-10);
    let motion = Simulation::new(&robot, settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut [stops]).unwrap();
    // v̇ = −μ v/√(v² + s²): √(v² + s²) − s·artanh(s/√(v² + s²)) falls as μt.
    let clock = |v: f64| v.hypot(1e-3) - 1e-3 * (1e-3 / v.hypot(1e-3)).atanh();
    // Below ten times s it creeps.
    let t = (clock(1.0) - clock(1e-2)) / 2.0;
    println!("{:e}", motion.events[0].t - t);
    assert!((motion.events[0].t - t).abs() < 1e-9 && motion.ended == Ended::ByEvent(0));
    assert_eq!(motion.t.last(), Some(&motion.events[0].t));
}

#[test]
fn a_contact_is_made_where_the_sphere_touches_the_plane() {
    let robot = model("ball", Base::Fixed);
    let normal = [0.0, 0.6, 0.8];
    let contact = Event::contact("touch", &robot, at(1, [0.0, 0.1, 0.0], normal.map(|n| 3.0 * n)), 0.05, 0.2).unwrap().action(Action::Stop);
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 1.0, 1e-9)).unwrap();
    let motion = simulation.run(&[1.0], &[0.0], &mut NoTorque, &mut [contact]).unwrap();
    let height = (0.2 + 0.05 - 0.6 * 0.1) / 0.8;
    assert!((motion.events[0].t - (2.0 * (1.0 - height) / G).sqrt()).abs() < 1e-11, "{:?}", motion.events);
}

/// A motion cut by events that do nothing is the same motion.
#[test]
fn events_that_are_only_recorded_change_nothing() {
    let settings = Settings { output: Output::Every(0.1), ..to(IntegratorId::dopri5, 2.0, 1e-8) };
    let mut simulation = Simulation::new(&chain::Robot, settings).unwrap();
    let (q, v) = ([0.4, -0.7, 0.5], [1.0, 0.5, -1.5]);
    let plain = simulation.run(&q, &v, &mut NoTorque, &mut []).unwrap();
    let mut events = [Event::new("zero", |_, q: &[f64], _: &[f64]| q[0]), Event::new("fast", |_, _: &[f64], v: &[f64]| v[2] - 1.0)];
    let watched = simulation.run(&q, &v, &mut NoTorque, &mut events).unwrap();
    assert!(watched.events.len() > 3 && watched.events.windows(2).all(|w| w[0].t <= w[1].t));
    assert_eq!((plain.q, plain.v), (watched.q, watched.v));
}

/// Nor does an event that never happens: its evaluation does not change the turn of a floating
/// body.
#[test]
fn what_is_looked_for_does_not_move_a_body_that_floats() {
    let robot = model("satellite", Base::Floating);
    let (mut q, v): (Vec<f64>, Vec<f64>) = (vec![0.0; robot.nq()], (0..robot.nv()).map(|k| 1.0 - 0.2 * k as f64).collect());
    articulated_core::algorithm::neutral(&robot, &mut q);
    for row in integrators() {
        let settings = Settings { output: Output::Steps, ..stepping(row.id, 1.0, 0.013) };
        let mut simulation = Simulation::new(&robot, settings).unwrap();
        let plain = simulation.run(&q, &v, &mut NoTorque, &mut []).unwrap();
        let watched = simulation.run(&q, &v, &mut NoTorque, &mut [Event::new("never", |_, _, _| 1.0)]).unwrap();
        assert_eq!((plain.q, plain.v), (watched.q, watched.v), "{}", row.name);
    }
}

/// In any order of the events.
#[test]
fn what_is_recorded_where_another_event_maps_happens_once() {
    let robot = one_joint("prismatic", 0.0);
    for factor in [0.5, -0.8] {
        for row in integrators() {
            let record = || Event::new("record", |_, q: &[f64], _: &[f64]| q[0]);
            let map = || {
                record().direction(Direction::Falling).action(Action::Map(Box::new(move |_, _, v| {
                    v[0] *= factor;
                    Ok(None)
                })))
            };
            for mut events in [[record(), map()], [map(), record()]] {
                let mut simulation = Simulation::new(&robot, any(row.id, 0.5)).unwrap();
                let motion = simulation.run(&[1.0], &[0.0], &mut NoTorque, &mut events).unwrap();
                let told: Vec<_> = motion.events.iter().map(|hit| hit.direction).collect();
                assert_eq!(told, [Direction::Falling; 2], "{}, {factor}: {:?}", row.name, motion.events);
            }
        }
    }
}

/// In the order of time, whatever that of their list; if one maps the state, the others of its time
/// happen with it.
#[test]
fn events_of_one_step_happen_in_order() {
    let still = one_joint("prismatic", 0.0).with_gravity([0.0; 3]);
    let at = |name: &str, x: f64| Event::new(name, move |_, q: &[f64], _: &[f64]| q[0] - x);
    let mut events = [at("last", 0.9), at("first", 0.2), at("middle", 0.5)];
    let settings = stepping(IntegratorId::rk4, 1.0, 1.0);
    let motion = Simulation::new(&still, settings.clone()).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut events).unwrap();
    let found: Vec<(usize, f64)> = motion.events.iter().map(|hit| (hit.event, hit.t)).collect();
    assert!(found.iter().zip([(1, 0.2), (2, 0.5), (0, 0.9)]).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-12), "{found:?}");
    assert_eq!((found.len(), motion.counts.steps), (3, 1));
    // Two that are zero at one place, found by different ways to within the tolerance.
    for k in 1..50 {
        let x = f64::from(k) / 51.0;
        let counted = |by: f64| {
            Action::Map(Box::new(move |_: f64, _: &mut [f64], v: &mut [f64]| {
                v[0] += by;
                Ok(None)
            }))
        };
        let mut both = [
            Event::new("steep", move |_, q: &[f64], _: &[f64]| (q[0] - x) * (3.0 + q[0])).action(counted(1.0)),
            Event::new("bent", move |_, q: &[f64], _: &[f64]| (q[0] - x) * (9.0 - q[0])).action(counted(0.25)),
        ];
        let settings = Settings { end: 0.99, ..settings.clone() };
        let motion = Simulation::new(&still, settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut both).unwrap();
        assert!(motion.events.len() == 2 && motion.events.iter().all(|hit| (hit.t - x).abs() < 3e-12), "{x}: {:?}", motion.events);
        assert_eq!(motion.v[1], 2.25);
    }
}

/// Between walls a billionth of a step apart, two events alternate for ever.
#[test]
fn two_events_that_cause_each_other_are_an_error_too() {
    let still = one_joint("prismatic", 0.0).with_gravity([0.0; 3]);
    let back = || {
        Action::Map(Box::new(|_: f64, _: &mut [f64], v: &mut [f64]| {
            v[0] = -v[0];
            Ok(None)
        }))
    };
    let mut walls =
        [Event::limit("left", 0, 0.0, f64::INFINITY).action(back()), Event::limit("right", 0, f64::NEG_INFINITY, 1e-13).action(back())];
    let settings = Settings { max_steps: 5000, ..to(IntegratorId::dopri5, 1.0, 1e-9) };
    let error = Simulation::new(&still, settings).unwrap().run(&[5e-14], &[1.0], &mut NoTorque, &mut walls).unwrap_err();
    assert!(matches!(error, SimulateError::Chattering { t, .. } if t < 1e-9), "{error}");
}

/// The result of a map must be a state.
#[test]
fn a_map_that_gives_no_state_is_an_error() {
    let run = |change: &'static dyn Fn(&mut [f64], &mut [f64])| {
        let action = Action::Map(Box::new(move |_: f64, q: &mut [f64], v: &mut [f64]| {
            change(q, v);
            Ok(None)
        }));
        let mut event = [Event::new("soon", |t, _: &[f64], _: &[f64]| t - 0.3).action(action)];
        let q = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        Simulation::new(&handle::Robot, to(IntegratorId::dopri5, 1.0, 1e-6)).unwrap().run(&q, &[0.1; 6], &mut NoTorque, &mut event)
    };
    let found = run(&|q, _| q[3..].fill(1.0)).unwrap_err();
    let joint = || Some("__floating_base__".to_owned());
    assert_eq!(found, SimulateError::State(vec![StateError::Quaternion { vector: "q", index: 3, norm: 2.0, joint: joint() }]));
    let found = run(&|_, v| v[4] = f64::INFINITY).unwrap_err();
    let expected = StateError::NotFinite { vector: "v", index: 4, found: f64::INFINITY, joint: joint() };
    assert_eq!(found, SimulateError::State(vec![expected]));
    let motion = run(&|q, v| (q[0], v[3]) = (5.0, 0.0)).unwrap();
    assert!(motion.q_at(1)[0] > 4.9);
}

/// Two bounds: a parabola between them that falls through zero at both.
#[test]
fn a_coordinate_leaves_its_limits_at_both_ends() {
    let still = one_joint("prismatic", 0.0).with_gravity([0.0; 3]);
    for (v, t) in [(1.0, 0.4), (-1.0, 0.8)] {
        let mut limit = [Event::limit("limit", 0, -0.6, 0.6).action(Action::Stop)];
        let settings = Settings { first_step: Some(0.1), max_step: 0.1, ..to(IntegratorId::dopri5, 2.0, 1e-9) };
        let motion = Simulation::new(&still, settings).unwrap().run(&[0.2], &[v], &mut NoTorque, &mut limit).unwrap();
        assert!(motion.events.len() == 1 && (motion.events[0].t - t).abs() < 1e-11, "{:?}", motion.events);
    }
}

/// The largest numbers, which files use for no bound, are bounds without effect.
#[test]
fn the_largest_numbers_are_bounds() {
    let robot = slider();
    for bounds in [(-f64::MAX, f64::MAX), (-1.0, f64::MAX), (-f64::MAX, 0.5)] {
        let mut limit = [Event::limit("limit", 0, bounds.0, bounds.1)];
        let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 1.0, 1e-6)).unwrap();
        let motion = simulation.run(&[0.0], &[1.0], &mut NoTorque, &mut limit).unwrap();
        let expected: &[f64] = if bounds.1 == 0.5 { &[0.5] } else { &[] };
        assert_eq!(motion.events.len(), expected.len(), "{bounds:?}: {:?}", motion.events);
        assert!(motion.events.iter().zip(expected).all(|(hit, t)| (hit.t - t).abs() < 1e-9), "{bounds:?}: {:?}", motion.events);
    }
}

#[test]
fn an_event_about_a_number_that_there_is_not_is_an_error_that_names_it() {
    let robot = one_joint("prismatic", 0.0);
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 0.1, 1e-6)).unwrap();
    let mut events = [Event::limit("end", 3, 0.0, 1.0), Event::limit("wall", 0, -9.0, 9.0), Event::stick_slip("slide", 1, 0.1)];
    let beyond = |event: &str, vector, index| StateError::Beyond { event: event.into(), vector, index, length: 1 };
    assert_eq!(
        simulation.run(&[0.0], &[0.0], &mut NoTorque, &mut events),
        Err(SimulateError::State(vec![beyond("end", "q", 3), beyond("slide", "v", 1)]))
    );
}

#[test]
fn bounds_that_nothing_is_between_are_an_error() {
    let robot = one_joint("prismatic", 0.0);
    for (lower, upper) in [(1.0, -1.0), (0.5, 0.5), (f64::NAN, 1.0), (0.0, f64::NAN)] {
        let mut events = [Event::limit("stop", 0, lower, upper)];
        let found = Simulation::new(&robot, to(IntegratorId::dopri5, 0.1, 1e-6)).unwrap().run(&[0.0], &[0.0], &mut NoTorque, &mut events);
        assert!(matches!(found, Err(SimulateError::State(all)) if matches!(all[..], [StateError::Bounds { .. }])), "{lower} {upper}");
    }
}

/// Stretch by stretch no event is lost and none comes twice: a zero at the end of a stretch
/// happened in it.
#[test]
fn an_event_where_two_stretches_meet_happens_once() {
    let robot = one_joint("prismatic", 0.0);
    for row in integrators() {
        let mut simulation = Simulation::new(&robot, any(row.id, 1.0)).unwrap();
        let alarm = || [Event::new("alarm", |t, _: &[f64], _: &[f64]| t - 0.5)];
        let (mut q, mut v, mut found) = (vec![0.3], vec![0.1], Vec::new());
        for k in 0..4 {
            simulation.set_span(0.25 * f64::from(k), 0.25 * f64::from(k + 1)).unwrap();
            let motion = simulation.run(&q, &v, &mut NoTorque, &mut alarm()).unwrap();
            found.extend(motion.events.iter().map(|hit| (k, hit.t, hit.direction)));
            let last = motion.len() - 1;
            (q, v) = (motion.q_at(last).to_vec(), motion.v_at(last).to_vec());
        }
        assert_eq!(found, [(1, 0.5, Direction::Rising)], "{}", row.name);
        let mut falling = [Event::new("end", |t, _: &[f64], _: &[f64]| 1.0 - t).action(Action::Stop)];
        simulation.set_span(0.25, 1.0).unwrap();
        let motion = simulation.run(&[0.3], &[0.1], &mut NoTorque, &mut falling).unwrap();
        assert_eq!((motion.events.len(), motion.ended), (1, Ended::ByEvent(0)), "{}", row.name);
    }
}

/// A function that stays at zero does not reach it.
#[test]
fn what_is_at_zero_all_the_while_is_no_event_at_the_end() {
    let still = Event::new("still", |t: f64, q: &[f64], _| if t == 0.0 { -1.0 } else { q[0] });
    let robot = slider();
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 1.0, 1e-6)).unwrap();
    assert!(simulation.run(&[0.0], &[0.0], &mut NoTorque, &mut [still]).unwrap().events.is_empty());
}
