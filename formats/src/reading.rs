//! Options for reading a document, and the result.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use articulated_core::description::{Base, Description};
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Subject, Unused, quote};
use articulated_core::suggest::nearest;

use crate::contact_points;
use crate::files::Recorder;
use crate::world::{Document, World};
use crate::{Format, Formats, Included, Input, LeaveOut, NoFiles, Sources, snap};

/// How to read.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The name of the file in messages. It is not opened.
    pub file: String,
    /// Whether the root link is the base or moves freely; it only changes the list of unused
    /// content.
    pub base: Base,
    /// Makes an inertia that is not positive semi-definite a warning instead of an error. One that
    /// is negative by rounding alone always is a warning.
    pub allow_unphysical_inertia: bool,
    /// If a unique tag of a URDF or SDF is repeated with other content, takes the first, with a
    /// warning, as urdfdom does.
    pub first_of_duplicates: bool,
    /// Elements of an MJCF that change the motion and are not read, to leave out with a warning.
    /// Those of other kinds are errors.
    pub leave_out: BTreeSet<LeaveOut>,
    /// Reads a URDF of a version other than 1.0, 1.1 and 1.2 as 1.0, with a warning instead of an
    /// error.
    pub allow_unknown_version: bool,
    /// Replaces an angle of a frame that is within this many rad of a multiple of π/2 by that
    /// multiple: above 0, at most [`MOST_SNAPPED`](crate::MOST_SNAPPED); any other number is an
    /// error. `None` leaves every number as written.
    pub snap_angles: Option<f64>,
    /// The formats to choose from.
    pub formats: Formats,
    /// Values of arguments of the file, as declared by `<xacro:arg>`. An undeclared one is a
    /// warning.
    pub arguments: BTreeMap<String, String>,
    /// Folders of packages, for files that the file includes from them.
    pub packages: BTreeMap<String, PathBuf>,
    /// Reads the meshes of collision geometry, for contact on points of their hulls.
    pub contact_meshes: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            file: "<robot>".into(),
            base: Base::Fixed,
            allow_unphysical_inertia: false,
            first_of_duplicates: false,
            leave_out: BTreeSet::new(),
            allow_unknown_version: false,
            snap_angles: None,
            formats: Formats::default(),
            arguments: BTreeMap::new(),
            packages: BTreeMap::new(),
            contact_meshes: false,
        }
    }
}

impl Options {
    /// Warns of undeclared arguments.
    pub(crate) fn warn_of_arguments(&self, declared: &BTreeSet<String>, log: &mut Diagnostics) {
        for name in self.arguments.keys().filter(|name| !declared.contains(*name)) {
            let near =
                nearest(name, declared.iter().map(String::as_str)).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
            let found = format!("the argument {}, which the file does not have", quote(name));
            log.warning((At::Nowhere, "args"), Code::Xacro, found, format!("one of its arguments{near}"));
        }
    }
}

/// A robot that was read, with the findings about its file.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The robot. A bound missing in the file is infinite: `lower` and `upper` of a continuous
    /// joint, `effort` and `velocity`. `axis` is (1, 0, 0) and `limit` and `dynamics` are `None`
    /// for joints that do not use them.
    pub description: Description,
    /// The world of the file.
    pub world: World,
    /// Suspicious content; the values were used as written.
    pub warnings: Vec<Diagnostic>,
    /// Content of the file that the description leaves out, or that only some scenes use.
    pub unused: Vec<Unused>,
    /// Every angle that was replaced because of [`Options::snap_angles`].
    pub snapped: Vec<Diagnostic>,
}

impl Reading {
    /// Withdraws findings about mass that the fixed base carries, for links that an edit has
    /// released (`go`).
    pub fn release(&mut self, go: impl Fn(&str) -> bool) {
        self.unused.retain(|u| !(u.why == HELD && matches!(&u.subject, Subject::Link(name) if go(name))));
    }
}

/// Reason why mass that the fixed base carries is not used.
pub(crate) const HELD: &str = "the base is fixed, and this link with it";

/// The robot in `bytes`; files that it includes are refused. Lengths in m, masses in kg, angles in
/// rad. Exact: every number is the double nearest to its spelling.
///
/// # Errors
/// All of the file's at once, at most 1000.
pub fn read(bytes: &[u8], options: &Options) -> Result<Reading, Diagnostics> {
    read_with(&NoFiles, bytes, options)
}

/// The files that a document includes, for reading it again with [`read_with`]. Their names are
/// built from the document and `options.file`; `root` is the folder that they are relative to.
pub fn included(sources: &dyn Sources, root: &Path, bytes: &[u8], options: &Options) -> Included {
    let recorder = Recorder { sources, root, known: RefCell::default() };
    if options.contact_meshes || options.formats.of(&options.file, bytes).is_some_and(Format::includes_files) {
        // Errors of the document are reported when it is read.
        drop(read_with(&recorder, bytes, options));
    }
    recorder.included()
}

/// As [`read()`], with the files that the document includes.
///
/// # Errors
/// All of the file's at once, at most 1000.
pub fn read_with(sources: &dyn Sources, bytes: &[u8], options: &Options) -> Result<Reading, Diagnostics> {
    let mut log = Diagnostics::new(&options.file);
    snap::check(options.snap_angles, &mut log);
    let Some(format) = options.formats.of(&options.file, bytes) else {
        log.error(Place::DOCUMENT, Code::Unsupported, quote(&options.file), "a robot; there are no formats to read it in");
        return Err(log);
    };
    let input = Input { bytes, options, sources };
    match format.read(&input, &mut log) {
        Some(Document { mut description, world }) if log.is_ok() => {
            if options.contact_meshes {
                contact_points::read(&mut description, &input);
            }
            let Diagnostics { warnings, notes, unused, .. } = log.finished();
            Ok(Reading { description, world, warnings, unused, snapped: notes })
        }
        _ => Err(log.finished()),
    }
}
