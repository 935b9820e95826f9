//! Functions of many states at once: a state a lane, in the widest instruction set that the processor has.
//!
//! ```text
//! pub mod batch_f64
//!     inverse_dynamics           states one after the other
//!     inverse_dynamics_blocks    blocks of states, each number of a block in one cache line
//!     mod avx512, avx2, …        the same body in each instruction set
//! ```

use std::fmt::Write;

use articulated_core::algorithm::Dim;
use articulated_core::lanes::{Real, Set, source};

use super::function::Context;
use super::sets::HAS_AVX2;
use super::signature::Signature;
use super::vector;
use crate::graph::Graph;
use crate::program::Program;

/// A function as batches have it.
pub(super) struct Batch<'a> {
    signature: Signature<'a>,
    /// Of plain numbers.
    graph: &'a Graph,
}

/// How many states a block has, whatever the instruction set: a cache line of each number.
fn states_of_block(real: Real) -> usize {
    64 / bytes(real)
}

fn bytes(real: Real) -> usize {
    if real == Real::F32 { 4 } else { 8 }
}

/// The name of the type in Rust.
pub(super) fn name(real: Real) -> &'static str {
    if real == Real::F32 { "f32" } else { "f64" }
}

/// An instruction set as batches use it.
struct Way {
    module: &'static str,
    set: Set,
    /// Bytes of a vector.
    bytes: usize,
    /// Where it is compiled.
    cfg: &'static str,
    /// What is asked of the processor; for one that all processors have that it is compiled for, nothing.
    asked: &'static str,
}

macro_rules! avx512 {
    () => {
        "all(target_feature = \"avx512f\", target_feature = \"avx512dq\", target_feature = \"avx2\", target_feature = \"fma\")"
    };
}

macro_rules! avx2 {
    () => {
        "all(target_feature = \"avx2\", target_feature = \"fma\")"
    };
}

/// The widest first.
const WAYS: [Way; 5] = [
    Way {
        module: "avx512",
        set: Set::Avx512,
        bytes: 64,
        cfg: "target_arch = \"x86_64\"",
        asked: "::std::is_x86_feature_detected!(\"avx512f\") && ::std::is_x86_feature_detected!(\"avx512dq\") && ::std::is_x86_feature_detected!(\"avx2\") && ::std::is_x86_feature_detected!(\"fma\")",
    },
    Way { module: "avx2", set: Set::Avx2, bytes: 32, cfg: concat!("all(target_arch = \"x86_64\", not(", avx512!(), "))"), asked: HAS_AVX2 },
    Way { module: "sse2", set: Set::Sse2, bytes: 16, cfg: concat!("all(target_arch = \"x86_64\", not(", avx2!(), "))"), asked: "true" },
    Way { module: "neon", set: Set::Neon, bytes: 16, cfg: "target_arch = \"aarch64\"", asked: "true" },
    Way {
        module: "portable",
        set: Set::Portable,
        bytes: 64,
        cfg: "not(any(target_arch = \"x86_64\", target_arch = \"aarch64\"))",
        asked: "true",
    },
];

/// Without `unsafe`.
const SAFE: [Way; 1] = [Way { module: "portable", set: Set::Portable, bytes: 64, cfg: "all()", asked: "true" }];

/// The modules of batches.
pub(super) fn batches(out: &mut String, functions: &[Batch], reals: &[Real], forbid_unsafe: bool) {
    if reals.is_empty() {
        return;
    }
    functions.iter().for_each(|f| f.body(out));
    *out += SUPPORT;
    for real in reals {
        module(out, functions, *real, if forbid_unsafe { &SAFE } else { &WAYS });
    }
}

