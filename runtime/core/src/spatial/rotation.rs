//! Rotation matrices. `r_ab` takes components in b to components in a.

use core::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;

/// R·v, written out: 9 multiplications, 6 additions.
#[inline(always)]
pub fn rotate<S: Scalar>(r: &Matrix3<S>, v: Vector3<S>) -> Vector3<S> {
    Vector3::new(dot([r.m11, r.m12, r.m13], v), dot([r.m21, r.m22, r.m23], v), dot([r.m31, r.m32, r.m33], v))
}

/// Rᵀ·v, written out: 9 multiplications, 6 additions.
#[inline(always)]
pub fn rotate_back<S: Scalar>(r: &Matrix3<S>, v: Vector3<S>) -> Vector3<S> {
    Vector3::new(dot([r.m11, r.m21, r.m31], v), dot([r.m12, r.m22, r.m32], v), dot([r.m13, r.m23, r.m33], v))
}

/// a_x v_x + a_y v_y + a_z v_z
#[inline(always)]
fn dot<S: Scalar>([x, y, z]: [S; 3], v: Vector3<S>) -> S {
    z.mul_add(v.z, y.mul_add(v.y, x * v.x))
}

/// R M Rᵀ with R = Rz of the angle of this sine and cosine: 20 operations instead of 90.
///
/// With w = s (M_xx − M_yy) + c (M_xy + M_yx) the diagonal changes by s·w. As accurate as the
/// largest number of M, no better.
#[inline(always)]
pub fn turned_about_z<S: Scalar>(m: &Matrix3<S>, sin: S, cos: S) -> Matrix3<S> {
    let (s, c) = (sin, cos);
    let w = s * (m.m11 - m.m22) + c * (m.m12 + m.m21);
    Matrix3::new(
        m.m11 - s * w,
        c * w - m.m21,
        c * m.m13 - s * m.m23, //
        c * w - m.m12,
        m.m22 + s * w,
        s * m.m13 + c * m.m23, //
        c * m.m31 - s * m.m32,
        s * m.m31 + c * m.m32,
        m.m33,
    )
}

/// Rotation matrix of the unit quaternion (x, y, z, w).
///
/// The norm is taken to be one and is not checked: with a norm 1 + ε the matrix is off by about 2ε.
pub fn from_quaternion<S: Scalar>(q: [S; 4]) -> Matrix3<S> {
    let [x, y, z, w] = q;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    let one = S::one();
    Matrix3::new(
        one - (yy + zz),
        xy - wz,
        xz + wy, //
        xy + wz,
        one - (xx + zz),
        yz - wx, //
        xz - wy,
        yz + wx,
        one - (xx + yy),
    )
}

/// The rotation nearest to a matrix that is one up to rounding: R − R (RᵀR − 1)/2, a Newton step
/// for the orthogonal factor of R.
///
/// Products of rotations drift: columns of a few turns are some units of roundoff too long or too
/// short, all the same way, and so is every lever that they turn. A step leaves only the rounding
/// of nine numbers. Numbers that are 0, 1 or −1 stay so.
pub fn nearest_rotation<S: Scalar>(r: &Matrix3<S>) -> Matrix3<S> {
    let (zero, one) = (S::zero(), S::one());
    let too_long = r.transpose() * r - Matrix3::identity();
    let change = (r * too_long).map(|x| x * S::from_f64(0.5));
    r.zip_map(&change, |x, by| if x == zero || x == one || x == -one { x } else { x - by })
}

/// (sin, cos) of an angle from a file.
///
/// The double nearest to a multiple of π/2 (up to ±2π) is taken as that multiple, so that a right
/// angle is a right angle: this moves no entry of a rotation matrix by more than 5·10⁻¹⁶. An angle
/// like 1.5708 is used as written.
pub fn sin_cos_of_written_angle<S: Scalar>(angle: f64) -> (S, S) {
    let quarter = (-4..=4).find(|&k| angle == f64::from(k) * FRAC_PI_2);
    let (zero, one) = (S::zero(), S::one());
    match quarter.map(|k: i32| k.rem_euclid(4)) {
        Some(0) => (zero, one),
        Some(1) => (one, zero),
        Some(2) => (zero, -one),
        Some(_) => (-one, zero),
        None => S::from_f64(angle).sin_cos(),
    }
}

/// R = Rz(yaw)·Ry(pitch)·Rx(roll), the URDF's rotation. Angles in rad.
pub fn from_rpy<S: Scalar>(rpy: [f64; 3]) -> Matrix3<S> {
    let [(sr, cr), (sp, cp), (sy, cy)] = rpy.map(sin_cos_of_written_angle::<S>);
    Matrix3::new(
        cy * cp,
        cy * sp * sr - sy * cr,
        cy * sp * cr + sy * sr, //
        sy * cp,
        sy * sp * sr + cy * cr,
        sy * sp * cr - cy * sr, //
        -sp,
        cp * sr,
        cp * cr,
    )
}

