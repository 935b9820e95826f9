//! XML for all formats: bytes to a document, tags with their lines, numbers in attributes.

pub(crate) mod document;
pub(crate) mod element;
pub(crate) mod lines;
pub(crate) mod markup;
pub(crate) mod number;
pub(crate) mod tree;
