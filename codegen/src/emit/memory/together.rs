//! Results that stand side by side and are made soon after one another, by one store. A processor stores once a cycle, and large matrices are mostly stores: the mass matrix of
//! a humanoid takes a tenth less time.

use std::collections::BTreeMap;

/// Two results go together if at most so many statements lie between them: longer kept, they would fill the registers.
const APART: usize = 100;

/// The statements with pairs of results `out[i][2j] = a; … out[i][2j + 1] = b;` as one, where the second stood.
pub(crate) fn two_at_once(statements: &str) -> String {
    let lines: Vec<&str> = statements.lines().collect();
    let results = lines.iter().enumerate().filter_map(|(n, line)| result(line).map(|(row, column, value)| ((row, column), (n, value))));
    let made: BTreeMap<(&str, usize), (usize, &str)> = results.collect();
    let mut text: Vec<Option<String>> = lines.iter().map(|line| Some((*line).to_owned())).collect();
    for (&(row, column), &(m, a)) in made.iter().filter(|((_, column), _)| column % 2 == 0) {
        let second = made.get(&(row, column + 1)).filter(|(n, _)| m.abs_diff(*n) <= APART);
        if let Some(&(n, b)) = second {
            text[m.min(n)] = None;
            text[m.max(n)] = Some(format!("    store(lanes([{a}, {b}]), &mut {row}.as_chunks_mut::<2>().0[{}]);", column / 2));
        }
    }
    text.into_iter().flatten().map(|line| line + "\n").collect()
}

/// The row, the column and the value of a result in an array of arrays.
fn result(line: &str) -> Option<(&str, usize, &str)> {
    let (place, value) = line.trim().strip_suffix(';')?.split_once(" = ")?;
    let (row, column) = place.strip_suffix(']')?.rsplit_once('[')?;
    (row.starts_with("out") && row.ends_with(']')).then_some((row, column.parse().ok()?, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_stored_together_and_others_alone() {
        let alone = "    out[3][6] = x1;\n    out[6] = x1;\n    out[7] = x1;\n";
        let found = two_at_once(&format!("    let x1 = a;\n    out[3][5] = x1;\n    let x2 = b;\n    out[3][4] = lane::<1>(x2);\n{alone}"));
        // Where both are known.
        let stored = "    store(lanes([lane::<1>(x2), x1]), &mut out[3].as_chunks_mut::<2>().0[2]);\n";
        assert_eq!(found, format!("    let x1 = a;\n    let x2 = b;\n{stored}{alone}"));
    }

    #[test]
    fn what_is_made_long_after_is_stored_alone() {
        let text = format!("    out[0][0] = a;\n{}    out[0][1] = b;\n", "    let x = y;\n".repeat(APART));
        assert_eq!(two_at_once(&text), text);
    }
}
