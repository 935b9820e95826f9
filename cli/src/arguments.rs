//! The command line.

use std::path::PathBuf;

use articulated_codegen::Level;
use articulated_core::algorithm::function;
use articulated_core::lanes::Real;
use articulated_formats::{SNAP_EXPECTED, can_snap};
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::accuracy::arguments::AccuracyArguments;
use crate::edits::{Edits, FrameArguments};
use crate::effects::arguments::EffectsArguments;
use crate::failure::{Failure, STATUSES};
use crate::names::{Names, known, wanted};
use crate::simulate::arguments::SimulateArguments;
use crate::stress::arguments::StressArguments;
use crate::table::counted;
use articulated_codegen::function_groups::Group;

/// Robot dynamics, spelled out: checks a URDF, generates its straight-line code, evaluates it, compares it, and simulates it.
#[derive(Debug, Parser)]
#[command(name = "articulated", version, after_help = overview())]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// How to print results
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// How to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people
    Text,
    /// For programs
    Json,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Says all that is wrong with a robot, and what it is made of
    #[command(after_help = examples(&[
        "articulated check arm.urdf",
        "articulated check --floating walker.urdf",
        "articulated check arm.urdf --function inverse_dynamics",
        "articulated check arm.urdf --append gripper.urdf@tool:left_ --payload left_palm=0.5@0,0,0.1 --lock elbow=0.5",
        "articulated check panda_like --format json",
    ]))]
    Check(CheckArguments),
    /// Writes a robot's dynamics out as Rust or C
    #[command(after_help = examples(&[
        "articulated generate panda_like",
        "articulated generate arm.urdf --functions placements,inverse_dynamics -o src/arm.rs",
        "articulated generate arm.urdf --runtime ::articulated -o src/arm.rs",
        "articulated generate arm.urdf --functions inverse_dynamics,forward_dynamics --batch f64,f32 -o src/arm.rs",
        "articulated generate arm.urdf --functions 'hold = gravity_torque + jacobians_body, bias = inverse_dynamics(a = 0)'",
        "articulated generate arm.urdf --functions 'still=inverse_dynamics(v=0,a=0)' --parameters 'payload(tool)'",
        "articulated generate arm.toml --functions motion --runtime ::articulated -o src/arm.rs",
        "articulated generate arm.urdf --level double_double -o src/arm_exact.rs",
        "articulated generate arm.urdf --target c -o firmware/arm",
        "articulated generate arm.urdf --frames tool,camera --lock wrist=0 --payload tool=1.2@0,0,0.1:1e-3,0,0,1e-3,0,1e-3",
        "articulated generate arm.urdf --append gripper.urdf@tool --append gripper.urdf@tool:second_:0,0,0.2,0,0,1.5",
    ]))]
    Generate(GenerateArguments),
    /// Evaluates functions on a file of states, by generic and by generated code
    #[command(after_help = examples(&[
        "articulated eval simple_pendulum --function inverse_dynamics --states states.json",
        "articulated eval simple_pendulum --function gravity_torque,placements --states states.csv --generic --format json",
        "",
        "states.json:  {\"states\": [{\"q\": [0.1], \"v\": {\"swing\": 0.2}, \"a\": [0], \"wrenches\": {\"bob\": [0, 0, 0, 0, 0, -5]}}]}",
        "states.csv:   q.swing,v.swing,a.swing",
        "              0.1,0.2,0",
        "",
        "Columns of a joint that has several numbers: q.hip[0],q.hip[1],…; a floating base is the joint __floating_base__",
    ]))]
    Eval(EvalArguments),
    /// Measures generated code against generic code: operations, size, time, error
    #[command(after_help = examples(&[
        "articulated compare panda_like",
        "articulated compare humanoid --functions inverse_dynamics --repetitions 101",
        "articulated compare ur5_like --functions kinematics,derivatives --frames flange",
        "articulated compare panda_like --functions inverse_dynamics --batch f64,f32",
        "articulated compare arm.urdf --peer libpeer.so --format json",
        "articulated compare quadruped --peers-manifest target/peers/peers.json --chart quadruped.svg",
    ]))]
    Compare(CompareArguments),
    /// Measures what accuracy costs: error and time of each function at each level, and the cheapest that is accurate enough
    #[command(after_help = examples(&[
        "articulated accuracy panda_like",
        "articulated accuracy arm.urdf --functions inverse_dynamics,mass_matrix --levels f32,f64,double_double --output accuracy",
        "articulated accuracy panda_like --functions forward_dynamics --advise --error 1e-9",
        "articulated accuracy --simulate pendulum --output integrators",
        "articulated accuracy ur5_like --peers-manifest target/peers/peers.json --output accuracy",
    ]))]
    Accuracy(AccuracyArguments),
    /// Lists all functions, and what they cost on some robots, on the frames of their tips
    #[command(after_help = examples(&[
        "articulated functions",
        "articulated functions panda_like arm.urdf --format json",
        "articulated functions --markdown > docs/functions.md",
    ]))]
    Functions(FunctionsArguments),
    /// Measures how costs grow with the robot: chains of 7 to 125 joints (--all: to 1000), generated against generic code, hot and cold caches
    #[command(after_help = examples(&[
        "articulated scaling",
        "articulated scaling --joints 7,30,100 --functions inverse_dynamics --chart scaling.svg",
        "articulated scaling --all --markdown --chart docs/scaling.svg > docs/scaling.md",
    ]))]
    Scaling(ScalingArguments),
    /// Measures hard cases: a corpus and the bundled robots, or a robot of yours; each with a limit that it has to keep
    #[command(after_help = examples(&[
        "articulated stress",
        "articulated stress --chapters chains,screws --rows",
        "articulated stress arm.urdf --states states.json",
        "articulated stress arm.urdf --generated --format json",
    ]))]
    Stress(StressArguments),
    /// Simulates a scene: a table of the motion, pictures, a page that plays it, and what became of energy and momentum
    #[command(after_help = examples(&[
        "articulated simulate double_pendulum",
        "articulated simulate quadruped_drop -o drop              (then open drop/motion.html)",
        "articulated simulate arm.toml -o arm --end 5 --integrator dop853 --rtol 1e-10",
        "articulated simulate arm.toml --generated --format json",
        "articulated simulate --all",
        "articulated simulate chain --against target/peers/peers.json",
    ]))]
    Simulate(SimulateArguments),
    /// Says which effects of a scene are on and off, what of the URDF is not used, and what each effect costs
    #[command(after_help = examples(&[
        "articulated effects golf_swing",
        "articulated effects arm.toml --time",
        "articulated effects arm.toml --functions forward_dynamics,mass_matrix --format json",
    ]))]
    Effects(EffectsArguments),
}

