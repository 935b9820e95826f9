//! The placement of a frame in a file.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;
use crate::spatial::{Placement, from_rpy, nearest_rotation};

/// The placement of a frame: a translation and a rotation, as the file gives them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin {
    /// Translation, m.
    pub xyz: [f64; 3],
    /// Rotation.
    pub rotation: Rotation,
}

/// A rotation in the form of the file, so that no digit is lost before it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rotation {
    /// Fixed-axis roll, pitch and yaw, rad: R = Rz(yaw)·Ry(pitch)·Rx(roll).
    RollPitchYaw([f64; 3]),
    /// A quaternion (x, y, z, w) of any finite length but zero.
    Quaternion([f64; 4]),
    /// A rotation matrix by rows. It may be off orthogonality by the digits of the file.
    Matrix([[f64; 3]; 3]),
}

impl Default for Rotation {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Rotation {
    /// No rotation.
    pub const IDENTITY: Self = Self::RollPitchYaw([0.0; 3]);

    /// The rotation matrix: components in the placed frame to components in the frame that it is
    /// placed in.
    #[must_use]
    pub fn matrix<S: Scalar>(&self) -> Matrix3<S> {
        match self {
            Self::RollPitchYaw(rpy) => from_rpy(*rpy),
            Self::Quaternion(quaternion) => from_any_quaternion(*quaternion),
            Self::Matrix([x, y, z]) => {
                let written = Matrix3::new(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]);
                nearest_rotation(&nearest_rotation(&written.map(S::from_f64)))
            }
        }
    }

    /// Roll, pitch and yaw, rad: as written, or computed to the roundoff of a double.
    #[must_use]
    pub fn rpy(&self) -> [f64; 3] {
        match self {
            Self::RollPitchYaw(rpy) => *rpy,
            Self::Quaternion(quaternion) => rpy_of_quaternion(*quaternion),
            Self::Matrix(_) => rpy_of_quaternion(quaternion_of(&self.matrix())),
        }
    }

    /// Whether all its numbers are finite, and a quaternion is not zero.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match self {
            Self::RollPitchYaw(rpy) => rpy.iter().all(|x| x.is_finite()),
            Self::Quaternion(quaternion) => quaternion.iter().all(|x| x.is_finite()) && *quaternion != [0.0; 4],
            Self::Matrix(rows) => rows.iter().flatten().all(|x| x.is_finite()),
        }
    }
}

impl Origin {
    /// Of a translation, m, and roll, pitch and yaw, rad.
    #[must_use]
    pub const fn new(xyz: [f64; 3], rpy: [f64; 3]) -> Self {
        Self { xyz, rotation: Rotation::RollPitchYaw(rpy) }
    }

    /// Of a translation, m, without a rotation.
    #[must_use]
    pub const fn at(xyz: [f64; 3]) -> Self {
        Self { xyz, rotation: Rotation::IDENTITY }
    }

    /// The placement of the frame that `next` places in this one, in the frame in which this one is
    /// placed. A rotation keeps the form of the file if the other is the identity.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let (first, second) = (self.rotation, next.rotation);
        let turned = if first == Rotation::IDENTITY { Vector3::from(next.xyz) } else { first.matrix::<f64>() * Vector3::from(next.xyz) };
        let rotation = match (first == Rotation::IDENTITY, second == Rotation::IDENTITY) {
            (true, _) => second,
            (_, true) => first,
            _ => {
                let product = first.matrix::<f64>() * second.matrix::<f64>();
                Rotation::Matrix([0, 1, 2].map(|row| [0, 1, 2].map(|column| product[(row, column)])))
            }
        };
        Self { xyz: [0, 1, 2].map(|k| self.xyz[k] + turned[k]), rotation }
    }

    /// As a placement: components in the placed frame to components in the frame that it is placed
    /// in.
    #[must_use]
    pub fn placement<S: Scalar>(&self) -> Placement<S> {
        Placement { rotation: self.rotation.matrix(), position: Vector3::from(self.xyz).map(S::from_f64) }
    }
}

/// R of a quaternion of any length. With n = |q|² each entry is a difference of squares or a sum of
/// products over n. So a quarter turn about an axis, written with two equal numbers, has the exact
/// entries 0 and ±1.
fn from_any_quaternion<S: Scalar>(quaternion: [f64; 4]) -> Matrix3<S> {
    let largest = quaternion.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let [x, y, z, w] = quaternion.map(|x| S::from_f64(x) / S::from_f64(largest));
    let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
    let n = (xx + ww) + (yy + zz);
    let two = |a: S| a + a;
    let on = |plus: S, minus: S, others: [S; 2]| ((plus - minus) + (others[0] - others[1])) / n;
    Matrix3::new(
        on(ww, yy, [xx, zz]),
        two(x * y - w * z) / n,
        two(x * z + w * y) / n, //
        two(x * y + w * z) / n,
        on(ww, xx, [yy, zz]),
        two(y * z - w * x) / n, //
        two(x * z - w * y) / n,
        two(y * z + w * x) / n,
        on(ww, xx, [zz, yy]),
    )
}

