//! Contents of the file, before names are looked up.

use articulated_core::description::{Collision, Inertial, JointDynamics, JointKind, Limit, Origin, Visual};
use articulated_core::diagnostic::{At, Subject};

/// Drake's joint for types that the format does not have.
pub(crate) const DRAKE_JOINT: &str = "drake:joint";

#[derive(Default)]
pub(crate) struct Draft {
    pub(crate) name: String,
    pub(crate) links: Vec<DraftLink>,
    pub(crate) joints: Vec<DraftJoint>,
    /// Tags of other programs that look like joints and are not read.
    pub(crate) passed_over: Vec<PassedOver>,
}

/// A tag that looks like a joint, as `<drake:joint>`.
pub(crate) struct PassedOver {
    pub(crate) at: At,
    pub(crate) tag: String,
    /// Empty if it has no name.
    pub(crate) name: String,
}

pub(crate) struct DraftLink {
    /// `None` if it is missing, which has been reported.
    pub(crate) name: Option<String>,
    pub(crate) at: At,
    pub(crate) inertial: Option<Inertial>,
    pub(crate) collision: Vec<Collision>,
    pub(crate) visual: Vec<Visual>,
}

pub(crate) struct DraftJoint {
    /// `None` if it is missing, which has been reported.
    pub(crate) name: Option<String>,
    pub(crate) at: At,
    /// `None` if it is missing or unknown, which has been reported.
    pub(crate) kind: Option<JointKind>,
    pub(crate) parent: Option<Reference>,
    pub(crate) child: Option<Reference>,
    pub(crate) origin: Origin,
    pub(crate) axis: [f64; 3],
    /// For a universal joint; zero otherwise.
    pub(crate) second_axis: [f64; 3],
    /// For a helical joint, m per revolution; zero otherwise.
    pub(crate) pitch: f64,
    pub(crate) mimic: Option<DraftMimic>,
    /// Further joints that it follows.
    pub(crate) also: Vec<DraftMimic>,
    pub(crate) limit: Option<Limit>,
    pub(crate) dynamics: JointDynamics,
}

/// A reference to the name of a link or joint.
pub(crate) struct Reference {
    pub(crate) name: String,
    pub(crate) at: At,
}

pub(crate) struct DraftMimic {
    pub(crate) leader: Reference,
    pub(crate) multiplier: Option<f64>,
    pub(crate) offset: Option<f64>,
}

impl DraftLink {
    pub(crate) fn subject(&self) -> Subject {
        Subject::Link(self.name.clone().unwrap_or_default())
    }
}

impl DraftJoint {
    pub(crate) fn subject(&self) -> Subject {
        Subject::Joint(self.name.clone().unwrap_or_default())
    }
}

/// Whether a joint has exactly one coordinate.
pub(crate) fn has_one_coordinate(kind: JointKind) -> bool {
    kind.sizes().0 == 1
}
