//! Functions of many states at once: one state per lane, in the widest instruction set that the
//! processor has.
//!
//! ```text
//! pub mod batch_f64
//!     inverse_dynamics           states one after the other
//!     inverse_dynamics_blocks    blocks of states, each number of a block in one cache line
//!     mod avx512, avx2, …        the same body in each instruction set
//! ```
//!
//! A long body has a second text for AVX2, with spill slots for sixteen registers
//! ([`super::spills`]).

mod arrays;
mod public;
mod text;
mod ways;

use std::fmt::Write;

use articulated_core::lanes::{Real, Set, source, tiles};

use self::arrays::{Array, each, inputs, results};
use self::text::{PUBLIC, SUPPORT};
use self::ways::{SAFE, Variant, WAYS};
use crate::Precision;
use crate::language::rust::RustOptions;
use crate::language::rust::function::body::{beginning, kept_types, nothing_kept};
use crate::language::rust::requirements::Requirements;
use crate::language::rust::spills;
use crate::language::rust::statements::{Place, Printer, ty};
use crate::language::rust::tree_shake::tree_shake;
use crate::lir::Body;
use crate::lir::function::{Function, States};

/// A function as batches have it.
pub(crate) struct Batch<'a> {
    function: &'a Function<'a>,
    states: &'a States,
    level: Precision,
}

/// How many states a block has, whatever the instruction set: a cache line of each number.
fn states_of_block(real: Real) -> usize {
    64 / real.bytes()
}

/// The modules of batches.
pub(crate) fn batches(out: &mut String, functions: &[Batch], reals: &[Real], rust: &RustOptions) {
    if reals.is_empty() {
        return;
    }
    functions.iter().for_each(|f| f.body(out));
    *out += SUPPORT;
    let mut calls = Requirements::default();
    calls.add_helper(SUPPORT);
    for Batch { states, .. } in functions {
        calls.add_body(&states.body);
        states.few_registers.iter().for_each(|body| calls.add_body(body));
    }
    for real in reals {
        module(out, functions, *real, if rust.forbid_unsafe { &SAFE } else { &WAYS }, (rust.no_std, &calls));
    }
}

fn module(out: &mut String, functions: &[Batch], real: Real, ways: &[Variant], helpers: (bool, &Requirements)) {
    let (real_name, n) = (real.name(), states_of_block(real));
    let lint = if ways.len() == 1 { "" } else { "unsafe_code, unused_unsafe, " };
    let _ = writeln!(
        out,
        "/// The functions for many states at once, in `{real_name}`: one state per lane, in the widest instruction set that the processor has.\n///\n\
         /// States are one after the other, or in blocks of {n} with each number of all states of a block together (`Lanes`), which is faster.\n\
         /// Sines and cosines are off by at most 1 ulp.\n\
         #[allow({lint}unused_imports, unused_macros, unused_variables, dead_code, unreachable_pub, trivial_numeric_casts, unused_results, clippy::all, clippy::pedantic)]\n\
         pub mod batch_{real_name} {{\n    use super::*;\n"
    );
    *out += &PUBLIC.replace("REAL", real_name).replace("BLOCK", &n.to_string());
    for way in ways {
        way.module(out, functions, real, helpers);
    }
    functions.iter().for_each(|f| f.public(out, real, ways));
    let _ = writeln!(out, "}}\n");
}

