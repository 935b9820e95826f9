//! Rate matrices from the acceleration of a joint's axis.

use articulated_core::Scalar;
use articulated_core::algorithm::AngularKinematics;
use articulated_core::index::BodyId;
use articulated_core::spatial::Vector3;

use super::view::View;

/// Bodies with this many products of inertia have U's diagonal by the axis: each takes a difference
/// on it.
const DENSE: usize = 2;

impl<S: Scalar> View<S> {
    /// The view with [`AngularKinematics::AxisAcceleration`] for each revolute joint that lies
    /// along an axis of its parent, where multiplying by it selects a column.
    #[must_use]
    pub fn with_axis_accelerations(mut self) -> Self {
        let one = |i: BodyId| {
            let body = &self.model.bodies()[i];
            let along = body.joint.is_rotation_about_axis() && lies_along_one(&body.placement.rotation.column(2).into_owned());
            let moments = &self.torque_inertia(i).second;
            let dense = [moments.m12, moments.m13, moments.m23].iter().filter(|x| !x.is_zero()).count() >= DENSE;
            match along {
                true if dense => AngularKinematics::AxisAccelerationAndDiagonal,
                true => AngularKinematics::AxisAcceleration,
                false => AngularKinematics::AngularAcceleration,
            }
        };
        let moving = self.model.outward().map(one);
        self.formulation.kinematics = std::iter::once(AngularKinematics::AngularAcceleration).chain(moving).collect();
        self
    }
}

/// Whether a unit vector is an axis, or one with its sign changed.
fn lies_along_one<S: Scalar>(e: &Vector3<S>) -> bool {
    let unit = |x: &S| *x == S::one() || *x == -S::one();
    e.iter().filter(|x| x.is_zero()).count() == 2 && e.iter().any(unit)
}
