//! Warnings about the document, as a constant.

use articulated_core::diagnostic::{Diagnostic, summary};

/// The constant that lists what looks wrong in the robot's file, a line for each sort of warning.
pub(crate) fn warnings(warnings: &[Diagnostic]) -> String {
    let lines = summary(warnings);
    format!(
        "/// Warnings about the robot's file; its values are used as written.\n#[cfg_attr(rustfmt, rustfmt_skip)]\npub const WARNINGS: [&str; {}] = {lines:?};\n",
        lines.len()
    )
}
