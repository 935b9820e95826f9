//! A robot as its file describes it: plain numbers in the file's own frames, before any
//! computation.
//!
//! A reader returns a [`Description`], and [`crate::model::Model`] is built from it.
//!
//! * `origin` places a joint's frame in its parent link's frame. The child link's frame coincides
//!   with the joint's frame where the joint's coordinates are zero.
//! * `axis` is expressed in the joint's frame.
//! * A body with several joints in sequence has an [intermediate](Link::intermediate) link between
//!   two of them.
//! * A [`Frame`] is a frame that coincides with no link.
//!
//! [`Description::lock`], [`Description::couple`], [`Description::attach`],
//! [`Description::append`] and [`Description::shaft`] edit it; an [`Editor`] makes many edits.

mod collision;
mod couple;
mod edit;
mod error;
mod moments;
mod names;
mod origin;
mod shaft;

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

pub use collision::{Collision, CollisionShape, ContactSphere, Hull, RIM_POINTS, Visual};
pub(crate) use couple::degree_of_chain;
pub use couple::{Coupling, MOST_DEGREE};
pub use edit::{Editor, Payload};
pub use error::EditError;
pub use moments::PrincipalMoments;
pub use origin::{Origin, Rotation};
pub use shaft::Shaft;

pub use crate::index::{ById, Id, JointId, LinkId};
use crate::joint::Follow;

/// A tree of links and joints. Indices into `links`, `joints` and `frames` follow the order of the
/// file.
///
/// It can be edited before [`Model::new`](crate::model::Model::new) makes a model of it:
///
/// ```
/// use articulated_core::description::{Description, EditError, Joint, JointKind, Link};
/// use articulated_core::description::{LinkId, Payload};
///
/// let link = |name: &str| Link { name: name.into(), ..Link::default() };
/// let slide = Joint {
///     name: "slide".into(),
///     kind: JointKind::Prismatic,
///     parent: LinkId(0),
///     child: LinkId(1),
///     axis: [0.0, 0.0, 1.0],
///     ..Joint::default()
/// };
/// let (links, joints) = ([link("mast"), link("fork")].into(), [slide].into());
/// let mut lift = Description { name: "lift".into(), links, joints, frames: vec![] };
/// lift.attach(&Payload { link: "fork".into(), mass: 100.0, ..Payload::default() })?;
/// lift.lock("slide", &[0.3])?; // m
/// assert_eq!(lift.joints[lift.joint("slide").unwrap()].locked, Some(vec![0.3]));
/// # Ok::<(), EditError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// The robot's name.
    pub name: String,
    /// Links in the order of the file.
    pub links: ById<LinkId, Link>,
    /// Joints in the order of the file.
    pub joints: ById<JointId, Joint>,
    /// Frames beside those of the links, in the order of the file.
    pub frames: Vec<Frame>,
}

/// A rigid body of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Link {
    /// The link's name, unique among links.
    pub name: String,
    /// Mass properties; `None` is a link without mass.
    pub inertial: Option<Inertial>,
    /// Collision geometry in the order of the file. The dynamics do not use it, unless effects
    /// are made of it.
    pub collision: Vec<Collision>,
    /// Its appearance in the order of the file. The dynamics do not use it.
    pub visual: Vec<Visual>,
    /// Whether the link only lies between two joints in sequence on one body. Such a link has no
    /// mass and no collision geometry, and is not a frame of the model.
    pub intermediate: bool,
}

/// Mass, centre of mass and rotational inertia of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// The inertial frame in the link's frame; its origin is the centre of mass.
    pub origin: Origin,
    /// Mass, kg.
    pub mass: f64,
    /// Rotational inertia about the centre of mass in axes of the inertial frame: xx, xy, xz, yy,
    /// yz, zz, kg·m².
    pub inertia: [f64; 6],
}

/// A named frame of the file that is not a link: a site, a tool centre point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// The frame's name, unique among links and frames.
    pub name: String,
    /// Index of the link that carries it.
    pub link: LinkId,
    /// The frame in the link's frame.
    pub origin: Origin,
}

