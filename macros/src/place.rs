//! Errors of the generator: where they show, and how to go on.

use articulated_codegen::{Error, Options};
use proc_macro2::Span;
use syn::LitStr;

use crate::errors::Errors;
use crate::settings::Settings;

/// The error at the word of the invocation that it is about: a function, a new name, otherwise the URDF.
pub(crate) fn at_its_word(error: &Error, settings: &Settings, urdf: &LitStr) -> syn::Error {
    let renamed = |name: &String| settings.rename.iter().find(|r| r.from.value() == *name);
    let span = match error {
        Error::Urdf(problems) => return each(problems, urdf.span()),
        Error::UnknownFunction { found: function, .. } | Error::Singular { function, .. } => function_span(function, settings),
        Error::Rename { from, .. } => renamed(from).map(|r| r.from.span()),
        Error::NameClash { first, second, .. } => renamed(second).or_else(|| renamed(first)).map(|r| r.to.span()),
        _ => None,
    };
    syn::Error::new(span.unwrap_or_else(|| urdf.span()), error)
}

fn function_span(function: &str, settings: &Settings) -> Option<Span> {
    settings.functions.iter().flatten().find(|name| *name == function).map(syn::Ident::span)
}

/// One error for each mistake in the document.
fn each(problems: &articulated_codegen::urdf::Problems, span: Span) -> syn::Error {
    let mut errors = Errors::default();
    for problem in &problems.errors {
        errors.push(syn::Error::new(span, problem));
    }
    errors.into_error().unwrap_or_else(|| syn::Error::new(span, problems))
}

/// Takes out of the options what `error` is about, or names it otherwise; whether there was such a thing.
pub(crate) fn leave_out(error: &Error, options: &mut Options) -> bool {
    let before = options.clone();
    match error {
        Error::UnknownFunction { found: function, .. } | Error::Singular { function, .. } => options.functions.retain(|f| f != function),
        Error::Rename { from, to, .. } => options.rename.retain(|(f, t)| (f, t) != (from, to)),
        Error::NameClash { second, ident, .. } => {
            let count = options.rename.len();
            options.rename.retain(|(from, _)| from != second);
            options.rename.push((second.clone(), format!("{ident}__{count}")));
        }
        _ => {}
    }
    *options != before
}
