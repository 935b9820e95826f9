//! Why an edit was refused.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use super::JointKind;
use crate::{MOST_LISTED, listed};

/// Why a [`Description`](super::Description) was not edited.
#[derive(Clone, Debug, PartialEq)]
pub enum EditError {
    /// There is no such link or frame.
    UnknownLink {
        /// The name found.
        name: String,
        /// The name of a link or frame most like it.
        nearest: Option<String>,
    },
    /// There is no such joint.
    UnknownJoint {
        /// The name found.
        name: String,
        /// The joint's name most like it.
        nearest: Option<String>,
    },
    /// Names that the edit would add and that links or joints have already.
    NamesTaken {
        /// All of them.
        names: Vec<String>,
    },
    /// The joint of a floating base was to be locked.
    LockedBase,
    /// A fixed joint was to be locked.
    LockedFixed {
        /// Its name.
        joint: String,
    },
    /// A joint that follows another was to be locked.
    LockedFollower {
        /// Its name.
        joint: String,
        /// The names of the joints that it follows.
        leaders: Vec<String>,
    },
    /// A locked joint was to be locked.
    LockedTwice {
        /// Its name.
        joint: String,
    },
    /// Coordinates of a wrong number, or not finite ones.
    Coordinates {
        /// The joint to be locked.
        joint: String,
        /// Its kind.
        kind: JointKind,
        /// The given coordinates.
        found: Vec<f64>,
    },
    /// A quaternion that is not of norm one.
    Quaternion {
        /// The joint to be locked.
        joint: String,
        /// The quaternion's norm.
        norm: f64,
    },
    /// A payload's mass is negative or not finite.
    Mass {
        /// The link that was to carry it.
        link: String,
        /// kg.
        found: f64,
    },
    /// A payload's centre of mass is not finite.
    Center {
        /// The link that was to carry it.
        link: String,
        /// m.
        found: [f64; 3],
    },
    /// A payload's inertia has a moment below zero or is not finite, or there is one without mass.
    Inertia {
        /// The link that was to carry it.
        link: String,
        /// xx, xy, xz, yy, yz, zz, kg·m².
        found: [f64; 6],
    },
    /// A joint that is not fixed was to bend.
    ShaftNotFixed {
        /// Its name.
        joint: String,
        /// Its kind.
        kind: JointKind,
    },
    /// A number of a shaft that no shaft has.
    ShaftNumber {
        /// The joint that was to bend.
        joint: String,
        /// Which number.
        field: &'static str,
        /// The given number.
        found: f64,
        /// The expected number, in words.
        expected: &'static str,
    },
    /// A joint cannot follow others as requested.
    Coupling {
        /// The joint that was to follow.
        joint: String,
        /// The found and the expected, in words.
        what: String,
    },
    /// The robot to be appended has no root.
    NoRoot {
        /// Its name.
        robot: String,
    },
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownLink { name, nearest } => unknown(f, "link or frame", name, nearest.as_deref()),
            Self::UnknownJoint { name, nearest } => unknown(f, "joint", name, nearest.as_deref()),
            Self::NamesTaken { names } => taken(f, names),
            Self::LockedBase => f.write_str("the floating base cannot be locked: say that the base is fixed"),
            Self::LockedFixed { joint } => write!(f, "joint {joint:?} is fixed: there is nothing to lock"),
            Self::LockedFollower { joint, leaders } => {
                let them = if leaders.len() == 1 { "that one" } else { "them" };
                write!(f, "joint {joint:?} follows {}: lock {them}", listed(leaders.iter().map(|leader| format!("{leader:?}"))))
            }
            Self::Coupling { joint, what } => write!(f, "joint {joint:?} cannot follow others: {what}"),
            Self::LockedTwice { joint } => write!(f, "joint {joint:?} is locked already"),
            Self::Coordinates { joint, kind, found } => {
                let (name, n) = (kind.name(), kind.sizes().0);
                let numbers = if n == 1 { "one finite number" } else { "finite numbers" };
                write!(f, "joint {joint:?}: locked at {found:?}, expected {}{numbers} for a {name} joint", Count(n))
            }
            Self::Quaternion { joint, norm } => {
                write!(f, "joint {joint:?}: locked at a quaternion of norm {norm:.4}, expected one, with the order x, y, z, w")
            }
            Self::Mass { link, found } => {
                write!(f, "load on link {link:?}: mass: found {found} kg, expected a finite number, not negative")
            }
            Self::Center { link, found } => {
                write!(f, "load on link {link:?}: centre of mass: found {found:?} m, expected finite numbers")
            }
            Self::Inertia { link, found } => write!(
                f,
                "load on link {link:?}: inertia: found {found:?} kg·m², expected xx, xy, xz, yy, yz, zz of a body with mass: finite, and no principal \
                 moment negative"
            ),
            Self::ShaftNotFixed { joint, kind } => {
                write!(f, "shaft at joint {joint:?}: found a {} joint, expected a fixed one, whose rigid offset is to bend", kind.name())
            }
            Self::ShaftNumber { joint, field, found, expected } => {
                write!(f, "shaft at joint {joint:?}: {field}: found {found}, expected {expected}")
            }
            Self::NoRoot { robot } => write!(f, "robot {robot:?}: found no root link, expected a tree"),
        }
    }
}

impl core::error::Error for EditError {}

/// A number before a noun; empty for one.
struct Count(usize);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 1 { Ok(()) } else { write!(f, "{} ", self.0) }
    }
}

fn unknown(f: &mut fmt::Formatter<'_>, what: &str, name: &str, nearest: Option<&str>) -> fmt::Result {
    write!(f, "the robot has no {what} {name:?}")?;
    nearest.map_or(Ok(()), |near| write!(f, ", did you mean {near:?}?"))
}

fn taken(f: &mut fmt::Formatter<'_>, names: &[String]) -> fmt::Result {
    let plural = if names.len() == 1 { "name is" } else { "names are" };
    let other = if names.len() > MOST_LISTED { "prefix" } else { "name or prefix" };
    write!(f, "{plural} taken: {}; give another {other}", listed(names.iter().map(|name| format!("{name:?}"))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_names_the_joint_and_what_would_be_right() {
        use alloc::string::ToString;
        let at = |kind, found: &[f64]| EditError::Coordinates { joint: "j".into(), kind, found: found.to_vec() }.to_string();
        assert_eq!(
            at(JointKind::Revolute, &[1.0, 2.0]),
            "joint \"j\": locked at [1.0, 2.0], expected one finite number for a revolute joint"
        );
        assert_eq!(at(JointKind::Spherical, &[1.0]), "joint \"j\": locked at [1.0], expected 4 finite numbers for a spherical joint");
    }
}
