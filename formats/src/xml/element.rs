//! A tag of the document with its line and its subject.

use articulated_core::diagnostic::{At, Code, Diagnostics, Place, Subject};
use roxmltree::{Attribute, Node};

use super::lines::Lines;
use super::markup;

/// Longer names are refused: each message about a link or joint carries its name.
const MOST_NAME: usize = 1024;

#[derive(Clone, Copy)]
pub(crate) struct Tag<'a> {
    node: Node<'a, 'a>,
    lines: &'a Lines<'a>,
    subject: &'a Subject,
}

/// The option that takes the first one of repeated unique tags, as the command, scenes and macro,
/// and build scripts spell it.
pub(crate) const FIRST_OF_DUPLICATES: &str = "`--first-of-duplicates` (key `first_of_duplicates`, method `Build::first_of_duplicates`)";

impl<'a> Tag<'a> {
    pub(crate) fn new(node: Node<'a, 'a>, lines: &'a Lines<'a>, subject: &'a Subject) -> Self {
        Self { node, lines, subject }
    }

    /// The same tag as part of a link or joint.
    pub(crate) fn of<'b>(&self, subject: &'b Subject) -> Tag<'b>
    where
        'a: 'b,
    {
        Tag { node: self.node, lines: self.lines, subject }
    }

    /// Whether expressions of xacro in this document have errors of their own.
    pub(crate) fn reports_expressions(&self) -> bool {
        self.lines.expressions_reported
    }

    pub(crate) fn subject(&self) -> &'a Subject {
        self.subject
    }

    pub(crate) fn is(&self, name: &str) -> bool {
        markup::is_name(self.node.tag_name().name(), name)
    }

    /// The tag's name as the file writes it.
    pub(crate) fn name(&self) -> String {
        markup::as_written(self.node.tag_name().name())
    }

    /// Its place in the file.
    pub(crate) fn at(&self) -> At {
        self.lines.at(self.node.range().start)
    }

    /// Reports that it is not used.
    pub(crate) fn unused(&self, log: &mut Diagnostics, what: String, why: impl Into<String>) {
        log.unused_at(self.at(), self.subject, what, why);
    }

    pub(crate) fn children(&self) -> impl Iterator<Item = Tag<'a>> + use<'a> {
        let Tag { lines, subject, node } = *self;
        node.children().filter(Node::is_element).map(move |node| Tag { node, lines, subject })
    }

    /// The first text in it, and its line.
    pub(crate) fn text(&self) -> Option<(&'a str, At)> {
        let text = |node: Node<'a, 'a>| Some((node.text()?.trim(), self.lines.at(node.range().start)));
        self.node.children().filter(Node::is_text).filter_map(text).find(|(text, _)| !text.is_empty())
    }

    /// This tag and all inside it.
    pub(crate) fn descendants(&self) -> impl Iterator<Item = Tag<'a>> + use<'a> {
        let Tag { lines, subject, node } = *self;
        node.descendants().filter(Node::is_element).map(move |node| Tag { node, lines, subject })
    }

    pub(crate) fn attributes(&self) -> impl Iterator<Item = Attribute<'a, 'a>> + use<'a> {
        self.node.attributes()
    }

    /// Names, values and lines of the attributes.
    pub(crate) fn attributes_with_lines(&self) -> impl Iterator<Item = (&'a str, &'a str, At)> + use<'a> {
        let Tag { lines, node, .. } = *self;
        node.attributes().map(move |a| (a.name(), a.value(), lines.at(a.range().start)))
    }

    /// End of the tag in the text.
    pub(crate) fn end(&self) -> usize {
        self.node.range().end
    }

    /// Start of the tag in the text.
    pub(crate) fn start(&self) -> usize {
        self.node.range().start
    }

    /// An attribute's value and line.
    pub(crate) fn attribute(&self, name: &str) -> Option<(&'a str, At)> {
        let attribute = self.node.attributes().find(|attribute| markup::is_name(attribute.name(), name))?;
        Some((attribute.value(), self.lines.at(attribute.range().start)))
    }

    pub(crate) fn place<'b>(&self, field: &'b str) -> Place<'b>
    where
        'a: 'b,
    {
        Place { at: self.at(), subject: self.subject, field }
    }

    /// The only tag of this name, if there is one. A second one is an error, or a warning if it has
    /// the same content.
    pub(crate) fn only(&self, name: &str, log: &mut Diagnostics) -> Option<Tag<'a>> {
        let mut all = self.children().filter(|tag| tag.is(name));
        let first = all.next()?;
        let expected = format!("one <{name}> inside <{}>", self.name());
        all.for_each(|again| again.report_again(&first, name, ("", &expected), log));
        Some(first)
    }

    /// Reports this tag, which repeats `first`; the first one counts. An error, or a warning if it
    /// has the same content. `of`: the text after the tag's name in the message.
    pub(crate) fn report_again(&self, first: &Tag<'a>, name: &str, (of, expected): (&str, &str), log: &mut Diagnostics) {
        let (place, kind, line) = (self.place(name), Code::DuplicateTag, first.at().line().unwrap_or_default());
        if self.says_the_same(first) {
            let found = format!("a second <{name}>{of}, equal to the first in line {line}");
            return log.warning(place, kind, found, format!("{expected}; used once"));
        }
        let found = format!("a second <{name}>{of} (the first is in line {line})");
        match self.lines.first_of_duplicates {
            true => log.warning(place, kind, found, format!("{expected}; the first is used")),
            false => log.error(place, kind, found, format!("{expected}; {FIRST_OF_DUPLICATES} takes the first")),
        }
    }

    /// Whether both have the same attributes, in any order, and the same tags and text inside.
    fn says_the_same(&self, other: &Tag<'a>) -> bool {
        let attributes = |tag: &Tag<'a>| {
            let mut all: Vec<_> = tag.node.attributes().map(|a| (a.name(), a.value().trim())).collect();
            all.sort_unstable();
            all
        };
        let text = |tag: &Tag<'a>| tag.node.text().map(str::trim).unwrap_or_default().to_owned();
        let (own, others): (Vec<_>, Vec<_>) = (self.children().collect(), other.children().collect());
        self.node.tag_name() == other.node.tag_name()
            && attributes(self) == attributes(other)
            && text(self) == text(other)
            && own.len() == others.len()
            && own.iter().zip(&others).all(|(a, b)| a.says_the_same(b))
    }

    /// The only tag of this name, which is required.
    pub(crate) fn required(&self, name: &str, log: &mut Diagnostics) -> Option<Tag<'a>> {
        let tag = self.only(name, log);
        if tag.is_none() {
            let expected = format!("<{name}> inside <{}>", self.name());
            log.error(self.place(name), Code::MissingTag, "none", expected);
        }
        tag
    }

    /// A required attribute.
    pub(crate) fn required_attribute(&self, name: &str, log: &mut Diagnostics) -> Option<(&'a str, At)> {
        let value = self.attribute(name);
        if value.is_none() {
            let expected = format!("the attribute {name} in <{}>", self.name());
            log.error(self.place(name), Code::MissingAttribute, "none", expected);
        }
        value
    }

    /// A required, non-empty attribute with a name.
    pub(crate) fn required_name(&self, attribute: &str, log: &mut Diagnostics) -> Option<String> {
        let (name, at) = self.required_attribute(attribute, log)?;
        if name.trim().is_empty() {
            let place = Place { at, ..self.place(attribute) };
            log.error(place, Code::EmptyName, "an empty name", "a name");
            return None;
        }
        if name.len() > MOST_NAME {
            let place = Place { at, ..self.place(attribute) };
            let found = format!("a name of {} bytes", name.len());
            log.error(place, Code::TooLarge, found, format!("at most {MOST_NAME}"));
            return None;
        }
        Some(name.to_owned())
    }

    /// The tag's name for messages, shortened if it is too long.
    pub(crate) fn name_for_messages(&self) -> String {
        let name = self.attribute("name").map_or("", |(name, _)| name);
        name.chars().take(MOST_NAME / 4).collect()
    }
}
