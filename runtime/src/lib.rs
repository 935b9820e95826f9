//! Robot dynamics, spelled out.
//!
//! `articulated` reads one robot's URDF when your crate is built and writes that robot's dynamics out as straight-line Rust
//! ([`robot!`], or a build script with the crate `articulated-codegen`). The same algorithms run here generically, on any robot loaded at run time
//! ([`load`], or [`describe`] to lock its joints, load it or append others first). Both sides implement the trait [`Dynamics`].
#![cfg_attr(not(feature = "std"), no_std)]

pub use articulated_core::algorithm::checked::{Factor, Singular, Solver, Unsolved, checked_forward_dynamics};
pub use articulated_core::algorithm::{self, FunctionError, FunctionId, Shape, Workspace, check_length, exactly, exactly_rows};
pub use articulated_core::description::{Base, Description, EditError, Origin, Payload};
pub use articulated_core::dynamics::Dynamics;
pub use articulated_core::model::{Model, ModelError};
pub use articulated_core::{Scalar, effect, monitor, spatial};

#[cfg(feature = "macros")]
pub use articulated_macros::robot;

#[cfg(feature = "std")]
pub mod simulate;

#[cfg(feature = "urdf")]
mod load;
#[cfg(feature = "urdf")]
pub use load::{LoadError, describe, describe_bytes, load, load_bytes};

#[cfg(feature = "rayon")]
mod threads;
#[cfg(feature = "rayon")]
pub use threads::{States, in_threads};
