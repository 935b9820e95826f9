//! `articulated check`.

mod base;
mod report;
mod text;

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use articulated_core::diagnostic::{Code, Diagnostics, values};
use articulated_formats::{Reading, nearly_right_angles};
use articulated_scene::BuiltRobot;

use crate::arguments::{CheckArguments, Format};
use crate::console;
use crate::diagnostic::Diagnostic;
use crate::failure::Failure;
use crate::robot::Robot;
use report::Report;

/// Prints all findings, errors of the input included.
pub(crate) fn run(arguments: &CheckArguments, format: Format) -> Result<u8, Failure> {
    let robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    let scene = robot.scene.is_some().then_some(arguments.robot.robot.as_path());
    let report = examine(&robot, scene, &crate::names::flat(&arguments.function));
    console::report(format, || text::text(&report), || crate::json(&report))?;
    Ok(if report.usable { crate::failure::OK } else { crate::failure::INPUT })
}

fn examine(robot: &Robot, scene: Option<&Path>, functions: &[String]) -> Report {
    let mut report = Report::new(robot);
    match robot.read() {
        Err(findings) => {
            report.errors.extend(findings.errors.iter().map(Diagnostic::of));
            report.warn_of(findings.warnings.iter());
        }
        Ok(built) => {
            let reading = &built.reading;
            report.warn_of(reading.warnings.iter().chain(&reading.snapped));
            warn_of_nearly_right_angles(robot, reading, &mut report);
            report.unused.extend(reading.unused.iter().map(ToString::to_string));
            describe(robot, &built, &mut report);
        }
    }
    // Joints may be locked in addition to the scene's: its motion is that of the scene alone.
    match scene.map(crate::simulate::look_over::look_over) {
        Some(Ok(warning)) => warning.into_iter().for_each(|line| report.warn(Diagnostic::from(line).into_warning())),
        Some(Err(failure)) => report.errors.extend(failure.errors),
        None => {}
    }
    if report.errors.is_empty() {
        functions.iter().for_each(|f| check_function(robot, f, &mut report));
    }
    report.usable = report.errors.is_empty();
    report
}

fn describe(robot: &Robot, built: &BuiltRobot, report: &mut Report) {
    report.gravity = built.model.gravity().into();
    report.describe(&built.reading.description, &built.model);
    let request = robot.whole_request(&values(&robot.options.functions));
    let mut findings = Diagnostics::new(&robot.file);
    articulated_codegen::check_names(&request, built, &mut findings);
    for finding in &findings.errors {
        // Name clashes in generated code matter only for code.
        match finding.code {
            Code::NameClash => report.warn(Diagnostic::of(finding).into_warning()),
            _ => report.errors.push(Diagnostic::of(finding)),
        }
    }
}

/// Robots with more bodies get no count of instructions, which takes long to find.
const COUNTED_BODIES: usize = 64;

/// Warns of angles that were printed with too few digits to be right angles, if generated code is
/// shorter with exact ones.
fn warn_of_nearly_right_angles(robot: &Robot, reading: &Reading, report: &mut Report) {
    let near = nearly_right_angles(&reading.description);
    let Some((first, angle)) = near.first() else { return };
    // The least power of ten, rad, that takes all of them as exact.
    let distance = |angle: f64| (angle - (angle / FRAC_PI_2).round() * FRAC_PI_2).abs();
    let most = near.iter().map(|(_, angle)| distance(*angle)).fold(0.0, f64::max);
    let tolerance = 10_f64.powi(most.log10().floor() as i32 + 1);
    let instructions = |snap: Option<f64>| {
        let mut request = robot.whole_request(&["inverse_dynamics".to_owned()]);
        (request.options.stages, request.options.robot.snap_angles) = (false, snap);
        Some(articulated_codegen::generate(&request).ok()?.ledger.functions.first()?.emitted().instructions())
    };
    let gain = match reading.description.joints.len() <= COUNTED_BODIES {
        true => instructions(robot.options.robot.snap_angles).zip(instructions(Some(tolerance))),
        false => None,
    };
    let gain = match gain {
        Some((now, then)) if then >= now => return,
        Some((now, then)) => format!("exact ones make {then} of {now} instructions of inverse dynamics"),
        None => "exact ones make shorter code".to_owned(),
    };
    let rest = if near.len() == 1 { String::new() } else { format!(" (and {} more)", near.len() - 1) };
    let message = format!(
        "{}: joint {first:?}: origin rpy: found {angle}, nearly a multiple of π/2{rest}, expected 1.5707963267948966 and the like: {gain}; \
         `--snap-angles {tolerance:e}` (key `snap_angles`, method `Build::snap_angles`) takes angles this near as exact",
        robot.file
    );
    report.warn(Diagnostic::warning_of_joint(&robot.file, first, Some("origin rpy"), message));
}

fn check_function(robot: &Robot, function: &str, report: &mut Report) {
    match articulated_codegen::generate(&robot.whole_request(&[function.to_owned()])) {
        Ok(_) => report.functions.push(function.to_owned()),
        Err(findings) => report.errors.extend(findings.errors.iter().map(Diagnostic::of)),
    }
}
