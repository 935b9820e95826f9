//! `articulated rollout`: many states, stepped many times.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use articulated_core::algorithm::{Argument, Function, Workspace, difference};
use articulated_core::model::Model;
use articulated_core::step::{self, ACT, CTRL, WARM, beside_the_table, rollout};
use articulated_formats::world::{Stepping, World, step_of_integrator};
use clap::Args;
use serde::Serialize;

use crate::arguments::{Format, RobotArguments};
use crate::console;
use crate::failure::{Failure, OK};
use crate::file_motion::{Start, are_computed, step_length, step_of_file};
use crate::robot::{Robot, read_bytes};
use crate::states::{self, State};
use crate::table::{Table, counted, number, plain};
use crate::touching::Touching;
use crate::{named_scene, parallel};

#[derive(Args, Debug)]
pub(crate) struct RolloutArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// How many steps
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    steps: u64,
    /// A file of states with q, v, and tau or act and ctrl, in JSON or CSV, or a number of random
    /// states [default: one state, of the file's keyframe `home` or its initial state]
    #[arg(long, value_name = "FILE|K")]
    states: Option<PathBuf>,
    /// Start with this keyframe of the file, and its controls
    #[arg(long, value_name = "NAME", conflicts_with = "states")]
    keyframe: Option<String>,
    /// The method, a function of the groups `steps` and `actuators`, or an integrator of MuJoCo
    /// [default: the file's, with its actuators, or step_semi_implicit_euler]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// Step with limits, dry friction and contacts of the file, by MuJoCo's law
    #[arg(long)]
    constraints: bool,
    /// Also list the contacts of the last states, with their forces, and how exact the
    /// accelerations are
    #[arg(long, requires = "constraints")]
    contacts: bool,
    /// The length of a step, s [default: the file's, or 0.001]
    #[arg(long, value_name = "S", value_parser = length)]
    time_step: Option<f64>,
    /// Also step all states with half the step, and print an estimate of the error of the last
    /// states. It takes twice the time more
    #[arg(long, conflicts_with = "hash")]
    error_estimate: bool,
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
    #[serde(skip_serializing_if = "Option::is_none")]
    error_estimate: Option<Estimate>,
    /// Names of the actuators, in the order of ctrl: of a method with actuators.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    actuators: Vec<String>,
    warnings: Vec<String>,
    states: Vec<End>,
}

/// Where a state ends.
#[derive(Serialize)]
struct End {
    q: Vec<f64>,
    v: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    act: Vec<f64>,
    /// What touches then.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    touching: Option<Touching>,
}

/// An estimate of the largest error of the last states, by Richardson: 2ᵖ/(2ᵖ − 1) times what half
/// the step changes, with the order p of the method, and with p = 1 where constraints act.
#[derive(Serialize)]
struct Estimate {
    /// Of q, in the tangent space, rad|m.
    q: f64,
    /// Of v, rad/s|m/s.
    v: f64,
    /// The states that it is of: finite with both steps.
    states: usize,
}

