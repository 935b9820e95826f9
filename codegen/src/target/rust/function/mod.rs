//! One function.

pub(crate) mod body;
pub(crate) mod levels;
pub(crate) mod results;
pub(crate) mod signature;

use std::fmt::Write;

use crate::Level;
use crate::graph::Op;
use crate::lir::function::{Ending, Function};
use crate::lir::{Body, Expr, Stmt};
use crate::target::rust::function::body::{body, pieces};
use crate::target::rust::function::signature::Signature;
use crate::target::rust::module::sets;
use crate::target::rust::several;
use crate::target::rust::spills;
use levels::real;

/// What the printer must know besides the functions.
#[derive(Clone, Copy)]
pub(crate) struct Context {
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
pub(crate) fn function(out: &mut String, function: &Function, context: Context) {
    let signature = Signature::of(function, real(context.level));
    signature.results_type(out);
    if function.groups.is_some() {
        return loops(out, &signature, context);
    }
    let (in_lanes, few) = (function.in_lanes(), function.few_registers.as_ref());
    if in_lanes || function.is_outlined {
        *out += &if few.is_some() { format!("{}\n", spills::MORE_REGISTERS) } else { String::new() };
        body_macro(out, &function.body, &signature, context.level);
    }
    if let Some(few) = few.filter(|_| in_lanes) {
        let _ = writeln!(out, "{}", spills::FEW_REGISTERS);
        body_macro(out, few, &signature, context.level);
        *out += "\n";
    }
    document(out, &signature, context);
    if function.ending != Ending::Value {
        value_form(out, &signature);
        into_form(out, &signature);
        *out += "/// Puts the result into `out`.\n";
    }
    opening(out, &signature, context);
    if in_lanes {
        lanes_calls(out, &signature);
    } else {
        let text = |body: &Body| {
            let mut text = String::new();
            calls(&mut text, body, &signature, context);
            text
        };
        *out += &match few {
            Some(few) => spills::by_registers(&text(few), &text(&function.body)),
            None => text(&function.body),
        };
    }
    let _ = writeln!(out, "}}\n");
    if function.ending == Ending::Value && signature.has_into() {
        into_form(out, &signature);
    }
}

/// The function's head, up to its first statement that computes.
fn opening(out: &mut String, signature: &Signature, context: Context) {
    let (name, uses) = (signature.name(), if context.forbid_unsafe { "" } else { "unsafe_code, unused_unsafe, " });
    let _ = writeln!(out, "#[allow({uses}unused_results, clippy::all, clippy::pedantic)]");
    let name = if signature.function.ending == Ending::Value { format!("pub fn {name}") } else { format!("fn {name}_fill") };
    let _ = writeln!(out, "{name}({}){} {{", signature.takes(), signature.returns());
    for argument in &signature.function.arguments {
        let _ = writeln!(out, "    let _ = {};", argument.name);
    }
}

/// The function that loops compute, of a module of their own.
fn loops(out: &mut String, signature: &Signature, context: Context) {
    document(out, signature, context);
    let (name, arguments, gives) = (signature.name(), signature.arguments(), signature.gives());
    let _ = writeln!(out, "#[inline]\npub fn {name}({arguments}) -> {gives} {{\n    let mut out = {};", signature.nothing());
    let _ = writeln!(out, "    {name}_into({});\n    out\n}}\n", signature.names_and("&mut out"));
    let _ = writeln!(out, "/// As [`{name}`], into `out`, whatever that holds.");
    let takes = signature.arguments_and(&format!("out: &mut {gives}"));
    let handed = signature.names_and("out");
    let _ = writeln!(out, "pub fn {name}_into({takes}) {{\n    derivatives::inverse_dynamics_derivatives({handed});\n}}\n");
}

/// The function as a value, where its body writes into what it is handed.
fn value_form(out: &mut String, signature: &Signature) {
    let (name, arguments, gives) = (signature.name(), signature.arguments(), signature.gives());
    let handed = signature.names_and("&mut out");
    let _ = writeln!(out, "{}#[inline]\npub fn {name}({arguments}) -> {gives} {{", allowed(signature));
    let _ = if is_written(signature) {
        let _ = writeln!(out, "    let mut out = ::core::mem::MaybeUninit::uninit();\n    {name}_fill({handed});");
        writeln!(out, "    // SAFETY: it was just written, all of it.\n    unsafe {{ out.assume_init() }}\n}}\n")
    } else {
        writeln!(out, "    let mut out = {};\n    {name}_into({handed});\n    out\n}}\n", signature.nothing())
    };
}

/// The function that writes into what the caller has: a copy costs as much as a third of a function.
fn into_form(out: &mut String, signature: &Signature) {
    let (name, names, gives) = (signature.name(), signature.names(), signature.gives());
    let _ = writeln!(out, "/// As [`{name}`], into `out`, whatever that holds.\n{}#[inline]", allowed(signature));
    let _ = writeln!(out, "pub fn {name}_into({}) {{", signature.arguments_and(&format!("out: &mut {gives}")));
    let _ = match signature.function.ending {
        Ending::Value => writeln!(out, "    *out = {name}({names});\n}}\n"),
        Ending::Written | Ending::Rows => {
            let _ = writeln!(out, "    // SAFETY: nothing is read there, and what is written is a value.");
            let handed = signature.names_and("unsafe { &mut *::core::ptr::from_mut(out).cast() }");
            writeln!(out, "    {name}_fill({handed});\n}}\n")
        }
        Ending::Filled => {
            let _ = writeln!(out, "    {name}_fill({});", signature.names_and("out"));
            writeln!(out, "{}}}\n", if signature.function.columns.is_some() { "    columns::columns(out);\n" } else { "" })
        }
    };
}

fn allowed(signature: &Signature) -> &'static str {
    if is_written(signature) { "#[allow(unsafe_code)]\n" } else { "" }
}

