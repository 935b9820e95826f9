//! Reads URDF files and prints all findings: `check [--floating] [--unused] file.urdf …`. The
//! status is 1 if any file is refused.

use std::process::ExitCode;

use articulated_core::description::Base;
use articulated_formats::{Options, read};

fn main() -> ExitCode {
    let (flags, files): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|a| a.starts_with("--"));
    let has = |flag: &str| flags.iter().any(|f| f == flag);
    let base = if has("--floating") { Base::Floating } else { Base::Fixed };
    let refused = files.iter().filter(|file| !check(file, base, has("--unused"))).count();
    ExitCode::from(u8::from(refused > 0))
}

fn check(file: &str, base: Base, unused: bool) -> bool {
    let options = Options { file: file.to_owned(), base, ..Options::default() };
    let bytes = match articulated_formats::read_file(file.as_ref(), articulated_formats::MOST_BYTES) {
        Ok(bytes) => bytes,
        Err(error) => {
            println!("error: {file}: {error}");
            return false;
        }
    };
    let start = std::time::Instant::now();
    let result = read(&bytes, &options);
    let time = start.elapsed();
    match result {
        Ok(reading) => {
            reading.warnings.iter().for_each(|w| println!("warning: {w}"));
            reading.unused.iter().filter(|_| unused).for_each(|u| println!("unused: {u}"));
            let (links, joints) = (reading.description.links.len(), reading.description.joints.len());
            println!("{file}: {links} links, {joints} joints, {time:.1?}");
            true
        }
        Err(problems) => {
            println!("{problems}");
            false
        }
    }
}
