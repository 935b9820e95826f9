//! Arguments and results of a batch.

use articulated_core::algorithm::{Dim, Shape};

use crate::emit::function::signature::Signature;

/// An argument or a result, one for each state.
pub(super) struct Array {
    pub(super) name: String,
    dims: Vec<Dim>,
    /// How many numbers.
    pub(super) numbers: usize,
}

impl Array {
    fn new(name: &str, dims: &[Dim], sizes: Shape) -> Self {
        Self { name: name.to_owned(), dims: dims.to_vec(), numbers: dims.iter().map(|d| d.len(sizes)).product() }
    }

    /// How many numbers, as an expression.
    pub(super) fn len(&self) -> String {
        let lengths: Vec<String> = self.dims.iter().map(Dim::to_string).collect();
        if lengths.is_empty() { "1".into() } else { lengths.join(" * ") }
    }

    /// Its type for one state or block.
    pub(super) fn nested(&self, of: &str) -> String {
        self.dims.iter().rev().fold(of.to_owned(), |inner, dim| format!("[{inner}; {dim}]"))
    }

    /// The slice of all states as a slice of flat arrays.
    pub(super) fn flat(&self, mutable: bool) -> String {
        let m = if mutable { "_mut" } else { "" };
        match self.dims.len() {
            0 => format!("{}.as_chunks{m}::<1>().0", self.name),
            1 => self.name.clone(),
            n => format!("{}{}.as_chunks{m}::<{{ {} }}>().0", self.name, format!(".as_flattened{m}()").repeat(n), self.len()),
        }
    }
}

/// What a function takes.
pub(super) fn inputs(signature: &Signature, sizes: Shape) -> Vec<Array> {
    signature.wanted.arguments().iter().map(|a| Array::new(a.name(), a.dims(), sizes)).collect()
}

/// What it gives.
pub(super) fn results(signature: &Signature, sizes: Shape) -> Vec<Array> {
    let parts = &signature.wanted.parts;
    let name = |f: &'static str| if parts.len() == 1 { "out" } else { f };
    parts.iter().map(|p| Array::new(name(p.function.name), p.function.gives, sizes)).collect()
}

/// A text for each array, with its name in the place of `NAME` and its number of numbers in that of `LEN`.
pub(super) fn each(arrays: &[Array], text: &str) -> String {
    arrays.iter().map(|a| text.replace("NAME", &a.name).replace("LEN", &a.len())).collect()
}
