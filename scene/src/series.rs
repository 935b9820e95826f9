//! Tables over time: in a file of numbers between commas, or in the scene itself.

use std::collections::HashSet;

use articulated_core::model::Model;

use crate::control::unreadable;
use crate::error::{Kind, quote};
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
    /// Where the scene says so.
    pub place: At,
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

/// The first name that was there before.
fn twice(names: &[String]) -> Option<&String> {
    let mut seen = HashSet::new();
    names.iter().find(|name| !seen.insert(name.as_str()))
}

impl Source {
    /// What can be told of rows in the scene without the robot.
    pub(crate) fn check(&self, key: &str, log: &mut Log) {
        let width = self.columns.len() + 1;
        if let Some(name) = twice(&self.columns) {
            log.error(self.place, &format!("{key}.columns"), Kind::Together, format!("the column {} twice", quote(name)), "each once");
        }
        if self.rows.is_empty() {
            log.error(self.place, key, Kind::MissingKey, "columns without rows", "rows: the time and a number for each column");
        }
        if let Some((i, row)) = self.rows.iter().enumerate().find(|(_, row)| row.len() != width) {
            let expected = format!("{}: the time and one for each of the columns", counted(width));
            log.error(self.place, &format!("{key}.rows[{i}]"), Kind::Together, counted(row.len()), expected);
            return;
        }
        if let Some(i) = (1..self.rows.len()).find(|&i| self.rows[i][0] <= self.rows[i - 1][0]) {
            let found = format!("the time {:?} after {:?}", self.rows[i][0], self.rows[i - 1][0]);
            log.error(self.place, &format!("{key}.rows[{i}]"), Kind::Together, found, "times in order");
        }
    }

    /// The table for a robot; columns that are not there are neutral. Without `read` a file is left alone.
    pub(crate) fn series(&self, model: &Model<f64>, side: Side, read: Option<&mut Reader<'_>>, log: &mut Log) -> Series {
        let Some(file) = &self.file else { return self.placed(model, side, "control.columns", log) };
        let Some(read) = read else { return Series::default() };
        match read(file).and_then(|text| self.parsed(file, &text)) {
            Ok(source) => source.placed(model, side, "control.file", log),
            Err(reason) => {
                log.error(
                    self.place,
                    "control.file",
                    Kind::UnknownName,
                    unreadable(file, &reason),
                    "a CSV with a first line that names its columns",
                );
                Series::default()
            }
        }
    }

    /// The rows of a CSV.
    fn parsed(&self, file: &str, text: &str) -> Result<Self, String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let (_, head) = lines.next().ok_or("it is empty")?;
        let mut names = head.split(',').map(|name| name.trim().trim_matches('"').to_owned());
        let first = names.next().unwrap_or_default();
        if !["t", "time"].contains(&first.as_str()) {
            return Err(format!("line 1: found {} as the first column, expected t", quote(&first)));
        }
        let mut source = Self { file: Some(file.to_owned()), columns: names.collect(), rows: Vec::new(), ..self.clone() };
        if let Some(name) = twice(&source.columns) {
            return Err(format!("line 1: found the column {} twice, expected each once", quote(name)));
        }
        for (i, line) in lines.take(MOST) {
            let numbers = line.split(',').map(|word| word.trim().parse::<f64>().ok().filter(|x| x.is_finite()));
            let row: Option<Vec<f64>> = numbers.collect();
            let row = row.filter(|row| row.len() == source.columns.len() + 1);
            let row = row.ok_or_else(|| format!("line {}: expected {} finite numbers", i + 1, source.columns.len() + 1))?;
            if source.rows.last().is_some_and(|last| row[0] <= last[0]) {
                return Err(format!("line {}: found the time {:?}, expected one after that before it", i + 1, row[0]));
            }
            source.rows.push(row);
        }
        if source.rows.is_empty() { Err("it has no rows".into()) } else { Ok(source) }
    }

    /// The columns in the places of their joints.
    fn placed(&self, model: &Model<f64>, side: Side, key: &str, log: &mut Log) -> Series {
        let places: Vec<Option<usize>> = self.columns.iter().map(|name| self.place_of(name, model, side, key, log)).collect();
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
            let key = |i: usize| if self.file.is_some() { format!("{key}, row {i}") } else { format!("control.rows[{i}]") };
            rows.iter_mut().enumerate().for_each(|(i, row)| normalise(model, row, (&key(i), &|_| self.place), log));
        }
        Series { times: self.rows.iter().map(|r| r[0]).collect(), rows, hold: self.hold }
    }

    /// The place of `joint` or `joint[k]`.
    fn place_of(&self, name: &str, model: &Model<f64>, side: Side, key: &str, log: &mut Log) -> Option<usize> {
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
        log.unknown(
            (self.place, key, Kind::UnknownName),
            (found, name),
            "a joint that moves, as elbow, or one of its numbers, as ball[0]",
            names,
        );
        None
    }
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

    #[test]
    fn a_column_stands_once() {
        let parsed = |text: &str| Source::default().parsed("t.csv", text).map(|source| source.columns);
        assert_eq!(parsed("t,a,\"a\"\n0,1,2\n"), Err("line 1: found the column \"a\" twice, expected each once".into()));
        assert_eq!(parsed("t,a,b\n0,1,2\n"), Ok(vec!["a".into(), "b".into()]));
        assert_eq!(parsed("\u{feff}t,a\n0,1\n"), Ok(vec!["a".into()]), "a byte order mark, as spreadsheets write it");
    }
}
