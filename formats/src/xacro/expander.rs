//! Expands a document.
//!
//! The walk over the tags has its own stack of [`Frame`]s: macros that call themselves do not
//! recurse here. Evaluation of expressions recurses, to a bounded depth.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use articulated_core::diagnostic::{At, Code, Diagnostics, Place, Subject, quote};
use articulated_core::suggest::Suggester;

use super::evaluate::evaluate;
use super::files::{self, Packages};
use super::scope::{GLOBAL, Scopes, Symbol};
use super::source::{self, Attribute, Element, Node};
use super::text::{Piece, pieces};
use super::value::{Fault, Result, Value, read_literal, read_truth, wrong};
use super::work::{Names, Work};
use super::{syntax, yaml};
use crate::Input;
use crate::xml::document;
use crate::xml::markup::as_written;

/// Maximum total depth of nested macros, conditions, included files and tags.
const MOST_FRAMES: usize = 2000;
/// Maximum depth of nested tags of the expanded document.
const MOST_DEPTH: usize = 200;
/// Bounds of the expanded document, with the blocks of macros: tags and attributes, and bytes.
const MOST_NODES: usize = 1 << 20;
const MOST_BYTES: usize = 32 << 20;
/// Bounds of included files: their number, counting repetitions, their nesting, and bytes of text.
const MOST_FILES: usize = 1000;
const MOST_NESTED_FILES: usize = 64;
const MOST_SOURCE: usize = 16 << 20;
/// Work of one tag, in steps of expressions.
const STEPS: usize = 16;

/// A file that is expanded.
pub(super) struct File {
    pub(super) path: PathBuf,
    /// Depth of nested included files.
    depth: usize,
}

/// A tag whose content is expanded.
pub(super) struct Frame {
    source: Rc<Element>,
    next: usize,
    pub(super) scope: usize,
    pub(super) file: Rc<File>,
    content: Content,
    finish: Finish,
    /// Depth in the expanded document.
    depth: usize,
}

#[derive(Default)]
struct Content {
    attributes: Vec<Attribute>,
    children: Vec<Node>,
}

/// Use of the expanded content.
pub(super) enum Finish {
    /// A tag of the expanded document.
    Element { name: Rc<str>, at: At },
    /// It replaces a tag of xacro.
    Splice,
    /// The blocks of a macro's call; the macro's name.
    Call(Rc<str>),
    /// The body of a macro: its name, and the place of its call.
    Body { name: Rc<str>, at: At },
}

pub(super) struct Expander<'a> {
    pub(super) input: &'a Input<'a>,
    pub(super) log: &'a mut Diagnostics,
    pub(super) scopes: Scopes,
    pub(super) frames: Vec<Frame>,
    pub(super) packages: Packages,
    pub(super) suggester: Suggester,
    /// Values of `<xacro:arg>`.
    pub(super) arguments: BTreeMap<String, Rc<str>>,
    /// Names of arguments that the file declares or uses.
    pub(super) declared: BTreeSet<String>,
    /// Whether a part of the robot is missing, which has been reported.
    pub(super) incomplete: bool,
    /// Whether a bound was reached, which has been reported.
    stopped: bool,
    work: Work,
    /// Where expressions are evaluated.
    scope: usize,
    at: At,
    /// Whether names are those of arguments: in `$(eval)`.
    in_eval: bool,
    sources: BTreeMap<PathBuf, Option<Rc<Element>>>,
    source_nodes: usize,
    source_bytes: usize,
    included: usize,
    nodes: usize,
    bytes: usize,
    /// Files and lines with a warning.
    warned: BTreeSet<(String, u32)>,
}

impl<'a> Expander<'a> {
    pub(super) fn new(input: &'a Input<'a>, source_nodes: usize, log: &'a mut Diagnostics) -> Self {
        let arguments = input.options.arguments.iter().map(|(name, value)| (name.clone(), value.as_str().into())).collect();
        Self {
            input,
            log,
            scopes: Scopes::new(),
            frames: Vec::new(),
            packages: Packages::default(),
            suggester: Suggester::default(),
            arguments,
            declared: BTreeSet::new(),
            incomplete: false,
            stopped: false,
            work: Work::default(),
            scope: GLOBAL,
            at: At::Nowhere,
            in_eval: false,
            sources: BTreeMap::new(),
            source_nodes,
            source_bytes: 0,
            included: 0,
            nodes: 0,
            bytes: 0,
            warned: BTreeSet::new(),
        }
    }

