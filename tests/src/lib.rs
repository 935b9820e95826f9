//! What the tests of the workspace share.
//!
//! Robots, states and yardsticks come from `articulated-test-support`; the laws of the core are tests of the core
//! (`runtime/core/tests/laws`). Generated code is compiled and run as a user's program would be ([`program`]).

pub use articulated_test_support::{case, jet, measure, random, random_effects, random_limbs, random_tree, rigid, virtual_power};

pub mod answers;
pub mod batch_program;
pub mod c_program;
pub mod fixture;
pub mod golden;
pub mod machine;
pub mod program;

/// The README's examples, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The recipes of `docs/conventions.md`.
#[cfg(doctest)]
#[doc = include_str!("../../docs/conventions.md")]
pub struct Recipes;

pub use articulated_formats::urdf::write as urdf_text;
