//! Smoothed friction: holding, creep and errors.

use articulated::simulate::{IntegratorId, SimulateError};
use articulated_core::effect::EffectId;

use super::{CART, moved, session, words};

/// A link of 2 kg with its centre 0.25 m from a hinge with 6 N·m of dry friction: gravity needs
/// 4.905 N·m.
const STICTION: &str = r#"<robot name="arm"><link name="root"/>
    <joint name="s" type="revolute"><parent link="root"/><child link="u"/><axis xyz="0 1 0"/>
      <limit lower="-1.2" upper="1.2" effort="40" velocity="3"/><dynamics damping="0.1" friction="6"/></joint>
    <link name="u"><inertial><mass value="2"/><origin xyz="0.25 0 0"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.05"/></inertial></link>
    </robot>"#;

/// s x/√(1 − x²): the rate at which smoothed friction carries the part x of its limit.
fn creeping(speed: f64, x: f64) -> f64 {
    speed * x / (1.0 - x * x).sqrt()
}

#[test]
fn a_joint_that_friction_holds_creeps_at_its_closed_form_and_never_slides() {
    let session = session("effects = { friction = { '*' = 'urdf' } }\nsimulation = { end = 10.0, events = ['stick_slip'] }", STICTION);
    let outcome = moved(&session);
    assert_eq!((outcome.error.as_ref(), words(&outcome)), (None, vec![]));
    assert!(outcome.recording.counts.steps < 60, "{:?}", outcome.recording.counts);
    let expected = creeping(1e-5, 2.0 * 9.81 * 0.25 / 6.0);
    let last = outcome.recording.len() - 1;
    let (q, v) = (outcome.recording.q_at(last)[0], outcome.recording.v_at(last)[0]);
    assert!((q / (10.0 * expected) - 1.0).abs() < 1e-3 && (v / expected - 1.0).abs() < 1e-3, "{q} {v} {expected}");
    let [creep] = &outcome.creep[..] else { panic!("{:?}", outcome.creep) };
    assert_eq!((creep.effect, creep.on.as_str()), (EffectId::friction, "s"));
    assert!((creep.distance / q - 1.0).abs() < 1e-3 && (creep.time - 10.0).abs() < 0.011, "{creep:?}");
}

/// 7 N·m instead: 0.7007 rad/s² at first, and it slides.
#[test]
fn a_joint_that_friction_does_not_hold_starts_to_slide() {
    let scene = "effects = { friction = { s = 4.0 } }\nsimulation = { end = 0.5, events = ['stick_slip'] }";
    let outcome = moved(&session(scene, STICTION));
    assert_eq!(words(&outcome), ["s starts to slide"]);
    // At a horizontal start 0.905 N·m accelerate an inertia of 0.05 + 2 · 0.25² kg·m².
    let expected = 0.5 * (4.905 - 4.0) / 0.175 * 0.25;
    let q = outcome.recording.q_at(outcome.recording.len() - 1)[0];
    assert!((q / expected - 1.0).abs() < 0.1, "{q} {expected}");
}

/// A puck of 2 kg on the ground is pushed along it with half of the friction that holds it.
#[test]
fn a_contact_creeps_at_its_closed_form() {
    const PUCK: &str = r#"<robot name="puck"><link name="rail"/><link name="cart"/><link name="puck"><inertial><mass value="2"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="along" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="9" velocity="9"/></joint>
        <joint name="up" type="prismatic"><parent link="cart"/><child link="puck"/><axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="9" velocity="9"/></joint></robot>"#;
    let push = 0.5 * 0.6 * 2.0 * 9.81;
    let scene = format!(
        "effects = {{ contact = {{ puck = {{ radius = 0.1, stiffness = 1e5, damping = 1.0, friction = 0.6 }} }} }}
        initial = {{ q = {{ up = {} }} }}
        control = {{ kind = 'torque', torque = {{ along = {push} }} }}
        simulation = {{ end = 2.0 }}",
        0.1 - 2.0 * 9.81 / 1e5
    );
    let outcome = moved(&session(&scene, PUCK));
    assert_eq!(outcome.error, None);
    let [creep] = &outcome.creep[..] else { panic!("{:?}", outcome.creep) };
    assert_eq!((creep.effect, creep.on.as_str()), (EffectId::contact, "puck"));
    let expected = creeping(1e-5, 0.5);
    assert!((creep.distance / creep.time / expected - 1.0).abs() < 1e-2 && creep.time > 1.9, "{creep:?} {expected}");
}

