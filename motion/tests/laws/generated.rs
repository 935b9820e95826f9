//! Generated robots move as the generic model does.

use articulated::simulate::IntegratorId;

use super::{ARM, moved, stage, words};

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
    let stage = stage(SCENE, ARM);
    assert_eq!(stage.frames(), arm::FRAME_NAMES);
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
    assert_eq!(stage.functions(IntegratorId::dopri5), functions);
}

/// Bounds on coordinates and rates, rad and rad/s: 1e-13 until the hand touches the ground, by rounding; 1e-6 to the end, a thousand tolerances, as steps
/// over a contact that begins are not smooth.
#[test]
fn a_generated_robot_moves_as_the_generic_one() {
    let stage = stage(SCENE, ARM);
    let (generic, generated) = (moved(&stage), stage.run(&arm::Robot, &arm::FRAME_NAMES).unwrap());
    assert_eq!(words(&generic), words(&generated));
    let all = words(&generic).join("; ");
    assert!(["limit", "ground", "sticks", "hand hits the ball"].iter().all(|what| all.contains(what)), "{all}");
    let (a, b) = (&generic.recording, &generated.recording);
    assert_eq!((a.len(), &a.t), (25, &b.t));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let apart_at = |k: usize| apart(a.q_at(k), b.q_at(k)).max(apart(a.v_at(k), b.v_at(k)));
    let touch = generic.happenings.iter().find(|h| h.what == "hand touches the ground").unwrap().t;
    let before = a.t.iter().take_while(|t| **t < touch).count();
    let [early, late] = [0..before, before..25].map(|rows| rows.map(apart_at).fold(0.0, f64::max));
    assert!(before > 2 && early < 1e-13 && late < 1e-6, "{before}: {early:e}, {late:e}");
    assert!((generic.ball.unwrap() - generated.ball.unwrap()).abs() < 1e-6);
    assert!(b.missing.is_empty(), "{:?}", b.missing);
}
