//! A picture as marks on a plane, in points; [`super::svg`] and [`super::png`] make files of the same picture.

/// x to the right, y down.
pub(super) type Point = [f64; 2];

/// Which side of a text its place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// One thing that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A line through points.
    Path { points: Vec<Point>, colour: &'static str, width: f64, dashed: bool },
    /// A text on its base line; `turned` reads from below upward.
    Text { at: Point, content: String, size: f64, anchor: Anchor, colour: &'static str, turned: bool },
}

/// A picture: its size, and its marks from the lowest to the topmost, on white.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawing {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) marks: Vec<Mark>,
}

impl Drawing {
    pub(super) fn path(&mut self, points: Vec<Point>, colour: &'static str, width: f64, dashed: bool) {
        self.marks.push(Mark::Path { points, colour, width, dashed });
    }

    pub(super) fn text(&mut self, at: Point, anchor: Anchor, size: f64, colour: &'static str, content: &str) {
        let content = crate::table::plain(content);
        self.marks.push(Mark::Text { at, content, size, anchor, colour, turned: false });
    }

    pub(super) fn turned_text(&mut self, at: Point, size: f64, colour: &'static str, content: &str) {
        let content = crate::table::plain(content);
        self.marks.push(Mark::Text { at, content, size, anchor: Anchor::Middle, colour, turned: true });
    }
}
