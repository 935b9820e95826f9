//! Links that go below a plane of contact where no contact holds them.

use std::fmt::Write;

use articulated::Dynamics;
use articulated_core::Plain;
use articulated_core::description::{Collision, ContactSphere, Link};
use articulated_core::effect::{EffectId, unit};

use crate::session::{Session, field};

/// A link whose collision geometry is deeper in a plane of contact than the contacts of its body.
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
    frame: usize,
    spheres: Vec<ContactSphere>,
    /// How much deeper than contact it may be, m.
    beside: f64,
}

/// A contact: its body, frame, sphere and plane.
struct Touch {
    body: usize,
    frame: usize,
    sphere: ContactSphere,
    plane: Plane,
}

impl Session {
    /// Links with collision geometry that are below a plane of contact by more than the contacts of
    /// their body, and a twentieth of their size: nothing holds them there. `t`, s, and `q`,
    /// `[t.len() · nq]`, are the times and states to look at: of a start, or of a
    /// [`Recording`](articulated::simulate::Recording). Of meshes, which are not read, the link's
    /// centre of mass counts. The deepest comes first; none where the scene has no contact.
    pub fn penetrations(&self, t: &[f64], q: &[f64]) -> Vec<Penetration> {
        let touches = self.touches();
        let mut planes: Vec<Plane> = Vec::new();
        touches.iter().for_each(|touch| planes.extend(Some(touch.plane).filter(|plane| !planes.contains(plane))));
        let parts = if planes.is_empty() { Vec::new() } else { self.parts() };
        if parts.is_empty() || self.model.nq() == 0 {
            return Vec::new();
        }
        let mut found: Vec<Option<Penetration>> = parts.iter().map(|_| None).collect();
        let (mut ws, mut places) = (self.model.workspace(), vec![0.0; 12 * self.model.frames().len()]);
        for (t, q) in t.iter().zip(q.chunks_exact(self.model.nq())) {
            if self.model.placements(&mut ws, q, &mut places).is_err() {
                continue;
            }
            for plane in &planes {
                let held = self.held(&touches, plane, &places);
                for (part, found) in parts.iter().zip(&mut found) {
                    let depth = part.spheres.iter().map(|s| depth(s, &places[12 * part.frame..][..12], plane)).fold(f64::MIN, f64::max);
                    if depth <= held[self.model.frames()[part.frame].body] + part.beside {
                        continue;
                    }
                    let new = || Penetration { link: part.link.to_owned(), from: *t, depth, at: *t };
                    let known = found.get_or_insert_with(new);
                    if depth > known.depth {
                        (known.depth, known.at) = (depth, *t);
                    }
                }
            }
        }
        let mut found: Vec<Penetration> = found.into_iter().flatten().collect();
        found.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        found
    }

    /// A warning of links that are below a plane at the coordinates q `[nq]`, where a motion
    /// starts.
    pub fn warning_of_penetrations_at_start(&self, q: &[f64]) -> Option<String> {
        let found = self.penetrations(&[0.0], q);
        let (which, them) = count(found.len())?;
        let list = listed(&found, |p| format!("{:?} ({} m deep)", p.link, Plain(rounded(p.depth))));
        let file = &self.scene.file;
        Some(format!(
            "{file}: effects.contact: found {which} below a contact plane at the start where no contact holds {them}: {list}, expected {them} above the plane \
             (by height, normal or initial.q), or {ADVICE}; used as given"
        ))
    }

    /// A warning of links that went below a plane in a motion with these times, s, and states,
    /// `[t.len() · nq]`. Those that were there from the start on are left out unless they sank much
    /// deeper.
    pub fn warning_of_penetrations(&self, t: &[f64], q: &[f64]) -> Option<String> {
        let (first, start) = (t.first()?, q.get(..self.model.nq())?);
        let at_start = self.penetrations(&[*first], start);
        let depth_at_start = |link: &str| at_start.iter().find(|p| p.link == link).map_or(0.0, |p| p.depth);
        let mut found = self.penetrations(t, q);
        found.retain(|p| p.depth > 1.5 * depth_at_start(&p.link));
        let (which, them) = count(found.len())?;
        let list = listed(&found, |p| {
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
            let frame = self.model.frames().iter().position(|frame| frame.name == contact.on)?;
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
        let placed = links.filter_map(|link| Some((link, frames.iter().position(|frame| frame.name == link.name)?)));
        let moving = placed.filter(|(_, frame)| frames[*frame].body != 0);
        moving.map(|(link, frame)| Part::of(link, frame)).filter(|part| !part.spheres.is_empty()).collect()
    }

    /// How deep the deepest contact of each body is in a plane, m; 0 where none is.
    fn held(&self, touches: &[Touch], plane: &Plane, places: &[f64]) -> Vec<f64> {
        let mut held = vec![0.0_f64; self.model.bodies().len()];
        for touch in touches.iter().filter(|touch| touch.plane == *plane) {
            held[touch.body] = held[touch.body].max(depth(&touch.sphere, &places[12 * touch.frame..][..12], plane));
        }
        held
    }
}

impl<'s> Part<'s> {
    fn of(link: &'s Link, frame: usize) -> Self {
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

/// How deep a sphere of a frame with this placement is in a plane, m.
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
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
