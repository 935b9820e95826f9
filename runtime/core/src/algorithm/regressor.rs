//! Regressors: dynamics are linear in the ten inertial parameters of each link.
//!
//! The parameters are π = (m, h_x, h_y, h_z, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz) with h = m c and I
//! about the origin of the link's frame, in its axes; a link is a moving link with everything that
//! is fixed to it ([`crate::model::Body::link`]), whether or not its joint is at its origin.
//! Atkeson, An & Hollerbach, *Int. J. Robot. Res.* 5, 1986, 101–119; energies: Gautier & Khalil,
//! *IEEE ICRA* 1988, 1026–1031.

use super::Workspace;
use super::common::{Axes, accelerations, on_the_way, positions, twists};
use crate::Scalar;
use crate::effect::{JOINT_PARAMETERS, joint_columns};
use crate::index::BodyId;
use crate::model::{BodyLink, Model};
use crate::spatial::{Matrix3, Placement, Twist, Vector3, rate_matrix, rotate, rotate_back};

/// Inertial parameters of a link.
pub const PARAMETERS: usize = 10;

/// Y with τ = Y π, π as [`Model::inertial_parameters`] has it: of each link m, m c and I_xx, I_xy,
/// I_xz, I_yy, I_yz, I_zz about its origin, in its axes.
///
/// q: `[nq]`; v, a: `[nv]`; out: `[nv][links][10]`, N·m|N per kg, kg·m and kg·m². By virtual power:
/// τ_l = Σ ∫ (s_l(r))·(r̈ − g) dm, with s_l(r) the velocity of the point at unit rate l.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn torque_regressor<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Tree, q);
    twists(model, ws, Axes::Tree, v);
    accelerations(model, ws, v, a, -model.gravity);
    out.fill(S::zero());
    let width = PARAMETERS * ws.shape.links;
    for (link, i) in model.links().enumerate() {
        let (Placement { rotation: turn, position: from }, state) = (link_frame(model, ws, i), &ws.common[i]);
        let back = |x: Vector3<S>| rotate_back(&turn, x);
        let u = rate_matrix(back(state.twist.angular), back(state.acceleration.angular));
        // The true acceleration of the body's origin: spatial acceleration + ω × v. That of the
        // link's: U r more.
        let acceleration = back(state.acceleration.linear + state.twist.angular.cross(&state.twist.linear)) + u * back(from);
        on_the_way(model, ws, i, from, |column, d| {
            let entries = entries(&column.axis.at(d).turned_back(&turn), &acceleration, &u);
            let at = column.at * width + link * PARAMETERS;
            out[at..at + PARAMETERS].iter_mut().zip(entries).for_each(|(out, x)| *out += x);
        });
    }
}

/// Generalised force along a motion (s; t) of a body whose points at r accelerate by a + U r, per
/// unit of each parameter.
fn entries<S: Scalar>(axis: &Twist<S>, a: &Vector3<S>, u: &Matrix3<S>) -> [S; PARAMETERS] {
    let (s, t) = (axis.angular, axis.linear);
    // m: t·a;  h: t·(U h) + s·(h × a) = h·(Uᵀt + a × s)
    let first = rotate_back(u, t) + a.cross(&s);
    // Σ: ∫ (s × r)·(U r) = Σ_ab G_ab Σ_ab with G_b = U_b × s
    let column = |k: usize| u.column(k).into_owned().cross(&s);
    let g = Matrix3::from_columns(&[column(0), column(1), column(2)]);
    // Σ = ½ tr(I)·1 − I
    let half = g.trace() * S::from_f64(0.5);
    let off = |i: usize, j: usize| -(g[(i, j)] + g[(j, i)]);
    let on = |i: usize| half - g[(i, i)];
    [t.dot(a), first.x, first.y, first.z, on(0), off(0, 1), off(0, 2), on(1), off(1, 2), on(2)]
}

