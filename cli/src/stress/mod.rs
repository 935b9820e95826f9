//! `articulated stress`: cases that break dynamics software, measured.
//!
//! For tests: [`corpus::CHAPTERS`], each a list of [`row::Row`]s with a limit that each has to keep.

pub mod corpus;
pub mod judge;
pub mod machine;
pub mod robots;
pub mod row;
mod terms;
pub mod urdf_text;
