//! Languages: each prints functions of the intermediate representation.

pub(crate) mod rust;
