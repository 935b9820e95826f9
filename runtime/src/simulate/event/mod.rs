//! Events: zeros of functions of time and state, at times unknown beforehand.

pub(crate) mod detectors;
mod impact;

use std::sync::Arc;

use articulated_core::algorithm::Shape;
use articulated_core::dynamics::Dynamics;
use articulated_core::effect::unit;
use articulated_core::spatial::screw::Quaternion;

pub use impact::{Impact, Struck};

use super::{SimulateError, StateError};

/// A joint slides from this many times the smoothing speed s of its friction on: there μ v/√(v² +
/// s²) is 0.995 of sliding friction μ.
pub const SLIDING: f64 = 10.0;

/// Direction in which an event's function crosses zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// From below to above.
    Rising,
    /// From above to below.
    Falling,
    /// Both.
    #[default]
    Either,
}

/// A function of time and state, g(t, q, v).
type Function<'a> = dyn FnMut(f64, &[f64], &[f64]) -> f64 + 'a;

/// A map of the state at time t: it may change q `[nq]` and v `[nv]`, and may return a number to
/// record.
pub type Map<'a> = dyn FnMut(f64, &mut [f64], &mut [f64]) -> Result<Option<f64>, SimulateError> + 'a;

/// The action at an event; the event is recorded in any case.
#[derive(Default)]
pub enum Action<'a> {
    /// Only a record.
    #[default]
    Record,
    /// The motion ends.
    Stop,
    /// The state is mapped, and the motion goes on from there.
    Map(Box<Map<'a>>),
}

/// A contact point of the robot with its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Number of its frame among the robot's.
    pub frame: usize,
    /// Its position in the frame, m.
    pub point: [f64; 3],
    /// Normal of the touched surface, in world axes, of any non-zero length.
    pub normal: [f64; 3],
}

/// An event at the zeros of g(t, q, v).
///
/// g is evaluated eleven times a step on the integrator's curve, at its ends and between. A zero
/// between two of these points is found if g changes its sign, and a pair of zeros if |g| has a
/// least value among them. A pair is missed only if it comes and goes between two neighbours
/// without |g| falling towards them: less than an eighth of a step, which `max_step` can bound.
pub struct Event<'a> {
    pub(crate) name: Arc<str>,
    /// The entry of q or v that it depends on, if it is one.
    about: Option<About>,
    /// Lower and upper bound of an empty range.
    inverted: Option<(f64, f64)>,
    pub(crate) direction: Direction,
    /// Crossing direction assumed when the guard is zero at the start or after a state reset;
    /// `None`: determined from the next sample.
    pub(crate) arriving: Option<Direction>,
    pub(crate) action: Action<'a>,
    pub(crate) function: Box<Function<'a>>,
}

/// A number of the state.
#[derive(Clone, Copy)]
enum About {
    Coordinate(usize),
    Rate(usize),
}

impl<'a> Event<'a> {
    /// An event where g(t, q, v) goes through zero, either way; it is recorded.
    pub fn new(name: impl Into<String>, g: impl FnMut(f64, &[f64], &[f64]) -> f64 + 'a) -> Self {
        Self {
            name: Arc::from(name.into()),
            about: None,
            inverted: None,
            direction: Direction::Either,
            arriving: None,
            action: Action::Record,
            function: Box::new(g),
        }
    }

    /// Only crossings in this direction.
    #[must_use]
    pub fn direction(mut self, direction: Direction) -> Self {
        self.direction = direction;
        self
    }

    /// A guard that is exactly zero at the start counts as a crossing in this direction if it
    /// continues so: it is assumed to come from the other side. Without this, such a zero is no
    /// event in either direction, so a motion may start on a section to which it returns.
    /// [`Event::limit`], [`Event::cone`] and [`Event::contact`] arrive falling.
    #[must_use]
    pub fn arriving(mut self, direction: Direction) -> Self {
        self.arriving = Some(direction);
        self
    }

