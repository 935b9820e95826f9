//! Model passes: the generator's view of a robot, and its transforms before tracing.
//!
//! A [`View`] is a model and the [`Formulation`] that goes with it. Each pass keeps joint torques.
//! The passes of [`model_passes`] are always taken, in order; the others where they cost less:
//! [`View::with_shifted_masses`], [`View::with_axis_accelerations`],
//! [`View::fold_rotations_into_constants`], [`View::in_unit_of`].

mod axis_acceleration;
mod fold_rotations;
mod places;
mod shift_masses;
mod slide;
mod symmetric;
mod turn;
mod unit;
mod view;
mod zeros;

use std::marker::PhantomData;

use articulated_core::Scalar;
#[cfg(doc)]
use articulated_core::algorithm::{Formulation, Function};

pub use fold_rotations::FoldedRotations;
pub use slide::slide;
pub use symmetric::drop_symmetric_rotation;
pub use turn::turn;
pub use unit::no_joint_moves_origin;
pub use view::View;

/// A pass over views.
pub type ModelPass<S> = fn(View<S>) -> View<S>;

impl<S: Scalar> View<S> {
    /// The view after all passes of [`model_passes`].
    #[must_use]
    pub fn passed(self) -> Self {
        model_passes::<S>().iter().fold(self, |view, (_, pass, _)| pass(view))
    }
}

/// Base parameters: [`articulated_core::model::regroup`].
fn regroup<S: Scalar>(mut view: View<S>) -> View<S> {
    view.model = articulated_core::model::regroup(view.model);
    view
}

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
            "drop_symmetric_rotation",
            drop_symmetric_rotation,
            "frames of revolute bodies that are axisymmetric and carry nothing, not even a frame, do not turn",
        ),
    ];
}

/// The passes in order; each row: name, pass, and invariant after it. They keep joint torques and
/// the poses of link frames: functions of the table that need more are not [`Function::regrouped`].
/// For those that need no frames ([`Function::asks_for_frames`]), frames may be removed before.
pub fn model_passes<S: Scalar>() -> &'static [(&'static str, ModelPass<S>, &'static str)] {
    Table::<S>::ROWS
}
