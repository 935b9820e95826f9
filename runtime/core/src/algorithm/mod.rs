//! The algorithms, each written once over the scalar, and the table of the functions that they give.

mod kinematics;
mod registry;
mod rnea;
pub mod textbook;
mod workspace;

pub use kinematics::placements;
pub(crate) use registry::check as check_length;
pub use registry::{Argument, Function, FunctionError, ResultKind, Shape, function, functions};
pub use rnea::{bias_forces, gravity_torque, inverse_dynamics};
pub use workspace::Workspace;
