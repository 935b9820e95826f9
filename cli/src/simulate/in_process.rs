//! Scenes for programs: `articulated simulate` with values in place of a command line and console
//! output.

use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;

use articulated::simulate::Settings;
use articulated_lab::console::{Progress, collect};
use articulated_lab::session::{Generic, Session};

use super::arguments::{self, SimulateArguments};
use super::files::{FIELDS, Files};
use super::motion::{self, Motion};
use super::of_file::OfFile;
use super::settings;
use super::summary::Summary;
use super::table;
use crate::arguments::Package;
use crate::failure::Failure;
use crate::named_scene;
use crate::robot::has_room;

pub use super::table::Column;

/// The reason for a missing scene, motion or file.
#[derive(Clone, Debug)]
pub struct Refusal {
    /// A line for each error.
    pub message: String,
    /// The errors as JSON: an object whose `errors` are as in the command's reports.
    pub json: String,
}

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        let lines: Vec<&str> = failure.errors.iter().map(|error| error.message.as_str()).collect();
        Self { message: lines.join("\n"), json: crate::json(&failure) }
    }
}

/// A caller's replacements for the scene's `[simulation]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// The last time, s.
    pub end: Option<f64>,
    /// The integrator's name.
    pub integrator: Option<String>,
    /// Fixed steps of this length, s.
    pub step: Option<f64>,
    /// Relative tolerance of a step.
    pub rtol: Option<f64>,
    /// Absolute tolerance of a step, rad, m, and the same per second.
    pub atol: Option<f64>,
    /// Seconds between two records.
    pub every: Option<f64>,
}

impl Changes {
    fn arguments(&self) -> Result<SimulateArguments, Failure> {
        let wrong = |key: &str, found: String, expected: &str| format!("{key}: found {found}, expected {expected}");
        let mut errors = Vec::new();
        if let Some(end) = self.end.filter(|end| !end.is_finite()) {
            errors.push(wrong("end", end.to_string(), "a finite number of seconds"));
        }
        for (key, given) in [("step", self.step), ("every", self.every)] {
            if let Some(x) = given.filter(|x| !(*x > 0.0 && x.is_finite())) {
                errors.push(wrong(key, x.to_string(), "a finite number of seconds greater than 0"));
            }
        }
        for (key, given) in [("rtol", self.rtol), ("atol", self.atol)] {
            if given.is_some() && self.step.is_some() {
                errors.push(wrong(key, format!("{key} beside step"), "one of them: steps are fixed, or chosen by tolerances"));
            }
        }
        if let Some(Err(names)) = self.integrator.as_deref().map(arguments::integrator) {
            errors.push(format!("integrator: found {:?}; {names}", self.integrator.as_deref().unwrap_or_default()));
        }
        if !errors.is_empty() {
            return Err(Failure::input(errors));
        }
        let Self { end, integrator, step, rtol, atol, every } = self.clone();
        Ok(SimulateArguments { end, integrator, step, rtol, atol, every, is_program: true, ..SimulateArguments::default() })
    }
}

/// A scene with its robot.
#[derive(Clone)]
pub struct Scene {
    session: Arc<Session>,
}

/// A motion, with all that is recorded of it.
pub struct Recorded {
    session: Arc<Session>,
    motion: Motion,
    settings: Settings,
    summary: Summary,
}

/// A value and the warnings on the way to it.
pub type WithWarnings<T> = (Result<T, Refusal>, Vec<String>);

pub(super) fn warned<T>(run: impl FnOnce() -> Result<T, Failure>) -> WithWarnings<T> {
    let (out, warnings) = collect(run);
    (out.map_err(Refusal::from), warnings)
}

impl Scene {
    /// A bundled scene by its name, or that of a file.
    pub fn open(scene: &Path) -> WithWarnings<Self> {
        warned(|| {
            let session = named_scene::session(scene)?;
            has_room(&session.scene.file, session.model.nv())?;
            Ok(Self { session: Arc::new(session) })
        })
    }

