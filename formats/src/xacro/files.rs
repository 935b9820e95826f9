//! Names of files and packages.
//!
//! `$(find NAME)` becomes a mark and the name of the package, and not a folder: the expanded
//! document does not depend on the package's location. The mark becomes a folder when a file is
//! opened, and `package://NAME` in the expanded document.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use crate::Input;

/// Around the name of a package.
const MARKS: [char; 2] = ['\u{f0000}', '\u{f0001}'];
/// Before a folder that replaces a package.
const FOLDER: char = '=';

/// Folders above the one that names start from, in which packages are looked for.
const MOST_ABOVE: usize = 6;

/// The packages that were found.
#[derive(Default)]
pub(crate) struct Packages {
    found: BTreeMap<String, Option<PathBuf>>,
}

/// The text of `$(find name)`.
pub(super) fn package(name: &str) -> String {
    format!("{}{name}{}", MARKS[0], MARKS[1])
}

/// The text of `$(dirname)`.
pub(super) fn folder(path: &Path) -> String {
    format!("{}{FOLDER}{}{}", MARKS[0], path.display(), MARKS[1])
}

/// A text of the expanded document, with names of packages in the place of marks.
pub(super) fn written(text: &str) -> String {
    if !text.contains(MARKS[0]) {
        return text.to_owned();
    }
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, name, after)) = split(rest) {
        match name.strip_prefix(FOLDER) {
            Some(folder) => out.extend([before, folder]),
            None => {
                let before = before.strip_suffix("file://").unwrap_or(before);
                out.extend([before, "package://", name]);
            }
        }
        rest = after;
    }
    out.push_str(rest);
    out.replace(MARKS, "")
}

/// A text up to the first mark, what the mark encloses, and the rest.
fn split(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once(MARKS[0])?;
    let (name, after) = rest.split_once(MARKS[1])?;
    Some((before, name, after))
}

impl Packages {
    /// The path of a file that a file in `beside` names; otherwise the missing package.
    pub(crate) fn path(&mut self, name: &str, beside: &Path, input: &Input<'_>) -> Result<PathBuf, String> {
        let name = name.strip_prefix("file://").unwrap_or(name);
        if let Some(("", inner, rest)) = split(name) {
            let rest = rest.trim_start_matches('/');
            return match inner.strip_prefix(FOLDER) {
                Some(folder) => Ok(tidy(&Path::new(folder).join(rest))),
                None => Ok(tidy(&self.folder(inner, beside, input).ok_or_else(|| inner.to_owned())?.join(rest))),
            };
        }
        if let Some(rest) = name.strip_prefix("package://") {
            let (package, rest) = rest.split_once('/').unwrap_or((rest, ""));
            return Ok(tidy(&self.folder(package, beside, input).ok_or_else(|| package.to_owned())?.join(rest)));
        }
        Ok(tidy(&beside.join(name)))
    }

    /// The folder of a package: as requested, as known to the sources, or around `beside` with a
    /// `package.xml`.
    pub(super) fn folder(&mut self, name: &str, beside: &Path, input: &Input<'_>) -> Option<PathBuf> {
        if let Some(found) = self.found.get(name) {
            return found.clone();
        }
        let folder =
            input.options.packages.get(name).cloned().or_else(|| input.sources.package(name)).or_else(|| around(name, beside, input));
        self.found.insert(name.to_owned(), folder.clone());
        folder
    }
}

/// The folder of a package that contains `beside` or is in a folder around it.
fn around(name: &str, beside: &Path, input: &Input<'_>) -> Option<PathBuf> {
    if name.is_empty() || name.contains(['/', '\\', '\0']) || name.starts_with('.') {
        return None;
    }
    let above = (1..=MOST_ABOVE).filter(|_| beside.is_relative()).map(|count| PathBuf::from(vec![".."; count].join("/")));
    for folder in beside.ancestors().map(Path::to_owned).chain(above) {
        if let Ok(bytes) = input.sources.read(&folder.join("package.xml"))
            && declares_package(&bytes, name)
        {
            return Some(folder);
        }
        let inner = folder.join(name);
        if input.sources.read(&inner.join("package.xml")).is_ok() {
            return Some(inner);
        }
    }
    None
}

/// Whether a `package.xml` of ROS declares the package of this name.
pub fn declares_package(bytes: &[u8], name: &str) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let own = text.split_once("<name>").and_then(|(_, rest)| rest.split_once("</name>"));
    own.is_some_and(|(own, _)| own.trim() == name)
}

