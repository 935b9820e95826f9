//! Edits of the robot before its model is made: joints locked, loads attached, robots appended,
//! links renamed.

use articulated_core::description::{Coupling, Origin, Payload, Rotation};
use articulated_core::diagnostic::{At, Code, Diagnostics};

use crate::table::{Cursor, Row};
use crate::tree::Value;

/// A joint and the coordinates at which it is locked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lock {
    /// The joint.
    pub joint: String,
    /// Its coordinates, rad or m; a quaternion as x, y, z, w.
    pub at: Vec<f64>,
    /// Its place in the scene.
    pub place: At,
}

/// A joint that follows others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Follower {
    /// How it follows.
    pub coupling: Coupling,
    /// Its place in the scene.
    pub place: At,
    /// The law as the scene lists it.
    listed: Listed,
}

/// The law of a follower as a scene lists it.
#[derive(Clone, Debug, Default, PartialEq)]
struct Listed {
    joints: Vec<String>,
    coefficients: Option<Vec<f64>>,
    offset: Option<f64>,
    polynomial: Option<Vec<f64>>,
    reference: Option<f64>,
}

/// A load on a link.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Load {
    /// The load.
    pub payload: Payload,
    /// Where the scene says so.
    pub place: At,
}

/// Another robot on a link.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Append {
    /// Its file, relative to the scene's folder.
    pub file: String,
    /// The link or frame that carries it.
    pub link: String,
    /// The prefix of its names.
    pub prefix: String,
    /// Its root in that frame.
    pub origin: Origin,
    /// Where the scene names its file.
    pub place: At,
    /// Where the scene names the link.
    pub link_place: At,
}