/// Which robot, and how to read it.
#[derive(Args, Debug)]
pub(crate) struct RobotArguments {
    /// A bundled robot's or scene's name (a robot's first), the path of a URDF or of a scene (.toml), or - for a URDF on the standard input
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: PathBuf,
    /// The root link moves freely (bundled robots know their own base)
    #[arg(long, conflicts_with = "fixed")]
    pub(crate) floating: bool,
    /// The root link is fixed
    #[arg(long)]
    pub(crate) fixed: bool,
    /// Gravity in the world frame, m/s² [default: 0,0,-9.81]
    #[arg(long, value_name = "X,Y,Z", value_parser = gravity, allow_hyphen_values = true)]
    pub(crate) gravity: Option<Gravity>,
    /// Accept negative principal moments, with a warning (moments that break the triangle inequality always are)
    #[arg(long)]
    pub(crate) allow_unphysical_inertia: bool,
    /// Take an angle of the file within TOL rad of a multiple of π/2 as that multiple: above 0, at most 0.5 [default: none is]
    #[arg(long, value_name = "TOL", value_parser = tolerance)]
    pub(crate) snap_angles: Option<f64>,
    /// Another name in Rust for a joint or link, where two would be one there; again for each
    #[arg(long, value_name = "NAME=RUST_NAME", value_parser = renaming)]
    pub(crate) rename: Vec<(String, String)>,
    /// How many MB of code all functions together may become; more is an error [default: 64, or what the scene says]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) max_code_size: Option<u64>,
    #[command(flatten)]
    pub(crate) edits: Edits,
}

