//! Size of the files in a folder: announced before the motion if it is large, and refused if it
//! exceeds the limit.

use std::path::Path;

use articulated::simulate::{Output, Settings};
use articulated_core::algorithm::Shape;

use super::arguments::SimulateArguments;
use super::files::is_page;
use crate::console;
use crate::failure::Failure;

/// Upper bound of bytes of a number with its comma.
const NUMBER: f64 = 25.0;

/// The command announces a size of this many bytes or more.
const MUCH: f64 = 1e7;

/// Default limit of the table, MB.
pub(super) const DEFAULT: u64 = 1000;

/// Size of a motion's records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Size {
    /// Numbers in a row.
    columns: usize,
    /// Rows that there is room for.
    most: f64,
    /// MB that there may be.
    allowed: u64,
}

impl Size {
    /// For motions of a robot that records all numbers.
    fn of(shape: Shape, allowed: u64) -> Self {
        let columns = 1 + shape.nq + 2 * shape.nv + 6 + 6;
        Self { columns, most: (allowed as f64 * 1e6 / Self::bytes(columns, 1.0)).floor(), allowed }
    }

    fn bytes(columns: usize, rows: f64) -> f64 {
        rows * columns as f64 * NUMBER
    }

    /// Description of a number of rows.
    fn describe(self, rows: f64) -> String {
        let size = Self::bytes(self.columns, rows) / 1e6;
        format!("{rows} rows of {} columns: up to {size:.0} MB", self.columns)
    }

    /// Checks the size of a motion in the folder of the arguments in advance. If the number of
    /// records is known only after the motion, it is limited to the available room. Errors: the
    /// size exceeds the limit.
    pub(super) fn look_ahead(shape: Shape, settings: &mut Settings, arguments: &SimulateArguments) -> Result<Option<Self>, Failure> {
        let Some(folder) = arguments.output.as_ref().filter(|path| !is_page(path)) else { return Ok(None) };
        let size = Self::of(shape, allowed(arguments));
        match rows(settings) {
            Some(rows) if rows > size.most => return Err(Failure::input([size.refusal(folder, rows)])),
            Some(rows) if Self::bytes(size.columns, rows) > MUCH => {
                console::note(&format!("{}: {}", folder.display(), size.describe(rows)));
            }
            Some(_) => {}
            None => settings.max_steps = settings.max_steps.min((size.most as u64).max(2) - 1),
        }
        Ok(Some(size))
    }

    fn refusal(self, folder: &Path, rows: f64) -> String {
        format!(
            "--output {}: found {}, expected at most {} MB: record less often (--every, or `output` in [simulation]), or allow more by --max-output-size",
            folder.display(),
            self.describe(rows),
            self.allowed
        )
    }

    /// The reason why a motion ended after this number of records.
    pub(super) fn ended(self, records: usize) -> Option<String> {
        let full = records as f64 >= self.most;
        full.then(|| {
            format!(
                "{}: there may be no more, unless --max-output-size allows more than {} MB",
                self.describe(records as f64),
                self.allowed
            )
        })
    }
}

/// MB that a file may have.
pub(super) fn allowed(arguments: &SimulateArguments) -> u64 {
    arguments.max_output_size.unwrap_or(DEFAULT)
}

/// Number of records of a motion to its end; `None`: one for each step, with steps by tolerance.
fn rows(settings: &Settings) -> Option<f64> {
    let length = settings.end - settings.start;
    match (&settings.output, settings.step) {
        (Output::Every(every), _) => Some((length / every).ceil() + 1.0),
        (Output::At(times), _) => Some(times.len() as f64 + 1.0),
        (Output::Ends, _) => Some(2.0),
        (Output::Steps, Some(step)) => Some((length / step).ceil().min(settings.max_steps as f64) + 1.0),
        (Output::Steps, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: Shape = Shape { nq: 7, nv: 6, frames: 0, links: 1, controls: 0, activations: 0, contacts: 0, given: 0 };

    fn arguments(size: Option<u64>) -> SimulateArguments {
        use clap::Parser;
        #[derive(Parser)]
        struct Words {
            #[command(flatten)]
            all: SimulateArguments,
        }
        let mut words = vec!["simulate".to_owned(), "scene".to_owned(), "-o".to_owned(), "folder".to_owned()];
        words.extend(size.map(|mb| format!("--max-output-size={mb}")));
        Words::parse_from(words).all
    }

    #[test]
    fn rows_are_those_that_the_motion_will_have() {
        let settings = |output| Settings { start: 1.0, end: 3.0, output, ..Settings::default() };
        assert_eq!(rows(&settings(Output::Every(0.01))), Some(201.0));
        assert_eq!(rows(&settings(Output::Every(0.3))), Some(8.0));
        assert_eq!(rows(&settings(Output::At(vec![1.5, 2.0]))), Some(3.0));
        assert_eq!(rows(&settings(Output::Ends)), Some(2.0));
        assert_eq!(rows(&settings(Output::Steps)), None);
        assert_eq!(rows(&Settings { step: Some(0.5), ..settings(Output::Steps) }), Some(5.0));
        assert_eq!(rows(&Settings { step: Some(1e-3), max_steps: 9, ..settings(Output::Steps) }), Some(10.0));
    }

    /// 1 + 7 + 2·6 + 12 = 32 columns of 25 bytes: a row is 800 bytes, and 1 MB is 1250 rows.
    #[test]
    fn a_motion_that_would_write_more_than_may_be_is_refused() {
        let ahead = |rows: f64, size| {
            let mut settings = Settings { end: rows - 1.0, output: Output::Every(1.0), ..Settings::default() };
            Size::look_ahead(SHAPE, &mut settings, &arguments(size)).map_err(|failure| failure.errors[0].message.clone())
        };
        assert!(ahead(1250.0, Some(1)).is_ok());
        let told = ahead(1251.0, Some(1)).unwrap_err();
        let expected = "--output folder: found 1251 rows of 32 columns: up to 1 MB, expected at most 1 MB: ";
        assert!(told.starts_with(expected) && told.ends_with("or allow more by --max-output-size"), "{told}");
        assert!(ahead(1_250_000.0, None).is_ok() && ahead(1_250_001.0, None).unwrap_err().contains("up to 1000 MB"));
    }

    #[test]
    fn steps_by_tolerance_end_where_there_is_no_more_room() {
        let mut settings = Settings { output: Output::Steps, ..Settings::default() };
        let size = Size::look_ahead(SHAPE, &mut settings, &arguments(Some(1))).unwrap().unwrap();
        assert_eq!((settings.max_steps, size.ended(1249)), (1249, None));
        assert!(size.ended(1250).is_some_and(|told| told.starts_with("1250 rows of 32 columns: ")));
    }
}
