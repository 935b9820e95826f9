//! Arguments that several commands have, and their values.

use std::path::PathBuf;

use articulated_codegen::Precision;
use articulated_core::lanes::Real;
use articulated_formats::world::GivenContact;
use articulated_formats::{LeaveOut, SNAP_EXPECTED, can_snap};
use clap::{Args, ValueEnum};

use crate::edits::{Edits, FrameArguments};
use crate::failure::{Failure, STATUSES};
use crate::names::{Names, known, requested};
use crate::table::counted;

/// The end of a command's help.
pub(crate) fn examples(lines: &[&str]) -> String {
    let lines: String = lines.iter().map(|l| format!("  {l}\n")).collect();
    format!("Examples:\n{lines}\n{STATUSES}")
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Readable text
    Text,
    /// Machine-readable JSON
    Json,
}

/// The robot, and options of reading it.
#[derive(Args, Debug)]
pub(crate) struct RobotArguments {
    /// A bundled robot's or scene's name (a robot's first), the path of a robot file (URDF, xacro,
    /// MJCF or SDF) or of a scene (.toml), or - for a robot file on the standard input
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: PathBuf,
    /// The root link moves freely (bundled robots know their own base)
    #[arg(long, conflicts_with = "fixed")]
    pub(crate) floating: bool,
    /// The root link is fixed
    #[arg(long)]
    pub(crate) fixed: bool,
    /// Gravity in the world frame, m/s² [default: that of the file, or else 0,0,-9.81]
    #[arg(long, value_name = "X,Y,Z", value_parser = gravity, allow_hyphen_values = true)]
    pub(crate) gravity: Option<Gravity>,
    /// Accept negative principal moments, with a warning (moments that break the triangle
    /// inequality always are)
    #[arg(long)]
    pub(crate) allow_unphysical_inertia: bool,
    /// Take the first of tags of a URDF or SDF that should be there once, with a warning
    #[arg(long)]
    pub(crate) first_of_duplicates: bool,
    /// Leave out elements of an MJCF that change the motion and are not read, with a warning: flex,
    /// composite, plugin, constraint, solver, contact. Those of another kind are errors
    #[arg(long, value_name = "KINDS", value_delimiter = ',')]
    pub(crate) leave_out: Vec<LeaveOut>,
    /// The contacts of two geoms of an MJCF are found by the caller of functions of the group
    /// `given_contacts`, in so many places; repeatable
    #[arg(long, value_name = "GEOM,GEOM[,PLACES]", value_parser = given_contact)]
    pub(crate) given_contact: Vec<GivenContact>,
    /// Read a URDF of a version other than 1.0, 1.1 and 1.2 as 1.0, with a warning
    #[arg(long)]
    pub(crate) allow_unknown_version: bool,
    /// Snap angles of the file within TOL rad of a multiple of π/2 to that multiple: above 0, at
    /// most 0.5 [default: off]
    #[arg(long, value_name = "TOL", value_parser = tolerance)]
    pub(crate) snap_angles: Option<f64>,
    /// The value of an argument that the file declares (`<xacro:arg>`); repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = argument)]
    pub(crate) arg: Vec<(String, String)>,
    /// The folder of a package that the file includes files from (`$(find NAME)`); of a FOLDER
    /// alone the last component is the name. Packages around the file, and those of
    /// AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, need none. Repeatable
    #[arg(long, value_name = "NAME=FOLDER", value_parser = Package::parse)]
    pub(crate) package: Vec<Package>,
    /// Another name in Rust for a joint or link, where two would be equal; repeatable
    #[arg(long, value_name = "NAME=RUST_NAME", value_parser = renaming)]
    pub(crate) rename: Vec<(String, String)>,
    /// Limit of the code of all functions together, MB; more is an error [default: 64, or the
    /// scene's]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) max_code_size: Option<u64>,
    /// The word `file`: the smooth effects of the robot's file act (damping, springs, armature,
    /// compensated weight, the medium) [default: none, or the scene's]
    #[arg(long, value_name = "file", value_parser = ["file"], hide_possible_values = true)]
    pub(crate) effects: Option<String>,
    #[command(flatten)]
    pub(crate) edits: Edits,
}

/// A package of files: its name, and its folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) folder: PathBuf,
}

impl Package {
    /// `NAME=FOLDER`, or a folder, whose last component is the name.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (name, folder) = match text.split_once('=') {
            Some((name, folder)) => (name.to_owned(), PathBuf::from(folder)),
            None => {
                let folder = PathBuf::from(text);
                let whole = folder.canonicalize().unwrap_or_else(|_| folder.clone());
                (whole.file_name().unwrap_or_default().to_string_lossy().into_owned(), folder)
            }
        };
        match (name.is_empty(), folder.is_dir()) {
            (true, _) => Err(format!("found {text:?}, expected NAME=FOLDER, or a folder with a name")),
            (_, false) => Err(format!("found no folder {:?}, expected NAME=FOLDER, or a folder", folder.display().to_string())),
            _ => Ok(Self { name, folder }),
        }
    }
}

