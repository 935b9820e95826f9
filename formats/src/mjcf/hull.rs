//! The convex hull of points, as triangles that look outward.
//!
//! Quickhull: of the points outside a face the farthest is taken; the faces that it sees are
//! replaced by those from their rim to the point. Barber, Dobkin & Huhdanpaa, ACM TOMS 22, 1996.

use std::collections::HashMap;

use crate::pose::{Vector, cross, dot, norm, scale, subtract};

/// More points are refused.
pub(crate) const MOST_POINTS: usize = 1 << 20;

/// A point is outside a face above this distance, relative to the size of all points.
const OUTSIDE: f64 = 1e-13;

struct Face {
    corners: [u32; 3],
    normal: Vector,
    /// normal · x of the points of its plane.
    level: f64,
    /// Points that see it.
    outside: Vec<u32>,
    is_gone: bool,
}

impl Face {
    fn of(points: &[Vector], corners: [u32; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|k| points[k as usize]);
        let normal = cross(subtract(b, a), subtract(c, a));
        let length = norm(normal);
        let normal = scale(normal, 1.0 / length);
        (length > 0.0).then(|| Self { corners, normal, level: dot(normal, a), outside: Vec::new(), is_gone: false })
    }

    fn height(&self, point: Vector) -> f64 {
        dot(self.normal, point) - self.level
    }

    fn edges(&self) -> [(u32, u32); 3] {
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)]
    }
}

/// The faces of the hull; `None` if the points lie in a plane, or if rounding leaves the surface
/// open.
pub(crate) fn hull(points: &[Vector]) -> Option<Vec<[u32; 3]>> {
    if points.len() > MOST_POINTS {
        return None;
    }
    let size = points.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let least = OUTSIDE * size;
    let mut faces = first(points)?;
    let mut by_edge = HashMap::new();
    for (index, face) in faces.iter().enumerate() {
        by_edge.extend(face.edges().map(|edge| (edge, index)));
    }
    for point in 0..points.len() as u32 {
        assign(points, point, &mut faces, 0, least);
    }
    let mut next: Vec<usize> = (0..faces.len()).collect();
    while let Some(index) = next.pop() {
        let face = &faces[index];
        if face.is_gone || face.outside.is_empty() {
            continue;
        }
        let height = |point: &u32| face.height(points[*point as usize]);
        let apex = face.outside.iter().copied().max_by(|a, b| height(a).total_cmp(&height(b)))?;
        let (rim, orphans) = remove_seen((points[apex as usize], -least), index, &mut faces, &mut by_edge)?;
        let before = faces.len();
        for (from, to) in rim {
            let face = Face::of(points, [from, to, apex])?;
            for edge in face.edges() {
                if by_edge.insert(edge, faces.len()).is_some() {
                    return None;
                }
            }
            next.push(faces.len());
            faces.push(face);
        }
        for point in orphans.into_iter().filter(|point| *point != apex) {
            assign(points, point, &mut faces, before, least);
        }
    }
    let left: Vec<[u32; 3]> = faces.iter().filter(|face| !face.is_gone).map(|face| face.corners).collect();
    let is_closed = by_edge.keys().all(|(from, to)| by_edge.contains_key(&(*to, *from)));
    is_closed.then_some(left)
}

/// The tetrahedron of points far from each other.
fn first(points: &[Vector]) -> Option<Vec<Face>> {
    let farthest = |measure: &dyn Fn(Vector) -> f64| {
        let all = points.iter().enumerate().map(|(k, point)| (k as u32, measure(*point)));
        all.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, most)| *most > 0.0).map(|(k, _)| k)
    };
    let at = |k: u32| points[k as usize];
    let origin = *points.first()?;
    let a = farthest(&|p| norm(subtract(p, origin)))?;
    let b = farthest(&|p| norm(subtract(p, at(a))))?;
    let c = farthest(&|p| norm(cross(subtract(p, at(a)), subtract(at(b), at(a)))))?;
    let base = Face::of(points, [a, b, c])?;
    let d = farthest(&|p| base.height(p).abs())?;
    let [a, b] = if base.height(at(d)) > 0.0 { [b, a] } else { [a, b] };
    [[a, b, c], [b, a, d], [c, b, d], [a, c, d]].into_iter().map(|corners| Face::of(points, corners)).collect()
}

/// Assigns a point to the first visible face from number `from` on.
fn assign(points: &[Vector], point: u32, faces: &mut [Face], from: usize, least: f64) {
    let position = points[point as usize];
    if let Some(face) = faces[from..].iter_mut().find(|face| face.height(position) > least) {
        face.outside.push(point);
    }
}

/// Edges around removed faces, and the points that were outside them.
type Removed = (Vec<(u32, u32)>, Vec<u32>);

/// Removes all faces that a point sees, starting from one; also coplanar ones, so that no triangle
/// without area is made at their edges.
fn remove_seen(
    (point, least): (Vector, f64),
    start: usize,
    faces: &mut [Face],
    by_edge: &mut HashMap<(u32, u32), usize>,
) -> Option<Removed> {
    let (mut rim, mut orphans, mut next) = (Vec::new(), Vec::new(), vec![start]);
    faces[start].is_gone = true;
    let mut seen = vec![start];
    while let Some(index) = next.pop() {
        orphans.append(&mut faces[index].outside);
        for (from, to) in faces[index].edges() {
            let neighbour = *by_edge.get(&(to, from))?;
            if faces[neighbour].is_gone {
                continue;
            }
            if faces[neighbour].height(point) >= least {
                faces[neighbour].is_gone = true;
                seen.push(neighbour);
                next.push(neighbour);
            }
        }
    }
    for index in &seen {
        for (from, to) in faces[*index].edges() {
            let neighbour = *by_edge.get(&(to, from))?;
            if !faces[neighbour].is_gone {
                rim.push((from, to));
            }
        }
    }
    for index in seen {
        faces[index].edges().iter().for_each(|edge| _ = by_edge.remove(edge));
    }
    Some((rim, orphans))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(points: &[Vector], faces: &[[u32; 3]]) -> f64 {
        let corners = faces.iter().map(|face| face.map(|k| points[k as usize]));
        corners.map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum()
    }

    #[test]
    fn the_hull_of_a_box_with_points_in_it_and_on_it_is_the_box() {
        let grid = [0.0, 0.25, 0.5, 1.0];
        let points: Vec<Vector> = grid.iter().flat_map(|x| grid.iter().flat_map(move |y| grid.map(|z| [*x, *y, 2.0 * z]))).collect();
        let faces = hull(&points).unwrap();
        assert!((volume(&points, &faces) - 2.0).abs() < 1e-14, "{}", volume(&points, &faces));
    }

    #[test]
    fn points_on_a_sphere_are_all_corners() {
        let points: Vec<Vector> = (0..500)
            .map(|k| {
                // Fibonacci's lattice
                let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 500.0;
                let (sine, cosine) = (2.399_963_229_728_653 * f64::from(k)).sin_cos();
                let r = (1.0 - z * z).sqrt();
                [r * cosine, r * sine, z]
            })
            .collect();
        let faces = hull(&points).unwrap();
        assert_eq!(faces.len(), 2 * points.len() - 4);
        let full = 4.0 * std::f64::consts::PI / 3.0;
        assert!((0.97 * full..full).contains(&volume(&points, &faces)));
    }

    #[test]
    fn points_in_a_plane_have_none() {
        assert!(hull(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]).is_none());
        assert!(hull(&[[1.0; 3]; 10]).is_none());
        assert!(hull(&[]).is_none());
    }
}
