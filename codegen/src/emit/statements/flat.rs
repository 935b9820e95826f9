//! Long functions without deep nests: to a compiler that keeps track of names for debuggers, what follows a `let` is inside of it, and some thousands
//! inside of one another are more than its stack holds. Where there are many, names are declared a hundred at a time, and then assigned. Their type is
//! declared with them: the time to infer it grows as the square of their number.

use crate::graph::Op;

/// From this many `let`s on.
const FLAT_FROM: usize = 1000;

/// How many names one `let` declares.
const TOGETHER: usize = 100;

const LET: &str = "    let ";

/// The same statements, flat if there are many; their values are of the type `ty`, but for comparisons, which stay where they are. Each name is given once.
pub(crate) fn flat(statements: &str, ty: &str) -> String {
    let is_flat = |line: &str| line.starts_with(LET) && !compares(line) && given(line).next().is_some();
    let names: Vec<&str> = statements.lines().filter(|line| is_flat(line)).flat_map(given).collect();
    if names.len() < FLAT_FROM {
        return statements.to_owned();
    }
    let declared = names.chunks(TOGETHER).map(|some| format!("{LET}[{}]: [{ty}; {}];\n", some.join(", "), some.len()));
    let assigned = statements.lines().map(|line| if is_flat(line) { line.replacen("let ", "", 1) } else { line.to_owned() } + "\n");
    declared.chain(assigned).collect()
}

/// Whether a statement gives no number, but whether one is positive.
pub(crate) fn compares(line: &str) -> bool {
    let row = Op::Positive.row();
    let right = line.split_once(" = ").map_or("", |(_, right)| right);
    let [rust, lanes] = [row.rust, row.lanes].map(|text| text.trim_start_matches("{a}"));
    right.starts_with(lanes) || right.trim_end_matches(';').ends_with(rust)
}

/// The names on the left of a statement.
fn given(line: &str) -> impl Iterator<Item = &str> {
    let left = line.split_once(" = ").map_or("", |(left, _)| left);
    left.trim_start_matches(LET).split(|c: char| !c.is_alphanumeric()).filter(|name| name.starts_with('x'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_statements_are_flat_and_few_stay_as_they_are() {
        let few = "    let x1 = a;\n    let [[x2, _], [x3, x4]] = f(x1);\n    out[0] = x4;\n";
        assert_eq!(flat(few, "f64"), few);
        let tests = "    let x5 = x4 > 0.0;\n    let x6 = if x5 { x4 } else { x3 };\n    let x7 = positive(x6);\n";
        let many: String = few.to_owned() + tests + &(8..1100).map(|k| format!("    let x{k} = x{};\n", k - 1)).collect::<String>();
        let flat = flat(&many, "f64");
        assert!(flat.starts_with("    let [x1, x2, x3, x4, x6, x8, "));
        assert!(flat.contains("x102]: [f64; 100];\n"));
        assert!(flat.contains("    x1 = a;\n    [[x2, _], [x3, x4]] = f(x1);\n    out[0] = x4;\n    let x5 = x4 > 0.0;\n    x6 = if x5 "));
        assert!(flat.contains("\n    let x7 = positive(x6);\n    x8 = x7;\n"));
        assert_eq!(flat.lines().filter(|l| l.starts_with(LET)).count(), 1097_usize.div_ceil(TOGETHER) + 2);
    }
}
