//! M X = B for many columns as a loop, as in Rust: [`articulated_core::lanes::COLUMNS`].
//!
//! Four vectors of columns stay in registers while a row takes its share of the others.

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
    let text = TEXT.replace("@TABLES", &tables).replace("@LINKAGE", linkage).replace("@N", &n.to_string());
    text.replace("@P_", &format!("{prefix}_")).replace("@U_", &format!("{}_", prefix.to_ascii_uppercase()))
}

pub(super) const TEXT: &str = "\
/* Columns side by side, as many as a vector has doubles. */
#if @U_VECTOR
typedef double @P_columns_v __attribute__((vector_size(@U_VECTOR)));
#define @U_COLUMNS (@U_VECTOR / 8)
#else
typedef double @P_columns_v;
#define @U_COLUMNS 1
#endif
/* Vectors of a row: of both B and of the unit matrix, side by side. */
#define @U_ROW ((3 * @N + @U_COLUMNS - 1) / @U_COLUMNS)
/* Row i = scale * row i - the sum of factor * row j over all j of the list. */
@LINKAGE void @P_columns_row(@P_columns_v x[@N][@U_ROW], int i, double scale, const unsigned short *rows, const double *factors, int count) {
    int k = 0;
    for (; k + 4 <= @U_ROW; k += 4) {
        @P_columns_v a = x[i][k] * scale, b = x[i][k + 1] * scale, c = x[i][k + 2] * scale, d = x[i][k + 3] * scale;
        for (int s = 0; s < count; s++) {
            const @P_columns_v *y = x[rows[s]] + k;
            a -= y[0] * factors[s];
            b -= y[1] * factors[s];
            c -= y[2] * factors[s];
            d -= y[3] * factors[s];
        }
        x[i][k] = a;
        x[i][k + 1] = b;
        x[i][k + 2] = c;
        x[i][k + 3] = d;
    }
    for (; k < @U_ROW; k++) {
        @P_columns_v a = x[i][k] * scale;
        for (int s = 0; s < count; s++) {
            a -= x[rows[s]][k] * factors[s];
        }
        x[i][k] = a;
    }
}

/* -M^-1 B in the place of both B, and M^-1 in that of the factors of M = L^T D L: the third matrix
   has L below the diagonal and D^-1 on it. Featherstone 2008, section 6.5. */
@LINKAGE void @P_columns(double *out) {
@TABLES    const double *l = out + 2 * @N * @N;
    union { @P_columns_v vectors[@N][@U_ROW]; double numbers[@N][@U_ROW * @U_COLUMNS]; } x;
    double factors[@N];
    for (int i = 0; i < @N; i++) {
        double *row = x.numbers[i];
        for (int k = 0; k < @N; k++) {
            row[k] = -out[i * @N + k];
            row[@N + k] = -out[(@N + i) * @N + k];
        }
        for (int k = 2 * @N; k < @U_ROW * @U_COLUMNS; k++) {
            row[k] = 0;
        }
        row[2 * @N + i] = 1;
    }
    /* L^-T, from the tips to the base. */
    for (int i = @N - 1; i >= 0; i--) {
        const unsigned short *rows = beyond + beyond_at[i];
        const int count = beyond_at[i + 1] - beyond_at[i];
        for (int s = 0; s < count; s++) {
            factors[s] = l[rows[s] * @N + i];
        }
        @P_columns_row(x.vectors, i, 1, rows, factors, count);
    }
    /* L^-1 D^-1, from the base to the tips. */
    for (int i = 0; i < @N; i++) {
        const unsigned short *rows = before + before_at[i];
        const int count = before_at[i + 1] - before_at[i];
        for (int s = 0; s < count; s++) {
            factors[s] = l[i * @N + rows[s]];
        }
        @P_columns_row(x.vectors, i, l[i * @N + i], rows, factors, count);
    }
    for (int m = 0; m < 3; m++) {
        for (int i = 0; i < @N; i++) {
            for (int k = 0; k < @N; k++) {
                out[(m * @N + i) * @N + k] = x.numbers[i][m * @N + k];
            }
        }
    }
}

";
