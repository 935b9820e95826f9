//! The reference itself: what its functions must be to each other, in many digits. Each is computed by its definition alone.

use articulated_cli::precise::Big;
use articulated_core::Scalar;
use articulated_core::algorithm::textbook::Textbook;
use articulated_core::algorithm::{Argument, Needs, functions};
use articulated_core::spatial::Reference;
use articulated_tests::case::{Case, State, cast, for_each_tree};
use articulated_tests::random_tree::Flavour;
use num_traits::{One, Zero};

/// Digits that rounding leaves: of 96, less what is lost where matrices are nearly singular.
const EXACT: f64 = 1e-60;

/// A step for central differences, a power of two: their error is its square.
const STEP: f64 = 1.0 / (1_u128 << 66) as f64;

/// What differences leave.
const NEARLY: f64 = 1e-36;

const REFERENCES: [Reference; 3] = [Reference::Body, Reference::World, Reference::WorldAligned];

/// A robot in a state, in many digits; quaternions of a norm of one.
struct Scene {
    book: Textbook<Big>,
    arguments: Vec<(Argument, Vec<Big>)>,
    /// Lengths of q and v, number of frames.
    size: [usize; 3],
}

impl Scene {
    fn new(case: &Case, state: &State) -> Self {
        let mut arguments: Vec<(Argument, Vec<Big>)> = Argument::ALL.iter().map(|&a| (a, cast(state.argument(a)))).collect();
        for (name, x) in &mut arguments {
            if matches!(name, Argument::Q | Argument::Target) {
                normalise(case, x);
            }
        }
        let size = [case.model.nq, case.model.nv, case.model.frames.len()];
        Self { book: case.textbook(), arguments, size }
    }

    fn given(&self, argument: Argument) -> &[Big] {
        &self.arguments.iter().find(|(a, _)| *a == argument).expect("all are there").1
    }

    /// q, v, a, wrenches.
    fn motion(&self) -> [&[Big]; 4] {
        [Argument::Q, Argument::V, Argument::A, Argument::Wrenches].map(|a| self.given(a))
    }

    fn call(&self, name: &str, arguments: &[&[Big]]) -> Vec<Big> {
        call(&self.book, name, arguments)
    }

    /// q ⊕ h·direction.
    fn stepped(&self, h: f64, direction: &[Big]) -> Vec<Big> {
        self.book.integrate(self.given(Argument::Q), &times(h, direction))
    }

    /// d/dh of f(q ⊕ h·direction, h) at 0.
    fn slope(&self, direction: &[Big], f: impl Fn(&[Big], f64) -> Vec<Big>) -> Vec<Big> {
        let at = |h: f64| f(&self.stepped(h, direction), h);
        times(0.5 / STEP, &minus(&at(STEP), &at(-STEP)))
    }
}

fn call(book: &Textbook<Big>, name: &str, arguments: &[&[Big]]) -> Vec<Big> {
    book.call(name, arguments).unwrap_or_else(|| panic!("no {name}")).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The name with its reference.
fn named(name: &str, reference: Reference) -> String {
    format!("{name}_{}", reference.name())
}

fn normalise(case: &Case, q: &mut [Big]) {
    for joint in &case.model.joints {
        let at = match joint.q.1 {
            4 => joint.q.0,
            7 => joint.q.0 + 3,
            _ => continue,
        };
        let norm = dot(&q[at..at + 4], &q[at..at + 4]).sqrt();
        q[at..at + 4].iter_mut().for_each(|c| *c = *c / norm);
    }
}

fn plus(a: &[Big], b: &[Big]) -> Vec<Big> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}

fn minus(a: &[Big], b: &[Big]) -> Vec<Big> {
    a.iter().zip(b).map(|(&a, &b)| a - b).collect()
}

fn times(k: f64, a: &[Big]) -> Vec<Big> {
    a.iter().map(|&a| a * Big::from_f64(k)).collect()
}

fn dot(a: &[Big], b: &[Big]) -> Big {
    a.iter().zip(b).fold(Big::zero(), |sum, (&a, &b)| sum + a * b)
}

/// Matrix times vector; nothing times nothing is the rows' number of zeros.
fn apply(matrix: &[Big], x: &[Big], rows: usize) -> Vec<Big> {
    (0..rows).map(|i| dot(&matrix[i * x.len()..][..x.len()], x)).collect()
}

fn transposed(matrix: &[Big], rows: usize, columns: usize) -> Vec<Big> {
    (0..rows * columns).map(|k| matrix[k % rows * columns + k / rows]).collect()
}

fn unit(n: usize, k: usize) -> Vec<Big> {
    (0..n).map(|i| if i == k { Big::one() } else { Big::zero() }).collect()
}

