//! `articulated new`: a crate with a robot, a controller, a simulation and a plot.

mod drop;
mod robot_toml;

use std::path::{Path, PathBuf};

use articulated_codegen::{Request, generate};
use articulated_core::description::Base;
use articulated_core::model::Model;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::arguments::{Format, RobotArguments};
use crate::console;
use crate::failure::Failure;
use crate::output;
use crate::robot::Robot;

/// What `new` takes.
#[derive(Debug, Args)]
#[command(mut_arg("robot", |robot| robot.long("file")))]
pub(crate) struct NewArguments {
    /// The folder of the new crate; its last part is the crate's name
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    #[command(flatten)]
    robot: RobotArguments,
    /// The controller of the program
    /// [default: computed-torque on a fixed base, pd on a floating one]
    #[arg(long, value_enum)]
    controller: Option<Controller>,
    /// The folder of the crate `articulated` [default: beside the command's source, else crates.io]
    #[arg(long, value_name = "FOLDER")]
    library: Option<PathBuf>,
}

/// A controller that `new` writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Controller {
    /// τ = M(q)·(kp·(target ⊖ q) − kd·v) + h(q, v); on a fixed base
    ComputedTorque,
    /// τ = kp·(target ⊖ q) − kd·v
    Pd,
}

#[derive(Serialize)]
struct Report {
    folder: String,
    files: Vec<String>,
    run: Vec<String>,
}

/// Writes the crate. Nothing is written if the robot cannot be used, or if the folder exists and is
/// not empty.
pub(crate) fn run(arguments: &NewArguments, format: Format) -> Result<(), Failure> {
    let folder = arguments.folder.as_path();
    let name = crate_name(folder)?;
    if folder.exists() && (!folder.is_dir() || folder.read_dir().is_ok_and(|mut entries| entries.next().is_some())) {
        let expected = "the path of a new folder, or of an empty one";
        return Err(Failure::input([format!("{}: found a file or a folder with files, expected {expected}", folder.display())]));
    }
    let robot = Robot::find(&arguments.robot)?;
    let base = robot.options.robot.base;
    let controller = match (arguments.controller, base) {
        (Some(Controller::ComputedTorque), Base::Floating) => {
            let expected = "--controller pd, or a fixed base: no torque drives the floating base";
            return Err(Failure::usage(format!("--controller computed-torque: found a floating base, expected {expected}")));
        }
        (Some(controller), _) => controller,
        (None, Base::Fixed) => Controller::ComputedTorque,
        (None, Base::Floating) => Controller::Pd,
    };
    // All that a build would refuse is reported now.
    let mut request: Request = robot.whole_request(&[]);
    request.options.functions = functions(controller).iter().map(|name| (*name).into()).collect();
    let generated = generate(&request)?;
    robot.warn_of(generated.warnings.iter());
    if generated.model.nv() == 0 {
        return Err(Failure::input([format!("{}: found no joint that moves, expected one at least", robot.file)]));
    }
    let source = Source::of(arguments, &robot)?;
    let mut files = vec![
        ("Cargo.toml".to_owned(), cargo_toml(&name, arguments.library.as_deref())?),
        ("src/main.rs".to_owned(), main_rs(&name, &source.keys, base, controller, &generated.model)),
        (".gitignore".to_owned(), "target\nmotion*\n".to_owned()),
    ];
    let drop = source.lines.as_ref().filter(|_| base == Base::Floating).and_then(|lines| drop::text(lines, &generated.model));
    let mut run = vec![format!("cd {}", folder.display()), "cargo run --release".to_owned()];
    if let Some(text) = drop {
        files.push(("drop.toml".to_owned(), text));
        run.push("articulated simulate drop.toml -o motion.html".to_owned());
    }
    files.extend(source.files);
    output::folder("FOLDER", &folder.join("src"))?;
    for (file, text) in &files {
        output::write(&folder.join(file), text)?;
    }
    let files: Vec<String> = files.into_iter().map(|(file, _)| file).collect();
    let text = || format!("{}: {}\n\nNext:\n  {}\n", folder.display(), files.join(", "), run.join("\n  "));
    console::report(format, text, || crate::json(&Report { folder: folder.display().to_string(), files: files.clone(), run: run.clone() }))
}

