//! Values that wait in memory while the registers are full, where that is decided here and not by a compiler. A processor without AVX-512 has sixteen registers, and in a long function
//! half of a compiler's instructions only move values out of them and back, nine and ten bytes each, for they name places far from the end of the stack: more than such a processor keeps decoded.
//!
//! Here values wait on shelves that an instruction reaches by one byte: two of 128 bytes behind each pointer, for that byte has a sign. Compilers are not told where pointers lead, so that what is
//! read there is read where it is needed, as [`Plan`] says. What waits long is not worth those bytes, and is in one struct for all.

use std::collections::VecDeque;
use std::fmt::Write;
use std::ops::Range;

use crate::Level;
use crate::emit::memory::chunks;
use crate::emit::memory::registers::{Plan, Step, Uses};
use crate::emit::statements::flat;
use crate::program::Program;

/// From this many nodes on, some 12 kB. Below, a processor keeps the code decoded whoever chose what waits, if nobody else runs on its core, and compilers know better how long an instruction takes.
pub(crate) const FROM: usize = 1000;

/// So many times must a hundred statements read something that waits, of one number each or in lanes: where it is less, compilers do as well.
const READS: [usize; 2] = [26, 18];

/// What is needed once in so many steps, or less often, does not wait on a shelf.
const RARELY: usize = 500;

/// Bytes of a shelf: as far as one byte reaches on either side of a pointer.
const SHELF: usize = 128;

/// Stands before what is for processors with sixteen registers, and before what is for others.
pub(crate) const FEW_REGISTERS: &str = "#[cfg(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\")))]";
pub(crate) const MORE_REGISTERS: &str = "#[cfg(not(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\"))))]";

/// The statements of a function of which there are both.
pub(crate) fn by_registers(few: &str, more: &str) -> String {
    format!("    {FEW_REGISTERS}\n    return {{\n{few}    }};\n    {MORE_REGISTERS}\n    return {{\n{more}    }};\n")
}

/// Whether there may be a text of this function for processors with sixteen registers, in which values wait.
pub(crate) fn is_possible(program: &Program, level: Level, forbid_unsafe: bool) -> bool {
    let graph = &program.graph;
    let of_numbers = !level.of_two() && level.fused;
    let is_long = graph.nodes().len() >= FROM && !chunks::is_long(graph, false);
    program.groups.is_none() && of_numbers && !forbid_unsafe && is_long
}

/// Whether enough is read in such a text of what waits.
pub(crate) fn pays(text: &str, in_lanes: bool) -> bool {
    let statements = text.lines().filter(|line| line.ends_with(';')).count();
    let [spills, named] = ["spill(&raw mut (*", "(*"].map(|what| text.matches(what).count());
    100 * (named - spills) >= READS[usize::from(in_lanes)] * (statements - spills)
}

/// Writes the module that the statements call, if any do.
pub(crate) fn module(out: &mut String) {
    if out.contains(CALLED) {
        *out += MODULE;
    }
}

const MODULE: &str = "\
/// Where values wait while sixteen registers are full.
#[cfg(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\")))]
#[allow(unsafe_code, unused_results, clippy::all, clippy::pedantic)]
mod spills {
    /// Puts a value where it waits. Compilers look for two numbers to write at once, but not where that is volatile: it takes long, and gains nothing.
    #[inline(always)]
    pub(super) unsafe fn spill<T>(place: *mut T, x: T) {
        // SAFETY: the caller has a place there.
        unsafe { place.write_volatile(x) }
    }
}

";

const CALLED: &str = "    use self::spills::spill;\n";

/// A value that waits.
#[derive(Clone, Copy)]
pub(crate) struct Kind {
    ty: &'static str,
    /// Places on a shelf.
    places: usize,
}

impl Kind {
    /// Of a type with so many lanes.
    pub(crate) fn of(ty: &'static str, lanes: usize) -> Self {
        let bytes = if ty == "f32" { size_of::<f32>() } else { size_of::<f64>() };
        Self { ty, places: SHELF / (bytes * lanes) }
    }
}

/// The same statements, with what waits put where it waits, and read from there.
pub(crate) fn spilled(statements: &str, kind: Kind) -> String {
    spilled_before(statements, &mut [], kind) + END
}

