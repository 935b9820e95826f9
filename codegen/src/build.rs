//! The build-script interface.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use articulated_core::algorithm::UserFunction;
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Span, Spanned, summary};
use articulated_formats::LeaveOut;
use articulated_formats::world::GivenContact;
use articulated_scene::{Loader, Robot, Scene, beside};

use crate::cache::Cache;
use crate::{Appended, Base, Coupling, Generated, Origin, Payload, Real, Reference, Request, RobotOptions, Target, generate, scene};

/// Generates a robot's code from a build script.
///
/// ```no_run
/// // build.rs
/// use articulated_codegen::{Build, Payload};
///
/// Build::new("robots/arm.urdf") // from the crate's folder
///     .functions(["inverse_dynamics", "hold = inverse_dynamics(v = 0, a = 0)"])
///     .payload(Payload { link: "tool".into(), mass: 0.5, ..Payload::default() }) // kg
///     .lock("elbow", [0.5]) // rad
///     .batch(["f64"])
///     .write("arm"); // $OUT_DIR/arm.rs
/// ```
/// and in the crate:
/// `#[allow(dead_code)] mod arm { include!(concat!(env!("OUT_DIR"), "/arm.rs")); }`.
#[derive(Clone, Debug)]
pub struct Build {
    /// The request, without its documents.
    request: Request,
    /// The place that names the robot's file, if a scene does.
    robot: Span,
    /// The scene's file, if any.
    scene: Option<String>,
    /// Findings about the words of the calls, and about the scene.
    findings: Diagnostics,
}

/// A type of numbers of [`Build::batch`]: a [`Real`], or its name, `"f64"` or `"f32"`.
#[derive(Clone, Debug)]
pub struct BatchType(Result<Real, String>);

impl From<Real> for BatchType {
    fn from(real: Real) -> Self {
        Self(Ok(real))
    }
}

impl From<&str> for BatchType {
    fn from(name: &str) -> Self {
        let real = [Real::F64, Real::F32].into_iter().find(|real| real.name() == name);
        Self(real.ok_or_else(|| name.to_owned()))
    }
}

impl From<String> for BatchType {
    fn from(name: String) -> Self {
        Self::from(name.as_str())
    }
}

/// Result of writing a file in a build script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The file; of C the header.
    pub path: PathBuf,
    /// Warnings about values of the document that were used as written: one line for each sort.
    pub warnings: Vec<String>,
    /// Whether it was generated now; if not, the file of the last run is kept, which had the same
    /// request.
    pub generated: bool,
}

impl Build {
    /// For the robot file at `path`, relative to the crate's folder.
    pub fn new(path: impl AsRef<Path>) -> Self {
        let mut request = Request::new(path.as_ref().display().to_string(), []);
        request.options.rust_mut().runtime = Some("::articulated".into());
        Self { request, robot: Span::default(), scene: None, findings: Diagnostics::default() }
    }

    /// For the scene at `path`, relative to the crate's folder. Later calls replace entries of the
    /// scene; locks, loads and robots to append are added to the scene's. Effects act on the robot
    /// as it is generated.
    ///
    /// ```no_run
    /// // build.rs
    /// articulated_codegen::Build::scene("scenes/arm.toml").functions(["forward_dynamics"]).write("arm");
    /// ```
    pub fn scene(path: impl AsRef<Path>) -> Self {
        let name = path.as_ref().display().to_string();
        let mut build = Self::new("");
        let scene = loader().scene(path.as_ref(), &Span::default(), &mut build.findings);
        if let Some(found) = scene {
            scene::fill(&mut build.request.options, &found);
            for other in &mut build.request.options.robot.append {
                other.file.value = beside(&name, &other.file);
            }
            if let Robot::File(file) = &found.robot {
                build.request.file = beside(&name, file);
                build.robot = Span { file: name.clone(), at: found.code.places.robot };
            }
            build.request.scene = Some(found);
        }
        Self { scene: Some(name), ..build }
    }

    /// The robot, if the scene does not name its file, or another one: the file at `path`, relative
    /// to the crate's folder.
    #[must_use]
    pub fn urdf(mut self, path: impl AsRef<Path>) -> Self {
        self.request.file = path.as_ref().display().to_string();
        self.robot = Span::default();
        self
    }

    /// A floating base.
    #[must_use]
    pub fn floating(mut self) -> Self {
        self.request.options.robot.base = Base::Floating;
        self
    }

