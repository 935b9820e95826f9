//! Where a frame is and how it moves.

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;
use crate::dual::Dual;
use crate::spatial::{Placement, Twist, rotate};

/// Inputs of the law of an effect on a frame.
#[derive(Clone, Copy, Debug)]
pub struct Station<S> {
    /// The frame in the world frame.
    pub placement: Placement<S>,
    /// Its motion, in its axes.
    pub twist: Twist<S>,
    /// Gravity in the world frame, m/s².
    pub gravity: Vector3<S>,
}

impl<S: Scalar> Station<S> {
    /// The same with the derivatives for the frame's small motion `step` and the change `turn` of
    /// its twist, both in its axes: R' = R [ω]×, p' = R v.
    pub(crate) fn moved(&self, step: &Twist<S>, change: &Twist<S>) -> Station<Dual<S>> {
        let Placement { rotation, position } = &self.placement;
        let spin = Matrix3::from_columns(&[0, 1, 2].map(|k| step.angular.cross(&Vector3::ith(k, S::one()))));
        let (turned, shifted) = (rotation * spin, rotate(rotation, step.linear));
        Station {
            placement: Placement {
                rotation: Matrix3::from_fn(|i, j| Dual::new(rotation[(i, j)], turned[(i, j)])),
                position: dual(position, &shifted),
            },
            twist: Twist { angular: dual(&self.twist.angular, &change.angular), linear: dual(&self.twist.linear, &change.linear) },
            gravity: self.gravity.map(Dual::constant),
        }
    }
}

fn dual<S: Scalar>(value: &Vector3<S>, slope: &Vector3<S>) -> Vector3<Dual<S>> {
    Vector3::from_fn(|k, _| Dual::new(value[k], slope[k]))
}
