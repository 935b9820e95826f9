//! M X = B for many columns, left a loop: four columns a vector, all vectors of a row in registers.
//!
//! Written out, the solution is two multiply-adds for each number of L and each column, which is most of the derivatives of forward dynamics. A function that leaves it a loop
//! writes B and the factors of M = Lᵀ D L into a place of its own, `out`, from which `columns` makes the result.
//!
//! The loop is core's text [`COLUMNS`], tested there; here it gets the tree's tables. `tests/generated` holds the two together to the generic library on every robot.

use std::fmt::Write;

use articulated_core::lanes::COLUMNS;

use crate::program::Columns;

/// Columns of a vector.
const LANES: usize = 4;

/// Up to this many vectors are in registers at once: all three matrices if they fit, or one after the other.
const TOGETHER: usize = 15;

/// How columns are laid out.
#[derive(Clone, Copy)]
pub(super) struct Layout<'a> {
    columns: &'a Columns,
}

impl<'a> Layout<'a> {
    pub(super) fn of(columns: &'a Columns) -> Self {
        Self { columns }
    }

    fn n(&self) -> usize {
        self.columns.ways.len()
    }

    /// Vectors of a row of one matrix.
    fn vectors(&self) -> usize {
        self.n().div_ceil(LANES)
    }

    /// Matrices that are solved for at once.
    fn together(&self) -> usize {
        if 3 * self.vectors() <= TOGETHER { 3 } else { 1 }
    }

    /// Where each number of the `[3][nv][nv]` that the unsolved function gives stands in `out`.
    pub(super) fn places(&self) -> Vec<String> {
        let (n, together) = (self.n(), self.together());
        let mut places = Vec::with_capacity(3 * n * n);
        for matrix in 0..2 {
            for (row, column) in pairs(n) {
                let vector = matrix % together * self.vectors() + column / LANES;
                places.push(format!("out.x[{}][{row}][{vector}][{}]", matrix / together, column % LANES));
            }
        }
        let starts = self.starts();
        for (row, column) in pairs(n) {
            let on_the_way = self.columns.ways[row].iter().position(|i| *i == column);
            places.push(match on_the_way {
                _ if row == column => format!("out.d[{row}]"),
                // Zeros are not written.
                None => String::new(),
                Some(k) => format!("out.l[{}]", starts[row] + k),
            });
        }
        places
    }

    /// Where the numbers of each row of L begin.
    fn starts(&self) -> Vec<usize> {
        let sums = self.columns.ways.iter().scan(0, |next, way| {
            *next += way.len();
            Some(*next - way.len())
        });
        sums.collect()
    }

    /// The type of `out`, how the tree stands, and the function `columns`.
    pub(super) fn module(&self, out: &mut String) {
        let (ways, starts) = (&self.columns.ways, self.starts());
        let before: Vec<Vec<(usize, usize)>> =
            ways.iter().zip(&starts).map(|(way, start)| way.iter().enumerate().map(|(k, i)| (*i, start + k)).collect()).collect();
        let beyond: Vec<Vec<(usize, usize)>> = (0..self.n())
            .map(|i| before.iter().enumerate().flat_map(|(k, row)| row.iter().filter(|e| e.0 == i).map(move |e| (k, e.1))).collect())
            .collect();
        let numbers = [
            ("VECTORS", "Vectors of a row of one matrix.", self.vectors()),
            ("TOGETHER", "Matrices that are solved for at once.", self.together()),
            ("ENTRIES", "Numbers of L off the diagonal.", ways.iter().map(Vec::len).sum()),
        ];
        let _ = writeln!(out, "/// M X = B for all columns of three matrices, by M = Lᵀ D L; Featherstone 2008, §6.5.");
        let _ = writeln!(
            out,
            "#[allow(unsafe_code, unused_unsafe, dead_code, clippy::all, clippy::pedantic)]\nmod columns {{\n#[allow(unused_imports)]\nuse ::core::iter::Iterator;\n\nuse super::NV;\n"
        );
        for (name, what, value) in numbers {
            let _ = writeln!(out, "/// {what}\nconst {name}: usize = {value};");
        }
        table(out, "BEFORE", "For each row of L: the column of each number and its place.", &before);
        table(out, "BEYOND", "For each column of L: the row of each number and its place.", &beyond);
        let _ = writeln!(out, "\n{COLUMNS}}}\n");
    }
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |row| (0..n).map(move |column| (row, column)))
}

fn table(out: &mut String, name: &str, what: &str, rows: &[Vec<(usize, usize)>]) {
    let rows: Vec<String> = rows.iter().map(|row| format!("&{row:?}")).collect();
    let _ = writeln!(out, "/// {what}\nconst {name}: [&[(u16, u16)]; NV] = [\n    {},\n];", rows.join(",\n    "));
}
