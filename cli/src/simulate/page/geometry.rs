//! Triangles: shapes as meshes, and meshes with fewer triangles.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use articulated_core::description::CollisionShape;
use nalgebra::Vector3;
use serde::{Serialize, Serializer};

use super::track::base64;

/// Corners of a circle.
const AROUND: usize = 24;
/// Rings of half a ball, its pole among them.
const RINGS: usize = 6;

/// A mesh of triangles, each with its corners counterclockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Geometry {
    /// m.
    pub(super) points: Vec<[f32; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// In the player's format: numbers of 32 bits.
impl Serialize for Geometry {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let points = base64(&self.points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>());
        let triangles = base64(&self.triangles.iter().flatten().flat_map(|k| k.to_le_bytes()).collect::<Vec<u8>>());
        (points, triangles).serialize(to)
    }
}

impl Geometry {
    /// For shapes other than meshes; `None` for a mesh or an unreadable shape.
    pub(super) fn of(shape: &CollisionShape) -> Option<Self> {
        match shape {
            CollisionShape::Box { size } => Some(Self::cuboid(size.map(|side| side / 2.0))),
            CollisionShape::Sphere { radius } => Some(Self::turned(&capsule(*radius, 0.0))),
            CollisionShape::Capsule { radius, length } => Some(Self::turned(&capsule(*radius, *length))),
            CollisionShape::Cylinder { radius, length } => {
                let [low, high] = [-0.5 * length, 0.5 * length];
                Some(Self::turned(&[[0.0, low], [*radius, low], [*radius, high], [0.0, high]]))
            }
            CollisionShape::Mesh { .. } | CollisionShape::Unread { .. } => None,
        }
    }

    /// A box with these half edges.
    pub(super) fn cuboid(half: [f64; 3]) -> Self {
        let corner = |k: usize| std::array::from_fn(|axis| (if k >> axis & 1 == 1 { half[axis] } else { -half[axis] }) as f32);
        const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = FACES.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Self { points: (0..8).map(corner).collect(), triangles }
    }

    /// The surface of revolution of a line of points (distance from the z axis, height), from
    /// below.
    fn turned(line: &[[f64; 2]]) -> Self {
        let around = |k: usize| (k as f64 * TAU / AROUND as f64).sin_cos();
        let point = |&[r, z]: &[f64; 2], k: usize| {
            let (sine, cosine) = around(k);
            [(r * cosine) as f32, (r * sine) as f32, z as f32]
        };
        let points = line.iter().flat_map(|p| (0..AROUND).map(move |k| point(p, k))).collect();
        let index = |ring: usize, k: usize| (ring * AROUND + k % AROUND) as u32;
        let strip = |ring: usize, k: usize| {
            let [a, b, c, d] = [index(ring, k), index(ring, k + 1), index(ring + 1, k + 1), index(ring + 1, k)];
            [[a, b, c], [a, c, d]]
        };
        let triangles = (1..line.len()).flat_map(|ring| (0..AROUND).flat_map(move |k| strip(ring - 1, k))).collect();
        Self { points, triangles }.welded()
    }

    /// With each point once, and without triangles that have a corner twice or a corner that is
    /// not a number.
    pub(super) fn welded(&self) -> Self {
        // −0 is 0.
        self.clustered(|point| point.map(|x| (x + 0.0).to_bits()))
    }

