//! Tables over time: in a file of numbers between commas, or in the scene itself.

use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
use std::collections::{HashMap, HashSet};
use std::io::BufRead;
use std::path::Path;

use articulated_core::control::Series;
use articulated_core::model::{JointInfo, Model};

use crate::csv;
use crate::initial::{Side, counted, neutral, normalise};

/// Where a table over time is to be had.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// A CSV, relative to the scene's folder; otherwise the rows are here.
    pub file: Option<String>,
    /// Names of the columns after the time.
    pub columns: Vec<String>,
    /// The time, s, and a number for each column.
    pub rows: Vec<Vec<f64>>,
    /// Each row holds until the next; otherwise linear between them.
    pub hold: bool,
    /// Where the scene names the file, or the columns.
    pub place: At,
    /// Where each column is named.
    pub column_places: Vec<At>,
    /// Where each row stands.
    pub row_places: Vec<At>,
}

/// Gives what a file holds by its name in the scene, to be read line by line, or says why not.
pub type Reader<'a> = dyn FnMut(&str) -> Result<Box<dyn BufRead>, String> + 'a;

/// The way to a column or a row, by its number.
type Key = dyn Fn(usize) -> String;

/// The place of one of them.
fn at(places: &[At], i: usize) -> At {
    places.get(i).copied().unwrap_or_default()
}

/// What a row has to have.
pub(crate) const ROW: &str = "the time and one for each of the columns";

impl Source {
    /// What can be told of rows in the scene without the robot, of the keys that are `right` by
    /// themselves.
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

    /// Each column is there once, by its name; other names of one place only the robot shows, see
    /// [`Source::places`].
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

    /// The table for a robot; columns that are not there are neutral. Without `read` a file is left
    /// alone.
    pub(crate) fn series(&self, model: &Model<f64>, side: Side, read: Option<&mut Reader<'_>>, log: &mut Diagnostics) -> Series {
        let Some(file) = &self.file else {
            let keys: [&Key; 2] = [&|i| format!("control.columns[{i}]"), &|i| format!("control.rows[{i}]")];
            return self.placed(model, side, keys, log);
        };
        let Some(read) = read else { return Series::default() };
        match read(file) {
            Ok(from) => self.parsed(file, from, (model, side), log),
            Err(reason) => {
                let found = format!("{}, which cannot be read ({reason})", quote(file));
                log.error((self.place, "control.file"), Code::UnknownName, found, "a CSV with a first line that names its columns");
                Series::default()
            }
        }
    }

    /// The table of a CSV. What is wrong with it is told of its own lines.
    fn parsed(&self, file: &str, from: Box<dyn BufRead>, robot: (&Model<f64>, Side), log: &mut Diagnostics) -> Series {
        let folder = Path::new(log.file()).parent().unwrap_or(Path::new(""));
        let mut own = Diagnostics::new(&folder.join(file).display().to_string());
        let series = csv::read(from, self.hold, robot, &mut own);
        log.take(own);
        series
    }

    /// Where the numbers of each column go: each to a place of its own.
    pub(crate) fn places(&self, model: &Model<f64>, side: Side, key: &Key, log: &mut Diagnostics) -> Places {
        let column = |(i, name): (usize, &String)| place_of(name, model, side, (at(&self.column_places, i), &key(i)), log);
        let places = Places(self.columns.iter().enumerate().map(column).collect());
        self.check_places(&places, key, log);
        places
    }

    /// No two columns go to one place under two names, as `elbow` and `elbow[0]`.
    fn check_places(&self, places: &Places, key: &Key, log: &mut Diagnostics) {
        let (mut names, mut taken) = (HashSet::new(), HashMap::new());
        for (i, (name, place)) in self.columns.iter().zip(&places.0).enumerate() {
            // A name that is there twice is told by `check_columns`.
            let (Some(place), true) = (place, names.insert(name)) else { continue };
            if let Some(before) = taken.insert(place, name) {
                let found = format!("the column {}, which is {} again", quote(name), quote(before));
                log.error((at(&self.column_places, i), &key(i)), Code::Together, found, "each once");
            }
        }
    }

