//! Shared code of the tests of the crates.
//!
//! Laws need three things: random robots ([`random_tree`], with [`random_effects`]), a reference
//! that shares no formula with the library ([`virtual_power`], and the textbook form in big
//! floats), and a scale for rounding errors ([`measure`]).
//!
//! The crate depends only on the core, the reference and the reader: the laws of the core are tests
//! of the core.

pub mod case;
pub mod every_function;
pub mod jet;
pub mod measure;
pub mod random;
pub mod random_effects;
pub mod random_limbs;
pub mod random_tree;
pub mod regressors;
pub mod rigid;
pub mod virtual_power;
