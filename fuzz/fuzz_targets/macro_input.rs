//! Any tokens are a module, or errors at the words that they are about. A crate of macros gives
//! nobody its functions: its modules are part of this one.
#![no_main]
#![allow(dead_code)]

use libfuzzer_sys::fuzz_target;

#[path = "../../macros/src/errors.rs"]
mod errors;
#[path = "../../macros/src/expand.rs"]
mod expand;
#[path = "../../macros/src/invocation.rs"]
mod invocation;
#[path = "../../macros/src/settings.rs"]
mod settings;
#[path = "../../macros/src/tree.rs"]
mod tree;

fuzz_target!(|text: &str| {
    let Ok(tokens) = text.parse::<proc_macro2::TokenStream>() else { return };
    let expanded = expand::expand(tokens);
    assert!(syn::parse2::<syn::File>(expanded).is_ok());
});
