//! Monitors of an evaluation, for teaching and debugging. No function of the table calls them, so
//! they cost nothing unless used.
//!
//! | function | reports | does not report |
//! |---|---|---|
//! | [`orthonormality`], [`placement_orthonormality`] | how far RᵀR is from 1: grows as the number of turns that were composed | that a placement is right |
//! | [`quaternion_norms`] | how far the quaternions of q are from norm one, which functions take for granted | |
//! | [`wrench_growth`] | a joint's wrench over the largest one of a body beyond | |
//! | [`adjoint_condition`] | the condition number of Ad, which depends on the units of length alone | anything about a configuration |
//! | [`scaled_condition`] | how far accelerations move for a small change of the robot | how large their own error is |
//! | [`pivot_cancellation`] | the part of each joint's inertia that elimination leaves | |

mod chain;
mod matrix;
mod wrench;

pub use chain::{ADJOINT_LIMIT, adjoint_condition, orthonormality, placement_orthonormality, quaternion_norms};
pub use matrix::{pivot_cancellation, scaled_condition};
pub use wrench::wrench_growth;
