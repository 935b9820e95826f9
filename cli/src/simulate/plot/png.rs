//! A picture as PNG, two pixels a point.

use tiny_skia::{FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

use super::drawing::{Anchor, Drawing, Mark, Point};
use super::font::{self, Pen};

const SCALE: f32 = 2.0;

/// The file's bytes.
pub(crate) fn bytes(drawing: &Drawing) -> Result<Vec<u8>, String> {
    let pixels = |points: f64| (points as f32 * SCALE).ceil().max(1.0) as u32;
    let (width, height) = (pixels(drawing.width), pixels(drawing.height));
    let mut map = Pixmap::new(width, height).ok_or_else(|| format!("{width} × {height} pixels are too many"))?;
    map.fill(tiny_skia::Color::WHITE);
    drawing.marks.iter().for_each(|m| mark(&mut map, m));
    map.encode_png().map_err(|e| e.to_string())
}

fn mark(map: &mut Pixmap, mark: &Mark) {
    let scale = Transform::from_scale(SCALE, SCALE);
    match mark {
        Mark::Path { points, colour, width, dash } => {
            let dash = dash.and_then(|lengths| StrokeDash::new(lengths.map(|x| x as f32).into(), 0.0));
            let stroke = Stroke { width: *width as f32, line_join: LineJoin::Round, line_cap: LineCap::Butt, dash, ..Stroke::default() };
            if let Some(path) = line(points) {
                map.stroke_path(&path, &paint(colour), &stroke, scale, None);
            }
        }
        Mark::Text { at, content, size, anchor, colour, turned } => {
            let width = font::width(content, *size);
            let back = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5 * width,
                Anchor::End => width,
            };
            let mut pen = Letters { builder: PathBuilder::new(), at: *at, back, turned: *turned };
            font::outline(content, *size, &mut pen);
            if let Some(path) = pen.builder.finish() {
                map.fill_path(&path, &paint(colour), FillRule::Winding, scale, None);
            }
        }
    }
}

fn line(points: &[Point]) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    for (k, [x, y]) in points.iter().map(|p| p.map(|x| x as f32)).enumerate() {
        if k == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    builder.finish()
}

/// From `#rrggbb`.
fn paint(colour: &str) -> Paint<'static> {
    let part = |k: usize| colour.get(k..k + 2).and_then(|h| u8::from_str_radix(h, 16).ok()).unwrap_or(0);
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(part(1), part(3), part(5), 255);
    paint
}

/// Outlines of a text, put where it belongs.
struct Letters {
    builder: PathBuilder,
    at: Point,
    /// How far before its place the text begins.
    back: f64,
    turned: bool,
}

impl Letters {
    fn place(&self, [x, y]: Point) -> [f32; 2] {
        let along = x - self.back;
        let [dx, dy] = if self.turned { [-y, -along] } else { [along, -y] };
        [(self.at[0] + dx) as f32, (self.at[1] + dy) as f32]
    }
}

impl Pen for Letters {
    fn start(&mut self, to: Point) {
        let [x, y] = self.place(to);
        self.builder.move_to(x, y);
    }

    fn line(&mut self, to: Point) {
        let [x, y] = self.place(to);
        self.builder.line_to(x, y);
    }

    fn bend(&mut self, by: Point, to: Point) {
        let ([x1, y1], [x, y]) = (self.place(by), self.place(to));
        self.builder.quad_to(x1, y1, x, y);
    }

    fn bend_twice(&mut self, first: Point, second: Point, to: Point) {
        let ([x1, y1], [x2, y2], [x, y]) = (self.place(first), self.place(second), self.place(to));
        self.builder.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.builder.close();
    }
}
