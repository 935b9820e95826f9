//! A plane and another shape.

use alloc::vec::Vec;

use super::{Placed, Touch};
use crate::Scalar;
use crate::scalar::flag;
use crate::spatial::Vector3;

/// The squared length below which an axis is along the normal, as in MuJoCo.
const LEAST: f64 = 1e-30;

fn touch<S: Scalar>(exists: S, normal: Vector3<S>, distance: S, deepest: Vector3<S>, tangent: Option<Vector3<S>>) -> Touch<S> {
    Touch { exists, distance, point: deepest - normal * (distance * S::from_f64(0.5)), normal, tangent }
}

pub(super) fn sphere<S: Scalar>(plane: &Placed<'_, S>, center: Vector3<S>, radius: S) -> Touch<S> {
    let normal = plane.axis(2);
    let distance = (center - plane.position).dot(&normal) - radius;
    touch(S::one(), normal, distance, center - normal * radius, None)
}

/// A sphere at each end; the first axis across is along the capsule.
pub(super) fn capsule<S: Scalar>(plane: &Placed<'_, S>, other: &Placed<'_, S>, radius: S, half: S) -> [Touch<S>; 2] {
    let axis = other.axis(2);
    // Along the normal it is no axis across it.
    let along = axis.dot(&plane.axis(2));
    let is_across = (S::one() - S::from_f64(LEAST) - along * along).positive();
    [half, -half].map(|at| {
        let one = sphere(plane, other.position + axis * at, radius);
        let [_, own, _] = one.frame();
        let tangent = axis.zip_map(&own, |a, b| S::select(is_across, a, b));
        Touch { tangent: Some(tangent), ..one }
    })
}

/// The lowest point: p − R A² Rᵀn/|A Rᵀn|, A the half axes.
pub(super) fn ellipsoid<S: Scalar>(plane: &Placed<'_, S>, other: &Placed<'_, S>, radii: [S; 3]) -> Touch<S> {
    let normal = plane.axis(2);
    let radii = Vector3::from(radii);
    let scaled = (other.rotation.transpose() * normal).component_mul(&radii);
    let length = scaled.dot(&scaled).sqrt();
    let lowest = other.position - other.rotation * scaled.component_mul(&radii) * (S::one() / length);
    touch(S::one(), normal, (lowest - plane.position).dot(&normal), lowest, None)
}

/// The lowest point of each rim, and two more of the lower one.
pub(super) fn cylinder<S: Scalar>(plane: &Placed<'_, S>, other: &Placed<'_, S>, radius: S, half: S, reach: S) -> [Touch<S>; 4] {
    let (normal, one) = (plane.axis(2), S::one());
    let upward = other.axis(2);
    // Towards the plane
    let sign = S::select(upward.dot(&normal).positive(), -one, one);
    let axis = upward * sign;
    let along = axis.dot(&normal);
    let height = (other.position - plane.position).dot(&normal);
    let lean = axis * along - normal;
    let square = lean.dot(&lean);
    let leans = (square - S::from_f64(LEAST)).positive();
    let length = S::select(leans, square, one).sqrt();
    let down = lean.zip_map(&other.axis(0), |a, b| S::select(leans, a / length, b)) * radius;
    let (axis, along) = (axis * half, along * half);
    let lowered = down.dot(&normal);
    let place = |exists: S, distance: S, deepest: Vector3<S>| touch(exists, normal, distance, other.position + deepest, None);
    let within = |distance: S| one - flag::<S>((distance - reach).positive());
    let lowest = height + along + lowered;
    let near = within(lowest);
    let side = down.cross(&axis);
    let square = side.dot(&side);
    let length = S::select(square.positive(), square, one).sqrt();
    let side = side * (radius * S::from_f64(0.75).sqrt() / length);
    let half = S::from_f64(0.5);
    let beside = height + along - lowered * half;
    let base = axis - down * half;
    let exists = near * within(beside);
    [
        place(near, lowest, down + axis),
        place(near * within(height - along + lowered), height - along + lowered, down - axis),
        place(exists, beside, base + side),
        place(exists, beside, base - side),
    ]
}

/// The corners, of those that are not above the centre the first four within reach.
pub(super) fn cuboid<S: Scalar>(plane: &Placed<'_, S>, other: &Placed<'_, S>, half: [S; 3], reach: S) -> Vec<Touch<S>> {
    let (normal, one) = (plane.axis(2), S::one());
    let height = (other.position - plane.position).dot(&normal);
    let sides: [Vector3<S>; 3] = core::array::from_fn(|k| other.axis(k) * half[k]);
    let mut found = S::zero();
    let corner = |k: usize| {
        let sign = |bit: usize| if k & bit == 0 { -one } else { one };
        let corner = sides[0] * sign(1) + sides[1] * sign(2) + sides[2] * sign(4);
        let above = corner.dot(&normal);
        let distance = height + above;
        let is_near = (one - flag::<S>((distance - reach).positive())) * (one - flag::<S>(above.positive()));
        let exists = is_near * flag::<S>((S::from_f64(3.5) - found).positive());
        found += exists;
        touch(exists, normal, distance, other.position + corner, None)
    };
    (0..8).map(corner).collect()
}
