//! `key = value, …`: the body of the macro, and the tables inside it.

use articulated_codegen::nearest;
use proc_macro2::{Span, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser};
use syn::{Error, Ident, Result, Token, braced, bracketed, token};

use crate::errors::Errors;

/// One key of a table that is read into a `T`.
pub(crate) struct Key<T> {
    /// Its name.
    pub(crate) name: &'static str,
    /// Whether it has to be there.
    pub(crate) required: bool,
    /// What its value has to be.
    pub(crate) expected: &'static str,
    /// Reads the value into the table. Only that it fails matters, not how: the message is `expected`.
    pub(crate) read: fn(&mut T, ParseStream) -> Result<()>,
}

/// A key, and another that may say the same.
const INSTEAD: &[(&str, &str)] = &[("urdf", "scene")];

/// Reads the entries up to the end. What is missing is reported at `span`.
pub(crate) fn entries<T: Default>(input: ParseStream, keys: &[Key<T>], span: Span, errors: &mut Errors) -> T {
    let mut table = Table { keys, value: T::default(), seen: Vec::new() };
    while !input.is_empty() {
        let result = table.entry(input);
        errors.take(result);
    }
    let said = |name: &str| table.seen.contains(&name) || INSTEAD.iter().any(|(key, other)| *key == name && table.seen.contains(other));
    for key in keys.iter().filter(|key| key.required && !said(key.name)) {
        errors.push(Error::new(span, format!("`{}` is missing: expected {}", key.name, key.expected)));
    }
    table.value
}

/// One table in braces, or a list of them in brackets.
pub(crate) fn tables<T: Default>(input: ParseStream, keys: &[Key<T>], errors: &mut Errors) -> Result<Vec<T>> {
    if !input.peek(token::Bracket) {
        return Ok(vec![table(input, keys, errors)?]);
    }
    let list;
    bracketed!(list in input);
    let mut tables = Vec::new();
    while !list.is_empty() {
        tables.push(table(&list, keys, errors)?);
        if !list.is_empty() {
            list.parse::<Token![,]>()?;
        }
    }
    Ok(tables)
}

fn table<T: Default>(input: ParseStream, keys: &[Key<T>], errors: &mut Errors) -> Result<T> {
    let content;
    let braces = braced!(content in input);
    Ok(entries(&content, keys, braces.span.join(), errors))
}

struct Table<'a, T> {
    keys: &'a [Key<T>],
    value: T,
    seen: Vec<&'static str>,
}

impl<T> Table<'_, T> {
    /// Reads `key = value` and the comma after it. Always consumes something.
    fn entry(&mut self, input: ParseStream) -> Result<()> {
        let key = self.key(input);
        let value = until_comma(input);
        self.set(&key?, &value)
    }

    fn key(&self, input: ParseStream) -> Result<Ident> {
        let key = Ident::parse_any(input).map_err(|e| Error::new(e.span(), format!("expected a key: {}", self.listed())))?;
        input.parse::<Token![=]>().map_err(|e| Error::new(e.span(), format!("expected `=` after `{key}`")))?;
        Ok(key)
    }

    fn set(&mut self, key: &Ident, value: &TokenStream) -> Result<()> {
        let row = self.keys.iter().find(|row| key == row.name).ok_or_else(|| self.unknown(key))?;
        if self.seen.contains(&row.name) {
            return Err(Error::new(key.span(), format!("`{key}` is given twice")));
        }
        self.seen.push(row.name);
        let expected = format!("`{key}`: expected {}", row.expected);
        if value.is_empty() {
            return Err(Error::new(key.span(), expected));
        }
        let read = |input: ParseStream| {
            (row.read)(&mut self.value, input).map_err(|_| Error::new_spanned(value, expected))?;
            if input.is_empty() { Ok(()) } else { Err(input.error("expected `,`")) }
        };
        read.parse2(value.clone())
    }

    fn unknown(&self, key: &Ident) -> Error {
        let nearest = nearest(&key.to_string(), self.keys.iter().map(|row| row.name));
        let meant = nearest.map(|n| format!("did you mean `{n}`? ")).unwrap_or_default();
        Error::new(key.span(), format!("unknown key `{key}`, {meant}there are: {}", self.listed()))
    }

    fn listed(&self) -> String {
        self.keys.iter().map(|row| row.name).collect::<Vec<_>>().join(", ")
    }
}

/// The tokens up to the next comma, or to the end; the comma is consumed.
fn until_comma(input: ParseStream) -> TokenStream {
    let mut tokens = TokenStream::new();
    while !input.is_empty() && !input.peek(Token![,]) {
        tokens.extend(input.parse::<TokenTree>());
    }
    let _ = input.parse::<Option<Token![,]>>();
    tokens
}