/// Whether the result is written to memory that holds no value yet.
fn is_written(signature: &Signature) -> bool {
    matches!(signature.function.ending, Ending::Written | Ending::Rows)
}

/// Whether the function profits from an instruction set that not every processor has.
pub(crate) fn needs_choice(function: &Function, level: Level) -> bool {
    let fuses = |s: &Stmt| matches!(s, Stmt::Let(_, Expr::Op(Op::MulAdd | Op::MulSub | Op::NegMulAdd | Op::NegMulSub, _)));
    !function.in_lanes() && (function.body.pieces.iter().flatten().any(fuses) || has_batch(&function.body) || level.of_two())
}

/// Whether sines of several angles are computed together.
pub(crate) fn has_batch(body: &Body) -> bool {
    body.pieces.iter().flatten().any(|s| matches!(s, Stmt::SinCos { alone: false, .. }))
}

/// A body of plain arithmetic, in pieces or one, and its call.
fn calls(out: &mut String, body: &Body, signature: &Signature, context: Context) {
    if body.pieces.len() > 1 || signature.function.is_outlined && body.slots.is_none() {
        long_calls(out, signature, context);
    } else if needs_choice(signature.function, context.level) && context.chooses() {
        chosen(out, body, signature, context.level);
    } else {
        levels::imports(out, context.level);
        self::body(out, body, signature, context.level);
    }
}

/// Plain arithmetic, with fused multiply-add where the processor has it: compiled for it, or found to be so.
fn chosen(out: &mut String, body: &Body, signature: &Signature, level: Level) {
    let (takes, names, returns) = (signature.takes(), signature.handed(), signature.returns());
    let (generic, own, fused) =
        if level.of_two() { ("const FUSED: bool", "FUSED", "true") } else { ("F: Fma", "MultiplyAdd<FUSED>", "MultiplyAdd<true>") };
    let _ = writeln!(out, "    #[inline(always)]\n    fn body<{generic}>({takes}){returns} {{");
    for argument in &signature.function.arguments {
        let _ = writeln!(out, "    let _ = {};", argument.name);
    }
    levels::imports(out, level);
    self::body(out, body, signature, level);
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
fn body_macro(out: &mut String, body: &Body, signature: &Signature, level: Level) {
    let (takes, returns, name) = (signature.takes(), signature.returns(), signature.name());
    let _ = writeln!(out, "macro_rules! {name}_body {{\n    ($(#[$features:meta])?) => {{");
    if signature.function.is_outlined && body.slots.is_none() {
        pieces(out, body, signature, level);
    } else {
        let _ = writeln!(out, "    $(#[$features])?\n    #[inline]\n    fn whole({takes}){returns} {{");
        for argument in &signature.function.arguments {
            let _ = writeln!(out, "    let _ = {};", argument.name);
        }
        self::body(out, body, signature, level);
        let _ = writeln!(out, "    }}");
    }
    let _ = writeln!(out, "    }};\n}}\n");
}

/// The call of a long body of plain arithmetic.
fn long_calls(out: &mut String, signature: &Signature, context: Context) {
    let (names, name) = (signature.handed(), signature.name());
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
fn lanes_calls(out: &mut String, signature: &Signature) {
    let (names, name, body) = (signature.handed(), signature.name(), &signature.function.body);
    let (width, several) = (body.ty.lanes(), several::is_used(body));
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

fn document(out: &mut String, signature: &Signature, context: Context) {
    let Function { spec, entry, groups, .. } = signature.function;
    for part in &spec.parts {
        let constants: Vec<String> = part.constants.iter().map(|(a, c)| format!("{} = {}", a.name(), shown(c))).collect();
        let at = if constants.is_empty() { String::new() } else { format!(", at {}", constants.join(", ")) };
        let _ = writeln!(out, "/// {}{at}.\n///", part.function.summary);
    }
    for argument in spec.arguments() {
        let _ = writeln!(out, "/// {}: `{}` {}.", argument.name(), signature.array(argument.dims()), argument.unit());
    }
    if context.parameters {
        let _ = writeln!(out, "/// parameters: as [`PARAMETERS`].");
    }
    if let [part] = spec.parts.as_slice() {
        let _ = writeln!(out, "/// Returns `{}` {}.\n///", signature.array(part.function.gives), part.function.unit);
        let _ = writeln!(out, "/// {}.", part.function.source);
    }
    let by = match entry.ways.join(", ") {
        ways if ways.is_empty() => ways,
        _ if groups.is_some() => "In loops over joints: ".into(),
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
        form(signature.function)
    );
}

/// So many things, of which one and several are called so.
fn counted(n: u64, [one, several]: [&str; 2]) -> String {
    format!("{n} {}", if n == 1 { one } else { several })
}

/// What there is to say of a function's form.
fn form(function: &Function) -> String {
    let entry = function.entry;
    if function.groups.is_some() {
        return format!(", each of {} joints at once", entry.lanes);
    }
    let lanes = if entry.lanes > 1 { format!("; limbs that are alike in {} lanes", entry.lanes) } else { String::new() };
    let pieces = if function.is_outlined { "; in pieces, so that it is compiled in less time" } else { "" };
    let spills =
        if function.few_registers.is_some() { "; for x86-64 without AVX-512 in one piece that says what waits in memory" } else { "" };
    format!(", depth {}{lanes}{pieces}{spills}", entry.depth)
}

fn shown(constant: &crate::Constant) -> String {
    match constant {
        crate::Constant::All(x) => format!("{x}"),
        crate::Constant::Each(numbers) => format!("{numbers:?}"),
    }
}
