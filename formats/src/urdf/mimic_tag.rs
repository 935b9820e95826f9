//! The tags `<mimic>` of a joint: the joints that it follows, and the law.

use std::collections::HashMap;

use articulated_core::diagnostic::{At, Code, Diagnostics, Place, quote};
use articulated_core::suggest::Suggester;

use super::ast::{DraftMimic, Reference};
use super::coupled::Parts;
use super::unused;
use crate::xml::element::Tag;
use crate::xml::markup;
use crate::xml::number::{self, attribute};

/// The tag in `<drake:joint>`.
pub(crate) const DRAKE_MIMIC: &str = "drake:mimic";

const ATTRIBUTES: [&str; 3] = ["joint", "multiplier", "offset"];

/// Other attributes that only label the tag.
const LABELS: [&str; 4] = ["name", "id", "comment", "description"];

/// The joints that a joint follows. Two tags for one leader are an error.
pub(crate) fn mimics(joint: &Tag<'_>, log: &mut Diagnostics) -> Vec<DraftMimic> {
    let mut first: HashMap<&str, Tag<'_>> = HashMap::new();
    let mut mimics = Vec::new();
    for tag in joint.children().filter(|tag| tag.is("mimic") || tag.is(DRAKE_MIMIC)) {
        let leader = tag.attribute("joint").map_or("", |(name, _)| name);
        if let Some(first) = first.get(leader) {
            let of = if leader.is_empty() { String::new() } else { format!(" of joint {}", quote(leader)) };
            tag.report_again(first, &tag.name(), (&of, "one <mimic> for each joint to follow"), log);
            continue;
        }
        first.insert(leader, tag);
        mimics.extend(mimic(&tag, log));
    }
    mimics
}

fn mimic(tag: &Tag<'_>, log: &mut Diagnostics) -> Option<DraftMimic> {
    report_laws(tag, log);
    let multiplier = attribute(tag, "multiplier", log);
    let offset = attribute(tag, "offset", log);
    let name = tag.required_name("joint", log)?;
    Some(DraftMimic { leader: Reference { name, at: tag.at() }, multiplier, offset })
}

/// Reports unknown attributes and tags. They are errors, because they may define another law than
/// the linear one; harmless ones are warnings.
fn report_laws(tag: &Tag<'_>, log: &mut Diagnostics) {
    for (name, value, at) in tag.attributes_with_lines() {
        let (name, value) = (markup::as_written(name), value.trim());
        if ATTRIBUTES.contains(&name.as_str()) {
            continue;
        }
        match is_harmless(&name, value) {
            true => unused::attribute_of(tag, &name, &ATTRIBUTES, log),
            false => report_law(tag, (&format!("the attribute {name} = {}", quote(value)), &name, at), log),
        }
    }
    for child in tag.children() {
        let name = child.name();
        let says_nothing = child.text().is_none() && child.attributes().next().is_none() && child.children().next().is_none();
        match says_nothing {
            true => unused::child_of(tag, &child, &Parts::default(), &[], log),
            false => report_law(tag, (&format!("the tag <{name}>"), &name, child.at()), log),
        }
    }
    unused::text_of(tag, log);
}

fn report_law(tag: &Tag<'_>, (found, name, at): (&str, &str, At), log: &mut Diagnostics) {
    let near = Suggester::default().misspelt(name, ATTRIBUTES);
    let code = if near.is_some() { Code::Misspelt } else { Code::Unknown };
    let hint = near.map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
    let expected = format!(
        "the attributes joint, multiplier and offset{hint}: q = multiplier · q of the joint + offset is the one law that is read; \
         remove what does not change it"
    );
    log.error(Place { at, ..tag.place(&format!("{} {name}", tag.name())) }, code, found.to_owned(), expected);
}

/// Whether an attribute does not concern the law: a label, a declaration of a prefix, or a value
/// that is empty, zero or false. A misspelt name of the format's own counts as that name.
fn is_harmless(name: &str, value: &str) -> bool {
    if name.starts_with("xmlns") || LABELS.contains(&name) {
        return true;
    }
    let says_nothing = value.is_empty() || number::parse(value) == Ok(0.0) || value.eq_ignore_ascii_case("false");
    says_nothing && Suggester::default().misspelt(name, ATTRIBUTES).is_none()
}
