//! Tables over time: in a file of numbers between commas, or in the scene itself.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use articulated_core::control::Series;
use articulated_core::effect::Range;
use articulated_core::model::{JointInfo, Model};

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

/// Gives the text of a file by its name in the scene, or says why not.
pub type Reader<'a> = dyn FnMut(&str) -> Result<String, String> + 'a;

/// More rows no table has.
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
    /// What can be told of rows in the scene without the robot, of the keys that are `right` by themselves.
    pub(crate) fn check(&self, key: &str, right: &[&str], log: &mut Log) {
        let [columns, rows] = ["columns", "rows"].map(|name| right.contains(&name));
        let missing = match (columns && self.columns.is_empty(), rows && self.rows.is_empty()) {
            (_, true) => Some((self.place, "columns without rows", "rows: the time and a number for each column")),
            (true, false) => Some((at(&self.row_places, 0), "rows without columns", "columns: the names of the numbers after the time")),
            _ => None,
        };
        if let Some((at, found, expected)) = missing {
            log.error(at, key, Kind::MissingKey, found, expected);
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

    /// Each column is there once, by its name; other names of one place only the robot shows, see [`Source::places`].
    fn check_columns(&self, key: &dyn Fn(usize) -> String, log: &mut Log) {
        let mut seen = HashSet::new();
        for (i, name) in self.columns.iter().enumerate().filter(|(_, name)| !seen.insert(name.as_str())) {
            log.error(at(&self.column_places, i), &key(i), Kind::Together, format!("the column {} twice", quote(name)), "each once");
        }
    }

    /// Each row has all its numbers.
    fn check_widths(&self, key: &dyn Fn(usize) -> String, log: &mut Log) {
        let width = self.columns.len() + 1;
        for (i, row) in self.rows.iter().enumerate().filter(|(_, row)| row.len() != width) {
            let expected = format!("{}: {ROW}", counted(width));
            log.error(at(&self.row_places, i), &key(i), Kind::Together, counted(row.len()), expected);
        }
    }

    /// Rows are in order.
    fn check_order(&self, key: &dyn Fn(usize) -> String, log: &mut Log) {
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
        let source = self.lines(file, text, (model, side), &mut own);
        source.check_columns(&|_| String::new(), &mut own);
        source.check_widths(&|_| String::new(), &mut own);
        source.check_order(&|_| String::new(), &mut own);
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
    fn lines(&self, file: &str, text: &str, robot: (&Model<f64>, Side), log: &mut Log) -> Self {
        let mut source = Self { file: Some(file.to_owned()), place: self.place, hold: self.hold, ..Self::default() };
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let line = |i: usize| At::Line(u32::try_from(i + 1).unwrap_or(u32::MAX));
        let mut lines = text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()).map(|(i, text)| (line(i), text));
        let Some(head) = lines.next() else {
            log.error(At::Nowhere, "", Kind::Syntax, "nothing", "a first line that names the columns, t and joints");
            return source;
        };
        source.head(head, robot, log);
        source.body(lines, MOST, log);
        if source.rows.is_empty() && log.count() == 0 {
            log.error(At::Nowhere, "", Kind::Syntax, "no rows", format!("lines of numbers: {ROW}"));
        }
        source
    }

    /// The names of the columns.
    fn head(&mut self, (at, text): (At, &str), (model, side): (&Model<f64>, Side), log: &mut Log) {
        let mut names = fields(text).into_iter();
        let first = names.next().unwrap_or_default();
        if !["t", "time"].contains(&first.as_str()) {
            log.error(at, "", Kind::Word, format!("{} as the first column", quote(&first)), "t");
        }
        self.columns = names.collect();
        self.column_places = vec![at; self.columns.len()];
        if self.columns.is_empty() {
            let expected = format!("columns of joints that move after t: {}", listed(model, side));
            log.error(at, "", Kind::MissingKey, "a single column", expected);
        }
    }

    /// The numbers of the lines after that, `most` at most.
    fn body<'t>(&mut self, lines: impl Iterator<Item = (At, &'t str)>, most: usize, log: &mut Log) {
        for (count, (at, text)) in lines.enumerate() {
            if count == most {
                log.error(at, "", Kind::Number, format!("row {}", count + 1), format!("at most {most} rows"));
                return;
            }
            if let Some(row) = self.row(text, at, log) {
                self.rows.push(row);
                self.row_places.push(at);
            }
        }
    }

    /// The numbers of a line of a CSV.
    fn row(&self, text: &str, at: At, log: &mut Log) -> Option<Vec<f64>> {
        let words = fields(text);
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
                _ => log.error(at, &bare(name), Kind::Number, quote(&word), Range::ALL.to_string()),
            }
        }
        (log.count() == before).then_some(row)
    }

    /// Where the numbers of each column go: each to a place of its own.
    fn places(&self, model: &Model<f64>, side: Side, key: &Key, log: &mut Log) -> Vec<Option<usize>> {
        let column = |(i, name): (usize, &String)| place_of(name, model, side, (at(&self.column_places, i), &key(i)), log);
        let places: Vec<Option<usize>> = self.columns.iter().enumerate().map(column).collect();
        self.check_places(&places, key, log);
        places
    }

    /// No two columns go to one place under two names, as `elbow` and `elbow[0]`.
    fn check_places(&self, places: &[Option<usize>], key: &Key, log: &mut Log) {
        let (mut names, mut taken) = (HashSet::new(), HashMap::new());
        for (i, (name, place)) in self.columns.iter().zip(places).enumerate() {
            // A name that is there twice is told by `check_columns`.
            let (Some(place), true) = (place, names.insert(name)) else { continue };
            if let Some(before) = taken.insert(place, name) {
                let found = format!("the column {}, which is {} again", quote(name), quote(before));
                log.error(at(&self.column_places, i), &key(i), Kind::Together, found, "each once");
            }
        }
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

/// What stands between the commas of a line, without the blanks around it; in quotation marks there may be commas too, and two marks are one (RFC 4180).
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut rest) = (Vec::new(), Some(line));
    while let Some(text) = rest {
        let (field, after) = quoted(text).unwrap_or_else(|| up_to_comma(text));
        fields.push(field);
        rest = after;
    }
    fields
}

