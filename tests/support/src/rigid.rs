//! Rigid placements and bodies of a description, composed as by fixed joints.

use articulated_core::description::{Inertial, Origin};
use nalgebra::{Matrix3, Vector3};

/// R = Rz(yaw) Ry(pitch) Rx(roll).
pub fn rotation(rpy: [f64; 3]) -> Matrix3<f64> {
    let axis = [nalgebra::Vector3::x_axis(), nalgebra::Vector3::y_axis(), nalgebra::Vector3::z_axis()];
    let about = |k: usize| *nalgebra::Rotation3::from_axis_angle(&axis[k], rpy[k]).matrix();
    about(2) * about(1) * about(0)
}

/// Roll, pitch and yaw of a rotation; accurate at the poles too, as roll is computed after removing
/// yaw.
pub fn rpy(r: &Matrix3<f64>) -> [f64; 3] {
    let yaw = r.m21.atan2(r.m11);
    let (s, c) = yaw.sin_cos();
    let roll = (s * r.m13 - c * r.m23).atan2(c * r.m22 - s * r.m12);
    [roll, (-r.m31).atan2(r.m11.hypot(r.m21)), yaw]
}

/// The frame `b`, given in `a`, in the frame that `a` is given in.
pub fn compose(a: &Origin, b: &Origin) -> Origin {
    let r = rotation(a.rotation.rpy());
    let p = r * Vector3::from(b.xyz) + Vector3::from(a.xyz);
    Origin::new(p.into(), rpy(&(r * rotation(b.rotation.rpy()))))
}

/// A body given in a frame with the placement `at`.
pub fn carried(at: &Origin, body: &Inertial) -> Inertial {
    Inertial { origin: compose(at, &body.origin), ..*body }
}

/// Two bodies as one (parallel axis theorem).
pub fn together(a: &Inertial, b: &Inertial) -> Inertial {
    let mass = a.mass + b.mass;
    let centre = (Vector3::from(a.origin.xyz) * a.mass + Vector3::from(b.origin.xyz) * b.mass) / mass;
    let about = |body: &Inertial| {
        let [xx, xy, xz, yy, yz, zz] = body.inertia;
        let (r, d) = (rotation(body.origin.rotation.rpy()), Vector3::from(body.origin.xyz) - centre);
        let shift = Matrix3::from_diagonal_element(d.dot(&d)) - d * d.transpose();
        r * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * r.transpose() + shift * body.mass
    };
    let i = about(a) + about(b);
    Inertial { mass, origin: Origin::at(centre.into()), inertia: [i.m11, i.m12, i.m13, i.m22, i.m23, i.m33] }
}
