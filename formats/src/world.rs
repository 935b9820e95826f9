//! Content of a file besides its robot: gravity, settings of a simulation, states, actuators.
//!
//! It does not change the description. A scene uses the parts that it requests. Numbers are in SI
//! units and in the conventions of the library: quaternions (x, y, z, w), rates of a floating joint
//! as the twist [ω; v] in axes of its link.

use std::collections::{BTreeMap, BTreeSet};

use articulated_core::actuator::{Activation, Terms};
use articulated_core::collision::Form;
use articulated_core::constraint::Cone;
use articulated_core::description::{Coupling, Description, Origin};
use articulated_core::diagnostic::At;
use articulated_core::effect::Applied;

use crate::LeaveOut;

/// A robot and its world, as read by a format.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The robot.
    pub description: Description,
    /// The rest.
    pub world: World,
}

impl From<Description> for Document {
    fn from(description: Description) -> Self {
        Self { description, world: World::default() }
    }
}

/// Content of a file besides its robot. `None`, or an empty list: not in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct World {
    /// Gravity in the world frame, m/s².
    pub gravity: Option<[f64; 3]>,
    /// Time step of a simulation, s.
    pub step: Option<f64>,
    /// Integrator of a simulation, by the file's name.
    pub integrator: Option<String>,
    /// How the file's simulator steps the motion, with its defaults (MJCF).
    pub stepping: Option<Stepping>,
    /// The initial state of the file, if it differs from that of joints at rest.
    pub home: Option<Keyframe>,
    /// States, in the order of the file.
    pub keyframes: Vec<Keyframe>,
    /// Actuators, in the order of the file.
    pub actuators: Vec<Actuator>,
    /// Springs and dampers across several joints, such as those of tendons: actuators without gain.
    pub passive: Vec<Actuator>,
    /// Bounds of the sum of all actuators on a joint of one degree of freedom, N·m or N.
    pub joint_forces: Vec<(String, [f64; 2])>,
    /// Joints that follow others, by linear equations of the file.
    pub couplings: Vec<(Coupling, At)>,
    /// Planes that do not move, against which links collide.
    pub planes: Vec<Plane>,
    /// For links with collision geometry, the contact mask of each piece, in the order of their
    /// lists. A link that is missing here makes contact with everything.
    pub contact_masks: BTreeMap<String, Vec<ContactMask>>,
    /// Effects of the file on links, with their places: of weight that is compensated, and of the
    /// medium.
    pub effects: Vec<(Applied, At)>,
    /// What touches in the file's simulator, by its law (MJCF).
    pub touching: Option<Touching>,
    /// Equations of the file that close loops, or are not linear: they are not applied.
    pub loops: Vec<Loop>,
}

/// Limits, dry friction and contacts of a file, with the numbers of MuJoCo's law.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Touching {
    /// The form of cones of friction.
    pub cone: Cone,
    /// `impratio`: by how much friction is harder than the normal, dimensionless.
    pub impedance_ratio: f64,
    /// Time constants are at least twice this time, s. `None`: they may be any.
    pub safe_step: Option<f64>,
    /// Shapes of links.
    pub shapes: Vec<TouchingShape>,
    /// Pairs of them that touch, by their places.
    pub pairs: Vec<TouchingPair>,
    /// Limits of joints.
    pub limits: Vec<TouchingLimit>,
    /// Dry friction of joints.
    pub friction: Vec<TouchingFriction>,
    /// Constraints of tendons, and equations of joints and tendons.
    pub sums: Vec<TouchingSum>,
    /// Frames of two links that are held together.
    pub anchors: Vec<TouchingAnchor>,
    /// For each body of the file its link, its centre of mass in the link's frame, m, and whether
    /// it moves on slides alone, where MuJoCo takes its mass for its inertia.
    pub bodies: Vec<(String, [f64; 3], bool)>,
    /// What the file has besides, and is not read.
    pub unread: Vec<Unread>,
    /// What the options leave out.
    pub left_out: BTreeSet<LeaveOut>,
    /// Pairs whose contacts a caller finds.
    pub given: Vec<GivenContact>,
}

