//! Poses and symmetric matrices, in plain doubles.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use articulated_core::description::{Origin, Rotation};

pub(crate) type Vector = [f64; 3];

/// A quaternion (w, x, y, z) of any non-zero length.
pub(crate) type Quaternion = [f64; 4];

/// A frame in another: a translation, m, and a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) position: Vector,
    pub(crate) rotation: Quaternion,
}

pub(crate) const IDENTITY: Quaternion = [1.0, 0.0, 0.0, 0.0];

impl Default for Pose {
    fn default() -> Self {
        Self { position: [0.0; 3], rotation: IDENTITY }
    }
}

impl Pose {
    /// A translation alone.
    pub(crate) fn at(position: Vector) -> Self {
        Self { position, ..Self::default() }
    }

    /// The pose of `inner`, which is given in this frame, in the frame that this one is given in.
    /// Exact if one of the two is the identity.
    pub(crate) fn then(&self, inner: &Self) -> Self {
        Self { position: add(self.position, rotate(self.rotation, inner.position)), rotation: multiply(self.rotation, inner.rotation) }
    }

    /// As a description has it.
    pub(crate) fn origin(&self) -> Origin {
        let [w, x, y, z] = self.rotation;
        let rotation = if [x, y, z] == [0.0; 3] { Rotation::IDENTITY } else { Rotation::Quaternion([x, y, z, w]) };
        Origin { xyz: self.position, rotation }
    }
}

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

