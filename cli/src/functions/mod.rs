//! `articulated functions`.

mod report;
mod text;

use std::path::{Path, PathBuf};

use articulated_codegen::function_groups;
use articulated_core::algorithm::{Function, function};
use articulated_core::step::beside_the_table;

use crate::arguments::{Format, FunctionsArguments, RobotArguments};
use crate::console::{self, Progress};
use articulated_lab::error::undefined;

use crate::failure::Failure;
use crate::parallel;
use crate::robot::Robot;
use crate::tips::{FEW, Tips};
use report::{Cell, Cost, FunctionRow, Report, RobotRow};

/// Default robots of the table: a small arm, an arm, and two legged robots.
const ROBOTS: [&str; 4] = ["ur5_like", "panda_like", "quadruped", "humanoid"];

/// A robot, and the frames that functions of frames are generated for.
struct Subject {
    robot: Robot,
    tips: Tips,
}

/// Prints the functions and their costs.
pub(crate) fn run(arguments: &FunctionsArguments, format: Format) -> Result<(), Failure> {
    let default: Vec<PathBuf> = ROBOTS.map(PathBuf::from).to_vec();
    let names = if arguments.robots.is_empty() { &default } else { &arguments.robots };
    let mut report = Report::default();
    let mut subjects = Vec::new();
    for name in names {
        let (subject, row) = subject(name, arguments)?;
        subjects.push(subject);
        report.robots.push(row);
    }
    let table = function_groups::all();
    let rows: Vec<&'static Function<f64>> = table.iter().filter_map(|name| function::<f64>(name)).chain(beside_the_table()).collect();
    let pairs: Vec<(&Function<f64>, &Subject)> = rows.iter().flat_map(|f| subjects.iter().map(move |s| (*f, s))).collect();
    let progress = Progress::new(pairs.len());
    let cells = parallel::map(&pairs, |(f, s)| {
        progress.doing(format!("{}: {}", s.robot.file, f.name));
        let cell = cell(f, s);
        progress.step();
        cell
    });
    drop(progress);
    let mut cells = cells.into_iter();
    for f in rows {
        let costs = cells.by_ref().take(subjects.len()).collect::<Result<_, _>>()?;
        report.functions.push(FunctionRow::new(f, costs));
    }
    let text = || if arguments.markdown { text::markdown(&report) } else { text::text(&report) };
    console::report(format, text, || crate::json(&report))
}

fn subject(name: &Path, arguments: &FunctionsArguments) -> Result<(Subject, RobotRow), Failure> {
    let bundled = name.to_str().and_then(articulated_models::robot);
    let is_bundled = bundled.is_some();
    let plain = RobotArguments::plain(name, arguments.floating && !is_bundled);
    let robot = Robot::find(&RobotArguments { max_code_size: arguments.max_code_size, ..plain })?;
    let built = robot.read()?;
    let reading = &built.reading;
    articulated_core::diagnostic::summary(reading.warnings.iter().filter(|_| !is_bundled)).iter().for_each(|line| console::warn(line));
    let model = robot.whole_model(&built)?;
    let tips = Tips::of(&reading.description, &model);
    let row = RobotRow {
        robot: bundled.map_or_else(|| model.name().to_owned(), |robot| robot.name.to_owned()),
        base: robot.base(),
        joints: model.joints().len(),
        degrees_of_freedom: model.nv(),
        frames: tips.all().to_vec(),
    };
    Ok((Subject { robot, tips }, row))
}

/// The cost of a function on a robot, or the reason why it is not defined there.
fn cell(f: &Function<f64>, subject: &Subject) -> Result<Cell, Failure> {
    let Some(frames) = subject.tips.of_function(f) else { return Ok(Cell::Undefined(FEW.into())) };
    let request = subject.robot.clone().on(frames).whole_request(&[f.name.to_owned()]);
    match articulated_codegen::generate(&request) {
        Ok(generated) => Ok(Cell::Cost(Cost::of(&generated.ledger.functions[0]))),
        Err(error) => Ok(Cell::Undefined(undefined(error)?)),
    }
}
