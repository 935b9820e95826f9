//! Names next to their marks.

use crate::plot::{Anchor, Point, SMALL};

/// Left, top, right and bottom.
pub(super) type Area = [f64; 4];

/// The size of names.
pub(super) const SIZE: f64 = SMALL;

/// Distance of a name's edge from its mark.
const GAP: f64 = 7.0;

/// The place of a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) at: Point,
    pub(super) anchor: Anchor,
    /// The end of a line from the mark, if the name is too far away to be identified by its place.
    pub(super) leader: Option<Point>,
}

/// The occupied areas of a picture.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    within: Area,
    taken: Vec<Area>,
    /// Lines from marks to names.
    leaders: Vec<[Point; 2]>,
}

impl Labels {
    /// All names are placed within this area, and outside the occupied ones.
    pub(super) fn new(within: Area, taken: Vec<Area>) -> Self {
        Self { within, taken, leaders: Vec::new() }
    }

    /// A place next to a mark, or the nearest free place with a line to it, which crosses no other
    /// line if possible. The place is then occupied.
    pub(super) fn place(&mut self, mark: Point, name: &str) -> Place {
        let free = |p: &Place| {
            let area = area(p, name);
            let clear = p.leader.is_none_or(|end| self.clear(mark, end));
            clear && self.holds(&area) && !self.taken.iter().any(|t| overlap(t, &area))
        };
        let alone = |p: &Place| {
            let around = self.leaders.iter().any(|line| through(*line, &area(p, name)));
            !around && p.leader.is_none_or(|end| !self.leaders.iter().any(|line| cross([mark, end], *line)))
        };
        let all = || beside(mark).into_iter().chain(farther(mark)).filter(free);
        let place = all().find(alone).or_else(|| all().next()).unwrap_or(beside(mark)[0]);
        self.taken.push(area(&place, name));
        self.leaders.extend(place.leader.map(|end| [mark, end]));
        place
    }

    /// Whether the outer part of a line crosses no occupied area.
    fn clear(&self, mark: Point, end: Point) -> bool {
        let outer = [on([mark, end], 0.4), end];
        !self.taken.iter().any(|t| through(outer, t))
    }

    fn holds(&self, [left, top, right, bottom]: &Area) -> bool {
        let [a, b, c, d] = self.within;
        *left >= a && *top >= b && *right <= c && *bottom <= d
    }
}

/// A point of a line, from 0 at its start to 1 at its end.
fn on([[x, y], end]: [Point; 2], part: f64) -> Point {
    [x + part * (end[0] - x), y + part * (end[1] - y)]
}

/// Whether a line leads through an area, seen at eleven of its points.
fn through(line: [Point; 2], area: &Area) -> bool {
    let inside = |[x, y]: Point| (area[0]..=area[2]).contains(&x) && (area[1]..=area[3]).contains(&y);
    (0..=10).any(|k| inside(on(line, 0.1 * f64::from(k))))
}

