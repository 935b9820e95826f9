//! A finding as data: the same in the report of `check` and of a failed command.

use articulated_core::diagnostic::{self, Severity, Subject};
use serde::Serialize;

/// A finding, with its place as far as it is known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Diagnostic {
    severity: &'static str,
    /// Its kind, for programs; `None` for a message of the command itself.
    code: Option<&'static str>,
    pub(crate) file: Option<String>,
    pub(crate) line: Option<u32>,
    pub(crate) column: Option<u32>,
    subject: Option<String>,
    field: Option<String>,
    found: Option<String>,
    expected: Option<String>,
    hint: Option<String>,
    pub(crate) message: String,
}

impl Diagnostic {
    pub(crate) fn of(finding: &diagnostic::Diagnostic) -> Self {
        let some = |text: &str| (!text.is_empty()).then(|| text.to_owned());
        Self {
            severity: match finding.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            },
            code: Some(finding.code.name()),
            file: some(finding.file()),
            line: finding.line(),
            column: finding.span.at.column(),
            subject: (finding.subject != Subject::Document).then(|| finding.subject.to_string()),
            field: some(&finding.field),
            found: some(&finding.found),
            expected: some(&finding.expected),
            hint: finding.hint.clone(),
            message: finding.to_string(),
        }
    }

    /// A warning about a joint.
    pub(crate) fn warning_of_joint(file: &str, joint: &str, field: Option<&str>, message: String) -> Self {
        let warning = Self { severity: "warning", file: Some(file.to_owned()), ..message.into() };
        Self { subject: Some(format!("joint {joint:?}")), field: field.map(str::to_owned), ..warning }
    }

    /// The same message as a warning.
    pub(crate) fn into_warning(self) -> Self {
        Self { severity: "warning", ..self }
    }
}

/// A message of the command.
impl From<String> for Diagnostic {
    fn from(message: String) -> Self {
        let (code, file, line, column, subject, field, found, expected, hint) = Default::default();
        Self { severity: "error", code, file, line, column, subject, field, found, expected, hint, message }
    }
}
