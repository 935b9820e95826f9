//! From an invocation to a module.

use std::env;
use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

use articulated_codegen::Request;
use proc_macro2::TokenStream;
use quote::quote;
use syn::{Error, LitStr, Result};

use crate::errors::Errors;
use crate::invocation::Invocation;
use crate::place;
use crate::settings::Settings;

/// So many errors of the generator are looked for; the mistakes in a URDF count as one.
const MOST_ERRORS: usize = 100;

/// The module, or one with as much as could be made and the errors.
pub(crate) fn expand(input: TokenStream) -> TokenStream {
    match syn::parse2(input) {
        Ok(invocation) => module(invocation),
        Err(error) => error.into_compile_error(),
    }
}

fn module(invocation: Invocation) -> TokenStream {
    let Invocation { attributes, visibility, module, name, settings, mut errors } = invocation;
    let contents = contents(&settings, &mut errors);
    let errors = errors.into_items();
    // Lints about style are for code that somebody writes. First, so that the user's attributes have the last word.
    let allow = quote! { #[allow(clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction)] };
    quote! { #allow #(#attributes)* #visibility #module #name { #errors #contents } }
}

/// The generated source and a mention of every URDF, by which the compiler knows that the module depends on them.
fn contents(settings: &Settings, errors: &mut Errors) -> TokenStream {
    let Some(urdf) = &settings.urdf else { return TokenStream::new() };
    let names = [urdf].into_iter().chain(settings.append.iter().filter_map(|other| other.urdf.as_ref()));
    let files: Vec<Option<File>> = names.map(|name| errors.take(File::read(name))).collect();
    let paths: Vec<String> = files.iter().flatten().map(|file| file.path.clone()).collect();
    let source = files.into_iter().collect::<Option<Vec<_>>>().map(|files| {
        let mut bytes = files.into_iter().map(|file| file.bytes);
        let mut request = Request { urdf: bytes.next().unwrap_or_default(), file: urdf.value(), options: settings.options() };
        request.options.append.iter_mut().zip(bytes).for_each(|(other, bytes)| other.urdf = bytes);
        source(request, settings, urdf, errors)
    });
    quote! { #source #(const _: &[u8] = ::core::include_bytes!(#paths);)* }
}

/// The generated source. What is wrong is reported and left out, and the rest tried again: so every error shows, and only those.
fn source(mut request: Request, settings: &Settings, urdf: &LitStr, errors: &mut Errors) -> TokenStream {
    for _ in 0..MOST_ERRORS {
        let error = match articulated_codegen::generate(&request) {
            Ok(generated) => return generated.tokens(),
            Err(error) => error,
        };
        errors.push(place::at_its_word(&error, settings, urdf));
        if !place::leave_out(&error, &mut request.options) {
            break;
        }
    }
    TokenStream::new()
}

/// A URDF.
struct File {
    path: String,
    bytes: Vec<u8>,
}

impl File {
    /// The file that `name` names, from the folder of the user's Cargo.toml.
    fn read(name: &LitStr) -> Result<Self> {
        let wrong = |reason: &str| Error::new(name.span(), format!("{}: {reason}", name.value()));
        let root = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
        let path = root.join(name.value());
        let bytes = fs::read(&path).map_err(|error| match error.kind() {
            ErrorKind::NotFound => wrong("there is no such file, seen from the folder of Cargo.toml"),
            _ => wrong(&error.to_string()),
        })?;
        let path = path.into_os_string().into_string().map_err(|_| wrong("the path of the package is not UTF-8"))?;
        Ok(Self { path, bytes })
    }
}
