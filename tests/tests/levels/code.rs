//! Generated code of every level, compiled and run.

use articulated_codegen::{Arithmetic, Generated, Precision, Request, bound, generate};
use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, function};
use articulated_core::model::Model;
use articulated_lab::compiled::{Compiled, Rustc, Target};
use articulated_lab::states;
use articulated_reference::Big;

const FUNCTION: &str = "inverse_dynamics";

fn generated(robot: &str, level: Precision) -> Generated {
    let bundled = articulated_models::robot(robot).unwrap();
    let mut request = Request::new(format!("{robot}.urdf"), bundled.urdf);
    request.options.robot.base = bundled.base;
    request.options.functions = vec![FUNCTION.into()];
    request.options.level = level;
    generate(&request).unwrap()
}

fn level(name: &str) -> Precision {
    name.parse().unwrap()
}

struct BuiltRobot {
    level: Precision,
    generated: Generated,
    compiled: Compiled,
}

fn build(robot: &str, name: &str, target: Target) -> BuiltRobot {
    let level = level(name);
    let generated = generated(robot, level);
    let compiled = Compiled::build_for(target, &Rustc::find().unwrap(), &generated).unwrap();
    BuiltRobot { level, generated, compiled }
}

impl BuiltRobot {
    fn call(&self, state: &[Vec<f64>]) -> Vec<f64> {
        let mut out = vec![0.0; self.generated.model.nv()];
        let arguments: Vec<&[f64]> = state.iter().map(Vec::as_slice).collect();
        self.compiled.call(FUNCTION, &arguments, &mut out).unwrap();
        out
    }

    /// The results in 96 digits; to be called in their scope.
    fn exact(&self, state: &[Vec<f64>]) -> Vec<Big> {
        self.generated.graphs[0].evaluate_as(|argument, k| Big::from_f64(state[argument][k]))
    }

    /// The error and the guaranteed bound of each result, after comparing them. The state has
    /// numbers of single precision.
    fn errors(&self, state: &[Vec<f64>], exact: &[Big]) -> Vec<(f64, Option<f64>)> {
        let found = self.call(state);
        let bounds = bound::bounds(&self.generated.graphs[0], self.level, &|argument, k| (state[argument][k], 0.0));
        let one = |(k, (exact, found)): (usize, (&Big, &f64))| {
            let error = (Big::from_f64(*found) - *exact).to_f64().abs();
            let bound = bounds.as_ref().map(|b| b[k]);
            assert!(bound.is_none_or(|bound| error <= bound), "{}: result {k} is off by {error:e}, bound {bound:?}", self.level);
            (error, bound)
        };
        exact.iter().zip(&found).enumerate().map(one).collect()
    }

    /// The largest error in these states.
    fn worst(&self, states: &[Vec<Vec<f64>>]) -> f64 {
        let errors = states.iter().flat_map(|state| Big::scope(|| self.errors(state, &self.exact(state))));
        errors.map(|e| e.0).fold(0.0, f64::max)
    }
}

/// In numbers that `f32` has too, some with angles far out.
fn some_states(robot: &str, count: usize) -> Vec<Vec<Vec<f64>>> {
    states_of(&generated(robot, Precision::default()).model, count, 5)
}

fn states_of(model: &Model<f64>, count: usize, seed: u64) -> Vec<Vec<Vec<f64>>> {
    let takes = function::<f64>(FUNCTION).unwrap().takes;
    let rounded = |x: &[f64]| x.iter().map(|x| f64::from(*x as f32)).collect::<Vec<_>>();
    let of = |s: &states::State| takes.iter().map(|a: &Argument| rounded(s.get(*a).unwrap())).collect::<Vec<_>>();
    states::random(model, count, seed).iter().map(of).collect()
}

const LEVELS: [&str; 9] =
    ["double_double", "compensated+two", "f64", "f64+no_fma", "f64+correct", "f64+fast_10", "f64+fast_7", "f32_f64", "f32"];

/// `count` states, a thousand at a time; whether one is the first of its thousand.
fn states_in_parts(model: &Model<f64>, count: usize) -> impl Iterator<Item = (Vec<Vec<f64>>, bool)> {
    (0..count.div_ceil(PART)).flat_map(move |part| {
        let states = states_of(model, PART.min(count - part * PART), 5 + part as u64);
        states.into_iter().enumerate().map(|(k, state)| (state, k == 0))
    })
}

const PART: usize = 1000;

