//! Plots in SVG: lines, dots and texts on a plane, and linear and logarithmic axes with their
//! ticks.
//!
//! Lengths are in points; x leads to the right, y down.

use std::fmt::Write;

use crate::table::plain;

/// x to the right, y down.
pub type Point = [f64; 2];

/// Lengths of dashes and gaps along a line.
pub type Dash = [f64; 2];

/// Colours of texts, of numbers at axes, and of the lines of a grid.
pub const INK: &str = "#222222";
/// Of numbers at axes, and of notes.
pub const GREY: &str = "#555555";
/// Colour of the lines of a grid.
pub const GRID: &str = "#dddddd";

/// The size of letters at axes and marks.
pub const SMALL: f64 = 11.0;

const FAMILY: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

/// The side of a text that is at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// A text on its base line.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    at: Point,
    content: String,
    size: f64,
    anchor: Anchor,
    colour: &'static str,
    /// Reads from below upward.
    turned: bool,
    bold: bool,
    /// With a white rim, so that it can be read across lines.
    rimmed: bool,
}

impl Text {
    /// In one line, whatever a name contains.
    pub fn new(at: Point, anchor: Anchor, size: f64, colour: &'static str, content: &str) -> Self {
        Self { at, content: plain(content), size, anchor, colour, turned: false, bold: false, rimmed: false }
    }

    /// Reads from below upward.
    #[must_use]
    pub fn turned(self) -> Self {
        Self { turned: true, ..self }
    }

    /// In bold letters.
    #[must_use]
    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// With a white rim.
    #[must_use]
    pub fn rimmed(self) -> Self {
        Self { rimmed: true, ..self }
    }

    /// Its text.
    pub fn content(&self) -> &str {
        &self.content
    }

    fn svg(&self, out: &mut String) {
        let [x, y] = self.at;
        let side = match self.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if self.turned { format!(" transform=\"rotate(-90 {x:.1} {y:.1})\"") } else { String::new() };
        let bold = if self.bold { " font-weight=\"bold\"" } else { "" };
        let rim = if self.rimmed { " stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"" } else { "" };
        let _ = writeln!(
            out,
            "<text x=\"{x:.1}\" y=\"{y:.1}\"{turn} font-size=\"{}\" text-anchor=\"{side}\" fill=\"{}\"{bold}{rim}>{}</text>",
            self.size,
            self.colour,
            escaped(&self.content)
        );
    }
}

/// One thing that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A line through points.
    Line {
        /// Its points.
        points: Vec<Point>,
        /// `#rrggbb`.
        colour: &'static str,
        /// Of the line.
        width: f64,
        /// `None` for a solid line.
        dash: Option<Dash>,
    },
    /// A circle.
    Dot {
        /// Its centre.
        at: Point,
        /// Of the circle.
        radius: f64,
        /// Of its rim.
        colour: &'static str,
        /// Of its inside.
        fill: &'static str,
    },
    /// A text.
    Text(Text),
}

impl Mark {
    fn svg(&self, out: &mut String) {
        match self {
            Self::Line { points, colour, width, dash } => {
                let dashes = dash.map_or_else(String::new, |[on, off]| format!(" stroke-dasharray=\"{on} {off}\""));
                let places: Vec<String> = points.iter().map(|p| format!("{:.1},{:.1}", p[0], p[1])).collect();
                let _ = writeln!(
                    out,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dashes}/>",
                    places.join(" ")
                );
            }
            Self::Dot { at: [x, y], radius, colour, fill } => {
                let _ = writeln!(
                    out,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.5\"/>"
                );
            }
            Self::Text(text) => text.svg(out),
        }
    }
}

/// A plot: its size, and its marks from the lowest to the topmost, on white.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    width: f64,
    height: f64,
    /// The drawn marks.
    pub marks: Vec<Mark>,
}

