//! Robots loaded at run time: as models at once, or as descriptions to be edited first.

use std::fmt;
use std::path::{Path, PathBuf};

use articulated_core::description::{Base, Description};
use articulated_core::diagnostic::Diagnostics;
use articulated_core::model::{Model, ModelError};
use articulated_formats::{Disk, MOST_BYTES, Options, Reading, nearest_file, read_file, read_with};

/// Why a file is not a robot.
#[derive(Debug)]
pub enum LoadError {
    /// The file cannot be read, or is larger than any robot file.
    Io {
        /// The file.
        file: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
    /// The document is not a usable robot; all findings about it.
    Diagnostics(Diagnostics),
    /// A robot that the algorithms do not accept.
    Model(ModelError),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { file, error } => write!(f, "{}: {error}", file.display()),
            Self::Diagnostics(e) => e.fmt(f),
            Self::Model(e) => e.fmt(f),
        }
    }
}

impl std::error::Error for LoadError {}

/// The generic model of the robot's file at `path`, with standard gravity and the file's actuators.
///
/// Every mistake of the file is an error. This function does not return warnings (an inertia that
/// no body has, and so on): [`formats::read`](crate::formats::read) does, and has options.
///
/// ```no_run
/// # fn arm() -> Result<(), Box<dyn std::error::Error>> {
/// use articulated::{Base, Model, formats};
///
/// let options = formats::Options { file: "arm.urdf".into(), ..formats::Options::default() };
/// let reading = formats::read(&std::fs::read("arm.urdf")?, &options)?;
/// for warning in &reading.warnings {
///     eprintln!("warning: {warning}");
/// }
/// let arm = Model::new(&reading.description, Base::Fixed)?;
/// # Ok(()) }
/// ```
pub fn load(path: impl AsRef<Path>, base: Base) -> Result<Model<f64>, LoadError> {
    model(&read(path.as_ref())?, base)
}

/// As [`load`], of a file in memory; `file` is its name in messages.
pub fn load_bytes(file: &str, bytes: &[u8], base: Base) -> Result<Model<f64>, LoadError> {
    model(&read_bytes(file, bytes)?, base)
}

fn model(reading: &Reading, base: Base) -> Result<Model<f64>, LoadError> {
    let description = &reading.description;
    let model = ModelError::of_base(description, base).and_then(|()| Model::new(description, base)).map_err(LoadError::Model)?;
    let (actuators, _) = reading.world.actuators_of(&model);
    let (constraints, _) = reading.world.constraints_of(description, &model);
    Ok(model.with_actuators(actuators).with_constraints(constraints))
}

/// The content of the robot's file at `path`, to be edited and made a model of:
///
/// ```
/// # fn arm() -> Result<(), Box<dyn std::error::Error>> {
/// use articulated::{Base, Model, Origin, Payload, describe};
///
/// let mut arm = describe("arm.urdf")?;
/// arm.append("tool", &describe("gripper.urdf")?, "left_", Origin::default())?;
/// arm.attach(&Payload { link: "left_palm".into(), mass: 0.5, ..Payload::default() })?;
/// arm.lock("elbow", &[0.5])?;
/// let arm = Model::new(&arm, Base::Fixed)?.with_frames(&["left_palm"])?;
/// # Ok(()) }
/// ```
///
/// Warnings are not returned, as for [`load`].
pub fn describe(path: impl AsRef<Path>) -> Result<Description, LoadError> {
    Ok(read(path.as_ref())?.description)
}

fn read(path: &Path) -> Result<Reading, LoadError> {
    let bytes = read_file(path, MOST_BYTES).map_err(|error| LoadError::Io { file: path.to_owned(), error: with_nearest(path, error) })?;
    read_bytes(&path.display().to_string(), &bytes)
}

/// The error with the intended file name, if there is one.
fn with_nearest(path: &Path, error: std::io::Error) -> std::io::Error {
    match nearest_file(path) {
        Some(near) => std::io::Error::new(error.kind(), format!("{error}; did you mean {near:?}?")),
        None => error,
    }
}

/// As [`describe`], of a file in memory; `file` is its name in messages.
pub fn describe_bytes(file: &str, bytes: &[u8]) -> Result<Description, LoadError> {
    Ok(read_bytes(file, bytes)?.description)
}

fn read_bytes(file: &str, bytes: &[u8]) -> Result<Reading, LoadError> {
    let options = Options { file: file.into(), ..Options::default() };
    read_with(&Disk, bytes, &options).map_err(LoadError::Diagnostics)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floating_base_beside_a_free_joint_is_refused() {
        let buoy = b"<mujoco><worldbody><body name='buoy'><freejoint name='sea'/><geom size='1'/></body></worldbody></mujoco>";
        assert_eq!(load_bytes("buoy.xml", buoy, Base::Fixed).unwrap().nv(), 6);
        let told = load_bytes("buoy.xml", buoy, Base::Floating).unwrap_err().to_string();
        assert!(told.starts_with("link \"buoy\" has the free joint \"sea\" already: leave out --floating"), "{told}");
    }

    #[test]
    fn a_file_that_is_not_there_is_named() {
        let error = load("/no/such/arm.urdf", Base::Fixed).unwrap_err().to_string();
        assert!(error.starts_with("/no/such/arm.urdf: ") && error.len() > "/no/such/arm.urdf: ".len(), "{error}");
        let folder = std::env::temp_dir().join(format!("articulated-near-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("walker.urdf"), "").unwrap();
        let error = load(folder.join("walker.ursf"), Base::Fixed).unwrap_err().to_string();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(error.ends_with("; did you mean \"walker.urdf\"?"), "{error}");
    }

    #[test]
    fn of_a_file_larger_than_any_robot_nothing_is_read() {
        let file = std::env::temp_dir().join(format!("articulated-vast-{}.urdf", std::process::id()));
        std::fs::File::create(&file).unwrap().set_len(1 << 40).unwrap();
        let error = describe(&file);
        std::fs::remove_file(&file).unwrap();
        let told = error.unwrap_err().to_string();
        assert_eq!(told, format!("{}: found 1099511627776 bytes, expected at most 67108864 bytes", file.display()));
    }

    #[test]
    fn what_is_odd_and_what_is_wrong_can_be_had_one_by_one() {
        let reading = crate::formats::read(b"<robot name='r'><link name='a'/></robot>", &crate::formats::Options::default()).unwrap();
        assert!(reading.warnings.is_empty() && reading.description.links.len() == 1);
        let LoadError::Diagnostics(findings) = load_bytes("r.urdf", b"<robot/>", Base::Fixed).unwrap_err() else {
            panic!("not the reader's")
        };
        assert!(findings.to_string().starts_with("r.urdf:1: "), "{findings}");
    }
}
