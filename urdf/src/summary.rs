//! Warnings that say one thing as one line.

use std::fmt::Display;

use articulated_core::listed;

use crate::problem::{Problem, Subject};
use crate::unused::Unused;

/// A line for each sort of problem: the first of the sort as it is, then how many more there are and where. Two are of one sort if they are of one file, one kind and one field.
///
/// ```
/// use articulated_urdf::{Options, read, summary};
///
/// let joint = |k: u32| format!("<link name='l{k}'/><joint name='j{k}' type='revolute'><parent link='base'/><child link='l{k}'/></joint>");
/// let urdf = format!("<robot name='r'><link name='base'/>{}</robot>", (0..28).map(joint).collect::<String>());
/// let warnings = read(urdf.as_bytes(), &Options::default()).unwrap().warnings;
/// assert_eq!((warnings.len(), summary(&warnings).len()), (28, 1));
/// assert!(summary(&warnings)[0].ends_with(" (and 27 more: joint \"j1\", joint \"j2\", joint \"j3\" and 24 more)"));
/// ```
pub fn summary<'a>(problems: impl IntoIterator<Item = &'a Problem>) -> Vec<String> {
    lines(problems, |p| (p.file.clone(), p.kind, p.field.clone()), |p| (&p.subject, p.line))
}

/// As [`summary`], of what is not used: two are of one sort if one reason holds for one tag.
pub fn summary_of_unused<'a>(unused: impl IntoIterator<Item = &'a Unused>) -> Vec<String> {
    lines(unused, |u| (u.tag.clone(), u.why.clone()), |u| (&u.subject, u.line))
}

/// So many places of the others are named.
const NAMED: usize = 3;

fn lines<'a, T: Display + 'a, K: std::hash::Hash + Eq>(
    all: impl IntoIterator<Item = &'a T>,
    sort: impl Fn(&T) -> K,
    place: impl Fn(&'a T) -> (&'a Subject, Option<u32>),
) -> Vec<String> {
    let (mut index, mut groups) = (std::collections::HashMap::new(), Vec::<(&T, Vec<&'a T>)>::new());
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
