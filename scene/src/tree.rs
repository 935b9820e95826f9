//! A scene before it is understood: tables, lists, numbers and words, each with its place. TOML and
//! the macro's tokens both become this.

use articulated_core::diagnostic::{At, quote};

/// A value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Its place.
    pub at: At,
    /// The value itself.
    pub value: Value,
}

/// Kinds of values.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// A number, perhaps not a finite one.
    Number(f64),
    /// A text.
    Text(String),
    /// `[a, b, …]`
    List(Vec<Node>),
    /// `{ name = value, … }`, in the order in which it is written.
    Table(Vec<Entry>),
    /// Something that no scene has, in words: a date.
    Other(String),
}

/// `name = value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The name.
    pub name: String,
    /// Its place.
    pub at: At,
    /// The value.
    pub node: Node,
}

impl Node {
    /// The same without its places.
    pub(crate) fn without_places(self) -> Self {
        let value = match self.value {
            Value::List(list) => Value::List(list.into_iter().map(Self::without_places).collect()),
            Value::Table(entries) => {
                let entries = entries.into_iter().map(|entry| Entry { at: At::Nowhere, node: entry.node.without_places(), ..entry });
                Value::Table(entries.collect())
            }
            value => value,
        };
        Self { at: At::Nowhere, value }
    }
}

impl Value {
    /// Description for a message.
    pub fn describe(&self) -> String {
        match self {
            Self::Bool(b) => b.to_string(),
            Self::Number(x) => format!("{x:?}"),
            Self::Text(text) => format!("the text {}", quote(text)),
            Self::List(list) => match list.iter().all(|n| matches!(n.value, Self::Number(_))) {
                true if list.len() == 1 => "a list of one number".into(),
                true if !list.is_empty() => format!("a list of {} numbers", list.len()),
                _ => "a list".into(),
            },
            Self::Table(_) => "a table".into(),
            Self::Other(words) => words.clone(),
        }
    }
}
