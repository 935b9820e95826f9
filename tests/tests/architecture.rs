//! The layout of the code: dependencies between crates point downward, files import each other in
//! no more circles than are known, and comments wrap at 100 columns.
//!
//! `cargo test -p articulated-tests --test architecture -- --nocapture` prints the graph of crates
//! and all circles.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The crates with code, the lowest first: each may use those before it.
const LAYERS: [(&str, &str); 11] = [
    ("articulated-core", "runtime/core"),
    ("articulated-reference", "reference"),
    ("articulated-formats", "formats"),
    ("articulated-scene", "scene"),
    ("articulated-codegen", "codegen"),
    ("articulated-macros", "macros"),
    ("articulated", "runtime"),
    ("articulated-motion", "motion"),
    ("articulated-models", "models"),
    ("articulated-lab", "tests/lab"),
    ("articulated-cli", "cli"),
];

/// Circles of files that import each other, by crate. A number only falls.
const CIRCLES: [(&str, usize); 11] = [
    ("articulated-core", 0),
    ("articulated-reference", 1),
    ("articulated-formats", 1),
    ("articulated-scene", 2),
    ("articulated-codegen", 0),
    ("articulated-macros", 0),
    ("articulated", 1),
    ("articulated-motion", 0),
    ("articulated-models", 0),
    ("articulated-lab", 0),
    ("articulated-cli", 0),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The workspace's crates that a crate depends on, without those of its tests.
fn dependencies(folder: &str) -> Vec<String> {
    let manifest = fs::read_to_string(root().join(folder).join("Cargo.toml")).expect("a manifest");
    let mut section = String::new();
    let mut found = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line.to_owned();
        }
        let name: String = line.chars().take_while(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_')).collect();
        let is_used = section.contains("dependencies") && !section.contains("dev-");
        if is_used && (name == "articulated" || name.starts_with("articulated-")) {
            found.push(name);
        }
    }
    found
}

#[test]
fn arrows_between_crates_point_downward() {
    let mut upward = Vec::new();
    for (level, (name, folder)) in LAYERS.iter().enumerate() {
        let uses = dependencies(folder);
        println!("{name} -> {}", uses.join(", "));
        for used in uses {
            let below = LAYERS[..level].iter().any(|(other, _)| *other == used);
            if !below {
                upward.push(format!("{name} -> {used}"));
            }
        }
    }
    assert_eq!(upward, [""; 0], "crates use what is above them");
}

/// All files of a crate by their module paths, without tests.
fn modules(folder: &Path) -> BTreeMap<Vec<String>, PathBuf> {
    fn walk(folder: &Path, path: &[String], all: &mut BTreeMap<Vec<String>, PathBuf>) {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let (file, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
            let inside = |name: &str| [path, &[name.to_owned()]].concat();
            if file.is_dir() {
                walk(&file, &inside(&name), all);
            } else if let Some(stem) = name.strip_suffix(".rs").filter(|stem| !matches!(*stem, "tests" | "main")) {
                let own = if matches!(stem, "lib" | "mod") { path.to_vec() } else { inside(stem) };
                all.insert(own, file);
            }
        }
    }
    let mut all = BTreeMap::new();
    walk(folder, &[], &mut all);
    // Texts that are included are no modules.
    all.retain(|path, _| !path.iter().any(|name| name == "text" || name == "tests"));
    all
}

/// The modules that a file imports, as paths from the root of its crate.
fn imports(text: &str, own: &[String]) -> Vec<Vec<String>> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(at) = rest.find("\nuse ").or_else(|| rest.starts_with("use ").then_some(0)) {
        let statement = rest[at..].trim_start().strip_prefix("use ").unwrap_or_default();
        let end = statement.find(';').unwrap_or(statement.len());
        let words: String = statement[..end].split_whitespace().collect();
        rest = &statement[end..];
        for path in expanded(&words) {
            let mut base = own.to_vec();
            let mut names = path.split("::").peekable();
            match names.peek().copied() {
                Some("crate") => base.clear(),
                Some("self") => {}
                Some("super") => _ = base.pop(),
                _ => continue,
            }
            names.next();
            for name in names {
                if name == "super" {
                    base.pop();
                } else {
                    base.push(name.to_owned());
                }
            }
            found.push(base);
        }
    }
    found
}

