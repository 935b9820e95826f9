//! The grammar: attributes, visibility, `mod name { key = value, … }`.

use proc_macro2::TokenStream;
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Error, Ident, Result, Token, Visibility, braced};

use crate::errors::Errors;
use crate::settings::Settings;

/// One `robot! { … }`.
pub(crate) struct Invocation {
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) visibility: Visibility,
    pub(crate) module: Token![mod],
    pub(crate) name: Ident,
    pub(crate) settings: Settings,
    /// Errors of the keys and their values.
    pub(crate) errors: Errors,
}

impl Parse for Invocation {
    fn parse(input: ParseStream) -> Result<Self> {
        let attributes = input.call(Attribute::parse_outer)?;
        let (visibility, module, name) = (input.parse()?, input.parse()?, input.parse::<Ident>()?);
        let content;
        braced!(content in input);
        let mut errors = Errors::default();
        let settings = Settings::read(content.parse()?, name.span(), &mut errors);
        let rest: TokenStream = input.parse()?;
        if !rest.is_empty() {
            errors.push(Error::new_spanned(rest, "one `robot!` makes one module"));
        }
        Ok(Self { attributes, visibility, module, name, settings, errors })
    }
}
