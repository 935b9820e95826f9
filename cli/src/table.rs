//! Tables that line up.

/// A table with titles and units over its columns; the first column is text, the others are numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    head: [Vec<String>; 2],
    rows: Vec<Vec<String>>,
    left: usize,
}

impl Table {
    /// Columns as (title, unit).
    pub(crate) fn new<T: Into<String>, U: Into<String>>(columns: impl IntoIterator<Item = (T, U)>) -> Self {
        let (titles, units) = columns.into_iter().map(|(t, u)| (t.into(), u.into())).unzip();
        Self { head: [titles, units], rows: Vec::new(), left: 1 }
    }

    /// The first `n` columns are text.
    pub(crate) fn left(mut self, n: usize) -> Self {
        self.left = n;
        self
    }

    /// Appends a row.
    pub(crate) fn row<T: Into<String>>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.rows.push(cells.into_iter().map(|c| plain(&c.into())).collect());
    }

    /// Appends a line of text across all columns.
    pub(crate) fn heading(&mut self, text: &str) {
        self.rows.push(vec![plain(text)]);
    }

    /// Whether there are no rows.
    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// As lines.
    pub(crate) fn text(&self) -> String {
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

/// How many columns of a terminal a text takes: marks on the letter before take none.
fn columns(text: &str) -> usize {
    text.chars().filter(|c| !('\u{300}'..='\u{36f}').contains(c)).count()
}

/// Text on one line, whatever a name contains.
pub(crate) fn plain(text: &str) -> String {
    if !text.contains(char::is_control) {
        return text.to_owned();
    }
    text.chars().flat_map(|c| if c.is_control() { c.escape_default().collect::<Vec<_>>() } else { vec![c] }).collect()
}

/// A number in at most six digits.
pub(crate) fn number(x: f64) -> String {
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
        assert_eq!(table.text(), "name       mass\n             kg\na           1.5\nлокоть       10\nnew\\nline     1\n");
    }

    #[test]
    fn headings_and_marks_move_nothing() {
        let mut table = Table::new([("", ""), ("n", "")]);
        table.heading("a heading that is longer than the table");
        table.row(["q̈", "1"]);
        assert_eq!(table.text(), "   n\na heading that is longer than the table\nq̈  1\n");
    }

    #[test]
    fn numbers_keep_six_digits() {
        let cases =
            [(0.0, "0"), (1.5, "1.5"), (123_456.7, "123457"), (0.001_234_567, "0.00123457"), (-1e-9, "-1.000e-9"), (f64::INFINITY, "∞")];
        cases.iter().for_each(|(x, text)| assert_eq!(number(*x), *text));
    }
}
