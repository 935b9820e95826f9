//! Zeros of large results: a few side by side by one statement each, between the statements that compute. To fill a whole matrix beforehand takes as long as a third of the humanoid's mass matrix, since a
//! processor does nothing else meanwhile; single stores have time while sums wait for their terms.

use super::dialect::Dialect;
use super::results::ZERO;
use crate::graph::Graph;

/// So many numbers at once are written in place; more would be a call.
const MOST: usize = 16;

/// The statements that write the zeros of a result whose numbers have these places.
pub(super) fn statements(graph: &Graph, dialect: &dyn Dialect, places: &[String]) -> Vec<String> {
    let zeros = places.iter().zip(&graph.outputs).filter(|(_, id)| dialect.number(**id) == ZERO).map(|(place, _)| place.as_str());
    runs(zeros).into_iter().map(|run| run.statement()).collect()
}

/// Neighbours in a row.
struct Run<'a> {
    row: &'a str,
    start: usize,
    count: usize,
}

impl Run<'_> {
    fn statement(&self) -> String {
        let Self { row, start, count } = self;
        if *count == 1 {
            format!("    {row}[{start}] = {ZERO};\n")
        } else {
            format!("    {row}[{start}..{}].fill({ZERO});\n", start + count)
        }
    }
}

fn runs<'a>(places: impl Iterator<Item = &'a str>) -> Vec<Run<'a>> {
    let mut runs: Vec<Run<'a>> = Vec::new();
    for place in places {
        let Some((row, column)) =
            place.strip_suffix(']').and_then(|p| p.rsplit_once('[')).and_then(|(row, k)| Some((row, k.parse().ok()?)))
        else {
            continue;
        };
        match runs.last_mut() {
            Some(run) if run.row == row && run.start + run.count == column && run.count < MOST => run.count += 1,
            _ => runs.push(Run { row, start: column, count: 1 }),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_go_together_as_long_as_they_are_few() {
        let places: Vec<String> = [(0, 1), (0, 2), (0, 4), (1, 5)].iter().map(|(i, j)| format!("out[{i}][{j}]")).collect();
        let text: String = runs(places.iter().map(String::as_str)).iter().map(Run::statement).collect();
        assert_eq!(text, "    out[0][1..3].fill(0.0);\n    out[0][4] = 0.0;\n    out[1][5] = 0.0;\n");
        let row: Vec<String> = (0..40).map(|j| format!("out[{j}]")).collect();
        let counts: Vec<usize> = runs(row.iter().map(String::as_str)).iter().map(|run| run.count).collect();
        assert_eq!(counts, [16, 16, 8]);
    }
}