/// A rotation whose third column is the direction of `axis` (not zero), as sparse as possible: for
/// a coordinate axis a signed permutation, otherwise with one zero. The axis is normalised without
/// overflow or underflow. It counts as a coordinate axis if the other components are within the
/// rounding of that one.
pub fn to_z_axis(axis: [f64; 3]) -> Matrix3<f64> {
    let z = unit(axis);
    let rounding = f64::EPSILON / 4.0;
    if let Some(k) = (0..3).find(|&k| (0..3).all(|j| j == k || z[j].abs() <= rounding)) {
        return signed_permutation(k, z[k].signum());
    }
    let smallest = z.map(f64::abs).imin();
    let mut e = Vector3::zeros();
    e[smallest] = 1.0;
    let x = e.cross(&z);
    let x = x / Scalar::sqrt(x.dot(&x));
    Matrix3::from_columns(&[x, z.cross(&x), z])
}

fn unit(axis: [f64; 3]) -> Vector3<f64> {
    let v = Vector3::from(axis);
    let v = v / v.amax();
    v / Scalar::sqrt(v.dot(&v))
}

/// The rotation by permutation whose third column is `sign`·e_k.
fn signed_permutation(k: usize, sign: f64) -> Matrix3<f64> {
    let e = [Vector3::x(), Vector3::y(), Vector3::z()];
    let z = e[k] * sign;
    let x = match (k, sign > 0.0) {
        (0, _) => e[1],
        (1, true) => e[2],
        _ => e[0],
    };
    Matrix3::from_columns(&[x, z.cross(&x), z]).map(|c| c + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_rotation(r: &Matrix3<f64>) -> bool {
        (r.transpose() * r - Matrix3::identity()).amax() < 1e-15 && (r.determinant() - 1.0).abs() < 1e-15
    }

    #[test]
    fn third_column_is_the_axis() {
        for axis in [
            [1.0, 0.0, 0.0],
            [0.0, -2.0, 0.0],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            [-1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1e-200, 2e-200, 3e-200],
        ] {
            let r = to_z_axis(axis);
            assert!(is_rotation(&r), "{axis:?} {r}");
            let v = Vector3::from(axis) / Vector3::from(axis).amax();
            assert!((r.column(2) * v.norm() - v).amax() < 1e-15, "{axis:?}");
        }
    }

    #[test]
    fn a_matrix_turns_about_z_as_by_two_products() {
        let m = Matrix3::new(0.3, -1.2, 0.7, 2.0, 0.5, -0.9, 0.4, 0.1, -0.6);
        let (s, c) = 0.7_f64.sin_cos();
        let r: Matrix3<f64> = from_rpy([0.0, 0.0, 0.7]);
        assert!((turned_about_z(&m, s, c) - r * m * r.transpose()).amax() < 1e-15);
    }

    #[test]
    fn rpy_is_yaw_after_pitch_after_roll() {
        let r: Matrix3<f64> = from_rpy([0.3, -0.7, 1.9]);
        let n = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.9);
        assert!((r - n.matrix()).amax() < 1e-15);
    }

    #[test]
    fn a_written_right_angle_is_exact_and_an_approximate_one_is_not() {
        assert_eq!(sin_cos_of_written_angle::<f64>(FRAC_PI_2), (1.0, 0.0));
        assert_eq!(sin_cos_of_written_angle::<f64>(-core::f64::consts::PI), (0.0, -1.0));
        assert_eq!(sin_cos_of_written_angle::<f64>(1.571).1, (1.571_f64).cos());
    }

    #[test]
    fn a_product_of_many_turns_drifts_and_its_nearest_rotation_does_not() {
        let length = |r: &Matrix3<f64>| (r.transpose() * r - Matrix3::identity()).amax() / f64::EPSILON;
        let turn = from_rpy::<f64>([0.3, -0.4, 2.0]);
        let product = (0..1000).fold(Matrix3::identity(), |r, _| r * turn);
        let nearest = nearest_rotation(&product);
        assert!(length(&product) > 20.0 && length(&nearest) <= 1.5, "{} {}", length(&product), length(&nearest));
        assert!((nearest - product).amax() <= length(&product) * f64::EPSILON);
        let quarter = from_rpy::<f64>([0.0, FRAC_PI_2, FRAC_PI_2]);
        assert_eq!(nearest_rotation(&quarter), quarter);
    }

    #[test]
    fn quaternion_of_a_quarter_turn_about_x() {
        let h = core::f64::consts::FRAC_1_SQRT_2;
        let r = from_quaternion([h, 0.0, 0.0, h]);
        assert!((rotate(&r, Vector3::y()) - Vector3::z()).amax() < 1e-15);
        assert!((rotate_back(&r, Vector3::z()) - Vector3::y()).amax() < 1e-15);
    }
}
