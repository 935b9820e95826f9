//! Tables over time: in a file of numbers between commas, or in the scene itself.

use std::collections::HashSet;
use std::path::Path;

use articulated_core::effect::Range;
use articulated_core::model::Model;

use crate::error::{Kind, bare, quote};
use crate::initial::{Side, counted, neutral, normalise};
use crate::log::Log;
use crate::tree::At;

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

/// Numbers over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Times in order, s.
    pub times: Vec<f64>,
    /// One row a time, each as long as q or v; quaternions have norm one.
    pub rows: Vec<Vec<f64>>,
    /// Each row holds until the next; otherwise linear between them.
    pub hold: bool,
}

impl Series {
    /// The numbers at the time `t`, each by itself (a quaternion is none between two rows); before the first row and after the last the nearest of them.
    pub fn at(&self, t: f64, out: &mut [f64]) {
        let next = self.times.partition_point(|x| *x <= t);
        let before = next.saturating_sub(1);
        let after = next.min(self.times.len().saturating_sub(1));
        let (Some(a), Some(b)) = (self.rows.get(before), self.rows.get(after)) else { return };
        let span = self.times[after] - self.times[before];
        let part = if self.hold || span <= 0.0 { 0.0 } else { (t - self.times[before]) / span };
        out.iter_mut().zip(a.iter().zip(b)).for_each(|(out, (a, b))| *out = a + part * (b - a));
    }
}

/// Gives the text of a file by its name in the scene, or says why not.
pub type Reader<'a> = dyn FnMut(&str) -> Result<String, String> + 'a;

/// More columns or rows no table has.
const MOST: usize = 10_000_000;

/// The way to a column or a row, by its number.
type Key = dyn Fn(usize) -> String;

/// The place of one of them.
fn at(places: &[At], i: usize) -> At {
    places.get(i).copied().unwrap_or_default()
}

/// What a row has to have.
const ROW: &str = "the time and one for each of the columns";

impl Source {
    /// What can be told of rows in the scene without the robot.
    pub(crate) fn check(&self, key: &str, log: &mut Log) {
        let missing = match (self.columns.is_empty(), self.rows.is_empty()) {
            (_, true) => Some((self.place, "columns without rows", "rows: the time and a number for each column")),
            (true, false) => Some((at(&self.row_places, 0), "rows without columns", "columns: the names of the numbers after the time")),
            _ => None,
        };
        if let Some((at, found, expected)) = missing {
            log.error(at, key, Kind::MissingKey, found, expected);
            return;
        }
        self.check_columns(&|i| format!("{key}.columns[{i}]"), log);
        self.check_rows(&|i| format!("{key}.rows[{i}]"), log);
    }

    /// Each column is there once.
    fn check_columns(&self, key: &dyn Fn(usize) -> String, log: &mut Log) {
        let mut seen = HashSet::new();
        for (i, name) in self.columns.iter().enumerate().filter(|(_, name)| !seen.insert(name.as_str())) {
            log.error(at(&self.column_places, i), &key(i), Kind::Together, format!("the column {} twice", quote(name)), "each once");
        }
    }

    /// Each row has all its numbers, and they are in order.
    fn check_rows(&self, key: &dyn Fn(usize) -> String, log: &mut Log) {
        let width = self.columns.len() + 1;
        for (i, row) in self.rows.iter().enumerate().filter(|(_, row)| row.len() != width) {
            let expected = format!("{}: {ROW}", counted(width));
            log.error(at(&self.row_places, i), &key(i), Kind::Together, counted(row.len()), expected);
        }
        for i in 1..self.rows.len() {
            if let ([before, ..], [time, ..]) = (&self.rows[i - 1][..], &self.rows[i][..])
                && time <= before
            {
                log.error(
                    at(&self.row_places, i),
                    &key(i),
                    Kind::Together,
                    format!("the time {time:?} after {before:?}"),
                    "times in order",
                );
            }
        }
    }

    /// The table for a robot; columns that are not there are neutral. Without `read` a file is left alone.
    pub(crate) fn series(&self, model: &Model<f64>, side: Side, read: Option<&mut Reader<'_>>, log: &mut Log) -> Series {
        let Some(file) = &self.file else {
            let keys: [&Key; 2] = [&|i| format!("control.columns[{i}]"), &|i| format!("control.rows[{i}]")];
            return self.placed(model, side, keys, log);
        };
        let Some(read) = read else { return Series::default() };
        match read(file) {
            Ok(text) => self.parsed(file, &text, model, side, log),
            Err(reason) => {
                let found = format!("{}, which cannot be read ({reason})", quote(file));
                log.error(self.place, "control.file", Kind::UnknownName, found, "a CSV with a first line that names its columns");
                Series::default()
            }
        }
    }

    /// The table of a CSV. What is wrong with it is told of its own lines.
    fn parsed(&self, file: &str, text: &str, model: &Model<f64>, side: Side, log: &mut Log) -> Series {
        let folder = Path::new(log.file()).parent().unwrap_or(Path::new(""));
        let mut own = Log::new(&folder.join(file).display().to_string());
        let source = self.lines(file, text, &mut own);
        source.check_columns(&|_| String::new(), &mut own);
        source.check_rows(&|_| String::new(), &mut own);
        let series = if own.count() == 0 {
            source.placed(model, side, [&|_| String::new(); 2], &mut own)
        } else {
            source.places(model, side, &|_| String::new(), &mut own);
            Series::default()
        };
        log.take(own);
        series
    }

