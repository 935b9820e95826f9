//! Generated = generic without a compiler: the interpreter computes the statements that a target
//! prints. It takes a fraction of the time of rustc, so every robot, function and body is here.
//!
//! Compilers and printing are tested on a few robots ([`crate::robots::COMPILED`]). These contain
//! every kind of statement that any robot here has.

use std::collections::{BTreeMap, BTreeSet};

use articulated_codegen::lir::interpret::interpret;
use articulated_codegen::lir::{Bodies, Body, Expr, Stmt};
use articulated_tests::case::State;
use articulated_tests::measure::{arguments, error};
use articulated_tests::random::Random;

use crate::robots::{COMPILED, ROBOTS, Robot, is_compiled};

const STATES: usize = 4;

/// Error allowed, in units of u times the yardstick: products and sums are rounded one after the
/// other, as in C. Seen: 29.
const ALLOWED: f64 = 64.0;

/// The results of a complete body.
fn results(body: &Body, given: &[&[f64]]) -> Vec<f64> {
    let mut found = interpret(body, |argument, k| given[argument][k]);
    if body.is_partial {
        // Results that are not stored are zero from the start.
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
    states.iter().map(|given| results(body, given)).collect()
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
                let found = results(body, &arguments(name, state));
                let far = error(&robot.case, name, state, &found);
                assert!(far <= ALLOWED, "{}::{name} ({which}): {far} units of roundoff in {state:?}", robot.name);
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

/// The kinds of statements of some robots: their operations, and the type of their values.
pub(crate) fn kinds<'a>(robots: impl Iterator<Item = &'a Robot>) -> BTreeSet<String> {
    robots.flat_map(|robot| robot.generated.bodies.iter().flat_map(kinds_of)).collect()
}

fn kinds_of(bodies: &Bodies) -> BTreeSet<String> {
    let statements = |body: &'_ Body| body.pieces.iter().flatten().map(|statement| kind(body, statement)).collect::<Vec<_>>();
    bodies.all().flat_map(|(_, body)| statements(body)).collect()
}

/// The kinds of statements that are not compiled, each with the shortest function that has it.
pub(crate) fn not_compiled(robots: &[Robot], compiled: &BTreeSet<String>) -> Vec<String> {
    let mut shortest: BTreeMap<String, (usize, String)> = BTreeMap::new();
    for robot in robots {
        for (name, bodies) in robot.functions().zip(&robot.generated.bodies) {
            let length = bodies.all().flat_map(|(_, body)| &body.pieces).map(Vec::len).sum();
            for kind in kinds_of(bodies).into_iter().filter(|kind| !compiled.contains(kind)) {
                let own = (length, format!("{}::{name}", robot.name));
                let best = shortest.entry(kind).or_insert_with(|| own.clone());
                *best = own.min(best.clone());
            }
        }
    }
    shortest.into_iter().map(|(kind, (length, function))| format!("{kind} (in {function}, {length} statements)")).collect()
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
    let compiled = kinds(ROBOTS.iter().filter(is_compiled));
    let missing = not_compiled(&ROBOTS, &compiled);
    assert!(missing.is_empty(), "no compiled robot has\n{}", missing.join("\n"));
    assert!(compiled.len() > 40 && ROBOTS.iter().filter(is_compiled).count() == COMPILED.len(), "{compiled:?}");
}
