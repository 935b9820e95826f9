//! A scene with its files.

use std::path::{Path, PathBuf};

use articulated_core::description::{Base, Shaft};
use articulated_core::effect::EffectErrors;
use articulated_core::model::Model;
use articulated_core::suggest::nearest;
use articulated_urdf::{MOST_BYTES, Reading, read_file};

use super::error::RobotError;
use super::faults::{Tried, leave_out, tried};
use super::options::{Appended, RobotAsked, RobotOptions};
use crate::edits::Append;
use crate::effects::{Edited, Resolved};
use crate::error::{Kind, SceneError, SceneErrors};
use crate::scene::{Robot, Scene};

/// A robot that scenes may call by its name.
#[derive(Clone, Copy, Debug)]
pub struct Bundled<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its URDF.
    pub urdf: &'a str,
    /// The base that it is meant for.
    pub base: Base,
}

/// A scene with the documents that it names.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The scene.
    pub scene: Scene,
    /// The robot's file, for messages.
    pub file: String,
    /// Its URDF's bytes.
    pub urdf: Vec<u8>,
    /// What the scene asks of it; without effects, which need the robot.
    pub options: RobotOptions,
    /// The files that were read: the scene, the robot, and those appended.
    pub files: Vec<PathBuf>,
}

/// A scene's robot as the scene leaves it.
#[derive(Clone, Debug)]
pub struct Settled {
    /// The robot, edited, and what there is to say of its document.
    pub reading: Reading,
    /// Its model under the scene's gravity, with the scene's effects, and with a frame for every link.
    pub model: Model<f64>,
    /// The effects, where the scene asks for them, and what is on, off and not used.
    pub resolved: Resolved,
}

/// What came of a scene's robot, mistakes and all.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// The robot without what was refused, with its model, which has no effects; `None`: there is none to be had.
    pub robot: Option<(Reading, Model<f64>)>,
    /// The scene's effects; none where one of them was refused, and those of refused shafts left out.
    pub resolved: Resolved,
    /// Everything that is wrong with the document, or else everything of the scene that does not fit the robot, tables of control in files apart.
    pub errors: Vec<RobotError>,
    /// What the scene asks without what was refused.
    pub rest: RobotOptions,
}