    /// A fixed base; overrides that of a scene.
    #[must_use]
    pub fn fixed(mut self) -> Self {
        self.request.options.robot.base = Base::Fixed;
        self
    }

    /// Angles of the file that are this near to a multiple of π/2, rad, above 0, at most
    /// [`MOST_SNAPPED`](crate::MOST_SNAPPED), are that: some exporters write 1.5708.
    #[must_use]
    pub fn snap_angles(mut self, tolerance: f64) -> Self {
        self.request.options.robot.snap_angles = Some(tolerance);
        self
    }

    /// The value of an argument that the robot's file declares (`<xacro:arg>`).
    #[must_use]
    pub fn arg(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.request.options.robot.arguments.insert(name.into(), value.into());
        self
    }

    /// The folder of a package that the robot's file includes files from (`$(find name)`), relative
    /// to the crate's folder. Not needed for packages around the file.
    #[must_use]
    pub fn package(mut self, name: impl Into<String>, folder: impl AsRef<Path>) -> Self {
        self.request.options.robot.packages.insert(name.into(), folder.as_ref().to_owned());
        self
    }

    /// Inertia that no body can have is used as it is written, with a warning.
    #[must_use]
    pub fn allow_unphysical_inertia(mut self) -> Self {
        self.request.options.robot.allow_unphysical_inertia = true;
        self
    }

    /// The first of tags of a URDF or SDF that should be there once is used, with a warning.
    #[must_use]
    pub fn first_of_duplicates(mut self) -> Self {
        self.request.options.robot.first_of_duplicates = true;
        self
    }

    /// MJCF elements of these kinds that change the motion and are not supported are ignored, with
    /// a warning. Elements of other kinds are errors.
    #[must_use]
    pub fn leave_out(mut self, kinds: impl IntoIterator<Item = LeaveOut>) -> Self {
        self.request.options.robot.leave_out.extend(kinds);
        self
    }

    /// Contacts of these geoms of an MJCF are found by the caller, in so many places: an argument
    /// of functions of the group `given_contacts`. Normals are from the first geom to the second.
    #[must_use]
    pub fn given_contact(mut self, first: impl Into<String>, second: impl Into<String>, places: usize) -> Self {
        let given = GivenContact { shapes: [first.into(), second.into()], places };
        self.request.options.robot.given_contacts.push(given.into());
        self
    }

    /// A URDF of a version other than 1.0, 1.1 and 1.2 is read as 1.0, with a warning.
    #[must_use]
    pub fn allow_unknown_version(mut self) -> Self {
        self.request.options.robot.allow_unknown_version = true;
        self
    }

    /// The constants of the joint or link `from` are named `to`; replaces earlier names of it.
    #[must_use]
    pub fn rename(mut self, from: impl Into<String>, to: impl Into<String>) -> Self {
        self.request.options.set_name(&from.into(), &to.into());
        self
    }

    /// Gravity in the world frame, m/s².
    #[must_use]
    pub fn gravity(mut self, gravity: [f64; 3]) -> Self {
        self.request.options.robot.gravity = Some(gravity);
        self
    }

