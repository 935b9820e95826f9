//! Files and the files that they include, as one tree of tags.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use articulated_core::description::Base;
use articulated_core::diagnostic::{Code, Diagnostics, Place, Subject, quote};

use super::convert;
use super::names::ROOT;
use crate::urdf::Urdf;
use crate::xml::document;
use crate::xml::element::Tag;
use crate::xml::lines::Lines;
use crate::xml::markup;
use crate::xml::tree::{Element, File};
use crate::{Format, Input, Options};

/// Maximum depth of nested tags; included ones count inside those that include them.
const MOST_DEPTH: usize = 256;
/// Maximum number of included files, and of all their tags.
const MOST_FILES: usize = 1000;
const MOST_TAGS: usize = 2 << 20;

/// Reads a file and the files that it includes.
pub(crate) struct Loader<'a> {
    input: &'a Input<'a>,
    files: usize,
    tags: usize,
    /// The files that are being read, one inside the other.
    open: Vec<PathBuf>,
}

impl<'a> Loader<'a> {
    pub(crate) fn new(input: &'a Input<'a>) -> Self {
        Self { input, files: 0, tags: 0, open: Vec::new() }
    }

    fn file(&self, name: &str, included: bool) -> Rc<File> {
        let first_of_duplicates = self.input.options.first_of_duplicates;
        Rc::new(File { name: name.to_owned(), included, first_of_duplicates, converted: false })
    }

    /// The root of a document. The root of an included file is a child of its `<include>`.
    pub(crate) fn root(&mut self, log: &mut Diagnostics) -> Option<Element> {
        let file = &self.input.options.file;
        self.open.push(file.into());
        self.document(self.input.bytes, &self.file(file, false), 0, log)
    }

