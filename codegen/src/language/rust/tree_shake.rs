//! Removes functions of helpers that are never called: each compiler would check them, and users
//! read them.
//!
//! The texts are those of [`articulated_core::lanes`] and its like, in which functions are items of
//! a known form.

use std::collections::{HashMap, HashSet};

use crate::language::rust::requirements::Requirements;

/// A function in a text: its name and its lines, attributes and comments above it included.
struct Item<'a> {
    name: &'a str,
    first: usize,
    last: usize,
}

/// The text of helpers without functions that are neither called nor needed by one that is. Modules
/// inside a function are part of it.
pub(crate) fn tree_shake(text: &str, calls: &Requirements) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let items = items(&lines);
    let live = live(&lines, &items, items.iter().map(|item| item.name).filter(|name| calls.has(name)).collect());
    let mut kept = vec![true; lines.len()];
    items.iter().filter(|item| !live.contains(item.name)).for_each(|item| kept[item.first..=item.last].fill(false));
    // Another name for a function that is not there any more.
    let gone = |line: &str| renamed(line).is_some_and(|(name, _)| items.iter().any(|item| item.name == name) && !live.contains(name));
    lines.iter().zip(&mut kept).filter(|(line, _)| gone(line)).for_each(|(_, kept)| *kept = false);
    let rest: Vec<&str> = lines.iter().zip(kept).filter(|(_, kept)| *kept).map(|(line, _)| *line).collect();
    without_gaps(&rest).iter().map(|line| format!("{line}\n")).collect()
}

/// The lines without empty blocks, and without empty lines at the ends of blocks or in succession.
fn without_gaps<'a>(lines: &[&'a str]) -> Vec<&'a str> {
    let mut kept: Vec<&str> = Vec::new();
    for line in lines {
        if line.trim() == "}" && kept.last().is_some_and(|last| last.is_empty()) {
            kept.pop();
        }
        let before = kept.last().copied().unwrap_or_default();
        if line.trim() == "}" && before.ends_with("! {") {
            kept.pop();
        } else if !line.is_empty() || !(before.is_empty() || before.ends_with('{')) {
            kept.push(line);
        }
    }
    kept
}

/// Names of the required functions: the first ones, and all that a required one names in its text.
fn live<'a>(lines: &[&'a str], items: &[Item<'a>], first: Vec<&'a str>) -> HashSet<&'a str> {
    let mut bodies: HashMap<&str, Vec<&'a str>> = HashMap::new();
    for item in items {
        bodies.entry(item.name).or_default().extend(lines[item.first..=item.last].iter().flat_map(|line| words(line)));
    }
    for (name, other) in lines.iter().filter_map(|line| renamed(line)) {
        bodies.entry(other).or_default().push(name);
    }
    let mut live: HashSet<&str> = HashSet::new();
    let mut open = first;
    while let Some(name) = open.pop() {
        if let Some(body) = bodies.get(name)
            && live.insert(name)
        {
            open.extend(body);
        }
    }
    live
}

/// The functions, in their order; a function inside another is part of it.
fn items<'a>(lines: &[&'a str]) -> Vec<Item<'a>> {
    let mut items: Vec<Item> = Vec::new();
    let mut next = 0;
    while next < lines.len() {
        if let Some(name) = declared(lines[next]) {
            let above =
                lines[..next].iter().rev().take_while(|line| ["#[", "//"].iter().any(|mark| line.trim_start().starts_with(mark))).count();
            let last = end(lines, next);
            items.push(Item { name, first: next - above, last });
            next = last;
        }
        next += 1;
    }
    items
}

/// The name of the function that begins in a line.
fn declared(line: &str) -> Option<&str> {
    let rest = line.trim_start();
    let rest = rest.strip_prefix("pub(super) ").unwrap_or(rest);
    let rest = rest.strip_prefix("extern \"C\" ").unwrap_or(rest);
    words(rest.strip_prefix("fn ")?).next()
}

/// The line in which the braces that open from `first` on are closed.
fn end(lines: &[&str], first: usize) -> usize {
    let mut depth = 0;
    for (k, line) in lines.iter().enumerate().skip(first) {
        depth += line.matches('{').count();
        depth -= line.matches('}').count().min(depth);
        if depth == 0 && line.contains('}') {
            return k;
        }
    }
    lines.len() - 1
}

/// `use self::name as other;`
fn renamed(line: &str) -> Option<(&str, &str)> {
    line.trim().strip_prefix("use self::")?.strip_suffix(';')?.split_once(" as ")
}

fn in_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c| !in_word(c)).filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use articulated_core::lanes::{Real, Set, source};

    fn calls(text: &str) -> Requirements {
        let mut calls = Requirements::default();
        calls.add_helper(text);
        calls
    }

    const TEXT: &str = "\
type V = f64;

some! {
    pub(super) fn a(x: V) -> V {
        b(x)
    }

    // Of no use.
    #[inline]
    pub(super) extern \"C\" fn c(x: V) -> V {
        if x > 0.0 { a(x) } else { x }
    }
}

use self::d as b;

fn d(x: V) -> V {
    x
}
";

    #[test]
    fn what_is_called_stays_and_all_else_goes() {
        let expected = TEXT.replace("\n    // Of no use.\n    #[inline]\n    pub(super) extern \"C\" fn c(x: V) -> V {\n        if x > 0.0 { a(x) } else { x }\n    }\n", "");
        assert_eq!(tree_shake(TEXT, &calls("x = a(y); // and not abc, nor _c")), expected);
        assert_eq!(tree_shake(TEXT, &calls("c(y)")), TEXT);
        assert_eq!(tree_shake(TEXT, &calls("abc, _a and a_")), "type V = f64;\n\n");
    }

    #[test]
    fn all_functions_of_the_lanes_are_found() {
        for set in [Set::Portable, Set::Sse2, Set::Avx2, Set::Neon] {
            let text = source(set, Real::F64, 4).unwrap();
            let lines: Vec<&str> = text.lines().collect();
            let found = items(&lines);
            let inside = lines.iter().filter(|line| line.contains("fn ") && !line.trim_start().starts_with("//")).count();
            assert_eq!(found.len(), inside, "{set:?}");
            let names: Vec<&str> = found.iter().map(|item| item.name).collect();
            let lines_of = |text: &str| text.lines().filter(|line| !line.is_empty()).map(String::from).collect::<Vec<_>>();
            assert_eq!(lines_of(&tree_shake(&text, &calls(&names.join(" ")))), lines_of(&text), "{set:?}");
            assert!(tree_shake(&text, &calls("{sin_cos}")).lines().count() < lines.len() * 3 / 4, "{set:?}");
        }
    }
}
