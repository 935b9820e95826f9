//! Two boxes.
//!
//! ```text
//! 1. the axis along which they overlap least: of 3 + 3 faces and 9 pairs of edges
//! 2. an axis of edges:  the points of both edges that are next to each other
//!    an axis of a face: the face of the other box that is opposite, cut by the sides of this face
//! ```
//!
//! A face wins where a pair of edges is hardly better. A cut face has the ends of its four edges
//! within the sides, and the corners of the first face within it: twelve places, of which eight
//! exist at most. Source: Gottschalk, Lin, Manocha, SIGGRAPH 1996 (the axes); the rules for ties
//! and for places are those of MuJoCo.

use alloc::vec::Vec;

use super::{Placed, Touch};
use crate::Scalar;
use crate::scalar::{flag, greater, of_precision, two_to, within};
use crate::spatial::{Matrix3, Vector3, rotate, rotate_back};

/// The number of places.
pub(super) const PLACES: usize = 12;

/// An edge wins over a face by this part.
const BIAS: f64 = 1e-6;
/// A face takes the place of an edge whose axis is this near, if it is worse by this part at most.
const ALONG: f64 = 0.99;
const WORSE: f64 = 0.05;
const LEAST: f64 = 1e-15;
/// Powers of two, of `f64` and of `f32`. In parts of all sizes: a distance that is rounding.
const ROUNDING: [i32; 2] = [-43, -20];
/// The square of the sine below which edges are parallel.
const PARALLEL: [i32; 2] = [-53, -23];
/// The component of an axis below which both corners are next.
const AMBIGUOUS: [i32; 2] = [-30, -17];
/// The squared distance of places that are the same, in parts of the square of the face.
const SAME: [i32; 2] = [-46, -33];
/// By which part a corner may be outside of a face.
const OUTSIDE: [i32; 2] = [-46, -19];

/// Two boxes with these halves of sides.
pub(super) fn boxes<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, halves: [[S; 3]; 2], reach: S) -> Vec<Touch<S>> {
    let pair = Pair::new(first, second, halves, reach);
    let faces = pair.faces();
    let edges = pair.edges(&faces);
    let exists = one_minus(flag::<S>((greater(faces.most, edges.most) - pair.reach).positive()));
    let edge = pair.touch_of_edges(&edges);
    let mut all = pair.touches_of_face(&faces);
    let is_edge = edges.wins.positive();
    for touch in &mut all {
        touch.exists = exists * touch.exists * one_minus(edges.wins);
    }
    let place = &mut all[0];
    let choose = |a: Vector3<S>, b: Vector3<S>| a.zip_map(&b, |a, b| S::select(is_edge, a, b));
    *place = Touch {
        exists: S::select(is_edge, exists * edge.exists, place.exists),
        distance: S::select(is_edge, edge.distance, place.distance),
        point: choose(edge.point, place.point),
        normal: choose(edge.normal, place.normal),
        tangent: None,
    };
    all
}

fn one_minus<S: Scalar>(x: S) -> S {
    S::one() - x
}

/// 1, or −1 of a negative number.
fn sign<S: Scalar>(x: S) -> S {
    S::select((-x).positive(), -S::one(), S::one())
}

/// Both boxes, seen from each other.
struct Pair<'a, S> {
    first: &'a Placed<'a, S>,
    second: &'a Placed<'a, S>,
    halves: [[S; 3]; 2],
    /// Axes of the second box in axes of the first, as columns.
    rotation: Matrix3<S>,
    /// The centre of the second box in the first, and of the first in the second.
    centers: [Vector3<S>; 2],
    /// Boxes that are further apart do not touch, m.
    reach: S,
    /// A number that no pass knows, 0 or more.
    unknown: S,
}

/// The face that is next.
struct Faces<S> {
    /// The distance along its axis, m.
    best: S,
    /// 1: it is one of the second box.
    is_of_second: S,
    /// Which axis it has: one of three is 1.
    axis: [S; 3],
    /// The largest distance along any axis, m.
    most: S,
}

/// The pair of edges that is next.
struct Edges<S> {
    /// 1: it wins over the face.
    wins: S,
    /// The axis across both, in the first box.
    across: Vector3<S>,
    /// Which edge of each box: one of three is 1.
    along: [[S; 3]; 2],
    most: S,
}

