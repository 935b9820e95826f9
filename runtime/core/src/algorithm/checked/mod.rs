//! Solutions with the mass matrix that say whether they can be trusted.
//!
//! A mass matrix is singular where some motion of the joints moves nothing that has mass: a joint
//! that carries none, a straight row of thin rods turned about its own axis, two joints that do the
//! same. In floating point it is singular before that, where a pivot D of the elimination is what
//! rounding left of its terms. So the measure is D/(Σ|terms|), and a pivot of which less than
//! [`least_pivot`] is left is an error that names its joint. The condition number of M says how far
//! a solution moves for a small change of the robot; a solution may be exact to the last bit for a
//! robot a few roundings away whatever it is.
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

/// Why there are no accelerations to be trusted: the joint whose pivot gave way, and what is left
/// of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular<S = f64> {
    /// Name of the joint; empty where the robot cannot tell
    /// ([`crate::dynamics::Dynamics::joint_of`]).
    pub joint: String,
    /// Index in v of the degree of freedom.
    pub freedom: usize,
    /// What was measured.
    pub measure: Measure,
    /// What was found; not a number where an argument was not.
    pub found: S,
    /// The least that would have been right.
    pub least: S,
}

/// What is measured of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// D/(Σ|terms|) of a pivot.
    Pivot,
    /// Whether the result is finite; torques or rates near the largest number there is may overflow
    /// though the mass matrix is well.
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
        // What is not a number is not itself.
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

/// 2¹⁰u, u = 2^−[`Scalar::BITS`]: a pivot of which less is left has fewer than ten bits that are
/// right.
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
// Why: ∞ − ∞ is not a number, and so is nothing else that is taken from itself.
fn finite<S: Scalar>(x: S) -> bool {
    (x - x).is_zero()
}
