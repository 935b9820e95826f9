//! Which functions may take which form of generated code.

use articulated_core::algorithm::{Argument, FunctionId};

/// A form of generated code that not every function takes. The first two keep the results and are
/// taken where they cost less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// Masses shifted to the body beyond a joint
    /// ([`crate::model_pass::View::with_shifted_masses`]): for what has an inverse dynamics in it
    /// in which bodies rotate, of which that takes numbers away.
    ShiftedMasses,
    /// Rate matrices by the axes of joints ([`crate::model_pass::View::with_axis_accelerations`]):
    /// for what has bodies that rotate while they move.
    AxisAccelerations,
    /// Statements from the last result on, not as they are traced: for matrices whose columns are
    /// carried side by side.
    FromTheLast,
}

impl Form {
    /// Whether a function takes it.
    pub(crate) fn fits(self, function: FunctionId) -> bool {
        use FunctionId as F;
        let row = function.row::<f64>();
        // At rest no body rotates.
        let moves = row.takes.contains(&Argument::V);
        match self {
            Self::ShiftedMasses => moves && matches!(row.general, F::inverse_dynamics_with_wrenches | F::forward_dynamics_with_wrenches),
            Self::AxisAccelerations => {
                moves
                    && matches!(
                        row.general,
                        F::inverse_dynamics_with_wrenches
                            | F::joint_wrenches
                            | F::forward_dynamics_with_wrenches
                            | F::center_of_mass_acceleration
                            | F::centroidal_momentum_rate
                            | F::forward_dynamics_derivatives_with_wrenches
                    )
            }
            Self::FromTheLast => matches!(function, F::mass_matrix | F::mass_matrix_inverse),
        }
    }
}
