//! Springs and limits on ball joints: closed forms, gradients, and many digits.

use std::f64::consts::PI;

use articulated_core::Scalar;
use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};
use articulated_core::effect::{Applied, EffectId, Fault};
use articulated_core::model::Model;
use articulated_core::spatial::screw::{Quaternion, right_jacobian_inverse};
use articulated_core::spatial::{Matrix3, Vector3};
use articulated_reference::Big;
use articulated_test_support::case::cast;
use articulated_test_support::random::Random;

/// Half the spacing of numbers at 1.
const U: f64 = f64::EPSILON / 2.0;

/// A pendulum of 2 kg on a ball joint, and behind it a bob on another.
fn pendulum() -> Model<f64> {
    let link = |name: &str, mass: Option<f64>| Link {
        name: name.into(),
        inertial: mass.map(|mass| Inertial { origin: Origin::at([0.0, 0.0, -0.3]), mass, inertia: [0.02, 0.0, 0.0, 0.03, 0.0, 0.01] }),
        ..Link::default()
    };
    let joint = |name: &str, parent: usize| Joint {
        name: name.into(),
        kind: JointKind::Spherical,
        parent: LinkId(parent),
        child: LinkId(parent + 1),
        origin: Origin::new([0.0, 0.1, -0.4], [0.3, -0.2, 0.5]),
        ..Joint::default()
    };
    let links = vec![link("base", None), link("rod", Some(2.0)), link("bob", Some(0.5))];
    let joints = vec![joint("hip", 0), joint("knee", 1)];
    let description = Description { name: "pendulum".into(), links: links.into(), joints: joints.into(), frames: Vec::new() };
    Model::new(&description, Base::Fixed).expect("a pendulum").with_gravity([0.0; 3])
}

fn on(effect: EffectId, on: &str, parameters: &[f64]) -> Applied {
    Applied { effect, on: on.into(), at: Origin::default(), parameters: parameters.to_vec() }
}

fn with(effect: EffectId, parameters: &[f64]) -> Model<f64> {
    pendulum().with_effects(&[on(effect, "hip", parameters)]).expect("an effect on a ball joint")
}

fn call<S: Scalar>(model: &Model<S>, name: &str, arguments: &[&[S]]) -> Vec<S> {
    let function = function::<S>(name).expect("in the table");
    let mut out = vec![S::zero(); function.len(model.shape())];
    function.call(model, &mut Workspace::new(model), arguments, &mut out).expect("lengths as the table says");
    out
}

/// A configuration with this rotation of the hip.
fn hip(q: [f64; 4]) -> Vec<f64> {
    [q, [0.0, 0.0, 0.0, 1.0]].concat()
}

fn turned_by(phi: [f64; 3]) -> Vec<f64> {
    hip(Quaternion::exp(Vector3::from(phi)).to_array())
}

/// The torque on the hip and the stored energy.
fn pull(model: &Model<f64>, q: &[f64], v: &[f64]) -> ([f64; 3], f64) {
    let forces = call(model, "effect_forces", &[q, v]);
    assert_eq!(forces[3..], [0.0; 3]);
    ([forces[0], forces[1], forces[2]], call(model, "potential_energy", &[q])[0])
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    let near = found.len() == expected.len() && found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= tolerance);
    assert!(near, "{found:?} instead of {expected:?}");
}

#[test]
fn a_spring_pulls_along_the_rotation_vector_from_rest() {
    let model = with(EffectId::spring, &[3.0, 0.0, 0.0, 0.0, 1.0]);
    let q = [0.1, 0.0, 0.0, 0.994_987_437_106_62];
    let phi = 2.0 * 0.1_f64.asin();
    for sign in [1.0, -1.0] {
        let (torque, energy) = pull(&model, &hip(q.map(|x| sign * x)), &[0.0; 6]);
        assert_near(&torque, &[-3.0 * phi, 0.0, 0.0], 4e-15);
        assert_near(&torque, &[-0.601_004_526_9, 0.0, 0.0], 1e-10);
        assert_near(&[energy], &[0.060_201_073_6], 1e-10);
    }
    // MuJoCo 4.0.0, a ball joint with stiffness="3": qfrc_spring and the potential energy.
    let norm = (0.25_f64 + 0.09 + 0.49 + 0.16).sqrt();
    let (torque, energy) = pull(&model, &hip([-0.5, 0.3, 0.7, 0.4].map(|x| x / norm)), &[0.1, 0.2, -0.3, 0.0, 0.0, 0.0]);
    assert_near(&torque, &[3.810_180_04, -2.286_108_03, -5.334_252_06], 1e-8);
    assert_near(&[energy], &[8.033_001_15], 1e-8);
}

