//! Shapes of links, for contact and drawings.

use articulated_core::description::{Collision, CollisionShape, Hull, Visual};
use articulated_core::diagnostic::{At, Code, Diagnostics, Subject};
use articulated_core::effect::unit;

use super::grammar::subject;
use super::graph::{Graph, WORLD};
use super::links::Link;
use super::names::relative_to;
use super::values::{self, exactly, only};
use crate::Options;
use crate::pose::{Pose, rotate};
use crate::world::Plane;
use crate::xml::tree::Element;

/// All collision geometry of a link. Its errors are warnings. Planes of links that do not move are
/// put into `planes`.
pub(crate) fn collisions(
    link: &Link<'_>,
    graph: &Graph<'_>,
    options: &Options,
    planes: &mut Vec<Plane>,
    log: &mut Diagnostics,
) -> Vec<Collision> {
    let tags = link.element.children.iter().filter(|child| child.is("collision"));
    let mut all = Vec::new();
    for tag in tags {
        let mut own = log.apart();
        if let Some(plane) = plane(tag).filter(|_| link.is_static) {
            planes.extend(placed_plane(tag, plane, link, graph, options, &mut own));
            log.take_as_warnings(own, "; the plane makes no contact");
            continue;
        }
        let (pose, shape) = placed_shape(tag, link, graph, options, &mut own);
        let why = own.errors.first().map(ToString::to_string).unwrap_or_default();
        // The reader of the other format has reported it.
        if !tag.file.converted {
            log.take_as_warnings(own, "; the shape makes no contact");
        }
        all.push(Collision { origin: pose.origin(), shape: shape.unwrap_or(CollisionShape::Unread { why }) });
    }
    all
}

/// The plane, if it is the only shape of a `<collision>`.
fn plane(tag: &Element) -> Option<&Element> {
    let geometry = tag.children.iter().find(|child| child.is("geometry"))?;
    let [shape] = geometry.children.as_slice() else { return None };
    shape.is("plane").then_some(shape)
}

fn placed_plane(
    tag: &Element,
    plane: &Element,
    link: &Link<'_>,
    graph: &Graph<'_>,
    options: &Options,
    log: &mut Diagnostics,
) -> Option<Plane> {
    let about = &subject(link.element);
    let pose = graph.relative(WORLD, link.node).then(&pose(tag, link, graph, options, log));
    let normal = match only(plane, "normal", about, log) {
        Some(normal) => {
            let given = exactly::<3>(normal, about, log)?;
            let Some(normal) = unit(given) else {
                normal.error((about, "normal"), Code::ZeroAxis, "a normal without direction", "three numbers that are not all 0", log);
                return None;
            };
            normal
        }
        None => [0.0, 0.0, 1.0],
    };
    let name = graph.nodes[link.node].name.clone();
    let (point, normal) = (pose.position, rotate(pose.rotation, normal));
    // Lines are those of the main file.
    let place = if plane.file.included { At::Nowhere } else { plane.at };
    Some(Plane { name, point, normal, mask: None, place })
}

/// The whole appearance of a link: the dynamics do not use it, so it causes no findings.
pub(crate) fn visuals(link: &Link<'_>, graph: &Graph<'_>, options: &Options, log: &Diagnostics) -> Vec<Visual> {
    let tags = link.element.children.iter().filter(|child| child.is("visual"));
    let visual = |tag: &Element| {
        let mut own = log.apart();
        let (pose, shape) = placed_shape(tag, link, graph, options, &mut own);
        let why = own.errors.first().map(ToString::to_string).unwrap_or_default();
        let material = tag.children.iter().find(|child| child.is("material"));
        let diffuse = material.and_then(|material| material.children.iter().find(|child| child.is("diffuse")));
        let color = diffuse.and_then(|color| exactly::<4>(color, &Subject::Document, &mut own));
        Visual {
            origin: pose.origin(),
            shape: shape.unwrap_or(CollisionShape::Unread { why }),
            material: String::new(),
            color: color.map(|color| color.map(|part| part.clamp(0.0, 1.0))),
        }
    };
    tags.map(visual).collect()
}

fn placed_shape(
    tag: &Element,
    link: &Link<'_>,
    graph: &Graph<'_>,
    options: &Options,
    log: &mut Diagnostics,
) -> (Pose, Option<CollisionShape>) {
    let about = &subject(link.element);
    let pose = pose(tag, link, graph, options, log);
    let Some(geometry) = only(tag, "geometry", about, log) else {
        tag.error((about, "geometry"), Code::MissingTag, "none", format!("<geometry> inside <{}>", tag.name), log);
        return (pose, None);
    };
    (pose, shape(geometry, about, log))
}

/// The pose of a shape in its link.
pub(crate) fn pose(tag: &Element, link: &Link<'_>, graph: &Graph<'_>, options: &Options, log: &mut Diagnostics) -> Pose {
    let about = &subject(link.element);
    let Some(element) = only(tag, "pose", about, log) else { return Pose::default() };
    let pose = values::pose(element, options.snap_angles, about, log);
    let frame = relative_to(element, link.scope).and_then(|reference| graph.resolve(&reference, log));
    frame.map_or(pose, |frame| graph.relative(link.node, frame).then(&pose))
}

/// The only shape of a `<geometry>`.
fn shape(geometry: &Element, about: &Subject, log: &mut Diagnostics) -> Option<CollisionShape> {
    const EXPECTED: &str = "one of <box>, <cylinder>, <sphere>, <capsule> and <mesh>";
    let [tag] = geometry.children.as_slice() else {
        let found = format!("{} shapes", geometry.children.len());
        geometry.error((about, "geometry"), Code::WrongCount, found, EXPECTED, log);
        return None;
    };
    let mut size = |name: &str| {
        let Some(element) = only(tag, name, about, log) else {
            tag.error((about, name), Code::MissingTag, "none", format!("<{name}> inside <{}>", tag.name), log);
            return None;
        };
        let [size] = exactly::<1>(element, about, log)?;
        if size < 0.0 {
            element.error((about, name), Code::Negative, format!("a negative size, {size}"), "sizes of at least 0 m", log);
            return None;
        }
        Some(size)
    };
    match tag.name.as_str() {
        "sphere" => Some(CollisionShape::Sphere { radius: size("radius")? }),
        "cylinder" => Some(CollisionShape::Cylinder { radius: size("radius")?, length: size("length")? }),
        "capsule" | "drake:capsule" => Some(CollisionShape::Capsule { radius: size("radius")?, length: size("length")? }),
        "box" => {
            let size = only(tag, "size", about, log).and_then(|size| exactly::<3>(size, about, log))?;
            if size.iter().any(|side| *side < 0.0) {
                tag.error((about, "size"), Code::Negative, "a negative size", "sizes of at least 0 m", log);
                return None;
            }
            Some(CollisionShape::Box { size })
        }
        "mesh" => {
            let (_, file) = values::name(tag, "uri", about, log)?;
            let scale = only(tag, "scale", about, log).and_then(|scale| exactly::<3>(scale, about, &mut log.apart()));
            Some(CollisionShape::Mesh { file: file.to_owned(), scale: scale.unwrap_or([1.0; 3]), hull: Hull::NotRead })
        }
        _ if tag.file.converted => {
            tag.error((about, "geometry"), Code::Unsupported, values::text(tag), EXPECTED, log);
            None
        }
        _ => {
            let found = format!("<{}>", tag.name);
            tag.error((about, "geometry"), Code::Unsupported, found, EXPECTED, log);
            None
        }
    }
}
