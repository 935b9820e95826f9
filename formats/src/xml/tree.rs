//! Tags with their attributes, as a tree that may come from several files.

use std::rc::Rc;

use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Subject, Unused};

use super::element::Tag;
use super::markup::as_written;

/// A tag with everything inside it.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) children: Vec<Element>,
    pub(crate) at: At,
    /// The first text that is in it, without blanks at its ends.
    pub(crate) content: Option<String>,
    /// The file that it is in.
    pub(crate) file: Rc<File>,
}

#[derive(Debug)]
pub(crate) struct Attribute {
    pub(crate) name: String,
    pub(crate) value: String,
    pub(crate) at: At,
}

/// A file that was read.
#[derive(Debug, Default)]
pub(crate) struct File {
    /// As in messages.
    pub(crate) name: String,
    /// Whether another file includes it.
    pub(crate) included: bool,
    /// Whether the first one of repeated unique tags counts.
    pub(crate) first_of_duplicates: bool,
    /// Whether its tags are made from a file of another format, whose warnings are already
    /// reported.
    pub(crate) converted: bool,
}

impl Element {
    /// From a tag of a file, without its children.
    pub(crate) fn of(tag: &Tag<'_>, file: &Rc<File>) -> Self {
        let attributes = tag
            .attributes_with_lines()
            .map(|(name, value, at)| Attribute { name: as_written(name), value: value.to_owned(), at })
            .collect();
        let content = tag.text().map(|(text, _)| text.to_owned());
        Self { name: tag.name(), attributes, children: Vec::new(), at: tag.at(), content, file: file.clone() }
    }

    pub(crate) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        self.attribute(name).map(|attribute| attribute.value.as_str())
    }

    pub(crate) fn is(&self, name: &str) -> bool {
        self.name == name
    }

    /// Whether both have the same attributes, in any order, and the same tags and text inside.
    pub(crate) fn says_the_same(&self, other: &Element) -> bool {
        let attributes = |element: &Element| {
            let mut all: Vec<(String, String)> =
                element.attributes.iter().map(|own| (own.name.clone(), own.value.trim().to_owned())).collect();
            all.sort_unstable();
            all
        };
        self.name == other.name
            && self.content == other.content
            && attributes(self) == attributes(other)
            && self.children.len() == other.children.len()
            && self.children.iter().zip(&other.children).all(|(a, b)| a.says_the_same(b))
    }

    /// The children of this name.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.name == name)
    }

    fn diagnostic(&self, at: At, subject: &Subject, field: &str, code: Code, found: String, expected: String) -> Diagnostic {
        Diagnostic::error(&self.file.name, Place { at, subject, field }, code, found, expected)
    }

    /// Reports an error at an attribute, or at the tag if it has no such attribute.
    pub(crate) fn error(
        &self,
        (subject, field): (&Subject, &str),
        code: Code,
        found: impl Into<String>,
        expected: impl Into<String>,
        log: &mut Diagnostics,
    ) {
        log.push(self.diagnostic(self.at_of(field), subject, field, code, found.into(), expected.into()));
    }

    /// Reports a warning, as [`Self::error`].
    pub(crate) fn warning(
        &self,
        (subject, field): (&Subject, &str),
        code: Code,
        found: impl Into<String>,
        expected: impl Into<String>,
        log: &mut Diagnostics,
    ) {
        if self.file.converted {
            return;
        }
        log.push(self.diagnostic(self.at_of(field), subject, field, code, found.into(), expected.into()).into_warning());
    }

    fn at_of(&self, field: &str) -> At {
        self.attribute(field).map_or(self.at, |attribute| attribute.at)
    }

    /// Reports unused content: an attribute, or the tag.
    pub(crate) fn unused(&self, subject: &Subject, attribute: Option<&Attribute>, why: &str, log: &mut Diagnostics) {
        let what = attribute.map_or_else(|| self.name.clone(), |attribute| format!("{} {}", self.name, attribute.name));
        self.unused_part(subject, (attribute, what), why, log);
    }

    /// As [`Self::unused`], under another name.
    pub(crate) fn unused_part(&self, subject: &Subject, (attribute, what): (Option<&Attribute>, String), why: &str, log: &mut Diagnostics) {
        if self.file.converted {
            return;
        }
        let why = if self.file.included { format!("{why} ({})", self.file.name) } else { why.to_owned() };
        let line = attribute.map_or(self.at, |attribute| attribute.at).line();
        log.push_unused(Unused { line, subject: subject.clone(), tag: what, why });
    }
}