impl Drawing {
    /// An empty one.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, marks: Vec::new() }
    }

    /// A whole line.
    pub fn path(&mut self, points: Vec<Point>, colour: &'static str, width: f64) {
        self.line(points, colour, width, None);
    }

    /// A line, dashed if it has dashes.
    pub fn line(&mut self, points: Vec<Point>, colour: &'static str, width: f64, dash: Option<Dash>) {
        self.marks.push(Mark::Line { points, colour, width, dash });
    }

    /// A full dot.
    pub fn dot(&mut self, at: Point, radius: f64, colour: &'static str) {
        self.marks.push(Mark::Dot { at, radius, colour, fill: colour });
    }

    /// An empty dot.
    pub fn ring(&mut self, at: Point, radius: f64, colour: &'static str) {
        self.marks.push(Mark::Dot { at, radius, colour, fill: "#ffffff" });
    }

    /// A text as it is by default.
    pub fn text(&mut self, at: Point, anchor: Anchor, size: f64, colour: &'static str, content: &str) {
        self.write(Text::new(at, anchor, size, colour, content));
    }

    /// A text.
    pub fn write(&mut self, text: Text) {
        self.marks.push(Mark::Text(text));
    }

    /// Upright lines of a grid at the ticks of an axis below, from `top` to `bottom`, and its
    /// numbers.
    pub fn ticks_below(&mut self, axis: &Axis, ticks: &[(f64, String)], [top, bottom]: [f64; 2]) {
        for (number, text) in ticks {
            let x = axis.at(*number);
            self.path(vec![[x, top], [x, bottom]], GRID, 1.0);
            self.text([x, bottom + 15.0], Anchor::Middle, SMALL, GREY, text);
        }
    }

    /// Level lines of a grid at the ticks of an axis at the left, from `left` to `right`, and its
    /// numbers.
    pub fn ticks_beside(&mut self, axis: &Axis, ticks: &[(f64, String)], [left, right]: [f64; 2]) {
        for (number, text) in ticks {
            let y = axis.at(*number);
            self.path(vec![[left, y], [right, y]], if *number == 0.0 { "#b0b0b0" } else { GRID }, 1.0);
            self.text([left - 6.0, y + 4.0], Anchor::End, SMALL, GREY, text);
        }
    }

    /// A row of a legend: a piece of the line, and the name next to it.
    pub fn key(&mut self, [x, y]: Point, (line, dash): (&'static str, Option<Dash>), colour: &'static str, name: &str) {
        self.line(vec![[x, y], [x + 18.0, y]], line, 2.0, dash);
        self.text([x + 24.0, y + 4.0], Anchor::Start, SMALL, colour, name);
    }

    /// The file's text.
    pub fn svg(&self) -> String {
        let (w, h) = (self.width, self.height);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\" viewBox=\"0 0 {w:.0} {h:.0}\" font-family=\"{FAMILY}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        );
        self.marks.iter().for_each(|mark| mark.svg(&mut out));
        out + "</svg>\n"
    }
}

/// Text between the tags of XML.
pub fn escaped(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut out, c| {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c => out.push(c),
        }
        out
    })
}

/// Approximate width of a text at a size: letters as wide as in DejaVu Sans, the widest of the
/// family.
pub fn width(text: &str, size: f64) -> f64 {
    let one = |c: char| match c {
        'i' | 'j' | 'l' | 'I' | 'J' | '\'' | '|' => 0.3,
        ' ' | '.' | ',' | ':' | ';' | '·' => 0.33,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' => 0.41,
        '_' | 's' | 'c' | 'z' => 0.54,
        'm' | 'w' | 'M' | 'W' | '…' => 0.98,
        'A'..='Z' => 0.75,
        c if u32::from(c) >= 0x1100 => 1.0,
        _ => 0.64,
    };
    size * text.chars().map(one).sum::<f64>()
}

/// From a number to a place on the plane.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Numbers at the ends; their logarithms to the base of 10 if the axis is logarithmic.
    range: [f64; 2],
    /// Where the ends are.
    ends: [f64; 2],
    /// Distance of ticks of a linear axis; `None` if the axis is logarithmic.
    step: Option<f64>,
}

impl Axis {
    /// Linear, over all numbers that are finite, its ends at ticks; about `count` ticks.
    pub fn around(numbers: impl Iterator<Item = f64>, ends: [f64; 2], count: f64) -> Self {
        let [low, high] = wide(numbers);
        let step = step((high - low) / count);
        Self { range: [(low / step).floor() * step, (high / step).ceil() * step], ends, step: Some(step) }
    }

    /// Linear, from the least to the most.
    pub fn exactly(numbers: impl Iterator<Item = f64>, ends: [f64; 2], count: f64) -> Self {
        let [low, high] = wide(numbers);
        Self { range: [low, high], ends, step: Some(step((high - low) / count)) }
    }

    /// Logarithmic, over all numbers that have a logarithm; `room` is left at both ends, in
    /// decades.
    pub fn logarithmic(numbers: impl Iterator<Item = f64>, ends: [f64; 2], room: f64) -> Self {
        let logs = numbers.filter(|x| *x > 0.0 && x.is_finite()).map(f64::log10);
        let [low, high] = logs.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        Self { range: if low <= high { [low - room, high + room] } else { [0.0, 1.0] }, ends, step: None }
    }

    /// The position of a number. A logarithmic axis clamps numbers to its ends.
    pub fn at(&self, number: f64) -> f64 {
        let along = |x: f64| (x - self.range[0]) / (self.range[1] - self.range[0]);
        let part = if self.step.is_some() { along(number) } else { along(number.max(1e-300).log10()).clamp(0.0, 1.0) };
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }

    /// Whether a number of a linear axis is between its ends.
    pub fn holds(&self, number: f64) -> bool {
        (self.range[0]..=self.range[1]).contains(&number)
    }

