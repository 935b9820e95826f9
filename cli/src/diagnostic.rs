//! An error or a warning as data: the same in the report of `check` and of what fails.

use articulated_scene::SceneError;
use articulated_urdf::{Problem, Subject};
use serde::Serialize;

/// What is wrong or odd, and where, as far as that is known apart from the words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Diagnostic {
    pub(crate) line: Option<u32>,
    pub(crate) subject: Option<String>,
    pub(crate) field: Option<String>,
    pub(crate) message: String,
}

impl Diagnostic {
    pub(crate) fn of(problem: &Problem) -> Self {
        Self {
            line: problem.line,
            subject: (problem.subject != Subject::Document).then(|| problem.subject.to_string()),
            field: (!problem.field.is_empty()).then(|| problem.field.clone()),
            message: problem.to_string(),
        }
    }

    /// Of a scene.
    pub(crate) fn of_scene(error: &SceneError) -> Self {
        let field = (!error.key.is_empty()).then(|| error.key.clone());
        Self { line: error.at.line(), subject: None, field, message: error.to_string() }
    }
}

/// Words alone.
impl From<String> for Diagnostic {
    fn from(message: String) -> Self {
        Self { line: None, subject: None, field: None, message }
    }
}