/// `a::{b, c::d}` as `a::b` and `a::c::d`.
fn expanded(path: &str) -> Vec<String> {
    let Some((before, list)) = path.split_once('{') else { return vec![path.split("as").next().unwrap_or(path).to_owned()] };
    let list = list.strip_suffix('}').unwrap_or(list);
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&list[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&list[start..]);
    parts.into_iter().filter(|part| !part.is_empty()).flat_map(|part| expanded(&format!("{before}{part}"))).collect()
}

/// Groups of files that import each other, directly or through others of the group.
fn circles(folder: &Path) -> Vec<BTreeSet<String>> {
    let modules = modules(folder);
    let names: Vec<&Vec<String>> = modules.keys().collect();
    // The longest part of a path that is a file.
    let file = |path: &[String]| (0..=path.len()).rev().find_map(|n| names.binary_search_by(|name| name.as_slice().cmp(&path[..n])).ok());
    let mut reaches: Vec<BTreeSet<usize>> = Vec::new();
    for (own, path) in &modules {
        let text = fs::read_to_string(path).expect("a source file");
        let from = names.binary_search(&own).expect("its own name");
        reaches.push(imports(&text, own).iter().filter_map(|path| file(path)).filter(|to| *to != from).collect());
    }
    loop {
        let before: usize = reaches.iter().map(BTreeSet::len).sum();
        for from in 0..reaches.len() {
            let more: BTreeSet<usize> = reaches[from].iter().flat_map(|to| reaches[*to].clone()).collect();
            reaches[from].extend(more);
        }
        if reaches.iter().map(BTreeSet::len).sum::<usize>() == before {
            break;
        }
    }
    let name = |k: usize| if names[k].is_empty() { "lib".to_owned() } else { names[k].join("/") };
    let mut found: Vec<BTreeSet<String>> = Vec::new();
    for from in 0..reaches.len() {
        let group: BTreeSet<String> =
            (0..reaches.len()).filter(|to| reaches[from].contains(to) && reaches[*to].contains(&from)).map(name).collect();
        if group.len() > 1 && !found.contains(&group) {
            found.push(group);
        }
    }
    found
}

#[test]
fn files_import_each_other_in_no_more_circles_than_are_known() {
    let mut worse = Vec::new();
    for ((name, folder), (_, known)) in LAYERS.iter().zip(CIRCLES) {
        let found = circles(&root().join(folder).join("src"));
        found.iter().for_each(|circle| println!("{name}: {}", circle.iter().cloned().collect::<Vec<_>>().join(" ")));
        if found.len() != known {
            worse.push(format!("{name}: found {}, expected {known}", found.len()));
        }
    }
    assert_eq!(worse, [""; 0], "circles of imports: mend the new one, or lower the number");
}

#[test]
fn a_circle_is_found_and_a_tree_is_none() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a folder that can be written");
    write("lib.rs", "mod a;\nmod b;\nuse a::A;\n");
    write("a.rs", "use crate::b::{B, C};\n");
    write("b.rs", "//! B.\nuse std::fmt;\n");
    assert!(circles(folder.path()).is_empty());
    write("b.rs", "//! B.\nuse super::a::A;\n\n#[cfg(test)]\nmod tests {}\n");
    assert_eq!(circles(folder.path()), [BTreeSet::from(["a".to_owned(), "b".to_owned()])]);
}

/// Comments of a line of their own that are longer than 100 columns: code of examples and formulas.
/// The number only falls.
const LONG_COMMENTS: usize = 80;

/// All Rust files in a folder and its subfolders, except build outputs.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let name = entry.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if entry.is_dir() && name != "target" && !name.starts_with('.') {
            sources(&entry, found);
        } else if name.ends_with(".rs") {
            found.push(entry);
        }
    }
}

#[test]
fn comments_wrap_at_100_columns() {
    let mut files = Vec::new();
    sources(&root(), &mut files);
    let mut long = Vec::new();
    for file in files.iter().filter(|file| !file.starts_with(root().join("tests/golden"))) {
        let text = fs::read_to_string(file).expect("a source");
        for (k, line) in text.lines().enumerate() {
            let words = line.trim_start();
            // Rows of tables may be long.
            let is_row = words.trim_start_matches(['/', '!']).trim_start().starts_with('|');
            if words.starts_with("//") && !is_row && line.chars().count() > 100 {
                long.push(format!("{}:{}: {line}", file.display(), k + 1));
            }
        }
    }
    assert!(long.len() <= LONG_COMMENTS, "{} comments are longer than 100 columns:\n{}", long.len(), long.join("\n"));
}
