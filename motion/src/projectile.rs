//! The ball of a scene, which is hit once.

use std::cell::Cell;
use std::rc::Rc;

use articulated::Dynamics;
use articulated::effect::unit;
use articulated::simulate::{Action, ContactPoint, Direction, Event, Impact, SimulateError};
use articulated_scene::{Impact as ImpactRequest, When};

/// State of the ball.
#[derive(Debug, Default)]
pub(crate) struct Projectile {
    /// Its event has occurred.
    spent: Cell<bool>,
    /// The motion ends with its event.
    pub(crate) ends: Cell<bool>,
    /// The link did not move towards the ball at its event.
    pub(crate) missed: Cell<bool>,
    /// Kinetic energy gained, J, once it is hit.
    pub(crate) energy: Cell<Option<f64>>,
}

impl Projectile {
    /// Back to the state before the run.
    pub(crate) fn reset(&self) {
        [&self.spent, &self.ends, &self.missed].into_iter().for_each(|cell| cell.set(false));
        self.energy.set(None);
    }

    /// The event of the impact, on the frame of this index. A point that starts at the ball hits it
    /// at the start.
    pub(crate) fn event<'a, R: Dynamics<f64>>(
        self: &Rc<Self>,
        request: &ImpactRequest,
        robot: &'a R,
        frame: usize,
    ) -> Result<Event<'a>, SimulateError>
    where
        R::Workspace: 'a,
    {
        let action = self.blow(request, robot, frame)?;
        let event = match request.when {
            When::Time(at) => Event::new(request.link.clone(), move |t, _, _| t - at),
            When::Ball(place) => {
                let (mut ws, mut out) = (robot.workspace(), vec![0.0; 12 * robot.shape().frames]);
                // `Impact::new` has checked that the normal has a direction.
                let (point, n, ball) = (request.point, unit(request.normal).unwrap_or(request.normal), self.clone());
                // n·(p − ball) with p = x + R r
                Event::new(request.link.clone(), move |_, q: &[f64], _| match robot.placements(&mut ws, q, &mut out) {
                    // A spent ball triggers no further event.
                    _ if ball.spent.get() => -1.0,
                    Ok(()) => {
                        let x = &out[12 * frame..][..12];
                        let p = |k: usize| x[9 + k] + (0..3).map(|c| x[3 * k + c] * point[c]).sum::<f64>();
                        (0..3).map(|k| n[k] * (p(k) - place[k])).sum()
                    }
                    Err(_) => f64::NAN, // it was tried when the blow was made
                })
            }
        };
        Ok(event.direction(Direction::Rising).arriving(Direction::Rising).action(action))
    }

    /// The action at its event.
    fn blow<'a, R: Dynamics<f64>>(self: &Rc<Self>, request: &ImpactRequest, robot: &'a R, frame: usize) -> Result<Action<'a>, SimulateError>
    where
        R::Workspace: 'a,
    {
        let at = ContactPoint { frame, point: request.point, normal: request.normal };
        let mut blow = Impact::new(robot, at, request.mass, request.restitution)?;
        let (ball, stop, speed, mass) = (self.clone(), request.stop, request.ball_speed, request.mass);
        Ok(Action::Map(Box::new(move |_, q, v| {
            if ball.spent.replace(true) {
                return Ok(None);
            }
            let struck = blow.strike(q, v, speed)?;
            let missed = struck.approach <= 0.0;
            ball.missed.set(missed);
            ball.ends.set(stop && !missed);
            let after = struck.ball_speed;
            let energy = 0.5 * mass * (after * after - speed * speed);
            ball.energy.set(Some(energy).filter(|_| !ball.missed.get()));
            Ok(Some(after))
        })))
    }
}