    /// The expanded root. `None`: a bound was reached.
    pub(super) fn expand(&mut self, root: &Rc<Element>) -> Option<Element> {
        let file = Rc::new(File { path: PathBuf::from(&self.input.options.file), depth: 0 });
        self.open(root, &root.name, GLOBAL, file);
        while let Some(frame) = self.frames.last_mut() {
            if let Some(node) = frame.source.children.get(frame.next).cloned() {
                frame.next += 1;
                match node {
                    Node::Element(element) => self.element(&element),
                    Node::Text(text, at) => self.text(&text, at),
                }
            } else if let Some(frame) = self.frames.pop()
                && let Some(root) = self.finish(frame)
            {
                return Some(root).filter(|_| !self.stopped);
            }
            if self.stopped {
                self.frames.clear();
            }
        }
        None
    }

    pub(super) fn path(&self) -> &Path {
        self.frames.last().map_or(Path::new(""), |frame| &frame.file.path)
    }

    pub(super) fn folder(&self) -> PathBuf {
        self.path().parent().map(Path::to_owned).unwrap_or_default()
    }

    // Reports.

    /// The link or joint that is expanded.
    fn subject(&self) -> Subject {
        for frame in self.frames.iter().rev() {
            let Finish::Element { name, .. } = &frame.finish else { continue };
            let own = frame.content.attributes.iter().find(|a| &*a.name == "name").map(|a| a.value.chars().take(256).collect());
            match (&**name, own) {
                ("link", Some(name)) => return Subject::Link(name),
                ("joint", Some(name)) => return Subject::Joint(name),
                _ => {}
            }
        }
        Subject::Document
    }

    /// The place of the call of the expanded macro.
    fn caller(&self) -> Option<String> {
        let index = self.frames.iter().rposition(|frame| matches!(frame.finish, Finish::Body { .. }))?;
        let Finish::Body { name, at } = &self.frames[index].finish else { return None };
        let call = self.log.finding((*at, ""), Code::Xacro, "", "").span;
        Some(format!("in the macro {} that {}:{} calls", as_written(name), call.file, call.at.line().unwrap_or_default()))
    }

    pub(super) fn error(&mut self, at: At, field: &str, code: Code, found: impl Into<String>, expected: impl Into<String>) {
        let subject = self.subject();
        let field = as_written(field);
        let place = Place { at, subject: &subject, field: &field };
        let finding = self.log.finding(place, code, found, expected).with_hint(self.caller());
        self.log.push(finding);
    }

    pub(super) fn warning(&mut self, at: At, field: &str, code: Code, found: impl Into<String>, expected: impl Into<String>) {
        let subject = self.subject();
        let field = as_written(field);
        let place = Place { at, subject: &subject, field: &field };
        let finding = self.log.finding(place, code, found, expected).with_hint(self.caller());
        self.log.push(finding.into_warning());
    }

    /// Reports the errors of a text with expressions.
    pub(super) fn fault(&mut self, at: At, field: &str, text: &str, fault: Fault) {
        match fault {
            Fault::Reported => {}
            Fault::Wrong { found, expected } => {
                let text: String = text.chars().take(100).collect();
                self.error(at, field, Code::Xacro, format!("the xacro expression {} with {found}", quote(&text)), expected);
            }
            Fault::TooLarge { found, most } => self.too_large(at, found, most),
        }
    }

    fn too_large(&mut self, at: At, found: &str, most: usize) {
        if !self.stopped {
            self.error(at, "", Code::TooLarge, found, format!("at most {most}"));
        }
        (self.stopped, self.incomplete) = (true, true);
    }

    // Content.

    fn count(&mut self, nodes: usize, bytes: usize, at: At) {
        self.nodes += nodes;
        self.bytes += bytes;
        if self.nodes > MOST_NODES {
            self.too_large(at, "an expanded document of very many tags and attributes", MOST_NODES);
        }
        if self.bytes > MOST_BYTES {
            self.too_large(at, "an expanded document of very many bytes", MOST_BYTES);
        }
    }

