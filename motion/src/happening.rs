//! What happened in a motion: for programs, and in words.

use std::fmt;

/// Something that happened, at its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Happening {
    /// When, s.
    pub t: f64,
    /// What, in a few words; of an event that was put behind those of the scene, its name.
    pub what: String,
    /// What of the scene it was; nothing of such an event.
    pub about: Option<About>,
    /// Of the ball's turn, its speed along the normal after it, m/s.
    pub ball_speed: Option<f64>,
}

/// An event of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct About {
    /// What sort of event.
    pub sort: Sort,
    /// Whose: a joint of one degree of freedom, a degree of freedom as `base[3]`, or a link.
    pub on: String,
    /// Whether what it is about begins: a limit is reached, the ground touched, the joint sticks, the ball is hit; or ends: the joint comes back, the link leaves the ground, the
    /// joint slips. The ball's turn comes once: not hit is nothing that moved towards it.
    pub begins: bool,
}

/// The sorts of events that a scene looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Sort {
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

impl Sort {
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

impl fmt::Display for About {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.on)?;
        if let Sort::Contact { number, of: of @ 2.. } = self.sort {
            write!(f, " (contact {number} of {of})")?;
        }
        f.write_str(match (self.sort, self.begins) {
            (Sort::LowerLimit, true) => " reaches its lower limit",
            (Sort::LowerLimit, false) => " comes back from its lower limit",
            (Sort::UpperLimit, true) => " reaches its upper limit",
            (Sort::UpperLimit, false) => " comes back from its upper limit",
            (Sort::Contact { .. }, true) => " touches the ground",
            (Sort::Contact { .. }, false) => " leaves the ground",
            (Sort::StickSlip, true) => " sticks",
            (Sort::StickSlip, false) => " slips",
            (Sort::Ball, true) => " hits the ball",
            (Sort::Ball, false) => " is not moving towards the ball",
        })
    }
}

impl Happening {
    /// An event of the scene, and the ball's speed after it.
    pub(crate) fn of(t: f64, about: About, ball_speed: Option<f64>) -> Self {
        let what = match (ball_speed, about.begins) {
            (Some(speed), true) => format!("{about}, which leaves at {speed:.4} m/s"),
            (Some(speed), false) => format!("{about}, which keeps {speed:.4} m/s"),
            (None, _) => about.to_string(),
        };
        Self { t, what, about: Some(about), ball_speed }
    }
}
