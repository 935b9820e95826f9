//! The equations `<connect>` and `<weld>`: points and frames that are held together.

use articulated_core::description::Origin;
use articulated_core::diagnostic::{Code, Diagnostics, Subject};

use super::element::Element;
use super::scope::{References, Scope, Sort};
use super::values::Values;
use crate::pose::{IDENTITY, Pose};
use crate::world::TouchingAnchor;

/// The references of a tag: of both bodies, or of both sites. The world is none.
pub(crate) fn references<'a>(element: &'a Element, log: &mut Diagnostics) -> References<'a> {
    let (sort, fields) = match is_of_bodies(element) {
        true => (Sort::Body, ["body1", "body2"]),
        false => (Sort::Site, ["site1", "site2"]),
    };
    let given = |all: &[&'static str]| all.iter().copied().find(|name| element.attribute(name).is_some());
    if let (Some(site), Some(other)) = (given(&["site1", "site2"]), given(&["body1", "body2", "anchor", "relpose"])) {
        let found = format!("both {site} and {other}");
        element.error((&Subject::Document, other), Code::Together, found, "sites, or bodies with their frames", log);
        return References::new();
    }
    let needed = &fields[..if sort == Sort::Body { 1 } else { 2 }];
    for field in needed.iter().filter(|field| element.attribute(field).is_none()) {
        let expected = match element.is("connect") {
            true => "the attributes body1 and anchor, or site1 and site2",
            false => "the attribute body1, or site1 and site2",
        };
        element.error((&Subject::Document, field), Code::MissingAttribute, "none", expected.to_owned(), log);
    }
    let named = fields.into_iter().filter_map(|field| Some((sort, field, element.text(field)?)));
    named.filter(|(.., name)| !is_world(sort, name)).collect()
}

fn is_of_bodies(element: &Element) -> bool {
    let has = |name: &str| element.attribute(name).is_some();
    has("body1") && (element.is("weld") || has("anchor"))
}

fn is_world(sort: Sort, name: &str) -> bool {
    sort == Sort::Body && name == "world"
}

/// The frames of both. `found`: what the references are; `links`: the link of each body.
pub(crate) fn anchor(
    element: &Element,
    found: &[usize],
    (values, links): (&Values<'_>, &[&str]),
    scope: &Scope<'_>,
    (what, reference, impedance): (String, [f64; 2], [f64; 5]),
    log: &mut Diagnostics,
) -> TouchingAnchor {
    let is_weld = element.is("weld");
    let turns = is_weld.then(|| values.number("torquescale", log).unwrap_or(1.0));
    let anchor = values.exactly::<3>("anchor", log).unwrap_or_default();
    let at = |position: [f64; 3], rotation: [f64; 4]| Some(Pose { position, rotation }.origin());
    let (links, frames): ([&str; 2], [Option<Origin>; 2]) = if is_of_bodies(element) {
        let mut found = found.iter();
        let body = |field: &str| element.text(field).filter(|name| !is_world(Sort::Body, name));
        let own = ["body1", "body2"].map(|field| body(field).and_then(|_| found.next()).map_or(links[0], |body| links[*body]));
        let pose = values.at_most("relpose", [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], log);
        let [x, y, z, turn @ ..] = pose;
        let frames = match (is_weld, turn != [0.0; 4]) {
            (false, _) => [at(anchor, IDENTITY), None],
            (true, false) => [None, at(anchor, IDENTITY)],
            (true, true) => [at([x, y, z], turn), at(anchor, IDENTITY)],
        };
        (own, frames)
    } else {
        let site = |k: usize| scope.sites[found[k]];
        ([0, 1].map(|k| links[site(k).1]), [0, 1].map(|k| Some(site(k).0.pose.origin())))
    };
    TouchingAnchor { what, links: links.map(str::to_owned), frames, turns, reference, impedance }
}
