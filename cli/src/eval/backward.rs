//! Solutions with the mass matrix for which rounding may change the result itself: a stiff contact,
//! steep friction, a light link. There a bound on the result is of little use, so the torques
//! required by the result are compared with the applied ones.

use articulated_core::algorithm::Function;
use articulated_core::model::Model;
use articulated_lab::residual::{Residual, residual_of};
use articulated_reference::ROUNDOFF;

use super::BOUND;

/// A result is judged by its torques if one unit of the bound exceeds this part of it.
pub(super) const LOOSE: f64 = 1e-3;

/// The largest backward error of the states that are judged by it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Backward {
    /// How many states are judged by it.
    pub(super) states: usize,
    /// The state of the largest.
    pub(super) state: usize,
    /// The torque that the result needs, less the applied one, and that over its terms.
    pub(super) residual: Residual,
}

impl Backward {
    /// Whether it is more than rounding explains.
    pub(super) fn exceeded(&self) -> bool {
        self.residual.units.is_nan() || self.residual.units > BOUND
    }

    /// The larger residual: the old one or that of a new state.
    pub(super) fn larger(old: Option<Self>, state: usize, residual: Residual) -> Self {
        match old {
            Some(old) if old.residual.is_larger(&residual) => Self { states: old.states + 1, ..old },
            old => Self { states: old.map_or(0, |old| old.states) + 1, state, residual },
        }
    }
}

/// Whether one unit of the bound is more than [`LOOSE`] of the result. `scale`: the scale of each
/// number.
pub(super) fn is_loose(scale: &[f64], result: &[f64]) -> bool {
    let largest = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    ROUNDOFF * largest(scale) > LOOSE * largest(result)
}

/// The larger backward error of some results of a function in a state; `None` if its results need
/// no torques, or one of them is not finite.
pub(super) fn of_results<'a>(
    function: &Function<f64>,
    model: &Model<f64>,
    arguments: &[&[f64]],
    results: impl Iterator<Item = &'a Vec<f64>>,
) -> Option<Residual> {
    let finite = results.filter(|result| result.iter().all(|x| x.is_finite()));
    let residuals = finite.filter_map(|result| residual_of(model, function, arguments, result));
    residuals.reduce(|a, b| if a.is_larger(&b) { a } else { b })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_loose_beside_the_largest_number_of_a_result() {
        let unit = |part: f64| [part / ROUNDOFF, 0.0];
        assert!(is_loose(&unit(1.1e-3), &[1.0, -0.5]) && !is_loose(&unit(0.9e-3), &[0.0, -1.0]));
        assert!(!is_loose(&unit(1.0), &[f64::NAN, f64::INFINITY]) && !is_loose(&[0.0], &[0.0]));
    }

    #[test]
    fn the_largest_is_kept_and_all_states_are_counted() {
        let residual = |units: f64| Residual { torque: units, units };
        let two = Backward::larger(Some(Backward::larger(None, 3, residual(2.0))), 4, residual(1.0));
        assert_eq!(two, Backward { states: 2, state: 3, residual: residual(2.0) });
        let three = Backward::larger(Some(two), 5, residual(BOUND + 1.0));
        assert_eq!((three.states, three.state, three.exceeded(), two.exceeded()), (3, 5, true, false));
        assert!(Backward::larger(Some(three), 6, residual(f64::NAN)).exceeded());
    }
}
