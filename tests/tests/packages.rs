//! Requirements of a registry for each published crate: its metadata, its licences, and no file
//! outside its folder.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// The crates that users depend on, and the crates that these depend on.
const PUBLISHED: [&str; 11] = [
    "articulated",
    "articulated-cli",
    "articulated-codegen",
    "articulated-core",
    "articulated-formats",
    "articulated-lab",
    "articulated-macros",
    "articulated-models",
    "articulated-motion",
    "articulated-reference",
    "articulated-scene",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the root of the workspace")
}

/// Cargo's metadata from the manifests of the workspace.
fn packages() -> Vec<Value> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(root())
        .output()
        .expect("cargo");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let all: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    all["packages"].as_array().expect("a list").clone()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

fn is_published(package: &Value) -> bool {
    package["publish"].is_null()
}

fn folder(package: &Value) -> PathBuf {
    Path::new(text(package, "manifest_path")).parent().expect("a folder").to_owned()
}

#[test]
fn the_published_crates_are_those_that_users_need() {
    let packages = packages();
    let published: BTreeSet<&str> = packages.iter().filter(|package| is_published(package)).map(|package| text(package, "name")).collect();
    assert_eq!(published, BTreeSet::from(PUBLISHED));
}

#[test]
fn published_crates_have_the_metadata_of_a_registry() {
    let mut missing = Vec::new();
    for package in packages().iter().filter(|package| is_published(package)) {
        let name = text(package, "name");
        for key in ["description", "license", "repository", "readme", "rust_version"] {
            if text(package, key).is_empty() {
                missing.push(format!("{name}: found no {key}"));
            }
        }
        for key in ["keywords", "categories"] {
            let count = package[key].as_array().map_or(0, Vec::len);
            if !(1..=5).contains(&count) {
                missing.push(format!("{name}: found {count} {key}, expected 1 to 5"));
            }
        }
        if package["metadata"]["docs"]["rs"]["all-features"] != Value::Bool(true) {
            missing.push(format!("{name}: found no all-features of docs.rs"));
        }
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let file = folder(package).join(licence);
            let is_link = file.symlink_metadata().is_ok_and(|metadata| metadata.is_symlink());
            if is_link || fs::read(file).ok() != fs::read(root().join(licence)).ok() {
                missing.push(format!("{name}: found no copy of {licence}"));
            }
        }
    }
    assert_eq!(missing, [""; 0]);
}

/// A dependency of tests alone has no version. Cargo leaves it out of the package, so crates may
/// test each other.
#[test]
fn dependencies_within_the_workspace_can_be_published() {
    let packages = packages();
    let versions: BTreeMap<&str, &str> = packages.iter().map(|package| (text(package, "name"), text(package, "version"))).collect();
    let mut wrong = Vec::new();
    for package in packages.iter().filter(|package| is_published(package)) {
        for dependency in package["dependencies"].as_array().expect("a list") {
            let Some(version) = versions.get(text(dependency, "name")) else { continue };
            let name = format!("{} -> {}", text(package, "name"), text(dependency, "name"));
            let expected = if dependency["kind"] == "dev" { "*".to_owned() } else { format!("^{version}") };
            let found = text(dependency, "req");
            if found != expected {
                wrong.push(format!("{name}: found the version {found}, expected {expected}"));
            }
            if dependency["kind"] != "dev" && !PUBLISHED.contains(&text(dependency, "name")) {
                wrong.push(format!("{name}: found a crate that is not published"));
            }
        }
    }
    assert_eq!(wrong, [""; 0]);
}

/// A dependency without default features is one without `measure`.
#[test]
fn the_python_package_compiles_nothing_that_measures() {
    let packages = packages();
    let dependency = |user: &str, used: &str| {
        let package = packages.iter().find(|package| text(package, "name") == user).expect("a crate");
        let all = package["dependencies"].as_array().expect("a list");
        all.iter().find(|one| text(one, "name") == used && one["kind"].is_null()).expect("a dependency").clone()
    };
    for (user, used) in [("articulated-python", "articulated-cli"), ("articulated-cli", "articulated-lab")] {
        let found = dependency(user, used);
        assert_eq!((&found["uses_default_features"], &found["features"]), (&Value::Bool(false), &Value::Array(Vec::new())), "{user}");
    }
}

fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// The files that a source text includes outside of `crate_folder`. Its paths are relative to the
/// file.
fn included_outside(file: &Path, source: &str, crate_folder: &Path) -> Vec<String> {
    let mut outside = Vec::new();
    for start in ["include_str!(", "include_bytes!(", "include!(", "#[path = "] {
        for (at, _) in source.match_indices(start) {
            let Some(path) = source[at + start.len()..].split('"').nth(1) else { continue };
            let mut place = file.parent().expect("a folder").to_owned();
            for part in Path::new(path).components() {
                match part {
                    Component::ParentDir => {
                        place.pop();
                    }
                    other => place.push(other),
                }
            }
            if !place.starts_with(crate_folder) {
                outside.push(format!("{}: {path}", file.display()));
            }
        }
    }
    outside
}

#[test]
fn published_sources_include_no_file_outside_their_crate() {
    let mut outside = Vec::new();
    for package in packages().iter().filter(|package| is_published(package)) {
        let folder = folder(package);
        let mut files = Vec::new();
        sources(&folder.join("src"), &mut files);
        let texts: Vec<(PathBuf, String)> =
            files.into_iter().map(|file| (file.clone(), fs::read_to_string(file).expect("a source file"))).collect();
        // Modules that are compiled for tests only.
        let tests: BTreeSet<&str> = texts
            .iter()
            .flat_map(|(_, source)| source.split("#[cfg(test)]\nmod ").skip(1))
            .filter_map(|rest| rest.split_once(';').map(|(name, _)| name))
            .collect();
        for (file, source) in &texts {
            let is_test =
                file.with_extension("").components().any(|part| part.as_os_str().to_str().is_some_and(|part| tests.contains(part)));
            if !is_test {
                outside.extend(included_outside(file, source, &folder));
            }
        }
    }
    assert_eq!(outside, [""; 0], "packages lack these files");
}

#[test]
fn a_file_outside_the_crate_is_found() {
    let file = Path::new("/crate/src/part/mod.rs");
    let found = included_outside(file, r#"include_str!("../../../docs/a.md"); include_str!(concat!("../", "x"))"#, Path::new("/crate"));
    assert_eq!(found, ["/crate/src/part/mod.rs: ../../../docs/a.md"]);
    assert_eq!(included_outside(file, r#"include_str!("../../readme.md")"#, Path::new("/crate")), [""; 0]);
}
