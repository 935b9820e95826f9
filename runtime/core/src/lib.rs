//! Robot dynamics over any scalar.
//!
//! Every algorithm of `articulated` is written here, once, over the trait [`Scalar`]. With `f64` it
//! is the generic run-time library. With a symbol it is the program that the generator writes. With
//! a big float it is the reference.
//!
//! Start with three names. A [`Description`](description::Description) has links and joints, as a
//! reader returns it or a program writes it. [`Model::new`](model::Model::new) makes the model. The
//! functions of [`Dynamics`](dynamics::Dynamics) compute:
//!
//! ```
//! use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link};
//! use articulated_core::description::{LinkId, Origin};
//! use articulated_core::dynamics::Dynamics;
//! use articulated_core::model::Model;
//!
//! // A bob of 2 kg on a rod of 0.5 m.
//! let bob = Inertial { origin: Origin::new([0.0, 0.0, -0.5], [0.0; 3]), mass: 2.0, inertia: [0.0; 6] };
//! let pendulum = Description {
//!     name: "pendulum".into(),
//!     links: [
//!         Link { name: "base".into(), ..Link::default() },
//!         Link { name: "bob".into(), inertial: Some(bob), ..Link::default() },
//!     ]
//!     .into(),
//!     joints: [Joint {
//!         name: "swing".into(),
//!         kind: JointKind::Continuous,
//!         parent: LinkId(0),
//!         child: LinkId(1),
//!         axis: [0.0, 1.0, 0.0],
//!         ..Joint::default()
//!     }]
//!     .into(),
//!     frames: vec![],
//! };
//! let model = Model::new(&pendulum, Base::Fixed)?;
//! let mut ws = model.workspace();
//! let (mut tau, mut a) = ([0.0], [0.0]);
//! model.inverse_dynamics(&mut ws, &[0.5], &[0.0], &[1.0], &mut tau)?; // q, v, a → τ, N·m
//! assert!((tau[0] - (2.0 * 0.25 + 2.0 * 9.81 * 0.5 * 0.5_f64.sin())).abs() < 1e-14);
//! model.forward_dynamics(&mut ws, &[0.5], &[0.0], &tau, &mut a)?; // q, v, τ → a, rad/s²
//! assert!((a[0] - 1.0).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Conventions: 6-vectors are (angular; linear). Algorithms work in body coordinates. Units are SI
//! units and radians. Gravity defaults to (0, 0, −9.81) m/s² in the world frame, which is the root
//! link's frame (fixed base) or the frame in which it floats.
//!
//! The crate is `no_std`. Models and algorithms need the feature `alloc`; `std` uses the platform's
//! mathematics.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "alloc")]
pub mod actuator;
pub mod dual;
pub mod eigen;
#[cfg(feature = "alloc")]
pub mod region;
pub mod running;
pub mod scalar;
pub mod spatial;

#[cfg(feature = "alloc")]
pub mod algorithm;
#[cfg(feature = "alloc")]
pub mod collision;
#[cfg(feature = "alloc")]
pub mod constraint;
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
pub mod index;
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
pub mod step;
#[cfg(feature = "alloc")]
pub mod suggest;

pub use nalgebra;
#[cfg(feature = "alloc")]
pub use plain::{MOST_LISTED, Plain, listed};
pub use scalar::Scalar;
