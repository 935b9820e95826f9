//! One function.

pub(crate) mod body;
pub(crate) mod precision;
pub(crate) mod results;
pub(crate) mod signature;

use std::fmt::Write;

use crate::Precision;
use crate::language::rust::function::body::{body, pieces};
use crate::language::rust::function::signature::Signature;
use crate::language::rust::instructions::{self, needs_choice};
use crate::language::rust::module::style;
use crate::language::rust::several;
use crate::language::rust::spills;
use crate::lir::Body;
use crate::lir::function::{Ending, Function};
use precision::real;

/// Context of the printer besides the functions.
#[derive(Clone, Copy)]
pub(crate) struct Context {
    pub(crate) parameters: bool,
    pub(crate) forbid_unsafe: bool,
    pub(crate) level: Precision,
}

impl Context {
    /// Whether instructions are chosen at run time.
    fn chooses(self) -> bool {
        !self.forbid_unsafe && self.level.fused
    }
}

/// The text of a module: its public part, and the private module behind it.
#[derive(Default)]
pub(crate) struct Text {
    pub(crate) public: String,
    pub(crate) implementation: String,
}

/// The name of the private module. It has the bodies of functions and all their helpers, so that
/// none of these takes a name from the user.
pub(crate) const IMPLEMENTATION: &str = "implementation";

/// The function's source, with its documentation and, if it has several results, the type that
/// holds them.
pub(crate) fn function(text: &mut Text, function: &Function, context: Context) {
    let signature = Signature::of(function, real(context.level));
    let Text { public, implementation } = text;
    signature.results_type(public);
    document(public, &signature, context);
    value_form(public, &signature);
    if signature.has_into() {
        into_form(public, &signature);
    }
    inner(implementation, &signature, context);
}

/// The function in the private module.
fn inner(out: &mut String, signature: &Signature, context: Context) {
    let (function, takes, returns) = (signature.function, signature.takes(), signature.returns());
    let _ = writeln!(out, "pub(super) fn {}({takes}){returns} {{", signature.name());
    if function.columns.is_some() {
        // The body has several ends.
        let _ = writeln!(out, "    before_columns({});\n    columns::columns(out);\n", signature.handed());
        let _ = writeln!(out, "    fn before_columns({takes}){returns} {{");
    }
    for argument in &function.arguments {
        let _ = writeln!(out, "    let _ = {};", argument.name);
    }
    let (in_lanes, few) = (function.in_lanes(), function.few_registers.as_ref());
    if in_lanes || function.is_outlined {
        *out += &if few.is_some() { format!("    {}\n", spills::MORE_REGISTERS) } else { String::new() };
        body_macro(out, &function.body, signature, context.level);
    }
    if let Some(few) = few.filter(|_| in_lanes) {
        let _ = writeln!(out, "    {}", spills::FEW_REGISTERS);
        body_macro(out, few, signature, context.level);
    }
    if in_lanes {
        lanes_calls(out, signature);
    } else {
        let text = |body: &Body| {
            let mut text = String::new();
            calls(&mut text, body, signature, context);
            text
        };
        *out += &match few {
            Some(few) => spills::by_registers(&text(few), &text(&function.body)),
            None => text(&function.body),
        };
    }
    *out += if function.columns.is_some() { "    }\n" } else { "" };
    let _ = writeln!(out, "}}\n");
}

/// The function as a value.
fn value_form(out: &mut String, signature: &Signature) {
    let (name, function) = (signature.name(), signature.function);
    *out += &allowed(signature, name);
    *out += "#[inline]\n";
    head(out, &format!("pub fn {name}"), &signature.argument_list(), &format!(" -> {}", signature.gives()));
    let handed = signature.names_and("&mut out");
    let _ = match function.ending {
        Ending::Value => writeln!(out, "    {IMPLEMENTATION}::{name}({})", signature.names()),
        Ending::Written | Ending::Rows => {
            let _ = writeln!(out, "    let mut out = ::core::mem::MaybeUninit::uninit();\n    {IMPLEMENTATION}::{name}({handed});");
            writeln!(out, "    // SAFETY: the function has written all of it.\n    unsafe {{ out.assume_init() }}")
        }
        Ending::Filled => writeln!(out, "    let mut out = {};\n    {name}_into({handed});\n    out", signature.nothing()),
    };
    *out += "}\n\n";
}

