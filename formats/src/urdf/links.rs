//! The tag `<link>`.

use articulated_core::description::Inertial;
use articulated_core::diagnostic::{Code, Diagnostics, Subject};

use super::ast::DraftLink;
use super::robot::Context;
use super::{collision, frame, inertia, unused, visual};
use crate::xml::element::Tag;
use crate::xml::number;

/// A link with its mass properties, its collision geometry and its appearance.
pub(crate) fn link(tag: &Tag<'_>, context: &Context<'_>, log: &mut Diagnostics) -> DraftLink {
    let subject = Subject::Link(tag.name_for_messages());
    let tag = tag.of(&subject);
    let name = tag.required_name("name", log);
    name.iter().for_each(|name| unused::warn_of_blanks(&tag, name, log));
    unused::rest(&tag, &["inertial"], &["name"], log);
    let inertial = tag.only("inertial", log).and_then(|tag| inertial(&tag, context, log));
    let (collision, visual) = (collision::all(&tag, context, log), visual::all(&tag, context, log));
    DraftLink { name, at: tag.at(), inertial, collision, visual }
}

fn inertial(tag: &Tag<'_>, context: &Context<'_>, log: &mut Diagnostics) -> Option<Inertial> {
    unused::rest(tag, &["origin", "mass", "inertia"], &[], log);
    let origin = frame::origin(tag, context, log);
    let mass = mass(tag, log);
    let moments = moments(tag, log);
    inertia::check(mass, moments, context, &tag.place("inertial"), log);
    Some(Inertial { origin, mass: mass?, inertia: moments? })
}

fn mass(inertial: &Tag<'_>, log: &mut Diagnostics) -> Option<f64> {
    if let Some(density) = inertial.children().find(|child| child.is("density"))
        && !inertial.children().any(|child| child.is("mass"))
    {
        let expected = "<mass> and <inertia>: <density> is an extension of Bullet, which is not read";
        log.error(density.place("mass"), Code::MissingTag, "<density> alone", expected);
        return None;
    }
    let tag = inertial.required("mass", log)?;
    unused::rest(&tag, &[], &["value"], log);
    number::required(&tag, "value", log)
}

fn moments(inertial: &Tag<'_>, log: &mut Diagnostics) -> Option<[f64; 6]> {
    const NAMES: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    let tag = inertial.required("inertia", log)?;
    unused::rest(&tag, &[], &NAMES, log);
    let [xx, xy, xz, yy, yz, zz] = NAMES.map(|name| number::required(&tag, name, log));
    Some([xx?, xy?, xz?, yy?, yz?, zz?])
}
