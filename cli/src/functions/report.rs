//! The table of functions as data.

use std::borrow::Cow;

use articulated_codegen::ledger::Entry;
use articulated_core::algorithm::{Argument, Function};
use serde::Serialize;

use crate::shape;
use articulated_codegen::function_groups::Group;

#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Report {
    pub(super) robots: Vec<RobotRow>,
    pub(super) functions: Vec<FunctionRow>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct RobotRow {
    pub(super) robot: String,
    pub(super) base: &'static str,
    pub(super) joints: usize,
    pub(super) degrees_of_freedom: usize,
    /// The frames that functions of frames are generated for.
    pub(super) frames: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct FunctionRow {
    pub(super) function: &'static str,
    #[serde(serialize_with = "name_of")]
    pub(super) group: Group,
    pub(super) takes: Vec<&'static str>,
    pub(super) gives: String,
    pub(super) unit: String,
    pub(super) summary: &'static str,
    pub(super) algorithm: &'static str,
    /// For a preset: the function, and its arguments that are zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) preset_of: Option<Preset>,
    /// One for each robot.
    pub(super) costs: Vec<Cell>,
}

#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Cell {
    Cost(Cost),
    /// The reason why the robot does not have the function.
    Undefined(String),
}

/// A function at zeros.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Preset {
    function: &'static str,
    zeros: Vec<&'static str>,
}

/// The emitted operations.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Cost {
    pub(super) multiplications: u64,
    pub(super) additions: u64,
    /// A multiply-add counted once; no sines and cosines.
    pub(super) instructions: u64,
    pub(super) sines_and_cosines: u64,
    pub(super) depth: u32,
    /// The forms chosen by count, if there are several.
    pub(super) ways: Vec<Cow<'static, str>>,
}

fn name_of<S: serde::Serializer>(group: &Group, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(group.name())
}

impl FunctionRow {
    pub(super) fn new(f: &Function<f64>, costs: Vec<Cell>) -> Self {
        Self {
            function: f.name,
            group: f.group,
            takes: f.takes.iter().copied().map(Argument::name).collect(),
            gives: shape::gives(f),
            unit: shape::unit(f),
            summary: f.summary,
            algorithm: f.source,
            preset_of: (f.general != f.id).then(|| Preset { function: f.general.name(), zeros: f.zeros().map(Argument::name).collect() }),
            costs,
        }
    }

    /// The algorithm and its source; for a preset, its function's name between two of these quotes.
    pub(super) fn computed_by(&self, quote: &str) -> String {
        self.preset_of.as_ref().map_or_else(
            || self.algorithm.to_owned(),
            |preset| format!("{quote}{}{quote} at {} = 0", preset.function, preset.zeros.join(" = ")),
        )
    }
}

impl Cost {
    pub(super) fn of(entry: &Entry) -> Self {
        let c = entry.emitted();
        Self {
            multiplications: c.multiplications(),
            additions: c.additions(),
            instructions: c.instructions(),
            sines_and_cosines: c.trigonometric(),
            depth: entry.depth,
            ways: entry.ways.clone(),
        }
    }
}

/// Reasons why a function is not defined, numbered from 1 as they are met.
#[derive(Debug, Default)]
pub(super) struct Footnotes(Vec<String>);

impl Footnotes {
    /// The cell's text: counts, or a dash with the number of the reason.
    pub(super) fn cell(&mut self, cell: &Cell) -> String {
        match cell {
            Cell::Cost(c) => format!("{}+{}, {}", c.multiplications, c.additions, c.instructions),
            Cell::Undefined(why) => {
                let known = self.0.iter().position(|w| w == why);
                let k = known.unwrap_or_else(|| {
                    self.0.push(why.clone());
                    self.0.len() - 1
                });
                format!("– ({})", k + 1)
            }
        }
    }

    /// A line for each reason.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> + '_ {
        self.0.iter().enumerate().map(|(k, why)| format!("({}) not defined: {why}", k + 1))
    }
}
