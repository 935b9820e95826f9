//! One graph as one function.

pub(crate) mod columns;
pub(crate) mod derivatives;
pub(crate) mod levels;
pub(crate) mod results;
pub(crate) mod signature;

use std::fmt::Write;

use articulated_core::algorithm::Shape;
use articulated_core::level::Level;

use crate::emit::function::signature::{Place, Signature};
use crate::emit::memory::chunks::pieces;
use crate::emit::memory::spill;
use crate::emit::module::sets;
use crate::emit::statements::plain;
use crate::emit::statements::several;
use crate::emit::statements::vector;
use crate::emit::statements::vector::Vector;
use crate::graph::Graph;
use crate::program::Program;
use levels::real;

/// What the emitter must know besides the programs.
#[derive(Clone, Copy)]
pub(crate) struct Context {
    pub(crate) sizes: Shape,
    pub(crate) parameters: bool,
    pub(crate) forbid_unsafe: bool,
    pub(crate) level: Level,
}

impl Context {
    /// Whether instructions are chosen when it runs.
    fn chooses(self) -> bool {
        !self.forbid_unsafe && self.level.fused
    }
}

/// The function's source, with its documentation and, where it gives several results, the type that holds them.
pub(crate) fn function(out: &mut String, program: &Program, context: Context) {
    let Program { wanted, graph, .. } = program;
    let mut signature = Signature::of(wanted, context.sizes, context.parameters).with(real(context.level));
    signature.place = Place::of(program, context.level, context.forbid_unsafe);
    (signature.columns, signature.long) = (program.columns.as_ref(), levels::is_long(program, context.level));
    signature.results_type(out);
    if program.groups.is_some() {
        return loops(out, program, &signature, context);
    }
    let spilled = spilled(program, &signature, context);
    signature.has_spilled = spilled.is_some();
    if in_lanes(graph) || signature.long {
        *out += &if signature.has_spilled { format!("{}\n", spill::MORE_REGISTERS) } else { String::new() };
        body_macro(out, graph, &signature, context.level);
    }
    if let Some(text) = spilled.as_ref().filter(|_| in_lanes(graph)) {
        let _ = writeln!(out, "{}\n{text}", spill::FEW_REGISTERS);
    }
    document(out, program, &signature, context);
    if signature.place != Place::Value {
        value_form(out, &signature);
        into_form(out, &signature);
        *out += "/// Puts the result into `out`.\n";
    }
    opening(out, &wanted.name, &signature, context);
    if in_lanes(graph) {
        lanes_calls(out, graph, &signature);
    } else {
        let mut text = String::new();
        calls(&mut text, graph, &signature, context);
        *out += &match &spilled {
            Some(few) => spill::by_registers(few, &text),
            None => text,
        };
    }
    let _ = writeln!(out, "}}\n");
    if signature.place == Place::Value && signature.has_into() {
        into_form(out, &signature);
    }
}

/// The function's head, up to its first statement that computes.
fn opening(out: &mut String, name: &str, signature: &Signature, context: Context) {
    let uses = if context.forbid_unsafe { "" } else { "unsafe_code, unused_unsafe, " };
    let _ = writeln!(out, "#[allow({uses}unused_results, clippy::all, clippy::pedantic)]");
    let name = if signature.place == Place::Value { format!("pub fn {name}") } else { format!("fn {name}_fill") };
    let _ = writeln!(out, "{name}({}){} {{", signature.takes(), signature.returns());
    for input in &signature.inputs {
        let _ = writeln!(out, "    let _ = {};", input.name);
    }
}

/// The text for processors with sixteen registers, if there is one.
fn spilled(program: &Program, signature: &Signature, context: Context) -> Option<String> {
    if !spill::is_possible(program, context.level, context.forbid_unsafe) {
        return None;
    }
    let (mut out, graph, signature) = (String::new(), &program.graph, signature.that_spills());
    if in_lanes(graph) {
        body_macro(&mut out, graph, &signature, context.level);
    } else {
        calls(&mut out, graph, &signature, context);
    }
    spill::pays(&out, in_lanes(graph)).then_some(out)
}

