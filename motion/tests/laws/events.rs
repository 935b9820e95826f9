//! Events of a motion and their texts.

use articulated::simulate::Ended;
use articulated_motion::{Detectors, Ending, EventKind, Outcome, SceneEvent, UnavailableEvent};
use articulated_scene::EventClass;

use super::{ARM, CART, moved, session, words};

/// The first two events, as data.
fn about(outcome: &Outcome) -> [Option<SceneEvent>; 2] {
    [0, 1].map(|k| outcome.occurrences.get(k).and_then(|h| h.about.clone()))
}

fn is(kind: EventKind, on: &str, begins: bool) -> Option<SceneEvent> {
    Some(SceneEvent { kind, on: on.into(), begins })
}

/// A cart of 2 kg at 3 m/s hits a ball of 0.5 kg at rest 0.6 m ahead; e = 0.8.
const BLOW: &str = "gravity = [0, 0, 0]
    initial = { v = { slide = 3.0 } }
    simulation = { end = 1.0, rtol = 1e-10, atol = 1e-12, events = ['limits'] }
    [impact]
    link = 'cart'
    normal = [2.0, 0.0, 0.0]
    mass = 0.5
    restitution = 0.8
    ball = [0.6, 0.0, 0.0]\n";

/// (1 + e) v m/(m + m_b), m/s.
const BALL: f64 = 1.8 * 3.0 * 2.0 / 2.5;

#[test]
fn a_blow_and_a_limit_are_found_and_told() {
    let outcome = moved(&session(BLOW, CART));
    assert_eq!(words(&outcome), ["cart hits the ball, which leaves at 4.3200 m/s", "slide reaches its upper limit"]);
    assert_eq!(about(&outcome), [is(EventKind::Ball, "cart", true), is(EventKind::UpperLimit, "slide", true)]);
    let after = 3.0 - 0.5 * BALL / 2.0;
    for (occurrence, t) in outcome.occurrences.iter().zip([0.2, 0.2 + 0.3 / after]) {
        assert!((occurrence.t - t).abs() < 1e-9, "{occurrence:?} {t}");
    }
    let speeds: Vec<Option<f64>> = outcome.occurrences.iter().map(|h| h.ball_speed).collect();
    assert!((speeds[0].unwrap() - BALL).abs() < 1e-9 && speeds[1].is_none(), "{speeds:?}");
    let energy = 0.5 * 0.5 * BALL * BALL;
    assert!((outcome.ball.unwrap() - energy).abs() < 1e-8, "{:?} {energy}", outcome.ball);
    assert_eq!((outcome.ending, outcome.reached, outcome.error), (Ending::AtEnd, 1.0, None));
}

#[test]
fn a_blow_does_not_depend_on_the_length_of_its_normal() {
    for normal in ["5e-324", "1e-200", "1.7e308"] {
        let outcome = moved(&session(&BLOW.replace("[2.0, 0.0", &format!("[{normal}, 0.0")), CART));
        assert!((outcome.occurrences[0].t - 0.2).abs() < 1e-9, "{normal}: {:?}", outcome.occurrences[0]);
        assert_eq!(words(&outcome)[0], "cart hits the ball, which leaves at 4.3200 m/s");
    }
}

#[test]
fn a_motion_stops_where_a_blow_ends_it() {
    let session = session(&format!("{BLOW}stop = true\n"), CART);
    let outcome = moved(&session);
    assert_eq!((outcome.ending, outcome.ending.to_string().as_str()), (Ending::ByBlow, "by an event"));
    assert!((outcome.reached - 0.2).abs() < 1e-9 && outcome.error.is_none(), "{}", outcome.reached);
    assert_eq!(words(&outcome), ["cart hits the ball, which leaves at 4.3200 m/s"]);
    assert!(outcome.recording.t.iter().all(|t| *t <= outcome.reached + 1e-12));
}

#[test]
fn a_motion_runs_again_as_it_ran_before() {
    let session = session(&format!("{BLOW}stop = true\n"), CART);
    let mut motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
    let initial = session.initial_state().unwrap();
    let [mut first, mut again] = [(); 2].map(|()| motion.run(&initial, &mut |_, _| true).unwrap());
    (first.wall, again.wall) = Default::default();
    assert_eq!(first, again);
    // A cart in the other direction never meets the ball: no state is left from the blow before.
    let away = articulated_motion::InitialState { v: vec![-1.0], ..initial };
    let outcome = motion.run(&away, &mut |_, _| true).unwrap();
    assert_eq!((outcome.ball, outcome.ending, words(&outcome)), (None, Ending::AtEnd, vec!["slide reaches its lower limit"]));
}