impl RobotArguments {
    /// A robot as it is.
    pub(crate) fn plain(robot: impl Into<PathBuf>, floating: bool) -> Self {
        Self {
            robot: robot.into(),
            floating,
            fixed: false,
            gravity: None,
            allow_unphysical_inertia: false,
            snap_angles: None,
            rename: Vec::new(),
            max_code_size: None,
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
    /// Check too that these functions can be generated
    #[arg(long, alias = "functions", value_name = "NAMES", value_parser = wanted)]
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

#[derive(Args, Debug)]
pub(crate) struct GenerateArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// The functions wanted, groups of them, name = first + second(a = 0), or motion: all that the motion of a scene calls [default: placements,inverse_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = wanted)]
    pub(crate) functions: Vec<Names>,
    /// Constants of the model that stay inputs: payload(LINK), inertia(LINK), origin(JOINT), gravity, and numbers of an effect that is on, as damping(JOINT), contact(LINK)
    #[arg(long, value_name = "ENTRIES", value_delimiter = ',')]
    pub(crate) parameters: Vec<String>,
    /// The functions for many states at once too, in numbers of these types: f64, f32
    #[arg(long, value_name = "TYPES", value_delimiter = ',', value_parser = real)]
    pub(crate) batch: Vec<Real>,
    /// The language. C is C99 for numbers alone: a header and a source
    #[arg(long, value_enum, default_value_t = Language::Rust)]
    pub(crate) target: Language,
    /// The prefix of all names in C [default: the robot's name]
    #[arg(long, value_name = "PREFIX")]
    pub(crate) prefix: Option<String>,
    /// The file to write instead of the standard output; for C the folder
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Code that depends on nothing but core and std (this is the default)
    #[arg(long, conflicts_with = "runtime")]
    pub(crate) standalone: bool,
    /// Each limb for itself: no limbs that are alike in lanes, also where that would be cheaper
    #[arg(long)]
    pub(crate) no_limbs: bool,
    /// No `unsafe` in the generated code: on x86-64 sines take a little longer, and long functions without AVX-512 up to twice as long
    #[arg(long)]
    pub(crate) forbid_unsafe: bool,
    /// For crates without std, which depend on the crate libm: no `unsafe`, no multiply-adds
    #[arg(long, conflicts_with = "runtime")]
    pub(crate) no_std: bool,
    /// How accurate: f64, f32, f32_f64, compensated, double_double, with +correct, +fast_7, +fast_10, +two, +no_fma
    /// [default: f64, or what the scene says]
    #[arg(long, value_name = "LEVEL")]
    pub(crate) level: Option<Level>,
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
    /// By generated code only, compiled by rustc
    #[arg(long, conflicts_with = "generic")]
    pub(crate) generated: bool,
    /// By generic code only
    #[arg(long)]
    pub(crate) generic: bool,
}

#[derive(Args, Debug)]
pub(crate) struct CompareArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// The functions to compare, or groups of them [default: all that are defined for the robot and take at most 20 000 instructions, on the frames of its tips]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// No `unsafe` in the generated code: shows what the vector instructions of the sines bring
    #[arg(long)]
    pub(crate) forbid_unsafe: bool,
    /// Many states at once too, in numbers of these types: f64, f32
    #[arg(long, value_name = "TYPES", value_delimiter = ',', value_parser = real)]
    pub(crate) batch: Vec<Real>,
    /// A peer library to time beside them; may be given several times. It is run: name only libraries that you trust
    #[arg(long, value_name = "LIBRARY")]
    pub(crate) peer: Vec<PathBuf>,
    /// A list of peer libraries, as the peers' build script writes it
    #[arg(long, value_name = "FILE")]
    pub(crate) peers_manifest: Option<PathBuf>,
    /// Draw the medians as dots on a logarithmic axis into this file, in SVG: of ours, and of the fastest build of each engine among the peers
    #[arg(long, value_name = "FILE")]
    pub(crate) chart: Option<PathBuf>,
    /// How often each is timed, 31 times at least
    #[arg(long, value_name = "N", default_value_t = 61, value_parser = clap::value_parser!(u32).range(31..=100_000))]
    pub(crate) repetitions: u32,
    /// How many random states they are judged on; one call at a time they are timed on the first of them, as many as keep arguments within 16 kB
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) states: u32,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// The largest error that is right, in units of 2⁻⁵³ of the sum of the magnitudes of the terms
    #[arg(long, value_name = "UNITS", default_value_t = 64.0, value_parser = units, allow_hyphen_values = true)]
    pub(crate) bound: f64,
}

#[derive(Args, Debug)]
pub(crate) struct FunctionsArguments {
    /// Bundled robots' names, or paths of URDF files or of scenes (.toml) [default: ur5_like panda_like quadruped humanoid]
    #[arg(value_name = "ROBOT")]
    pub(crate) robots: Vec<PathBuf>,
    /// The root links of robots that are files move freely
    #[arg(long)]
    pub(crate) floating: bool,
    /// How many MB of code a function may become; what is more is not defined [default: 64, or what the scene says]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) max_code_size: Option<u64>,
    /// As tables in Markdown, with a head and the meaning of each function
    #[arg(long, conflicts_with = "format")]
    pub(crate) markdown: bool,
}

