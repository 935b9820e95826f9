//! Joints, one file each: pose, motion and torque of one kind.
//!
//! In a [`crate::model::Model`] a joint with an axis turns about or slides along the z-axis of its
//! frame; the model's builder chose the frames so, and composes planar and universal joints of
//! these. Adding a joint: a file with a type that implements [`JointLaw`], and its row in
//! `joints!`.

mod floating;
mod follow;
mod helical;
#[cfg(feature = "alloc")]
mod mount;
mod prismatic;
mod revolute;
mod spherical;

pub use floating::Floating;
pub use follow::Follow;
pub use helical::Helical;
#[cfg(feature = "alloc")]
pub(crate) use mount::Mount;
pub use prismatic::Prismatic;
pub use revolute::Revolute;
pub use spherical::Spherical;

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Motion, Placement, SpatialInertia, Twist, Wrench};

/// From one row for each kind of joint all that branches on it.
macro_rules! joints {
    ($dollar:tt $($(#[$doc:meta])+ $kind:ident,)+) => {
        /// The kinds of moving joints of a model.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Joint {
            $($(#[$doc])+ $kind,)+
        }

        impl Joint {
            /// Number of coordinates.
            pub fn nq(self) -> usize {
                match self {
                    $(Self::$kind => <$kind<f64> as JointLaw<f64>>::NQ,)+
                }
            }

            /// Number of degrees of freedom.
            pub fn nv(self) -> usize {
                match self {
                    $(Self::$kind => <$kind<f64> as JointLaw<f64>>::NV,)+
                }
            }

            /// As [`JointLaw::QUATERNION`].
            pub fn quaternion(self) -> Option<usize> {
                match self {
                    $(Self::$kind => <$kind<f64> as JointLaw<f64>>::QUATERNION,)+
                }
            }

            /// As [`JointLaw::ROTATION`].
            pub const fn rotation(self) -> Freedom {
                match self {
                    $(Self::$kind => <$kind<f64> as JointLaw<f64>>::ROTATION,)+
                }
            }

            /// As [`JointLaw::TRANSLATION`].
            pub const fn translation(self) -> Freedom {
                match self {
                    $(Self::$kind => <$kind<f64> as JointLaw<f64>>::TRANSLATION,)+
                }
            }

            /// As [`JointLaw::regroupable`].
            pub fn regroupable<S: Scalar>(self, inertia: &SpatialInertia<S>) -> Option<SpatialInertia<S>> {
                match self {
                    $(Self::$kind => $kind::regroupable(inertia),)+
                }
            }

            /// As [`JointLaw::has_inertia`].
            pub fn has_inertia<S: Scalar>(self, inertia: &SpatialInertia<S>) -> bool {
                match self {
                    $(Self::$kind => $kind::has_inertia(inertia),)+
                }
            }

            /// The joint's pose at its coordinates in `q`.
            #[inline(always)]
            pub fn pose<S: Scalar>(self, at: &Coordinates<S>, q: &[S]) -> Pose<S> {
                match self {
                    $(Self::$kind => Pose::$kind($kind::at(at, q)),)+
                }
            }
        }

        /// A pose of any kind of joint, to be kept between sweeps.
        #[derive(Clone, Copy, Debug)]
        pub enum Pose<S> {
            $(#[doc = concat!("See [`", stringify!($kind), "`].")] $kind($kind<S>),)+
        }

        impl<S: Scalar> Pose<S> {
            /// Where the child is its joint frame.
            pub fn identity() -> Self {
                Self::Prismatic(Prismatic::by(S::zero()))
            }

            /// At this angle about the joint's axis.
            #[cfg(feature = "alloc")]
            #[inline(always)]
            pub(crate) fn rotation_about_axis(angle: Angle<S>) -> Self {
                Self::Revolute(Revolute::of(angle))
            }

            /// As [`JointLaw::freedom`].
            #[inline(always)]
            pub fn freedom(&self, k: usize) -> Option<usize> {
                match self {
                    $(Self::$kind(_) => $kind::<S>::freedom(k),)+
                }
            }
        }

        /// Runs one expression with the pose of the kind that it is: one branch for a whole step of
        /// an algorithm. Algorithms need allocation.
        #[cfg(feature = "alloc")]
        macro_rules! with_pose {
            ($dollar pose:expr, $dollar p:ident => $dollar body:expr) => {
                match $dollar pose {
                    $($crate::joint::Pose::$kind($dollar p) => $dollar body,)+
                }
            };
        }
        #[cfg(feature = "alloc")]
        pub(crate) use with_pose;
    };
}

joints! { $
    /// Turns about z; revolute and continuous joints.
    Revolute,
    /// Slides along z.
    Prismatic,
    /// Turns about z and slides along it.
    Helical,
    /// Turns freely about a point: unit quaternion (x, y, z, w); rates are ω in axes of the child.
    Spherical,
    /// Moves freely: position and unit quaternion (x, y, z, w); rates are the body twist.
    Floating,
}

/// The directions in which a joint lets its child rotate or translate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// None.
    None,
    /// About or along the joint's axis, z.
    Axis,
    /// All three.
    Free,
}

impl Joint {
    /// Whether the joint is a rotation about its axis and nothing else: the child's origin stays,
    /// and S = [e_z; 0].
    #[inline(always)]
    pub const fn is_rotation_about_axis(self) -> bool {
        matches!((self.rotation(), self.translation()), (Freedom::Axis, Freedom::None))
    }

    /// Whether the joint is a translation along its axis and nothing else: S = [0; e_z].
    #[inline(always)]
    pub const fn is_translation_along_axis(self) -> bool {
        matches!((self.rotation(), self.translation()), (Freedom::None, Freedom::Axis))
    }

    /// Whether the joint is any rotation about its origin, and nothing else.
    #[inline(always)]
    pub const fn is_rotation_about_point(self) -> bool {
        matches!((self.rotation(), self.translation()), (Freedom::Free, Freedom::None))
    }

    /// Whether the joint moves the child's origin in the parent, so that a coordinate, a rate or a
    /// force of it has a length in it.
    #[inline(always)]
    pub const fn moves_origin(self) -> bool {
        !matches!(self.translation(), Freedom::None)
    }

    /// Whether the joint constrains nothing: six degrees of freedom.
    #[inline(always)]
    pub const fn is_unconstrained(self) -> bool {
        matches!((self.rotation(), self.translation()), (Freedom::Free, Freedom::Free))
    }
}

/// Where a joint's numbers are in the vectors q and v, and how it follows another joint if it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates<S> {
    /// First index in q.
    pub q: usize,
    /// First index in v, a and τ.
    pub v: usize,
    /// For a joint that follows: its own coordinate as a function of the leader's.
    pub mimic: Option<Follow<S>>,
    /// How far a helical joint slides, m/rad; zero for every other.
    pub pitch: S,
}

/// A constant angle, by its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle<S> {
    /// Its sine.
    pub sin: S,
    /// Its cosine.
    pub cos: S,
}

impl<S: Scalar> Angle<S> {
    /// No angle.
    pub fn zero() -> Self {
        Self { sin: S::zero(), cos: S::one() }
    }

    /// Whether it is zero.
    pub fn is_zero(&self) -> bool {
        *self == Self::zero()
    }

    /// Rz of the angle.
    pub fn rotation(&self) -> Matrix3<S> {
        let (o, Self { sin, cos }) = (S::zero(), *self);
        Matrix3::new(cos, -sin, o, sin, cos, o, o, o, S::one())
    }

    /// The sum with the angle of this sine and cosine.
    #[inline(always)]
    pub fn plus(&self, (sin, cos): (S, S)) -> (S, S) {
        (sin * self.cos + cos * self.sin, cos * self.cos - sin * self.sin)
    }
}

impl<S: Scalar> Coordinates<S> {
    /// The joint's own single coordinate.
    #[inline(always)]
    pub fn coordinate(&self, q: &[S]) -> S {
        match &self.mimic {
            None => q[self.q],
            Some(f) => f.value(q[self.q]),
        }
    }

    /// The joint's own single rate.
    #[inline(always)]
    pub fn rate(&self, q: &[S], v: &[S]) -> S {
        match &self.mimic {
            None => v[self.v],
            Some(f) => v[self.v] * f.slope(q[self.q]),
        }
    }

    /// The joint's own single acceleration: f′ a + f″ v² of a follower.
    #[inline(always)]
    pub fn acceleration(&self, q: &[S], v: &[S], a: &[S]) -> S {
        let linear = self.rate(q, a);
        self.bend(q).map_or(linear, |bend| linear + bend * (v[self.v] * v[self.v]))
    }

    /// Both, of q, v and a.
    #[inline(always)]
    pub(crate) fn rates(&self, [q, v, a]: [&[S]; 3]) -> [S; 2] {
        [self.rate(q, v), self.acceleration(q, v, a)]
    }

    /// Own rate over the leader's, f′; `None` for a joint that follows none.
    #[inline(always)]
    pub fn rate_of_one(&self, q: &[S]) -> Option<S> {
        self.mimic.as_ref().map(|f| f.slope(q[self.q]))
    }

    /// Whether it follows another joint, and not linearly.
    pub fn is_bent(&self) -> bool {
        self.mimic.as_ref().is_some_and(|f| f.higher.is_some())
    }

    /// f″ of a follower; `None` where it is zero everywhere.
    #[inline(always)]
    pub fn bend(&self, q: &[S]) -> Option<S> {
        self.mimic.as_ref()?.bend(q[self.q])
    }

    /// f‴ of a follower; `None` where f″ is zero everywhere.
    #[inline(always)]
    pub fn rate_of_bend(&self, q: &[S]) -> Option<S> {
        self.mimic.as_ref()?.rate_of_bend(q[self.q])
    }

    /// The joint's own torque, N·m or N, in terms of the coordinate that it moves with: power is
    /// the same, so τ_leader = f′ τ.
    #[inline(always)]
    pub fn to_leader(&self, q: &[S], torque: S) -> S {
        self.rate_of_one(q).map_or(torque, |ratio| torque * ratio)
    }

    /// The same in another scalar.
    #[cfg(feature = "alloc")]
    pub(crate) fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Coordinates<T> {
        Coordinates { q: self.q, v: self.v, mimic: self.mimic.as_ref().map(|m| m.map(f)), pitch: f(self.pitch) }
    }
}

/// The interface of a joint for algorithms, at one pose. "Joint frame" is the frame fixed in the
/// parent, "child" the one that moves.
pub trait JointLaw<S: Scalar>: Copy {
    /// Number of coordinates.
    const NQ: usize;
    /// Number of degrees of freedom.
    const NV: usize;
    /// Index of the first coordinate of a unit quaternion (x, y, z, w), if there is one; otherwise
    /// each degree of freedom has a coordinate.
    const QUATERNION: Option<usize>;
    /// The directions in which the child rotates.
    const ROTATION: Freedom;
    /// The directions in which the child's origin moves; along the axis by the rotation where that
    /// is the only degree of freedom.
    const TRANSLATION: Freedom;

    /// The pose at the joint's coordinates in `q`.
    fn at(at: &Coordinates<S>, q: &[S]) -> Self;

    /// A vector from axes of the joint frame to axes of the child: Rᵀ v.
    fn to_child(&self, v: Vector3<S>) -> Vector3<S>;

    /// A vector from axes of the child to axes of the joint frame: R v.
    fn to_joint(&self, v: Vector3<S>) -> Vector3<S>;

    /// The child's origin in the parent, where `x_pj` places the joint frame in the parent, m.
    fn origin(&self, x_pj: &Placement<S>) -> Vector3<S>;

    /// The child's placement, from that of the joint frame in the same frame.
    fn compose(&self, x_wj: Placement<S>) -> Placement<S>;

    /// Column k of S, the twist of the child about its origin at the unit rate k of the joint, in
    /// the axes that `turn` takes the child's to.
    fn subspace(&self, turn: &Matrix3<S>, k: usize) -> Twist<S>;

    /// The child's motion in its axes, from `carried`, the motion that the point of the parent now
    /// at the child's origin has, in axes from which `turn` takes vectors to the child's, and from
    /// the joint's rates in `v` and their derivatives in `a`.
    fn motion(&self, carried: Motion<S>, turn: impl Fn(Vector3<S>) -> Vector3<S>, at: &Coordinates<S>, state: [&[S]; 3]) -> Motion<S>;

    /// The child's mass as seen from the joint frame.
    fn inertia_to_joint(&self, inertia: &SpatialInertia<S>) -> SpatialInertia<S>;

    /// An articulated inertia from axes of the child to axes of the joint frame, about the same
    /// point.
    fn articulated_to_joint(&self, inertia: &ArticulatedInertia<S>) -> ArticulatedInertia<S>;

    /// Index of the joint's degree of freedom k in the twist [ω; v] of the child about its origin;
    /// `None` if it is not a single number of it.
    fn freedom(k: usize) -> Option<usize>;

    /// I·S_k: the wrench, in the child's frame, that gives a body of this inertia at rest the unit
    /// acceleration in the joint's own degree of freedom k.
    fn column(&self, inertia: &SpatialInertia<S>, k: usize) -> Wrench<S>;

    /// S_kᵀ F: the joint's own torque k, N·m or N, for the wrench F on the child, in the child's
    /// frame.
    fn torque(&self, wrench: &Wrench<S>, k: usize) -> S;

    /// The part of the child's inertia, in its frame, that no torque of the joint distinguishes
    /// from the parent's; `None`: nothing.
    fn regroupable(inertia: &SpatialInertia<S>) -> Option<SpatialInertia<S>>;

    /// Whether the mass matrix of the joint alone is not zero in at least one of its directions,
    /// for a child of this inertia.
    fn has_inertia(inertia: &SpatialInertia<S>) -> bool;
}
