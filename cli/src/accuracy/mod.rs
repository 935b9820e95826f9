//! `articulated accuracy`: what a digit costs.

mod advise;
pub(crate) mod arguments;
mod contender;
mod csv;
mod judge;
mod labels;
mod machine;
mod measure;
mod motion;
mod page;
mod plot;
mod report;
mod states;
mod text;
mod words;

use std::path::Path;

use articulated_codegen::Level;
use articulated_core::algorithm::function;

use crate::accuracy::arguments::AccuracyArguments;
use crate::arguments::Format;
use crate::compare::accuracy::Reference;
use crate::compiled::Rustc;
use crate::console;
use crate::failure::Failure;
use crate::names;
use crate::output;
use crate::robot::Robot;
use crate::tips::Tips;
use report::Report;

/// What is measured unless functions are named.
const FUNCTIONS: [&str; 4] = ["placements", "inverse_dynamics", "mass_matrix", "forward_dynamics"];

/// Measures and prints.
pub(crate) fn run(arguments: &AccuracyArguments, format: Format) -> Result<(), Failure> {
    if arguments.simulate {
        return motion::run(arguments, format);
    }
    let mut robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    let built = robot.read()?;
    let reading = &built.reading;
    robot.warn_of(reading.warnings.iter().chain(&reading.snapped));
    if robot.options.robot.frames.is_none() {
        let tips = Tips::of(&reading.description, &robot.whole_model(&built)?);
        robot = robot.on(tips.all());
    }
    let chosen = names::flat(&arguments.functions);
    let mut functions: Vec<&'static str> = Vec::new();
    let wanted = if chosen.is_empty() { FUNCTIONS.map(str::to_owned).to_vec() } else { chosen };
    for name in wanted.iter().filter_map(|name| Some(function::<f64>(name)?.name)) {
        if !functions.contains(&name) {
            functions.push(name);
        }
    }
    let mut levels: Vec<Level> = Vec::new();
    for level in if arguments.levels.is_empty() { Level::all() } else { arguments.levels.clone() } {
        if !levels.contains(&level) {
            levels.push(level);
        }
    }
    arguments.output.as_deref().map_or(Ok(()), |folder| output::folder("--output", folder))?;
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let reference = Reference::new(&reading.description, &robot.options);
    let report = measure::all(&robot, &reference, &rustc, &functions, &levels, arguments)?;
    console::print(&match (arguments.advise, arguments.error, format) {
        (true, Some(wish), Format::Text) => advise::text(&report, wish),
        (true, Some(wish), Format::Json) => crate::json(&advise::whole(&report, wish)),
        (_, _, Format::Text) => text::text(&report),
        (_, _, Format::Json) => crate::json(&report),
    })?;
    // What took minutes to measure is told even if the files cannot be written.
    arguments.output.as_ref().map_or(Ok(()), |folder| write(folder, &report)).map_err(Failure::after_report)?;
    match arguments.error.filter(|_| arguments.advise).and_then(|wish| advise::short(&report, wish)) {
        None => Ok(()),
        Some(line) => Err(Failure::bound_of_report(line)),
    }
}

/// All files of a report.
fn write(folder: &Path, report: &Report) -> Result<(), Failure> {
    let put = |name: &str, bytes: &[u8]| output::write(&folder.join(name), bytes);
    let diagrams = plot::diagrams(report);
    for (name, drawing) in &diagrams {
        put(&format!("{name}.svg"), plot::svg(drawing).as_bytes())?;
        put(&format!("{name}.png"), &plot::png(drawing).map_err(|e| Failure::tool(&e))?)?;
    }
    put("accuracy.csv", csv::text(report).as_bytes())?;
    put("accuracy.json", crate::json(report).as_bytes())?;
    put("report.html", page::html(report, &diagrams).as_bytes())
}
