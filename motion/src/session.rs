//! A scene with its robot.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use articulated_core::description::Description;
use articulated_core::diagnostic::{Diagnostic, Diagnostics};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;
use articulated_formats::{Reading, open_file};
use articulated_scene::{BuiltRobot, Opened, Report, Scene};

/// No table of control is larger, bytes: ten million rows, of which none has more, of 400 each.
const MOST_OF_TABLE: u64 = 4 << 30;

/// A scene with its robot as the scene leaves it.
#[derive(Clone, Debug)]
pub struct Session {
    /// The scene.
    pub scene: Scene,
    /// The robot as the scene edits it.
    pub description: Description,
    /// The model of that, under the scene's gravity, with the scene's effects and a frame for each link.
    pub model: Model<f64>,
    /// The effects that are on: those that the model has.
    pub effects: Vec<Applied>,
    /// What of the effects is on and off, and what of the robot's document is not used.
    pub report: Report,
    /// What is odd about the robot, and used as it is written or as the scene asks.
    pub warnings: Vec<Diagnostic>,
    folder: PathBuf,
}

/// Constructors.
impl Session {
    /// The scene at `path` with the robot of the URDF that it names. Errors: all that is wrong with the scene, or else with the robot, or else all of the scene that does not fit it.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Diagnostics> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(Self::of(articulated_scene::open(path, &[])?)?.in_folder(folder))
    }

    /// Of a scene whose files are read, or of one for which a program has the documents itself ([`Opened::new`]). Errors: as [`Session::open`].
    pub fn of(opened: Opened) -> Result<Self, Diagnostics> {
        let BuiltRobot { reading, model, resolved, .. } = opened.build()?;
        let Reading { description, mut warnings, snapped, .. } = reading;
        warnings.extend(snapped);
        let session = Self::new(opened.scene, description, model, resolved.effects);
        Ok(Self { warnings, report: resolved.report, ..session })
    }

    /// Of parts that belong together: `model` is that of `description` and has `effects`, which [`Scene::resolve`] gives; with nothing to report. Files that the scene names are seen from the
    /// folder in which the program runs, see [`Session::in_folder`].
    pub fn new(scene: Scene, description: Description, model: Model<f64>, effects: Vec<Applied>) -> Self {
        Self { scene, description, model, effects, report: Report::default(), warnings: Vec::new(), folder: PathBuf::new() }
    }

    /// Files that the scene names are seen from this folder: that of the scene's file.
    #[must_use]
    pub fn in_folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = folder.into();
        self
    }
}

impl Session {
    /// A file that the scene names, a table over time, to be read line by line. Errors: one that
    /// cannot be read, is no regular file, or is larger than any table (4 GiB).
    pub fn file(&self, name: &str) -> Result<Box<dyn BufRead>, String> {
        let path = self.folder.join(name);
        let file = open_file(&path, MOST_OF_TABLE).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Box::new(BufReader::new(file)))
    }

    /// The effects of one kind.
    pub fn effects_of(&self, effect: EffectId) -> impl Iterator<Item = &Applied> {
        self.effects.iter().filter(move |a| a.effect == effect)
    }

    /// Names of the frames that [`Session::model`] gives, in its order.
    pub fn frame_names(&self) -> Vec<&str> {
        self.model.frames.iter().map(|frame| frame.name.as_str()).collect()
    }
}

/// The numbers of a field of an effect, by the field's name; none where the effect has no such field, or not as many numbers as it should.
pub fn field<'a>(applied: &'a Applied, name: &str) -> &'a [f64] {
    let mut start = 0;
    for f in applied.effect.row().fields {
        if f.name == name {
            return applied.parameters.get(start..start + f.len).unwrap_or(&[]);
        }
        start += f.len;
    }
    &[]
}