/// φ = log(q₀⁻¹ q), whatever the norm of q₀ as it is given.
#[test]
fn a_spring_rests_where_it_is_told() {
    let (rest, phi) = (Vector3::new(0.7, -1.1, 0.4), Vector3::new(-0.3, 0.2, 0.9));
    let q = Quaternion::exp(rest).product(&Quaternion::exp(phi));
    for length in [1.0, -3.0, 1e-200, 1e200] {
        let given = Quaternion::exp(rest).to_array().map(|x| length * x);
        let model = with(EffectId::spring, &[&[2.0][..], &given].concat());
        let (torque, energy) = pull(&model, &hip(q.to_array()), &[0.0; 6]);
        assert_near(&torque, (phi * -2.0).as_slice(), 1e-14);
        assert_near(&[energy], &[phi.norm_squared()], 1e-14);
    }
}

/// At half a turn the torque changes its sign at once, and the energy is ½ k π².
#[test]
fn a_spring_pulls_the_shorter_way_back() {
    let model = with(EffectId::spring, &[2.0, 0.0, 0.0, 0.0, 1.0]);
    let at = |angle: f64| pull(&model, &turned_by([0.0, angle, 0.0]), &[0.0; 6]);
    for beyond in [1e-3, 1e-9] {
        assert_near(&at(PI - beyond).0, &[0.0, -2.0 * (PI - beyond), 0.0], 1e-14);
        assert_near(&at(PI + beyond).0, &[0.0, 2.0 * (PI - beyond), 0.0], 2e-14);
        assert_near(&[at(PI - beyond).1 - at(PI + beyond).1], &[0.0], 1e-13);
    }
}

