//! Shared code of the tests of the workspace.
//!
//! Robots, states and yardsticks come from `articulated-test-support`; the laws of the core are
//! tests of the core (`runtime/core/tests/laws`). Generated code is compiled and run as a user's
//! program would be ([`program`]).

pub use articulated_test_support::{case, jet, measure, random, random_effects, random_limbs, random_tree, rigid, virtual_power};

pub mod answers;
pub mod batch_program;
pub mod c_program;
pub mod fixture;
pub mod golden;
pub mod machine;
pub mod program;

/// The examples of `README.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The examples of `docs/macro.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/macro.md")]
pub struct Macro;

/// The examples of `docs/library.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/library.md")]
pub struct Library;

/// The examples of `docs/batches.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/batches.md")]
pub struct Batches;

/// The examples of `docs/recipes.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/recipes.md")]
pub struct Recipes;

/// The examples of `docs/simulation.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/simulation.md")]
pub struct Simulation;

/// The examples of `docs/derivatives.md`, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/derivatives.md")]
pub struct Derivatives;

pub use articulated_formats::urdf::write as urdf_text;