/// The same numbers, to `tolerance` of the largest of them or of one.
fn same(what: &str, found: &[Big], expected: &[Big], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = expected.iter().map(|e| e.to_f64().abs()).fold(1.0, f64::max);
    for (k, (&f, &e)) in found.iter().zip(expected).enumerate() {
        let error = (f - e).to_f64().abs();
        assert!(error <= tolerance * largest, "{what}, entry {k}: {} for {}, error {error:e}", f.to_f64(), e.to_f64());
    }
}

fn for_each_scene(count: u64, flavour: Flavour, law: impl Fn(&Case, &Scene)) {
    for_each_tree(count, flavour, |case, random| {
        let state = case.state(random);
        Big::scope(|| law(case, &Scene::new(case, &state)));
    });
}

/// Small, since everything is tried.
const SMALL: Flavour = Flavour { links: 6, ..Flavour::ANY };

/// Small, with a mass matrix that can be inverted.
const REGULAR: Flavour = Flavour { links: 6, ..Flavour::REGULAR };

#[test]
fn every_function_of_the_table_is_answered() {
    for_each_scene(6, REGULAR, |case, scene| {
        for row in functions::<f64>().iter().filter(|f| f.needs != Needs::FreeFrames) {
            let given: Vec<&[Big]> = row.takes.iter().map(|&a| scene.given(a)).collect();
            assert_eq!(scene.call(row.name, &given).len(), row.len(case.model.shape()), "{}", row.name);
            assert!(scene.book.call(row.name, &given[1..]).is_some_and(|r| r.is_err()), "{}", row.name);
        }
        assert!(scene.book.call("no_such_function", &[]).is_none());
    });
}

#[test]
fn twists_are_jacobians_times_rates_and_accelerations_their_rates() {
    for_each_scene(12, SMALL, |_, scene| {
        let ([q, v, a, _], rows) = (scene.motion(), 6 * scene.size[2]);
        for reference in REFERENCES {
            let call = |name: &str, given: &[&[Big]]| scene.call(&named(name, reference), given);
            let (jacobian, rate) = (call("jacobians", &[q]), call("jacobian_rates", &[q, v]));
            let bias = apply(&rate, v, rows);
            same("twists", &call("twists", &[q, v]), &apply(&jacobian, v, rows), EXACT);
            same("bias", &call("bias_accelerations", &[q, v]), &bias, EXACT);
            same("accelerations", &call("accelerations", &[q, v, a]), &plus(&apply(&jacobian, a, rows), &bias), EXACT);
        }
    });
}

