//! The C interface around a generated module: one function each, on plain pointers, in a symbol of
//! its own.

use articulated_core::algorithm::function;
use articulated_core::lanes::Real;

/// How states are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// One after the other.
    States,
    /// In blocks, with each number of all states of a block together.
    Blocks,
}

impl Layout {
    pub(crate) const ALL: [Self; 2] = [Self::Blocks, Self::States];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::States => "states",
            Self::Blocks => "blocks",
        }
    }

    /// How many states the library takes as one.
    pub(crate) fn states(self, real: Real) -> usize {
        match self {
            Self::States => 1,
            Self::Blocks => 64 / real.bytes(),
        }
    }

    pub(super) fn suffix(self) -> &'static str {
        match self {
            Self::States => "",
            Self::Blocks => "_blocks",
        }
    }
}

/// The symbol of a function.
pub(super) fn symbol(function: &str) -> String {
    format!("articulated_{function}")
}

const HEAD: &str = "\
//! The generated functions behind a C interface.
//!
//! SAFETY, of all that is unsafe here: who calls gives arrays of the type and the length that a function takes and gives, and no array twice.
#[allow(dead_code)]
#[path = \"robot.rs\"]
mod robot;

unsafe fn read<'a, T>(x: *const f64) -> &'a T {
    unsafe { &*x.cast() }
}

unsafe fn write<T>(out: *mut f64, result: T) {
    unsafe { out.cast::<T>().write_unaligned(result) }
}

unsafe fn place<'a, T>(out: *mut f64) -> &'a mut T {
    unsafe { &mut *out.cast() }
}
";

/// The symbol of a function of many states.
pub(super) fn batch_symbol(function: &str, real: Real, layout: Layout) -> String {
    format!("{}_{}{}", symbol(function), real.name(), layout.suffix())
}

/// The crate's source; its generated module is `robot.rs`, in the same folder.
pub(super) fn source(functions: &[&str], module: &str) -> String {
    functions.iter().fold(HEAD.to_owned(), |text, name| text + &one(name, module.contains(&format!("pub fn {name}_into("))))
}

/// Large results are written in place.
fn one(name: &str, into: bool) -> String {
    let takes = function::<f64>(name).map_or(&[][..], |f| f.takes);
    let parameters: String = takes.iter().map(|a| format!("{}: *const f64, ", a.name())).collect();
    let arguments: Vec<String> = takes.iter().map(|a| format!("read({})", a.name())).collect();
    let (symbol, arguments) = (symbol(name), arguments.join(", "));
    let call =
        if into { format!("robot::{name}_into({arguments}, place(out))") } else { format!("write(out, robot::{name}({arguments}))") };
    format!(
        "\n#[unsafe(no_mangle)]\npub unsafe extern \"C\" fn {symbol}({parameters}out: *mut f64) {{\n    \
         unsafe {{ {call} }}\n}}\n"
    )
}

const BATCH_HEAD: &str = "\
//! Generated functions of many states behind a C interface.
//!
//! SAFETY, of all that is unsafe here: who calls gives arrays of the type and of `count` times the length that a function takes and gives, and no array twice.
#[allow(dead_code)]
#[path = \"robot.rs\"]
mod robot;

unsafe fn read<'a, T>(x: *const u8, count: usize) -> &'a [T] {
    unsafe { ::std::slice::from_raw_parts(x.cast(), count) }
}

unsafe fn write<'a, T>(x: *mut u8, count: usize) -> &'a mut [T] {
    unsafe { ::std::slice::from_raw_parts_mut(x.cast(), count) }
}
";

/// The crate's source with a function's batches.
pub(super) fn batches(name: &str, reals: &[Real]) -> String {
    let takes = function::<f64>(name).map_or(&[][..], |f| f.takes);
    let parameters: String = takes.iter().map(|a| format!("{}: *const u8, ", a.name())).collect();
    let arguments: String = takes.iter().map(|a| format!("read({}, count), ", a.name())).collect();
    let all = reals.iter().flat_map(|real| Layout::ALL.map(|layout| (*real, layout)));
    all.fold(BATCH_HEAD.to_owned(), |text, (real, layout)| {
        let (symbol, called) = (batch_symbol(name, real, layout), format!("batch_{}::{name}{}", real.name(), layout.suffix()));
        text + &format!(
            "\n#[unsafe(no_mangle)]\npub unsafe extern \"C\" fn {symbol}({parameters}out: *mut u8, count: usize) {{\n    \
             let _ = unsafe {{ robot::{called}({arguments}write(out, count)) }};\n}}\n"
        )
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_function_is_one_symbol_that_takes_pointers() {
        let text = super::source(&["bias_forces"], "");
        assert!(text.contains("fn articulated_bias_forces(q: *const f64, v: *const f64, out: *mut f64)"));
        assert!(text.contains("write(out, robot::bias_forces(read(q), read(v)))"));
        let text = super::source(&["bias_forces"], "pub fn bias_forces_into(q: ");
        assert!(text.contains("robot::bias_forces_into(read(q), read(v), place(out))"));
    }
}
