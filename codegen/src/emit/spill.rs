//! Values that wait in memory while the registers are full, where that is decided here and not by a compiler. A processor without AVX-512 has sixteen registers, and in a long function
//! half of a compiler's instructions only move values out of them and back, nine and ten bytes each, for they name places far from the end of the stack: more than such a processor keeps decoded.
//!
//! Here values wait on shelves of sixteen places, each behind a pointer of its own, from which an instruction reaches a place by one byte. Compilers are not told which shelf is which, so that what is
//! read there is read where it is needed, as [`Plan`] says. What waits long is not worth those bytes, and is in one struct for all.

use std::collections::VecDeque;
use std::fmt::Write;
use std::ops::Range;

use super::registers::{Plan, Step, Uses};
use super::{chunks, flat, levels};
use crate::Level;
use crate::graph::{Graph, NodeId, Op};
use crate::program::Program;

/// From this many nodes on, some 20 kB. Below, a processor keeps the code decoded whoever chose what waits, if nobody else runs on its core, and compilers know better how long an instruction takes.
const FROM: usize = 1400;

/// What waits must be read so many times on the average, in tenths: where it is put away once and fetched once, nothing is gained.
const READS: usize = 14;

/// What is needed once in so many steps, or less often, does not wait on a shelf.
const RARELY: usize = 300;

/// Places of a shelf: 128 bytes, what one signed byte reaches.
const SHELF: usize = 16;

/// Stands before what is for processors with sixteen registers, and before what is for others.
pub(super) const FEW_REGISTERS: &str = "#[cfg(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\")))]";
pub(super) const MORE_REGISTERS: &str = "#[cfg(not(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\"))))]";

/// Whether there is a text of this function for processors with sixteen registers, in which values wait.
pub(super) fn spills(program: &Program, level: Level, forbid_unsafe: bool) -> bool {
    let graph = &program.graph;
    let plain = graph.lanes().width == 1 && program.groups.is_none();
    let of_doubles = levels::computed(level) == "f64" && !level.of_two() && level.fused;
    let is_long = graph.nodes().len() >= FROM && !chunks::is_long(graph, false);
    plain && of_doubles && !forbid_unsafe && is_long && pays(graph)
}

/// Whether what waits is read often enough.
fn pays(graph: &Graph) -> bool {
    let steps: Vec<Step> = (0..graph.nodes().len()).map(|k| step(graph, k)).collect();
    let plan = Plan::of(&steps, &Uses::of(&steps));
    plan.spills() > 0 && 10 * plan.reloads() >= READS * plan.spills()
}

fn step(graph: &Graph, k: usize) -> Step {
    let node = &graph.nodes()[k];
    if node.op == Op::Constant {
        return Step::default();
    }
    let mut used: Vec<usize> = node.operands().filter(|id| graph.node(*id).op != Op::Constant).map(NodeId::index).collect();
    let foldable = if used.len() == node.operands().count() { used.clone() } else { Vec::new() };
    used.sort_unstable();
    used.dedup();
    Step { made: vec![k], used, foldable }
}

/// The module that the statements call.
const MODULE: &str = "\
/// Where values wait while sixteen registers are full.
#[cfg(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\")))]
#[allow(unsafe_code, clippy::all, clippy::pedantic)]
mod spills {
    /// As many places as an instruction reaches by one byte.
    pub(super) struct Shelf {
        PLACES
    }

    pub(super) const EMPTY: Shelf = Shelf { EMPTY };

    /// Puts a value where it waits. Compilers look for two to write at once, but not where it is volatile: that takes long, and gains nothing.
    #[inline(always)]
    pub(super) fn spill(place: &mut f64, x: f64) {
        // SAFETY: what a reference leads to may be written.
        unsafe { ::core::ptr::from_mut(place).write_volatile(x) }
    }
}

";

/// That module, with the places of a shelf.
pub(super) fn module() -> String {
    let places = |text: fn(usize) -> String| (0..SHELF).map(text).collect::<Vec<_>>().join(", ");
    MODULE
        .replace("PLACES", &places(|k| format!("pub(super) m{k}: f64")))
        .replace("Shelf { EMPTY }", &format!("Shelf {{ {} }}", places(|k| format!("m{k}: 0.0"))))
}

/// The same statements, with what waits put where it waits, and read from there; `results` are what is made of values at the end.
pub(super) fn spilled(statements: &str, results: &mut [String]) -> String {
    let lines: Vec<Statement> = statements.lines().map(Statement::of).collect();
    let last = results.iter().map(|result| Step { made: Vec::new(), ..Statement::of(result).step });
    let steps: Vec<Step> = lines.iter().map(|line| line.step.clone()).chain(last).collect();
    let uses = Uses::of(&steps);
    let plan = Plan::of(&steps, &uses);
    let mut writer = Writer::new(&uses, &plan);
    let mut text = String::new();
    lines.iter().enumerate().for_each(|(at, line)| writer.write(&mut text, at, line));
    for (at, result) in (lines.len()..).zip(results) {
        writer.load(&mut text, at);
        *result = writer.with_names(result, plan.folded[at]);
    }
    writer.beginning() + &text
}

