//! Mass properties that are computed from the shapes of a link: `<inertial auto="true">`.
//!
//! The rules are those of sdformat 15: the density of a shape, or else that of the link, or else
//! 1000 kg/m³; a mass in the file scales the result. Shapes overlap without notice.

use std::f64::consts::PI;

use articulated_core::description::Inertial;
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::grammar::subject;
use super::graph::Graph;
use super::links::Link;
use super::shapes;
use super::values::{self, exactly, number, only};
use crate::Options;
use crate::pose::{Pose, Symmetric, Vector, add, diagonal, of_point, rotate, scale, subtract, turned};
use crate::xml::tree::Element;

/// Density of a shape without its own, kg/m³.
const DENSITY: f64 = 1000.0;

const SHAPES: &str = "a box, capsule, cone, cylinder, ellipsoid or sphere, or <mass> and <inertia> without `auto`";

/// A shape in its own frame.
struct Solid {
    /// m³.
    volume: f64,
    /// Squares of the radii of gyration about the centre of mass, m²: the moments of 1 kg.
    gyration: Vector,
    /// The centre of mass on the z axis, m.
    centre: f64,
}

/// The inertia of a link that requests it; `None` for other links, and with an error. A link that
/// does not move needs no inertia: no error is reported.
pub(crate) fn inertial(link: &Link<'_>, graph: &Graph<'_>, options: &Options, log: &mut Diagnostics) -> Option<Inertial> {
    let about = &subject(link.element);
    let mut own = log.apart();
    let tag = only(link.element, "inertial", about, &mut own)?;
    if !values::flag(tag, "auto", about, &mut own) {
        return None;
    }
    let mut own = log.apart();
    let inertial = of_shapes(tag, link, graph, options, &mut own);
    if !link.is_static {
        log.take(own);
    }
    inertial
}

fn of_shapes(tag: &Element, link: &Link<'_>, graph: &Graph<'_>, options: &Options, log: &mut Diagnostics) -> Option<Inertial> {
    let about = &subject(link.element);
    for name in ["pose", "inertia"] {
        tag.all(name).for_each(|given| given.unused(about, None, "the inertia is computed of the shapes: `auto`", log));
    }
    let given = number(tag, "mass", about, log);
    let of_link = number(tag, "density", about, log);
    let mut shapes = link.element.all("collision").peekable();
    if shapes.peek().is_none() {
        tag.error((about, "auto"), Code::MissingTag, "no shapes", "<collision> with a shape, of which the inertia is computed", log);
        return None;
    }
    let (mut parts, mut is_good) = (Vec::new(), true);
    for shape in shapes {
        let density = number(shape, "density", about, log).or(of_link);
        if density.is_none() && given.is_none() {
            let expected = "<density> inside <collision> or <inertial>: the format's default is used, 1000 kg/m³";
            shape.warning((about, "density"), Code::MissingTag, "none", expected, log);
        }
        let density = density.unwrap_or(DENSITY);
        if density <= 0.0 {
            shape.error((about, "density"), Code::Negative, format!("{density}"), "a density above 0 kg/m³", log);
            is_good = false;
        }
        let pose = shapes::pose(shape, link, graph, options, log);
        match solid(shape, about, log) {
            Some(solid) => parts.push((pose, density * solid.volume, solid)),
            None => is_good = false,
        }
    }
    if !is_good {
        return None;
    }
    let (mass, centre, inertia) = sum(&parts);
    if mass <= 0.0 || !mass.is_finite() || !inertia.iter().all(|moment| moment.is_finite()) {
        let found = if mass == 0.0 { "shapes without volume".to_owned() } else { format!("shapes of {mass} kg together") };
        tag.error((about, "auto"), Code::Negative, found, "shapes with a volume", log);
        return None;
    }
    let factor = given.map_or(1.0, |given| given / mass);
    if factor <= 0.0 {
        tag.error((about, "mass"), Code::NegativeMass, format!("a mass of {} kg", factor * mass), "a mass above zero beside `auto`", log);
        return None;
    }
    Some(Inertial { origin: Pose::at(centre).origin(), mass: given.unwrap_or(mass), inertia: inertia.map(|moment| factor * moment) })
}

/// Mass, centre of mass and inertia about it, of solids with their poses and masses.
fn sum(parts: &[(Pose, f64, Solid)]) -> (f64, Vector, Symmetric) {
    let centre_of = |pose: &Pose, solid: &Solid| add(pose.position, rotate(pose.rotation, [0.0, 0.0, solid.centre]));
    let mass: f64 = parts.iter().map(|(_, mass, _)| mass).sum();
    let moment = parts.iter().fold([0.0; 3], |sum, (pose, own, solid)| add(sum, scale(centre_of(pose, solid), *own)));
    let centre = scale(moment, 1.0 / mass);
    let inertia = parts.iter().fold([0.0; 6], |sum, (pose, own, solid)| {
        let about_own = turned(pose.rotation, diagonal(scale(solid.gyration, *own)));
        let of_centre = of_point(*own, subtract(centre_of(pose, solid), centre));
        [0, 1, 2, 3, 4, 5].map(|k| sum[k] + about_own[k] + of_centre[k])
    });
    (mass, centre, inertia)
}

