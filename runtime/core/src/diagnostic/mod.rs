//! Findings about files, requests and robots: one type, one collector.
//!
//! A check takes `&mut Diagnostics`, reports its findings, and continues: all findings of one input
//! come from one pass over it. The entry points (macro, build script, command) differ in how they
//! show a [`Diagnostic`], not in their findings.

mod code;
mod collector;
mod quote;
mod summary;

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;
use core::ops::{Deref, DerefMut};

pub use code::Code;
pub use collector::Diagnostics;
pub use quote::{is_invisible, quote, quote_number};
pub use summary::{summary, summary_of_unused};

/// One finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How serious it is.
    pub severity: Severity,
    /// Its sort, for programs.
    pub code: Code,
    /// Its place.
    pub span: Span,
    /// The link or joint.
    pub subject: Subject,
    /// The tag, attribute or key; empty for the file as a whole.
    pub field: String,
    /// The content of the input; a full sentence if `expected` is empty.
    pub found: String,
    /// The expected content; empty if `found` is a sentence.
    pub expected: String,
    /// A hint: the intended name, or the option that allows it.
    pub hint: Option<String>,
}

/// How serious a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// The input is refused.
    Error,
    /// The input is used as it is.
    Warning,
    /// The input is changed, as requested.
    Note,
}

/// A place in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    /// The name of the file, as the user writes it; empty if there is none.
    pub file: String,
    /// The place in it.
    pub at: At,
}

/// A place in a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum At {
    /// No particular place.
    #[default]
    Nowhere,
    /// A place in a file.
    Text {
        /// The line, from 1.
        line: u32,
        /// The column in characters, from 1; 0 for the whole line.
        column: u32,
    },
    /// A place in a file that the document includes. A collector replaces it by the place in that
    /// file, see [`Diagnostics::include`].
    Included {
        /// The number of the file in the collector.
        file: u16,
        /// The line, from 1.
        line: u32,
        /// The column in characters, from 1; 0 for the whole line.
        column: u32,
    },
    /// A word of a macro's invocation, by its number there.
    Word(u32),
}

/// The subject of a [`Diagnostic`].
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum Subject {
    /// The document as a whole.
    #[default]
    Document,
    /// The link of this name.
    Link(String),
    /// The joint of this name.
    Joint(String),
}

/// Where a check is when it reports: place, link or joint, and key.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The place in the file.
    pub at: At,
    /// The link or joint.
    pub subject: &'a Subject,
    /// The tag, attribute or key.
    pub field: &'a str,
}

/// Content of a file that is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct Unused {
    /// The line, from 1, where it is known.
    pub line: Option<u32>,
    /// The link or joint that it belongs to.
    pub subject: Subject,
    /// The tag, or the tag and attribute.
    pub tag: String,
    /// Why it is not used.
    pub why: String,
}

/// A value with the place that it comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its place; `None` for a value that no file gives.
    pub span: Option<Span>,
}

impl At {
    /// A whole line, from 1.
    #[must_use]
    pub fn line_of(line: u32) -> Self {
        Self::Text { line, column: 0 }
    }

    /// The line, if it is in a file.
    #[must_use]
    pub fn line(self) -> Option<u32> {
        if let Self::Text { line, .. } | Self::Included { line, .. } = self { Some(line) } else { None }
    }

    /// The column, if it is known.
    #[must_use]
    pub fn column(self) -> Option<u32> {
        match self {
            Self::Text { column: column @ 1.., .. } | Self::Included { column: column @ 1.., .. } => Some(column),
            _ => None,
        }
    }
}

impl Place<'_> {
    /// The whole document.
    pub const DOCUMENT: Place<'static> = Place { at: At::Nowhere, subject: &Subject::Document, field: "" };
}

impl<'a> From<(At, &'a str)> for Place<'a> {
    fn from((at, field): (At, &'a str)) -> Self {
        Self { at, field, ..Place::DOCUMENT }
    }
}

impl<'a> From<(At, &'a String)> for Place<'a> {
    fn from((at, field): (At, &'a String)) -> Self {
        Self::from((at, field.as_str()))
    }
}

impl Default for Place<'_> {
    fn default() -> Self {
        Self::DOCUMENT
    }
}

impl<'a> From<&Place<'a>> for Place<'a> {
    fn from(place: &Place<'a>) -> Self {
        *place
    }
}

