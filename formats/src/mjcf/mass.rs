//! The mass of a body or a geom, with its centre and its inertia.

use articulated_core::description::Inertial;

use super::axes;
use crate::pose::{Pose, Quaternion, Symmetric};

/// MuJoCo refuses moving bodies with less mass, kg, or smaller moments of inertia, kg·m².
const LEAST: f64 = 1e-15;

/// A mass, kg, with its centre and its inertia about it, in the frame of its body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mass {
    pub(crate) pose: Pose,
    pub(crate) mass: f64,
    /// In the axes of the pose.
    pub(crate) inertia: Symmetric,
    /// The rotation from the pose to the principal axes, if it is not that of the inertia.
    pub(crate) axes: Option<Quaternion>,
}

impl Mass {
    /// As a description has it.
    pub(crate) fn inertial(&self) -> Inertial {
        Inertial { origin: self.pose.origin(), mass: self.mass, inertia: self.inertia }
    }

    /// Whether MuJoCo accepts it for a moving body.
    pub(crate) fn can_move(&self) -> bool {
        let (moments, _) = axes::principal(self.inertia);
        self.mass >= LEAST && moments.iter().all(|moment| *moment >= LEAST)
    }
}
