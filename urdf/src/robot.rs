//! The tag `<robot>`: only its direct children are links and joints.

use crate::draft::Draft;
use crate::element::Tag;
use crate::log::Log;
use crate::problem::{Kind, quote};
use crate::{Options, joints, links, unused};

const VERSIONS: [&str; 4] = ["1", "1.0", "1.1", "1.2"];

/// All links and joints, with everything wrong about each of them reported.
pub(crate) fn draft(robot: &Tag<'_>, options: &Options, log: &mut Log) -> Draft {
    let name = robot.required_name("name", log).unwrap_or_default();
    unused::rest(robot, &["link", "joint"], &["name", "version"], log);
    let open = limits_are_open(robot, log);
    let mut draft = Draft { name, ..Draft::default() };
    for tag in robot.children() {
        if tag.is("link") {
            draft.links.push(links::link(&tag, options, log));
        } else if tag.is("joint") {
            draft.joints.push(joints::joint(&tag, open, options, log));
        }
    }
    if draft.links.is_empty() {
        log.error(&robot.place("link"), Kind::NoLinks, "no link", "a robot with at least one link");
    }
    draft
}

/// From version 1.2 on, a bound that is left out is infinite; before, it is zero.
fn limits_are_open(robot: &Tag<'_>, log: &mut Log) -> bool {
    let version = robot.attribute("version").map_or("1.0", |(version, _)| version.trim());
    if !VERSIONS.contains(&version) {
        let expected = "1.0, 1.1 or 1.2; read as 1.0";
        log.warning(&robot.place("version"), Kind::Version, quote(version), expected);
    }
    version == "1.2"
}
