//! A scene with its robot.

use std::io::BufRead;
use std::path::{Path, PathBuf};

use articulated_core::description::Description;
use articulated_core::diagnostic::{Diagnostic, Diagnostics};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;
use articulated_formats::Reading;
use articulated_formats::world::World;
use articulated_scene::{BuiltRobot, Opened, Report, Scene, open_table};

/// A scene with its robot after the scene's edits.
#[derive(Clone, Debug)]
pub struct Session {
    /// The scene.
    pub scene: Scene,
    /// The robot after the scene's edits.
    pub description: Description,
    /// Its model, with the scene's gravity and effects and a frame for each link.
    pub model: Model<f64>,
    /// The active effects, which the model has.
    pub effects: Vec<Applied>,
    /// Active and inactive effects, and unused content of the robot's document.
    pub report: Report,
    /// Warnings about the robot.
    pub warnings: Vec<Diagnostic>,
    /// The world of the robot's file: actuators, keyframes.
    pub world: World,
    folder: PathBuf,
}

/// Constructors.
impl Session {
    /// Opens the scene at `path` and the robot that it names. Errors: all findings about the scene
    /// and its files, and about the scene on the robot, as far as they can be read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Diagnostics> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(Self::of(articulated_scene::open(path, &[])?)?.in_folder(folder))
    }

    /// From a scene with documents that are read, or supplied by a program ([`Opened::new`]).
    /// Errors: as [`Session::open`].
    pub fn of(opened: Opened) -> Result<Self, Diagnostics> {
        let BuiltRobot { reading, model, resolved, .. } = opened.build()?;
        let Reading { description, mut warnings, snapped, world, .. } = reading;
        warnings.extend(snapped);
        let session = Self::new(opened.scene, description, model, resolved.effects).in_world(world);
        Ok(Self { warnings, report: resolved.report, ..session })
    }

    /// From matching parts: `model` is that of `description` and has `effects`, as
    /// [`Scene::resolve`] returns them; the report is empty. Paths in the scene are relative to the
    /// working directory, see [`Session::in_folder`].
    pub fn new(scene: Scene, description: Description, model: Model<f64>, effects: Vec<Applied>) -> Self {
        Self {
            scene,
            description,
            model,
            effects,
            report: Report::default(),
            warnings: Vec::new(),
            world: World::default(),
            folder: PathBuf::new(),
        }
    }

    /// With the world of the robot's file: states, actuators, the time step.
    #[must_use]
    pub fn in_world(self, world: World) -> Self {
        Self { scene: self.scene.with_step_of(&world), world, ..self }
    }

    /// Resolves paths in the scene relative to this folder, usually that of the scene's file.
    #[must_use]
    pub fn in_folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = folder.into();
        self
    }
}

impl Session {
    /// Opens a file that the scene names, a table over time, to be read line by line. Errors: a
    /// file that is unreadable, not regular, or larger than any table (4 GiB).
    pub fn file(&self, name: &str) -> Result<Box<dyn BufRead>, String> {
        open_table(&self.folder, name)
    }

    /// The effects of one kind.
    pub fn effects_of(&self, effect: EffectId) -> impl Iterator<Item = &Applied> {
        self.effects.iter().filter(move |a| a.effect == effect)
    }

    /// Names of the frames of [`Session::model`], in its order.
    pub fn frame_names(&self) -> Vec<&str> {
        self.model.frames().iter().map(|frame| frame.name.as_str()).collect()
    }
}

/// The numbers of a field of an effect, by the field's name; empty if the effect has no such field,
/// or has too few numbers.
pub fn field<'a>(applied: &'a Applied, name: &str) -> &'a [f64] {
    let mut start = 0;
    for f in applied.effect.row().fields_of(applied.parameters.len()) {
        if f.name == name {
            return applied.parameters.get(start..start + f.len).unwrap_or(&[]);
        }
        start += f.len;
    }
    &[]
}