/// The function that loops compute, of a module of their own.
fn loops(out: &mut String, program: &Program, signature: &Signature, context: Context) {
    document(out, program, signature, context);
    let (name, arguments, gives) = (&signature.wanted.name, signature.arguments(), signature.gives());
    let _ = writeln!(out, "#[inline]\npub fn {name}({arguments}) -> {gives} {{\n    let mut out = {};", signature.nothing());
    let _ = writeln!(out, "    {name}_into({});\n    out\n}}\n", signature.names_and("&mut out"));
    let _ = writeln!(out, "/// As [`{name}`], into `out`, whatever that holds.");
    let takes = signature.arguments_and(&format!("out: &mut {gives}"));
    let handed = signature.names_and("out");
    let _ = writeln!(out, "pub fn {name}_into({takes}) {{\n    derivatives::inverse_dynamics_derivatives({handed});\n}}\n");
}

/// The function as a value, where its body writes into what it is handed.
fn value_form(out: &mut String, signature: &Signature) {
    let (name, arguments, gives) = (&signature.wanted.name, signature.arguments(), signature.gives());
    let handed = signature.names_and("&mut out");
    let _ = writeln!(out, "{}#[inline]\npub fn {name}({arguments}) -> {gives} {{", allowed(signature));
    let _ = if signature.place == Place::Written {
        let _ = writeln!(out, "    let mut out = ::core::mem::MaybeUninit::uninit();\n    {name}_fill({handed});");
        writeln!(out, "    // SAFETY: it was just written, all of it.\n    unsafe {{ out.assume_init() }}\n}}\n")
    } else {
        writeln!(out, "    let mut out = {};\n    {name}_into({handed});\n    out\n}}\n", signature.nothing())
    };
}

/// The function that writes into what the caller has: a copy costs as much as a third of a function.
fn into_form(out: &mut String, signature: &Signature) {
    let (name, names, gives) = (&signature.wanted.name, signature.names(), signature.gives());
    let _ = writeln!(out, "/// As [`{name}`], into `out`, whatever that holds.\n{}#[inline]", allowed(signature));
    let _ = writeln!(out, "pub fn {name}_into({}) {{", signature.arguments_and(&format!("out: &mut {gives}")));
    let _ = match signature.place {
        Place::Value => writeln!(out, "    *out = {name}({names});\n}}\n"),
        Place::Written => {
            let _ = writeln!(out, "    // SAFETY: nothing is read there, and what is written is a value.");
            let handed = signature.names_and("unsafe { &mut *::core::ptr::from_mut(out).cast() }");
            writeln!(out, "    {name}_fill({handed});\n}}\n")
        }
        Place::Filled => {
            let _ = writeln!(out, "    {name}_fill({});", signature.names_and("out"));
            writeln!(out, "{}}}\n", if signature.columns.is_some() { "    columns::columns(out);\n" } else { "" })
        }
    };
}

fn allowed(signature: &Signature) -> &'static str {
    if signature.place == Place::Written { "#[allow(unsafe_code)]\n" } else { "" }
}

/// Whether the values are vectors.
pub(crate) fn in_lanes(graph: &Graph) -> bool {
    graph.lanes().width > 1
}

/// Whether the function profits from an instruction set that not every processor has.
pub(crate) fn needs_choice(graph: &Graph, level: Level) -> bool {
    !in_lanes(graph) && (graph.counts().fused() > 0 || plain::has_batch(graph, level) || level.of_two())
}

/// A body of plain arithmetic, in pieces or one, and its call.
fn calls(out: &mut String, graph: &Graph, signature: &Signature, context: Context) {
    if signature.long {
        long_calls(out, signature, context);
    } else if needs_choice(graph, context.level) && context.chooses() {
        chosen(out, graph, signature, context.level);
    } else {
        levels::body(out, graph, signature, context.level);
    }
}

