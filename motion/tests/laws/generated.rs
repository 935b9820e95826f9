//! Generated robots move as the generic model does.

use articulated::simulate::IntegratorId;

use super::{ARM, CART, moved, session, words};

const SCENE: &str = include_str!("arm.toml");

articulated::robot! {
    mod arm {
        scene = "tests/laws/arm.toml",
        functions = [motion],
        frames = [hand],
    }
}

#[test]
fn a_robot_is_generated_with_what_the_scene_needs() {
    let session = session(SCENE, ARM);
    assert_eq!(session.frames(), arm::FRAME_NAMES);
    let functions = [
        "forward_dynamics",
        "integrate",
        "difference",
        "placements",
        "jacobians_world_aligned",
        "solve_mass_matrix",
        "kinetic_energy",
        "potential_energy",
        "centroidal_momentum",
        "dissipation",
        "motor_torques",
    ];
    assert_eq!(session.functions(IntegratorId::dopri5), functions);
}

/// Functions without effect are not requested: momentum without mass, losses without effects. A
/// frame that two parts of the scene need is listed once.
#[test]
fn a_robot_is_generated_without_what_the_scene_has_not() {
    let told = |scene: &str, urdf: &str| {
        let functions = session(scene, urdf).functions(IntegratorId::dopri5);
        ["centroidal_momentum", "dissipation", "motor_torques"].map(|name| functions.contains(&name))
    };
    let effects = "effects = { damping = { slide = { damping = 1.0 } } }";
    assert_eq!(told(effects, CART), [true; 3]);
    assert_eq!(told("", CART), [true, false, false]);
    assert_eq!(told(effects, &CART.replace("<mass value=\"2\"/>", "<mass value=\"0\"/>")), [false, true, true]);
    let hook = "<link name='hook'/><joint name='glue' type='fixed'><parent link='cart'/><child link='hook'/></joint></robot>";
    let ball = "{ radius = 0.1, stiffness = 10.0, damping = 0.1, friction = 0.5 }";
    let scene = format!(
        "effects.contact = {{ cart = {ball}, hook = {ball} }}\nsimulation = {{ end = 1.0, events = ['contacts'] }}
        impact = {{ link = 'cart', normal = [1, 0, 0], mass = 0.5, restitution = 0.8, time = 0.5 }}"
    );
    assert_eq!(session(&scene, &CART.replace("</robot>", hook)).frames(), ["cart", "hook"]);
}

/// Bounds on coordinates and rates, rad and rad/s: 1e-13 until the hand touches the ground, by
/// rounding; 1e-6 to the end, a thousand tolerances, as steps over a contact that begins are not
/// smooth.
#[test]
fn a_generated_robot_moves_as_the_generic_one() {
    let session = session(SCENE, ARM);
    let (generic, generated) = (moved(&session), session.run(&arm::Robot, &arm::FRAME_NAMES).unwrap());
    assert_eq!(words(&generic), words(&generated));
    let all = words(&generic).join("; ");
    assert!(["limit", "ground", "stops sliding", "hand hits the ball"].iter().all(|what| all.contains(what)), "{all}");
    let (a, b) = (&generic.recording, &generated.recording);
    assert_eq!((a.len(), &a.t), (25, &b.t));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let apart_at = |k: usize| apart(a.q_at(k), b.q_at(k)).max(apart(a.v_at(k), b.v_at(k)));
    let touch = generic.occurrences.iter().find(|h| h.what == "hand touches the ground").unwrap().t;
    let before = a.t.iter().take_while(|t| **t < touch).count();
    let [early, late] = [0..before, before..25].map(|rows| rows.map(apart_at).fold(0.0, f64::max));
    assert!(before > 2 && early < 1e-13 && late < 1e-6, "{before}: {early:e}, {late:e}");
    assert!((generic.ball.unwrap() - generated.ball.unwrap()).abs() < 1e-6);
    assert!(b.missing.is_empty(), "{:?}", b.missing);
}
