//! Generated code of hard robots at every level of accuracy, each judged by its contract.

mod built_robot;
mod contract;
mod judge;

use articulated_codegen::Precision;
use articulated_core::algorithm::FunctionId;
use articulated_core::description::{Base, Description};

use super::corpus::Effort;
use super::judge::{DERIVATIVES, State};
use super::robots::{built, hard, states};
use super::row::{Case, Row};
use crate::error::Error;
use crate::parallel;
pub use built_robot::BuiltRobot;
pub use judge::rows as of_made;

/// The chapter of levels.
pub const NAME: &str = "levels";

const WHY: &str = "constants pass through model passes, symbols and decimals, and sums through other orders and other numbers than where they were written";

/// Functions of a robot of this number of joints: derivatives only of small ones, since those of
/// sums of two doubles are tens of thousands of instructions.
pub(super) fn functions(joints: usize, level: Precision) -> Vec<FunctionId> {
    let mut functions = vec![FunctionId::inverse_dynamics, FunctionId::mass_matrix, FunctionId::forward_dynamics];
    if joints <= if level.of_two() { 4 } else { DERIVATIVES } {
        functions.extend([FunctionId::inverse_dynamics_derivatives, FunctionId::forward_dynamics_derivatives]);
    }
    functions
}

/// Robots on which every level is tried, whatever the effort.
const OF_LEVELS: [&str; 3] = ["tapering", "heavy_middle", "far_off"];

/// These levels on some robots, and the default on all; all on all with full effort.
pub(super) fn chapter(effort: Effort, levels: &[Precision]) -> Result<Vec<Row>, Error> {
    let robots = hard();
    let wanted = |name: &str, level: Precision| effort == Effort::Full || level == Precision::default() || OF_LEVELS.contains(&name);
    let of = |(name, robot): &'_ (&'static str, Description)| {
        levels.iter().filter(|l| wanted(name, **l)).map(|l| (*name, robot.clone(), *l)).collect::<Vec<_>>()
    };
    rows(&robots.iter().flat_map(of).collect::<Vec<_>>())
}

/// Each robot at its level. Errors: a tool fails.
pub fn rows(pairs: &[(&str, Description, Precision)]) -> Result<Vec<Row>, Error> {
    parallel::map(pairs, |(name, robot, level)| one(name, robot, *level)).into_iter().collect::<Result<Vec<_>, _>>().map(|r| r.concat())
}

fn one(name: &str, robot: &Description, level: Precision) -> Result<Vec<Row>, Error> {
    let model = built(robot, Base::Fixed);
    let made = BuiltRobot::of_description(name, robot, level, &functions(model.nv(), level))?;
    let case = Case::new(NAME, format!("{name}, {level}"), WHY);
    Ok(of_made(&case, &model, &made, &hard_states(&model)))
}

/// At random, and one with angles beyond those that sines are made for.
fn hard_states(model: &articulated_core::model::Model<f64>) -> Vec<State> {
    let mut states = states(model, 4, 81, 1.0);
    states[3].q.iter_mut().for_each(|q| *q *= 1e8);
    states
}
