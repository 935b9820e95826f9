//! Files and the files that they include, as one tree of tags.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use articulated_core::diagnostic::{Code, Diagnostics, Place, Subject, quote};

use crate::Sources;
use crate::xml::document;
use crate::xml::element::Tag;
use crate::xml::lines::Lines;
pub(crate) use crate::xml::tree::{Attribute, Element, File};

/// Maximum depth of nested tags; included ones count inside those that include them.
const MOST_DEPTH: usize = 256;
/// Maximum number of included files, and of all their tags.
const MOST_FILES: usize = 1000;
const MOST_TAGS: usize = 2 << 20;

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

    /// The root of a document, with the included files in place of their tags.
    pub(crate) fn root(&mut self, bytes: &[u8], file: &str, log: &mut Diagnostics) -> Option<Element> {
        let mut own = Diagnostics::new(file);
        let root = self.document(bytes, &Rc::new(File { name: file.to_owned(), ..File::default() }), 0, &mut own);
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
        let mut element = Element::of(tag, file);
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
        // From the main file's folder, or else from the folder of the including file.
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
                    let file = File { name: path.to_string_lossy().into_owned(), included: true, ..File::default() };
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
