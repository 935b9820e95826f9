//! `articulated stress`: cases that break dynamics software, measured.
//!
//! For tests: [`corpus::CHAPTERS`], each a list of [`row::Row`]s with a limit that each has to keep.

pub(crate) mod arguments;
mod command;
mod condition;
pub mod corpus;
pub mod judge;
pub mod levels;
pub mod machine;
pub mod own;
pub mod robots;
pub mod row;
mod text;

pub(crate) use command::run;
