//! The interface of a format, and the registry.

use std::fmt;

use articulated_core::diagnostic::Diagnostics;

use crate::world::Document;
use crate::{Options, Sources, mjcf, sdf, urdf};

/// A format of robot files. Each has one row in [`FORMATS`].
pub trait Format: Sync + std::panic::RefUnwindSafe {
    /// Its name, in small letters.
    fn name(&self) -> &'static str;

    /// Endings of its files, without the dot and in small letters.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether a document looks like one of this format.
    fn recognizes(&self, bytes: &[u8]) -> bool;

    /// Whether a document may include other files.
    fn includes_files(&self) -> bool {
        false
    }

    /// The robot of a document, and its world. Reports all findings; `None` if there is an error,
    /// or no robot.
    fn read(&self, input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<Document>;
}

/// A document to read.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// Its bytes.
    pub bytes: &'a [u8],
    /// How to read it, and the name of the file.
    pub options: &'a Options,
    /// Where to find the files that it includes.
    pub sources: &'a dyn Sources,
}

/// All formats. A document of an unrecognized format is read as the first.
pub const FORMATS: &[&dyn Format] = &[&urdf::Urdf, &mjcf::Mjcf, &sdf::Sdf];

/// The formats that a reader chooses from.
#[derive(Clone, Copy)]
pub struct Formats(pub &'static [&'static dyn Format]);

impl Formats {
    /// The format of a document: the one that recognizes it, or that of the file's ending, or the
    /// first. `None` if there are no formats.
    #[must_use]
    pub fn of(self, file: &str, bytes: &[u8]) -> Option<&'static dyn Format> {
        let ending = file.rsplit_once('.').map(|(_, ending)| ending.to_lowercase());
        let has_ending = |format: &&&'static dyn Format| ending.as_deref().is_some_and(|e| format.extensions().contains(&e));
        let recognized = || self.0.iter().find(|format| format.recognizes(bytes));
        self.0
            .iter()
            .find(|format| has_ending(format) && format.recognizes(bytes))
            .or_else(recognized)
            .or_else(|| self.0.iter().find(has_ending))
            .or(self.0.first())
            .copied()
    }

    /// Whether a file's ending is that of a robot file.
    #[must_use]
    pub fn has_ending(self, ending: &str) -> bool {
        self.0.iter().any(|format| format.extensions().iter().any(|own| own.eq_ignore_ascii_case(ending)))
    }

    fn names(self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|format| format.name())
    }
}

impl Default for Formats {
    fn default() -> Self {
        Self(FORMATS)
    }
}

impl fmt::Debug for Formats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

impl PartialEq for Formats {
    fn eq(&self, other: &Self) -> bool {
        self.names().eq(other.names())
    }
}