impl<'a, S: Scalar> Pair<'a, S> {
    fn new(first: &'a Placed<'a, S>, second: &'a Placed<'a, S>, halves: [[S; 3]; 2], reach: S) -> Self {
        let apart = second.position - first.position;
        let size = halves.iter().flatten().fold(S::zero(), |sum, half| sum + *half);
        Self {
            first,
            second,
            halves,
            rotation: Matrix3::from_fn(|i, j| first.axis(i).dot(&second.axis(j))),
            centers: [rotate_back(&first.rotation, apart), -rotate_back(&second.rotation, apart)],
            reach: reach + of_precision(apart.dot(&apart), ROUNDING) * size,
            unknown: apart.dot(&apart),
        }
    }

    fn faces(&self) -> Faces<S> {
        let (zero, one) = (S::zero(), S::one());
        let mut found: Option<Faces<S>> = None;
        for (owner, seen) in [self.rotation, self.rotation.transpose()].iter().enumerate() {
            let other = self.halves[1 - owner];
            for k in 0..3 {
                let radius = (0..3).fold(zero, |sum, j| sum + seen[(k, j)].abs() * other[j]);
                let distance = self.centers[owner][k].abs() - self.halves[owner][k] - radius;
                let axis = core::array::from_fn(|j| if j == k { one } else { zero });
                let own = Faces { best: distance, is_of_second: if owner == 1 { one } else { zero }, axis, most: distance };
                found = Some(match found {
                    None => own,
                    Some(before) => {
                        let is_better = (distance - before.best).positive();
                        let choose = |a: S, b: S| S::select(is_better, a, b);
                        Faces {
                            best: choose(distance, before.best),
                            is_of_second: choose(own.is_of_second, before.is_of_second),
                            axis: core::array::from_fn(|j| choose(own.axis[j], before.axis[j])),
                            most: choose(distance, before.most),
                        }
                    }
                });
            }
        }
        found.unwrap_or(Faces { best: zero, is_of_second: zero, axis: [one, zero, zero], most: zero })
    }