/// A field, and what is behind its comma, if there is one.
type Field<'a> = (String, Option<&'a str>);

fn up_to_comma(text: &str) -> Field<'_> {
    let (field, rest) = text.split_once(',').map_or((text, None), |(field, rest)| (field, Some(rest)));
    (field.trim().to_owned(), rest)
}

/// A field that begins with a mark, if another one ends it.
fn quoted(text: &str) -> Option<Field<'_>> {
    let (mut field, mut rest) = (String::new(), text.trim_start().strip_prefix('"')?);
    loop {
        let (inside, after) = rest.split_once('"')?;
        field += inside;
        let Some(more) = after.strip_prefix('"') else {
            let (tail, rest) = up_to_comma(after);
            return Some(((field + &tail).trim().to_owned(), rest));
        };
        field.push('"');
        rest = more;
    }
}

/// The columns that a robot has.
fn listed(model: &Model<f64>, side: Side) -> String {
    let count = |j: &JointInfo| if side == Side::Q { j.q.1 } else { j.v.1 };
    let name = |j: &JointInfo| match count(j) {
        1 => j.name.clone(),
        n => format!("{0}[0] to {0}[{1}]", j.name, n - 1),
    };
    articulated_core::listed(model.joints.iter().map(name))
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
    fn rows_beyond_the_most_are_told_and_not_read() {
        let lines = |n: usize| (0..n).map(|i| (At::Line(i as u32 + 2), ["0,1", "1,2", "2,3", "rubbish"][i]));
        let body = |n: usize| {
            let (mut source, mut log) = (Source { columns: vec!["elbow".into()], ..Source::default() }, Log::new("t.csv"));
            source.body(lines(n), 2, &mut log);
            (source.rows.len(), log.result(()).err().map(|e| e.to_string()))
        };
        assert_eq!(body(2), (2, None));
        let told = Some("t.csv:4: found row 3, expected at most 2 rows".to_owned());
        assert_eq!((body(3), body(4)), ((2, told.clone()), (2, told)));
    }

    #[test]
    fn numbers_of_a_table_in_a_file_are_the_nearest_doubles() {
        let (mut bits, mut log) = (0x9e37_79b9_7f4a_7c15_u64, Log::new("t.csv"));
        let source = Source { columns: vec!["elbow".into()], ..Source::default() };
        let doubles = std::iter::repeat_with(|| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        });
        for x in doubles.filter(|x| x.is_finite()).take(100_000) {
            let row = source.row(&format!("{x:?},{x:.16e}"), At::Line(1), &mut log).unwrap();
            assert_eq!([row[0].to_bits(), row[1].to_bits()], [x.to_bits(); 2], "{x:e}");
        }
    }

    #[test]
    fn a_long_list_of_columns_is_cut() {
        let link = |i: usize| {
            let kind = if i == 0 { "spherical" } else { "continuous" };
            format!("<link name='l{i}'/><joint name='j{i}' type='{kind}'><parent link='base'/><child link='l{i}'/></joint>")
        };
        let urdf = format!("<robot name='r'><link name='base'/>{}</robot>", (0..14).map(link).collect::<String>());
        let description = articulated_urdf::read(urdf.as_bytes(), &Default::default()).unwrap().description;
        let model = Model::new(&description, articulated_core::description::Base::Fixed).unwrap();
        assert_eq!(listed(&model, Side::Q), "j0[0] to j0[3], j1, j2, j3, j4, j5, j6, j7, j8, j9, j10, j11 and 2 more");
        assert!(listed(&model, Side::V).starts_with("j0[0] to j0[2], j1"));
    }

    #[test]
    fn fields_in_quotation_marks_may_have_commas_and_marks() {
        assert_eq!(fields("t, elbow ,\"a,b \"\"q\"\"\", \"wrist\""), ["t", "elbow", "a,b \"q\"", "wrist"]);
        assert_eq!(
            (fields(""), fields("1,"), fields("\"\",2")),
            (vec![String::new()], vec!["1".into(), String::new()], vec![String::new(), "2".into()])
        );
        assert_eq!(
            (fields("\"open,2"), fields("a\"b,\"c\"d")),
            (vec!["\"open".to_owned(), "2".into()], vec!["a\"b".to_owned(), "cd".into()])
        );
    }
}
