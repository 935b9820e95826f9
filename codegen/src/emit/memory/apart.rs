//! Results that stand side by side, through two pointers in turn of which a compiler cannot know that they are one. Where it sees two neighbours it looks for two vectors to make them from,
//! all the way back to the inputs, and puts the statements of the whole function into another order each time: of a seven-axis arm's derivatives that was a third of the time to compile, and saved no time when they ran.
//! What pieces of a long function hand on is kept apart by its places ([`super::chunks`]).

use std::fmt::Write;

use crate::emit::statements::dialect::Dialect;
use crate::graph::Graph;

/// From this many nodes on. Below, it is little time, and the code is a little faster as it was.
const FROM: usize = 1500;

/// Whether results are kept apart; where they are stored two at once, nobody looks for more.
pub(crate) fn keeps_apart(graph: &Graph, dialect: &dyn Dialect) -> bool {
    graph.nodes().len() >= FROM && graph.lanes().width == 1 && !dialect.stores_two()
}

/// The place of a number of a result.
pub(crate) fn place(k: usize) -> String {
    format!("{}[{k}]", ["even", "odd"][k % 2])
}

/// The statements with `even[4] = x;` and `odd[5] = y;` written to these places of `out`, which is an array of so many numbers, so many times in arrays.
pub(crate) fn written(statements: &str, numbers: usize, nests: usize) -> String {
    let mut out = String::new();
    if statements.lines().any(|line| set(line).is_some()) {
        pointers(&mut out, numbers, nests);
    }
    statements.lines().for_each(|line| out += &(set(line).unwrap_or_else(|| line.to_owned()) + "\n"));
    out
}

/// The two pointers.
fn pointers(out: &mut String, numbers: usize, nests: usize) {
    let slice = if nests == 0 { ".as_mut_slice()".to_owned() } else { ".as_flattened_mut()".repeat(nests) };
    let _ = writeln!(
        out,
        "    let ::core::option::Option::Some(even) = ::core::cell::Cell::from_mut(out{slice}).as_slice_of_cells().first_chunk::<{numbers}>() else {{ ::core::unreachable!() }};\n    \
         // The same, but compilers do not know: they would look for vectors, and take longer.\n    \
         let odd = ::core::hint::black_box(even);\n    \
         let _ = (even, odd);"
    );
}

fn set(line: &str) -> Option<String> {
    let (place, value) = line.strip_suffix(';')?.split_once(" = ")?;
    let given = ["even[", "odd["].iter().any(|name| place.trim_start().starts_with(name));
    given.then(|| format!("{place}.set({value});"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_set_and_all_else_stays() {
        let text = format!("    let x1 = a;\n    {} = x1;\n    {} = -x1;\n    x2 = b;\n", place(4), place(7));
        let written_so = "    let x1 = a;\n    even[4].set(x1);\n    odd[7].set(-x1);\n    x2 = b;\n";
        let written = written(&text, 8, 0);
        assert!(written.starts_with("    let ::core::option::Option::Some(even)") && written.ends_with(written_so), "{written}");
    }

    #[test]
    fn without_results_there_are_no_pointers() {
        assert_eq!(written("    let x1 = a;\n", 8, 0), "    let x1 = a;\n");
    }
}
