//! Code for crates without `std`: floating-point functions that `core` lacks, by the crate `libm`,
//! under their names in `std`.

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

/// The text of these names.
pub(crate) fn float() -> String {
    let of = |(real, suffix): (&str, &str)| OF.replace("REAL", real).replace("SUFFIX", suffix);
    FLOAT.to_owned() + &[("f64", ""), ("f32", "f")].map(of).concat()
}

/// Import of a submodule of the private module that may need it.
pub(crate) fn import(no_std: bool) -> &'static str {
    if no_std { "#[allow(unused_imports)]\nuse super::Float;\n\n" } else { "" }
}