    fn text(&mut self, text: &str, at: At) {
        let Some(frame) = self.frames.last() else { return };
        let value = match self.evaluated(text, at, frame.scope) {
            Ok(value) => files::written(&value.written()),
            Err(fault) => {
                self.fault(at, "text", text, fault);
                text.to_owned()
            }
        };
        self.count(1, value.len(), at);
        if let Some(frame) = self.frames.last_mut() {
            frame.content.children.push(Node::Text(value.into(), at));
        }
    }

    /// Opens a tag of the expanded document.
    pub(super) fn open(&mut self, element: &Rc<Element>, name: &Rc<str>, scope: usize, file: Rc<File>) {
        let finish = Finish::Element { name: name.clone(), at: element.at };
        self.push(element, scope, file, finish);
        self.count(1, name.len() * 2 + 8, element.at);
        for attribute in &element.attributes {
            if attribute.name.starts_with(source::PREFIX) || &*attribute.name == "xmlns\u{b7}xacro" {
                continue;
            }
            let value = self.attribute(name, attribute, scope);
            self.count(1, attribute.name.len() + value.len() + 8, attribute.at);
            if let Some(frame) = self.frames.last_mut() {
                frame.content.attributes.push(Attribute { value, ..attribute.clone() });
            }
        }
    }

    fn attribute(&mut self, tag: &str, attribute: &Attribute, scope: usize) -> Rc<str> {
        if !attribute.value.contains('$') {
            return attribute.value.clone();
        }
        match self.evaluated(&attribute.value, attribute.at, scope) {
            Ok(value) => files::written(&value.written()).into(),
            // Names of files have no effect on the dynamics.
            Err(Fault::Wrong { found, expected }) if &*attribute.name == "filename" => {
                let found = format!("the xacro expression {} with {found}", quote(&attribute.value));
                self.warning(
                    attribute.at,
                    &format!("{tag} filename"),
                    Code::Xacro,
                    found,
                    format!("{expected}; the name is left as written"),
                );
                attribute.value.clone()
            }
            Err(fault) => {
                self.fault(attribute.at, &format!("{tag} {}", attribute.name), &attribute.value, fault);
                attribute.value.clone()
            }
        }
    }

    /// Expands the content of a tag next.
    pub(super) fn push(&mut self, source: &Rc<Element>, scope: usize, file: Rc<File>, finish: Finish) {
        if self.frames.len() >= MOST_FRAMES {
            return self.too_large(source.at, "macros, conditions and tags nested very deeply", MOST_FRAMES);
        }
        let own = usize::from(matches!(finish, Finish::Element { .. }));
        let depth = self.frames.last().map_or(0, |frame| frame.depth) + own;
        if depth > MOST_DEPTH {
            return self.too_large(source.at, "tags nested very deeply", MOST_DEPTH);
        }
        if let Err(fault) = self.work.steps(STEPS + self.frames.len() / 16) {
            return self.fault(source.at, "", "", fault);
        }
        self.frames.push(Frame { source: source.clone(), next: 0, scope, file, content: Content::default(), finish, depth });
    }

    /// Puts the content of a frame in its place. Returns the root, if it is the root's.
    fn finish(&mut self, frame: Frame) -> Option<Element> {
        let Frame { source, scope, file, content, finish, .. } = frame;
        let Content { attributes, children } = content;
        match finish {
            Finish::Element { name, at } => {
                let element = Element { name, attributes, children, at };
                match self.frames.last_mut() {
                    Some(parent) => parent.content.children.push(Node::Element(Rc::new(element))),
                    None => return Some(element),
                }
            }
            Finish::Call(name) => self.call(&source, &name, &children, scope, file),
            Finish::Splice | Finish::Body { .. } => {
                if let Some(attribute) = attributes.first() {
                    let found = format!("<xacro:attribute> directly inside <{}>", as_written(&source.name));
                    self.warning(
                        attribute.at,
                        "xacro:attribute",
                        Code::Misplaced,
                        found,
                        "it directly inside the tag: xacro ignores it here",
                    );
                }
                if matches!(finish, Finish::Body { .. }) {
                    self.scopes.clear(scope);
                }
                if let Some(parent) = self.frames.last_mut() {
                    parent.content.children.extend(children);
                }
            }
        }
        None
    }

