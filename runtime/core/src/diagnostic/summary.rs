//! Warnings of one sort as one line.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Display;

use super::{Diagnostic, Subject, Unused};
use crate::listed;

/// A line for each sort of finding: the first of the sort unchanged, then the number and the places
/// of the others. Two are of one sort if they have one file, one code and one field.
///
/// ```
/// use articulated_core::diagnostic::{At, Code, Diagnostic, Place, Subject, summary};
///
/// let joints = [0, 1, 2].map(|k| Subject::Joint(format!("j{k}")));
/// let limit = |subject| Place { at: At::Nowhere, subject, field: "limit" };
/// let warning = |s| Diagnostic::error("arm.urdf", &limit(s), Code::LimitMissing, "none", "bounds").into_warning();
/// let warnings: Vec<Diagnostic> = joints.iter().map(warning).collect();
/// let line = "arm.urdf: joint \"j0\": limit: found none, expected bounds (and 2 more: joint \"j1\", joint \"j2\")";
/// assert_eq!(summary(&warnings), [line]);
/// ```
pub fn summary<'a>(findings: impl IntoIterator<Item = &'a Diagnostic>) -> Vec<String> {
    lines(findings, |d| (d.span.file.clone(), d.code, d.field.clone()), |d| (&d.subject, d.line()))
}

/// As [`summary`], of content that is not used: two are of one sort if they have one tag and one
/// reason.
pub fn summary_of_unused<'a>(unused: impl IntoIterator<Item = &'a Unused>) -> Vec<String> {
    lines(unused, |u| (u.tag.clone(), u.why.clone()), |u| (&u.subject, u.line))
}

/// Largest number of the other places that are named.
const NAMED: usize = 3;

fn lines<'a, T: Display + 'a, K: Ord>(
    all: impl IntoIterator<Item = &'a T>,
    sort: impl Fn(&T) -> K,
    place: impl Fn(&'a T) -> (&'a Subject, Option<u32>),
) -> Vec<String> {
    let (mut index, mut groups) = (BTreeMap::new(), Vec::<(&T, Vec<&'a T>)>::new());
    for one in all {
        let at = *index.entry(sort(one)).or_insert(groups.len());
        match groups.get_mut(at) {
            Some((_, others)) => others.push(one),
            None => groups.push((one, Vec::new())),
        }
    }
    let line = |(first, others): (&T, Vec<&'a T>)| {
        if others.is_empty() {
            return first.to_string();
        }
        let mut names: Vec<String> = others.iter().filter_map(|one| name(place(one))).collect();
        names.dedup();
        let places = match names.len() {
            0 => String::new(),
            n if n > NAMED => format!(": {} and {} more", names[..NAMED].join(", "), n - NAMED),
            _ => format!(": {}", listed(names)),
        };
        format!("{first} (and {} more{places})", others.len())
    };
    groups.into_iter().map(line).collect()
}

fn name((subject, line): (&Subject, Option<u32>)) -> Option<String> {
    if *subject == Subject::Document { line.map(|line| format!("line {line}")) } else { Some(subject.to_string()) }
}
