//! Joints that follow one other by a polynomial: q_full = f(q), so v_full = G v with G = f′, and
//! τ = Gᵀ τ_full.

use articulated_core::description::{Base, Coupling, Description, EditError, Joint, JointId, JointKind, Link, LinkId, Mimic, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::{JointInfo, Model, ModelError};
use articulated_test_support::case::{Case, State};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;

use crate::effects::{assert_near, by_duals, call};
use crate::trees::{for_each_tree, share};

/// Σ cₖ (x − r)ᵏ.
const COEFFICIENTS: [f64; 5] = [0.3, -0.7, 0.4, 0.1, -0.05];
const REFERENCE: f64 = 0.2;

/// f, f′ and f″ by their definitions.
fn law(x: f64) -> [f64; 3] {
    let d = x - REFERENCE;
    let power = |k: usize| d.powi(k as i32);
    let term = |k: usize| (k as f64, COEFFICIENTS[k]);
    let value = (0..5).map(|k| term(k).1 * power(k)).sum();
    let slope = (1..5).map(|k| term(k).0 * term(k).1 * power(k - 1)).sum();
    let bend = (2..5).map(|k| term(k).0 * (term(k).0 - 1.0) * term(k).1 * power(k - 2)).sum();
    [value, slope, bend]
}

/// A tree, and the same where its last joint of one coordinate follows another.
struct Reduced<'a> {
    free: &'a Case,
    case: Case,
    follower: JointInfo,
    leader: JointInfo,
}

fn info(case: &Case, name: &str) -> JointInfo {
    case.model.joints().iter().find(|j| j.name == name).unwrap().clone()
}

impl<'a> Reduced<'a> {
    fn of(free: &'a Case, random: &mut Random) -> Option<Self> {
        let joints = &free.description.joints;
        let mut single: Vec<usize> = (0..joints.len()).filter(|&j| joints[JointId(j)].kind.sizes() == (1, 1)).collect();
        random.shuffle(&mut single);
        let [follower, leader, ..] = single[..] else { return None };
        let [follower, leader] = [follower, leader].map(|j| joints[JointId(j)].name.as_str());
        let mut tree = free.description.clone();
        tree.couple(&Coupling::polynomial(follower, leader, &COEFFICIENTS, REFERENCE).unwrap()).unwrap();
        let case = Case::new("", tree, free.base);
        assert_eq!(case.model.nv() + 1, free.model.nv());
        let (follower, leader) = (info(free, follower), info(&case, leader));
        Some(Self { free, case, follower, leader })
    }

    /// q of the free tree.
    fn coordinates(&self, q: &[f64]) -> Vec<f64> {
        let own = |joint: &JointInfo| match joint.name == self.follower.name {
            true => vec![law(q[self.leader.q.0])[0]],
            false => q[info(&self.case, &joint.name).q.0..][..joint.q.1].to_vec(),
        };
        self.free.model.joints().iter().flat_map(own).collect()
    }

    /// G, `[free nv][nv]`, with this number for d(follower)/d(leader) and this for others.
    fn matrix(&self, slope: f64, one: f64) -> Vec<Vec<f64>> {
        let mut rows = vec![vec![0.0; self.case.model.nv()]; self.free.model.nv()];
        for joint in self.free.model.joints() {
            if joint.name == self.follower.name {
                rows[joint.v.0][self.leader.v.0] = slope;
            } else {
                (0..joint.v.1).for_each(|k| rows[joint.v.0 + k][info(&self.case, &joint.name).v.0 + k] = one);
            }
        }
        rows
    }

    /// G and Ġ.
    fn jacobians(&self, q: &[f64], v: &[f64]) -> [Vec<Vec<f64>>; 2] {
        let ([_, slope, bend], k) = (law(q[self.leader.q.0]), self.leader.v.0);
        [self.matrix(slope, 1.0), self.matrix(bend * v[k], 0.0)]
    }
}

