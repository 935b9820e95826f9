//! Names that the compiler would warn of: they are the user's.

/// The source with what allows functions' names with two `_` side by side, which come of names such as `static_`.
pub(crate) fn allowed(source: String, functions: &[&str]) -> String {
    if !functions.iter().any(|name| is_odd(&format!("{name}_"))) {
        return source;
    }
    let mut out = String::with_capacity(source.len());
    for line in source.lines() {
        if function(line).is_some_and(is_odd) {
            let indent = line.len() - line.trim_start().len();
            out += &format!("{:indent$}#[allow(non_snake_case)]\n", "");
        }
        out.extend([line, "\n"]);
    }
    out
}

/// What stands before a constant of this name.
pub(crate) fn of_constant(name: &str) -> &'static str {
    if name.contains(char::is_lowercase) { "#[allow(non_upper_case_globals)]\n    " } else { "" }
}

fn is_odd(name: &str) -> bool {
    name.trim_start_matches('_').contains("__")
}

/// The name of the function that begins on this line.
fn function(line: &str) -> Option<&str> {
    let (before, rest) = line.trim_start().split_once("fn ")?;
    let begins = before.is_empty() || before == "pub " || before.starts_with("pub(") && before.ends_with(") ");
    let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next();
    name.filter(|_| begins)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_with_two_underscores_side_by_side_are_allowed_and_others_left_alone() {
        let source =
            "/// f.\n#[inline]\npub fn a_(x: (A, B)) {\n}\n    pub(super) fn a__into(x: f64) {\n    }\nfn b_c() {}\nlet a__b = 1;\n";
        let expected = source.replace("    pub(super) fn", "    #[allow(non_snake_case)]\n    pub(super) fn");
        assert_eq!(allowed(source.to_owned(), &["b", "a_"]), expected);
        assert_eq!(allowed(source.to_owned(), &["b", "a_c"]), source);
    }

    #[test]
    fn a_constant_in_lower_case_is_allowed() {
        assert_eq!([of_constant("TCP_1"), of_constant("ЛОКОТЬ")], [""; 2]);
        assert!(of_constant("tcp").contains("non_upper_case_globals"));
    }
}
