//! What a scene looks out for: limits, contacts, dry friction, and a ball.

use std::cell::Cell;
use std::rc::Rc;

use articulated::Dynamics;
use articulated::simulate::{Action, ContactPoint, Direction, Event, Hit, Impact, SimulateError};
use articulated_core::description::JointKind;
use articulated_core::effect::{EffectId, JointEffect};
use articulated_core::model::Body;
use articulated_scene::{Watched, When};

use super::stage::{Stage, field};

/// Events of a robot, and how each of them reads.
pub(super) struct Watch<'a> {
    pub(super) events: Vec<Event<'a>>,
    /// Where its function rises through zero, where it falls; of a ball, when it is hit and when it is not.
    words: Vec<[String; 2]>,
    /// Sorts that the scene looks for and has nothing of.
    pub(super) without: Vec<Watched>,
    /// Set by a blow that ends the motion.
    pub(super) over: Rc<Cell<bool>>,
    /// Kinetic energy that the ball got, J, once it was hit.
    pub(super) ball: Rc<Cell<Option<f64>>>,
    /// Whether the ball's turn came when nothing moved towards it.
    missed: Rc<Cell<bool>>,
}

/// The links whose frames the events need.
pub(super) fn frames(stage: &Stage) -> Vec<String> {
    let contacts = stage.effects_of(EffectId::contact).filter(|_| looked_for(stage).contains(&Watched::Contacts)).map(|a| a.on.clone());
    let mut all: Vec<String> = contacts.chain(stage.prepared.scene.impact.iter().map(|i| i.link.clone())).collect();
    all.sort_unstable();
    all.dedup();
    all
}

fn looked_for(stage: &Stage) -> &[Watched] {
    stage.prepared.scene.simulation.as_ref().map_or(&[], |s| &s.events)
}

