//! The corpus: chapters of hard cases.

mod axes;
mod chains;
mod inertias;
mod masses;
mod motions;
mod passes;
mod scaling;
mod screws;
mod stiff;
mod turns;

use super::row::Row;

/// The part of a chapter to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Sampled: seconds.
    Quick,
    /// All of it: minutes.
    Full,
}

/// A chapter: its name, and its rows.
pub type Chapter = (&'static str, fn(Effort) -> Vec<Row>);

/// All chapters.
pub const CHAPTERS: &[Chapter] = &[
    (chains::NAME, chains::rows),
    (masses::NAME, masses::rows),
    (inertias::NAME, inertias::rows),
    (scaling::NAME, scaling::rows),
    (axes::NAME, axes::rows),
    (screws::NAME, screws::rows),
    (turns::NAME, turns::rows),
    (passes::NAME, passes::rows),
    (stiff::NAME, stiff::rows),
    (motions::NAME, motions::rows),
];