    /// The action.
    #[must_use]
    pub fn action(mut self, action: Action<'a>) -> Self {
        self.action = action;
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Coordinate i of q leaves the limits: g = (q − lower)(upper − q)/(upper − lower), falling;
    /// with one bound infinite the distance from the other.
    pub fn limit(name: impl Into<String>, i: usize, lower: f64, upper: f64) -> Self {
        Self::limit_of_sum(name, vec![(i, 1.0)], 0.0, (lower, upper))
    }

    /// As [`Event::limit`], of a joint that follows others: x = Σ multiplier · q + offset. `terms`:
    /// the indices in q, and the multipliers.
    pub fn limit_of_sum(name: impl Into<String>, terms: Vec<(usize, f64)>, offset: f64, (lower, upper): (f64, f64)) -> Self {
        let last = terms.iter().map(|(i, _)| *i).max();
        Self::limit_of(name, last, move |q| sum(q, &terms) + offset, (lower, upper))
    }

    /// As [`Event::limit`], of a coordinate x(q) `[nq]` that depends on the entry `about` of q and
    /// on those before, if on any: one of a joint that follows another by a polynomial.
    pub fn limit_of(name: impl Into<String>, about: Option<usize>, x: impl Fn(&[f64]) -> f64 + 'a, (lower, upper): (f64, f64)) -> Self {
        let g = move |_: f64, q: &[f64], _: &[f64]| {
            let x = x(q);
            match (lower.is_finite(), upper.is_finite()) {
                // Halves: the distance of the two may be beyond the range of numbers.
                (true, true) => (x - lower) * (((upper - x) / 2.0) / (upper / 2.0 - lower / 2.0)),
                (true, false) => x - lower,
                _ => upper - x,
            }
        };
        // NaN is no bound.
        let inverted = if lower < upper { None } else { Some((lower, upper)) };
        Self { about: about.map(About::Coordinate), inverted, ..Self::new(name, g).falling() }
    }

    /// The rotation of the unit quaternion (x, y, z, w) at coordinate i of q is by the angle
    /// `upper`, rad: g = upper − 2 atan2(|(x, y, z)|, |w|), falling.
    pub fn cone(name: impl Into<String>, i: usize, upper: f64) -> Self {
        let g = move |_: f64, q: &[f64], _: &[f64]| upper - Quaternion::from_array([0, 1, 2, 3].map(|k| number(q, i + k))).angle();
        Self { about: Some(About::Coordinate(i + 3)), ..Self::new(name, g).falling() }
    }

    /// Rate i of v starts to slide (rising) or stops sliding (falling): |v| passes [`SLIDING`]
    /// times the speed at which the friction law is smoothed. Below that the joint creeps under its
    /// load.
    pub fn stick_slip(name: impl Into<String>, i: usize, speed: f64) -> Self {
        Self::stick_slip_of_sum(name, vec![(i, 1.0)], speed)
    }

    /// As [`Event::stick_slip`], of a joint that follows others: its rate is Σ multiplier · v.
    /// `terms`: the indices in v, and the multipliers.
    pub fn stick_slip_of_sum(name: impl Into<String>, terms: Vec<(usize, f64)>, speed: f64) -> Self {
        let last = terms.iter().map(|(i, _)| *i).max();
        Self::stick_slip_of(name, last, move |_, v| sum(v, &terms), speed)
    }

    /// As [`Event::stick_slip`], of a rate x(q, v) that depends on the entry `about` of v and on
    /// those before, if on any: one of a joint that follows another by a polynomial.
    pub fn stick_slip_of(name: impl Into<String>, about: Option<usize>, x: impl Fn(&[f64], &[f64]) -> f64 + 'a, speed: f64) -> Self {
        let g = move |_: f64, q: &[f64], v: &[f64]| x(q, v).abs() - SLIDING * speed;
        Self { about: about.map(About::Rate), ..Self::new(name, g) }
    }

    /// Errors for a robot of this shape: an index out of range, or bounds that exclude every value.
    pub(crate) fn wrong(&self, shape: Shape) -> impl Iterator<Item = StateError> {
        let event = || self.name.to_string();
        let about = self.about.map(|about| match about {
            About::Coordinate(i) => ("q", i, shape.nq),
            About::Rate(i) => ("v", i, shape.nv),
        });
        let beyond = about.filter(|(_, index, length)| index >= length);
        let beyond = beyond.map(|(vector, index, length)| StateError::Beyond { event: event(), vector, index, length });
        let bounds = self.inverted.map(|(lower, upper)| StateError::Bounds { event: event(), lower, upper });
        beyond.into_iter().chain(bounds)
    }

    /// A sphere of this radius, m, about a point touches the plane nᵀx = height, m, of the world
    /// frame, n its normal made of length one: its distance falls through zero.
    ///
    /// The robot needs the function `placements`. Errors: all invalid numbers, at once.
    pub fn contact<R: Dynamics<f64>>(
        name: impl Into<String>,
        robot: &'a R,
        at: ContactPoint,
        radius: f64,
        height: f64,
    ) -> Result<Self, SimulateError>
    where
        R::Workspace: 'a,
    {
        let ContactPoint { frame, point, normal } = at;
        let finite = [("radius", radius, "finite, m"), ("height", height, "finite, m")];
        let values = finite.map(|(what, found, right)| value(what, found, right, true));
        StateError::none(wrong_place(robot, &at).chain(values.into_iter().flatten()))?;
        let normal = unit(normal).unwrap_or(normal);
        let mut place = Points::new(robot, frame)?;
        let g = move |_: f64, q: &[f64], _: &[f64]| match place.point(q, point) {
            Ok(x) => x.iter().zip(normal).map(|(x, n)| x * n).sum::<f64>() - height - radius,
            Err(_) => f64::NAN, // it was tried when this was made
        };
        Ok(Self::new(name, g).falling())
    }

    /// Its distance from something is g.
    fn falling(self) -> Self {
        self.direction(Direction::Falling).arriving(Direction::Falling)
    }
}

/// For messages about a normal: its length, or 1 if it has a direction but its length overflows.
fn length(normal: [f64; 3]) -> f64 {
    unit(normal).map_or_else(|| normal.iter().fold(0.0_f64, |length, n| length.hypot(*n)), |_| 1.0)
}

/// A number that is not finite, or not otherwise `fit`.
fn value(what: &'static str, found: f64, right: &'static str, fit: bool) -> Option<StateError> {
    (!fit || !found.is_finite()).then_some(StateError::Value { what, found, right: right.into() })
}

/// Errors for this robot.
fn wrong_place<R: Dynamics<f64>>(robot: &R, at: &ContactPoint) -> impl Iterator<Item = StateError> {
    let (frames, length) = (robot.shape().frames, length(at.normal));
    let frame = (at.frame >= frames).then_some(StateError::Frame { index: at.frame, frames });
    let point = ["x of the point", "y of the point", "z of the point"].into_iter().zip(at.point);
    let point = point.filter_map(|(what, x)| value(what, x, "finite, m", true));
    let normal = value("length of the normal", length, "finite, greater than 0", length > 0.0);
    frame.into_iter().chain(point).chain(normal)
}

/// Number i, which is there ([`Event::wrong`]).
fn number(x: &[f64], i: usize) -> f64 {
    x.get(i).copied().unwrap_or(f64::NAN)
}

/// Σ multiplier · x.
fn sum(x: &[f64], terms: &[(usize, f64)]) -> f64 {
    terms.iter().map(|(i, multiplier)| multiplier * number(x, *i)).sum()
}

/// Where points of a frame are.
struct Points<'r, R: Dynamics<f64>> {
    robot: &'r R,
    ws: R::Workspace,
    placements: Vec<f64>,
    frame: usize,
}

