//! Effects against MuJoCo, with accelerations in `tests/fixtures/effects`.

use articulated_core::description::Origin;
use articulated_core::effect::{Applied, effect};
use articulated_tests::case::Case;
use serde::Deserialize;

#[derive(Deserialize)]
struct Answers {
    engine: String,
    cases: Vec<Answer>,
}

/// One robot subject to some effects.
#[derive(Deserialize)]
struct Answer {
    robot: String,
    case: String,
    gravity: [f64; 3],
    joints: Vec<String>,
    effects: Vec<Written>,
    states: Vec<State>,
}

#[derive(Deserialize)]
struct Written {
    effect: String,
    on: String,
    xyz: [f64; 3],
    rpy: [f64; 3],
    parameters: Vec<f64>,
}

#[derive(Deserialize)]
struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    a: Vec<f64>,
}

/// `tests/oracles/effects_fixtures.py` wrote the answers.
#[test]
fn accelerations_are_mujocos() {
    let answers: Answers = serde_json::from_str(include_str!("../../fixtures/effects/mujoco.json")).expect("the fixture");
    assert_eq!(answers.cases.len(), 12, "{}", answers.engine);
    for answer in &answers.cases {
        let case = Case::bundled(articulated_models::robot(&answer.robot).expect("a bundled robot")).with_gravity(answer.gravity);
        assert!(case.model.joints().iter().map(|j| &j.name).eq(&answer.joints), "{}", answer.robot);
        let applied = |w: &Written| Applied {
            effect: effect(&w.effect).expect("a known effect").id,
            on: w.on.clone(),
            at: Origin::new(w.xyz, w.rpy),
            parameters: w.parameters.clone(),
        };
        let effects: Vec<Applied> = answer.effects.iter().map(applied).collect();
        let model = case.model.clone().with_effects(&effects).expect("effects that can be had");
        for state in &answer.states {
            let found = Case { model: model.clone(), ..case.clone() }.call::<f64>("forward_dynamics", &[&state.q, &state.v, &state.tau]);
            let scale = state.a.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            for (f, e) in found.iter().zip(&state.a) {
                assert!((f - e).abs() <= 1e-10 * scale, "{} {}: {f} instead of {e}", answer.robot, answer.case);
            }
        }
    }
}
