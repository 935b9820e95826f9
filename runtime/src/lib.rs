//! Robot dynamics as straight-line code, and the same algorithms as a library.
//!
//! Start with one of these three:
//!
//! | you have | call | you get |
//! |---|---|---|
//! | a robot that is known when the crate is built | [`robot!`] | a module with one function for each name in `functions` |
//! | a robot that is loaded at run time | [`load`], or [`describe`] to edit it first | a [`Model`] with all functions of [`Dynamics`] |
//! | either of them, and a motion | [`simulate::Simulation`] | a recording of q, v and energies |
//!
//! The macro. A build script with the crate `articulated-codegen` generates the same code:
//!
//! ```
//! articulated::robot! {
//!     pub mod arm {
//!         urdf = "tests/simulate/urdf/chain.urdf", // from the folder of Cargo.toml
//!         functions = [inverse_dynamics],
//!     }
//! }
//!
//! let tau: [f64; arm::NV] = arm::inverse_dynamics(&[0.1; arm::NQ], &[0.0; arm::NV], &[0.0; arm::NV]); // N·m
//! assert!(tau.iter().all(|tau| tau.is_finite()));
//! ```
//!
//! The library. A workspace is made once, and results are written into a slice:
//!
//! ```
//! use articulated::{Base, Dynamics};
//!
//! let urdf = r#"<robot name="pendulum"><link name="base"/><link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
//!     <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
//!     <joint name="swing" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;
//! let model = articulated::load_bytes("pendulum.urdf", urdf.as_bytes(), Base::Fixed)?;
//! let (mut ws, mut tau) = (model.workspace(), [0.0]);
//! model.gravity_torque(&mut ws, &[0.5], &mut tau)?;
//! assert!((tau[0] - 2.0 * 9.81 * 0.5 * 0.5_f64.sin()).abs() < 1e-14); // N·m
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The module [`simulate`] begins with an example of a simulation. Generated robots and models
//! implement the trait [`Dynamics`], so a function over that trait accepts both.
//!
//! Conventions: SI units and radians. Vectors of six are (angular; linear). Joints are ordered
//! depth-first in the file's order; names are in [`Model::joints`]. A floating base comes first: of
//! q its position and quaternion (x, y, z, w); of v, a and τ its [ω; v], their rates, and [m; f],
//! all in its own axes. Matrices are written row by row. Gravity is (0, 0, −9.81) m/s² in the world
//! frame unless [`Model::with_gravity`] changes it.
#![cfg_attr(not(feature = "std"), no_std)]

pub use articulated_core::algorithm::checked::{Factor, Singular, Solver, Unsolved, checked_forward_dynamics};
pub use articulated_core::algorithm::{
    self, FunctionError, FunctionId, Shape, Workspace, check_count, check_length, exactly, exactly_rows,
};
pub use articulated_core::description::{self, Base, Description, EditError, JointKind, Limit, Origin, Payload};
pub use articulated_core::dynamics::Dynamics;
pub use articulated_core::model::{self, JointRow, Model, ModelError};
pub use articulated_core::{Scalar, effect, monitor, nalgebra, spatial};

#[cfg(feature = "macros")]
pub use articulated_macros::robot;

#[cfg(feature = "std")]
pub mod simulate;

#[cfg(feature = "formats")]
mod load;
/// The readers of robot files, with their warnings and options.
#[cfg(feature = "formats")]
pub use articulated_formats as formats;
#[cfg(feature = "formats")]
pub use load::{LoadError, describe, describe_bytes, load, load_bytes};

#[cfg(feature = "rayon")]
mod threads;
#[cfg(feature = "rayon")]
pub use threads::{States, in_threads};
