//! From a position in the text to its line.

/// Where the lines of a text end.
pub(crate) struct Lines {
    ends: Vec<usize>,
}

impl Lines {
    pub(crate) fn of(text: &str) -> Self {
        Self { ends: text.match_indices('\n').map(|(i, _)| i).collect() }
    }

    /// The line of a byte, from 1.
    pub(crate) fn at(&self, position: usize) -> u32 {
        self.ends.partition_point(|end| *end < position) as u32 + 1
    }

    /// The last line.
    pub(crate) fn last(&self) -> u32 {
        self.at(usize::MAX)
    }
}

/// The line of a byte of `bytes`, from 1, without an index.
pub(crate) fn line_of(bytes: &[u8], position: usize) -> u32 {
    bytes.iter().take(position).filter(|b| **b == b'\n').count() as u32 + 1
}
