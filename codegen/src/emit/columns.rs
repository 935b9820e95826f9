//! M X = B for many columns, left a loop: four columns a vector, all vectors of a row in registers.
//!
//! Written out, the solution is two multiply-adds for each number of L and each column, which is most of the derivatives of forward dynamics. A function that leaves it a loop
//! writes B and the factors of M = Lᵀ D L into a place of its own, `out`, from which `columns` makes the result.
//!
//! The loop is that of `solve_rows` in `core/algorithm/ltdl.rs`, on vectors of columns; `tests/generated` holds it to that one on every robot.

use std::fmt::Write;

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
        *out += KERNEL;
    }
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |row| (0..n).map(move |column| (row, column)))
}

fn table(out: &mut String, name: &str, what: &str, rows: &[Vec<(usize, usize)>]) {
    let rows: Vec<String> = rows.iter().map(|row| format!("&{row:?}")).collect();
    let _ = writeln!(out, "/// {what}\nconst {name}: [&[(u16, u16)]; NV] = [\n    {},\n];", rows.join(",\n    "));
}

const KERNEL: &str = "
/// What is solved: B in vectors of four columns, D⁻¹, and L row by row.
#[repr(align(64))]
pub(super) struct Unsolved {
    pub(super) x: [[[[f64; 4]; TOGETHER * VECTORS]; NV]; 3 / TOGETHER],
    pub(super) d: [f64; NV],
    pub(super) l: [f64; ENTRIES],
}

impl Unsolved {
    /// Zeros, and the unit matrix for the third B.
    #[inline]
    pub(super) fn new() -> Self {
        let mut new = Self { x: [[[[0.0; 4]; TOGETHER * VECTORS]; NV]; 3 / TOGETHER], d: [0.0; NV], l: [0.0; ENTRIES] };
        let last = &mut new.x[3 / TOGETHER - 1];
        for i in 0..NV {
            last[i][(TOGETHER - 1) * VECTORS + i / 4][i % 4] = 1.0;
        }
        new
    }
}

macro_rules! solve {
    ($(#[$features:meta])?) => {
        $(#[$features])?
        fn solve(unsolved: &mut Unsolved) {
            let Unsolved { x, d, l } = unsolved;
            for x in x {
                // L⁻ᵀ, from the tips to the base.
                for i in (0..NV).rev() {
                    let mut row = [k(0.0); TOGETHER * VECTORS];
                    for b in 0..TOGETHER * VECTORS {
                        row[b] = load(&x[i][b]);
                    }
                    for &(j, at) in BEYOND[i] {
                        let (factor, other) = (k(l[at as usize]), &x[j as usize]);
                        for b in 0..TOGETHER * VECTORS {
                            row[b] = fnmadd(factor, load(&other[b]), row[b]);
                        }
                    }
                    for b in 0..TOGETHER * VECTORS {
                        store(row[b], &mut x[i][b]);
                    }
                }
                // L⁻¹ D⁻¹, from the base to the tips.
                for i in 0..NV {
                    let (factor, mut row) = (k(d[i]), [k(0.0); TOGETHER * VECTORS]);
                    for b in 0..TOGETHER * VECTORS {
                        row[b] = mul(factor, load(&x[i][b]));
                    }
                    for &(j, at) in BEFORE[i] {
                        let (factor, other) = (k(l[at as usize]), &x[j as usize]);
                        for b in 0..TOGETHER * VECTORS {
                            row[b] = fnmadd(factor, load(&other[b]), row[b]);
                        }
                    }
                    for b in 0..TOGETHER * VECTORS {
                        store(row[b], &mut x[i][b]);
                    }
                }
            }
        }
    };
}

/// X = M⁻¹ B of all three.
pub(super) fn columns(unsolved: &mut Unsolved, out: &mut [[[f64; NV]; NV]; 3]) {
    solve(unsolved);
    for (x, out) in unsolved.x.iter().zip(out.chunks_exact_mut(TOGETHER)) {
        for (m, out) in out.iter_mut().enumerate() {
            for (x, out) in x.iter().zip(out) {
                out.copy_from_slice(&x[m * VECTORS..][..VECTORS].as_flattened()[..NV]);
            }
        }
    }
}

fn solve(unsolved: &mut Unsolved) {
    #[cfg(target_arch = \"x86_64\")]
    {
        use super::avx2_f64x4::*;
        solve!(#[target_feature(enable = \"avx2,fma\")]);
        #[cfg(all(target_arch = \"x86_64\", not(all(target_feature = \"avx2\", target_feature = \"fma\"))))]
        if ::std::is_x86_feature_detected!(\"avx2\") && ::std::is_x86_feature_detected!(\"fma\") {
            // SAFETY: the processor was just asked for both.
            return unsafe { solve(unsolved) };
        }
        #[cfg(all(target_feature = \"avx2\", target_feature = \"fma\"))]
        // SAFETY: this is compiled for processors with both.
        return unsafe { solve(unsolved) };
    }
    #[cfg(target_arch = \"aarch64\")]
    {
        use super::neon_f64x4::*;
        solve!(#[target_feature(enable = \"neon\")]);
        // SAFETY: every 64-bit Arm processor has it.
        return unsafe { solve(unsolved) };
    }
    #[cfg(not(any(target_arch = \"aarch64\", all(target_arch = \"x86_64\", target_feature = \"avx2\", target_feature = \"fma\"))))]
    {
        use super::portable_f64x4::*;
        solve!();
        solve(unsolved)
    }
}
}

";
