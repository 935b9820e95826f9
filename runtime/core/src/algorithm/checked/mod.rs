//! Solutions with the mass matrix that report whether they are reliable.
//!
//! A mass matrix is singular if some motion of the joints moves no mass: a joint that carries none,
//! a straight row of thin rods turned about its own axis, two equivalent joints. In floating point
//! it is singular earlier, if a pivot D of the elimination is only rounding error of its terms. So
//! the measure is D/(Σ|terms|), and a pivot with less than [`least_pivot`] left is an error that
//! names its joint. The condition number of M says how far a solution moves for a small change of
//! the robot. Whatever it is, a solution may be exact to the last bit for a robot a few roundings
//! away.
//!
//! | | cost beside the unchecked form |
//! |---|---|
//! | [`checked_forward_dynamics`] of a [`Model`] without joints that follow others | 30 to 55 instructions per body where constants are folded in (the ledger of operations has both, robot by robot), a tenth to a fifth of the time |
//! | of a model with such joints | 10 to 15 instructions per degree of freedom, a quarter of the time |
//! | [`Solver`], of any robot that has `bias_forces` and `mass_matrix` | up to n³/3 operations of LᵀDL where nothing is zero, and 6n² for each step of refinement, of which one is enough as a rule |
//! | [`Factor::condition`] | nine to twenty-one solutions, 2n² operations each |

mod condition;
mod factor;
mod pivots;
mod solver;

use alloc::string::String;
use core::fmt;

pub use factor::Factor;
pub(super) use pivots::Size;
pub use pivots::{articulated_body_pivots, checked_forward_dynamics, checked_forward_dynamics_with_wrenches, factored_pivots};
pub use solver::{Solver, Unsolved};

use crate::Scalar;
use crate::scalar::two_to;

#[allow(unused_imports)]
// Why: named in the documentation.
use crate::model::Model;

/// Error of unreliable accelerations: the joint with the lost pivot, and its remaining part.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular<S = f64> {
    /// Name of the joint; empty if the robot does not know it
    /// ([`crate::dynamics::Dynamics::joint_of`]).
    pub joint: String,
    /// Index in v of the degree of freedom.
    pub freedom: usize,
    /// The measure.
    pub measure: Measure,
    /// The measured value; NaN if an argument was NaN.
    pub found: S,
    /// The least that would have been right.
    pub least: S,
}

/// Measures of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// D/(Σ|terms|) of a pivot.
    Pivot,
    /// Whether the result is finite; torques or rates near the largest finite number may overflow
    /// though the mass matrix is regular.
    Finite,
}

impl<S: Scalar> fmt::Display for Singular<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { joint, freedom, measure, found, least } = self;
        if joint.is_empty() {
            write!(f, "degree of freedom {freedom}: ")?;
        } else {
            write!(f, "joint {joint:?} (degree of freedom {freedom}): ")?;
        }
        // NaN is not equal to itself.
        #[allow(clippy::eq_op)]
        let no_number = found != found;
        match measure {
            _ if no_number => write!(f, "q, v or tau is not a number, or something overflows on the way"),
            Measure::Pivot => {
                write!(f, "the mass matrix is singular: of this pivot {found:?} of its terms is left, expected {least:?} or more")
            }
            Measure::Finite => write!(f, "the acceleration overflows"),
        }
    }
}

impl<S: Scalar> core::error::Error for Singular<S> {}

/// 2¹⁰u, u = 2^−[`Scalar::BITS`]: a pivot with less left has fewer than ten correct bits.
pub fn least_pivot<S: Scalar>() -> S {
    S::from_f64(const { two_to(10 - S::BITS as i32) })
}

/// Whether a > b.
fn greater<S: Scalar<Mask = bool>>(a: S, b: S) -> bool {
    (a - b).positive()
}

/// The larger, `b` where `a` is not a number.
fn larger<S: Scalar<Mask = bool>>(a: S, b: S) -> S {
    if greater(a, b) { a } else { b }
}

/// Whether it is a number, and not infinite.
#[allow(clippy::eq_op)]
// Why: x − x is NaN for infinities and NaN, and zero for all else.
fn finite<S: Scalar>(x: S) -> bool {
    (x - x).is_zero()
}
