//! `articulated rollout`: many states, stepped many times.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use articulated_core::algorithm::{Argument, Workspace, neutral};
use articulated_core::model::Model;
use articulated_core::step::{self, rollout, step_of_mujoco, steps};
use clap::Args;
use serde::Serialize;

use crate::arguments::{Format, RobotArguments};
use crate::console;
use crate::failure::{Failure, OK};
use crate::robot::{Robot, read_bytes};
use crate::states::{self, State};
use crate::table::counted;
use crate::{named_scene, parallel};

/// The step of a file without one, s.
const STEP: f64 = 1e-3;

#[derive(Args, Debug)]
pub(crate) struct RolloutArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// How many steps
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    steps: u64,
    /// A file of states with q, v and tau, in JSON or CSV, or a number of random states [default:
    /// one state of zeros]
    #[arg(long, value_name = "FILE|K")]
    states: Option<PathBuf>,
    /// The method, a function of the group `steps` [default: that of the file's integrator, or
    /// semi_implicit_euler]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// The length of a step, s [default: the file's, or 0.001]
    #[arg(long, value_name = "S", value_parser = length)]
    time_step: Option<f64>,
    /// The seed of random states
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print the hash of the last states alone
    #[arg(long, conflicts_with = "format")]
    hash: bool,
}

fn length(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|h| h.is_finite() && *h > 0.0).ok_or_else(|| "expected a positive number of seconds".into())
}

#[derive(Serialize)]
struct Report {
    robot: String,
    method: &'static str,
    time_step: f64,
    steps: u64,
    threads: usize,
    /// Time of all steps, s.
    seconds: f64,
    /// FNV-1a of the last states.
    hash: String,
    warnings: Vec<String>,
    states: Vec<End>,
}

/// Where a state ends.
#[derive(Serialize)]
struct End {
    q: Vec<f64>,
    v: Vec<f64>,
}

pub(crate) fn run(arguments: &RolloutArguments, format: Format) -> Result<u8, Failure> {
    // A file's own forces are those of its smooth motion.
    let name = arguments.robot.robot.as_path();
    let robot = if named_scene::is_robot(name) { Robot::of_scene(name, &arguments.robot)? } else { Robot::find(&arguments.robot)? };
    let built = robot.read()?;
    let model = robot.model(&built)?;
    let world = &built.reading.world;
    let method = method(arguments, world.integrator.as_deref())?;
    if let Some(row) = step::step::<f64>(method) {
        articulated_codegen::defined(&robot.file, &model, &articulated_codegen::massless(&model), row)?;
    }
    let h = arguments.time_step.or(world.step).unwrap_or(STEP);
    let starts = starts(arguments, &model)?;
    let begin = Instant::now();
    let ends = parallel::map(&starts, |state| stepped(&model, method, state, h, arguments.steps));
    let seconds = begin.elapsed().as_secs_f64();
    let mut warnings = Vec::new();
    let lost = ends.iter().filter(|end| end.q.iter().chain(&end.v).any(|x| !x.is_finite())).count();
    if lost > 0 {
        let states = if lost == 1 { "1 state is".to_owned() } else { format!("{lost} states are") };
        warnings.push(format!("{states} not finite at the end: the step of {h} s is too long, or the motion has no bound"));
    }
    warnings.iter().for_each(|line| console::warn(line));
    let report = Report {
        robot: model.name().to_owned(),
        method,
        time_step: h,
        steps: arguments.steps,
        threads: parallel::threads().min(starts.len()),
        seconds,
        hash: format!("{:016x}", hash(&ends)),
        warnings,
        states: ends,
    };
    console::report(format, || text(&report, arguments.hash), || crate::json(&report))?;
    Ok(OK)
}

