//! M X = B for many columns as a loop: four columns per vector, all vectors of a row in registers.
//!
//! Written out, the solution is two multiply-adds for each number of L and each column, which is
//! most of the derivatives of forward dynamics. A function with the loop writes B and the factors
//! of M = Lᵀ D L into the memory of the result, which `columns` computes from them.
//!
//! The loop is core's text [`COLUMNS`], tested there; here it gets the tree's tables.
//! `tests/generated` compares the two together with the generic library on every robot.

use std::fmt::Write;

use articulated_core::lanes::COLUMNS;

use crate::program::MultiRhsSolve;

/// Columns of a vector, and vectors of a row of one matrix with which all three matrices are solved
/// for at once: with fewer, one after the other is faster (up to a tenth of the whole function),
/// with more, the vectors of a row are more than there are registers, or slower on one processor
/// (five of eight: Emerald Rapids 8 %) than they are faster on another (Zen 5: 3 %).
const ALL_AT_ONCE: [(usize, std::ops::RangeInclusive<usize>); 2] = [(4, 3..=5), (8, 1..=3)];

/// How columns are laid out.
pub(crate) struct Layout<'a> {
    columns: &'a MultiRhsSolve,
}

impl<'a> Layout<'a> {
    pub(crate) fn of(columns: &'a MultiRhsSolve) -> Self {
        Self { columns }
    }

    fn n(&self) -> usize {
        self.columns.ways.len()
    }

    /// Matrices that are solved for at once, in vectors of four columns and of eight.
    fn together(&self) -> [usize; 2] {
        ALL_AT_ONCE.map(|(lanes, vectors)| if vectors.contains(&self.n().div_ceil(lanes)) { 3 } else { 1 })
    }

    /// The tables of the tree, and the function `columns`.
    pub(crate) fn module(&self, out: &mut String) {
        let before = &self.columns.ways;
        let beyond: Vec<Vec<usize>> = (0..self.n()).map(|i| (0..self.n()).filter(|&k| before[k].contains(&i)).collect()).collect();
        let _ = writeln!(out, "/// M X = B for all columns of three matrices, by M = Lᵀ D L; Featherstone 2008, §6.5.");
        let _ = writeln!(
            out,
            "#[allow(unsafe_code, unused_unsafe, dead_code, unused_results, clippy::all, clippy::pedantic)]\nmod columns {{\n#[allow(unused_imports)]\nuse ::core::iter::Iterator;\n\nuse super::NV;\n"
        );
        let _ = writeln!(
            out,
            "/// Matrices that are solved for at once, in vectors of four columns and of eight.\nconst TOGETHER: [usize; 2] = {:?};",
            self.together()
        );
        table(out, "BEFORE", "For each row of L the columns of its numbers.", before);
        table(out, "BEYOND", "For each column of L the rows of its numbers.", &beyond);
        let _ = writeln!(out, "\n{COLUMNS}}}\n");
    }
}

fn table(out: &mut String, name: &str, what: &str, rows: &[Vec<usize>]) {
    let rows: Vec<String> = rows.iter().map(|row| format!("&{row:?}")).collect();
    let _ = writeln!(out, "/// {what}\nconst {name}: [&[u16]; NV] = [\n    {},\n];", rows.join(",\n    "));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_has_its_columns_and_each_column_its_rows() {
        // A fork: two ways of different lengths to one base.
        let columns = MultiRhsSolve { ways: vec![vec![], vec![0], vec![1, 0], vec![0], vec![3, 0]] };
        let mut out = String::new();
        Layout::of(&columns).module(&mut out);
        let table = |name: &str| -> String {
            let (_, rest) = out.split_once(&format!("const {name}: [&[u16]; NV] = [")).unwrap();
            rest.split_once("];").unwrap().0.split_whitespace().collect()
        };
        assert_eq!(table("BEFORE"), "&[],&[0],&[1,0],&[0],&[3,0],");
        assert_eq!(table("BEYOND"), "&[1,2,3,4],&[2],&[],&[4],&[],");
        assert!(out.contains("const TOGETHER: [usize; 2] = [1, 3];"));
        // All three matrices where each has three to five vectors of four, and up to three of
        // eight.
        for (n, together) in [(8, [1, 3]), (9, [3, 3]), (20, [3, 3]), (21, [1, 3]), (24, [1, 3]), (25, [1, 1])] {
            assert_eq!(Layout::of(&MultiRhsSolve { ways: vec![vec![]; n] }).together(), together, "{n}");
        }
    }
}
