//! Shapes in words.

use articulated_core::algorithm::{Dim, Function};

/// `[frames][6][nv]`; empty for a single number.
pub(crate) fn dims(dims: &[Dim]) -> String {
    dims.iter().map(|d| format!("[{}]", d.to_string().to_lowercase())).collect()
}

/// Shape and unit of a function's result.
pub(crate) fn result<S>(function: &Function<S>) -> String {
    format!("{} {}", dims(function.gives), function.unit).trim_start().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_read_as_they_are_indexed() {
        let shape = |name: &str| dims(articulated_core::algorithm::function::<f64>(name).unwrap().gives);
        assert_eq!((shape("jacobians_body").as_str(), shape("kinetic_energy").as_str()), ("[frames][6][nv]", ""));
    }
}
