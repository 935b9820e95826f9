//! Blows: a ball that a robot strikes.

use articulated::simulate::{Event, Impact, IntegratorId, NoTorque, SimulateError, Simulation, StateError};
use articulated::{Base, Dynamics, FunctionError, load_bytes};

use crate::robots::{at, chain, model, slider, to};

#[test]
fn a_blow_hands_over_what_the_ball_and_the_mass_behind_the_point_say() {
    let (ball, restitution) = (0.046, 0.78);
    let q = [0.4, -0.7, 0.5];
    let (robot, mut v) = (chain::Robot, [1.0, 0.5, -1.5]);
    let generic = model("chain", Base::Fixed);
    let mut impact = Impact::new(&generic, at(3, [0.0, 0.02, -0.4], [0.3, -0.5, 0.2]), ball, restitution).unwrap();
    // So that they approach.
    let approach = impact.strike(&q, &mut v.clone(), 0.0).unwrap().approach;
    v.iter_mut().for_each(|v| *v *= approach.signum());
    let energy = |v: &[f64]| {
        let mut t = [0.0];
        robot.kinetic_energy(&mut robot.workspace(), &q, v, &mut t).unwrap();
        t[0]
    };
    let before = energy(&v);
    let struck = impact.strike(&q, &mut v, 0.0).unwrap();
    let (head, approach) = (struck.effective_mass, approach.abs());
    // The smash factor.
    assert!((struck.ball_speed / approach - (1.0 + restitution) * head / (head + ball)).abs() < 1e-14);
    let lost = before - energy(&v) - 0.5 * ball * struck.ball_speed.powi(2);
    let expected = 0.5 * (1.0 - restitution * restitution) * approach.powi(2) * head * ball / (head + ball);
    assert!((lost - expected).abs() < 1e-14, "{lost} J, not {expected} J");
    // Newton's law: the remaining approach speed, reversed.
    let after = impact.strike(&q, &mut v, struck.ball_speed).unwrap();
    assert!((after.approach + restitution * approach).abs() < 1e-14 && after.impulse == 0.0);
}

/// A free body, struck off its centre: 1/m_h = 1/m + (r × n)ᵀ I⁻¹ (r × n), with every component of
/// r × n in play, and the momentum that it loses is that of the ball.
#[test]
fn a_blow_off_the_centre_turns_a_free_body() {
    let text = r#"<robot name="box"><link name="box"><inertial><mass value="2"/>
        <inertia ixx="0.3" ixy="0" ixz="0" iyy="0.5" iyz="0" izz="0.7"/></inertial></link></robot>"#;
    let robot = load_bytes("box", text.as_bytes(), Base::Floating).unwrap();
    let (mass, ball, moments) = (2.0, 0.4, [0.3, 0.5, 0.7]);
    // A turn by 120° about (1, 1, 1) takes x to y, y to z and z to x.
    let q = [1.0, 2.0, 3.0, 0.5, 0.5, 0.5, 0.5];
    let (point, normal) = ([0.2, -0.3, 0.5], [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0]);
    // The normal in axes of the body.
    let n = [normal[1], normal[2], normal[0]];
    let arm = [point[1] * n[2] - point[2] * n[1], point[2] * n[0] - point[0] * n[2], point[0] * n[1] - point[1] * n[0]];
    let inverse = 1.0 / mass + (0..3).map(|k| arm[k] * arm[k] / moments[k]).sum::<f64>();
    let mut v = [0.0, 0.0, 0.0, 3.0 * n[0], 3.0 * n[1], 3.0 * n[2]];
    let struck = Impact::new(&robot, at(0, point, normal), ball, 1.0).unwrap().strike(&q, &mut v, 0.0).unwrap();
    assert!((struck.effective_mass * inverse - 1.0).abs() < 1e-14 && (struck.approach - 3.0).abs() < 1e-14, "{struck:?}");
    let impulse = 2.0 * 3.0 / (inverse + 1.0 / ball);
    assert!((struck.impulse - impulse).abs() < 1e-13, "{struck:?}");
    for k in 0..3 {
        assert!((v[k] + arm[k] / moments[k] * impulse).abs() < 1e-13, "ω[{k}] = {}", v[k]);
        assert!((v[3 + k] - n[k] * (3.0 - impulse / mass)).abs() < 1e-13, "v[{k}] = {}", v[3 + k]);
    }
}

/// A ball of negligible mass leaves at (1 + e) times the speed of the point.
#[test]
fn a_ball_of_no_weight_to_speak_of_is_struck() {
    let robot = slider();
    for mass in [1e-3, 1e-300, 1e-310, f64::from_bits(1)] {
        let mut v = [1.0];
        let struck = Impact::new(&robot, at(1, [0.0; 3], [0.0, 0.0, 1.0]), mass, 0.5).unwrap().strike(&[0.0], &mut v, 0.0).unwrap();
        assert!((struck.ball_speed - 1.5 / (1.0 + mass)).abs() < 1e-15 && struck.approach == 1.0, "{mass:e}: {struck:?}");
    }
}

