//! What there is to say about the document, where the compiler has no way to say it.

use articulated_urdf::Problem;

/// The constant that lists what looks odd in the URDF: a macro cannot warn.
pub(crate) fn warnings(warnings: &[Problem]) -> String {
    let lines: Vec<String> = warnings.iter().map(Problem::to_string).collect();
    format!(
        "\n/// What looks odd in the URDF; its values were used as written.\npub const WARNINGS: [&str; {}] = {lines:?};\n",
        lines.len()
    )
}
