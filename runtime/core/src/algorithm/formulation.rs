//! How the algorithms compute on a model: choices that change the arithmetic and no result.

use crate::Scalar;
use crate::index::{BodyId, ById};
use crate::joint::{Angle, Coordinates};
use crate::spatial::SpatialInertia;

/// Choices for the bodies of a model, by their indices; a body beyond the end of a list has the
/// default. [`super::Workspace::with_formulation`] takes it.
///
/// The caller guarantees that results are the same: rotations and inertias must match the frames
/// and inertias of the model.
#[derive(Clone, Debug)]
pub struct Formulation<S> {
    /// How the frames of bodies on a rotation about an axis rotate; by default as
    /// [`FrameRotation::of_joint`].
    pub rotations: ById<BodyId, FrameRotation<S>>,
    /// Mass properties for inverse dynamics: any that have the same torques; by default the
    /// model's.
    pub torque_inertias: ById<BodyId, SpatialInertia<S>>,
    /// Source of the rate matrices in inverse dynamics.
    pub kinematics: ById<BodyId, AngularKinematics>,
}

/// How the frame of a body rotates about the axis of its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRotation<S> {
    /// The angle of the frame where the joint's coordinate is zero.
    pub offset: Angle<S>,
    /// One: the frame rotates with the body. Zero: it does not; then the body must be axisymmetric,
    /// or the given constants must be those at one configuration.
    pub share: S,
}

/// Source of a body's rate matrix U ([`crate::spatial::rate_matrix`]) in inverse dynamics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AngularKinematics {
    /// From ω and ω̇, for a joint of any kind.
    #[default]
    AngularAcceleration,
    /// For a revolute joint, from ω, ω̇_z and the second derivative ë of the joint's axis e
    /// ([`crate::spatial::rates_about`]). The axis is fixed in both bodies of the joint, so that ë
    /// = U_λ e is a column that the parent already has. It is turned in place of ω̇, and the terms
    /// added to ω̇ are not computed.
    AxisAcceleration,
    /// The same, and U's diagonal from ë_z = −(ω_x² + ω_y²) as well.
    AxisAccelerationAndDiagonal,
}

impl<S> Default for Formulation<S> {
    /// That of the library.
    fn default() -> Self {
        Self { rotations: ById::default(), torque_inertias: ById::default(), kinematics: ById::default() }
    }
}

impl<S: Scalar> Formulation<S> {
    /// The same with `f` of each constant.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Formulation<T> {
        Formulation {
            rotations: self.rotations.iter().map(|rotation| rotation.map(f)).collect(),
            torque_inertias: self.torque_inertias.iter().map(|inertia| inertia.map(f)).collect(),
            kinematics: self.kinematics.clone(),
        }
    }
}

impl<S: Scalar> FrameRotation<S> {
    /// By the joint's coordinate.
    pub fn of_joint() -> Self {
        Self { offset: Angle::zero(), share: S::one() }
    }

    /// The angle by which the frame of a body is rotated; q: `[nq]`, rad.
    #[inline(always)]
    pub fn angle(&self, at: &Coordinates<S>, q: &[S]) -> Angle<S> {
        if self.share.is_zero() {
            return Angle::zero();
        }
        let own = at.coordinate(q).sin_cos();
        let (sin, cos) = if self.offset.is_zero() { own } else { self.offset.plus(own) };
        if self.share == S::one() {
            Angle { sin, cos }
        } else {
            Angle { sin: sin * self.share, cos: S::one() + (cos - S::one()) * self.share }
        }
    }

    /// The same with `f` of each constant.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> FrameRotation<T> {
        FrameRotation { offset: Angle { sin: f(self.offset.sin), cos: f(self.offset.cos) }, share: f(self.share) }
    }
}