/// The same with `results`, what is made of values at the end; behind that [`END`] has to stand.
pub(crate) fn spilled_before(statements: &str, results: &mut [String], kind: Kind) -> String {
    let lines: Vec<Statement> = statements.lines().map(Statement::of).collect();
    let last = results.iter().map(|result| Step { made: Vec::new(), ..Statement::of(result).step });
    let steps: Vec<Step> = lines.iter().map(|line| line.step.clone()).chain(last).collect();
    let uses = Uses::of(&steps);
    let plan = Plan::of(&steps, &uses);
    let mut writer = Writer::new(&uses, &plan, kind);
    let mut text = String::new();
    lines.iter().enumerate().for_each(|(at, line)| writer.write(&mut text, at, line));
    for (at, result) in (lines.len()..).zip(results) {
        writer.load(&mut text, at);
        *result = writer.with_names(result, plan.folded[at]);
    }
    writer.beginning() + &text
}

/// What stands behind the statements, and behind what is made of them.
pub(crate) const END: &str = "    }\n";

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
        // A number that is written out is in memory already, what is there twice has to be loaded, and so has what stands alone.
        let once = |k: &usize| all.iter().filter(|other| *other == k).count() == 1;
        let foldable = if all.len() < 2 || has_literal(right) { Vec::new() } else { all.iter().copied().filter(once).collect() };
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
    kind: Kind,
    /// The place of each value that waits: whether it is far, and which one.
    place: Vec<Option<(bool, usize)>>,
    near: Places,
    far: Places,
    /// How many times each value was loaded.
    loaded: Vec<usize>,
}

