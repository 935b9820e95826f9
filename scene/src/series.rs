//! Tables over time: in a file of numbers between commas, or in the scene itself.

use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
use std::collections::{HashMap, HashSet};
use std::io::{BufRead, BufReader};
use std::path::Path;

use articulated_core::control::{Interpolation, Series};
use articulated_formats::{nearest_file, open_file};

use crate::csv;
use crate::initial::counted;
use crate::slots::Slots;

/// The numbers between two rows of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// Linear; a quaternion by the shortest rotation, at one rate.
    #[default]
    Linear,
    /// Each row holds until the next.
    Hold,
    /// A cubic spline, at rest at its ends.
    Cubic,
}

impl Between {
    /// The table with these numbers between its rows.
    fn of(self, series: Series) -> Series {
        let Series { times, rows, .. } = series;
        let between = match self {
            Self::Linear => Interpolation::Linear,
            Self::Hold => Interpolation::Hold,
            Self::Cubic => Interpolation::cubic(&times, &rows),
        };
        Series { times, rows, between }
    }
}

/// Source of a table over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// A CSV, relative to the scene's folder; otherwise the rows are here.
    pub file: Option<String>,
    /// Names of the columns after the time.
    pub columns: Vec<String>,
    /// The time, s, and a number for each column.
    pub rows: Vec<Vec<f64>>,
    /// The numbers between two rows.
    pub between: Between,
    /// Where the scene says what is between rows.
    pub between_place: At,
    /// Place of the file, or of the columns, in the scene.
    pub place: At,
    /// Where each column is named.
    pub column_places: Vec<At>,
    /// Place of each row.
    pub row_places: Vec<At>,
}

/// Opens a file by its name in the scene, to be read line by line, or returns the reason why not.
pub type Reader<'a> = dyn FnMut(&str) -> Result<Box<dyn BufRead>, String> + 'a;

/// The way to a column or a row, by its number.
type Key = dyn Fn(usize) -> String;

/// The i-th place.
fn at(places: &[At], i: usize) -> At {
    places.get(i).copied().unwrap_or_default()
}

/// Content of a row.
pub(crate) const ROW: &str = "the time and one for each of the columns";

impl Source {
    /// Checks the rows in the scene without the robot, for the keys that are `right` by themselves.
    pub(crate) fn check(&self, key: &str, right: &[&str], log: &mut Diagnostics) {
        let [columns, rows] = ["columns", "rows"].map(|name| right.contains(&name));
        let missing = match (columns && self.columns.is_empty(), rows && self.rows.is_empty()) {
            (_, true) => Some((self.place, "columns without rows", "rows: the time and a number for each column")),
            (true, false) => Some((at(&self.row_places, 0), "rows without columns", "columns: the names of the numbers after the time")),
            _ => None,
        };
        if let Some((at, found, expected)) = missing {
            log.error((at, key), Code::MissingKey, found, expected);
            return;
        }
        let row = |i: usize| format!("{key}.rows[{i}]");
        if columns {
            self.check_columns(&|i| format!("{key}.columns[{i}]"), log);
        }
        if rows && columns {
            self.check_widths(&row, log);
        }
        if rows {
            self.check_order(&row, log);
        }
    }

    /// Each column occurs once, by its name; different names of one place are only found with the
    /// robot, see [`Source::places`].
    pub(crate) fn check_columns(&self, key: &dyn Fn(usize) -> String, log: &mut Diagnostics) {
        let mut seen = HashSet::new();
        for (i, name) in self.columns.iter().enumerate().filter(|(_, name)| !seen.insert(name.as_str())) {
            log.error((at(&self.column_places, i), &key(i)), Code::Together, format!("the column {} twice", quote(name)), "each once");
        }
    }

    /// Each row has all its numbers.
    fn check_widths(&self, key: &dyn Fn(usize) -> String, log: &mut Diagnostics) {
        let width = self.columns.len() + 1;
        for (i, row) in self.rows.iter().enumerate().filter(|(_, row)| row.len() != width) {
            let expected = format!("{}: {ROW}", counted(width));
            log.error((at(&self.row_places, i), &key(i)), Code::Together, counted(row.len()), expected);
        }
    }

    /// Rows are in order.
    fn check_order(&self, key: &dyn Fn(usize) -> String, log: &mut Diagnostics) {
        for i in 1..self.rows.len() {
            if let ([before, ..], [time, ..]) = (&self.rows[i - 1][..], &self.rows[i][..])
                && time <= before
            {
                log.error(
                    (at(&self.row_places, i), &key(i)),
                    Code::Together,
                    format!("the time {time:?} after {before:?}"),
                    "times in order",
                );
            }
        }
    }