    /// Sets an attribute of the tag that is expanded.
    pub(super) fn set_attribute(&mut self, new: Attribute) {
        self.count(1, new.name.len() + new.value.len() + 8, new.at);
        let Some(frame) = self.frames.last_mut() else { return };
        match frame.content.attributes.iter_mut().find(|own| own.name == new.name) {
            Some(own) => *own = new,
            None => frame.content.attributes.push(new),
        }
        if frame.content.attributes.len() > 256 {
            self.too_large(At::Nowhere, "a tag with very many attributes", 256);
        }
    }

    // Values.

    /// The value of a text with expressions.
    pub(super) fn evaluated(&mut self, text: &str, at: At, scope: usize) -> Result<Value> {
        let before = (self.scope, self.at);
        (self.scope, self.at) = (scope, at);
        let value = self.value_of(text);
        (self.scope, self.at) = before;
        value
    }

    fn value_of(&mut self, text: &str) -> Result<Value> {
        if !text.contains('$') {
            return Ok(Value::text(text));
        }
        self.work.enter()?;
        let value = self.value_of_pieces(text);
        self.work.leave();
        value
    }

    fn value_of_pieces(&mut self, text: &str) -> Result<Value> {
        let pieces = pieces(text)?;
        // A single part keeps its type.
        if let [piece] = pieces.as_slice() {
            return self.piece(piece);
        }
        let mut out = String::new();
        for piece in &pieces {
            let part = self.piece(piece)?.written();
            self.work.bytes(part.len())?;
            out.push_str(&part);
        }
        Ok(Value::text(&out))
    }

    fn piece(&mut self, piece: &Piece<'_>) -> Result<Value> {
        match piece {
            Piece::Text(text) => Ok(Value::text(text)),
            Piece::Expression(text) => {
                let text = self.value_of(text)?.written();
                self.work.steps(text.len() / 16)?;
                evaluate(&syntax::parse(&text)?, self)
            }
            Piece::Extension(text) => {
                let text = self.value_of(text)?.written();
                self.extension(text.trim())
            }
        }
    }

    /// The value of `$(command words)`.
    fn extension(&mut self, text: &str) -> Result<Value> {
        let (command, rest) = text.split_once(' ').unwrap_or((text, ""));
        let words: Vec<&str> = rest.split_whitespace().collect();
        match (command, words.as_slice()) {
            ("eval", _) => {
                let expression = syntax::parse(rest)?;
                let before = std::mem::replace(&mut self.in_eval, true);
                let value = evaluate(&expression, self);
                self.in_eval = before;
                Ok(Value::text(&value?.written()))
            }
            ("arg", [name]) => self.argument(name),
            ("find", [name]) => {
                let folder = self.folder();
                match self.packages.folder(name, &folder, self.input) {
                    Some(_) => Ok(Value::text(&files::package(name))),
                    None => wrong(format!("the unknown package {}", quote(name)), PACKAGE),
                }
            }
            ("env", [name]) => match self.input.sources.variable(name) {
                Some(value) => Ok(Value::text(&value)),
                None => {
                    wrong(format!("the variable {name} of the environment, which is not set"), "one that is set where the file is read")
                }
            },
            ("optenv", [name, default @ ..]) => Ok(Value::text(&self.input.sources.variable(name).unwrap_or_else(|| default.join(" ")))),
            ("dirname", []) => Ok(Value::text(&files::folder(&self.folder()))),
            // Names of files start from there.
            ("cwd", []) => Ok(Value::text(&files::folder(Path::new(".")))),
            ("arg" | "find" | "env" | "optenv" | "dirname" | "cwd", _) => {
                wrong(format!("{} words behind {command}", words.len()), "one name, and none behind dirname and cwd")
            }
            _ => wrong(format!("the unknown command {}", quote(command)), "arg, find, env, optenv, dirname, cwd or eval"),
        }
    }

