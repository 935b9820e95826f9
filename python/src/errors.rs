//! Findings of the library as Python's errors and dicts.

use articulated_core::diagnostic::{Diagnostic, Diagnostics, Severity, Subject};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A finding as a dict.
pub(crate) fn dict<'py>(py: Python<'py>, finding: &Diagnostic) -> PyResult<Bound<'py, PyDict>> {
    let severity = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let subject = match &finding.subject {
        Subject::Document => None,
        other => Some(other.to_string()),
    };
    let out = PyDict::new(py);
    out.set_item("severity", severity)?;
    out.set_item("code", finding.code.name())?;
    out.set_item("file", finding.file())?;
    out.set_item("line", finding.line())?;
    out.set_item("column", finding.span.at.column())?;
    out.set_item("subject", subject)?;
    out.set_item("field", &finding.field)?;
    out.set_item("found", &finding.found)?;
    out.set_item("expected", &finding.expected)?;
    out.set_item("hint", &finding.hint)?;
    out.set_item("message", finding.to_string())?;
    Ok(out)
}

/// Findings as a list of dicts.
pub(crate) fn list<'py>(py: Python<'py>, findings: &[Diagnostic]) -> PyResult<Bound<'py, PyList>> {
    PyList::new(py, findings.iter().map(|finding| dict(py, finding)).collect::<PyResult<Vec<_>>>()?)
}

/// `articulated.RobotError` with all findings, errors first.
pub(crate) fn refused(py: Python<'_>, findings: &Diagnostics) -> PyErr {
    let all: Vec<Diagnostic> = findings.errors.iter().chain(&findings.warnings).chain(&findings.notes).cloned().collect();
    let error = || {
        let class = py.import("articulated._errors")?.getattr("RobotError")?;
        class.call1((findings.to_string(), list(py, &all)?))
    };
    error().map_or_else(|failed| failed, PyErr::from_value)
}
