//! Actuators of a robot: forces with an affine law on sums of coordinates, some with an activation
//! of first order.
//!
//! ```text
//! l = Σ gear · q,   l̇ = Σ gear · v         (of a ball joint: the rotation vector log q)
//! f = clamp((g₀ + g₁ l + g₂ l̇) w + b₀ + b₁ l + b₂ l̇),   w = clamp(u), or the activation
//! τ = Σ gear f
//! ```
//!
//! Source: MuJoCo documentation, Actuation model.

mod activation;
mod frames;
mod path;
mod site;
mod terms;
mod torques;

use alloc::string::String;
use alloc::vec::Vec;

pub use activation::{Activation, Filter};
pub use frames::FrameDrive;
pub(crate) use frames::FrameRow;
pub(crate) use path::row as path_row;
pub use path::{Strand, path_at};
pub use site::{SiteDrive, SiteFrame};
pub use terms::Terms;

use crate::Scalar;
use crate::joint::Coordinates;

/// The actuators of a robot, in the order of its file, with the springs and dampers of its tendons.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuators<S = f64> {
    /// The actuators: each has a control.
    pub laws: Vec<ActuatorLaw<S>>,
    /// Bounds of their torque together on a degree of freedom: (number of the degree of freedom,
    /// [lower, upper]), N·m or N.
    pub bounds: Vec<(usize, [S; 2])>,
    /// Joints that follow others, on which actuators act.
    pub followers: Vec<Follower<S>>,
    /// Springs and dampers of tendons: they have no control, and no bound applies to them.
    pub passive: Vec<ActuatorLaw<S>>,
}

/// A force with an affine law on a sum of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorLaw<S = f64> {
    /// Its name.
    pub name: String,
    /// The joints that it drives.
    pub drives: Vec<Transmission<S>>,
    /// The frames that it pushes, instead of joints.
    pub frames: Option<FrameDrive<S>>,
    /// g₀, g₁, g₂: force for each unit of control, of length, and of rate of length.
    pub gain: [S; 3],
    /// b₀, b₁, b₂: force without control.
    pub bias: [S; 3],
    /// Forces of higher degree beside these, of springs and dampers.
    pub terms: Option<Terms<S>>,
    /// Bounds of the control u.
    pub control_range: Option<[S; 2]>,
    /// Bounds of the force f.
    pub force_range: Option<[S; 2]>,
    /// The activation between control and force, if it has one.
    pub activation: Option<Activation<S>>,
}

/// How an actuator drives a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transmission<S = f64> {
    /// The first coordinate of the joint.
    pub q: usize,
    /// Its first degree of freedom.
    pub v: usize,
    /// d(length)/d(coordinate), a number for each degree of freedom: one, or three of a ball joint.
    pub gear: Vec<S>,
    /// Coefficients of the powers 2, 3 and 4 of the coordinate in the length, of a joint that
    /// follows by a polynomial: then `gear` is the coefficient of the first power. `None`: zeros.
    pub higher: Option<[S; 3]>,
    /// Whether it gives no torque, only a part of the length: a [`Follower`] has the torque.
    pub has_no_torque: bool,
}

/// A joint with actuators that follows others: q = Σ f(leader). Each leader gets the torque of
/// these actuators, times f′. The bounds of the leaders do not limit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Follower<S = f64> {
    /// The actuators on it: the place in [`Actuators::laws`], and the gear.
    pub laws: Vec<(usize, S)>,
    /// Bounds of their torque together, N·m or N.
    pub range: Option<[S; 2]>,
    /// The coordinates that it moves with, each with the law by which it follows.
    pub leaders: Vec<Coordinates<S>>,
}

impl<S> Default for Actuators<S> {
    fn default() -> Self {
        Self { laws: Vec::new(), bounds: Vec::new(), followers: Vec::new(), passive: Vec::new() }
    }
}

impl<S: Scalar> Default for ActuatorLaw<S> {
    fn default() -> Self {
        let zero = [S::zero(); 3];
        Self {
            name: String::new(),
            drives: Vec::new(),
            frames: None,
            gain: zero,
            bias: zero,
            terms: None,
            control_range: None,
            force_range: None,
            activation: None,
        }
    }
}

impl<S> Default for Follower<S> {
    fn default() -> Self {
        Self { laws: Vec::new(), range: None, leaders: Vec::new() }
    }
}

impl<S: Scalar> Actuators<S> {
    /// Whether there is nothing: no actuator, and no spring or damper of a tendon.
    pub fn is_empty(&self) -> bool {
        self.laws.is_empty() && self.passive.is_empty()
    }

    /// How many of them have an activation: the length of `act`.
    pub fn activations(&self) -> usize {
        self.laws.iter().filter(|law| law.activation.is_some()).count()
    }

    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Actuators<T> {
        let pairs = |list: &[(usize, S)]| list.iter().map(|(k, x)| (*k, f(*x))).collect();
        let follower = |one: &Follower<S>| Follower {
            laws: pairs(&one.laws),
            range: one.range.map(|range| range.map(f)),
            leaders: one.leaders.iter().map(|own| own.map(f)).collect(),
        };
        Actuators {
            laws: self.laws.iter().map(|law| law.map(f)).collect(),
            bounds: self.bounds.iter().map(|(k, range)| (*k, range.map(f))).collect(),
            followers: self.followers.iter().map(follower).collect(),
            passive: self.passive.iter().map(|law| law.map(f)).collect(),
        }
    }
}

impl<S: Scalar> ActuatorLaw<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> ActuatorLaw<T> {
        let drive = |drive: &Transmission<S>| Transmission {
            q: drive.q,
            v: drive.v,
            gear: drive.gear.iter().map(|x| f(*x)).collect(),
            higher: drive.higher.map(|all| all.map(f)),
            has_no_torque: drive.has_no_torque,
        };
        ActuatorLaw {
            name: self.name.clone(),
            drives: self.drives.iter().map(drive).collect(),
            frames: self.frames.as_ref().map(|frames| frames.map(f)),
            gain: self.gain.map(f),
            bias: self.bias.map(f),
            terms: self.terms.as_ref().map(|terms| terms.map(f)),
            control_range: self.control_range.map(|range| range.map(f)),
            force_range: self.force_range.map(|range| range.map(f)),
            activation: self.activation.as_ref().map(|activation| activation.map(f)),
        }
    }
}
