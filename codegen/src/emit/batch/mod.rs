//! Functions of many states at once: one state per lane, in the widest instruction set that the processor has.
//!
//! ```text
//! pub mod batch_f64
//!     inverse_dynamics           states one after the other
//!     inverse_dynamics_blocks    blocks of states, each number of a block in one cache line
//!     mod avx512, avx2, …        the same body in each instruction set
//! ```
//!
//! A long body has a second text for AVX2, which says what waits in memory while sixteen registers are full ([`super::spill`]).

mod arrays;
mod block;
mod public;
mod text;
mod ways;

use std::collections::HashSet;
use std::fmt::Write;

use articulated_core::algorithm::Shape;
use articulated_core::lanes::{Real, Set, source, tiles};
use articulated_core::level::Level;

use self::arrays::{Array, each, inputs, results};
use self::block::Block;
use self::text::{PUBLIC, SUPPORT};
use self::ways::{SAFE, WAYS, Way};
use crate::emit::function::Context;
use crate::emit::function::signature::Signature;
use crate::emit::memory::chunks::{cut, kept, nothing_kept};
use crate::emit::memory::spill::{self, Kind, spilled};
use crate::emit::module::used::{Caller, used};
use crate::emit::statements::dialect::Dialect;
use crate::emit::statements::flat::flat;
use crate::emit::statements::vector::Vector;
use crate::graph::{Graph, NodeId};
use crate::program::Program;

/// A function as batches have it.
pub(super) struct Batch<'a> {
    signature: Signature<'a>,
    sizes: Shape,
    /// Of plain numbers.
    graph: &'a Graph,
    /// Whether it may be said here what waits in memory.
    may_spill: bool,
    /// Operations of the function of one state, where that is straight-line code with the numbers
    /// and sines of `f64` batches. Limbs in lanes are one operation.
    operations_of_one: Option<u64>,
}

/// Statements of a piece of a long body.
const LENGTH: usize = 300;

/// From this many nodes on a body is cut: below, compilers take no less for pieces, and what goes from piece to piece costs time. Vectors fill memory sooner than numbers do, so
/// that is later than for one state.
const CUT_FROM: usize = 20_000;

/// Vectors of AVX2 are as long as so many `f64`.
const AVX2_LANES: usize = 4;

/// A sine or cosine takes as long as so many operations.
const SINE: u64 = 10;

/// To turn two numbers of a result from blocks into states takes as long as a block saves on so
/// many operations (AVX-512, Emerald Rapids).
const TWO_NUMBERS: u64 = 5;

/// A result of which more than three fifths are computed is dense: to store it takes the function
/// of one state as long.
const DENSE: (usize, usize) = (3, 5);

/// How many states a block has, whatever the instruction set: a cache line of each number.
fn states_of_block(real: Real) -> usize {
    64 / real.bytes()
}

/// The modules of batches.
pub(super) fn batches(out: &mut String, functions: &[Batch], reals: &[Real], forbid_unsafe: bool) {
    if reals.is_empty() {
        return;
    }
    functions.iter().for_each(|f| f.body(out));
    *out += SUPPORT;
    let caller = Caller::new(out.as_str());
    for real in reals {
        module(out, functions, *real, if forbid_unsafe { &SAFE } else { &WAYS }, &caller);
    }
}

fn module(out: &mut String, functions: &[Batch], real: Real, ways: &[Way], caller: &Caller) {
    let (real_name, n) = (real.name(), states_of_block(real));
    let lint = if ways.len() == 1 { "" } else { "unsafe_code, unused_unsafe, " };
    let _ = writeln!(
        out,
        "/// The functions for many states at once, in `{real_name}`: one state per lane, in the widest instruction set that the processor has.\n///\n\
         /// States stand one after the other, or in blocks of {n} with each number of all states of a block together (`Lanes`), which is faster.\n\
         /// Sines and cosines are off by at most 1 ulp.\n\
         #[allow({lint}unused_imports, unused_macros, unused_variables, dead_code, unreachable_pub, trivial_numeric_casts, unused_results, clippy::all, clippy::pedantic)]\n\
         pub mod batch_{real_name} {{\n    use super::*;\n"
    );
    *out += &PUBLIC.replace("REAL", real_name).replace("BLOCK", &n.to_string());
    for way in ways {
        way.module(out, functions, real, caller);
    }
    functions.iter().for_each(|f| f.public(out, real, ways));
    let _ = writeln!(out, "}}\n");
}