/// The record of an event that strikes is the ball's speed, and the motion goes on with the new
/// state; an event that cannot strike is refused.
#[test]
fn an_event_that_strikes_gives_the_speed_of_the_ball() {
    let robot = model("chain", Base::Fixed);
    let blow = || Impact::new(&robot, at(3, [0.0, 0.02, -0.4], [0.3, -0.5, 0.2]), 0.046, 0.78).unwrap();
    let (q, v) = ([0.4, -0.7, 0.5], [1.0, 0.5, -1.5]);
    let sign = blow().strike(&q, &mut v.clone(), 0.0).unwrap().approach.signum();
    let v = v.map(|v| v * sign);
    let mut struck = [Event::new("now", |t, _: &[f64], _: &[f64]| t - 0.01).action(blow().action())];
    let run = |end: f64, events: &mut [Event]| {
        Simulation::new(&robot, to(IntegratorId::dop853, end, 1e-12)).unwrap().run(&q, &v, &mut NoTorque, events).unwrap()
    };
    let (motion, before) = (run(0.01 + 1e-9, &mut struck), run(0.01, &mut []));
    let mut after = before.v_at(1).to_vec();
    let expected = blow().strike(before.q_at(1), &mut after, 0.0).unwrap();
    assert!((motion.events[0].value.unwrap() - expected.ball_speed).abs() < 1e-9 && expected.ball_speed > 0.1, "{:?}", motion.events);
    assert!(motion.v_at(1).iter().zip(&after).all(|(a, b)| (a - b).abs() < 1e-6), "{:?} {after:?}", motion.v_at(1));
    for n in [0, 2, 4] {
        assert!(matches!(
            blow().strike(&q, &mut vec![0.0; n], 0.0),
            Err(SimulateError::Function(FunctionError::Length { argument: "v", .. }))
        ));
    }
    for (normal, mass, restitution, what) in [
        ([0.0; 3], 1.0, 0.5, "length of the normal"),
        ([1.0; 3], 0.0, 0.5, "mass of the ball"),
        ([1.0; 3], 1.0, 1.1, "restitution"),
        ([1.0; 3], 1.0, -0.1, "restitution"),
    ] {
        let Err(SimulateError::State(all)) = Impact::new(&robot, at(3, [0.0; 3], normal), mass, restitution) else { panic!("{what}") };
        assert!(matches!(all[..], [StateError::Value { what: found, .. }] if found == what), "{all:?}");
    }
}

#[test]
fn all_that_is_wrong_with_a_blow_or_a_contact_is_said_at_once() {
    let robot = model("chain", Base::Fixed);
    let frames = format!("there is no frame 99: the robot has {}, the first is 0", robot.frames().len());
    let told = |error: Option<SimulateError>| error.unwrap().to_string().lines().map(str::to_owned).collect::<Vec<_>>();
    let blow = Impact::new(&robot, at(99, [0.0, f64::NAN, 0.0], [0.0; 3]), -1.0, 3.0).err();
    let normal = "length of the normal = 0 cannot be used; it should be finite, greater than 0";
    let point = "y of the point = NaN cannot be used; it should be finite, m";
    let expected = [
        &frames,
        point,
        normal,
        "mass of the ball = -1 cannot be used; it should be finite, greater than 0, kg",
        "restitution = 3 cannot be used; it should be from 0 to 1",
    ];
    assert_eq!(told(blow), expected);
    let contact = Event::contact("foot", &robot, at(99, [0.0, f64::NAN, 0.0], [0.0; 3]), f64::INFINITY, f64::NAN).err();
    let radius = "radius = inf cannot be used; it should be finite, m";
    assert_eq!(told(contact), [&frames, point, normal, radius, "height = NaN cannot be used; it should be finite, m"]);
    let next = robot.frames().len();
    assert!(Impact::new(&robot, at(next - 1, [0.0; 3], [0.0, 0.0, 1.0]), 1.0, 0.5).is_ok());
    assert!(Impact::new(&robot, at(next, [0.0; 3], [0.0, 0.0, 1.0]), 1.0, 0.5).is_err());
}

/// A normal whose length is beyond the range of numbers.
#[test]
fn a_contact_is_found_whatever_the_length_of_its_normal() {
    let robot = model("ball", Base::Fixed);
    let met = |length: f64| {
        let contact = Event::contact("touch", &robot, at(1, [0.0; 3], [0.0, length, length]), 0.05, 0.2).unwrap();
        let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 1.0, 1e-9)).unwrap();
        simulation.run(&[1.0], &[0.0], &mut NoTorque, &mut [contact]).unwrap().events[0].t
    };
    assert_eq!([5e-324, 1e-310, f64::MAX].map(met), [met(1.0); 3]);
}