/// Whether two lines cross.
fn cross(a: [Point; 2], b: [Point; 2]) -> bool {
    // Twice the area of a triangle, positive if the point is on one side of the line.
    let side = |[from, to]: [Point; 2], p: Point| (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
    let apart = |line, [p, q]: [Point; 2]| side(line, p) * side(line, q) < 0.0;
    apart(a, b) && apart(b, a)
}

/// Right, left, and at the corners.
fn beside([x, y]: Point) -> [Place; 6] {
    let right = |dy: f64, gap: f64| Place { at: [x + gap, y + dy], anchor: Anchor::Start, leader: None };
    let left = |dy: f64, gap: f64| Place { at: [x - gap, y + dy], anchor: Anchor::End, leader: None };
    [right(4.0, GAP), left(4.0, GAP), right(-5.0, 3.0), right(14.0, 3.0), left(-5.0, 3.0), left(14.0, 3.0)]
}

/// On either side, farther and farther up and down.
fn farther([x, y]: Point) -> impl Iterator<Item = Place> {
    (1..30).flat_map(move |k| {
        let away = 6.0 * f64::from(k);
        [(1.0, -away), (1.0, away), (-1.0, -away), (-1.0, away)].map(|(side, dy)| {
            let end = [x + side * 22.0, y + dy];
            let anchor = if side > 0.0 { Anchor::Start } else { Anchor::End };
            Place { at: [end[0] + side * 2.0, end[1] + 4.0], anchor, leader: Some(end) }
        })
    })
}

/// The area of a name.
pub(super) fn area(place: &Place, name: &str) -> Area {
    let [x, y] = place.at;
    let wide = width(name);
    let left = match place.anchor {
        Anchor::Start => x,
        Anchor::Middle => x - 0.5 * wide,
        Anchor::End => x - wide,
    };
    [left, y - 0.8 * SIZE, left + wide, y + 0.25 * SIZE]
}

/// Approximate width of a name, for letters of a sans serif.
pub(super) fn width(name: &str) -> f64 {
    0.61 * SIZE * name.chars().count() as f64
}

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_beside_their_marks_and_never_on_each_other() {
        let marks: Vec<Point> = (0..9).map(|k| [100.0 + f64::from(k % 3), 100.0 + 2.0 * f64::from(k)]).collect();
        let taken = marks.iter().map(|[x, y]| [x - 4.0, y - 4.0, x + 4.0, y + 4.0]).collect();
        let mut labels = Labels::new([0.0, 0.0, 400.0, 300.0], taken);
        let places: Vec<Place> = marks.iter().map(|m| labels.place(*m, "compensated")).collect();
        assert_eq!(places[0], beside(marks[0])[0]);
        assert!(places.iter().any(|p| p.leader.is_some()) && places.iter().filter(|p| p.leader.is_none()).count() >= 2);
        let areas: Vec<Area> = places.iter().map(|p| area(p, "compensated")).collect();
        for (k, a) in areas.iter().enumerate() {
            assert!(labels.holds(a) && areas[k + 1..].iter().all(|b| !overlap(a, b)), "{areas:?}");
        }
    }

    #[test]
    fn a_line_leads_around_what_is_taken() {
        let labels = Labels::new([0.0, 0.0, 100.0, 100.0], vec![[60.0, 40.0, 80.0, 60.0]]);
        assert!(!labels.clear([40.0, 50.0], [90.0, 50.0]) && labels.clear([40.0, 50.0], [90.0, 10.0]));
        // A line may begin within its own mark.
        assert!(labels.clear([78.0, 50.0], [100.0, 50.0]));
    }

    /// Two marks side by side under a crowd: the names go to their own sides.
    #[test]
    fn lines_do_not_cross() {
        let marks = [[440.0, 360.0], [460.0, 360.0]];
        let crowd = [[300.0, 320.0, 436.0, 380.0], [464.0, 320.0, 600.0, 380.0]];
        let around = marks.iter().map(|[x, y]| [x - 4.0, y - 4.0, x + 4.0, y + 4.0]).chain(crowd).collect();
        let mut labels = Labels::new([0.0, 0.0, 720.0, 400.0], around);
        marks.iter().for_each(|m| _ = labels.place(*m, "double_double"));
        let [a, b] = labels.leaders[..] else { panic!("{labels:?}") };
        assert!(!cross(a, b) && cross([[0.0, 0.0], [2.0, 2.0]], [[0.0, 2.0], [2.0, 0.0]]), "{a:?} {b:?}");
    }

    #[test]
    fn a_name_at_the_edge_stands_on_the_other_side() {
        let mut labels = Labels::new([0.0, 0.0, 100.0, 100.0], vec![]);
        assert_eq!(labels.place([95.0, 50.0], "f64"), beside([95.0, 50.0])[1]);
        assert_eq!(labels.place([5.0, 50.0], "f64").anchor, Anchor::Start);
        // Without any room it is placed next to its mark nevertheless.
        assert_eq!(Labels::new([0.0; 4], vec![]).place([50.0, 50.0], "f64"), beside([50.0, 50.0])[0]);
    }
}
