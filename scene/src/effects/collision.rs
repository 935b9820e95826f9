//! Contact of the collision geometry of a robot's file.

use articulated_core::description::{Collision, CollisionShape, Hull, Link, LinkId, Origin};
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics, Place, Subject};
use articulated_core::effect::{Effect, EffectId};
use articulated_formats::world::ContactMask;

use super::resolve::{Resolving, fill, missing};
use super::{EffectRequest, FRAME, Numbers, Selector};
use crate::scene::Scene;
use crate::table::Cursor;

/// The word for it.
pub(super) const WORD: &str = crate::report::COLLISION;

/// The field that a shape supplies.
const RADIUS: &str = "radius";

/// Whether points of this effect may be those of collision geometry.
pub(super) fn offers(row: &Effect) -> bool {
    row.id == EffectId::contact
}

/// Whether the field of an effect is taken from collision geometry.
pub(crate) fn is_of_shape(row: &Effect, field: &str) -> bool {
    offers(row) && field == RADIUS
}

/// Refuses own points of the scene combined with those of the geometry.
pub(super) fn refuse_own_points(spot: &Cursor<'_>, log: &mut Diagnostics) {
    for own in [RADIUS].into_iter().chain(FRAME).filter_map(|key| spot.get(key)) {
        let name = own.key.rsplit('.').next().unwrap_or_default();
        own.clash(log, format!("{name} beside from = \"{WORD}\""), "one of both: the shapes of the robot's file give radii and places");
    }
}

impl Scene {
    /// Whether contact uses collision geometry.
    pub(crate) fn touches_with_geometry(&self) -> bool {
        self.effects.iter().any(is_requested)
    }
}

/// Whether the geometry is requested.
pub(super) fn is_requested(one: &EffectRequest) -> bool {
    one.says.as_ref().is_some_and(|says| says.from_collision)
}

/// Whether a link's contact uses its geometry: if the link requests it, or if all links do and the
/// link's own entry has no point.
pub(super) fn is_taken(row: &Effect, says: &Numbers, rest: Option<&Numbers>) -> bool {
    let has_radius = || row.fields.iter().zip(&says.fields).any(|(field, own)| field.name == RADIUS && own.is_some());
    says.from_collision || (rest.is_some_and(|rest| rest.from_collision) && says.at.is_none() && !has_radius())
}

/// A name as a key of TOML: in quotes unless it is bare.
fn toml_key(name: &str) -> String {
    let is_bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    if is_bare { name.to_owned() } else { format!("{name:?}") }
}

/// Why a mesh makes no contact.
fn why_unread(shape: &CollisionShape) -> Option<&str> {
    match shape {
        CollisionShape::Mesh { hull: Hull::Unreadable { why }, .. } => Some(why),
        CollisionShape::Mesh { hull: Hull::NotRead, .. } => Some("files of meshes are not read here"),
        _ => None,
    }
}

