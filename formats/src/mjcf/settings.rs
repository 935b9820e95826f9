//! The sections `<compiler>`, `<default>` and `<asset>` of one document.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::suggest::nearest;

use super::element::Element;
use super::values::{Angles, Values};

/// Where masses come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InertiaFromGeom {
    Never,
    Always,
    /// For bodies without `<inertial>`.
    Auto,
}

/// The settings of `<compiler>`.
#[derive(Clone, Debug)]
pub(crate) struct Compiler {
    pub(crate) auto_limits: bool,
    pub(crate) bound_mass: f64,
    pub(crate) bound_inertia: f64,
    pub(crate) total_mass: Option<f64>,
    pub(crate) balance_inertia: bool,
    pub(crate) angles: Angles,
    pub(crate) mesh_folder: String,
    pub(crate) strip_path: bool,
    pub(crate) inertia_from_geom: InertiaFromGeom,
    pub(crate) groups: [i64; 2],
    pub(crate) fit_aabb: bool,
    pub(crate) align_free: bool,
}

impl Compiler {
    fn of(root: &Element, log: &mut Diagnostics) -> Self {
        let angles = Angles { degrees: true, sequence: *b"xyz" };
        let mut all = Self {
            auto_limits: true,
            bound_mass: 0.0,
            bound_inertia: 0.0,
            total_mass: None,
            balance_inertia: false,
            angles,
            mesh_folder: String::new(),
            strip_path: false,
            inertia_from_geom: InertiaFromGeom::Auto,
            groups: [0, 5],
            fit_aabb: false,
            align_free: false,
        };
        for section in root.all("compiler") {
            all.section(&Values::alone(section, &Subject::Document), log);
        }
        all
    }

    fn section(&mut self, values: &Values<'_>, log: &mut Diagnostics) {
        use InertiaFromGeom::{Always, Auto, Never};
        let yes = |name: &str, into: &mut bool, log: &mut Diagnostics| *into = values.yes(name, log).unwrap_or(*into);
        yes("autolimits", &mut self.auto_limits, log);
        yes("balanceinertia", &mut self.balance_inertia, log);
        yes("strippath", &mut self.strip_path, log);
        yes("fitaabb", &mut self.fit_aabb, log);
        yes("alignfree", &mut self.align_free, log);
        self.bound_mass = values.number("boundmass", log).unwrap_or(self.bound_mass);
        self.bound_inertia = values.number("boundinertia", log).unwrap_or(self.bound_inertia);
        self.total_mass = values.number("settotalmass", log).map_or(self.total_mass, |mass| (mass > 0.0).then_some(mass));
        self.angles.degrees = values.word("angle", &[("degree", true), ("radian", false)], log).unwrap_or(self.angles.degrees);
        if values.word("coordinate", &[("local", false), ("global", true)], log) == Some(true) {
            let expected = "local coordinates: MuJoCo 2.3.3 and older convert such files";
            values.error("coordinate", Code::Unsupported, "global coordinates", expected, log);
        }
        if let Some(sequence) = values.text("eulerseq") {
            match <[u8; 3]>::try_from(sequence.as_bytes()) {
                Ok(axes) if axes.iter().all(|axis| b"xyzXYZ".contains(axis)) => self.angles.sequence = axes,
                _ => values.error("eulerseq", Code::Word, quote(sequence), "three letters out of x, y, z, X, Y and Z", log),
            }
        }
        // In one section, the folder for meshes has precedence over that for all.
        for name in ["assetdir", "meshdir"] {
            self.mesh_folder = values.text(name).map_or_else(|| std::mem::take(&mut self.mesh_folder), str::to_owned);
        }
        let words = [("false", Never), ("true", Always), ("auto", Auto)];
        self.inertia_from_geom = values.word("inertiafromgeom", &words, log).unwrap_or(self.inertia_from_geom);
        if let Some(range) = values.exactly::<2>("inertiagrouprange", log) {
            self.groups = range.map(|group| group as i64);
        }
    }
}

/// A default class: its tags, and the class above it.
#[derive(Debug, Default)]
struct Class<'a> {
    above: Option<usize>,
    tags: Vec<&'a Element>,
}

/// All default classes; the first applies to everything without a class.
#[derive(Debug)]
pub(crate) struct Classes<'a> {
    classes: Vec<Class<'a>>,
    names: BTreeMap<&'a str, usize>,
}

/// The name of the class of everything.
const MAIN: &str = "main";

impl<'a> Classes<'a> {
    fn of(root: &'a Element, log: &mut Diagnostics) -> Self {
        let mut all = Self { classes: vec![Class::default()], names: BTreeMap::from([(MAIN, 0)]) };
        for section in root.all("default") {
            if let Some(name) = section.text("class").filter(|name| *name != MAIN && !name.is_empty()) {
                let expected = "the class main, or none: other classes are inside it";
                section.error((&Subject::Document, "class"), Code::Word, quote(name), expected, log);
            }
            all.section(section, 0, log);
        }
        all
    }

