//! Names that a function cannot have in Rust.

use crate::FunctionSpec;

/// Why a function cannot have its name, if it cannot.
pub(in crate::language) fn refuses_name(function: &FunctionSpec) -> Option<String> {
    let (name, group) = (function.name.as_str(), function.group());
    // The type of several results has the name of the function: `self_` would be `Self`.
    if is_keyword(name) || name.trim_end_matches('_') == "self" {
        return Some("is a reserved word of Rust: expected another name".into());
    }
    let is_type = TYPES.split_whitespace().any(|word| group.as_deref() == Some(word));
    let is_kept = is_type || RESERVED.split_whitespace().any(|word| word == name);
    is_kept.then(|| "is kept for a part of the generated module: expected another name".into())
}

/// Whether Rust keeps the word for itself.
pub fn is_keyword(word: &str) -> bool {
    KEYWORDS.split_whitespace().any(|keyword| keyword == word)
}

const KEYWORDS: &str = "as async await break const continue crate dyn else enum extern false fn for gen if impl in let loop match mod move mut pub \
                        ref return self static struct super trait true try type unsafe use where while abstract become box do final macro \
                        override priv typeof unsized virtual yield";

/// Names of the generated module, except those of arguments and results.
const RESERVED: &str = "out parameters batch_f64 batch_f32";

/// The type of the generated module, except those of several results.
const TYPES: &str = "Robot";
