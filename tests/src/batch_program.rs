//! Batches of generated modules as a program: it reads states, checks each function for the laws of
//! batches, and returns the results.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use articulated_codegen::ledger::Entry;
use articulated_codegen::{Generated, Real};

use crate::program::Program;

/// Number of states for a function: more than two blocks of either type.
pub const STATES: usize = 37;

/// The batches of several robots, in one instruction set, compiled as one program.
#[derive(Debug)]
pub struct BatchProgram(Program);

impl BatchProgram {
    /// Compiles. `set` is the module of the instruction set that is taken, whatever the processor
    /// has; `flags` go to the compiler.
    ///
    /// # Panics
    /// If the compiler refuses the program: its message is printed.
    pub fn build(robots: &[(&str, &Generated)], set: &str, flags: &[&str]) -> Self {
        let changed: BTreeMap<&str, Generated> =
            robots.iter().map(|(name, g)| (*name, Generated { source: only(set, &g.source), ..(*g).clone() })).collect();
        let named: Vec<(&str, &Generated)> = changed.iter().map(|(name, g)| (*name, g)).collect();
        Self(Program::of(&named, &main(&named), flags))
    }

    /// Results for [`STATES`] states, each a list of arguments in the registry's order; `f32`
    /// results keep their values.
    ///
    /// # Panics
    /// If a law of batches does not hold.
    pub fn run(&self, robot: &str, function: &str, real: Real, states: &[Vec<&[f64]>]) -> Vec<Vec<f64>> {
        assert_eq!(states.len(), STATES);
        self.0.run(robot, &format!("{function} {}", real.name()), states)
    }

    /// How long the compiler took.
    pub fn time(&self) -> std::time::Duration {
        self.0.time
    }
}

/// The source with one instruction set chosen: modules of the others, and calls to them, are not
/// compiled.
fn only(set: &str, source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    let mut lines = source.lines().peekable();
    let mut asked = false;
    while let Some(line) = lines.next() {
        let then: Vec<&str> = lines.clone().take(3).collect();
        match line.trim_start().starts_with("#[cfg(").then(|| named(&then)).flatten() {
            Some(named) => out += if named == set { "#[cfg(all())]" } else { "#[cfg(any())]" },
            None => out += if asked { "    if true {" } else { line },
        }
        asked = line.trim_start().starts_with("#[cfg(") && then[0].starts_with("    if ") && named(&then).is_some();
        out.push('\n');
    }
    out
}

/// The instruction set of the module or the call in these lines.
fn named(lines: &[&str]) -> Option<&'static str> {
    let begins = |set: &&str| lines.first().is_some_and(|line| *line == format!("mod {set} {{"));
    let called = |set: &&str| lines.iter().skip(1).any(|l| l.trim_start().trim_start_matches("unsafe { ").starts_with(&format!("{set}::")));
    ["avx512", "avx2", "sse2", "neon", "portable"].into_iter().find(|set| begins(set) || called(set))
}

const HEAD: &str = "\
#![allow(dead_code)]
#![deny(warnings)]
use std::io::{Read, Write};

/// Nested arrays of numbers.
trait Nest<T> {
    fn nest(next: &mut dyn FnMut() -> T) -> Self;
    fn each(&self, then: &mut dyn FnMut(&T));
}

macro_rules! leaf {
    ($($leaf:ty)*) => { $(impl Nest<$leaf> for $leaf {
        fn nest(next: &mut dyn FnMut() -> $leaf) -> $leaf {
            next()
        }

        fn each(&self, then: &mut dyn FnMut(&$leaf)) {
            then(self);
        }
    })* };
}

leaf!(f64 f32);

impl<T, A: Nest<T>, const N: usize> Nest<T> for [A; N] {
    fn nest(next: &mut dyn FnMut() -> T) -> Self {
        std::array::from_fn(|_| A::nest(next))
    }

    fn each(&self, then: &mut dyn FnMut(&T)) {
        self.iter().for_each(|a| a.each(then));
    }
}

fn flat<T: Copy, A: Nest<T>>(x: &[A]) -> Vec<T> {
    let mut out = Vec::new();
    x.iter().for_each(|a| a.each(&mut |t| out.push(*t)));
    out
}

/// States one after the other as blocks; those of the last block that is not full are left out.
fn blocks<T: Copy, L, A: Nest<T>, B: Nest<L>>(states: &[A], len: usize, lanes: fn(&[T]) -> L) -> Vec<B> {
    let block = |states: &[A]| {
        let each: Vec<Vec<T>> = states.iter().map(|s| flat(std::slice::from_ref(s))).collect();
        let mut k = 0;
        B::nest(&mut || {
            let numbers: Vec<T> = each.iter().map(|s| s[k]).collect();
            k += 1;
            lanes(&numbers)
        })
    };
    states.chunks_exact(len).map(block).collect()
}

