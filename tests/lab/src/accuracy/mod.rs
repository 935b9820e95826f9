//! The cost of accuracy: error and time of each function at each level.

mod advise;
mod contender;
mod csv;
mod judge;
mod labels;
mod measure;
pub mod motion;
mod page;
mod plot;
mod report;
mod states;
mod text;
mod words;

use articulated_codegen::Precision;
use articulated_core::algorithm::function;
use articulated_core::description::Description;

use crate::compare::accuracy::Reference;
use crate::compiled::Rustc;
use crate::error::Error;
use crate::json::json;
use crate::robot::Robot;
pub use report::{Report, Settings};

/// Default functions.
const FUNCTIONS: [&str; 4] = ["placements", "inverse_dynamics", "mass_matrix", "forward_dynamics"];

/// Measures a robot.
pub fn measure(robot: &Robot, description: &Description, settings: &Settings) -> Result<Report, Error> {
    let mut functions: Vec<&'static str> = Vec::new();
    let wanted = if settings.functions.is_empty() { FUNCTIONS.map(str::to_owned).to_vec() } else { settings.functions.clone() };
    for name in wanted.iter().filter_map(|name| Some(function::<f64>(name)?.name)) {
        if !functions.contains(&name) {
            functions.push(name);
        }
    }
    let mut levels: Vec<Precision> = Vec::new();
    for level in if settings.levels.is_empty() { Precision::all() } else { settings.levels.clone() } {
        if !levels.contains(&level) {
            levels.push(level);
        }
    }
    let rustc = Rustc::find().map_err(|e| Error::tool(&e))?;
    let reference = Reference::new(description, robot);
    measure::all(robot, &reference, &rustc, &functions, &levels, settings)
}

impl Report {
    /// As tables.
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// The cheapest level of each function with a largest error of at most `wish`.
    pub fn advice(&self, wish: f64) -> advise::Whole<'_> {
        advise::whole(self, wish)
    }

    /// The same in sentences.
    pub fn advice_in_text(&self, wish: f64) -> String {
        advise::text(self, wish)
    }

    /// The functions without an accurate enough level, in a sentence.
    pub fn short_of(&self, wish: f64) -> Option<String> {
        advise::short(self, wish)
    }

    /// All files of the report: their names and contents.
    pub fn files(&self) -> Vec<(String, String)> {
        let diagrams = plot::diagrams(self);
        let mut files: Vec<(String, String)> = diagrams.iter().map(|(name, drawing)| (format!("{name}.svg"), drawing.svg())).collect();
        files.push(("accuracy.csv".to_owned(), csv::text(self)));
        files.push(("accuracy.json".to_owned(), json(self)));
        files.push(("report.html".to_owned(), page::html(self, &diagrams)));
        files
    }
}