/// From one row for each kind of joint of a file, with its name in a URDF, the kinds and their
/// list.
macro_rules! joint_kinds {
    ($($(#[$attribute:meta])+ $kind:ident $name:literal,)+) => {
        /// Kind of a joint of the file, by the motion that it allows.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub enum JointKind {
            $($(#[$attribute])+ $kind,)+
        }

        impl JointKind {
            /// All kinds, in the order of printed lists.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// Its name in a URDF.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => $name,)+
                }
            }
        }
    };
}

joint_kinds! {
    /// A turn about the axis, within limits.
    Revolute "revolute",
    /// A turn about the axis without limits; its coordinate is the plain angle.
    Continuous "continuous",
    /// A translation along the axis.
    Prismatic "prismatic",
    /// No motion.
    #[default]
    Fixed "fixed",
    /// Six degrees of freedom.
    Floating "floating",
    /// Two translations in the plane normal to the axis and a turn about it: (x, y, θ), rates along
    /// the axes of the joint frame. For the axis z the plane has the frame's x and y, for x its y
    /// and z, for y its z and x; for any other, the first two columns of
    /// [`crate::spatial::to_z_axis`].
    Planar "planar",
    /// Any rotation about the joint's origin: a unit quaternion (x, y, z, w) and the angular
    /// velocity in axes of the child.
    Spherical "spherical",
    /// A rotation about the axis, within limits, that slides along it: `pitch` metres per
    /// revolution. The coordinate is the angle.
    Helical "helical",
    /// A rotation about `axis`, then one about `second_axis`, which the first has turned: Cardan's
    /// joint.
    Universal "universal",
}

/// Quantity of a coordinate or a rate of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A turn, rad.
    Angle,
    /// A way, m.
    Length,
    /// One of the four numbers of a unit quaternion (x, y, z, w), which are neighbours. No rate is
    /// of this kind.
    Quaternion,
}

impl JointKind {
    /// The quantities of its coordinates, in order.
    pub fn coordinates(self) -> &'static [Quantity] {
        use Quantity::{Angle, Length, Quaternion};
        match self {
            Self::Fixed => &[],
            Self::Revolute | Self::Continuous | Self::Helical => &[Angle],
            Self::Prismatic => &[Length],
            Self::Universal => &[Angle, Angle],
            Self::Planar => &[Length, Length, Angle],
            Self::Spherical => &[Quaternion, Quaternion, Quaternion, Quaternion],
            Self::Floating => &[Length, Length, Length, Quaternion, Quaternion, Quaternion, Quaternion],
        }
    }

    /// The quantities of its rates, in order: those of a joint without a quaternion are the rates
    /// of its coordinates.
    pub fn rates(self) -> &'static [Quantity] {
        use Quantity::{Angle, Length};
        match self {
            Self::Fixed | Self::Revolute | Self::Continuous | Self::Prismatic | Self::Helical | Self::Universal | Self::Planar => {
                self.coordinates()
            }
            Self::Spherical => &[Angle, Angle, Angle],
            Self::Floating => &[Angle, Angle, Angle, Length, Length, Length],
        }
    }

    /// Number of coordinates and number of degrees of freedom.
    pub fn sizes(self) -> (usize, usize) {
        (self.coordinates().len(), self.rates().len())
    }

    /// Index of the first coordinate of its unit quaternion (x, y, z, w); `None`: its coordinates
    /// are plain numbers, one for each degree of freedom.
    pub fn quaternion(self) -> Option<usize> {
        self.coordinates().iter().position(|of| *of == Quantity::Quaternion)
    }

    /// Whether it allows no motion.
    pub fn is_fixed(self) -> bool {
        self.rates().is_empty()
    }

    /// Whether it is a translation along an axis, so that its coordinate is a length.
    pub fn is_linear(self) -> bool {
        *self.coordinates() == [Quantity::Length]
    }

    /// Whether its coordinate may have bounds.
    pub fn has_bounds(self) -> bool {
        self != Self::Continuous
    }

    /// Whether it has a pitch, m per revolution.
    pub fn has_pitch(self) -> bool {
        self == Self::Helical
    }

    /// Whether it rotates about a second axis.
    pub fn has_second_axis(self) -> bool {
        self == Self::Universal
    }

    /// Whether it moves along or about an axis.
    pub fn has_axis(self) -> bool {
        !matches!(self, Self::Fixed | Self::Floating | Self::Spherical)
    }
}