fn times(g: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    g.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

fn plus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// A G, of A row by row with as many columns as G has rows.
fn right(a: &[f64], g: &[Vec<f64>]) -> Vec<f64> {
    let n = g[0].len();
    a.chunks_exact(g.len()).flat_map(|row| (0..n).map(move |k| row.iter().zip(g).map(|(x, g)| x * g[k]).sum())).collect()
}

/// Gᵀ A, of A row by row.
fn left(g: &[Vec<f64>], a: &[f64]) -> Vec<f64> {
    let (n, width) = (g[0].len(), a.len() / g.len());
    (0..n * width).map(|k| g.iter().enumerate().map(|(i, row)| row[k / width] * a[i * width + k % width]).sum()).collect()
}

/// Random trees that have such a follower, which more than half of them have.
fn for_each_reduced(count: u64, check: impl Fn(&Case, &Reduced, &mut Random)) {
    let met = std::cell::Cell::new(0);
    for_each_tree(count, Flavour { mimic: false, locked: false, ..Flavour::REGULAR }, |free, random| {
        let Some(reduced) = Reduced::of(free, random) else { return };
        met.set(met.get() + 1);
        check(free, &reduced, random);
    });
    assert!(met.get() > share(count / 2), "only {} trees", met.get());
}

/// Every function of the reduced robot through G and Ġ, from those of the robot without the
/// follower's law.
#[test]
fn functions_are_those_of_the_free_robot_through_the_jacobian() {
    for_each_reduced(120, |free, reduced, random| {
        let (full, model) = (&free.model, &reduced.case.model);
        let State { q: x, v: u, a: b, tau, .. } = reduced.case.state(random);
        let [g, rate] = reduced.jacobians(&x, &u);
        let (q, v) = (reduced.coordinates(&x), times(&g, &u));
        let a = plus(&times(&g, &b), &times(&rate, &u));
        let near = |name: &str, given: &[&[f64]], expected: &[f64]| assert_near(&call(model, name, given), expected, 1e-12, name);
        let f = |name: &str, given: &[&[f64]]| call(full, name, given);
        near("inverse_dynamics", &[&x, &u, &b], &left(&g, &f("inverse_dynamics", &[&q, &v, &a])));
        let a_bias = times(&rate, &u);
        near("bias_forces", &[&x, &u], &left(&g, &f("inverse_dynamics", &[&q, &v, &a_bias])));
        near("gravity_torque", &[&x], &left(&g, &f("gravity_torque", &[&q])));
        let m = f("mass_matrix", &[&q]);
        near("mass_matrix", &[&x], &left(&g, &right(&m, &g)));
        // C v + g = h and the symbols of Christoffel: Gᵀ (C G + M Ġ)
        let c = plus(&right(&f("coriolis_matrix", &[&q, &v]), &g), &right(&m, &rate));
        near("coriolis_matrix", &[&x, &u], &left(&g, &c));
        near("torque_regressor", &[&x, &u, &b], &left(&g, &f("torque_regressor", &[&q, &v, &a])));
        for reference in ["body", "world", "world_aligned"] {
            let (name, rates) = (format!("jacobians_{reference}"), format!("jacobian_rates_{reference}"));
            let jacobian = f(&name, &[&q]);
            near(&name, &[&x], &right(&jacobian, &g));
            near(&rates, &[&x, &u], &plus(&right(&f(&rates, &[&q, &v]), &g), &right(&jacobian, &rate)));
            let name = format!("twists_{reference}");
            near(&name, &[&x, &u], &f(&name, &[&q, &v]));
            let name = format!("accelerations_{reference}");
            near(&name, &[&x, &u, &b], &f(&name, &[&q, &v, &a]));
            let name = format!("bias_accelerations_{reference}");
            near(&name, &[&x, &u], &f(&format!("accelerations_{reference}"), &[&q, &v, &a_bias]));
        }
        near("placements", &[&x], &f("placements", &[&q]));
        near("placement_derivatives", &[&x], &right(&f("placement_derivatives", &[&q]), &g));
        for name in ["kinetic_energy", "centroidal_momentum", "center_of_mass_velocity", "kinetic_energy_regressor"] {
            near(name, &[&x, &u], &f(name, &[&q, &v]));
        }
        for name in ["potential_energy", "center_of_mass", "potential_energy_regressor"] {
            near(name, &[&x], &f(name, &[&q]));
        }
        for name in ["center_of_mass_jacobian", "centroidal_momentum_matrix"] {
            near(name, &[&x], &right(&f(name, &[&q]), &g));
        }
        for name in ["center_of_mass_acceleration", "centroidal_momentum_rate", "joint_wrenches"] {
            near(name, &[&x, &u, &b], &f(name, &[&q, &v, &a]));
        }
        let found = call(model, "forward_dynamics", &[&x, &u, &tau]);
        let back = call(model, "inverse_dynamics", &[&x, &u, &found]);
        assert_near(&back, &tau, 1e-9, "torques of forward dynamics");
    });
}

/// Dampers, friction, springs, stops and rotors on followers: forces are Gᵀ of those on the own
/// coordinate, and derivatives are those of dual numbers through the whole function.
#[test]
fn effects_on_a_follower_act_by_the_slope_of_its_law() {
    for_each_reduced(60, |free, reduced, random| {
        let on = |effect, parameters: &[f64]| Applied {
            effect,
            on: reduced.follower.name.clone(),
            at: Origin::default(),
            parameters: parameters.to_vec(),
        };
        let effects = [
            on(EffectId::damping, &[0.7]),
            on(EffectId::friction, &[0.4, 0.3]),
            on(EffectId::spring, &[1.9, 0.4]),
            on(EffectId::polynomial_spring, &[0.6, 0.2, 0.1]),
            on(EffectId::limit, &[-0.3, 0.2, 3.0, 0.5]),
            on(EffectId::armature, &[0.1, 2.0]),
        ];
        let with = |case: &Case| case.model.clone().with_effects(&effects).unwrap();
        let (full, model) = (with(free), with(&reduced.case));
        let State { q: x, v: u, a: b, .. } = reduced.case.state(random);
        let [g, rate] = reduced.jacobians(&x, &u);
        let (q, v) = (reduced.coordinates(&x), times(&g, &u));
        let a = plus(&times(&g, &b), &times(&rate, &u));
        let near = |name: &str, given: &[&[f64]], expected: &[f64]| assert_near(&call(&model, name, given), expected, 1e-12, name);
        near("effect_forces", &[&x, &u], &left(&g, &call(&full, "effect_forces", &[&q, &v])));
        near("inverse_dynamics", &[&x, &u, &b], &left(&g, &call(&full, "inverse_dynamics", &[&q, &v, &a])));
        near("mass_matrix", &[&x], &left(&g, &right(&call(&full, "mass_matrix", &[&q]), &g)));
        near("kinetic_energy", &[&x, &u], &call(&full, "kinetic_energy", &[&q, &v]));
        near("potential_energy", &[&x], &call(&full, "potential_energy", &[&q]));
        near("dissipation", &[&x, &u], &call(&full, "dissipation", &[&q, &v]));
        let message = reduced.case.model.clone().with_effects(&[on(EffectId::motor, &[1.0, 1.0, 1.0, 0.8, 0.1])]).unwrap_err();
        assert!(message.to_string().contains("follows"), "{message}");
    });
}

/// With effects on bodies too, and with chains of followers.
#[test]
fn derivatives_are_those_of_dual_numbers() {
    for_each_tree(40, Flavour { bent: true, ..Flavour::REGULAR }, |case, random| {
        let applied = articulated_test_support::random_effects::random_effects(random, &case.model, |_| true);
        let model = case.model.clone().with_effects(&applied).expect("effects that can be had");
        let State { q, v, a, .. } = case.state(random);
        let given = [q.as_slice(), &v, &a];
        let found = call(&model, "inverse_dynamics_derivatives", &given);
        assert_near(&found, &by_duals(&model, "inverse_dynamics", given), 1e-10, "derivatives of torques");
        let torques = call(&model, "inverse_dynamics", &given);
        let given = [q.as_slice(), &v, &torques];
        let found = call(&model, "forward_dynamics_derivatives", &given);
        assert_near(&found, &by_duals(&model, "forward_dynamics", given), 1e-6, "derivatives of accelerations");
    });
}

fn link(name: &str, mass: f64) -> Link {
    let inertial = (mass > 0.0).then(|| articulated_core::description::Inertial { origin: Origin::default(), mass, inertia: [0.0; 6] });
    Link { name: name.into(), inertial, ..Link::default() }
}

fn joint(name: &str, kind: JointKind, [parent, child]: [usize; 2], axis: [f64; 3]) -> Joint {
    Joint { name: name.into(), kind, parent: LinkId(parent), child: LinkId(child), axis, ..Joint::default() }
}

/// c₂ of the slider and its mass; the pendulum's point mass and length, whose inertia about the
/// hinge is m_p l².
const C: f64 = 0.8;
const M: f64 = 1.7;
const POINT: f64 = 0.9;
const LENGTH: f64 = 0.6;

/// A pendulum about y, and beside it a slider along z of the base that follows by c₂ q².
fn pendulum_and_slider() -> Description {
    let mut hand = link("hand", POINT);
    hand.inertial.iter_mut().for_each(|inertial| inertial.origin = Origin { xyz: [0.0, 0.0, -LENGTH], ..Origin::default() });
    let joints =
        [joint("swing", JointKind::Continuous, [0, 1], [0.0, 1.0, 0.0]), joint("rise", JointKind::Prismatic, [0, 2], [0.0, 0.0, 1.0])];
    let links = [link("base", 0.0), hand, link("load", M)];
    let mut robot = Description { name: "cam".into(), links: links.into(), joints: joints.into(), frames: vec![] };
    robot.couple(&Coupling::polynomial("rise", "swing", &[0.0, 0.0, C], 0.0).unwrap()).unwrap();
    robot
}

/// By hand, with f = c q², f′ = 2 c q and f″ = 2 c:
///
/// ```text
/// (I + m f′²) q̈ + m f′ f″ q̇² + m g f′ + m_p g l sin q = τ
/// ```
#[test]
fn a_pendulum_that_lifts_a_load_is_that_of_the_equation_by_hand() {
    let case = Case::new("cam", pendulum_and_slider(), Base::Fixed);
    assert_eq!((case.model.nv(), case.model.has_followers()), (1, true));
    let (inertia, gravity) = (POINT * LENGTH * LENGTH, 9.81);
    for (q, v, a) in [(0.7, 1.1, -0.4), (-1.3, 0.2, 2.0), (0.0, -1.5, 0.3)] {
        let (slope, bend) = (2.0 * C * q, 2.0 * C);
        let mass = inertia + M * slope * slope;
        let bias = M * slope * bend * v * v + M * gravity * slope + POINT * gravity * LENGTH * f64::sin(q);
        assert_near(&case.call::<f64>("mass_matrix", &[&[q]]), &[mass], 1e-15, "M");
        assert_near(&case.call::<f64>("inverse_dynamics", &[&[q], &[v], &[a]]), &[mass * a + bias], 1e-14, "τ");
        assert_near(&case.call::<f64>("forward_dynamics", &[&[q], &[v], &[0.0]]), &[-bias / mass], 1e-14, "q̈");
        assert_near(&case.call::<f64>("coriolis_matrix", &[&[q], &[v]]), &[M * slope * bend * v], 1e-15, "C");
        let by_q = 2.0 * M * slope * bend * a + M * bend * bend * v * v + M * gravity * bend + POINT * gravity * LENGTH * f64::cos(q);
        let expected = [by_q, 2.0 * M * slope * bend * v, mass];
        assert_near(&case.call::<f64>("inverse_dynamics_derivatives", &[&[q], &[v], &[a]]), &expected, 1e-14, "∂τ");
        let energy = 0.5 * mass * v * v;
        assert_near(&case.call::<f64>("kinetic_energy", &[&[q], &[v]]), &[energy], 1e-15, "T");
        let height = M * gravity * C * q * q - POINT * gravity * LENGTH * f64::cos(q);
        assert_near(&case.call::<f64>("potential_energy", &[&[q]]), &[height], 1e-14, "U");
    }
}

/// Without forces but gravity, T + U stays to the order of the method.
#[test]
fn energy_is_conserved() {
    let case = Case::new("cam", pendulum_and_slider(), Base::Fixed);
    let energy = |q: &[f64], v: &[f64]| case.call::<f64>("kinetic_energy", &[q, v])[0] + case.call::<f64>("potential_energy", &[q])[0];
    let drift = |steps: usize| {
        let (mut q, mut v, h) = (vec![1.4], vec![0.3], 1.0 / steps as f64);
        let begin = energy(&q, &v);
        for _ in 0..steps {
            let slope = |q: f64, v: f64| [v, case.call::<f64>("forward_dynamics", &[&[q], &[v], &[0.0]])[0]];
            let k1 = slope(q[0], v[0]);
            let k2 = slope(q[0] + 0.5 * h * k1[0], v[0] + 0.5 * h * k1[1]);
            let k3 = slope(q[0] + 0.5 * h * k2[0], v[0] + 0.5 * h * k2[1]);
            let k4 = slope(q[0] + h * k3[0], v[0] + h * k3[1]);
            let sum = |k: usize| h / 6.0 * (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]);
            (q[0], v[0]) = (q[0] + sum(0), v[0] + sum(1));
        }
        (energy(&q, &v) - begin).abs()
    };
    // The error of the method of Runge and Kutta falls with the fourth power of the step.
    let [coarse, fine] = [drift(500), drift(1000)];
    assert!(fine < 1e-6 && coarse / fine > 12.0, "{coarse:e}, {fine:e}");
}