#[test]
fn who_follows_it_may_end_it() {
    let session = session("initial = { v = { slide = 0.1 } }\nsimulation = { end = 1.0, step = 0.01, integrator = 'rk4' }", CART);
    let mut motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
    let mut told = Vec::new();
    let mut observer = |t: f64, counts: &articulated_motion::Counts| {
        told.push((t, counts.steps));
        counts.steps < 25
    };
    let outcome = motion.run(&session.initial_state().unwrap(), &mut observer).unwrap();
    assert_eq!((outcome.ending, outcome.recording.ended, told.len()), (Ending::ByObserver, Ended::ByObserver, 25));
    assert!((outcome.reached - 0.25).abs() < 1e-12 && told[24].0 == outcome.reached, "{}", outcome.reached);
}

#[test]
fn a_ball_that_nothing_moves_towards_keeps_its_speed() {
    let scene = BLOW.replace("ball = [0.6, 0.0, 0.0]", "time = 0.25\nball_speed = 7.5") + "stop = true\n";
    let outcome = moved(&session(&scene, CART));
    assert_eq!(words(&outcome)[0], "cart is not moving towards the ball, which keeps 7.5000 m/s");
    assert!(outcome.ball.is_none() && (outcome.occurrences[0].t - 0.25).abs() < 1e-9, "{outcome:?}");
    // There is no hit, so the motion does not end.
    assert_eq!((outcome.ending, outcome.reached), (Ending::AtEnd, 1.0));
}

#[test]
fn who_is_as_fast_as_the_ball_does_not_hit_it() {
    let scene = |speed: &str| BLOW.replace("ball = [0.6, 0.0, 0.0]", &format!("time = 0.25\nball_speed = {speed}"));
    let [missed, hit] = ["3.0", "2.0"].map(|speed| moved(&session(&scene(speed), CART)));
    assert_eq!(words(&missed)[0], "cart is not moving towards the ball, which keeps 3.0000 m/s");
    // Its gain is relative to its initial energy: ½ m_b (v² − 2²), v = 2 + (1 + e) m/(m + m_b).
    let after: f64 = 2.0 + 1.8 * 2.0 / 2.5;
    let gets = 0.25 * (after * after - 4.0);
    assert!(missed.ball.is_none() && hit.ball.is_some_and(|energy| (energy - gets).abs() < 1e-8), "{missed:?} {hit:?}");
}

#[test]
fn what_is_where_the_ball_is_at_the_start_hits_it_there() {
    let outcome = moved(&session(&BLOW.replace("0.6", "0.0"), CART));
    assert_eq!((words(&outcome)[0], outcome.occurrences.len()), ("cart hits the ball, which leaves at 4.3200 m/s", 2));
    assert!(outcome.occurrences[0].t < 1e-9, "{outcome:?}");
    let away = moved(&session(&BLOW.replace("0.6", "0.0").replace("slide = 3.0", "slide = -0.1"), CART));
    assert!(away.occurrences.is_empty() && away.ball.is_none(), "{away:?}");
}

/// At its bound to the last bit at the start.
#[test]
fn who_begins_at_a_limit_and_goes_beyond_reaches_it() {
    let scene = |v: f64| {
        format!(
            "gravity = [0, 0, 0]\ninitial = {{ q = {{ slide = 0.5 }}, v = {{ slide = {v} }} }}\nsimulation = {{ end = 0.1, events = ['limits'] }}"
        )
    };
    let urdf = CART.replace("upper=\"0.9\"", "upper=\"0.5\"");
    let [beyond, back] = [1.0, -1.0].map(|v| moved(&session(&scene(v), &urdf)));
    assert_eq!(words(&beyond), ["slide reaches its upper limit"]);
    assert!(beyond.occurrences[0].t < 1e-9 && back.occurrences.is_empty(), "{beyond:?} {back:?}");
}

