//! A capsule and a box: spheres at one or two points of the axis of the capsule.
//!
//! The first is the point of the axis that is next to the box: an end of the axis over a face, or
//! the point next to one of the twelve edges. The second follows the axis along the face or the
//! edge, as far as both reach. The rules for it are those of MuJoCo.

use alloc::vec;
use alloc::vec::Vec;

use super::{Placed, Touch, solid};
use crate::Scalar;
use crate::scalar::{flag, within};
use crate::spatial::{Matrix3, Vector3, rotate, rotate_back};

const LEAST: f64 = 1e-15;

/// Where the axis is next to the box. Flags are 1 or 0.
struct Next<S> {
    /// The squared distance, m².
    square: S,
    /// The point of the axis, from −1 to 1.
    at: S,
    /// The point of the edge, from −1 to 1.
    on_edge: S,
    /// What is next: a face, or the inside; a corner; the middle of an edge.
    is_face: S,
    is_corner: S,
    is_edge: S,
    /// Which face or edge: none of them inside.
    axis: [S; 3],
    /// Of a corner or an edge, whether it is on the positive side.
    corner: [S; 3],
}

/// A capsule and a box with these halves of its sides.
pub(super) fn capsule_box<S: Scalar>(
    first: &Placed<'_, S>,
    second: &Placed<'_, S>,
    [radius, half]: [S; 2],
    sides: [S; 3],
    reach: S,
) -> [Touch<S>; 2] {
    let (zero, one, two) = (S::zero(), S::one(), S::from_f64(2.0));
    let center = rotate_back(&second.rotation, first.position - second.position);
    let axis = rotate_back(&second.rotation, first.axis(2));
    let way = axis * half;
    let most = reach + two * (radius + half + sides[0] + sides[1] + sides[2]);
    let ends = nearest_end(&center, &way, sides, most);
    let next = nearest_edge(&center, &way, half, sides, &ends);
    let exists = next.is_face + next.is_corner + next.is_edge;
    let upward: [S; 3] = core::array::from_fn(|k| flag::<S>(way[k].positive()));
    let xor = |a: S, b: S| a + b - two * a * b;
    let against: [S; 3] = core::array::from_fn(|k| xor(upward[k], next.corner[k]));
    // So far does the axis go beyond this length.
    let past = |length: S, k: usize| {
        let size = way[k].abs();
        S::select(size.positive(), length / S::select(size.positive(), size, one), S::from_f64(1e30))
    };
    let lesser = |a: S, b: S| S::select((a - b).positive(), b, a);
    let over = |k: usize| past(two * sides[k], k);
    let is = |x: S, n: f64| flag::<S>((S::from_f64(0.25) - (x - S::from_f64(n)) * (x - S::from_f64(n))).positive());

    // Corner: along an edge, or along a face
    let count = against[0] + against[1] + against[2];
    let (single, double) = (is(count, 1.0), is(count, 2.0));
    let onward = single - double;
    let alone = against.map(|x| S::select(single.positive(), x, one - x));
    let chosen = |x: [S; 3]| (0..3).fold(zero, |sum, k| sum + alone[k] * x[k]);
    let overs = [over(0), over(1), over(2)];
    let is_steep = (chosen([0, 1, 2].map(|k| axis[k] * axis[k])) - S::from_f64(0.5)).positive();
    let along_edge = lesser(one - onward * next.at, chosen(overs));
    let other = (0..3).fold(one + onward * next.at, |most, k| S::select(alone[k].positive(), most, lesser(most, overs[k])));
    let by_corner = S::select(is_steep, along_edge * onward, -(other * onward));
    let has_corner = next.is_corner * (single + double);

    // Edge: towards the face at the smaller angle
    let (mut by_edge, mut has_edge) = (zero, zero);
    for k in 0..3 {
        let [a, b] = [(k + 1) % 3, (k + 2) % 3];
        let is_crossed = is(against[a] + against[b], 1.0);
        let swaps = (axis[a].abs() - axis[b].abs()).positive();
        let pick = |x: S, y: S| S::select(swaps, x, y);
        let ahead = pick(against[a], against[b]);
        let onward = two * ahead - one;
        let same = one - xor(upward[k], ahead);
        let rest = one - (two * same - one) * next.on_edge;
        let length = lesser(lesser(one - onward * next.at, pick(overs[a], overs[b])), past(sides[k] * rest, k));
        let counts = next.axis[k] * next.is_edge * is_crossed;
        by_edge += counts * length * onward;
        has_edge += counts;
    }

    // Face: from the end inwards, until the axis leaves the face
    let onward = -next.at;
    let end = center + way * next.at;
    let mut length = two;
    for k in 0..3 {
        for side in [sides[k], -sides[k]] {
            let size = way[k] * way[k];
            let rate = S::select(size.positive(), way[k], one);
            let own = (side - end[k]) / rate * onward;
            let counts = flag::<S>(own.positive()) * flag::<S>((length - own).positive()) * flag::<S>(size.positive());
            length = S::select((counts * (one - next.axis[k])).positive(), own, length);
        }
    }
    let has_face = next.is_face * (next.axis[0] + next.axis[1] + next.axis[2]);

    let choose = |has: S, own: S, other: S| S::select(has.positive(), own, other);
    let further = choose(has_face, length * onward, choose(has_edge, by_edge, choose(has_corner, by_corner, zero)));
    let ball = |at: S, exists: S| {
        let center = second.position + rotate(&second.rotation, center + way * at);
        let placed = Placed { form: first.form, rotation: Matrix3::zeros(), position: center };
        Touch { exists, ..solid::sphere_box(&placed, second, radius, sides) }
    };
    [ball(next.at, exists), ball(next.at + further, exists * (has_corner + has_edge + has_face))]
}

