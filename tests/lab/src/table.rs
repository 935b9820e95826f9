//! Tables that line up.

/// A table with titles and units over its columns; the first column is text, the others are
/// numbers.
#[derive(Clone, Debug, Default)]
pub struct Table {
    head: [Vec<String>; 2],
    rows: Vec<Vec<String>>,
    left: usize,
    /// Maximum columns of the first cell of a row before the others.
    first: Option<usize>,
}

impl Table {
    /// Columns as (title, unit).
    pub fn new<T: Into<String>, U: Into<String>>(columns: impl IntoIterator<Item = (T, U)>) -> Self {
        let (titles, units) = columns.into_iter().map(|(t, u)| (plain(&t.into()), plain(&u.into()))).unzip();
        Self { head: [titles, units], rows: Vec::new(), left: 1, first: None }
    }

    /// The first `n` columns are text.
    pub fn left(mut self, n: usize) -> Self {
        self.left = n;
        self
    }

    /// A first cell of more columns than this is on a line of its own.
    pub fn first_within(mut self, columns: usize) -> Self {
        self.first = Some(columns);
        self
    }

    /// Appends a row.
    pub fn row<T: Into<String>>(&mut self, cells: impl IntoIterator<Item = T>) {
        let mut cells: Vec<String> = cells.into_iter().map(|c| plain(&c.into())).collect();
        if let Some(first) = cells.first_mut().filter(|c| self.first.is_some_and(|most| columns(c) > most)) {
            self.rows.push(vec![std::mem::take(first)]);
        }
        self.rows.push(cells);
    }

    /// Appends a line of text across all columns.
    pub fn heading(&mut self, text: &str) {
        self.rows.push(vec![plain(text)]);
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// As lines.
    pub fn text(&self) -> String {
        let units = self.head[1].iter().any(|u| !u.is_empty());
        let head = self.head.iter().take(if units { 2 } else { 1 });
        let lines: Vec<&Vec<String>> = head.chain(&self.rows).collect();
        // Headings are as wide as they are.
        let cells = || lines.iter().filter(|l| l.len() > 1 || self.head[0].len() == 1);
        let width = |k: usize| cells().filter_map(|l| l.get(k)).map(|c| columns(c)).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.head[0].len()).map(width).collect();
        lines.iter().fold(String::new(), |text, line| text + self.line(line, &widths).trim_end() + "\n")
    }

    fn line(&self, cells: &[String], widths: &[usize]) -> String {
        let cell = |(k, (text, width)): (usize, (&String, &usize))| {
            let fill = " ".repeat(width.saturating_sub(columns(text)));
            if k < self.left { format!("{text}{fill}") } else { format!("{fill}{text}") }
        };
        cells.iter().zip(widths).enumerate().map(cell).collect::<Vec<_>>().join("  ")
    }
}

/// The number of terminal columns of a text: marks on the letter before take none, wide letters of
/// East Asia and pictures two (Unicode Standard Annex 11, its large blocks).
fn columns(text: &str) -> usize {
    let one = |c: char| match c {
        '\u{300}'..='\u{36f}' => 0,
        '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}' | '\u{f900}'..='\u{faff}' => 2,
        '\u{fe30}'..='\u{fe4f}' | '\u{ff00}'..='\u{ff60}' | '\u{ffe0}'..='\u{ffe6}' => 2,
        '\u{1f300}'..='\u{1faff}' | '\u{20000}'..='\u{3fffd}' => 2,
        _ => 1,
    };
    text.chars().map(one).sum()
}

/// How many columns prose takes.
pub const WIDTH: usize = 100;

/// Prose in lines of at most [`WIDTH`] columns, as far as its spaces allow; continuation lines are
/// aligned with its beginning.
pub fn wrapped(text: &str) -> String {
    text.split_inclusive('\n').map(wrapped_line).collect()
}

fn wrapped_line(line: &str) -> String {
    let text = line.trim_start_matches(' ');
    let indent = &line[..line.len() - text.len()];
    let (mut out, mut at) = (indent.to_owned(), indent.len());
    for (k, word) in text.split(' ').enumerate() {
        let wide = columns(word.trim_end_matches('\n'));
        if k > 0 && at + 1 + wide > WIDTH {
            out = out.trim_end_matches(' ').to_owned() + "\n" + indent;
            at = indent.len();
        } else if k > 0 {
            out.push(' ');
            at += 1;
        }
        out += word;
        at += wide;
    }
    out
}

