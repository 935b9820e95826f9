//! A mesh with fewer triangles: edges are collapsed one after the other, the one that moves the
//! surface least first.
//!
//! Each point has a quadric, the sum over its triangles of the squared distance from their planes,
//! weighted by area. Open edges have planes of their own, across their triangle, so that a rim
//! keeps its place. An edge becomes its end, its middle or the point of least distance.
//! Collapses that turn a triangle over, or that pinch the surface, are left out.
//!
//! M. Garland & P. S. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH
//! 1997.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap, HashMap};

use nalgebra::{Matrix3, Vector3};

use super::geometry::Geometry;

/// Weight of the planes across open edges.
const RIM: f64 = 1e2;

/// xᵀA x + 2 bᵀx + c, by area.
#[derive(Clone, Copy)]
struct Quadric {
    a: Matrix3<f64>,
    b: Vector3<f64>,
    c: f64,
}

impl Quadric {
    const ZERO: Self = Self { a: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), b: Vector3::new(0.0, 0.0, 0.0), c: 0.0 };

    /// The squared distance from a plane through `point`, times `weight`.
    fn of_plane(normal: Vector3<f64>, point: Vector3<f64>, weight: f64) -> Self {
        let d = -normal.dot(&point);
        Self { a: weight * normal * normal.transpose(), b: weight * d * normal, c: weight * d * d }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { a: self.a + other.a, b: self.b + other.b, c: self.c + other.c }
    }

    fn at(&self, x: Vector3<f64>) -> f64 {
        (x.dot(&(self.a * x)) + 2.0 * self.b.dot(&x) + self.c).max(0.0)
    }
}

/// A collapse to try: its cost, by the bits of a number that is not negative, the points, and their
/// versions when it was found.
type Candidate = Reverse<(u64, [u32; 2], [u32; 2])>;

struct Surface {
    points: Vec<Vector3<f64>>,
    quadrics: Vec<Quadric>,
    triangles: Vec<Option<[u32; 3]>>,
    /// The triangles of each point.
    around: Vec<Vec<u32>>,
    /// Changes with each collapse into the point; collapsed points have none.
    versions: Vec<u32>,
    heap: BinaryHeap<Candidate>,
}

impl Geometry {
    /// With at most this many triangles, or as few as the surface can have without tearing.
    pub(super) fn decimated(self, most: usize) -> Self {
        if self.triangles.len() <= most { self } else { collapsed(&self, most) }
    }
}

