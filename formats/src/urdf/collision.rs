//! The tag `<collision>`: the dynamics do not use it, so its errors are warnings here, and errors
//! if a scene requests contact of it.

use articulated_core::description::{Collision, CollisionShape, Hull};
use articulated_core::diagnostic::{Code, Diagnostics, quote};

use super::robot::Context;
use super::{frame, unused};
use crate::xml::element::Tag;
use crate::xml::number;

/// The shapes that are read, and their attributes.
const SHAPES: [(&str, &[&str]); 6] = [
    ("box", &["size"]),
    ("cylinder", &["radius", "length"]),
    ("sphere", &["radius"]),
    ("capsule", &["radius", "length"]),
    ("drake:capsule", &["radius", "length"]),
    ("mesh", &["filename", "scale"]),
];

const EXPECTED_SHAPE: &str = "one of <box>, <cylinder>, <sphere>, <capsule> and <mesh>";

/// All collision geometry of a link.
pub(crate) fn all(link: &Tag<'_>, context: &Context<'_>, log: &mut Diagnostics) -> Vec<Collision> {
    link.children().filter(|tag| tag.is("collision")).map(|tag| collision(&tag, context, log)).collect()
}

fn collision(tag: &Tag<'_>, context: &Context<'_>, log: &mut Diagnostics) -> Collision {
    let mut own = log.apart();
    unused::rest(tag, &["origin", "geometry"], &["name"], &mut own);
    let origin = frame::origin(tag, context, &mut own);
    let shape = tag.required("geometry", &mut own).and_then(|geometry| shape(&geometry, &mut own));
    let faults = own.errors.len();
    let why = own.errors.first().map(ToString::to_string);
    log.take_as_warnings(own, "; the shape makes no contact");
    let shape = match (shape, why) {
        (Some(shape), None) => shape,
        (_, Some(why)) if faults > 1 => CollisionShape::Unread { why: format!("{why}, and {} more", faults - 1) },
        // An expression of xacro has an error of its own.
        (_, why) => CollisionShape::Unread { why: why.unwrap_or_default() },
    };
    Collision { origin, shape }
}

/// The only shape of a `<geometry>`.
pub(crate) fn shape(geometry: &Tag<'_>, log: &mut Diagnostics) -> Option<CollisionShape> {
    unused::beside_tags(geometry, &[], log);
    let mut children = geometry.children();
    let (Some(tag), None) = (children.next(), children.next()) else {
        let (kind, found) = match geometry.children().count() {
            0 => (Code::MissingTag, "no shape".to_owned()),
            count => (Code::DuplicateTag, format!("{count} shapes")),
        };
        log.error(geometry.place("geometry"), kind, found, EXPECTED_SHAPE);
        return None;
    };
    let name = tag.name();
    let Some((_, attributes)) = SHAPES.iter().find(|(known, _)| *known == name) else {
        log.error(tag.place("geometry"), Code::Unsupported, format!("<{name}>"), EXPECTED_SHAPE);
        return None;
    };
    unused::rest(&tag, &[], attributes, log);
    match name.as_str() {
        "box" => Some(CollisionShape::Box { size: sizes(&tag, "size", log)? }),
        "mesh" => {
            let file = tag.required_attribute("filename", log)?.0.to_owned();
            // A wrong scale is of concern to contact alone.
            let scale = number::silently(&tag, "scale");
            let is_wrong = scale.is_none() && tag.attribute("scale").is_some();
            let hull =
                if is_wrong { Hull::Unreadable { why: format!("{file}: a `scale` that is not three numbers") } } else { Hull::NotRead };
            Some(CollisionShape::Mesh { file, scale: scale.unwrap_or([1.0; 3]), hull })
        }
        "sphere" => sizes(&tag, "radius", log).map(|[radius]| CollisionShape::Sphere { radius }),
        _ => {
            let (radius, length) = (sizes(&tag, "radius", log), sizes(&tag, "length", log));
            let ([radius], [length]) = (radius?, length?);
            Some(if name == "cylinder" { CollisionShape::Cylinder { radius, length } } else { CollisionShape::Capsule { radius, length } })
        }
    }
}

/// The sizes in a required attribute, m: not below zero.
fn sizes<const N: usize>(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> Option<[f64; N]> {
    let (text, _) = tag.required_attribute(name, log)?;
    let sizes = number::attribute_list(tag, name, log)?;
    if sizes.iter().any(|size| *size < 0.0) {
        let field = format!("{} {name}", tag.name());
        log.error(tag.place(&field), Code::Negative, format!("a negative size in {}", quote(text)), "sizes of at least 0 m");
        return None;
    }
    Some(sizes)
}
