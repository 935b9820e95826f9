//! The tag `<geom>`: mass, and the shape for contact and for drawings.

use std::collections::BTreeMap;
use std::rc::Rc;

use articulated_core::collision::Form;
use articulated_core::description::{CollisionShape, Hull};
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::axes;
use super::contact::Surface;
use super::element::Element;
use super::grammar::subject;
use super::left_out::Gate;
use super::mass::Mass;
use super::mesh::{self, Meshes};
use super::settings::Settings;
use super::simulation::Rules;
use super::values::Values;
use crate::pose::{IDENTITY, Pose, TINY, Vector, add, diagonal, norm, of_z_axis, rotate, scale, subtract};
use crate::world::ContactMask;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Plane,
    HeightField,
    Sphere,
    Capsule,
    Ellipsoid,
    Cylinder,
    Box,
    Mesh,
    /// A signed distance field, of a plugin or a mesh.
    Sdf,
}

/// A geom in the frame of its body.
pub(crate) struct Geom<'a> {
    pub(crate) element: &'a Element,
    /// With prefixes and suffixes; `None` if it has no name.
    pub(crate) name: Option<String>,
    /// The part of the tree that it is in.
    pub(crate) part: usize,
    /// Of its document.
    settings: Rc<Settings<'a>>,
    kind: Kind,
    /// Of the shape; for a mesh, of the frame of its file.
    pose: Pose,
    /// Half the extent of the shape along its axes, m.
    size: Vector,
    mesh: Option<&'a Element>,
    mass: Option<f64>,
    density: f64,
    is_shell: bool,
    fit_scale: f64,
    /// Whether shapes are fitted to the corners of meshes, rather than to their inertia.
    fit_corners: bool,
    pub(crate) group: i64,
    /// `contype` and `conaffinity`.
    pub(crate) mask: ContactMask,
    pub(crate) color: Option<[f64; 4]>,
    /// The coefficients of the medium, if it acts as on an ellipsoid: blunt and slender drag, drag
    /// of turns, Kutta and Magnus lift.
    pub(crate) in_fluid: Option<[f64; 5]>,
    /// Its numbers of the law of contact.
    pub(crate) surface: Surface,
}

const KINDS: [(&str, Kind); 9] = [
    ("plane", Kind::Plane),
    ("hfield", Kind::HeightField),
    ("sphere", Kind::Sphere),
    ("capsule", Kind::Capsule),
    ("ellipsoid", Kind::Ellipsoid),
    ("cylinder", Kind::Cylinder),
    ("box", Kind::Box),
    ("mesh", Kind::Mesh),
    ("sdf", Kind::Sdf),
];

/// The pose of a shape between two points, and half its length, m.
pub(crate) fn between(values: &Values<'_>, log: &mut Diagnostics) -> Option<(Pose, f64)> {
    let [a, b, c, x, y, z] = values.exactly::<6>("fromto", log)?;
    let (from, to) = ([a, b, c], [x, y, z]);
    let along = subtract(from, to);
    let length = norm(along);
    if length / 2.0 < TINY {
        values.error("fromto", Code::Number, quote(values.text("fromto").unwrap_or_default()), "two points that are apart", log);
        return None;
    }
    let rotation = of_z_axis(scale(along, 1.0 / length));
    Some((Pose { position: scale(add(from, to), 0.5), rotation }, length / 2.0))
}

