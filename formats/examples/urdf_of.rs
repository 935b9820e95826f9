//! Writes the robot of a file as a plain URDF: the expansion of a xacro file.
//!
//! ```text
//! cargo run -p articulated-formats --example urdf_of -- FILE [--arg NAME=VALUE]
//!     [--package NAME=FOLDER]
//! ```

use std::process::ExitCode;

use articulated_formats::{Disk, MOST_BYTES, Options, read_file, read_with, urdf};

fn main() -> ExitCode {
    let mut options = Options { allow_unphysical_inertia: true, ..Options::default() };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let pair =
            |value: Option<String>| value.and_then(|value| value.split_once('=').map(|(name, value)| (name.to_owned(), value.to_owned())));
        match word.as_str() {
            "--arg" => options.arguments.extend(pair(words.next())),
            "--package" => options.packages.extend(pair(words.next()).map(|(name, folder)| (name, folder.into()))),
            file => options.file = file.to_owned(),
        }
    }
    let bytes = match read_file(options.file.as_ref(), MOST_BYTES) {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("{}: {error}", options.file);
            return ExitCode::FAILURE;
        }
    };
    match read_with(&Disk, &bytes, &options) {
        Ok(reading) => {
            reading.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
            print!("{}", urdf::write(&reading.description));
            ExitCode::SUCCESS
        }
        Err(diagnostics) => {
            eprintln!("{diagnostics}");
            ExitCode::FAILURE
        }
    }
}
