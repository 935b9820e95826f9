//! Drag along and about the axes of a frame.

use super::{Field, FrameForce, Slopes, Station};
use crate::Scalar;
use crate::spatial::{Vector3, Wrench, rotate_back};

pub(super) const FIELDS: &[Field] = &[
    Field::number("linear", "N·s²/m²", "force along each axis at the unit speed, quadratic").at_least_zero().part().of(3),
    Field::number("angular", "N·m·s²", "moment about each axis at the unit rate, quadratic").at_least_zero().part().of(3),
    Field::number("viscous_linear", "N·s/m", "force at the unit speed, linear").at_least_zero().part().or(&[0.0]),
    Field::number("viscous_angular", "N·m·s", "moment at the unit rate, linear").at_least_zero().part().or(&[0.0]),
    Field::number("wind", "m/s", "velocity of the medium in the world frame").or(&[0.0; 3]).of(3),
];

pub(super) struct Law;

/// The velocity relative to the medium.
#[inline(always)]
fn relative<S: Scalar>(p: &[S], at: &Station<S>) -> Vector3<S> {
    at.twist.linear - rotate_back(&at.placement.rotation, Vector3::new(p[8], p[9], p[10]))
}

impl FrameForce for Law {
    // v less the wind: f_i = −c_i |v_i| v_i − b v_i;  m_i = −C_i |ω_i| ω_i − B ω_i
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let against = |x: Vector3<S>, c: &[S], b: S| Vector3::from_fn(|i, _| -((c[i] * x[i].abs() + b) * x[i]));
        Wrench { moment: against(at.twist.angular, &p[3..6], p[7]), force: against(relative(p, at), &p[..3], p[6]) }
    }

    const HAS_DAMPING: bool = true;

    // 2 C_i |ω_i| + B;  2 c_i |v_i| + b
    fn damping<S: Scalar>(p: &[S], at: &Station<S>) -> Slopes<S> {
        let (two, v) = (S::from_f64(2.0), relative(p, at));
        let slope = |c: S, x: S, b: S| two * c * x.abs() + b;
        Slopes::Diagonal(core::array::from_fn(|k| match k {
            0..3 => slope(p[3 + k], at.twist.angular[k], p[7]),
            _ => slope(p[k - 3], v[k - 3], p[6]),
        }))
    }
}
