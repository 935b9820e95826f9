//! From a scene to a request.

use std::fs;
use std::path::{Path, PathBuf};

use articulated_core::description::Base;
use articulated_scene::{At, Edited, Kind, Resolved, Robot, SceneError, SceneErrors};

pub use articulated_scene::{self, Scene};

use crate::edit::{model, read_with_shafts};
use crate::request::Appended;
use crate::{Edit, Error, Options, Reason, Refusal, Request};

/// A scene and the request that it amounts to.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// The robot, its edits and its effects.
    pub request: Request,
    /// The effects, where the scene asks for them, and what is on, off and not used.
    pub resolved: Resolved,
    /// The files that were read: the scene, the robot, and those appended.
    pub files: Vec<PathBuf>,
}

/// A bundled robot's URDF and the base that it is meant for, by its name.
pub type Bundled<'a> = &'a dyn Fn(&str) -> Option<(&'static str, Base)>;

/// The scene at `path` with its robot. Files that it names are seen from its folder.
pub fn open(path: &Path, bundled: Bundled<'_>) -> Result<Prepared, Error> {
    let file = path.display().to_string();
    let scene = Scene::read_bytes(&file, &bytes(path)?)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut prepared = open_in(scene, folder, bundled)?;
    prepared.files.insert(0, path.to_owned());
    Ok(prepared)
}

/// A scene that was read, with its robot. Files that it names are seen from `folder`.
pub fn open_in(mut scene: Scene, folder: &Path, bundled: Bundled<'_>) -> Result<Prepared, Error> {
    scene.code.append.iter_mut().for_each(|other| other.urdf = folder.join(&other.urdf).display().to_string());
    let mut files = Vec::new();
    let (file, urdf, base) = match &scene.robot {
        Robot::Urdf(name) => {
            let path = folder.join(name);
            files.push(path.clone());
            (path.display().to_string(), bytes(&path)?, Base::Fixed)
        }
        Robot::Bundled(name) => match bundled(name) {
            Some((urdf, base)) => (format!("{name}.urdf"), urdf.as_bytes().to_vec(), base),
            None => {
                return Err(no_robot(&scene, "a bundled robot that there is not", &format!("the name of a bundled robot, not {name:?}")));
            }
        },
        Robot::Given => return Err(no_robot(&scene, "no robot", "robot, or urdf")),
    };
    let append = scene.code.append.iter().map(|other| {
        files.push(PathBuf::from(&other.urdf));
        bytes(Path::new(&other.urdf))
    });
    let append = append.collect::<Result<Vec<_>, _>>()?;
    Ok(Prepared { files, ..prepare(scene, &file, urdf, base, append)? })
}

/// The request of a scene for the robot in `urdf`; `append` are the documents that it appends. Nothing is opened. `base` is taken where the scene does not say.
pub fn prepare(scene: Scene, file: &str, urdf: Vec<u8>, base: Base, append: Vec<Vec<u8>>) -> Result<Prepared, Error> {
    let mut request = Request::new(file, urdf);
    request.options.base = base;
    fill(&mut request.options, &scene);
    request.options.append.iter_mut().zip(append).for_each(|(other, urdf)| other.urdf = urdf);
    let resolved = resolve(&request, &scene).map_err(|error| placed(error, &scene))?;
    request.options.effects.clone_from(&resolved.effects);
    Ok(Prepared { scene, request, resolved, files: Vec::new() })
}

/// Writes what the scene says into the options: all but the effects, which need the robot, and the documents of the robots to append.
pub fn fill(options: &mut Options, scene: &Scene) {
    let code = scene.code.clone();
    let put = |said: Option<bool>, into: &mut bool| *into = said.unwrap_or(*into);
    options.base = scene.base.unwrap_or(options.base);
    options.gravity = scene.gravity.unwrap_or(options.gravity);
    options.functions = code.functions.unwrap_or(std::mem::take(&mut options.functions));
    options.parameters = code.parameters.unwrap_or_default();
    options.frames = code.frames;
    options.wrench_reference = code.wrenches_in.unwrap_or_default();
    options.append = code.append.into_iter().map(appended).collect();
    options.payloads = code.payload.into_iter().map(|load| load.payload).collect();
    options.shafts = scene.shafts.iter().map(|asked| asked.shaft.clone()).collect();
    options.lock = code.lock.into_iter().map(|lock| (lock.joint, lock.at)).collect();
    put(code.allow_unphysical_inertia, &mut options.allow_unphysical_inertia);
    options.snap_angles = code.snap_angles;
    options.rename = code.rename;
    put(code.limbs, &mut options.limbs);
    options.batch = code.batch.unwrap_or_default();
    options.level = code.level.unwrap_or(options.level);
    put(code.forbid_unsafe, &mut options.forbid_unsafe);
}

fn appended(other: articulated_scene::Append) -> Appended {
    Appended { urdf: Vec::new(), file: other.urdf, at: other.link, prefix: other.prefix, origin: other.origin }
}

/// The scene's effects on the robot of the request. Errors: those of [`crate::read`] as they are; what is wrong with the effects by their places in the scene.
pub fn resolve(request: &Request, scene: &Scene) -> Result<Resolved, Error> {
    let (reading, shafts) = read_with_shafts(request)?;
    let robot = Edited { description: &reading.description, base: request.options.base, unused: &reading.unused, shafts: &shafts };
    let resolved = scene.resolve(&robot)?;
    let mut with_effects = Request { urdf: Vec::new(), file: request.file.clone(), options: request.options.clone() };
    with_effects.options.effects.clone_from(&resolved.effects);
    match model(&with_effects, &reading.description) {
        Err(Error::Effects { errors, .. }) => Err(resolved.place(&scene.file, &errors).into()),
        Err(error) => Err(error),
        Ok(_) => Ok(resolved),
    }
}

/// Edits that were refused, by their places in the scene; other errors as they are.
pub fn placed(error: Error, scene: &Scene) -> Error {
    let Error::Edits { refusals } = &error else { return error };
    let placed: Option<Vec<SceneError>> = refusals.iter().map(|refusal| place(refusal, scene)).collect();
    placed.map_or(error, |errors| SceneErrors { errors }.into())
}

/// `None`: it is not the scene's.
fn place(refusal: &Refusal, scene: &Scene) -> Option<SceneError> {
    let code = &scene.code;
    let (at, key) = match refusal.edit {
        Edit::Append(i) => (code.append.get(i)?.place, "append".to_owned()),
        Edit::Payload(i) => (code.payload.get(i)?.place, "payload".to_owned()),
        Edit::Shaft(i) => scene.shafts.get(i).map(|asked| (asked.place, format!("effects.shaft.{}", asked.shaft.joint)))?,
        Edit::Lock(i) => code.lock.get(i).map(|lock| (lock.place, format!("lock.{}", lock.joint)))?,
        Edit::Frame(_) => (At::Nowhere, "frames".to_owned()),
    };
    let found = match &refusal.reason {
        Reason::Edit(error) => error.to_string(),
        Reason::Urdf(problems) => problems.to_string(),
        Reason::FrameTwice(name) => format!("{name:?} is listed twice"),
    };
    Some(SceneError { file: scene.file.clone(), at, key, kind: Kind::Refused, found, expected: String::new(), nearest: None })
}

/// The scene has no robot that could be had.
pub(crate) fn no_robot(scene: &Scene, found: &str, expected: &str) -> Error {
    let (found, expected) = (found.to_owned(), expected.to_owned());
    let key = if scene.robot == Robot::Given { String::new() } else { "robot".to_owned() };
    let error = SceneError { file: scene.file.clone(), at: At::Nowhere, key, kind: Kind::UnknownName, found, expected, nearest: None };
    SceneErrors { errors: vec![error] }.into()
}

/// A file that a scene names, as seen from where the scene is seen.
pub fn beside(scene: &str, name: &str) -> String {
    let folder = Path::new(scene).parent().filter(|folder| *folder != Path::new(""));
    folder.map_or_else(|| name.to_owned(), |folder| folder.join(name).display().to_string())
}

fn bytes(path: &Path) -> Result<Vec<u8>, Error> {
    fs::read(path).map_err(|e| Error::File { file: path.display().to_string(), reason: e.to_string() })
}
