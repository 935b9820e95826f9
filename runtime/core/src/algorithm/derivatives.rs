//! First derivatives of inverse and forward dynamics.
//!
//! Singh, Russell & Wensing, *IEEE Robot. Autom. Lett.* 7, 2022 (joints with several
//! degrees of freedom included), with 2B of their Coriolis operator as
//! [`crate::spatial::CoriolisInertia`] and everything in common axes about each body's own origin
//! ([`super::common`]):
//!
//! ```text
//! ψ̇ = V_λ × S     ψ̈ = V̇_λ × S + V_λ × ψ̇     Ṡ = V_i × S          (l on the way from k to the base)
//! ∂τ_k/∂q_l = S_kᵀ [2B^C ψ̇_l + I^C ψ̈_l]        ∂τ_l/∂q_k = S_lᵀ [2B^C ψ̇_k + I^C ψ̈_k + S_k ×* F^C]
//! ∂τ_k/∂v_l = S_kᵀ [2B^C S_l + I^C (ψ̇_l + Ṡ_l)]  ∂τ_l/∂v_k = S_lᵀ [2B^C S_k + I^C (ψ̇_k + Ṡ_k)]
//! ```
//!
//! with the composites of k's body. A follower of the coordinate q by f(q) has S = f′ A with an
//! axis A that moves as others do. Where f is not linear, S′ = f″ A and S″ = f‴ A are not zero, and
//! the chain rule adds
//!
//! ```text
//! S′ q̇ to ψ̇ and Ṡ
//! V_λ × S′ q̇ + S′ q̈ + S″ q̇² to ψ̈
//! S′ᵀ F^C to ∂τ/∂q of the leader by itself
//! ```
//!
//! Forward dynamics: Carpentier & Mansard, *RSS* 2018: ∂a = −M⁻¹
//! ∂(inverse dynamics at a).

use super::Workspace;
use super::common::{Axes, accelerations, carry, coriolis, forces, inertias, on_the_way, positions, twists};
use super::crba::mass_matrix_in_common_axes;
use super::effects;
use super::ltdl::{factor, inverse, path_to_root, solve, solve_rows};
use super::rnea::inverse_dynamics_with_wrenches;
use super::wrenches;
use crate::Scalar;
use crate::index::BodyId;
use crate::model::Model;
use crate::spatial::{Reference, Twist, Vector3, Wrench, rotate};

/// ∂τ/∂q, ∂τ/∂v and ∂τ/∂a = M of τ = inverse dynamics, with external wrenches that are constant in
/// their reference.
///
/// q: `[nq]`; v, a: `[nv]`; wrenches: `[frames][6]`, as [`Model::wrench_reference`] says, or empty;
/// out: `[3][nv][nv]`, entry (i, j) of each is ∂τ_i/∂x_j. q in the tangent space: a quaternion
/// joint's child moves by a small motion in its own axes.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn inverse_dynamics_derivatives_with_wrenches<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    a: &[S],
    wrenches: &[S],
    out: &mut [S],
) {
    let axes = axes(model);
    positions(model, ws, axes, q);
    twists(model, ws, axes, v);
    accelerations(model, ws, v, a, -model.gravity);
    inertias(model, ws);
    coriolis(model, ws);
    forces(model, ws);
    curls(model, ws, v, a);
    let n = model.nv * model.nv;
    let (by_q, rest) = out.split_at_mut(n);
    let (by_v, by_a) = rest.split_at_mut(n);
    let mut matrices = Matrices { by_q, by_v, by_a };
    matrices.clear();
    external(model, ws, q, wrenches, matrices.by_q);
    effects::body_slopes(model, ws, matrices.by_q, Some((&mut *matrices.by_v, &mut *matrices.by_a)));
    effects::joint_slopes(model, [q, v, a], matrices.by_q, Some((&mut *matrices.by_v, &mut *matrices.by_a)));
    for i in model.inward() {
        for k in ws.columns_of(i) {
            matrices.row_and_column(model, ws, i, k);
        }
        collect(model, ws, i);
    }
}