impl<'a> Resolving<'a> {
    /// Adds a contact for each sphere or point of a link's collision geometry. With a mask, only
    /// pieces that make contact with that mask count.
    pub(super) fn of_collision(
        &mut self,
        row: &'static Effect,
        link: &'a Link,
        (one, says): (&EffectRequest, &Numbers),
        (rest, mask): (Option<&Numbers>, Option<ContactMask>),
        log: &mut Diagnostics,
    ) {
        let masks = self.robot.world.contact_masks.get(&link.name);
        let meets = |k: usize| match (mask, masks.and_then(|masks| masks.get(k))) {
            (Some(mask), Some(own)) => mask.meets(*own),
            _ => true,
        };
        let pieces: Vec<&Collision> = link.collision.iter().enumerate().filter(|(k, _)| meets(*k)).map(|(_, piece)| piece).collect();
        if pieces.is_empty() && !link.collision.is_empty() {
            return;
        }
        let unread = pieces.iter().filter_map(|piece| match &piece.shape {
            CollisionShape::Unread { why } => Some(why),
            _ => None,
        });
        let before = log.count();
        for why in unread {
            let found = format!("collision geometry of link {:?} that cannot be read: {why}", link.name);
            log.error((one.place, &one.key), Code::Robot, found, "geometry that can be read, or \"off\" for this link");
        }
        if log.count() > before {
            return;
        }
        let spheres: Vec<_> = pieces.iter().flat_map(|piece| piece.contact_spheres()).collect();
        let unread = pieces.iter().find_map(|piece| why_unread(&piece.shape));
        match (&one.on, unread) {
            (Selector::Named(name), why) if spheres.is_empty() => {
                let what = why.map_or_else(|| "no collision geometry".to_owned(), |why| format!("no mesh that can be read: {why}"));
                let expected = "a mesh that can be read, a box, cylinder, sphere or capsule in <collision>, or contact with `radius`";
                return log.error((one.place, &one.key), Code::Robot, format!("link {name:?} with {what}"), expected);
            }
            (_, Some(why)) => {
                let kind = if spheres.is_empty() { Code::NoContact } else { Code::PartOfContact };
                let found = format!("a mesh that makes no contact: {why}");
                self.warn_of_contact(one, link, kind, &found, "a mesh that can be read, or a box, cylinder, sphere or capsule");
            }
            _ => {}
        }
        for shape in pieces.iter().map(|piece| &piece.shape) {
            if let CollisionShape::Mesh { file, hull: Hull::Points { points, missing, vertices }, .. } = shape
                && *missing > 0.0
            {
                let found = format!("{file}: a mesh of {vertices} vertices");
                let expected = format!("{} points, which touch for it: it reaches up to {missing:.2e} m farther", points.len());
                self.warn_of_contact(one, link, Code::PartOfContact, &found, &expected);
            }
        }
        let radius = row.fields.iter().position(|field| field.name == RADIUS);
        for sphere in spheres {
            let mut says = says.clone();
            radius.and_then(|at| says.fields.get_mut(at)).into_iter().for_each(|own| *own = Some(vec![sphere.radius]));
            match fill((row, row.fields), &[Some(&says), rest], &|_| None) {
                Ok(mut filled) => {
                    radius.and_then(|at| filled.get_mut(at)).into_iter().for_each(|(_, tag)| *tag = Some(WORD));
                    self.put_filled(row, &link.name, Origin { xyz: sphere.center, ..Origin::default() }, one, &filled);
                }
                // It is missing for each of the points.
                Err(field) => return missing(row, field, one, &format!("link {:?}", link.name), log),
            }
        }
    }

    fn warn_of_contact(&mut self, one: &EffectRequest, link: &Link, kind: Code, found: &str, expected: &str) {
        self.warn(one, &Subject::Link(link.name.clone()), kind, found, expected);
    }

    /// Refuses contact of the geometry of all links if no link has any, unless there are errors
    /// beyond the first `errors` already: nothing would touch the ground.
    pub(super) fn refuse_no_geometry(&self, asked: &[&EffectRequest], errors: usize, log: &mut Diagnostics) {
        let Some(one) = asked.iter().find(|one| one.on == Selector::All && is_requested(one)) else { return };
        if log.count() > errors {
            return;
        }
        let links = &self.robot.description.links;
        let found = match links.iter().any(|link| !link.collision.is_empty()) {
            false => "a robot without collision geometry".to_owned(),
            true if self.touches_by_masks() => {
                let mut shapes = links.iter().flat_map(|link| &link.collision).map(|piece| &piece.shape);
                let why = shapes.find_map(why_unread).map_or_else(String::new, |why| format!(": {why}"));
                format!("a robot with meshes alone as collision geometry, and none that can be read{why}")
            }
            // The file lets its geometry pass through the planes.
            true => return,
        };
        // The tips of the tree: the links that no other is on.
        let joints = &self.robot.description.joints;
        let is_tip = |id: LinkId| joints.iter().all(|joint| joint.parent != id) && !self.still[id];
        let tips: Vec<&str> = links.with_ids().filter(|(id, _)| is_tip(*id)).map(|(_, link)| link.name.as_str()).take(4).collect();
        let lines: Vec<String> = tips.iter().map(|tip| format!("{} = {{ radius = 0.02 }}", toml_key(tip))).collect();
        let expected = match lines.is_empty() {
            true => "<collision> of boxes, cylinders, spheres or capsules".to_owned(),
            false => format!(
                "<collision> of boxes, cylinders, spheres or capsules, or spheres of the scene, such as [effects.contact] with the lines {}",
                lines.join(" and ")
            ),
        };
        log.error((one.place, &one.key), Code::NoContact, found, &expected);
    }

    /// Whether a link has geometry that no mask keeps from contact.
    fn touches_by_masks(&self) -> bool {
        let masks = &self.robot.world.contact_masks;
        let all = self.robot.description.links.iter();
        all.flat_map(|link| &link.collision).any(|piece| matches!(piece.shape, CollisionShape::Mesh { .. })) || masks.is_empty()
    }

    pub(super) fn warn(&mut self, one: &EffectRequest, subject: &Subject, kind: Code, found: &str, expected: &str) {
        let place = Place { at: one.place, subject, field: &one.key };
        self.resolved.warnings.push(Diagnostic::error(&self.scene.file, place, kind, found, expected).into_warning());
    }
}
