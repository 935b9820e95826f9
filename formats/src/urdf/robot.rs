//! The tag `<robot>`: only its direct children are links and joints.

use std::collections::BTreeMap;

use super::ast::{DRAKE_JOINT, Draft, DraftLink, PassedOver};
use super::coupled::{self, Parts};
use super::{compiler, frame, joint_forces, joints, links, unused, visual};
use crate::Options;
use crate::xml::element::Tag;
use articulated_core::diagnostic::{Code, Diagnostics, Place, quote};

/// The version of the format that a file names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Version {
    V1_0,
    /// Adds `quat_xyzw`.
    V1_1,
    /// A missing bound is infinite; before, it is zero.
    V1_2,
}

const VERSIONS: [(&str, Version); 4] = [("1", Version::V1_0), ("1.0", Version::V1_0), ("1.1", Version::V1_1), ("1.2", Version::V1_2)];

/// The context of reading a tag.
pub(crate) struct Context<'a> {
    pub(crate) options: &'a Options,
    pub(crate) version: Version,
    /// The longest distance from one frame to the next in the file, m; at most 1 m, and 1 m where
    /// all are zero.
    pub(crate) length: f64,
    /// Colours of materials by their names.
    pub(crate) materials: BTreeMap<String, [f64; 4]>,
}

/// All links and joints; all errors of each are reported.
pub(crate) fn draft(robot: &Tag<'_>, options: &Options, log: &mut Diagnostics) -> Draft {
    let name = robot.required_name("name", log).unwrap_or_default();
    unused::warn_of_blanks(robot, &name, log);
    let used: (&[&str], &[&str]) = (&["link", "joint", DRAKE_JOINT, "transmission"], &["name", "version"]);
    unused::rest_beside(robot, &Parts::of(robot), used, log);
    let context =
        Context { options, version: version(robot, options, log), length: frame::longest(robot), materials: visual::materials(robot) };
    let mut draft = Draft { name, ..Draft::default() };
    for tag in robot.children() {
        if tag.is("link") {
            draft.links.push(links::link(&tag, &context, log));
        } else if tag.is("joint") || tag.is(DRAKE_JOINT) {
            draft.joints.push(joints::joint(&tag, &context, log));
        } else if coupled::is_joint(&tag) {
            let name = tag.name_for_messages();
            draft.passed_over.push(PassedOver { at: tag.at(), tag: tag.name(), name });
        }
    }
    if draft.links.is_empty() {
        log.error(robot.place("link"), Code::NoLinks, "no link", "a robot with at least one link");
    }
    declare_world(&mut draft, log);
    joint_forces::keep_rotors(robot, &mut draft.joints, log);
    joint_forces::keep_springs(robot, &mut draft.joints, log);
    compiler::warn(robot, &draft.links, log);
    draft
}

/// The name of the link that other programs add if a joint hangs on it and it is not declared.
const WORLD: &str = "world";

/// Adds the link `world`, if joints hang on it and the file does not declare it.
fn declare_world(draft: &mut Draft, log: &mut Diagnostics) {
    let is_world = |name: &str| name == WORLD;
    if draft.links.iter().any(|link| link.name.as_deref().is_some_and(is_world))
        || draft.joints.iter().any(|joint| joint.child.as_ref().is_some_and(|child| is_world(&child.name)))
    {
        return;
    }
    let Some((joint, parent)) =
        draft.joints.iter().find_map(|joint| Some((joint, joint.parent.as_ref().filter(|parent| is_world(&parent.name))?)))
    else {
        return;
    };
    let (subject, at) = (joint.subject(), parent.at);
    let place = Place { at, subject: &subject, field: "parent" };
    let found = format!("{}, which is not a link of this file", quote(WORLD));
    log.warning(place, Code::UndeclaredWorld, found, "<link name=\"world\"/>; added as a link without mass");
    draft.links.push(DraftLink { name: Some(WORLD.to_owned()), at, inertial: None, collision: Vec::new(), visual: Vec::new() });
}

/// The option that reads other versions, as the command, scenes and macro, and build scripts spell
/// it.
const ALLOW_UNKNOWN_VERSION: &str = "`--allow-unknown-version` (key `allow_unknown_version`, method `Build::allow_unknown_version`)";

fn version(robot: &Tag<'_>, options: &Options, log: &mut Diagnostics) -> Version {
    let Some((given, at)) = robot.attribute("version") else {
        return Version::V1_0;
    };
    let version = VERSIONS.iter().find(|(name, _)| *name == given.trim());
    if version.is_none() {
        let place = Place { at, ..robot.place("version") };
        let found = format!("the version {}", quote(given.trim()));
        match options.allow_unknown_version {
            true => log.warning(place, Code::Version, found, "1.0, 1.1 or 1.2; read as 1.0"),
            false => log.error(place, Code::Version, found, format!("1.0, 1.1 or 1.2; {ALLOW_UNKNOWN_VERSION} reads it as 1.0")),
        }
    }
    version.map_or(Version::V1_0, |(_, version)| *version)
}