/// y = 0.25 − 2 x comes to its lower bound, −1, at x = 0.625, and to its upper, 0.75, at x = −0.25.
#[test]
fn a_joint_that_follows_has_bounds_of_its_own() {
    let follower = "<link name='b'/><joint name='y' type='prismatic'><parent link='rail'/><child link='b'/><axis xyz='1 0 0'/>
        <limit lower='-1' upper='0.75' effort='1' velocity='1'/><mimic joint='slide' multiplier='-2' offset='0.25'/></joint></robot>";
    let urdf = CART.replace("</robot>", follower);
    for (v, at, which, kind) in [(1.25, 0.5, "lower", EventKind::LowerLimit), (-0.5, 0.5, "upper", EventKind::UpperLimit)] {
        let scene =
            format!("gravity = [0, 0, 0]\ninitial = {{ v = {{ slide = {v} }} }}\nsimulation = {{ end = 0.6, events = ['limits'] }}");
        let outcome = moved(&session(&scene, &urdf));
        assert_eq!(words(&outcome), [format!("y reaches its {which} limit")]);
        assert_eq!(about(&outcome), [is(kind, "y", true), None]);
        assert!((outcome.occurrences[0].t - at).abs() < 1e-9, "{:?}", outcome.occurrences);
    }
    let session = session("", &urdf);
    let told = |x: f64| session.beyond(&[x]).iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(told(0.75), ["s.toml: initial.q.y: found -1.25, beyond its limits, expected -1 to 0.75; used as given"]);
    assert_eq!((told(0.25).len(), told(1.0).len()), (0, 2));
}

/// With the bound of the effect, or else that of an MJCF file, on the angle of the rotation.
#[test]
fn a_ball_joint_comes_to_the_bound_of_its_angle() {
    let urdf = "<robot name='r'><link name='base'/><joint name='hip' type='spherical'><parent link='base'/><child link='rod'/></joint>
        <link name='rod'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>";
    let mjcf = "<mujoco><compiler angle='radian'/><worldbody><body name='rod'><joint name='hip' type='ball' range='0 0.5'/>
        <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>";
    let scene = "gravity = [0, 0, 0]\ninitial = { v = { hip = [0.6, 0.0, -0.8] } }\nsimulation = { end = 0.6, events = ['limits'] }\n";
    let effect = "[effects.limit.hip]\nupper = 0.5\nstiffness = 10\n";
    for (scene, robot) in [(format!("{scene}{effect}"), urdf), (scene.to_owned(), mjcf)] {
        let outcome = moved(&session(&scene, robot));
        assert_eq!(words(&outcome), ["hip reaches its upper limit"]);
        assert_eq!(about(&outcome), [is(EventKind::UpperLimit, "hip", true), None]);
        assert!((outcome.occurrences[0].t - 0.5).abs() < 1e-6, "{:?}", outcome.occurrences);
    }
    let session = session("", mjcf);
    let told = |half: f64| session.beyond(&[0.0, -half.sin(), 0.0, -half.cos()]).iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(told(0.5), ["s.toml: initial.q.hip: found 1, beyond its limits, expected 0 to 0.5; used as given"]);
    assert!(told(0.2).is_empty());
}

/// A joint that follows another with multiplier 0 does not move: its bounds and its friction have
/// no events, at any position.
#[test]
fn a_joint_that_follows_and_stands_still_has_no_events() {
    let follower = "<link name='b'/><joint name='y' type='prismatic'><parent link='rail'/><child link='b'/><axis xyz='1 0 0'/>
        <limit lower='-1' upper='0.25' effort='1' velocity='1'/><mimic joint='slide' multiplier='0' offset='0.5'/></joint></robot>";
    let scene = "effects = { friction = { y = { friction = 2.0, speed = 1e-4 } } }\nsimulation = { end = 0.1, events = ['stick_slip'] }";
    let session = session(scene, &CART.replace("</robot>", follower));
    let detectors = Detectors::new(&session, &session.model, &session.frame_names()).unwrap();
    assert_eq!(detectors.unavailable, [UnavailableEvent { file: "s.toml".into(), what: EventClass::StickSlip, joint: None }]);
    assert!(detectors.events.is_empty() && session.beyond(&[0.0]).is_empty());
}

