//! Checks of the call of a function, and its errors.

use core::fmt;

use super::FunctionId;

/// Errors of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionError {
    /// A slice has another length than the model says.
    Length {
        /// The argument's name.
        argument: &'static str,
        /// The length found.
        found: usize,
        /// The length expected.
        expected: usize,
    },
    /// More arguments or fewer than the function takes.
    Arguments {
        /// The function's name.
        function: &'static str,
        /// How many were found.
        found: usize,
        /// How many were expected.
        expected: usize,
    },
    /// The workspace was made for a robot with another tree, other coordinates or another number of
    /// frames.
    Workspace,
    /// The robot was generated without this function.
    NotGenerated {
        /// The function's name.
        function: &'static str,
    },
    /// None of the function's ways applies to the robot.
    NoWay {
        /// The function's name.
        function: &'static str,
    },
}

impl fmt::Display for FunctionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { argument, found, expected } => write!(f, "{argument}: found {found} numbers, expected {expected}"),
            Self::Arguments { function, found, expected } => write!(f, "{function}: found {found} arguments, expected {expected}"),
            Self::Workspace => f.write_str("workspace: found that of another robot, expected one that this robot made"),
            Self::NotGenerated { function } => write!(f, "this robot was generated without {function}: add it to `functions`"),
            Self::NoWay { function } => write!(f, "{function}: found no way to compute it for this robot"),
        }
    }
}

impl core::error::Error for FunctionError {}

impl FunctionError {
    /// Why a robot that was generated with certain functions did not take a call.
    pub fn of_call(function: FunctionId, found: usize, generated: &[FunctionId]) -> Self {
        let row = function.row::<f64>();
        match generated.contains(&function) {
            true => Self::Arguments { function: row.name, found, expected: row.takes.len() },
            false => Self::NotGenerated { function: row.name },
        }
    }
}

/// The number of arguments, or the error that names the function.
pub fn check_count(function: &'static str, found: usize, expected: usize) -> Result<(), FunctionError> {
    if found == expected { Ok(()) } else { Err(FunctionError::Arguments { function, found, expected }) }
}

/// The length of an argument, or the error that names it.
pub fn check_length(argument: &'static str, found: usize, expected: usize) -> Result<(), FunctionError> {
    if found == expected { Ok(()) } else { Err(FunctionError::Length { argument, found, expected }) }
}

/// A slice as an array of exactly `N` numbers, or the error that names it.
pub fn exactly<'a, const N: usize, S>(argument: &'static str, slice: &'a [S]) -> Result<&'a [S; N], FunctionError> {
    slice.try_into().map_err(|_| FunctionError::Length { argument, found: slice.len(), expected: N })
}

/// A slice as exactly `N` rows of `M` numbers, or the error that names it.
pub fn exactly_rows<'a, const N: usize, const M: usize, S>(
    argument: &'static str,
    slice: &'a [S],
) -> Result<&'a [[S; M]; N], FunctionError> {
    let (rows, rest) = slice.as_chunks::<M>();
    let rows = if rest.is_empty() { rows.try_into().ok() } else { None };
    rows.ok_or(FunctionError::Length { argument, found: slice.len(), expected: N * M })
}
