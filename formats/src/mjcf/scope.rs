//! Names of joints and tendons, as other parts of the file refer to them.

use std::collections::{BTreeMap, BTreeSet};

use articulated_core::diagnostic::{At, Code, Diagnostics, Subject, quote};
use articulated_core::suggest::nearest;

use super::bodies::{Extent, Joint, Kind, Part, Site, Tree};
use super::element::Element;
use crate::pose::{IDENTITY, scalar_last};

/// Maximum number of references of actuators, tendons and equations, including those of copies. A
/// name counts by its length.
const MOST: usize = 250_000;
/// Bytes of a name that count as one reference.
const BYTES_OF_A_REFERENCE: usize = 64;
/// Maximum number of errors with hints.
const HINTS: usize = 100;

/// Kinds of named items.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sort {
    Joint,
    Tendon,
    Site,
    Body,
    Geom,
}

impl Sort {
    fn name(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::Tendon => "tendon",
            Self::Site => "site",
            Self::Body => "body",
            Self::Geom => "geom",
        }
    }
}

/// A joint with its name in the description.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    pub(crate) joint: &'a Joint<'a>,
    pub(crate) name: &'a str,
    /// The index of its body.
    pub(crate) body: usize,
}

/// The names of a model.
pub(crate) struct Scope<'a> {
    pub(crate) tree: &'a Tree<'a>,
    /// In the order of MuJoCo's coordinates.
    pub(crate) joints: Vec<Known<'a>>,
    /// All sites, each with the index of its body.
    pub(crate) sites: Vec<(&'a Site<'a>, usize)>,
    /// All geoms: the index of the body, and the place in its list.
    pub(crate) geoms: Vec<(usize, usize)>,
    /// Indices and parts by full names.
    names: BTreeMap<(Sort, String), (usize, usize)>,
    /// Names as the documents have them.
    own: BTreeSet<(Sort, &'a str)>,
    /// Whether all joints are known: otherwise an unknown name may be that of an invalid joint.
    is_complete: bool,
    /// Reported warnings, by the address of the tag: a document may be in several parts.
    reported: BTreeSet<(*const Element, String)>,
    looked_up: usize,
    /// The name of the main file.
    main: &'a str,
}

/// References of a tag: kind, attribute, and name.
pub(crate) type References<'a> = Vec<(Sort, &'static str, &'a str)>;

impl<'a> Scope<'a> {
    /// `names`: those of all joints in the description, in the order of the bodies.
    pub(crate) fn new(main: &'a str, tree: &'a Tree<'a>, names: &'a [String], is_complete: bool) -> Self {
        let all = tree.bodies.iter().enumerate().flat_map(|(body, own)| own.joints.iter().map(move |joint| (body, joint)));
        let joints: Vec<Known<'_>> = all.zip(names).map(|((body, joint), name)| Known { joint, name, body }).collect();
        let (names, own, reported) = (BTreeMap::new(), BTreeSet::new(), BTreeSet::new());
        let mut scope =
            Self { tree, joints: Vec::new(), sites: Vec::new(), geoms: Vec::new(), names, own, is_complete, reported, looked_up: 0, main };
        for (index, Known { joint, .. }) in joints.iter().enumerate() {
            scope.add(Sort::Joint, joint.element, joint.name.as_ref(), (index, joint.part));
        }
        for (index, body) in tree.bodies.iter().enumerate() {
            scope.add(Sort::Body, body.element, body.name.as_ref(), (index, body.part));
            for site in &body.sites {
                scope.add(Sort::Site, site.element, site.name.as_ref(), (scope.sites.len(), site.part));
                scope.sites.push((site, index));
            }
            for (place, geom) in body.geoms.iter().enumerate() {
                scope.add(Sort::Geom, geom.element, geom.name.as_ref(), (scope.geoms.len(), geom.part));
                scope.geoms.push((index, place));
            }
        }
        scope.joints = joints;
        scope
    }

    /// Adds the full name of the item of a part's tag, with its index.
    pub(crate) fn add(&mut self, sort: Sort, element: &'a Element, full: Option<&String>, (index, part): (usize, usize)) {
        if let (Some(full), Some(own)) = (full, element.text("name")) {
            self.names.entry((sort, full.clone())).or_insert((index, part));
            self.own.insert((sort, own));
        }
    }

    /// Whether the maximum number of references was looked up.
    pub(crate) fn is_full(&self) -> bool {
        self.looked_up >= MOST
    }

    /// The part itself.
    pub(crate) fn part(&self, part: usize) -> &'a Part<'a> {
        &self.tree.parts[part]
    }

    /// The index of the item with this name in a part, and whether it is inside the part.
    fn find(&self, part: usize, sort: Sort, own: &str) -> Option<(usize, bool)> {
        let mut at = part;
        loop {
            let Part { prefix, suffix, extent, parent, parts, .. } = self.part(at);
            let found = self.names.get(&(sort, format!("{prefix}{own}{suffix}"))).copied();
            match found.filter(|(_, of)| *extent == Extent::Whole || parts.contains(of)) {
                Some((index, _)) => return Some((index, at == part)),
                None if *extent == Extent::Copy => at = *parent,
                None => return None,
            }
        }
    }

