//! Warnings about the document, as a constant.

use articulated_core::diagnostic::{Diagnostic, summary};

/// The constant that lists the warnings about the robot's file, one line for each sort.
pub(crate) fn warnings(warnings: &[Diagnostic]) -> String {
    let lines = summary(warnings);
    format!(
        "/// Warnings about the robot's file; its values are used as written.\n#[cfg_attr(rustfmt, rustfmt_skip)]\npub const WARNINGS: [&str; {}] = {lines:?};\n",
        lines.len()
    )
}