/// The scene at `path` with its robot's documents; `bundled` are the robots that it may call by name. Files that it names are seen from its folder.
pub fn open(path: &Path, bundled: &[Bundled<'_>]) -> Result<Opened, RobotError> {
    let file = path.display().to_string();
    let scene = Scene::read_bytes(&file, &read_robot_file(path)?)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut opened = open_in(scene, folder, bundled)?;
    opened.files.insert(0, path.to_owned());
    Ok(opened)
}

/// A scene that was read, with its robot's documents; `bundled` are the robots that it may call by name. Files that it names are seen from `folder`.
pub fn open_in(mut scene: Scene, folder: &Path, bundled: &[Bundled<'_>]) -> Result<Opened, RobotError> {
    let appended: Vec<PathBuf> = scene.code.append.iter().map(|other| folder.join(&other.urdf)).collect();
    scene.code.append.iter_mut().zip(&appended).for_each(|(other, path)| other.urdf = path.display().to_string());
    let mut files = Vec::new();
    let (file, urdf, base) = match &scene.robot {
        Robot::Urdf(name) => {
            let path = folder.join(name);
            files.push(path.clone());
            let urdf = read_robot_file(&path).map_err(|error| scene.unreadable(scene.code.places.robot, "urdf", &error))?;
            (path.display().to_string(), urdf, Base::Fixed)
        }
        Robot::Bundled(name) => match bundled.iter().find(|one| one.name == name) {
            Some(one) => (format!("{name}.urdf"), one.urdf.as_bytes().to_vec(), one.base),
            None => return Err(scene.unknown_robot(name, bundled).into()),
        },
        Robot::Given => return Err(scene.without_robot("no robot", "robot, or urdf").into()),
    };
    let append = scene.code.append.iter().zip(appended).map(|(other, path)| {
        let bytes = read_robot_file(&path);
        files.push(path);
        bytes.map_err(|error| scene.unreadable(other.place, "append.urdf", &error))
    });
    let append = append.collect::<Result<Vec<_>, _>>()?;
    Ok(Opened { files, ..Opened::new(scene, &file, urdf, base, append) })
}

impl Opened {
    /// A scene for the robot in `urdf`; `append` are the documents that it appends. Nothing is opened. `base` is taken where the scene does not say.
    pub fn new(scene: Scene, file: &str, urdf: Vec<u8>, base: Base, append: Vec<Vec<u8>>) -> Self {
        let mut options = RobotOptions { base, ..RobotOptions::default() };
        scene.fill_robot(&mut options);
        options.append.iter_mut().zip(append).for_each(|(other, urdf)| other.urdf = urdf);
        Self { scene, file: file.to_owned(), urdf, options, files: Vec::new() }
    }

    /// The robot as the scene asks for it.
    pub fn asked(&self) -> RobotAsked<'_> {
        RobotAsked { file: &self.file, urdf: &self.urdf, options: &self.options }
    }

    /// The robot as the scene leaves it. Errors: everything that is wrong with the document, or else everything of the scene that does not fit the robot, by its places in the scene;
    /// tables of control in files apart.
    pub fn settle(&self) -> Result<Settled, RobotError> {
        let Attempt { robot, resolved, errors, .. } = self.attempt();
        match (RobotError::of(errors), robot) {
            (None, Some((mut reading, model))) => {
                reading.warnings.extend(resolved.warnings.iter().cloned());
                let refused = |errors: EffectErrors| RobotError::Effects { file: self.file.clone(), errors: errors.0 };
                Ok(Settled { model: model.with_effects(&resolved.effects).map_err(refused)?, reading, resolved })
            }
            (Some(error), _) => Err(error.placed(&self.scene)),
            (None, None) => unreachable!("a robot that is not there is an error"),
        }
    }

    /// As [`settle`](Self::settle), with what there is where something is wrong, for who looks for more mistakes.
    pub fn attempt(&self) -> Attempt {
        let whole = |options: &RobotOptions| {
            let asked = RobotAsked { options, ..self.asked() };
            let reading = asked.read()?;
            let model = asked.model(&reading.description)?;
            Ok((reading, model))
        };
        let Tried { value: robot, mut errors, rest } = tried(&self.options, whole, leave_out);
        let resolved = self.scene.effects_of_rest(&RobotAsked { options: &rest, ..self.asked() }, !errors.is_empty());
        let resolved = resolved.unwrap_or_else(|error| {
            errors.extend(error);
            Resolved::default()
        });
        let (_, refused) = self.scene.without_refused_shafts(&rest.shafts);
        let unfit = robot.iter().filter_map(|(_, model)| beside_shafts(self.scene.fits(model).err()?, &refused));
        errors.extend(unfit.map(RobotError::from));
        Attempt { robot, resolved, errors, rest }
    }
}

impl Scene {
    /// Writes into the options what the scene says of its robot: all but the effects, which need it, and the documents of the robots to append.
    pub fn fill_robot(&self, options: &mut RobotOptions) {
        let code = self.code.clone();
        options.base = self.base.unwrap_or(options.base);
        options.gravity = self.gravity.unwrap_or(options.gravity);
        options.frames = code.frames;
        options.wrench_reference = code.wrenches_in.unwrap_or_default();
        options.append = code.append.into_iter().map(appended).collect();
        options.payloads = code.payload.into_iter().map(|load| load.payload).collect();
        options.shafts = self.shafts.iter().map(|asked| asked.shaft.clone()).collect();
        options.lock = code.lock.into_iter().map(|lock| (lock.joint, lock.at)).collect();
        options.allow_unphysical_inertia = code.allow_unphysical_inertia.unwrap_or(options.allow_unphysical_inertia);
        options.snap_angles = code.snap_angles;
    }

    /// The scene's effects on the robot that is asked for. Errors: those of [`RobotAsked::read`] as they are; what is wrong with the effects by their places in the scene.
    pub fn effects_on(&self, asked: &RobotAsked<'_>) -> Result<Resolved, RobotError> {
        let (reading, shafts) = asked.read_with_shafts()?;
        let robot = Edited { description: &reading.description, base: asked.options.base, unused: &reading.unused, shafts: &shafts };
        let resolved = self.resolve(&robot)?;
        let options = RobotOptions { effects: resolved.effects.clone(), ..asked.options.clone() };
        match (RobotAsked { options: &options, ..*asked }).model(&reading.description) {
            Err(RobotError::Effects { errors, .. }) => Err(resolved.place(&self.file, &errors).into()),
            Err(error) => Err(error),
            Ok(_) => Ok(resolved),
        }
    }

    /// The scene's effects on `rest`, what of the robot that was asked for was not refused. Errors: `None` where there are none to be had and that was told before: `told`.
    pub fn effects_of_rest(&self, rest: &RobotAsked<'_>, told: bool) -> Result<Resolved, Option<RobotError>> {
        let (scene, refused) = self.without_refused_shafts(&rest.options.shafts);
        scene.effects_on(rest).map_err(|error| match error {
            RobotError::Scene(errors) => beside_shafts(errors, &refused).map(RobotError::from),
            // All that the robot itself is refused for was told already.
            error => Some(error).filter(|_| !told),
        })
    }

    /// The scene with those of its shafts that are `left`, in their order, for springs go with the shafts one by one; and the joints of the others.
    fn without_refused_shafts(&self, left: &[Shaft]) -> (Self, Vec<String>) {
        let (mut scene, mut refused, mut left) = (self.clone(), Vec::new(), left.iter().peekable());
        scene.shafts.retain(|asked| {
            let is_left = left.next_if(|shaft| **shaft == asked.shaft).is_some();
            refused.extend((!is_left).then(|| asked.shaft.joint.clone()));
            is_left
        });
        (scene, refused)
    }
}

/// What is not about joints and links that only a `refused` shaft would have brought.
fn beside_shafts(SceneErrors { mut errors }: SceneErrors, refused: &[String]) -> Option<SceneErrors> {
    let is_of_shaft = |name: &str| refused.iter().any(|joint| Shaft::may_name(joint, name));
    let is_about_shaft = |error: &SceneError| error.key.split(['.', '[']).any(is_of_shaft);
    errors.retain(|error| error.kind != Kind::UnknownName || !is_about_shaft(error));
    (!errors.is_empty()).then_some(SceneErrors { errors })
}

fn appended(other: Append) -> Appended {
    Appended { urdf: Vec::new(), file: other.urdf, at: other.link, prefix: other.prefix, origin: other.origin }
}

/// A file that a scene names, as seen from where the scene is seen.
pub fn beside(scene: &str, name: &str) -> String {
    let folder = Path::new(scene).parent().filter(|folder| *folder != Path::new(""));
    folder.map_or_else(|| name.to_owned(), |folder| folder.join(name).display().to_string())
}

/// The bytes of a scene or a URDF, no more than a URDF may have.
pub fn read_robot_file(path: &Path) -> Result<Vec<u8>, RobotError> {
    read_file(path, MOST_BYTES).map_err(|e| {
        let near = nearest_file(path).map(|name| format!("; did you mean {name:?}?")).unwrap_or_default();
        RobotError::File { file: path.display().to_string(), reason: format!("{e}{near}") }
    })
}

/// The name in the folder of `path` that is most like that of `path` and has the same ending, where there is no such file; none in a folder of very many.
pub fn nearest_file(path: &Path) -> Option<String> {
    const MOST_FILES: usize = 10_000;
    if path.exists() {
        return None;
    }
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let files = std::fs::read_dir(folder).ok()?.take(MOST_FILES).filter_map(|entry| Some(PathBuf::from(entry.ok()?.file_name())));
    let alike = files.filter(|file| file.extension() == path.extension());
    let stems: Vec<String> = alike.filter_map(|file| Some(file.file_stem()?.to_str()?.to_owned())).collect();
    let stem = nearest(path.file_stem()?.to_str()?, stems.iter().map(String::as_str))?;
    Some(path.extension().and_then(|ending| ending.to_str()).map_or(stem.clone(), |ending| format!("{stem}.{ending}")))
}
