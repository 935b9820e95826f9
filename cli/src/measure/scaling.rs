//! `articulated scaling`.

use std::path::PathBuf;

use articulated_lab::scaling::{Settings, measure};
use clap::Args;

use super::chart;
use crate::arguments::Format;
use crate::failure::Failure;
use crate::names::{self, Names, known};
use crate::{console, output};

#[derive(Args, Debug)]
pub(crate) struct ScalingArguments {
    /// Numbers of joints [default: 7,14,30,60,125; with --all up to 1000]
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', value_parser = joints)]
    pub(crate) joints: Vec<usize>,
    /// The functions to measure, or groups of them
    /// [default: inverse_dynamics,mass_matrix,forward_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// Measure all lengths: takes minutes and gigabytes of memory, mostly for rustc
    #[arg(long, conflicts_with = "joints")]
    pub(crate) all: bool,
    /// The file to draw the times to, as SVG
    #[arg(long, value_name = "FILE")]
    pub(crate) chart: Option<PathBuf>,
    /// Print a Markdown document
    #[arg(long, conflicts_with = "format")]
    pub(crate) markdown: bool,
    /// Repetitions of each timing, at least 5
    #[arg(long, value_name = "N", default_value_t = 31, value_parser = clap::value_parser!(u32).range(5..=100_000))]
    pub(crate) repetitions: u32,
}

fn joints(text: &str) -> Result<usize, String> {
    text.trim().parse().ok().filter(|n| (1..=2000).contains(n)).ok_or_else(|| "expected 1 to 2000 joints".into())
}

/// Measures and prints.
pub(crate) fn run(arguments: &ScalingArguments, format: Format) -> Result<(), Failure> {
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: times of generic code, and of the generation, mean little");
    }
    arguments.chart.as_deref().map_or(Ok(()), chart::checked)?;
    let settings = Settings {
        joints: arguments.joints.clone(),
        functions: names::flat(&arguments.functions),
        all: arguments.all,
        repetitions: arguments.repetitions,
    };
    let report = measure(&settings)?;
    let text = || if arguments.markdown { report.markdown(arguments.chart.as_deref()) } else { report.text() };
    console::report(format, text, || crate::json(&report))?;
    // The report is printed even if the drawing cannot be written: it took minutes to measure.
    arguments.chart.as_ref().map_or(Ok(()), |path| output::write(path, report.chart())).map_err(Failure::after_report)
}
