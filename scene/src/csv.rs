//! A table over time in a CSV, read line by line: only the used numbers are kept in memory.

use crate::table::bare;
use articulated_core::diagnostic::{At, Code, Diagnostics, quote_number};
use std::io::{BufRead, Read};

use articulated_core::control::Series;
use articulated_core::effect::Range;

use crate::initial::counted;
use crate::series::{Places, ROW, Source};
use crate::slots::Slots;

/// Upper bounds of a table.
#[derive(Clone, Copy)]
struct Most {
    /// Lines with numbers.
    rows: usize,
    /// Numbers of all rows together, with the robot's row length: 2 GiB.
    numbers: usize,
    /// Bytes of a line, without its end.
    line: u64,
    /// Lines, empty ones too.
    lines: u32,
    /// Reported errors; after these, reading stops.
    wrong: usize,
}

const MOST: Most = Most { rows: 10_000_000, numbers: 1 << 28, line: 1 << 20, lines: 20_000_000, wrong: 100 };

/// The table of a CSV for a robot; missing columns are neutral. Errors are reported at their lines
/// and quote only the wrong number or name; the table is then empty.
pub(crate) fn read(from: Box<dyn BufRead>, slots: &Slots<'_>, log: &mut Diagnostics) -> Series {
    read_at_most(MOST, from, slots, log)
}

fn read_at_most(most: Most, from: Box<dyn BufRead>, slots: &Slots<'_>, log: &mut Diagnostics) -> Series {
    let mut lines = Lines { from, count: 0, most };
    let Some((at, head)) = lines.next(log) else {
        if log.count() == 0 {
            log.error((At::Nowhere, ""), Code::Syntax, "nothing", format!("a first line that names the columns, t and {}", slots.kind()));
        }
        return Series::default();
    };
    let Some(columns) = columns(&head, at, slots, log) else { return Series::default() };
    let source = Source { column_places: vec![at; columns.len()], columns, ..Source::default() };
    source.check_columns(&|_| String::new(), log);
    let places = source.places(slots, &|_| String::new(), log);
    let mut table = Table { columns: &source.columns, places: &places, slots, series: Series::default(), last: None };
    table.fill(&mut lines, most, log);
    if table.last.is_none() && log.count() == 0 {
        log.error((At::Nowhere, ""), Code::Syntax, "no rows", format!("lines of numbers: {ROW}"));
    }
    if log.count() == 0 { table.series } else { Series::default() }
}

/// The names of the columns after the time; `None` if the line is not a table's header.
fn columns(text: &str, at: At, slots: &Slots<'_>, log: &mut Diagnostics) -> Option<Vec<String>> {
    let mut names = fields(text).into_iter();
    let first = names.next().unwrap_or_default();
    if !["t", "time"].contains(&first.as_str()) {
        log.error((at, ""), Code::Word, format!("{} as the first column", quote_number(&first)), "t");
        return None;
    }
    let columns: Vec<String> = names.collect();
    if columns.is_empty() {
        let expected = format!("columns of {}", slots.listed());
        log.error((at, ""), Code::MissingKey, "a single column", expected);
        return None;
    }
    Some(columns)
}

/// Rows as they are read.
struct Table<'a> {
    columns: &'a [String],
    places: &'a Places,
    slots: &'a Slots<'a>,
    series: Series,
    /// Time of the last row, s.
    last: Option<f64>,
}

impl Table<'_> {
    /// Reads lines up to the end, to a bound of the table, or to the maximum number of errors.
    fn fill(&mut self, lines: &mut Lines, most: Most, log: &mut Diagnostics) {
        let neutral = &self.slots.neutral;
        let rows = most.rows.min(most.numbers / neutral.len().max(1));
        let mut count = 0;
        while let Some((at, text)) = lines.next(log) {
            count += 1;
            if count > rows {
                return log.error((at, ""), Code::Number, format!("row {count}"), format!("at most {rows} rows"));
            }
            if log.count() >= most.wrong {
                let found = format!("{} mistakes above; from here on nothing is read", log.count());
                return log.error((at, ""), Code::Syntax, found, "");
            }
            let Some(numbers) = self.row(&text, at, log) else { continue };
            self.in_order(numbers[0], at, log);
            let mut row = neutral.clone();
            self.places.put(&numbers[1..], &mut row);
            if self.places.are_all() {
                self.slots.normalise(&mut row, ("", &|_| at), log);
            }
            // A table with errors is not used.
            if log.count() == 0 {
                self.series.times.push(numbers[0]);
                self.series.rows.push(row);
            }
        }
    }

    fn in_order(&mut self, time: f64, at: At, log: &mut Diagnostics) {
        if let Some(before) = self.last.filter(|before| time <= *before) {
            log.error((at, ""), Code::Together, format!("the time {time:?} after {before:?}"), "times in order");
        }
        self.last = Some(time);
    }

    /// The numbers of a line; `None` if one of them is invalid.
    fn row(&self, text: &str, at: At, log: &mut Diagnostics) -> Option<Vec<f64>> {
        let words = fields(text);
        let width = self.columns.len() + 1;
        if words.len() != width {
            log.error((at, ""), Code::Together, counted(words.len()), format!("{}: {ROW}", counted(width)));
            return None;
        }
        let before = log.count();
        let names = std::iter::once("t").chain(self.columns.iter().map(String::as_str));
        let mut row = Vec::with_capacity(width);
        for (name, word) in names.zip(words) {
            match word.parse::<f64>() {
                Ok(x) if x.is_finite() => row.push(x),
                _ => log.error((at, &bare(name)), Code::Number, quote_number(&word), Range::ALL.to_string()),
            }
        }
        (log.count() == before).then_some(row)
    }
}

