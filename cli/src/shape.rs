//! Shapes in words.

use articulated_core::algorithm::{Dim, Function, Port};

/// `[frames][6][nv]`; empty for a single number.
pub(crate) fn dims(dims: &[Dim]) -> String {
    dims.iter().map(|d| format!("[{}]", d.to_string().to_lowercase())).collect()
}

/// Shape and unit of a function's result.
pub(crate) fn result<S>(function: &Function<S>) -> String {
    format!("{} {}", dims(function.gives), function.unit).trim_start().to_owned()
}

/// Shape of a function's result; of several, each with its name.
pub(crate) fn gives<S>(function: &Function<S>) -> String {
    let one = |port: &Port| format!("{} {}", port.name, dims(port.dims));
    if function.outputs.is_empty() { dims(function.gives) } else { function.outputs.iter().map(one).collect::<Vec<_>>().join(", ") }
}

/// Unit of a function's result, or those of several.
pub(crate) fn unit<S>(function: &Function<S>) -> String {
    let units = function.outputs.iter().map(|port| port.unit).collect::<Vec<_>>();
    if units.is_empty() { function.unit.to_owned() } else { units.join("; ") }
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
