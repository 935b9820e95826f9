//! Zeros of large results: a few side by side by one statement each, between the statements that compute. To fill a whole matrix beforehand takes as long as a third of the humanoid's mass matrix, since a
//! processor does nothing else meanwhile; single stores have time while sums wait for their terms.

use crate::emit::function::results::ZERO;
use crate::emit::statements::dialect::Dialect;
use crate::graph::Graph;

/// So many numbers at once are written in place; more would be a call.
const MOST: usize = 16;

/// The statements that write the zeros of a result whose numbers have these places, as far as they are read.
pub(crate) fn statements(graph: &Graph, dialect: &dyn Dialect, places: &[String], read: impl Fn(usize) -> bool) -> Vec<String> {
    let zeros = (0..places.len()).filter(|&k| read(k) && dialect.number(graph.outputs[k]) == ZERO).map(|k| places[k].as_str());
    runs(zeros).iter().map(Run::statement).collect()
}

/// Zeros side by side.
enum Run<'a> {
    /// So many in a row of an array from a column on.
    Row { row: &'a str, start: usize, count: usize },
    /// One that is in no array.
    Alone(&'a str),
}

impl<'a> Run<'a> {
    fn of(place: &'a str) -> Self {
        let element = || {
            let (row, column) = place.strip_suffix(']')?.rsplit_once('[')?;
            Some(Self::Row { row, start: column.parse().ok()?, count: 1 })
        };
        element().unwrap_or(Self::Alone(place))
    }

    /// Takes in what stands right behind, if it is not too much then.
    fn takes(&mut self, next: &Self) -> bool {
        let (Self::Row { row, start, count }, Self::Row { row: other, start: column, .. }) = (self, next) else { return false };
        let follows = row == other && *start + *count == *column && *count < MOST;
        *count += usize::from(follows);
        follows
    }

    fn statement(&self) -> String {
        match self {
            Self::Row { row, start, count: 1 } => format!("    {row}[{start}] = {ZERO};\n"),
            Self::Row { row, start, count } => format!("    {row}[{start}..{}].fill({ZERO});\n", start + count),
            Self::Alone(place) => format!("    {place} = {ZERO};\n"),
        }
    }
}

fn runs<'a>(places: impl Iterator<Item = &'a str>) -> Vec<Run<'a>> {
    let mut runs: Vec<Run<'a>> = Vec::new();
    for next in places.map(Run::of) {
        if !runs.last_mut().is_some_and(|run| run.takes(&next)) {
            runs.push(next);
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text<'a>(places: impl Iterator<Item = &'a str>) -> String {
        runs(places).iter().map(Run::statement).collect()
    }

    #[test]
    fn neighbours_go_together_and_none_is_left_out() {
        let places = ["out.m[0][1]", "out.m[0][2]", "out.m[0][4]", "out.m[1][5]", "out.energy", "out.f[6]"];
        let statements = ["out.m[0][1..3].fill(0.0)", "out.m[0][4] = 0.0", "out.m[1][5] = 0.0", "out.energy = 0.0", "out.f[6] = 0.0"];
        assert_eq!(text(places.into_iter()), statements.map(|s| format!("    {s};\n")).concat());
    }

    #[test]
    fn no_statement_writes_much() {
        let row: Vec<String> = (0..40).map(|j| format!("out[{j}]")).collect();
        let written = text(row.iter().map(String::as_str));
        assert_eq!(written, "    out[0..16].fill(0.0);\n    out[16..32].fill(0.0);\n    out[32..40].fill(0.0);\n");
    }
}