/// The numbers of whole blocks of these states, in their order in the blocks.
fn in_blocks<T: Copy + Into<f64>, A: Nest<T>>(states: &[A], len: usize) -> Vec<f64> {
    let block = |states: &[A]| {
        let each: Vec<Vec<T>> = states.iter().map(|s| flat(std::slice::from_ref(s))).collect();
        (0..each[0].len()).flat_map(|k| each.iter().map(|s| s[k].into()).collect::<Vec<f64>>()).collect::<Vec<f64>>()
    };
    states.chunks_exact(len).flat_map(block).collect()
}

fn same(what: &str, a: &[f64], b: &[f64]) {
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b), \"{what}\");
}

/// The largest difference is 64 units of roundoff of the largest number.
fn near(what: &str, a: &[f64], b: &[f64]) {
    let scale = a.iter().fold(0.0, |max: f64, x| max.max(x.abs()));
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 64.0 * f64::EPSILON * scale), \"{what}\");
}

/// Marks what is not written.
const MARK: f64 = -7.5;

#[allow(unused)]
fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let n: usize = arguments[3].parse().unwrap();
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).unwrap();
    let mut numbers = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap()));
    let mut next = || numbers.next().unwrap();
    let mut found: Vec<f64> = Vec::new();
    match (arguments[1].as_str(), arguments[2].as_str()) {
";

const TAIL: &str = "\
        _ => panic!(\"no such function\"),
    }
    let bytes: Vec<u8> = found.iter().flat_map(|y| y.to_le_bytes()).collect();
    std::io::stdout().write_all(&bytes).unwrap();
}
";

fn main(robots: &[(&str, &Generated)]) -> String {
    let mut out = HEAD.to_owned();
    let reals = |g: &Generated| {
        [Real::F64, Real::F32].into_iter().filter(|r| g.source.contains(&format!("mod batch_{}", r.name()))).collect::<Vec<_>>()
    };
    for (robot, generated) in robots {
        for entry in &generated.ledger.functions {
            reals(generated).into_iter().for_each(|real| laws(&mut out, robot, entry, real, generated));
        }
    }
    out += TAIL;
    for (robot, generated) in robots {
        let _ =
            writeln!(out, "#[no_implicit_prelude]\n#[deny(unused_results, trivial_numeric_casts, unused_qualifications)]\nmod {robot};");
        reals(generated).into_iter().for_each(|r| out += &format!("leaf!({robot}::batch_{}::Lanes);\n", r.name()));
    }
    out
}

/// The laws for one function, as an arm.
fn laws(out: &mut String, robot: &str, entry: &Entry, real: Real, generated: &Generated) {
    let name = entry.function.as_str();
    let takes: Vec<&str> = entry.arguments.iter().map(|a| a.name()).collect();
    let each = |text: &str| takes.iter().map(|a| text.replace("ARG", a)).collect::<String>();
    let agree = if is_state_by_state(&generated.source, name, real) { STATE_BY_STATE } else { SAME_BLOCKS };
    let text = LAWS
        .replace("BLOCKS_AGREE", agree)
        .replace("EACH_STATE", &each("&ARG[k], "))
        .replace("EACH_VECTOR", &each("            let mut ARG = Vec::new();\n"))
        .replace("EACH_PUSH", &each("                ARG.push(Nest::<REAL>::nest(&mut || next() as REAL));\n"))
        .replace(
            "EACH_BLOCKS",
            &each("            let ARG_blocks = blocks(&ARG, Lanes::LEN, |x: &[REAL]| Lanes(x.try_into().unwrap()));\n"),
        )
        .replace("EACH_SOME", &each("&ARG[3..][..len], "))
        .replace("EACH_BLOCK", &each("&ARG_blocks, "))
        .replace("EACH", &each("&ARG, "))
        .replace("WRONG_LENGTHS", &wrong_lengths(&takes));
    *out += &text.replace("ROBOT", robot).replace("NAME", name).replace("REAL", real.name());
}

/// Whether the batch calls the function of one state for each state.
#[must_use]
pub fn is_state_by_state(source: &str, name: &str, real: Real) -> bool {
    let batch = source.split_once(&format!("pub mod batch_{}", real.name())).map_or("", |(_, batch)| batch);
    let batch = batch.split("pub mod batch_").next().unwrap_or("");
    batch.contains(&format!("super::super::{name}_into("))
}