    /// The numbers written at a logarithmic axis: powers of ten, and their multiples by 2 and 5 if
    /// there are few.
    pub fn decades(&self, text: impl Fn(f64) -> String) -> Vec<(f64, String)> {
        let decades = self.range[1] - self.range[0];
        let multiples: &[f64] = if decades < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let every = (decades / 12.0).ceil().max(1.0) as i32;
        let powers = (self.range[0].floor() as i32..=self.range[1].ceil() as i32).filter(|p| p % every == 0);
        let all = powers.flat_map(|p| multiples.iter().map(move |m| m * 10f64.powi(p)));
        all.filter(|x| self.holds(x.log10())).map(|x| (x, text(x))).collect()
    }

    /// The numbers written at a linear axis, and their common power of ten.
    pub fn ticks(&self) -> (Vec<(f64, String)>, i32) {
        let ([low, high], step) = (self.range, self.step.unwrap_or(1.0));
        let slack = 1e-9 * step;
        let (first, last) = (((low - slack) / step).ceil() as i64, ((high + slack) / step).floor() as i64);
        let largest = low.abs().max(high.abs());
        let power = if (1e-3..1e5).contains(&largest) { 0 } else { 3 * (largest.log10() / 3.0).floor() as i32 };
        let unit = step / 10f64.powi(power);
        let places = (-unit.log10() + 0.01).floor().clamp(0.0, 9.0) as usize;
        // 2.5 has a place more than its power of ten.
        let places = if (unit * 10f64.powi(places as i32)).fract().abs() > 0.1 { places + 1 } else { places };
        let tick = |k: i64| {
            let text = format!("{:.places$}", k as f64 * unit);
            (k as f64 * step, text.replace('-', "−"))
        };
        ((first..=last.min(first + 50)).map(tick).collect(), power)
    }
}

/// The least and the most, some way apart: numbers that differ in their last digits only are drawn
/// as one.
fn wide(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let ends = numbers.filter(|x| x.is_finite()).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    let [low, high] = if ends[0] <= ends[1] { ends.map(|x| x.clamp(-1e300, 1e300)) } else { [0.0, 1.0] };
    let size = low.abs().max(high.abs());
    if high - low > 1e-7 * size && size > 1e-290 {
        [low, high]
    } else {
        let room = if size > 1e-290 { 0.1 * size } else { 1.0 };
        [low - room, high + room]
    }
}

/// 1, 2 or 5 times a power of ten, at least `least`.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|m| m * power).into_iter().find(|s| *s >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis) -> Vec<String> {
        axis.ticks().0.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        let axis = Axis::around([-0.93, 1.2].into_iter(), [100.0, 0.0], 5.0);
        assert_eq!(texts(&axis), ["−1.0", "−0.5", "0.0", "0.5", "1.0", "1.5"]);
        assert_eq!((axis.at(-1.0), axis.at(1.5)), (100.0, 0.0));
        let small = Axis::around([0.0, 3.2e-13].into_iter(), [0.0, 1.0], 4.0);
        assert_eq!((texts(&small), small.ticks().1), (vec!["0".into(), "100".into(), "200".into(), "300".into(), "400".into()], -15));
    }

    #[test]
    fn what_hardly_changes_is_a_straight_line() {
        let axis = Axis::around([5.0, 5.0 + 1e-12].into_iter(), [0.0, 100.0], 4.0);
        assert!((axis.at(5.0) - axis.at(5.0 + 1e-12)).abs() < 1e-6);
        for odd in [vec![], vec![f64::NAN], vec![0.0], vec![f64::MAX, f64::MIN], vec![5e-324, 0.0]] {
            let axis = Axis::around(odd.into_iter(), [0.0, 1.0], 5.0);
            assert!(axis.range[0] < axis.range[1] && axis.ticks().0.len() < 60, "{axis:?}");
        }
    }

    #[test]
    fn equal_ratios_are_equal_distances() {
        let axis = Axis::logarithmic([1e-16, 1e-6].into_iter(), [0.0, 103.0], 0.15);
        assert!((axis.at(1e-10) - axis.at(1e-12) - (axis.at(1e-12) - axis.at(1e-14))).abs() < 1e-9);
        let ticks = |axis: &Axis| axis.decades(|x| x.to_string()).into_iter().map(|(x, _)| x).collect::<Vec<_>>();
        assert!(ticks(&axis).len() >= 8 && ticks(&Axis::logarithmic([].into_iter(), [0.0, 1.0], 0.1)).len() >= 2);
        assert_eq!(ticks(&Axis::logarithmic([10.0, 100.0].into_iter(), [0.0, 1.0], 0.0)), [10.0, 20.0, 50.0, 100.0]);
    }

    #[test]
    fn a_name_cannot_end_its_element() {
        let mut out = Drawing::new(10.0, 10.0);
        out.text([0.0, 0.0], Anchor::Start, 10.0, INK, "</text>&\n\"");
        assert!(out.svg().contains(">&lt;/text&gt;&amp;\\n&quot;</text>"), "{}", out.svg());
    }

    #[test]
    fn widths_grow_with_size() {
        assert!((width("abc", 20.0) - 2.0 * width("abc", 10.0)).abs() < 1e-9);
    }
}
