//! From a position in a text to its line and column.

use articulated_core::diagnostic::At;

/// Starts of the lines of a text.
pub(crate) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
    /// Whether expressions of xacro in this text have errors of their own.
    pub(super) expressions_reported: bool,
    /// Whether the first one of repeated unique tags counts.
    pub(super) first_of_duplicates: bool,
    /// Of an expanded text: positions, in order, and the places that the text from there on comes
    /// from.
    origins: Vec<(usize, At)>,
}

impl<'a> Lines<'a> {
    pub(crate) fn of(text: &'a str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
        Self { text, starts, expressions_reported: false, first_of_duplicates: false, origins: Vec::new() }
    }

    /// For a text that was expanded from others: places are those of the source.
    /// `expressions_reported`: remaining expressions have errors of their own, and are not reported
    /// again as numbers.
    pub(crate) fn expanded(text: &'a str, origins: Vec<(usize, At)>, expressions_reported: bool) -> Self {
        Self { text, starts: vec![0], expressions_reported, first_of_duplicates: false, origins }
    }

    /// Sets whether the first one of repeated unique tags counts.
    pub(crate) fn with_first_of_duplicates(self, first_of_duplicates: bool) -> Self {
        Self { first_of_duplicates, ..self }
    }

    /// The place of a byte.
    pub(crate) fn at(&self, position: usize) -> At {
        if let Some(index) = self.origins.partition_point(|(start, _)| *start <= position).checked_sub(1) {
            return self.origins[index].1;
        }
        let line = self.starts.partition_point(|start| *start <= position).max(1);
        let start = self.starts[line - 1];
        // A line of many columns is not counted again for each of its tags.
        let column = if position - start.min(position) > LONGEST { 0 } else { self.characters(start, position) + 1 };
        At::Text { line: line as u32, column }
    }

    fn characters(&self, start: usize, end: usize) -> u32 {
        self.text.get(start..end).map_or(0, |text| text.chars().count() as u32)
    }

    /// The last line.
    pub(crate) fn last(&self) -> At {
        At::line_of(self.starts.len() as u32)
    }
}

/// Columns beyond this are not counted, bytes.
const LONGEST: usize = 1000;

/// The line of a byte of `bytes`, without an index.
pub(crate) fn line_of(bytes: &[u8], position: usize) -> At {
    At::line_of(bytes.iter().take(position).filter(|b| **b == b'\n').count() as u32 + 1)
}
