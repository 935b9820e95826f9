//! The content of the macro's braces, in the form of scenes: `key = value, …`. A value is a number,
//! a word, a text, `[value, …]`, `{ name = value, … }`; for some keys it is an expression, which is
//! a text here and is parsed elsewhere: `hold = inverse_dynamics(v = 0)`.

use std::collections::BTreeSet;
use std::fmt::Display;

use articulated_codegen::diagnostic::At;
use articulated_codegen::scene::articulated_scene::{Entry, Node, Value};
use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser};
use syn::{Error, Ident, Lit, LitBool, LitStr, Result, Token};

use crate::errors::Errors;

/// Deeper values are not read; no scene has such values.
const DEEPEST: usize = 16;

/// Keys whose values, or the items of their lists, are expressions.
const EXPRESSIONS: [&str; 4] = ["functions", "parameters", "level", "crate"];

/// The words that places in a tree refer to.
pub(crate) struct Places {
    words: Vec<TokenStream>,
    /// Collector of errors without a place.
    elsewhere: Span,
}

impl Places {
    /// An empty list.
    pub(crate) fn new(elsewhere: Span) -> Self {
        Self { words: Vec::new(), elsewhere }
    }

    fn at(&mut self, word: TokenStream) -> At {
        self.words.push(word);
        At::Word(u32::try_from(self.words.len() - 1).unwrap_or(u32::MAX))
    }

    /// Where an item that is made for a place is shown.
    pub(crate) fn span(&self, at: At) -> Span {
        let word = if let At::Word(index) = at { self.words.get(index as usize) } else { None };
        word.and_then(|word| word.clone().into_iter().next()).map_or(self.elsewhere, |token| token.span())
    }

    /// An error at a place.
    pub(crate) fn error(&self, at: At, message: impl Display) -> Error {
        let word = if let At::Word(index) = at { self.words.get(index as usize) } else { None };
        word.map_or_else(|| Error::new(self.elsewhere, &message), |word| Error::new_spanned(word, &message))
    }
}

/// A reader of tokens.
pub(crate) struct Tree<'a> {
    pub(crate) places: &'a mut Places,
    /// Collector of errors; unreadable entries are reported here and left out.
    pub(crate) errors: &'a mut Errors,
    /// The keys that were found, including those with unreadable values.
    pub(crate) keys: BTreeSet<String>,
}

/// How a value may be written.
#[derive(Clone, Copy)]
struct Form {
    depth: usize,
    is_expression: bool,
}

impl<'a> Tree<'a> {
    pub(crate) fn new(places: &'a mut Places, errors: &'a mut Errors) -> Self {
        Self { places, errors, keys: BTreeSet::new() }
    }

    /// The keys of an invocation with their values.
    pub(crate) fn read(&mut self, tokens: TokenStream) -> Node {
        let at = At::Nowhere;
        Node { at, value: Value::Table(self.entries(tokens, 0)) }
    }

    fn entries(&mut self, tokens: TokenStream, depth: usize) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        for said in self.between_commas(tokens) {
            let entry = self.entry(said, depth);
            let Some(entry) = self.errors.take(entry) else { continue };
            if entries.iter().any(|other| other.name == entry.name) {
                self.errors.push(self.places.error(entry.at, format!("`{}` is given twice", entry.name)));
            } else {
                entries.push(entry);
            }
        }
        entries
    }

    /// `name = value`
    fn entry(&mut self, tokens: TokenStream, depth: usize) -> Result<Entry> {
        // A key without its sign counts as present: it is not reported as missing too.
        let first: TokenStream = tokens.clone().into_iter().take(1).collect();
        let named = quoted.parse2(first.clone()).or_else(|_| plain.parse2(first));
        self.keys.extend(named.ok().filter(|_| depth == 0));
        let (word, name, value) = key.parse2(tokens)?;
        if value.is_empty() {
            return Err(Error::new_spanned(word, format!("expected a value after `{name} =`")));
        }
        let form = Form { depth, is_expression: depth == 0 && EXPRESSIONS.contains(&name.as_str()) };
        // Only in lists have expressions a name.
        let mut pairs = value.clone().into_iter().zip(value.clone().into_iter().skip(1));
        match pairs.find(|(_, next)| is(next, '=')) {
            Some((before, _)) => Err(Error::new(before.span(), COMMA)),
            None => Ok(Entry { name, at: self.places.at(word), node: self.node(value, form)? }),
        }
    }

    fn node(&mut self, tokens: TokenStream, form: Form) -> Result<Node> {
        if form.depth > DEEPEST {
            return Err(Error::new_spanned(tokens, "too deep"));
        }
        let at = self.places.at(tokens.clone());
        Ok(Node { at, value: self.value(&tokens, form)? })
    }

    fn value(&mut self, tokens: &TokenStream, form: Form) -> Result<Value> {
        let deeper = Form { depth: form.depth + 1, ..form };
        match group(tokens) {
            Some((Delimiter::Brace, entries)) => Ok(Value::Table(self.entries(entries, deeper.depth))),
            Some((Delimiter::Bracket, items)) => Ok(Value::List(self.items(items, deeper))),
            _ => scalar(tokens).map_or_else(|| several(tokens, form), Ok),
        }
    }

    fn items(&mut self, tokens: TokenStream, form: Form) -> Vec<Node> {
        let mut items = Vec::new();
        for said in self.between_commas(tokens) {
            let item = self.node(said, form);
            items.extend(self.errors.take(item));
        }
        items
    }

    /// The tokens between commas; a trailing comma is allowed.
    fn between_commas(&mut self, tokens: TokenStream) -> Vec<TokenStream> {
        let (mut all, mut said) = (Vec::new(), TokenStream::new());
        for token in tokens {
            if !is(&token, ',') {
                said.extend([token]);
            } else if said.is_empty() {
                self.errors.push(Error::new(token.span(), "nothing before the comma"));
            } else {
                all.push(std::mem::take(&mut said));
            }
        }
        all.extend(Some(said).filter(|rest| !rest.is_empty()));
        all
    }
}

