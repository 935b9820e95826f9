//! Spheres and capsules.

use super::{Placed, Touch};
use crate::Scalar;
use crate::scalar::{flag, within};
use crate::spatial::Vector3;

/// The least length, as in MuJoCo.
const LEAST: f64 = 1e-15;
/// The square of the sine below which axes are parallel, as in MuJoCo from 4.0 on.
const PARALLEL: f64 = 1e-8;

/// Two spheres with these centres. In one point, their axes z say what is across.
pub(super) fn balls<S: Scalar>([(first, a), (second, b)]: [(Vector3<S>, S); 2], axes: [Vector3<S>; 2], exists: S) -> Touch<S> {
    let apart = second - first;
    let square = apart.dot(&apart);
    let is_apart = (square - S::from_f64(LEAST * LEAST)).positive();
    let across = axes[0].cross(&axes[1]);
    let length = across.dot(&across);
    let has_axis = (length - S::from_f64(LEAST * LEAST)).positive();
    let one = S::select(has_axis, length, S::one()).sqrt();
    let unit = Vector3::new(S::one(), S::zero(), S::zero());
    let otherwise = across.zip_map(&unit, |x, unit| S::select(has_axis, x / one, unit));
    let long = S::select(is_apart, square, S::one()).sqrt();
    let normal = apart.zip_map(&otherwise, |x, other| S::select(is_apart, x / long, other));
    let distance = S::select(is_apart, long, S::zero()) - a - b;
    let point = first + normal * (a + distance * S::from_f64(0.5));
    Touch { exists, distance, point, normal, tangent: None }
}

pub(super) fn spheres<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, a: S, b: S) -> Touch<S> {
    balls([(first.position, a), (second.position, b)], [first.axis(2), second.axis(2)], S::one())
}

/// The point of the capsule's axis that is next to the sphere.
pub(super) fn sphere_capsule<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, a: S, b: S, half: S) -> Touch<S> {
    let axis = second.axis(2);
    let at = within(axis.dot(&(first.position - second.position)), half);
    balls([(first.position, a), (second.position + axis * at, b)], [first.axis(2), axis], S::one())
}

/// The points of both axes that are next to each other: one place, or two of parallel capsules.
pub(super) fn capsules<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, [a, half]: [S; 2], [b, other]: [S; 2]) -> [Touch<S>; 2] {
    let one = S::one();
    let axes = [first.axis(2), second.axis(2)];
    let (e, f) = (axes[0] * half, axes[1] * other);
    let apart = first.position - second.position;
    // min |apart + x e − y f|²: [ee −ef; −ef ff] [x; y] = [u; w]
    let (ee, ef, ff) = (e.dot(&e), -e.dot(&f), f.dot(&f));
    let (u, w) = (-e.dot(&apart), f.dot(&apart));
    let determinant = ee * ff - ef * ef;
    let across = axes[0].cross(&axes[1]);
    let is_crossed = one - flag::<S>((S::from_f64(PARALLEL) - across.dot(&across)).positive());
    let crosses = is_crossed.positive();
    let divisor = S::select(crosses, determinant, one);
    let (x, y) = ((ff * u - ef * w) / divisor, (ee * w - ef * u) / divisor);
    // Within the first axis, then within the second.
    let y_at = |x: S| (w - ef * x) / ff;
    let x_at = |y: S| within((u - ef * y) / ee, one);
    let (over, under) = ((x - one).positive(), (-(x + one)).positive());
    let y = S::select(over, y_at(one), S::select(under, y_at(-one), y));
    let x = within(x, one);
    let (over, under) = ((y - one).positive(), (-(y + one)).positive());
    let x = S::select(over, x_at(one), S::select(under, x_at(-one), x));
    let y = within(y, one);
    let place = |x: S, y: S, exists: S| balls([(first.position + e * x, a), (second.position + f * y, b)], axes, exists);
    // Parallel: both ends of the part that they have in common
    let mut chosen = [x, y, x, y];
    S::when((one - is_crossed).positive(), &mut chosen, |chosen| {
        let same = S::select((-ef).positive(), one, -one);
        for (side, own) in [-one, one].into_iter().zip(chosen.chunks_mut(2)) {
            // The end of the second on this side, or that of the first
            let end = side * same;
            let is_within = (one - (u - ef * end) / ee * side).positive();
            own[0] = S::select(is_within, x_at(end), side);
            own[1] = S::select(is_within, end, within(y_at(side), one));
        }
    });
    let [x, y, x1, y1] = chosen;
    [place(x, y, one), place(x1, y1, one - is_crossed)]
}
