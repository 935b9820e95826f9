//! Every function of the table on one robot, in big floats.

use articulated_core::algorithm::{Argument, Function, Needs, functions};
use articulated_core::model::Model;
use articulated_reference::Big;

use crate::case::{Case, State, cast};

/// Tolerance for the library's constants, which are double precision at every precision of the
/// rest. Seen: 2·10⁻¹⁵.
const NEAR: f64 = 2e-14;

/// The same for solutions with the mass matrix, which include its condition number. Seen: 9·10⁻¹⁵.
const SOLVED: f64 = 2e-13;

/// The largest [`difference`] between a function on the library's constants and its right value.
pub fn tolerance(row: &Function<Big>) -> f64 {
    if row.inverts_mass_matrix() { SOLVED } else { NEAR }
}

/// The largest difference, relative to the largest entry or to one; not a number if one entry is
/// not.
///
/// # Panics
/// If the lengths differ.
pub fn difference(found: &[Big], expected: &[Big]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().map(|e| e.to_f64().abs()).fold(1.0, f64::max);
    let one = |(f, e): (&Big, &Big)| (*f - *e).to_f64().abs() / largest;
    found.iter().zip(expected).map(one).fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

/// Calls `visit` with each function that the robot has, and its arguments at `state`.
///
/// # Panics
/// If `model` is not one of the same robot.
pub fn for_each_function(case: &Case, model: &Model<Big>, state: &State, mut visit: impl FnMut(&'static Function<Big>, &[&[Big]])) {
    let arguments: Vec<(Argument, Vec<Big>)> = Argument::ALL.iter().map(|&a| (a, cast(state.argument(a)))).collect();
    let bound = case.model.frames().iter().any(|f| case.model.freedoms_of(f.body).len() < 6);
    let has = |f: &Function<Big>| match f.needs {
        Needs::FreeFrames => !bound,
        Needs::Mass => case.model.moving_mass() > 0.0,
        Needs::Nothing | Needs::MassMatrix => true,
    };
    for row in functions::<Big>().iter().filter(|f| has(f)) {
        let given = |a: &Argument| arguments.iter().find(|(b, _)| a == b).map(|(_, x)| x.as_slice());
        let given: Vec<&[Big]> = row.takes.iter().filter_map(given).collect();
        visit(row, &given);
    }
    assert_eq!(model.nv(), case.model.nv());
}