fn module(out: &mut String, functions: &[Batch], real: Real, ways: &[Way]) {
    let (real_name, n) = (name(real), states_of_block(real));
    let lint = if ways.len() == 1 { "" } else { "unsafe_code, unused_unsafe, " };
    let _ = writeln!(
        out,
        "/// The functions for many states at once, in `{real_name}`: a state a lane, in the widest instruction set that the processor has.\n///\n\
         /// States stand one after the other, or in blocks of {n} with each number of all states of a block together ([`Lanes`]), which is faster.\n\
         /// Sines and cosines are off by at most 1 ulp.\n\
         #[allow({lint}unused_imports, unused_macros, dead_code, unreachable_pub, clippy::all, clippy::pedantic)]\n\
         pub mod batch_{real_name} {{\n    use super::*;\n"
    );
    *out += &PUBLIC.replace("REAL", real_name).replace("BLOCK", &n.to_string());
    for way in ways {
        way.module(out, functions, real);
    }
    functions.iter().for_each(|f| f.public(out, real_name, ways));
    let _ = writeln!(out, "}}\n");
}

impl Way {
    fn module(&self, out: &mut String, functions: &[Batch], real: Real) {
        let (features, width) = (self.set.features(), self.bytes / bytes(real));
        let attribute = if features.is_empty() { String::new() } else { format!("#[target_feature(enable = \"{features}\")]") };
        let text = source(self.set, real, width).unwrap_or_default();
        let _ = writeln!(out, "#[cfg({})]\nmod {} {{\n    mod lanes {{\n{text}}}\n", self.cfg, self.module);
        let _ = writeln!(out, "    use self::lanes::*;\n    use super::{{Lanes, super::*}};\n    batch_support!({attribute});");
        for f in functions {
            let _ = writeln!(out, "    {}_in_batch!({attribute});", f.name());
        }
        let _ = writeln!(out, "}}\n");
    }
}

/// An argument or a result of a batch.
struct Array {
    name: String,
    dims: Vec<Dim>,
}

impl Array {
    /// How many numbers, as an expression.
    fn len(&self) -> String {
        let lengths: Vec<String> = self.dims.iter().map(Dim::to_string).collect();
        if lengths.is_empty() { "1".into() } else { lengths.join(" * ") }
    }

    /// Its type for one state or block.
    fn nested(&self, of: &str) -> String {
        self.dims.iter().rev().fold(of.to_owned(), |inner, dim| format!("[{inner}; {dim}]"))
    }

    /// The slice of all states as a slice of flat arrays.
    fn flat(&self, mutable: bool) -> String {
        let m = if mutable { "_mut" } else { "" };
        match self.dims.len() {
            1 => self.name.clone(),
            n => format!("{}{}.as_chunks{m}::<{{ {} }}>().0", self.name, format!(".as_flattened{m}()").repeat(n), self.len()),
        }
    }
}

impl<'a> Batch<'a> {
    pub(super) fn of(program: &'a Program, context: Context) -> Self {
        Self { signature: Signature::of(&program.wanted, context.sizes, context.parameters), graph: &program.plain }
    }

    fn name(&self) -> &str {
        &self.signature.wanted.name
    }

    fn inputs(&self) -> Vec<Array> {
        self.signature.wanted.arguments().iter().map(|a| Array { name: a.name().into(), dims: a.dims().to_vec() }).collect()
    }

    fn results(&self) -> Vec<Array> {
        let parts = &self.signature.wanted.parts;
        let name = |f: &str| if parts.len() == 1 { "out".into() } else { f.to_owned() };
        parts.iter().map(|p| Array { name: name(p.function.name), dims: p.function.gives.to_vec() }).collect()
    }

    /// `, parameters: &[f64; PARAMETERS.len()]`, where there are any: the same for all states.
    fn parameters(&self) -> (&'static str, &'static str) {
        let any = self.signature.inputs.len() > self.inputs().len();
        if any { ("parameters: &[f64; PARAMETERS.len()], ", "parameters, ") } else { ("", "") }
    }

