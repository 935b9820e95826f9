//! Shapes of links: their appearance, their collision geometry, and the points of it that touch the
//! ground.

use alloc::string::String;
use alloc::vec::Vec;

use super::Origin;
use crate::spatial::Vector3;

/// A piece of a link's collision geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// The shape's frame in the link's frame.
    pub origin: Origin,
    /// The shape.
    pub shape: CollisionShape,
}

/// A piece of a link's appearance.
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// The shape's frame in the link's frame.
    pub origin: Origin,
    /// The shape.
    pub shape: CollisionShape,
    /// The name of its material; empty where it has none.
    pub material: String,
    /// The colour of its material, if the file says it: red, green, blue and opacity, 0 to 1.
    pub color: Option<[f64; 4]>,
}

/// A shape about the origin of its frame. Sizes are finite and at least 0.
#[derive(Clone, Debug, PartialEq)]
pub enum CollisionShape {
    /// A ball.
    Sphere {
        /// m.
        radius: f64,
    },
    /// A box along the axes of its frame.
    Box {
        /// Lengths of its sides along x, y and z, m.
        size: [f64; 3],
    },
    /// A cylinder along the z axis of its frame.
    Cylinder {
        /// m.
        radius: f64,
        /// From one end to the other, m.
        length: f64,
    },
    /// A cylinder along the z axis of its frame with half a ball on each end.
    Capsule {
        /// m.
        radius: f64,
        /// Of the cylinder alone, m.
        length: f64,
    },
    /// A mesh in a file.
    Mesh {
        /// The file's name, as it is written.
        file: String,
        /// Factors of the mesh's coordinates along x, y and z.
        scale: [f64; 3],
        /// Its points that touch the ground, if the file was read for them.
        hull: Hull,
    },
    /// A shape that could not be read.
    Unread {
        /// Why, in a sentence.
        why: String,
    },
}

/// Points of the convex hull of a mesh, on which it touches the ground.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Hull {
    /// The points were not requested.
    #[default]
    NotRead,
    /// The file has none.
    Unreadable {
        /// Why, in a sentence.
        why: String,
    },
    /// Some vertices of the mesh.
    Points {
        /// In the frame of the shape, with the mesh's scale, m.
        points: Vec<[f64; 3]>,
        /// The mesh reaches at most about this much farther than the points, m.
        missing: f64,
        /// Vertices in the file.
        vertices: usize,
    },
}

/// A sphere of a link that touches the ground for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSphere {
    /// Its centre in the link's frame, m.
    pub center: [f64; 3],
    /// Its radius, m: 0 for a point.
    pub radius: f64,
}

/// Number of points on each rim of a cylinder, the first of them in the direction of its x axis.
pub const RIM_POINTS: usize = 8;

impl Collision {
    /// The spheres that touch a plane for the shape, in the link's frame: of a sphere itself, of a
    /// box its 8 corners, of a capsule the two balls at its ends, of a cylinder [`RIM_POINTS`]
    /// points on each rim, the lower one first, of a mesh the points of its [`Hull`]. Coincident
    /// corners, as those of a plate, are one. None for an unread shape.
    pub fn contact_spheres(&self) -> Vec<ContactSphere> {
        let (radius, points) = match &self.shape {
            CollisionShape::Sphere { radius } => (*radius, [[0.0; 3]].into()),
            CollisionShape::Box { size } => (0.0, corners(*size)),
            CollisionShape::Cylinder { radius, length } => (0.0, rims(*radius, *length)),
            CollisionShape::Capsule { radius, length } => (*radius, [-0.5, 0.5].map(|end| [0.0, 0.0, end * length]).into()),
            CollisionShape::Mesh { hull: Hull::Points { points, .. }, .. } => (0.0, points.clone()),
            CollisionShape::Mesh { .. } | CollisionShape::Unread { .. } => (0.0, Vec::new()),
        };
        let (turn, at) = (self.origin.rotation.matrix::<f64>(), Vector3::from(self.origin.xyz));
        let mut spheres: Vec<ContactSphere> = Vec::new();
        for point in points {
            let center: [f64; 3] = (at + turn * Vector3::from(point)).into();
            // A plate has each corner twice, and a rod without radius its ends.
            if spheres.iter().all(|other| other.center != center) {
                spheres.push(ContactSphere { center, radius });
            }
        }
        spheres
    }
}

fn corners(size: [f64; 3]) -> Vec<[f64; 3]> {
    const ENDS: [f64; 2] = [-0.5, 0.5];
    let of = |z: f64| ENDS.map(|y| ENDS.map(|x| [x * size[0], y * size[1], z * size[2]]));
    ENDS.map(of).as_flattened().as_flattened().to_vec()
}