/// The end of the axis that is inside or over a face, if it is nearer than `most`.
fn nearest_end<S: Scalar>(center: &Vector3<S>, way: &Vector3<S>, sides: [S; 3], most: S) -> Next<S> {
    let (zero, one) = (S::zero(), S::one());
    let mut next =
        Next { square: most, at: zero, on_edge: zero, is_face: zero, is_corner: zero, is_edge: zero, axis: [zero; 3], corner: [zero; 3] };
    for at in [-one, one] {
        let end = center + way * at;
        let beyond = Vector3::from_fn(|k, _| end[k] - within(end[k], sides[k]));
        let is_out: [S; 3] = core::array::from_fn(|k| flag::<S>((end[k].abs() - sides[k]).positive()));
        let square = beyond.dot(&beyond);
        let over_one = flag::<S>((S::from_f64(1.5) - (is_out[0] + is_out[1] + is_out[2])).positive());
        let is_nearer = (over_one * flag::<S>((next.square - square).positive())).positive();
        let choose = |a: S, b: S| S::select(is_nearer, a, b);
        next.square = choose(square, next.square);
        next.at = choose(at, next.at);
        next.is_face = choose(one, next.is_face);
        next.axis = core::array::from_fn(|k| choose(is_out[k], next.axis[k]));
    }
    next
}