    /// The columns in the places of their joints; `keys`: those of a column and of a row.
    fn placed(&self, model: &Model<f64>, side: Side, [column, key]: [&Key; 2], log: &mut Diagnostics) -> Series {
        let places = self.places(model, side, column, log);
        let neutral = places.neutral(model, side);
        let row = |numbers: &Vec<f64>| {
            let mut row = neutral.clone();
            places.put(&numbers[1..], &mut row);
            row
        };
        let mut rows: Vec<Vec<f64>> = self.rows.iter().map(row).collect();
        if side == Side::Q && places.are_all() {
            let place = |i: usize| at(&self.row_places, i);
            rows.iter_mut().enumerate().for_each(|(i, row)| normalise(model, row, (&key(i), &|_| place(i)), log));
        }
        Series { times: self.rows.iter().map(|r| r[0]).collect(), rows, hold: self.hold }
    }
}

/// Where in a row of the robot the number of each column goes; nowhere if there is no such joint.
pub(crate) struct Places(Vec<Option<usize>>);

impl Places {
    /// Whether each column has one.
    pub(crate) fn are_all(&self) -> bool {
        self.0.iter().all(Option::is_some)
    }

    /// A row of the robot, `[nq]` or `[nv]`, without any column.
    pub(crate) fn neutral(&self, model: &Model<f64>, side: Side) -> Vec<f64> {
        if side == Side::Q { neutral(model) } else { vec![0.0; model.nv()] }
    }

    /// Puts the numbers of the columns into a row of the robot.
    pub(crate) fn put(&self, numbers: &[f64], row: &mut [f64]) {
        for (place, x) in self.0.iter().zip(numbers) {
            if let Some(place) = place {
                row[*place] = *x;
            }
        }
    }
}

/// The columns that a robot has.
pub(crate) fn listed(model: &Model<f64>, side: Side) -> String {
    let count = |j: &JointInfo| if side == Side::Q { j.q.1 } else { j.v.1 };
    let name = |j: &JointInfo| match count(j) {
        1 => j.name.clone(),
        n => format!("{0}[0] to {0}[{1}]", j.name, n - 1),
    };
    articulated_core::listed(model.joints().iter().map(name))
}

/// The place of `joint` or `joint[k]`.
fn place_of(name: &str, model: &Model<f64>, side: Side, (at, key): (At, &str), log: &mut Diagnostics) -> Option<usize> {
    let range = |joint: &str| model.joints().iter().find(|j| j.name == joint).map(|j| if side == Side::Q { j.q } else { j.v });
    if let Some((first, 1)) = range(name) {
        return Some(first);
    }
    let indexed = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
    if let Some((joint, k)) = indexed
        && let (Some((first, count)), Ok(k)) = (range(joint), k.parse::<usize>())
        && k < count
    {
        return Some(first + k);
    }
    let names = model.joints().iter().map(|j| j.name.as_str());
    let found = format!("the column {}", quote(name));
    log.unknown(((at, key), Code::UnknownName), (found, name), "a joint that moves, as elbow, or one of its numbers, as ball[0]", names);
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_list_of_columns_is_cut() {
        let link = |i: usize| {
            let kind = if i == 0 { "spherical" } else { "continuous" };
            format!("<link name='l{i}'/><joint name='j{i}' type='{kind}'><parent link='base'/><child link='l{i}'/></joint>")
        };
        let urdf = format!("<robot name='r'><link name='base'/>{}</robot>", (0..14).map(link).collect::<String>());
        let description = articulated_formats::read(urdf.as_bytes(), &Default::default()).unwrap().description;
        let model = Model::new(&description, articulated_core::description::Base::Fixed).unwrap();
        assert_eq!(listed(&model, Side::Q), "j0[0] to j0[3], j1, j2, j3, j4, j5, j6, j7, j8, j9, j10, j11 and 2 more");
        assert!(listed(&model, Side::V).starts_with("j0[0] to j0[2], j1"));
    }
}
