//! A controller of one's own: the hand of an arm hangs on a spring and a damper.
//!
//! The build script generates code from this file, and the program compares it with the same law on
//! numbers.

use articulated_core::algorithm::{placements, static_torque, twists_world_aligned};
use articulated_core::user_function;

user_function! {
    /// τ = g(q) + Jᵀ f, f = k (target − p) − d ṗ: gravity is held, the frame is pulled to a place.
    pub struct Impedance;
    fn impedance<S>(robot, work, q: [Nq] "rad", v: [Nv] "rad/s", target: [Of(3)] "m, world axes", gains: [Of(2)] "k in N/m, d in N·s/m")
        -> (torque: [Nv] "N·m") {
        let (mut pose, mut twist, mut pulled) = ([S::zero(); 12], [S::zero(); 6], [S::zero(); 6]);
        placements(robot, work, q, &mut pose);
        twists_world_aligned(robot, work, q, v, &mut twist);
        let force: [S; 3] = std::array::from_fn(|k| gains[0] * (target[k] - pose[9 + k]) - gains[1] * twist[3 + k]);
        for k in 0..9 {
            pulled[3 + k % 3] -= pose[k] * force[k / 3]; // −Rᵀ f, in axes of the hand
        }
        static_torque(robot, work, q, &pulled, torque);
    }
}
