//! Links that go below a plane of contact where no contact holds them.

use std::fmt::Write;

use articulated::Dynamics;
use articulated_core::Plain;
use articulated_core::description::{Collision, ContactSphere, Link};
use articulated_core::effect::{EffectId, unit};
use articulated_core::index::{BodyId, ById, FrameId};

use crate::session::{Session, field};

/// A link with collision geometry deeper in a plane of contact than the contacts of its body.
#[derive(Clone, Debug, PartialEq)]
pub struct Penetration {
    /// The link.
    pub link: String,
    /// Time at which it is first found there, s.
    pub from: f64,
    /// Largest depth found, m.
    pub depth: f64,
    /// Time of the largest depth, s.
    pub at: f64,
}

/// Tolerated extra depth of geometry, relative to its size: contact points are seldom exactly on
/// it.
const BESIDE: f64 = 0.05;

/// Number of links that a warning names.
const NAMED: usize = 5;

/// A plane of contact: its normal, of length one, and its height along it, m.
type Plane = ([f64; 3], f64);

/// Geometry of a link that may be below a plane.
struct Part<'s> {
    link: &'s str,
    /// The link's frame.
    frame: FrameId,
    spheres: Vec<ContactSphere>,
    /// Tolerated depth beyond that of the contacts, m.
    beside: f64,
}

/// A contact: its body, frame, sphere and plane.
struct Touch {
    body: BodyId,
    frame: FrameId,
    sphere: ContactSphere,
    plane: Plane,
}

/// Depths of links below planes of contact, state by state: of links with collision geometry that
/// are below a plane by more than the contacts of their body, and a twentieth of their size. Of
/// meshes, which are not read, the link's centre of mass counts.
pub(crate) struct Depths<'s> {
    session: &'s Session,
    touches: Vec<Touch>,
    planes: Vec<Plane>,
    parts: Vec<Part<'s>>,
    found: Vec<Option<Penetration>>,
    /// Depth of each part in the first state, m; 0 if it was not too deep.
    at_start: Option<Vec<f64>>,
}

impl<'s> Depths<'s> {
    pub(crate) fn of(session: &'s Session) -> Self {
        let touches = session.touches();
        let mut planes: Vec<Plane> = Vec::new();
        touches.iter().for_each(|touch| planes.extend(Some(touch.plane).filter(|plane| !planes.contains(plane))));
        let parts = if planes.is_empty() { Vec::new() } else { session.parts() };
        Self { session, touches, planes, found: parts.iter().map(|_| None).collect(), parts, at_start: None }
    }

    /// A state at this time, s, by the placements of the model's frames, `[frames][12]`.
    pub(crate) fn add(&mut self, t: f64, places: &[f64]) {
        for plane in &self.planes {
            let held = self.session.held(&self.touches, plane, places);
            for (part, found) in self.parts.iter().zip(&mut self.found) {
                let depth = part.spheres.iter().map(|s| depth(s, &places[12 * part.frame.0..][..12], plane)).fold(f64::MIN, f64::max);
                if depth <= held[self.session.model.frames()[part.frame].body] + part.beside {
                    continue;
                }
                let new = || Penetration { link: part.link.to_owned(), from: t, depth, at: t };
                let known = found.get_or_insert_with(new);
                if depth > known.depth {
                    (known.depth, known.at) = (depth, t);
                }
            }
        }
        let depths = || self.found.iter().map(|found| found.as_ref().map_or(0.0, |p| p.depth)).collect();
        self.at_start.get_or_insert_with(depths);
    }

    /// The links that went too deep, the deepest first. Those that were too deep from the start are
    /// left out unless they sank much deeper.
    pub(crate) fn found(self) -> Vec<Penetration> {
        let at_start = self.at_start.unwrap_or_default();
        let sank = |(k, found): (usize, Option<Penetration>)| found.filter(|p| p.depth > 1.5 * at_start.get(k).copied().unwrap_or(0.0));
        deepest_first(self.found.into_iter().enumerate().filter_map(sank).collect())
    }
}

fn deepest_first(mut found: Vec<Penetration>) -> Vec<Penetration> {
    found.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    found
}

impl Session {
    /// Links that are below a plane of contact, without a contact that holds them, at the
    /// coordinates q `[nq]`; the deepest first. Empty if the scene has no contact.
    pub fn penetrations_at(&self, q: &[f64]) -> Vec<Penetration> {
        let (mut depths, mut places) = (Depths::of(self), vec![0.0; 12 * self.model.frames().len()]);
        if depths.parts.is_empty() || self.model.placements(&mut self.model.workspace(), q, &mut places).is_err() {
            return Vec::new();
        }
        depths.add(0.0, &places);
        deepest_first(depths.found.into_iter().flatten().collect())
    }

