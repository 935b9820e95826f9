//! What happened in a motion: for programs, and in words.

use std::fmt;

/// Something that happened, at its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Occurrence {
    /// When, s.
    pub t: f64,
    /// What, in a few words; of an event that was put behind those of the scene, its name.
    pub what: String,
    /// What of the scene it was; nothing of such an event.
    pub about: Option<SceneEvent>,
    /// Of the ball's turn, its speed along the normal after it, m/s.
    pub ball_speed: Option<f64>,
}

/// An event of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SceneEvent {
    /// Its kind.
    pub kind: EventKind,
    /// Whose: a joint of one degree of freedom, a degree of freedom as `base[3]`, or a link.
    pub on: String,
    /// Whether what it is about begins: a limit is reached, the ground touched, the joint stops
    /// sliding, the ball is hit; or ends: the joint comes back, the link leaves the ground, the
    /// joint starts to slide ([`SLIDING`](articulated::simulate::SLIDING)). The ball's turn comes
    /// once: not hit is nothing that moved towards it.
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
        /// Which of the link's, from 1, in the order of the scene.
        number: usize,
        /// How many the link has.
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
