//! `articulated eval`.

mod backward;
#[cfg_attr(not(feature = "measure"), path = "uncompiled.rs")]
mod compiled;
mod layout;
mod report;
mod text;
mod warnings;

use std::path::Path;

use articulated_core::algorithm::{Function, Workspace, function};
use articulated_core::model::Model;
use articulated_formats::nearest_file;
use articulated_reference::{scales, scales_of_generated, where_suspect};

use crate::arguments::{EvalArguments, Format};
use crate::console;
use crate::failure::{Failure, OK};
use crate::names;
use crate::robot::{Robot, note_of_parameters, read_bytes};
use crate::states::{self, State};
use crate::table::counted;
use backward::Backward;
use compiled::{Compiled, compile};
use report::{Difference, FunctionReport, Outcome, Report};

/// Generic and generated results may differ by this many units of roundoff of the sum of the
/// magnitudes of their terms.
const BOUND: f64 = 128.0;

/// Prints the results of every function on every state.
pub(crate) fn run(arguments: &EvalArguments, format: Format) -> Result<u8, Failure> {
    let robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    robot.has_a_level_of_rounding()?;
    let built = robot.read()?;
    let reading = &built.reading;
    robot.warn_of(reading.warnings.iter().chain(&reading.snapped));
    let model = robot.model(&built)?;
    let names = names::flat(&arguments.function);
    let functions = functions(&names);
    let states = read_states(&arguments.states, &model, &functions)?;
    let mut report =
        Report::new(&robot, &model, &built.effects, states.warnings.into_iter().chain(note_of_parameters(&robot.options)).collect());
    report.warnings.iter().for_each(|w| console::warn(w));
    let massless = articulated_codegen::massless(&model);
    functions.iter().try_for_each(|f| articulated_codegen::defined(&robot.file, &model, &massless, f))?;
    let compiled = if arguments.generic { None } else { compile(&robot, &names, arguments.generated, &mut report)? };
    for f in &functions {
        report.functions.push(evaluate(f, &model, &states.states, compiled.as_ref(), arguments.generated));
    }
    let found = warnings::of_results(&report.functions, &states.states, &model, &arguments.states.to_string_lossy());
    found.iter().for_each(|w| console::warn(w));
    report.warnings.extend(found);
    console::report(format, || text::text(&report, &model), || crate::json(&report.json(&model)))?;
    match report.functions.iter().find(|f| f.exceeded()) {
        None => Ok(OK),
        Some(f) if f.largest.is_some_and(|d| d.exceeded()) => {
            Err(Failure::bound_of_report(format!("{}: generic and generated results differ by more than {BOUND} units", f.function.name)))
        }
        Some(f) => Err(Failure::bound_of_report(format!(
            "{}: the torques that the results need differ from the applied ones by more than {BOUND} units",
            f.function.name
        ))),
    }
}

fn functions(names: &[String]) -> Vec<&'static Function<f64>> {
    let mut wanted: Vec<&'static Function<f64>> = Vec::new();
    for f in names.iter().filter_map(|name| function::<f64>(name)) {
        if wanted.iter().all(|w| w.name != f.name) {
            wanted.push(f);
        }
    }
    wanted
}

/// The states of the file; each must contain the arguments of all functions.
fn read_states(path: &Path, model: &Model<f64>, functions: &[&'static Function<f64>]) -> Result<states::States, Failure> {
    let file = path.display();
    let wrong = |lines: Vec<String>| Failure::input(lines.into_iter().map(|line| format!("{file}: {line}")));
    let near = || nearest_file(path).map(|near| format!("; did you mean {near:?}?")).unwrap_or_default();
    let bytes = read_bytes(path).map_err(|e| wrong(vec![format!("{e}{}", near())]))?;
    let states = states::read(&bytes, model).map_err(wrong)?;
    let missing = missing(&states.states, model, functions);
    if missing.is_empty() { Ok(states) } else { Err(wrong(states::listed(missing))) }
}

/// The missing arguments of functions, a line each.
fn missing(states: &[State], model: &Model<f64>, functions: &[&'static Function<f64>]) -> Vec<String> {
    let mut lines = Vec::new();
    for (k, state) in states.iter().enumerate() {
        for f in functions {
            if let Err(argument) = state.arguments(f) {
                let (name, count) = (argument.name(), counted(argument.len(model.shape()), "number"));
                lines.push(format!("states[{k}]: {name}: found nothing, expected {count}: {} takes {name}", f.name));
            }
        }
    }
    lines
}

fn evaluate(
    function: &'static Function<f64>,
    model: &Model<f64>,
    states: &[State],
    compiled: Option<&Compiled>,
    generated_only: bool,
) -> FunctionReport {
    let mut workspace = Workspace::new(model);
    let mut outcomes = Vec::with_capacity(states.len());
    let mut largest: Option<Difference> = None;
    let mut torques: Option<Backward> = None;
    for (k, state) in states.iter().enumerate() {
        let arguments = state.arguments(function).unwrap_or_default();
        let mut out = vec![0.0; function.len(model.shape())];
        let generated = compiled.and_then(|c| c.call(function.name, &arguments, &mut out).ok().map(|()| out.clone()));
        let generic = function.call(model, &mut workspace, &arguments, &mut out).ok().map(|()| out);
        let results = || generic.iter().filter(|_| !generated_only).chain(&generated);
        let own = match function.inverts_mass_matrix() || generic.is_some() && generated.is_some() {
            true => scales(model, function.name, &arguments).unwrap_or_default(),
            false => Vec::new(),
        };
        let is_loose = results().any(|result| backward::is_loose(&own, result));
        let residual = if is_loose { backward::of_results(function, model, &arguments, results()) } else { None };
        if let Some(residual) = residual {
            torques = Some(Backward::larger(torques, k, residual));
        } else if let (Some(a), Some(b)) = (&generic, &generated) {
            let difference = match Difference::largest(k, a, b, &own) {
                difference if difference.exceeded() => {
                    let moved = scales_of_generated(model, function.name, &arguments).unwrap_or_default();
                    let is_suspect = |i: usize, own: f64| Difference::largest(k, &a[i..=i], &b[i..=i], &[own]).exceeded();
                    Difference::largest(k, a, b, &where_suspect(&own, &moved, is_suspect))
                }
                difference => difference,
            };
            largest = Difference::larger(largest, difference);
        }
        outcomes.push(Outcome { generic: generic.filter(|_| !generated_only), generated });
    }
    FunctionReport { function, outcomes, largest, backward: torques }
}