    /// Requested functions: names, groups, `name = first + second(a = 0)`; with a scene also
    /// `motion`, for all functions that its motion calls.
    #[must_use]
    pub fn functions<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        let options = &mut self.request.options;
        options.functions = names.into_iter().map(|name| name.into().into()).collect();
        for user in options.users.iter() {
            if options.functions.iter().all(|name| name.trim() != user.name) {
                options.functions.push(user.name.into());
            }
        }
        self
    }

    /// Adds a function of your own ([`user_function!`](articulated_core::user_function)): it is
    /// generated under its name, and [`functions`](Self::functions) and derivatives may name it.
    ///
    /// ```no_run
    /// // build.rs
    /// # use articulated_codegen::Build;
    /// # use articulated_codegen::core::{algorithm::potential_energy, user_function};
    /// user_function! {
    ///     /// k U(q): the potential energy, weighed.
    ///     pub struct Weighed;
    ///     fn weighed<S>(robot, work, q: [Nq] "rad", k: [] "1") -> (cost: [] "J") {
    ///         potential_energy(robot, work, q, cost);
    ///         cost[0] *= k[0];
    ///     }
    /// }
    /// let build = Build::new("robots/arm.urdf").functions(["slope = gradient(weighed, q)"]);
    /// build.function(Weighed).write("arm");
    /// ```
    #[must_use]
    pub fn function<F: UserFunction>(mut self, function: F) -> Self {
        let options = &mut self.request.options;
        options.users.push(function);
        if options.functions.iter().all(|name| name.trim() != F::NAME) {
            options.functions.push(F::NAME.into());
        }
        self
    }

    /// Constants of the model that stay inputs: `payload(link)`, `inertia(link)`, `origin(joint)`,
    /// `gravity`, and numbers of an effect that is on, as `damping(joint)`, `contact(link)`.
    #[must_use]
    pub fn parameters<N: Into<String>>(mut self, entries: impl IntoIterator<Item = N>) -> Self {
        self.request.options.parameters = entries.into_iter().map(|entry| entry.into().into()).collect();
        self
    }

    /// Links whose frames the functions of frames compute.
    #[must_use]
    pub fn frames<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.request.options.robot.set_frames(names);
        self
    }

    /// Reference of the wrench arguments.
    #[must_use]
    pub fn wrenches_in(mut self, reference: Reference) -> Self {
        self.request.options.robot.wrench_reference = reference;
        self
    }

    /// Lets a joint follow others: differential and tendon drives.
    #[must_use]
    pub fn coupling(mut self, coupling: Coupling) -> Self {
        self.request.options.robot.coupling.push(coupling.into());
        self
    }

    /// Couples joints by the linear equations of the robot's file (MJCF).
    #[must_use]
    pub fn file_coupling(mut self) -> Self {
        self.request.options.robot.file_coupling = true;
        self
    }

    /// Lets the smooth effects of the robot's file act: damping, springs and armature of joints,
    /// compensated weight, the medium. Those that the scene names are the scene's.
    #[must_use]
    pub fn file_effects(mut self) -> Self {
        let scene = self.request.scene.get_or_insert_with(|| Scene { file: self.request.file.clone(), ..Scene::default() });
        scene.add_file_effects("Build::file_effects", At::default());
        self
    }

    /// Locks a joint at these coordinates, one for each of its own: rad or m, a quaternion as x, y,
    /// z, w. Joints that follow it are locked with it.
    #[must_use]
    pub fn lock(mut self, joint: impl Into<String>, at: impl Into<Vec<f64>>) -> Self {
        self.request.options.robot.lock.push((joint.into(), at.into()).into());
        self
    }

    /// Attaches a load to a link.
    #[must_use]
    pub fn payload(mut self, payload: Payload) -> Self {
        self.request.options.robot.payloads.push(payload.into());
        self
    }

    /// Appends the robot of the file at `path`, relative to the crate's folder: its root at
    /// `origin` in the frame of the link `at`, `prefix` before its names.
    #[must_use]
    pub fn append(mut self, path: impl AsRef<Path>, at: impl Into<String>, prefix: impl Into<String>, origin: Origin) -> Self {
        let file = Spanned::from(path.as_ref().display().to_string());
        let other = Appended { document: Vec::new(), file, at: at.into().into(), prefix: prefix.into(), origin };
        self.request.options.robot.append.push(other);
        self
    }

    /// Another language than Rust, for a build script that also compiles it. `write("arm")` writes
    /// `$OUT_DIR/arm.h`, and `arm.c` unless one header is requested; the prefix of all names is
    /// `arm`, or that of the options. Calls for Rust alone, as [`Build::no_std`], make the language
    /// Rust again.
    ///
    /// ```no_run
    /// // build.rs, beside the crate `cc`
    /// use articulated_codegen::{Build, COptions, Target};
    ///
    /// let c = Target::C(COptions::default());
    /// Build::new("robots/arm.urdf").functions(["inverse_dynamics"]).language(c).write("arm");
    /// let source = format!("{}/arm.c", std::env::var("OUT_DIR").unwrap());
    /// // cc::Build::new().file(source).compile("arm");
    /// ```
    #[must_use]
    pub fn language(mut self, target: Target) -> Self {
        self.request.options.target = target;
        self
    }

    /// Code that depends on nothing but `core` and `std`: no implementation of the trait
    /// `Dynamics`.
    #[must_use]
    pub fn standalone(mut self) -> Self {
        self.request.options.rust_mut().runtime = None;
        self
    }

    /// Also functions of many states, in numbers of these types: `["f64", "f32"]` or [`Real`]s.
    /// Their modules are `batch_f64` and `batch_f32`. An unknown type is an error of the
    /// generation.
    #[must_use]
    pub fn batch<R: Into<BatchType>>(mut self, reals: impl IntoIterator<Item = R>) -> Self {
        self.findings.errors.retain(|error| error.code != Code::Batch);
        self.request.options.batch.clear();
        for real in reals {
            match real.into().0 {
                Ok(real) => self.request.options.batch.push(real),
                Err(name) => {
                    let place = (At::Nowhere, "batch");
                    self.findings.push(Diagnostic::error("", place, Code::Batch, format!("{name:?}"), "\"f64\" or \"f32\""));
                }
            }
        }
        self
    }

    /// How accurate the functions are.
    #[must_use]
    pub fn level(mut self, level: crate::Precision) -> Self {
        self.request.options.level = level;
        self
    }

    /// Whether isomorphic branches may be computed together, one per lane of a vector, where that
    /// is cheaper. Default: `true`.
    #[must_use]
    pub fn limbs(mut self, at_once: bool) -> Self {
        self.request.options.limbs = at_once;
        self
    }

    /// No `unsafe` in the generated code, for crates that forbid it: no limbs in lanes, and no
    /// choice of instructions when it runs.
    #[must_use]
    pub fn forbid_unsafe(mut self) -> Self {
        self.request.options.rust_mut().forbid_unsafe = true;
        self
    }

    /// For crates without `std`. They must depend on the crate `libm`, which computes square roots,
    /// arctangents, and sines of angles beyond the range of the level. No `unsafe`, multiply-adds
    /// or implementation of the trait `Dynamics`, regardless of other options.
    #[must_use]
    pub fn no_std(mut self) -> Self {
        self.request.options.rust_mut().no_std = true;
        self
    }

    /// How many megabytes (10⁶ bytes) of Rust all functions together may become, instead of
    /// [`MAX_CODE_SIZE`](crate::MAX_CODE_SIZE). More is an error.
    #[must_use]
    pub fn max_code_size(mut self, megabytes: u64) -> Self {
        self.request.options.max_code_size = megabytes;
        self
    }

    /// Any other choice.
    #[must_use]
    pub fn options(mut self, change: impl FnOnce(&mut crate::Options)) -> Self {
        change(&mut self.request.options);
        self
    }

    /// Reads the robot's file, and those to append, and generates. Nothing is written or printed.
    pub fn generate(&self) -> Result<Generated, Diagnostics> {
        generate(&self.request()?)
    }

    /// Generates and writes `$OUT_DIR/<name>.rs`, and reports its dependencies to cargo. For build
    /// scripts.
    ///
    /// If the last run wrote the file for the same request, and the build script is the same
    /// program, nothing is generated and nothing written: the file keeps its date. Error: this run
    /// has already written a file of this name, which would be lost.
    pub fn try_write(&self, name: &str) -> Result<Written, Diagnostics> {
        let appended = self.request.options.robot.append.iter().map(|other| &other.file.value);
        let files = self.scene.iter().chain([&self.request.file]).chain(appended);
        for file in files.filter(|file| !file.is_empty()) {
            println!("cargo::rerun-if-changed={}", from_root(Path::new(file)).display());
        }
        let folder = std::env::var_os("OUT_DIR").map(PathBuf::from).unwrap_or_default();
        let file = folder.join(name);
        if !names_written().insert(file.clone()) {
            return Err(file_error(name, "found a name that this build script has written already, expected one for each robot"));
        }
        let written = self.write_in(&folder, name).inspect_err(|_| _ = names_written().remove(&file))?;
        for warning in &written.warnings {
            println!("cargo::warning={warning}");
        }
        Ok(written)
    }

    fn write_in(&self, folder: &Path, name: &str) -> Result<Written, Diagnostics> {
        let mut request = self.request()?;
        for (included, _) in request.options.robot.included.files() {
            println!("cargo::rerun-if-changed={}", from_root(included).display());
        }
        request.options.stages = false;
        let path = file_in(folder, name)?;
        if let Target::C(c) = &mut request.options.target {
            c.prefix.get_or_insert_with(|| name.to_owned());
            return write_c(folder, &request);
        }
        // The cache does not see what a function of the user contains.
        let cache = if request.options.users.is_empty() { Cache::new(&path, &request) } else { None };
        if let Some(warnings) = cache.as_ref().and_then(Cache::warnings) {
            return Ok(Written { path, warnings, generated: false });
        }
        let generated = generate(&request)?;
        let warnings = summary(&generated.warnings);
        cache.iter().for_each(Cache::forget);
        write_changed(&path, &generated.source)?;
        cache.iter().for_each(|cache| cache.remember(&warnings));
        Ok(Written { path, warnings, generated: true })
    }

    /// The request, with the files read.
    fn request(&self) -> Result<Request, Diagnostics> {
        let (mut request, mut log, mut loader) = (self.request.clone(), self.findings.clone(), loader());
        let mut is_complete = !request.file.is_empty();
        match (&request.scene, request.file.as_str()) {
            (Some(scene), "") if !scene.doubts_robot() => log.push(
                scene.without_robot("no robot", "file; a bundled robot is known to the command line alone: give its file with Build::urdf"),
            ),
            (_, "") => {}
            (_, file) => {
                let document = loader.read(file.as_ref(), &self.robot, "urdf", &mut log);
                is_complete = document.is_some();
                request.document = document.unwrap_or_default();
                loader.include(file, &request.document, &request.options.robot);
            }
        }
        let mut append = std::mem::take(&mut request.options.robot.append);
        // Arguments apply to the robot only.
        let own = RobotOptions { arguments: BTreeMap::new(), ..request.options.robot.clone() };
        for other in &mut append {
            let span = other.file.span.clone().unwrap_or_default();
            let document = loader.read(other.file.value.as_ref(), &span, "append.urdf", &mut log);
            is_complete &= document.is_some();
            other.document = document.unwrap_or_default();
            loader.include(&other.file.value, &other.document, &own);
        }
        request.options.robot.append = append;
        request.options.robot.included = loader.included.clone();
        if !log.is_ok() {
            // Other errors of the request; without the robot only those of its words.
            scene::check_rest(&request, is_complete, &mut log);
        }
        log.result(request)
    }

    /// As [`Build::try_write`]; on an error prints it for cargo and ends the build script with
    /// status 1.
    pub fn write(&self, name: &str) {
        if let Err(error) = self.try_write(name) {
            print!("{}", for_cargo(&error));
            std::process::exit(1);
        }
    }
}

