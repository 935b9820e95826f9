//! Values of expressions, with their meaning in Python.

use std::cmp::Ordering;
use std::ops::Deref;
use std::rc::Rc;

use articulated_core::diagnostic::quote;

/// A value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    None,
    Bool(bool),
    /// Python's integers are unbounded: these have 128 bits, and larger ones are an error.
    Int(i128),
    Float(f64),
    Text(Rc<str>),
    List(Rc<Items<Value>>),
    Tuple(Rc<Items<Value>>),
    /// Keys and values, in their order.
    Table(Rc<Items<(Value, Value)>>),
    /// A function or a module by its name.
    Builtin(&'static str),
    /// A method of a value.
    Method(Rc<Value>, Rc<str>),
    /// The properties of an included file, by the number of their scope.
    Scope(usize),
}

/// The items of a list, and the depth of nested lists in it.
#[derive(Debug)]
pub(super) struct Items<T> {
    all: Box<[T]>,
    depth: u8,
}

impl<T> Deref for Items<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.all
    }
}

/// Maximum depth of nested lists.
const MOST_DEPTH: u8 = 32;
/// Maximum number of compared items of two lists; beyond it they count as different.
const MOST_COMPARED: usize = 1 << 16;

/// Errors of an expression.
#[derive(Clone, Debug)]
pub(super) enum Fault {
    /// What was found, and what is expected.
    Wrong { found: String, expected: String },
    /// An error was reported already.
    Reported,
    /// The work exceeds that of any robot: found, and the bound.
    TooLarge { found: &'static str, most: usize },
}

pub(super) type Result<T> = std::result::Result<T, Fault>;

/// A fault of these words.
pub(super) fn wrong<T>(found: impl Into<String>, expected: impl Into<String>) -> Result<T> {
    Err(Fault::Wrong { found: found.into(), expected: expected.into() })
}

impl Value {
    pub(super) fn text(text: &str) -> Self {
        Self::Text(text.into())
    }

    pub(super) fn list(items: Vec<Self>) -> Result<Self> {
        nested(items, Self::depth).map(Self::List)
    }

    pub(super) fn tuple(items: Vec<Self>) -> Result<Self> {
        nested(items, Self::depth).map(Self::Tuple)
    }

    pub(super) fn table(entries: Vec<(Self, Self)>) -> Result<Self> {
        if let Some((key, _)) = entries.iter().find(|(key, _)| key.depth() > 0) {
            return wrong(format!("{} as a key", key.kind()), "a text or a number");
        }
        nested(entries, |(_, value)| value.depth()).map(Self::Table)
    }

    fn depth(&self) -> u8 {
        match self {
            Self::List(items) | Self::Tuple(items) => items.depth,
            Self::Table(entries) => entries.depth,
            Self::Method(value, _) => value.depth(),
            _ => 0,
        }
    }