    /// With one point for each key, the mean of its points.
    fn clustered(&self, key: impl Fn([f32; 3]) -> [u32; 3]) -> Self {
        let mut found: HashMap<[u32; 3], u32> = HashMap::new();
        let mut sums: Vec<(Vector3<f64>, f64)> = Vec::new();
        let new: Vec<Option<u32>> = (self.points.iter())
            .map(|&point| {
                let at = Vector3::from(point.map(f64::from));
                let index = *at.iter().all(|x| x.is_finite()).then(|| found.entry(key(point)).or_insert(sums.len() as u32))?;
                if index as usize == sums.len() {
                    sums.push((Vector3::zeros(), 0.0));
                }
                let sum = &mut sums[index as usize];
                *sum = (sum.0 + at, sum.1 + 1.0);
                Some(index)
            })
            .collect();
        let corner = |k: u32| new.get(k as usize).copied().flatten();
        let triangle = |t: &[u32; 3]| Some([corner(t[0])?, corner(t[1])?, corner(t[2])?]);
        let is_flat = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
        let mut triangles: Vec<[u32; 3]> = self.triangles.iter().filter_map(triangle).filter(|t| !is_flat(t)).collect();
        // Triangles of merged points may coincide.
        let smallest_first = |t: &[u32; 3]| (0..3).map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]).min().unwrap_or(*t);
        triangles.iter_mut().for_each(|t| *t = smallest_first(t));
        triangles.sort_unstable();
        triangles.dedup();
        Self { points: sums.iter().map(|(sum, count)| (sum / *count).map(|x| x as f32).into()).collect(), triangles }
    }

    /// With the coordinates multiplied; a mirrored mesh is turned inside out again.
    pub(super) fn scaled(mut self, scale: [f64; 3]) -> Self {
        for point in &mut self.points {
            *point = std::array::from_fn(|axis| (f64::from(point[axis]) * scale[axis]) as f32);
        }
        if scale.iter().product::<f64>() < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        self
    }

    /// The corners of the box along the axes that holds it.
    pub(super) fn bounds(&self) -> Vec<Vector3<f64>> {
        let end = |axis: usize, pick: fn(f32, f32) -> f32| self.points.iter().map(|p| p[axis]).reduce(pick).map(f64::from);
        let ends = [0, 1, 2].map(|axis| end(axis, f32::min).zip(end(axis, f32::max)));
        let [Some(x), Some(y), Some(z)] = ends else { return Vec::new() };
        let pick = |(low, high): (f64, f64), k: usize, bit: usize| if k >> bit & 1 == 1 { high } else { low };
        (0..8).map(|k| Vector3::new(pick(x, k, 0), pick(y, k, 1), pick(z, k, 2))).collect()
    }
}