/// A joint of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Joint {
    /// The joint's name, unique among joints.
    pub name: String,
    /// The motion that it allows.
    pub kind: JointKind,
    /// Index of the parent link.
    pub parent: LinkId,
    /// Index of the child link.
    pub child: LinkId,
    /// The joint's frame in the parent link's frame.
    pub origin: Origin,
    /// The axis in the joint's frame, as written: not necessarily of unit length, never zero for a
    /// joint that has one.
    pub axis: [f64; 3],
    /// The second axis of a universal joint, in the joint's frame at zero, not along the first; not
    /// used otherwise.
    pub second_axis: [f64; 3],
    /// How far a helical joint slides in one turn, m; not used otherwise.
    pub pitch: f64,
    /// Coordinates at which the joint is locked, in the number of its kind; `None`: it moves.
    pub locked: Option<Vec<f64>>,
    /// The joint that this one follows.
    pub mimic: Option<Mimic>,
    /// Further joints that it follows: q is the sum of their contributions. Empty without `mimic`.
    pub also: Vec<Mimic>,
    /// Limits, where the file gives them.
    pub limit: Option<Limit>,
    /// Forces that the file gives to the joint. The dynamics do not use them, unless effects are
    /// made of them.
    pub dynamics: JointDynamics,
}

/// How a joint follows another: q = f(x) with the coordinate x of the leader,
///
/// ```text
/// f(x) = offset + multiplier x + higher₀ x² + higher₁ x³ + higher₂ x⁴
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mimic {
    /// Index of the joint that is followed.
    pub joint: JointId,
    /// Dimensionless, or m/rad, or rad/m.
    pub multiplier: f64,
    /// rad or m.
    pub offset: f64,
    /// Coefficients of the powers 2, 3 and 4, rad or m over powers of rad or m; zeros where the
    /// joint follows linearly.
    pub higher: [f64; 3],
}

impl Mimic {
    /// q = multiplier · x + offset.
    pub fn linear(joint: JointId, multiplier: f64, offset: f64) -> Self {
        Self { joint, multiplier, offset, higher: [0.0; 3] }
    }

    /// f.
    pub fn law(&self) -> Follow<f64> {
        Follow { multiplier: self.multiplier, offset: self.offset, higher: Some(self.higher).filter(|all| *all != [0.0; 3]) }
    }

    /// The degree of f: one also where the multiplier is zero.
    pub fn degree(&self) -> usize {
        self.higher.iter().rposition(|x| *x != 0.0).map_or(1, |last| last + 2)
    }
}

/// Bounds of a joint's motion; infinite where the file gives none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Lower bound of the coordinate, rad or m.
    pub lower: f64,
    /// Upper bound of the coordinate, rad or m.
    pub upper: f64,
    /// Largest torque or force, N·m or N.
    pub effort: f64,
    /// Largest rate, rad/s or m/s.
    pub velocity: f64,
    /// Largest acceleration, rad/s² or m/s².
    pub acceleration: f64,
    /// Largest acceleration against the motion, rad/s² or m/s².
    pub deceleration: f64,
    /// Largest rate of the acceleration, rad/s³ or m/s³.
    pub jerk: f64,
}

impl Limit {
    /// No limits.
    pub const NONE: Self = Self {
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
        effort: f64::INFINITY,
        velocity: f64::INFINITY,
        acceleration: f64::INFINITY,
        deceleration: f64::INFINITY,
        jerk: f64::INFINITY,
    };
}

