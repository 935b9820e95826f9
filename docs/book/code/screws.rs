//! The exponential of a screw, and the screws of a robot at q = 0, spelled out.

use articulated::algorithm::textbook::matrix::{cross_matrix, halves, rodrigues, stack};
use articulated::spatial::Placement;
use nalgebra::{Matrix3, Matrix4, Vector3, Vector6};

use crate::Robot;

/// The screw (ŝ; −ŝ × p + h ŝ) of an axis ŝ of length one through the point p, m, with the pitch h,
/// m/rad.
pub fn screw(axis: Vector3<f64>, point: Vector3<f64>, pitch: f64) -> Vector6<f64> {
    stack(axis, axis * pitch - axis.cross(&point))
}

/// `[S] = [[ŝ]× v; 0 0]`, 4 × 4, of S = (ŝ; v).
pub fn screw_matrix(screw: &Vector6<f64>) -> Matrix4<f64> {
    let (axis, v) = halves(screw);
    let mut matrix = Matrix4::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&cross_matrix(axis));
    matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&v);
    matrix
}

/// `exp([S] θ)` of a screw whose angular part has length one or zero; θ in rad, or in m if it is
/// zero. Lynch & Park 2017, §3.3.
pub fn exponential(screw: &Vector6<f64>, angle: f64) -> Placement<f64> {
    let (axis, v) = halves(screw);
    let (sin, cos) = angle.sin_cos();
    let w = cross_matrix(axis);
    // G(θ) = θ 1 + (1 − cos θ) [ŝ]× + (θ − sin θ) [ŝ]×²
    let g = Matrix3::identity() * angle + w * (1.0 - cos) + w * w * (angle - sin);
    Placement { rotation: rodrigues(axis, angle), position: g * v }
}

/// The pose of 12 numbers: R row by row, then p.
pub fn pose(numbers: &[f64]) -> Placement<f64> {
    Placement { rotation: Matrix3::from_row_slice(&numbers[..9]), position: Vector3::from_column_slice(&numbers[9..12]) }
}

/// The screws of the revolute joints of an arm in world axes about the world's origin, at q = 0:
/// its axis in the child's frame, carried by the child's pose.
pub fn space_screws(robot: &Robot) -> Vec<Vector6<f64>> {
    let home = robot.textbook.placements(&robot.model.neutral());
    let moving = robot.description.joints.iter().filter(|joint| joint.kind != articulated::JointKind::Fixed);
    let screw_of = |joint: &articulated::description::Joint| {
        let child = pose(&home[12 * joint.child.0..]);
        screw(child.rotation * Vector3::from(joint.axis).normalize(), child.position, 0.0)
    };
    moving.map(screw_of).collect()
}