/// Half a circle, a line of this length, and half a circle again.
fn capsule(radius: f64, length: f64) -> Vec<[f64; 2]> {
    let arc = |k: usize, middle: f64| {
        let (sine, cosine) = (-FRAC_PI_2 + k as f64 * PI / (2 * RINGS) as f64).sin_cos();
        // The poles are on the axis.
        [if k.is_multiple_of(2 * RINGS) { 0.0 } else { radius * cosine }, middle + radius * sine]
    };
    (0..=RINGS).map(|k| arc(k, -0.5 * length)).chain((RINGS..=2 * RINGS).map(|k| arc(k, 0.5 * length))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the divergence theorem.
    fn volume(mesh: &Geometry) -> f64 {
        let point = |k: u32| Vector3::from(mesh.points[k as usize].map(f64::from));
        mesh.triangles.iter().map(|[a, b, c]| point(*a).dot(&point(*b).cross(&point(*c))) / 6.0).sum()
    }

    fn shape(shape: &CollisionShape) -> Geometry {
        Geometry::of(shape).unwrap()
    }

    #[test]
    fn shapes_are_closed_and_have_the_volume_of_the_shape() {
        let (radius, length) = (0.3, 0.8);
        let (ball, rod) = (4.0 / 3.0 * PI * radius * radius * radius, PI * radius * radius * length);
        let cases = [
            (CollisionShape::Box { size: [0.2, 0.5, 0.7] }, 0.07, 1e-6),
            (CollisionShape::Sphere { radius }, ball, 0.04),
            (CollisionShape::Cylinder { radius, length }, rod, 0.02),
            (CollisionShape::Capsule { radius, length }, ball + rod, 0.03),
        ];
        for (kind, expected, off) in cases {
            let mesh = shape(&kind);
            let found = volume(&mesh);
            assert!(found <= expected * (1.0 + 1e-6) && found > expected * (1.0 - off), "{kind:?}: {found}, {expected}");
            // Each edge belongs to two triangles, once in each direction.
            let edges = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
            let all: std::collections::HashSet<[u32; 2]> = mesh.triangles.iter().flat_map(edges).collect();
            assert_eq!(all.len(), 3 * mesh.triangles.len(), "{kind:?}");
            assert!(all.iter().all(|[a, b]| all.contains(&[*b, *a])), "{kind:?}");
        }
        let mesh = CollisionShape::Mesh { file: String::new(), scale: [1.0; 3], hull: articulated_core::description::Hull::NotRead };
        assert!(Geometry::of(&mesh).is_none());
    }

    #[test]
    fn a_mesh_with_too_many_triangles_keeps_its_shape() {
        let fine: Vec<[f64; 2]> =
            (0..=500).map(|k| (f64::from(k) * PI / 500.0 - FRAC_PI_2).sin_cos()).map(|(sine, cosine)| [cosine, sine]).collect();
        let mesh = Geometry::turned(&fine);
        assert!(mesh.triangles.len() > 20_000);
        let coarse = mesh.clone().decimated(5_000);
        assert!((4_000..=5_000).contains(&coarse.triangles.len()), "{}", coarse.triangles.len());
        assert!((volume(&coarse) / volume(&mesh) - 1.0).abs() < 1e-3, "{}", volume(&coarse));
        assert_eq!(coarse.clone().decimated(5_000), coarse);
    }

    /// A thin tube, open at both ends, and a sheet: neither tears, and the rims stay.
    #[test]
    fn open_meshes_keep_their_rims_and_their_walls() {
        let line: Vec<[f64; 2]> = (0..=400).map(|k| [0.04, f64::from(k) * 1e-3]).collect();
        let tube = Geometry::turned(&line);
        let coarse = tube.clone().decimated(400);
        assert!(coarse.triangles.len() <= 400, "{}", coarse.triangles.len());
        assert_eq!(coarse.bounds().len(), 8);
        for (a, b) in coarse.bounds().iter().zip(tube.bounds()) {
            assert!((a - b).norm() < 1e-3, "{a} {b}");
        }
        // The area of the wall, and open edges at the two rims alone.
        let area = |mesh: &Geometry| -> f64 {
            let point = |k: u32| Vector3::from(mesh.points[k as usize].map(f64::from));
            mesh.triangles.iter().map(|[a, b, c]| (point(*b) - point(*a)).cross(&(point(*c) - point(*a))).norm() / 2.0).sum()
        };
        assert!((area(&coarse) / area(&tube) - 1.0).abs() < 0.02, "{}", area(&coarse) / area(&tube));
        let mut sides: HashMap<[u32; 2], usize> = HashMap::new();
        for t in &coarse.triangles {
            for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
                *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
        }
        let height = |k: &u32| coarse.points[*k as usize][2];
        for (side, _) in sides.iter().filter(|(_, count)| **count == 1) {
            assert!(side.iter().all(|k| height(k) < 1e-3 || height(k) > 0.399), "a tear at {side:?}");
        }
        assert!(sides.values().all(|count| *count <= 2));
    }

    /// Each point of the fine mesh is near the coarse one, so that no view loses a part.
    #[test]
    fn a_box_with_fine_faces_keeps_its_corners() {
        let n = 40_u32;
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for axis in 0..3 {
            for end in [0.0_f32, 1.0] {
                let first = points.len() as u32;
                let at = |i: u32, k: u32| {
                    let mut p = [0.0; 3];
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (end, i as f32 / n as f32, k as f32 / n as f32);
                    p
                };
                points.extend((0..=n).flat_map(|i| (0..=n).map(move |k| at(i, k))));
                for (i, k) in (0..n).flat_map(|i| (0..n).map(move |k| (i, k))) {
                    let corner = |i: u32, k: u32| first + i * (n + 1) + k;
                    let [a, b, c, d] = [corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1)];
                    triangles.extend(if end > 0.5 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
                }
            }
        }
        let mesh = Geometry { points, triangles }.welded();
        let coarse = mesh.clone().decimated(60);
        assert!(coarse.triangles.len() <= 60, "{}", coarse.triangles.len());
        assert!((volume(&coarse) - 1.0).abs() < 1e-5, "{}", volume(&coarse));
    }

    #[test]
    fn points_that_are_no_numbers_are_left_out_with_their_triangles() {
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f32::NAN; 3], [-0.0, 0.0, 0.0]];
        let mesh = Geometry { points, triangles: vec![[0, 1, 2], [1, 2, 3], [0, 4, 1], [4, 1, 2], [0, 1, 9]] };
        let kept = mesh.welded();
        assert_eq!((kept.points.len(), kept.triangles), (3, vec![[0, 1, 2]]));
    }

    #[test]
    fn a_mirrored_mesh_keeps_its_outside() {
        let mesh = Geometry::cuboid([0.5; 3]).scaled([-2.0, 1.0, 1.0]);
        assert!((volume(&mesh) - 2.0).abs() < 1e-6);
        assert_eq!(mesh.bounds()[7], Vector3::new(1.0, 0.5, 0.5));
    }
}
