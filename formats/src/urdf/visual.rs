//! The tags `<visual>` and `<material>`: the dynamics do not use them, so they cause no errors or
//! warnings. A drawing reports what it cannot show.

use std::collections::BTreeMap;

use articulated_core::description::{CollisionShape, Visual};
use articulated_core::diagnostic::Diagnostics;

use super::robot::Context;
use super::{collision, frame};
use crate::xml::element::Tag;
use crate::xml::number;

/// The whole appearance of a link.
pub(crate) fn all(link: &Tag<'_>, context: &Context<'_>, log: &Diagnostics) -> Vec<Visual> {
    link.children().filter(|tag| tag.is("visual")).map(|tag| visual(&tag, context, log.apart())).collect()
}

fn visual(tag: &Tag<'_>, context: &Context<'_>, mut own: Diagnostics) -> Visual {
    let origin = frame::origin(tag, context, &mut own);
    let shape = tag.required("geometry", &mut own).and_then(|geometry| collision::shape(&geometry, &mut own));
    let why = || own.errors.first().map(ToString::to_string).unwrap_or_default();
    let shape = shape.unwrap_or_else(|| CollisionShape::Unread { why: why() });
    let material = tag.children().find(|child| child.is("material"));
    let name = material.as_ref().and_then(|tag| tag.attribute("name")).map_or("", |(name, _)| name);
    let color = material.as_ref().and_then(color).or_else(|| context.materials.get(name).copied());
    Visual { origin, shape, material: name.to_owned(), color }
}

/// The colours of all named materials, wherever they are defined: the first of each name.
pub(crate) fn materials(robot: &Tag<'_>) -> BTreeMap<String, [f64; 4]> {
    let mut all = BTreeMap::new();
    for tag in robot.descendants().filter(|tag| tag.is("material")) {
        if let (Some((name, _)), Some(color)) = (tag.attribute("name"), color(&tag)) {
            all.entry(name.to_owned()).or_insert(color);
        }
    }
    all
}

fn color(material: &Tag<'_>) -> Option<[f64; 4]> {
    let tag = material.children().find(|child| child.is("color"))?;
    let color: [f64; 4] = number::silently(&tag, "rgba")?;
    Some(color.map(|part| part.clamp(0.0, 1.0)))
}