#[derive(Args, Debug)]
pub(crate) struct ScalingArguments {
    /// Numbers of joints [default: 7,14,30,60,125; with --all up to 1000]
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', value_parser = joints)]
    pub(crate) joints: Vec<usize>,
    /// The functions to measure, or groups of them [default: inverse_dynamics,mass_matrix,forward_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// All lengths: takes some minutes and some GB of memory, most of it for rustc
    #[arg(long, conflicts_with = "joints")]
    pub(crate) all: bool,
    /// The file to draw the times to, as SVG
    #[arg(long, value_name = "FILE")]
    pub(crate) chart: Option<PathBuf>,
    /// As a document in Markdown
    #[arg(long, conflicts_with = "format")]
    pub(crate) markdown: bool,
    /// How often each is timed, 5 times at least
    #[arg(long, value_name = "N", default_value_t = 31, value_parser = clap::value_parser!(u32).range(5..=100_000))]
    pub(crate) repetitions: u32,
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

fn real(text: &str) -> Result<Real, String> {
    let all = [Real::F64, Real::F32];
    all.into_iter().find(|r| r.name() == text.trim()).ok_or_else(|| "expected f64 or f32".into())
}

/// The first of a list that stands before it too.
pub(crate) fn twice<T>(all: &[T], same: impl Fn(&T, &T) -> bool) -> Option<&T> {
    all.iter().enumerate().find(|(k, one)| all[..*k].iter().any(|other| same(other, one))).map(|(_, one)| one)
}

/// Whether each type is asked for once.
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

fn joints(text: &str) -> Result<usize, String> {
    text.trim().parse().ok().filter(|n| (1..=2000).contains(n)).ok_or_else(|| "expected 1 to 2000 joints".into())
}

fn tolerance(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x| can_snap(*x)).ok_or_else(|| format!("expected {SNAP_EXPECTED}"))
}

/// `name=RUST_NAME`; the name in the file may hold such a sign too.
fn renaming(text: &str) -> Result<(String, String), String> {
    let (from, to) = text.rsplit_once('=').filter(|(from, _)| !from.is_empty()).ok_or("expected NAME=RUST_NAME, as in a-b=A_MINUS_B")?;
    Ok((from.to_owned(), to.trim().to_owned()))
}

fn units(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0).ok_or_else(|| "expected a finite number, 0 or more".into())
}

/// A path as it stands in Rust: `::articulated`, `crate::dynamics`.
fn rust_path(text: &str) -> Result<String, String> {
    let word = |w: &str| !w.is_empty() && w.chars().all(|c| c.is_alphanumeric() || c == '_') && !w.starts_with(char::is_numeric);
    let path = text.strip_prefix("::").unwrap_or(text);
    let begins = |(k, w): (usize, &str)| w == "super" || k == 0 && path == text && ["crate", "self"].contains(&w);
    let free = |(k, w): (usize, &str)| word(w) && w != "_" && (begins((k, w)) || !articulated_codegen::is_keyword(w));
    if path.split("::").enumerate().all(free) { Ok(text.to_owned()) } else { Err("expected a path of Rust such as ::articulated".into()) }
}

fn examples(lines: &[&str]) -> String {
    let lines: String = lines.iter().map(|l| format!("  {l}\n")).collect();
    format!("Examples:\n{lines}\n{STATUSES}")
}

fn overview() -> String {
    let robots: String = articulated_models::ROBOTS.iter().map(|r| format!("  {:16} {}\n", r.name, r.summary)).collect();
    let group = |g: Group| format!("  {}: {}\n", g.name(), g.title());
    let one = |name: &'static str| function::<f64>(name).map(|f| format!("    {name:42} {}\n", f.summary)).unwrap_or_default();
    let functions: String = Group::ALL.into_iter().map(|g| group(g) + &g.functions().map(one).collect::<String>()).collect();
    let scenes: String = articulated_models::SCENES.iter().map(|s| format!("  {:16} {}\n", s.name, s.summary())).collect();
    let functions = format!("Functions, in groups whose names stand for all of them:\n{functions}");
    format!("Bundled robots:\n{robots}\nBundled scenes:\n{scenes}\n{functions}\n{STATUSES}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_well_formed() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }

    #[test]
    fn gravity_is_three_finite_numbers() {
        assert_eq!(gravity("0, -9.81,1e0"), Ok(Gravity([0.0, -9.81, 1.0])));
        assert!(gravity("1,2").is_err() && gravity("1,2,nan").is_err() && gravity("").is_err());
    }

    #[test]
    fn a_bound_is_a_finite_number() {
        assert_eq!((units("0"), units("2.5e1")), (Ok(0.0), Ok(25.0)));
        assert!(["nan", "inf", "-1", ""].iter().all(|text| units(text).is_err()));
    }

    #[test]
    fn a_path_is_one_of_rust() {
        assert!(rust_path("::a::b_1").is_ok() && rust_path("crate::x").is_ok());
        assert!(["fn::x", "a::fn", "_", "a::crate", "::self::x"].iter().all(|path| rust_path(path).is_err()));
        assert!(rust_path("super::super::x").is_ok() && rust_path("self::x").is_ok());
        assert!(rust_path("a; fn").is_err() && rust_path("::").is_err() && rust_path("1a").is_err());
    }
}