#[test]
fn a_locked_leader_locks_its_follower_at_the_value_of_its_law() {
    let mut robot = pendulum_and_slider();
    robot.lock("swing", &[0.5]).unwrap();
    let case = Case::new("cam", robot, Base::Fixed);
    let load = case.model.frames().iter().find(|frame| frame.name == "load").unwrap();
    assert!(load.body.is_base() && (load.placement.position.z - C * 0.25).abs() < 1e-15, "{load:?}");
}

/// Chains are composed while the product of the degrees is at most four.
#[test]
fn chains_of_polynomials_are_composed_up_to_the_fourth_degree() {
    let chain = |laws: [[f64; 5]; 2]| {
        let links = (0..4).map(|k| link(&format!("l{k}"), 1.0)).collect();
        let joints = (0..3).map(|k| joint(&format!("j{k}"), JointKind::Prismatic, [k, k + 1], [0.0, 0.0, 1.0])).collect();
        let mut robot = Description { links, joints, ..Description::default() };
        for (k, [offset, multiplier, higher @ ..]) in laws.into_iter().enumerate() {
            robot.joints[JointId(k)].mimic = Some(Mimic { joint: JointId(k + 1), multiplier, offset, higher });
        }
        Model::new(&robot, Base::Fixed)
    };
    let square = [0.3, -0.4, 0.5, 0.0, 0.0];
    let model = chain([square, [0.1, 0.7, -0.2, 0.0, 0.0]]).unwrap();
    let (x, outer) = (0.6, |y: f64| 0.3 - 0.4 * y + 0.5 * y * y);
    let y = 0.1 + 0.7 * x - 0.2 * x * x;
    let found = call(&model, "placements", &[&[x]]);
    assert_near(&[found[23], found[35], found[47]], &[outer(y), outer(y) + y, outer(y) + y + x], 1e-15, "heights");
    let error = chain([square, [0.0, 1.0, 0.0, 0.1, 0.0]]).unwrap_err();
    assert_eq!(error, ModelError::Degree { joint: "j0".into() });
    assert!(error.to_string().contains("at most 4"), "{error}");
    let error = chain([[0.0, 1.0, f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0]]).unwrap_err();
    assert!(matches!(error, ModelError::TooLarge { .. }), "{error}");
}

