//! `[impact]`: a ball that a link hits.

use articulated_core::diagnostic::{At, Diagnostics};
use articulated_core::effect::Range;

use crate::edits::name;
use crate::simulation::set;
use crate::table::{Cursor, Row};
use crate::tree::Value;

/// A ball at rest and the link that hits it: an instantaneous impact along the normal, without
/// friction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impact {
    /// The link or frame that hits.
    pub link: String,
    /// The point that hits, in that frame, m.
    pub point: [f64; 3],
    /// Direction in which the ball leaves, in the world frame; of any non-zero length.
    pub normal: [f64; 3],
    /// Mass of the ball, kg.
    pub mass: f64,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Speed of the ball along the normal before, m/s.
    pub ball_speed: f64,
    /// When.
    pub when: When,
    /// Whether the simulation ends with it.
    pub stop: bool,
    /// Place of the link in the scene.
    pub place: At,
    /// Place of the time or position in the scene.
    pub when_place: At,
}

/// When the ball is hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// When the point passes the plane through this place, in the world frame, m, with the impact's
    /// normal: n·(p − ball) rises through zero.
    Ball([f64; 3]),
    /// At this time, s.
    Time(f64),
}

impl Default for When {
    fn default() -> Self {
        Self::Ball([0.0; 3])
    }
}

pub(crate) const KEYS: &[Row<Impact>] = &[
    Row {
        name: "link",
        required: true,
        value: "text",
        default: "",
        what: "the link or frame that hits",
        read: |x, s, log| {
            x.place = s.at;
            x.link = name(s, log, "the name of a link or frame").unwrap_or_default();
        },
    },
    Row {
        name: "point",
        required: false,
        value: "3 numbers, m",
        default: "[0, 0, 0]",
        what: "the point that hits, in that frame",
        read: |x, s, log| set(&mut x.point, s.numbers(log)),
    },
    Row {
        name: "normal",
        required: true,
        value: "3 numbers",
        default: "",
        what: "the direction in which the ball goes, in the world frame, of any length",
        read: |x, s, log| {
            let normal = s.numbers(log);
            if normal == Some([0.0; 3]) {
                s.bad(log, "no direction", "three numbers that are not all 0");
            }
            set(&mut x.normal, normal);
        },
    },
    Row {
        name: "mass",
        required: true,
        value: "number, kg",
        default: "",
        what: "mass of the ball, above 0",
        read: |x, s, log| set(&mut x.mass, s.positive(log)),
    },
    Row {
        name: "restitution",
        required: true,
        value: "number, 1",
        default: "",
        what: "coefficient of restitution, at least 0, at most 1",
        read: |x, s, log| {
            set(&mut x.restitution, s.within(log, Range { at_most: 1.0, ..Range::NOT_NEGATIVE }));
        },
    },
    Row {
        name: "ball_speed",
        required: false,
        value: "number, m/s",
        default: "0",
        what: "speed of the ball along the normal before",
        read: |x, s, log| set(&mut x.ball_speed, s.number(log)),
    },
    Row {
        name: "ball",
        required: false,
        value: "3 numbers, m",
        default: "this or `time` has to be given",
        what: "the ball's place in the world frame: it is hit when the point passes the plane through it, forward along the normal",
        read: |x, s, log| {
            x.when_place = s.at;
            set(&mut x.when, s.numbers(log).map(When::Ball));
        },
    },
    Row {
        name: "time",
        required: false,
        value: "number, s",
        default: "this or `ball` has to be given",
        what: "when the ball is hit, wherever the point is then: from the start on, before the end",
        read: |x, s, log| {
            x.when_place = s.at;
            set(&mut x.when, s.number(log).map(When::Time));
        },
    },
    Row {
        name: "stop",
        required: false,
        value: "true or false",
        default: "false",
        what: "whether the simulation ends with it",
        read: |x, s, log| set(&mut x.stop, s.boolean(log)),
    },
];

pub(crate) fn read(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Impact> {
    let mut impact = Impact::default();
    let before = log.count();
    spot.read(KEYS, &mut impact, log);
    match (spot.get("ball"), spot.get("time")) {
        (Some(_), Some(time)) => time.clash(log, "ball and time", "one of them"),
        // One of them may be misspelt.
        (None, None) if matches!(spot.node.value, Value::Table(_)) && !log.has_unknown_key(before) => {
            spot.clash(log, "neither ball nor time", "one of them, to say when the ball is hit");
        }
        _ => {}
    }
    (log.count() == before).then_some(impact)
}