/// The function that writes into the caller's memory: a copy costs as much as a third of a
/// function.
fn into_form(out: &mut String, signature: &Signature) {
    let (name, gives, function) = (signature.name(), signature.gives(), signature.function);
    let into = format!("{name}_into");
    let _ = writeln!(out, "/// As [`{name}`], into `out` (overwritten).");
    *out += &allowed(signature, &into);
    *out += "#[inline]\n";
    let mut list = signature.argument_list();
    list.push(format!("out: &mut {gives}"));
    head(out, &format!("pub fn {into}"), &list, "");
    let handed = signature.names_and("out");
    let _ = match function.ending {
        Ending::Value => writeln!(out, "    *out = {name}({});", signature.names()),
        Ending::Written | Ending::Rows => {
            let _ = writeln!(out, "    // SAFETY: the function reads nothing there, and writes a value.");
            let _ = writeln!(out, "    let out = unsafe {{ &mut *::core::ptr::from_mut(out).cast() }};");
            writeln!(out, "    {IMPLEMENTATION}::{name}({handed});")
        }
        Ending::Filled => writeln!(out, "    {IMPLEMENTATION}::{name}({handed});"),
    };
    *out += "}\n\n";
}

/// The first line of a function, or several where one would be longer than 100 columns.
pub(crate) fn head(out: &mut String, before: &str, arguments: &[String], returns: &str) {
    let line = format!("{before}({}){returns} {{", arguments.join(", "));
    if line.chars().count() <= 100 {
        let _ = writeln!(out, "{line}");
    } else {
        let list: String = arguments.iter().map(|argument| format!("    {argument},\n")).collect();
        let _ = writeln!(out, "{before}(\n{list}){returns} {{");
    }
}

/// The lints that a public function would break.
fn allowed(signature: &Signature, name: &str) -> String {
    let is_unsafe = matches!(signature.function.ending, Ending::Written | Ending::Rows);
    let mut lints = Vec::new();
    lints.extend(is_unsafe.then_some("unsafe_code"));
    lints.extend(style::is_odd(name).then_some("non_snake_case"));
    if lints.is_empty() { String::new() } else { format!("#[allow({})]\n", lints.join(", ")) }
}

/// A body of plain arithmetic, in pieces or one, and its call.
fn calls(out: &mut String, body: &Body, signature: &Signature, context: Context) {
    if body.pieces.len() > 1 || signature.function.is_outlined && body.slots.is_none() {
        long_calls(out, signature, context);
    } else if needs_choice(signature.function, context.level) && context.chooses() {
        chosen(out, body, signature, context.level);
    } else {
        precision::imports(out, context.level);
        self::body(out, body, signature, context.level);
    }
}

/// Plain arithmetic, with fused multiply-add if the processor has it: known when compiled, or
/// detected at run time.
fn chosen(out: &mut String, body: &Body, signature: &Signature, level: Precision) {
    let (takes, names, returns) = (signature.takes(), signature.handed(), signature.returns());
    let (generic, own, fused) =
        if level.of_two() { ("const FUSED: bool", "FUSED", "true") } else { ("F: Fma", "MultiplyAdd<FUSED>", "MultiplyAdd<true>") };
    let _ = writeln!(out, "    #[inline(always)]\n    fn body<{generic}>({takes}){returns} {{");
    for argument in &signature.function.arguments {
        let _ = writeln!(out, "    let _ = {};", argument.name);
    }
    precision::imports(out, level);
    self::body(out, body, signature, level);
    let _ = writeln!(out, "    }}\n    {}", instructions::NOT_COMPILED_FOR_AVX2);
    let _ = writeln!(out, "    if {} {{", instructions::HAS_AVX2);
    let _ = writeln!(
        out,
        "        #[target_feature(enable = \"avx2,fma\")]\n        fn fused({takes}){returns} {{\n            body::<{fused}>({names})\n        }}"
    );
    let _ = writeln!(
        out,
        "        // SAFETY: the processor has both, as was just checked.\n        return unsafe {{ fused({names}) }};\n    }}"
    );
    let _ = writeln!(out, "    body::<{own}>({names})");
}

/// The body as a macro: it is compiled for several instruction sets.
fn body_macro(out: &mut String, body: &Body, signature: &Signature, level: Precision) {
    let (takes, returns) = (signature.takes(), signature.returns());
    let _ = writeln!(out, "macro_rules! whole {{\n    ($(#[$features:meta])?) => {{");
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
    let names = signature.handed();
    precision::imports(out, context.level);
    if context.chooses() {
        let _ = writeln!(out, "    {}\n    if {} {{", instructions::NOT_COMPILED_FOR_AVX2, instructions::HAS_AVX2);
        let fused = if context.level.of_two() { "const FUSED: bool = true" } else { "type F = MultiplyAdd<true>" };
        let _ = writeln!(out, "        {fused};\n        whole!(#[target_feature(enable = \"avx2,fma\")]);");
        let _ = writeln!(
            out,
            "        // SAFETY: the processor has both, as was just checked.\n        return unsafe {{ whole({names}) }};\n    }}"
        );
    }
    let _ = writeln!(out, "    whole!();\n    whole({names})");
}

