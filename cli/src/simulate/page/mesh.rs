//! Meshes of a robot's file: their paths, and their contents.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use articulated_core::diagnostic::{Code, Diagnostics, Place, Subject};
use articulated_formats::{Disk, Environment, Sources, declares_package};

use crate::arguments::Package;
use mesh_loader::Loader;

use super::geometry::Geometry;

/// Triangles of all meshes together, at most: with 24 bytes each a page has 5 MB.
const MOST_OF_ALL: usize = 200_000;
/// Minimum number of triangles of a mesh in a large robot.
const LEAST: usize = 200;

/// Finds and reads meshes; each is read once.
pub(crate) struct Meshes<'a> {
    /// Of the robot's files, the robot's own first.
    folders: Vec<PathBuf>,
    packages: &'a [Package],
    read: RefCell<HashMap<PathBuf, Result<Rc<Geometry>, String>>>,
    log: RefCell<Diagnostics>,
}

impl<'a> Meshes<'a> {
    /// For a robot in these folders. `file`: its name in warnings.
    pub(crate) fn new(folders: Vec<PathBuf>, packages: &'a [Package], file: &str) -> Self {
        Self { folders, packages, read: RefCell::default(), log: RefCell::new(Diagnostics::new(file)) }
    }

    /// Warnings about inexact drawings.
    pub(crate) fn into_warnings(self) -> Diagnostics {
        self.log.into_inner()
    }

    /// The part of their triangles that meshes of these names may keep: all of them, unless they
    /// are too many together.
    pub(super) fn share<'n>(&self, names: impl Iterator<Item = &'n str>) -> f64 {
        let distinct: BTreeSet<PathBuf> = names.filter_map(|name| self.find(name).ok()).collect();
        let all: usize = distinct.iter().filter_map(|path| Some(self.read(path).ok()?.triangles.len())).sum();
        (MOST_OF_ALL as f64 / all.max(1) as f64).min(1.0)
    }

    /// The mesh of a link, with this part of its triangles; a warning if there is none.
    pub(super) fn mesh(&self, link: &str, name: &str, share: f64) -> Option<Geometry> {
        let found = self.find(name).and_then(|path| self.read(&path).map_err(|why| (format!("{}: {why}", path.display()), EXPECTED)));
        let mesh = match found {
            Ok(mesh) => mesh,
            Err((found, expected)) => {
                self.warn(link, &found, &format!("{expected}; the link's inertia box is drawn instead"));
                return None;
            }
        };
        let count = mesh.triangles.len();
        let most = ((share * count as f64).round() as usize).max(LEAST);
        let drawn = Geometry::clone(&mesh).decimated(most);
        if drawn.triangles.len() < count {
            let found = format!("{name}: a mesh of {count} triangles");
            self.warn(link, &found, &format!("at most {most}: drawn with {}", drawn.triangles.len()));
        }
        Some(drawn)
    }

    /// A warning about a link's appearance.
    pub(super) fn warn(&self, link: &str, found: &str, expected: &str) {
        let subject = Subject::Link(link.to_owned());
        let place = Place { subject: &subject, ..Place::DOCUMENT };
        let mut log = self.log.borrow_mut();
        let place = Place { field: "mesh", ..place };
        log.warning(place, Code::File, found, expected);
    }

    /// The file of a name. Errors: what was found and what is expected.
    fn find(&self, name: &str) -> Result<PathBuf, (String, &'static str)> {
        let none = |expected| Err((format!("no file {name}"), expected));
        if let Some((package, rest)) = ["package://", "model://"].iter().find_map(|scheme| name.strip_prefix(scheme)?.split_once('/')) {
            let own = self.packages.iter().filter(|known| known.name == package).map(|known| known.folder.join(rest));
            let around = self.folders.iter().flat_map(|folder| upward(folder, package)).map(|folder| folder.join(rest));
            let of_environment = Environment.package(package).map(|folder| folder.join(rest));
            return own.chain(around).chain(of_environment).find(|path| path.is_file()).map_or_else(|| none(IN_PACKAGE), Ok);
        }
        let path = Path::new(name.strip_prefix("file://").unwrap_or(name));
        let mut places = self.folders.iter().map(|folder| folder.join(path));
        places.find(|path| path.is_file()).map_or_else(|| none(BESIDE), Ok)
    }

    fn read(&self, path: &Path) -> Result<Rc<Geometry>, String> {
        if let Some(known) = self.read.borrow().get(path) {
            return known.clone();
        }
        let found = read(path).map(Rc::new);
        self.read.borrow_mut().insert(path.to_owned(), found.clone());
        found
    }
}

const EXPECTED: &str = "a mesh in STL, OBJ or COLLADA (.dae)";
const BESIDE: &str = "one relative to the robot's file";
const IN_PACKAGE: &str = "one in the folder of its package: --package NAME=FOLDER, or `packages` of the scene, says where that is";

/// Folders of a package that contain this folder, or that are in a surrounding folder: by their
/// name, or by the name in their `package.xml`.
fn upward(folder: &Path, package: &str) -> Vec<PathBuf> {
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let is_declared = |around: &Path| Disk.read(&around.join("package.xml")).is_ok_and(|bytes| declares_package(&bytes, package));
    let is_named = |around: &Path| around.file_name().is_some_and(|name| name == package);
    let own = |around: &Path| (is_named(around) || is_declared(around)).then(|| around.to_owned());
    let folders = whole.ancestors().flat_map(|around| own(around).into_iter().chain([around.join(package)]));
    folders.filter(|found| found.is_dir()).collect()
}

/// The mesh of a file, m. Errors: the reason why it is unreadable.
fn read(path: &Path) -> Result<Geometry, String> {
    let bytes = Disk.read(path).map_err(|e| e.to_string())?;
    let known = path.extension().is_some_and(|e| ["stl", "obj", "dae"].iter().any(|known| e.eq_ignore_ascii_case(known)));
    if !known {
        return Err("a file of another kind".to_owned());
    }
    // Materials of OBJ are not looked for.
    let nothing = |_: &Path| Ok(Vec::new());
    let scene = Loader::default().merge_meshes(true).load_from_slice_with_reader(&bytes, path, nothing).map_err(|e| e.to_string())?;
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for mesh in scene.meshes {
        let first = points.len() as u32;
        points.extend(mesh.vertices);
        triangles.extend(mesh.faces.iter().map(|face| face.map(|k| k + first)));
    }
    let mesh = upright(Geometry { points, triangles }, &bytes).welded();
    if mesh.triangles.is_empty() { Err("no triangle".to_owned()) } else { Ok(mesh) }
}

/// With z up, if a COLLADA file has another axis up.
fn upright(mut mesh: Geometry, bytes: &[u8]) -> Geometry {
    let says = |word: &[u8]| bytes.windows(word.len()).any(|part| part == word);
    let turn: fn([f32; 3]) -> [f32; 3] = match () {
        () if says(b"<up_axis>Y_UP") => |[x, y, z]| [x, -z, y],
        () if says(b"<up_axis>X_UP") => |[x, y, z]| [-y, x, z],
        () => return mesh,
    };
    mesh.points.iter_mut().for_each(|point| *point = turn(*point));
    mesh
}