fn collapsed(mesh: &Geometry, most: usize) -> Geometry {
    let mut surface = Surface::of(mesh);
    let mut left = mesh.triangles.len();
    while left > most
        && let Some(Reverse((_, edge, versions))) = surface.heap.pop()
    {
        if edge.map(|k| surface.versions[k as usize]) == versions {
            left -= surface.collapse(edge);
        }
    }
    surface.mesh()
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

impl Surface {
    fn of(mesh: &Geometry) -> Self {
        let points: Vec<Vector3<f64>> = mesh.points.iter().map(|p| Vector3::from(p.map(f64::from))).collect();
        let mut surface = Self {
            quadrics: vec![Quadric::ZERO; points.len()],
            around: vec![Vec::new(); points.len()],
            versions: vec![0; points.len()],
            triangles: mesh.triangles.iter().copied().map(Some).collect(),
            heap: BinaryHeap::new(),
            points,
        };
        let mut sides: HashMap<[u32; 2], usize> = HashMap::new();
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            triangle.iter().for_each(|p| surface.around[*p as usize].push(k as u32));
            edges(*triangle).iter().for_each(|[a, b]| *sides.entry([*a.min(b), *a.max(b)]).or_default() += 1);
        }
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|p| surface.points[p as usize]);
            let across = (b - a).cross(&(c - a));
            let area = across.norm();
            if area == 0.0 {
                continue;
            }
            let normal = across / area;
            let plane = Quadric::of_plane(normal, a, area);
            for p in triangle {
                surface.quadrics[*p as usize] = surface.quadrics[*p as usize].plus(&plane);
            }
            for [p, q] in edges(*triangle).into_iter().filter(|[p, q]| sides[&[*p.min(q), *p.max(q)]] == 1) {
                let [from, to] = [p, q].map(|k| surface.points[k as usize]);
                let side = to - from;
                let out = side.cross(&normal);
                if out.norm() > 0.0 {
                    let rim = Quadric::of_plane(out.normalize(), from, RIM * side.norm_squared());
                    [p, q].into_iter().for_each(|k| surface.quadrics[k as usize] = surface.quadrics[k as usize].plus(&rim));
                }
            }
        }
        sides.into_keys().collect::<BTreeSet<_>>().into_iter().for_each(|edge| surface.propose(edge));
        surface
    }

    /// The best place of an edge that becomes a point, and its cost.
    fn best(&self, [p, q]: [u32; 2]) -> (f64, Vector3<f64>) {
        let (a, b) = (self.points[p as usize], self.points[q as usize]);
        let quadric = self.quadrics[p as usize].plus(&self.quadrics[q as usize]);
        let least = quadric.a.try_inverse().map(|inverse| -inverse * quadric.b);
        // Where planes are nearly parallel the least is far away.
        let near = least.filter(|x| (x - 0.5 * (a + b)).norm() <= 1.5 * (a - b).norm());
        let choices = [Some(a), Some(b), Some(0.5 * (a + b)), near];
        let cost = |x: Vector3<f64>| (quadric.at(x), x);
        choices.into_iter().flatten().map(cost).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, a))
    }

    fn propose(&mut self, edge: [u32; 2]) {
        // Of equal costs short edges come first.
        let length = (self.points[edge[0] as usize] - self.points[edge[1] as usize]).norm_squared();
        let cost = self.best(edge).0 + 1e-9 * length * length;
        if cost.is_finite() {
            self.heap.push(Reverse((cost.to_bits(), edge, edge.map(|k| self.versions[k as usize]))));
        }
    }

    fn neighbours(&self, p: u32) -> BTreeSet<u32> {
        let corners = self.around[p as usize].iter().filter_map(|t| self.triangles[*t as usize]).flatten();
        corners.filter(|k| *k != p).collect()
    }

    /// Whether a triangle of `p`, other than those that vanish, turns over if `p` moves.
    fn turns(&self, p: u32, other: u32, place: Vector3<f64>) -> bool {
        let triangles = self.around[p as usize].iter().filter_map(|t| self.triangles[*t as usize]);
        triangles.filter(|t| !t.contains(&other)).any(|t| {
            let normal = |[a, b, c]: [Vector3<f64>; 3]| (b - a).cross(&(c - a));
            let now = t.map(|k| self.points[k as usize]);
            let then = t.map(|k| if k == p { place } else { self.points[k as usize] });
            let (before, after) = (normal(now), normal(then));
            before.dot(&after) <= 0.2 * before.norm() * after.norm()
        })
    }

    /// Makes one point of an edge; returns the number of triangles that vanish, zero if the edge
    /// stays.
    fn collapse(&mut self, [p, q]: [u32; 2]) -> usize {
        let (_, place) = self.best([p, q]);
        let vanish: Vec<u32> =
            self.around[p as usize].iter().copied().filter(|t| self.triangles[*t as usize].is_some_and(|t| t.contains(&q))).collect();
        // Two sheets that meet at a point would be pinched together.
        let shared = self.neighbours(p).intersection(&self.neighbours(q)).count();
        if vanish.is_empty() || shared != vanish.len() || self.turns(p, q, place) || self.turns(q, p, place) {
            return 0;
        }
        for t in &vanish {
            self.triangles[*t as usize] = None;
        }
        let moved = std::mem::take(&mut self.around[q as usize]);
        for t in moved {
            if let Some(triangle) = &mut self.triangles[t as usize] {
                triangle.iter_mut().filter(|k| **k == q).for_each(|k| *k = p);
                self.around[p as usize].push(t);
            }
        }
        let triangles = &self.triangles;
        self.around[p as usize].retain(|t| triangles[*t as usize].is_some());
        self.points[p as usize] = place;
        self.quadrics[p as usize] = self.quadrics[p as usize].plus(&self.quadrics[q as usize]);
        self.versions[p as usize] += 1;
        self.versions[q as usize] = u32::MAX;
        for k in self.neighbours(p) {
            self.propose([p.min(k), p.max(k)]);
        }
        vanish.len()
    }

    fn mesh(self) -> Geometry {
        let mut new: HashMap<u32, u32> = HashMap::new();
        let mut points = Vec::new();
        let mut corner = |k: u32| {
            *new.entry(k).or_insert_with(|| {
                points.push(self.points[k as usize].map(|x| x as f32).into());
                points.len() as u32 - 1
            })
        };
        let triangles = self.triangles.iter().flatten().map(|t| t.map(&mut corner)).collect();
        Geometry { points, triangles }
    }
}