#[test]
fn slopes_of_placements_twists_and_jacobians_are_those_of_differences() {
    for_each_scene(8, SMALL, |_, scene| {
        let ([q, v, a, _], [_, nv, frames]) = (scene.motion(), scene.size);
        let placed = scene.slope(v, |q, _| scene.call("placements", &[q]));
        same("placements", &apply(&scene.call("placement_derivatives", &[q]), v, 12 * frames), &placed, NEARLY);
        let twists = scene.call("twists_world_aligned", &[q, v]);
        for frame in 0..frames {
            same("ṗ", &twists[6 * frame + 3..][..3], &placed[12 * frame + 9..][..3], NEARLY);
        }
        for reference in REFERENCES {
            let call = |name: &str, given: &[&[Big]]| scene.call(&named(name, reference), given);
            let found = scene.slope(v, |q, h| call("twists", &[q, &plus(v, &times(h, a))]));
            same("twists", &call("accelerations", &[q, v, a]), &found, NEARLY);
            let found = scene.slope(v, |q, _| call("jacobians", &[q]));
            assert_eq!(found.len(), 6 * frames * nv);
            same("jacobians", &call("jacobian_rates", &[q, v]), &found, NEARLY);
        }
    });
}

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
        let ([q, v, ..], n) = (scene.motion(), case.model.nv);
        if case.model.nq != n {
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
fn torques_and_energies_are_regressors_times_parameters() {
    for_each_scene(15, SMALL, |_, scene| {
        let ([q, v, a, _], nv) = (scene.motion(), scene.size[1]);
        let parameters = scene.book.parameters();
        let found = apply(&scene.call("torque_regressor", &[q, v, a]), &parameters, nv);
        same("τ", &found, &scene.call("inverse_dynamics", &[q, v, a]), EXACT);
        let found = apply(&scene.call("kinetic_energy_regressor", &[q, v]), &parameters, 1);
        same("T", &found, &scene.call("kinetic_energy", &[q, v]), EXACT);
        let found = apply(&scene.call("potential_energy_regressor", &[q]), &parameters, 1);
        same("U", &found, &scene.call("potential_energy", &[q]), EXACT);
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

#[test]
fn derivatives_are_those_of_differences() {
    for_each_scene(4, REGULAR, |_, scene| {
        let ([q, v, a, w], n) = (scene.motion(), scene.size[1]);
        let tau = scene.given(Argument::Tau);
        let torque = |q: &[Big], v: &[Big], a: &[Big]| scene.call("inverse_dynamics_with_wrenches", &[q, v, a, w]);
        let inverse = scene.call("inverse_dynamics_derivatives_with_wrenches", &[q, v, a, w]);
        let motion = |q: &[Big], v: &[Big], tau: &[Big]| scene.call("forward_dynamics_with_wrenches", &[q, v, tau, w]);
        let forward = scene.call("forward_dynamics_derivatives_with_wrenches", &[q, v, tau, w]);
        let statics = scene.call("static_torque_derivative", &[q, w]);
        let (still, rest) = (vec![Big::zero(); n], vec![Big::zero(); n]);
        for k in 0..n {
            let e = unit(n, k);
            let column = |all: &[Big], part: usize| apply(&all[part * n * n..][..n * n], &e, n);
            let moved = |x: &[Big], h: f64| plus(x, &times(h, &e));
            same("∂τ/∂q", &column(&inverse, 0), &scene.slope(&e, |q, _| torque(q, v, a)), NEARLY);
            same("∂τ/∂v", &column(&inverse, 1), &scene.slope(&still, |_, h| torque(q, &moved(v, h), a)), NEARLY);
            same("∂τ/∂a", &column(&inverse, 2), &scene.slope(&still, |_, h| torque(q, v, &moved(a, h))), NEARLY);
            same("∂a/∂q", &column(&forward, 0), &scene.slope(&e, |q, _| motion(q, v, tau)), NEARLY);
            same("∂a/∂v", &column(&forward, 1), &scene.slope(&still, |_, h| motion(q, &moved(v, h), tau)), NEARLY);
            same("∂a/∂τ", &column(&forward, 2), &scene.slope(&still, |_, h| motion(q, v, &moved(tau, h))), NEARLY);
            same("∂g/∂q", &column(&statics, 0), &scene.slope(&e, |q, _| torque(q, &rest, &rest)), NEARLY);
        }
        let free = vec![Big::zero(); w.len()];
        for (name, last) in [("inverse_dynamics", a), ("forward_dynamics", tau)] {
            let plain = scene.call(&format!("{name}_derivatives"), &[q, v, last]);
            same(name, &plain, &scene.call(&format!("{name}_derivatives_with_wrenches"), &[q, v, last, &free]), 0.0);
        }
    });
}

#[test]
fn energies_are_those_of_virtual_power() {
    for_each_scene(15, SMALL, |case, scene| {
        let ([q, v, ..], n) = (scene.motion(), scene.size[1]);
        let motions = case.motions();
        let (rest, other) = (vec![Big::zero(); n], scene.given(Argument::Target));
        let energy = |q: &[Big]| motions.energy(q, v, &rest);
        same("T", &scene.call("kinetic_energy", &[q, v]), &[energy(q).kinetic], EXACT);
        // The links that do not move have a height too, but always the same.
        let potential = |q: &[Big]| scene.call("potential_energy", &[q])[0];
        same("U", &[potential(q) - potential(other)], &[energy(q).potential - energy(other).potential], EXACT);
        let m = scene.call("mass_matrix", &[q]);
        same("½ vᵀM v", &times(0.5, &[dot(v, &apply(&m, v, n))]), &[energy(q).kinetic], EXACT);
    });
}

#[test]
fn momentum_is_mass_times_velocity_and_a_matrix_times_rates() {
    for_each_scene(10, REGULAR, |_, scene| {
        let ([q, v, a, _], n) = (scene.motion(), scene.size[1]);
        if n == 0 {
            return;
        }
        let momentum = scene.call("centroidal_momentum", &[q, v]);
        same("A v", &apply(&scene.call("centroidal_momentum_matrix", &[q]), v, 6), &momentum, EXACT);
        let velocity = scene.call("center_of_mass_velocity", &[q, v]);
        same("J v", &apply(&scene.call("center_of_mass_jacobian", &[q]), v, 3), &velocity, EXACT);
        let mass = scene.book.parameters().chunks(10).fold(Big::zero(), |sum, p| sum + p[0]);
        let carried: Vec<Big> = velocity.iter().map(|&x| x * mass).collect();
        same("m ċ", &momentum[3..], &carried, EXACT);
        let later = |h: f64| plus(v, &times(h, a));
        let slope = scene.slope(v, |q, _| scene.call("center_of_mass", &[q]));
        same("ċ", &velocity, &slope, NEARLY);
        let slope = scene.slope(v, |q, h| scene.call("center_of_mass_velocity", &[q, &later(h)]));
        same("c̈", &scene.call("center_of_mass_acceleration", &[q, v, a]), &slope, NEARLY);
        let slope = scene.slope(v, |q, h| scene.call("centroidal_momentum", &[q, &later(h)]));
        same("ḣ", &scene.call("centroidal_momentum_rate", &[q, v, a]), &slope, NEARLY);
    });
}

/// What the joints pass is what the links need: a link's wrench is the sum of its momentum's rate and of what it hands on.
#[test]
fn power_through_the_joints_is_that_of_the_torques() {
    for_each_scene(15, SMALL, |case, scene| {
        let [q, v, a, _] = scene.motion();
        let wrenches = scene.call("joint_wrenches", &[q, v, a]);
        let (twists, placed) = (scene.call("twists_world", &[q, v]), scene.call("placements", &[q]));
        let mut power = Big::zero();
        for (k, body) in case.model.links().enumerate() {
            // The twist of the child against the parent, taken in base axes about the base's origin, with the wrench brought there.
            let joint = case.description.joint(&case.model.bodies[body].name).map(|j| &case.description.joints[j]);
            let (parent, child) = joint.map_or((None, case.description.root().unwrap_or(0)), |j| (Some(j.parent), j.child));
            let of = |link: Option<usize>, i: usize| link.map_or(Big::zero(), |l| twists[6 * l + i]);
            let relative: Vec<Big> = (0..6).map(|i| of(Some(child), i) - of(parent, i)).collect();
            let [x, w] = [&placed[12 * child..][..12], &wrenches[6 * k..][..6]];
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

#[test]
fn a_step_and_a_difference_undo_each_other() {
    for_each_scene(25, SMALL, |case, scene| {
        let (book, [q, target, step]) = (&scene.book, [Argument::Q, Argument::Target, Argument::Step].map(|a| scene.given(a)));
        let mut found = book.integrate(q, &book.difference(q, target));
        for joint in case.model.joints.iter().filter(|j| matches!(j.q.1, 4 | 7)) {
            let at = joint.q.0 + joint.q.1 - 4..joint.q.0 + joint.q.1;
            if dot(&found[at.clone()], &target[at.clone()]).to_f64() < 0.0 {
                found[at].iter_mut().for_each(|x| *x = -*x);
            }
        }
        same("q ⊕ (t ⊖ q)", &found, target, EXACT);
        let stepped = book.integrate(q, step);
        same("(q ⊕ s) ⊖ q", &book.difference(q, &stepped), step, EXACT);
        same("q ⊖ q", &book.difference(q, q), &vec![Big::zero(); step.len()], EXACT);
        // Two halves along one line are the whole.
        let half = times(0.5, step);
        let twice = book.integrate(&book.integrate(q, &half), &half);
        same("q ⊕ s/2 ⊕ s/2", &twice, &stepped, EXACT);
    });
}

#[test]
fn a_configuration_at_random_is_one() {
    for_each_scene(20, SMALL, |case, scene| {
        let q = scene.book.random_configuration(scene.given(Argument::Uniform));
        for joint in &case.model.joints {
            let own: Vec<f64> = q[joint.q.0..][..joint.q.1].iter().map(|x| x.to_f64()).collect();
            let (lower, upper) = joint.limit.map_or((-std::f64::consts::PI, std::f64::consts::PI), |l| (l.lower, l.upper));
            assert!(own.iter().all(|x| (lower..=upper).contains(x)), "{}: {own:?}", joint.name);
            if matches!(joint.q.1, 4 | 7) {
                let x = &q[joint.q.0 + joint.q.1 - 4..][..4];
                same("norm", &[dot(x, x)], &[Big::one()], EXACT);
            }
        }
    });
}

#[test]
fn chosen_frames_are_rows_of_all() {
    for_each_scene(10, SMALL, |case, scene| {
        let (links, [q, v, ..]) = (&case.description.links, scene.motion());
        let chosen = [links.len() - 1, 0];
        let names = chosen.map(|l| links[l].name.as_str());
        let book = case.textbook::<Big>().with_frames(&names).unwrap();
        for (name, given) in [("placements", &[q][..]), ("twists_body", &[q, v]), ("jacobians_world", &[q])] {
            let (all, found) = (scene.call(name, given), call(&book, name, given));
            let rows = all.len() / links.len();
            let expected: Vec<Big> = chosen.iter().flat_map(|l| all[l * rows..][..rows].to_vec()).collect();
            same(name, &found, &expected, 0.0);
        }
        assert_eq!(case.textbook::<Big>().with_frames(&["nobody"]).map(|_| ()), Err("nobody".into()));
    });
}