/// Source of the crate's robot.
struct Source {
    /// Keys of the macro.
    keys: String,
    /// Files of the robot in the crate.
    files: Vec<(String, String)>,
    /// Lines of a scene with the robot; `None` for the robot of a scene.
    lines: Option<String>,
}

impl Source {
    /// Copies a robot's file that includes no other file. Refers to scenes and to other robot files
    /// by their absolute path.
    fn of(arguments: &NewArguments, robot: &Robot) -> Result<Self, Failure> {
        let given = &arguments.robot;
        let edits = &given.edits;
        let is_plain = given.gravity.is_none()
            && !(given.allow_unphysical_inertia || given.first_of_duplicates || given.allow_unknown_version)
            && given.leave_out.is_empty()
            && given.snap_angles.is_none()
            && given.max_code_size.is_none()
            && given.arg.is_empty()
            && given.package.is_empty()
            && given.rename.is_empty()
            && edits.append.is_empty()
            && edits.payload.is_empty()
            && edits.lock.is_empty()
            && edits.coupling.is_empty();
        if robot.scene.is_some() {
            if !is_plain {
                let expected = "these options in the scene, or --file with the robot's file";
                return Err(Failure::usage(format!(
                    "--file {}: found a scene beside options of a robot, expected {expected}",
                    given.robot.display()
                )));
            }
            if !given.robot.is_file() {
                let expected = "the path of a scene or of a robot file, or the name of a bundled robot";
                return Err(Failure::usage(format!("--file {}: found a bundled scene, expected {expected}", given.robot.display())));
            }
            let keys = format!("scene = {:?},", robot_toml::absolute(&given.robot));
            return Ok(Self { keys, files: Vec::new(), lines: None });
        }
        let is_alone = robot.options.robot.included.files().next().is_none();
        let (file, mut files) = match is_alone {
            true => ("robot.urdf".to_owned(), vec![("robot.urdf".to_owned(), String::from_utf8_lossy(&robot.document).into_owned())]),
            false => (robot_toml::absolute(&given.robot), Vec::new()),
        };
        let lines = robot_toml::text(&file, given, &robot.options);
        if is_plain && is_alone {
            let base = if robot.options.robot.base == Base::Floating { "\n        base = floating," } else { "" };
            return Ok(Self { keys: format!("urdf = \"robot.urdf\",{base}"), files, lines: Some(lines) });
        }
        files.push(("robot.toml".to_owned(), lines.clone()));
        Ok(Self { keys: "scene = \"robot.toml\",".to_owned(), files, lines: Some(lines) })
    }
}

/// The crate's name: the last part of the folder.
fn crate_name(folder: &Path) -> Result<String, Failure> {
    let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let first = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    let others = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    if first && others && !["test", "core", "std", "articulated"].contains(&name) {
        return Ok(name.to_owned());
    }
    let expected = "a letter, then letters, digits, - and _, as names of crates have; not test, core, std or articulated";
    Err(Failure::usage(format!("{}: found the name {name:?}, expected {expected}", folder.display())))
}

fn functions(controller: Controller) -> &'static [&'static str] {
    match controller {
        Controller::ComputedTorque => &["inverse_dynamics", "forward_dynamics", "integrate", "difference"],
        Controller::Pd => &["forward_dynamics", "integrate", "difference"],
    }
}