/// y = −2 x stops sliding below ten times 0.01 m/s: x = 0.5 t − ½ t² below 0.05, from 0.45 s to
/// 0.55 s.
#[test]
fn a_joint_that_follows_slides_at_its_own_rate() {
    let follower = "<link name='b'/><joint name='y' type='prismatic'><parent link='rail'/><child link='b'/><axis xyz='1 0 0'/>
        <limit lower='-1' upper='1' effort='1' velocity='1'/><mimic joint='slide' multiplier='-2'/></joint></robot>";
    let scene = "initial = { v = { slide = 0.5 } }
        control = { kind = 'torque', torque = { slide = -2.0 } }
        effects = { friction = { y = { friction = 1e-9, speed = 0.01 } } }
        simulation = { end = 1.0, events = ['stick_slip'] }";
    let outcome = moved(&session(scene, &CART.replace("</robot>", follower)));
    assert_eq!(words(&outcome), ["y stops sliding", "y starts to slide"]);
    for (occurrence, t) in outcome.occurrences.iter().zip([0.45, 0.55]) {
        assert!((occurrence.t - t).abs() < 1e-6, "{occurrence:?} {t}");
    }
}

/// y = 2 x² with x = 0.5 t − ½ t²: it is beyond 0.02 m while x is beyond 0.1, from 0.2764 s to
/// 0.7236 s, and slides while |ẏ| = |4 x ẋ| is above ten times 0.005 m/s.
#[test]
fn a_joint_that_follows_by_a_polynomial_has_its_own_bounds_and_rate() {
    let follower = "<link name='b'/><joint name='y' type='prismatic'><parent link='rail'/><child link='b'/><axis xyz='1 0 0'/>
        <limit lower='-1' upper='0.02' effort='1' velocity='1'/></joint></robot>";
    let scene = "initial = { v = { slide = 0.5 } }
        coupling = { y = { joint = ['slide'], polynomial = [0, 0, 2] } }
        control = { kind = 'torque', torque = { slide = -2.0 } }
        effects = { friction = { y = { friction = 1e-9, speed = 0.005 } } }
        simulation = { end = 0.9, events = ['limits', 'stick_slip'] }";
    let outcome = moved(&session(scene, &CART.replace("</robot>", follower)));
    let of = |kind: EventKind| {
        let is_own = |about: &SceneEvent| about.kind == kind && about.on == "y";
        outcome.occurrences.iter().filter(|o| o.about.as_ref().is_some_and(is_own)).map(|o| o.t).collect::<Vec<f64>>()
    };
    let (bounds, slides) = (of(EventKind::UpperLimit), of(EventKind::StickSlip));
    let expected = [0.5 - 0.05_f64.sqrt(), 0.5 + 0.05_f64.sqrt()];
    assert!(bounds.len() == 2 && bounds.iter().zip(expected).all(|(t, e)| (t - e).abs() < 1e-6), "{bounds:?}");
    let rate = |t: f64| (4.0 * (0.5 * t - 0.5 * t * t) * (0.5 - t)).abs();
    assert!(slides.len() == 3 && slides.iter().all(|t| (rate(*t) - 0.05).abs() < 1e-6), "{slides:?}");
}

#[test]
fn contacts_and_ends_of_sliding_are_found_and_told() {
    let fall = "initial = { q = { shoulder = 1.2 } }
        effects = { contact = { hand = { radius = 0.05, stiffness = 1e4, damping = 1.0, friction = 0.5, height = 0.12 } } }
        simulation = { end = 1.0, integrator = 'rodas4', events = ['contacts'] }";
    let outcome = moved(&session(fall, ARM));
    assert_eq!(words(&outcome)[..2], ["hand touches the ground", "hand leaves the ground"]);
    let contact = |begins| is(EventKind::Contact { number: 1, of: 1 }, "hand", begins);
    assert_eq!(about(&outcome), [contact(true), contact(false)]);
    // Friction of 2 N stops 2 kg at 0.5 m/s after half a second.
    let slide = "initial = { v = { slide = 0.5 } }
        effects = { friction = { slide = { friction = 2.0, speed = 1e-4 } } }
        simulation = { end = 1.0, integrator = 'rodas4', events = ['stick_slip'] }";
    let outcome = moved(&session(slide, CART));
    assert_eq!(words(&outcome), ["slide stops sliding"]);
    assert!((outcome.occurrences[0].t - 0.5).abs() < 1e-3, "{:?}", outcome.occurrences);
}