#[test]
fn a_speed_that_the_tolerances_do_not_resolve_is_refused_with_its_key() {
    let scene = |atol: &str| {
        format!(
            "effects = {{ friction = {{ slide = {{ friction = 1.0, speed = 1e-15 }} }},
            contact = {{ cart = {{ radius = 0.1, stiffness = 1e4, damping = 1.0, friction = 0.5, speed = 5e-9 }} }} }}
            simulation = {{ end = 1.0, {atol} }}"
        )
    };
    let told = |scene: &str| {
        let session = session(scene, CART);
        session.check(&session.settings().unwrap()).map_or_else(|e| e.to_string(), |()| String::new())
    };
    let lines = [
        "s.toml: effects.friction.slide.speed: found 1e-15, expected at least 1e-8, ten times simulation.atol = 1e-9: a larger `speed`, or a smaller `atol`",
        "s.toml: effects.contact.cart.speed: found 5e-9, expected at least 1e-8, ten times simulation.atol = 1e-9: a larger `speed`, or a smaller `atol`",
    ];
    let found = told(&scene(""));
    assert!(lines.iter().all(|line| found.lines().any(|l| l == *line)) && found.lines().count() == 2, "{found}");
    // Fixed steps have no tolerance.
    assert_eq!(told(&scene("integrator = 'rodas4', step = 1e-3")), "");
    assert_eq!(told(&scene("atol = 1e-16")), "");
}

#[test]
fn friction_and_contact_are_stiff_and_everything_else_is_not() {
    let integrator = |scene: &str| session(&format!("{scene}\nsimulation = {{ end = 1.0 }}"), CART).settings().unwrap().integrator;
    assert_eq!(integrator("effects = { friction = { slide = 1.0 } }"), IntegratorId::rodas4);
    let contact = "effects = { contact = { cart = { radius = 0.1, stiffness = 1e4, damping = 1.0, friction = 0.5 } } }";
    assert_eq!(integrator(contact), IntegratorId::rodas4);
    assert_eq!(integrator("effects = { damping = { slide = 1.0 } }"), IntegratorId::dopri5);
    assert_eq!(integrator("effects = { friction = { slide = 'off' } }"), IntegratorId::dopri5);
    let named = session("effects = { friction = { slide = 1.0 } }\nsimulation = { end = 1.0, integrator = 'dop853' }", CART);
    assert_eq!(named.settings().unwrap().integrator, IntegratorId::dop853);
}

/// A ball joint at 10 rad/s: one step of 1 s would turn it by more than π.
#[test]
fn the_first_step_shows_what_a_run_would_end_with() {
    let ball = CART.replace("prismatic", "spherical");
    let scene = |step: f64| {
        format!(
            "gravity = [0, 0, 0]\ninitial = {{ v = {{ slide = [0.0, 0.0, 10.0] }} }}
            simulation = {{ end = 2.0, integrator = 'lie_midpoint', step = {step} }}"
        )
    };
    for (step, refused) in [(1.0, true), (0.01, false)] {
        let session = session(&scene(step), &ball);
        let mut motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
        let initial = session.initial_state().unwrap();
        let first = motion.first_step(&initial).unwrap();
        assert_eq!(first.is_some(), refused, "{first:?}");
        // A run afterwards begins anew.
        let outcome = motion.run(&initial, &mut |_, _| true).unwrap();
        assert_eq!(outcome.error, first);
        if refused {
            assert!(matches!(first, Some(SimulateError::Turn { t, .. }) if t == 0.0), "{first:?}");
        }
    }
}

/// Random scenes: integrators, steps, effects and starts, some of them extreme. A start accepted by
/// the first step is not refused by a run.
#[test]
fn what_the_first_step_accepts_is_not_refused_at_the_start() {
    let mut state = 7_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..150 {
        let mut size = |from: f64, to: f64| 10_f64.powf(from + (to - from) * random());
        let integrator = ["rodas4", "dopri5", "dop853", "rk4", "semi_implicit_euler", "lie_midpoint"][(size(0.0, 1.0) * 0.6) as usize % 6];
        let fixed = ["rk4", "semi_implicit_euler", "lie_midpoint"].contains(&integrator);
        let step = if fixed { format!(", step = {:e}", size(-4.0, 0.0)) } else { String::new() };
        let scene = format!(
            "effects = {{ damping = {{ s = {:e} }}, spring = {{ s = {:e} }}, friction = {{ s = {{ friction = {:e}, speed = {:e} }} }} }}
            initial = {{ v = {{ s = {:e} }} }}
            simulation = {{ end = 0.01, max_steps = 2000, integrator = '{integrator}'{step} }}",
            size(-3.0, 8.0),
            size(-3.0, 12.0),
            size(-3.0, 3.0),
            size(-7.0, 0.0),
            size(-3.0, 6.0)
        );
        let session = session(&scene, STICTION);
        let mut motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
        let initial = session.initial_state().unwrap();
        let first = motion.first_step(&initial).unwrap();
        let outcome = motion.run(&initial, &mut |_, _| true).unwrap();
        match first {
            Some(error) => assert_eq!(outcome.error, Some(error), "{scene}"),
            None => assert!(outcome.error.is_none() || outcome.reached > 0.0, "{:?}: {scene}", outcome.error),
        }
        if outcome.recording.counts.steps > 0 { accepted += 1 } else { refused += 1 }
    }
    assert!(accepted > 30 && refused > 10, "{accepted} {refused}");
}
