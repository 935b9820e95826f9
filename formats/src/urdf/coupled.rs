//! Couplings of joints, and joints that close loops, that a file states for a simulator: inside
//! `<gazebo>`, `<plugin>` and `<ros2_control>`.

use std::collections::{HashMap, HashSet};

use articulated_core::diagnostic::quote;

use crate::xml::element::Tag;
use crate::xml::markup;
use crate::xml::number::{parse, silently};

/// Lost content, and the expected replacement.
pub(crate) struct Loss {
    pub(crate) what: String,
    pub(crate) expected: String,
}

/// Expected instead of a closed loop.
pub(crate) const LOOP: &str = "a tree of joints: it is not closed, and the dynamics are those of the tree without it";

/// The robot's own content: its links, and the laws of its followers.
#[derive(Default)]
pub(crate) struct Parts<'a> {
    links: HashSet<&'a str>,
    /// Multipliers and offsets of joints that follow others, by the names of the two.
    laws: HashMap<[&'a str; 2], [f64; 2]>,
}

impl<'a> Parts<'a> {
    pub(crate) fn of(robot: &Tag<'a>) -> Self {
        let mut parts = Self::default();
        for tag in robot.children() {
            let Some((name, _)) = tag.attribute("name") else { continue };
            if tag.is("link") {
                parts.links.insert(name);
            } else if tag.is("joint") {
                for mimic in tag.children().filter(|child| child.is("mimic")) {
                    let Some((leader, _)) = mimic.attribute("joint") else { continue };
                    let law = [("multiplier", 1.0), ("offset", 0.0)].map(|(name, x)| silently::<1>(&mimic, name).map_or(x, |[x]| x));
                    parts.laws.entry([name, leader]).or_insert(law);
                }
            }
        }
        parts
    }

    /// The coupling or loop of a tag that is lost.
    pub(crate) fn loss(&self, tag: &Tag<'_>) -> Option<Loss> {
        if tag.is("plugin") {
            return self.plugin(tag);
        }
        if tag.is("joint")
            && let Some(leader) = parameter(tag, "mimic")
        {
            let number = |name| parameter(tag, name).and_then(|word| parse(word).ok());
            return self.coupling(
                tag.attribute("name").map(|(name, _)| name),
                Some(leader),
                [number("multiplier"), number("offset")],
                "a parameter of the joint",
            );
        }
        if !is_joint(tag) {
            return None;
        }
        if tag.attribute("type").is_some_and(|(kind, _)| kind.trim() == "gearbox") {
            let expected = "<mimic> inside <joint>: it is not read, and the joints move by themselves";
            return Some(Loss { what: "a coupling of two joints by the gearbox".to_owned(), expected: expected.to_owned() });
        }
        let [parent, child] = ["parent", "child"].map(|name| end(tag, name).filter(|link| self.links.contains(link)));
        let (parent, child) = (parent?, child?);
        let what = format!("a closed loop between the links {} and {} by the joint", quote(parent), quote(child));
        Some(Loss { what, expected: LOOP.to_owned() })
    }

    fn plugin(&self, tag: &Tag<'_>) -> Option<Loss> {
        let names = ["filename", "name"].map(|name| tag.attribute(name).map_or_else(String::new, |(value, _)| letters(value)));
        if names.iter().any(|name| says_loop(name)) {
            return Some(Loss { what: "a closed loop by the plugin".to_owned(), expected: LOOP.to_owned() });
        }
        if !names.iter().any(|name| name.contains("mimic")) {
            return None;
        }
        let text = |wanted: &str| tag.children().find(|child| letters(&child.name()) == wanted).and_then(|child| Some(child.text()?.0));
        let numbers = ["multiplier", "offset"].map(|name| text(name).and_then(|word| parse(word).ok()));
        self.coupling(text("joint"), text("mimicjoint"), numbers, "the plugin")
    }

    /// The loss of a coupling of joints, unless the robot's own `<mimic>` defines it.
    fn coupling(&self, follower: Option<&str>, leader: Option<&str>, [multiplier, offset]: [Option<f64>; 2], by: &str) -> Option<Loss> {
        let (Some(follower), Some(leader)) = (follower, leader) else {
            let expected = "<mimic> inside <joint>: it is not read, and the joint moves by itself";
            return Some(Loss { what: format!("a coupling of joints by {by}"), expected: expected.to_owned() });
        };
        let law = [multiplier.unwrap_or(1.0), offset.unwrap_or(0.0)];
        let own = self.laws.get(&[follower, leader]);
        if own == Some(&law) {
            return None;
        }
        let [multiplier, offset] = law;
        let what = format!("a coupling of joint {} with joint {}, {multiplier} · q + {offset}, by {by}", quote(follower), quote(leader));
        let joint = quote(follower);
        let expected = match own {
            Some(_) => format!("the law of <mimic> inside joint {joint}: that one is used"),
            None => format!(
                "<mimic joint={} multiplier=\"{multiplier}\" offset=\"{offset}\"/> inside joint {joint}: it is not read, and the joint moves by itself",
                quote(leader)
            ),
        };
        Some(Loss { what, expected })
    }
}

/// The link that a joint of another program names, without the models around it.
fn end<'a>(joint: &Tag<'a>, which: &str) -> Option<&'a str> {
    let tag = joint.children().find(|child| child.is(which))?;
    let name = tag.attribute("link").or_else(|| tag.text())?.0.trim();
    name.rsplit("::").next()
}

/// The text of a `<param>` of this name.
fn parameter<'a>(joint: &Tag<'a>, name: &str) -> Option<&'a str> {
    let is_it = |child: &Tag<'a>| child.is("param") && child.attribute("name").is_some_and(|(own, _)| own == name);
    Some(joint.children().find(is_it)?.text()?.0)
}

/// Whether a name, in small letters, is that of a closed loop.
pub(crate) fn says_loop(name: &str) -> bool {
    ["loopjoint", "closedloop", "kinematicloop"].iter().any(|word| name.contains(word))
}

/// Whether a tag other than `<joint>` joins two links: a joint for another program.
pub(crate) fn is_joint(tag: &Tag<'_>) -> bool {
    let has = |name: &str| tag.children().any(|child| child.is(name));
    letters(&tag.name()).ends_with("joint") && has("parent") && has("child")
}

/// A name without its prefix, in small letters alone.
pub(crate) fn letters(name: &str) -> String {
    let name = markup::as_written(name);
    let name = name.rsplit(':').next().unwrap_or_default();
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}
