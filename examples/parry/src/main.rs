//! Two gems fall on a floor: parry3d finds their contacts, and generated code steps by MuJoCo's law.
//!
//! ```text
//! cd examples/parry && cargo run --release
//! ```

use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d_f64::shape::{ConvexPolyhedron, HalfSpace, Shape};

#[allow(dead_code)]
mod gems {
    include!(concat!(env!("OUT_DIR"), "/gems.rs"));
}

use gems::{GIVEN, GIVEN_SHAPES, NEUTRAL, NV};

/// The vertices of the mesh in gems.xml, m.
const VERTICES: [[f64; 3]; 5] = [[0.0, 0.0, 0.1], [0.1, 0.0, 0.0], [-0.05, 0.09, 0.0], [-0.05, -0.09, 0.0], [0.0, 0.0, -0.1]];
const H: f64 = 0.002;
const STEPS: usize = 1500;

/// The pose of a geom in the world.
fn pose(name: &str, q: &[f64; gems::NQ]) -> Pose {
    let first = match name {
        "floor" => return Pose::IDENTITY,
        "lower" => 0,
        _ => 7,
    };
    let [x, y, z, i, j, k, w] = std::array::from_fn(|n| q[first + n]);
    Pose { rotation: Rotation::from_xyzw(i, j, k, w), translation: Vector::new(x, y, z) }
}

/// The contacts as the step takes them: 1 or 0, the distance, the point, and the normal from the
/// first shape to the second.
fn contacts(shapes: &dyn Fn(&str) -> Box<dyn Shape>, q: &[f64; gems::NQ]) -> ([[f64; 8]; GIVEN], usize) {
    let (mut out, mut touching, mut at) = ([[0.0; 8]; GIVEN], 0, 0);
    while at < GIVEN {
        let [first, second] = GIVEN_SHAPES[at];
        let places = GIVEN_SHAPES[at..].iter().take_while(|names| **names == [first, second]).count();
        let (one, other) = (pose(first, q), pose(second, q));
        let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
        let relative = one.inverse() * other;
        DefaultQueryDispatcher
            .contact_manifolds(&relative, &*shapes(first), &*shapes(second), 1e-3, &mut manifolds, &mut None)
            .expect("parry3d knows these shapes");
        let points = manifolds.iter().flat_map(|manifold| manifold.points.iter().map(|point| (point, manifold.local_n1)));
        // The deepest first
        let mut points: Vec<_> = points.collect();
        points.sort_by(|(a, _), (b, _)| a.dist.total_cmp(&b.dist));
        for (place, (point, normal)) in out[at..at + places].iter_mut().zip(points) {
            let middle = 0.5 * (one * point.local_p1 + other * point.local_p2);
            let normal = one.rotation * normal;
            *place = [1.0, point.dist, middle.x, middle.y, middle.z, normal.x, normal.y, normal.z];
            touching += usize::from(point.dist < 0.0);
        }
        at += places;
    }
    (out, touching)
}

fn main() {
    let vertices: Vec<Vector> = VERTICES.iter().map(|[x, y, z]| Vector::new(*x, *y, *z)).collect();
    let gem = ConvexPolyhedron::from_convex_hull(&vertices).expect("a convex mesh");
    let shapes = |name: &str| -> Box<dyn Shape> {
        match name {
            "floor" => Box::new(HalfSpace::new(Vector::Z)),
            _ => Box::new(gem.clone()),
        }
    };
    let (mut q, mut v, mut warm) = (NEUTRAL, [0.0; NV], [0.0; NV]);
    q[2] = 0.15;
    q[7..10].copy_from_slice(&[0.03, 0.01, 0.4]);
    println!("{:>6} {:>9} {:>12} {:>12} {:>14}", "t, s", "contacts", "lower z, m", "upper z, m", "kinetic, J");
    for k in 0..=STEPS {
        let (given, touching) = contacts(&shapes, &q);
        if k % 150 == 0 {
            println!("{:6.1} {touching:9} {:12.4} {:12.4} {:14.6}", k as f64 * H, q[2], q[9], gems::kinetic_energy(&q, &v));
        }
        let next = gems::constrained_step_implicit_damping_with_contacts(&q, &v, &[], &[], &given, &warm, &H);
        (q, v, warm) = (next.q_next, next.v_next, next.warm_next);
    }
    let energy = gems::kinetic_energy(&q, &v);
    assert!(q[2] > 0.02 && q[9] > 0.02 && energy < 1e-3, "both lie on the floor at rest: {energy} J");
}
