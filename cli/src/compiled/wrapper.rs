//! The C interface around a generated module: one function each, on plain pointers, in a symbol of its own.

use articulated_core::algorithm::function;

/// The symbol of a function.
pub(super) fn symbol(function: &str) -> String {
    format!("articulated_{function}")
}

const HEAD: &str = "\
//! The generated functions behind a C interface.
#[allow(dead_code)]
#[path = \"robot.rs\"]
mod robot;

unsafe fn read<'a, T>(x: *const f64) -> &'a T {
    unsafe { &*x.cast() }
}

unsafe fn write<T>(out: *mut f64, result: T) {
    unsafe { out.cast::<T>().write_unaligned(result) }
}
";

/// The crate's source; the generated module is `robot.rs` beside it.
pub(super) fn source(functions: &[&str]) -> String {
    functions.iter().fold(HEAD.to_owned(), |text, name| text + &one(name))
}

fn one(name: &str) -> String {
    let takes = function::<f64>(name).map_or(&[][..], |f| f.takes);
    let parameters: String = takes.iter().map(|a| format!("{}: *const f64, ", a.name())).collect();
    let arguments: Vec<String> = takes.iter().map(|a| format!("read({})", a.name())).collect();
    let (symbol, arguments) = (symbol(name), arguments.join(", "));
    format!(
        "\n#[unsafe(no_mangle)]\npub unsafe extern \"C\" fn {symbol}({parameters}out: *mut f64) {{\n    \
         unsafe {{ write(out, robot::{name}({arguments})) }}\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_function_is_one_symbol_that_takes_pointers() {
        let text = super::source(&["bias_forces"]);
        assert!(text.contains("fn articulated_bias_forces(q: *const f64, v: *const f64, out: *mut f64)"));
        assert!(text.contains("robot::bias_forces(read(q), read(v))"));
    }
}
