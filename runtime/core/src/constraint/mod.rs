//! What a robot touches: limits and dry friction of joints and tendons, equations, and contacts, by
//! MuJoCo's law.
//!
//! The acceleration a is the minimum of a strictly convex function:
//!
//! ```text
//! ½ (a − a₀)ᵀ M (a − a₀) + s(J a − r)      a₀: the acceleration without constraints
//! ```
//!
//! s is a sum over constraints, each with its rows of J and its reference accelerations r. A
//! constraint is soft: r pulls its violation back like a spring with a damper, and it gives way by
//! an impedance.
//!
//! A file of this folder is a law, but `newton`, which finds the minimum. Shapes that touch are
//! in [`crate::collision`]. Source: MuJoCo documentation, Computation: constraint model; Todorov,
//! ICRA 2014.

mod anchors;
mod contact;
mod forces;
mod joints;
mod motion;
mod newton;
mod pairs;
mod soft;
mod sums;
mod weights;

use alloc::vec::Vec;

pub use anchors::{Anchor, poses};
pub use contact::MOST_ROWS;
pub use forces::CONTACT;
pub(crate) use forces::contact_forces;
pub(crate) use newton::{Certificate, Smooth, certified, constrained, searched};
pub use pairs::GIVEN;
pub use soft::{Impedance, Soft};
pub use sums::{Length, Sum, SumLaw, Term};
pub use weights::{Weights, weights};

use crate::Scalar;
use crate::collision::Shape;

/// The constraints of a robot. Empty lists: it has none.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraints<S = f64> {
    /// The form of cones of friction.
    pub cone: Cone,
    /// Limits of joints.
    pub limits: Vec<Limit<S>>,
    /// Dry friction of joints.
    pub friction: Vec<DryFriction<S>>,
    /// Constraints of lengths: of tendons, and equations.
    pub sums: Vec<Sum<S>>,
    /// Frames of two bodies that are held together.
    pub anchors: Vec<Anchor<S>>,
    /// Shapes that make contact.
    pub shapes: Vec<Shape<S>>,
    /// Which of them touch each other.
    pub pairs: Vec<Pair<S>>,
}

impl<S> Default for Constraints<S> {
    fn default() -> Self {
        Self {
            cone: Cone::default(),
            limits: Vec::new(),
            friction: Vec::new(),
            sums: Vec::new(),
            anchors: Vec::new(),
            shapes: Vec::new(),
            pairs: Vec::new(),
        }
    }
}

/// The form of cones of friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cone {
    /// A pyramid: a row for each of its edges.
    #[default]
    Pyramid,
    /// An elliptic cone.
    Ellipse,
}

/// Bounds of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit<S = f64> {
    /// The first coordinate of the joint.
    pub q: usize,
    /// Its first degree of freedom.
    pub v: usize,
    /// The bounds.
    pub bound: Bound<S>,
    /// The bound acts from this far before it, rad or m.
    pub margin: S,
    /// How it gives way.
    pub soft: Soft<S>,
    /// The inverse inertia of its row in the reference pose, 1/(kg·m²) or 1/kg.
    pub weight: S,
}

/// Where the bounds of a joint are.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound<S = f64> {
    /// The coordinate is between two numbers, rad or m.
    Between([S; 2]),
    /// The rotation of a ball joint is at most by this angle, rad.
    Angle(S),
}

/// Dry friction of a degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct DryFriction<S = f64> {
    /// The degree of freedom; of a free joint's translation the first of its three.
    pub v: usize,
    /// Of a free joint's translation: where its quaternion is in q, and the axis of the parent
    /// along which it acts.
    pub along: Option<(usize, usize)>,
    /// Its greatest force, N·m or N.
    pub loss: S,
    /// How it gives way.
    pub soft: Soft<S>,
    /// The inverse inertia of its row in the reference pose, 1/(kg·m²) or 1/kg.
    pub weight: S,
}

/// Two shapes that may touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair<S = f64> {
    /// The places of both in [`Constraints::shapes`].
    pub shapes: [usize; 2],
    /// In how many places a caller says where they touch: functions without contacts as an argument
    /// leave the pair out. 0: the places are computed here.
    pub given: usize,
    /// The number of directions in which the contact has forces: 1, 3 (with friction), 4 (with
    /// torsion) or 6 (with rolling).
    pub dimension: usize,
    /// Coefficients of friction: two of sliding, dimensionless, of torsion, m, and two of rolling,
    /// m.
    pub friction: [S; 5],
    /// Friction of the regularised cone, dimensionless: that of sliding over the root of the ratio
    /// of impedances.
    pub mu: S,
    /// Contact acts from this distance on, m.
    pub margin: S,
    /// How it gives way along the normal.
    pub soft: Soft<S>,
    /// Damping across the normal, 1/s.
    pub tangential_damping: S,
    /// The inverse inertia of the row along the normal in the reference pose, 1/kg.
    pub weight: S,
}

impl<S: Scalar> Constraints<S> {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.limits.is_empty() && self.friction.is_empty() && self.sums.is_empty() && self.anchors.is_empty() && self.pairs.is_empty()
    }

    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Constraints<T> {
        Constraints {
            cone: self.cone,
            limits: self.limits.iter().map(|limit| limit.map(f)).collect(),
            friction: self.friction.iter().map(|own| own.map(f)).collect(),
            sums: self.sums.iter().map(|own| own.map(f)).collect(),
            anchors: self.anchors.iter().map(|anchor| anchor.map(f)).collect(),
            shapes: self.shapes.iter().map(|shape| shape.map(f)).collect(),
            pairs: self.pairs.iter().map(|pair| pair.map(f)).collect(),
        }
    }
}

impl<S: Scalar> Limit<S> {
    fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Limit<T> {
        let bound = match self.bound {
            Bound::Between(both) => Bound::Between(both.map(f)),
            Bound::Angle(angle) => Bound::Angle(f(angle)),
        };
        Limit { q: self.q, v: self.v, bound, margin: f(self.margin), soft: self.soft.map(f), weight: f(self.weight) }
    }
}

impl<S: Scalar> DryFriction<S> {
    fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> DryFriction<T> {
        DryFriction { v: self.v, along: self.along, loss: f(self.loss), soft: self.soft.map(f), weight: f(self.weight) }
    }
}

impl<S: Scalar> Pair<S> {
    fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Pair<T> {
        Pair {
            shapes: self.shapes,
            given: self.given,
            dimension: self.dimension,
            friction: self.friction.map(f),
            mu: f(self.mu),
            margin: f(self.margin),
            soft: self.soft.map(f),
            tangential_damping: f(self.tangential_damping),
            weight: f(self.weight),
        }
    }
}