/// A puck of 2 kg, held back by 2 N along each axis: each of its numbers stops by itself.
#[test]
fn numbers_of_one_joint_are_told_apart() {
    let puck = CART.replace("prismatic", "planar").replace("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"0 0 1\"/>");
    let scene = "gravity = [0, 0, 0]
        initial = { v = { slide = [0.5, 0.25, 0.0] } }
        effects = { friction = { slide = { friction = 2.0, speed = 1e-4 } } }
        simulation = { end = 1.0, integrator = 'rodas4', events = ['stick_slip'] }";
    let outcome = moved(&session(scene, &puck));
    assert_eq!(words(&outcome), ["slide[1] stops sliding", "slide[0] stops sliding"]);
    assert_eq!(about(&outcome), ["slide[1]", "slide[0]"].map(|on| is(EventKind::StickSlip, on, true)));
}

#[test]
fn sorts_of_events_that_cannot_happen_are_told() {
    let session = session("simulation = { end = 0.1, events = ['contacts', 'limits', 'stick_slip'] }", CART);
    let motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
    let expected = [EventClass::Contacts, EventClass::StickSlip].map(|what| UnavailableEvent { file: "s.toml".into(), what, joint: None });
    assert_eq!(motion.unavailable_events(), expected);
    let told = r#"s.toml: simulation.events: found "contacts", expected an effect contact of the scene; nothing to look for"#;
    assert_eq!(motion.unavailable_events()[0].to_string(), told);
}

/// A `<limit>` with effort and velocity alone: its bounds are 0 and 0.
#[test]
fn joints_whose_bounds_nothing_is_between_are_told_and_left_out() {
    let urdf = CART.replace("lower=\"-0.5\" upper=\"0.9\" ", "");
    let session = session("simulation = { end = 0.1, events = ['limits'] }", &urdf);
    let motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
    let told: Vec<String> = motion.unavailable_events().iter().map(ToString::to_string).collect();
    assert!(told.len() == 1 && told[0].contains("found joint \"slide\" without a lower bound below"), "{told:?}");
    assert!(moved(&session).occurrences.is_empty());
}

#[test]
fn contacts_of_one_link_are_told_apart() {
    let ball = "radius = 0.1, stiffness = 10.0, damping = 0.1, friction = 0.5, normal = [-1, 0, 0]";
    let scene = format!(
        "gravity = [0, 0, 0]\ninitial = {{ v = {{ slide = 1.0 }} }}\nsimulation = {{ end = 0.5, events = ['contacts'] }}
        effects.contact.cart = [{{ {ball}, height = -0.3 }}, {{ {ball}, height = -0.4 }}]"
    );
    // Contacts of another link do not count.
    let bumper = "<link name='bumper'/><joint name='glue' type='fixed'><parent link='cart'/><child link='bumper'/></joint></robot>";
    let scene =
        scene.replace("effects.contact.cart", &format!("effects.contact.bumper = {{ {ball}, height = -9 }}\n        effects.contact.cart"));
    let told = moved(&session(&scene, &CART.replace("</robot>", bumper)));
    assert_eq!(words(&told)[..2], ["cart (contact 1 of 2) touches the ground", "cart (contact 2 of 2) touches the ground"]);
    assert_eq!(about(&told), [1, 2].map(|number| is(EventKind::Contact { number, of: 2 }, "cart", true)));
}

