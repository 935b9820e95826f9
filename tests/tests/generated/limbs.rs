//! Limbs that are alike, mirrored, nearly alike or of different lengths: whatever goes into lanes
//! compiles, and is right.

use articulated_codegen::{Generated, Options};
use articulated_core::description::Base;
use articulated_tests::program::Program;
use articulated_tests::random_limbs::random_limbs;
use articulated_tests::urdf_text;

use crate::equals_generic::compare;
use crate::robots::{Robot, with};

const ROBOTS: u64 = 32;

/// One of each way in which code is made: lanes alone, matrices in lanes, pieces, frames, and what
/// all limbs add to.
const FUNCTIONS: [&str; 5] =
    ["inverse_dynamics", "mass_matrix", "inverse_dynamics_derivatives", "jacobians_body", "centroidal_momentum_matrix"];

#[test]
fn limbs_of_every_kind_are_those_of_the_generic_library() {
    let robot = |seed| {
        let urdf = urdf_text(&random_limbs(seed));
        with(format!("limbs_{seed}"), &urdf, Base::Floating, false, Options::default(), |name| FUNCTIONS.contains(&name))
    };
    let robots: Vec<Robot> = (0..ROBOTS).map(robot).collect();
    let modules: Vec<(&str, &Generated)> = robots.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&modules, &["-C", "target-cpu=native"]);
    let lanes = |robot: &&Robot| robot.generated.ledger.functions.iter().any(|f| f.lanes > 1);
    println!("{} of {ROBOTS} robots have something in lanes; compiled in {:.1?}", robots.iter().filter(lanes).count(), program.time);
    for robot in &robots {
        println!("{}: {:.1} units of roundoff", robot.name, compare(&program, robot));
    }
}