    /// The table with rows of these numbers; those without a column are neutral. Without `read` no
    /// file is opened.
    pub(crate) fn series(&self, slots: &Slots<'_>, read: Option<&mut Reader<'_>>, log: &mut Diagnostics) -> Series {
        let Some(file) = &self.file else {
            let keys: [&Key; 2] = [&|i| format!("control.columns[{i}]"), &|i| format!("control.rows[{i}]")];
            return self.placed(slots, keys, log);
        };
        let Some(read) = read else { return Series::default() };
        match read(file) {
            Ok(from) => self.parsed(file, from, slots, log),
            Err(reason) => {
                unreadable(file, self.place, &reason, log);
                Series::default()
            }
        }
    }

    /// The table of a CSV. Its errors are reported at their lines in the file.
    fn parsed(&self, file: &str, from: Box<dyn BufRead>, slots: &Slots<'_>, log: &mut Diagnostics) -> Series {
        let folder = Path::new(log.file()).parent().unwrap_or(Path::new(""));
        let mut own = Diagnostics::new(&folder.join(file).display().to_string());
        let series = csv::read(from, slots, &mut own);
        log.take(own);
        self.between.of(series)
    }

    /// Where the numbers of each column go: each to a place of its own.
    pub(crate) fn places(&self, slots: &Slots<'_>, key: &Key, log: &mut Diagnostics) -> Places {
        let column = |(i, name): (usize, &String)| slots.place(name, (at(&self.column_places, i), &key(i)), log);
        let places = Places(self.columns.iter().enumerate().map(column).collect());
        self.check_places(&places, key, log);
        places
    }

    /// No two columns go to one place under two names, as `elbow` and `elbow[0]`.
    fn check_places(&self, places: &Places, key: &Key, log: &mut Diagnostics) {
        let (mut names, mut taken) = (HashSet::new(), HashMap::new());
        for (i, (name, place)) in self.columns.iter().zip(&places.0).enumerate() {
            // `check_columns` reports duplicate names.
            let (Some(place), true) = (place, names.insert(name)) else { continue };
            if let Some(before) = taken.insert(place, name) {
                let found = format!("the column {}, which is {} again", quote(name), quote(before));
                log.error((at(&self.column_places, i), &key(i)), Code::Together, found, "each once");
            }
        }
    }

    /// The columns in their places; `keys`: those of a column and of a row.
    fn placed(&self, slots: &Slots<'_>, [column, key]: [&Key; 2], log: &mut Diagnostics) -> Series {
        let places = self.places(slots, column, log);
        let neutral = &slots.neutral;
        let row = |numbers: &Vec<f64>| {
            let mut row = neutral.clone();
            places.put(&numbers[1..], &mut row);
            row
        };
        let mut rows: Vec<Vec<f64>> = self.rows.iter().map(row).collect();
        if places.are_all() {
            let place = |i: usize| at(&self.row_places, i);
            rows.iter_mut().enumerate().for_each(|(i, row)| slots.normalise(row, (&key(i), &|_| place(i)), log));
        }
        let times = self.rows.iter().map(|r| r[0]).collect();
        self.between.of(Series { times, rows, ..Series::default() })
    }
}

/// Reports an unreadable file of a table.
pub(crate) fn unreadable(file: &str, place: At, reason: &str, log: &mut Diagnostics) {
    let found = format!("{}, which cannot be read ({reason})", quote(file));
    log.error((place, "control.file"), Code::UnknownName, found, "a CSV with a first line that names its columns");
}

/// Opens the file of a table, seen from `folder`, to be read line by line.
///
/// # Errors
/// A file that is unreadable, not regular, or larger than any table (4 GiB); for a missing file,
/// the intended name.
pub fn open_table(folder: &Path, name: &str) -> Result<Box<dyn BufRead>, String> {
    let path = folder.join(name);
    let file = open_file(&path, MOST_OF_TABLE).map_err(|error| {
        let near = nearest_file(&path).map(|near| format!("; did you mean {near:?}?")).unwrap_or_default();
        format!("{}: {error}{near}", path.display())
    })?;
    Ok(Box::new(BufReader::new(file)))
}

/// Maximum size of a control table, bytes: ten million rows, the maximum, of 400 bytes each.
const MOST_OF_TABLE: u64 = 4 << 30;

/// Index in a row for the number of each column; `None` if no number has such a name.
pub(crate) struct Places(Vec<Option<usize>>);

impl Places {
    /// Whether each column has one.
    pub(crate) fn are_all(&self) -> bool {
        self.0.iter().all(Option::is_some)
    }

    /// Puts the numbers of the columns into a row.
    pub(crate) fn put(&self, numbers: &[f64], row: &mut [f64]) {
        for (place, x) in self.0.iter().zip(numbers) {
            if let Some(place) = place {
                row[*place] = *x;
            }
        }
    }
}
