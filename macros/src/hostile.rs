//! Whatever the tokens: a module or errors, soon, and never a panic.

use proc_macro2::TokenStream;

use crate::expand::expand;

const SEEDS: [&str; 3] = [
    include_str!("../../fuzz/seeds/macro_input/whole.txt"),
    include_str!("../../fuzz/seeds/macro_input/edits.txt"),
    include_str!("../../fuzz/seeds/macro_input/scene.txt"),
];

/// Words that an invocation may have in a place where they are wrong.
const WORDS: [&str; 26] = [
    "=",
    ",",
    "{",
    "}",
    "[",
    "]",
    "(",
    ")",
    "mod",
    "pub",
    "true",
    "-",
    "1e400",
    "0x10",
    "-0.0",
    "\"\"",
    "\"\\u{0}\"",
    "'a'",
    "r#type",
    "::",
    "functions",
    "urdf",
    "coupling",
    "first_of_duplicates",
    "lock",
    "99999999999999999999",
];

/// xorshift64*, so that a failure can be repeated from its seed.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 20) as usize % n.max(1)
    }
}

/// The words of a text: letters and digits together, all else one by one.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = vec![String::new()];
    for c in text.chars() {
        let alone = !(c.is_alphanumeric() || "_.\"/".contains(c));
        match words.last_mut() {
            Some(last) if !alone => last.push(c),
            _ => words.extend([c.to_string(), String::new()]),
        }
    }
    words
}

fn mutated(seed: &str, random: &mut Random) -> String {
    let mut words = words(seed);
    for _ in 0..1 + random.below(3) {
        let (at, other) = (random.below(words.len()), random.below(words.len()));
        match random.below(5) {
            0 => drop(words.remove(at)),
            1 => words.swap(at, other),
            2 => words.insert(at, words[other].clone()),
            3 => words[at] = WORDS[random.below(WORDS.len())].to_owned(),
            _ => words.insert(at, format!(" {} ", WORDS[random.below(WORDS.len())])),
        }
    }
    words.concat()
}

/// Whether it expanded without an error; the output is Rust either way.
fn answer(text: &str) -> Option<bool> {
    let tokens: TokenStream = text.parse().ok()?;
    let expanded = std::panic::catch_unwind(|| expand(tokens)).unwrap_or_else(|_| panic!("panic at {text}"));
    assert!(syn::parse2::<syn::File>(expanded.clone()).is_ok(), "no Rust comes out of {text}");
    let out = expanded.to_string();
    assert!(out.len() < 10_000_000, "{} bytes come out of {text}", out.len());
    Some(!out.contains("compile_error"))
}

#[test]
fn mutated_invocations_are_modules_or_errors() {
    let (mut wholes, mut tokens) = (0, 0);
    for seed in 1..=120 {
        let mut random = Random(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(seed));
        let text = mutated(SEEDS[seed as usize % SEEDS.len()], &mut random);
        if let Some(whole) = answer(&text) {
            tokens += 1;
            wholes += usize::from(whole);
        }
    }
    // All ways are walked: no tokens, errors, modules.
    assert!((40..120).contains(&tokens) && (5..tokens).contains(&wholes), "{tokens} {wholes}");
}

#[test]
fn seeds_expand() {
    SEEDS.iter().for_each(|seed| assert_eq!(answer(seed), Some(true), "{seed}: {}", expand(seed.parse().unwrap())));
}

/// Deeper than anybody writes; the compiler itself refuses more.
#[test]
fn deep_brackets_are_refused() {
    for (open, close) in [("[", "]"), ("{", "}"), ("(", ")")] {
        let deep = open.repeat(100) + "1" + &close.repeat(100);
        for key in ["functions", "lock", "gravity", "effects", "nonsense"] {
            assert_eq!(answer(&format!("mod m {{ urdf = \"../tests/ui/urdf/clash.urdf\", {key} = {deep} }}")), Some(false));
        }
    }
}
