//! Elements of a file that are not read, and which an option leaves out.

use std::fmt;
use std::str::FromStr;

use articulated_core::suggest::nearest;

/// Elements of an MJCF that change the motion and are not read. They are errors, unless
/// [`Options::leave_out`](crate::Options::leave_out) contains their kind: then they are warnings,
/// and the motion is computed without them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LeaveOut {
    /// Flexible bodies: `flex` and `flexcomp`.
    Flex,
    /// Bodies that `composite` makes.
    Composite,
    /// Plugins for forces (elastic ones) or shapes (signed distance fields).
    Plugin,
    /// Constraints of the law of contact that are not computed, such as those of tendons around
    /// geoms. Only functions with constraints report them.
    Constraint,
    /// The solvers PGS and CG, and iterations without slip: Newton's method finds the optimum. Only
    /// functions with constraints report them.
    Solver,
    /// Pairs of shapes whose contact is not computed. Only functions with constraints report them.
    Contact,
}

impl LeaveOut {
    /// All kinds.
    pub const ALL: [Self; 6] = [Self::Flex, Self::Composite, Self::Plugin, Self::Constraint, Self::Solver, Self::Contact];

    /// The names and the kinds, for lists of words.
    pub const WORDS: [(&str, Self); 6] = [
        ("flex", Self::Flex),
        ("composite", Self::Composite),
        ("plugin", Self::Plugin),
        ("constraint", Self::Constraint),
        ("solver", Self::Solver),
        ("contact", Self::Contact),
    ];

    /// The name in options: `flex`, `composite`, `plugin`, `constraint`, `solver` or `contact`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flex => "flex",
            Self::Composite => "composite",
            Self::Plugin => "plugin",
            Self::Constraint => "constraint",
            Self::Solver => "solver",
            Self::Contact => "contact",
        }
    }

    /// The options that leave it out.
    #[must_use]
    pub fn option(self) -> String {
        format!("`--leave-out {}` (key `leave_out`, method `Build::leave_out`)", self.name())
    }
}

impl fmt::Display for LeaveOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A word that does not name a kind of element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoKind(String);

impl fmt::Display for NoKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "found {:?}, expected flex, composite, plugin, constraint, solver or contact", self.0)?;
        match nearest(&self.0, LeaveOut::ALL.iter().map(|kind| kind.name())) {
            Some(near) => write!(f, " (did you mean {near:?}?)"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for NoKind {}

impl FromStr for LeaveOut {
    type Err = NoKind;

    fn from_str(text: &str) -> Result<Self, NoKind> {
        Self::ALL.into_iter().find(|kind| kind.name() == text).ok_or_else(|| NoKind(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_has_its_name() {
        for (kind, (name, own)) in LeaveOut::ALL.into_iter().zip(LeaveOut::WORDS) {
            assert_eq!((kind, kind.name(), name.parse()), (own, name, Ok(kind)));
        }
        let error = "plugins".parse::<LeaveOut>().unwrap_err().to_string();
        assert_eq!(error, "found \"plugins\", expected flex, composite, plugin, constraint, solver or contact (did you mean \"plugin\"?)");
    }
}