#[test]
fn polynomials_that_cannot_be_are_refused_with_what_was_found() {
    let refused = |coupling: Result<Coupling, EditError>| {
        let mut robot = pendulum_and_slider();
        let more = [joint("a", JointKind::Prismatic, [2, 3], [1.0, 0.0, 0.0]), joint("b", JointKind::Prismatic, [3, 4], [1.0, 0.0, 0.0])];
        for (name, joint) in ["la", "lb"].into_iter().zip(more) {
            robot.links.push(link(name, 1.0));
            robot.joints.push(joint);
        }
        coupling.and_then(|coupling| robot.couple(&coupling)).unwrap_err().to_string()
    };
    let leaders = vec![("swing".to_owned(), 1.0), ("b".to_owned(), 2.0)];
    for (coupling, what) in [
        (Coupling::polynomial("a", "swing", &[0.0; 6], 0.0), "found 6 coefficients"),
        (Coupling::polynomial("a", "swing", &[], 0.0), "expected one to five"),
        (Coupling::polynomial("a", "swing", &[0.0, 1.0, f64::INFINITY], 0.0), "expected finite numbers"),
        (Coupling::polynomial("a", "swing", &[0.0, 1.0, 1.0], f64::NAN), "expected finite numbers"),
        (Coupling::polynomial("a", "rise", &[0.0, 1.0, 0.0, 0.4], 0.0), "the product of the degrees"),
        (Coupling::polynomial("a", "a", &[0.0, 1.0, 0.4], 0.0), "expected another joint"),
        (Ok(Coupling { joint: "a".into(), leaders, higher: [0.1, 0.0, 0.0], offset: 0.0 }), "with 2 leaders, expected one leader"),
        (
            Ok(Coupling { joint: "a".into(), leaders: vec![("b".into(), 1.0)], higher: [f64::NAN, 0.0, 0.0], offset: 0.0 }),
            "expected finite numbers",
        ),
    ] {
        let told = refused(coupling);
        assert!(told.contains(what) && told.contains("\"a\""), "{told}");
    }
}
