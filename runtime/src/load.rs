//! Robots loaded at run time.

use std::fmt;
use std::path::Path;

use articulated_core::description::Base;
use articulated_core::model::{Model, ModelError};
use articulated_urdf::{Options, Problems, read};

/// Why a file is not a robot.
#[derive(Debug)]
pub enum LoadError {
    /// The file cannot be read.
    Io(std::io::Error),
    /// The document is not a usable URDF; every error in it.
    Urdf(Problems),
    /// A robot of a kind that the algorithms do not know.
    Model(ModelError),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(e) => e.fmt(f),
            Self::Urdf(e) => e.fmt(f),
            Self::Model(e) => e.fmt(f),
        }
    }
}

impl std::error::Error for LoadError {}

/// The generic model of the URDF at `path`, with standard gravity.
pub fn load(path: impl AsRef<Path>, base: Base) -> Result<Model<f64>, LoadError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(LoadError::Io)?;
    load_bytes(&path.display().to_string(), &bytes, base)
}

/// The generic model of a URDF in memory; `file` is its name in messages.
pub fn load_bytes(file: &str, bytes: &[u8], base: Base) -> Result<Model<f64>, LoadError> {
    let options = Options { file: file.into(), base, ..Options::default() };
    let reading = read(bytes, &options).map_err(LoadError::Urdf)?;
    Model::new(&reading.description, base).map_err(LoadError::Model)
}
