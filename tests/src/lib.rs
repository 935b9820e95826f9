//! What the tests of the workspace share.
//!
//! Laws need three things: robots that nobody thought of ([`random_tree`]), a right answer that shares no formula with what is
//! tested ([`virtual_power`], and the textbook form in big floats), and a yardstick for rounding errors ([`measure`]). Generated code is
//! compiled and run as a user's program would be ([`program`]). The laws themselves are in `tests/`.

pub mod answers;
pub mod batch_program;
pub mod case;
pub mod fixture;
pub mod golden;
pub mod jet;
pub mod machine;
pub mod measure;
pub mod program;
pub mod random;
pub mod random_effects;
pub mod random_limbs;
pub mod random_tree;
pub mod rigid;
pub mod virtual_power;

/// The README's examples, compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The recipes of `docs/conventions.md`.
#[cfg(doctest)]
#[doc = include_str!("../../docs/conventions.md")]
pub struct Recipes;

pub use articulated_cli::stress::urdf_text;
