//! Values written in the macro as scenes have them: `{ name = value, … }`, `[value, …]`, numbers, words.

use articulated_codegen::scene::articulated_scene::{At, Entry, Node, Value};
use proc_macro2::Span;
use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::{Ident, LitBool, LitStr, Result, Token, braced, bracketed, token};

use crate::keys::signed;

/// Deeper values are not read: nothing in a scene is so deep.
const DEEPEST: usize = 16;

/// The spans of the words that places in a tree refer to.
#[derive(Default)]
pub(crate) struct Spans(Vec<Span>);

impl Spans {
    fn at(&mut self, span: Span) -> At {
        self.0.push(span);
        At::Word(u32::try_from(self.0.len() - 1).unwrap_or(u32::MAX))
    }

    /// The span of a place.
    pub(crate) fn of(&self, at: At) -> Option<Span> {
        match at {
            At::Word(index) => self.0.get(usize::try_from(index).ok()?).copied(),
            _ => None,
        }
    }
}

/// One value.
pub(crate) fn node(input: ParseStream, spans: &mut Spans) -> Result<Node> {
    within(input, spans, 0)
}

fn within(input: ParseStream, spans: &mut Spans, depth: usize) -> Result<Node> {
    let at = spans.at(input.span());
    if depth > DEEPEST {
        return Err(input.error("too deep"));
    }
    let value = if input.peek(token::Brace) {
        Value::Table(entries(input, spans, depth)?)
    } else if input.peek(token::Bracket) {
        Value::List(items(input, spans, depth)?)
    } else if input.peek(LitStr) {
        Value::Text(input.parse::<LitStr>()?.value())
    } else if input.peek(LitBool) {
        Value::Bool(input.parse::<LitBool>()?.value)
    } else if input.peek(Ident::peek_any) {
        Value::Text(Ident::parse_any(input)?.unraw().to_string())
    } else {
        // Finite or not: the scene's reader says what it has to be.
        Value::Number(signed(input)?)
    };
    Ok(Node { at, value })
}

fn entries(input: ParseStream, spans: &mut Spans, depth: usize) -> Result<Vec<Entry>> {
    let content;
    braced!(content in input);
    let mut entries: Vec<Entry> = Vec::new();
    while !content.is_empty() {
        let span = content.span();
        let name = if content.peek(LitStr) { content.parse::<LitStr>()?.value() } else { Ident::parse_any(&content)?.unraw().to_string() };
        if entries.iter().any(|entry| entry.name == name) {
            return Err(syn::Error::new(span, "given twice"));
        }
        content.parse::<Token![=]>()?;
        let at = spans.at(span);
        entries.push(Entry { name, at, node: within(&content, spans, depth + 1)? });
        comma(&content)?;
    }
    Ok(entries)
}

fn items(input: ParseStream, spans: &mut Spans, depth: usize) -> Result<Vec<Node>> {
    let content;
    bracketed!(content in input);
    let mut items = Vec::new();
    while !content.is_empty() {
        items.push(within(&content, spans, depth + 1)?);
        comma(&content)?;
    }
    Ok(items)
}

fn comma(content: ParseStream) -> Result<()> {
    if content.is_empty() { Ok(()) } else { content.parse::<Token![,]>().map(|_| ()) }
}
