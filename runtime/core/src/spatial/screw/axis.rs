//! Screw axes, and chains of them.

use nalgebra::Vector3;

use crate::Scalar;
use crate::spatial::{Placement, Twist};

/// A screw: a line and a motion: `turn` rad about the line and `slide` m along it for each unit of
/// the coordinate.
///
/// Turn and slide are homogeneous coordinates of the pitch slide/turn, so that a translation is a
/// screw like any other. Lynch & Park 2017, §3.3.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw<S> {
    /// A point on the line, m; of no meaning for a translation.
    pub point: Vector3<S>,
    /// The line's direction, of length one.
    pub direction: Vector3<S>,
    /// Turn about the line, rad for each unit.
    pub turn: S,
    /// Slide along the line, m for each unit.
    pub slide: S,
}

impl<S: Scalar> Screw<S> {
    /// A screw of finite pitch, m/rad, whose coordinate is the angle; 0 for a pure rotation.
    pub fn with_pitch(point: Vector3<S>, direction: Vector3<S>, pitch: S) -> Self {
        Self { point, direction, turn: S::one(), slide: pitch }
    }

    /// Infinite pitch: a translation, whose coordinate is the distance in m.
    pub fn translation(direction: Vector3<S>) -> Self {
        Self { point: Vector3::zeros(), direction, turn: S::zero(), slide: S::one() }
    }

    /// The twist for a unit rate, in the frame that the line is given in: [ω; v] =
    /// [turn·s; slide·s + point × ω].
    ///
    /// The exponential of this twist is analytic at turn = 0: a screw whose turn goes to zero
    /// becomes the translation.
    pub fn twist(&self) -> Twist<S> {
        let angular = self.direction * self.turn;
        Twist { angular, linear: self.direction * self.slide + self.point.cross(&angular) }
    }

    /// The screw of a twist that is not zero: its point is the line's nearest to the origin, ω ×
    /// v/ω², as far off as the twist is near to a translation.
    pub fn of(twist: &Twist<S>) -> Self {
        let (one, unit) = (S::one(), unit_of(twist));
        let (w, v) = (twist.angular.map(|x| x / unit), twist.linear.map(|x| x / unit));
        let square = w.dot(&w);
        let turns = square.positive();
        let safe = S::select(turns, square, one);
        let turn = S::select(turns, safe.sqrt(), S::zero());
        // v/|v| without rotation; there v is not zero.
        let way = S::select(turns, one, v.dot(&v)).sqrt();
        let length = S::select(turns, safe.sqrt(), way);
        let direction = w.zip_map(&v, |w, v| S::select(turns, w, v) / length);
        Self { point: w.cross(&v).map(|c| c / safe), direction, turn: turn * unit, slide: direction.dot(&v) * unit }
    }
}

/// Unit of a twist in which its squares are numbers that are not zero: one, unless the twist is
/// very small or very large.
fn unit_of<S: Scalar>(twist: &Twist<S>) -> S {
    let size = twist.angular.iter().chain(twist.linear.iter()).fold(S::zero(), |sum, x| sum + x.abs());
    let (small, large) = ((S::from_f64(1e-15) - size).positive(), (size - S::from_f64(1e15)).positive());
    S::select(small, size, S::select(large, size, S::one()))
}

/// Product of exponentials with screws in the world frame: e^{S_1 θ_1} ⋯ e^{S_n θ_n} M, where
/// `home` is the placement M at θ = 0.
///
/// The twists are those of the robot at θ = 0; θ rad or m. Lynch & Park 2017, (4.14).
pub fn product_of_exponentials_in_space<S: Scalar>(joints: &[(Twist<S>, S)], home: &Placement<S>) -> Placement<S> {
    product(Placement::identity(), joints).compose(home)
}

/// Product of exponentials with screws in the frame of the end: M e^{B_1 θ_1} ⋯ e^{B_n θ_n}, B_i =
/// Ad(M⁻¹) S_i. Lynch & Park 2017, (4.16).
pub fn product_of_exponentials_in_body<S: Scalar>(home: &Placement<S>, joints: &[(Twist<S>, S)]) -> Placement<S> {
    product(*home, joints)
}

fn product<S: Scalar>(first: Placement<S>, joints: &[(Twist<S>, S)]) -> Placement<S> {
    joints.iter().fold(first, |x, (screw, angle)| {
        let way = Twist { angular: screw.angular * *angle, linear: screw.linear * *angle };
        x.compose(&way.exp())
    })
}
