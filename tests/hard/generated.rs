//! Generated code of the hard robots, by the same measure as generic code.

use articulated_cli::stress::judge::{BACKWARD, exact_error, worse};
use articulated_cli::stress::robots::{built, hard, states};
use articulated_cli::stress::urdf_text::urdf_text;
use articulated_codegen::{Generated, Request, generate};
use articulated_core::algorithm::FunctionId;
use articulated_core::description::{Base, Description};
use articulated_tests::measure::error;
use articulated_tests::program::Program;

const FUNCTIONS: [FunctionId; 3] = [FunctionId::inverse_dynamics, FunctionId::mass_matrix, FunctionId::forward_dynamics];

/// Levels of accuracy that promise f64's errors or less, on robots of each kind of trouble, besides the default on all.
const LEVELS: [&str; 3] = ["f64+no_fma", "f64+correct", "compensated"];
const OF_LEVELS: [&str; 3] = ["tapering", "heavy_middle", "far_off"];

/// No pass of the generator may cost a robot its digits: backward errors stay where they are for generic code.
#[test]
fn generated_code_of_hard_robots_keeps_the_limits() {
    let all = hard();
    let mut robots: Vec<(String, &str, &Description)> = all.iter().map(|(name, robot)| ((*name).to_owned(), "f64", robot)).collect();
    for (k, level) in LEVELS.iter().enumerate() {
        let some = all.iter().filter(|(name, _)| OF_LEVELS.contains(name));
        robots.extend(some.map(|(name, robot)| (format!("{name}_{k}"), *level, robot)));
    }
    let made: Vec<(&str, Generated)> = robots
        .iter()
        .map(|(name, level, robot)| {
            let mut request = Request::new(format!("{name}.urdf"), urdf_text(robot));
            request.options.functions = FUNCTIONS.iter().map(|f| f.name().to_owned()).collect();
            request.options.level = level.parse().unwrap_or_else(|e| panic!("{level}: {e}"));
            (name.as_str(), generate(&request).unwrap_or_else(|e| panic!("{name}: {e}")))
        })
        .collect();
    let modules: Vec<(&str, &Generated)> = made.iter().map(|(name, g)| (*name, g)).collect();
    let program = Program::build(&modules, &["-C", "opt-level=1", "-C", "target-cpu=native"]);
    let mut failed = Vec::new();
    for (name, level, robot) in &robots {
        let model = built(robot, Base::Fixed);
        let case = articulated_tests::case::Case::new(name, (*robot).clone(), Base::Fixed);
        let mut states = states(&model, 4, 81, 1.0);
        states[3].q.iter_mut().for_each(|q| *q *= 1e8);
        for function in FUNCTIONS {
            let given = |s: &articulated_cli::stress::judge::State| match function {
                FunctionId::inverse_dynamics => vec![s.q.clone(), s.v.clone(), s.a.clone()],
                FunctionId::mass_matrix => vec![s.q.clone()],
                _ => vec![s.q.clone(), s.v.clone(), s.tau.clone()],
            };
            let arguments: Vec<Vec<Vec<f64>>> = states.iter().map(given).collect();
            let slices: Vec<Vec<&[f64]>> = arguments.iter().map(|a| a.iter().map(Vec::as_slice).collect()).collect();
            let found = program.run(name, function.name(), &slices);
            let one = |k: usize| match function {
                FunctionId::forward_dynamics => {
                    let s = &states[k];
                    let mut state = articulated_tests::case::State::new(s.q.clone(), s.v.clone(), s.a.clone());
                    state.tau.clone_from(&s.tau);
                    error(&case, function.name(), &state, &found[k])
                }
                _ => exact_error(function, &model, &arguments[k], &found[k]),
            };
            let far = (0..states.len()).map(one).fold(0.0, worse);
            if std::env::var_os("SHOW").is_some() {
                println!("{name} {level} {}: {far:.2} u", function.name());
            }
            if far.is_nan() || far > BACKWARD {
                failed.push(format!("{name}, {level}: {}: {far:e} u", function.name()));
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
