//! The placements of moving joints, each according to the doc comments of [`JointKind`].

use std::f64::consts::{FRAC_PI_2, TAU};

use articulated_core::Scalar;
use articulated_core::description::{Joint, JointKind, Origin};
use nalgebra::{Matrix3, Vector3};

use crate::jet::Jet;

/// [R | p] in motion.
pub(super) type Pose<S> = (Matrix3<Jet<S>>, Vector3<Jet<S>>);

/// The child's placement in the joint's frame, for the joint's own coordinates, rates and their
/// derivatives.
pub(super) fn joint_pose<S: Scalar>(joint: &Joint, [q, v, a]: &[Vec<S>; 3]) -> Pose<S> {
    let x = |k: usize| Jet(q[k], v[k], a[k]);
    let still = (Matrix3::identity(), Vector3::zeros());
    let slide = |direction: Vector3<Jet<S>>, length: Jet<S>| direction.map(|c| c * length);
    match joint.kind {
        JointKind::Fixed => still,
        JointKind::Revolute | JointKind::Continuous => (turn(axis(joint.axis), x(0)), still.1),
        JointKind::Prismatic => (still.0, slide(axis(joint.axis), x(0))),
        // The double nearest to 2π is a turn.
        JointKind::Helical => {
            (turn(axis(joint.axis), x(0)), slide(axis(joint.axis), x(0) * Jet::from_f64(joint.pitch) / Jet::from_f64(TAU)))
        }
        JointKind::Universal => (turn(axis(joint.axis), x(0)) * turn(axis(joint.second_axis), x(1)), still.1),
        JointKind::Planar => {
            let [first, second] = plane(joint.axis);
            (turn(axis(joint.axis), x(2)), slide(first, x(0)) + slide(second, x(1)))
        }
        JointKind::Spherical => (attitude(q, three(v, 0), three(a, 0)), still.1),
        JointKind::Floating => free(q, v, a),
    }
}

/// The directions of x and y of a planar joint with this normal.
fn plane<S: Scalar>(normal: [f64; 3]) -> [Vector3<Jet<S>>; 2] {
    let e: [Vector3<Jet<S>>; 3] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let z = axis(normal);
    let along = (0..3).find(|&k| (0..3).all(|i| i == k || normal[i] == 0.0));
    let x = match along {
        Some(k) if normal[k] > 0.0 || k == 0 => e[(k + 1) % 3],
        Some(_) => e[0],
        // The coordinate axis furthest from the normal, the first of several, gives x = e × z.
        None => {
            let farthest = (0..3).fold(0, |best, k| if normal[k].abs() < normal[best].abs() { k } else { best });
            let x = e[farthest].cross(&z);
            let norm = x.dot(&x).sqrt();
            x.map(|c| c / norm)
        }
    };
    [x, z.cross(&x)]
}

pub(super) fn compose<S: Scalar>(a: &Pose<S>, b: &Pose<S>) -> Pose<S> {
    (a.0 * b.0, a.0 * b.1 + a.1)
}

pub(super) fn place<S: Scalar>(origin: &Origin) -> Pose<S> {
    let e = [Vector3::x(), Vector3::y(), Vector3::z()];
    let about = |k: usize| {
        let (s, c) = written(origin.rotation.rpy()[k]);
        from_axis(e[k], Jet::still(s), Jet::still(c))
    };
    (about(2) * about(1) * about(0), Vector3::from(origin.xyz).map(Jet::from_f64))
}

/// (sin, cos); the double nearest to a right angle is a right angle: that is a convention, not
/// dynamics.
fn written<S: Scalar>(angle: f64) -> (S, S) {
    let turns = (angle / FRAC_PI_2).round();
    if turns * FRAC_PI_2 != angle || turns.abs() > 4.0 {
        return S::from_f64(angle).sin_cos();
    }
    let exact = |x: f64| S::from_f64(x.round());
    (exact(angle.sin()), exact(angle.cos()))
}

fn turn<S: Scalar>(axis: Vector3<Jet<S>>, angle: Jet<S>) -> Matrix3<Jet<S>> {
    let (sin, cos) = angle.sin_cos();
    from_axis(axis, sin, cos)
}

/// cos·1 + sin·[e]× + (1 − cos)·e eᵀ.
fn from_axis<S: Scalar>(e: Vector3<Jet<S>>, sin: Jet<S>, cos: Jet<S>) -> Matrix3<Jet<S>> {
    let o = Jet::still(S::zero());
    let cross = Matrix3::new(o, -e.z, e.y, e.z, o, -e.x, -e.y, e.x, o);
    Matrix3::from_diagonal_element(cos) + cross * sin + e * e.transpose() * (Jet::still(S::one()) - cos)
}

fn axis<S: Scalar>(written: [f64; 3]) -> Vector3<Jet<S>> {
    let v: Vector3<S> = Vector3::from(written).map(S::from_f64);
    let norm = v.dot(&v).sqrt();
    v.map(|c| Jet::still(c / norm))
}

fn three<S: Scalar>(x: &[S], at: usize) -> Vector3<S> {
    Vector3::new(x[at], x[at + 1], x[at + 2])
}

/// A turning body: q = quaternion (x, y, z, w), ω in its own axes, and its derivative.
fn attitude<S: Scalar>(q: &[S], omega: Vector3<S>, alpha: Vector3<S>) -> Matrix3<Jet<S>> {
    let half = |x: [S; 4]| x.map(|c| S::from_f64(0.5) * c);
    let pure = |w: Vector3<S>| [w.x, w.y, w.z, S::zero()];
    let x = [q[0], q[1], q[2], q[3]];
    // ẋ = ½ x ω;  ẍ = ½ (ẋ ω + x ω̇)
    let first = half(product(x, pure(omega)));
    let (one, other) = (product(first, pure(omega)), product(x, pure(alpha)));
    let second = half([0, 1, 2, 3].map(|k| one[k] + other[k]));
    from_quaternion([0, 1, 2, 3].map(|k| Jet(x[k], first[k], second[k])))
}

/// A free body: q = (position; quaternion x, y, z, w), v = body twist [ω; v], a = v̇.
pub(super) fn free<S: Scalar>(q: &[S], v: &[S], a: &[S]) -> Pose<S> {
    let rotation = attitude(&q[3..], three(v, 0), three(a, 0));
    // ṗ = R v;  p̈ = Ṙ v + R v̇
    let (r, rate) = (rotation.map(|c| c.0), rotation.map(|c| c.1));
    let speed = r * three(v, 3);
    let change = rate * three(v, 3) + r * three(a, 3);
    (rotation, Vector3::from_fn(|k, _| Jet(q[k], speed[k], change[k])))
}

/// Hamilton's product of (x, y, z, w).
fn product<S: Scalar>([ax, ay, az, aw]: [S; 4], [bx, by, bz, bw]: [S; 4]) -> [S; 4] {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// (w² − |u|²)·1 + 2 u uᵀ + 2 w [u]×, divided by the norm squared: a rotation, whatever the norm.
fn from_quaternion<S: Scalar>([x, y, z, w]: [Jet<S>; 4]) -> Matrix3<Jet<S>> {
    let u = Vector3::new(x, y, z);
    let (length, two, o) = (u.dot(&u), Jet::from_f64(2.0), Jet::still(S::zero()));
    let cross = Matrix3::new(o, -z, y, z, o, -x, -y, x, o);
    let r = Matrix3::from_diagonal_element(w * w - length) + u * u.transpose() * two + cross * (two * w);
    let norm = w * w + length;
    r.map(|c| c / norm)
}
