//! Model passes: `Model → Model`, keeping the physics.

mod places;
mod slide;
mod still;
mod turn;
mod zeros;

use core::marker::PhantomData;

pub(super) use slide::counts_an_offset;
pub use slide::slide;
pub use still::still;
pub use turn::turn;
pub(super) use zeros::within;

use super::{Model, regroup};
use crate::Scalar;

/// A pass over models.
pub type ModelPass<S> = fn(Model<S>) -> Model<S>;

struct Table<S>(PhantomData<S>);

impl<S: Scalar> Table<S> {
    const ROWS: &'static [(&'static str, ModelPass<S>, &'static str)] = &[
        (
            "turn",
            turn,
            "frames of revolute bodies are turned about their axes to where rotations have zeros, and angles counted from there; frames of links are where they were",
        ),
        (
            "regroup",
            regroup,
            "no revolute body has m, h_z or Σ_zz, no prismatic body has Σ, no spherical body has m: its parent has them; joint torques are the same, wrenches between bodies are not",
        ),
        (
            "slide",
            slide,
            "frames of revolute and prismatic bodies are where offsets and moments are fewest, along their axes; frames of links are where they were, bodies' own origins are not those of their links",
        ),
        (
            "still",
            still,
            "frames of revolute bodies that are the same from all sides about their axes and carry nothing, not even a frame, do not turn",
        ),
    ];
}

/// The passes in order; each row: name, pass, and what holds after it. They keep joint torques, and where the frames of links are: functions of the table that need more are not
/// [`crate::algorithm::Function::regrouped`]. For those that do not even ask for frames ([`crate::algorithm::Function::asks_for_frames`]) these may be taken away before.
pub fn model_passes<S: Scalar>() -> &'static [(&'static str, ModelPass<S>, &'static str)] {
    Table::<S>::ROWS
}
