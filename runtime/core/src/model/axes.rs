//! Bodies whose turning is carried outward by the acceleration of their joint's axis.

use crate::Scalar;
use crate::model::Model;
use crate::spatial::Vector3;

/// What inverse dynamics finds a body's rate matrix U ([`crate::spatial::rate_matrix`]) from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rates {
    /// From ω and ω̇, for a joint of any kind.
    #[default]
    Angular,
    /// For a revolute joint, from ω, ω̇_z and the second derivative ë of the joint's axis e ([`crate::spatial::rates_about`]). The axis is fixed in both bodies of the joint, so that ë = U_λ e is a column of what
    /// the parent has found already: it is turned in place of ω̇, and what is added to ω̇ is not computed.
    Axis,
    /// The same, and U's diagonal from ë_z = −(ω_x² + ω_y²) as well.
    AxisAndDiagonal,
}

/// Bodies with so many products of inertia have U's diagonal by the axis: each takes a difference on it.
const DENSE: usize = 2;

impl<S: Scalar> Model<S> {
    /// The model with [`Rates`] by the axis of each revolute joint that lies along an axis of its parent, where to multiply by it is to choose a column.
    #[must_use]
    pub fn with_rates_by_axes(mut self) -> Self {
        for body in self.bodies.iter_mut().skip(1) {
            let along = body.joint.is_rotation_about_axis() && lies_along_one(&body.placement.rotation.column(2).into_owned());
            let moments = &body.for_torques().second;
            let dense = [moments.m12, moments.m13, moments.m23].iter().filter(|x| !x.is_zero()).count() >= DENSE;
            body.rates = match along {
                true if dense => Rates::AxisAndDiagonal,
                true => Rates::Axis,
                false => Rates::Angular,
            };
        }
        self
    }
}

/// Whether a unit vector is an axis, or one with its sign changed.
fn lies_along_one<S: Scalar>(e: &Vector3<S>) -> bool {
    let unit = |x: &S| *x == S::one() || *x == -S::one();
    e.iter().filter(|x| x.is_zero()).count() == 2 && e.iter().any(unit)
}
