//! `[effects.shaft]`: shafts that bend.

use articulated_core::description::Shaft;
use articulated_core::diagnostic::{At, Diagnostics};

use crate::simulation::set;
use crate::table::{Cursor, Row};

/// Its name among the effects.
pub(crate) const NAME: &str = "shaft";

/// A fixed joint whose rigid offset bends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaftRequest {
    /// The shaft.
    pub shaft: Shaft,
    /// Place in the scene.
    pub place: At,
}

/// More pieces are not worth their coordinates.
const MOST_SEGMENTS: u64 = 100;

pub(crate) const KEYS: &[Row<ShaftRequest>] = &[
    Row {
        name: "segments",
        required: true,
        value: "whole number, 1 to 100",
        default: "",
        what: "how many pieces bend: each is a universal joint with springs; the error of deflections falls with its square",
        read: |x, s, log| set(&mut x.shaft.segments, s.whole(log, 1, MOST_SEGMENTS).and_then(|n| usize::try_from(n).ok())),
    },
    Row {
        name: "stiffness",
        required: true,
        value: "number, N·m²",
        default: "",
        what: "flexural rigidity E·I, the same all along and in both directions, above 0",
        read: |x, s, log| set(&mut x.shaft.stiffness, s.positive(log)),
    },
    Row {
        name: "damping",
        required: false,
        value: "number, s",
        default: "0",
        what: "bending moment E·I·damping at the unit rate of curvature, at least 0",
        read: |x, s, log| set(&mut x.shaft.damping, s.not_negative(log)),
    },
    Row {
        name: "mass",
        required: false,
        value: "number, kg",
        default: "that of the link before the joint, which is taken from there",
        what: "mass of the part that bends, the same all along, above 0",
        read: |x, s, log| x.shaft.mass = s.positive(log),
    },
    Row {
        name: "start",
        required: false,
        value: "3 numbers, m",
        default: "[0, 0, 0]",
        what: "where it begins, in the frame of the link before the joint",
        read: |x, s, log| x.shaft.start = s.numbers(log),
    },
    Row {
        name: "end",
        required: false,
        value: "3 numbers, m",
        default: "the joint's place",
        what: "where it ends, in the frame of the link before the joint; what is left to the joint is rigid",
        read: |x, s, log| x.shaft.end = s.numbers(log),
    },
];

/// The shafts, one for each fixed joint.
pub(crate) fn read(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<ShaftRequest> {
    let mut shafts = Vec::new();
    for entry in spot.entries(log, "a table of fixed joints") {
        let value = spot.of(entry);
        if value.node.value == crate::tree::Value::Text("off".into()) {
            continue;
        }
        let mut shaft = ShaftRequest { shaft: Shaft { joint: entry.name.clone(), ..Shaft::default() }, place: entry.at };
        value.read(KEYS, &mut shaft, log);
        shafts.push(shaft);
    }
    shafts
}