/// `{ joint = coordinates, … }`.
pub(crate) fn locks(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<Lock> {
    let entries = spot.entries(log, "a table of joints, as { elbow = 0.5 }");
    let lock = |entry| {
        let value = spot.of(entry);
        Some(Lock { joint: entry.name.clone(), at: coordinates(&value, log)?, place: entry.at })
    };
    entries.iter().filter_map(lock).collect()
}

/// `{ joint = { joint = […], coefficients = […], offset = 0 }, … }`, with `polynomial` and
/// `reference` instead of the last two of a joint that follows one other not linearly.
/// The same, or the word `file`: the couplings of the scene, and whether those of the robot's file
/// apply.
pub(crate) fn couplings(spot: &Cursor<'_>, log: &mut Diagnostics) -> (Vec<Follower>, bool) {
    match &spot.node.value {
        Value::Text(word) if word == "file" => (Vec::new(), true),
        _ => (followers(spot, log), false),
    }
}

fn followers(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<Follower> {
    let entries = spot.entries(log, "a table of joints, as { pitch = { joint = [\"m1\", \"m2\"], coefficients = [0.5, -0.5] } }");
    let follower = |entry| {
        let (value, mut one) = (spot.of(entry), Follower { place: entry.at, ..Follower::default() });
        let before = log.count();
        value.read(FOLLOWER, &mut one, log);
        if log.count() == before {
            let listed = std::mem::take(&mut one.listed);
            match listed.coupling(&entry.name) {
                Ok(coupling) => one.coupling = coupling,
                Err((found, expected)) => value.bad(log, found, expected),
            }
        }
        (log.count() == before).then_some(one)
    };
    entries.iter().filter_map(follower).collect()
}

impl Listed {
    /// The coupling of this joint. The error: the found and the expected.
    fn coupling(self, joint: &str) -> Result<Coupling, (String, &'static str)> {
        let Self { joints, coefficients, offset, polynomial, reference } = self;
        match (coefficients, polynomial) {
            (Some(coefficients), None) if reference.is_none() => {
                if joints.len() != coefficients.len() {
                    let found = format!("{} joints and {} coefficients", joints.len(), coefficients.len());
                    return Err((found, "as many coefficients as joints"));
                }
                let (joint, leaders) = (joint.to_owned(), joints.into_iter().zip(coefficients).collect());
                Ok(Coupling { joint, leaders, offset: offset.unwrap_or_default(), ..Coupling::default() })
            }
            (Some(_), None) => Err(("reference without polynomial".to_owned(), "the key polynomial, or no reference")),
            (None, Some(polynomial)) => {
                let [leader] = joints.as_slice() else {
                    return Err((format!("a polynomial and {} joints", joints.len()), "one joint that is followed by a polynomial"));
                };
                if offset.is_some() {
                    return Err(("offset beside polynomial".to_owned(), "the number of power zero in polynomial, and no offset"));
                }
                Coupling::polynomial(joint, leader, &polynomial, reference.unwrap_or_default())
                    .map_err(|error| (error.to_string(), "a polynomial of a degree up to 4, of finite numbers"))
            }
            (Some(_), Some(_)) => Err(("coefficients and polynomial".to_owned(), "one of them")),
            (None, None) => Err(("neither coefficients nor polynomial".to_owned(), "one of them")),
        }
    }
}

const FOLLOWER: &[Row<Follower>] = &[
    Row {
        name: "joint",
        required: true,
        value: "texts",
        default: "",
        what: "the joints that are followed",
        read: |f, s, log| f.listed.joints = s.texts(log, "a list of joints, as [\"m1\", \"m2\"]").unwrap_or_default(),
    },
    Row {
        name: "coefficients",
        required: false,
        value: "numbers",
        default: "has to be given, but where `polynomial` is",
        what: "d(own coordinate)/d(coordinate) of each of them",
        read: |f, s, log| f.listed.coefficients = s.some_numbers(log, "a list of finite numbers"),
    },
    Row {
        name: "offset",
        required: false,
        value: "number, rad or m",
        default: "0",
        what: "own coordinate where theirs are zero",
        read: |f, s, log| f.listed.offset = s.number(log),
    },
    Row {
        name: "polynomial",
        required: false,
        value: "1 to 5 numbers",
        default: "none",
        what: "instead of `coefficients` and `offset`, of one joint: own coordinate = Σ cₖ (coordinate − reference)ᵏ, the numbers cₖ from power zero on",
        read: |f, s, log| f.listed.polynomial = s.some_numbers(log, "a list of finite numbers"),
    },
    Row {
        name: "reference",
        required: false,
        value: "number, rad or m",
        default: "0",
        what: "the coordinate of that joint about which the polynomial is written",
        read: |f, s, log| f.listed.reference = s.number(log),
    },
];

/// One number or several.
pub(crate) fn coordinates(spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Vec<f64>> {
    match spot.node.value {
        Value::List(_) => spot.some_numbers(log, "finite numbers"),
        _ => spot.number(log).map(|x| vec![x]),
    }
}

/// `{ "name" = "NAME", … }`.
pub(crate) fn renamings(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<(String, String)> {
    let entries = spot.entries(log, "a table of names, as { \"a-b\" = \"A_MINUS_B\" }");
    entries.iter().filter_map(|e| Some((e.name.clone(), spot.of(e).text(log, "a name in Rust")?.to_owned()))).collect()
}

/// Arguments of a file: values are texts, or numbers and truth values as they are written.
pub(crate) fn arguments(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<(String, String)> {
    let entries = spot.entries(log, "a table of arguments, as { hand = true, prefix = \"left_\" }");
    let value = |spot: Cursor<'_>, log: &mut Diagnostics| match &spot.node.value {
        Value::Number(number) => Some(number.to_string()),
        Value::Bool(value) => Some(value.to_string()),
        _ => spot.text(log, "a text, a number, true or false").map(str::to_owned),
    };
    entries.iter().filter_map(|e| Some((e.name.clone(), value(spot.of(e), log)?))).collect()
}

/// Folders of packages.
pub(crate) fn packages(spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<(String, String)> {
    let entries = spot.entries(log, "a table of folders, as { arm_description = \"../arm_description\" }");
    entries.iter().filter_map(|e| Some((e.name.clone(), spot.of(e).text(log, "the path of a folder")?.to_owned()))).collect()
}

/// Places of the items of a list, or of the entries of a table.
pub(crate) fn places(spot: &Cursor<'_>) -> Vec<At> {
    match &spot.node.value {
        Value::List(list) => list.iter().map(|item| item.at).collect(),
        Value::Table(entries) => entries.iter().map(|entry| entry.at).collect(),
        _ => Vec::new(),
    }
}

/// A name that is not empty.
pub(crate) fn name(spot: &Cursor<'_>, log: &mut Diagnostics, what: &str) -> Option<String> {
    let name = spot.text(log, what)?;
    if name.is_empty() {
        log.error((spot.node.at, &spot.key), Code::Word, "an empty text", what);
    }
    Some(name.to_owned())
}

/// Of a payload.
pub(crate) const LOAD: &[Row<Load>] = &[
    Row {
        name: "link",
        required: true,
        value: "text",
        default: "",
        what: "the link or frame that carries it",
        read: |l, s, log| {
            l.place = s.node.at;
            l.payload.link = name(s, log, "the name of a link or frame").unwrap_or_default();
        },
    },
    Row {
        name: "mass",
        required: true,
        value: "number, kg",
        default: "",
        what: "its mass, at least 0",
        read: |l, s, log| l.payload.mass = s.not_negative(log).unwrap_or_default(),
    },
    Row {
        name: "center_of_mass",
        required: false,
        value: "3 numbers, m",
        default: "[0, 0, 0]",
        what: "in the frame of what carries it",
        read: |l, s, log| l.payload.center_of_mass = s.numbers(log).unwrap_or_default(),
    },
    Row {
        name: "inertia",
        required: false,
        value: "6 numbers, kg·m²",
        default: "a point's",
        what: "xx, xy, xz, yy, yz, zz about the centre of mass, in axes of what carries it",
        read: |l, s, log| l.payload.inertia = s.numbers(log).unwrap_or_default(),
    },
    Row {
        name: "name",
        required: false,
        value: "text",
        default: "`<link>_payload`",
        what: "name of the link that stands for it",
        read: |l, s, log| l.payload.name = name(s, log, "a name"),
    },
];

/// Of a robot to append.
pub(crate) const APPEND: &[Row<Append>] = &[
    Row {
        name: "urdf",
        required: true,
        value: "text",
        default: "",
        what: "its file, seen from the scene's folder",
        read: |a, s, log| {
            a.place = s.node.at;
            a.file = name(s, log, "the path of a robot file").unwrap_or_default();
        },
    },
    Row {
        name: "file",
        required: false,
        value: "text",
        default: "",
        what: "its file in any format, as `urdf`: both keys are one",
        read: |a, s, log| {
            if !a.file.is_empty() {
                s.clash(log, "urdf and file", "one of them");
            }
            a.place = s.node.at;
            a.file = name(s, log, "the path of a robot's file").unwrap_or_default();
        },
    },
    Row {
        name: "at",
        required: true,
        value: "text",
        default: "",
        what: "the link or frame that carries it",
        read: |a, s, log| {
            a.link_place = s.node.at;
            a.link = name(s, log, "the name of a link or frame").unwrap_or_default();
        },
    },
    Row {
        name: "prefix",
        required: false,
        value: "text",
        default: "none",
        what: "what stands before its names",
        read: |a, s, log| a.prefix = s.text(log, "a text").unwrap_or_default().to_owned(),
    },
    Row {
        name: "xyz",
        required: false,
        value: "3 numbers, m",
        default: "[0, 0, 0]",
        what: "its root in that frame",
        read: |a, s, log| a.origin.xyz = s.numbers(log).unwrap_or_default(),
    },
    Row {
        name: "rpy",
        required: false,
        value: "3 numbers, rad",
        default: "[0, 0, 0]",
        what: "roll, pitch, yaw of its root in that frame",
        read: |a, s, log| a.origin.rotation = Rotation::RollPitchYaw(s.numbers(log).unwrap_or_default()),
    },
];
