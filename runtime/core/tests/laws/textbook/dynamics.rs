//! Forces and their effects.

use articulated_core::Scalar;
use articulated_core::algorithm::Argument;
use articulated_core::algorithm::textbook::{aba::aba, crba::crba, rnea::rnea};
use articulated_core::description::LinkId;
use articulated_reference::Big;
use articulated_test_support::random_tree::Flavour;
use nalgebra::Vector6;
use num_traits::Zero;

use super::{
    EXACT, NEARLY, REFERENCES, REGULAR, SMALL, apply, call, dot, for_each_scene, minus, named, plus, same, times, transposed, unit,
};

#[test]
fn a_wrench_takes_jt_w_of_the_torques() {
    for_each_scene(10, SMALL, |case, scene| {
        let ([q, v, a, w], [_, nv, frames]) = (scene.motion(), scene.size);
        for reference in REFERENCES {
            let book = case.textbook::<Big>().with_wrenches_in(reference);
            let jacobian = scene.call(&named("jacobians", reference), &[q]);
            let of_wrenches = apply(&transposed(&jacobian, 6 * frames, nv), w, nv);
            let (free, rest) = (scene.call("inverse_dynamics", &[q, v, a]), vec![Big::zero(); nv]);
            same("torques", &call(&book, "inverse_dynamics_with_wrenches", &[q, v, a, w]), &minus(&free, &of_wrenches), EXACT);
            let held = minus(&scene.call("inverse_dynamics", &[q, &rest, &rest]), &of_wrenches);
            same("static torque", &call(&book, "static_torque", &[q, w]), &held, EXACT);
        }
    });
}

#[test]
fn coriolis_matrix_and_gravity_are_the_bias_and_the_rate_of_the_mass_matrix() {
    for_each_scene(12, SMALL, |_, scene| {
        let ([q, v, ..], [_, nv, _]) = (scene.motion(), scene.size);
        let c = scene.call("coriolis_matrix", &[q, v]);
        let bias = plus(&apply(&c, v, nv), &scene.call("gravity_torque", &[q]));
        same("C v + g", &scene.call("bias_forces", &[q, v]), &bias, EXACT);
        let rate = scene.slope(v, |q, _| scene.call("mass_matrix", &[q]));
        same("Ṁ", &plus(&c, &transposed(&c, nv, nv)), &rate, NEARLY);
    });
}

/// C_ij = ½ Σ_k (∂_k M_ij + ∂_j M_ik − ∂_i M_jk) v_k, where rates are derivatives of coordinates.
#[test]
fn coriolis_matrix_is_that_of_the_christoffel_symbols() {
    let flavour = Flavour { floating: false, every_kind: false, ..SMALL };
    for_each_scene(12, flavour, |case, scene| {
        let ([q, v, ..], n) = (scene.motion(), case.model.nv());
        if case.model.nq() != n {
            return;
        }
        let slopes: Vec<Vec<Big>> = (0..n).map(|k| scene.slope(&unit(n, k), |q, _| scene.call("mass_matrix", &[q]))).collect();
        let d = |k: usize, i: usize, j: usize| slopes[k][i * n + j];
        let half = Big::from_f64(0.5);
        let entry = |i: usize, j: usize| (0..n).fold(Big::zero(), |sum, k| sum + half * (d(k, i, j) + d(j, i, k) - d(i, j, k)) * v[k]);
        let expected: Vec<Big> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
        same("C", &scene.call("coriolis_matrix", &[q, v]), &expected, NEARLY);
    });
}

