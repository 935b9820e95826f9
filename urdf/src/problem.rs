//! What is wrong: data first, then a sentence.

use std::fmt;

/// All that is wrong with a file.
#[derive(Clone, Debug)]
pub struct Problems {
    /// Why the file was refused; never empty.
    pub errors: Vec<Problem>,
    /// What else looks wrong.
    pub warnings: Vec<Problem>,
}

/// One thing that is wrong or looks wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The name of the file, as given in the options.
    pub file: String,
    /// The line, from 1, where one can be told.
    pub line: Option<u32>,
    /// Which link or joint.
    pub subject: Subject,
    /// What sort of mistake.
    pub kind: Kind,
    /// Which tag or attribute.
    pub field: String,
    /// What stands there.
    pub found: String,
    /// What would be right.
    pub expected: String,
}

/// What a [`Problem`] is about.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Subject {
    /// The document as a whole.
    Document,
    /// The link of this name.
    Link(String),
    /// The joint of this name.
    Joint(String),
}

/// The sorts of mistakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// The bytes are not UTF-8.
    NotUtf8,
    /// The document is larger, deeper or wider than any robot.
    TooLarge,
    /// Not well-formed XML.
    Xml,
    /// A document type declaration, where entities are defined.
    Doctype,
    /// Xacro has not been run.
    Xacro,
    /// The root element is not `<robot>`.
    NotARobot,
    /// A robot without links.
    NoLinks,
    /// A version of the format that is not known.
    Version,
    /// A tag that has to be there is missing.
    MissingTag,
    /// An attribute that has to be there is missing.
    MissingAttribute,
    /// A tag that may stand once stands twice.
    DuplicateTag,
    /// A tag or attribute that changes the robot and cannot be read.
    Unsupported,
    /// A name is empty.
    EmptyName,
    /// Two links, or two joints, of one name.
    DuplicateName,
    /// Not a decimal number.
    NotANumber,
    /// A number that is infinite, not a number, or beyond double precision.
    NotFinite,
    /// Too few or too many numbers.
    WrongCount,
    /// A type of joint that the format does not have.
    UnknownJointType,
    /// A joint names a link that does not exist.
    UnknownLink,
    /// A link is the child of several joints.
    TwoParents,
    /// Links that hang on each other in a ring.
    Ring,
    /// Several links hang on nothing.
    SeveralRoots,
    /// An axis without a direction.
    ZeroAxis,
    /// A planar joint without an axis.
    NoAxis,
    /// The two axes of a universal joint have one direction.
    ParallelAxes,
    /// A helical joint that does not slide.
    ZeroPitch,
    /// A mass below zero.
    NegativeMass,
    /// A principal moment of inertia below zero.
    InertiaNotPositive,
    /// One principal moment is greater than the other two together.
    InertiaTriangle,
    /// Rotational inertia without mass.
    InertiaWithoutMass,
    /// A joint mimics one that does not exist.
    UnknownLeader,
    /// A joint mimics itself, directly or by way of others.
    MimicRing,
    /// The joint that is followed does not have exactly one coordinate.
    LeaderCannotLead,
    /// The joint that follows does not have exactly one coordinate.
    FollowerCannotFollow,
    /// A revolute, helical or prismatic joint without `<limit>`.
    LimitMissing,
    /// A `<limit>` without an attribute that the format asks for.
    LimitIncomplete,
    /// A lower bound above the upper one.
    LimitOrder,
    /// A joint's coordinate, as asked for, that is beyond its limits.
    BeyondLimit,
    /// An angle of a frame that is more than a turn, or a bound that is many: degrees, most often.
    MoreThanATurn,
    /// A length or an inertia beyond any robot's: in millimetres, most often.
    Units,
    /// A bound or a coefficient below zero that has no such meaning.
    Negative,
    /// A tag or attribute that nobody knows, but nearly one that matters.
    Misspelt,
    /// A tag or attribute that nobody knows.
    Unknown,
    /// A link or a joint that does not stand directly inside the robot.
    Misplaced,
    /// A load on what a fixed base holds.
    UnusedInertia,
    /// An angle was replaced by a multiple of π/2, as asked for.
    Snapped,
    /// Generated code that a compiler takes minutes for: of the robot, not of the file.
    LongCode,
    /// [`Options::snap_angles`](crate::Options::snap_angles) that cannot be.
    SnapAngles,
    /// `<mimic>` on a fixed joint.
    UnusedMimic,
    /// A follower with the multiplier 0.
    MimicZero,
    /// A follower that moves beyond its limits as its leader moves within its own.
    MimicRange,
    /// An axis that is not of length 1.
    AxisLength,
    /// A lower bound equal to the upper one.
    LimitEqual,
    /// A limit of effort or velocity that is zero.
    LimitZero,
    /// A name with leading or trailing blanks, or with characters that are not visible.
    OddName,
    /// A joint hangs on `world`, which the file does not declare.
    UndeclaredWorld,
    /// A quaternion whose norm is not 1.
    QuaternionNorm,
    /// Both `rpy` and `quat_xyzw`.
    TwoRotations,
    /// Dynamics that the file states where they are not read: closed loops, springs.
    LostDynamics,
    /// Contact asked of collision geometry that makes none: a mesh, or nothing.
    NoContact,
    /// Contact asked of collision geometry of which a part makes none: a mesh beside other shapes.
    PartOfContact,
    /// A number that no robot has: gravity or a coordinate.
    BeyondSense,
    /// More problems than are listed.
    More,
    /// The two readers of this crate disagree: a mistake of the crate, not of the file.
    Internal,
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let errors = self.errors.iter().map(|p| ("error", p.to_string()));
        let warnings = crate::summary(&self.warnings).into_iter().map(|line| ("warning", line));
        for (i, (level, problem)) in errors.chain(warnings).enumerate() {
            let end = if i == 0 { "" } else { "\n" };
            write!(f, "{end}{level}: {problem}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file)?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        if self.subject != Subject::Document {
            write!(f, " {}:", self.subject)?;
        }
        if !self.field.is_empty() {
            write!(f, " {}:", self.field)?;
        }
        write!(f, " found {}", self.found)?;
        match self.expected.as_str() {
            "" => Ok(()),
            expected => write!(f, ", expected {expected}"),
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Document => f.write_str("document"),
            Self::Link(name) => write!(f, "link {}", quote(name)),
            Self::Joint(name) => write!(f, "joint {}", quote(name)),
        }
    }
}

/// ` (did you mean "upper"?)`, or nothing.
pub(crate) fn hint(meant: Option<&str>) -> String {
    meant.map(|name| format!(" (did you mean {}?)", quote(name))).unwrap_or_default()
}

/// Control characters, and those that only change the direction or the joining of letters.
pub(crate) fn is_invisible(c: char) -> bool {
    c.is_control() || matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

/// `text` in quotation marks, on one line, cut where it gets long. Characters that are not visible are escaped.
pub fn quote(text: &str) -> String {
    quoted(text, 80)
}

/// As [`quote`], of what should be a number: cut after as many characters as a double may need.
pub fn quote_number(text: &str) -> String {
    quoted(text, 24)
}

fn quoted(text: &str, most: usize) -> String {
    let mut out = String::from('"');
    for c in text.chars().take(most) {
        match c {
            c if is_invisible(c) => out.extend(c.escape_default()),
            c => out.push(c),
        }
    }
    out.push_str(if text.chars().nth(most).is_some() { "…\"" } else { "\"" });
    out
}