    /// A warning of links that are below a plane at the coordinates q `[nq]`, where a motion
    /// starts.
    pub fn warning_of_penetrations_at_start(&self, q: &[f64]) -> Option<String> {
        let found = self.penetrations_at(q);
        let (which, them) = count(found.len())?;
        let list = listed(&found, |p| format!("{:?} ({} m deep)", p.link, Plain(rounded(p.depth))));
        let file = &self.scene.file;
        Some(format!(
            "{file}: effects.contact: found {which} below a contact plane at the start where no contact holds {them}: {list}, expected {them} above the plane \
             (by height, normal or initial.q), or {ADVICE}; used as given"
        ))
    }

    /// A warning of links that went below a plane in a motion
    /// ([`Outcome::penetrations`](crate::Outcome::penetrations)).
    pub fn warning_of_penetrations(&self, found: &[Penetration]) -> Option<String> {
        let (which, them) = count(found.len())?;
        let list = listed(found, |p| {
            let [from, at, depth] = [p.from, p.at, rounded(p.depth)].map(Plain);
            format!("{:?} from t = {from} s on, {depth} m deep at t = {at} s", p.link)
        });
        let file = &self.scene.file;
        let goes = if found.len() == 1 { "goes" } else { "go" };
        Some(format!(
            "{file}: effects.contact: found {which} that {goes} below a contact plane where no contact holds {them}: {list}, expected {ADVICE}"
        ))
    }

    /// All contacts of the scene.
    fn touches(&self) -> Vec<Touch> {
        let contacts = self.effects_of(EffectId::contact).filter_map(|contact| {
            let frame = self.model.frames().position(|frame| frame.name == contact.on)?;
            let normal = unit(field(contact, "normal").try_into().ok()?)?;
            let sphere = ContactSphere { center: contact.at.xyz, radius: *field(contact, "radius").first()? };
            let plane = (normal, *field(contact, "height").first()?);
            Some(Touch { body: self.model.frames()[frame].body, frame, sphere, plane })
        });
        contacts.collect()
    }

    /// Collision geometry of the links that move.
    fn parts(&self) -> Vec<Part<'_>> {
        let frames = self.model.frames();
        let links = self.description.links.iter().filter(|link| !link.collision.is_empty());
        let placed = links.filter_map(|link| Some((link, frames.position(|frame| frame.name == link.name)?)));
        let moving = placed.filter(|(_, frame)| frames[*frame].body != BodyId::BASE);
        moving.map(|(link, frame)| Part::of(link, frame)).filter(|part| !part.spheres.is_empty()).collect()
    }

    /// Depth of the deepest contact of each body in a plane, m; 0 without contact.
    fn held(&self, touches: &[Touch], plane: &Plane, places: &[f64]) -> ById<BodyId, f64> {
        let mut held: ById<BodyId, f64> = vec![0.0; self.model.bodies().len()].into();
        for touch in touches.iter().filter(|touch| touch.plane == *plane) {
            held[touch.body] = held[touch.body].max(depth(&touch.sphere, &places[12 * touch.frame.0..][..12], plane));
        }
        held
    }
}

impl<'s> Part<'s> {
    fn of(link: &'s Link, frame: FrameId) -> Self {
        let mut spheres: Vec<ContactSphere> = link.collision.iter().flat_map(Collision::contact_spheres).collect();
        if spheres.is_empty() {
            spheres.extend(link.inertial.map(|inertial| ContactSphere { center: inertial.origin.xyz, radius: 0.0 }));
        }
        Self { link: &link.name, frame, beside: BESIDE * diagonal(&spheres), spheres }
    }
}

/// The diagonal of the box around spheres, m.
fn diagonal(spheres: &[ContactSphere]) -> f64 {
    let extent = |k: usize| {
        let end = |sign: f64| spheres.iter().map(|s| sign * s.center[k] + s.radius).fold(f64::MIN, f64::max);
        (end(1.0) + end(-1.0)).max(0.0)
    };
    (0..3).map(|k| extent(k) * extent(k)).sum::<f64>().sqrt()
}

/// Depth in a plane of a sphere of a frame with this placement, m.
fn depth(sphere: &ContactSphere, x: &[f64], (normal, height): &Plane) -> f64 {
    let center = |k: usize| x[9 + k] + (0..3).map(|c| x[3 * k + c] * sphere.center[c]).sum::<f64>();
    height + sphere.radius - (0..3).map(|k| normal[k] * center(k)).sum::<f64>()
}

const ADVICE: &str =
    "contact there: `from = \"collision\"` in `effects.contact` makes it of boxes, cylinders, spheres and capsules in <collision>";

fn count(links: usize) -> Option<(String, &'static str)> {
    match links {
        0 => None,
        1 => Some(("1 link".to_owned(), "it")),
        n => Some((format!("{n} links"), "them")),
    }
}

fn listed(found: &[Penetration], one: impl Fn(&Penetration) -> String) -> String {
    let mut list = String::new();
    for (k, penetration) in found.iter().take(NAMED).enumerate() {
        let _ = write!(list, "{}{}", if k > 0 { "; " } else { "" }, one(penetration));
    }
    if found.len() > NAMED {
        let _ = write!(list, "; and {} more", found.len() - NAMED);
    }
    list
}

/// To three digits, for people.
pub(crate) fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