impl RobotArguments {
    /// A robot without edits.
    pub(crate) fn plain(robot: impl Into<PathBuf>, floating: bool) -> Self {
        Self {
            robot: robot.into(),
            floating,
            fixed: false,
            gravity: None,
            allow_unphysical_inertia: false,
            first_of_duplicates: false,
            leave_out: Vec::new(),
            given_contact: Vec::new(),
            allow_unknown_version: false,
            snap_angles: None,
            arg: Vec::new(),
            package: Vec::new(),
            rename: Vec::new(),
            max_code_size: None,
            effects: None,
            edits: Edits::default(),
        }
    }
}

#[derive(Args, Debug)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// Also check that these functions can be generated
    #[arg(long, alias = "functions", value_name = "NAMES", value_parser = requested)]
    pub(crate) function: Vec<Names>,
}

/// A language to generate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Language {
    /// Rust
    Rust,
    /// C99
    C,
}

/// An interface that generated C may have beside its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Abi {
    /// CasADi's external
    Casadi,
}

#[derive(Args, Debug)]
pub(crate) struct GenerateArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// The functions to generate: names, groups, name = first + second(a = 0), or motion: all
    /// functions that the motion of a scene calls [default: placements,inverse_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = requested)]
    pub(crate) functions: Vec<Names>,
    /// Constants of the model that stay inputs: payload(LINK), inertia(LINK), origin(JOINT),
    /// gravity, and numbers of an effect that is on, as damping(JOINT), contact(LINK)
    #[arg(long, value_name = "ENTRIES", value_delimiter = ',')]
    pub(crate) parameters: Vec<String>,
    /// Also generate batch functions, for many states at once, with these number types: f64, f32
    #[arg(long, value_name = "TYPES", value_delimiter = ',', value_parser = real)]
    pub(crate) batch: Vec<Real>,
    /// The language. C is C99, which needs math.h alone
    #[arg(long, alias = "target", value_enum, default_value_t = Language::Rust)]
    pub(crate) language: Language,
    /// The prefix of all names in C [default: the robot's name]
    #[arg(long, value_name = "PREFIX")]
    pub(crate) prefix: Option<String>,
    /// C that does not need math.h: with sines, square roots and arctangents of its own
    #[arg(long)]
    pub(crate) no_libm: bool,
    /// Another interface to add to C. casadi: what casadi.external loads, with sparsity and
    /// derivatives
    #[arg(long, value_enum, value_name = "INTERFACE")]
    pub(crate) abi: Option<Abi>,
    /// The derivatives that CasADi finds: 0 none, 1 jac_F and adj1_F of each function F, 2 also
    /// jac_adj1_F, for exact Hessians [default: 1]
    #[arg(long, value_name = "ORDER", requires = "abi", value_parser = clap::value_parser!(u8).range(0..=2))]
    pub(crate) derivatives: Option<u8>,
    /// The file to write instead of the standard output. C: a header (arm.h), or a folder for a
    /// header and a source
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Code that depends on nothing but core and std (this is the default)
    #[arg(long, conflicts_with = "runtime")]
    pub(crate) standalone: bool,
    /// Do not compute isomorphic limbs in vector lanes, even where that is cheaper
    #[arg(long)]
    pub(crate) no_limbs: bool,
    /// No `unsafe` in the generated code: on x86-64 sines take a little longer, and long functions
    /// without AVX-512 up to twice as long
    #[arg(long)]
    pub(crate) forbid_unsafe: bool,
    /// For crates without std, which depend on the crate libm: no `unsafe`, no multiply-adds
    #[arg(long, conflicts_with = "runtime")]
    pub(crate) no_std: bool,
    /// Level of accuracy: f64, f32, f32_f64, compensated, double_double, with +correct, +fast_7,
    /// +fast_10, +two, +no_fma [default: f64, or the scene's]
    #[arg(long, value_name = "LEVEL")]
    pub(crate) level: Option<Precision>,
    /// The path of the runtime crate, to implement its trait `Dynamics`
    #[arg(long, value_name = "PATH", value_parser = rust_path)]
    pub(crate) runtime: Option<String>,
}

#[derive(Args, Debug)]
pub(crate) struct EvalArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// The functions to evaluate, or groups of them
    #[arg(long, alias = "functions", value_name = "NAMES", required = true, value_parser = known)]
    pub(crate) function: Vec<Names>,
    /// A file of states in JSON or CSV; - is the standard input
    #[arg(long, value_name = "FILE")]
    pub(crate) states: PathBuf,
    /// Use generated code only, compiled by rustc
    #[arg(long, conflicts_with = "generic")]
    pub(crate) generated: bool,
    /// Use generic code only
    #[arg(long)]
    pub(crate) generic: bool,
}

#[derive(Args, Debug)]
pub(crate) struct FunctionsArguments {
    /// Names of bundled robots, paths of robot files (URDF, xacro, MJCF, SDF) or scenes (.toml)
    /// [default: ur5_like panda_like quadruped humanoid]
    #[arg(value_name = "ROBOT")]
    pub(crate) robots: Vec<PathBuf>,
    /// The root links of robots from files move freely
    #[arg(long)]
    pub(crate) floating: bool,
    /// Limit of the code of a function, MB; larger functions are not defined [default: 64, or the
    /// scene's]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) max_code_size: Option<u64>,
    /// Print Markdown tables, with a heading and the meaning of each function
    #[arg(long, conflicts_with = "format")]
    pub(crate) markdown: bool,
}

