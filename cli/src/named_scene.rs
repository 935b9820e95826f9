//! Scenes by the words of a command line: a bundled one by its name, or a file.

use std::path::{Path, PathBuf};

use articulated_codegen::nearest;
use articulated_codegen::scene::{self, Bundled, Prepared, Scene};
use articulated_formats::{FORMATS, Formats, LeaveOut, MOST_BYTES, nearest_file, read_file};
use articulated_lab::session::Session;
use articulated_scene::folder_of;

use crate::console;
use crate::failure::Failure;
use crate::robot_scene;

/// Whether a word names a scene if robots are accepted too; names of robots have precedence.
pub(crate) fn is_scene(path: &Path) -> bool {
    let is_bundled = |name| articulated_models::scene(name).is_some() && articulated_models::robot(name).is_none();
    path.to_str().is_some_and(is_bundled) || ends_with(path, "toml")
}

/// The scene, and the folder of its file. A bundled one has precedence over a file of its name,
/// like a bundled robot: `./name` is the file.
pub(crate) fn open(path: &Path) -> Result<(Prepared, PathBuf), Failure> {
    open_without(path, &[])
}

/// The same without these kinds of what a robot's file has.
fn open_without(path: &Path, leave_out: &[LeaveOut]) -> Result<(Prepared, PathBuf), Failure> {
    if let Some(bundled) = path.to_str().and_then(articulated_models::scene) {
        let scene = Scene::read(&bundled.file(), bundled.toml)?;
        return Ok((scene::open_in(scene, Path::new(""), &robots())?, PathBuf::new()));
    }
    let name = &path.to_string_lossy();
    if !path.exists() {
        return Err(unknown(name));
    }
    if is_robot(path) {
        let folder = folder_of(path);
        let scene = Scene::made_for(name, &robot_scene::text(path, leave_out)?)?;
        return Ok((scene::open_in(scene, folder, &robots())?, folder.to_owned()));
    }
    Ok((scene::open(path, &robots())?, path.parent().map(Path::to_owned).unwrap_or_default()))
}

/// Whether a path is a robot's file, by its ending or its content: [`robot_scene`] makes a scene of
/// it.
pub(crate) fn is_robot(path: &Path) -> bool {
    if !path.is_file() || ends_with(path, "toml") {
        return false;
    }
    let has_ending = path.extension().is_some_and(|ending| Formats::default().has_ending(&ending.to_string_lossy()));
    let recognized = |bytes: Vec<u8>| FORMATS.iter().any(|format| format.recognizes(&bytes));
    has_ending || read_file(path, MOST_BYTES).is_ok_and(recognized)
}

/// The scene with its robot. Warnings about the robot are printed.
pub(crate) fn session(path: &Path) -> Result<Session, Failure> {
    session_without(path, &[])
}

/// The same without these kinds of what a robot's file has.
pub(crate) fn session_without(path: &Path, leave_out: &[LeaveOut]) -> Result<Session, Failure> {
    let session = session_of(path, open_without(path, leave_out)?)?;
    session.robot_warnings.iter().for_each(|line| console::warn(line));
    Ok(session)
}

/// The same without warnings.
pub(crate) fn quiet_session(path: &Path) -> Result<Session, Failure> {
    session_of(path, open(path)?)
}

fn session_of(path: &Path, (prepared, folder): (Prepared, PathBuf)) -> Result<Session, Failure> {
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    Ok(Session::new(name, prepared, folder)?)
}

fn ends_with(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending))
}

/// The robots that scenes may call by name.
fn robots() -> Vec<Bundled<'static>> {
    let all = articulated_models::ROBOTS.iter().chain(articulated_models::MJCF);
    all.map(|robot| Bundled { name: robot.name, document: robot.urdf, base: robot.base }).collect()
}

fn unknown(name: &str) -> Failure {
    let names = || articulated_models::SCENES.iter().chain(articulated_models::LAW_SCENES).map(|s| s.name);
    let bundled = || nearest(name.strip_suffix(".toml").unwrap_or(name), names());
    let near = nearest_file(name.as_ref()).or_else(bundled).map(|n| format!("; did you mean {n:?}?")).unwrap_or_default();
    let robot = if articulated_models::robot(name).is_some() { "; that is a robot, and a scene says what to do with it" } else { "" };
    let known = names().collect::<Vec<_>>().join(", ");
    Failure::input([format!("{name}: found neither a file nor a bundled scene{robot}{near} (bundled: {known})")])
}
