//! Finding events on the curve of a step.

use super::{Direction, Event};
use crate::simulate::SimulateError;
use crate::simulate::curve::Curve;
use crate::simulate::system::System;

/// Sample points of a step: eighths, and closer at its ends, to catch an extremum there.
const PLACES: [f64; 11] = [0.0, 1.0 / 64.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 63.0 / 64.0, 1.0];

/// A zero found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Zero {
    pub(crate) theta: f64,
    pub(crate) event: usize,
    pub(crate) direction: Direction,
}

/// State of event detection between steps, and scratch space for one step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Detectors {
    /// Side of zero of each event's function: ±1, or 0 while unknown.
    side: Vec<f64>,
    /// Residual of each event's function at its last zero.
    left: Vec<f64>,
    /// Values, `[places][events]`.
    values: Vec<f64>,
    /// Zeros of the step, in order.
    pub(crate) zeros: Vec<Zero>,
}

impl Detectors {
    /// Starts a motion with this number of events.
    pub(crate) fn begin(&mut self, events: usize) {
        self.side.clear();
        self.side.resize(events, 0.0);
        self.left.clear();
        self.left.resize(events, 0.0);
        self.values.resize(PLACES.len() * events, 0.0);
        self.zeros.clear();
        self.zeros.reserve(4 * PLACES.len() * events);
    }

    /// The side of event `e` from now on.
    pub(crate) fn set_side(&mut self, e: usize, value: f64) {
        self.side[e] = sign(value);
    }

    /// Residual of the function of event `e` at its zero.
    pub(crate) fn set_left(&mut self, e: usize, value: f64) {
        self.left[e] = value.abs();
    }

    /// As it was set, without its sign.
    pub(crate) fn left(&self, e: usize) -> f64 {
        self.left[e]
    }

    /// All zeros of a step, in `zeros`; its curve is ready. A zero at the end belongs to the next
    /// step, if it is not the `last`.
    pub(crate) fn scan(
        &mut self,
        events: &mut [Event],
        system: &mut System<'_>,
        curve: &mut Curve<'_>,
        (tolerance, last): (f64, bool),
    ) -> Result<(), SimulateError> {
        self.zeros.clear();
        let count = events.len();
        for (place, theta) in PLACES.into_iter().enumerate() {
            for e in 0..count {
                self.values[place * count + e] = value(events, e, system, curve, theta, e == 0)?;
            }
        }
        let mut search = Search { events, system, curve, tolerance };
        for e in 0..count {
            self.zeros_of(e, &mut search, last)?;
        }
        self.zeros.sort_unstable_by(|a, b| a.theta.total_cmp(&b.theta).then(a.event.cmp(&b.event)));
        Ok(())
    }