/// Plain arithmetic, with fused multiply-add where the processor has it: compiled for it, or found to be so.
fn chosen(out: &mut String, graph: &Graph, signature: &Signature, level: Level) {
    let (takes, names, returns) = (signature.takes(), signature.handed(), signature.returns());
    let (generic, own, fused) =
        if level.of_two() { ("const FUSED: bool", "FUSED", "true") } else { ("F: Fma", "MultiplyAdd<FUSED>", "MultiplyAdd<true>") };
    let _ = writeln!(out, "    #[inline(always)]\n    fn body<{generic}>({takes}){returns} {{");
    for input in &signature.inputs {
        let _ = writeln!(out, "    let _ = {};", input.name);
    }
    levels::body(out, graph, signature, level);
    let _ = writeln!(out, "    }}\n    {}", sets::NOT_COMPILED_FOR_AVX2);
    let _ = writeln!(out, "    if {} {{", sets::HAS_AVX2);
    let _ = writeln!(
        out,
        "        #[target_feature(enable = \"avx2,fma\")]\n        fn fused({takes}){returns} {{\n            body::<{fused}>({names})\n        }}"
    );
    let _ = writeln!(out, "        // SAFETY: the processor was just asked for both.\n        return unsafe {{ fused({names}) }};\n    }}");
    let _ = writeln!(out, "    body::<{own}>({names})");
}

/// The body as a macro: it is compiled for several instruction sets.
fn body_macro(out: &mut String, graph: &Graph, signature: &Signature, level: Level) {
    let (takes, returns, name) = (signature.takes(), signature.returns(), &signature.wanted.name);
    let _ = writeln!(out, "macro_rules! {name}_body {{\n    ($(#[$features:meta])?) => {{");
    if signature.long {
        let vector = Vector { graph, signature };
        levels::with_dialect(graph, signature, level, |own| pieces(out, graph, signature, if in_lanes(graph) { &vector } else { own }));
    } else {
        let _ = writeln!(out, "    $(#[$features])?\n    #[inline]\n    fn whole({takes}){returns} {{");
        for input in &signature.inputs {
            let _ = writeln!(out, "    let _ = {};", input.name);
        }
        vector::body(out, graph, signature);
        let _ = writeln!(out, "    }}");
    }
    let _ = writeln!(out, "    }};\n}}\n");
}

/// The call of a long body of plain arithmetic.
fn long_calls(out: &mut String, signature: &Signature, context: Context) {
    let (names, name) = (signature.handed(), &signature.wanted.name);
    levels::imports(out, context.level);
    if context.chooses() {
        let _ = writeln!(out, "    {}\n    if {} {{", sets::NOT_COMPILED_FOR_AVX2, sets::HAS_AVX2);
        let fused = if context.level.of_two() { "const FUSED: bool = true" } else { "type F = MultiplyAdd<true>" };
        let _ = writeln!(out, "        {fused};\n        {name}_body!(#[target_feature(enable = \"avx2,fma\")]);");
        let _ =
            writeln!(out, "        // SAFETY: the processor was just asked for both.\n        return unsafe {{ whole({names}) }};\n    }}");
    }
    let _ = writeln!(out, "    {name}_body!();\n    whole({names})");
}