    /// The names and numbers of a CSV; rows that are wrong are told and left out.
    fn lines(&self, file: &str, text: &str, log: &mut Log) -> Self {
        let mut source = Self { file: Some(file.to_owned()), place: self.place, hold: self.hold, ..Self::default() };
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let line = |i: usize| At::Line(u32::try_from(i + 1).unwrap_or(u32::MAX));
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let Some((i, head)) = lines.next() else {
            log.error(At::Nowhere, "", Kind::Syntax, "nothing", "a first line that names the columns, t and joints");
            return source;
        };
        let mut names = head.split(',').map(|name| name.trim().trim_matches('"').to_owned());
        let first = names.next().unwrap_or_default();
        if !["t", "time"].contains(&first.as_str()) {
            log.error(line(i), "", Kind::Word, format!("{} as the first column", quote(&first)), "t");
        }
        source.columns = names.collect();
        source.column_places = vec![line(i); source.columns.len()];
        for (i, words) in lines.take(MOST) {
            if let Some(row) = source.row(words, line(i), log) {
                source.rows.push(row);
                source.row_places.push(line(i));
            }
        }
        if source.rows.is_empty() && log.count() == 0 {
            log.error(At::Nowhere, "", Kind::Syntax, "no rows", format!("lines of numbers: {ROW}"));
        }
        source
    }

    /// The numbers of a line of a CSV.
    fn row(&self, words: &str, at: At, log: &mut Log) -> Option<Vec<f64>> {
        let words: Vec<&str> = words.split(',').map(str::trim).collect();
        let width = self.columns.len() + 1;
        let before = log.count();
        if words.len() != width {
            log.error(at, "", Kind::Together, counted(words.len()), format!("{}: {ROW}", counted(width)));
        }
        let names = std::iter::once("t").chain(self.columns.iter().map(String::as_str));
        let mut row = Vec::with_capacity(width);
        for (name, word) in names.zip(words) {
            match word.parse::<f64>() {
                Ok(x) if x.is_finite() => row.push(x),
                _ => log.error(at, &bare(name), Kind::Number, quote(word), Range::ALL.to_string()),
            }
        }
        (log.count() == before).then_some(row)
    }

    /// Where the numbers of each column go.
    fn places(&self, model: &Model<f64>, side: Side, key: &Key, log: &mut Log) -> Vec<Option<usize>> {
        let column = |(i, name): (usize, &String)| place_of(name, model, side, (at(&self.column_places, i), &key(i)), log);
        self.columns.iter().enumerate().map(column).collect()
    }

    /// The columns in the places of their joints; `keys`: those of a column and of a row.
    fn placed(&self, model: &Model<f64>, side: Side, [column, key]: [&Key; 2], log: &mut Log) -> Series {
        let places = self.places(model, side, column, log);
        let neutral = if side == Side::Q { neutral(model) } else { vec![0.0; model.nv] };
        let row = |numbers: &Vec<f64>| {
            let mut row = neutral.clone();
            places.iter().zip(&numbers[1..]).for_each(|(place, x)| {
                if let Some(place) = place {
                    row[*place] = *x;
                }
            });
            row
        };
        let mut rows: Vec<Vec<f64>> = self.rows.iter().map(row).collect();
        if side == Side::Q && places.iter().all(Option::is_some) {
            let place = |i: usize| at(&self.row_places, i);
            rows.iter_mut().enumerate().for_each(|(i, row)| normalise(model, row, (&key(i), &|_| place(i)), log));
        }
        Series { times: self.rows.iter().map(|r| r[0]).collect(), rows, hold: self.hold }
    }
}

/// The place of `joint` or `joint[k]`.
fn place_of(name: &str, model: &Model<f64>, side: Side, (at, key): (At, &str), log: &mut Log) -> Option<usize> {
    let range = |joint: &str| model.joints.iter().find(|j| j.name == joint).map(|j| if side == Side::Q { j.q } else { j.v });
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
    let names = model.joints.iter().map(|j| j.name.as_str());
    let found = format!("the column {}", quote(name));
    log.unknown((at, key, Kind::UnknownName), (found, name), "a joint that moves, as elbow, or one of its numbers, as ball[0]", names);
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_linear_between_rows_or_held_and_hold_at_the_ends() {
        let series = |hold| Series { times: vec![0.0, 1.0, 3.0], rows: vec![vec![1.0], vec![3.0], vec![-1.0]], hold };
        let at = |hold, t| {
            let mut out = [f64::NAN];
            series(hold).at(t, &mut out);
            out[0]
        };
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0].map(|t| at(false, t)), [1.0, 1.0, 2.0, 3.0, 1.0, -1.0, -1.0]);
        assert_eq!([-1.0, 0.5, 1.0, 2.9, 3.0, 9.0].map(|t| at(true, t)), [1.0, 1.0, 3.0, 3.0, -1.0, -1.0]);
    }
}
