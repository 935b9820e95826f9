//! Code for crates without `std`: what `core` lacks of floating-point numbers, by the crate `libm`, under the names that `std` gives it.

const FLOAT: &str = "
/// What `core` lacks of floating-point numbers, by the crate `libm`.
#[allow(dead_code)]
trait Float: ::core::marker::Sized {
    fn mul_add(self, b: Self, c: Self) -> Self;
    fn sqrt(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn atan2(self, x: Self) -> Self;
}
";

const OF: &str = "
impl Float for REAL {
    fn mul_add(self, b: Self, c: Self) -> Self {
        ::libm::fmaSUFFIX(self, b, c)
    }

    fn sqrt(self) -> Self {
        ::libm::sqrtSUFFIX(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        ::libm::sincosSUFFIX(self)
    }

    fn atan2(self, x: Self) -> Self {
        ::libm::atan2SUFFIX(self, x)
    }
}
";

/// The source with these names in scope, in each of its modules.
pub(crate) fn without_std(source: &str) -> String {
    let mut out = String::new();
    for line in source.lines() {
        out.extend([line, "\n"]);
        if opens_module(line) {
            let indent = line.len() - line.trim_start().len() + 4;
            out += &format!("{:indent$}#[allow(unused_imports)]\n{:indent$}use super::Float;\n\n", "", "");
        }
    }
    out += FLOAT;
    for (real, suffix) in [("f64", ""), ("f32", "f")] {
        out += &OF.replace("REAL", real).replace("SUFFIX", suffix);
    }
    out
}

fn opens_module(line: &str) -> bool {
    let line = line.trim_start();
    let line = line.strip_prefix("pub ").or_else(|| line.strip_prefix("pub(super) ")).unwrap_or(line);
    line.starts_with("mod ") && line.ends_with('{')
}