/// The call of the body for the best instruction set there is.
fn lanes_calls(out: &mut String, graph: &Graph, signature: &Signature) {
    let (names, name, width) = (signature.handed(), &signature.wanted.name, graph.lanes().width);
    let several = several::wanted(graph);
    let mut block = |cfg: &str, set: &str, features: &str, calls: &str| {
        let several = if several { format!("\n        use self::several_f64x{width}::{set}::*;") } else { String::new() };
        let _ = writeln!(
            out,
            "    {cfg}\n    {{\n        use self::{set}_f64x{width}::*;{several}\n        {name}_body!({features});\n{calls}    }}"
        );
    };
    let calls = format!(
        "        {}\n        if {} {{\n            // SAFETY: the processor was just asked for both.\n            return unsafe {{ whole({names}) }};\n        }}\n        \
         {}\n        // SAFETY: this is compiled for processors with both.\n        return unsafe {{ whole({names}) }};\n",
        sets::NOT_COMPILED_FOR_AVX2,
        sets::HAS_AVX2,
        sets::COMPILED_FOR_AVX2,
    );
    block("#[cfg(target_arch = \"x86_64\")]", "avx2", "#[target_feature(enable = \"avx2,fma\")]", &calls);
    let calls = format!("        // SAFETY: every x86-64 processor has it.\n        return unsafe {{ whole({names}) }};\n");
    block(sets::NOT_COMPILED_FOR_AVX2, "sse2", "#[target_feature(enable = \"sse2,fxsr\")]", &calls);
    let calls = format!("        // SAFETY: every 64-bit Arm processor has it.\n        return unsafe {{ whole({names}) }};\n");
    block("#[cfg(target_arch = \"aarch64\")]", "neon", "#[target_feature(enable = \"neon\")]", &calls);
    block(sets::OTHERS, "portable", "", &format!("        whole({names})\n"));
}

fn document(out: &mut String, program: &Program, signature: &Signature, context: Context) {
    let Program { wanted, entry, .. } = program;
    for part in &wanted.parts {
        let constants: Vec<String> = part.constants.iter().map(|(a, c)| format!("{} = {}", a.name(), shown(c))).collect();
        let at = if constants.is_empty() { String::new() } else { format!(", at {}", constants.join(", ")) };
        let _ = writeln!(out, "/// {}{at}.\n///", part.function.summary);
    }
    for argument in wanted.arguments() {
        let _ = writeln!(out, "/// {}: `{}` {}.", argument.name(), signature.array(argument.dims()), argument.unit());
    }
    if context.parameters {
        let _ = writeln!(out, "/// parameters: as [`PARAMETERS`].");
    }
    if let [part] = wanted.parts.as_slice() {
        let _ = writeln!(out, "/// Returns `{}` {}.\n///", signature.array(part.function.gives), part.function.unit);
        let _ = writeln!(out, "/// {}.", part.function.source);
    }
    let by = match entry.ways.join(", ") {
        ways if ways.is_empty() => ways,
        _ if program.groups.is_some() => "In loops over joints: ".into(),
        ways => format!("By {ways}, the cheapest for this robot; "),
    };
    let c = entry.emitted();
    let _ = writeln!(
        out,
        "/// {by}{} + {} in {} (multiply-adds counted once), {}{}.",
        counted(c.multiplications(), ["multiplication", "multiplications"]),
        counted(c.additions(), ["addition", "additions"]),
        counted(c.instructions(), ["instruction", "instructions"]),
        counted(c.trigonometric(), ["sine or cosine", "sines and cosines"]),
        form(program, signature)
    );
}

/// So many things, of which one and several are called so.
fn counted(n: u64, [one, several]: [&str; 2]) -> String {
    format!("{n} {}", if n == 1 { one } else { several })
}

/// What there is to say of a function's form.
fn form(program: &Program, signature: &Signature) -> String {
    let entry = &program.entry;
    if program.groups.is_some() {
        return format!(", each of {} joints at once", entry.lanes);
    }
    let lanes = if entry.lanes > 1 { format!("; limbs that are alike in {} lanes", entry.lanes) } else { String::new() };
    let pieces = if signature.long { "; in pieces, so that it is compiled in less time" } else { "" };
    let spills = if signature.has_spilled { "; for x86-64 without AVX-512 in one piece that says what waits in memory" } else { "" };
    format!(", depth {}{lanes}{pieces}{spills}", entry.depth)
}

fn shown(constant: &crate::Constant) -> String {
    match constant {
        crate::Constant::All(x) => format!("{x}"),
        crate::Constant::Each(numbers) => format!("{numbers:?}"),
    }
}
