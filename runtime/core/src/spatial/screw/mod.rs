//! Screws: exponentials and logarithms of rotations and placements, with their derivatives.
//!
//! ω ∈ ℝ³ stands for the rotation exp ω about ω by |ω| rad, a twist ξ = [ω; v] for the placement
//! exp ξ. Nothing here branches on a value, so all of it can be traced and differentiated, at ω = 0
//! too; each coefficient changes from a series to its closed form where that is good
//! ([`HalfAngle`]). Errors are in units of u, half the spacing of numbers at 1, as measured against
//! 320 bits.
//!
//! Sources: Lynch & Park, *Modern Robotics*, 2017, ch. 3; Barfoot, *State Estimation for Robotics*,
//! 2017, ch. 7; Park, *Computational aspects of the product-of-exponentials formula for robot
//! kinematics*, IEEE Trans. Automatic Control 39(3), 1994.

mod adjoint;
mod axis;
mod coefficients;
mod motion;
mod quaternion;
mod rotation;
mod series;

pub use axis::{Screw, product_of_exponentials_in_body, product_of_exponentials_in_space};
pub use coefficients::HalfAngle;
pub use quaternion::Quaternion;
pub use rotation::{
    cross_matrix, exp_rotation, left_jacobian, left_jacobian_inverse, log_rotation, right_jacobian, right_jacobian_inverse,
};