/// ∂(static_torque)/∂q.
///
/// q: `[nq]`; wrenches: `[frames][6]`; out: `[nv · nv]`, row by row.
///
/// # Panics
/// As [`inverse_dynamics_derivatives_with_wrenches`].
pub fn static_torque_derivative<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], wrenches: &[S], out: &mut [S]) {
    out.fill(S::zero());
    positions(model, ws, axes(model), q);
    inertias(model, ws);
    let zeros = core::mem::take(&mut ws.zeros);
    still(model, ws);
    accelerations(model, ws, &zeros, &zeros, -model.gravity);
    effects::joint_slopes(model, [q, &zeros, &zeros], out, None);
    ws.zeros = zeros;
    for i in model.outward() {
        let state = &mut ws.common[i];
        state.force = state.inertia.apply(&state.acceleration);
        for k in ws.columns_of(i) {
            ws.columns[k].psi_ddot = falling(model, ws, i, k, &ws.common[i].carried_acceleration);
        }
    }
    external(model, ws, q, wrenches, out);
    effects::body_slopes(model, ws, out, None);
    for i in model.inward() {
        for k in ws.columns_of(i) {
            let (state, column) = (&ws.common[i], &ws.columns[k]);
            let held = state.inertia.apply(&column.axis);
            let drive = state.inertia.apply(&column.psi_ddot) + column.axis.cross_wrench(&state.force);
            column.bend.iter().for_each(|bend| out[column.at * (model.nv + 1)] += state.force.power(bend));
            carry(model, ws, i, [held, drive], |own, [held, drive], other| {
                out[column.at * model.nv + other.at] += held.power(&other.psi_ddot);
                if !own {
                    out[other.at * model.nv + column.at] += drive.power(&other.axis);
                }
            });
        }
        collect(model, ws, i);
    }
}

/// ∂a/∂q, ∂a/∂v and ∂a/∂τ = M⁻¹ of a = forward dynamics, with external wrenches that are constant
/// in their reference.
///
/// q: `[nq]`; v, tau: `[nv]`; wrenches: `[frames][6]`, as [`Model::wrench_reference`] says, or
/// empty; out: `[3][nv][nv]`, entry (i, j) of each is ∂a_i/∂x_j. q in the tangent space.
///
/// # Panics
/// As [`inverse_dynamics_derivatives_with_wrenches`].
pub fn forward_dynamics_derivatives_with_wrenches<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    out: &mut [S],
) {
    let n = model.nv * model.nv;
    let matrix = unsolved(model, ws, q, v, tau, wrenches, out);
    // ∂a = −M⁻¹ ∂τ;  ∂a/∂τ = M⁻¹
    out[..2 * n].iter_mut().for_each(|x| *x = -*x);
    for out in out.chunks_exact_mut(n.max(1)).take(2) {
        solve_rows(&matrix, &ws.parent_dof, out);
    }
    let by_tau = &mut out[2 * n..];
    inverse(&matrix, &ws.parent_dof, by_tau);
    effects::driven_slopes(model, v, tau, |i, _, slope| by_tau.iter_mut().skip(i).step_by(model.nv).for_each(|x| *x *= slope));
    ws.matrix = matrix;
}

/// All of [`forward_dynamics_derivatives_with_wrenches`] but the solution of M X = −B column by
/// column, which is the same for each, so that generated code may leave it a loop: B = ∂τ/∂q and B
/// = ∂τ/∂v, and in the third matrix M = Lᵀ D L: L below the diagonal, D⁻¹ on it, zeros above.
/// Without motors.
///
/// # Panics
/// As [`inverse_dynamics_derivatives_with_wrenches`].
pub(super) fn unsolved_derivatives<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    out: &mut [S],
) {
    let matrix = unsolved(model, ws, q, v, tau, wrenches, out);
    let factors = &mut out[2 * model.nv * model.nv..];
    factors.fill(S::zero());
    for k in 0..model.nv {
        for i in core::iter::once(k).chain(path_to_root(&ws.parent_dof, k)) {
            factors[k * model.nv + i] = matrix[k * model.nv + i];
        }
    }
    ws.matrix = matrix;
}