impl Variant {
    fn module(&self, out: &mut String, functions: &[Batch], real: Real, (no_std, calls): (bool, &Requirements)) {
        let (features, width) = (self.set.features(), self.bytes / real.bytes());
        let attribute = if features.is_empty() { String::new() } else { format!("#[target_feature(enable = \"{features}\")]") };
        let text: String = [source, tiles].iter().filter_map(|text| text(self.set, real, width)).collect();
        let float = if no_std { "use super::super::super::Float;\n\n" } else { "" };
        let text = float.to_owned() + &tree_shake(&text, calls);
        let _ = writeln!(out, "#[doc(hidden)]\n#[cfg({})]\nmod {} {{\n    mod lanes {{\n{text}}}\n", self.cfg, self.module);
        // Functions of the robot could have the names of the lanes' functions: only its constants
        // are imported.
        let mut more = if functions.iter().any(|f| f.function.is_of_actuators()) { ", NA, NU".to_owned() } else { String::new() };
        if functions.iter().any(|f| f.function.is_of_contacts()) {
            more += ", CONTACTS";
        }
        if functions.iter().any(|f| f.function.is_of_given()) {
            more += ", GIVEN";
        }
        if functions.iter().any(|f| f.inputs().iter().any(|a| a.is_parameters)) {
            more += ", PARAMETERS";
        }
        let _ = writeln!(
            out,
            "    use ::core::{{cmp::Ord, iter::Iterator}};\n\n    use self::lanes::*;\n    use super::{{Lanes, super::{{FRAMES, LINKS, NQ, NV{more}}}}};"
        );
        let _ = writeln!(out, "    batch_support!({attribute});");
        let (few, more) = (spills::FEW_REGISTERS, spills::MORE_REGISTERS);
        let spills = |f: &&Batch| self.set == Set::Avx2 && f.states.few_registers.is_some();
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
    /// `None` if there is no function of many states.
    pub(crate) fn of(function: &'a Function<'a>, level: Precision) -> Option<Self> {
        Some(Self { function, states: function.states.as_ref()?, level })
    }

    fn name(&self) -> &str {
        &self.function.spec.name
    }

    /// Arguments that have numbers.
    fn inputs(&self) -> Vec<Array> {
        inputs(self.function).into_iter().filter(|a| a.numbers > 0).collect()
    }

    /// Results that have numbers.
    fn results(&self) -> Vec<Array> {
        results(self.function).into_iter().filter(|a| a.numbers > 0).collect()
    }

    /// Whether there is anything to compute.
    fn is_any(&self) -> bool {
        !self.results().is_empty()
    }

    /// The body, and its callers for blocks and for states one after the other.
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

    /// The computation of one block, in pieces if it is long; if it pays, also for sixteen
    /// registers.
    fn blocks(&self, out: &mut String, declared: &str, names: &str) {
        let (name, States { body, few_registers }) = (self.name(), self.states);
        let mut write = |name: &str, body: &Body| {
            // A build may have but one of two.
            *out += if few_registers.is_some() { "#[allow(unused_macros)]\n" } else { "" };
            let _ = writeln!(out, "macro_rules! {name} {{\n    ($(#[$features:meta])?) => {{");
            self.block(out, (declared, names), body);
            *out += "    };\n}\n\n";
        };
        write(&format!("{name}_in_block"), body);
        if let Some(few) = few_registers {
            write(&self.that_spills(), few);
        }
    }

    /// The macro of a block for sixteen registers.
    fn that_spills(&self) -> String {
        format!("{}_in_block_that_spills", self.name())
    }

    fn block(&self, out: &mut String, (declared, names): (&str, &str), body: &Body) {
        let name = self.name();
        let m = format!("{name}_kept");
        kept_types(out, &m, body);
        let places = |at: usize| self.place(at);
        let printer = Printer { body, arguments: &self.function.arguments, level: self.level, places: &places, is_raw: false };
        let mut calls = String::new();
        for (c, piece) in body.pieces.iter().enumerate() {
            let _ = writeln!(out, "    $(#[$features])?\n    #[inline(never)]");
            let _ = writeln!(out, "    fn {name}_piece_{c}({declared}part: usize, m: &mut {m}) {{");
            *out += beginning(body);
            if let Some(slots) = &body.slots {
                spills::beginning(out, slots, ty(body.ty).0);
            }
            printer.statements(out, piece);
            *out += if body.slots.is_some() { spills::END } else { "" };
            *out += "    }\n\n";
            let _ = writeln!(calls, "        {name}_piece_{c}({names}part, &mut m);");
        }
        let _ = writeln!(out, "    $(#[$features])?\n    #[inline(never)]\n    fn {name}_block({declared}) {{");
        *out += &nothing_kept(&m, body);
        let _ = writeln!(out, "        for part in 0..PARTS {{\n{calls}        }}\n    }}\n");
    }

    /// Where a number of the results is put.
    fn place(&self, mut at: usize) -> Place {
        for array in self.results() {
            if at < array.numbers {
                return Place { array: array.name, index: Some(at) };
            }
            at -= array.numbers;
        }
        Place { array: String::new(), index: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, generate};

    /// The mass matrix of two arms side by side is half zeros; transposing its block of results
    /// would take longer than computing it.
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
