//! How bodies move: columns of J, and twists.

use crate::index::{BodyId, ById};
use crate::spatial::Twist;

/// A column of J of all bodies beyond a joint.
pub(super) struct Column<S> {
    pub(super) body: BodyId,
    pub(super) at: usize,
    pub(super) axis: Twist<S>,
}

/// The twists of bodies.
pub(super) type Twists<S> = ById<BodyId, Twist<S>>;
