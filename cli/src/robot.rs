//! The robot that a command is about: a bundled one by its name, or a URDF by its path.

use std::io::Read;
use std::path::{Path, PathBuf};

use articulated_codegen::{Generated, Options, Request, generate, nearest};
use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_urdf::{Problems, Reading};

use crate::arguments::RobotArguments;
use crate::failure::Failure;

/// A little more than the reader accepts, so that it is the reader who refuses.
const MOST_BYTES: u64 = (64 << 20) + 1;

/// A robot's document and how to read it.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    /// Its file, for messages and for the header of generated code.
    pub(crate) file: String,
    pub(crate) urdf: Vec<u8>,
    pub(crate) options: Options,
    path: Option<PathBuf>,
}

impl Robot {
    /// The robot that the arguments name.
    pub(crate) fn find(arguments: &RobotArguments) -> Result<Self, Failure> {
        let name = arguments.robot.as_str();
        let bundled = articulated_models::robot(name);
        let (file, urdf, base, path) = match bundled {
            Some(b) => (format!("{name}.urdf"), b.urdf.as_bytes().to_vec(), b.base, None),
            None if name == "-" => ("<stdin>".to_owned(), read_file(name)?, Base::Fixed, None),
            None => (name.to_owned(), read_file(name)?, Base::Fixed, Some(PathBuf::from(name))),
        };
        let base = match (arguments.floating, arguments.fixed) {
            (true, _) => Base::Floating,
            (_, true) => Base::Fixed,
            _ => base,
        };
        let mut options = Options { base, ..Options::default() };
        options.gravity = arguments.gravity.map_or(options.gravity, |g| g.0);
        options.allow_unphysical_inertia = arguments.allow_unphysical_inertia;
        options.snap_angles = arguments.snap_angles;
        Ok(Self { file, urdf, options, path })
    }

    /// What the reader finds in the document.
    pub(crate) fn read(&self) -> Result<Reading, Problems> {
        let options = articulated_urdf::Options {
            file: self.file.clone(),
            base: self.options.base,
            allow_unphysical_inertia: self.options.allow_unphysical_inertia,
            snap_angles: self.options.snap_angles,
        };
        articulated_urdf::read(&self.urdf, &options)
    }

    /// The model of what was read, under the gravity asked for.
    pub(crate) fn model(&self, reading: &Reading) -> Result<Model<f64>, Failure> {
        let error = |error| articulated_codegen::Error::Model { file: self.file.clone(), error };
        let model = Model::new(&reading.description, self.options.base).map_err(error)?;
        Ok(model.with_gravity(self.options.gravity))
    }

    /// The request for these functions, without a runtime.
    pub(crate) fn request(&self, functions: &[String]) -> Request {
        let mut request = Request::new(self.file.clone(), self.urdf.clone());
        request.options = self.options.clone();
        request.options.functions = functions.to_vec();
        request
    }

    /// The code of these functions, without a runtime.
    pub(crate) fn generate(&self, functions: &[String]) -> Result<Generated, articulated_codegen::Error> {
        generate(&self.request(functions))
    }

    /// Whether the base floats.
    pub(crate) fn floating(&self) -> bool {
        self.options.base == Base::Floating
    }

    /// The base in a word.
    pub(crate) fn base(&self) -> &'static str {
        if self.floating() { "floating" } else { "fixed" }
    }

    /// A file with the document, for those who read files: the robot's own, or one in `folder`.
    pub(crate) fn file_in(&self, folder: &Path) -> std::io::Result<PathBuf> {
        match &self.path {
            Some(path) if path.is_file() => Ok(path.clone()),
            _ => {
                let path = folder.join("robot.urdf");
                std::fs::write(&path, &self.urdf)?;
                Ok(path)
            }
        }
    }
}

/// The bytes of a file; `-` is the standard input.
pub(crate) fn read_bytes(name: &str) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if name == "-" {
        std::io::stdin().lock().take(MOST_BYTES).read_to_end(&mut bytes)?;
    } else {
        std::fs::File::open(name)?.take(MOST_BYTES).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

fn read_file(name: &str) -> Result<Vec<u8>, Failure> {
    read_bytes(name).map_err(|error| {
        let names = || articulated_models::ROBOTS.iter().map(|r| r.name);
        let near = nearest(name, names()).map(|n| format!("; did you mean {n:?}?")).unwrap_or_default();
        let known = names().collect::<Vec<_>>().join(", ");
        Failure::input([format!("{name}: found neither a file ({error}) nor a bundled robot{near} (bundled: {known})")])
    })
}

/// The model of a bundled robot.
#[cfg(test)]
pub(crate) fn bundled_model(name: &str) -> Model<f64> {
    let robot = articulated_models::robot(name).unwrap();
    let options = articulated_urdf::Options { base: robot.base, ..articulated_urdf::Options::default() };
    Model::new(&articulated_urdf::read(robot.urdf.as_bytes(), &options).unwrap().description, robot.base).unwrap()
}
