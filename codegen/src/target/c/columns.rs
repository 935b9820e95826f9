//! M X = B for many columns as a loop, as in Rust: [`articulated_core::lanes::COLUMNS`].
//!
//! The loops over columns have a constant length, a multiple of eight, so that compilers make
//! vectors of them.

use std::fmt::Write;

use crate::program::MultiRhsSolve;

/// The function `PREFIX_columns`.
pub(super) fn text(prefix: &str, linkage: &str, columns: &MultiRhsSolve) -> String {
    let n = columns.ways.len();
    let beyond: Vec<Vec<usize>> = (0..n).map(|i| (0..n).filter(|&k| columns.ways[k].contains(&i)).collect()).collect();
    let mut tables = String::new();
    for (name, what, rows) in [
        ("before", "For each row of L the columns of its numbers.", &columns.ways),
        ("beyond", "For each column of L the rows of its numbers.", &beyond),
    ] {
        let all: Vec<String> = rows.iter().flatten().map(usize::to_string).collect();
        let starts: Vec<String> = (0..=n).map(|i| rows[..i].iter().map(Vec::len).sum::<usize>().to_string()).collect();
        // C has no arrays of length zero.
        let numbers = if all.is_empty() { "0".to_owned() } else { all.join(", ") };
        let _ = writeln!(tables, "    /* {what} */\n    static const unsigned short {name}[] = {{{numbers}}};");
        let _ = writeln!(tables, "    static const unsigned short {name}_at[{}] = {{{}}};", n + 1, starts.join(", "));
    }
    let text = TEXT.replace("@TABLES", &tables).replace("@LINKAGE", linkage).replace("@P", prefix);
    text.replace("@N", &n.to_string()).replace("@W", &(3 * n).next_multiple_of(8).to_string())
}

const TEXT: &str = "\
/* -M^-1 B in the place of both B, and M^-1 in that of the factors of M = L^T D L: the third matrix
   has L below the diagonal and D^-1 on it. Featherstone 2008, section 6.5. */
@LINKAGE void @P_columns(double *out) {
@TABLES    const double *l = out + 2 * @N * @N;
    /* Rows of both -B and of the unit matrix, side by side. */
    double x[@N][@W];
    for (int i = 0; i < @N; i++) {
        for (int k = 0; k < @W; k++) {
            x[i][k] = 0;
        }
        for (int k = 0; k < @N; k++) {
            x[i][k] = -out[i * @N + k];
            x[i][@N + k] = -out[(@N + i) * @N + k];
        }
        x[i][2 * @N + i] = 1;
    }
    /* L^-T, from the tips to the base. */
    for (int i = @N - 1; i >= 0; i--) {
        for (int s = beyond_at[i]; s < beyond_at[i + 1]; s++) {
            const int j = beyond[s];
            const double factor = l[j * @N + i];
            for (int k = 0; k < @W; k++) {
                x[i][k] -= factor * x[j][k];
            }
        }
    }
    /* L^-1 D^-1, from the base to the tips. */
    for (int i = 0; i < @N; i++) {
        const double scale = l[i * @N + i];
        for (int k = 0; k < @W; k++) {
            x[i][k] *= scale;
        }
        for (int s = before_at[i]; s < before_at[i + 1]; s++) {
            const int j = before[s];
            const double factor = l[i * @N + j];
            for (int k = 0; k < @W; k++) {
                x[i][k] -= factor * x[j][k];
            }
        }
    }
    for (int m = 0; m < 3; m++) {
        for (int i = 0; i < @N; i++) {
            for (int k = 0; k < @N; k++) {
                out[(m * @N + i) * @N + k] = x[i][m * @N + k];
            }
        }
    }
}

";
