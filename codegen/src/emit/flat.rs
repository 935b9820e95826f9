//! Long functions without deep nests: to a compiler that keeps track of names for debuggers, what follows a `let` is inside of it, and some thousands
//! inside of one another are more than its stack holds. Where there are many, names are declared a hundred at a time, and then assigned.

/// From this many `let`s on.
const FLAT_FROM: usize = 1000;

/// How many names one `let` declares.
const TOGETHER: usize = 100;

const LET: &str = "    let ";

/// The same statements, flat if there are many. Each name is given once.
pub(super) fn flat(statements: &str) -> String {
    let is_let = |line: &&str| line.starts_with(LET);
    if statements.lines().filter(is_let).count() < FLAT_FROM {
        return statements.to_owned();
    }
    let names: Vec<&str> = statements.lines().filter(is_let).flat_map(given).collect();
    let declared = names.chunks(TOGETHER).map(|some| format!("{LET}({},);\n", some.join(", ")));
    let assigned =
        statements.lines().map(|line| line.strip_prefix(LET).map_or_else(|| format!("{line}\n"), |rest| format!("    {rest}\n")));
    declared.chain(assigned).collect()
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
        assert_eq!(flat(few), few);
        let many: String = few.to_owned() + &(5..1100).map(|k| format!("    let x{k} = x{};\n", k - 1)).collect::<String>();
        let flat = flat(&many);
        assert!(flat.starts_with("    let (x1, x2, x3, x4, x5, "));
        assert!(flat.contains("    x1 = a;\n    [[x2, _], [x3, x4]] = f(x1);\n    out[0] = x4;\n    x5 = x4;\n"));
        assert_eq!(flat.lines().filter(|l| l.starts_with(LET)).count(), 1099_usize.div_ceil(TOGETHER));
    }
}
