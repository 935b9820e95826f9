//! The tag `<link>`.

use articulated_core::description::Inertial;

use crate::draft::DraftLink;
use crate::element::Tag;
use crate::log::Log;
use crate::problem::Subject;
use crate::{Options, frame, inertia, number, unused};

/// A link with its mass properties.
pub(crate) fn link(tag: &Tag<'_>, options: &Options, log: &mut Log) -> DraftLink {
    let subject = Subject::Link(tag.name_for_messages());
    let tag = tag.of(&subject);
    let name = tag.required_name("name", log);
    unused::rest(&tag, &["inertial"], &["name"], log);
    let inertial = tag.only("inertial", log).and_then(|tag| inertial(&tag, options, log));
    DraftLink { name, line: tag.line(), inertial }
}

fn inertial(tag: &Tag<'_>, options: &Options, log: &mut Log) -> Option<Inertial> {
    unused::rest(tag, &["origin", "mass", "inertia"], &[], log);
    let origin = frame::origin(tag, options.snap_angles, log);
    let mass = mass(tag, log);
    let moments = moments(tag, log);
    inertia::check(mass, moments, options.allow_unphysical_inertia, &tag.place("inertial"), log);
    Some(Inertial { origin, mass: mass?, inertia: moments? })
}

fn mass(inertial: &Tag<'_>, log: &mut Log) -> Option<f64> {
    let tag = inertial.required("mass", log)?;
    unused::rest(&tag, &[], &["value"], log);
    number::required(&tag, "value", log)
}

fn moments(inertial: &Tag<'_>, log: &mut Log) -> Option<[f64; 6]> {
    const NAMES: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    let tag = inertial.required("inertia", log)?;
    unused::rest(&tag, &[], &NAMES, log);
    let [xx, xy, xz, yy, yz, zz] = NAMES.map(|name| number::required(&tag, name, log));
    Some([xx?, xy?, xz?, yy?, yz?, zz?])
}