/// The dependency on the library, by its path or its version.
fn cargo_toml(name: &str, library: Option<&Path>) -> Result<String, Failure> {
    let beside = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../runtime"));
    let path = match library {
        Some(path) if path.join("Cargo.toml").is_file() => Some(path),
        Some(path) => {
            let expected = "the folder of the crate `articulated`, with its Cargo.toml";
            return Err(Failure::input([format!("--library {}: found no crate, expected {expected}", path.display())]));
        }
        None => Some(beside).filter(|path| path.join("Cargo.toml").is_file()),
    };
    let path = path.map(|path| path.canonicalize().unwrap_or_else(|_| path.to_owned()));
    let source = match path {
        Some(path) => format!("{{ path = {} }}", serde_json::Value::from(path.display().to_string())),
        None => format!("{:?}", env!("CARGO_PKG_VERSION")),
    };
    Ok(format!(
        r#"[package]
name = "{name}"
version = "0.1.0"
edition = "2024"

[dependencies]
articulated = {source}

# Straight-line code is 70 to 100 times slower without optimisation.
[profile.dev.package.{name}]
opt-level = 3

# `cargo check` and `cargo build` compile the generator once, not twice.
[profile.dev.build-override]
debug = true

[workspace]
"#
    ))
}

/// The program.
fn main_rs(name: &str, keys: &str, base: Base, controller: Controller, model: &Model) -> String {
    let first = if base == Base::Floating { 6 } else { 0 };
    let functions = functions(controller).join(", ");
    let law = match controller {
        Controller::ComputedTorque => {
            r#"/// Computed torque: each coordinate moves to its target as a critically damped oscillator.
fn controller(target: &[f64; robot::NQ], q: &[f64; robot::NQ], v: &[f64; robot::NV]) -> [f64; robot::NV] {
    let error = robot::difference(q, target); // target ⊖ q
    let a = std::array::from_fn(|k| 100.0 * error[k] - 20.0 * v[k]);
    robot::inverse_dynamics(q, v, &a)
}"#
        }
        Controller::Pd => {
            r#"/// Springs and dampers in the joints. Choose the gains for your robot.
fn controller(target: &[f64; robot::NQ], q: &[f64; robot::NQ], v: &[f64; robot::NV]) -> [f64; robot::NV] {
    let error = robot::difference(q, target); // target ⊖ q
    std::array::from_fn(|k| if DRIVEN.contains(&k) { 100.0 * error[k] - 10.0 * v[k] } else { 0.0 })
}"#
        }
    };
    let doc = format!("`{}`: {} coordinates, {} degrees of freedom.", model.name(), model.nq(), model.nv());
    TEMPLATE
        .replace("@NAME@", name)
        .replace("@DOC@", &doc.replace(char::is_control, " "))
        .replace("@KEYS@", keys)
        .replace("@FUNCTIONS@", &functions)
        .replace("@LAW@", law)
        .replace("@FIRST@", &first.to_string())
}

const TEMPLATE: &str = r##"//! A robot under a controller at 1 kHz. Run it with `cargo run --release`.

use std::fmt::Write;

use articulated::Dynamics;
use articulated::simulate::{Output, Settings, Simulation};

articulated::robot! {
    /// @DOC@
    pub mod robot {
        @KEYS@
        functions = [@FUNCTIONS@],
    }
}

/// The controller's period and the end of the motion, s.
const PERIOD: f64 = 1e-3;
const END: f64 = 3.0;
/// The degrees of freedom that torques drive: not those of a floating base.
const DRIVEN: std::ops::Range<usize> = @FIRST@..robot::NV;

@LAW@