/// The point of the axis that is next to one of the edges, if it is nearer than this.
fn nearest_edge<S: Scalar>(center: &Vector3<S>, way: &Vector3<S>, half: S, sides: [S; 3], next: &Next<S>) -> Next<S> {
    let (zero, one) = (S::zero(), S::one());
    // The signs of the middle of an edge, and its direction
    let mut table: Vec<S> = Vec::new();
    for along in 0..3 {
        for corner in (0..8).filter(|corner| corner & (1 << along) == 0) {
            table.extend((0..3).map(|k| {
                if k == along {
                    zero
                } else if corner & (1 << k) == 0 {
                    -one
                } else {
                    one
                }
            }));
            table.extend((0..3).map(|k| if k == along { one } else { zero }));
        }
    }
    let mut state = vec![next.square, next.at, next.on_edge, next.is_face, next.is_corner, next.is_edge];
    state.extend(next.axis.iter().chain(&next.corner));
    S::for_each(12, &table, &mut state, &mut [], |row, state, _| {
        let (signs, along) = ([row[0], row[1], row[2]], [row[3], row[4], row[5]]);
        let pick = |x: [S; 3]| (0..3).fold(zero, |sum, k| sum + along[k] * x[k]);
        let middle = Vector3::from_fn(|k, _| signs[k] * sides[k]);
        let apart = middle - center;
        let length = pick(sides);
        // min |apart + x e − y way|², e along the edge
        let (ee, ef, ff) = (length * length, -(length * pick((*way).into())), half * half);
        let (u, w) = (-(length * pick(apart.into())), way.dot(&apart));
        let determinant = ee * ff - ef * ef;
        let is_parallel = flag::<S>((S::from_f64(LEAST) - determinant.abs()).positive());
        let divisor = S::select(is_parallel.positive(), one, determinant);
        let (x, y) = ((ff * u - ef * w) / divisor, (ee * w - ef * u) / divisor);
        // Which corner clipped x: 1, −1 or 0. It stays if y then moves x along the edge.
        let side = |x: S, other: S| S::select((x - one).positive(), one, S::select((-(x + one)).positive(), -one, other));
        let clips = side(x, zero);
        let (over, under) = (clips.positive(), (-clips).positive());
        let y = S::select(over, (w - ef) / ff, S::select(under, (w + ef) / ff, y));
        let (over, under) = ((y - one).positive(), (-(y + one)).positive());
        let x = S::select(over, (u - ef) / ee, S::select(under, (u + ef) / ee, within(x, one)));
        let clips = side(x, clips);
        let (x, y) = (within(x, one), within(y, one));
        let way = apart - way * y + Vector3::from_fn(|k, _| along[k] * sides[k]) * x;
        let square = way.dot(&way);
        let is_nearer = (state[0] - S::from_f64(LEAST) - square).positive();
        let is_nearer = ((one - is_parallel) * flag::<S>(is_nearer)).positive();
        let (is_corner, is_high) = (clips.abs(), flag::<S>(clips.positive()));
        let own = [square, y, x, zero, is_corner, one - is_corner];
        let half = S::from_f64(0.5);
        let bit = |k: usize| (one - along[k]) * (half + half * signs[k]) + along[k] * is_high;
        let own = own.into_iter().chain(along).chain([bit(0), bit(1), bit(2)]);
        state.iter_mut().zip(own).for_each(|(state, own)| *state = S::select(is_nearer, own, *state));
    });
    Next {
        square: state[0],
        at: state[1],
        on_edge: state[2],
        is_face: state[3],
        is_corner: state[4],
        is_edge: state[5],
        axis: [state[6], state[7], state[8]],
        corner: [state[9], state[10], state[11]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::Form;
    use crate::spatial::from_rpy;

    fn touching(position: [f64; 3], turn: [f64; 3]) -> Vec<Touch<f64>> {
        let (capsule, cuboid) = (Form::Capsule { radius: 0.1, half: 0.5 }, Form::Box { half: [1.0, 0.7, 0.4] });
        let first = Placed { form: &capsule, rotation: from_rpy(turn), position: Vector3::from(position) };
        let second = Placed { form: &cuboid, rotation: Matrix3::identity(), position: Vector3::zeros() };
        let all = capsule_box(&first, &second, [0.1, 0.5], [1.0, 0.7, 0.4], 0.0);
        all.into_iter().filter(|touch| touch.exists == 1.0).collect()
    }

    const RIGHT: f64 = core::f64::consts::FRAC_PI_2;

    #[test]
    fn a_capsule_that_lies_on_a_face_touches_at_two_points() {
        let all = touching([0.2, 0.1, 0.49], [0.0, RIGHT, 0.0]);
        assert_eq!(all.len(), 2);
        let mut places: Vec<f64> = all.iter().map(|touch| touch.point.x).collect();
        places.sort_by(f64::total_cmp);
        assert!((places[0] + 0.3).abs() < 1e-12 && (places[1] - 0.7).abs() < 1e-12, "{places:?}");
        for touch in all {
            assert!((touch.distance + 0.01).abs() < 1e-14 && (touch.normal + Vector3::z()).norm() < 1e-14);
        }
        // Beyond the edge the second point is at the edge.
        let mut places: Vec<f64> = touching([0.8, 0.1, 0.49], [0.0, RIGHT, 0.0]).iter().map(|touch| touch.point.x).collect();
        places.sort_by(f64::total_cmp);
        assert!((places[0] - 0.3).abs() < 1e-12 && (places[1] - 1.0).abs() < 1e-12, "{places:?}");
    }

    #[test]
    fn a_capsule_on_its_end_touches_at_one_point() {
        let all = touching([0.2, 0.1, 0.99], [0.0; 3]);
        assert!((all[0].distance + 0.01).abs() < 1e-14 && (all[0].point - Vector3::new(0.2, 0.1, 0.395)).norm() < 1e-14);
        // The other point is far away.
        assert!(all[1..].iter().all(|touch| touch.distance > 0.9));
    }

    #[test]
    fn a_capsule_across_an_edge_touches_at_its_nearest_point() {
        // Through (1, 0, 0.4) + 0.09 (1, 0, 1)/√2, along y
        let s = 0.09 * 0.5_f64.sqrt();
        let all = touching([1.0 + s, 0.0, 0.4 + s], [0.0, core::f64::consts::FRAC_PI_4, 0.0].map(|x| x * 3.0));
        let nearest = all.iter().map(|touch| touch.distance).fold(f64::MAX, f64::min);
        assert!((nearest + 0.01).abs() < 1e-12, "{nearest}");
    }
}