    fn document(&mut self, bytes: &[u8], file: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Option<Element> {
        let mut own = Diagnostics::new(&file.name);
        let root = self.tags(bytes, file, depth, &mut own);
        log.take(own);
        root
    }

    fn tags(&mut self, bytes: &[u8], file: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Option<Element> {
        let text = document::text(bytes, log)?;
        let lines = Lines::of(&text);
        let document = document::parse(&text, &lines, log)?;
        let root = Tag::new(document.root_element(), &lines, &Subject::Document);
        if !root.name().eq_ignore_ascii_case(ROOT) {
            let found = format!("the root element {}", quote(&root.name()));
            log.error(root.place(""), Code::NotARobot, found, "the root element <sdf>");
            return None;
        }
        Some(self.element(&root, file, depth, log))
    }

    fn element(&mut self, tag: &Tag<'_>, file: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Element {
        let mut element = Element::of(tag, file);
        if depth > MOST_DEPTH {
            log.error(tag.place(""), Code::TooLarge, "tags nested very deeply", format!("at most {MOST_DEPTH}"));
            return element;
        }
        for child in tag.children() {
            self.tags += 1;
            if self.tags > MOST_TAGS {
                if self.tags == MOST_TAGS + 1 {
                    log.error(child.place(""), Code::TooLarge, "very many tags", format!("at most {MOST_TAGS}"));
                }
                break;
            }
            element.children.push(self.element(&child, file, depth + 1, log));
        }
        if element.is("include") && (tag.children().any(|child| child.is("uri"))) {
            let included = self.include(tag, file, depth, log);
            element.children.extend(included);
        }
        element
    }

    /// The root of an included file.
    fn include(&mut self, tag: &Tag<'_>, from: &Rc<File>, depth: usize, log: &mut Diagnostics) -> Option<Element> {
        let uri = tag.children().find(|child| child.is("uri"))?;
        let Some((name, at)) = uri.text() else {
            log.error(uri.place("uri"), Code::EmptyName, "an empty name", "the path of a file, or of the folder of a model");
            return None;
        };
        let place = Place { at, ..uri.place("uri") };
        if self.files >= MOST_FILES {
            if self.files == MOST_FILES {
                log.error(place, Code::TooLarge, format!("more than {MOST_FILES} files"), format!("at most {MOST_FILES}"));
            }
            self.files += 1;
            return None;
        }
        let path = without_scheme(name);
        if path.contains("://") {
            let expected = "a path beside this file, with model://, file:// or without: no other address is opened";
            log.error(place, Code::File, quote(name), expected);
            return None;
        }
        let beside = Path::new(&from.name).parent().unwrap_or(Path::new(""));
        let mut error = None;
        for folder in [beside.to_owned(), beside.join("..")] {
            match self.find(&folder.join(path)) {
                Ok((path, _)) if self.open.contains(&path) => {
                    let found = format!("{}, which includes this file", quote(name));
                    log.error(place, Code::Ring, found, "a file that does not include itself");
                    return None;
                }
                Ok((path, bytes)) => {
                    self.files += 1;
                    let file = self.file(&path.to_string_lossy(), true);
                    if markup::root(&bytes) == Some(b"robot") {
                        return self.urdf(&bytes, &file, log);
                    }
                    self.open.push(path);
                    let root = self.document(&bytes, &file, depth + 1, log);
                    self.open.pop();
                    return root;
                }
                Err(fault) => error = error.or(Some(fault)),
            }
        }
        let why = error.map(|error| error.to_string()).unwrap_or_default();
        let found = format!("{}: {why}", quote(name));
        let expected = "a file, or a folder with model.config or model.sdf, from the folder of this file or the one above it";
        log.error(place, Code::File, found, expected);
        None
    }

    /// A URDF, as the root of a document with its model.
    fn urdf(&mut self, bytes: &[u8], file: &Rc<File>, log: &mut Diagnostics) -> Option<Element> {
        let asked = self.input.options.clone();
        // The mass on its base is reported for the whole model; arguments are those of the main
        // file.
        let options = Options { file: file.name.clone(), base: Base::Floating, arguments: BTreeMap::new(), ..asked };
        let mut own = Diagnostics::new(&file.name);
        let read = Urdf.read(&Input { bytes, options: &options, sources: self.input.sources }, &mut own);
        own.unused.iter_mut().for_each(|unused| unused.why = format!("{} ({})", unused.why, file.name));
        let file = Rc::new(File { name: file.name.clone(), included: true, first_of_duplicates: false, converted: true });
        let root = read.filter(|_| own.is_ok()).map(|read| convert::document(&read.description, &file, &mut own));
        log.take(own);
        root
    }

    /// The file of this path, or the model file in the folder of this path.
    fn find(&self, path: &Path) -> std::io::Result<(PathBuf, Vec<u8>)> {
        let error = match self.input.sources.read(path) {
            Ok(bytes) => return Ok((path.to_owned(), bytes)),
            Err(error) => error,
        };
        let listed = self.input.sources.read(&path.join("model.config")).ok().and_then(|bytes| newest(&bytes));
        for name in listed.iter().map(String::as_str).chain(["model.sdf"]) {
            let path = path.join(name);
            if let Ok(bytes) = self.input.sources.read(&path) {
                return Ok((path, bytes));
            }
        }
        Err(error)
    }
}

fn without_scheme(uri: &str) -> &str {
    let path = ["model://", "package://", "file://"].iter().find_map(|scheme| uri.strip_prefix(scheme)).unwrap_or(uri);
    path.strip_suffix('/').unwrap_or(path)
}

/// The file of the newest version that a `model.config` lists.
fn newest(bytes: &[u8]) -> Option<String> {
    let log = &mut Diagnostics::default();
    let text = document::text(bytes, log)?;
    let lines = Lines::of(&text);
    let document = document::parse(&text, &lines, log)?;
    let root = Tag::new(document.root_element(), &lines, &Subject::Document);
    let version = |tag: &Tag<'_>| -> Vec<u32> {
        let text = tag.attribute("version").map_or("", |(version, _)| version);
        text.trim().split('.').map(|part| part.parse().unwrap_or(0)).collect()
    };
    let files = root.children().filter(|child| child.is(ROOT));
    files.max_by_key(version).and_then(|tag| Some(tag.text()?.0.to_owned()))
}
