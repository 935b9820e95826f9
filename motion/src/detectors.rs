//! Detectors of a scene's events: limits, contacts, dry friction, and the ball.

use std::fmt;
use std::rc::Rc;

use articulated::Dynamics;
use articulated::simulate::{ContactPoint, Direction, Event, Hit};
use articulated_core::effect::{Applied, EffectId};
use articulated_scene::EventClass;

use crate::error::{Fault, MotionErrors};
use crate::occurrence::{EventKind, Occurrence, SceneEvent};
use crate::projectile::Projectile;
use crate::session::{Session, field};

/// Events of a scene on a robot, with the meaning of each.
pub struct Detectors<'a> {
    /// The events, for a simulation. A program may append others.
    pub events: Vec<Event<'a>>,
    /// Requested classes of events that cannot occur.
    pub unavailable: Vec<UnavailableEvent>,
    /// Kind and subject of the scene's events, which come first.
    about: Vec<(EventKind, String)>,
    ball: Rc<Projectile>,
}

/// A requested class of events that cannot occur. It is a warning, not an error, since effects may
/// be switched off.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnavailableEvent {
    /// The scene's file.
    pub file: String,
    /// The requested class.
    pub what: EventClass,
    /// The joint without usable bounds: the file's lower bound is not below the upper one, as in a
    /// `<limit>` without bounds. `None`: no joint or link has such an event.
    pub joint: Option<String>,
}