/// Roll, pitch and yaw of a quaternion (x, y, z, w) of any length but zero. With r, p, y for half
/// the angles:
///
/// ```text
/// w + y = (cos p + sin p) cos(r − y)        x − z = (cos p + sin p) sin(r − y)
/// w − y = (cos p − sin p) cos(r + y)        x + z = (cos p − sin p) sin(r + y)
/// ```
///
/// So no digit is lost near a pitch of ±π/2.
fn rpy_of_quaternion([x, y, z, w]: [f64; 4]) -> [f64; 3] {
    let length = |a: f64, b: f64| {
        let largest = a.abs().max(b.abs());
        if largest > 0.0 { largest * Scalar::sqrt((a / largest) * (a / largest) + (b / largest) * (b / largest)) } else { 0.0 }
    };
    let angle = |sine: f64, cosine: f64| Scalar::atan2(sine, cosine);
    let (plus, minus) = (length(w + y, x - z), length(w - y, x + z));
    let (sum, difference) = (angle(x + z, w - y), angle(x - z, w + y));
    let within = |angle: f64| if angle.abs() > PI { angle - if angle > 0.0 { TAU } else { -TAU } } else { angle };
    [within(sum + difference), 2.0 * angle(plus, minus) - FRAC_PI_2, within(sum - difference)]
}

/// A unit quaternion (x, y, z, w) of a rotation matrix, from the largest of its four numbers, so
/// that nothing cancels.
/// Shepperd, J. Guidance and Control 1, 1978.
fn quaternion_of(r: &Matrix3<f64>) -> [f64; 4] {
    let diagonal = [r.m11, r.m22, r.m33, r.trace()];
    let largest = (0..4).fold(3, |best, k| if diagonal[k] > diagonal[best] { k } else { best });
    if largest == 3 {
        let w = Scalar::sqrt(1.0 + diagonal[3]) / 2.0;
        return [(r.m32 - r.m23) / (4.0 * w), (r.m13 - r.m31) / (4.0 * w), (r.m21 - r.m12) / (4.0 * w), w];
    }
    let (i, j, k) = (largest, (largest + 1) % 3, (largest + 2) % 3);
    let own = Scalar::sqrt(1.0 + diagonal[i] - diagonal[j] - diagonal[k]) / 2.0;
    let mut quaternion = [0.0; 4];
    quaternion[i] = own;
    quaternion[j] = (r[(i, j)] + r[(j, i)]) / (4.0 * own);
    quaternion[k] = (r[(i, k)] + r[(k, i)]) / (4.0 * own);
    quaternion[3] = (r[(k, j)] - r[(j, k)]) / (4.0 * own);
    quaternion
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(r: &Matrix3<f64>) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| r[(i, j)]))
    }

    const TURNS: [[f64; 3]; 8] = [
        [0.3, -0.7, 1.9],
        [0.0, FRAC_PI_2, 0.4],
        [1.0, -FRAC_PI_2, -0.4],
        [3.1, 0.2, -3.1],
        [0.0, 3.0, 0.0],
        [FRAC_PI_2, 0.0, 0.0],
        [0.0, 0.0, PI],
        [PI, 0.0, 1e-9],
    ];

    #[test]
    fn the_three_forms_of_a_rotation_are_one_rotation() {
        for rpy in TURNS {
            let matrix: Matrix3<f64> = from_rpy(rpy);
            let quaternion = quaternion_of(&matrix);
            let forms = [
                Rotation::Matrix(rows(&matrix)),
                Rotation::Quaternion(quaternion),
                Rotation::Quaternion(quaternion.map(|x| -1e150 * x)),
                Rotation::RollPitchYaw(Rotation::Quaternion(quaternion).rpy()),
                Rotation::RollPitchYaw(Rotation::Matrix(rows(&matrix)).rpy()),
            ];
            for form in forms {
                assert!((form.matrix::<f64>() - matrix).amax() < 2e-15, "{rpy:?} {form:?}");
            }
        }
    }

    #[test]
    fn a_matrix_of_six_digits_becomes_orthogonal() {
        let matrix = from_rpy::<f64>([0.3, -0.7, 1.9]).map(|x| (x * 1e6).round() / 1e6);
        let r: Matrix3<f64> = Rotation::Matrix(rows(&matrix)).matrix();
        assert!((r.transpose() * r - Matrix3::identity()).amax() < 1e-15);
        assert!((r - matrix).amax() < 1e-6);
    }

    #[test]
    fn quarter_turns_by_quaternion_are_exact() {
        let half = 0.5;
        let about = |k: usize| {
            let mut quaternion = [0.0, 0.0, 0.0, half];
            quaternion[k] = half;
            Rotation::Quaternion(quaternion).matrix::<f64>()
        };
        let expected = [[FRAC_PI_2, 0.0, 0.0], [0.0, FRAC_PI_2, 0.0], [0.0, 0.0, FRAC_PI_2]].map(from_rpy::<f64>);
        assert_eq!([0, 1, 2].map(about), expected);
    }

    #[test]
    fn one_placement_after_another_is_their_product() {
        for (a, b) in TURNS.into_iter().zip(TURNS.into_iter().rev()) {
            let (first, second) = (Origin::new([1.0, -2.0, 0.5], a), Origin::new([0.25, 3.0, -1.0], b));
            for (first, second) in [(first, second), (Origin::at(first.xyz), second), (first, Origin::at(second.xyz))] {
                let [one, other, both] = [first, second, first.then(&second)].map(|origin| origin.placement::<f64>());
                assert!((one.rotation * other.rotation - both.rotation).amax() < 2e-15, "{a:?} {b:?}");
                assert!((one.position + one.rotation * other.position - both.position).amax() < 4e-15, "{a:?} {b:?}");
            }
            assert_eq!((Origin::default().then(&first), first.then(&Origin::default())), (first, first));
        }
    }

    #[test]
    fn a_rotation_without_a_direction_is_not_finite() {
        assert!(!Rotation::Quaternion([0.0; 4]).is_finite());
        assert!(!Rotation::Matrix([[f64::NAN; 3]; 3]).is_finite());
        assert!(!Rotation::RollPitchYaw([f64::INFINITY, 0.0, 0.0]).is_finite());
        assert!(Rotation::IDENTITY.is_finite());
    }
}