/// A geom; its mesh is not read yet.
pub(crate) fn geom<'a>(
    values: &Values<'a>,
    settings: &Rc<Settings<'a>>,
    frame: &Pose,
    (rules, gate): (Rules, &mut Gate<'_>),
    log: &mut Diagnostics,
) -> Option<Geom<'a>> {
    let kind = if values.has("type") { values.word("type", &KINDS, log)? } else { Kind::Sphere };
    let mesh = asset(values, ("mesh", &settings.meshes), log)?;
    let has_plugin = gate.has_plugin(values.element, "a plugin of a geom", log);
    let mesh_has_plugin = mesh.is_some_and(|mesh| gate.has_plugin(mesh, "a plugin of a mesh", log));
    if has_plugin || mesh_has_plugin {
        return None;
    }
    if kind == Kind::Mesh && mesh.is_none() {
        values.error("mesh", Code::MissingAttribute, "none", "the name of a mesh", log);
        return None;
    }
    let mut size = size(values, kind, mesh.is_some(), settings, log)?;
    let pose = if values.has_numbers("fromto") {
        let (pose, half) = between(values, log)?;
        if values.exactly::<3>("pos", log).is_some_and(|pos| pos != [0.0; 3]) {
            values.error("fromto", Code::Together, "both pos and fromto", "one of them", log);
        }
        match kind {
            _ if mesh.is_some() => values.error("fromto", Code::Together, "both mesh and fromto", "one of them", log),
            Kind::Capsule | Kind::Cylinder => size[1] = half,
            Kind::Ellipsoid | Kind::Box => size = [size[0], size[0], half],
            _ => values.error("fromto", Code::Together, "fromto", "it in a capsule, a cylinder, a box or an ellipsoid", log),
        }
        pose
    } else {
        values.pose(&settings.compiler.angles, log)
    };
    let sizes = sizes(kind);
    if mesh.is_none() && size[..sizes].iter().any(|size| *size <= 0.0) {
        let found = quote(values.text("size").unwrap_or_default());
        values.error("size", Code::Number, found, format!("{sizes} numbers above zero, m"), log);
        return None;
    }
    let mass = values.number("mass", log);
    let density = if mass.is_none() { values.number("density", log).unwrap_or(1000.0) } else { 0.0 };
    if mass.unwrap_or(density) < 0.0 {
        let field = if mass.is_some() { "mass" } else { "density" };
        values.error(field, Code::NegativeMass, format!("a negative {field}"), "zero or more", log);
    }
    let is_shell = values.yes("shellinertia", log).unwrap_or(false);
    if is_shell && matches!(kind, Kind::Mesh | Kind::Sdf) {
        values.error("shellinertia", Code::Together, "a mesh with shellinertia", "inertia=\"shell\" of the mesh in <asset>", log);
    }
    let affinity = |name: &str, log: &mut Diagnostics| values.integer(name, log).unwrap_or(1);
    let mask = match rules.flags.no_contact {
        true => ContactMask::default(),
        false => ContactMask { kinds: affinity("contype", log), affinity: affinity("conaffinity", log) },
    };
    let is_fitted = mesh.is_some() && !matches!(kind, Kind::Mesh | Kind::Sdf);
    Some(Geom {
        element: values.element,
        name: None,
        part: 0,
        settings: settings.clone(),
        kind,
        pose: frame.then(&pose),
        size,
        mesh,
        mass,
        density,
        is_shell,
        fit_scale: if is_fitted { values.number("fitscale", log).unwrap_or(1.0) } else { 1.0 },
        fit_corners: rules.fit_corners,
        group: values.integer("group", log).unwrap_or(0),
        mask,
        color: values.exactly::<4>("rgba", log),
        surface: Surface::of(values, log),
        in_fluid: in_fluid(values, log),
    })
}

fn in_fluid(values: &Values<'_>, log: &mut Diagnostics) -> Option<[f64; 5]> {
    let is_ellipsoid = values.word("fluidshape", &[("none", false), ("ellipsoid", true)], log)?;
    is_ellipsoid.then(|| values.at_most("fluidcoef", [0.5, 0.25, 1.5, 1.0, 1.0], log))
}

/// The tag of `<asset>` that an attribute names; an error, and `None`, if there is no such tag.
fn asset<'a>(
    values: &Values<'a>,
    (field, all): (&str, &BTreeMap<String, &'a Element>),
    log: &mut Diagnostics,
) -> Option<Option<&'a Element>> {
    let Some(name) = values.text(field) else { return Some(None) };
    let found = all.get(name).copied();
    if found.is_none() {
        let near = articulated_core::suggest::nearest(name, all.keys().map(String::as_str));
        let hint = near.map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
        let what = if field == "mesh" { "mesh" } else { "height field" };
        values.error(field, Code::UnknownName, quote(name), format!("the name of a {what} of <asset>{hint}"), log);
        return None;
    }
    Some(found)
}

/// Number of size parameters of a shape.
fn sizes(kind: Kind) -> usize {
    match kind {
        Kind::Sphere => 1,
        Kind::Capsule | Kind::Cylinder => 2,
        Kind::Ellipsoid | Kind::Box | Kind::HeightField => 3,
        Kind::Plane | Kind::Mesh | Kind::Sdf => 0,
    }
}