/// A pair of shapes whose contacts a caller finds, and gives to functions as an argument.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GivenContact {
    /// Names of the shapes; normals are from the first to the second.
    pub shapes: [String; 2],
    /// In how many places they touch at most.
    pub places: usize,
}

/// No pair has more.
pub const MOST_GIVEN: usize = 64;

impl Touching {
    /// Whether two shapes of these names may touch, by masks and the tree.
    pub fn may_touch(&self, names: &[String; 2]) -> bool {
        self.pairs.iter().any(|pair| self.is_of(pair, names).is_some())
    }

    /// Whether a pair is of these names: its shapes in their order.
    pub(crate) fn is_of(&self, pair: &TouchingPair, names: &[String; 2]) -> Option<[usize; 2]> {
        let [first, second] = pair.shapes;
        let is = |shapes: [usize; 2]| shapes.iter().zip(names).all(|(shape, name)| self.shapes[*shape].name == *name);
        [[first, second], [second, first]].into_iter().find(|shapes| is(*shapes))
    }

    /// Whether the file has a constraint, whether or not it is computed.
    pub fn has_some(&self) -> bool {
        self.has_read() || !self.unread.is_empty()
    }

    /// Whether it has one that is read.
    pub(crate) fn has_read(&self) -> bool {
        let Self { limits, friction, sums, anchors, pairs, .. } = self;
        !(limits.is_empty() && friction.is_empty() && sums.is_empty() && anchors.is_empty() && pairs.is_empty())
    }
}

/// A constraint that is not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unread {
    /// The word that leaves it out.
    pub kind: LeaveOut,
    /// What it is.
    pub what: String,
    /// Place in the file.
    pub place: At,
}

/// A shape that makes contact.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingShape {
    /// Its name, or `geom_N` by its number from 0.
    pub name: String,
    /// Its link.
    pub link: String,
    /// Its frame in the link's frame.
    pub origin: Origin,
    /// Its form; or what it is, of a form that makes no contact here.
    pub form: Result<Form, &'static str>,
    /// Place in the file.
    pub place: At,
}

/// Two shapes that touch.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingPair {
    /// Their places in the list.
    pub shapes: [usize; 2],
    /// 1, 3, 4 or 6.
    pub dimension: usize,
    /// Coefficients of friction: two of sliding, of torsion, two of rolling.
    pub friction: [f64; 5],
    /// `solref` along the normal, and across it if that is another.
    pub reference: [f64; 2],
    /// The same across the normal; zeros: the same.
    pub reference_across: [f64; 2],
    /// `solimp`.
    pub impedance: [f64; 5],
    /// m.
    pub margin: f64,
}

/// A limit of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingLimit {
    /// The joint.
    pub joint: String,
    /// Bounds of its coordinate, rad or m; of a ball joint 0 and the largest angle.
    pub range: [f64; 2],
    /// rad or m.
    pub margin: f64,
    /// `solref`.
    pub reference: [f64; 2],
    /// `solimp`.
    pub impedance: [f64; 5],
}

/// Dry friction of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingFriction {
    /// The joint.
    pub joint: String,
    /// N·m or N, of each of its degrees of freedom.
    pub loss: f64,
    /// `solref`.
    pub reference: [f64; 2],
    /// `solimp`.
    pub impedance: [f64; 5],
}

/// A length that changes with the coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum TouchingLength {
    /// A sum of coordinates: joints with their factors.
    Sum(Vec<(String, f64)>),
    /// That of a path.
    Path(Vec<Strand>),
}