/// The solid of a `<collision>`.
fn solid(collision: &Element, about: &Subject, log: &mut Diagnostics) -> Option<Solid> {
    let geometry = collision.all("geometry").next();
    let Some([tag]) = geometry.map(|geometry| geometry.children.as_slice()) else {
        collision.error((about, "geometry"), Code::WrongCount, "no shape, or several", SHAPES, log);
        return None;
    };
    let mut size = |name: &str| -> Option<f64> {
        let size = number(tag, name, about, log);
        if size.is_none_or(|size| size < 0.0) {
            let found = size.map_or_else(|| "none".to_owned(), |size| format!("a negative size, {size}"));
            tag.error((about, name), Code::Negative, found, format!("<{name}> inside <{}>, at least 0 m", tag.name), log);
            return None;
        }
        size
    };
    match tag.name.as_str() {
        "sphere" => size("radius").map(|r| ellipsoid([r; 3])),
        "cylinder" => Some(cylinder(size("radius")?, size("length")?)),
        "capsule" | "drake:capsule" => Some(capsule(size("radius")?, size("length")?)),
        "cone" => Some(cone(size("radius")?, size("length")?)),
        "box" | "ellipsoid" | "drake:ellipsoid" => three(tag, about, log),
        name => {
            let uri = tag.all("uri").next().map(values::text);
            let found = uri.map_or_else(|| format!("<{name}>"), |uri| format!("the {name} {}", quote(uri)));
            tag.error((about, "auto"), Code::Unsupported, found, SHAPES, log);
            None
        }
    }
}

/// A box or an ellipsoid, of three sizes.
fn three(tag: &Element, about: &Subject, log: &mut Diagnostics) -> Option<Solid> {
    let name = if tag.is("box") { "size" } else { "radii" };
    let Some(child) = only(tag, name, about, log) else {
        tag.error((about, name), Code::MissingTag, "none", format!("<{name}> inside <{}>", tag.name), log);
        return None;
    };
    let sizes = exactly::<3>(child, about, log)?;
    if sizes.iter().any(|size| *size < 0.0) {
        child.error((about, name), Code::Negative, "a negative size", "sizes of at least 0 m", log);
        return None;
    }
    if !tag.is("box") {
        return Some(ellipsoid(sizes));
    }
    let [x, y, z] = sizes;
    let gyration = [(y * y + z * z) / 12.0, (x * x + z * z) / 12.0, (x * x + y * y) / 12.0];
    Some(Solid { volume: x * y * z, gyration, centre: 0.0 })
}

fn ellipsoid([a, b, c]: Vector) -> Solid {
    let gyration = [(b * b + c * c) / 5.0, (a * a + c * c) / 5.0, (a * a + b * b) / 5.0];
    Solid { volume: 4.0 / 3.0 * PI * a * b * c, gyration, centre: 0.0 }
}

/// From -length/2 to length/2.
fn cylinder(radius: f64, length: f64) -> Solid {
    let across = radius * radius / 4.0 + length * length / 12.0;
    Solid { volume: PI * radius * radius * length, gyration: [across, across, radius * radius / 2.0], centre: 0.0 }
}

/// A cylinder of this length with half a ball on each end. The centre of half a ball is 3/8 of the
/// radius from its flat side.
fn capsule(radius: f64, length: f64) -> Solid {
    let (middle, ends) = (cylinder(radius, length), ellipsoid([radius; 3]));
    let volume = middle.volume + ends.volume;
    let share = if volume > 0.0 { [middle.volume / volume, ends.volume / volume] } else { [0.0; 2] };
    let beyond = length * length / 4.0 + 3.0 / 8.0 * length * radius;
    let [x, _, z] = middle.gyration;
    let across = share[0] * x + share[1] * (ends.gyration[0] + beyond);
    Solid { volume, gyration: [across, across, share[0] * z + share[1] * ends.gyration[2]], centre: 0.0 }
}

/// From its base at -length/2 to its tip at length/2.
fn cone(radius: f64, length: f64) -> Solid {
    let across = 3.0 / 20.0 * radius * radius + 3.0 / 80.0 * length * length;
    Solid { volume: PI * radius * radius * length / 3.0, gyration: [across, across, 3.0 / 10.0 * radius * radius], centre: -length / 4.0 }
}