#[test]
fn forward_dynamics_solves_the_equations_of_motion() {
    for_each_scene(12, REGULAR, |_, scene| {
        let ([q, v, _, w], n) = (scene.motion(), scene.size[1]);
        let tau = scene.given(Argument::Tau);
        let a = scene.call("forward_dynamics", &[q, v, tau]);
        same("τ", &scene.call("inverse_dynamics", &[q, v, &a]), tau, EXACT);
        let a = scene.call("forward_dynamics_with_wrenches", &[q, v, tau, w]);
        same("τ with wrenches", &scene.call("inverse_dynamics_with_wrenches", &[q, v, &a, w]), tau, EXACT);
        let (m, inverse) = (scene.call("mass_matrix", &[q]), scene.call("mass_matrix_inverse", &[q]));
        same("M⁻¹ τ", &scene.call("solve_mass_matrix", &[q, tau]), &apply(&inverse, tau, n), EXACT);
        for k in 0..n {
            let column = apply(&inverse, &unit(n, k), n);
            same("M M⁻¹", &apply(&m, &column, n), &unit(n, k), EXACT);
        }
    });
}

/// Of any tree, with joints that follow others: two bodies then share a rate.
#[test]
fn composite_bodies_give_the_mass_matrix_of_n_recursions() {
    for_each_scene(20, SMALL, |_, scene| {
        let ([q, v, ..], n) = (scene.motion(), scene.size[1]);
        let m = crba(&scene.book.at(q, v));
        let found: Vec<Big> = (0..n * n).map(|k| m[(k / n, k % n)]).collect();
        same("M", &found, &scene.call("mass_matrix", &[q]), EXACT);
    });
}

#[test]
fn articulated_bodies_give_the_acceleration_that_inverse_dynamics_undoes() {
    for_each_scene(20, REGULAR, |case, scene| {
        let ([q, v, ..], tau) = (scene.motion(), scene.given(Argument::Tau));
        let tree = scene.book.at(q, v);
        // Any wrench on each body
        let wrench = |i: usize| Vector6::from_fn(|k, _| Big::from_f64((1 + i * 6 + k) as f64).sin_cos().0);
        let wrenches: Vec<Vector6<Big>> = (0..tree.bodies.len()).map(wrench).collect();
        let followers = case.description.joints.iter().any(|j| j.mimic.is_some() && j.locked.is_none());
        let Some(a) = aba(&tree, v, tau, &wrenches) else { return assert!(followers, "no joint follows another") };
        assert_eq!(a.len(), scene.size[1]);
        same("τ", &rnea(&tree, v, &a, &wrenches), tau, EXACT);
        same("q̈", &aba(&tree, v, tau, &[]).expect("as before"), &scene.call("forward_dynamics", &[q, v, tau]), EXACT);
    });
}

#[test]
fn derivatives_are_those_of_differences() {
    for_each_scene(8, REGULAR, |_, scene| {
        let ([q, v, a, w], n) = (scene.motion(), scene.size[1]);
        // Along one direction at random: a wrong entry shows.
        let (tau, e) = (scene.given(Argument::Tau), scene.given(Argument::Step));
        let torque = |q: &[Big], v: &[Big], a: &[Big]| scene.call("inverse_dynamics_with_wrenches", &[q, v, a, w]);
        let inverse = scene.call("inverse_dynamics_derivatives_with_wrenches", &[q, v, a, w]);
        let motion = |q: &[Big], v: &[Big], tau: &[Big]| scene.call("forward_dynamics_with_wrenches", &[q, v, tau, w]);
        let forward = scene.call("forward_dynamics_derivatives_with_wrenches", &[q, v, tau, w]);
        let statics = scene.call("static_torque_derivative", &[q, w]);
        let rest = vec![Big::zero(); n];
        let along = |all: &[Big], part: usize| apply(&all[part * n * n..][..n * n], e, n);
        let moved = |x: &[Big], h: f64| plus(x, &times(h, e));
        same("∂τ/∂q", &along(&inverse, 0), &scene.slope(e, |q, _| torque(q, v, a)), NEARLY);
        same("∂τ/∂v", &along(&inverse, 1), &scene.slope(&rest, |_, h| torque(q, &moved(v, h), a)), NEARLY);
        same("∂τ/∂a", &along(&inverse, 2), &scene.slope(&rest, |_, h| torque(q, v, &moved(a, h))), NEARLY);
        same("∂a/∂q", &along(&forward, 0), &scene.slope(e, |q, _| motion(q, v, tau)), NEARLY);
        same("∂a/∂v", &along(&forward, 1), &scene.slope(&rest, |_, h| motion(q, &moved(v, h), tau)), NEARLY);
        same("∂a/∂τ", &along(&forward, 2), &scene.slope(&rest, |_, h| motion(q, v, &moved(tau, h))), NEARLY);
        same("∂g/∂q", &along(&statics, 0), &scene.slope(e, |q, _| torque(q, &rest, &rest)), NEARLY);
        let free = vec![Big::zero(); w.len()];
        for (name, last) in [("inverse_dynamics", a), ("forward_dynamics", tau)] {
            let plain = scene.call(&format!("{name}_derivatives"), &[q, v, last]);
            same(name, &plain, &scene.call(&format!("{name}_derivatives_with_wrenches"), &[q, v, last, &free]), 0.0);
        }
    });
}

