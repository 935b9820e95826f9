//! A scene with its robot: what `simulate` and `effects` are about.

use std::ops::Deref;
use std::path::{Path, PathBuf};

use articulated::Dynamics;
use articulated_codegen::Request;
use articulated_codegen::scene::Prepared;
use articulated_core::description::Base;
use articulated_core::diagnostic::summary;
use articulated_scene::{BuiltRobot, Robot};

use crate::console;
use crate::failure::Failure;
use crate::named_scene;

/// A scene with its robot, as it moves, and what the command has to know besides.
pub(crate) struct Stage {
    /// Of the scene, without folder and ending.
    pub(crate) name: String,
    /// What code of the robot is generated from.
    pub(crate) request: Request,
    /// What is odd about the robot.
    pub(crate) odd: Vec<String>,
    stage: articulated_motion::Stage,
}

impl Deref for Stage {
    type Target = articulated_motion::Stage;

    fn deref(&self) -> &Self::Target {
        &self.stage
    }
}

impl Stage {
    /// Refuses a level whose functions take `f32`, which what calls them here has not.
    pub(crate) fn is_of_doubles(&self) -> Result<(), Failure> {
        let level = self.request.options.level;
        if !level.is_single() {
            return Ok(());
        }
        Err(Failure::input([format!(
            "{}: level: found {level}, expected one whose functions take f64, as states here are",
            self.scene.file
        )]))
    }

    /// The scene that a word of the command line names: a file, or a bundled one. What is odd about its robot is told.
    pub(crate) fn find(name: &Path) -> Result<Self, Failure> {
        let stage = Self::open(name)?;
        stage.odd.iter().for_each(|line| console::warn(line));
        Ok(stage)
    }

    /// The same, and nothing is told.
    pub(crate) fn open(name: &Path) -> Result<Self, Failure> {
        let (prepared, folder) = named_scene::open(name)?;
        let name = name.file_stem().unwrap_or(name.as_os_str()).to_string_lossy().into_owned();
        Self::new(name, prepared, folder)
    }

    fn new(name: String, prepared: Prepared, folder: PathBuf) -> Result<Self, Failure> {
        let Prepared { scene, mut request, robot, .. } = prepared;
        let BuiltRobot { reading, model, resolved, effects, .. } = robot;
        // Variants of the request replace its effects.
        (request.scene, request.options.robot.effects) = (None, effects.clone());
        request.options.robot.frames = None;
        // Bundled robots are odd on purpose.
        let odd = reading.warnings.iter().filter(|_| !matches!(scene.robot, Robot::Bundled(_)));
        let odd = summary(odd.chain(&reading.snapped));
        let mut stage = articulated_motion::Stage::new(scene, reading.description, model, effects).in_folder(folder);
        stage.report = resolved.report;
        Ok(Self { name, request, odd, stage })
    }

    pub(crate) fn base(&self) -> Base {
        self.request.options.robot.base
    }
}

/// The joint that a number of a step belongs to: steps of q first, then v.
pub(super) fn joint_of(stage: &Stage, number: usize) -> Option<String> {
    let freedom = number % stage.model.nv.max(1);
    Dynamics::joint_of(&stage.model, freedom).filter(|name| !name.is_empty()).map(str::to_owned)
}
