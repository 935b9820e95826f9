//! Tables of keys, one row each, from which scenes are read and their documentation is made; and
//! the types of values.

use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
use articulated_core::effect::Range;

use crate::tree::{Entry, Node, Value};

/// One key of a table that is read into a `T`.
pub(crate) struct Row<T> {
    /// Its name.
    pub(crate) name: &'static str,
    /// Whether it has to be there.
    pub(crate) required: bool,
    /// The type of its value, and the unit.
    pub(crate) value: &'static str,
    /// Value if it is left out.
    pub(crate) default: &'static str,
    /// Meaning.
    pub(crate) what: &'static str,
    /// Reads the value.
    pub(crate) read: fn(&mut T, &Cursor<'_>, &mut Diagnostics),
}

/// Keys that other programs have, and the one that is meant.
pub(crate) const MEANT: [(&str, &str); 5] = [
    ("floating", "base = \"floating\""),
    ("floating_base", "base = \"floating\""),
    ("free_flyer", "base = \"floating\""),
    ("fixed", "base = \"fixed\""),
    ("fixed_base", "base = \"fixed\""),
];

/// A value and the way to it.
pub(crate) struct Cursor<'a> {
    pub(crate) node: &'a Node,
    pub(crate) key: String,
    /// The place of the key.
    pub(crate) at: At,
}

impl<'a> Cursor<'a> {
    /// The whole scene.
    pub(crate) fn root(node: &'a Node) -> Self {
        Self { node, key: String::new(), at: node.at }
    }

    /// The spot of an entry.
    pub(crate) fn of(&self, entry: &'a Entry) -> Self {
        let name = bare(&entry.name);
        let key = if self.key.is_empty() { name } else { format!("{}.{name}", self.key) };
        Self { node: &entry.node, key, at: entry.at }
    }

    /// The spot of an item of a list.
    pub(crate) fn item(&self, node: &'a Node, index: usize) -> Self {
        Self { node, key: format!("{}[{index}]", self.key), at: node.at }
    }

    /// It is of another type.
    pub(crate) fn wrong(&self, log: &mut Diagnostics, expected: impl Into<String>) {
        log.error((self.node.at, &self.key), Code::Type, self.node.value.describe(), expected);
    }

    /// Reports a number that is invalid here.
    pub(crate) fn bad(&self, log: &mut Diagnostics, found: impl Into<String>, expected: impl Into<String>) {
        log.error((self.node.at, &self.key), Code::Number, found, expected);
    }

    /// Reports a conflict with another key.
    pub(crate) fn clash(&self, log: &mut Diagnostics, found: impl Into<String>, expected: impl Into<String>) {
        log.error((self.at, &self.key), Code::Together, found, expected);
    }