impl Way {
    fn module(&self, out: &mut String, functions: &[Batch], real: Real, caller: &Caller) {
        let (features, width) = (self.set.features(), self.bytes / real.bytes());
        let attribute = if features.is_empty() { String::new() } else { format!("#[target_feature(enable = \"{features}\")]") };
        let text: String = [source, tiles].iter().filter_map(|text| text(self.set, real, width)).collect();
        let text = used(&text, caller);
        let _ = writeln!(out, "#[cfg({})]\nmod {} {{\n    mod lanes {{\n{text}}}\n", self.cfg, self.module);
        // Functions of the robot could bear names of the lanes': its constants alone are let in.
        let parameters = if functions.iter().any(|f| f.inputs().iter().any(|a| a.is_parameters)) { ", PARAMETERS" } else { "" };
        let _ = writeln!(
            out,
            "    use ::core::{{cmp::Ord, iter::Iterator}};\n\n    use self::lanes::*;\n    use super::{{Lanes, super::{{FRAMES, LINKS, NQ, NV{parameters}}}}};"
        );
        let _ = writeln!(out, "    batch_support!({attribute});");
        let (few, more) = (spill::FEW_REGISTERS, spill::MORE_REGISTERS);
        let spills = |f: &&Batch| self.set == Set::Avx2 && caller.names(&f.that_spills());
        if functions.iter().any(|f| spills(&f)) {
            let _ = writeln!(out, "    {few}\n    use super::super::spills;");
        }
        for f in functions.iter().filter(|f| f.is_any()) {
            let name = f.name();
            if spills(&f) {
                let _ = writeln!(out, "    {few}\n    {}!({attribute});\n    {more}", f.that_spills());
            }
            let _ = writeln!(out, "    {name}_in_block!({attribute});\n    {name}_in_batch!({attribute});");
        }
        let _ = writeln!(out, "}}\n");
    }
}

impl<'a> Batch<'a> {
    pub(super) fn of(program: &'a Program, context: Context) -> Self {
        let graph = &program.plain;
        let may_spill = !context.forbid_unsafe && graph.nodes().len() >= spill::FROM;
        let signature = Signature::of(&program.wanted, context.sizes, context.parameters);
        let is_straight = program.columns.is_none() && program.groups.is_none() && context.level == Level::default();
        let counts = program.graph.counts();
        let operations_of_one = is_straight.then(|| counts.instructions() + SINE * counts.trigonometric());
        Self { signature, sizes: context.sizes, graph, may_spill, operations_of_one }
    }

    /// Whether states one after the other are faster by the function of one state, called for each
    /// of them. A block saves time for each operation, but its results have to be turned into
    /// states, which costs time for each number: also for zeros and for the other half of a
    /// symmetric matrix, which the function of one state only stores.
    fn is_faster_one_by_one(&self, real: Real) -> bool {
        let (results, outputs) = (self.results(), &self.graph.outputs);
        let has_one = results.len() == 1 && self.signature.has_into() && self.inputs().iter().all(|a| !a.is_parameters);
        let Some(operations) = self.operations_of_one.filter(|_| has_one && real == Real::F64) else { return false };
        let numbers = outputs.len();
        let computed: HashSet<NodeId> = outputs.iter().copied().filter(|id| self.graph.constant_value(*id).is_none()).collect();
        DENSE.1 * computed.len() <= DENSE.0 * numbers && 2 * operations < TWO_NUMBERS * numbers as u64
    }

    fn name(&self) -> &str {
        &self.signature.wanted.name
    }

    /// Arguments that have numbers.
    fn inputs(&self) -> Vec<Array> {
        inputs(&self.signature, self.sizes).into_iter().filter(|a| a.numbers > 0).collect()
    }

    /// Results that have numbers.
    fn results(&self) -> Vec<Array> {
        results(&self.signature, self.sizes).into_iter().filter(|a| a.numbers > 0).collect()
    }

    /// Whether there is anything to compute.
    fn is_any(&self) -> bool {
        !self.results().is_empty()
    }