/// A line of text.
struct Statement<'a> {
    /// `let x7 = ` or where the result goes.
    left: &'a str,
    right: &'a str,
    step: Step,
}

impl<'a> Statement<'a> {
    fn of(line: &'a str) -> Self {
        let (left, right) = line.split_at(line.find(" = ").map_or(0, |at| at + 3));
        let made = if flat::compares(line) { Vec::new() } else { names(left).map(|(_, k)| k).collect() };
        let all: Vec<usize> = names(right).map(|(_, k)| k).collect();
        let mut used = all.clone();
        used.sort_unstable();
        used.dedup();
        // A number that is written out is in memory already, what is there twice has to be loaded, and so has what is only moved.
        let once = |k: &usize| all.iter().filter(|other| *other == k).count() == 1;
        let is_moved = right.trim_end_matches(';').strip_prefix('x').is_some_and(|k| k.parse::<usize>().is_ok());
        let foldable = if is_moved || has_literal(right) { Vec::new() } else { all.iter().copied().filter(once).collect() };
        Self { left, right, step: Step { made, used, foldable } }
    }
}

fn has_literal(text: &str) -> bool {
    words(text).any(|(_, word)| word.starts_with(|c: char| c.is_ascii_digit()))
}

/// The numbers of the values in a text, and where they stand.
fn names(text: &str) -> impl Iterator<Item = (Range<usize>, usize)> {
    words(text).filter_map(|(start, word)| Some((start..start + word.len(), word.strip_prefix('x')?.parse().ok()?)))
}

fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).map(|(start, _)| start).filter(move |&start| !text[..start].ends_with(word)).map(move |start| {
        let rest = &text[start..];
        (start, &rest[..rest.find(|c| !word(c)).unwrap_or(rest.len())])
    })
}

/// Places that are given away and become free again.
#[derive(Default)]
struct Places {
    free: VecDeque<usize>,
    all: usize,
}

impl Places {
    fn take(&mut self) -> usize {
        self.free.pop_front().unwrap_or_else(|| {
            self.all += 1;
            self.all - 1
        })
    }
}

/// The writer of the statements.
struct Writer<'a> {
    uses: &'a Uses,
    plan: &'a Plan,
    /// The place of each value that waits: whether it is far, and which one.
    place: Vec<Option<(bool, usize)>>,
    near: Places,
    far: Places,
    /// How many times each value was loaded.
    loaded: Vec<usize>,
}

impl<'a> Writer<'a> {
    fn new(uses: &'a Uses, plan: &'a Plan) -> Self {
        let values = plan.waits.len();
        Self { uses, plan, place: vec![None; values], near: Places::default(), far: Places::default(), loaded: vec![0; values] }
    }

    fn write(&mut self, out: &mut String, at: usize, line: &Statement) {
        self.load(out, at);
        let _ = writeln!(out, "{}{}", line.left, self.with_names(line.right, self.plan.folded[at]));
        for &k in line.step.used.iter().filter(|k| self.uses.is_over(**k, at)) {
            match self.place[k] {
                Some((true, place)) => self.far.free.push_back(place),
                Some((false, place)) => self.near.free.push_back(place),
                None => {}
            }
        }
        for &k in line.step.made.iter().filter(|k| self.plan.waits[**k]) {
            let is_far = self.uses.rarity(k, at) >= RARELY;
            let place = if is_far { self.far.take() } else { self.near.take() };
            self.place[k] = Some((is_far, place));
            let _ = writeln!(out, "    spill(&mut {}, x{k});", self.waiting(k));
        }
    }

    /// Loads what is to be in registers.
    fn load(&mut self, out: &mut String, at: usize) {
        for &k in &self.plan.loads[at] {
            self.loaded[k] += 1;
            let _ = writeln!(out, "    let {} = {};", self.name(k), self.waiting(k));
        }
    }

    /// What a value is called that is in a register.
    fn name(&self, k: usize) -> String {
        if self.loaded[k] == 0 { format!("x{k}") } else { format!("x{k}r{}", self.loaded[k]) }
    }

    /// And where it waits.
    fn waiting(&self, k: usize) -> String {
        match self.place[k] {
            Some((true, place)) => format!("far.m{place}"),
            Some((false, place)) => format!("s{}.m{}", place / SHELF, place % SHELF),
            None => self.name(k),
        }
    }

    /// The same text, with values called as they are now.
    fn with_names(&self, text: &str, folded: Option<usize>) -> String {
        let (mut out, mut done) = (String::new(), 0);
        for (range, k) in names(text) {
            out += &text[done..range.start];
            out += &if folded == Some(k) { self.waiting(k) } else { self.name(k) };
            done = range.end;
        }
        out + &text[done..]
    }

