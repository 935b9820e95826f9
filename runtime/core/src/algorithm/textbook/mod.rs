//! The reference: every function of the table by its definition, in plain matrices, in the frames
//! of the file.
//!
//! Motions are differentiated by [`Dual`] and not by formulas; linear functions are applied to unit
//! vectors; sums over links are written as sums. Inverse dynamics is the plain matrix form with 6×6
//! Adjoint and inertia matrices and one set of screw axes a joint (Lynch & Park, *Modern Robotics*,
//! 2017, §8.3.2). It shares no formula with the other algorithms and is their reference, in big
//! floats where it matters. It is not meant to be fast.
//!
//! The three recursions are a page each: [`rnea`], [`crba`] and [`aba`]. They read a [`Tree`], the
//! robot at one configuration, which [`Textbook::at`] makes.

pub mod aba;
mod build;
mod call;
mod coriolis;
pub mod crba;
mod derivatives;
mod dynamics;
mod energy;
mod joint;
mod kinematics;
mod manifold;
mod manifold_derivatives;
pub mod matrix;
mod momentum;
mod regressor;
pub mod rnea;
mod solve;
mod tree;

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use nalgebra::{Matrix6, Vector3};

use crate::Scalar;
use crate::dual::Dual;
use crate::model::JointInfo;
use crate::spatial::{Placement, Reference};
use joint::Joint;
pub use tree::{Tree, TreeBody};

/// A described robot with every link a body and every joint a joint, fixed ones too. Constants are
/// computed in the scalar `S` from the numbers of the file.
///
/// [`Textbook::call`] has every function by its name and checks lengths; the functions themselves
/// take slices as long as stated, and panic at shorter ones.
#[derive(Clone, Debug)]
pub struct Textbook<S> {
    bodies: Vec<Link<S>>,
    /// Name and body of each link and of each other frame of the file.
    links: Vec<(String, usize)>,
    /// Bodies of the frames.
    frames: Vec<usize>,
    gravity: Vector3<S>,
    wrench_reference: Reference,
    /// The joints that are coordinates.
    joints: Vec<JointInfo>,
    nq: usize,
    nv: usize,
}

#[derive(Clone, Debug)]
struct Link<S> {
    parent: Option<usize>,
    /// The joint's frame in the parent link's.
    placement: Placement<S>,
    joint: Joint<S>,
    /// G, 6×6, about the link's origin.
    inertia: Matrix6<S>,
    /// Whether any joint on the way from the base moves it.
    carried: bool,
    /// Whether it is a link of the file, and neither an intermediate one nor a frame.
    is_link: bool,
}

impl<S: Scalar> Textbook<S> {
    /// The same robot with only the named frames, in this order, or the first name that no link
    /// has.
    pub fn with_frames<N: AsRef<str>>(mut self, names: &[N]) -> Result<Self, String> {
        let find = |name: &N| self.links.iter().find(|(link, _)| link == name.as_ref()).map(|(_, body)| *body);
        self.frames = names.iter().map(|n| find(n).ok_or_else(|| n.as_ref().to_string())).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// The same robot, with wrenches given in another reference.
    #[must_use]
    pub fn with_wrenches_in(mut self, reference: Reference) -> Self {
        self.wrench_reference = reference;
        self
    }

    /// For each body the one that it is fixed to, by any number of fixed joints, and its frame in
    /// that one's. The joint of that one moves, or it is the root.
    fn seats(&self) -> Vec<(usize, Placement<S>)> {
        let mut seats: Vec<(usize, Placement<S>)> = Vec::with_capacity(self.bodies.len());
        for (i, body) in self.bodies.iter().enumerate() {
            seats.push(match body.parent {
                Some(p) if !body.joint.moves() => (seats[p].0, seats[p].1.compose(&body.placement)),
                _ => (i, Placement::identity()),
            });
        }
        seats
    }

    /// The links that move, in the order of the joints that move them: of all that a joint moves
    /// and that is fixed together, the first link. The rest belongs to it.
    fn moving_links(&self) -> Vec<usize> {
        let seats = self.seats();
        let moving = (0..self.bodies.len()).filter(|&i| self.bodies[i].joint.moves());
        moving.filter_map(|i| (i..self.bodies.len()).find(|&k| seats[k].0 == i && self.bodies[k].is_link)).collect()
    }

    /// The same robot with constants that do not vary.
    fn lift(&self) -> Textbook<Dual<S>> {
        let constant = Dual::constant;
        let link = |b: &Link<S>| Link {
            parent: b.parent,
            placement: b.placement.map(constant),
            joint: b.joint.lift(),
            inertia: b.inertia.map(constant),
            carried: b.carried,
            is_link: b.is_link,
        };
        Textbook {
            bodies: self.bodies.iter().map(link).collect(),
            links: self.links.clone(),
            frames: self.frames.clone(),
            gravity: self.gravity.map(constant),
            wrench_reference: self.wrench_reference,
            joints: self.joints.clone(),
            nq: self.nq,
            nv: self.nv,
        }
    }

    /// The k-th unit vector of the tangent space.
    fn unit(&self, k: usize) -> Vec<S> {
        (0..self.nv).map(|i| if i == k { S::one() } else { S::zero() }).collect()
    }

    /// The rates of rest.
    fn rest(&self) -> Vec<S> {
        alloc::vec![S::zero(); self.nv]
    }
}

/// Numbers that do not vary.
fn constant<S: Scalar>(x: &[S]) -> Vec<Dual<S>> {
    x.iter().map(|&x| Dual::constant(x)).collect()
}

/// x + ε x'.
fn varied<S: Scalar>(x: &[S], slope: &[S]) -> Vec<Dual<S>> {
    x.iter().zip(slope).map(|(&x, &d)| Dual::new(x, d)).collect()
}

/// The derivatives.
fn slopes<S: Scalar>(x: &[Dual<S>]) -> Vec<S> {
    x.iter().map(|x| x.slope).collect()
}
