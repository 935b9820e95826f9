//! The sorts of findings.

use core::fmt;

/// From one row for each code, with its name for programs, the codes and their list.
macro_rules! codes {
    ($($(#[$attribute:meta])+ $code:ident $name:literal,)+) => {
        /// The sort of a finding. Programs decide by it; its name is stable.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Code {
            $($(#[$attribute])+ $code,)+
        }

        impl Code {
            /// All codes.
            pub const ALL: &'static [Self] = &[$(Self::$code),+];

            /// Its name in JSON.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$code => $name,)+
                }
            }
        }
    };
}

codes! {
    /// The bytes are not UTF-8.
    NotUtf8 "not_utf8",
    /// The document is larger, deeper or wider than any robot.
    TooLarge "too_large",
    /// Not well-formed XML.
    Xml "xml",
    /// A document type declaration, where entities are defined.
    Doctype "doctype",
    /// Xacro has not been run.
    Xacro "xacro",
    /// The root element is not `<robot>`.
    NotARobot "not_a_robot",
    /// A robot without links.
    NoLinks "no_links",
    /// A version of the format that is not known.
    Version "version",
    /// A required tag is missing.
    MissingTag "missing_tag",
    /// A required attribute is missing.
    MissingAttribute "missing_attribute",
    /// A tag that may occur once occurs twice.
    DuplicateTag "duplicate_tag",
    /// Content that changes the robot and cannot be read.
    Unsupported "unsupported",
    /// A name is empty.
    EmptyName "empty_name",
    /// Two links, or two joints, of one name.
    DuplicateName "duplicate_name",
    /// Not a decimal number.
    NotANumber "not_a_number",
    /// A number that is infinite, not a number, or beyond double precision.
    NotFinite "not_finite",
    /// Too few or too many numbers.
    WrongCount "wrong_count",
    /// A type of joint that the format does not have.
    UnknownJointType "unknown_joint_type",
    /// A link that does not exist.
    UnknownLink "unknown_link",
    /// A joint that does not exist.
    UnknownJoint "unknown_joint",
    /// A link that is the child of several joints.
    TwoParents "two_parents",
    /// Links that form a cycle.
    Ring "ring",
    /// Several links without a parent.
    SeveralRoots "several_roots",
    /// An axis without a direction.
    ZeroAxis "zero_axis",
    /// A planar joint without an axis.
    NoAxis "no_axis",
    /// The two axes of a universal joint have one direction.
    ParallelAxes "parallel_axes",
    /// A helical joint that does not slide.
    ZeroPitch "zero_pitch",
    /// A mass below zero.
    NegativeMass "negative_mass",
    /// A principal moment of inertia below zero.
    InertiaNotPositive "inertia_not_positive",
    /// One principal moment is greater than the other two together.
    InertiaTriangle "inertia_triangle",
    /// Rotational inertia without mass.
    InertiaWithoutMass "inertia_without_mass",
    /// A joint mimics one that does not exist.
    UnknownLeader "unknown_leader",
    /// A joint that follows itself, directly or through others.
    MimicRing "mimic_ring",
    /// The joint that is followed does not have exactly one coordinate.
    LeaderCannotLead "leader_cannot_lead",
    /// The joint that follows does not have exactly one coordinate.
    FollowerCannotFollow "follower_cannot_follow",
    /// A revolute, helical or prismatic joint without `<limit>`.
    LimitMissing "limit_missing",
    /// A `<limit>` without an attribute that the format requires.
    LimitIncomplete "limit_incomplete",
    /// A lower bound above the upper one.
    LimitOrder "limit_order",
    /// A joint's coordinate that is beyond its limits.
    BeyondLimit "beyond_limit",
    /// An angle of a frame that is more than a turn, or a bound that is many: usually degrees.
    MoreThanATurn "more_than_a_turn",
    /// A length or an inertia beyond any robot's: usually millimetres.
    Units "units",
    /// A bound or a coefficient below zero where that has no meaning.
    Negative "negative",
    /// A tag or attribute that the reader does not know, close to one that it does.
    Misspelt "misspelt",
    /// A tag or attribute that the reader does not know.
    Unknown "unknown",
    /// A link or a joint that is not directly inside the robot.
    Misplaced "misplaced",
    /// A load on a link that a fixed base holds.
    UnusedInertia "unused_inertia",
    /// An angle was replaced by a multiple of π/2, as requested.
    Snapped "snapped",
    /// Generated code that a compiler needs minutes for.
    LongCode "long_code",
    /// A tolerance for right angles that is out of range.
    SnapAngles "snap_angles",
    /// `<mimic>` on a fixed joint.
    UnusedMimic "unused_mimic",
    /// A follower with the multiplier 0.
    MimicZero "mimic_zero",
    /// A follower that moves beyond its limits as its leader moves within its own.
    MimicRange "mimic_range",
    /// An axis that is not of length 1.
    AxisLength "axis_length",
    /// A lower bound equal to the upper one.
    LimitEqual "limit_equal",
    /// A limit of effort or velocity that is zero.
    LimitZero "limit_zero",
    /// A name with blanks at an end, or with characters that are not visible.
    OddName "odd_name",
    /// A joint hangs on `world`, which the file does not declare.
    UndeclaredWorld "undeclared_world",
    /// A quaternion whose norm is not 1.
    QuaternionNorm "quaternion_norm",
    /// Both `rpy` and `quat_xyzw`.
    TwoRotations "two_rotations",
    /// Dynamics that the file states where they are not read: closed loops, springs.
    LostDynamics "lost_dynamics",
    /// Contact with collision geometry that cannot make any: a mesh, or no geometry.
    NoContact "no_contact",
    /// Contact with collision geometry of which a part cannot make any: a mesh beside other shapes.
    PartOfContact "part_of_contact",
    /// An effect whose numbers are to come from the robot's file, which has them for no joint.
    NoNumbers "no_numbers",
    /// A number far beyond any robot's: gravity or a coordinate.
    BeyondSense "beyond_sense",
    /// More findings than are listed.
    More "more",
    /// Two readers of one file disagree: a mistake of the reader, not of the file.
    Internal "internal",
    /// Not the syntax of the format, or more than any file of it holds.
    Syntax "syntax",
    /// A key that does not exist.
    UnknownKey "unknown_key",
    /// A required key is missing.
    MissingKey "missing_key",
    /// A value of another type.
    Type "type",
    /// A word that is not one of the allowed ones.
    Word "word",
    /// A number outside its range.
    Number "number",
    /// Numbers or keys that exclude each other.
    Together "together",
    /// A joint, link, function or file that does not exist.
    UnknownName "unknown_name",
    /// The robot does not allow this.
    Robot "robot",
    /// The model refuses this: `found` is a sentence.
    Refused "refused",
    /// A file cannot be read or written.
    File "file",
    /// An edit of the robot that cannot be made.
    Edit "edit",
    /// A robot that the algorithms do not accept.
    Model "model",
    /// An effect that the model does not accept.
    Effect "effect",
    /// A function that does not exist.
    UnknownFunction "unknown_function",
    /// An entry of the list of functions that cannot be read, or does not fit the robot.
    FunctionSpec "function_spec",
    /// Two functions of one name.
    SameName "same_name",
    /// An entry of the list of parameters that cannot be read, or does not fit the robot.
    Parameter "parameter",
    /// A name in code for a name that the robot does not have, or one that is not an identifier.
    Rename "rename",
    /// Two names that become one identifier.
    NameClash "name_clash",
    /// A function that divides by an inertia that is zero on this robot.
    SingularMassMatrix "singular_mass_matrix",
    /// A function of the centre of mass, and nothing that moves has mass.
    NoMass "no_mass",
    /// A function of actuators, for a robot that has none.
    NoActuators "no_actuators",
    /// A function of constraints, for a robot that has none.
    NoConstraints "no_constraints",
    /// A function of frames with six degrees of freedom, and a frame has fewer.
    BoundFrames "bound_frames",
    /// More generated code than the request allows.
    TooMuchCode "too_much_code",
    /// A type of numbers for batches that does not exist, or is listed twice.
    Batch "batch",
    /// A level of accuracy that the target does not have.
    Level "level",
    /// A prefix that is not an identifier.
    Prefix "prefix",
    /// Options that exclude each other, or an option without its value.
    Usage "usage",
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