pub(crate) fn run(arguments: &RolloutArguments, format: Format) -> Result<u8, Failure> {
    // A file's own forces are those of its smooth motion.
    let name = arguments.robot.robot.as_path();
    let robot = if named_scene::is_robot(name) { Robot::of_scene(name, &arguments.robot)? } else { Robot::find(&arguments.robot)? };
    let built = robot.read()?;
    let model = robot.model(&built)?;
    let world = &built.reading.world;
    // A file of states with torques is stepped with torques.
    let (starts, source) = starts(arguments, &robot.file, world, &model)?;
    let has_torques =
        arguments.states.as_ref().is_some_and(|given| given.exists()) && starts.iter().any(|s| s.get(Argument::Tau).is_some());
    let kind = match arguments.constraints {
        true => Kind::Constrained,
        false if !model.actuators().is_empty() && !has_torques => Kind::Actuated,
        false => Kind::Plain,
    };
    let method = method(arguments, world.stepping.as_ref(), kind)?;
    if method.takes.contains(&WARM) {
        are_computed(&robot.file, (&built.reading.description, world), &model)?;
    }
    articulated_codegen::defined(&robot.file, &model, &articulated_codegen::massless(&model), method)?;
    if method.takes.contains(&CTRL) {
        let locked = articulated_codegen::locked_actuators(&robot.file, world, &model);
        articulated_core::diagnostic::summary(locked.iter()).iter().for_each(|line| console::warn(line));
        let torques = |(k, _): (usize, &State)| format!("states[{k}]: found tau, expected ctrl: {} has no torques", method.name);
        let wrong: Vec<String> = starts.iter().enumerate().filter(|_| has_torques).map(torques).collect();
        if !wrong.is_empty() {
            return Err(Failure::input(states::listed(wrong)));
        }
    }
    source.iter().for_each(|source| console::note(&format!("starts with {source}")));
    let h = step_length(arguments.time_step, world);
    let begin = Instant::now();
    let ends = parallel::map(&starts, |state| stepped(&model, method, state, (h, arguments.steps, arguments.contacts)));
    let seconds = begin.elapsed().as_secs_f64();
    let error_estimate = arguments.error_estimate.then(|| {
        let halves = parallel::map(&starts, |state| stepped(&model, method, state, (0.5 * h, 2 * arguments.steps, false)));
        estimate(&model, method, ends.iter().zip(&halves))
    });
    let mut warnings = Vec::new();
    let lost = ends.iter().filter(|end| end.numbers().any(|x| !x.is_finite())).count();
    if lost > 0 {
        let states = if lost == 1 { "1 state is".to_owned() } else { format!("{lost} states are") };
        warnings.push(format!("{states} not finite at the end: the step of {h} s is too long, or the motion has no bound"));
    }
    let lacking = ends.iter().filter_map(|end| end.touching.as_ref()).filter(|touching| !touching.is_found()).count();
    if lacking > lost {
        warnings.push(format!("{}: the last acceleration is not that of the optimum, see relative_error", counted(lacking, "state")));
    }
    warnings.iter().for_each(|line| console::warn(line));
    let report = Report {
        robot: model.name().to_owned(),
        method: method.name,
        time_step: h,
        steps: arguments.steps,
        threads: parallel::threads().min(starts.len()),
        seconds,
        hash: format!("{:016x}", hash(&ends)),
        error_estimate,
        actuators: if method.takes.contains(&CTRL) {
            model.actuators().laws.iter().map(|law| law.name.clone()).collect()
        } else {
            Vec::new()
        },
        warnings,
        states: ends,
    };
    console::report(format, || text(&report, arguments.hash), || crate::json(&report))?;
    Ok(OK)
}

impl End {
    fn numbers(&self) -> impl Iterator<Item = &f64> {
        self.q.iter().chain(&self.v).chain(&self.act)
    }
}

/// What acts during a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Plain,
    Actuated,
    Constrained,
}

impl Kind {
    /// How its functions begin.
    fn prefix(self) -> &'static str {
        match self {
            Self::Plain => "step_",
            Self::Actuated => "actuated_step_",
            Self::Constrained => "constrained_step_",
        }
    }

    /// The function beside this one without actuators.
    fn beside(self, plain: &str) -> Option<&'static Function<f64>> {
        let own = plain.strip_prefix("step_")?;
        step::step(&format!("{}{own}", self.prefix()))
    }
}

/// The method.
fn method(arguments: &RolloutArguments, of_file: Option<&Stepping>, kind: Kind) -> Result<&'static Function<f64>, Failure> {
    let is_step = |row: &&Function<f64>| row.takes.contains(&step::H) && !row.takes.contains(&step::CONTACTS);
    let Some(name) = &arguments.method else {
        let [plain, _] = step_of_file(of_file);
        return kind.beside(plain).ok_or_else(|| Failure::usage(format!("--method: found no step beside {plain}")));
    };
    let row = beside_the_table::<f64>().filter(is_step).find(|row| row.name == name || row.name.strip_prefix(kind.prefix()) == Some(name));
    row.or_else(|| kind.beside(step_of_integrator(name)?[0])).ok_or_else(|| {
        let all: Vec<&str> = beside_the_table::<f64>().filter(is_step).map(|row| row.name).collect();
        Failure::usage(format!("--method: found {name:?}, expected one of {}, Euler, implicitfast, RK4", all.join(", ")))
    })
}

