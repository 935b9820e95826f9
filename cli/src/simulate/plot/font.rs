//! The letters of pictures: DejaVu Sans, whose outlines come with the program, so that a picture is the same everywhere.

use std::sync::OnceLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Its name for files that have text as text.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

fn face() -> Option<&'static Face<'static>> {
    static FACE: OnceLock<Option<Face<'static>>> = OnceLock::new();
    FACE.get_or_init(|| Face::parse(dejavu::sans::regular(), 0).ok()).as_ref()
}

/// What is drawn for a character; the font's box for those that it does not have.
fn glyph(face: &Face<'_>, c: char) -> GlyphId {
    face.glyph_index(c).unwrap_or(GlyphId(0))
}

/// How wide a text is at a size.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let Some(face) = face() else { return text.chars().count() as f64 * size * 0.6 };
    let units: f64 = text.chars().map(|c| f64::from(face.glyph_hor_advance(glyph(face, c)).unwrap_or(0))).sum();
    units * size / f64::from(face.units_per_em())
}

/// Gives the outlines of a text at a size to `pen`, the start of the base line at the origin, y up.
pub(super) fn outline(text: &str, size: f64, pen: &mut impl Pen) {
    let Some(face) = face() else { return };
    let scale = size / f64::from(face.units_per_em());
    let mut x = 0.0;
    for c in text.chars() {
        let id = glyph(face, c);
        face.outline_glyph(id, &mut Placed { pen, x, scale });
        x += f64::from(face.glyph_hor_advance(id).unwrap_or(0)) * scale;
    }
}

/// What draws outlines.
pub(super) trait Pen {
    fn start(&mut self, to: [f64; 2]);
    fn line(&mut self, to: [f64; 2]);
    fn bend(&mut self, by: [f64; 2], to: [f64; 2]);
    fn bend_twice(&mut self, first: [f64; 2], second: [f64; 2], to: [f64; 2]);
    fn close(&mut self);
}

/// A glyph of the font in its place in a text.
struct Placed<'a, P> {
    pen: &'a mut P,
    x: f64,
    scale: f64,
}

impl<P> Placed<'_, P> {
    fn at(&self, x: f32, y: f32) -> [f64; 2] {
        [self.x + f64::from(x) * self.scale, f64::from(y) * self.scale]
    }
}

impl<P: Pen> OutlineBuilder for Placed<'_, P> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pen.start(self.at(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.pen.line(self.at(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.pen.bend(self.at(x1, y1), self.at(x, y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.pen.bend_twice(self.at(x1, y1), self.at(x2, y2), self.at(x, y));
    }

    fn close(&mut self) {
        self.pen.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_grow_with_size_and_letters_of_all_names_are_there() {
        assert!((width("abc", 20.0) - 2.0 * width("abc", 10.0)).abs() < 1e-9);
        assert!("локоть αβ ·²³°−".chars().all(|c| face().unwrap().glyph_index(c).is_some()));
    }
}
