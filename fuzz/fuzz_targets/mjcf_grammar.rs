//! Documents of the right tags and attributes, mostly in the right places: each is a robot or a
//! list of mistakes.
#![no_main]

use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_formats::mjcf::Mjcf;
use articulated_formats::{Formats, Options, read};
use libfuzzer_sys::fuzz_target;

#[path = "../../formats/tests/corpus/grammar.rs"]
mod grammar;

fuzz_target!(|bytes: &[u8]| {
    let text = grammar::document(bytes);
    match read(text.as_bytes(), &Options { formats: Formats(&[&Mjcf]), ..Options::default() }) {
        Ok(reading) => drop(Model::<f64>::new(&reading.description, Base::Fixed)),
        Err(problems) => assert!(!problems.errors.is_empty()),
    }
});