/// The states at the start, and where they are from if that is the robot's file.
fn starts(arguments: &RolloutArguments, file: &str, world: &World, model: &Model<f64>) -> Result<(Vec<State>, Option<String>), Failure> {
    let Some(given) = &arguments.states else {
        let Start { state: start, ctrl, source } = Start::of_file(file, world, model, arguments.keyframe.as_deref())?;
        let mut state = State::default();
        for (argument, numbers) in [(Argument::Q, start.q), (Argument::V, start.v), (ACT, start.act), (CTRL, ctrl)] {
            state.set(argument, numbers);
        }
        return Ok((vec![state], (world.stepping.is_some()).then_some(source)));
    };
    if let Some(count) = given.to_str().and_then(|text| text.parse::<usize>().ok()).filter(|_| !given.exists()) {
        return Ok((states::random(model, count, arguments.seed), None));
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
    if missing.is_empty() { Ok((found.states, None)) } else { Err(wrong(states::listed(missing))) }
}

/// A state after all steps; its torques or controls are held.
fn stepped(model: &Model<f64>, method: &Function<f64>, state: &State, (h, count, touches): (f64, u64, bool)) -> End {
    let shape = model.shape();
    let vector = |argument: Argument| state.get(argument).map_or_else(|| vec![0.0; argument.len(shape)], <[f64]>::to_vec);
    let is_actuated = method.takes.contains(&CTRL);
    let act = if is_actuated { vector(ACT) } else { Vec::new() };
    let mut end = step::State { q: vector(Argument::Q), v: vector(Argument::V), act, warm: Vec::new() };
    let held = vector(if is_actuated { CTRL } else { Argument::Tau });
    let inputs = (0..count).map(|_| held.as_slice());
    let mut ws = Workspace::new(model);
    let done = rollout(method, (model, &mut ws), &mut end, h, inputs, |_, _| {});
    let touching = touches.then(|| Touching::of(model, &mut ws, &end, &held)).transpose();
    debug_assert!(done.is_ok() && touching.is_ok(), "vectors are made to measure");
    End { q: end.q, v: end.v, act: end.act, touching: touching.ok().flatten() }
}

/// The estimate of the error of ends, each beside that of half the step.
fn estimate<'a>(model: &Model<f64>, method: &Function<f64>, pairs: impl Iterator<Item = (&'a End, &'a End)>) -> Estimate {
    let order = if method.takes.contains(&WARM) { 1 } else { step::order(method) };
    let factor = 2_f64.powi(order as i32) / (2_f64.powi(order as i32) - 1.0);
    let (mut ws, mut way) = (Workspace::new(model), vec![0.0; model.nv()]);
    let mut found = Estimate { q: 0.0, v: 0.0, states: 0 };
    for (end, half) in pairs.filter(|(end, half)| end.numbers().chain(half.numbers()).all(|x| x.is_finite())) {
        difference(model, &mut ws, &end.q, &half.q, &mut way);
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0_f64, |most, x| most.max(x.abs())) * factor;
        found.q = found.q.max(largest(&mut way.iter().copied()));
        found.v = found.v.max(largest(&mut end.v.iter().zip(&half.v).map(|(one, other)| one - other)));
        found.states += 1;
    }
    found
}

/// FNV-1a of the bits of all numbers.
fn hash(ends: &[End]) -> u64 {
    let bytes = ends.iter().flat_map(End::numbers).flat_map(|x| x.to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn text(report: &Report, is_hash: bool) -> String {
    if is_hash {
        return format!("{}\n", report.hash);
    }
    let Report { robot, method, time_step, steps, threads, seconds, hash, error_estimate, states, .. } = report;
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
    match error_estimate {
        Some(Estimate { states: 0, .. }) => out += "no estimate of the error: no last state is finite with half the step too\n",
        Some(Estimate { q, v, .. }) => {
            let _ =
                writeln!(out, "error of the last states, estimated by half the step: q {} rad|m, v {} rad/s|m/s", number(*q), number(*v));
        }
        None => {}
    }
    for (k, touching) in states.iter().enumerate().filter_map(|(k, end)| Some((k, end.touching.as_ref()?))) {
        let Touching { relative_error, search_steps, contacts } = touching;
        let (count, steps) = (counted(contacts.len(), "contact"), counted(*search_steps as usize, "step"));
        let _ = writeln!(out, "\nstate {k}: {count}; relative error of the acceleration {}, after {steps}", number(*relative_error));
        if contacts.is_empty() {
            continue;
        }
        let mut table = Table::new([("shapes", ""), ("x", "m"), ("y", "m"), ("z", "m"), ("force x", "N"), ("y", "N"), ("z", "N")]);
        for contact in contacts {
            let names = contact.shapes.each_ref().map(|name| plain(name)).join(", ");
            table.row(std::iter::once(names).chain(contact.point.iter().chain(&contact.force).map(|x| number(*x))));
        }
        out += &table.text();
    }
    out
}