    fn section(&mut self, section: &'a Element, class: usize, log: &mut Diagnostics) {
        self.classes[class].tags.extend(section.children.iter().filter(|child| !child.is("default")));
        for inner in section.all("default") {
            let name = inner.text("class").unwrap_or_default();
            if name.is_empty() {
                inner.error((&Subject::Document, "class"), Code::MissingAttribute, "none", "the name of the class", log);
                continue;
            }
            let index = self.classes.len();
            if self.names.contains_key(name) {
                inner.error(
                    (&Subject::Document, "class"),
                    Code::DuplicateName,
                    format!("a second class {}", quote(name)),
                    "a name of its own",
                    log,
                );
                continue;
            }
            self.names.insert(name, index);
            self.classes.push(Class { above: Some(class), tags: Vec::new() });
            self.section(inner, index, log);
        }
    }

    /// The class of a name; an error if it does not exist.
    pub(crate) fn find(&self, element: &Element, attribute: &str, log: &mut Diagnostics) -> Option<usize> {
        let name = element.text(attribute)?;
        let found = self.names.get(name).copied();
        if found.is_none() {
            let hint = nearest(name, self.names.keys().copied()).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
            element.error(
                (&Subject::Document, attribute),
                Code::UnknownName,
                quote(name),
                format!("the name of a default class{hint}"),
                log,
            );
        }
        found
    }

    /// The tags of a class, and of the classes above, the farthest first.
    pub(crate) fn lineage(&self, class: usize) -> Vec<&[&'a Element]> {
        let mut all = Vec::new();
        let mut next = Some(class);
        while let Some(class) = next.map(|index| &self.classes[index]) {
            all.push(class.tags.as_slice());
            next = class.above;
        }
        all.reverse();
        all
    }

    /// The tags of this name of a class and the classes above, the nearest first.
    pub(crate) fn tags(&self, class: usize, name: &str) -> Vec<&'a Element> {
        let lineage = self.lineage(class);
        lineage.iter().rev().flat_map(|tags| tags.iter().rev()).filter(|tag| tag.is(name)).copied().collect()
    }
}

/// The settings of one document, without its bodies.
#[derive(Debug)]
pub(crate) struct Settings<'a> {
    /// The folder of the document.
    pub(crate) folder: PathBuf,
    pub(crate) compiler: Compiler,
    pub(crate) classes: Classes<'a>,
    /// Meshes and height fields by their names.
    pub(crate) meshes: BTreeMap<String, &'a Element>,
    pub(crate) height_fields: BTreeMap<String, &'a Element>,
    /// Other documents by their names.
    pub(crate) models: BTreeMap<String, &'a Element>,
    /// Tags in the sections of these names.
    pub(crate) tendons: Vec<&'a Element>,
    pub(crate) actuators: Vec<&'a Element>,
    pub(crate) equations: Vec<&'a Element>,
    pub(crate) keyframes: Vec<&'a Element>,
    pub(crate) contacts: Vec<&'a Element>,
}

impl<'a> Settings<'a> {
    pub(crate) fn of(root: &'a Element, log: &mut Diagnostics) -> Self {
        let folder = Path::new(&root.file.name).parent().map(Path::to_owned).unwrap_or_default();
        let compiler = Compiler::of(root, log);
        let classes = Classes::of(root, log);
        let (mut meshes, mut models, mut height_fields, mut seen) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new(), BTreeSet::new());
        for asset in root.all("asset").flat_map(|section| &section.children) {
            let (list, what) = match asset.name.as_str() {
                "mesh" => (&mut meshes, "mesh"),
                "model" => (&mut models, "model"),
                "hfield" => (&mut height_fields, "hfield"),
                _ => continue,
            };
            let name = asset.text("name").map_or_else(|| stem(asset.text("file").unwrap_or_default()), str::to_owned);
            if name.is_empty() {
                asset.error((&Subject::Document, "name"), Code::MissingAttribute, "none", format!("a name of the {what}, or a file"), log);
            } else if seen.insert((what, name.clone())) {
                list.insert(name, asset);
            } else {
                let found = format!("a second {what} {}", quote(&name));
                asset.error((&Subject::Document, "name"), Code::DuplicateName, found, "a name of its own", log);
            }
        }
        let section = |name| root.all(name).flat_map(|section| &section.children).collect();
        let [tendons, actuators, equations, keyframes, contacts] = ["tendon", "actuator", "equality", "keyframe", "contact"].map(section);
        Self { folder, compiler, classes, meshes, height_fields, models, tendons, actuators, equations, keyframes, contacts }
    }
}

/// The name of a file without its folder and ending.
fn stem(file: &str) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or_default();
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned()
}