const LAWS: &str = "\
        (\"ROBOT\", \"NAME REAL\") => {
            use ROBOT::batch_REAL::{self as batch, Lanes, LengthError};
EACH_VECTOR            for _ in 0..n {
EACH_PUSH            }
            let numbers = |x: &[_]| flat::<REAL, _>(x).into_iter().map(f64::from).collect::<Vec<f64>>();
            let mark = Nest::<REAL>::nest(&mut || MARK as REAL);
            let mut out = vec![mark; n];
            batch::NAME(EACH&mut out).unwrap();
            found = numbers(&out);
            // As many as there are, from anywhere: a state's result is its own.
            for len in 0..=2 * Lanes::LEN + 1 {
                let mut some = vec![mark; len];
                batch::NAME(EACH_SOME&mut some).unwrap();
                same(\"some states\", &numbers(&some), &numbers(&out[3..][..len]));
            }
EACH_BLOCKS            let whole = n / Lanes::LEN;
            let of_blocks = |x: &[_]| flat::<Lanes, _>(x).into_iter().flat_map(|l| l.0.map(f64::from)).collect::<Vec<f64>>();
            let mark_block = Nest::<Lanes>::nest(&mut || Lanes([MARK as REAL; Lanes::LEN]));
            let mut out_blocks = vec![mark_block; whole];
            batch::NAME_blocks(EACH_BLOCK&mut out_blocks).unwrap();
            BLOCKS_AGREE
            // States into blocks and back, however many. The last state fills the last block.
            for len in 0..=2 * Lanes::LEN + 1 {
                let states: Vec<[REAL; 3]> = (0..len).map(|i| [i as REAL, -1.0, 0.5 + i as REAL]).collect();
                let mut packed = vec![[Lanes::ZERO; 3]; Lanes::blocks(len)];
                Lanes::pack(&states, &mut packed).unwrap();
                for (i, number) in packed.iter().flat_map(|block| (0..Lanes::LEN).map(|i| block[2].0[i])).enumerate() {
                    assert_eq!(number, states[i.min(len - 1)][2]);
                }
                let mut back = vec![[MARK as REAL; 3]; len];
                Lanes::unpack(&packed, &mut back).unwrap();
                assert_eq!(back, states);
                let (found, expected) = (packed.len() + 1, packed.len());
                packed.push([Lanes::ZERO; 3]);
                let wrong = Err(LengthError { argument: \"blocks\", found, expected });
                assert_eq!([Lanes::pack(&states, &mut packed), Lanes::unpack(&packed, &mut back)], [wrong, wrong]);
            }
            // A slice that is too short is refused, whichever it is, and nothing is written.
            (out, out_blocks) = (vec![mark; n], vec![mark_block; whole]);
WRONG_LENGTHS            let written: Vec<f64> = numbers(&out).into_iter().chain(of_blocks(&out_blocks)).collect();
            assert!(written.iter().all(|x| *x == MARK));
        }
";

/// Blocks return the same bits as states one after the other.
const SAME_BLOCKS: &str = "same(\"blocks\", &of_blocks(&out_blocks), &in_blocks::<REAL, _>(&out, Lanes::LEN));";

/// States return the same bits as the function of one state. Blocks round differently.
const STATE_BY_STATE: &str = "\
let mut singles = vec![mark; n];
            for (k, out) in singles.iter_mut().enumerate() {
                ROBOT::NAME_into(EACH_STATE&mut *out);
            }
            same(\"state by state\", &numbers(&out), &numbers(&singles));
            near(\"blocks\", &of_blocks(&out_blocks), &in_blocks::<REAL, _>(&out, Lanes::LEN));";

/// Calls with one slice cut.
fn wrong_lengths(takes: &[&str]) -> String {
    let arrays: Vec<&str> = takes.iter().copied().chain(["out"]).collect();
    let mut out = String::new();
    for (short, argument) in arrays.iter().enumerate() {
        for (suffix, length) in [("", "n"), ("_blocks", "whole")] {
            let cut = |k: usize| if k == short { format!("[..{length} - 1]") } else { String::new() };
            let given: String = takes.iter().enumerate().map(|(k, a)| format!("&{a}{suffix}{}, ", cut(k))).collect();
            // The other lengths are compared with the first one.
            let (argument, found, expected) = if short == 0 { (arrays[1], 0, 1) } else { (*argument, 1, 0) };
            let error = format!("LengthError {{ argument: {argument:?}, found: {length} - {found}, expected: {length} - {expected} }}");
            let _ =
                writeln!(out, "            assert_eq!(batch::NAME{suffix}({given}&mut out{suffix}{}), Err({error}));", cut(takes.len()));
        }
    }
    out
}
