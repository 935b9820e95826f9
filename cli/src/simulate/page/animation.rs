//! A motion as a picture that moves: SVG with animated paths, without a script, for pages of text.

use std::fmt::Write;

use articulated_core::spatial::Placement;
use articulated_lab::plot::escaped;
use nalgebra::Vector3;

use super::figure::Figure;

/// Maximum number of frames, and of frames per second.
const MOST: (usize, f64) = (120, 20.0);
/// How long the last frame stays, s.
const PAUSE: f64 = 1.0;
/// Units across the picture, and in its margin; the maximum height relative to the width.
const WIDTH: f64 = 960.0;
const MARGIN: f64 = 20.0;
const ASPECT: f64 = 0.75;
/// Initial direction of the view of the page, rad.
const AZIMUTH: f64 = -0.9;
const ELEVATION: f64 = 0.32;
/// Of limbs, as on that page.
const HUES: [u32; 8] = [208, 28, 150, 0, 270, 50, 190, 320];

type Point = [f64; 2];

/// Upward direction, height of the ground along it, and a sphere around the motion.
pub(super) struct Room {
    pub(super) up: Vector3<f64>,
    pub(super) ground: f64,
    pub(super) center: Vector3<f64>,
    pub(super) radius: f64,
}

/// Indices of the times that become frames, the first and the last among them.
pub(super) fn chosen(t: &[f64], speed: f64) -> Vec<usize> {
    let (Some(first), Some(last)) = (t.first(), t.last()) else { return Vec::new() };
    let gap = (speed / MOST.1).max((last - first) / (MOST.0 - 2) as f64) * (1.0 - 1e-6);
    let (mut next, mut chosen) = (*first, Vec::new());
    for (k, now) in t.iter().enumerate() {
        if *now >= next || k == t.len() - 1 {
            chosen.push(k);
            next = now + gap;
        }
    }
    chosen
}

/// The picture. `times`: of the frames, s; `placements`: of all moving bodies in each frame;
/// `speed`: seconds of the motion in a second.
pub(super) fn svg(figure: &Figure, placements: &[Placement<f64>], room: &Room, times: &[f64], title: &str, speed: f64) -> String {
    let eye = Eye::of(room);
    let fixed = Placement::identity();
    let place = |frame: usize, body: usize| placements.get(frame * figure.frames.len() + body.checked_sub(1)?);
    let at = |frame: usize, body: usize| place(frame, body).unwrap_or(&fixed);
    let frames = 0..times.len();
    let mut hulls: Vec<(f64, usize, Vec<Vec<Point>>)> = (figure.boxes.iter())
        .map(|own| {
            let hull = |k| hull(own.corners().map(|p| eye.show(&at(k, own.body).transform(p))).to_vec());
            let depth = eye.back.dot(&at(0, own.body).transform(Vector3::from(own.center)));
            (depth, own.limb, frames.clone().map(hull).collect())
        })
        .collect();
    // The far ones first.
    hulls.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends = |k: usize| -> Vec<[Point; 2]> {
        let end = |body: usize, p: [f64; 3]| eye.show(&at(k, body).transform(Vector3::from(p)));
        figure.sticks.iter().map(|s| [end(s.from, s.start), end(s.to, s.end)]).collect()
    };
    let sticks: Vec<Vec<[Point; 2]>> = frames.clone().map(ends).collect();
    let page = Page::of(hulls.iter().flat_map(|h| h.2.iter().flatten()).chain(sticks.iter().flatten().flatten()));
    let clock = Clock::of(times, speed);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0}\" viewBox=\"0 0 {WIDTH:.0} {:.0}\">\n\
         <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        WIDTH / 2.0,
        page.height,
        escaped(title)
    );
    let _ = writeln!(out, "<path d=\"{}\" stroke=\"#dde2e6\" stroke-width=\"2\"/>", page.grid(room, &eye));
    for (_, limb, hulls) in &hulls {
        let hue = HUES[limb % HUES.len()];
        let look = format!("fill=\"hsl({hue},45%,68%)\" fill-opacity=\".7\" stroke=\"hsl({hue},45%,30%)\" stroke-opacity=\".6\"");
        clock.path(&mut out, &look, &hulls.iter().map(|hull| page.line(hull) + "Z").collect::<Vec<_>>());
    }
    let strokes = |k: usize| sticks[k].iter().map(|stick| page.line(stick)).collect::<String>();
    let look = "fill=\"none\" stroke=\"#26323e\" stroke-width=\"5\" stroke-linecap=\"round\"";
    clock.path(&mut out, look, &frames.map(strokes).collect::<Vec<_>>());
    out + "</svg>\n"
}