    /// The value of a property found in a scope.
    fn symbol(&mut self, scope: usize, name: &str) -> Result<Option<Value>> {
        match self.scopes.get(scope, name) {
            None | Some(Symbol::Block(_)) => Ok(None),
            Some(Symbol::Value(value)) => Ok(Some(value.clone())),
            Some(Symbol::Failed) => Err(Fault::Reported),
            Some(Symbol::Pending) => wrong(format!("the property {name:?}, which refers to itself"), "a property without itself"),
            Some(Symbol::Lazy(text, at)) => {
                let (text, at) = (text.clone(), *at);
                self.scopes.set(scope, name, Symbol::Pending);
                let value = self.evaluated(&text, at, scope).map(|value| literal(&value));
                match value {
                    Ok(value) => {
                        self.scopes.set(scope, name, Symbol::Value(value.clone()));
                        Ok(Some(value))
                    }
                    Err(fault) => {
                        self.scopes.set(scope, name, Symbol::Failed);
                        self.fault(at, &format!("property {name}"), &text, fault);
                        Err(Fault::Reported)
                    }
                }
            }
        }
    }

    /// The condition of a text; `None` if it is not a condition, which is reported.
    pub(super) fn truth(&mut self, text: &str, at: At, field: &str, scope: usize) -> Option<bool> {
        let value = match self.evaluated(text, at, scope) {
            Ok(value) => value,
            Err(fault) => {
                self.incomplete = true;
                self.fault(at, field, text, fault);
                return None;
            }
        };
        let truth = if let Value::Text(text) = &value { read_truth(text) } else { Some(value.is_true()) };
        if truth.is_none() {
            self.incomplete = true;
            let found = format!("{} as a condition", value.shown());
            self.error(at, field, Code::Xacro, found, "true, false, or an integer");
        }
        truth
    }

    // Files.

    /// The root of a file. `None`: an error states why; a missing file is an error unless it is
    /// `optional`.
    pub(super) fn include(&mut self, path: &Path, place: (At, &str), optional: bool) -> Option<(Rc<Element>, Rc<File>)> {
        self.included += 1;
        let depth = self.frames.last().map_or(0, |frame| frame.file.depth) + 1;
        if self.included > MOST_FILES {
            self.too_large(place.0, "very many included files", MOST_FILES);
            return None;
        }
        if depth > MOST_NESTED_FILES {
            self.too_large(place.0, "files that include each other very deeply", MOST_NESTED_FILES);
            return None;
        }
        let known = self.sources.get(path).cloned();
        let root = match known {
            Some(root) => root,
            None => {
                let bytes = match self.input.sources.read(path) {
                    Ok(bytes) => bytes,
                    Err(_) if optional => return None,
                    Err(error) => {
                        self.incomplete = true;
                        let near = self.input.sources.nearest(path).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
                        let found = format!("{}: {error}", quote(&path.to_string_lossy()));
                        self.error(place.0, place.1, Code::File, found, format!("a file, from the folder of this one{near}"));
                        return None;
                    }
                };
                let root = self.parse(path, &bytes, place.0);
                self.sources.insert(path.to_owned(), root.clone());
                root
            }
        };
        self.incomplete |= root.is_none();
        Some((root?, Rc::new(File { path: path.to_owned(), depth })))
    }

    fn parse(&mut self, path: &Path, bytes: &[u8], at: At) -> Option<Rc<Element>> {
        self.source_bytes += bytes.len();
        if self.source_bytes > MOST_SOURCE {
            self.too_large(at, "included files of very many bytes", MOST_SOURCE);
            return None;
        }
        let name = path.to_string_lossy();
        let number = self.log.include(&name)?;
        let mut own = Diagnostics::new(&name);
        let root = document::text(bytes, &mut own).and_then(|text| source::read(&text, Some(number), &mut self.source_nodes, &mut own));
        self.log.take(own);
        root
    }
}

pub(super) const PACKAGE: &str =
    "a package around the file (a folder with a package.xml), or one that packages give: --package NAME=FOLDER";

/// A value of a property or a parameter: a text may spell a number or a truth value.
pub(super) fn literal(value: &Value) -> Value {
    if let Value::Text(text) = value { read_literal(text) } else { value.clone() }
}