/// A count with its noun: `1 joint`, `2 joints`.
pub fn counted(n: usize, thing: &str) -> String {
    format!("{n} {thing}{}", if n == 1 { "" } else { "s" })
}

/// A count of degrees of freedom.
pub fn freedom(n: usize) -> String {
    counted(n, "degree") + " of freedom"
}

/// Whether a terminal interprets a character instead of showing it: it ends a line, moves the
/// cursor, or turns the direction of the following text.
pub fn is_obeyed(c: char) -> bool {
    c.is_control() || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Text on one line, whatever a name contains: control characters are escaped.
pub fn plain(text: &str) -> String {
    escaped(text, is_obeyed)
}

/// The text with these characters escaped.
pub fn escaped(text: &str, these: impl Fn(char) -> bool) -> String {
    if !text.contains(&these) {
        return text.to_owned();
    }
    text.chars().fold(String::with_capacity(text.len()), |mut out, c| {
        if these(c) {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
        out
    })
}

/// A number in at most six digits.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if !x.is_finite() {
        if x.is_nan() {
            "not a number".into()
        } else if x > 0.0 {
            "∞".into()
        } else {
            "-∞".into()
        }
    } else if (1e-4..1e6).contains(&size) {
        let places = (5.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
        let text = format!("{x:.places$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{x:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_under_each_other() {
        let mut table = Table::new([("name", ""), ("mass", "kg")]);
        table.row(["a", "1.5"]);
        table.row(["локоть", "10"]);
        table.row(["new\nline", "1"]);
        assert_eq!(plain("a\u{202e}b\u{9b}\tc"), "a\\u{202e}b\\u{9b}\\tc");
        assert_eq!(table.text(), "name       mass\n             kg\na           1.5\nлокоть       10\nnew\\nline     1\n");
    }

    #[test]
    fn headings_and_marks_move_nothing() {
        let mut table = Table::new([("", ""), ("n", "")]);
        table.heading("a heading that is longer than the table");
        table.row(["q̈", "1"]);
        assert_eq!(table.text(), "   n\na heading that is longer than the table\nq̈  1\n");
        table.row(["手", "2"]);
        assert_eq!(table.text(), "    n\na heading that is longer than the table\nq̈   1\n手  2\n");
    }

    #[test]
    fn a_long_first_cell_stands_on_a_line_of_its_own() {
        let mut table = Table::new([("case", ""), ("n", "")]).first_within(5);
        table.row(["short", "1"]);
        table.row(["longer than that", "2"]);
        assert_eq!(table.text(), "case   n\nshort  1\nlonger than that\n       2\n");
    }

    #[test]
    fn prose_is_wrapped_and_loses_nothing() {
        let text = format!("  {}\nshort\n\n{}\n", "q̈ word ".repeat(30).trim_end(), "x".repeat(120));
        let lines = wrapped(&text);
        assert!(lines.lines().filter(|l| l.contains(' ')).all(|l| columns(l) <= WIDTH && l.trim_end() == l), "{lines}");
        assert!(lines.lines().take(3).all(|l| l.starts_with("  q̈") || l.starts_with("  word")), "{lines}");
        assert!(lines.lines().next().is_some_and(|l| columns(l) > WIDTH - 5), "{lines}");
        assert!(text.split_whitespace().eq(lines.split_whitespace()) && lines.ends_with("x\n") && lines.contains("\nshort\n\nx"));
        assert_eq!(wrapped("no end"), "no end");
    }

    #[test]
    fn one_is_singular() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "joint")), ["0 joints", "1 joint", "2 joints"]);
        assert_eq!([1, 6].map(freedom), ["1 degree of freedom", "6 degrees of freedom"]);
    }

    #[test]
    fn numbers_keep_six_digits() {
        let cases =
            [(0.0, "0"), (1.5, "1.5"), (123_456.7, "123457"), (0.001_234_567, "0.00123457"), (-1e-9, "-1.000e-9"), (f64::INFINITY, "∞")];
        cases.iter().for_each(|(x, text)| assert_eq!(number(*x), *text));
    }
}