/// A parallel projection.
struct Eye {
    right: Vector3<f64>,
    top: Vector3<f64>,
    back: Vector3<f64>,
    ground: [Vector3<f64>; 2],
}

impl Eye {
    fn of(room: &Room) -> Self {
        let up = room.up;
        let start = if up.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
        let side = (start - up * up.dot(&start)).normalize();
        let ahead = up.cross(&side);
        let (s, c) = ELEVATION.sin_cos();
        let back = (side * AZIMUTH.cos() + ahead * AZIMUTH.sin()) * c + up * s;
        let right = up.cross(&back).normalize();
        Self { right, top: back.cross(&right), back, ground: [side, ahead] }
    }

    /// x to the right, y down.
    fn show(&self, p: &Vector3<f64>) -> Point {
        [self.right.dot(p), -self.top.dot(p)]
    }
}

/// The window of the picture on the projection.
struct Page {
    corner: Point,
    scale: f64,
    height: f64,
}

impl Page {
    /// Large enough for all of these.
    fn of<'a>(all: impl Iterator<Item = &'a Point>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in all.filter(|p| p.iter().all(|x| x.is_finite())) {
            (low, high) = ([0, 1].map(|k| low[k].min(p[k])), [0, 1].map(|k| high[k].max(p[k])));
        }
        let size = [0, 1].map(|k| if high[k] > low[k] { high[k] - low[k] } else { 1e-3 });
        let scale = ((WIDTH - 2.0 * MARGIN) / size[0]).min((ASPECT * WIDTH - 2.0 * MARGIN) / size[1]);
        let height = size[1] * scale + 2.0 * MARGIN;
        let low = low.map(|x| if x.is_finite() { x } else { 0.0 });
        Self { corner: [low[0] - (WIDTH / scale - size[0]) / 2.0, low[1] - MARGIN / scale], scale, height }
    }

    fn line(&self, points: &[Point]) -> String {
        let mut out = String::new();
        for (k, p) in points.iter().enumerate() {
            let [x, y] = [0, 1].map(|axis| (self.scale * (p[axis] - self.corner[axis])).clamp(-1e5, 1e5).round() as i64);
            let _ = write!(out, "{}{x} {y}", if k == 0 { 'M' } else { 'L' });
        }
        out
    }

    /// Lines on the ground, around the moving bodies.
    fn grid(&self, room: &Room, eye: &Eye) -> String {
        let center = room.center + room.up * (room.ground - room.up.dot(&room.center));
        let spot = |i: i32, j: i32| {
            let [side, ahead] = eye.ground.map(|axis| axis * (room.radius / 2.0));
            eye.show(&(center + side * f64::from(i) + ahead * f64::from(j)))
        };
        (-4..=4).map(|i| self.line(&[spot(i, -4), spot(i, 4)]) + &self.line(&[spot(-4, i), spot(4, i)])).collect()
    }
}

/// When the frames are shown.
struct Clock {
    duration: f64,
    keys: String,
}

impl Clock {
    fn of(times: &[f64], speed: f64) -> Self {
        let length = times.first().zip(times.last()).map_or(0.0, |(first, last)| (last - first) / speed);
        let duration = length + PAUSE;
        let keys: Vec<String> = times.iter().map(|t| format!("{:.4}", (t - times[0]) / speed / duration)).collect();
        Self { duration, keys: keys.join(";") }
    }

    /// A path with one text for each frame.
    fn path(&self, out: &mut String, look: &str, texts: &[String]) {
        let Some(first) = texts.first() else { return };
        let _ = write!(out, "<path {look} d=\"{first}\">");
        if texts.iter().any(|text| text != first) {
            let (duration, keys, texts) = (self.duration, &self.keys, texts.join(";"));
            let _ = write!(out, "<animate attributeName=\"d\" calcMode=\"discrete\" repeatCount=\"indefinite\" dur=\"{duration:.3}s\" ");
            let _ = write!(out, "keyTimes=\"{keys}\" values=\"{texts}\"/>");
        }
        out.push_str("</path>\n");
    }
}

/// The convex hull, counterclockwise (Andrew 1979).
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let bends = |a: Point, b: Point, p: Point| (b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0]);
    let mut out: Vec<Point> = Vec::new();
    for _ in 0..2 {
        let start = out.len();
        for &p in &points {
            while out.len() >= start + 2 && !bends(out[out.len() - 2], out[out.len() - 1], p) {
                out.pop();
            }
            out.push(p);
        }
        out.pop();
        points.reverse();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::hull;

    #[test]
    fn a_hull_has_the_corners_alone() {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [0.5, 0.4], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0]];
        assert_eq!(hull(points), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }
}