pub(crate) fn subtract(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(crate) fn scale(a: Vector, by: f64) -> Vector {
    a.map(|x| x * by)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The vector of length 1 in this direction; `None` for a length below 1e-14.
pub(crate) fn unit(a: Vector) -> Option<Vector> {
    let length = norm(a);
    (length >= TINY && length.is_finite()).then(|| a.map(|x| x / length))
}

/// Lengths, sizes and masses below this count as zero.
pub(crate) const TINY: f64 = 1e-14;

pub(crate) fn conjugate([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

/// (x, y, z, w) of norm one; of zero the identity, as in MuJoCo.
pub(crate) fn scalar_last(quaternion: Quaternion) -> Quaternion {
    let largest = quaternion.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let length = largest * quaternion.iter().map(|x| (x / largest) * (x / largest)).sum::<f64>().sqrt();
    if length < 1e-15 || !length.is_finite() {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let [w, x, y, z] = if length == 1.0 { quaternion } else { quaternion.map(|x| x / length) };
    [x, y, z, w]
}

/// The product, exact where one of the two is the identity.
pub(crate) fn multiply(a: Quaternion, b: Quaternion) -> Quaternion {
    if is_identity(a) {
        return b;
    }
    if is_identity(b) {
        return a;
    }
    let [aw, ax, ay, az] = a;
    let [bw, bx, by, bz] = b;
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

pub(crate) fn is_identity([w, x, y, z]: Quaternion) -> bool {
    w != 0.0 && [x, y, z] == [0.0; 3]
}

/// The rotation matrix by rows.
pub(crate) fn matrix(q: Quaternion) -> [Vector; 3] {
    let largest = q.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let [w, x, y, z] = q.map(|k| k / largest);
    let n = w * w + x * x + y * y + z * z;
    let entry = |a: f64| 2.0 * a / n;
    [
        [(w * w + x * x - y * y - z * z) / n, entry(x * y - w * z), entry(x * z + w * y)],
        [entry(x * y + w * z), (w * w - x * x + y * y - z * z) / n, entry(y * z - w * x)],
        [entry(x * z - w * y), entry(y * z + w * x), (w * w - x * x - y * y + z * z) / n],
    ]
}

pub(crate) fn rotate(q: Quaternion, v: Vector) -> Vector {
    if is_identity(q) {
        return v;
    }
    matrix(q).map(|row| dot(row, v))
}

/// The unit quaternion of a turn about a unit axis. For a double that is a multiple of π/2, a
/// quarter turn has two equal numbers, so that its matrix is exact.
pub(crate) fn about(axis: Vector, angle: f64) -> Quaternion {
    let (sine, cosine) = half(angle);
    [cosine, axis[0] * sine, axis[1] * sine, axis[2] * sine]
}

/// Sine and cosine of half the angle.
fn half(angle: f64) -> (f64, f64) {
    let quarters = (angle / FRAC_PI_2).round();
    if quarters.abs() < 1e6 && quarters * FRAC_PI_2 == angle {
        let s = FRAC_1_SQRT_2;
        return match (quarters as i64).rem_euclid(8) {
            0 => (0.0, 1.0),
            1 => (s, s),
            2 => (1.0, 0.0),
            3 => (s, -s),
            4 => (0.0, -1.0),
            5 => (-s, -s),
            6 => (-1.0, 0.0),
            _ => (-s, s),
        };
    }
    (angle / 2.0).sin_cos()
}

/// An angle in rad; multiples of 90° are exact multiples of π/2.
pub(crate) fn radians(degrees: f64) -> f64 {
    let quarters = degrees / 90.0;
    if quarters == quarters.round() && quarters.abs() < 1e6 { quarters * FRAC_PI_2 } else { degrees / 180.0 * std::f64::consts::PI }
}

/// The smallest turn that takes z to a direction, which must be of unit length.
pub(crate) fn of_z_axis(z: Vector) -> Quaternion {
    // (0, 0, 1) × z
    let axis = [-z[1], z[0], 0.0];
    let sine = norm(axis);
    let axis = if sine < 1e-10 { [1.0, 0.0, 0.0] } else { axis.map(|x| x / sine) };
    about(axis, sine.atan2(z[2]))
}

/// The quaternion of three axes of unit length, at right angles. Shepperd, J. Guidance and Control
/// 1, 1978.
pub(crate) fn of_axes(x: Vector, y: Vector, z: Vector) -> Quaternion {
    let trace = x[0] + y[1] + z[2];
    let diagonal = [trace, x[0], y[1], z[2]];
    let largest = (0..4).fold(0, |best, k| if diagonal[k] > diagonal[best] { k } else { best });
    let own = 2.0 * (1.0 + 2.0 * diagonal[largest] - trace).max(0.0).sqrt();
    match largest {
        0 => {
            let own = 2.0 * (1.0 + trace).max(0.0).sqrt();
            [own / 4.0, (y[2] - z[1]) / own, (z[0] - x[2]) / own, (x[1] - y[0]) / own]
        }
        1 => [(y[2] - z[1]) / own, own / 4.0, (x[1] + y[0]) / own, (z[0] + x[2]) / own],
        2 => [(z[0] - x[2]) / own, (x[1] + y[0]) / own, own / 4.0, (y[2] + z[1]) / own],
        _ => [(x[1] - y[0]) / own, (z[0] + x[2]) / own, (y[2] + z[1]) / own, own / 4.0],
    }
}

/// A symmetric matrix: xx, xy, xz, yy, yz, zz.
pub(crate) type Symmetric = [f64; 6];

pub(crate) fn diagonal([x, y, z]: Vector) -> Symmetric {
    [x, 0.0, 0.0, y, 0.0, z]
}

/// R·S·Rᵀ.
pub(crate) fn turned(q: Quaternion, s: Symmetric) -> Symmetric {
    if is_identity(q) {
        return s;
    }
    let r = matrix(q);
    let [xx, xy, xz, yy, yz, zz] = s;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let entry = |i: usize, j: usize| dot(r[i], [dot(rows[0], r[j]), dot(rows[1], r[j]), dot(rows[2], r[j])]);
    [entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)]
}

/// The inertia of a point of this mass, kg, at this position from the origin.
pub(crate) fn of_point(mass: f64, [x, y, z]: Vector) -> Symmetric {
    [y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y].map(|i| mass * i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near<const N: usize>(a: [f64; N], b: [f64; N]) -> bool {
        a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-14)
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(matrix(about([1.0, 0.0, 0.0], radians(90.0))), [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]);
        assert_eq!(matrix(about([0.0, 0.0, 1.0], -FRAC_PI_2)), [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(about([0.0, 1.0, 0.0], radians(180.0)), [0.0, 0.0, 1.0, 0.0]);
    }

    #[test]
    fn axes_are_the_columns_of_the_matrix() {
        for q in [[0.1, 0.9, -0.3, 0.2], [0.8, 0.1, 0.2, -0.5], [-0.1, 0.2, 0.9, 0.3], [0.05, 0.1, 0.2, -0.9]] {
            let m = matrix(q);
            let column = |k: usize| [m[0][k], m[1][k], m[2][k]];
            let back = matrix(of_axes(column(0), column(1), column(2)));
            assert!((0..3).all(|k| near(m[k], back[k])), "{q:?}");
        }
        let z = unit([0.3, -0.4, -0.2]).unwrap();
        assert!(near(rotate(of_z_axis(z), [0.0, 0.0, 1.0]), z));
        assert!(near(rotate(of_z_axis([0.0, 0.0, -1.0]), [0.0, 0.0, 1.0]), [0.0, 0.0, -1.0]));
    }
}