/// A path without `.` and without `NAME/..`.
fn tidy(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            part => out.push(part),
        }
    }
    out
}

/// Whether a name of a file has wildcards.
pub(super) fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?', '['])
}

/// A part of a pattern.
enum Part {
    /// `*`: any characters.
    Any,
    /// `?`: any character.
    One,
    Character(char),
    /// `[…]`: one character from these ranges, or with `!`, one outside them.
    Class {
        is_not: bool,
        ranges: Vec<[char; 2]>,
    },
}

impl Part {
    fn fits(&self, c: char) -> bool {
        match self {
            Self::Any => false,
            Self::One => true,
            Self::Character(own) => *own == c,
            Self::Class { is_not, ranges } => ranges.iter().any(|[first, last]| (*first..=*last).contains(&c)) != *is_not,
        }
    }
}

/// The parts of a pattern, as Python's `fnmatch` splits it. A `[` without its `]` is itself.
fn parts(pattern: &str) -> Vec<Part> {
    let signs: Vec<char> = pattern.chars().collect();
    let (mut parts, mut at, mut is_open) = (Vec::new(), 0, true);
    while at < signs.len() {
        let c = signs[at];
        at += 1;
        parts.push(match c {
            '*' => Part::Any,
            '?' => Part::One,
            // After a `[` without its `]`, later ones have none either.
            '[' if is_open => match class(&signs[at..]) {
                Some((class, length)) => {
                    at += length;
                    class
                }
                None => {
                    is_open = false;
                    Part::Character(c)
                }
            },
            c => Part::Character(c),
        });
    }
    parts
}

/// The class of the characters after a `[`, and their number including the `]`.
fn class(signs: &[char]) -> Option<(Part, usize)> {
    let is_not = signs.first() == Some(&'!');
    let from = usize::from(is_not);
    // A `]` that comes first is a member.
    let end = from + 1 + signs.get(from + 1..)?.iter().position(|c| *c == ']')?;
    let (members, mut ranges, mut at) = (&signs[from..end], Vec::new(), 0);
    while at < members.len() {
        let is_range = members.get(at + 1) == Some(&'-') && at + 2 < members.len();
        ranges.push([members[at], members[if is_range { at + 2 } else { at }]]);
        at += if is_range { 3 } else { 1 };
    }
    Some((Part::Class { is_not, ranges }, end + 1))
}

/// Whether a file name matches a pattern with `*`, `?` and `[…]`.
pub(super) fn fits(pattern: &str, name: &str) -> bool {
    let (parts, name): (Vec<Part>, Vec<char>) = (parts(pattern), name.chars().collect());
    // Position of the last `*`, and of the character where its match was tried.
    let (mut p, mut n, mut star) = (0, 0, None);
    while n < name.len() {
        match parts.get(p) {
            Some(Part::Any) => {
                star = Some((p, n));
                p += 1;
            }
            Some(part) if part.fits(name[n]) => (p, n) = (p + 1, n + 1),
            _ => match star {
                Some((at, tried)) => {
                    (p, n) = (at + 1, tried + 1);
                    star = Some((at, tried + 1));
                }
                None => return false,
            },
        }
    }
    let shows_hidden = name.first().is_none_or(|c| *c != '.') || pattern.starts_with('.');
    parts[p..].iter().all(|part| matches!(part, Part::Any)) && shows_hidden
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_named_in_the_expanded_document() {
        let find = package("ur");
        assert_eq!(written(&format!("file://{find}/a.stl")), "package://ur/a.stl");
        assert_eq!(written(&format!("{find}/a.stl {}/b", folder("x".as_ref()))), "package://ur/a.stl x/b");
        assert_eq!(written("plain"), "plain");
    }

    #[test]
    fn names_fit_patterns() {
        for (pattern, name, is_so) in [
            ("*.xacro", "a.xacro", true),
            ("*.xacro", "a.urdf", false),
            ("a?c*", "abc", true),
            ("*a*b", "xaab", true),
            ("*", ".a", false),
            ("", "a", false),
            ("a[1-3]", "a2", true),
            ("a[1-3]", "a4", false),
            ("a[!1-3]", "a4", true),
            ("a[!1-3]", "a2", false),
            ("[]x]*", "]b", true),
            ("[a-]", "-", true),
            ("[3-1]", "2", false),
            ("a[1", "a[1", true),
            ("a[1", "a1", false),
            ("*[é-ü].x", "bö.x", true),
        ] {
            assert_eq!(fits(pattern, name), is_so, "{pattern} {name}");
        }
    }
}
