//! Dynamics in places where they are not read: inside `<gazebo>`, under a prefix, in unknown tags.

use super::coupled::{LOOP, Loss, Parts, is_joint, letters, says_loop};
use super::joint_forces;
use crate::xml::element::Tag;
use articulated_core::diagnostic::{Code, Diagnostics, quote};

/// Known tags of other programs that may state dynamics.
const SEARCHED: [&str; 5] = ["gazebo", "mujoco", "plugin", "frame", "ros2_control"];

/// Whether a known, unused tag is searched for dynamics.
pub(crate) fn is_searched(name: &str) -> bool {
    SEARCHED.contains(&name)
}

/// Warns of all dynamics in `tag` and the tags inside it. Returns whether there are some.
pub(crate) fn report(tag: &Tag<'_>, parts: &Parts<'_>, log: &mut Diagnostics) -> bool {
    // Tags inside a reported tag belong to it.
    let (mut end, mut any) = (0, false);
    for inner in tag.descendants() {
        if inner.start() < end {
            continue;
        }
        // Those at a joint are kept, or have a warning of their own.
        if inner.is(joint_forces::SPRING) && tag.attribute("reference").is_some() {
            continue;
        }
        if let Some(Loss { what, expected }) = parts.loss(&inner).or_else(|| loss(&inner)) {
            let name = inner.attribute("name").map(|_| format!(" {}", quote(&inner.name_for_messages()))).unwrap_or_default();
            let within = if inner.start() == tag.start() { String::new() } else { format!(" inside {}", shown(tag)) };
            log.warning(inner.place(&format!("<{}>", inner.name())), Code::LostDynamics, format!("{what}{name}{within}"), expected);
            (end, any) = (inner.end(), true);
        }
    }
    any
}

fn shown(tag: &Tag<'_>) -> String {
    match tag.attribute("reference") {
        Some((link, _)) => format!("<{} reference={}>", tag.name(), quote(link)),
        None => format!("<{}>", tag.name()),
    }
}

/// The lost content of a tag.
fn loss(tag: &Tag<'_>) -> Option<Loss> {
    let (what, expected) = stated(tag)?;
    Some(Loss { what: what.to_owned(), expected: expected.to_owned() })
}

/// The lost content of a tag, and the expected replacement.
fn stated(tag: &Tag<'_>) -> Option<(&'static str, &'static str)> {
    let name = letters(&tag.name());
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if says_loop(&name) || has(&["equality"]) || name.ends_with("constraint") {
        return Some(("a closed loop or a constraint", LOOP));
    }
    if has(&["bushing"]) {
        return Some(("a spring and damper between two links", "none: it is not read, and no such force acts"));
    }
    if is_joint(tag) {
        return Some(("a joint", "<joint> directly inside <robot>: it is not read, and the dynamics are those without it"));
    }
    if (has(&["spring", "stiffness", "tendon"])) && !has(&["springreference", "implicitspring", "contact"]) && !is_off(tag) {
        return Some(("a spring", "`effects` of a scene, which has springs: it is not read, and no such force acts"));
    }
    if name == "mimic" && tag.attribute("joint").is_some() {
        return Some(("a joint that follows another", "<mimic> inside <joint>: it is not read, and the joint moves by itself"));
    }
    if (name == "turngravityoff" && is_on(tag)) || (name == "gravity" && is_off(tag)) {
        return Some(("a link without gravity", "gravity on all links: it is not turned off"));
    }
    None
}

fn value<'a>(tag: &Tag<'a>) -> Option<&'a str> {
    tag.attribute("value").map(|(value, _)| value.trim()).or_else(|| tag.text().map(|(text, _)| text))
}

fn is_off(tag: &Tag<'_>) -> bool {
    value(tag).is_some_and(|value| value.eq_ignore_ascii_case("false") || value.parse() == Ok(0.0))
}

fn is_on(tag: &Tag<'_>) -> bool {
    value(tag).is_some_and(|value| value.eq_ignore_ascii_case("true") || value == "1")
}
