//! The robot of a command: a bundled one by its name, a file by its path, or that of a scene, with
//! its edits and effects.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use articulated_codegen::scene::Scene;
use articulated_codegen::{Appended, MOST_FREEDOMS, Options, Request, TrigAccuracy, nearest};
use articulated_core::description::Base;
use articulated_core::diagnostic::{At, Diagnostic, Diagnostics, summary, values};
use articulated_core::model::Model;
use articulated_formats::{Environment, Included, MOST_BYTES, nearest_file, read_at_most};
use articulated_scene::{BuiltRobot, RobotOptions};

use crate::arguments::{RobotArguments, names_in_rust};
use crate::console;
use crate::edits::{CouplingArgument, Edits, FrameArguments};
use crate::failure::Failure;
use crate::{named_scene, output};
pub(crate) use articulated_lab::robot::{named, note_of_parameters};

/// A robot's document and how to read it.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    /// Its file, for messages and for the header of generated code.
    pub(crate) file: String,
    /// The scene that it is of.
    pub(crate) scene: Option<String>,
    pub(crate) document: Vec<u8>,
    pub(crate) options: Options,
    /// The scene with its effects.
    effects: Option<Scene>,
    /// Of the document, for measurements.
    #[cfg_attr(not(feature = "measure"), expect(dead_code))]
    path: Option<PathBuf>,
    /// Warnings of bundled robots are intended.
    bundled: bool,
    /// All files that it was read from.
    files: Vec<PathBuf>,
}

impl Robot {
    /// The robot that the arguments name.
    pub(crate) fn find(arguments: &RobotArguments) -> Result<Self, Failure> {
        names_in_rust(&arguments.rename)?;
        let name = arguments.robot.as_path();
        if named_scene::is_scene(name) {
            return Self::of_scene(name, arguments);
        }
        let scenes: Vec<&str> = articulated_models::SCENES.iter().chain(articulated_models::LAW_SCENES).map(|scene| scene.name).collect();
        let (file, document) = document(name, &scenes)?;
        let bundled = name.to_str().and_then(articulated_models::robot);
        let base = bundled.map_or(Base::Fixed, |b| b.base);
        let path = (bundled.is_none() && !is_standard_input(name)).then(|| name.to_owned());
        let base = match (arguments.floating, arguments.fixed) {
            (true, _) => Base::Floating,
            (_, true) => Base::Fixed,
            _ => base,
        };
        let mut options = Options::default();
        options.robot.base = base;
        options.robot.gravity = arguments.gravity.map(|g| g.0).or(options.robot.gravity);
        options.robot.allow_unphysical_inertia = arguments.allow_unphysical_inertia;
        options.robot.first_of_duplicates = arguments.first_of_duplicates;
        options.robot.leave_out = arguments.leave_out.iter().copied().collect();
        options.robot.given_contacts = arguments.given_contact.iter().cloned().map(Into::into).collect();
        options.robot.allow_unknown_version = arguments.allow_unknown_version;
        options.robot.snap_angles = arguments.snap_angles;
        options.rename = arguments.rename.iter().cloned().map(Into::into).collect();
        options.max_code_size = arguments.max_code_size.unwrap_or(options.max_code_size);
        of_file(&mut options, arguments);
        options.robot.included = included(&file, &document, &options.robot);
        edit(&mut options, &arguments.edits)?;
        let files = files(path.iter().cloned(), &arguments.edits, &options);
        let effects = arguments.effects.is_some().then(|| Scene::of_file_effects(&file));
        Ok(Self { file, scene: None, document, options, effects, path, bundled: bundled.is_some(), files })
    }

    /// The robot of a scene: a file, or a bundled one. Arguments replace the values of the scene;
    /// edits are made after the scene's.
    pub(crate) fn of_scene(name: &Path, arguments: &RobotArguments) -> Result<Self, Failure> {
        let (prepared, _) = named_scene::open(name)?;
        let bundled = matches!(prepared.scene.robot, articulated_scene::Robot::Bundled(_));
        let mut request = prepared.request;
        let options = &mut request.options;
        options.robot.base = match (arguments.floating, arguments.fixed) {
            (true, _) => Base::Floating,
            (_, true) => Base::Fixed,
            _ => options.robot.base,
        };
        options.robot.gravity = arguments.gravity.map(|g| g.0).or(options.robot.gravity);
        options.robot.allow_unphysical_inertia |= arguments.allow_unphysical_inertia;
        options.robot.first_of_duplicates |= arguments.first_of_duplicates;
        options.robot.leave_out.extend(&arguments.leave_out);
        options.robot.given_contacts.extend(arguments.given_contact.iter().cloned().map(Into::into));
        options.robot.allow_unknown_version |= arguments.allow_unknown_version;
        options.robot.snap_angles = arguments.snap_angles.or(options.robot.snap_angles);
        arguments.rename.iter().for_each(|(from, to)| options.set_name(from, to));
        if !arguments.arg.is_empty() || !arguments.package.is_empty() {
            of_file(options, arguments);
            options.robot.included.extend(included(&request.file, &request.document, &options.robot));
        }
        options.max_code_size = arguments.max_code_size.unwrap_or(options.max_code_size);
        edit(options, &arguments.edits)?;
        // The scene's effects on all joints apply to the edited robot.
        let Request { document, file, options, mut scene } = request;
        if arguments.effects.is_some() {
            scene.get_or_insert_with(|| Scene::of_file_effects(&file)).add_file_effects("--effects", At::default());
        }
        let files = files(prepared.files.into_iter(), &arguments.edits, &options);
        Ok(Self { file, scene: Some(name.display().to_string()), document, options, effects: scene, path: None, bundled, files })
    }

