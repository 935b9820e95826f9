//! A valid robot, and ways to make it invalid.
#![allow(dead_code, reason = "each test file uses a part")]

use std::path::Path;
use std::{env, fs};

use articulated_core::description::{Description, Joint};
use articulated_core::diagnostic::{Diagnostic, Diagnostics};
use articulated_formats::{Options, Reading, read};

/// A crane: five links, joints of four types, no warnings.
pub(crate) const CRANE: &str = include_str!("crane.urdf");

/// The crane with one change, which has to apply exactly once.
pub(crate) fn crane(from: &str, to: &str) -> String {
    assert_eq!(CRANE.matches(from).count(), 1, "{from}");
    CRANE.replace(from, to)
}

pub(crate) fn options() -> Options {
    Options { file: "crane.urdf".to_owned(), ..Options::default() }
}

pub(crate) fn accepted(text: &str) -> Reading {
    read(text.as_bytes(), &options()).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

pub(crate) fn described(text: &str) -> Description {
    accepted(text).description
}

pub(crate) fn refused(text: &str) -> Diagnostics {
    refused_bytes(text.as_bytes())
}

pub(crate) fn refused_bytes(bytes: &[u8]) -> Diagnostics {
    match read(bytes, &options()) {
        Ok(_) => panic!("accepted: {}", String::from_utf8_lossy(bytes)),
        Err(problems) => problems,
    }
}

/// The only error of a text.
pub(crate) fn only_error(text: &str) -> Diagnostic {
    let problems = refused(text);
    assert_eq!(problems.errors.len(), 1, "{problems}\n{text}");
    problems.errors[0].clone()
}

/// Compares messages with those in a file of this folder, word by word; `UPDATE_GOLDEN=1` renews
/// it.
pub(crate) fn as_kept(file: &str, messages: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(file);
    if env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, messages.join("\n") + "\n").expect("the folder can be written to");
    }
    let kept = fs::read_to_string(&path).expect("the file is there");
    let kept: Vec<&str> = kept.lines().collect();
    for (message, kept) in messages.iter().zip(&kept) {
        assert_eq!(message, kept, "{file}");
    }
    assert_eq!(messages.len(), kept.len(), "{file}");
}

/// The joint of this name in an accepted document.
pub(crate) fn joint(text: &str, name: &str) -> Joint {
    let description = described(text);
    description.joints[description.joint(name).unwrap()].clone()
}
