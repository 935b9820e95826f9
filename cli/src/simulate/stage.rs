//! A scene with its robot: what `simulate` and `effects` are about.

use std::path::{Path, PathBuf};

use articulated_codegen::scene::{self, Bundled, Prepared, Scene};
use articulated_codegen::{Error, nearest};
use articulated_core::description::{Base, Description};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;
use articulated_scene::Robot;
use articulated_urdf::read_file;

use crate::console;
use crate::failure::Failure;

/// No table of control is larger, bytes: ten million rows, of which none has more, of 400 each.
const MOST_OF_TABLE: u64 = 4 << 30;

/// A scene, its robot, and the model of both.
pub(crate) struct Stage {
    /// Of the scene, without folder and ending.
    pub(crate) name: String,
    pub(crate) prepared: Prepared,
    /// The robot as edited.
    pub(crate) description: Description,
    /// With the scene's effects, and a frame for each link.
    pub(crate) model: Model<f64>,
    folder: PathBuf,
}

const BUNDLED: Bundled<'static> = &|name| articulated_models::robot(name).map(|r| (r.urdf, r.base));

impl Stage {
    /// Refuses a level whose functions take `f32`, which what calls them here has not.
    pub(crate) fn is_of_doubles(&self) -> Result<(), Failure> {
        let level = self.prepared.request.options.level;
        if !level.is_single() {
            return Ok(());
        }
        Err(Failure::input([format!(
            "{}: level: found {level}, expected one whose functions take f64, as states here are",
            self.prepared.scene.file
        )]))
    }

    /// The scene that a word of the command line names: a file, or a bundled one. What is odd about its robot is told.
    pub(crate) fn find(name: &str) -> Result<Self, Failure> {
        let (stage, odd) = Self::open(name)?;
        odd.iter().for_each(|line| console::warn(line));
        Ok(stage)
    }

    /// The same, with what is odd about its robot.
    pub(crate) fn open(name: &str) -> Result<(Self, Vec<String>), Failure> {
        let path = Path::new(name);
        let bundled = articulated_models::scene(name.strip_suffix(".toml").unwrap_or(name)).filter(|_| !path.is_file());
        let (prepared, folder) = match bundled {
            Some(bundled) => {
                let scene = Scene::read(&format!("{}.toml", bundled.name), bundled.toml).map_err(Error::from)?;
                (scene::open_in(scene, Path::new(""), BUNDLED)?, PathBuf::new())
            }
            None if path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf")) => {
                let expected = format!("a scene, a TOML file with urdf = {name:?} in it");
                return Err(Failure::input([format!("{name}: found a URDF, expected {expected}")]));
            }
            None if path.exists() => (scene::open(path, BUNDLED)?, path.parent().map(Path::to_owned).unwrap_or_default()),
            None => return Err(unknown(name)),
        };
        let name = path.file_stem().map_or_else(|| name.to_owned(), |stem| stem.to_string_lossy().into_owned());
        Self::new(name, prepared, folder)
    }

    fn new(name: String, mut prepared: Prepared, folder: PathBuf) -> Result<(Self, Vec<String>), Failure> {
        prepared.request.options.robot.frames = None;
        let reading = articulated_codegen::read(&prepared.request)?;
        // Bundled robots are odd on purpose.
        let odd = reading.warnings.iter().filter(|_| !matches!(prepared.scene.robot, Robot::Bundled(_)));
        let odd = odd.chain(&reading.snapped).map(ToString::to_string).collect();
        let model = articulated_codegen::model(&prepared.request, &reading.description)?;
        Ok((Self { name, prepared, description: reading.description, model, folder }, odd))
    }

    pub(crate) fn base(&self) -> Base {
        self.prepared.request.options.robot.base
    }

    /// The effects that are on.
    pub(crate) fn effects(&self) -> &[Applied] {
        &self.prepared.request.options.robot.effects
    }

    /// Those of one kind.
    pub(crate) fn effects_of(&self, effect: EffectId) -> impl Iterator<Item = &Applied> {
        self.effects().iter().filter(move |a| a.effect == effect)
    }

    /// The text of a file that the scene names.
    pub(crate) fn file(&self, name: &str) -> Result<String, String> {
        let path = self.folder.join(name);
        let wrong = |reason: String| format!("{}: {reason}", path.display());
        let bytes = read_file(&path, MOST_OF_TABLE).map_err(|e| wrong(e.to_string()))?;
        let not_text = |at: usize| wrong(format!("byte {at}: found no UTF-8, expected a CSV"));
        String::from_utf8(bytes).map_err(|e| not_text(e.utf8_error().valid_up_to()))
    }
}

/// The numbers of a field of an effect.
pub(crate) fn field<'a>(applied: &'a Applied, name: &str) -> &'a [f64] {
    let mut start = 0;
    for f in applied.effect.row().fields {
        if f.name == name {
            return applied.parameters.get(start..start + f.len).unwrap_or(&[]);
        }
        start += f.len;
    }
    &[]
}

fn unknown(name: &str) -> Failure {
    let names = || articulated_models::SCENES.iter().map(|s| s.name);
    let near = nearest(name, names()).map(|n| format!("; did you mean {n:?}?")).unwrap_or_default();
    let robot = if articulated_models::robot(name).is_some() { "; that is a robot, and a scene says what to do with it" } else { "" };
    let known = names().collect::<Vec<_>>().join(", ");
    Failure::input([format!("{name}: found neither a file nor a bundled scene{robot}{near} (bundled: {known})")])
}
