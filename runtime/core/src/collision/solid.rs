//! A sphere and a solid with edges.

use super::round::balls;
use super::{Placed, Touch};
use crate::Scalar;
use crate::scalar::{flag, within};
use crate::spatial::{Vector3, rotate, rotate_back};

/// The side, a cap or the rim, whichever is next.
pub(super) fn sphere_cylinder<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, radius: S, own: S, half: S) -> Touch<S> {
    let (zero, one) = (S::zero(), S::one());
    let axis = second.axis(2);
    let apart = first.position - second.position;
    let along = axis.dot(&apart);
    let across = apart - axis * along;
    let square = across.dot(&across);
    let far = S::select(square.positive(), square, one).sqrt();
    let out = S::select(square.positive(), far, zero);
    let beside = flag::<S>((half - along.abs()).positive());
    let above = flag::<S>((own - out).positive());
    // Inside, the nearer one counts.
    let is_cap_nearer = flag::<S>(((own - out) - (half - along.abs())).positive());
    let inside = beside * above;
    let side = beside * (one - inside * is_cap_nearer);
    let cap = above * (one - inside * (one - is_cap_nearer));
    let sign = S::select(along.positive(), one, -one);
    let rim = second.position + across * (own / far) + axis * (half * sign);
    let (is_side, is_cap) = (side.positive(), cap.positive());
    let center = (second.position + axis * along).zip_map(&rim, |a, b| S::select(is_side, a, b));
    let other = S::select(is_side, own, zero);
    let round = balls([(first.position, radius), (center, other)], [first.axis(2), axis], one);
    // A plane at the end, with its normal from the sphere to the cylinder.
    let outward = axis * sign;
    let distance = along.abs() - half - radius;
    let point = first.position - outward * (radius + distance * S::from_f64(0.5));
    let choose = |a: Vector3<S>, b: Vector3<S>| a.zip_map(&b, |a, b| S::select(is_cap, a, b));
    Touch {
        exists: one,
        distance: S::select(is_cap, distance, round.distance),
        point: choose(point, round.point),
        normal: choose(-outward, round.normal),
        tangent: None,
    }
}

/// The point of the box that is next to the centre; inside, the face that is next.
pub(super) fn sphere_box<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, radius: S, half: [S; 3]) -> Touch<S> {
    let (zero, one) = (S::zero(), S::one());
    let center = rotate_back(&second.rotation, first.position - second.position);
    let clamped = Vector3::from_fn(|k, _| within(center[k], half[k]));
    let apart = clamped - center;
    let square = apart.dot(&apart);
    let is_outside = (square - S::from_f64(1e-30)).positive();
    let length = S::select(is_outside, square, one).sqrt();
    let outside = apart.map(|x| x / length);
    // The face that is next: of two at the same distance the first.
    let (mut depth, mut inside) = (half[0] + half[0] + half[1] + half[1] + half[2] + half[2], Vector3::zeros());
    for k in 0..3 {
        for sign in [-one, one] {
            let own = half[k] - sign * center[k];
            let is_next = (depth - own).positive();
            depth = S::select(is_next, own, depth);
            let face = Vector3::from_fn(|j, _| if j == k { -sign } else { zero });
            inside = face.zip_map(&inside, |a, b| S::select(is_next, a, b));
        }
    }
    let normal = outside.zip_map(&inside, |a, b| S::select(is_outside, a, b));
    let distance = S::select(is_outside, length - radius, -depth - radius);
    let point = center + normal * (radius + distance * S::from_f64(0.5));
    Touch {
        exists: one,
        distance,
        point: second.position + rotate(&second.rotation, point),
        normal: rotate(&second.rotation, normal),
        tangent: None,
    }
}
