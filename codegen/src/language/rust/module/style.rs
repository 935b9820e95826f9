//! Names of the user that would cause compiler warnings.

/// Attribute of a constant of this name.
pub(crate) fn of_constant(name: &str) -> &'static str {
    if name.contains(char::is_lowercase) { "#[allow(non_upper_case_globals)]\n    " } else { "" }
}

/// Whether a function's name has two `_` side by side, which come of names such as `static_`.
pub(crate) fn is_odd(name: &str) -> bool {
    name.trim_start_matches('_').contains("__")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_two_underscores_inside_is_odd() {
        assert_eq!(["a__b", "__a", "a_b", "static__into"].map(is_odd), [true, false, false, true]);
    }

    #[test]
    fn a_constant_in_lower_case_is_allowed() {
        assert_eq!([of_constant("TCP_1"), of_constant("ЛОКОТЬ")], [""; 2]);
        assert!(of_constant("tcp").contains("non_upper_case_globals"));
    }
}
