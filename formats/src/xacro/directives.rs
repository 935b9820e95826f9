//! The tags of xacro.

use std::path::Path;
use std::rc::Rc;

use articulated_core::diagnostic::{At, Code, quote};

use super::expander::{Expander, File, Finish, PACKAGE, literal};
use super::files;
use super::scope::{GLOBAL, Macro, Symbol};
use super::source::{Attribute, Element, Node, PREFIX, is_name, prepared};
use super::syntax;
use super::text::{Parameter, parameters};
use super::value::Value;
use crate::xml::markup::as_written;

/// Maximum number of parameters of a macro's call.
const MOST_PARAMETERS: usize = 1000;

impl Expander<'_> {
    /// Expands a tag.
    pub(super) fn element(&mut self, element: &Rc<Element>) {
        let Some(frame) = self.frames.last() else { return };
        let (scope, file) = (frame.scope, frame.file.clone());
        let Some(directive) = element.directive() else { return self.open(element, &element.name, scope, file) };
        match directive {
            "property" => self.property_tag(element, scope),
            "macro" => self.macro_tag(element, scope),
            "arg" => self.arg_tag(element, scope),
            "if" | "unless" => {
                self.known(element, &["value"]);
                let Some(value) = self.required(element, "value") else { return };
                let truth = self.truth(&value.value, value.at, &field(element, "value"), scope);
                if truth == Some(directive == "if") {
                    self.push(element, scope, file, Finish::Splice);
                }
            }
            "include" => self.include_tag(element, scope),
            "insert_block" => self.insert_tag(element, scope, file),
            "element" => self.element_tag(element, scope),
            "attribute" => self.attribute_tag(element, scope),
            "call" => self.call_tag(element, scope, file),
            name => {
                let name = name.into();
                self.call_of(element, name, scope, file);
            }
        }
    }

    /// A required attribute: without it, a part of the robot is missing.
    fn required<'e>(&mut self, element: &'e Element, name: &str) -> Option<&'e Attribute> {
        let found = element.attribute(name);
        if found.is_none() {
            self.incomplete = true;
            let expected = format!("the attribute {} in <{}>", as_written(name), as_written(&element.name));
            self.error(element.at, &field(element, name), Code::MissingAttribute, "none", expected);
        }
        found
    }

    /// Warns of other attributes.
    fn known(&mut self, element: &Element, names: &[&str]) {
        for attribute in element.attributes.iter().filter(|a| !names.contains(&&*a.name) && !a.name.starts_with("xmlns")) {
            let expected = format!("nothing but {}", names.join(", "));
            self.warning(attribute.at, &field(element, &attribute.name), Code::Unknown, "what is not known and not used", expected);
        }
    }

    /// The text of a required attribute.
    fn required_text(&mut self, element: &Element, name: &str, scope: usize) -> Option<(String, At)> {
        let attribute = self.required(element, name)?;
        self.text_of(element, attribute, scope)
    }

    fn text_of(&mut self, element: &Element, attribute: &Attribute, scope: usize) -> Option<(String, At)> {
        match self.evaluated(&attribute.value, attribute.at, scope) {
            Ok(value) => Some((value.written(), attribute.at)),
            Err(fault) => {
                self.incomplete = true;
                self.fault(attribute.at, &field(element, &attribute.name), &attribute.value, fault);
                None
            }
        }
    }

    fn refused(&mut self, at: At, element: &Element, name: &str, found: impl Into<String>, expected: impl Into<String>) {
        self.incomplete = true;
        self.error(at, &field(element, name), Code::Xacro, found, expected);
    }

    fn arg_tag(&mut self, element: &Element, scope: usize) {
        self.known(element, &["name", "default"]);
        let Some(name) = self.required(element, "name") else { return };
        let name = name.value.to_string();
        self.declared.insert(name.clone());
        if self.arguments.contains_key(&name) {
            return;
        }
        // Without a default, it must be given at its use.
        let Some(default) = element.attribute("default") else { return };
        match self.evaluated(&default.value, default.at, scope) {
            Ok(value) => {
                self.arguments.insert(name, value.written().into());
            }
            Err(fault) => self.fault(default.at, &field(element, "default"), &default.value, fault),
        }
    }

    fn property_tag(&mut self, element: &Rc<Element>, scope: usize) {
        self.known(element, &["name", "value", "default", "remove", "scope", "lazy_eval"]);
        let Some((name, at)) = self.required_text(element, "name", scope) else { return };
        if !is_identifier(&name) || name.starts_with("__") {
            let expected = "a name of letters, digits and _ that begins with none of the digits";
            return self.refused(at, element, "name", quote(&name), expected);
        }
        let [value, default, remove, lazy] = ["value", "default", "remove", "lazy_eval"].map(|name| element.attribute(name));
        let mut truth = |attribute: Option<&Attribute>, default: bool| {
            attribute.map_or(Some(default), |a| self.truth(&a.value, a.at, &field(element, &a.name), scope))
        };
        let (Some(remove), Some(lazy)) = (truth(remove, false), truth(lazy, true)) else { return };
        if usize::from(value.is_some()) + usize::from(default.is_some()) + usize::from(remove) > 1 {
            return self.refused(element.at, element, "value", "more than one of value, default and remove", "one of them");
        }
        if remove {
            if super::functions::is_of_every_file(&name) {
                let found = format!("the name {}, which every file has", quote(&name));
                self.warning(at, &field(element, "name"), Code::Xacro, found, "a property of this file: that name cannot be removed");
            }
            return self.scopes.remove(scope, &name);
        }
        if default.is_some() && (self.scopes.find(scope, &name).0.is_some() || super::functions::global(&name).is_some()) {
            return;
        }
        let target = match element.attribute("scope") {
            None => None,
            Some(attribute) => match &*attribute.value {
                "global" => Some(GLOBAL),
                "parent" => match self.scopes.parent(scope) {
                    Some(parent) => Some(parent),
                    None => {
                        let found = "parent, outside of a macro";
                        return self.refused(attribute.at, element, "scope", found, "global, or no scope");
                    }
                },
                "local" => None,
                other => {
                    let expected = "global, parent, or no scope";
                    return self.refused(attribute.at, element, "scope", quote(other), expected);
                }
            },
        };
        match value.or(default) {
            None => self.scopes.set(target.unwrap_or(scope), &format!("**{name}"), Symbol::Block(element.clone())),
            Some(value) => {
                self.warn_of_redefinition(&name, at, &field(element, "name"));
                self.set_property(element, &name, value, (scope, target.unwrap_or(scope)), lazy && target.is_none());
            }
        }
    }

    /// Warns, as xacro does, of redefining a built-in name: it has another meaning from here on.
    fn warn_of_redefinition(&mut self, name: &str, at: At, field: &str) {
        if super::functions::is_of_every_file(name) {
            let found = format!("the name {}, which stands for a function or a number in every file", quote(name));
            self.warning(at, field, Code::Xacro, found, "another name; used as written, in place of that function or number");
        }
    }

    fn set_property(&mut self, element: &Element, name: &str, value: &Attribute, (scope, target): (usize, usize), lazy: bool) {
        let symbol = if lazy {
            // A text without expressions is its own value, unless it is in quotation marks.
            match literal(&Value::Text(value.value.clone())) {
                Value::Text(text) => Symbol::Lazy(text, value.at),
                value => Symbol::Value(value),
            }
        } else {
            match self.evaluated(&value.value, value.at, scope) {
                Ok(value) => Symbol::Value(literal(&value)),
                Err(fault) => {
                    self.fault(value.at, &field(element, &value.name), &value.value, fault);
                    Symbol::Failed
                }
            }
        };
        self.scopes.set(target, name, symbol);
    }

    fn macro_tag(&mut self, element: &Rc<Element>, scope: usize) {
        self.known(element, &["name", "params"]);
        let Some(attribute) = self.required(element, "name") else { return };
        let name = attribute.value.strip_prefix("xacro:").unwrap_or(&attribute.value);
        if name == "call" || name.contains('.') || name.is_empty() {
            let expected = "a name other than call, without a point";
            return self.refused(attribute.at, element, "name", quote(name), expected);
        }
        let list = element.attribute("params").map_or("".into(), |params| params.value.clone());
        let count = parameters(&list).len();
        if count > MOST_PARAMETERS {
            let expected = format!("at most {MOST_PARAMETERS}");
            return self.refused(element.at, element, "params", format!("{count} parameters"), expected);
        }
        self.scopes.define(scope, &prepared(name), Macro { body: element.clone(), parameters: list });
    }

    fn insert_tag(&mut self, element: &Element, scope: usize, file: Rc<File>) {
        self.known(element, &["name"]);
        let Some(attribute) = self.required(element, "name") else { return };
        let name = &attribute.value;
        for (stars, content_only) in [("**", true), ("*", false)] {
            let full = format!("{stars}{name}");
            let found = self.scopes.find(scope, &full).0;
            let Some(Symbol::Block(block)) = found.and_then(|scope| self.scopes.get(scope, &full)) else { continue };
            let block = block.clone();
            return match content_only {
                true => self.push(&block, scope, file, Finish::Splice),
                false => self.open(&block, &block.name, scope, file),
            };
        }
        let found = format!("the unknown block {}", quote(name));
        self.refused(attribute.at, element, "name", found, "a block of the macro, or a property without a value");
    }

    fn element_tag(&mut self, element: &Rc<Element>, scope: usize) {
        let attribute = format!("{PREFIX}name");
        let Some((name, at)) = self.required_text(element, &attribute, scope) else { return };
        if !is_name(&name) {
            return self.refused(at, element, &attribute, quote(&name), "the name of a tag");
        }
        if name == "xacro:element" {
            return self.refused(at, element, &attribute, quote(&name), "the name of another tag");
        }
        let attributes = element.attributes.iter().filter(|own| *own.name != *attribute).cloned().collect();
        self.element(&Rc::new(Element { name: prepared(&name).into(), attributes, ..(**element).clone() }));
    }

    fn attribute_tag(&mut self, element: &Element, scope: usize) {
        self.known(element, &["name", "value"]);
        let name = self.required_text(element, "name", scope);
        let value = self.required_text(element, "value", scope);
        let (Some((name, at)), Some((value, _))) = (name, value) else { return };
        if !is_name(&name) {
            return self.refused(at, element, "name", quote(&name), "the name of an attribute");
        }
        self.set_attribute(Attribute { name: prepared(&name).into(), value: files::written(&value).into(), at });
    }

    fn include_tag(&mut self, element: &Rc<Element>, scope: usize) {
        self.known(element, &["filename", "ns", "optional"]);
        for child in element.elements().take(1) {
            let found = format!("<{}> inside <xacro:include>", as_written(&child.name));
            self.warning(child.at, "xacro:include", Code::Misplaced, found, "nothing inside it: it is not used");
        }
        let namespace = match element.attribute("ns") {
            Some(attribute) => match self.text_of(element, attribute, scope) {
                Some((name, _)) => Some(name).filter(|name| !name.is_empty()),
                None => return,
            },
            None => None,
        };
        let optional =
            element.attribute("optional").and_then(|a| self.truth(&a.value, a.at, &field(element, &a.name), scope)).unwrap_or(false);
        let Some((name, at)) = self.required_text(element, "filename", scope) else { return };
        let inner = match &namespace {
            Some(name) => {
                self.warn_of_redefinition(name, element.at, &field(element, "ns"));
                self.scopes.namespace(scope, name)
            }
            None => scope,
        };
        let folder = self.folder();
        let path = match self.packages.path(&name, &folder, self.input) {
            Ok(path) => path,
            Err(_) if optional => return,
            Err(package) => {
                let found = format!("the unknown package {}", quote(&package));
                return self.refused(at, element, "filename", found, PACKAGE);
            }
        };
        let place = (at, field(element, "filename"));
        let paths = if files::is_pattern(&name) { self.matching(&path, &place) } else { vec![path] };
        // Frames are expanded from the last one on.
        let mut roots = Vec::new();
        for path in paths {
            if let Some(root) = self.include(&path, (place.0, &place.1), optional) {
                roots.push(root);
            }
        }
        for (root, file) in roots.into_iter().rev() {
            self.push(&root, inner, file, Finish::Splice);
        }
    }

    /// The files of a pattern, in the order of their names.
    fn matching(&mut self, pattern: &Path, (at, field): &(At, String)) -> Vec<std::path::PathBuf> {
        let folder = pattern.parent().unwrap_or(Path::new(""));
        let name = pattern.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if files::is_pattern(&folder.to_string_lossy()) {
            self.incomplete = true;
            let expected = "*, ? and […] in the name of the file alone, not in that of a folder";
            self.error(*at, field, Code::Unsupported, quote(&pattern.to_string_lossy()), expected);
            return Vec::new();
        }
        let mut names = match self.input.sources.list(folder) {
            Ok(names) => names,
            Err(error) => {
                self.incomplete = true;
                let found = format!("{}: {error}", quote(&folder.to_string_lossy()));
                self.error(*at, field, Code::File, found, "a folder, from that of this file");
                return Vec::new();
            }
        };
        names.retain(|own| files::fits(&name, own));
        names.sort_unstable();
        if names.is_empty() {
            let found = format!("{}, which no file has", quote(&pattern.to_string_lossy()));
            self.warning(*at, field, Code::File, found, "the name of a file");
        }
        names.into_iter().map(|name| folder.join(name)).collect()
    }

    fn call_tag(&mut self, element: &Rc<Element>, scope: usize, file: Rc<File>) {
        let Some((name, _)) = self.required_text(element, "macro", scope) else { return };
        let attributes = element.attributes.iter().filter(|own| &*own.name != "macro").cloned().collect();
        let element = Rc::new(Element { attributes, ..(**element).clone() });
        self.call_of(&element, prepared(&name).into(), scope, file);
    }

    /// Expands the blocks of a call; then follows the call.
    fn call_of(&mut self, element: &Rc<Element>, name: Rc<str>, scope: usize, file: Rc<File>) {
        if self.scopes.find_macro(scope, &name).is_none() {
            let near = self.scopes.nearest_macro(scope, &name, &mut self.suggester);
            let near = near.map(|near| format!(" (did you mean {:?}?)", as_written(&near))).unwrap_or_default();
            let found = format!("the tag <xacro:{}>, which is no macro", as_written(&name));
            self.incomplete = true;
            return self.error(element.at, "xacro", Code::Xacro, found, format!("a macro that is defined before{near}"));
        }
        self.push(element, scope, file, Finish::Call(name));
    }

    /// Calls a macro with the blocks that were expanded.
    pub(super) fn call(&mut self, element: &Rc<Element>, name: &Rc<str>, blocks: &[Node], scope: usize, file: Rc<File>) {
        let Some((outer, own)) = self.scopes.find_macro(scope, name) else { return };
        let list = own.parameters.clone();
        let parameters = parameters(&list);
        let inner = self.scopes.inner(outer);
        let mut given = std::collections::BTreeSet::new();
        for attribute in element.attributes.iter().filter(|a| !a.name.starts_with("xmlns")) {
            if !parameters.iter().any(|p| p.name == &*attribute.name) {
                let names: Vec<&str> = parameters.iter().map(|p| p.name).filter(|name| !name.starts_with('*')).collect();
                let near =
                    self.suggester.nearest(&attribute.name, names).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
                let found = format!("{}, which is no parameter of the macro", quote(&as_written(&attribute.name)));
                self.refused(attribute.at, element, &attribute.name, found, format!("one of {}{near}", quote(&list)));
                continue;
            }
            given.insert(attribute.name.clone());
            self.warn_of_redefinition(&attribute.name, attribute.at, &field(element, &attribute.name));
            let symbol = match self.evaluated(&attribute.value, attribute.at, scope) {
                Ok(value) => Symbol::Value(literal(&value)),
                Err(fault) => {
                    self.fault(attribute.at, &field(element, &attribute.name), &attribute.value, fault);
                    Symbol::Failed
                }
            };
            self.scopes.set(inner, &attribute.name, symbol);
        }
        let mut blocks = blocks.iter().filter_map(|node| if let Node::Element(block) = node { Some(block) } else { None });
        for parameter in parameters.iter().filter(|p| p.name.starts_with('*')) {
            match blocks.next() {
                Some(block) => self.scopes.set(inner, parameter.name, Symbol::Block(block.clone())),
                None => {
                    let found = format!("no tag for the block {}", quote(parameter.name));
                    self.refused(element.at, element, "", found, format!("one inside <{}>", as_written(&element.name)));
                }
            }
        }
        if let Some(block) = blocks.next() {
            let found = format!("<{}>, for which the macro has no block", as_written(&block.name));
            self.refused(block.at, element, "", found, format!("blocks of {}", quote(&list)));
        }
        for parameter in parameters.iter().filter(|p| !p.name.starts_with('*') && !given.contains(p.name)) {
            self.default(element, parameter, (scope, inner));
        }
        self.push(&own.body, inner, file, Finish::Body { name: name.clone(), at: element.at });
    }

    /// Sets a parameter that is missing in a call.
    fn default(&mut self, element: &Element, parameter: &Parameter<'_>, (scope, inner): (usize, usize)) {
        self.warn_of_redefinition(parameter.name, element.at, &field(element, parameter.name));
        let forwarded =
            if parameter.forwards { self.evaluated(&format!("${{{}}}", parameter.name), element.at, scope) } else { Ok(Value::None) };
        let is_known = parameter.forwards && self.scopes.find(scope, parameter.name).0.is_some();
        let value = match (parameter.default, forwarded) {
            (_, value) if is_known => value,
            (Some(default), _) => self.evaluated(default, element.at, scope),
            _ => {
                let found = format!("none for the parameter {}", quote(parameter.name));
                self.refused(
                    element.at,
                    element,
                    parameter.name,
                    found,
                    format!("the attribute {} in <{}>", parameter.name, as_written(&element.name)),
                );
                return self.scopes.set(inner, parameter.name, Symbol::Failed);
            }
        };
        let symbol = match value {
            Ok(value) => Symbol::Value(literal(&value)),
            Err(fault) => {
                self.fault(element.at, &field(element, parameter.name), parameter.default.unwrap_or(parameter.name), fault);
                Symbol::Failed
            }
        };
        self.scopes.set(inner, parameter.name, symbol);
    }
}

/// The tag and the attribute, for messages.
fn field(element: &Element, attribute: &str) -> String {
    format!("{} {attribute}", element.name).trim_end().to_owned()
}

/// Whether a name may be that of a property.
fn is_identifier(name: &str) -> bool {
    let is_word = name.chars().all(|c| c.is_alphanumeric() || c == '_');
    let is_digit = name.starts_with(|c: char| c.is_ascii_digit());
    !name.is_empty() && name.len() <= 256 && is_word && !is_digit && !syntax::KEYWORDS.contains(&name)
}