impl<'a> Watch<'a> {
    /// What the scene asks for; `frames` are the robot's, in its order.
    pub(super) fn of<R: Dynamics<f64>>(stage: &Stage, robot: &'a R, frames: &[String], start: f64) -> Result<Self, SimulateError>
    where
        R::Workspace: 'a,
    {
        let mut watch = Self {
            events: Vec::new(),
            words: Vec::new(),
            without: Vec::new(),
            over: Rc::default(),
            ball: Rc::default(),
            missed: Rc::default(),
        };
        for what in looked_for(stage) {
            let before = watch.events.len();
            match what {
                Watched::Limits => watch.limits(stage),
                Watched::Contacts => watch.contacts(stage, robot, frames)?,
                Watched::StickSlip => watch.stick_slip(stage),
            }
            if watch.events.len() == before {
                watch.without.push(*what);
            }
        }
        watch.ball(stage, robot, frames, start)?;
        Ok(watch)
    }

    /// What happened, in words.
    pub(super) fn words(&self, hit: &Hit) -> String {
        let [rising, falling] = &self.words[hit.event];
        match hit.value {
            // Of the ball, which is all that has a value.
            Some(speed) => format!("{} {speed:.4} m/s", if self.missed.get() { falling } else { rising }),
            None => if hit.direction == Direction::Falling { falling } else { rising }.clone(),
        }
    }

    fn push(&mut self, event: Event<'a>, rising: String, falling: String) {
        self.events.push(event);
        self.words.push([rising, falling]);
    }

    /// The bounds of the effect if a joint has it, else those of the file.
    fn limits(&mut self, stage: &Stage) {
        for (at, body) in freedoms(stage) {
            let own = effect_of(body, at.freedom, EffectId::limit).map(|e| (e.parameters[0], e.parameters[1]));
            let Some(bounds) = own.or_else(|| of_the_file(stage, body)) else { continue };
            let (lower, upper) = at.of_the_coordinate(bounds);
            if lower.is_finite() || upper.is_finite() {
                let event = Event::limit(body.name.clone(), at.q, lower, upper).direction(Direction::Either);
                self.push(event, format!("{} comes back from its limit", body.name), format!("{} reaches its limit", body.name));
            }
        }
    }

    fn contacts<R: Dynamics<f64>>(&mut self, stage: &Stage, robot: &'a R, frames: &[String]) -> Result<(), SimulateError>
    where
        R::Workspace: 'a,
    {
        for a in stage.effects_of(EffectId::contact) {
            let Some(frame) = frames.iter().position(|f| *f == a.on) else { continue };
            let at = ContactPoint { frame, point: a.at.xyz, normal: three(field(a, "normal")) };
            let (radius, height) = (field(a, "radius")[0], field(a, "height")[0]);
            let event = Event::contact(a.on.clone(), robot, at, radius, height)?.direction(Direction::Either);
            self.push(event, format!("{} leaves the ground", a.on), format!("{} touches the ground", a.on));
        }
        Ok(())
    }

    fn stick_slip(&mut self, stage: &Stage) {
        for (at, body) in freedoms(stage) {
            let Some(friction) = effect_of(body, at.freedom, EffectId::friction) else { continue };
            let event = Event::stick_slip(body.name.clone(), at.v, friction.parameters[1] / at.multiplier.abs());
            self.push(event, format!("{} slips", body.name), format!("{} sticks", body.name));
        }
    }

    /// What is where the ball is at the start passes it there.
    fn ball<R: Dynamics<f64>>(&mut self, stage: &Stage, robot: &'a R, frames: &[String], start: f64) -> Result<(), SimulateError>
    where
        R::Workspace: 'a,
    {
        let Some(ball) = &stage.prepared.scene.impact else { return Ok(()) };
        let Some(frame) = frames.iter().position(|f| *f == ball.link) else { return Ok(()) };
        let at = ContactPoint { frame, point: ball.point, normal: ball.normal };
        let mut blow = Impact::new(robot, at, ball.mass, ball.restitution)?;
        let (over, stop, speed, done) = (self.over.clone(), ball.stop, ball.ball_speed, Rc::new(Cell::new(false)));
        let (got, missed, mass, was) = (self.ball.clone(), self.missed.clone(), ball.mass, done.clone());
        let map = move |_: f64, q: &mut [f64], v: &mut [f64]| {
            // One ball, one blow.
            if done.replace(true) {
                return Ok(None);
            }
            over.set(stop);
            let struck = blow.strike(q, v, speed)?;
            missed.set(struck.impulse == 0.0);
            let after = struck.ball_speed;
            got.set(Some(0.5 * mass * (after * after - speed * speed)));
            Ok(Some(after))
        };
        let hits = format!("{} hits the ball, which leaves at", ball.link);
        let misses = format!("{} is not moving towards the ball, which keeps", ball.link);
        let before = move |t: f64, g: f64| if g == 0.0 && t <= start { -f64::MIN_POSITIVE } else { g };
        let event = match ball.when {
            When::Time(at) => Event::new(ball.link.clone(), move |t, _, _| before(t, t - at)),
            When::Ball(place) => {
                let (mut ws, mut out) = (robot.workspace(), vec![0.0; 12 * robot.shape().frames]);
                let (point, n) = (ball.point, ball.normal);
                // n·(p − ball) with p = x + R r
                Event::new(ball.link.clone(), move |t, q: &[f64], _| match robot.placements(&mut ws, q, &mut out) {
                    // Nobody looks for a ball that is gone.
                    _ if was.get() => -1.0,
                    Ok(()) => {
                        let x = &out[12 * frame..][..12];
                        let p = |k: usize| x[9 + k] + (0..3).map(|c| x[3 * k + c] * point[c]).sum::<f64>();
                        before(t, (0..3).map(|k| n[k] * (p(k) - place[k])).sum())
                    }
                    Err(_) => f64::NAN,
                })
            }
        };
        self.push(event.direction(Direction::Rising).action(Action::Map(Box::new(map))), hits, misses);
        Ok(())
    }
}

/// A degree of freedom: which of its joint's, the coordinate and the rate that it moves with, and how: its own coordinate is multiplier · that + offset.
struct Freedom {
    freedom: usize,
    q: usize,
    v: usize,
    multiplier: f64,
    offset: f64,
}

impl Freedom {
    /// Bounds of its own coordinate as those of the coordinate that it moves with.
    fn of_the_coordinate(&self, (lower, upper): (f64, f64)) -> (f64, f64) {
        let [a, b] = [lower, upper].map(|x| (x - self.offset) / self.multiplier);
        if self.multiplier < 0.0 { (b, a) } else { (a, b) }
    }
}

/// All degrees of freedom with their bodies, those of joints that follow others too. A quaternion's have no coordinates: they are no place of bounds.
fn freedoms(stage: &Stage) -> impl Iterator<Item = (Freedom, &Body<f64>)> {
    stage.model.bodies.iter().skip(1).flat_map(|body| {
        let (at, follow) = (&body.coordinates, body.coordinates.mimic);
        let (multiplier, offset) = follow.map_or((1.0, 0.0), |f| (f.multiplier, f.offset));
        let one = move |freedom| (Freedom { freedom, q: at.q + freedom, v: at.v + freedom, multiplier, offset }, body);
        (0..body.joint.nv()).filter(move |_| multiplier != 0.0).map(one)
    })
}

/// The bounds that the file gives a joint of one degree of freedom, those of one that follows another too.
fn of_the_file(stage: &Stage, body: &Body<f64>) -> Option<(f64, f64)> {
    let joint = stage.description.joints.iter().find(|joint| joint.name == body.name && body.joint.nv() == 1)?;
    joint.limit.filter(|_| joint.kind != JointKind::Continuous).map(|l| (l.lower, l.upper))
}

/// The effect on a degree of freedom of a body's joint.
fn effect_of(body: &Body<f64>, freedom: usize, effect: EffectId) -> Option<&JointEffect<f64>> {
    body.effects.joint.iter().find(|e| e.effect == effect && e.freedom == freedom)
}

fn three(x: &[f64]) -> [f64; 3] {
    x.try_into().unwrap_or([0.0, 0.0, 1.0])
}