/// Y with τ_l = Y_l (d_l, μ_l, I_l) of effects on joints: viscous damping d, dry friction μ and
/// armature I = I_rotor n² of the joint of each degree of freedom. A row depends on the numbers of
/// its own degree of freedom alone, so the matrix is stored without its zeros.
///
/// v, a: `[nv]`; out: `[nv][3]`, N·m|N per N·m·s/rad|N·s/m, N·m|N and kg·m²|kg: v, v/√(v² + s²) and
/// a. s is the rate below which the model's friction is smooth, 1e-5 rad/s|m/s if it has none.
/// Joints that follow a coordinate act on the same columns: Σ d c², Σ |μ c| for rates far above s,
/// and Σ I c², with their multipliers c, add to the numbers of the leader. Those of a follower by a
/// polynomial, whose c depends on q, are in no column.
///
/// # Panics
/// As [`torque_regressor`].
pub fn joint_regressor<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, v: &[S], a: &[S], out: &mut [S]) {
    for body in model.outward().map(|i| &model.bodies[i]).filter(|body| body.coordinates.mimic.is_none()) {
        for freedom in 0..body.joint.nv() {
            let at = body.coordinates.v + freedom;
            out[at * JOINT_PARAMETERS..][..JOINT_PARAMETERS].copy_from_slice(&joint_columns(&body.effects.joint, freedom, v[at], a[at]));
        }
    }
}

/// y with kinetic energy T = yᵀπ.
///
/// q: `[nq]`; v: `[nv]`; out: `[links][10]`.
///
/// # Panics
/// As [`torque_regressor`].
pub fn kinetic_energy_regressor<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Base, q);
    twists(model, ws, Axes::Base, v);
    let half = S::from_f64(0.5);
    for (i, out) in model.links().zip(out.chunks_exact_mut(PARAMETERS)) {
        let Placement { rotation: turn, position: from } = link_frame(model, ws, i);
        let Twist { angular: w, linear: v } = ws.common[i].twist.at(from).turned_back(&turn);
        // T = ½ m v² + v·(ω × h) + ½ ωᵀ I ω
        let first = v.cross(&w);
        out.copy_from_slice(&[
            half * v.dot(&v),
            first.x,
            first.y,
            first.z,
            half * w.x * w.x,
            w.x * w.y,
            w.x * w.z,
            half * w.y * w.y,
            w.y * w.z,
            half * w.z * w.z,
        ]);
    }
}

/// y with potential energy U = yᵀπ.
///
/// q: `[nq]`; out: `[links][10]`.
///
/// # Panics
/// As [`torque_regressor`].
pub fn potential_energy_regressor<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Base, q);
    out.fill(S::zero());
    for (i, out) in model.links().zip(out.chunks_exact_mut(PARAMETERS)) {
        let Placement { rotation: turn, position: from } = link_frame(model, ws, i);
        // U = −gᵀ (m p + R h)
        out[0] = -model.gravity.dot(&(ws.common[i].position + from));
        let first = -rotate_back(&turn, model.gravity);
        out[1..4].copy_from_slice(first.as_slice());
    }
}

/// Axes of the link of body `i` in common axes, and its origin from the body's.
fn link_frame<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId) -> Placement<S> {
    let rotation = ws.common[i].rotation;
    let body = Placement { rotation, position: Vector3::zeros() };
    model.bodies[i].link.as_ref().map_or(body, |link| Placement {
        rotation: rotation * link.placement.rotation,
        position: rotate(&rotation, link.placement.position),
    })
}

impl<S: Scalar> Model<S> {
    /// π of every moving link, `[links][10]`: m, h = m c, and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz
    /// about the origin of the link's frame, in its axes; kg, kg·m, kg·m².
    pub fn inertial_parameters(&self) -> alloc::vec::Vec<[S; PARAMETERS]> {
        let one = |i: BodyId| {
            let (inertia, link) = (&self.bodies[i].inertia, &self.bodies[i].link);
            let of_link = |link: &BodyLink<S>| inertia.shifted(-link.placement.position).turned(&link.placement.rotation.transpose());
            link.as_ref().map_or(*inertia, of_link).parameters()
        };
        self.links().map(one).collect()
    }
}
