//! Volumes and inertias of meshes, from files and from vertices in the document.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::axes;
use super::element::Element;
use super::hull::hull;
use super::settings::Settings;
use super::values::Values;
use crate::Sources;
use crate::mesh_file::{Triangles, parse};
use crate::pose::{Quaternion, Symmetric, Vector, add, conjugate, cross, dot, norm, rotate, scale, subtract};

/// How a mesh becomes a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    /// Tetrahedra from the centroid of the faces, all of positive volume.
    Legacy,
    /// Tetrahedra with the sign of their face.
    Exact,
    /// The surface alone.
    Shell,
    /// The convex hull.
    Convex,
}

/// A mesh as a body of density 1 (of surface density 1 for a shell), in the frame of its file.
#[derive(Debug)]
pub(crate) struct Body {
    /// m³, or m² of a shell.
    pub(crate) volume: f64,
    pub(crate) center: Vector,
    /// About the centre, in the axes of the file.
    pub(crate) inertia: Symmetric,
    vertices: Vec<Vector>,
}

/// A mesh in the axes of its inertia, about its centre.
pub(crate) struct Principal {
    /// To the axes of the file.
    pub(crate) axes: Quaternion,
    /// Half the sides of the box of equal volume and inertia, m.
    pub(crate) inertia_box: Vector,
    /// The corners of the smallest box along the axes, m.
    pub(crate) corners: [Vector; 2],
}

impl Body {
    pub(crate) fn principal(&self) -> Principal {
        let ([a, b, c], axes) = axes::principal_of_mesh(self.inertia);
        let side = |two: f64, one: f64| 0.5 * (6.0 * (two - one).max(0.0) / self.volume).sqrt();
        let back = conjugate(axes);
        let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for vertex in &self.vertices {
            let own = rotate(back, subtract(*vertex, self.center));
            for k in 0..3 {
                corners[0][k] = corners[0][k].min(own[k]);
                corners[1][k] = corners[1][k].max(own[k]);
            }
        }
        Principal { axes, inertia_box: [side(b + c, a), side(a + c, b), side(a + b, c)], corners }
    }
}

/// All meshes that geoms refer to.
pub(crate) struct Meshes<'a> {
    sources: &'a dyn Sources,
    /// By the place of the tag in memory.
    known: BTreeMap<usize, Option<Rc<Body>>>,
}

impl<'a> Meshes<'a> {
    pub(crate) fn new(sources: &'a dyn Sources) -> Self {
        Self { sources, known: BTreeMap::new() }
    }

    /// The body of a mesh; an error, once, if it has none.
    pub(crate) fn body(&mut self, element: &Element, settings: &Settings<'_>, log: &mut Diagnostics) -> Option<Rc<Body>> {
        let key = std::ptr::from_ref(element) as usize;
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let body = self.read(element, settings, log).map(Rc::new);
        self.known.insert(key, body.clone());
        body
    }

    fn read(&self, element: &Element, settings: &Settings<'_>, log: &mut Diagnostics) -> Option<Body> {
        let class = settings.classes.find(element, "class", log).unwrap_or(0);
        let values = Values::new(element, settings.classes.tags(class, "mesh"), &Subject::Document);
        let modes = [("legacy", Mode::Legacy), ("exact", Mode::Exact), ("shell", Mode::Shell), ("convex", Mode::Convex)];
        let mode = if values.has("inertia") { values.word("inertia", &modes, log)? } else { Mode::Legacy };
        let mut triangles = self.triangles(&values, settings, log)?;
        let scale = values.exactly::<3>("scale", log).unwrap_or([1.0; 3]);
        let position = values.exactly::<3>("refpos", log).unwrap_or_default();
        let rotation = conjugate(values.exactly::<4>("refquat", log).unwrap_or([1.0, 0.0, 0.0, 0.0]));
        for vertex in &mut triangles.vertices {
            let own = rotate(rotation, subtract(*vertex, position));
            *vertex = [0, 1, 2].map(|k| own[k] * scale[k]);
        }
        if scale.iter().product::<f64>() < 0.0 {
            triangles.faces.iter_mut().for_each(|face| face.swap(1, 2));
        }
        if mode == Mode::Convex || triangles.faces.is_empty() {
            if values.exactly::<1>("maxhullvert", log).is_some_and(|[most]| most >= 0.0) {
                let expected = "the whole hull, or <inertial> in the body: `maxhullvert` is not read";
                values.error("maxhullvert", Code::Unsupported, "a part of a convex hull", expected, log);
                return None;
            }
            let Some(faces) = hull(&triangles.vertices) else {
                let found = "points without a convex hull that can be computed";
                values.error("inertia", Code::Unsupported, found, "points that do not lie in a plane", log);
                return None;
            };
            triangles.faces = faces;
        }
        let body = body(triangles, mode);
        if body.is_none() {
            let expected = "a closed surface whose faces have one orientation, or `inertia=\"shell\"`";
            values.error("file", Code::Unsupported, "a mesh of no volume", expected, log);
        }
        body
    }

