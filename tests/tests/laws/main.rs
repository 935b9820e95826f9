//! Answers of other engines, and robots at random that go through a file. The laws of the core are
//! tests of the core.

mod effects_fixtures;
mod fixtures;
mod interface;
mod random_trees;
mod regressors;