#[test]
fn a_sphere_that_starts_with_its_centre_under_the_plane_is_told() {
    let of = |height: f64| {
        let session = session(
            &format!("effects.contact.cart = {{ radius = 0.1, stiffness = 1e3, damping = 0.1, friction = 0.5, height = {height} }}"),
            CART,
        );
        session.sunk(&[0.0]).iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(of(0.0), Vec::<String>::new());
    let told = of(0.25);
    assert!(told.len() == 1 && told[0].contains("effects.contact.cart: found the centre of the sphere 0.25 m under the plane"), "{told:?}");
}

/// A normal is a direction; the height is counted in metres along it.
#[test]
fn how_far_a_sphere_is_under_the_plane_does_not_depend_on_the_length_of_the_normal() {
    for normal in ["[0, 0, 1]", "[0, 0, 2]", "[0, 0, 0.1]", "[0, 0, 1e-200]", "[0, 0, 1e200]"] {
        let contact =
            format!("radius = 0.1, stiffness = 1e3, damping = 0.1, friction = 0.5, normal = {normal}, height = 0.1, xyz = [0, 0, 0.09]");
        let session = session(&format!("effects = {{ contact = {{ cart = {{ {contact} }} }} }}"), CART);
        let [sunk] = &session.sunk(&[0.0])[..] else { panic!("{normal}") };
        assert!((sunk.depth - 0.01).abs() < 1e-15, "{normal}: {}", sunk.depth);
    }
    // 0.1 − (0.6·0.05 + 0.8·0.02)
    let contact = "radius = 0.1, stiffness = 1e3, damping = 0.1, friction = 0.5, normal = [3, 0, 4], height = 0.1, xyz = [0.05, 0, 0.02]";
    let session = session(&format!("effects = {{ contact = {{ cart = {{ {contact} }} }} }}"), CART);
    assert!((session.sunk(&[0.0])[0].depth - 0.054).abs() < 1e-15, "{:?}", session.sunk(&[0.0]));
}

#[test]
fn an_error_on_the_way_leaves_what_was_up_to_there() {
    let scene = "initial = { v = { slide = 1.0 } }
        simulation = { end = 1.0, integrator = 'rk4', step = 0.01, max_steps = 30, output = 'steps' }";
    let outcome = moved(&session(scene, CART));
    assert_eq!((outcome.ending, outcome.recording.len()), (Ending::ByError, 31));
    assert!(outcome.error.unwrap().to_string().starts_with("30 steps were made") && (outcome.reached - 0.3).abs() < 1e-12);
}

/// y = 0.5 slide − 2 side + 0.25 has bounds and friction of its own.
#[test]
fn a_joint_that_follows_several_has_events_of_its_own() {
    let more = "<link name='b'/><link name='c'/>
        <joint name='side' type='prismatic'><parent link='rail'/><child link='c'/><axis xyz='0 1 0'/><limit lower='-9' upper='9' effort='1' velocity='1'/></joint>
        <joint name='y' type='prismatic'><parent link='rail'/><child link='b'/><axis xyz='1 0 0'/><limit lower='-1' upper='0.75' effort='1' velocity='1'/>
        <dynamics damping='1' friction='0'/><mimic joint='slide' multiplier='0.5' offset='0.25'/><mimic joint='side' multiplier='-2'/></joint></robot>";
    let urdf = CART.replace("</robot>", more).replace(
        "<link name='c'/>",
        "<link name='c'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>",
    );
    let scene = |effects: &str| {
        format!(
            "gravity = [0, 0, 0]\n initial = {{ q = {{ side = 0.1 }}, v = {{ slide = 1.0, side = -0.5 }} }}\n\
             simulation = {{ end = 0.7, rtol = 1e-10, atol = 1e-12, events = ['limits'] }}\n{effects}"
        )
    };
    // y = 0.05 + 1.5 t: at 0.75 after 7/15 s.
    let outcome = moved(&session(&scene(""), &urdf));
    let found = outcome.occurrences.iter().find(|one| one.what.contains("y reaches")).expect("a bound is reached");
    assert_eq!(found.about, is(EventKind::UpperLimit, "y", true));
    assert!((found.t - 7.0 / 15.0).abs() < 1e-9, "{found:?}");
    // A damper on it takes from both: 2 v̇₁ = −0.5 f, 1 v̇₂ = 2 f with f = 1 · (0.5 v₁ − 2 v₂).
    let outcome = moved(&session(&scene("effects = { damping = 'file' }"), &urdf));
    let rate = 0.125 + 4.0;
    // The rate of y is 1.5 e⁻ʳᵗ, r = 0.125 + 4; here integrated twice.
    let end = 0.7;
    let decay = 1.5 * (end - (1.0 - f64::exp(-rate * end)) / rate) / rate;
    let last = outcome.recording.q_at(outcome.recording.len() - 1).to_vec();
    for (found, expected) in last.iter().zip([end - 0.25 * decay, 0.1 - 0.5 * end + 2.0 * decay]) {
        assert!((found - expected).abs() < 1e-8, "{last:?}, expected {expected}");
    }
    // At the start it may be beyond its own bounds.
    let start = session(&scene(""), &urdf);
    let beyond: Vec<(String, f64)> = start.beyond(&[0.2, -0.5]).into_iter().map(|one| (one.joint, one.found)).collect();
    assert_eq!((beyond[0].0.as_str(), (beyond[0].1 - 1.35).abs() < 1e-15, beyond.len()), ("y", true, 1), "{beyond:?}");
    assert!(start.beyond(&[0.2, 0.1]).is_empty());
}