    /// The zeros of one event, between the places at which its function is known.
    fn zeros_of(&mut self, e: usize, search: &mut Search<'_, '_, '_, '_>, last: bool) -> Result<(), SimulateError> {
        let count = search.events.len();
        let (mut side, mut from) = (self.side[e], 0);
        for place in 0..PLACES.len() {
            let g = |place: usize| self.values[place * count + e];
            // The side at the start of the step is known: rounding may contradict it.
            let now = if place == 0 && side != 0.0 { side } else { sign(g(place)) };
            if now != 0.0 && side != 0.0 && now != side {
                let theta = search.zero(e, (PLACES[from], side), (PLACES[place], now))?;
                push(&mut self.zeros, search.events, e, theta, now);
            } else if place >= 2 && now != 0.0 && [1, 2].iter().all(|k| sign(g(place - k)) == now) {
                let [a, b, c] = [g(place - 2), g(place - 1), g(place)].map(f64::abs);
                let beyond = if b < a && b <= c { search.beyond(e, (PLACES[place - 2], PLACES[place]), now)? } else { None };
                if let Some(middle) = beyond {
                    let first = search.zero(e, (PLACES[place - 2], now), (middle, -now))?;
                    let second = search.zero(e, (middle, -now), (PLACES[place], now))?;
                    push(&mut self.zeros, search.events, e, first, -now);
                    push(&mut self.zeros, search.events, e, second, now);
                }
            }
            if now != 0.0 {
                (side, from) = (now, place);
            }
        }
        // A function that was at zero before does not reach it.
        let [before, end] = [2, 1].map(|back| self.values[(PLACES.len() - back) * count + e]);
        if last && side != 0.0 && end == 0.0 && before != 0.0 {
            push(&mut self.zeros, search.events, e, 1.0, -side);
        }
        self.side[e] = side;
        Ok(())
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn push(zeros: &mut Vec<Zero>, events: &[Event], event: usize, theta: f64, to: f64) {
    let direction = if to > 0.0 { Direction::Rising } else { Direction::Falling };
    if [Direction::Either, direction].contains(&events[event].direction) {
        zeros.push(Zero { theta, event, direction });
    }
}

/// g of event e at θ; the point is computed where `fresh`.
fn value(
    events: &mut [Event],
    e: usize,
    system: &mut System<'_>,
    curve: &mut Curve<'_>,
    theta: f64,
    fresh: bool,
) -> Result<f64, SimulateError> {
    let nv = system.nv();
    if fresh {
        curve.at(system, theta)?;
    }
    let point = &*curve.point;
    let g = (events[e].function)(point.t, &point.q, &point.y[nv..2 * nv]);
    let nowhere = || SimulateError::NotFinite { t: point.t, what: "event", index: vec![e], names: vec![events[e].name.to_string()] };
    if g.is_nan() { Err(nowhere()) } else { Ok(g) }
}

struct Search<'s, 'e, 'c, 'r> {
    events: &'s mut [Event<'e>],
    system: &'s mut System<'r>,
    curve: &'s mut Curve<'c>,
    /// In units of the step.
    tolerance: f64,
}

impl Search<'_, '_, '_, '_> {
    fn at(&mut self, e: usize, theta: f64) -> Result<f64, SimulateError> {
        value(self.events, e, self.system, self.curve, theta, true)
    }

    /// Where g goes from one side to the other: halving, and the false position of Anderson &
    /// Björck (BIT 13, 1973) where that is faster.
    fn zero(&mut self, e: usize, (mut a, side): (f64, f64), (mut b, _): (f64, f64)) -> Result<f64, SimulateError> {
        let (mut ga, mut gb) = (self.at(e, a)?, self.at(e, b)?);
        let (mut last, mut halve) = (0.0, ga * gb >= 0.0);
        while b - a > self.tolerance {
            let width = b - a;
            let guess = if halve { 0.5 * (a + b) } else { (a * gb - b * ga) / (gb - ga) };
            let x = if guess > a && guess < b { guess } else { 0.5 * (a + b) };
            if x <= a || x >= b {
                break;
            }
            let g = self.at(e, x)?;
            if g == 0.0 {
                return Ok(x);
            }
            if sign(g) == side {
                let factor = 1.0 - g / ga;
                if last == 1.0 {
                    gb *= if factor > 0.0 { factor } else { 0.5 };
                }
                (a, ga, last) = (x, g, 1.0);
            } else {
                let factor = 1.0 - g / gb;
                if last == -1.0 {
                    ga *= if factor > 0.0 { factor } else { 0.5 };
                }
                (b, gb, last) = (x, g, -1.0);
            }
            // The false position creeps up from one side: then the other end is brought in.
            halve = !halve && b - a > 0.5 * width || sign(ga) == sign(gb);
        }
        Ok(if self.at(e, a)?.abs() < self.at(e, b)?.abs() { a } else { b })
    }

    /// A place in (a, b) where g is not on this side, if the least of |g| leads to one: golden
    /// section (Kiefer 1953).
    fn beyond(&mut self, e: usize, (mut a, mut b): (f64, f64), side: f64) -> Result<Option<f64>, SimulateError> {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut inner = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)];
        let mut g = [side * self.at(e, inner[0])?, side * self.at(e, inner[1])?];
        while b - a > self.tolerance.max(1e-9) {
            if let Some(k) = [0, 1].into_iter().find(|&k| g[k] < 0.0) {
                return Ok(Some(inner[k]));
            }
            if g[0] < g[1] {
                b = inner[1];
                inner = [b - GOLDEN * (b - a), inner[0]];
                g = [side * self.at(e, inner[0])?, g[0]];
            } else {
                a = inner[0];
                inner = [inner[1], a + GOLDEN * (b - a)];
                g = [g[1], side * self.at(e, inner[1])?];
            }
        }
        Ok(None)
    }
}