/// Three numbers in m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gravity(pub(crate) [f64; 3]);

pub(crate) fn gravity(text: &str) -> Result<Gravity, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|x| x.trim().parse::<f64>()).collect();
    let numbers = numbers.map_err(|e| e.to_string())?;
    let three: [f64; 3] = numbers.try_into().map_err(|n: Vec<f64>| format!("found {}, expected three", counted(n.len(), "number")))?;
    if three.iter().all(|x| x.is_finite()) { Ok(Gravity(three)) } else { Err("expected finite numbers".into()) }
}

pub(crate) fn real(text: &str) -> Result<Real, String> {
    let all = [Real::F64, Real::F32];
    all.into_iter().find(|r| r.name() == text.trim()).ok_or_else(|| "expected f64 or f32".into())
}

/// The first repeated item of a list.
pub(crate) fn twice<T>(all: &[T], same: impl Fn(&T, &T) -> bool) -> Option<&T> {
    all.iter().enumerate().find(|(k, one)| all[..*k].iter().any(|other| same(other, one))).map(|(_, one)| one)
}

/// Whether each type is requested once.
pub(crate) fn types_of_batch(types: &[Real]) -> Result<(), Failure> {
    let wrong = |real: &Real| Failure::usage(format!("--batch: found a type that is there twice, {}, expected each once", real.name()));
    twice(types, |a, b| a == b).map_or(Ok(()), |real| Err(wrong(real)))
}

/// Whether each joint and link is renamed once.
pub(crate) fn names_in_rust(rename: &[(String, String)]) -> Result<(), Failure> {
    let wrong = |(from, to): &(String, String)| {
        Failure::usage(format!("--rename {from}={to}: found a name that is renamed twice, {from:?}, expected each once"))
    };
    twice(rename, |a, b| a.0 == b.0).map_or(Ok(()), |second| Err(wrong(second)))
}

fn tolerance(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x| can_snap(*x)).ok_or_else(|| format!("expected {SNAP_EXPECTED}"))
}

/// `GEOM,GEOM` or `GEOM,GEOM,PLACES`.
fn given_contact(text: &str) -> Result<GivenContact, String> {
    let words: Vec<&str> = text.split(',').collect();
    let (names, places) = match words.as_slice() {
        [first, second] => ([*first, *second], 1),
        [first, second, places] => {
            ([*first, *second], places.parse().map_err(|_| format!("found {places:?}, expected a number of places"))?)
        }
        _ => return Err("expected two names of geoms, and in how many places they touch, as in foot,floor,4".into()),
    };
    Ok(GivenContact { shapes: names.map(str::to_owned), places })
}

/// `NAME=VALUE`.
fn argument(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').filter(|(name, _)| !name.is_empty()).ok_or("expected NAME=VALUE, as in hand=true")?;
    Ok((name.to_owned(), value.to_owned()))
}

/// `name=RUST_NAME`; the name in the file may contain `=` too.
fn renaming(text: &str) -> Result<(String, String), String> {
    let (from, to) = text.rsplit_once('=').filter(|(from, _)| !from.is_empty()).ok_or("expected NAME=RUST_NAME, as in a-b=A_MINUS_B")?;
    Ok((from.to_owned(), to.trim().to_owned()))
}

/// A Rust path: `::articulated`, `crate::dynamics`.
fn rust_path(text: &str) -> Result<String, String> {
    let word = |w: &str| !w.is_empty() && w.chars().all(|c| c.is_alphanumeric() || c == '_') && !w.starts_with(char::is_numeric);
    let path = text.strip_prefix("::").unwrap_or(text);
    let begins = |(k, w): (usize, &str)| w == "super" || k == 0 && path == text && ["crate", "self"].contains(&w);
    let free = |(k, w): (usize, &str)| word(w) && w != "_" && (begins((k, w)) || !articulated_codegen::is_keyword(w));
    if path.split("::").enumerate().all(free) { Ok(text.to_owned()) } else { Err("expected a path of Rust such as ::articulated".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_is_three_finite_numbers() {
        assert_eq!(gravity("0, -9.81,1e0"), Ok(Gravity([0.0, -9.81, 1.0])));
        assert!(gravity("1,2").is_err() && gravity("1,2,nan").is_err() && gravity("").is_err());
    }

    #[test]
    fn a_path_is_one_of_rust() {
        assert!(rust_path("::a::b_1").is_ok() && rust_path("crate::x").is_ok());
        assert!(["fn::x", "a::fn", "_", "a::crate", "::self::x"].iter().all(|path| rust_path(path).is_err()));
        assert!(rust_path("super::super::x").is_ok() && rust_path("self::x").is_ok());
        assert!(rust_path("a; fn").is_err() && rust_path("::").is_err() && rust_path("1a").is_err());
    }
}
