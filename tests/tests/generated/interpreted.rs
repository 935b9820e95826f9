//! Generated = generic without a compiler: the interpreter computes the statements that a target
//! prints. It takes a fraction of the time of rustc, so every robot, function and body is here.
//!
//! Compilers and printing are tested on a few robots ([`crate::robots::COMPILED`]). These contain
//! every kind of statement that any robot here has.

use std::collections::BTreeSet;

use articulated_codegen::lir::interpret::interpret;
use articulated_codegen::lir::{Body, Expr, Stmt};
use articulated_tests::case::State;
use articulated_tests::measure::{arguments, error};
use articulated_tests::random::Random;

use crate::equals_generic::allowed;
use crate::robots::{COMPILED, ROBOTS, Robot};

const STATES: usize = 4;

/// The results of a body.
fn results(body: &Body, is_whole: bool, given: &[&[f64]]) -> Vec<f64> {
    let mut found = interpret(body, |argument, k| given[argument][k]);
    if body.is_partial && is_whole {
        // What is not stored is zero from the start.
        found.iter_mut().filter(|x| x.is_nan()).for_each(|x| *x = 0.0);
    }
    found
}

/// The bodies of a function whose results are complete, with their names.
pub(crate) fn whole_bodies<'a>(robot: &'a Robot, name: &str) -> impl Iterator<Item = (&'static str, &'a Body)> + use<'a> {
    let place = robot.functions().position(|own| own == name).expect("a function of the robot");
    let bodies = &robot.generated.bodies[place];
    // A loop follows these two, which is not part of them.
    let is_cut = |name: &str| bodies.is_followed_by_columns && ["single", "few registers"].contains(&name);
    bodies.all().filter(move |(name, _)| !is_cut(name))
}

/// Results of the function of one state.
pub(crate) fn run(robot: &Robot, name: &str, states: &[Vec<&[f64]>]) -> Vec<Vec<f64>> {
    let (_, body) = whole_bodies(robot, name).next().expect("a body that is complete");
    states.iter().map(|given| results(body, true, given)).collect()
}

/// The largest difference of any body of any function from the generic library, and how many bodies
/// there are.
pub(crate) fn compare(robot: &Robot) -> (f64, usize) {
    let mut random = Random::new(31);
    let states: Vec<State> = (0..STATES).map(|_| robot.case.state(&mut random)).collect();
    let (mut worst, mut count) = (0.0_f64, 0);
    for name in robot.functions() {
        for (which, body) in whole_bodies(robot, name) {
            for state in &states {
                let found = results(body, true, &arguments(name, state));
                let far = error(&robot.case, name, state, &found);
                assert!(far <= allowed(name), "{}::{name} ({which}): {far} units of roundoff in {state:?}", robot.name);
                worst = worst.max(far);
            }
            count += 1;
        }
    }
    (worst, count)
}

#[test]
fn statements_give_what_the_generic_library_gives() {
    let mut bodies = 0;
    for robot in ROBOTS.iter() {
        let (worst, count) = compare(robot);
        println!("{}: {worst:.1} units of roundoff in {count} bodies", robot.name);
        bodies += count;
    }
    assert!(bodies > 800, "{bodies} bodies");
}

/// The kinds of statements of some robots: what they do, and the type of their values.
pub(crate) fn kinds<'a>(robots: impl Iterator<Item = &'a Robot>) -> BTreeSet<String> {
    let bodies = robots.flat_map(|robot| &robot.generated.bodies).flat_map(|bodies| bodies.all().map(|(_, body)| body));
    bodies.flat_map(|body| body.pieces.iter().flatten().map(|statement| kind(body, statement))).collect()
}

fn kind(body: &Body, statement: &Stmt) -> String {
    let what = match statement {
        Stmt::Let(_, Expr::Op(op, _)) => format!("{op:?}"),
        Stmt::Let(_, other) => word(&format!("{other:?}")),
        Stmt::SinCos { angles, alone } => format!("SinCos of {}, alone: {alone}", angles.len()),
        Stmt::SumLanes(_, operands) => format!("SumLanes of {}", operands.len()),
        Stmt::Store(store) => format!("Store {}", word(&format!("{store:?}"))),
        other => word(&format!("{other:?}")),
    };
    format!("{:?}: {what}", body.ty)
}

/// The name of a variant.
fn word(debug: &str) -> String {
    debug.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_owned()
}

#[test]
fn the_robots_that_are_compiled_have_every_kind_of_statement() {
    let all = kinds(ROBOTS.iter());
    let compiled = kinds(ROBOTS.iter().filter(|robot| COMPILED.contains(&robot.name.as_str())));
    let missing: Vec<&String> = all.difference(&compiled).collect();
    assert!(missing.is_empty(), "no compiled robot has {missing:?}");
    assert!(all.len() > 40, "{all:?}");
}