    /// Refuses a scene's level if its results differ from the library's by more than rounding: a
    /// comparison with the library's would always fail.
    pub(crate) fn has_a_level_of_rounding(&self) -> Result<(), Failure> {
        let level = self.options.level;
        if !level.is_single() && !matches!(level.sines, TrigAccuracy::Fast7 | TrigAccuracy::Fast10) {
            return Ok(());
        }
        let file = self.scene.as_deref().unwrap_or(&self.file);
        Err(Failure::input([format!(
            "{file}: level: found {level}, expected f64 or what is more exact, as results are held to the library's; `articulated accuracy {file}` measures others"
        )]))
    }

    /// The robot with these frames.
    pub(crate) fn with(mut self, arguments: &FrameArguments) -> Self {
        if !arguments.frames.is_empty() {
            self.options.robot.set_frames(arguments.frames.iter().cloned());
        }
        self.options.robot.wrench_reference = arguments.wrenches_in.unwrap_or(self.options.robot.wrench_reference);
        self
    }

    /// The robot with the frames of these links, which the command chose by itself.
    pub(crate) fn on(mut self, frames: &[String]) -> Self {
        let mut request = self.whole_request(&values(&self.options.functions));
        request.set_frames(frames);
        self.options = request.options;
        self
    }

    /// Prints these warnings, a line for each kind; none for a bundled robot, whose warnings only
    /// `check` lists.
    pub(crate) fn warn_of<'a>(&self, warnings: impl Iterator<Item = &'a Diagnostic>) {
        summary(warnings.filter(|_| !self.bundled)).iter().for_each(|line| console::warn(line));
    }

    /// The robot, edited as requested, with its model.
    pub(crate) fn read(&self) -> Result<BuiltRobot, Diagnostics> {
        self.request(&[]).build_robot()
    }

    /// The model with the frames of the request.
    pub(crate) fn model(&self, robot: &BuiltRobot) -> Result<Model<f64>, Failure> {
        Ok(robot.framed(self.whole_model(robot)?))
    }

    /// As [`Robot::model`], with a frame for every link.
    pub(crate) fn whole_model(&self, robot: &BuiltRobot) -> Result<Model<f64>, Failure> {
        has_room(&self.file, robot.model.nv())?;
        Ok(robot.model.clone())
    }

    /// The request for these functions, without a runtime, for callers that write their code or
    /// report its cost.
    pub(crate) fn whole_request(&self, functions: &[String]) -> Request {
        let mut request = Request { scene: self.effects.clone(), ..Request::new(self.file.clone(), self.document.clone()) };
        request.options = self.options.clone();
        request.options.functions = functions.iter().cloned().map(Into::into).collect();
        request
    }

    /// As [`Robot::whole_request`], for callers of the functions with the arguments of the table;
    /// parameters are constants, see [`note_of_parameters`].
    pub(crate) fn request(&self, functions: &[String]) -> Request {
        let mut request = self.whole_request(functions);
        request.options.parameters.clear();
        request
    }

    /// Whether the base floats.
    pub(crate) fn floating(&self) -> bool {
        self.options.robot.base == Base::Floating
    }

    /// The base in a word.
    pub(crate) fn base(&self) -> &'static str {
        if self.floating() { "floating" } else { "fixed" }
    }

    /// Refuses an option whose path is an input file of the robot, which would be replaced.
    pub(crate) fn keeps_its_files(&self, option: &str, path: Option<&Path>) -> Result<(), Failure> {
        match path.filter(|path| self.files.iter().any(|file| output::is_same(file, path))) {
            Some(path) => {
                Err(Failure::usage(format!("{option} {}: found a file that the robot is read from, expected another", path.display())))
            }
            None => Ok(()),
        }
    }

    /// The robot for measurements.
    #[cfg(feature = "measure")]
    pub(crate) fn loaded(&self) -> articulated_lab::robot::Robot {
        let Self { file, scene, document, options, effects, path, .. } = self.clone();
        articulated_lab::robot::Robot { file, scene, document, options, effects, path }
    }
}