    /// Its name, without folder and ending.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.session.name
    }

    /// Runs it by the generic library. `go_on` is called after each step, and returns false to stop
    /// the run.
    pub fn run(&self, changes: &Changes, go_on: &mut dyn FnMut() -> bool) -> WithWarnings<Recorded> {
        warned(|| {
            let session = &self.session;
            let settings = changes.arguments().and_then(|arguments| settings::of(session, &arguments));
            let (settings, initial) = Failure::both(settings, session.start().map_err(Failure::from))?;
            motion::solvable(session)?;
            let (mut settings, progress) = (settings, Progress::hidden());
            let motion = match session.scene.law() {
                None => motion::run(session, &initial, &Generic, &settings, &progress, go_on)?,
                Some(_) if changes.choose_steps() => {
                    let expected = "no integrator and no tolerances: steps are those of the robot's file";
                    return Err(Failure::input([format!("{}: found simulation.law, expected {expected}", session.scene.file)]));
                }
                Some(_) => OfFile::of_scene(session, &initial, &mut settings)?.run(session, &settings, &progress, go_on)?,
            };
            let summary = Summary::new(session, &motion, &settings, "generic");
            for warning in summary.out_of_balance().iter().chain(&motion.error) {
                crate::console::warn(&format!("{}: {warning}", session.scene.file));
            }
            Ok(Recorded { session: Arc::clone(session), motion, settings, summary })
        })
    }
}

impl Changes {
    /// Whether they say how steps are chosen.
    fn choose_steps(&self) -> bool {
        self.integrator.is_some() || self.rtol.is_some() || self.atol.is_some()
    }
}

impl Recorded {
    /// The columns of `recording.csv`.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        table::columns(&self.motion.recording)
    }

    /// Lengths of a state: nq and nv.
    #[must_use]
    pub fn sizes(&self) -> (usize, usize) {
        (self.motion.recording.q_names.len(), self.motion.recording.v_names.len())
    }

    /// The contents of `summary.json`, without files.
    #[must_use]
    pub fn summary(&self) -> String {
        crate::json(&self.summary)
    }

    /// Writes a folder with all files, or only a page if the path ends with `.html`. `packages`:
    /// folders of ROS packages, `NAME=FOLDER` or `FOLDER`, for meshes. Returns the paths or names
    /// of the written files.
    pub fn write<P: AsRef<OsStr>>(&self, path: &Path, packages: &[P]) -> WithWarnings<Vec<String>> {
        warned(|| {
            let package = |text: &P| Package::parse(&text.as_ref().to_string_lossy());
            let packages: Result<Vec<Package>, String> = packages.iter().map(package).collect();
            let packages = packages.map_err(|error| Failure::input([format!("packages: {error}")]))?;
            let mut summary = self.summary.clone();
            Files::at(path, &packages, &self.settings, FIELDS)?.write(&self.session, &self.motion, &mut summary)?;
            Ok(summary.files)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused<T>(out: WithWarnings<T>) -> String {
        out.0.err().expect("a refusal").message
    }

    #[test]
    fn a_scene_runs_in_process_and_gives_the_columns_and_files_of_the_command() {
        let (scene, warnings) = Scene::open(Path::new("pendulum"));
        let (scene, changes) = (scene.unwrap(), Changes { end: Some(0.1), ..Changes::default() });
        assert!(warnings.is_empty() && scene.name() == "pendulum", "{warnings:?}");
        let recorded = scene.run(&changes, &mut || true).0.unwrap();
        let columns = recorded.columns();
        assert_eq!((columns[0].title.as_str(), recorded.sizes()), ("t", (1, 1)));
        assert_eq!(columns[0].values.last(), Some(&0.1));
        let folder = tempfile::tempdir().unwrap();
        let files = recorded.write(folder.path(), &[] as &[&str]).0.unwrap();
        assert!(files.iter().all(|name| folder.path().join(name).is_file()) && files.contains(&"motion.html".to_owned()), "{files:?}");
        let mut steps = 0;
        let count = |steps: &mut usize| {
            *steps += 1;
            *steps < 2
        };
        let short = scene.run(&changes, &mut || count(&mut steps)).0.unwrap();
        assert!(short.columns()[0].values.len() < columns[0].values.len());
    }

    #[test]
    fn messages_name_fields_and_no_options() {
        assert!(refused(Scene::open(Path::new("pendulun"))).contains("did you mean \"pendulum\"?"));
        let scene = Scene::open(Path::new("pendulum")).0.unwrap();
        let run = |changes: Changes| refused(scene.run(&changes, &mut || true));
        let wrong = run(Changes { end: Some(f64::NAN), every: Some(0.0), integrator: Some("rk5".into()), ..Changes::default() });
        assert_eq!(wrong.lines().count(), 3, "{wrong}");
        let fixed = run(Changes { integrator: Some("rk4".into()), rtol: Some(1e-3), step: Some(1e-3), ..Changes::default() });
        let end = run(Changes { end: Some(-1.0), ..Changes::default() });
        assert!(end.starts_with("end: found") && !format!("{wrong}{fixed}{end}").contains("--"), "{end} {fixed}");
    }
}