impl<'a> Detectors<'a> {
    /// The scene's events on a robot; `frames` are the names of its frames in its order. Errors,
    /// all at once: required frames that are missing, functions that the robot lacks, invalid
    /// numbers.
    pub fn new<R: Dynamics<f64>, S: AsRef<str>>(session: &Session, robot: &'a R, frames: &[S]) -> Result<Self, MotionErrors>
    where
        R::Workspace: 'a,
    {
        let mut detectors = Self { events: Vec::new(), unavailable: Vec::new(), about: Vec::new(), ball: Rc::default() };
        let mut faults = Vec::new();
        for what in session.requested_events() {
            let before = (detectors.events.len(), faults.len(), detectors.unavailable.len());
            match what {
                EventClass::Limits => detectors.limits(session),
                EventClass::Contacts => detectors.contacts(session, robot, frames, &mut faults),
                EventClass::StickSlip => detectors.stick_slip(session),
            }
            if (detectors.events.len(), faults.len(), detectors.unavailable.len()) == before {
                detectors.unavailable.push(UnavailableEvent { file: session.scene.file.clone(), what: *what, joint: None });
            }
        }
        detectors.hit(session, robot, frames, &mut faults);
        MotionErrors::none(&session.scene.file, faults)?;
        Ok(detectors)
    }

    /// The occurrence of a hit; an event appended by the program has only its name.
    pub fn occurrence(&self, hit: &Hit) -> Occurrence {
        let Some((kind, on)) = self.about.get(hit.event) else {
            return Occurrence { t: hit.t, what: hit.name.to_string(), about: None, ball_speed: None };
        };
        let begins = if *kind == EventKind::Ball { !self.ball.missed.get() } else { hit.direction == Direction::Falling };
        Occurrence::of(hit.t, SceneEvent { kind: *kind, on: on.clone(), begins }, hit.value)
    }

    /// Returns a closure: whether an impact ended the motion; call it after each step. It does not
    /// borrow the detectors, whose events the simulation borrows during the run.
    pub fn over(&self) -> impl Fn() -> bool + use<> {
        let ball = self.ball.clone();
        move || ball.ends.get()
    }

    /// Kinetic energy gained by the ball, J, once it is hit.
    pub fn ball_energy(&self) -> Option<f64> {
        self.ball.energy.get()
    }

    /// Resets the ball for another run.
    pub fn reset(&mut self) {
        self.ball.reset();
    }

    fn push(&mut self, event: Event<'a>, kind: EventKind, on: &str) {
        self.events.push(event);
        self.about.push((kind, on.to_owned()));
    }

    /// The bounds of the effect if a joint has it, else those of the file.
    fn limits(&mut self, session: &Session) {
        for at in session.freedoms() {
            let (name, Some((lower, upper))) = (session.name_of(&at), session.bounds(&at)) else { continue };
            if lower >= upper {
                self.unavailable.push(UnavailableEvent { file: session.scene.file.clone(), what: EventClass::Limits, joint: Some(name) });
                continue;
            }
            let kinds = [EventKind::LowerLimit, EventKind::UpperLimit];
            for (kind, (lower, upper)) in kinds.into_iter().zip([(lower, f64::INFINITY), (f64::NEG_INFINITY, upper)]) {
                if lower.is_finite() || upper.is_finite() {
                    let ([last, _], own) = (at.own.last(), at.own.clone());
                    let x = move |q: &[f64]| own.coordinate(q).unwrap_or(f64::NAN);
                    let event = Event::limit_of(name.as_str(), last, x, (lower, upper)).direction(Direction::Either);
                    self.push(event, kind, &name);
                }
            }
        }
        for (name, at, upper) in session.cones() {
            self.push(Event::cone(name, at, upper).direction(Direction::Either), EventKind::UpperLimit, name);
        }
    }

    fn contacts<R: Dynamics<f64>, S: AsRef<str>>(&mut self, session: &Session, robot: &'a R, frames: &[S], faults: &mut Vec<Fault>)
    where
        R::Workspace: 'a,
    {
        for (kind, a) in contacts(session) {
            let Some(frame) = frame_of(&a.on, frames) else {
                faults.push(no_frame("effects.contact", &a.on, frames));
                continue;
            };
            let at = ContactPoint { frame, point: a.at.xyz, normal: field(a, "normal").try_into().unwrap_or([f64::NAN; 3]) };
            match Event::contact(a.on.clone(), robot, at, number(a, "radius"), number(a, "height")) {
                Ok(event) => self.push(event.direction(Direction::Either), kind, &a.on),
                Err(error) => faults.extend(Fault::of(error)),
            }
        }
    }

    fn stick_slip(&mut self, session: &Session) {
        for at in session.freedoms() {
            let Some([_, speed, ..]) = at.effect(EffectId::friction).map(|friction| friction.parameters.as_slice()) else { continue };
            let name = session.name_of(&at);
            let ([_, last], own) = (at.own.last(), at.own.clone());
            let event = Event::stick_slip_of(name.as_str(), last, move |q, v| own.rate(q, v), *speed);
            self.push(event, EventKind::StickSlip, &name);
        }
    }

    fn hit<R: Dynamics<f64>, S: AsRef<str>>(&mut self, session: &Session, robot: &'a R, frames: &[S], faults: &mut Vec<Fault>)
    where
        R::Workspace: 'a,
    {
        let Some(request) = &session.scene.impact else { return };
        let Some(frame) = frame_of(&request.link, frames) else { return faults.push(no_frame("impact.link", &request.link, frames)) };
        match self.ball.event(request, robot, frame) {
            Ok(event) => self.push(event, EventKind::Ball, &request.link),
            Err(error) => faults.extend(Fault::of(error)),
        }
    }
}

/// The contacts, each with its index among those of its link.
fn contacts(session: &Session) -> impl Iterator<Item = (EventKind, &Applied)> {
    let all = move || session.effects_of(EffectId::contact);
    all().enumerate().map(move |(k, a)| {
        let number = 1 + all().take(k).filter(|other| other.on == a.on).count();
        (EventKind::Contact { number, of: all().filter(|other| other.on == a.on).count() }, a)
    })
}

/// The index of a link's frame.
fn frame_of<S: AsRef<str>>(link: &str, frames: &[S]) -> Option<usize> {
    frames.iter().position(|name| name.as_ref() == link)
}

/// The fault of an event on a link without a frame.
fn no_frame<S: AsRef<str>>(key: &'static str, link: &str, frames: &[S]) -> Fault {
    Fault::NoFrame { key, link: link.to_owned(), frames: frames.iter().map(|name| name.as_ref().to_owned()).collect() }
}

/// A field of one number; NaN if it is missing.
fn number(applied: &Applied, name: &str) -> f64 {
    field(applied, name).first().copied().unwrap_or(f64::NAN)
}

impl fmt::Display for UnavailableEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(joint) = &self.joint {
            let (file, name) = (&self.file, self.what.name());
            return write!(
                f,
                "{file}: simulation.events: {name:?}: found joint {joint:?} without a lower bound below the upper one, expected one; not looked for"
            );
        }
        let expected = match self.what {
            EventClass::Limits => "a joint with bounds",
            EventClass::Contacts => "an effect contact of the scene",
            EventClass::StickSlip => "an effect friction of the scene",
        };
        let (file, name) = (&self.file, self.what.name());
        write!(f, "{file}: simulation.events: found {name:?}, expected {expected}; nothing to look for")
    }
}