    fn triangles(&self, values: &Values<'_>, settings: &Settings<'_>, log: &mut Diagnostics) -> Option<Triangles> {
        let element = values.element;
        let mut triangles = match element.text("file") {
            Some(file) => {
                let (bytes, path) = self.file(element, file, settings, log)?;
                match parse(&bytes, &path, element.text("content_type").unwrap_or_default()) {
                    Ok(triangles) => {
                        if triangles.has_others {
                            let found = format!("{}: an OBJ of several objects or groups", quote(file));
                            let expected = "one object: the first one alone gives the mass, as in MuJoCo";
                            element.warning((&values.subject, "file"), Code::LostDynamics, found, expected, log);
                        }
                        triangles
                    }
                    Err(found) => {
                        let expected = "a binary STL, an OBJ or an MSH with faces of vertices that exist";
                        values.error("file", Code::File, format!("{}: {found}", quote(file)), expected, log);
                        return None;
                    }
                }
            }
            None if values.has("builtin") => {
                let found = format!("the mesh {}", quote(values.text("builtin").unwrap_or_default()));
                values.error("builtin", Code::Unsupported, found, "a file or vertices, or <inertial> in the body", log);
                return None;
            }
            None => Triangles::default(),
        };
        if let Some(numbers) = values.list("vertex", log) {
            triangles.vertices = numbers.chunks_exact(3).map(|v| [0, 1, 2].map(|k| single(v[k]))).collect();
        }
        if let Some(numbers) = values.list("face", log) {
            triangles.faces = numbers.chunks_exact(3).map(|f| [0, 1, 2].map(|k| f[k] as u32)).collect();
        }
        let count = triangles.vertices.len();
        if count < 4 || triangles.faces.iter().flatten().any(|index| *index as usize >= count) {
            let found = format!("{count} vertices and {} faces", triangles.faces.len());
            values.error("vertex", Code::WrongCount, found, "at least 4 vertices, and faces of those", log);
            return None;
        }
        Some(triangles)
    }

    fn file(&self, element: &Element, file: &str, settings: &Settings<'_>, log: &mut Diagnostics) -> Option<(Vec<u8>, PathBuf)> {
        let mut first = None;
        for path in paths(element, file, settings) {
            match self.sources.read(&path) {
                Ok(bytes) => return Some((bytes, path)),
                Err(error) => first = first.or(Some((error, path))),
            }
        }
        let (error, path) = first?;
        let found = format!("{}: {error}", quote(&path.to_string_lossy()));
        let expected = "a file: the mass of a body is that of its meshes, unless it has <inertial>";
        element.error((&Subject::Document, "file"), Code::File, found, expected, log);
        None
    }
}

/// Possible paths of a mesh's file: from the main file's folder, or from the folder of the file
/// that names it.
pub(crate) fn paths(element: &Element, file: &str, settings: &Settings<'_>) -> [PathBuf; 3] {
    let stripped = file.rsplit(['/', '\\']).next().unwrap_or_default();
    let file = Path::new(if settings.compiler.strip_path { stripped } else { file });
    let meshes = Path::new(&settings.compiler.mesh_folder);
    let beside = Path::new(&element.file.name).parent().unwrap_or(Path::new(""));
    [settings.folder.join(meshes).join(file), beside.join(meshes).join(file), beside.join(file)]
}

fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Volume, centre and inertia of the solid enclosed by the faces, or of the faces.
fn body(triangles: Triangles, mode: Mode) -> Option<Body> {
    const LEAST: f64 = 1e-15;
    let Triangles { vertices, faces, .. } = triangles;
    let corners = |face: &[u32; 3]| face.map(|k| vertices[k as usize]);
    let middle = |[a, b, c]: [Vector; 3]| scale(add(add(a, b), c), 1.0 / 3.0);
    // Twice the area, along the normal.
    let normal = |[a, b, c]: [Vector; 3]| cross(subtract(b, a), subtract(c, a));
    // The centroid of the faces
    let (mut area, mut centroid) = (0.0, [0.0; 3]);
    for face in faces.iter().map(corners) {
        let own = norm(normal(face)) / 2.0;
        area += own;
        centroid = add(centroid, scale(middle(face), own));
    }
    if area < LEAST || !area.is_finite() {
        return None;
    }
    let centroid = scale(centroid, 1.0 / area);
    // V = Σ (m − o)·n / 6 over the tetrahedra from o to the faces, or the area of the faces
    let size = |face: [Vector; 3], from: Vector| match mode {
        Mode::Shell => norm(normal(face)) / 2.0,
        Mode::Legacy => (dot(subtract(middle(face), from), normal(face)) / 6.0).abs(),
        Mode::Exact | Mode::Convex => dot(subtract(middle(face), from), normal(face)) / 6.0,
    };
    let (mut volume, mut center) = (0.0, [0.0; 3]);
    for face in faces.iter().map(corners) {
        let own = size(face, centroid);
        volume += own;
        center = add(center, scale(add(scale(middle(face), 3.0), centroid), own / 4.0));
    }
    if volume < LEAST {
        return None;
    }
    let center = scale(center, 1.0 / volume);
    // The products of inertia of a tetrahedron with one corner at the origin, or of a triangle
    let parts = if mode == Mode::Shell { 12.0 } else { 20.0 };
    let (mut volume, mut products) = (0.0, [0.0; 6]);
    for face in faces.iter().map(corners) {
        let [d, e, f] = face.map(|corner| subtract(corner, center));
        let own = size([d, e, f], [0.0; 3]);
        volume += own;
        for (product, (i, j)) in products.iter_mut().zip([(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]) {
            let twice = 2.0 * (d[i] * d[j] + e[i] * e[j] + f[i] * f[j]);
            let mixed = d[i] * e[j] + d[j] * e[i] + d[i] * f[j] + d[j] * f[i] + e[i] * f[j] + e[j] * f[i];
            *product += own / parts * (twice + mixed);
        }
    }
    let [xx, xy, xz, yy, yz, zz] = products;
    let inertia = [yy + zz, -xy, -xz, xx + zz, -yz, xx + yy];
    (volume >= LEAST).then_some(Body { volume, center, inertia, vertices })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_file::obj;

    /// A box of sides 1, 2 and 3 from the origin, with faces of four corners that look outward.
    const BOX: &str = "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1/1/1 2/2/2 6/3 5\nf -5 -1 -2 -6\nf 1 5 8 4\nf 2 3 7 6\n";

    #[test]
    fn a_box_has_the_inertia_of_a_box_in_each_mode() {
        for mode in [Mode::Legacy, Mode::Exact] {
            let found = body(obj(BOX.as_bytes()).unwrap(), mode).unwrap();
            assert!((found.volume - 6.0).abs() < 1e-14, "{mode:?} {}", found.volume);
            assert!(norm(subtract(found.center, [0.5, 1.0, 1.5])) < 1e-14);
            let expected = [6.5, 0.0, 0.0, 5.0, 0.0, 2.5];
            assert!(found.inertia.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-13), "{:?}", found.inertia);
            let sides = found.principal().inertia_box;
            assert!(norm(subtract(sides, [0.5, 1.0, 1.5])) < 1e-13, "{sides:?}");
        }
        let shell = body(obj(BOX.as_bytes()).unwrap(), Mode::Shell).unwrap();
        assert!((shell.volume - 22.0).abs() < 1e-13);
    }
}
