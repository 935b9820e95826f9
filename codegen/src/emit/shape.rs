//! Arguments and results as types of Rust: one row each.

use articulated_core::algorithm::{Argument, ResultKind, Shape as Sizes};

/// The constant that is an argument's length.
pub(super) fn length(argument: Argument) -> &'static str {
    match argument {
        Argument::Q => "NQ",
        Argument::V | Argument::A | Argument::Tau => "NV",
    }
}

/// How a result is written.
pub(super) struct Shape {
    /// What the generated function returns.
    pub(super) array: &'static str,
    /// How many numbers are in a row; `None` for a result without rows.
    pub(super) row: Option<usize>,
    /// What a method of `Dynamics` writes into: its element type, and its length.
    pub(super) slice: (&'static str, &'static str),
    /// How the array becomes such a slice.
    pub(super) as_slice: &'static str,
}

/// The shape of a result, for a robot of these sizes.
pub(super) fn shape(gives: ResultKind, sizes: Sizes) -> Shape {
    match gives {
        ResultKind::Torque | ResultKind::Acceleration => Shape { array: "[f64; NV]", row: None, slice: ("f64", "NV"), as_slice: "" },
        ResultKind::Placements => Shape { array: "[[f64; 12]; FRAMES]", row: Some(12), slice: ("[f64; 12]", "FRAMES"), as_slice: "" },
        ResultKind::MassMatrix => {
            Shape { array: "[[f64; NV]; NV]", row: Some(sizes.nv), slice: ("f64", "NV * NV"), as_slice: ".as_flattened()" }
        }
    }
}
