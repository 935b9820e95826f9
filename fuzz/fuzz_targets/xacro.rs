//! Any bytes are a robot or a list of mistakes. Each file that they include has the same bytes.
#![no_main]

use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_formats::{Options, Sources, read_with};
use libfuzzer_sys::fuzz_target;

struct Same<'a>(&'a [u8]);

impl Sources for Same<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        match path.file_name() {
            Some(name) if name == "package.xml" => Err(Error::new(ErrorKind::NotFound, "no such file")),
            _ => Ok(self.0.to_vec()),
        }
    }

    fn list(&self, _folder: &Path) -> Result<Vec<String>> {
        Ok(vec!["a.xacro".to_owned(), "b.xacro".to_owned()])
    }

    fn package(&self, name: &str) -> Option<PathBuf> {
        (name.len() % 2 == 0).then(|| name.into())
    }
}

fuzz_target!(|bytes: &[u8]| {
    let options = Options { file: "robot.xacro".to_owned(), ..Options::default() };
    match read_with(&Same(bytes), bytes, &options) {
        Ok(reading) => assert!(reading.description.root().is_some()),
        Err(problems) => assert!(!problems.errors.is_empty()),
    }
});