const COMMA: &str = "expected `,`";

fn is(token: &TokenTree, c: char) -> bool {
    matches!(token, TokenTree::Punct(mark) if mark.as_char() == c)
}

/// A name: its tokens, its text, and the tokens after its sign.
fn key(input: ParseStream) -> Result<(TokenStream, String, TokenStream)> {
    let word: TokenStream = input.parse::<TokenTree>()?.into();
    let name = quoted.parse2(word.clone()).or_else(|_| plain.parse2(word.clone()));
    let name = name.map_err(|_| Error::new_spanned(&word, "expected a name, as in `name = value`"))?;
    input.parse::<Token![=]>().map_err(|error| Error::new(error.span(), format!("expected `=` after `{name}`")))?;
    Ok((word, name, input.parse()?))
}

/// The brackets and their content, if the tokens are one group.
fn group(tokens: &TokenStream) -> Option<(Delimiter, TokenStream)> {
    let mut tokens = tokens.clone().into_iter();
    match (tokens.next()?, tokens.next()) {
        (TokenTree::Group(group), None) if group.delimiter() == Delimiter::None => self::group(&group.stream()),
        (TokenTree::Group(group), None) => Some((group.delimiter(), group.stream())),
        _ => None,
    }
}

/// A text, `true` or `false`, a number, a word.
fn scalar(tokens: &TokenStream) -> Option<Value> {
    let text = |input: ParseStream| quoted(input).map(Value::Text);
    let truth = |input: ParseStream| Ok(Value::Bool(input.parse::<LitBool>()?.value));
    let number = |input: ParseStream| number(input).map(Value::Number);
    let word = |input: ParseStream| plain(input).map(Value::Text);
    let read = text.parse2(tokens.clone()).or_else(|_| truth.parse2(tokens.clone()));
    read.or_else(|_| number.parse2(tokens.clone())).or_else(|_| word.parse2(tokens.clone())).ok()
}

fn quoted(input: ParseStream) -> Result<String> {
    Ok(input.parse::<LitStr>()?.value())
}

fn plain(input: ParseStream) -> Result<String> {
    Ok(Ident::parse_any(input)?.unraw().to_string())
}

/// A number, finite or not, with or without a sign. Units are not guessed from a suffix: `90deg` is
/// not a number.
fn number(input: ParseStream) -> Result<f64> {
    let sign = if input.parse::<Option<Token![-]>>()?.is_some() { -1.0 } else { 1.0 };
    let literal: Lit = input.parse()?;
    let (number, suffix): (f64, &str) = match &literal {
        Lit::Float(x) => (x.base10_parse()?, x.suffix()),
        Lit::Int(x) => (x.base10_parse()?, x.suffix()),
        _ => return Err(Error::new(literal.span(), "not a number")),
    };
    if matches!(suffix, "" | "f64") { Ok(sign * number) } else { Err(Error::new(literal.span(), "a unit")) }
}

/// Other tokens: an expression where one is allowed, otherwise an error.
fn several(tokens: &TokenStream, form: Form) -> Result<Value> {
    let mut each = tokens.clone().into_iter();
    let (first, second) = (each.next(), each.next());
    let begins = matches!(&first, Some(TokenTree::Ident(_))) || first.as_ref().is_some_and(|first| is(first, ':'));
    match second {
        _ if begins && form.is_expression => Ok(Value::Text(tokens.to_string())),
        Some(second) if !first.is_some_and(|first| is(&first, '-')) => {
            Err(Error::new(second.span(), format!("{COMMA}; names that are no words stand in quotation marks")))
        }
        _ => Ok(Value::Other(format!("`{tokens}`"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_tokens_are_the_nearest_doubles() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let doubles = std::iter::repeat_with(|| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        });
        for x in doubles.filter(|x| x.is_finite()).take(100_000) {
            for text in [format!("{x:?}"), format!("{x:.16e}")] {
                let tokens: TokenStream = text.parse().unwrap();
                assert!(matches!(scalar(&tokens), Some(Value::Number(y)) if y.to_bits() == x.to_bits()), "{text}");
            }
        }
    }
}
