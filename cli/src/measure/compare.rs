//! `articulated compare`.

use std::path::PathBuf;

use articulated_core::lanes::Real;
use articulated_lab::compare::{Settings, measure};
use clap::Args;

use super::chart;
use crate::arguments::{Format, Language, RobotArguments, real, types_of_batch};
use crate::edits::FrameArguments;
use crate::failure::{Failure, OK};
use crate::names::{self, Names, known};
use crate::robot::Robot;
use crate::{console, output};

#[derive(Args, Debug)]
pub(crate) struct CompareArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// The functions to compare, or groups of them
    /// [default: all that are defined for the robot and take at most 20 000 instructions, on the frames of its tips]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// No `unsafe` in the generated code: shows what the vector instructions of the sines bring
    #[arg(long)]
    pub(crate) forbid_unsafe: bool,
    /// Also compare batches of many states, with these number types: f64, f32
    #[arg(long, value_name = "TYPES", value_delimiter = ',', value_parser = real)]
    pub(crate) batch: Vec<Real>,
    /// Also compare the same functions in this language, by each of its compilers that is
    /// installed: c
    #[arg(long, value_enum, default_value = "rust")]
    pub(crate) language: Language,
    /// A peer library to time beside them; may be given several times. It is run: name only
    /// libraries that you trust
    #[arg(long, value_name = "LIBRARY")]
    pub(crate) peer: Vec<PathBuf>,
    /// A list of peer libraries, as the peers' build script writes it
    #[arg(long, value_name = "FILE")]
    pub(crate) peers_manifest: Option<PathBuf>,
    /// Draw the medians of ours and of each engine's fastest build to this SVG file, as dots on a
    /// logarithmic axis
    #[arg(long, value_name = "FILE")]
    pub(crate) chart: Option<PathBuf>,
    /// Repetitions of each timing, at least 31
    #[arg(long, value_name = "N", default_value_t = 61, value_parser = clap::value_parser!(u32).range(31..=100_000))]
    pub(crate) repetitions: u32,
    /// Number of random states for accuracy; single calls are timed on the first of them, as many
    /// as keep the arguments within 16 kB
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) states: u32,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Largest accepted error, in units of 2⁻⁵³ of the sum of the magnitudes of the terms
    #[arg(long, value_name = "UNITS", default_value_t = 64.0, value_parser = units, allow_hyphen_values = true)]
    pub(crate) bound: f64,
}

fn units(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0).ok_or_else(|| "expected a finite number, 0 or more".into())
}

/// Measures and prints.
pub(crate) fn run(arguments: &CompareArguments, format: Format) -> Result<u8, Failure> {
    types_of_batch(&arguments.batch)?;
    let mut robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    robot.has_a_level_of_rounding()?;
    robot.keeps_its_files("--chart", arguments.chart.as_deref())?;
    arguments.chart.as_deref().map_or(Ok(()), chart::checked)?;
    robot.options.rust_mut().forbid_unsafe |= arguments.forbid_unsafe;
    let built = robot.read()?;
    let reading = &built.reading;
    robot.warn_of(reading.warnings.iter().chain(&reading.snapped));
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: times of generic code, and of the generation, mean little");
    }
    let settings = Settings {
        functions: names::flat(&arguments.functions),
        batch: arguments.batch.clone(),
        c: arguments.language == Language::C,
        peer: arguments.peer.clone(),
        peers_manifest: arguments.peers_manifest.clone(),
        repetitions: arguments.repetitions,
        states: arguments.states,
        seed: arguments.seed,
        bound: arguments.bound,
    };
    let report = measure(robot.loaded(), &reading.description, &robot.whole_model(&built)?, &settings)?;
    console::report(format, || report.text(), || crate::json(&report))?;
    // The report is printed even if the drawing cannot be written: it took minutes to measure.
    if let Some(file) = &arguments.chart {
        output::write(file, report.chart()).map_err(Failure::after_report)?;
    }
    report.exceeded().map_or(Ok(OK), |line| Err(Failure::bound_of_report(line)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_a_finite_number() {
        assert_eq!((units("0"), units("2.5e1")), (Ok(0.0), Ok(25.0)));
        assert!(["nan", "inf", "-1", ""].iter().all(|text| units(text).is_err()));
    }
}
