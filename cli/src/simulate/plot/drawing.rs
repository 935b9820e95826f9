//! A picture as marks on a plane, in points; [`super::svg`] and [`super::png`] make files of the same picture.

/// x to the right, y down.
pub(crate) type Point = [f64; 2];

/// Which side of a text its place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Lengths of dashes and gaps along a line, in points.
pub(crate) type Dash = [f64; 2];

/// One thing that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Mark {
    /// A line through points.
    Path { points: Vec<Point>, colour: &'static str, width: f64, dash: Option<Dash> },
    /// A text on its base line; `turned` reads from below upward.
    Text { at: Point, content: String, size: f64, anchor: Anchor, colour: &'static str, turned: bool },
}

/// A picture: its size, and its marks from the lowest to the topmost, on white.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drawing {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) marks: Vec<Mark>,
}

impl Drawing {
    pub(crate) fn path(&mut self, points: Vec<Point>, colour: &'static str, width: f64, dashed: bool) {
        self.line(points, colour, width, dashed.then_some([4.0, 3.0]));
    }

    pub(crate) fn line(&mut self, points: Vec<Point>, colour: &'static str, width: f64, dash: Option<Dash>) {
        self.marks.push(Mark::Path { points, colour, width, dash });
    }

    pub(crate) fn text(&mut self, at: Point, anchor: Anchor, size: f64, colour: &'static str, content: &str) {
        let content = crate::table::plain(content);
        self.marks.push(Mark::Text { at, content, size, anchor, colour, turned: false });
    }

    pub(crate) fn turned_text(&mut self, at: Point, size: f64, colour: &'static str, content: &str) {
        let content = crate::table::plain(content);
        self.marks.push(Mark::Text { at, content, size, anchor: Anchor::Middle, colour, turned: true });
    }
}