impl Diagnostic {
    /// An error at a place of a file.
    #[must_use]
    pub fn error<'a>(file: &str, place: impl Into<Place<'a>>, code: Code, found: impl Into<String>, expected: impl Into<String>) -> Self {
        let Place { at, subject, field } = place.into();
        Self {
            severity: Severity::Error,
            code,
            span: Span { file: file.to_string(), at },
            subject: subject.clone(),
            field: field.to_string(),
            found: found.into(),
            expected: expected.into(),
            hint: None,
        }
    }

    /// An error that one sentence describes.
    #[must_use]
    pub fn refusal<'a>(file: &str, place: impl Into<Place<'a>>, code: Code, sentence: impl Into<String>) -> Self {
        Self::error(file, place, code, sentence, "")
    }

    /// The same finding as a warning.
    #[must_use]
    pub fn into_warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }

    /// The same finding at the place of an entry, if a file gives it.
    #[must_use]
    pub fn at<T>(self, entry: &Spanned<T>) -> Self {
        Self { span: entry.span.clone().unwrap_or(self.span), ..self }
    }

    /// The same finding with a hint, if there is one.
    #[must_use]
    pub fn with_hint(self, hint: Option<String>) -> Self {
        Self { hint: hint.or(self.hint), ..self }
    }

    /// The same finding with the intended name, if there is one.
    #[must_use]
    pub fn with_nearest(self, nearest: Option<impl AsRef<str>>) -> Self {
        self.with_hint(nearest.map(|name| format!("did you mean {:?}?", name.as_ref())))
    }

    /// The file.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.span.file
    }

    /// The line, from 1, where it is known.
    #[must_use]
    pub fn line(&self) -> Option<u32> {
        self.span.at.line()
    }

    /// All but the file and the line.
    #[must_use]
    pub fn message(&self) -> String {
        let mut out = String::new();
        if self.subject != Subject::Document {
            out += &format!("{}: ", self.subject);
        }
        if !self.field.is_empty() {
            out += &format!("{}: ", self.field);
        }
        if self.is_sentence() {
            out += &self.found;
        } else {
            out += &format!("found {}", self.found);
        }
        if !self.expected.is_empty() {
            out += &format!(", expected {}", self.expected);
        }
        if let Some(hint) = &self.hint {
            out += &format!("; {hint}");
        }
        out
    }

    /// Whether `found` is a sentence.
    fn is_sentence(&self) -> bool {
        self.expected.is_empty() && !matches!(self.code, Code::More | Code::Syntax)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.span.file.is_empty() {
            write!(f, "{}:", self.span.file)?;
            if let Some(line) = self.line() {
                write!(f, "{line}:")?;
            }
            f.write_str(" ")?;
        }
        f.write_str(&self.message())
    }
}

impl core::error::Error for Diagnostic {}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Document => f.write_str("document"),
            Self::Link(name) => write!(f, "link {}", quote(name)),
            Self::Joint(name) => write!(f, "joint {}", quote(name)),
        }
    }
}

impl fmt::Display for Unused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if self.subject != Subject::Document {
            write!(f, "{}: ", self.subject)?;
        }
        write!(f, "{}: {}", self.tag, self.why)
    }
}

impl<T> Spanned<T> {
    /// A value from a place of a file.
    pub fn new(value: T, file: &str, at: At) -> Self {
        Self { value, span: Some(Span { file: file.to_string(), at }) }
    }

    /// The place, or the file as a whole for a value that has none.
    pub fn span_or(&self, file: &str) -> Span {
        self.span.clone().unwrap_or_else(|| Span { file: file.to_string(), at: At::Nowhere })
    }
}

impl<T> Deref for Spanned<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> DerefMut for Spanned<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.value
    }
}

impl<T> From<T> for Spanned<T> {
    fn from(value: T) -> Self {
        Self { value, span: None }
    }
}

impl From<&str> for Spanned<String> {
    fn from(value: &str) -> Self {
        String::from(value).into()
    }
}

impl AsRef<str> for Spanned<String> {
    fn as_ref(&self) -> &str {
        &self.value
    }
}

impl<T: fmt::Display> fmt::Display for Spanned<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)
    }
}

/// The values, without their places.
pub fn values<T: Clone>(all: &[Spanned<T>]) -> Vec<T> {
    all.iter().map(|one| one.value.clone()).collect()
}

#[cfg(test)]
mod tests;