    /// The number of items, as a measure of their work.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::List(items) | Self::Tuple(items) => items.len(),
            Self::Table(entries) => entries.len(),
            Self::Text(text) => text.len() / 16,
            _ => 0,
        }
    }

    /// Its type, for messages.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::None => "None",
            Self::Bool(_) => "a truth value",
            Self::Int(_) => "an integer",
            Self::Float(_) => "a number",
            Self::Text(_) => "a text",
            Self::List(_) => "a list",
            Self::Tuple(_) => "a tuple",
            Self::Table(_) => "a dictionary",
            Self::Builtin(_) | Self::Method(..) => "a function",
            Self::Scope(_) => "a namespace",
        }
    }

    /// Its type and its value, for messages.
    pub(super) fn shown(&self) -> String {
        const SHOWN: usize = 60;
        match self {
            Self::None | Self::Builtin(_) | Self::Method(..) | Self::Scope(_) => self.kind().to_owned(),
            Self::Text(text) => format!("the text {}", quote(&text.chars().take(SHOWN).collect::<String>())),
            other => format!("{} {}", other.kind(), other.written().chars().take(SHOWN).collect::<String>()),
        }
    }

    pub(super) fn is_true(&self) -> bool {
        match self {
            Self::None => false,
            Self::Bool(value) => *value,
            Self::Int(value) => *value != 0,
            Self::Float(value) => *value != 0.0,
            Self::Text(text) => !text.is_empty(),
            Self::List(items) | Self::Tuple(items) => !items.is_empty(),
            Self::Table(entries) => !entries.is_empty(),
            Self::Builtin(_) | Self::Method(..) | Self::Scope(_) => true,
        }
    }

    /// The number, if it is one or a truth value.
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Bool(value) => Some(f64::from(u8::from(*value))),
            Self::Int(value) => Some(*value as f64),
            Self::Float(value) => Some(*value),
            _ => None,
        }
    }

    /// The integer, if it is one or a truth value.
    pub(super) fn integer(&self) -> Option<i128> {
        match self {
            Self::Bool(value) => Some(i128::from(*value)),
            Self::Int(value) => Some(*value),
            _ => None,
        }
    }

    /// As `str` writes it.
    pub(super) fn written(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, false, 0);
        out
    }

    /// As `repr` writes it.
    pub(super) fn literal(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, true, 0);
        out
    }

    fn write(&self, out: &mut String, is_literal: bool, depth: usize) {
        // A value that contains itself many times over would be written endlessly.
        if depth > 16 || out.len() > MOST_WRITTEN {
            return out.push_str("...");
        }
        let list = |out: &mut String, items: &[Self]| {
            for (i, item) in items.iter().enumerate() {
                out.push_str(if i == 0 { "" } else { ", " });
                item.write(out, true, depth + 1);
            }
        };
        match self {
            Self::None => out.push_str("None"),
            Self::Bool(true) => out.push_str("True"),
            Self::Bool(false) => out.push_str("False"),
            Self::Int(value) => out.push_str(&value.to_string()),
            Self::Float(value) => out.push_str(&float(*value)),
            Self::Text(text) if is_literal => {
                let mark = if text.contains('\'') && !text.contains('"') { '"' } else { '\'' };
                out.push(mark);
                for c in text.chars() {
                    match c {
                        '\\' => out.push_str("\\\\"),
                        '\n' => out.push_str("\\n"),
                        c if c == mark => out.extend(['\\', c]),
                        c => out.push(c),
                    }
                }
                out.push(mark);
            }
            Self::Text(text) => out.push_str(text),
            Self::List(items) => {
                out.push('[');
                list(out, items);
                out.push(']');
            }
            Self::Tuple(items) => {
                out.push('(');
                list(out, items);
                out.push_str(if items.len() == 1 { ",)" } else { ")" });
            }
            Self::Table(entries) => {
                out.push('{');
                for (i, (key, value)) in entries.iter().enumerate() {
                    out.push_str(if i == 0 { "" } else { ", " });
                    key.write(out, true, depth + 1);
                    out.push_str(": ");
                    value.write(out, true, depth + 1);
                }
                out.push('}');
            }
            Self::Builtin(name) => out.push_str(name),
            Self::Method(_, name) => out.push_str(name),
            Self::Scope(_) => out.push_str("a namespace"),
        }
    }

    pub(super) fn equals(&self, other: &Self) -> bool {
        self.equals_within(other, &mut 0)
    }

    /// As [`Self::equals`]; counts the items that were compared.
    pub(super) fn equals_within(&self, other: &Self, count: &mut usize) -> bool {
        *count += 1;
        if *count > MOST_COMPARED {
            return false;
        }
        if let (Some(a), Some(b)) = (self.integer(), other.integer()) {
            return a == b;
        }
        if let (Some(a), Some(b)) = (self.number(), other.number()) {
            return a == b;
        }
        match (self, other) {
            (Self::None, Self::None) => true,
            (Self::Text(a), Self::Text(b)) => {
                *count += a.len() / 16;
                a == b
            }
            (Self::List(a), Self::List(b)) | (Self::Tuple(a), Self::Tuple(b)) => {
                a.len() == b.len() && a.iter().zip(b.iter()).all(|(a, b)| a.equals_within(b, count))
            }
            (Self::Table(a), Self::Table(b)) => {
                let mut has =
                    |key: &Self, value: &Self| b.iter().any(|(k, v)| k.equals_within(key, count) && v.equals_within(value, count));
                a.len() == b.len() && a.iter().all(|(key, value)| has(key, value))
            }
            (Self::Builtin(a), Self::Builtin(b)) => a == b,
            (Self::Scope(a), Self::Scope(b)) => a == b,
            _ => false,
        }
    }

    /// The order of two values; `None` if one is NaN. An error if they are not comparable.
    pub(super) fn order(&self, other: &Self) -> Result<Option<Ordering>> {
        if let (Some(a), Some(b)) = (self.integer(), other.integer()) {
            return Ok(Some(a.cmp(&b)));
        }
        if let (Some(a), Some(b)) = (self.number(), other.number()) {
            return Ok(a.partial_cmp(&b));
        }
        match (self, other) {
            (Self::Text(a), Self::Text(b)) => Ok(Some(a.cmp(b))),
            _ => wrong(format!("an order of {} and {}", self.shown(), other.shown()), "two numbers, or two texts"),
        }
    }

    /// The entry of a dictionary.
    pub(super) fn entry(&self, key: &Self) -> Option<&Self> {
        let Self::Table(entries) = self else { return None };
        entries.iter().find(|(known, _)| known.equals(key)).map(|(_, value)| value)
    }
}