    /// The entries of a table.
    pub(crate) fn entries(&self, log: &mut Diagnostics, expected: &str) -> &'a [Entry] {
        match &self.node.value {
            Value::Table(entries) => entries,
            _ => {
                self.wrong(log, expected);
                &[]
            }
        }
    }

    /// The value of a key of a table, if it is there.
    pub(crate) fn get(&self, name: &str) -> Option<Cursor<'a>> {
        match &self.node.value {
            Value::Table(entries) => entries.iter().find(|e| e.name == name).map(|e| self.of(e)),
            _ => None,
        }
    }

    /// The items of a list.
    pub(crate) fn list(&self) -> Option<Vec<Cursor<'a>>> {
        match &self.node.value {
            Value::List(list) => Some(list.iter().enumerate().map(|(i, node)| self.item(node, i)).collect()),
            _ => None,
        }
    }

    /// A number, which is judged elsewhere.
    pub(crate) fn any(&self, log: &mut Diagnostics) -> Option<f64> {
        match self.node.value {
            Value::Number(x) => Some(x),
            _ => {
                self.wrong(log, "a number");
                None
            }
        }
    }

    /// A finite number.
    pub(crate) fn number(&self, log: &mut Diagnostics) -> Option<f64> {
        self.within(log, Range::ALL)
    }

    /// A finite number, at least zero.
    pub(crate) fn not_negative(&self, log: &mut Diagnostics) -> Option<f64> {
        self.within(log, Range::NOT_NEGATIVE)
    }

    /// A finite number above zero.
    pub(crate) fn positive(&self, log: &mut Diagnostics) -> Option<f64> {
        self.within(log, Range::POSITIVE)
    }

    /// A number of the range.
    pub(crate) fn within(&self, log: &mut Diagnostics, range: Range) -> Option<f64> {
        match self.node.value {
            Value::Number(x) if range.has(x) => Some(x),
            Value::Number(x) => {
                self.bad(log, format!("{x:?}"), range.to_string());
                None
            }
            _ => {
                self.wrong(log, range.to_string());
                None
            }
        }
    }

    /// A whole number from `least` to `most`.
    pub(crate) fn whole(&self, log: &mut Diagnostics, least: u64, most: u64) -> Option<u64> {
        let expected = format!("a whole number from {least} to {most}");
        match self.node.value {
            Value::Number(x) if x.fract() == 0.0 && x >= least as f64 && x <= most as f64 => Some(x as u64),
            Value::Number(x) => {
                self.bad(log, format!("{x:?}"), expected);
                None
            }
            _ => {
                self.wrong(log, expected);
                None
            }
        }
    }

    /// A list of N finite numbers.
    pub(crate) fn numbers<const N: usize>(&self, log: &mut Diagnostics) -> Option<[f64; N]> {
        match self.some_numbers(log, &format!("a list of {N} finite numbers"))?.try_into() {
            Ok(numbers) => Some(numbers),
            Err(_) => {
                self.wrong(log, format!("a list of {N} finite numbers"));
                None
            }
        }
    }

    /// A list of finite numbers.
    pub(crate) fn some_numbers(&self, log: &mut Diagnostics, expected: &str) -> Option<Vec<f64>> {
        let Some(list) = self.list() else {
            self.wrong(log, expected);
            return None;
        };
        let before = log.count();
        let numbers = list.iter().filter_map(|item| item.number(log)).collect();
        (log.count() == before).then_some(numbers)
    }

    /// A text.
    pub(crate) fn text(&self, log: &mut Diagnostics, expected: &str) -> Option<&'a str> {
        match &self.node.value {
            Value::Text(text) => Some(text),
            _ => {
                self.wrong(log, expected);
                None
            }
        }
    }

    /// A list of texts.
    pub(crate) fn texts(&self, log: &mut Diagnostics, expected: &str) -> Option<Vec<String>> {
        let Some(list) = self.list() else {
            self.wrong(log, expected);
            return None;
        };
        let before = log.count();
        let texts = list.iter().filter_map(|item| item.text(log, "a text").map(str::to_owned)).collect();
        (log.count() == before).then_some(texts)
    }

    /// `true` or `false`.
    pub(crate) fn boolean(&self, log: &mut Diagnostics) -> Option<bool> {
        match self.node.value {
            Value::Bool(b) => Some(b),
            _ => {
                self.wrong(log, "true or false");
                None
            }
        }
    }

    /// One of some words.
    pub(crate) fn word<W: Copy>(&self, log: &mut Diagnostics, words: &[(&'static str, W)]) -> Option<W> {
        self.word_like(log, words, |found| found)
    }

    /// One of some words. For an unknown word, the suggestion is the word nearest to `meant` of it.
    pub(crate) fn word_like<W: Copy>(&self, log: &mut Diagnostics, words: &[(&'static str, W)], meant: impl Fn(&str) -> &str) -> Option<W> {
        let listed = words.iter().map(|(word, _)| format!("{word:?}")).collect::<Vec<_>>().join(", ");
        let found = self.text(log, &format!("one of {listed}"))?;
        if let Some((_, meant)) = words.iter().find(|(word, _)| *word == found) {
            return Some(*meant);
        }
        let names = words.iter().map(|(word, _)| *word);
        log.unknown(((self.node.at, &self.key), Code::Word), (quote(found), meant(found)), format!("one of {listed}"), names);
        None
    }

    /// The table, by its rows.
    pub(crate) fn read<T>(&self, rows: &[Row<T>], into: &mut T, log: &mut Diagnostics) {
        let before = log.count();
        let entries = self.entries(log, "a table");
        if log.count() > before {
            return;
        }
        for entry in entries {
            let spot = self.of(entry);
            match rows.iter().find(|row| row.name == entry.name) {
                Some(row) => (row.read)(into, &spot, log),
                None => spot.unknown_key(log, rows.iter().map(|row| row.name)),
            }
        }
        // The file of a robot has two possible keys.
        let is_given = |name: &str| entries.iter().any(|e| e.name == name || (name == "urdf" && e.name == "file"));
        for row in rows.iter().filter(|row| row.required && !is_given(row.name)) {
            log.error(
                (self.at, &self.key),
                Code::MissingKey,
                format!("no {}", row.name),
                format!("{}: {}, {}", row.name, row.value, row.what),
            );
        }
    }

    /// Reports an unknown key.
    pub(crate) fn unknown_key<'n>(&self, log: &mut Diagnostics, names: impl IntoIterator<Item = &'n str>) {
        const FOUND: &str = "a key that is not known";
        if let Some((_, meant)) = MEANT.iter().find(|(key, _)| *key == self.key) {
            return log.error((self.at, &self.key), Code::UnknownKey, FOUND, *meant);
        }
        let names: Vec<&str> = names.into_iter().collect();
        let name = self.key.rsplit('.').next().unwrap_or_default();
        log.unknown(((self.at, &self.key), Code::UnknownKey), (FOUND.into(), name), format!("one of {}", names.join(", ")), names);
    }

    /// One table, or a list of tables, each by the rows.
    pub(crate) fn tables<T: Default>(&self, rows: &[Row<T>], log: &mut Diagnostics) -> Vec<T> {
        let one = |spot: &Cursor<'_>, log: &mut Diagnostics| {
            let before = log.count();
            let mut value = T::default();
            spot.read(rows, &mut value, log);
            (log.count() == before).then_some(value)
        };
        match self.list() {
            Some(list) => list.iter().filter_map(|spot| one(spot, log)).collect(),
            None => one(self, log).into_iter().collect(),
        }
    }
}

/// A name as a part of the path to a key.
pub(crate) fn bare(name: &str) -> String {
    let plain = !name.is_empty() && name.len() <= 80 && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    if plain { name.to_owned() } else { quote(name) }
}