/// A constraint of a length.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingSum {
    /// What it is, for messages.
    pub what: String,
    /// The length.
    pub length: TouchingLength,
    /// What holds for it.
    pub law: TouchingLaw,
    /// Whether it is one of tendons, whose strength is that of their lengths.
    pub is_of_tendons: bool,
    /// The joint that follows others by this equation where it is applied to the model.
    pub coupling: Option<String>,
    /// `solref`.
    pub reference: [f64; 2],
    /// `solimp`.
    pub impedance: [f64; 5],
}

/// Two frames that are held together.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingAnchor {
    /// What it is, for messages.
    pub what: String,
    /// Both links.
    pub links: [String; 2],
    /// The frames in the frames of their links. `None`: where the other one is in the reference
    /// pose.
    pub frames: [Option<Origin>; 2],
    /// The length by which turns are scaled, m. `None`: only the origins are held together.
    pub turns: Option<f64>,
    /// `solref`.
    pub reference: [f64; 2],
    /// `solimp`.
    pub impedance: [f64; 5],
}

/// What holds for a length.
#[derive(Clone, Debug, PartialEq)]
pub enum TouchingLaw {
    /// It is between two numbers; the bounds act from a margin before them on.
    Between {
        /// The bounds.
        range: [f64; 2],
        /// The margin.
        margin: f64,
    },
    /// Its dry friction.
    DryFriction(f64),
    /// It is a polynomial of another sum.
    Equation {
        /// The other length, if there is one.
        other: Option<TouchingLength>,
        /// Both lengths in the reference pose.
        references: [f64; 2],
        /// The coefficients, of degree 0 to 4.
        coefficients: [f64; 5],
    },
}

/// How the simulator of a file steps its motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stepping {
    /// The integrator by the file's name, or the default.
    pub integrator: String,
    /// The time step, s, or the default.
    pub step: f64,
    /// Whether its Euler is explicit in the damping of joints.
    pub is_explicit_in_damping: bool,
}

impl Stepping {
    /// The functions that step in the same way: with torques, and with actuators. `None`: there is
    /// none.
    pub fn functions(&self) -> Option<[&'static str; 2]> {
        if self.integrator == "Euler" && self.is_explicit_in_damping {
            return Some(["step_semi_implicit_euler", "actuated_step_semi_implicit_euler"]);
        }
        step_of_integrator(&self.integrator)
    }
}

/// The functions of a step that move as this integrator of MuJoCo does, by its name in an MJCF:
/// with torques, and with actuators. `None`: there is none.
pub fn step_of_integrator(name: &str) -> Option<[&'static str; 2]> {
    match name {
        "Euler" => Some(["step_implicit_damping", "actuated_step_implicit_damping"]),
        "implicitfast" => Some(["step_implicit_velocity", "actuated_step_implicit_velocity"]),
        "RK4" => Some(["step_rk4_mujoco", "actuated_step_rk4_mujoco"]),
        _ => None,
    }
}

impl World {
    /// The time step of the file, s, or the default of its simulator, if that is known.
    pub fn time_step(&self) -> Option<f64> {
        self.stepping.as_ref().map(|stepping| stepping.step).or(self.step)
    }
}

/// A state of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keyframe {
    /// Its name, or `key_N` by its number from 0.
    pub name: String,
    /// Coordinates by joint, as many as the joint has. Empty: those of the joints at rest.
    pub q: Vec<(String, Vec<f64>)>,
    /// Rates by joint, as many as the joint has. Empty: all 0.
    pub v: Vec<(String, Vec<f64>)>,
    /// Controls, one for each of [`World::actuators`]. Empty: all 0.
    pub control: Vec<f64>,
    /// Activations, one for each of [`World::actuators`]: 0 of those without. Empty: all 0.
    pub activation: Vec<f64>,
    /// Place in the file.
    pub place: At,
}

