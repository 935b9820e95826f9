//! Points of meshes on which links touch the ground.
//!
//! h(d) = max dᵀx is how far points reach along d. Contact with a plane depends on h alone. Each
//! step adds the vertex where h of the chosen points falls short most.

use std::cmp::Ordering;
use std::path::Path;

use articulated_core::description::{CollisionShape, Description, Hull};
use articulated_core::diagnostic::quote;

use crate::Input;
use crate::mesh_file::{ascii_stl, parse};
use crate::pose::{Vector, dot};
use crate::xacro::Packages;

/// Points of a mesh, at most: as many as those of a cylinder.
const MOST: usize = 16;

/// Directions in which reach is compared, beside those of the axes.
const DIRECTIONS: usize = 500;

/// A shortfall that does not matter, relative to the size of the mesh.
const LEAST: f64 = 1e-9;

/// Reads the meshes of collision geometry, and keeps their points.
pub(crate) fn read(description: &mut Description, input: &Input<'_>) {
    let beside = Path::new(&input.options.file).parent().unwrap_or(Path::new(""));
    let mut packages = Packages::default();
    for piece in description.links.iter_mut().flat_map(|link| &mut link.collision) {
        let CollisionShape::Mesh { file, scale, hull } = &mut piece.shape else { continue };
        if *hull == Hull::NotRead {
            let found = vertices(file, beside, &mut packages, input);
            *hull = found.map_or_else(|why| Hull::Unreadable { why }, |vertices| points_of(&vertices, *scale));
        }
    }
}

/// The vertices of a file; otherwise why there are none.
fn vertices(name: &str, beside: &Path, packages: &mut Packages, input: &Input<'_>) -> Result<Vec<Vector>, String> {
    let as_package = name.strip_prefix("model://").map_or_else(|| name.to_owned(), |rest| format!("package://{rest}"));
    let path = packages
        .path(&as_package, beside, input)
        .map_err(|package| format!("{}: no package {}; `packages` or --package names its folder", quote(name), quote(&package)))?;
    let bytes = input.sources.read(&path).map_err(|error| format!("{}: {error}", quote(&path.to_string_lossy())))?;
    let read = parse(&bytes, &path, "").or_else(|why| ascii_stl(&bytes, &path).ok_or(why));
    let vertices = read.map_err(|why| format!("{}: {why}; STL, OBJ and MSH are read for contact", quote(name)))?.vertices;
    if vertices.is_empty() { Err(format!("{}: a mesh without vertices", quote(name))) } else { Ok(vertices) }
}

/// Directions all over the sphere, those of the axes first.
fn directions() -> Vec<Vector> {
    let axes = (0..6).map(|k| [0, 1, 2].map(|i| if i == k / 2 { [1.0, -1.0][k % 2] } else { 0.0 }));
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let spiral = (0..DIRECTIONS).map(|k| {
        let (z, angle) = (1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64, golden * k as f64);
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    });
    axes.chain(spiral).collect()
}

/// The vertices that reach farthest.
fn points_of(vertices: &[Vector], scale: Vector) -> Hull {
    // A file of triangles has each vertex several times.
    let mut scaled: Vec<Vector> = vertices.iter().map(|x| [0, 1, 2].map(|k| x[k] * scale[k])).collect();
    let by_numbers = |a: &Vector, b: &Vector| (0..3).map(|k| a[k].total_cmp(&b[k])).find(|order| order.is_ne());
    scaled.sort_unstable_by(|a, b| by_numbers(a, b).unwrap_or(Ordering::Equal));
    scaled.dedup();
    // Per direction: its farthest vertex, and how far that and the chosen ones reach.
    let mut open: Vec<(Vector, usize, f64, f64)> = directions()
        .into_iter()
        .map(|d| {
            let reach = scaled.iter().map(|x| dot(d, *x)).enumerate();
            let (far, most) = reach.fold((0, f64::NEG_INFINITY), |most, next| if next.1 > most.1 { next } else { most });
            (d, far, most, f64::NEG_INFINITY)
        })
        .collect();
    let size = scaled.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut points: Vec<Vector> = Vec::new();
    loop {
        let worst = open.iter().max_by(|a, b| (a.2 - a.3).total_cmp(&(b.2 - b.3)));
        let Some(&(_, far, reach, chosen)) = worst else { return Hull::default() };
        let missing = reach - chosen;
        if missing <= LEAST * size || points.len() == MOST {
            return Hull::Points { points, missing: missing.max(0.0), vertices: scaled.len() };
        }
        let point = scaled[far];
        open.iter_mut().for_each(|(d, _, _, chosen)| *chosen = chosen.max(dot(*d, point)));
        points.push(point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(vertices: &[Vector]) -> (Vec<Vector>, f64) {
        match points_of(vertices, [1.0, 1.0, 2.0]) {
            Hull::Points { points, missing, .. } => (points, missing),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_box_of_many_vertices_touches_on_its_corners() {
        let side = || (0..5).map(|k| f64::from(k) / 4.0 - 0.5);
        let all: Vec<Vector> = side().flat_map(|x| side().flat_map(move |y| side().map(move |z| [x, y, z]))).collect();
        let (points, missing) = points(&all);
        assert_eq!((points.len(), missing), (8, 0.0));
        assert!(points.iter().all(|p| p[0].abs() == 0.5 && p[1].abs() == 0.5 && p[2].abs() == 1.0), "{points:?}");
    }

    #[test]
    fn a_plate_and_a_point_have_points_too() {
        assert_eq!(points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, 0.0]]).0.len(), 3);
        assert_eq!(points(&[[1.0, 2.0, 3.0]]).0, [[1.0, 2.0, 6.0]]);
        assert_eq!(points(&[[0.0; 3]]).0.len(), 1);
    }

    #[test]
    fn of_a_ball_as_many_points_touch_as_there_may_be() {
        let (found, missing) = points(&directions());
        assert_eq!(found.len(), MOST);
        // Stretched twofold; the caps between 16 points on a ball are about 0.2 high.
        assert!(missing > 0.1 && missing < 0.5, "{missing}");
        let reach = |all: &[Vector], d: Vector| all.iter().map(|x| dot(*x, d)).fold(f64::MIN, f64::max);
        let whole: Vec<Vector> = directions().iter().map(|[x, y, z]| [*x, *y, 2.0 * z]).collect();
        assert!(directions().into_iter().all(|d| reach(&whole, d) - reach(&found, d) <= missing + 1e-12));
    }
}
