//! Limbs that are alike, mirrored, nearly alike or of different lengths: all code in lanes
//! compiles, and is right.

use articulated_codegen::{Generated, Options};
use articulated_core::description::Base;
use articulated_tests::program::Program;
use articulated_tests::random_limbs::random_limbs;
use articulated_tests::urdf_text;

use crate::equals_generic::compare;
use crate::interpreted::{self, kinds, not_compiled};
use crate::robots::{self, Robot, is_compiled, with};

/// The random robots, and those that are compiled: with the compiled robots of [`crate::robots`]
/// these contain every kind of statement that all of them have.
const ROBOTS: std::ops::Range<u64> = 0..32;
const COMPILED: [(u64, &[&str]); 6] =
    [(0, &FUNCTIONS), (1, &FUNCTIONS), (2, &FUNCTIONS), (3, &FUNCTIONS), (5, &["inverse_dynamics_derivatives"]), (26, &["mass_matrix"])];

/// One function for each form of code: lanes alone, matrices in lanes, pieces, frames, and sums
/// over all limbs.
const FUNCTIONS: [&str; 5] =
    ["inverse_dynamics", "mass_matrix", "inverse_dynamics_derivatives", "jacobians_body", "centroidal_momentum_matrix"];

fn robots(all: impl Iterator<Item = (u64, &'static [&'static str])>) -> Vec<Robot> {
    let robot = |(seed, functions): (u64, &[&str])| {
        let urdf = urdf_text(&random_limbs(seed));
        with(format!("limbs_{seed}"), &urdf, Base::Floating, false, Options::default(), |name| functions.contains(&name))
    };
    all.map(robot).collect()
}

/// With all functions.
fn all_robots() -> Vec<Robot> {
    robots(ROBOTS.map(|seed| (seed, &FUNCTIONS[..])))
}

#[test]
fn limbs_of_every_kind_are_those_of_the_generic_library() {
    let robots = all_robots();
    let lanes = |robot: &&Robot| robot.generated.ledger.functions.iter().any(|f| f.lanes > 1);
    let with_lanes = robots.iter().filter(lanes).count();
    for robot in &robots {
        println!("{}: {:.1} units of roundoff", robot.name, interpreted::compare(robot).0);
    }
    assert!(with_lanes > robots.len() / 2, "{with_lanes} of {} robots have something in lanes", robots.len());
    // Other robots are compiled, too.
    let own = self::robots(COMPILED.into_iter());
    let compiled = kinds(own.iter().chain(robots::ROBOTS.iter().filter(is_compiled)));
    let missing = not_compiled(&robots, &compiled);
    assert!(missing.is_empty(), "no compiled robot has\n{}", missing.join("\n"));
}

#[test]
fn limbs_are_compiled_as_they_are_interpreted() {
    compile(&robots(COMPILED.into_iter()));
}

#[test]
#[ignore = "all robots, of which the test above compiles some; rustc takes minutes: cargo test … -- --ignored"]
fn so_are_all_limbs() {
    compile(&all_robots());
}

fn compile(robots: &[Robot]) {
    let modules: Vec<(&str, &Generated)> = robots.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&modules, &["-C", "target-cpu=native"]);
    println!("compiled {} robots in {:.1?}", robots.len(), program.time);
    for robot in robots {
        println!("{}: {:.1} units of roundoff", robot.name, compare(&program, robot));
    }
}