    /// Arguments, each declared by `of`.
    fn declared(&self, of: impl Fn(&Array, bool) -> String) -> String {
        let inputs = self.inputs();
        let inputs: Vec<String> = inputs.iter().map(|a| format!("{}: &{}", a.name, of(a, false))).collect();
        let results: Vec<String> = self.results().iter().map(|a| format!("{}: &mut {}", a.name, of(a, true))).collect();
        format!("{}{}{}", inputs.join(", ") + ", ", self.parameters().0, results.join(", "))
    }

    /// The body, and what calls it for each block.
    fn body(&self, out: &mut String) {
        let (name, parameters) = (self.name(), self.parameters().1);
        let flat = |of: &str| self.declared(|a, _| format!("[[{of}; {{ {} }}]]", a.len()));
        let _ = writeln!(out, "macro_rules! {name}_in_batch {{\n    ($(#[$features:meta])?) => {{");
        let _ =
            writeln!(out, "    $(#[$features])?\n    fn {name}_block({}) {{", self.declared(|a, _| format!("[Lanes; {{ {} }}]", a.len())));
        let _ = writeln!(out, "    for part in 0..PARTS {{");
        vector::block(out, self.graph, &self.signature, &self.places());
        let _ = writeln!(out, "    }}\n    }}");
        let of_block = |at: &str| {
            let inputs = self.inputs().into_iter().map(|a| format!("&{}[{at}], ", a.name));
            inputs.collect::<String>()
                + parameters
                + &self.results().iter().map(|a| format!("&mut {}[{at}]", a.name)).collect::<Vec<_>>().join(", ")
        };
        let first = &self.results()[0].name;
        let _ = writeln!(out, "    $(#[$features])?\n    pub(super) fn {name}_blocks({}) {{", flat("Lanes"));
        let _ = writeln!(out, "        for k in 0..{first}.len() {{\n            {name}_block({});\n        }}\n    }}", of_block("k"));
        let _ = writeln!(out, "    $(#[$features])?\n    pub(super) fn {name}_states({}) {{", flat("Real"));
        let gathered: String = self.inputs().iter().map(|a| format!("&gather({}, first), ", a.name)).collect();
        let blocks: String = self
            .results()
            .iter()
            .map(|a| format!("            let mut {0}_block = [Lanes::ZERO; {{ {1} }}];\n", a.name, a.len()))
            .collect();
        let given: Vec<String> = self.results().iter().map(|a| format!("&mut {}_block", a.name)).collect();
        let scattered: String = self.results().iter().map(|a| format!("            scatter(&{0}_block, first, {0});\n", a.name)).collect();
        let _ = writeln!(
            out,
            "        let mut first = 0;\n        while first < {first}.len() {{\n{blocks}            {name}_block({gathered}{parameters}{});\n{scattered}            first += Lanes::LEN;\n        }}\n    }}",
            given.join(", ")
        );
        let _ = writeln!(out, "    }};\n}}\n");
    }

    /// Where each number of the results is put.
    fn places(&self) -> Vec<String> {
        let lengths = self.signature.lengths();
        self.results().iter().zip(lengths).flat_map(|(a, n)| (0..n).map(|k| format!("{}[{k}]", a.name)).collect::<Vec<_>>()).collect()
    }

