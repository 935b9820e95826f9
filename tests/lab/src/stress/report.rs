//! Which rows are measured.

use articulated_codegen::{Options, Precision};
use articulated_core::model::Model;
use serde::Serialize;

use super::corpus::{CHAPTERS, Effort};
use super::judge::State;
use super::row::Row;
use super::user_robot::Found;
use super::{levels, user_robot};
use crate::console::Progress;
use crate::error::Error;
use crate::robot::{Robot, note_of_parameters};

/// The results of the measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Every row is right.
    pub(super) pass: bool,
    /// Number of measured rows, and of failed ones.
    pub(super) rows_measured: usize,
    pub(super) rows_failed: usize,
    /// Omitted measurements, with the reasons.
    pub(super) notes: Vec<String>,
    pub(super) rows: Vec<Row>,
}

/// Settings of the measurement.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The chapters of the corpus; if empty, all.
    pub chapters: Vec<String>,
    /// All of the corpus, which takes minutes.
    pub full: bool,
    /// Generated code too, compiled by rustc.
    pub generated: bool,
    /// The levels; if empty, all of the corpus, and the default one of robots.
    pub levels: Vec<Precision>,
}

/// All names of chapters.
pub fn chapters() -> impl Iterator<Item = &'static str> {
    CHAPTERS.iter().map(|(name, _)| *name).chain([levels::NAME, user_robot::NAME])
}

/// Measures the corpus and the bundled robots.
pub fn of_corpus(settings: &Settings) -> Result<Report, Error> {
    let effort = if settings.full { Effort::Full } else { Effort::Quick };
    let wanted = |name: &str| settings.chapters.is_empty() || settings.chapters.iter().any(|c| c == name);
    let chapters: Vec<_> = CHAPTERS.iter().filter(|(name, _)| wanted(name)).collect();
    let progress = Progress::new(chapters.len() + 2);
    let Found { mut rows, mut notes } = Found::default();
    for (name, chapter) in chapters {
        progress.doing(format!("chapter {name}"));
        rows.extend(chapter(effort));
        progress.step();
    }
    if settings.generated && wanted(levels::NAME) || settings.chapters.iter().any(|c| c == levels::NAME) {
        progress.doing(format!("chapter {}", levels::NAME));
        let all = if settings.levels.is_empty() { Precision::all() } else { settings.levels.clone() };
        rows.extend(levels::chapter(effort, &all)?);
    }
    progress.step();
    if wanted(user_robot::NAME) {
        for bundled in articulated_models::ROBOTS {
            progress.doing(format!("robot {}", bundled.name));
            let mut options = Options::default();
            options.robot.base = bundled.base;
            let file = format!("{}.urdf", bundled.name);
            let robot = Robot { file, scene: None, document: bundled.urdf.as_bytes().to_vec(), options, effects: None, path: None };
            let request = robot.request(&[]);
            let model = request.build_robot()?.model;
            let found = user_robot::rows(&robot, &model, &[], &of_robots(settings))?;
            rows.extend(found.rows);
            notes.extend(found.notes.iter().map(|note| format!("{}: {note}", robot.file)));
        }
    }
    progress.step();
    Ok(Report::new(Found { rows, notes }))
}

/// The levels of robots' generated code.
fn of_robots(settings: &Settings) -> Vec<Precision> {
    match (settings.generated, settings.levels.is_empty()) {
        (false, _) => Vec::new(),
        (true, true) => vec![Precision::default()],
        (true, false) => settings.levels.clone(),
    }
}

/// Measures a robot: on random states, on hard ones, and on given ones. `model`: with a frame for
/// each link.
pub fn of_robot(robot: &Robot, model: &Model<f64>, given: &[State], settings: &Settings) -> Result<Report, Error> {
    let mut found = user_robot::rows(robot, model, given, &of_robots(settings))?;
    found.notes.extend(note_of_parameters(&robot.options));
    Ok(Report::new(found))
}

impl Report {
    fn new(Found { rows, notes }: Found) -> Self {
        let failed = rows.iter().filter(|r| !r.pass).count();
        Self { pass: failed == 0, rows_measured: rows.len(), rows_failed: failed, notes, rows }
    }

    /// A sentence if rows are beyond their limits.
    pub fn exceeded(&self) -> Option<String> {
        (self.rows_failed > 0).then(|| format!("{} of {} rows beyond their limits", self.rows_failed, self.rows_measured))
    }
}