impl Names for Expander<'_> {
    fn property(&mut self, name: &str) -> Result<Option<Value>> {
        if self.in_eval {
            return match name {
                "arg" => Ok(super::functions::of_module("xacro", name)),
                _ if self.arguments.contains_key(name) => self.argument(name).map(Some),
                _ => Ok(None),
            };
        }
        self.member(self.scope, name)
    }

    fn suggestion(&mut self, name: &str) -> Option<String> {
        self.scopes.nearest(self.scope, name, &mut self.suggester)
    }

    fn member(&mut self, scope: usize, name: &str) -> Result<Option<Value>> {
        let (found, searched) = self.scopes.find(scope, name);
        self.work.steps(searched)?;
        found.map_or(Ok(None), |scope| self.symbol(scope, name))
    }

    fn argument(&mut self, name: &str) -> Result<Value> {
        self.declared.insert(name.to_owned());
        match self.arguments.get(name) {
            Some(value) if self.in_eval => Ok(read_literal(value)),
            Some(value) => Ok(Value::Text(value.clone())),
            None => {
                let near = self.suggester.nearest(name, self.arguments.keys().map(String::as_str));
                let near = near.map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
                wrong(
                    format!("the unknown argument {name:?}"),
                    format!("one with <xacro:arg>, or that args give: --arg {name}=VALUE{near}"),
                )
            }
        }
    }

    fn file_name(&self, name: &str) -> String {
        if Path::new(name).is_absolute() || name.starts_with('\u{f0000}') {
            return name.to_owned();
        }
        format!("{}/{name}", files::folder(&self.folder()))
    }

    fn load_yaml(&mut self, name: &str) -> Result<Value> {
        let folder = self.folder();
        let path = match self.packages.path(name, &folder, self.input) {
            Ok(path) => path,
            Err(package) => return wrong(format!("the unknown package {}", quote(&package)), PACKAGE),
        };
        let shown = path.to_string_lossy().into_owned();
        let bytes = match self.input.sources.read(&path) {
            Ok(bytes) => bytes,
            Err(error) => return wrong(format!("{}: {error}", quote(&shown)), "a file, from the folder of the one that is expanded"),
        };
        self.work.bytes(bytes.len().saturating_mul(16))?;
        let Ok(text) = std::str::from_utf8(&bytes) else {
            return wrong(format!("{}, which is not UTF-8", quote(&shown)), "a file in the encoding UTF-8");
        };
        match yaml::read(text, &mut |text| self.number_of_yaml(text)) {
            Ok((value, again)) => {
                let file = self.log.include(&shown);
                for (line, key) in again {
                    let at = file.map_or(At::Nowhere, |file| At::Included { file, line, column: 0 });
                    // Each use of the file reads it again.
                    if self.warned.insert((shown.clone(), line)) {
                        self.log.warning(
                            (at, "yaml"),
                            Code::DuplicateName,
                            format!("a second key {key}"),
                            "each key once: the last value counts",
                        );
                    }
                }
                Ok(value)
            }
            Err(yaml::Fault { line, fault: Fault::Wrong { found, expected } }) => {
                let file = self.log.include(&shown);
                let at = file.map_or(At::Nowhere, |file| At::Included { file, line, column: 0 });
                self.error(at, "yaml", Code::Xacro, found, expected);
                Err(Fault::Reported)
            }
            Err(fault) => Err(fault.fault),
        }
    }

    fn message(&mut self, text: String, is_warning: bool) {
        if is_warning {
            self.warning(self.at, "xacro", Code::Xacro, format!("the message of the file {}", quote(&text)), "none");
        }
    }

    fn work(&mut self) -> &mut Work {
        &mut self.work
    }
}

impl Expander<'_> {
    /// The number of an expression with a unit, which has no properties.
    fn number_of_yaml(&mut self, text: &str) -> Result<f64> {
        let before = self.scope;
        self.scope = usize::MAX;
        let value = syntax::parse(text).and_then(|expression| evaluate(&expression, self));
        self.scope = before;
        let value = value?;
        let number = if let Value::Text(text) = &value { super::value::read_float(text) } else { value.number() };
        number.map_or_else(|| wrong(value.shown(), "a number"), Ok)
    }
}