impl<'r, R: Dynamics<f64>> Points<'r, R> {
    /// For an existing frame ([`wrong_place`]).
    fn new(robot: &'r R, frame: usize) -> Result<Self, SimulateError> {
        let shape = robot.shape();
        let mut points = Self { robot, ws: robot.workspace(), placements: vec![0.0; 12 * shape.frames], frame };
        points.point(&vec![0.5; shape.nq], [0.0; 3])?;
        Ok(points)
    }

    /// The point in the world frame, m.
    fn point(&mut self, q: &[f64], point: [f64; 3]) -> Result<[f64; 3], SimulateError> {
        self.robot.placements(&mut self.ws, q, &mut self.placements)?;
        let x = &self.placements[12 * self.frame..12 * (self.frame + 1)];
        let turned = turn(x, point);
        Ok([0, 1, 2].map(|k| x[9 + k] + turned[k]))
    }

    /// From axes of the frame to world axes, as of the last call of `point`.
    fn turned(&self, vector: [f64; 3]) -> [f64; 3] {
        turn(&self.placements[12 * self.frame..], vector)
    }
}

/// R v, the rotation row by row.
fn turn(r: &[f64], v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| r[3 * k] * v[0] + r[3 * k + 1] * v[1] + r[3 * k + 2] * v[2])
}