/// ∂τ/∂q and ∂τ/∂v at the acceleration due to τ, including the slopes of motors, in `out`; returns
/// the factors of M, in the workspace's matrix.
fn unsolved<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    out: &mut [S],
) -> alloc::vec::Vec<S> {
    let n = model.nv * model.nv;
    let (mut matrix, mut a) = (core::mem::take(&mut ws.matrix), core::mem::take(&mut ws.solution));
    inverse_dynamics_with_wrenches(model, ws, q, v, &[], wrenches, &mut a);
    let mut driven = core::mem::take(&mut ws.driven);
    effects::motor_torque(model, v, tau, &mut driven);
    a.iter_mut().zip(&driven).for_each(|(b, tau)| *b = *tau - *b);
    ws.driven = driven;
    mass_matrix_in_common_axes(model, ws, q, &mut matrix);
    factor(&mut matrix, &ws.parent_dof);
    solve(&matrix, &ws.parent_dof, &mut a);
    inverse_dynamics_derivatives_with_wrenches(model, ws, q, v, &a, wrenches, out);
    ws.solution = a;
    effects::driven_slopes(model, v, tau, |i, by_v, _| out[n + i * model.nv + i] -= by_v);
    matrix
}

/// Whether there are no motors between τ and the joints.
pub(super) fn without_motors<S: Scalar>(model: &Model<S>) -> bool {
    !model.has_motors()
}

/// Common axes: those in the middle of each tree, unless poses of bodies in the base are needed.
fn axes<S: Scalar>(model: &Model<S>) -> Axes {
    if effects::any_on_bodies(model) { Axes::Base } else { Axes::Tree }
}

/// At rest.
fn still<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>) {
    for i in model.outward() {
        ws.common[i].twist = Twist::zero();
        for k in ws.columns_of(i) {
            (ws.columns[k].s_dot, ws.columns[k].psi_dot) = (Twist::zero(), Twist::zero());
        }
    }
}

/// ψ̈ of every column.
fn curls<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, v: &[S], a: &[S]) {
    for i in model.outward() {
        let (twist, acceleration) = (ws.common[i].carried_twist, ws.common[i].carried_acceleration);
        for k in ws.columns_of(i) {
            let falling = falling(model, ws, i, k, &acceleration);
            let column = &mut ws.columns[k];
            column.psi_ddot = falling + twist.cross(&column.psi_dot);
            if let (Some(bend), Some(rate)) = (column.bend, column.rate_of_bend) {
                let (v, a) = (v[column.at], a[column.at]);
                column.psi_ddot = column.psi_ddot + twist.cross(&bend).times(v) + bend.times(a) + rate.times(v * v);
            }
        }
    }
}

/// V̇_λ × S. A body on the base by a revolute joint falls as the base does: then the product is
/// taken before its factors are turned, and is zero for an upright joint.
fn falling<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId, k: usize, carried: &Twist<S>) -> Twist<S> {
    let body = &model.bodies[i];
    if body.parent != BodyId::BASE || !body.joint.is_rotation_about_axis() || body.coordinates.is_bent() {
        return carried.cross(&ws.columns[k].axis);
    }
    let product = body.placement.rotation.column(2).cross(&model.gravity);
    let product = Twist { angular: Vector3::zeros(), linear: rotate(&ws.common[i].base, product) };
    body.coordinates.mimic.map_or(product, |f| product.times(f.multiplier))
}

/// Adds the sums of a body and all beyond it to its parent.
fn collect<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: BodyId) {
    let (parent, state) = (model.bodies[i].parent, ws.common[i]);
    if parent != BodyId::BASE {
        let to = &mut ws.common[parent];
        to.inertia += state.inertia.shifted(state.shift);
        to.coriolis += state.coriolis.shifted(state.shift);
        to.force += state.shift_to_parent(&state.force);
    }
}