/// Coefficients of a joint's own forces, as the file gives them; `None` where it gives none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointDynamics {
    /// Viscous damping, N·m·s/rad or N·s/m.
    pub damping: Option<f64>,
    /// Damping per square and per cube of the rate, N·m·s²/rad² or N·s²/m², and N·m·s³/rad³ or
    /// N·s³/m³.
    pub damping_terms: Option<[f64; 2]>,
    /// Coulomb friction, N·m or N.
    pub friction: Option<f64>,
    /// Inertia of the rotor, seen behind the gear, kg·m² or kg.
    pub armature: Option<f64>,
    /// Stiffness of a spring, N·m/rad or N/m.
    pub stiffness: Option<f64>,
    /// Stiffness per square and per cube of the distance from rest, N·m/rad² or N/m², and N·m/rad³
    /// or N/m³.
    pub stiffness_terms: Option<[f64; 2]>,
    /// The coordinate at which the springs are slack, rad or m; `None` with a stiffness: zero.
    pub rest: Option<f64>,
}

/// Whether the root link is the base or moves freely in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Base {
    /// The root link does not move; its frame is the world frame.
    #[default]
    Fixed,
    /// The root link has six degrees of freedom in the world frame.
    Floating,
}

impl Description {
    /// Index of the root link: the first that is no joint's child. `None` where there is none.
    pub fn root(&self) -> Option<LinkId> {
        let mut is_child: ById<LinkId, bool> = vec![false; self.links.len()].into();
        for joint in &self.joints {
            is_child.get_mut(joint.child).into_iter().for_each(|is| *is = true);
        }
        is_child.position(|is| !is)
    }

    /// The first free joint by which the robot floats already, so that a floating base would let it
    /// float twice: a [floating](JointKind::Floating) joint that is not locked, on the root or on
    /// links fixed to it. The root is without mass, or it is called `world`, as in files whose root
    /// is the world. `None`: there is none, or the root is a body that may fly beside others.
    pub fn free_joint_of_root(&self) -> Option<&Joint> {
        let root = self.root()?;
        let mut below: ById<LinkId, Vec<&Joint>> = vec![Vec::new(); self.links.len()].into();
        for joint in &self.joints {
            below.get_mut(joint.parent)?.push(joint);
        }
        let mut seen: ById<LinkId, bool> = vec![false; self.links.len()].into();
        let (mut held, mut free) = (vec![root], None);
        let mut has_mass = false;
        while let Some(link) = held.pop() {
            if core::mem::replace(seen.get_mut(link)?, true) {
                continue;
            }
            has_mass |= self.links[link].inertial.is_some_and(|inertial| inertial.mass != 0.0);
            for joint in &below[link] {
                if joint.kind.is_fixed() || joint.locked.is_some() {
                    held.push(joint.child);
                } else if joint.kind == JointKind::Floating {
                    free = free.or(Some(*joint));
                }
            }
        }
        free.filter(|_| !has_mass || self.links[root].name == "world")
    }

    /// Index of the link called `name`.
    pub fn link(&self, name: &str) -> Option<LinkId> {
        self.links.position(|l| l.name == name)
    }

    /// Index of the joint called `name`.
    pub fn joint(&self, name: &str) -> Option<JointId> {
        self.joints.position(|j| j.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_soon_found_wherever_it_is() {
        let count = 100_000;
        let robot = |child: fn(usize) -> usize| Description {
            links: vec![Link::default(); count + 1].into(),
            joints: (0..count).map(|k| Joint { child: LinkId(child(k)), ..Joint::default() }).collect(),
            ..Description::default()
        };
        assert_eq!(robot(|k| k).root(), Some(LinkId(count)));
        assert_eq!(robot(|k| k + 1).root(), Some(LinkId(0)));
        assert_eq!(robot(|k| k.max(1)).root(), Some(LinkId(0)));
        // A child index without a link is ignored.
        assert_eq!(Description { joints: [Joint { child: LinkId(7), ..Joint::default() }].into(), ..Description::default() }.root(), None);
    }
}
