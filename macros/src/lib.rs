//! The macro `robot!`: a thin shell around `articulated-codegen`.

/// Not yet.
#[proc_macro]
pub fn robot(_input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    proc_macro::TokenStream::new()
}