/// Half the extent of a shape along its axes, m; `None` after an error.
fn size(values: &Values<'_>, kind: Kind, has_mesh: bool, settings: &Settings<'_>, log: &mut Diagnostics) -> Option<Vector> {
    let field = asset(values, ("hfield", &settings.height_fields), log)?;
    match (kind, field, has_mesh) {
        (Kind::HeightField | Kind::Plane, _, true) => {
            values.error("mesh", Code::Together, "a plane or a height field with a mesh", "a shape that can be fitted to a mesh", log);
            None
        }
        (Kind::HeightField, None, _) => {
            values.error("hfield", Code::MissingAttribute, "none", "the name of a height field", log);
            None
        }
        (Kind::HeightField, Some(field), _) => {
            let field = Values::alone(field, &Subject::Document);
            let Some([x, y, elevation, base]) = field.exactly::<4>("size", log).filter(|size| size.iter().all(|x| *x > 0.0)) else {
                field.error("size", Code::Number, quote(field.text("size").unwrap_or_default()), "4 numbers above zero, m", log);
                return None;
            };
            // As with half the height everywhere; its base is below.
            Some([x, y, 0.25 * elevation + 0.5 * base])
        }
        (_, Some(_), _) => {
            values.error("hfield", Code::Together, "a height field in another shape", "type=\"hfield\"", log);
            None
        }
        _ if has_mesh || sizes(kind) == 0 => Some([0.0; 3]),
        _ => Some(values.at_most("size", [0.0; 3], log)),
    }
}

