//! The list of peer libraries that their build script writes.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::error::Error;

/// A library, with details of its making. Only the path is required.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub(crate) struct Library {
    pub(crate) name: Option<String>,
    pub(crate) path: PathBuf,
    /// The name and the version of its engine: other fields distinguish builds of the same engine.
    pub(crate) engine: Option<String>,
    pub(crate) compiler: Option<String>,
    pub(crate) version: Option<String>,
    pub(crate) flags: Option<String>,
    /// `f32` if it computes in single precision.
    pub(crate) element: Option<String>,
    /// How many states a call computes, if that is not one: number k of state i at k·lanes + i of
    /// each array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) lanes: Option<NonZeroUsize>,
    /// Machine code of all of it.
    pub(crate) text_bytes: Option<u64>,
    /// Of all of it.
    pub(crate) compilation_seconds: Option<f64>,
    /// For a generator: the robots that it has code for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) robots: Vec<Code>,
}

/// The generated code of one robot.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Code {
    pub(crate) robot: String,
    pub(crate) floating: bool,
    /// FNV-1a of the URDF, 64 bits, hexadecimal with `0x`.
    pub(crate) hash: String,
    pub(crate) functions: BTreeMap<String, Cost>,
}

/// Cost of making a generated function, and its length.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub(crate) struct Cost {
    /// Arithmetic in the code that was generated, sines and moves included.
    pub(crate) operations: Option<u64>,
    pub(crate) code_bytes: Option<u64>,
    pub(crate) generation_seconds: f64,
    pub(crate) compilation_seconds: f64,
}

impl Library {
    /// A library of which only the path is known.
    pub(crate) fn at(path: &Path) -> Self {
        Self { path: path.to_owned(), ..Self::default() }
    }

    /// Its code for the robot of this document.
    pub(crate) fn code(&self, urdf: &[u8], floating: bool) -> Option<&Code> {
        let hash = format!("{:#x}", fnv(urdf));
        self.robots.iter().find(|r| r.hash == hash && r.floating == floating)
    }

    /// Tolerated difference of its results from ours, relative to the magnitude.
    pub(crate) fn bound(&self) -> f64 {
        if self.element.as_deref() == Some("f32") { SINGLE_BOUND } else { BOUND }
    }
}

/// Of double precision.
pub(crate) const BOUND: f64 = 1e-9;
/// Of single precision.
pub(crate) const SINGLE_BOUND: f64 = 1e-3;

/// FNV-1a of 64 bits.
fn fnv(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, b| (hash ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3))
}

/// The libraries that a command line names one by one, and those of a manifest.
pub(crate) fn named(paths: &[PathBuf], manifest: Option<&Path>) -> Result<Vec<Library>, Error> {
    let missing: Vec<String> =
        paths.iter().filter(|p| !p.exists()).map(|p| format!("{}: found no such file, expected a peer's library", p.display())).collect();
    if !missing.is_empty() {
        return Err(Error::input(missing));
    }
    let mut libraries: Vec<Library> = paths.iter().map(|path| Library::at(path)).collect();
    if let Some(file) = manifest {
        libraries.extend(read(file).map_err(|line| Error::input([line]))?);
    }
    Ok(libraries)
}

/// The libraries of a manifest: a list of objects with `path`, or an object with such a list as
/// `peers`.
pub(crate) fn read(file: &Path) -> Result<Vec<Library>, String> {
    let wrong = |e: &dyn std::fmt::Display| format!("{}: {e}", file.display());
    let bytes = articulated_formats::read_file(file, articulated_formats::MOST_BYTES).map_err(|e| wrong(&e))?;
    let value: Value = serde_json::from_slice(&bytes).map_err(|e| wrong(&e))?;
    let list = value.as_array().or_else(|| value.get("peers")?.as_array()).ok_or_else(|| wrong(&"found no list of peers"))?;
    list.iter().map(|entry| Library::deserialize(entry).map_err(|e| wrong(&format!("found a peer that is none: {e}")))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_is_known_by_its_hash() {
        assert_eq!(fnv(b"foobar"), 0x85944171f73967e8); // of the reference's test vectors
        let code = Code { robot: "r".into(), floating: true, hash: format!("{:#x}", fnv(b"<robot/>")), functions: BTreeMap::new() };
        let library = Library { robots: vec![code], ..Library::default() };
        assert!(library.code(b"<robot/>", true).is_some());
        assert!(library.code(b"<robot/>", false).is_none() && library.code(b"<robot />", true).is_none());
    }
}
