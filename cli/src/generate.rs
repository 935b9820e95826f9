//! `articulated generate`.

use articulated_codegen::{Generated, generate};
use serde::Serialize;

use crate::arguments::{Format, GenerateArguments, types_of_batch};
use crate::console;
use crate::failure::Failure;
use crate::ledger::{Stage, stages};
use crate::output;
use crate::robot::Robot;

#[derive(Serialize)]
struct Report {
    source: String,
    warnings: Vec<String>,
    snapped: Vec<String>,
    unused: Vec<String>,
    functions: Vec<Function>,
}

#[derive(Serialize)]
struct Function {
    function: String,
    stages: Vec<Stage>,
    depth: u32,
}

/// Writes the source to where it is wanted; as JSON the report is printed in any case.
pub(crate) fn run(arguments: &GenerateArguments, format: Format) -> Result<(), Failure> {
    types_of_batch(&arguments.batch)?;
    let robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    robot.keeps_its_files("--output", arguments.output.as_deref())?;
    arguments.output.as_deref().map_or(Ok(()), |path| output::file("--output", path))?;
    let mut request = robot.whole_request(&crate::names::flat(&arguments.functions));
    if arguments.functions.is_empty() {
        request.options.functions.clone_from(&robot.options.functions);
    }
    // What is not said is the scene's, if there is one.
    if !arguments.parameters.is_empty() {
        request.options.parameters.clone_from(&arguments.parameters);
    }
    if !arguments.batch.is_empty() {
        request.options.rust_mut().batch.clone_from(&arguments.batch);
    }
    request.options.limbs &= !arguments.no_limbs;
    request.options.rust_mut().forbid_unsafe |= arguments.forbid_unsafe;
    request.options.rust_mut().no_std = arguments.no_std;
    request.options.level = arguments.level.unwrap_or(request.options.level);
    request.options.rust_mut().runtime = arguments.runtime.clone().filter(|_| !arguments.standalone);
    let generated = generate(&request)?;
    robot.warn_of(generated.warnings.iter().chain(&generated.snapped));
    if let Some(path) = &arguments.output {
        output::write(path, &generated.source)?;
    }
    match (format, &arguments.output) {
        (Format::Json, _) => console::print(&json(&generated)),
        (Format::Text, None) => console::print(&generated.source),
        (Format::Text, Some(_)) => Ok(()),
    }
}

fn json(generated: &Generated) -> String {
    let lines = |problems: &[articulated_urdf::Problem]| problems.iter().map(ToString::to_string).collect();
    let function = |e: &articulated_codegen::ledger::Entry| Function { function: e.function.clone(), stages: stages(e), depth: e.depth };
    crate::json(&Report {
        source: generated.source.clone(),
        warnings: lines(&generated.warnings),
        snapped: lines(&generated.snapped),
        unused: generated.unused.iter().map(ToString::to_string).collect(),
        functions: generated.ledger.functions.iter().map(function).collect(),
    })
}
