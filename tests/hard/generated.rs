//! Generated code of the hard robots: errors within the contract of its level.

use articulated_codegen::Precision;
use articulated_core::description::Description;
use articulated_lab::stress::levels::rows;
use articulated_lab::stress::robots::hard;

fn hold(pairs: &[(&str, Description, Precision)]) {
    let rows = rows(pairs).unwrap_or_else(|e| panic!("{e:?}"));
    crate::hold(&rows);
}

/// No pass of the generator may lose digits: errors stay as in generic code.
#[test]
fn generated_code_of_hard_robots_keeps_the_limits() {
    hold(&hard().into_iter().map(|(name, robot)| (name, robot, Precision::default())).collect::<Vec<_>>());
}

/// Every level, each on a robot with another kind of trouble: small ones, since code of sums of two
/// doubles is long.
#[test]
fn code_of_every_level_keeps_what_the_level_promises() {
    let small: Vec<(&str, Description)> = hard().into_iter().filter(|(_, robot)| robot.joints.len() <= 4).collect();
    let pairs: Vec<_> =
        Precision::all().into_iter().zip(small.iter().cycle()).map(|(level, (name, robot))| (*name, robot.clone(), level)).collect();
    hold(&pairs);
}