/// The name of the method.
fn method(arguments: &RolloutArguments, of_file: Option<&str>) -> Result<&'static str, Failure> {
    let Some(name) = &arguments.method else {
        let known = of_file.and_then(step_of_mujoco).unwrap_or("step_semi_implicit_euler");
        if let (Some(file), None) = (of_file, of_file.and_then(step_of_mujoco)) {
            console::note(&format!("the file's integrator is {file}: steps are those of {known}"));
        }
        return Ok(known);
    };
    let row = steps::<f64>().iter().find(|row| row.name == name || row.name.strip_prefix("step_") == Some(name));
    row.map(|row| row.name).or_else(|| step_of_mujoco(name)).ok_or_else(|| {
        let all: Vec<&str> = steps::<f64>().iter().map(|row| row.name).collect();
        Failure::usage(format!("--method: found {name:?}, expected one of {}", all.join(", ")))
    })
}

/// The states at the start.
fn starts(arguments: &RolloutArguments, model: &Model<f64>) -> Result<Vec<State>, Failure> {
    let Some(given) = &arguments.states else {
        let (mut state, mut q) = (State::default(), vec![0.0; model.nq()]);
        neutral(model, &mut q);
        state.set(Argument::Q, q);
        state.set(Argument::V, vec![0.0; model.nv()]);
        return Ok(vec![state]);
    };
    if let Some(count) = given.to_str().and_then(|text| text.parse::<usize>().ok()).filter(|_| !given.exists()) {
        return Ok(states::random(model, count, arguments.seed));
    }
    let file = given.display();
    let wrong = |lines: Vec<String>| Failure::input(lines.into_iter().map(|line| format!("{file}: {line}")));
    let bytes = read_bytes(given).map_err(|error| wrong(vec![error.to_string()]))?;
    let found = states::read(&bytes, model).map_err(wrong)?;
    found.warnings.iter().for_each(|line| console::warn(line));
    let lacks = |(k, state): (usize, &State)| {
        let missing = [Argument::Q, Argument::V].into_iter().find(|argument| state.get(*argument).is_none())?;
        Some(format!("states[{k}]: {}: found nothing, expected {}", missing.name(), counted(missing.len(model.shape()), "number")))
    };
    let missing: Vec<String> = found.states.iter().enumerate().filter_map(lacks).collect();
    if missing.is_empty() { Ok(found.states) } else { Err(wrong(states::listed(missing))) }
}

/// A state after all steps; its torques are held.
fn stepped(model: &Model<f64>, method: &str, state: &State, h: f64, count: u64) -> End {
    let vector = |argument: Argument, length: usize| state.get(argument).map_or_else(|| vec![0.0; length], <[f64]>::to_vec);
    let (mut q, mut v) = (vector(Argument::Q, model.nq()), vector(Argument::V, model.nv()));
    let tau = vector(Argument::Tau, model.nv());
    if let Some(row) = step::step(method) {
        let torques = (0..count).map(|_| tau.as_slice());
        let done = rollout(row, (model, &mut Workspace::new(model)), (&mut q, &mut v), h, torques, |_, _, _| {});
        debug_assert!(done.is_ok(), "vectors are made to measure");
    }
    End { q, v }
}

/// FNV-1a of the bits of all numbers.
fn hash(ends: &[End]) -> u64 {
    let bytes = ends.iter().flat_map(|end| end.q.iter().chain(&end.v)).flat_map(|x| x.to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn text(report: &Report, is_hash: bool) -> String {
    if is_hash {
        return format!("{}\n", report.hash);
    }
    let Report { robot, method, time_step, steps, threads, seconds, hash, states, .. } = report;
    let mut out = String::new();
    let all = states.len() as f64 * *steps as f64;
    let _ = writeln!(out, "{robot}: {} by {method}, {} of {time_step} s", counted(states.len(), "state"), counted(*steps as usize, "step"));
    let _ = writeln!(
        out,
        "{:.3} s on {}: {:.2} µs a step, {:.0} times as fast as the motion",
        seconds,
        counted(*threads, "thread"),
        1e6 * seconds * *threads as f64 / all,
        all * time_step / seconds
    );
    let _ = writeln!(out, "hash of the last states: {hash}");
    out
}
