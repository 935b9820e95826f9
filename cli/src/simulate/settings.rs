//! Settings of a simulation: the scene's own, and those of the command line.

use articulated::simulate::{Output, SettingError, Settings, integrator};

use super::arguments::SimulateArguments;
use crate::console;
use crate::failure::Failure;
use articulated_lab::session::Session;

/// The settings, or the reason why there are none.
pub(super) fn of(session: &Session, arguments: &SimulateArguments) -> Result<Settings, Failure> {
    let (scene, file) = (session.scene.simulation.as_ref(), &session.scene.file);
    if scene.is_none() && arguments.end.is_none() {
        let end = arguments.option("end");
        return Err(Failure::input([format!("{file}: simulation: found nothing, expected [simulation] with `end`, s, or {end} here")]));
    }
    let integrator = session.scene.default_integrator();
    let mut settings = scene.map_or_else(|| Settings { integrator, ..Settings::default() }, |s| s.settings.clone());
    let a = arguments;
    settings.end = a.end.unwrap_or(settings.end);
    settings.rtol = a.rtol.unwrap_or(settings.rtol);
    settings.atol = a.atol.unwrap_or(settings.atol);
    choose_steps(&mut settings, a, session)?;
    settings.output = a.every.map_or(settings.output, Output::Every);
    let problems = settings.problems(session.model.shape());
    if !problems.is_empty() {
        return Err(Failure::input(problems.iter().map(|p| message(p, a, file))));
    }
    too_many_steps(&settings).iter().for_each(|warning| console::warn(&format!("{file}: {warning}")));
    Ok(settings)
}

/// Reports fixed steps that need more than the maximum number to the end, unless an event ends the
/// motion before.
fn too_many_steps(settings: &Settings) -> Option<String> {
    let (step, most) = (settings.step?, settings.max_steps);
    let (steps, reached) = ((settings.end - settings.start) / step, settings.start + step * most as f64);
    let message = || {
        format!(
            "simulation.step: found {step:?} s, {steps:.1e} steps to the end, of which max_steps = {most} are made, up to t = {reached} s; expected longer steps, or a greater max_steps"
        )
    };
    (steps > most as f64 * (1.0 + 1e-9)).then(message)
}

/// The integrator and the choice of its steps. Errors: an option that does not apply to it, and a
/// missing step.
fn choose_steps(settings: &mut Settings, a: &SimulateArguments, session: &Session) -> Result<(), Failure> {
    let file = &session.scene.file;
    settings.step = a.step.or(settings.step);
    let of_file = session.world.step;
    if let Some(row) = a.integrator.as_deref().and_then(integrator) {
        settings.integrator = row.id;
        // The step of a scene applies to the scene's own integrator.
        if row.adaptive && a.step.is_none() {
            settings.step = None;
        } else if !row.adaptive && settings.step.is_none() {
            settings.step = of_file;
        }
    }
    if let (false, None, Some(name)) = (settings.integrator.row().adaptive, settings.step, &a.integrator) {
        return Err(Failure::input([format!(
            "{} {name}: found no length of its steps, expected {}, s, or `step` in [simulation] of {file}",
            a.option("integrator"),
            a.option("step")
        )]));
    }
    let Some(step) = settings.step else { return Ok(()) };
    let tolerances = [("rtol", a.rtol), ("atol", a.atol)].into_iter().filter(|(_, given)| given.is_some());
    let by = if a.step.is_some() { a.option("step") } else { format!("`step` in [simulation] of {file}") };
    let message = |(option, _)| {
        format!(
            "{}: found a fixed step of {step:?} s ({by}), which no tolerance chooses, expected an integrator that chooses its steps, as {} dopri5",
            a.option(option),
            a.option("integrator")
        )
    };
    let lines: Vec<String> = tolerances.map(message).collect();
    if lines.is_empty() { Ok(()) } else { Err(Failure::input(lines)) }
}

/// A problem, reported at its option if that was given, else at the scene.
fn message(problem: &SettingError, a: &SimulateArguments, file: &str) -> String {
    let options = [
        ("end", "end", a.end.is_some()),
        ("step", "step", a.step.is_some()),
        ("rtol", "rtol", a.rtol.is_some()),
        ("atol", "atol", a.atol.is_some()),
        ("output", "every", a.every.is_some()),
    ];
    match options.iter().find(|(key, _, given)| *key == problem.key && *given) {
        Some((_, option, _)) => format!("{}: found {}, expected {}", a.option(option), problem.found, problem.right),
        None => format!("{file}: {problem}"),
    }
}
