//! The tags of a file and of the files that it includes, as one tree.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Subject, Unused, quote};

use crate::Sources;
use crate::xml::document;
use crate::xml::element::Tag;
use crate::xml::lines::Lines;

/// Tags may be nested so deeply, included ones in those that include them.
const MOST_DEPTH: usize = 256;
/// A file may include so many files, and so many tags altogether.
const MOST_FILES: usize = 1000;
const MOST_TAGS: usize = 2 << 20;

/// A tag with everything inside it.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) children: Vec<Element>,
    pub(crate) at: At,
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
#[derive(Debug)]
pub(crate) struct File {
    /// As in messages.
    pub(crate) name: String,
    /// Whether another file includes it.
    pub(crate) included: bool,
}

impl Element {
    pub(crate) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        self.attribute(name).map(|attribute| attribute.value.as_str())
    }

    pub(crate) fn is(&self, name: &str) -> bool {
        self.name == name
    }

    /// The children of this name.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.name == name)
    }

    fn diagnostic(&self, at: At, subject: &Subject, field: &str, code: Code, found: String, expected: String) -> Diagnostic {
        Diagnostic::error(&self.file.name, Place { at, subject, field }, code, found, expected)
    }

    /// Reports an error at one of the attributes, or at the tag where it has none of this name.
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
        log.push(self.diagnostic(self.at_of(field), subject, field, code, found.into(), expected.into()).into_warning());
    }

    fn at_of(&self, field: &str) -> At {
        self.attribute(field).map_or(self.at, |attribute| attribute.at)
    }

    /// Reports what of it is not used: an attribute, or the tag.
    pub(crate) fn unused(&self, subject: &Subject, attribute: Option<&Attribute>, why: &str, log: &mut Diagnostics) {
        let what = attribute.map_or_else(|| self.name.clone(), |attribute| format!("{} {}", self.name, attribute.name));
        let tag = if self.file.included { format!("{what} of {}", self.file.name) } else { what };
        let line = attribute.map_or(self.at, |attribute| attribute.at).line();
        log.push_unused(Unused { line, subject: subject.clone(), tag, why: why.to_owned() });
    }
}

/// Reads a file and the files that it includes.
pub(crate) struct Loader<'a> {
    sources: &'a dyn Sources,
    /// The folder of the main file.
    folder: PathBuf,
    included: BTreeSet<PathBuf>,
    tags: usize,
}

impl<'a> Loader<'a> {
    pub(crate) fn new(sources: &'a dyn Sources, file: &str) -> Self {
        let folder = Path::new(file).parent().map(Path::to_owned).unwrap_or_default();
        Self { sources, folder, included: BTreeSet::from([PathBuf::from(file)]), tags: 0 }
    }

    /// The root of a document, with the included files in the place of their tags.
    pub(crate) fn root(&mut self, bytes: &[u8], file: &str, log: &mut Diagnostics) -> Option<Element> {
        let mut own = Diagnostics::new(file);
        let root = self.document(bytes, &Rc::new(File { name: file.to_owned(), included: false }), 0, &mut own);
        log.take(own);
        root
    }

    fn document(&mut self, bytes: &[u8], file: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Option<Element> {
        let text = document::text(bytes, log)?;
        let lines = Lines::of(&text);
        let document = document::parse(&text, &lines, log)?;
        let root = Tag::new(document.root_element(), &lines, &Subject::Document);
        if !root.name().eq_ignore_ascii_case("mujoco") && (depth == 0 || !root.name().to_ascii_lowercase().starts_with("mujoco")) {
            let found = format!("the root element {}", quote(&root.name()));
            log.error(root.place(""), Code::NotARobot, found, "the root element <mujoco>");
            return None;
        }
        Some(self.element(&root, file, depth, log))
    }

    fn element(&mut self, tag: &Tag<'_>, file: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Element {
        let attributes = tag.attributes_with_lines().map(|(name, value, at)| Attribute {
            name: crate::xml::markup::as_written(name),
            value: value.to_owned(),
            at,
        });
        let mut element =
            Element { name: tag.name(), attributes: attributes.collect(), children: Vec::new(), at: tag.at(), file: file.clone() };
        if depth > MOST_DEPTH {
            log.error(tag.place(""), Code::TooLarge, "tags nested very deeply", format!("at most {MOST_DEPTH}"));
            return element;
        }
        for child in tag.children() {
            self.tags += 1;
            if self.tags > MOST_TAGS {
                log.error(child.place(""), Code::TooLarge, "very many tags", format!("at most {MOST_TAGS}"));
                break;
            }
            match child.is("include") {
                true => element.children.extend(self.include(&child, file, depth, log)),
                false => element.children.push(self.element(&child, file, depth + 1, log)),
            }
        }
        element
    }

    /// The tags of an included file.
    fn include(&mut self, tag: &Tag<'_>, from: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Vec<Element> {
        let Some((name, at)) = tag.required_attribute("file", log) else { return Vec::new() };
        let place = Place { at, ..tag.place("include file") };
        let beside = Path::new(&from.name).parent().unwrap_or(Path::new(""));
        // From the main file's folder, or else from that of the file that includes it.
        let paths = [self.folder.join(name), beside.join(name)];
        if self.included.len() >= MOST_FILES {
            log.error(place, Code::TooLarge, format!("more than {MOST_FILES} files"), format!("at most {MOST_FILES}"));
            return Vec::new();
        }
        let mut error = None;
        for path in paths {
            if self.included.contains(&path) {
                log.error(place, Code::DuplicateTag, format!("{}, which is included already", quote(name)), "each file once");
                return Vec::new();
            }
            match self.sources.read(&path) {
                Ok(bytes) => {
                    self.included.insert(path.clone());
                    let file = File { name: path.to_string_lossy().into_owned(), included: true };
                    let mut own = Diagnostics::new(&file.name);
                    let root = self.document(&bytes, &Rc::new(file), depth + 1, &mut own);
                    log.take(own);
                    return root.map(|root| root.children).unwrap_or_default();
                }
                Err(fault) => error = error.or(Some(fault)),
            }
        }
        let why = error.map(|error| error.to_string()).unwrap_or_default();
        let found = format!("{}: {why}", quote(name));
        log.error(place, Code::File, found, "a file, from the folder of the main file or of this one");
        Vec::new()
    }
}