/// Joints pass what links need: a link's wrench is the sum of its momentum's rate and of the wrench
/// that it passes on.
#[test]
fn power_through_the_joints_is_that_of_the_torques() {
    for_each_scene(15, SMALL, |case, scene| {
        let [q, v, a, _] = scene.motion();
        let wrenches = scene.call("joint_wrenches", &[q, v, a]);
        let (twists, placed) = (scene.call("twists_world", &[q, v]), scene.call("placements", &[q]));
        let mut power = Big::zero();
        for (k, body) in case.model.links().enumerate() {
            // The twist of the child against the parent, taken in world axes about the world's
            // origin, with the wrench brought there.
            let joint = case.description.joint(&case.model.bodies()[body].name).map(|j| &case.description.joints[j]);
            let (parent, child) = joint.map_or((None, case.description.root().unwrap_or(LinkId(0))), |j| (Some(j.parent), j.child));
            let of = |link: Option<usize>, i: usize| link.map_or(Big::zero(), |l| twists[6 * l + i]);
            let relative: Vec<Big> = (0..6).map(|i| of(Some(child.0), i) - of(parent.map(|parent| parent.0), i)).collect();
            let [x, w] = [&placed[12 * child.0..][..12], &wrenches[6 * k..][..6]];
            let (moment, force) = (apply(&x[..9], &w[..3], 3), apply(&x[..9], &w[3..], 3));
            let p = &x[9..];
            let arm: Vec<Big> = (0..3).map(|i| p[(i + 1) % 3] * force[(i + 2) % 3] - p[(i + 2) % 3] * force[(i + 1) % 3]).collect();
            power += dot(&plus(&moment, &arm), &relative[..3]) + dot(&force, &relative[3..]);
        }
        let expected = dot(&scene.call("inverse_dynamics", &[q, v, a]), v);
        same("power", &[power], &[expected], EXACT);
    });
}

#[test]
fn operational_space_inertia_is_j_m_inverse_jt_inverted() {
    for_each_scene(6, REGULAR, |case, scene| {
        let ([q, ..], [_, n, frames]) = (scene.motion(), scene.size);
        let (jacobian, inverse) = (scene.call("jacobians_world_aligned", &[q]), scene.call("mass_matrix_inverse", &[q]));
        let mobility = scene.call("operational_space_inertia_inverse", &[q]);
        for frame in 0..frames {
            let j = &jacobian[6 * n * frame..][..6 * n];
            let own = &mobility[36 * frame..][..36];
            for k in 0..6 {
                let column = apply(&inverse, &apply(&transposed(j, 6, n), &unit(6, k), n), n);
                same("J M⁻¹ Jᵀ", &apply(own, &unit(6, k), 6), &apply(j, &column, 6), EXACT);
            }
        }
        if case.base == articulated_core::description::Base::Floating {
            let inertia = scene.call("operational_space_inertia", &[q]);
            for (k, frame) in (0..6 * frames).map(|i| (i % 6, i / 6)) {
                let [own, back] = [&inertia, &mobility].map(|m| &m[36 * frame..][..36]);
                same("Λ Λ⁻¹", &apply(own, &apply(back, &unit(6, k), 6), 6), &unit(6, k), EXACT);
            }
        }
    });
}