/// The non-empty lines of a text.
struct Lines {
    from: Box<dyn BufRead>,
    count: u32,
    most: Most,
}

impl Lines {
    /// The next line; `None` at the end and after a line that is not text or too long, which is
    /// reported.
    fn next(&mut self, log: &mut Diagnostics) -> Option<(At, String)> {
        loop {
            self.count += 1;
            let (at, most) = (At::line_of(self.count), self.most);
            let mut wrong = |kind, found: String, expected: String| {
                log.error((at, ""), kind, found, expected);
                None
            };
            let mut line = Vec::new();
            match self.from.by_ref().take(most.line + 1).read_until(b'\n', &mut line) {
                Ok(0) => return None,
                Ok(_) if self.count > most.lines => {
                    return wrong(Code::Syntax, "one line more".into(), format!("at most {} lines", most.lines));
                }
                Ok(length) if length as u64 > most.line && !line.ends_with(b"\n") => {
                    let expected = format!("a line of a CSV, of at most {} bytes", most.line);
                    return wrong(Code::Syntax, format!("more than {} bytes without an end of line", most.line), expected);
                }
                Ok(_) => {}
                Err(error) => return wrong(Code::Syntax, format!("what cannot be read ({error})"), "a line of a CSV".into()),
            }
            let Ok(text) = String::from_utf8(line) else {
                return wrong(Code::Syntax, "bytes that are not UTF-8".into(), "a CSV".into());
            };
            // Spreadsheets write a byte order mark.
            let text = match text.strip_prefix('\u{feff}') {
                Some(rest) if self.count == 1 => rest.to_owned(),
                _ => text,
            };
            if !text.trim().is_empty() {
                return Some((at, text));
            }
        }
    }
}

/// The fields between the commas of a line, trimmed. Quoted fields may contain commas, and two
/// quotation marks are one (RFC 4180).
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut rest) = (Vec::new(), Some(line));
    while let Some(text) = rest {
        let (field, after) = quoted(text).unwrap_or_else(|| up_to_comma(text));
        fields.push(field);
        rest = after;
    }
    fields
}

