//! The algorithms against two others with which they share no formula.

use articulated_core::Scalar;
use articulated_core::algorithm::textbook::Textbook;
use articulated_core::algorithm::{Needs, Workspace, functions};
use articulated_reference::Big;
use articulated_test_support::case::{Case, State, cast, for_each_bundled, placements};
use articulated_test_support::measure::{arguments, distance, distance_from, scale, torque_scale};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;

use crate::trees::for_each_tree;

/// Errors allowed, in units of u times the magnitude of the terms. Seen: 8 on 60 random trees.
const FEW: f64 = 16.0;

/// Functions that have a scale which shares nothing with the library.
const MEASURED: [&str; 5] = ["placements", "inverse_dynamics", "bias_forces", "gravity_torque", "mass_matrix"];

pub(crate) fn textbook_holds(case: &Case, random: &mut Random) {
    let state = case.state(random);
    for name in MEASURED {
        let given = arguments(name, &state);
        let far = Big::scope(|| {
            let expected = case.textbook::<Big>().call(name, &slices(&precise(&given))).unwrap().unwrap();
            distance_from(&case.call::<f64>(name, &given), &expected, &scale(case, name, &state))
        });
        assert!(far <= FEW, "{name}: {far:?} units of roundoff");
    }
}

#[test]
fn recursion_is_the_textbook_in_many_digits() {
    for_each_tree(60, Flavour::ANY, textbook_holds);
    for_each_tree(60, Flavour::BENT, textbook_holds);
    for_each_bundled(textbook_holds);
}

fn precise(given: &[&[f64]]) -> Vec<Vec<Big>> {
    given.iter().map(|x| cast(x)).collect()
}

fn slices(given: &[Vec<Big>]) -> Vec<&[Big]> {
    given.iter().map(Vec::as_slice).collect()
}

/// Rounding alone: each function in double precision, and in many digits from the same constants.
fn rounding_is_small(case: &Case, random: &mut Random, wanted: impl Fn(Needs) -> bool) {
    let state = case.state(random);
    for name in functions::<f64>().iter().filter(|f| wanted(f.needs)).map(|f| f.name) {
        let given = arguments(name, &state);
        let far = Big::scope(|| {
            let expected = case.call::<Big>(name, &slices(&precise(&given)));
            distance_from(&case.call::<f64>(name, &given), &expected, &scale(case, name, &state))
        });
        assert!(far <= FEW, "{name}: {far:?} units of roundoff");
    }
}

#[test]
fn rounding_moves_no_result_by_more_than_a_few_units() {
    let law = |case: &Case, random: &mut Random| {
        rounding_is_small(case, random, |needs| needs == Needs::Nothing || needs == Needs::Mass && case.model.moving_mass() > 0.0);
    };
    for_each_tree(40, Flavour::ANY, law);
    for_each_bundled(law);
}

/// Relative to the effect of a backward error of one unit.
#[test]
fn nor_what_is_solved_with_the_mass_matrix() {
    for_each_tree(20, Flavour::REGULAR, |case, random| rounding_is_small(case, random, |needs| needs == Needs::MassMatrix));
}

#[test]
fn the_textbook_in_double_precision_is_the_textbook_in_many_digits() {
    for_each_tree(20, Flavour::ANY, |case, random| {
        let state = case.state(random);
        let found = case.textbook::<f64>().inverse_dynamics(&state.q, &state.v, &state.a);
        let far = Big::scope(|| {
            let [q, v, a] = state.cast::<Big>();
            let expected = case.textbook::<Big>().inverse_dynamics(&q, &v, &a);
            // It forms linear velocities, which cancel only in the end: every torque is as good as
            // the largest.
            let largest = torque_scale(case, &state).into_iter().fold(0.0, f64::max);
            distance_from(&found, &expected, &vec![largest; found.len()])
        });
        assert!(far <= FEW, "{far} units of roundoff");
    });
}

fn virtual_power_holds(case: &Case, random: &mut Random) {
    let state = case.state(random);
    let motions = case.motions();
    assert_eq!(motions.size, (case.model.nq(), case.model.nv()));
    let scale = torque_scale(case, &state);
    let expected = motions.inverse_dynamics(&state.q, &state.v, &state.a);
    let far = distance(&case.inverse_dynamics(&state), &expected, &scale);
    assert!(far <= 2.0 * FEW, "torques: {far} units of roundoff");
    let far = distance(
        &placements(&case.model, &state.q),
        &motions.placements(&state.q),
        &articulated_test_support::measure::scale(case, "placements", &state),
    );
    assert!(far <= 2.0 * FEW, "placements: {far} units of roundoff");
}

#[test]
fn torques_are_those_of_virtual_power() {
    for_each_tree(200, Flavour::ANY, virtual_power_holds);
    for_each_tree(100, Flavour::BENT, virtual_power_holds);
    for_each_bundled(virtual_power_holds);
}

/// Two derivations without common parts, to 60 digits: no tolerance can hide an error.
#[test]
fn textbook_and_virtual_power_agree_to_sixty_digits() {
    for_each_tree(12, Flavour { links: 6, ..Flavour::BENT }, |case, random| {
        let state = case.state(random);
        Big::scope(|| {
            let [mut q, v, a] = state.cast::<Big>();
            normalise(case, &mut q);
            let textbook: Textbook<Big> = case.textbook();
            let expected = textbook.inverse_dynamics(&q, &v, &a);
            let found = case.motions().inverse_dynamics(&q, &v, &a);
            for (k, (e, f)) in expected.iter().zip(&found).enumerate() {
                let error = (*e - *f).to_f64().abs();
                assert!(error <= 1e-60 * torque_scale(case, &state)[k], "torque {k}: {error:e}");
            }
        });
    });
}

/// A double's quaternion has a norm of one to 16 digits only, and the two forms use the rest
/// differently.
fn normalise(case: &Case, q: &mut [Big]) {
    for joint in case.model.joints().iter().filter(|j| matches!(j.q.1, 4 | 7)) {
        let end = joint.q.0 + joint.q.1;
        let x = &mut q[end - 4..end];
        let square = x.iter().fold(Big::from_f64(0.0), |s, c| s + *c * *c);
        let norm = square.sqrt();
        x.iter_mut().for_each(|c| *c = *c / norm);
    }
}

#[test]
fn bias_forces_and_gravity_torque_are_inverse_dynamics_at_rest() {
    for_each_tree(30, Flavour::ANY, |case, random| {
        let State { q, v, .. } = case.state(random);
        let zero = vec![0.0; v.len()];
        assert_eq!(case.call::<f64>("bias_forces", &[&q, &v]), case.call::<f64>("inverse_dynamics", &[&q, &v, &zero]));
        assert_eq!(case.call::<f64>("gravity_torque", &[&q]), case.call::<f64>("inverse_dynamics", &[&q, &zero, &zero]));
    });
}

/// A workspace keeps nothing from one call to the next.
#[test]
fn a_result_does_not_depend_on_the_calls_before() {
    for_each_tree(10, Flavour::REGULAR, |case, random| {
        let mut shared = Workspace::new(&case.model);
        for row in functions::<f64>().iter().chain(functions::<f64>()) {
            let state = case.state(random);
            let mut out = vec![f64::NAN; row.len(case.model.shape())];
            row.call(&case.model, &mut shared, &arguments(row.name, &state), &mut out).unwrap();
            let alone = case.call::<f64>(row.name, &arguments(row.name, &state));
            let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&out), bits(&alone), "{}", row.name);
        }
    });
}
