//! Limbs that are alike, mirrored, nearly alike or of different lengths: whatever goes into lanes
//! compiles, and is right.

use articulated_codegen::{Generated, Options};
use articulated_core::description::Base;
use articulated_tests::program::Program;
use articulated_tests::random_limbs::random_limbs;
use articulated_tests::urdf_text;

use crate::equals_generic::compare;
use crate::robots::{Robot, with};

/// How many are compiled, and by how many a longer test goes on.
const ROBOTS: [std::ops::Range<u64>; 2] = [0..12, 12..32];

/// One of each way in which code is made: lanes alone, matrices in lanes, pieces, frames, and what
/// all limbs add to.
const FUNCTIONS: [&str; 5] =
    ["inverse_dynamics", "mass_matrix", "inverse_dynamics_derivatives", "jacobians_body", "centroidal_momentum_matrix"];

#[test]
fn limbs_of_every_kind_are_those_of_the_generic_library() {
    compare_limbs(ROBOTS[0].clone());
}

#[test]
#[ignore = "more robots of the kinds above; rustc takes a minute: cargo test … -- --ignored"]
fn so_are_further_limbs() {
    compare_limbs(ROBOTS[1].clone());
}

fn compare_limbs(seeds: std::ops::Range<u64>) {
    let robot = |seed| {
        let urdf = urdf_text(&random_limbs(seed));
        with(format!("limbs_{seed}"), &urdf, Base::Floating, false, Options::default(), |name| FUNCTIONS.contains(&name))
    };
    let robots: Vec<Robot> = seeds.map(robot).collect();
    let modules: Vec<(&str, &Generated)> = robots.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&modules, &["-C", "target-cpu=native"]);
    let lanes = |robot: &&Robot| robot.generated.ledger.functions.iter().any(|f| f.lanes > 1);
    let with_lanes = robots.iter().filter(lanes).count();
    println!("{with_lanes} of {} robots have something in lanes; compiled in {:.1?}", robots.len(), program.time);
    for robot in &robots {
        println!("{}: {:.1} units of roundoff", robot.name, compare(&program, robot));
    }
}