/// Items with their depth: `depth` of each, plus one.
fn nested<T>(items: Vec<T>, depth: impl Fn(&T) -> u8) -> Result<Rc<Items<T>>> {
    let depth = items.iter().map(depth).max().unwrap_or_default() + 1;
    if depth > MOST_DEPTH {
        return wrong("lists nested very deeply", format!("at most {MOST_DEPTH} levels"));
    }
    Ok(Rc::new(Items { all: items.into(), depth }))
}

/// Longer texts of lists and dictionaries are cut off, bytes.
const MOST_WRITTEN: usize = 1 << 20;

/// A number as Python writes it: the fewest digits that identify it, in scientific notation below
/// 1e-4 and from 1e16 on.
fn float(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() { "nan".to_owned() } else { if value > 0.0 { "inf" } else { "-inf" }.to_owned() };
    }
    let scientific = format!("{value:e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    if value != 0.0 && !(-4..16).contains(&exponent) {
        let sign = if exponent < 0 { '-' } else { '+' };
        return format!("{digits}e{sign}{:02}", exponent.abs());
    }
    let plain = format!("{value}");
    if plain.contains('.') { plain } else { plain + ".0" }
}

/// The integer that Python's `int` reads.
pub(super) fn read_integer(text: &str) -> Option<i128> {
    let text = text.trim();
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let is_plain = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit() || b == b'_');
    if !is_plain || digits.starts_with('_') || digits.ends_with('_') || digits.contains("__") {
        return None;
    }
    text.replace('_', "").parse().ok()
}

/// The number that Python's `float` reads.
pub(super) fn read_float(text: &str) -> Option<f64> {
    let text = text.trim();
    let word = text.strip_prefix(['+', '-']).unwrap_or(text);
    let names = ["nan", "inf", "infinity"];
    if names.iter().any(|name| word.eq_ignore_ascii_case(name)) {
        return text.parse().ok();
    }
    let is_plain = text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
    text.parse().ok().filter(|_| is_plain)
}

/// A text as a truth value, as conditions read it.
pub(super) fn read_truth(text: &str) -> Option<bool> {
    match text {
        "true" | "True" => Some(true),
        "false" | "False" => Some(false),
        other => read_integer(other).map(|value| value != 0),
    }
}

/// The value of a text of a property or a parameter: a number, a truth value, the text inside a
/// single pair of `'`, or the text itself.
pub(super) fn read_literal(text: &str) -> Value {
    if text.len() >= 2 && text.starts_with('\'') && text.ends_with('\'') {
        return Value::text(&text[1..text.len() - 1]);
    }
    if text.contains('_') {
        return Value::text(text);
    }
    read_integer(text)
        .map(Value::Int)
        .or_else(|| read_float(text).map(Value::Float))
        .or_else(|| read_truth(text).map(Value::Bool))
        .unwrap_or_else(|| Value::text(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_python_writes_them() {
        let cases = [
            (0.0, "0.0"),
            (-0.0, "-0.0"),
            (1.0, "1.0"),
            (0.1, "0.1"),
            (0.0001, "0.0001"),
            (0.00001, "1e-05"),
            (1.5e-7, "1.5e-07"),
            (123456789.125, "123456789.125"),
            (1e15, "1000000000000000.0"),
            (1e16, "1e+16"),
            (1.7976931348623157e308, "1.7976931348623157e+308"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "nan"),
        ];
        for (value, text) in cases {
            assert_eq!(float(value), text);
        }
    }

    #[test]
    fn literals_of_properties_are_read_as_xacro_reads_them() {
        let cases = [
            ("1", "1"),
            (" -2 ", "-2"),
            ("1.50", "1.5"),
            ("1e3", "1000.0"),
            ("true", "True"),
            ("False", "False"),
            ("1_0", "'1_0'"),
            ("'1'", "'1'"),
            ("0x10", "'0x10'"),
            ("a b", "'a b'"),
            ("", "''"),
            ("-inf", "-inf"),
        ];
        for (text, value) in cases {
            assert_eq!(read_literal(text).literal(), value, "{text}");
        }
    }
}