/// Errors are within their bounds, and the relative accuracy of levels is as promised.
fn hold(robot: &str, count: usize) {
    let levels = LEVELS.map(|name| build(robot, name, Target::Own));
    let mut worst = [0.0_f64; LEVELS.len()];
    let mut single = vec![(0.0_f64, 0.0_f64); levels[0].generated.model.nv()];
    for (state, first) in states_in_parts(&levels[0].generated.model, count) {
        Big::scope(|| {
            // Graphs of levels differ only in the computation of a node: one evaluation in 96
            // digits serves all.
            let exact = levels[0].exact(&state);
            for (worst, level) in worst.iter_mut().zip(&levels) {
                let errors = level.errors(&state, &exact);
                *worst = errors.iter().fold(*worst, |worst, e| worst.max(e.0));
                if level.level.arithmetic == Arithmetic::Single {
                    single.iter_mut().zip(&errors).for_each(|(s, e)| *s = (s.0.max(e.0), s.1.max(e.1.unwrap_or_default())));
                }
                let same = |(a, b): (&Big, &Big)| (*a - *b).to_f64().abs() <= 1e-80 * a.to_f64().abs();
                assert!(!first || exact.iter().zip(&level.exact(&state)).all(same), "{}", level.level);
            }
        });
    }
    worst_of_single_is_where_the_bound_says(&single);
    let of = |name: &str| worst[LEVELS.iter().position(|l| *l == name).unwrap()];
    let plain = of("f64");
    assert!(of("double_double") <= of("compensated+two") * (1.0 + 1e-9), "{worst:?}");
    assert!(of("compensated+two") < plain && plain < 1e-12, "{worst:?}");
    assert!(of("f64+no_fma") < 4.0 * plain && of("f64+correct") < 2.0 * plain, "{worst:?}");
    assert!(plain < of("f64+fast_10") && of("f64+fast_10") < of("f64+fast_7") && of("f64+fast_7") < 1e-4, "{worst:?}");
    assert!(of("f64+fast_10") < of("f32_f64") && of("f32_f64") < of("f32") && of("f32") < 1e-2, "{worst:?}");
}

/// The largest error and the largest bound of each result: the worst error of all is in a result
/// with one of the largest bounds, and no bound is idle.
fn worst_of_single_is_where_the_bound_says(results: &[(f64, f64)]) {
    let most = results.iter().fold(0.0_f64, |most, r| most.max(r.1));
    let worst = results.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    assert!(worst.1 >= 0.5 * most, "{results:?}");
    for (error, bound) in results {
        assert!(*error >= 0.01 * bound, "{error:e} of {bound:e}");
    }
}

#[test]
fn errors_are_within_their_bounds_and_levels_in_their_order() {
    hold("panda_like", 120);
}

#[test]
#[ignore = "a million states in 96 digits: 12 min with optimisation"]
fn errors_are_within_their_bounds_on_a_million_states_of_an_arm() {
    hold("panda_like", 1_000_000);
}

#[test]
#[ignore = "a million states in 96 digits: 9 min with optimisation"]
fn errors_are_within_their_bounds_on_a_million_states_of_another_arm() {
    hold("ur5_like", 1_000_000);
}

#[test]
#[ignore = "a million states in 96 digits: 24 min with optimisation"]
fn errors_are_within_their_bounds_on_a_million_states_of_a_quadruped() {
    hold("quadruped", 1_000_000);
}

#[test]
fn far_angles_and_what_is_no_number_do_what_the_contract_says() {
    let robot = "simple_pendulum";
    for name in LEVELS {
        let made = build(robot, name, Target::Own);
        let far: Vec<Vec<Vec<f64>>> =
            [1e6_f32, 1e15, 1e22, -1e22].iter().map(|q| vec![vec![f64::from(*q)], vec![0.5], vec![-0.25]]).collect();
        assert!(made.worst(&far) < 1e-5, "{name}");
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for place in 0..3 {
                let mut state = vec![vec![0.5], vec![0.25], vec![1.0]];
                state[place][0] = odd;
                let found = made.call(&state)[0];
                // A pendulum's torque does not depend on its rate.
                assert!(!found.is_finite() || place == 1, "{name}: {odd} as argument {place} gives {found}");
            }
        }
    }
}

#[test]
fn without_fused_multiply_add_the_bits_are_the_same_whatever_the_processor_can_do() {
    for name in ["f64+no_fma", "f32+no_fma", "double_double+no_fma"] {
        let [own, any] = [Target::Own, Target::Any].map(|target| build("ur5_like", name, target));
        assert!(Target::differ() || !cfg!(target_feature = "fma"));
        for state in some_states("ur5_like", 50) {
            let bits = |m: &BuiltRobot| m.call(&state).into_iter().map(f64::to_bits).collect::<Vec<_>>();
            assert_eq!(bits(&own), bits(&any), "{name}");
        }
    }
}

#[test]
fn there_is_a_bound_of_every_result_and_it_holds_all_over_the_box() {
    for name in ["f64", "f32"] {
        let generated = generated("ur5_like", level(name));
        let bounds = generated.bounds_in_box(0).unwrap();
        assert_eq!(bounds.len(), generated.model.nv());
        assert!(bounds.iter().all(|b| b.is_finite() && *b > 0.0), "{bounds:?}");
        for state in some_states("ur5_like", 20) {
            let one = bound::bounds(&generated.graphs[0], level(name), &|argument, k| (state[argument][k], 0.0)).unwrap();
            assert!(one.iter().zip(&bounds).all(|(one, all)| one <= all), "{one:?} {bounds:?}");
        }
    }
}
