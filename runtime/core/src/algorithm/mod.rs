//! The algorithms, each written once over the scalar, and the table of the functions that they give.

mod crba;
mod forward_dynamics;
mod kinematics;
mod registry;
mod rnea;
pub mod textbook;
mod workspace;

pub use crba::mass_matrix;
pub use forward_dynamics::forward_dynamics;
pub use kinematics::placements;
pub use registry::{Argument, Function, FunctionError, ResultKind, Shape, function, functions};
pub use registry::{check_length, exactly};
pub use rnea::{bias_forces, gravity_torque, inverse_dynamics};
pub use workspace::Workspace;
