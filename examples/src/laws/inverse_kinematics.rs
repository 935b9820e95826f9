//! Inverse kinematics of a hand: an iteration that ends where the hand is.

use articulated_core::Scalar;
use articulated_core::algorithm::{jacobians_world_aligned, placements};
use articulated_core::user_function;

/// The hand is there from this distance on, m.
const NEAR: f64 = 1e-10;

user_function! {
    /// Coordinates in which the hand is at a place, by Newton's method: q ← q + Jᵀ (J Jᵀ)⁻¹ e with
    /// e = place − p(q). `missed` is 1 where 50 turns were not enough.
    pub struct Reach;
    fn reach<S>(robot, work, start: [Nv] "rad", place: [Of(3)] "m, world axes") -> (found: [Nv] "rad", missed: [] "1") {
        let n = robot.nv();
        let (mut pose, mut jacobian) = ([S::zero(); 12], vec![S::zero(); 6 * n]);
        found.copy_from_slice(start);
        let there = S::repeat(50, found, |q| {
            placements(robot, work, q, &mut pose);
            jacobians_world_aligned(robot, work, q, &mut jacobian);
            let error: [S; 3] = std::array::from_fn(|k| place[k] - pose[9 + k]);
            let row = |k: usize| &jacobian[(3 + k) * n..][..n];
            let product = |i: usize, j: usize| row(i).iter().zip(row(j)).fold(S::zero(), |sum, (a, b)| sum + *a * *b);
            let force = solved([0, 1, 2].map(|i| [0, 1, 2].map(|j| product(i, j))), error);
            for (j, q) in q.iter_mut().enumerate() {
                *q += (0..3).fold(S::zero(), |sum, k| sum + row(k)[j] * force[k]);
            }
            let far = error.iter().fold(S::zero(), |sum, e| sum + *e * *e).sqrt();
            (S::from_f64(NEAR) - far).positive()
        });
        missed[0] = S::select(there, S::zero(), S::one());
    }
}

/// A⁻¹ b of a symmetric matrix A, by its cross products.
fn solved<S: Scalar>(a: [[S; 3]; 3], b: [S; 3]) -> [S; 3] {
    let cross = |x: [S; 3], y: [S; 3]| [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    let dot = |x: [S; 3], y: [S; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    let adjugate = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])];
    let determinant = dot(a[0], adjugate[0]);
    [0, 1, 2].map(|k| dot([adjugate[0][k], adjugate[1][k], adjugate[2][k]], b) / determinant)
}