impl<'a> Writer<'a> {
    fn new(uses: &'a Uses, plan: &'a Plan, kind: Kind) -> Self {
        let values = plan.waits.len();
        Self { uses, plan, kind, place: vec![None; values], near: Places::default(), far: Places::default(), loaded: vec![0; values] }
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
            let _ = writeln!(out, "    spill(&raw mut {}, x{k});", self.waiting(k));
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
            Some((true, place)) => format!("(*far).m{place}"),
            Some((false, place)) => format!("(*s{}).m{}", place / self.kind.places, place % self.kind.places),
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

    /// What stands before the statements: room, and pointers of which compilers do not know where they lead.
    fn beginning(&self) -> String {
        let mut out = String::from(
            "    // There are sixteen registers: this says what waits in memory, and where.\n    use ::core::hint::black_box as hidden;\n",
        );
        out += CALLED;
        if self.far.all > 0 {
            self.room(&mut out, "far", "Far", self.far.all, "Far");
            out += "    let far = hidden(far.as_mut_ptr());\n";
        }
        let shelves = self.near.all.div_ceil(self.kind.places);
        if shelves > 0 {
            self.room(&mut out, "shelves", "Shelf", self.kind.places, &format!("[Shelf; {shelves}]"));
            out += "    let shelves: *mut Shelf = shelves.as_mut_ptr().cast();\n";
        }
        for k in (0..shelves).step_by(2) {
            // Of the second of two, which is where the first ends.
            let behind = (k + 1).min(shelves - 1);
            let _ = writeln!(out, "    let s{behind} = hidden(shelves.wrapping_add({behind}));");
            if behind > k {
                let _ = writeln!(out, "    let s{k} = s{behind}.wrapping_sub(1);");
            }
        }
        out + "    // SAFETY: what waits is written to its place before it is read there.\n    unsafe {\n"
    }

    /// Room for what is made of a struct of so many places.
    fn room(&self, out: &mut String, name: &str, place: &str, places: usize, ty: &str) {
        let fields: Vec<String> = (0..places).map(|k| format!("m{k}: {}", self.kind.ty)).collect();
        let _ = writeln!(out, "    #[allow(dead_code)]\n    struct {place} {{ {} }}", fields.join(", "));
        let _ = writeln!(out, "    let mut {name} = ::core::mem::MaybeUninit::<{ty}>::uninit();");
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

    fn spilled(statements: &str, results: &mut [String]) -> String {
        spilled_before(statements, results, Kind::of("f64", 1))
    }

    #[test]
    fn what_fits_into_registers_stays_as_it_is() {
        let text = long(14);
        let found = spilled(&text, &mut []);
        assert!(found.ends_with(&format!("    unsafe {{\n{text}")) && !found.contains("MaybeUninit"), "{found}");
        assert!(!pays(&(found + END), false));
    }

    #[test]
    fn what_is_needed_last_waits_and_is_read_where_it_is_needed() {
        let text = spilled(&long(16), &mut []);
        // x0 is needed at once, x15 is first, and x1 last.
        let spills: Vec<&str> = text.lines().filter(|line| line.contains("spill(")).map(str::trim).collect();
        assert_eq!(spills, ["spill(&raw mut (*s0).m0, x1);", "spill(&raw mut (*s0).m1, x2);"]);
        assert!(
            text.contains(
                "    let x28 = F::fma(x0, -x3, x27);\n    let x29 = F::fma(x0, -(*s0).m1, x28);\n    let x30 = F::fma(x0, -(*s0).m0, x29);\n"
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
            assert!(spilled(&text, &mut []).ends_with(&format!("    let x1r1 = (*s0).m0;\n    let x30 = {loaded};\n")), "{right}");
        }
    }

    #[test]
    fn results_at_the_end_are_read_where_they_wait() {
        let mut results = vec!["x30".to_owned(), "x7 as f32".to_owned()];
        let text = spilled(&long(24).replace("x7)", "x8)"), &mut results);
        assert!(text.contains("    spill(&raw mut (*s0)."));
        assert_eq!(results[0], "x30");
        assert!(
            text.contains(&format!("let {} = (*s0).m", results[1].trim_end_matches(" as f32"))) || results[1].starts_with("(*s0).m"),
            "{results:?}"
        );
    }

    #[test]
    fn comparisons_never_wait() {
        let text = format!("    let x100 = x0 > 0.0;\n{}    let x101 = if x100 {{ x1 }} else {{ x2 }};\n", long(40));
        assert!(!spilled(&text, &mut []).contains("x100)"));
    }

    #[test]
    fn of_lanes_fewer_lie_on_a_shelf_and_two_shelves_around_a_pointer() {
        let text = super::spilled(&long(40).replace("f64", "V"), Kind::of("V", 4));
        assert!(text.contains("struct Shelf { m0: V, m1: V, m2: V, m3: V }") && text.contains("MaybeUninit::<[Shelf; 7]>"), "{text}");
        assert!(text.contains("    let s5 = hidden(shelves.wrapping_add(5));\n    let s4 = s5.wrapping_sub(1);\n    let s6 = hidden(shelves.wrapping_add(6));\n"));
        assert!(pays(&text, true));
    }

    /// The statements as they were before: each place stands for what was put there last, each name for the value that was loaded.
    fn undone(text: &str) -> String {
        let (mut holds, mut out) = (std::collections::HashMap::<&str, &str>::new(), String::new());
        for line in text.lines().skip_while(|line| !line.contains("unsafe {")).skip(1) {
            if let Some((place, value)) =
                line.strip_prefix("    spill(&raw mut ").and_then(|line| line.strip_suffix(");")?.split_once(", "))
            {
                holds.insert(place, value);
                continue;
            }
            let mut line = holds.iter().fold(line.to_owned(), |line, (place, value)| {
                let end = |rest: &str| !rest.starts_with(|c: char| c.is_ascii_digit());
                line.split(place).enumerate().fold(String::new(), |line, (n, rest)| {
                    line + if n == 0 {
                        ""
                    } else if end(rest) {
                        value
                    } else {
                        place
                    } + rest
                })
            });
            for load in (1..9).map(|k| format!("r{k}")) {
                line = line.replace(&load, "");
            }
            let (left, right) = line.trim().trim_start_matches("let ").split_once(" = ").unwrap();
            if left != right.trim_end_matches(';') {
                out += &(line + "\n");
            }
        }
        out
    }

    #[test]
    fn what_is_read_is_what_was_put_there() {
        let again: String = (1..60)
            .map(|k| format!("    let x{} = F::fma(x{}, x{}, x{});\n", 200 + k, 7 * k % 60, 11 * k % 60, 60 + 13 * k % 59))
            .collect();
        let text = long(60) + &again;
        assert_eq!(undone(&spilled(&text, &mut [])), text);
    }

    #[test]
    fn places_are_used_again_and_what_is_needed_seldom_is_far() {
        let squares: String = (0..1500).map(|k| format!("    let x{} = x0 * x0;\n", 3000 + k)).collect();
        let again = long(24).replace("q[", "v[").replace('x', "x2000").replace("fmax", "fma");
        let text = spilled(&(long(24) + &squares + "    let x1000 = x46 * x1;\n" + &again), &mut []);
        assert!(text.contains("    spill(&raw mut (*far).m0, x1);\n") && text.contains("    let x1000 = x46 * (*far).m0;\n"), "{text}");
        assert!(text.contains("struct Far { m0: f64 }") && text.contains("MaybeUninit::<[Shelf; 1]>"), "{text}");
    }
}