fn rims(radius: f64, length: f64) -> Vec<[f64; 3]> {
    // cos 45° = sin 45°
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let circle: [[f64; 2]; RIM_POINTS] =
        [[1.0, 0.0], [half, half], [0.0, 1.0], [-half, half], [-1.0, 0.0], [-half, -half], [0.0, -1.0], [half, -half]];
    let rim = |end: f64| circle.map(|[x, y]| [radius * x, radius * y, end * length]);
    [-0.5, 0.5].map(rim).as_flattened().to_vec()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::*;

    fn spheres(shape: CollisionShape, origin: Origin) -> Vec<ContactSphere> {
        Collision { origin, shape }.contact_spheres()
    }

    /// The least of nᵀ(centre) − radius, which a plane with the normal n first touches.
    fn lowest(spheres: &[ContactSphere], n: [f64; 3]) -> f64 {
        let down = |s: &ContactSphere| (0..3).map(|k| n[k] * s.center[k]).sum::<f64>() - s.radius;
        spheres.iter().map(down).fold(f64::INFINITY, f64::min)
    }

    /// Directions all over the sphere, of length one.
    fn directions() -> impl Iterator<Item = [f64; 3]> {
        (0..400).map(|k| {
            let (z, angle) = (1.0 - (f64::from(k) + 0.5) / 200.0, 2.399_963 * f64::from(k));
            let r = (1.0 - z * z).sqrt();
            [r * angle.cos(), r * angle.sin(), z]
        })
    }

    #[test]
    fn the_points_of_a_shape_reach_as_far_as_the_shape_does_in_every_direction() {
        let (radius, length, size) = (0.3, 0.8, [0.2, 0.5, 0.7]);
        for [x, y, z] in directions() {
            let reach = |shape| -lowest(&spheres(shape, Origin::default()), [x, y, z]);
            let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-15, "{found} {expected}");
            close(reach(CollisionShape::Sphere { radius }), radius);
            close(reach(CollisionShape::Capsule { radius, length }), radius + 0.5 * length * z.abs());
            close(reach(CollisionShape::Box { size }), 0.5 * (size[0] * x.abs() + size[1] * y.abs() + size[2] * z.abs()));
            // Of a rim at most 1 − cos(π/8) of the radius is missing.
            let (found, rim) = (reach(CollisionShape::Cylinder { radius, length }), radius * x.hypot(y));
            let whole = rim + 0.5 * length * z.abs();
            assert!(found <= whole + 1e-15 && found >= whole - 0.0762 * rim, "{found} {whole}");
        }
    }

    #[test]
    fn there_are_as_many_points_as_a_shape_has_ends() {
        let count = |shape| spheres(shape, Origin::default()).len();
        assert_eq!(count(CollisionShape::Sphere { radius: 1.0 }), 1);
        assert_eq!(count(CollisionShape::Capsule { radius: 1.0, length: 1.0 }), 2);
        assert_eq!(count(CollisionShape::Box { size: [1.0; 3] }), 8);
        assert_eq!(count(CollisionShape::Cylinder { radius: 1.0, length: 1.0 }), 16);
        // A plate, a rod, a disc, a point.
        assert_eq!(count(CollisionShape::Box { size: [1.0, 1.0, 0.0] }), 4);
        assert_eq!(count(CollisionShape::Cylinder { radius: 0.0, length: 1.0 }), 2);
        assert_eq!(count(CollisionShape::Cylinder { radius: 1.0, length: 0.0 }), 8);
        assert_eq!(count(CollisionShape::Box { size: [0.0; 3] }), 1);
        let mesh = |hull| CollisionShape::Mesh { file: "foot.stl".into(), scale: [1.0; 3], hull };
        assert_eq!(count(mesh(Hull::NotRead)), 0);
        assert_eq!(count(mesh(Hull::Points { points: [[0.0; 3], [1.0; 3]].into(), missing: 0.0, vertices: 9 })), 2);
        assert_eq!(count(CollisionShape::Unread { why: "no size".into() }), 0);
    }

    #[test]
    fn points_are_placed_with_their_shape() {
        // z of the shape is −y of the link.
        let origin = Origin::new([1.0, 2.0, 3.0], [FRAC_PI_2, 0.0, 0.0]);
        let ends = spheres(CollisionShape::Capsule { radius: 0.1, length: 2.0 }, origin);
        let expected = [[1.0, 3.0, 3.0], [1.0, 1.0, 3.0]].map(|center| ContactSphere { center, radius: 0.1 });
        assert_eq!(ends, expected);
        let rims = spheres(CollisionShape::Cylinder { radius: 0.5, length: 2.0 }, origin);
        assert!(rims[..8].iter().all(|s| s.center[1] == 3.0) && rims[8..].iter().all(|s| s.center[1] == 1.0));
        let far = |s: &ContactSphere| (s.center[0] - 1.0).hypot(s.center[2] - 3.0);
        assert!(rims.iter().all(|s| s.radius == 0.0 && (far(s) - 0.5).abs() < 1e-15));
    }
}
