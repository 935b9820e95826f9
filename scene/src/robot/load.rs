//! The loader: a scene and a robot with all files that they name. The macro, the build script, the
//! command and tests share it.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use articulated_core::description::Base;
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Span, Spanned};
use articulated_core::suggest::nearest;
use articulated_formats::{Disk, Environment, Included, Options, Sources, included};

use super::build::BuiltRobot;
use super::options::{Appended, RobotOptions, RobotRequest};
use crate::scene::{Robot, Scene};
use crate::series::open_table;

/// A robot that scenes may call by its name.
#[derive(Clone, Copy, Debug)]
pub struct Bundled<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its document.
    pub document: &'a str,
    /// The intended base.
    pub base: Base,
}

/// Reads scenes and robots.
#[derive(Clone)]
pub struct Loader<'a> {
    /// Where files come from.
    pub sources: &'a dyn Sources,
    /// The folder that names of files start from.
    pub root: PathBuf,
    /// The same for messages: `, seen from …`; empty for the program's working folder.
    pub seen_from: &'static str,
    /// The robots that scenes may call by name.
    pub bundled: &'a [Bundled<'a>],
    /// The files that were read.
    pub files: Vec<PathBuf>,
    /// The files that documents of robots include.
    pub included: Included,
}

/// A scene with the documents that it names.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The scene.
    pub scene: Scene,
    /// The robot's file, for messages.
    pub file: String,
    /// The bytes of that file.
    pub document: Vec<u8>,
    /// The scene's requests for the robot; without the scene's effects, which need the robot.
    pub options: RobotOptions,
    /// The files that were read: the scene, the robot, and those appended.
    pub files: Vec<PathBuf>,
}

