//! The functions that a module of batches shows.

use std::fmt::Write;

use articulated_core::lanes::{Real, Set};

use super::Batch;
use super::arrays::{Array, inputs, results};
use super::ways::Variant;

impl Batch<'_> {
    /// The function for states one after the other, and the one for blocks.
    pub(super) fn public(&self, out: &mut String, real: Real, ways: &[Variant]) {
        let name = self.name();
        for (suffix, inner, of, what) in [("", "states", real.name(), "states"), ("_blocks", "blocks", "Lanes", "blocks")] {
            self.document(out, what);
            let _ = writeln!(out, "pub fn {name}{suffix}({}) -> ::core::result::Result<(), LengthError> {{", self.declared(of));
            self.lengths(out);
            if suffix.is_empty() && self.function.is_faster_one_by_one(self.level, real) {
                self.one_by_one(out);
            } else if self.is_any() {
                self.calls(out, &format!("{name}_{inner}"), ways);
            }
            let _ = writeln!(out, "    #[allow(unreachable_code)]\n    ::core::result::Result::Ok(())\n}}\n");
        }
    }

    fn document(&self, out: &mut String, what: &str) {
        let parts = self.function.spec.summaries();
        let name = &self.function.spec.name;
        let _ = writeln!(
            out,
            "/// {}; for as many {what} as the first argument has. Each state's arguments and results are those of",
            parts.join("; ")
        );
        let one = if what == "states" { "set" } else { "block" };
        let shared =
            if self.inputs().iter().any(|a| a.is_parameters) { format!(" One {one} of parameters does for all.") } else { String::new() };
        let _ = writeln!(out, "/// [`{name}`](super::super::{name}()), with their units.{shared}\n///");
        let _ = writeln!(out, "/// # Errors\n/// If a slice has another length than the first: nothing is computed.");
    }

    /// Arguments and results with their types.
    fn declared(&self, of: &str) -> String {
        let one = |a: &Array, r: &str| format!("{}: {r}[{}]", a.name, a.nested(of));
        let inputs: String = inputs(self.function).iter().map(|a| one(a, "&") + ", ").collect();
        let results: Vec<String> = results(self.function).iter().map(|a| one(a, "&mut ")).collect();
        inputs + &results.join(", ")
    }

    /// Checks that all slices have as many states as the first.
    fn lengths(&self, out: &mut String) {
        let mut arrays: Vec<Array> = inputs(self.function).into_iter().chain(results(self.function)).collect();
        arrays.sort_by_key(|array| array.is_parameters);
        let first = &arrays[0].name;
        for Array { name, is_parameters, .. } in &arrays[1..] {
            let found = if *is_parameters {
                format!("if {name}.len() == 1 {{ {first}.len() }} else {{ {name}.len() }}")
            } else {
                format!("{name}.len()")
            };
            let _ = writeln!(out, "    LengthError::unless(\"{name}\", {found}, {first}.len())?;");
        }
    }

    /// The function of one state, state by state.
    fn one_by_one(&self, out: &mut String) {
        let (name, first) = (self.name(), self.results()[0].name.clone());
        let inputs: String = inputs(self.function).iter().map(|a| format!("&{}[k], ", a.name)).collect();
        let _ = writeln!(out, "    // To transpose blocks of results into states takes longer than vectors save.");
        let _ = writeln!(out, "    for k in 0..{first}.len() {{\n        super::super::{name}_into({inputs}&mut {first}[k]);\n    }}");
    }

    /// The call in the first available instruction set.
    fn calls(&self, out: &mut String, inner: &str, ways: &[Variant]) {
        let inputs: String = self.inputs().iter().map(|a| a.flat(false) + ", ").collect();
        let results: Vec<String> = self.results().iter().map(|a| a.flat(true)).collect();
        let call = format!("{inner}({inputs}{})", results.join(", "));
        for Variant { module, cfg, asked, set, .. } in ways {
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
    }
}