    /// What stands before the statements: shelves, and pointers of which compilers do not know where they lead.
    fn beginning(&self) -> String {
        let shelves = self.near.all.div_ceil(SHELF);
        let of_far = |text: fn(usize) -> String| (0..self.far.all).map(text).collect::<Vec<_>>().join(", ");
        let names = (0..shelves).map(|k| format!("s{k}")).collect::<Vec<_>>().join(", ");
        let mut out = String::from(
            "    // There are sixteen registers: this says what waits in memory, and where.\n    use ::core::hint::black_box as shelf;\n",
        );
        out += "    use self::spills::{EMPTY, spill};\n";
        if self.far.all > 0 {
            let _ = writeln!(out, "    struct Far {{ {} }}", of_far(|k| format!("m{k}: f64")));
            let _ = writeln!(out, "    let mut far = Far {{ {} }};\n    let far = shelf(&mut far);", of_far(|k| format!("m{k}: 0.0")));
        }
        let _ = writeln!(out, "    let mut shelves = [EMPTY; {shelves}];\n    let [{names}] = &mut shelves;");
        (0..shelves).for_each(|k| out += &format!("    let s{k} = shelf(s{k});\n"));
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So many inputs, and sums of the first with each of the others from the last one on, so that all are needed until the end.
    fn long(n: usize) -> String {
        let inputs = (0..n).map(|k| format!("    let x{k} = q[{k}];\n"));
        let sums = (1..n).map(|k| format!("    let x{} = F::fma(x0, -x{}, x{});\n", n + k - 1, n - k, if k == 1 { 0 } else { n + k - 2 }));
        inputs.chain(sums).collect()
    }

    #[test]
    fn what_fits_into_registers_stays_as_it_is() {
        let text = long(14);
        let with_beginning = spilled(&text, &mut []);
        assert!(
            with_beginning.ends_with(&format!("let mut shelves = [EMPTY; 0];\n    let [] = &mut shelves;\n{text}")),
            "{with_beginning}"
        );
    }

    #[test]
    fn what_is_needed_last_waits_and_is_read_where_it_is_needed() {
        let text = spilled(&long(16), &mut []);
        // x0 is needed at once, x15 is first, and x1 last.
        let spills: Vec<&str> = text.lines().filter(|line| line.contains("spill(")).map(str::trim).collect();
        assert_eq!(spills, ["spill(&mut s0.m0, x1);", "spill(&mut s0.m1, x2);"]);
        assert!(
            text.contains(
                "    let x28 = F::fma(x0, -x3, x27);\n    let x29 = F::fma(x0, -s0.m1, x28);\n    let x30 = F::fma(x0, -s0.m0, x29);\n"
            ),
            "{text}"
        );
    }

    #[test]
    fn what_is_there_twice_or_moved_or_beside_a_number_is_loaded() {
        let used = ["x1 * x1", "x1", "F::fma(0.5, x1, x0)"];
        for right in used {
            let text = long(16).replace("F::fma(x0, -x1, x29)", right);
            let loaded = right.replace("x1", "x1r1");
            assert!(spilled(&text, &mut []).ends_with(&format!("    let x1r1 = s0.m0;\n    let x30 = {loaded};\n")), "{right}");
        }
    }

    #[test]
    fn results_at_the_end_are_read_where_they_wait() {
        let mut results = vec!["x30".to_owned(), "x7 as f32".to_owned()];
        let text = spilled(&long(24).replace("x7)", "x8)"), &mut results);
        assert!(text.contains("    spill(&mut s0."));
        assert_eq!(results[0], "x30");
        assert!(
            text.contains(&format!("let {} = s0.m", results[1].trim_end_matches(" as f32"))) || results[1].starts_with("s0.m"),
            "{results:?}"
        );
    }

    #[test]
    fn comparisons_never_wait() {
        let text = format!("    let x100 = x0 > 0.0;\n{}    let x101 = if x100 {{ x1 }} else {{ x2 }};\n", long(40));
        assert!(!spilled(&text, &mut []).contains("x100)"));
    }

    #[test]
    fn places_are_used_again_and_what_is_needed_seldom_is_far() {
        let squares: String = (0..900).map(|k| format!("    let x{} = x0 * x0;\n", 100 + k)).collect();
        let again = long(24).replace("q[", "v[").replace('x', "x2000").replace("fmax", "fma");
        let text = spilled(&(long(24) + &squares + "    let x1000 = x46 * x1;\n" + &again), &mut []);
        assert!(text.contains("    spill(&mut far.m0, x1);\n") && text.contains("    let x1000 = x46 * far.m0;\n"), "{text}");
        assert!(text.contains("struct Far { m0: f64 }") && text.contains("let mut shelves = [EMPTY; 1];"), "{text}");
    }
}