/// A force with an affine law on a sum of coordinates:
///
/// ```text
/// length l = Σ gear · q        (of a ball joint: gear · log q, the rotation vector)
/// force  f = clamp(gain(l, l̇) · w + bias(l, l̇)),   gain(l, l̇) = g₀ + g₁ l + g₂ l̇
/// τ += gear · f
/// ```
///
/// w is clamp(u), or the activation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actuator {
    /// Its name, or `actuator_N` by its number from 0.
    pub name: String,
    /// The joints that it drives: the name, and a number for each degree of freedom.
    pub drives: Vec<(String, Vec<f64>)>,
    /// The frames on which it acts, in place of joints.
    pub frames: Option<OnFrames>,
    /// g₀, g₁, g₂: force for each unit of control, of length, and of rate of length.
    pub gain: [f64; 3],
    /// b₀, b₁, b₂: force without control.
    pub bias: [f64; 3],
    /// Forces of higher degree beside these, of springs and dampers of tendons.
    pub terms: Option<Terms>,
    /// Bounds of the control u.
    pub control_range: Option<[f64; 2]>,
    /// Bounds of the force f.
    pub force_range: Option<[f64; 2]>,
    /// The activation between control and force, if it has one.
    pub activation: Option<Activation>,
    /// Place in the file.
    pub place: At,
}

/// Frames on which a force acts.
#[derive(Clone, Debug, PartialEq)]
pub enum OnFrames {
    /// It pushes at a frame.
    Site(Box<Site>),
    /// It pulls along a path.
    Path(Vec<Strand>),
}

impl OnFrames {
    /// The same with the names of links changed.
    pub fn renamed(self, name: impl Fn(&str) -> String + Copy) -> Self {
        let on = |(link, at): (String, Origin)| (name(&link), at);
        match self {
            Self::Site(own) => Self::Site(Box::new(Site { at: on(own.at), reference: own.reference.map(on), ..*own })),
            Self::Path(strands) => {
                let strand = |own: Strand| Strand { points: own.points.into_iter().map(on).collect(), ..own };
                Self::Path(strands.into_iter().map(strand).collect())
            }
        }
    }
}

/// The part of a path between two pulleys: straight lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand {
    /// Its points: the link, and the point in the link's frame.
    pub points: Vec<(String, Origin)>,
    /// Length of the path for a unit of this strand: one over the divisor of its pulley.
    pub factor: f64,
}

/// The frame on which an actuator acts, and its reference frame, if it has one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Site {
    /// The link, and the frame in the link's frame.
    pub at: (String, Origin),
    /// The same of the reference frame, if there is one.
    pub reference: Option<(String, Origin)>,
    /// Force, N, and moment, N·m, of a force of one, in axes of the frame, or of the reference.
    pub gear: [f64; 6],
}

/// A plane that does not move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plane {
    /// Its name; may be empty.
    pub name: String,
    /// A point of it in the world frame, m.
    pub point: [f64; 3],
    /// Its normal in the world frame, of norm one: the side on which links are.
    pub normal: [f64; 3],
    /// The mask of its contacts; `None`: contact with everything.
    pub mask: Option<ContactMask>,
    /// Place in the file.
    pub place: At,
}

/// Bits that define which collision geometry makes contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactMask {
    /// The kinds that it is of, a bit each.
    pub kinds: i64,
    /// The kinds that it makes contact with.
    pub affinity: i64,
}

impl ContactMask {
    /// Whether two make contact: one has an affinity to a kind of the other.
    pub fn meets(self, other: Self) -> bool {
        self.kinds & other.affinity != 0 || other.kinds & self.affinity != 0
    }
}

/// An equation of the file that is not part of the tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loop {
    /// Its name; may be empty.
    pub name: String,
    /// Its kind, with the file's name for it: `connect`, `weld`, `joint`, `tendon`.
    pub kind: String,
    /// Its links or joints.
    pub between: Vec<String>,
    /// Whether functions with constraints keep it.
    pub is_computed: bool,
    /// Place in the file.
    pub place: At,
}
