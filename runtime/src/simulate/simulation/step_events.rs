//! Outputs and events of a step, and the actions of events on the state.

use super::{Outcome, Run, Simulation};
use crate::simulate::curve::Curve;
use crate::simulate::event::detectors::Zero;
use crate::simulate::integrator::Start;
use crate::simulate::step_control::rounding;
use crate::simulate::{Action, Direction, Event, Hit, SimulateError, StateError};

/// The curve of the step from the state to `$t`: of the parts of a simulation that it takes, so
/// that others stay free.
macro_rules! curve {
    ($of:ident, $t:ident) => {
        Curve {
            method: &mut *$of.method,
            start: Start { t: $of.t, h: $t - $of.t, y: &$of.y, f: &$of.f },
            end: &$of.end,
            point: &mut $of.point,
        }
    };
}

impl Simulation<'_> {
    /// Outputs and events of the step to t, which is not yet the state. If the step is cut short,
    /// `end` is at the cut. Returns the time up to which the step counts, and its outcome.
    pub(super) fn look(&mut self, run: &mut Run, t: f64) -> Result<(f64, Outcome), SimulateError> {
        let (cut, outcome) = if run.events.is_empty() { (1.0, Outcome::GoOn) } else { self.events(run, t)? };
        let stop = if cut < 1.0 { self.t + cut * (t - self.t) } else { t };
        self.outputs(run, t, (cut, stop))?;
        if cut < 1.0 {
            curve!(self, t).at(&mut self.system, cut)?;
            self.end.copy_from_slice(&self.point.y);
        }
        Ok((stop, outcome))
    }

    /// Records the events of the step to t. Returns the part of it after which one of them cuts it
    /// short, and its outcome.
    fn events(&mut self, run: &mut Run, t: f64) -> Result<(f64, Outcome), SimulateError> {
        let (start, h) = (self.t, t - self.t);
        let tolerance = self.settings.event_tolerance.max(rounding(t) / 4.0) / h;
        let mut curve = curve!(self, t);
        curve.prepare(&mut self.system, run.control)?;
        self.detectors.scan(run.events, &mut self.system, &mut curve, (tolerance, t >= self.settings.end))?;
        let (mut cut, mut outcome, first) = (1.0, Outcome::GoOn, run.recording.events.len());
        for &Zero { theta, event, direction } in &self.detectors.zeros {
            // Events at the same time as the first that cuts the step short happen too; later ones
            // are found again, if they still occur.
            if !matches!(outcome, Outcome::GoOn) && theta > cut + tolerance {
                break;
            }
            run.recording.events.push(Hit { event, name: run.events[event].name.clone(), t: start + theta * h, direction, value: None });
            self.system.counts.events += 1;
            let next = match (&run.events[event].action, &outcome) {
                (Action::Record, _) | (_, Outcome::Stopped(_)) => continue,
                (Action::Stop, _) => Outcome::Stopped(event),
                (Action::Map(_), _) => Outcome::Mapped,
            };
            if matches!(outcome, Outcome::GoOn) {
                cut = theta;
                // So do events found a moment before it.
                self.progress.cut = first + self.detectors.zeros.iter().take_while(|zero| zero.theta < cut - tolerance).count();
            }
            outcome = next;
        }
        Ok((cut, outcome))
    }

    /// Records the requested output up to the cut of the step to t, given as a fraction and a time.
    fn outputs(&mut self, run: &mut Run, t: f64, (cut, stop): (f64, f64)) -> Result<(), SimulateError> {
        let (start, h) = (self.t, t - self.t);
        let Some(times) = &mut self.progress.times else { return Ok(()) };
        let mut curve = curve!(self, t);
        loop {
            let next = times.next(&self.settings);
            if next > stop + rounding(stop) {
                return Ok(());
            }
            if next > self.settings.start {
                let theta = if next >= t - rounding(t) { 1.0 } else { ((next - start) / h).min(cut) };
                if theta < 1.0 {
                    curve.prepare(&mut self.system, run.control)?;
                }
                curve.at(&mut self.system, theta)?;
                curve.point.t = next;
                self.known.record(&mut self.system, run.control, curve.point, run.recording)?;
            }
            times.advance();
            if next >= self.settings.end {
                return Ok(());
            }
        }
    }

    /// Runs the maps of the events that cut the step short, if there are some.
    pub(super) fn map(&mut self, run: &mut Run) -> Result<bool, SimulateError> {
        let (mut mapped, nv) = (false, self.shape.nv);
        for hit in &run.recording.events[self.progress.cut..] {
            let left = (run.events[hit.event].function)(self.t, &self.system.origin, &self.y[nv..2 * nv]);
            self.detectors.set_left(hit.event, left);
        }
        for hit in self.progress.cut..run.recording.events.len() {
            mapped |= self.map_by(run, hit)?;
        }
        Ok(mapped)
    }

    fn map_by(&mut self, run: &mut Run, hit: usize) -> Result<bool, SimulateError> {
        let (nv, event) = (self.shape.nv, run.recording.events[hit].event);
        let Event { action: Action::Map(map), name, .. } = &mut run.events[event] else { return Ok(false) };
        // The same event again at the same time: it would never end. Others may happen at one time,
        // but not for ever.
        let again = self.t - self.progress.last_map.1 <= 2.0 * self.settings.event_tolerance.max(rounding(self.t));
        self.progress.chatter = if again { self.progress.chatter + 1 } else { 0 };
        if again && (self.progress.last_map.0 == event || self.progress.chatter > 100) {
            return Err(SimulateError::Chattering { t: self.t, event: name.to_string() });
        }
        self.progress.last_map = (event, self.t);
        self.point.q.copy_from_slice(&self.system.origin);
        self.v.copy_from_slice(&self.y[nv..2 * nv]);
        let before = self.known.energy(&mut self.system, &self.point.q, &self.v)?;
        run.recording.events[hit].value = map(self.t, &mut self.point.q, &mut self.v)?;
        StateError::none(self.system.manifold.wrong_state(&self.system.robot, &self.point.q, &self.v))?;
        self.system.origin.copy_from_slice(&self.point.q);
        self.y[nv..2 * nv].copy_from_slice(&self.v);
        self.renormalise()?;
        self.point.q.copy_from_slice(&self.system.origin);
        self.known.from_events += self.known.energy(&mut self.system, &self.point.q, &self.v)? - before;
        Ok(true)
    }

    /// The side of zero of each event from here on. For events that have just happened, the side a
    /// moment later, unless a map has taken the function away from zero. A function that a map
    /// leaves at rest at zero is on the side it came from: the event happens again if it goes on.
    pub(super) fn take_sides(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        const MOMENT: f64 = 1e-9;
        let nv = self.shape.nv;
        for e in 0..run.events.len() {
            let here = (run.events[e].function)(self.t, &self.system.origin, &self.y[nv..2 * nv]);
            let mut value = here;
            let fired = run.recording.events[self.progress.cut..].iter().find(|hit| hit.event == e).map(|hit| hit.direction);
            let arriving = run.events[e].arriving.filter(|_| here == 0.0);
            if fired.is_some() || here == 0.0 {
                let step = self.point.y.as_mut_slice();
                step[..nv].iter_mut().zip(&self.y[nv..2 * nv]).for_each(|(u, v)| *u = MOMENT * v);
                self.system.configuration(&step[..nv], &mut self.point.q)?;
                let rates = self.y[nv..2 * nv].iter().zip(&self.f[nv..2 * nv]);
                self.v.iter_mut().zip(rates).for_each(|(out, (v, a))| *out = v + MOMENT * a);
                let change = (run.events[e].function)(self.t + MOMENT, &self.point.q, &self.v) - here;
                // More than the error of the search, and more than a moment changes.
                let away = here.abs() > (2.0 * self.detectors.left(e)).max(change.abs());
                value = if away { here } else { change };
            }
            value = match (fired, arriving) {
                (Some(direction), _) if value == 0.0 => before(direction),
                (None, Some(direction)) => before(direction),
                _ => value,
            };
            self.detectors.set_side(e, value);
        }
        Ok(())
    }
}

/// The side from which a function goes this way.
fn before(direction: Direction) -> f64 {
    match direction {
        Direction::Rising => -1.0,
        Direction::Falling => 1.0,
        Direction::Either => 0.0,
    }
}
