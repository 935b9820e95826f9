//! Event records of a motion: data and text.

use std::fmt;

/// The record of an event.
#[derive(Clone, Debug, PartialEq)]
pub struct Occurrence {
    /// Time, s.
    pub t: f64,
    /// Description; for an event appended by the program, its name.
    pub what: String,
    /// The event of the scene; `None` for an appended event.
    pub about: Option<SceneEvent>,
    /// For the ball's event, its speed along the normal afterwards, m/s.
    pub ball_speed: Option<f64>,
}

/// An event of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SceneEvent {
    /// Its kind.
    pub kind: EventKind,
    /// Subject: a joint of one degree of freedom, a degree of freedom as `base[3]`, or a link.
    pub on: String,
    /// Whether the condition begins (a limit is reached, the ground is touched, the joint stops
    /// sliding, the ball is hit) or ends (the joint comes back, the link leaves the ground, the
    /// joint starts to slide, [`SLIDING`](articulated::simulate::SLIDING)). The ball's event occurs
    /// once; false means that the link did not move towards the ball.
    pub begins: bool,
}

/// The kinds of events that a scene looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum EventKind {
    /// The lower bound of a joint.
    LowerLimit,
    /// The upper bound of a joint.
    UpperLimit,
    /// A contact of a link with the ground.
    Contact {
        /// Number among the link's contacts, from 1, in the order of the scene.
        number: usize,
        /// Number of contacts of the link.
        of: usize,
    },
    /// Dry friction that holds a joint.
    StickSlip,
    /// A ball that a link hits.
    Ball,
}

impl EventKind {
    /// Its name in files: `lower_limit`, `upper_limit`, `contact`, `stick_slip`, `ball`.
    pub fn name(self) -> &'static str {
        match self {
            Self::LowerLimit => "lower_limit",
            Self::UpperLimit => "upper_limit",
            Self::Contact { .. } => "contact",
            Self::StickSlip => "stick_slip",
            Self::Ball => "ball",
        }
    }
}

impl fmt::Display for SceneEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.on)?;
        if let EventKind::Contact { number, of: of @ 2.. } = self.kind {
            write!(f, " (contact {number} of {of})")?;
        }
        f.write_str(match (self.kind, self.begins) {
            (EventKind::LowerLimit, true) => " reaches its lower limit",
            (EventKind::LowerLimit, false) => " comes back from its lower limit",
            (EventKind::UpperLimit, true) => " reaches its upper limit",
            (EventKind::UpperLimit, false) => " comes back from its upper limit",
            (EventKind::Contact { .. }, true) => " touches the ground",
            (EventKind::Contact { .. }, false) => " leaves the ground",
            (EventKind::StickSlip, true) => " stops sliding",
            (EventKind::StickSlip, false) => " starts to slide",
            (EventKind::Ball, true) => " hits the ball",
            (EventKind::Ball, false) => " is not moving towards the ball",
        })
    }
}

impl Occurrence {
    /// An event of the scene, and the ball's speed after it.
    pub(crate) fn of(t: f64, about: SceneEvent, ball_speed: Option<f64>) -> Self {
        let what = match (ball_speed, about.begins) {
            (Some(speed), true) => format!("{about}, which leaves at {speed:.4} m/s"),
            (Some(speed), false) => format!("{about}, which keeps {speed:.4} m/s"),
            (None, _) => about.to_string(),
        };
        Self { t, what, about: Some(about), ball_speed }
    }
}