/// Generates C and writes its files.
fn write_c(folder: &Path, request: &Request) -> Result<Written, Diagnostics> {
    let generated = generate(request)?;
    for file in &generated.files {
        write_changed(&folder.join(&file.name), &file.text)?;
    }
    let path = folder.join(&generated.files[0].name);
    Ok(Written { path, warnings: summary(&generated.warnings), generated: true })
}

/// An unchanged file keeps its date, so that nothing is recompiled.
fn write_changed(path: &Path, text: &str) -> Result<(), Diagnostics> {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    fs::write(path, text).map_err(|e| file_error(&path.display().to_string(), e.to_string()))
}

/// Files that this build script has written, so that a second robot does not overwrite the first.
fn names_written() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    static WRITTEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    WRITTEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// `name`.rs in the folder. Errors: `name` is not a file name, or names a file elsewhere.
fn file_in(folder: &Path, name: &str) -> Result<PathBuf, Diagnostics> {
    if Path::new(name).file_name().is_some_and(|file| file == name) {
        return Ok(folder.join(format!("{name}.rs")));
    }
    Err(file_error(name, "found something else than a plain file name, expected one, without folders and `.rs`, as \"arm\""))
}

/// A file that cannot be written.
fn file_error(name: &str, reason: impl Into<String>) -> Diagnostics {
    Diagnostic::refusal(name, Place::DOCUMENT, Code::File, reason).into()
}

/// Files of the crate that the build script belongs to.
fn loader() -> Loader<'static> {
    Loader { root: from_root(Path::new("")), ..Loader::default() }
}

/// Findings in the words by which a build script reports them to cargo.
fn for_cargo(findings: &Diagnostics) -> String {
    let errors = findings.errors.iter().map(|error| format!("cargo::error={error}\n"));
    errors.chain(summary(&findings.warnings).into_iter().map(|line| format!("cargo::warning={line}\n"))).collect()
}

/// A path as seen from the crate's folder.
fn from_root(path: &Path) -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default().join(path)
}

#[cfg(test)]
mod tests;
