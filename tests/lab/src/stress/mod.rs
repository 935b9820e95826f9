//! Cases that break dynamics software, measured.
//!
//! For tests: [`corpus::CHAPTERS`], each a list of [`row::Row`]s with a limit that each has to
//! keep.

mod condition;
pub mod corpus;
pub mod judge;
pub mod levels;
pub mod machine;
mod report;
pub mod robots;
pub mod row;
mod text;
pub mod user_robot;

pub use report::{Report, Settings, chapters, of_corpus, of_robot};

impl Report {
    /// As tables: every row, or the one of each case that comes nearest to its limit.
    pub fn text(&self, every: bool) -> String {
        text::text(self, every)
    }
}