    /// The body, and what calls it for blocks and for states one after the other.
    fn body(&self, out: &mut String) {
        if !self.is_any() {
            return;
        }
        let (inputs, results, name) = (self.inputs(), self.results(), self.name());
        let declared = |of: &str| each(&inputs, &format!("NAME: &{of}, ")) + &each(&results, &format!("NAME: &mut {of}, "));
        let given = |input: &str, result: &str| each(&inputs, input) + &each(&results, result);
        let gathered = |states: &str| -> String { inputs.iter().map(|a| a.gathered(&states.replace("NAME", &a.name))).collect() };
        self.blocks(out, &declared("[Lanes; { LEN }]"), &given("NAME, ", "NAME, "));
        let _ = writeln!(out, "macro_rules! {name}_in_batch {{\n    ($(#[$features:meta])?) => {{");
        let first = &results[0].name;
        let _ = writeln!(out, "    $(#[$features])?\n    pub(super) fn {name}_blocks({}) {{", declared("[[Lanes; { LEN }]]"));
        let _ =
            writeln!(out, "        for k in 0..{first}.len() {{\n            {name}_block({});", given("&NAME[AT], ", "&mut NAME[k], "));
        let _ = writeln!(out, "        }}\n    }}\n");

        let _ = writeln!(out, "    $(#[$features])?\n    pub(super) fn {name}_states({}) {{", declared("[[Real; { LEN }]]"));
        let _ = writeln!(out, "        let whole = {first}.len() / Lanes::LEN;\n        let first = whole * Lanes::LEN;");
        *out += &each(&inputs, "        let mut NAME_block = [Lanes::ZERO; { LEN }];\n");
        *out += &each(&results, "        let mut NAME_block = [Lanes::ZERO; { LEN }];\n");
        let call = format!("            {name}_block({});\n", given("&NAME_block, ", "&mut NAME_block, "));
        for shared in inputs.iter().filter(|a| a.is_parameters) {
            let _ =
                writeln!(out, "        if {0}.len() == 1 {{\n            gather(&filled({0}), &mut {0}_block);\n        }}", shared.name);
        }
        *out += "        for k in 0..whole {\n";
        *out += &gathered("&NAME.as_chunks().0[k]");
        *out += &call;
        *out += &each(&results, "            scatter(&NAME_block, &mut NAME.as_chunks_mut().0[k]);\n");
        let _ = writeln!(out, "        }}\n        if first < {first}.len() {{");
        *out += &gathered("&filled(&NAME[first..])");
        *out += &call;
        *out += &each(&results, "            scatter_some(&NAME_block, &mut NAME[first..]);\n");
        *out += "        }\n    }\n    };\n}\n\n";
    }

    /// What is computed for one block, in pieces where it is long; where it pays, for sixteen registers too.
    fn blocks(&self, out: &mut String, declared: &str, names: &str) {
        let name = self.name();
        let block = Block(Vector { graph: self.graph, signature: &self.signature });
        let length = if self.graph.nodes().len() < CUT_FROM { usize::MAX } else { LENGTH };
        let (pieces, slots) = cut(self.graph, &block, &self.places(), &[], length);
        // As many bytes of either real.
        let kind = Kind::of(block.value().0, AVX2_LANES);
        let spilled = pieces.first().filter(|_| self.may_spill && pieces.len() == 1).map(|text| spilled(text, kind));
        let spilled = spilled.filter(|text| spill::pays(text, true));
        let mut write = |name: &str, pieces: &[String]| {
            // A build may have but one of two.
            *out += if spilled.is_some() { "#[allow(unused_macros)]\n" } else { "" };
            let _ = writeln!(out, "macro_rules! {name} {{\n    ($(#[$features:meta])?) => {{");
            self.block(out, (declared, names), &block, pieces, slots);
            *out += "    };\n}\n\n";
        };
        write(&format!("{name}_in_block"), &pieces);
        if let Some(text) = &spilled {
            write(&self.that_spills(), std::slice::from_ref(text));
        }
    }

    /// The macro of a block for sixteen registers.
    fn that_spills(&self) -> String {
        format!("{}_in_block_that_spills", self.name())
    }