    fn edges(&self, faces: &Faces<S>) -> Edges<S> {
        let (zero, one) = (S::zero(), S::one());
        let [first, second] = self.halves;
        let mut best = faces.best;
        let mut found = Edges { wins: zero, across: Vector3::new(one, zero, zero), along: [[one, zero, zero]; 2], most: faces.most };
        for i in 0..3 {
            for j in 0..3 {
                let other = self.rotation.column(j);
                // e_i × b_j: its component i is zero.
                let [i1, i2, j1, j2] = [(i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3];
                let (x, y) = (-other[i2], other[i1]);
                let square = x * x + y * y;
                let is_crossed = one_minus(flag::<S>((of_precision(self.unknown, PARALLEL) - square).positive()));
                let length = S::select(is_crossed.positive(), square, one).sqrt();
                let (x, y) = (x / length, y / length);
                let on_second = |k: usize| x * self.rotation[(i1, k)] + y * self.rotation[(i2, k)];
                let radius =
                    first[i1] * x.abs() + first[i2] * y.abs() + second[j1] * on_second(j1).abs() + second[j2] * on_second(j2).abs();
                let distance = (x * self.centers[0][i1] + y * self.centers[0][i2]).abs() - radius;
                let is_crossed = is_crossed.positive();
                found.most = S::select(is_crossed, greater(found.most, distance), found.most);
                let beats = flag::<S>((distance - S::from_f64(BIAS) * distance.abs() - best).positive());
                let beats = S::select(is_crossed, beats * flag::<S>((distance - faces.best).positive()), zero).positive();
                let choose = |a: S, b: S| S::select(beats, a, b);
                best = choose(distance, best);
                found.wins = choose(one, found.wins);
                let across = Vector3::from_fn(|k, _| if k == i1 { x } else { y } * if k == i { zero } else { one });
                found.across = across.zip_map(&found.across, choose);
                for (along, own) in found.along.iter_mut().zip([i, j]) {
                    *along = core::array::from_fn(|k| choose(if k == own { one } else { zero }, along[k]));
                }
            }
        }
        // The axis of the face, in the first box
        let of = |row: Vector3<S>| (0..3).fold(zero, |sum, k| sum + row[k] * faces.axis[k]);
        let in_first = Vector3::from_fn(|k, _| of(self.rotation.row(k).transpose()));
        let is_of_second = faces.is_of_second.positive();
        let face = Vector3::from(faces.axis).zip_map(&in_first, |a, b| S::select(is_of_second, b, a));
        let is_along = flag::<S>((found.across.dot(&face).abs() - S::from_f64(ALONG)).positive());
        let allowed = faces.best + S::from_f64(WORSE) * faces.best.abs() + S::from_f64(LEAST);
        found.wins *= one_minus(is_along * flag::<S>((allowed - best).positive()));
        found
    }

    /// The points of two edges that are next to each other, all in the first box.
    fn touch_of_edges(&self, edges: &Edges<S>) -> Touch<S> {
        let (zero, one, half) = (S::zero(), S::one(), S::from_f64(0.5));
        let across = edges.across * sign(edges.across.dot(&self.centers[0]));
        let [first, second] = edges.along.map(Vector3::from);
        let size = |owner: usize| (0..3).fold(zero, |sum, k| sum + self.halves[owner][k] * edges.along[owner][k]);
        let (most, least) = (size(0), size(1));
        let ambiguous = of_precision(self.unknown, AMBIGUOUS);
        // A corner next along an axis, and the way to the other one where both are next
        let corner = |axis: &Vector3<S>, owner: usize| {
            let beside = |k: usize| self.halves[owner][k] * one_minus(edges.along[owner][k]);
            let corner = Vector3::from_fn(|k, _| sign(axis[k]) * beside(k));
            let is_both = |k: usize| flag::<S>((ambiguous - axis[k].abs()).positive());
            (corner, Vector3::from_fn(|k, _| is_both(k) * (-(corner[k] + corner[k]))))
        };
        let (on_first, way) = corner(&across, 0);
        let seen = rotate_back(&self.rotation, across);
        let (on_second, other_way) = corner(&-seen, 1);
        let (on_second, other_way) = (rotate(&self.rotation, on_second) + self.centers[0], rotate(&self.rotation, other_way));
        let second = rotate(&self.rotation, second);
        let b = first.dot(&second);
        let rest = one - b * b;
        let is_crossed = one_minus(flag::<S>((S::from_f64(LEAST) - rest).positive())).positive();
        let divisor = S::select(is_crossed, rest, one);
        // The squared gap, and both points
        let mut best = [S::from_f64(two_to(100)), zero, zero, zero, zero, zero, zero];
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
        let table: Vec<S> = corners.iter().flatten().map(|x| S::from_f64(*x)).collect();
        S::for_each(corners.len(), &table, &mut best, &mut [], |row, best, _| {
            let (c, d) = (on_first + way * row[0], on_second + other_way * row[1]);
            let e = d - c;
            let (u, w) = (first.dot(&e), second.dot(&e));
            let s = within(S::select(is_crossed, (u - b * w) / divisor, zero), most);
            let t = within(b * s - w, least);
            let s = within(u + b * t, most);
            let (c, d) = (c + first * s, d + second * t);
            let gap = d - c;
            let square = gap.dot(&gap);
            let is_better = (best[0] - square).positive();
            let own = [square, c.x, c.y, c.z, d.x, d.y, d.z];
            best.iter_mut().zip(own).for_each(|(best, own)| *best = S::select(is_better, own, *best));
        });
        let [_, a, b, c, d, e, f] = best;
        let (one_point, other) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        let distance = (other - one_point).dot(&across);
        Touch {
            exists: one_minus(flag::<S>((distance - self.reach).positive())),
            distance,
            point: self.first.position + rotate(&self.first.rotation, (one_point + other) * half),
            normal: rotate(&self.first.rotation, across),
            tangent: None,
        }
    }

    /// The places of a face of the other box within a face.
    fn touches_of_face(&self, faces: &Faces<S>) -> Vec<Touch<S>> {
        let (one, half) = (S::one(), S::from_f64(0.5));
        let is_of_second = faces.is_of_second.positive();
        let owner = |first: S, second: S| S::select(is_of_second, second, first);
        // All seen from the box of the face, whose axes are turned: x and y across it, z out of it
        let turned = |x: [S; 3]| -> [S; 3] {
            let [a, b, _] = faces.axis.map(Scalar::positive);
            core::array::from_fn(|k| S::select(a, x[(k + 1) % 3], S::select(b, x[(k + 2) % 3], x[k])))
        };
        let three = |first: [S; 3], second: [S; 3]| core::array::from_fn(|k| owner(first[k], second[k]));
        let [size, other] = [three(self.halves[0], self.halves[1]), three(self.halves[1], self.halves[0])];
        let size = turned(size);
        let center = turned(three(self.centers[0].into(), self.centers[1].into()));
        let seen: [[S; 3]; 3] =
            core::array::from_fn(|k| turned(core::array::from_fn(|i| owner(self.rotation[(i, k)], self.rotation[(k, i)]))));
        // Axes of the other box: the last one is the most upright.
        let upright = seen.map(|axis| axis[2].abs());
        let is_second = flag::<S>((upright[1] - upright[0]).positive());
        let most = S::select(is_second.positive(), upright[1], upright[0]);
        let is_third = flag::<S>((upright[2] - most).positive());
        let (is_second, is_third) = (is_second.positive(), is_third.positive());
        // Which of three is last: the cyclic order stays.
        let ordered = |x: [S; 3]| -> [S; 3] {
            core::array::from_fn(|k| S::select(is_third, x[k], S::select(is_second, x[(k + 2) % 3], x[(k + 1) % 3])))
        };
        let by_component: [[S; 3]; 3] = core::array::from_fn(|r| ordered(seen.map(|axis| axis[r])));
        let other = ordered(other);
        let out = sign(center[2]);
        let towards = -sign(out * by_component[2][2]);
        let scale = |r: usize| if r == 2 { out } else { one };
        let middle: [S; 3] = core::array::from_fn(|r| {
            let x = scale(r) * (center[r] + towards * other[2] * by_component[r][2]);
            if r == 2 { x - size[2] } else { x }
        });
        let side = |k: usize| -> [S; 3] { core::array::from_fn(|r| scale(r) * other[k] * by_component[r][k]) };
        let places = cut(&middle, [side(0), side(1)], [size[0], size[1]], [OUTSIDE, SAME].map(|n| of_precision(self.unknown, n)));
        // Back to the world
        let axis = |k: usize| turned(core::array::from_fn(|j| owner(self.first.rotation[(k, j)], self.second.rotation[(k, j)])));
        let axes = [axis(0), axis(1), axis(2)];
        let position = Vector3::from_fn(|k, _| owner(self.first.position[k], self.second.position[k]));
        let normal = Vector3::from_fn(|k, _| axes[k][2]) * (out * owner(one, -one));
        let touch = |place: Place<S>| {
            let [x, y, z] = place.point;
            let up = out * (size[2] + half * z);
            let point = position + Vector3::from_fn(|k, _| axes[k][0] * x + axes[k][1] * y + axes[k][2] * up);
            Touch { exists: place.exists, distance: z, point, normal, tangent: None }
        };
        places.into_iter().map(touch).collect()
    }
}

/// A corner of a cut face.
struct Place<S> {
    exists: S,
    /// Across the face, and above it.
    point: [S; 3],
}

/// The corners of a parallelogram, of which this is the middle and halves of its sides, within
/// |x|, |y| ≤ size.
fn cut<S: Scalar>(middle: &[S; 3], [u, w]: [[S; 3]; 2], size: [S; 2], [outside, same]: [S; 2]) -> Vec<Place<S>> {
    let (zero, one) = (S::zero(), S::one());
    let at = |a: S, b: S| -> [S; 3] { core::array::from_fn(|r| middle[r] + a * u[r] + b * w[r]) };
    let corners = [at(one, one), at(-one, one), at(-one, -one), at(one, -one)];
    let mut places: Vec<Place<S>> = Vec::with_capacity(PLACES);
    for k in 0..4 {
        let (p, q) = (corners[k], corners[(k + 1) % 4]);
        // The part of the edge within the sides: from t₀ to t₁
        let (mut from, mut to, mut is_in) = (zero, one, one);
        for axis in 0..2 {
            for side in [one, -one] {
                let [before, behind] = [p, q].map(|corner| side * corner[axis] - size[axis]);
                let [leaves, enters] = [behind, before].map(|x| flag::<S>(x.positive()));
                let changes = leaves + enters - (leaves * enters + leaves * enters);
                let t = before / S::select(changes.positive(), before - behind, one);
                let [is_end, is_start] = [leaves * one_minus(enters), enters * one_minus(leaves)].map(Scalar::positive);
                to = S::select(is_end, S::select((to - t).positive(), t, to), to);
                from = S::select(is_start, greater(from, t), from);
                is_in *= one_minus(leaves * enters);
            }
        }
        is_in *= one_minus(flag::<S>((from - to).positive()));
        let along = |t: S| -> [S; 3] { core::array::from_fn(|r| p[r] + t * (q[r] - p[r])) };
        places.push(Place { exists: is_in, point: along(from) });
        // The end of an edge that is not cut is the start of the next one.
        places.push(Place { exists: is_in * flag::<S>((one - to).positive()), point: along(to) });
    }
    let determinant = u[0] * w[1] - u[1] * w[0];
    let divisor = S::select(determinant.abs().positive(), determinant, one);
    for [a, b] in [[one, one], [-one, one], [-one, -one], [one, -one]] {
        let [x, y] = [a * size[0], b * size[1]];
        let (dx, dy) = (x - middle[0], y - middle[1]);
        let (s, t) = ((dx * w[1] - dy * w[0]) / divisor, (dy * u[0] - dx * u[1]) / divisor);
        let is_out = |x: S| flag::<S>((x.abs() - (one + outside)).positive());
        let exists = one_minus(is_out(s)) * one_minus(is_out(t));
        places.push(Place { exists, point: [x, y, middle[2] + s * u[2] + t * w[2]] });
    }
    // Of places that are the same, the first one
    let square = size[0] * size[0] + size[1] * size[1];
    let same = same * square;
    for k in 0..places.len() {
        let mut exists = places[k].exists;
        for before in &places[..k] {
            let [dx, dy] = [0, 1].map(|r| before.point[r] - places[k].point[r]);
            exists *= one_minus(before.exists * flag::<S>((same - (dx * dx + dy * dy)).positive()));
        }
        places[k].exists = exists;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::Form;
    use crate::spatial::from_rpy;

    fn touching(second: [f64; 3], turn: [f64; 3], halves: [[f64; 3]; 2]) -> Vec<Touch<f64>> {
        let forms = halves.map(|half| Form::Box { half });
        let placed = |form, rotation, position: [f64; 3]| Placed { form, rotation, position: Vector3::from(position) };
        let one = placed(&forms[0], Matrix3::identity(), [0.0; 3]);
        let other = placed(&forms[1], from_rpy(turn), second);
        let mut all = boxes(&one, &other, halves, 0.0);
        all.retain(|touch| touch.exists == 1.0);
        all
    }

    #[test]
    fn a_box_on_another_touches_at_the_corners_of_the_smaller_one() {
        for (halves, turn) in [([[0.5, 0.4, 0.1], [0.2, 0.1, 0.3]], 0.7), ([[0.2, 0.1, 0.1], [0.9, 0.8, 0.3]], 0.3)] {
            let all = touching([0.0, 0.0, halves[0][2] + halves[1][2] - 0.01], [0.0, 0.0, turn], halves);
            assert_eq!(all.len(), 4);
            for touch in all {
                assert!((touch.distance + 0.01).abs() < 1e-15 && (touch.normal - Vector3::z()).norm() < 1e-15);
                assert!((touch.point.z - halves[0][2] + 0.005).abs() < 1e-15);
                assert!((touch.point.xy().norm() - 0.2_f64.hypot(0.1)).abs() < 1e-15, "{}", touch.point);
            }
        }
    }

    /// Equal faces, one turned by 45°: a regular octagon.
    #[test]
    fn a_cut_face_has_eight_corners() {
        let all = touching([0.0, 0.0, -1.98], [0.0, 0.0, core::f64::consts::FRAC_PI_4], [[1.0; 3]; 2]);
        assert_eq!(all.len(), 8);
        let radius = 1.0 / (core::f64::consts::PI / 8.0).cos();
        for touch in &all {
            assert!((touch.point.xy().norm() - radius).abs() < 1e-14 && (touch.normal + Vector3::z()).norm() < 1e-15);
        }
        // Equal boxes that lie on each other: each corner once
        assert_eq!(touching([0.0, 0.0, 1.98], [0.0; 3], [[1.0; 3]; 2]).len(), 4);
        assert_eq!(touching([0.0, 0.0, 2.02], [0.0; 3], [[1.0; 3]; 2]).len(), 0);
    }

    #[test]
    fn crossed_edges_touch_at_one_point() {
        // Edges along y below and along x above, at z = 1 and z = √2 − …
        let turn = core::f64::consts::FRAC_PI_4;
        let forms = [[1.0; 3]; 2].map(|half| Form::Box { half });
        let placed = |form, rotation, z: f64| Placed { form, rotation, position: Vector3::new(0.0, 0.0, z) };
        let one = placed(&forms[0], from_rpy([0.0, turn, 0.0]), 0.0);
        let other = placed(&forms[1], from_rpy([turn, 0.0, 0.0]), 2.0 * 2_f64.sqrt() - 0.01);
        let all: Vec<_> = boxes(&one, &other, [[1.0; 3]; 2], 0.0).into_iter().filter(|touch| touch.exists == 1.0).collect();
        assert_eq!(all.len(), 1);
        assert!((all[0].distance + 0.01).abs() < 1e-14 && (all[0].normal - Vector3::z()).norm() < 1e-14);
        assert!((all[0].point - Vector3::new(0.0, 0.0, 2_f64.sqrt() - 0.005)).norm() < 1e-14);
    }
}
