//! The functions to which each form of generated code applies.

use articulated_core::algorithm::{Argument, Function, FunctionId};

use crate::sym::Sym;

/// A form of generated code that applies to some functions only. The first two keep the results and
/// are taken where they cost less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// Masses shifted to the body beyond a joint
    /// ([`crate::model_pass::View::with_shifted_masses`]): for functions that contain an inverse
    /// dynamics with rotating bodies.
    ShiftedMasses,
    /// Rate matrices by the axes of joints ([`crate::model_pass::View::with_axis_accelerations`]):
    /// for functions with rotating bodies.
    AxisAccelerations,
    /// Statements ordered backwards from the last result, not as traced: for matrices whose columns
    /// are computed side by side.
    FromTheLast,
}

impl Form {
    /// Whether it applies to a function: to one that it consists of.
    pub(crate) fn fits(self, function: &Function<Sym>) -> bool {
        match function.contains {
            [] => self.fits_row(function.id),
            all => all.iter().any(|id| self.fits_row(*id)),
        }
    }

    fn fits_row(self, function: FunctionId) -> bool {
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