    fn block(&self, out: &mut String, (declared, names): (&str, &str), block: &Block, pieces: &[String], slots: usize) {
        let name = self.name();
        let m = format!("{name}_kept");
        kept(out, &m, block, slots);
        let mut calls = String::new();
        for (c, piece) in pieces.iter().enumerate() {
            let _ = writeln!(out, "    $(#[$features])?\n    #[inline(never)]");
            let _ = writeln!(
                out,
                "    fn {name}_piece_{c}({declared}part: usize, m: &mut {m}) {{\n{}{piece}    }}\n",
                block.beginning(),
                piece = flat(piece, block.value().0)
            );
            let _ = writeln!(calls, "        {name}_piece_{c}({names}part, &mut m);");
        }
        let _ = writeln!(out, "    $(#[$features])?\n    #[inline(never)]\n    fn {name}_block({declared}) {{");
        *out += &nothing_kept(&m, block, slots);
        let _ = writeln!(out, "        for part in 0..PARTS {{\n{calls}        }}\n    }}\n");
    }

    /// Where each number of the results is put.
    fn places(&self) -> Vec<String> {
        self.results().iter().flat_map(|a| (0..a.numbers).map(|k| format!("{}[{k}]", a.name)).collect::<Vec<_>>()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, generate};

    /// The mass matrix of two arms side by side is half zeros; its block of results would take
    /// longer to turn than to compute.
    #[test]
    fn sparse_results_are_computed_state_by_state_in_doubles() {
        let arm = |name: &str| {
            let link = |k: usize| {
                let parent = if k == 0 { "base".to_owned() } else { format!("{name}{}", k - 1) };
                format!(
                    "<link name='{name}{k}'><inertial><origin xyz='0.1 0 0.2'/><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
                    <joint name='{name}_{k}' type='continuous'><parent link='{parent}'/><child link='{name}{k}'/><axis xyz='0 1 0'/></joint>"
                )
            };
            (0..3).map(link).collect::<String>()
        };
        let urdf = format!("<robot name='two'><link name='base'/>{}{}{}{}</robot>", arm("a"), arm("b"), arm("c"), arm("d"));
        let mut request = Request::new("two.urdf", urdf);
        request.options.functions = vec!["mass_matrix".into(), "forward_dynamics".into()];
        request.options.batch = vec![Real::F64, Real::F32];
        let source = generate(&request).unwrap().source;
        let (_, doubles) = source.split_once("pub mod batch_f64").unwrap();
        let (doubles, singles) = doubles.split_once("pub mod batch_f32").unwrap();
        assert!(doubles.contains("mass_matrix_into(&q[k], &mut out[k]);") && !singles.contains("mass_matrix_into("));
        assert!(!doubles.contains("forward_dynamics_into("));
        assert!(doubles.contains("mass_matrix_blocks(q") && doubles.contains("forward_dynamics_states("));
    }

    #[test]
    fn parameters_are_those_of_each_state_or_one_set_for_all() {
        let urdf = "<robot name='arm'><link name='base'/><link name='tip'/>\
            <joint name='hinge' type='continuous'><parent link='base'/><child link='tip'/><axis xyz='0 1 0'/></joint></robot>";
        let mut request = Request::new("arm.urdf", urdf);
        request.options.functions = vec!["gravity_torque".into()];
        request.options.parameters = vec!["payload(tip)".into()];
        request.options.batch = vec![Real::F32];
        let source = generate(&request).unwrap().source;
        let (_, batch) = source.split_once("macro_rules! gravity_torque_in_block").unwrap();
        for words in [
            "= at(&q[0], part);",
            "= at(&parameters[1], part);",
            "gravity_torque_block(&q[k], &parameters[if parameters.len() == 1 { 0 } else { k }], &mut out[k], );",
            "parameters: &[[f32; PARAMETERS.len()]], out: &mut [[f32; NV]]",
            "super::{FRAMES, LINKS, NQ, NV, PARAMETERS}",
        ] {
            assert!(batch.contains(words), "{words} in {batch}");
        }
        request.options.parameters.clear();
        request.options.functions = vec!["mass_matrix".into()];
        assert!(!generate(&request).unwrap().source.contains("PARAMETERS}"));
    }
}
