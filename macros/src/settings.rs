//! The keys of an invocation: those of scenes, which are read as in scenes, and the macro's own.

use std::collections::BTreeSet;

use articulated_codegen::diagnostic::At;
use articulated_codegen::scene::articulated_scene::{Node, Value};
use articulated_codegen::{Options, RustOptions, Target};
use proc_macro2::{Span, TokenStream};
use syn::Path;
use syn::parse::Parser;

use crate::errors::Errors;
use crate::tree::{Places, Tree};

/// The keys with their values.
pub(crate) struct Settings {
    pub(crate) macro_keys: MacroKeys,
    /// The table of the keys that scenes also have.
    pub(crate) rest: Node,
    pub(crate) places: Places,
    /// All keys, including those with unreadable values.
    keys: BTreeSet<String>,
}

/// The macro's own keys.
#[derive(Default)]
pub(crate) struct MacroKeys {
    /// The scene's file, and where it is named.
    pub(crate) scene: Option<(String, At)>,
    runtime: Option<(String, At)>,
    no_std: bool,
    standalone: bool,
}

/// One of the macro's own keys.
struct Key {
    name: &'static str,
    expected: &'static str,
    /// `None`: the value is invalid for this key.
    read: fn(&mut MacroKeys, &Node) -> Option<()>,
}

const KEYS: [Key; 4] = [
    Key {
        name: "scene",
        expected: "the path of a scene from the folder of Cargo.toml, as \"scenes/arm.toml\"",
        read: |macro_keys, node| text(node).map(|path| macro_keys.scene = Some((path.to_owned(), node.at))),
    },
    Key { name: "no_std", expected: "true or false", read: |macro_keys, node| truth(node).map(|yes| macro_keys.no_std = yes) },
    Key {
        name: "crate",
        expected: "the absolute path of the crate `articulated`, as ::articulated or crate::path",
        read: |macro_keys, node| absolute(text(node)?).map(|path| macro_keys.runtime = Some((path, node.at))),
    },
    Key { name: "standalone", expected: "true or false", read: |macro_keys, node| truth(node).map(|yes| macro_keys.standalone = yes) },
];

impl Settings {
    /// Reads the braces of the module whose name is at `module`.
    pub(crate) fn read(tokens: TokenStream, module: Span, errors: &mut Errors) -> Self {
        let (mut places, mut macro_keys) = (Places::new(module), MacroKeys::default());
        let mut tree = Tree::new(&mut places, errors);
        let mut rest = tree.read(tokens);
        let keys = tree.keys;
        if let Value::Table(entries) = &mut rest.value {
            entries.retain(|entry| {
                let Some(key) = KEYS.iter().find(|key| key.name == entry.name) else { return true };
                if (key.read)(&mut macro_keys, &entry.node).is_none() {
                    let message = format!("{}: found {}, expected {}", key.name, entry.node.value.describe(), key.expected);
                    errors.push(places.error(entry.node.at, message));
                }
                false
            });
        }
        if let (true, Some((_, at))) = (macro_keys.standalone, &macro_keys.runtime) {
            errors.push(places.error(*at, "standalone code uses no crate: leave out `crate` or `standalone`"));
        }
        Self { macro_keys, rest, places, keys }
    }

    /// The names of the macro's own keys.
    pub(crate) fn own_names() -> [&'static str; KEYS.len()] {
        KEYS.map(|key| key.name)
    }

    /// Whether the invocation has this key, with a valid or an invalid value.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.keys.contains(name)
    }
}

impl MacroKeys {
    /// Options that only these keys change.
    pub(crate) fn options(&self) -> Options {
        let runtime = || self.runtime.as_ref().map_or("::articulated".into(), |(path, _)| path.clone());
        let rust = RustOptions { no_std: self.no_std, runtime: (!self.standalone).then(runtime), ..RustOptions::default() };
        Options { target: Target::Rust(rust), stages: false, ..Options::default() }
    }
}

fn text(node: &Node) -> Option<&str> {
    if let Value::Text(text) = &node.value { Some(text) } else { None }
}

fn truth(node: &Node) -> Option<bool> {
    if let Value::Bool(truth) = node.value { Some(truth) } else { None }
}

/// A path that means the same inside the generated module as outside of it, without spaces.
fn absolute(path: &str) -> Option<String> {
    let path: Path = Path::parse_mod_style.parse_str(path).ok()?;
    let segments: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    let colons = if path.leading_colon.is_some() { "::" } else { "" };
    (path.leading_colon.is_some() || segments[0] == "crate").then(|| format!("{colons}{}", segments.join("::")))
}