#[test]
fn a_cone_is_a_stop_of_the_angle_of_the_rotation() {
    let model = with(EffectId::limit, &[0.5, 100.0, 0.4]);
    let at = |phi: [f64; 3], v: [f64; 3]| pull(&model, &turned_by(phi), &[v, [0.0; 3]].concat());
    assert_eq!(at([0.0; 3], [1.0, 2.0, 3.0]), ([0.0; 3], 0.0));
    assert_eq!(at([0.29, 0.0, -0.4], [9.0; 3]), ([0.0; 3], 0.0));
    // |φ| = 0.75: k x (1 + c θ̇), with θ̇ = φᵀω/θ.
    let phi = [0.45, 0.0, -0.6];
    for (v, factor) in [([0.0; 3], 1.0), ([1.0, 5.0, 0.0], 1.24), ([0.0, 5.0, 1.0], 0.68), ([-6.0, 0.0, 0.0], 0.0)] {
        let (torque, energy) = at(phi, v);
        assert_near(&torque, &[-15.0 * factor, 0.0, 20.0 * factor], 1e-13);
        assert_near(&[energy], &[3.125], 1e-13);
    }
    // Power that is not stored is dissipated.
    let (q, v) = (turned_by(phi), [1.0, 5.0, 0.0, 0.0, 0.0, 0.0]);
    assert_near(&call(&model, "dissipation", &[&q, &v]), &[-15.0 * 0.24], 1e-13);
    let slower = [-6.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_near(&call(&model, "dissipation", &[&q, &slower]), &[-15.0 * 6.0], 1e-12);
    // An angle is at most π.
    assert_eq!(pull(&with(EffectId::limit, &[PI, 100.0, 0.0]), &turned_by([0.0, 0.0, PI - 1e-6]), &[0.0; 6]), ([0.0; 3], 0.0));
}

/// τ = −∂U/∂δ along q ⊕ δ, by differences in many digits.
#[test]
fn torques_are_the_gradients_of_energies() {
    let mut random = Random::new(5);
    for (effect, parameters) in [(EffectId::spring, &[3.0, 0.2, -0.5, 0.1, 0.7][..]), (EffectId::limit, &[0.4, 70.0, 0.0])] {
        let model = with(effect, parameters);
        for angle in [1e-9, 0.3, 1.0, 2.9] {
            let axis = Vector3::from(random.three(1.0)).normalize();
            let q = turned_by((axis * angle).into());
            let torque = pull(&model, &q, &[0.0; 6]).0;
            Big::scope(|| {
                let model: Model<Big> = model.cast();
                let step = 1e-20;
                for k in 0..3 {
                    let energy = |sign: f64| {
                        let step: Vec<Big> = (0..6).map(|i| Big::from_f64(if i == k { sign * step } else { 0.0 })).collect();
                        call(&model, "potential_energy", &[&call(&model, "integrate", &[&cast(&q), &step])])[0]
                    };
                    let slope = (energy(1.0) - energy(-1.0)) / Big::from_f64(2.0 * step);
                    let far = (-slope).error_of(torque[k], U);
                    let size = 3.0 + Vector3::from(torque).norm();
                    assert!(far <= 8.0 * size, "{effect:?} at {angle}: {far} u of {}", torque[k]);
                }
            });
        }
    }
}

/// ∂τ/∂q = k J_r(φ)⁻¹ for a spring, from no turn to half a turn; all that depends on φ to a few
/// roundings.
#[test]
fn slopes_hold_from_no_turn_to_half_a_turn() {
    let mut random = Random::new(8);
    let spring = with(EffectId::spring, &[3.0, 0.0, 0.0, 0.0, 1.0]);
    let both = pendulum()
        .with_effects(&[
            on(EffectId::spring, "hip", &[3.0, 0.2, -0.5, 0.1, 0.7]),
            on(EffectId::limit, "hip", &[1e-3, 2.0, 0.6]),
            on(EffectId::limit, "knee", &[0.3, 5.0, 0.2]),
        ])
        .expect("effects on ball joints");
    let (zero, none) = ([0.0; 6], vec![0.0; 6 * both.frames().len()]);
    let at_rest = call(&spring, "static_torque_derivative", &[&hip([0.0, 0.0, 0.0, 1.0]), &none]);
    assert_eq!(at_rest[..3], [3.0, 0.0, 0.0]);
    for angle in [1e-300, 1e-9, 1e-4, 0.1, 1.0, 2.0, 3.1, PI - 1e-4, PI - 1e-8] {
        let phi = Vector3::from(random.three(1.0)).normalize() * angle;
        let q = turned_by(phi.into());
        let found = call(&spring, "static_torque_derivative", &[&q, &none]);
        let expected: Matrix3<f64> = right_jacobian_inverse(phi) * 3.0;
        for (i, k) in (0..3).flat_map(|i| (0..3).map(move |k| (i, k))) {
            assert!((found[6 * i + k] - expected[(i, k)]).abs() < 2e-14, "{angle}: {} is not {}", found[6 * i + k], expected[(i, k)]);
        }
        let q = [&q[..4], &turned_by(random.three(0.8))[..4]].concat();
        let v: Vec<f64> = [random.three(1.0), random.three(1.0)].concat();
        Big::scope(|| {
            let exact: Model<Big> = both.cast();
            let given: [&[f64]; 3] = [&q, &v, &zero];
            let many: Vec<Vec<Big>> = given.iter().map(|x| cast(x)).collect();
            let many: Vec<&[Big]> = many.iter().map(Vec::as_slice).collect();
            for name in ["effect_forces", "inverse_dynamics_derivatives"] {
                let count = if name == "effect_forces" { 2 } else { 3 };
                let (found, expected) = (call(&both, name, &given[..count]), call(&exact, name, &many[..count]));
                let far = found.iter().zip(&expected).map(|(f, e)| e.error_of(*f, U)).fold(0.0, f64::max);
                assert!(far <= 200.0, "{name} at {angle}: {far} u");
            }
        });
    }
}

#[test]
fn numbers_that_a_ball_cannot_have_are_refused() {
    let told = |effect: EffectId, parameters: &[f64]| {
        let errors = pendulum().with_effects(&[on(effect, "hip", parameters)]).expect_err("wrong numbers");
        (errors[0].fault.clone(), errors[0].to_string())
    };
    assert_eq!(told(EffectId::spring, &[3.0, 0.0]).0, Fault::Length { found: 2, expected: 5 });
    assert_eq!(told(EffectId::limit, &[-1.0, 1.0, 3.0, 0.0]).0, Fault::Length { found: 4, expected: 3 });
    assert!(told(EffectId::spring, &[3.0, 0.0, 0.0, 0.0, 0.0]).1.contains("rest: found 0, 0, 0, 0, expected a quaternion"));
    assert!(told(EffectId::limit, &[0.0, 3.0, 0.0]).1.contains("upper: found 0, expected a finite number above 0"));
    let twice = [on(EffectId::limit, "hip", &[1.0, 3.0, 0.0]), on(EffectId::limit, "hip", &[1.0, 3.0, 0.0])];
    assert!(pendulum().with_effects(&twice).expect_err("given twice")[0].to_string().contains("twice"));
    let nothing = with(EffectId::spring, &[0.0, 0.0, 0.0, 0.0, 1.0]);
    assert!(nothing.bodies().iter().all(|body| body.effects.joint.is_empty()));
}
