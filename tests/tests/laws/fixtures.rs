//! Against Pinocchio and MuJoCo, with results in our conventions in `tests/fixtures` (see
//! `tests/oracles/README.md`).

use std::collections::BTreeSet;

use articulated_core::algorithm::{function, functions};
use articulated_tests::answers::{Answered, Answers, answers};
use articulated_tests::case::Case;

/// Error allowed, relative to the result's largest entry or to 1. Both sides round, and solutions
/// with the mass matrix include its condition number, up to 2·10⁶ (golfer). Seen: 3·10⁻¹³ there,
/// 1.2·10⁻¹³ elsewhere.
const TOLERANCE: f64 = 1e-12;

/// Functions that no engine provides: random numbers are its own; and functions of effects, which
/// have laws and closed forms of their own (`effects.rs`, `effects_closed.rs` of core).
const WITHOUT: [&str; 5] = ["random_configuration", "effect_forces", "dissipation", "motor_torques", "joint_regressor"];

/// The first difference of results; `None` if they agree.
fn parting(case: &Case, state: &Answered, name: &str, expected: &[f64]) -> Option<String> {
    let Some(row) = function::<f64>(name) else { return Some(format!("{name} is not in the registry")) };
    let given = |argument: &str| state.arguments.get(argument).map(Vec::as_slice);
    let Some(arguments) = row.takes.iter().map(|a| given(a.name())).collect::<Option<Vec<_>>>() else {
        return Some(format!("{name}: the fixture lacks one of {:?}", row.takes));
    };
    let found = case.call::<f64>(name, &arguments);
    if found.len() != expected.len() {
        return Some(format!("{name}: {} numbers instead of {}", found.len(), expected.len()));
    }
    let size = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let error = |(f, e): (&f64, &f64)| (f - e).abs() / size;
    let (at, worst) =
        found.iter().zip(expected).map(error).enumerate().fold((0, 0.0), |most, (k, e)| if e <= most.1 { most } else { (k, e) });
    if worst <= TOLERANCE {
        return None;
    }
    Some(format!("{name}, number {at}: {} instead of {}, largest entry {size}: off by {worst:.1e}", found[at], expected[at]))
}

fn partings(answers: &Answers) -> Vec<String> {
    let (case, mut all) = (answers.case(), Vec::new());
    for (k, state) in answers.states.iter().enumerate() {
        let case = state.of(&case);
        let partings = state.results.iter().filter_map(|(name, expected)| parting(&case, state, name, expected));
        all.extend(partings.map(|text| format!("{}, state {k}: {text}", case.name)));
    }
    all
}

#[test]
fn every_function_gives_what_other_engines_give() {
    let partings: Vec<String> = answers().iter().flat_map(partings).collect();
    assert!(partings.is_empty(), "{} results:\n{}", partings.len(), partings.join("\n"));
}

#[test]
fn every_function_has_been_asked_of_another_engine() {
    let answers = answers();
    let asked: BTreeSet<&str> = answers.iter().flat_map(|a| &a.states).flat_map(|s| s.results.keys()).map(String::as_str).collect();
    let all = functions::<f64>().iter().map(|f| f.name);
    let missing: Vec<&str> = all.filter(|name| !asked.contains(name) && !WITHOUT.contains(name)).collect();
    assert!(missing.is_empty(), "no fixture holds {missing:?}: add them to tests/oracles/engines/results.py");
}

#[test]
fn engines_were_asked_about_the_same_robots() {
    for answers in answers() {
        let Case { name, model, .. } = answers.case();
        let joints: Vec<&String> = model.joints().iter().map(|j| &j.name).collect();
        let links: Vec<&String> = model.links().map(|i| &model.bodies()[i].name).collect();
        assert_eq!(joints, answers.joints.iter().collect::<Vec<_>>(), "{name}");
        assert_eq!(links, answers.links.iter().collect::<Vec<_>>(), "{name}");
        assert_eq!((model.nq(), model.nv()), (answers.nq, answers.nv), "{name}");
        assert!(!answers.states.is_empty(), "{name}");
    }
}