/// Refuses a robot with a mass matrix, which every workspace contains, that is too large.
pub(crate) fn has_room(file: &str, nv: usize) -> Result<(), Failure> {
    if nv <= MOST_FREEDOMS {
        return Ok(());
    }
    Err(Failure::input([format!("{file}: found {nv} degrees of freedom, expected at most {MOST_FREEDOMS} to compute with")]))
}

/// The edits, with the documents of the robots to append.
fn edit(options: &mut Options, edits: &Edits) -> Result<(), Failure> {
    for other in &edits.append {
        let (file, document) = document(&other.file, &[])?;
        // Only the robot itself has arguments.
        let own = RobotOptions { arguments: BTreeMap::new(), ..options.robot.clone() };
        options.robot.included.extend(included(&file, &document, &own));
        let (file, at) = (file.into(), other.at.clone().into());
        options.robot.append.push(Appended { document, file, at, prefix: other.prefix.clone(), origin: other.origin });
    }
    options.robot.payloads.extend(edits.payload.iter().cloned().map(Into::into));
    for coupling in &edits.coupling {
        match coupling {
            CouplingArgument::File => options.robot.file_coupling = true,
            CouplingArgument::Joint(one) => options.robot.coupling.push(one.clone().into()),
        }
    }
    options.robot.lock.extend(edits.lock.iter().map(|lock| (lock.joint.clone(), lock.at.clone()).into()));
    Ok(())
}

/// All files of a robot: its own, those of the robots to append, and included ones.
fn files(own: impl Iterator<Item = PathBuf>, edits: &Edits, options: &Options) -> Vec<PathBuf> {
    let appended = edits.append.iter().map(|other| other.file.clone()).filter(|file| file.is_file());
    own.chain(appended).chain(options.robot.included.files().map(|(path, _)| path.to_owned())).collect()
}

/// Takes the arguments of the robot's file, and its packages.
fn of_file(options: &mut Options, arguments: &RobotArguments) {
    options.robot.arguments.extend(arguments.arg.iter().cloned());
    options.robot.packages.extend(arguments.package.iter().map(|package| (package.name.clone(), package.folder.clone())));
}

/// The files that a document includes.
fn included(file: &str, document: &[u8], robot: &RobotOptions) -> Included {
    let (arguments, packages) = (robot.arguments.clone(), robot.packages.clone());
    let options = articulated_formats::Options { file: file.to_owned(), arguments, packages, ..articulated_formats::Options::default() };
    articulated_formats::included(&Environment, Path::new(""), document, &options)
}

/// A file's name for messages, and its bytes: of a bundled robot by its name, the standard input,
/// or a file. `scenes` are other accepted names.
fn document(path: &Path, scenes: &[&str]) -> Result<(String, Vec<u8>), Failure> {
    match path.to_str().and_then(articulated_models::robot) {
        Some(bundled) => Ok((bundled.file(), bundled.urdf.as_bytes().to_vec())),
        None if is_standard_input(path) => Ok(("<stdin>".to_owned(), read_file(path, scenes)?)),
        None => Ok((path.display().to_string(), read_file(path, scenes)?)),
    }
}

fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The bytes of a regular file, up to the maximum size of a robot's file; `-` is the standard
/// input, which can be read only once.
pub(crate) fn read_bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    static TAKEN: AtomicBool = AtomicBool::new(false);
    if !is_standard_input(path) {
        return articulated_formats::read_file(path, MOST_BYTES);
    }
    if TAKEN.swap(true, Ordering::Relaxed) {
        return Err(std::io::Error::other("the standard input is another file of this command already"));
    }
    read_at_most(std::io::stdin().lock(), MOST_BYTES)
}

fn read_file(path: &Path, scenes: &[&str]) -> Result<Vec<u8>, Failure> {
    read_bytes(path).map_err(|error| {
        let name = path.to_string_lossy();
        if is_standard_input(path) || path.exists() {
            return Failure::input([format!("{name}: cannot be read: {error}")]);
        }
        let names = || articulated_models::ROBOTS.iter().map(|r| r.name);
        let bundled = || nearest(&name, names().chain(scenes.iter().copied()));
        let near = nearest_file(path).or_else(bundled).map(|n| format!("; did you mean {n:?}?")).unwrap_or_default();
        let known = names().collect::<Vec<_>>().join(", ");
        Failure::input([format!("{name}: found neither a file ({error}) nor a bundled robot{near} (bundled: {known})")])
    })
}

/// The model of a bundled robot.
#[cfg(test)]
pub(crate) fn bundled_model(name: &str) -> Model<f64> {
    let robot = articulated_models::robot(name).unwrap();
    let options = articulated_formats::Options { base: robot.base, ..articulated_formats::Options::default() };
    Model::new(&articulated_formats::read(robot.urdf.as_bytes(), &options).unwrap().description, robot.base).unwrap()
}