    /// The indices of the items that a tag of a part refers to; `None` if the tag does not refer to
    /// this part. An error if it refers to no part.
    pub(crate) fn resolve(
        &mut self,
        part: usize,
        element: &Element,
        references: &References<'_>,
        log: &mut Diagnostics,
    ) -> Option<Vec<usize>> {
        let Part { prefix, suffix, .. } = self.part(part);
        let letters = prefix.len() + suffix.len() + element.text("name").map_or(0, str::len);
        let cost = references.len().max(1) + letters / BYTES_OF_A_REFERENCE;
        self.looked_up += cost;
        if self.is_full() {
            let found = "very many copies of actuators, tendons and equations";
            if self.looked_up - cost < MOST {
                element.error((&Subject::Document, ""), Code::TooLarge, found, format!("at most {MOST} references"), log);
            }
            return None;
        }
        let found: Vec<Option<(usize, bool)>> = references.iter().map(|(sort, _, own)| self.find(part, *sort, own)).collect();
        let extent = self.part(part).extent;
        let is_inside = match extent {
            Extent::Whole | Extent::Attached => true,
            Extent::Copy => found.iter().flatten().any(|(_, is_inside)| *is_inside),
        };
        let all: Option<Vec<usize>> = found.iter().map(|found| found.map(|(index, _)| index)).collect();
        if all.is_none() && extent == Extent::Whole && self.is_complete {
            let unknown =
                |(sort, _, own): &&(Sort, &'static str, &str)| !self.own.contains(&(*sort, *own)) && self.find(part, *sort, own).is_none();
            if let Some((sort, field, own)) = references.iter().find(unknown) {
                // Searching the nearest name for very many errors takes too long.
                let names = self.names.keys().filter(|(known, _)| known == sort && log.errors.len() < HINTS).map(|(_, name)| name.as_str());
                let hint = nearest(own, names).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
                let expected = format!("the name of a {}{hint}", sort.name());
                element.error((&Subject::Document, field), Code::UnknownName, quote(own), expected, log);
            }
        }
        all.filter(|_| is_inside)
    }

    /// Reports once that a tag is not used; a warning if the motion differs without it.
    pub(crate) fn unread(&mut self, element: &Element, why: &str, lost: Option<(&str, &str)>, log: &mut Diagnostics) {
        if self.reported.insert((std::ptr::from_ref(element), String::new())) {
            element.unused(&Subject::Document, None, why, log);
        }
        if let Some(lost) = lost {
            self.warn(element, "", lost, log);
        }
    }

    /// Warns once about a tag: `found`, followed by its name, and `expected`.
    pub(crate) fn warn(&mut self, element: &Element, field: &str, (found, expected): (&str, &str), log: &mut Diagnostics) {
        if self.reported.insert((std::ptr::from_ref(element), format!("{field} {found}"))) {
            let field = if field.is_empty() { element.name.as_str() } else { field };
            let name = element.text("name").filter(|name| !name.is_empty()).map(|name| format!(" {}", quote(name))).unwrap_or_default();
            element.warning((&Subject::Document, field), Code::LostDynamics, format!("{found}{name}"), expected, log);
        }
    }

    /// The place of a tag, if it is in the main file.
    pub(crate) fn place(&self, element: &Element) -> At {
        if element.file.name == self.main { element.at } else { At::Nowhere }
    }

    /// The full name of a tag in a part; `None` if it has no name in the file.
    pub(crate) fn full(&self, part: usize, element: &Element) -> Option<String> {
        let own = element.text("name").filter(|name| !name.is_empty())?;
        let Part { prefix, suffix, .. } = self.part(part);
        Some(format!("{prefix}{own}{suffix}"))
    }
}

/// How many rates a joint has.
pub(crate) fn freedoms(kind: Kind) -> usize {
    match kind {
        Kind::Free => 6,
        Kind::Ball => 3,
        Kind::Slide | Kind::Hinge => 1,
    }
}

/// How many coordinates a joint has.
pub(crate) fn coordinates(kind: Kind) -> usize {
    freedoms(kind) + usize::from(matches!(kind, Kind::Free | Kind::Ball))
}

/// The coordinates of a joint at which its body has its `pos`.
pub(crate) fn reference(scope: &Scope<'_>, known: &Known<'_>) -> Vec<f64> {
    let pose = scope.tree.bodies[known.body].pose;
    match known.joint.kind {
        Kind::Free => pose.position.into_iter().chain(scalar_last(pose.rotation)).collect(),
        Kind::Ball => scalar_last(IDENTITY).to_vec(),
        Kind::Slide | Kind::Hinge => vec![known.joint.reference],
    }
}
