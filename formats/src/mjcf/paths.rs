//! Paths of spatial tendons: straight lines over sites, with pulleys.

use std::collections::HashMap;

use articulated_core::actuator::path_at;
use articulated_core::algorithm::Workspace;
use articulated_core::description::{Base, Description};
use articulated_core::diagnostic::{Code, Diagnostics, Subject};
use articulated_core::model::Model;

use super::bodies::Kind;
use super::element::Element;
use super::reflected::Drives;
use super::scope::{Scope, freedoms, reference};
use super::values::Values;
use crate::actuation::strands_of;
use crate::world::Strand;

/// A path, with its lengths in poses of the file.
pub(crate) struct Path {
    pub(crate) strands: Vec<Strand>,
    /// Its length in the reference pose, m.
    pub(crate) at_reference: f64,
    /// Its length where springs of joints are at rest, m.
    pub(crate) at_rest: f64,
    /// Length for a unit of each rate, in the reference pose.
    pub(crate) row: Drives,
}

/// Points of paths times links of the file: more are not measured.
const MOST: usize = 20_000_000;
/// Most links of a file with paths.
const MOST_LINKS: usize = 10_000;

/// The file in which lengths are measured.
pub(crate) struct Places<'a> {
    description: &'a Description,
    links: &'a [String],
    /// Made for the first path.
    known: Option<Known>,
    /// How many points times links were measured.
    measured: usize,
}

/// The model of a file.
struct Known {
    model: Model<f64>,
    ws: Workspace<f64>,
    /// Coordinates of the reference pose, and those where springs of joints are at rest.
    at: [Vec<f64>; 2],
    /// The first degree of freedom of each joint of the file.
    starts: Vec<usize>,
}

impl Known {
    fn of(description: &Description, scope: &Scope<'_>) -> Option<Self> {
        let model: Model<f64> = Model::new(description, Base::Fixed).ok()?;
        let mut at = [vec![0.0; model.nq()], vec![0.0; model.nq()]];
        let places: HashMap<&str, (usize, usize)> =
            model.joints().iter().map(|joint| (joint.name.as_str(), (joint.q.0, joint.v.0))).collect();
        let mut starts = Vec::with_capacity(scope.joints.len());
        for known in &scope.joints {
            let &(q, v) = places.get(known.name)?;
            let start = reference(scope, known);
            let is_number = matches!(known.joint.kind, Kind::Hinge | Kind::Slide);
            let rest = if is_number { vec![known.joint.rest] } else { start.clone() };
            at.iter_mut().zip([start, rest]).for_each(|(all, own)| all[q..][..own.len()].copy_from_slice(&own));
            starts.push(v);
        }
        let ws = Workspace::new(&model);
        Some(Self { model, ws, at, starts })
    }
}

impl<'a> Places<'a> {
    /// `links`: the name of the link of each body.
    pub(crate) fn new(description: &'a Description, links: &'a [String]) -> Self {
        Self { description, links, known: None, measured: 0 }
    }

    /// The path of a tag `<spatial>`; `sites`: those of its tags `<site>`, in order. `None`: it
    /// goes around a geom, or the file has mistakes, which are reported.
    pub(crate) fn path(&mut self, element: &Element, sites: &[usize], scope: &Scope<'_>, log: &mut Diagnostics) -> Option<Path> {
        let strands = strands(element, sites, self.links, scope, log)?;
        if !log.is_ok() {
            return None;
        }
        let points: usize = strands.iter().map(|strand| strand.points.len()).sum();
        self.measured = self.measured.saturating_add((points + 2).saturating_mul(self.links.len()));
        if self.measured > MOST || self.links.len() > MOST_LINKS {
            let expected = format!("at most {MOST_LINKS} links, and {MOST} points of tendons times links");
            element.error((&Subject::Document, ""), Code::TooLarge, "very many points of spatial tendons", expected, log);
            return None;
        }
        if self.known.is_none() {
            self.known = Known::of(self.description, scope);
        }
        let Known { model, ws, at, starts } = self.known.as_mut()?;
        let path = strands_of(model, &strands)?;
        let (at_reference, entries) = path_at(model, ws, &at[0], &path);
        let (at_rest, _) = path_at(model, ws, &at[1], &path);
        let mut full = vec![0.0; model.nv()];
        entries.iter().for_each(|(k, entry)| full[*k] += entry);
        let mut row: Drives = Vec::new();
        for (index, (known, start)) in scope.joints.iter().zip(&*starts).enumerate() {
            let gears = full[*start..][..freedoms(known.joint.kind)].to_vec();
            if gears.iter().any(|gear| *gear != 0.0) {
                row.push((index, gears));
            }
        }
        Some(Path { strands, at_reference, at_rest, row })
    }
}

/// The strands of a tag. `None`: it goes around a geom, or it has mistakes.
fn strands(element: &Element, sites: &[usize], links: &[String], scope: &Scope<'_>, log: &mut Diagnostics) -> Option<Vec<Strand>> {
    let subject = &Subject::Document;
    let parts: Vec<&Element> = element.children.iter().filter(|inner| matches!(inner.name.as_str(), "site" | "pulley" | "geom")).collect();
    let mut sites = sites.iter();
    let mut strands = vec![Strand { points: Vec::new(), factor: 1.0 }];
    let mut wrong = |inner: &Element, found: &str, expected: &str| inner.error((subject, ""), Code::Misplaced, found, expected, log);
    if parts.len() < 2 {
        wrong(element, "a path of less than two points", "the sites of the tendon");
    }
    let is_pulley = |k: Option<usize>| k.and_then(|k| parts.get(k)).is_none_or(|part| part.is("pulley"));
    for (k, part) in parts.iter().enumerate() {
        let (before, after) = (k.checked_sub(1), Some(k + 1));
        if part.is("pulley") {
            if k + 1 == parts.len() {
                wrong(part, "a pulley at the end", "sites behind it");
            } else if k > 0 && is_pulley(before) {
                wrong(part, "a pulley behind a pulley", "sites between them");
            }
        } else if part.is("site") {
            if is_pulley(before) && is_pulley(after) {
                wrong(part, "a site alone between pulleys", "another one beside it");
            }
            let again = before.and_then(|k| parts.get(k)).filter(|other| other.is("site") && other.text("site") == part.text("site"));
            if again.is_some() {
                wrong(part, "the same site again", "another one");
            }
        } else if k == 0 || k + 1 == parts.len() || !parts[k - 1].is("site") || !parts[k + 1].is("site") {
            wrong(part, "a geom that is not between two sites", "one before it and one behind it");
        }
    }
    for part in &parts {
        if part.is("pulley") {
            if part.attribute("divisor").is_none() {
                part.error((subject, "divisor"), Code::MissingAttribute, "none", "the divisor of the pulley", log);
            }
            let divisor = Values::alone(part, subject).number("divisor", log).unwrap_or(1.0);
            if divisor <= 0.0 {
                part.error((subject, "divisor"), Code::Number, format!("{divisor}"), "a number above zero", log);
            }
            strands.push(Strand { points: Vec::new(), factor: 1.0 / divisor });
        } else if let Some((site, body)) = sites.next().filter(|_| part.is("site")).and_then(|index| scope.sites.get(*index)) {
            strands.last_mut()?.points.push((links[*body].clone(), site.pose.origin()));
        }
    }
    strands.retain(|strand| !strand.points.is_empty());
    let wraps = parts.iter().any(|part| part.is("geom"));
    (!wraps && log.is_ok()).then_some(strands)
}