    /// The functions of the module, for states one after the other and for blocks.
    fn public(&self, out: &mut String, real: &str, ways: &[Way]) {
        let (name, doc) = (self.name(), self.signature.wanted.parts.iter().map(|p| p.function.summary).collect::<Vec<_>>().join("; "));
        for (suffix, of, what) in [("", real, "states"), ("_blocks", "Lanes", "blocks")] {
            let inner = if suffix.is_empty() { "_states" } else { "_blocks" };
            let declared = self.declared(|a, _| format!("[{}]", a.nested(of)));
            let counted = self.inputs().into_iter().chain(self.results()).collect::<Vec<_>>();
            let _ = writeln!(
                out,
                "/// {doc}; for as many {what} as the first argument has.\n///\n/// # Errors\n/// If another slice has another length: nothing is computed."
            );
            let _ = writeln!(out, "pub fn {name}{suffix}({declared}) -> ::core::result::Result<(), LengthError> {{");
            for other in &counted[1..] {
                let _ = writeln!(out, "    LengthError::unless(\"{0}\", {0}.len(), {1}.len())?;", other.name, counted[0].name);
            }
            let inputs: String = self.inputs().iter().map(|a| a.flat(false) + ", ").collect();
            let results: Vec<String> = self.results().iter().map(|a| a.flat(true)).collect();
            let call = format!("{name}{inner}({inputs}{}{})", self.parameters().1, results.join(", "));
            for Way { module, cfg, asked, set, .. } in ways {
                let call = if *set == Set::Portable {
                    format!("{module}::{call};")
                } else {
                    format!("// SAFETY: the processor has these instructions.\n        unsafe {{ {module}::{call} }};")
                };
                let _ = writeln!(
                    out,
                    "    #[cfg({cfg})]\n    if {asked} {{\n        {call}\n        return ::core::result::Result::Ok(());\n    }}"
                );
            }
            let _ = writeln!(out, "    #[allow(unreachable_code)]\n    ::core::result::Result::Ok(())\n}}\n");
        }
    }
}

/// What bodies need besides the arithmetic.
const SUPPORT: &str = "\
macro_rules! batch_support {
    ($(#[$features:meta])?) => {
        /// How many vectors a block has of each number.
        const PARTS: usize = Lanes::LEN / LANES;

        $(#[$features])?
        #[inline]
        fn at(from: &Lanes, part: usize) -> V {
            load(&from.0.as_chunks::<LANES>().0[part])
        }

        $(#[$features])?
        #[inline]
        fn put(to: &mut Lanes, part: usize, x: V) {
            store(x, &mut to.0.as_chunks_mut::<LANES>().0[part]);
        }

        /// States one after the other as a block; behind the last one, the last again.
        $(#[$features])?
        #[inline]
        fn gather<const N: usize>(states: &[[Real; N]], first: usize) -> [Lanes; N] {
            let mut block = [Lanes::ZERO; N];
            let rows: [&[Real; N]; Lanes::LEN] = ::core::array::from_fn(|lane| &states[(first + lane).min(states.len() - 1)]);
            for k in 0..N {
                for part in 0..PARTS {
                    let numbers: [Real; LANES] = ::core::array::from_fn(|lane| rows[part * LANES + lane][k]);
                    put(&mut block[k], part, lanes(numbers));
                }
            }
            block
        }

        $(#[$features])?
        #[inline]
        fn scatter<const N: usize>(block: &[Lanes; N], first: usize, states: &mut [[Real; N]]) {
            for (lane, state) in states[first..].iter_mut().take(Lanes::LEN).enumerate() {
                for k in 0..N {
                    state[k] = block[k].0[lane];
                }
            }
        }
    };
}

";

/// What the module shows besides the functions.
const PUBLIC: &str = "\
    /// One number of each state of a block.
    #[repr(align(64))]
    #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq)]
    pub struct Lanes(pub [REAL; BLOCK]);

    impl Lanes {
        /// How many states a block has.
        pub const LEN: usize = BLOCK;
        /// Zero in every state.
        pub const ZERO: Self = Self([0.0; BLOCK]);
    }

    /// Slices of different lengths.
    #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq, ::core::cmp::Eq)]
    pub struct LengthError {
        /// Which argument.
        pub argument: &'static str,
        /// How long it is.
        pub found: usize,
        /// How long the first one is.
        pub expected: usize,
    }

    impl LengthError {
        fn unless(argument: &'static str, found: usize, expected: usize) -> ::core::result::Result<(), Self> {
            if found == expected { ::core::result::Result::Ok(()) } else { ::core::result::Result::Err(Self { argument, found, expected }) }
        }
    }

    impl ::core::fmt::Display for LengthError {
        fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
            ::core::write!(f, \"argument {}: found {} states, expected {} as in the first argument\", self.argument, self.found, self.expected)
        }
    }

    impl ::core::error::Error for LengthError {}

";
