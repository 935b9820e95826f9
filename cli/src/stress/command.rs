//! The command itself: which rows, and the exit status.

use std::path::Path;

use articulated_codegen::Level;
use articulated_core::algorithm::Argument;
use serde::Serialize;

use super::corpus::{CHAPTERS, Effort};
use super::judge::State;
use super::own::Found;
use super::row::Row;
use super::{levels, own, text};
use crate::arguments::{Format, RobotArguments};
use crate::console::{self, Progress};
use crate::failure::{Failure, OK};
use crate::robot::{Robot, note_of_parameters, read_bytes};
use crate::states;
use crate::stress::arguments::StressArguments;

/// What was measured.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Report {
    /// Every row is right.
    pub(super) pass: bool,
    /// How many were measured, and how many of them are wrong.
    pub(super) rows_measured: usize,
    pub(super) rows_failed: usize,
    /// What was left out, and why.
    pub(super) notes: Vec<String>,
    pub(super) rows: Vec<Row>,
}

/// Measures and prints; a row that is wrong is an exceeded bound.
pub(crate) fn run(arguments: &StressArguments, format: Format) -> Result<u8, Failure> {
    let Found { rows, notes } = match &arguments.robot {
        Some(robot) => of_robot(arguments, robot)?,
        None => of_corpus(arguments)?,
    };
    let failed = rows.iter().filter(|r| !r.pass).count();
    let report = Report { pass: failed == 0, rows_measured: rows.len(), rows_failed: failed, notes, rows };
    console::print(&match format {
        Format::Text => text::text(&report, arguments.rows),
        Format::Json => crate::json(&report),
    })?;
    match failed {
        0 => Ok(OK),
        n => Err(Failure::bound_of_report(format!("{n} of {} rows beyond their limits", report.rows_measured))),
    }
}

fn of_corpus(arguments: &StressArguments) -> Result<Found, Failure> {
    let effort = if arguments.full { Effort::Full } else { Effort::Quick };
    let wanted = |name: &str| arguments.chapters.is_empty() || arguments.chapters.iter().any(|c| c == name);
    let chapters: Vec<_> = CHAPTERS.iter().filter(|(name, _)| wanted(name)).collect();
    let progress = Progress::new(chapters.len() + 2);
    let Found { mut rows, mut notes } = Found::default();
    for (name, chapter) in chapters {
        progress.doing(format!("chapter {name}"));
        rows.extend(chapter(effort));
        progress.step();
    }
    if arguments.generated && wanted(levels::NAME) || arguments.chapters.iter().any(|c| c == levels::NAME) {
        progress.doing(format!("chapter {}", levels::NAME));
        let all = if arguments.levels.is_empty() { Level::all() } else { arguments.levels.clone() };
        rows.extend(levels::chapter(effort, &all)?);
    }
    progress.step();
    if wanted(own::NAME) {
        for robot in articulated_models::ROBOTS {
            progress.doing(format!("robot {}", robot.name));
            let robot = Robot::find(&RobotArguments::plain(robot.name, false))?;
            let found = own::rows(&robot, &[], &of_robots(arguments))?;
            rows.extend(found.rows);
            notes.extend(found.notes.iter().map(|note| format!("{}: {note}", robot.file)));
        }
    }
    progress.step();
    Ok(Found { rows, notes })
}

/// The levels of robots' generated code.
fn of_robots(arguments: &StressArguments) -> Vec<Level> {
    match (arguments.generated, arguments.levels.is_empty()) {
        (false, _) => Vec::new(),
        (true, true) => vec![Level::default()],
        (true, false) => arguments.levels.clone(),
    }
}

fn of_robot(arguments: &StressArguments, name: &Path) -> Result<Found, Failure> {
    let mut robot = RobotArguments::plain(name, arguments.floating);
    robot.fixed = arguments.fixed;
    robot.gravity = arguments.gravity;
    robot.allow_unphysical_inertia = arguments.allow_unphysical_inertia;
    let robot = Robot::find(&robot)?;
    let given = match &arguments.states {
        Some(file) => given(&robot, file)?,
        None => Vec::new(),
    };
    let mut found = own::rows(&robot, &given, &of_robots(arguments))?;
    found.notes.extend(note_of_parameters(&robot.options));
    Ok(found)
}

/// The states of a file; what a state does not give is zero.
fn given(robot: &Robot, path: &Path) -> Result<Vec<State>, Failure> {
    let model = robot.whole_model(&robot.read()?)?;
    let file = path.display();
    let bytes = read_bytes(path).map_err(|e| Failure::input([format!("{file}: {e}")]))?;
    let read = states::read(&bytes, &model).map_err(|lines| Failure::input(lines.into_iter().map(|l| format!("{file}: {l}"))))?;
    read.warnings.iter().for_each(|w| console::warn(w));
    let one = |s: &states::State| {
        let of = |a: Argument| s.get(a).map_or_else(|| vec![0.0; a.len(model.shape())], <[f64]>::to_vec);
        State { q: of(Argument::Q), v: of(Argument::V), a: of(Argument::A), tau: of(Argument::Tau) }
    };
    Ok(read.states.iter().map(one).collect())
}
