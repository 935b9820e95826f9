//! What the file says and the description leaves out.

use std::fmt;

use articulated_core::suggest::Suggester;

use crate::element::Tag;
use crate::log::{Log, Place};
use crate::problem::{Kind, Subject, is_invisible, quote};
use crate::{lost, markup};

/// Content of the file that is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct Unused {
    /// The line, from 1, where one can be told.
    pub line: Option<u32>,
    /// Which link or joint it belongs to.
    pub subject: Subject,
    /// Which tag, or which tag and attribute.
    pub tag: String,
    /// Why it is not used.
    pub why: String,
}

impl fmt::Display for Unused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if self.subject != Subject::Document {
            write!(f, "{}: ", self.subject)?;
        }
        write!(f, "{}: {}", self.tag, self.why)
    }
}

const APPEARANCE: &str = "appearance plays no part in the dynamics";

/// Tags that are known, by what they stand in, and why they are not used.
const KNOWN: &[(&str, &str, &str)] = &[
    ("robot", "material", APPEARANCE),
    ("robot", "transmission", "rotor inertia and gear ratios are given by the scene"),
    ("robot", "gazebo", "settings of a simulator"),
    ("robot", "ros2_control", "settings of a controller"),
    ("robot", "sensor", "sensors play no part in the dynamics"),
    ("robot", "frame", "an extension that is not used"),
    ("robot", "mujoco", "settings of a simulator"),
    ("robot", "plugin", "settings of a simulator"),
    ("robot", "disable_collisions", "collisions are not looked for"),
    ("link", "visual", APPEARANCE),
    ("link", "collision", "no effect of a scene takes it (`contact` with `from = \"collision\"` does)"),
    ("collision", "material", APPEARANCE),
    ("collision", "contact_coefficients", "contact parameters are given by the scene"),
    ("collision", "surface", "contact parameters are given by the scene"),
    ("collision", "concave", "settings of a simulator"),
    ("collision", "group", "settings of a simulator"),
    ("collision", "verbose", "settings of a simulator"),
    ("link", "contact", "contact parameters are given by the scene"),
    ("link", "self_collision_checking", "collisions are not looked for"),
    ("joint", "safety_controller", "settings of a controller"),
    ("joint", "calibration", "settings of a controller"),
    ("limit", "acceleration", "acceleration is not limited"),
    ("limit", "deceleration", "acceleration is not limited"),
    ("limit", "jerk", "jerk is not limited"),
];

/// So much of a text is told.
const SHOWN: usize = 40;

/// Reports the tags, the attributes and the text inside `tag` other than those that are used.
pub(crate) fn rest(tag: &Tag<'_>, tags: &[&str], attributes: &[&str], log: &mut Log) {
    beside_tags(tag, attributes, log);
    for child in tag.children().filter(|child| !tags.iter().any(|name| child.is(name))) {
        let name = child.name();
        let parent = tag.name();
        let why = KNOWN.iter().find(|(within, known, _)| *within == parent && *known == name);
        match why {
            Some((_, _, why)) => {
                if lost::is_searched(&name) {
                    lost::report(&child, log);
                }
                log.unused(&child, name, *why);
            }
            None if name != "link" && name != "joint" && (lost::report(&child, log) || around_links(&child, &name, log)) => {
                log.unused(&child, name, "not known");
            }
            None if name == "link" || name == "joint" => misplaced(&child.place(&format!("<{name}>")), &name, &parent, log),
            None => unknown(&child.place(&format!("<{name}>")), name.clone(), &name, tags, log),
        }
    }
}

/// Reports the attributes other than those that are used, and the text.
pub(crate) fn beside_tags(tag: &Tag<'_>, attributes: &[&str], log: &mut Log) {
    rest_of_attributes(tag, attributes, log);
    if let Some((text, line)) = tag.text() {
        let shown: String = text.chars().take(SHOWN).collect();
        let why = format!("text between tags says nothing of a robot: {}", quote(&markup::as_written(&shown)));
        log.unused_at(Some(line), tag.subject(), format!("text in <{}>", tag.name()), why);
    }
}

fn rest_of_attributes(tag: &Tag<'_>, used: &[&str], log: &mut Log) {
    for attribute in tag.attributes().filter(|a| !used.contains(&a.name())) {
        let name = markup::as_written(attribute.name());
        // Declarations of prefixes say nothing about the robot.
        if name.starts_with("xmlns") {
            continue;
        }
        let what = format!("{} {name}", tag.name());
        match KNOWN.iter().find(|(within, known, _)| tag.is(within) && *known == name) {
            Some((_, _, why)) => log.unused(tag, what, *why),
            None => unknown(&tag.place(&what), what.clone(), &name, used, log),
        }
    }
}

/// Whether an unknown tag has links or joints inside it, with a warning.
fn around_links(tag: &Tag<'_>, name: &str, log: &mut Log) -> bool {
    let count = |which: &str| tag.descendants().filter(|inner| inner.is(which) && inner.attribute("name").is_some()).count();
    let (links, joints) = (count("link"), count("joint"));
    // What has a prefix is an extension of another program.
    if links + joints == 0 || name.contains(':') {
        return false;
    }
    let found = format!("{links} links and {joints} joints inside <{name}>");
    let expected = "links and joints directly inside <robot>: these are not read, and the dynamics are those without them";
    log.warning(&tag.place(&format!("<{name}>")), Kind::Misplaced, found, expected);
    true
}

/// Warns of a name that looks like another one: with blanks at its ends, or with characters that are not visible.
pub(crate) fn warn_of_blanks(tag: &Tag<'_>, name: &str, log: &mut Log) {
    let found = if name.trim() != name {
        "a name with blanks at an end"
    } else if name.chars().any(is_invisible) {
        "a name with characters that are not visible"
    } else {
        return;
    };
    let expected = "a name of visible characters; used as written";
    log.warning(&tag.place("name"), Kind::OddName, format!("{found}, {}", quote(name)), expected);
}

fn misplaced(place: &Place<'_>, name: &str, parent: &str, log: &mut Log) {
    log.unused_at(place.line, place.subject, name.to_owned(), "in no place where it counts");
    let expected = format!("it directly inside <robot>, where alone it counts: is a </{parent}> missing?");
    log.warning(place, Kind::Misplaced, format!("one inside <{parent}>"), expected);
}

fn unknown(place: &Place<'_>, what: String, name: &str, used: &[&str], log: &mut Log) {
    const FOUND: &str = "what is not known and not used";
    log.unused_at(place.line, place.subject, what, "not known");
    // What has a prefix is somebody's extension, and meant for them.
    let listed = || if used.is_empty() { "nothing of its own".to_owned() } else { format!("nothing but {}", used.join(", ")) };
    match Suggester::default().misspelt(name, used.iter().copied()) {
        Some(near) => log.warning(place, Kind::Misspelt, FOUND, format!("{near}, perhaps")),
        None if name.contains(':') => {}
        None => log.warning(place, Kind::Unknown, FOUND, listed()),
    }
}