struct Matrices<'a, S> {
    by_q: &'a mut [S],
    by_v: &'a mut [S],
    by_a: &'a mut [S],
}

impl<S: Scalar> Matrices<'_, S> {
    fn clear(&mut self) {
        for m in [&mut *self.by_q, &mut *self.by_v, &mut *self.by_a] {
            m.fill(S::zero());
        }
    }

    /// Entries of column `k` of body `i` with itself and with the columns on the path to the root.
    fn row_and_column(&mut self, model: &Model<S>, ws: &Workspace<S>, i: BodyId, k: usize) {
        let (n, state, column) = (model.nv, &ws.common[i], &ws.columns[k]);
        let two = S::from_f64(2.0);
        let twice_b = |omega: Vector3<S>| state.coriolis.wrench(omega * two);
        let held = state.inertia.apply(&column.axis);
        let turning = state.coriolis.transposed(&column.axis.times(two));
        let round = ws.is_independent_of_angle(model, i);
        let by_q = match round {
            true => Wrench::zero(),
            false => twice_b(column.psi_dot.angular) + state.inertia.apply(&column.psi_ddot) + column.axis.cross_wrench(&state.force),
        };
        column.bend.iter().for_each(|bend| self.by_q[column.at * (n + 1)] += state.force.power(bend));
        let by_v = twice_b(column.axis.angular) + state.inertia.apply(&(column.psi_dot + column.s_dot));
        carry(model, ws, i, [held, by_q, by_v], |own, [held, by_q, by_v], other| {
            let (row, transposed) = (column.at * n + other.at, other.at * n + column.at);
            let inertia = held.power(&other.axis);
            self.by_a[row] += inertia;
            if !(own && round) {
                self.by_q[row] += turning.dot(&other.psi_dot.angular) + held.power(&other.psi_ddot);
            }
            self.by_v[row] += turning.dot(&other.axis.angular) + held.power(&(other.psi_dot + other.s_dot));
            if !own {
                self.by_a[transposed] += inertia;
                self.by_q[transposed] += by_q.power(&other.axis);
                self.by_v[transposed] += by_v.power(&other.axis);
            }
        });
    }
}

/// Subtracts external wrenches from the forces of bodies. The sweep assumes that all forces turn
/// with their body; ∂τ/∂q is corrected for those that do not.
fn external<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], wrenches: &[S], by_q: &mut [S]) {
    let reference = model.wrench_reference;
    let mut frame = model.frames.iter().filter(|f| f.body != BodyId::BASE);
    wrenches::each(model, ws, q, wrenches, |ws, body, w| {
        let turn = ws.common[body].rotation;
        let w = w.turned(&turn);
        ws.common[body].force = ws.common[body].force - w;
        let offset = frame.next().map_or_else(Vector3::zeros, |f| rotate(&turn, f.placement.position));
        if reference != Reference::Body {
            put_right(model, ws, body, &w, (reference == Reference::WorldAligned).then_some(offset), by_q);
        }
    });
}

/// For each pair (l, k) of columns on the path from `body` to the root, ∂τ_l/∂q_k −= S_lᵀ δ_k. δ_k
/// is the change of the wrench for a unit step of k, less its change if the wrench turned with the
/// body, S_k ×* w. In space the wrench is constant, except for its moment if it moves with the
/// point at `offset`.
fn put_right<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, body: BodyId, w: &Wrench<S>, offset: Option<Vector3<S>>, by_q: &mut [S]) {
    on_the_way(model, ws, body, Vector3::zeros(), |column, d| {
        let (k, axis) = (column.at, column.axis.at(d));
        let mut change = Wrench::zero() - axis.cross_wrench(w);
        if let Some(offset) = offset {
            change.moment += axis.at(offset).linear.cross(&w.force);
        }
        on_the_way(model, ws, body, Vector3::zeros(), |l, d| by_q[l.at * model.nv + k] -= change.power(&l.axis.at(d)));
    });
}
