//! A loaded robot: its document, its source, and the options of reading it.

use std::path::{Path, PathBuf};

use articulated_codegen::{Generated, Options, Request, generate};
use articulated_core::description::Base;
use articulated_core::diagnostic::{Diagnostics, values};
use articulated_scene::Scene;

/// A robot's document and how to read it.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Its file, for messages and for the header of generated code.
    pub file: String,
    /// The scene that it is of.
    pub scene: Option<String>,
    /// The document.
    pub document: Vec<u8>,
    /// How to read it, and how to generate its code.
    pub options: Options,
    /// The scene with its effects.
    pub effects: Option<Scene>,
    /// Where the document is, if it is a file.
    pub path: Option<PathBuf>,
}

impl Robot {
    /// The robot with the frames of these links.
    #[must_use]
    pub fn on(mut self, frames: &[String]) -> Self {
        let mut request = self.bare_request();
        request.options = self.options;
        request.set_frames(frames);
        self.options = request.options;
        self
    }

    /// The request for these functions. They take the arguments of the table and no parameters,
    /// which are constants, see [`note_of_parameters`].
    pub fn request(&self, functions: &[String]) -> Request {
        let mut request = self.bare_request();
        request.options = self.options.clone();
        request.options.functions = functions.iter().cloned().map(Into::into).collect();
        request.options.parameters.clear();
        request
    }

    /// The request for its document, with its effects.
    fn bare_request(&self) -> Request {
        Request { scene: self.effects.clone(), ..Request::new(self.file.clone(), self.document.clone()) }
    }

    /// The code of these functions.
    pub fn generate(&self, functions: &[String]) -> Result<Generated, Diagnostics> {
        generate(&self.request(functions))
    }

    /// Whether effects act on it.
    pub fn has_effects(&self) -> bool {
        self.effects.as_ref().is_some_and(Scene::has_effects) || !self.options.robot.effects.is_empty()
    }

    /// Whether the base floats.
    pub fn floating(&self) -> bool {
        self.options.robot.base == Base::Floating
    }

    /// The base in a word.
    pub fn base(&self) -> &'static str {
        if self.floating() { "floating" } else { "fixed" }
    }

    /// A file with the document, for libraries that read files: the robot's own, or one in
    /// `folder`. Errors: the robot is edited, and no file has it.
    pub fn file_in(&self, folder: &Path) -> std::io::Result<PathBuf> {
        let o = &self.options.robot;
        if !(o.append.is_empty() && o.payloads.is_empty() && o.lock.is_empty() && o.shafts.is_empty()) || self.has_effects() {
            return Err(std::io::Error::other(
                "peers read the file, which knows nothing of --append, --payload, --lock and the effects of scenes: leave out one or the other",
            ));
        }
        match &self.path {
            Some(path) if path.is_file() => Ok(path.clone()),
            _ => {
                let path = folder.join("robot.urdf");
                std::fs::write(&path, &self.document)?;
                Ok(path)
            }
        }
    }
}

/// A robot's file as reports name it, with the scene that it is of.
pub fn named(file: &str, scene: Option<&str>) -> String {
    scene.map_or_else(|| file.to_owned(), |scene| format!("{file} of {scene}"))
}

/// The note of a report on a scene's parameters.
pub fn note_of_parameters(options: &Options) -> Option<String> {
    let list = values(&options.parameters).join(", ");
    (!list.is_empty()).then(|| format!("parameters: {list}: constants here, with the numbers of the robot's description"))
}

/// The model of a bundled robot.
#[cfg(test)]
pub(crate) fn bundled_model(name: &str) -> articulated_core::model::Model<f64> {
    let robot = articulated_models::robot(name).unwrap();
    let options = articulated_formats::Options { base: robot.base, ..articulated_formats::Options::default() };
    articulated_core::model::Model::new(&articulated_formats::read(robot.urdf.as_bytes(), &options).unwrap().description, robot.base)
        .unwrap()
}