/// The scene at `path` with its robot's documents; `bundled` are the robots available by name.
/// Names of files are relative to its folder.
///
/// # Errors
/// All findings, if one is an error; then also those about the scene on its robot, as far as both
/// can be read.
pub fn open(path: &Path, bundled: &[Bundled<'_>]) -> Result<Opened, Diagnostics> {
    let mut log = Diagnostics::new(&path.display().to_string());
    let opened = open_into(path, bundled, &mut log);
    whole(opened, folder_of(path), log)
}

/// As [`open`], and reports to a collector.
///
/// # Errors
/// A document is missing: the scene, if that could be read. A collector without errors means that
/// the files are valid; invalid content was left out of the scene.
pub fn open_into(path: &Path, bundled: &[Bundled<'_>], log: &mut Diagnostics) -> Result<Opened, Option<Box<Scene>>> {
    let mut loader = Loader { sources: &Environment, bundled, ..Loader::default() };
    let scene = loader.scene(path, &Span::default(), log).ok_or(None)?;
    loader.open(folder_of(path), scene.clone(), log).ok_or_else(|| Some(Box::new(scene)))
}

/// The opened scene if there are no errors. Otherwise all errors, with the scene's other errors.
fn whole(opened: Result<Opened, Option<Box<Scene>>>, folder: &Path, mut log: Diagnostics) -> Result<Opened, Diagnostics> {
    let scene = match opened {
        Ok(opened) if log.is_ok() => return Ok(opened),
        Ok(opened) => {
            opened.robot().check_with_table(folder, &mut log);
            None
        }
        Err(scene) => scene,
    };
    if let Some(scene) = scene {
        scene.check_table(None, &mut |name| open_table(folder, name), &mut log);
    }
    Err(log.result(()).err().unwrap_or_default())
}

/// A scene that was read, with its robot's documents; `bundled` are the robots available by name.
/// Names of files are relative to `folder`.
///
/// # Errors
/// All findings, if one is an error.
pub fn open_in(scene: Scene, folder: &Path, bundled: &[Bundled<'_>]) -> Result<Opened, Diagnostics> {
    let mut log = Diagnostics::new(&scene.file);
    let opened = open_in_into(scene, folder, bundled, &mut log);
    whole(opened, folder, log)
}

/// As [`open_in`], and reports to a collector.
///
/// # Errors
/// As [`open_into`].
pub fn open_in_into(scene: Scene, folder: &Path, bundled: &[Bundled<'_>], log: &mut Diagnostics) -> Result<Opened, Option<Box<Scene>>> {
    let mut loader = Loader { sources: &Environment, bundled, ..Loader::default() };
    loader.open(folder, scene.clone(), log).ok_or_else(|| Some(Box::new(scene)))
}

impl Default for Loader<'_> {
    /// The file system, from the program's working folder; no bundled robots.
    fn default() -> Self {
        Self { sources: &Disk, root: PathBuf::new(), seen_from: "", bundled: &[], files: Vec::new(), included: Included::default() }
    }
}

impl Loader<'_> {
    /// The bytes of a file. A finding is at the place that names the file, under its key; without a
    /// place, at the file itself.
    pub fn read(&mut self, name: &Path, span: &Span, key: &str, log: &mut Diagnostics) -> Option<Vec<u8>> {
        let (path, name) = (self.root.join(name), name.display().to_string());
        match self.sources.read(&path) {
            Ok(bytes) => {
                self.files.push(path);
                Some(bytes)
            }
            Err(error) => {
                let near = self.sources.nearest(&path).map(|near| format!("did you mean {near:?}?"));
                let reason = match error.kind() {
                    ErrorKind::NotFound => format!("there is no such file{}", self.seen_from),
                    _ => error.to_string(),
                };
                log.push(
                    match *span == Span::default() {
                        true => Diagnostic::refusal(&name, Place::DOCUMENT, Code::File, reason),
                        false => Diagnostic::refusal(&span.file, (span.at, key), Code::File, format!("{name}: {reason}")),
                    }
                    .with_hint(near),
                );
                None
            }
        }
    }

    /// Reads the files that a robot's document includes; `name`: the document's, `robot`: the
    /// arguments and packages for reading it later.
    pub fn include(&mut self, name: &str, document: &[u8], robot: &RobotOptions) {
        let RobotOptions { formats, arguments, packages, contact_meshes, .. } = robot;
        let (arguments, packages) = (arguments.clone(), packages.clone());
        let (formats, contact_meshes) = (*formats, *contact_meshes);
        let options = Options { file: name.to_owned(), formats, arguments, packages, contact_meshes, ..Options::default() };
        let found = included(self.sources, &self.root, document, &options);
        self.files.extend(found.files().map(|(path, _)| self.root.join(path)));
        self.included.extend(found);
    }

    /// The scene of this name, which `span` names. Its errors are reported and left out. `None`:
    /// there is no such file, or it is not TOML.
    pub fn scene(&mut self, name: &Path, span: &Span, log: &mut Diagnostics) -> Option<Scene> {
        let bytes = self.read(name, span, "scene", log)?;
        Scene::read_bytes_into(&name.display().to_string(), &bytes, log)
    }

    /// The documents that a scene names, relative to its folder. `None`: a document is missing, and
    /// an error names it.
    pub fn open(&mut self, folder: &Path, scene: Scene, log: &mut Diagnostics) -> Option<Opened> {
        let robot = self.robot(folder, &scene, log);
        let mut options = RobotOptions { base: robot.as_ref().map_or(Base::Fixed, |robot| robot.2), ..RobotOptions::default() };
        scene.fill_robot(&mut options);
        let appended = self.append(folder, &mut options, log);
        let (file, document, _) = robot.filter(|_| appended)?;
        options.included = self.included.clone();
        Some(Opened { scene, file, document, options, files: self.files.clone() })
    }

    /// The name, the document and the base of a scene's robot; `folder`: the scene's.
    pub fn robot(&mut self, folder: &Path, scene: &Scene, log: &mut Diagnostics) -> Option<(String, Vec<u8>, Base)> {
        match &scene.robot {
            Robot::File(name) => {
                let at = scene.code.places.robot;
                let name = seen_from(at, folder, name);
                let document = self.read(&name, &Span { file: scene.file.clone(), at }, "urdf", log)?;
                let name = name.display().to_string();
                let mut options = RobotOptions::default();
                scene.fill_robot(&mut options);
                self.include(&name, &document, &options);
                Some((name, document, Base::Fixed))
            }
            Robot::Bundled(name) => match self.bundled.iter().find(|one| one.name == name) {
                Some(one) => Some((format!("{name}.urdf"), one.document.as_bytes().to_vec(), one.base)),
                None => {
                    log.push(self.unknown_robot(scene, name));
                    None
                }
            },
            Robot::Given => {
                if !scene.doubts_robot() {
                    log.push(scene.without_robot("no robot", "robot, or urdf"));
                }
                None
            }
        }
    }

    /// Reads the robots to append; `folder`: the scene's. Returns whether all are there.
    pub fn append(&mut self, folder: &Path, options: &mut RobotOptions, log: &mut Diagnostics) -> bool {
        let mut all = true;
        let mut append = std::mem::take(&mut options.append);
        // Only the robot itself has arguments.
        let own = RobotOptions { arguments: BTreeMap::new(), ..options.clone() };
        for other in &mut append {
            let span = other.file.span.clone().unwrap_or_default();
            let name = seen_from(span.at, folder, &other.file);
            match self.read(&name, &span, "append.urdf", log) {
                Some(document) => {
                    (other.document, other.file.value) = (document, name.display().to_string());
                    self.include(&other.file.value, &other.document, &own);
                }
                None => all = false,
            }
        }
        options.append = append;
        all
    }

    fn unknown_robot(&self, scene: &Scene, name: &str) -> Diagnostic {
        let names: Vec<&str> = self.bundled.iter().map(|one| one.name).collect();
        let expected = match names.as_slice() {
            [] => "urdf: no robot is known by name here".to_owned(),
            names => format!("one of {}", names.join(", ")),
        };
        scene.without_robot(&format!("{name:?}, no such robot"), &expected).with_nearest(nearest(name, names))
    }
}

/// A file as the root sees it: a name in an invocation is unchanged, a name in a scene is relative
/// to the scene's folder.
fn seen_from(at: At, folder: &Path, name: &str) -> PathBuf {
    if matches!(at, At::Word(_)) { name.into() } else { folder.join(name) }
}

/// The folder of a file.
#[must_use]
pub fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// A file that a scene names, relative to the root that the scene is relative to.
#[must_use]
pub fn beside(scene: &str, name: &str) -> String {
    let folder = Path::new(scene).parent().filter(|folder| *folder != Path::new(""));
    folder.map_or_else(|| name.to_owned(), |folder| folder.join(name).display().to_string())
}

impl Opened {
    /// A scene for the robot in `document`; `append` are the documents of appended robots. No file
    /// is opened. `base` applies if the scene has none.
    #[must_use]
    pub fn new(scene: Scene, file: &str, document: Vec<u8>, base: Base, append: Vec<Vec<u8>>) -> Self {
        let mut options = RobotOptions { base, ..RobotOptions::default() };
        scene.fill_robot(&mut options);
        options.append.iter_mut().zip(append).for_each(|(other, document)| other.document = document);
        Self { scene, file: file.to_owned(), document, options, files: Vec::new() }
    }

    /// The robot requested by the scene.
    #[must_use]
    pub fn robot(&self) -> RobotRequest<'_> {
        RobotRequest { file: &self.file, document: &self.document, options: &self.options, scene: Some(&self.scene), checks_motion: true }
    }

    /// The robot as the scene leaves it.
    ///
    /// # Errors
    /// All findings about the document, or else about the scene and the robot, by their places in
    /// the
    /// scene; tables of control in files apart.
    pub fn build(&self) -> Result<BuiltRobot, Diagnostics> {
        self.robot().build()
    }
}

impl Scene {
    /// Writes the scene's options of its robot into `options`: all but the effects, which need the
    /// robot, and the documents of the robots to append.
    pub fn fill_robot(&self, options: &mut RobotOptions) {
        let (code, places) = (self.code.clone(), &self.code.places);
        options.base = self.base.unwrap_or(options.base);
        options.gravity = self.gravity.or(options.gravity);
        options.frames = code.frames.map(|names| self.spanned(names, &places.frames));
        options.wrench_reference = code.wrenches_in.unwrap_or_default();
        options.append = code
            .append
            .into_iter()
            .map(|other| Appended {
                document: Vec::new(),
                file: self.span(other.file, other.place),
                at: self.span(other.link, other.link_place),
                prefix: other.prefix,
                origin: other.origin,
            })
            .collect();
        options.payloads = code.payload.into_iter().map(|load| self.span(load.payload, load.place)).collect();
        options.shafts = self.shafts.iter().map(|asked| self.span(asked.shaft.clone(), asked.place)).collect();
        options.coupling = code.coupling.into_iter().map(|follower| self.span(follower.coupling, follower.place)).collect();
        options.file_coupling = code.file_coupling;
        options.lock = code.lock.into_iter().map(|lock| self.span((lock.joint, lock.at), lock.place)).collect();
        options.allow_unphysical_inertia = code.allow_unphysical_inertia.unwrap_or(options.allow_unphysical_inertia);
        options.first_of_duplicates = code.first_of_duplicates.unwrap_or(options.first_of_duplicates);
        options.given_contacts = code.given_contacts.into_iter().map(|(given, place)| self.span(given, place)).collect();
        options.leave_out = code.leave_out.unwrap_or_else(|| std::mem::take(&mut options.leave_out));
        options.allow_unknown_version = code.allow_unknown_version.unwrap_or(options.allow_unknown_version);
        options.snap_angles = code.snap_angles;
        options.arguments.extend(code.args);
        let folder = folder_of(Path::new(&self.file));
        let packages = code.packages.into_iter().enumerate().map(|(i, (name, path))| {
            let at = places.packages.get(i).copied().unwrap_or_default();
            (name, seen_from(at, folder, &path))
        });
        options.packages.extend(packages);
        options.contact_meshes |= self.touches_with_geometry();
    }

    /// A value with its place in the scene.
    fn span<T>(&self, value: T, at: At) -> Spanned<T> {
        Spanned::new(value, &self.file, at)
    }

    /// Values with their places in the scene, one for each.
    pub fn spanned<T>(&self, values: Vec<T>, places: &[At]) -> Vec<Spanned<T>> {
        let at = |i: usize| places.get(i).copied().unwrap_or_default();
        values.into_iter().enumerate().map(|(i, value)| self.span(value, at(i))).collect()
    }

    /// Whether the key that names the robot was left out.
    #[must_use]
    pub fn doubts_robot(&self) -> bool {
        ["robot", "urdf", "file"].iter().any(|key| self.doubts(key))
    }

    /// The finding that the scene has no robot.
    #[must_use]
    pub fn without_robot(&self, found: &str, expected: &str) -> Diagnostic {
        let key = if self.robot == Robot::Given { "" } else { "robot" };
        Diagnostic::error(&self.file, (self.code.places.robot, key), Code::UnknownName, found, expected)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Error, Result};

    use super::*;

    struct Files(&'static [(&'static str, &'static str)]);

    impl Sources for Files {
        fn read(&self, path: &Path) -> Result<Vec<u8>> {
            let found = self.0.iter().find(|(name, _)| Path::new(name) == path);
            found.map(|(_, text)| text.as_bytes().to_vec()).ok_or_else(|| Error::from(ErrorKind::NotFound))
        }
    }

    const FILES: Files = Files(&[
        (
            "here/scenes/arm.toml",
            "file = \"../arm.xacro\"\nargs = { mass = 2, hand = true, side = \"left\" }\npackages = { parts = \"../parts\" }\n\
             append = { file = \"../tool.xacro\", at = \"left\", prefix = \"t_\" }",
        ),
        (
            "here/scenes/../arm.xacro",
            "<robot name='arm'><xacro:arg name='mass' default='1'/><xacro:arg name='hand' default='false'/><xacro:arg name='side' default=''/>
             <xacro:include filename='$(find parts)/part.xacro'/><xacro:if value='$(arg hand)'><xacro:part name='$(arg side)' mass='$(arg mass)'/></xacro:if></robot>",
        ),
        (
            "here/parts/part.xacro",
            "<robot><xacro:macro name='part' params='name mass'><link name='${name}'><inertial><mass value='${mass}'/>
             <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></xacro:macro></robot>",
        ),
        ("here/scenes/../tool.xacro", "<robot name='tool'><xacro:arg name='size' default='big'/><link name='$(arg size)'/></robot>"),
    ]);

    #[test]
    fn a_scene_leaves_out_what_its_key_names() {
        const CLOTH: Files = Files(&[
            ("all.toml", "file = \"cloth.xml\""),
            ("without.toml", "file = \"cloth.xml\"\nleave_out = [\"flex\"]"),
            ("cloth.xml", "<mujoco><worldbody><body><joint/><geom size='1'/></body><flexcomp name='cloth'/></worldbody></mujoco>"),
        ]);
        let read = |name: &str| {
            let mut log = Diagnostics::new("");
            let mut loader = Loader { sources: &CLOTH, ..Loader::default() };
            let scene = loader.scene(name.as_ref(), &Span::default(), &mut log);
            let opened = scene.and_then(|scene| loader.open("".as_ref(), scene, &mut log));
            opened.unwrap_or_else(|| panic!("{log}")).robot().read()
        };
        let found = read("all.toml").map(|_| ()).unwrap_err().to_string();
        assert!(found.contains("key `leave_out`"), "{found}");
        let reading = read("without.toml").unwrap_or_else(|found| panic!("{found}"));
        assert!(reading.warnings[0].to_string().contains("a flexible body \"cloth\""), "{:?}", reading.warnings);
    }

    #[test]
    fn arguments_and_packages_of_a_scene_are_those_of_its_robot() {
        let mut log = Diagnostics::new("");
        let mut loader = Loader { sources: &FILES, root: "here".into(), ..Loader::default() };
        let scene = loader.scene("scenes/arm.toml".as_ref(), &Span::default(), &mut log);
        let opened = scene.and_then(|scene| loader.open("scenes".as_ref(), scene, &mut log));
        let opened = opened.unwrap_or_else(|| panic!("{log}"));
        let reading = opened.robot().read().unwrap_or_else(|found| panic!("{found}"));
        let links: Vec<&str> = reading.description.links.iter().map(|link| link.name.as_str()).collect();
        assert_eq!(links, ["left", "t_big"]);
        assert_eq!(reading.description.links[articulated_core::description::LinkId(0)].inertial.map(|inertial| inertial.mass), Some(2.0));
        assert!(reading.warnings.iter().all(|warning| warning.field != "args"), "{:?}", reading.warnings);
        assert!(opened.files.contains(&"here/parts/part.xacro".into()), "{:?}", opened.files);
    }
}