/// A field and the text after its comma, if there is one.
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

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Error};

    use articulated_core::description::Base;
    use articulated_core::model::Model;

    use super::*;
    use crate::slots::Side;

    const ARM: &str = "<robot name='r'><link name='base'/><link name='l'/>
        <joint name='elbow' type='continuous'><parent link='base'/><child link='l'/></joint></robot>";

    fn arm() -> Model<f64> {
        let description = articulated_formats::read(ARM.as_bytes(), &Default::default()).unwrap().description;
        Model::new(&description, Base::Fixed).unwrap()
    }

    /// Reads within bounds: the table, or all reported errors.
    fn read_within(most: Most, from: impl BufRead + 'static) -> Result<Series, String> {
        let mut log = Diagnostics::new("t.csv");
        let series = read_at_most(most, Box::new(from), &Slots::of_joints(&arm(), Side::V), &mut log);
        log.result(series).map_err(|e| e.to_string())
    }

    fn of_text(most: Most, text: &str) -> Result<Series, String> {
        read_within(most, Cursor::new(text.to_owned()))
    }

    #[test]
    fn what_goes_beyond_the_most_is_told_and_not_read() {
        let table = |rows: usize| "t,elbow\n".to_owned() + &["0,1\n", "1,2\n", "2,3\n", "rubbish\n"][..rows].concat();
        let few = Most { rows: 2, ..MOST };
        assert_eq!(of_text(few, &table(2)).unwrap().times, [0.0, 1.0]);
        let told = Err("t.csv:4: found row 3, expected at most 2 rows".to_owned());
        assert_eq!((of_text(few, &table(3)), of_text(few, &table(4))), (told.clone(), told));
        // This robot has one number per row.
        let told = Err("t.csv:3: found row 2, expected at most 1 rows".to_owned());
        assert_eq!(of_text(Most { numbers: 1, ..MOST }, &table(3)), told);
        let told = Err("t.csv:4: found one line more, expected at most 3 lines".to_owned());
        assert_eq!(of_text(Most { lines: 3, ..MOST }, "t,elbow\n\n\n\n\n"), told);
    }

    /// A device, a hole in a file: zeros without an end of line.
    #[test]
    fn what_has_no_lines_is_refused_after_one_of_them() {
        let told = read_within(MOST, std::io::BufReader::new(std::io::repeat(0))).unwrap_err();
        let expected = "t.csv:1: found more than 1048576 bytes without an end of line, expected a line of a CSV, of at most 1048576 bytes";
        assert_eq!(told, expected);
        let told = of_text(Most { line: 9, ..MOST }, "t,elbow\n0,1\n1,20000000").unwrap_err();
        assert_eq!(told, "t.csv:3: found more than 9 bytes without an end of line, expected a line of a CSV, of at most 9 bytes");
        for (end, is_ok) in [("1234567\n", true), ("1234567", true), ("12345678\n", false), ("12345678", false)] {
            assert_eq!(of_text(Most { line: 9, ..MOST }, &format!("t,elbow\n0,{end}")).is_ok(), is_ok, "{end:?}");
        }
    }

    /// Endless garbage is not read to its end.
    #[test]
    fn after_many_mistakes_the_rest_is_left_alone() {
        struct Endless(u64);
        impl Read for Endless {
            fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
                self.0 += out.len() as u64;
                assert!(self.0 < 1 << 20, "reads on");
                out.fill(b'x');
                out.iter_mut().step_by(8).for_each(|byte| *byte = b'\n');
                Ok(out.len())
            }
        }
        let told = read_within(MOST, std::io::BufReader::new(Cursor::new("t,elbow\n").chain(Endless(0)))).unwrap_err();
        assert_eq!(told.lines().count(), 101, "{told}");
        assert!(told.ends_with("found 100 mistakes above; from here on nothing is read"), "{told}");
    }

    #[test]
    fn no_more_of_a_file_is_told_than_the_number_that_is_wrong() {
        let secret = "root:x:0:0:the administrator of this machine:/root:/bin/sh";
        let told = of_text(MOST, &format!("{secret}\n{secret}\n")).unwrap_err();
        assert_eq!(told, "t.csv:1: found \"root:x:0:0:the administr…\" as the first column, expected t");
        let told = of_text(MOST, &format!("t,elbow\n{secret}\n0,\u{1b}[2J\u{202e}{secret}\n")).unwrap_err();
        let expected = "t.csv:2: found one number, expected 2 numbers: the time and one for each of the columns
t.csv:3: elbow: found \"\\u{1b}[2J\\u{202e}root:x:0:0:the admi…\", expected a finite number";
        assert_eq!(told, expected);
    }

    #[test]
    fn a_file_that_cannot_be_read_on_is_told_with_the_line() {
        struct Broken;
        impl Read for Broken {
            fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
                Err(Error::other("the disk is gone"))
            }
        }
        let told = read_within(MOST, std::io::BufReader::new(Cursor::new("t,elbow\n0,1\n").chain(Broken))).unwrap_err();
        assert_eq!(told, "t.csv:3: found what cannot be read (the disk is gone), expected a line of a CSV");
        let told = read_within(MOST, Cursor::new(b"t,elbow\n0,\xff\n".to_vec())).unwrap_err();
        assert_eq!(told, "t.csv:2: found bytes that are not UTF-8, expected a CSV");
    }

    #[test]
    fn numbers_of_a_table_in_a_file_are_the_nearest_doubles() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let doubles = std::iter::repeat_with(|| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        });
        let doubles: Vec<f64> = doubles.filter(|x| x.is_finite()).take(100_000).collect();
        let rows = doubles.iter().enumerate().map(|(k, x)| if k % 2 == 0 { format!("{k},{x:?}\n") } else { format!("{k},{x:.16e}\n") });
        let series = of_text(MOST, &("t,elbow\n".to_owned() + &rows.collect::<String>())).unwrap();
        assert_eq!(series.rows.len(), doubles.len());
        series.rows.iter().zip(&doubles).for_each(|(row, x)| assert_eq!(row[0].to_bits(), x.to_bits(), "{x:e}"));
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
