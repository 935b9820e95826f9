//! Content of the file that the description leaves out.

use articulated_core::diagnostic::{Code, Diagnostics, Place, is_invisible, quote};

use articulated_core::suggest::Suggester;

use super::coupled::Parts;
use super::lost;
use crate::xml::element::Tag;
use crate::xml::markup;

const APPEARANCE: &str = "appearance plays no part in the dynamics";

const LATER: &str = "a limit that <robot version=\"1.2\"> adds";

/// Known tags, with their parents, and the reasons why they are not used.
const KNOWN: &[(&str, &str, &str)] = &[
    ("robot", "material", APPEARANCE),
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
    ("limit", "acceleration", LATER),
    ("limit", "deceleration", LATER),
    ("limit", "jerk", LATER),
];

/// Number of characters of a text shown in a message.
const SHOWN: usize = 40;

/// Reports unused tags, attributes and text inside `tag`.
pub(crate) fn rest(tag: &Tag<'_>, tags: &[&str], attributes: &[&str], log: &mut Diagnostics) {
    rest_beside(tag, &Parts::default(), (tags, attributes), log);
}

/// As [`rest`], with the parts of the robot that the rest may refer to.
pub(crate) fn rest_beside(tag: &Tag<'_>, parts: &Parts<'_>, (tags, attributes): (&[&str], &[&str]), log: &mut Diagnostics) {
    beside_tags(tag, attributes, log);
    for child in tag.children().filter(|child| !tags.iter().any(|name| child.is(name))) {
        child_of(tag, &child, parts, tags, log);
    }
}

/// Reports a tag inside `tag` that is not in `tags`, which are used.
pub(crate) fn child_of(tag: &Tag<'_>, child: &Tag<'_>, parts: &Parts<'_>, tags: &[&str], log: &mut Diagnostics) {
    let name = child.name();
    let parent = tag.name();
    let why = KNOWN.iter().find(|(within, known, _)| *within == parent && *known == name);
    // Links may hang on a joint of another program: directly inside the robot it does not close a
    // loop.
    match why {
        Some((_, _, why)) => {
            if lost::is_searched(&name) {
                lost::report(child, parts, log);
            }
            child.unused(log, name, *why);
        }
        None if name != "link" && name != "joint" && (lost::report(child, &Parts::default(), log) || around_links(child, &name, log)) => {
            child.unused(log, name, "not known");
        }
        None if name == "link" || name == "joint" => misplaced(&child.place(&format!("<{name}>")), &name, &parent, log),
        None => unknown(&child.place(&format!("<{name}>")), name.clone(), &name, tags, log),
    }
}

/// Reports unused attributes, and the text.
pub(crate) fn beside_tags(tag: &Tag<'_>, attributes: &[&str], log: &mut Diagnostics) {
    for attribute in tag.attributes().filter(|a| !attributes.contains(&a.name())) {
        attribute_of(tag, &markup::as_written(attribute.name()), attributes, log);
    }
    text_of(tag, log);
}

/// Reports the text in a tag.
pub(crate) fn text_of(tag: &Tag<'_>, log: &mut Diagnostics) {
    if let Some((text, at)) = tag.text() {
        let shown: String = text.chars().take(SHOWN).collect();
        let why = format!("text between tags says nothing of a robot: {}", quote(&markup::as_written(&shown)));
        log.unused_at(at, tag.subject(), format!("text in <{}>", tag.name()), why);
    }
}

/// Reports an attribute that is not in `used`.
pub(crate) fn attribute_of(tag: &Tag<'_>, name: &str, used: &[&str], log: &mut Diagnostics) {
    // Declarations of prefixes do not concern the robot.
    if name.starts_with("xmlns") {
        return;
    }
    let what = format!("{} {name}", tag.name());
    match KNOWN.iter().find(|(within, known, _)| tag.is(within) && *known == name) {
        Some((_, _, why)) => tag.unused(log, what, *why),
        None => unknown(&tag.place(&what), what.clone(), name, used, log),
    }
}

/// Whether an unknown tag has links or joints inside it, with a warning.
fn around_links(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> bool {
    let count = |which: &str| tag.descendants().filter(|inner| inner.is(which) && inner.attribute("name").is_some()).count();
    let (links, joints) = (count("link"), count("joint"));
    // A name with a prefix is an extension of another program.
    if links + joints == 0 || name.contains(':') {
        return false;
    }
    let found = format!("{links} links and {joints} joints inside <{name}>");
    let expected = "links and joints directly inside <robot>: these are not read, and the dynamics are those without them";
    log.warning(tag.place(&format!("<{name}>")), Code::Misplaced, found, expected);
    true
}

/// Warns of a name that looks like another one: with blanks at its ends, or with invisible
/// characters.
pub(crate) fn warn_of_blanks(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) {
    let found = if name.trim() != name {
        "a name with blanks at an end"
    } else if name.chars().any(is_invisible) {
        "a name with characters that are not visible"
    } else {
        return;
    };
    let expected = "a name of visible characters; used as written";
    log.warning(tag.place("name"), Code::OddName, format!("{found}, {}", quote(name)), expected);
}

fn misplaced(place: &Place<'_>, name: &str, parent: &str, log: &mut Diagnostics) {
    log.unused_at(place.at, place.subject, name.to_owned(), "in no place where it counts");
    let expected = format!("it directly inside <robot>, where alone it counts: is a </{parent}> missing?");
    log.warning(place, Code::Misplaced, format!("one inside <{parent}>"), expected);
}

fn unknown(place: &Place<'_>, what: String, name: &str, used: &[&str], log: &mut Diagnostics) {
    const FOUND: &str = "what is not known and not used";
    log.unused_at(place.at, place.subject, what, "not known");
    // A name with a prefix is an extension of another program, and meant for it.
    let listed = || if used.is_empty() { "nothing of its own".to_owned() } else { format!("nothing but {}", used.join(", ")) };
    match Suggester::default().misspelt(name, used.iter().copied()) {
        Some(near) => log.warning(place, Code::Misspelt, FOUND, format!("{near}, perhaps")),
        None if name.contains(':') => {}
        None => log.warning(place, Code::Unknown, FOUND, listed()),
    }
}