/// Where the joints shall go: half a radian (or metre) from where they start, within their limits.
fn target(start: &[f64; robot::NQ]) -> [f64; robot::NQ] {
    let step = std::array::from_fn(|k| if DRIVEN.contains(&k) { 0.5 } else { 0.0 });
    let mut target = robot::integrate(start, &step); // start ⊕ step
    for (k, q) in target.iter_mut().enumerate() {
        if robot::Q_LOWER[k] < robot::Q_UPPER[k] {
            *q = q.clamp(robot::Q_LOWER[k], robot::Q_UPPER[k]);
        }
    }
    target
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut q, mut v) = (robot::NEUTRAL, [0.0; robot::NV]);
    let target = target(&q);
    let mut errors = vec![(0.0, robot::difference(&q, &target))];
    let settings = Settings { end: END, output: Output::Steps, ..Settings::default() };
    let mut simulation = Simulation::new(&robot::Robot, settings)?;
    for step in 0..(END / PERIOD) as u32 {
        let t = f64::from(step) * PERIOD;
        let tau = controller(&target, &q, &v);
        // The robot moves for one period under these torques.
        simulation.set_span(t, t + PERIOD)?;
        let mut hold = |_: f64, _: &[f64], _: &[f64], out: &mut [f64]| out.copy_from_slice(&tau);
        let motion = simulation.run(&q, &v, &mut hold, &mut [])?;
        let last = motion.len() - 1;
        (q, v) = (motion.q_at(last).try_into()?, motion.v_at(last).try_into()?);
        if step % 20 == 19 {
            errors.push((t + PERIOD, robot::difference(&q, &target)));
        }
    }
    let largest = errors.last().map_or(0.0, |(_, e)| e[DRIVEN].iter().fold(0.0, |most: f64, e| most.max(e.abs())));
    println!("largest distance from the target after {END} s: {largest:.2e} rad or m");
    std::fs::write("motion.svg", plot(&errors))?;
    println!("motion.svg shows the distance of each joint from its target over time");
    Ok(())
}

/// The name of the joint that degree of freedom `k` belongs to.
fn joint(k: usize) -> String {
    let mut joints = (0..robot::JOINTS).filter_map(|index| robot::Robot.joint(index));
    joints.rfind(|joint| joint.v.0 <= k).map_or(String::new(), |joint| joint.name.replace(['<', '&'], "_"))
}

/// One line for each degree of freedom that is driven: its distance from the target over time.
fn plot(errors: &[(f64, [f64; robot::NV])]) -> String {
    let (width, height) = (640.0, 360.0);
    let largest = errors.iter().flat_map(|(_, e)| &e[DRIVEN]).fold(1e-9, |most: f64, e| most.max(e.abs()));
    let mut svg =
        String::from("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-60 -20 920 430' font-family='sans-serif' font-size='12'>");
    let _ = write!(svg, "<rect x='-60' y='-20' width='920' height='430' fill='white'/>");
    for (value, label) in [(largest, format!("{largest:.2}")), (0.0, "0".into()), (-largest, format!("{:.2}", -largest))] {
        let y = height / 2.0 * (1.0 - value / largest);
        let _ = write!(svg, "<path d='M0 {y}H{width}' stroke='#ccc'/><text x='-6' y='{y}' text-anchor='end'>{label}</text>");
    }
    let below = (height / DRIVEN.len() as f64).min(16.0); // from one name of the legend to the next
    for k in DRIVEN {
        let (hue, y) = (360 * k / robot::NV, 12.0 + below * (k - DRIVEN.start) as f64);
        let _ = write!(svg, "<text x='660' y='{y:.1}' font-size='{:.1}' fill='hsl({hue} 70% 35%)'>{}</text>", 0.8 * below, joint(k));
        let points: Vec<String> =
            errors.iter().map(|(t, e)| format!("{:.1},{:.1}", width * t / END, height / 2.0 * (1.0 - e[k] / largest))).collect();
        let _ = write!(svg, "<polyline points='{}' fill='none' stroke='hsl({hue} 70% 45%)'/>", points.join(" "));
    }
    let _ = write!(svg, "<text x='0' y='385'>0 s</text><text x='{width}' y='385' text-anchor='end'>{END} s</text>");
    let _ = write!(svg, "<text x='{}' y='385' text-anchor='middle'>@NAME@: target − q, rad or m</text></svg>", width / 2.0);
    svg
}
"##;
