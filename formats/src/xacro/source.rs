//! The tags of a source file, and of the expanded document: a tree of nodes with the places of
//! their sources.

use std::rc::Rc;

use articulated_core::diagnostic::{At, Code, Diagnostics, Place};
use roxmltree::{Document, Node as XmlNode};

use crate::xml::document;
use crate::xml::lines::Lines;
use crate::xml::markup;

/// Maximum number of tags and attributes of a source file, or of all.
const MOST_NODES: usize = 1 << 20;

/// A tag with everything inside it. Names have the colon of the prepared text, see [`markup`].
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: Rc<str>,
    pub(super) attributes: Vec<Attribute>,
    pub(super) children: Vec<Node>,
    pub(super) at: At,
}

#[derive(Clone, Debug)]
pub(super) struct Attribute {
    pub(super) name: Rc<str>,
    pub(super) value: Rc<str>,
    pub(super) at: At,
}

#[derive(Clone, Debug)]
pub(super) enum Node {
    Element(Rc<Element>),
    Text(Rc<str>, At),
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| &*attribute.name == name)
    }

    /// The name of a tag of xacro, without the prefix.
    pub(super) fn directive(&self) -> Option<&str> {
        self.name.strip_prefix(PREFIX)
    }

    pub(super) fn elements(&self) -> impl Iterator<Item = &Rc<Element>> {
        self.children.iter().filter_map(|child| if let Node::Element(element) = child { Some(element) } else { None })
    }
}

/// `xacro:` in the prepared text.
pub(super) const PREFIX: &str = "xacro\u{b7}";

/// The name of the prepared text that a file writes so.
pub(super) fn prepared(name: &str) -> String {
    name.replace(':', "\u{b7}")
}

/// The root of a file's text, as [`document::text`] prepares it. `file`: the number of an included
/// file in the collector. `nodes` counts the tags and attributes of all files.
pub(super) fn read(text: &str, file: Option<u16>, nodes: &mut usize, log: &mut Diagnostics) -> Option<Rc<Element>> {
    let lines = Lines::of(text);
    let document = document::parse(text, &lines, log)?;
    tree(&document, &lines, file, nodes, log)
}

/// As [`read`], for a parsed document.
pub(super) fn tree(
    document: &Document<'_>,
    lines: &Lines<'_>,
    file: Option<u16>,
    nodes: &mut usize,
    log: &mut Diagnostics,
) -> Option<Rc<Element>> {
    let tree = Reader { lines, file }.element(document.root_element(), nodes);
    if tree.is_none() {
        log.error(Place::DOCUMENT, Code::TooLarge, "very many tags and attributes", format!("at most {MOST_NODES}"));
    }
    tree
}

struct Reader<'a> {
    lines: &'a Lines<'a>,
    file: Option<u16>,
}

impl Reader<'_> {
    fn at(&self, position: usize) -> At {
        match (self.lines.at(position), self.file) {
            (At::Text { line, column }, Some(file)) => At::Included { file, line, column },
            (at, _) => at,
        }
    }

    /// The tags are nested less deeply than [`markup::prepare`] allows.
    fn element(&self, node: XmlNode<'_, '_>, nodes: &mut usize) -> Option<Rc<Element>> {
        *nodes += 1 + node.attributes().len();
        if *nodes > MOST_NODES {
            return None;
        }
        let attributes =
            node.attributes().map(|a| Attribute { name: a.name().into(), value: a.value().into(), at: self.at(a.range().start) });
        let mut element = Element {
            name: node.tag_name().name().into(),
            attributes: attributes.collect(),
            children: Vec::new(),
            at: self.at(node.range().start),
        };
        for child in node.children() {
            if child.is_element() {
                element.children.push(Node::Element(self.element(child, nodes)?));
            } else if let Some(text) = child.text().filter(|text| child.is_text() && !text.trim().is_empty()) {
                element.children.push(Node::Text(text.into(), self.at(child.range().start)));
            }
        }
        Some(Rc::new(element))
    }
}

/// An expanded document as text, and its sources: positions in order, each with the source place of
/// the text from there on.
pub(crate) struct Expanded {
    pub(crate) text: String,
    pub(crate) origins: Vec<(usize, At)>,
}

/// Writes a document for the XML reader. It is nested less deeply than [`markup::prepare`] allows.
pub(super) fn write(root: &Element) -> Expanded {
    let mut out = Expanded { text: String::new(), origins: Vec::new() };
    write_element(root, &mut out);
    out
}

fn write_element(element: &Element, out: &mut Expanded) {
    out.origins.push((out.text.len(), element.at));
    out.text.push('<');
    out.text.push_str(&element.name);
    for attribute in &element.attributes {
        out.text.push(' ');
        out.origins.push((out.text.len(), attribute.at));
        out.text.push_str(&attribute.name);
        out.text.push_str("=\"");
        escape(&attribute.value, &mut out.text);
        out.text.push('"');
    }
    out.text.push('>');
    for child in &element.children {
        match child {
            Node::Element(child) => write_element(child, out),
            Node::Text(text, at) => {
                out.origins.push((out.text.len(), *at));
                escape(text, &mut out.text);
            }
        }
    }
    out.text.push_str("</");
    out.text.push_str(&element.name);
    out.text.push('>');
}

fn escape(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\r' | '\t' => out.extend([' ']),
            // XML has no way to write them.
            c if c < ' ' || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(char::REPLACEMENT_CHARACTER),
            c => out.push(c),
        }
    }
}

/// Whether an expanded name is valid for a tag or an attribute.
pub(super) fn is_name(name: &str) -> bool {
    let name = markup::as_written(name);
    let mut characters = name.chars();
    name.len() <= 1024
        && characters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && characters.all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | ':'))
}
