//! The grammar: attributes, visibility, `mod name { key = value, … }`.

use articulated_codegen::nearest;
use proc_macro2::{TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream, Parser};
use syn::{Attribute, Error, Ident, Result, Token, Visibility, braced};

use crate::errors::Errors;
use crate::keys::{KEYS, Key};
use crate::settings::Settings;

/// One `robot! { … }`.
pub(crate) struct Invocation {
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) visibility: Visibility,
    pub(crate) module: Token![mod],
    pub(crate) name: Ident,
    pub(crate) settings: Settings,
    /// What is wrong with the keys and their values.
    pub(crate) errors: Errors,
}

impl Parse for Invocation {
    fn parse(input: ParseStream) -> Result<Self> {
        let attributes = input.call(Attribute::parse_outer)?;
        let (visibility, module, name) = (input.parse()?, input.parse()?, input.parse()?);
        let content;
        braced!(content in input);
        let mut keys = Keys::default();
        while !content.is_empty() {
            keys.entry(&content);
        }
        let Keys { settings, errors, .. } = keys.checked(&name);
        let mut invocation = Self { attributes, visibility, module, name, settings, errors };
        let rest: TokenStream = input.parse()?;
        if !rest.is_empty() {
            invocation.errors.push(Error::new_spanned(rest, "one `robot!` makes one module"));
        }
        Ok(invocation)
    }
}

/// The keys so far.
#[derive(Default)]
struct Keys {
    settings: Settings,
    errors: Errors,
    seen: Vec<&'static str>,
}

impl Keys {
    /// Reads `key = value` and the comma after it. Always consumes something.
    fn entry(&mut self, input: ParseStream) {
        let key = key(input);
        let value = until_comma(input);
        let result = key.and_then(|key| self.set(&key, &value));
        self.errors.take(result);
    }

    fn set(&mut self, key: &Ident, value: &TokenStream) -> Result<()> {
        let row = KEYS.iter().find(|row| key == row.name).ok_or_else(|| unknown(key))?;
        if self.seen.contains(&row.name) {
            return Err(Error::new(key.span(), format!("`{key}` is given twice")));
        }
        self.seen.push(row.name);
        self.read(row, key, value)
    }

    fn read(&mut self, row: &Key, key: &Ident, value: &TokenStream) -> Result<()> {
        let expected = format!("`{key}`: expected {}", row.expected);
        if value.is_empty() {
            return Err(Error::new(key.span(), expected));
        }
        let read = |input: ParseStream| {
            (row.read)(&mut self.settings, input).map_err(|_| Error::new_spanned(value, expected))?;
            if input.is_empty() { Ok(()) } else { Err(input.error("expected `,`")) }
        };
        read.parse2(value.clone())
    }

    /// With what can only be told at the end.
    fn checked(mut self, name: &Ident) -> Self {
        self.settings.check(&mut self.errors);
        if !self.seen.contains(&"urdf") {
            self.errors
                .push(Error::new(name.span(), "`urdf` is missing: say urdf = \"…\", the path of a URDF from the folder of Cargo.toml"));
        }
        self
    }
}

fn key(input: ParseStream) -> Result<Ident> {
    let key = Ident::parse_any(input).map_err(|e| Error::new(e.span(), format!("expected a key: {}", listed())))?;
    input.parse::<Token![=]>().map_err(|e| Error::new(e.span(), format!("expected `=` after `{key}`")))?;
    Ok(key)
}

fn unknown(key: &Ident) -> Error {
    let nearest = nearest(&key.to_string(), KEYS.iter().map(|row| row.name));
    let meant = nearest.map(|n| format!(", did you mean `{n}`?")).unwrap_or_default();
    Error::new(key.span(), format!("unknown key `{key}`{meant}; there are: {}", listed()))
}

fn listed() -> String {
    KEYS.iter().map(|row| row.name).collect::<Vec<_>>().join(", ")
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