/// The call of the body for the best available instruction set.
fn lanes_calls(out: &mut String, signature: &Signature) {
    let (names, body) = (signature.handed(), &signature.function.body);
    let (width, several) = (body.ty.lanes(), several::is_used(body));
    let mut block = |cfg: &str, set: &str, features: &str, calls: &str| {
        let several = if several { format!("\n        use self::several_f64x{width}::{set}::*;") } else { String::new() };
        let _ = writeln!(
            out,
            "    {cfg}\n    {{\n        use self::{set}_f64x{width}::*;{several}\n        whole!({features});\n{calls}    }}"
        );
    };
    let calls = format!(
        "        {}\n        if {} {{\n            // SAFETY: the processor has both, as was just checked.\n            return unsafe {{ whole({names}) }};\n        }}\n        \
         {}\n        // SAFETY: this is compiled for processors with both.\n        return unsafe {{ whole({names}) }};\n",
        instructions::NOT_COMPILED_FOR_AVX2,
        instructions::HAS_AVX2,
        instructions::COMPILED_FOR_AVX2,
    );
    block("#[cfg(target_arch = \"x86_64\")]", "avx2", "#[target_feature(enable = \"avx2,fma\")]", &calls);
    let calls = format!("        // SAFETY: every x86-64 processor has it.\n        return unsafe {{ whole({names}) }};\n");
    block(instructions::NOT_COMPILED_FOR_AVX2, "sse2", "#[target_feature(enable = \"sse2,fxsr\")]", &calls);
    let calls = format!("        // SAFETY: every 64-bit Arm processor has it.\n        return unsafe {{ whole({names}) }};\n");
    block("#[cfg(target_arch = \"aarch64\")]", "neon", "#[target_feature(enable = \"neon\")]", &calls);
    block(instructions::OTHERS, "portable", "", &format!("        whole({names})\n"));
}

fn document(out: &mut String, signature: &Signature, context: Context) {
    let Function { spec, entry, .. } = signature.function;
    for (part, summary) in spec.parts.iter().zip(spec.summaries()) {
        let constants: Vec<String> = part.constants.iter().map(|(a, c)| format!("{} = {}", a.name(), shown(c))).collect();
        let at = if constants.is_empty() { String::new() } else { format!(", at {}", constants.join(", ")) };
        let _ = writeln!(out, "/// {summary}{at}.\n///");
    }
    for argument in spec.arguments() {
        let _ = writeln!(out, "/// {}: `{}` {}.", argument.name(), signature.array(argument.dims()), argument.unit());
    }
    if context.parameters {
        let _ = writeln!(out, "/// parameters: as [`PARAMETERS`].");
    }
    if let ([output], [part]) = (signature.function.outputs.as_slice(), spec.parts.as_slice()) {
        let _ = writeln!(out, "/// Returns `{}` {}.\n///", signature.array(&output.dims), output.unit);
        let _ = writeln!(out, "/// {}.", part.function.source);
    }
    let by = match entry.ways.join(", ") {
        ways if ways.is_empty() => ways,
        ways => format!("Strategy: {ways} (the cheapest for this robot). "),
    };
    let c = entry.emitted();
    let _ = writeln!(
        out,
        "/// {by}{} + {} in {}{} (multiply-adds counted once), {}{}.",
        counted(c.multiplications(), ["multiplication", "multiplications"]),
        counted(c.additions(), ["addition", "additions"]),
        counted(c.instructions(), ["instruction", "instructions"]),
        signature.function.at_most(),
        counted(c.trigonometric(), ["sine or cosine", "sines and cosines"]),
        form(signature.function)
    );
}

/// A number with its noun in singular or plural.
fn counted(n: u64, [one, several]: [&str; 2]) -> String {
    format!("{n} {}", if n == 1 { one } else { several })
}

/// Description of a function's form.
fn form(function: &Function) -> String {
    let entry = function.entry;
    let lanes = if entry.lanes > 1 { format!("; isomorphic limbs in {} lanes", entry.lanes) } else { String::new() };
    let pieces = if function.is_outlined { "; in several pieces, which compile faster" } else { "" };
    let spills = if function.few_registers.is_some() { "; with explicit spills on x86-64 without AVX-512" } else { "" };
    format!(", depth {}{lanes}{pieces}{spills}", entry.depth)
}

fn shown(constant: &crate::Constant) -> String {
    match constant {
        crate::Constant::All(x) => format!("{x}"),
        crate::Constant::Each(numbers) => format!("{numbers:?}"),
    }
}
