//! Robot dynamics over any scalar.
//!
//! Every algorithm of `articulated` is written here, once, over the trait [`Scalar`]. With `f64` it is the generic run-time
//! library; with a symbol it is the program that the generator writes out; with a big float it is the reference.
//!
//! Conventions: 6-vectors are (angular; linear); algorithms work in body coordinates; SI units and radians; gravity defaults to
//! (0, 0, −9.81) m/s² in the world frame, which is the root link's frame (fixed base) or the frame it floats in.
//!
//! The crate is `no_std`. Models and algorithms need the feature `alloc`; `std` uses the platform's mathematics.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod dual;
pub mod eigen;
pub mod running;
pub mod scalar;
pub mod spatial;

#[cfg(feature = "alloc")]
pub mod algorithm;
#[cfg(feature = "alloc")]
pub mod control;
#[cfg(feature = "alloc")]
pub mod description;
#[cfg(feature = "alloc")]
pub mod diagnostic;
#[cfg(feature = "alloc")]
pub mod dynamics;
#[cfg(feature = "alloc")]
pub mod effect;
#[cfg(feature = "alloc")]
pub mod integrator;
pub mod joint;
#[cfg(feature = "alloc")]
pub mod lanes;
#[cfg(feature = "alloc")]
pub mod model;
#[cfg(feature = "alloc")]
pub mod monitor;
#[cfg(feature = "alloc")]
mod plain;
#[cfg(feature = "alloc")]
pub mod precision;
#[cfg(feature = "alloc")]
pub mod settings;
#[cfg(feature = "alloc")]
pub mod suggest;

pub use nalgebra;
#[cfg(feature = "alloc")]
pub use plain::{MOST_LISTED, Plain, listed};
pub use scalar::Scalar;