impl Geom<'_> {
    /// Its mass, centre and inertia; `None` if it has no mass, or after an error.
    pub(crate) fn mass(&self, meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> Option<Mass> {
        if self.mass == Some(0.0) || (self.mass.is_none() && self.density == 0.0) {
            return None;
        }
        let body = match self.mesh {
            Some(mesh) => Some(meshes.body(mesh, &self.settings, log)?),
            None if self.kind == Kind::Sdf => {
                let expected = "a mesh, or <inertial> in the body: plugins are not read";
                self.element.error((&subject(self.element), "type"), Code::Unsupported, "a field of a plugin", expected, log);
                return None;
            }
            None => None,
        };
        let (pose, volume, inertia, axes) = match (&body, self.kind) {
            (Some(body), Kind::Mesh | Kind::Sdf) => {
                let inertia = body.inertia.map(|x| x / body.volume);
                (self.pose.then(&Pose::at(body.center)), body.volume, inertia, axes::principal_of_mesh(body.inertia).1)
            }
            (Some(body), kind) => {
                let (size, center) = fitted(body, kind, self.fit_corners);
                let size = scale(size, self.fit_scale);
                if size[..sizes(kind)].iter().any(|size| *size <= 0.0) {
                    let expected = "a shape that fits: the mesh is too flat for this one";
                    self.element.error((&subject(self.element), "mesh"), Code::Number, "a fitted shape without a size", expected, log);
                    return None;
                }
                let axes = body.principal().axes;
                let position = add(body.center, rotate(axes, center));
                let (volume, inertia) = shape(kind, size, self.is_shell);
                (self.pose.then(&Pose { position, rotation: axes }), volume, diagonal(inertia), IDENTITY)
            }
            (None, kind) => {
                let (volume, inertia) = shape(kind, self.size, self.is_shell);
                (self.pose, volume, diagonal(inertia), IDENTITY)
            }
        };
        if self.mass.is_some() && volume <= TINY {
            return None;
        }
        let mass = self.mass.unwrap_or(self.density * volume);
        (mass > TINY).then(|| Mass { mass, pose, inertia: inertia.map(|x| mass * x), axes: Some(axes) })
    }

    /// The ellipsoid that the medium acts on: its frame in the body, and its semi-axes, m. `None`:
    /// it has no extent along an axis, or after an error.
    pub(crate) fn ellipsoid(&self, meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> Option<(Pose, Vector)> {
        let (pose, [a, b, c]) = match self.mesh {
            None => (self.pose, self.size),
            Some(mesh) => {
                let body = meshes.body(mesh, &self.settings, log)?;
                let principal = body.principal();
                let (size, center) = match self.kind {
                    Kind::Mesh | Kind::Sdf => {
                        let [least, most] = principal.corners;
                        ([0, 1, 2].map(|k| least[k].abs().max(most[k].abs())), [0.0; 3])
                    }
                    kind => {
                        let (size, center) = fitted(&body, kind, self.fit_corners);
                        (scale(size, self.fit_scale), center)
                    }
                };
                let position = add(body.center, rotate(principal.axes, center));
                (self.pose.then(&Pose { position, rotation: principal.axes }), size)
            }
        };
        let semi_axes = match self.kind {
            Kind::Sphere => [a; 3],
            Kind::Capsule => [a, a, a + b],
            Kind::Cylinder => [a, a, b],
            _ => [a, b, c],
        };
        semi_axes.iter().all(|own| *own > 0.0).then_some((pose, semi_axes))
    }

    /// Moves it when the frame of its body moves the other way.
    pub(crate) fn move_by(&mut self, pose: &Pose) {
        self.pose = pose.then(&self.pose);
    }

    /// Whether it is a plane, with or without contact.
    pub(crate) fn is_plane(&self) -> bool {
        self.kind == Kind::Plane
    }

    /// Its shape for contact and drawings, with its pose in the body.
    pub(crate) fn shape(&self) -> Option<(Pose, CollisionShape)> {
        let unread = |why: &str| CollisionShape::Unread { why: why.to_owned() };
        let [a, b, c] = self.size;
        let shape = match (self.kind, self.mesh) {
            (Kind::Mesh, Some(mesh)) => self.mesh_shape(mesh),
            (_, Some(_)) => unread("a shape that is fitted to a mesh"),
            (Kind::Sphere, _) => CollisionShape::Sphere { radius: a },
            (Kind::Capsule, _) => CollisionShape::Capsule { radius: a, length: 2.0 * b },
            (Kind::Cylinder, _) => CollisionShape::Cylinder { radius: a, length: 2.0 * b },
            (Kind::Box, _) => CollisionShape::Box { size: [2.0 * a, 2.0 * b, 2.0 * c] },
            (Kind::Ellipsoid, _) => unread("an ellipsoid"),
            (Kind::HeightField, _) => unread("a height field"),
            (Kind::Sdf, _) => unread("a signed distance field"),
            // Of the world, see `plane`
            (Kind::Plane, _) => return None,
            (Kind::Mesh, None) => return None,
        };
        Some((self.pose, shape))
    }

    /// Its pose and its form for contact; of a form that makes none what it is.
    pub(crate) fn form(&self) -> (Pose, Result<Form, &'static str>) {
        let [a, b, _] = self.size;
        let form = match (self.kind, self.mesh) {
            (_, Some(_)) => Err("mesh"),
            (Kind::Plane, _) => Ok(Form::Plane),
            (Kind::Sphere, _) => Ok(Form::Sphere { radius: a }),
            (Kind::Capsule, _) => Ok(Form::Capsule { radius: a, half: b }),
            (Kind::Cylinder, _) => Ok(Form::Cylinder { radius: a, half: b }),
            (Kind::Box, _) => Ok(Form::Box { half: self.size }),
            (Kind::Ellipsoid, _) => Ok(Form::Ellipsoid { radii: self.size }),
            (Kind::HeightField, _) => Err("height field"),
            (Kind::Sdf | Kind::Mesh, _) => Err("mesh"),
        };
        (self.pose, form)
    }

    /// Whether it makes contact with something.
    pub(crate) fn collides(&self) -> bool {
        self.mask != ContactMask::default()
    }

    /// The frame of a contact plane: its z axis is the normal.
    pub(crate) fn plane(&self) -> Option<Pose> {
        (self.kind == Kind::Plane && self.mesh.is_none() && self.collides()).then_some(self.pose)
    }

    fn mesh_shape(&self, mesh: &Element) -> CollisionShape {
        let settings = &*self.settings;
        let class = settings.classes.find(mesh, "class", &mut Diagnostics::default()).unwrap_or(0);
        let subject = Subject::Document;
        let values = Values::new(mesh, settings.classes.tags(class, "mesh"), &subject);
        let Some(file) = mesh.text("file") else {
            return CollisionShape::Unread { why: "a mesh without a file".to_owned() };
        };
        let scale = values.exactly::<3>("scale", &mut Diagnostics::default()).unwrap_or([1.0; 3]);
        // A mesh that the file moves is drawn where it was.
        let is_moved = values.has("refpos") || values.has("refquat");
        let hull = if is_moved { Hull::Unreadable { why: format!("{file}: a mesh with `refpos` or `refquat`") } } else { Hull::NotRead };
        let [path, ..] = mesh::paths(mesh, file, settings);
        // From the folder of the document, as in other formats.
        let path = path.strip_prefix(&settings.folder).unwrap_or(&path).to_owned();
        CollisionShape::Mesh { file: path.to_string_lossy().into_owned(), scale, hull }
    }
}

/// Half the size of a shape fitted to a mesh, and its centre, in the principal axes of the mesh.
fn fitted(body: &mesh::Body, kind: Kind, to_corners: bool) -> (Vector, Vector) {
    let principal = body.principal();
    let [a, b, c] = principal.inertia_box;
    if !to_corners {
        let size = match kind {
            Kind::Sphere => [(a + b + c) / 3.0, 0.0, 0.0],
            Kind::Capsule => [(a + b) / 2.0, (c - (a + b) / 4.0).max(0.0), 0.0],
            Kind::Cylinder => [(a + b) / 2.0, c, 0.0],
            _ => [a, b, c],
        };
        return (size, [0.0; 3]);
    }
    let [least, most] = principal.corners;
    let center = scale(add(least, most), 0.5);
    let [a, b, c] = subtract(most, center);
    let radius = a.max(b);
    let size = match kind {
        Kind::Sphere => [radius.max(c), 0.0, 0.0],
        Kind::Capsule => [radius, c - radius, 0.0],
        Kind::Cylinder => [radius, c, 0.0],
        _ => [a, b, c],
    };
    (size, center)
}

/// Volume, m³ (or surface, m²), and principal moments of inertia for 1 kg of a shape.
fn shape(kind: Kind, [a, b, c]: Vector, is_shell: bool) -> (f64, Vector) {
    use std::f64::consts::PI;
    match (kind, is_shell) {
        (Kind::Sphere, false) => (4.0 * PI * a * a * a / 3.0, [2.0 * a * a / 5.0; 3]),
        (Kind::Sphere, true) => (4.0 * PI * a * a, [2.0 * a * a / 3.0; 3]),
        (Kind::Capsule, is_shell) => capsule(a, 2.0 * b, is_shell),
        (Kind::Cylinder, false) => {
            let height = 2.0 * b;
            let across = (3.0 * a * a + height * height) / 12.0;
            (PI * a * a * height, [across, across, a * a / 2.0])
        }
        (Kind::Cylinder, true) => {
            let (disk, side) = (PI * a * a, 4.0 * PI * a * b);
            let total = 2.0 * disk + side;
            let (disk, side) = (disk / total, side / total);
            let across = side * (6.0 * a * a + 4.0 * b * b) / 12.0 + 2.0 * disk * (a * a / 4.0 + b * b);
            (total, [across, across, side * a * a + disk * a * a])
        }
        (Kind::Ellipsoid, false) => (4.0 * PI * a * b * c / 3.0, [(b * b + c * c) / 5.0, (a * a + c * c) / 5.0, (a * a + b * b) / 5.0]),
        (Kind::Ellipsoid, true) => ellipsoid_shell([a, b, c]),
        (Kind::Box | Kind::HeightField, false) => (8.0 * a * b * c, [(b * b + c * c) / 3.0, (a * a + c * c) / 3.0, (a * a + b * b) / 3.0]),
        (Kind::Box | Kind::HeightField, true) => box_shell([a, b, c]),
        (Kind::Plane | Kind::Mesh | Kind::Sdf, _) => (0.0, [0.0; 3]),
    }
}

fn capsule(radius: f64, height: f64, is_shell: bool) -> (f64, Vector) {
    use std::f64::consts::PI;
    let r2 = radius * radius;
    if is_shell {
        let (ball, tube) = (4.0 * PI * r2, 2.0 * PI * radius * height);
        let total = ball + tube;
        let (ball, tube) = (ball / total, tube / total);
        // For a hemisphere, from the middle of the ball and from the middle of the capsule
        let (own, from) = (radius / 2.0, height / 2.0 + radius / 2.0);
        let across = tube * (6.0 * r2 + height * height) / 12.0 + ball * (2.0 * r2 / 3.0 + from * from - own * own);
        return (total, [across, across, tube * r2 + 2.0 * ball * r2 / 3.0]);
    }
    let volume = PI * (r2 * height + 4.0 * r2 * radius / 3.0);
    let ball = 4.0 * radius / (4.0 * radius + 3.0 * height);
    let tube = 1.0 - ball;
    let moment = 2.0 * ball * r2 / 5.0;
    let across = tube * (3.0 * r2 + height * height) / 12.0 + moment + ball * height * (3.0 * radius + 2.0 * height) / 8.0;
    (volume, [across, across, tube * r2 / 2.0 + moment])
}

/// The surface by Thomsen's approximation, the moments as those of a layer of 1e-6 m, as in MuJoCo.
fn ellipsoid_shell(size: Vector) -> (f64, Vector) {
    use std::f64::consts::PI;
    const POWER: f64 = 1.6075;
    const LAYER: f64 = 1e-6;
    let [a, b, c] = size;
    let mean = ((a * b).powf(POWER) + (b * c).powf(POWER) + (c * a).powf(POWER)) / 3.0;
    let moments = |[a, b, c]: Vector| [(b * b + c * c) / 5.0, (a * a + c * c) / 5.0, (a * a + b * b) / 5.0];
    let volume = |[a, b, c]: Vector| 4.0 * PI * a * b * c / 3.0;
    let outer = size.map(|x| x + LAYER);
    let density = 1.0 / (volume(outer) - volume(size));
    let of = |size: Vector| moments(size).map(|moment| volume(size) * density * moment);
    (4.0 * PI * mean.powf(1.0 / POWER), subtract(of(outer), of(size)))
}

fn box_shell([a, b, c]: Vector) -> (f64, Vector) {
    let [x, y, z] = [2.0 * a, 2.0 * b, 2.0 * c];
    let sides = [x * y, y * z, z * x];
    let total = 2.0 * (sides[0] + sides[1] + sides[2]);
    let [xy, yz, zx] = sides.map(|side| side / total);
    let [a2, b2, c2] = [a * a, b * b, c * c];
    let [x2, y2, z2] = [x * x / 12.0, y * y / 12.0, z * z / 12.0];
    let moments = [
        2.0 * (xy * c2 + zx * b2 + xy * y2 + yz * (y2 + z2) + zx * z2),
        2.0 * (xy * c2 + yz * a2 + xy * x2 + yz * z2 + zx * (x2 + z2)),
        2.0 * (yz * a2 + zx * b2 + xy * (x2 + y2) + yz * y2 + zx * x2),
    ];
    (total, moments)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_shells_of_a_box_are_the_shell() {
        // d/dh of the moments of a solid that grows by h on each side, by central differences
        let size = [0.2, 0.3, 0.5];
        let h = 1e-5;
        let solid = |h: f64| {
            let (volume, moments) = shape(Kind::Box, size.map(|x| x + h), false);
            moments.map(|moment| volume * moment)
        };
        let volume = |h: f64| shape(Kind::Box, size.map(|x| x + h), false).0;
        let area = (volume(h) - volume(-h)) / (2.0 * h);
        let (found, moments) = shape(Kind::Box, size, true);
        assert!((found - area).abs() < 1e-6);
        let (outer, inner) = (solid(h), solid(-h));
        for (moment, (outer, inner)) in moments.iter().zip(outer.iter().zip(inner)) {
            assert!((moment - (outer - inner) / (2.0 * h) / area).abs() < 1e-6);
        }
    }

    #[test]
    fn a_capsule_without_length_is_a_sphere() {
        for is_shell in [false, true] {
            let (volume, moments) = shape(Kind::Capsule, [0.3, 0.0, 0.0], is_shell);
            let (expected, sphere) = shape(Kind::Sphere, [0.3, 0.0, 0.0], is_shell);
            assert!((volume - expected).abs() < 1e-15 && norm(subtract(moments, sphere)) < 1e-15);
        }
    }
}
