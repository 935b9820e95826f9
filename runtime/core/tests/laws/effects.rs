//! Laws that hold for all effects on a robot: on random trees with random effects.

use articulated_core::Scalar;
use articulated_core::algorithm::{self as dynamics, Workspace};
use articulated_core::description::{Base, Origin};
use articulated_core::dual::Dual;
use articulated_core::effect::{self, Applied, BodyEffect, EffectId, Enters, JointEffect, On, effects};
use articulated_core::index::{BodyId, FrameId};
use articulated_core::model::Model;
use articulated_core::spatial::{Placement, from_quaternion};
use articulated_test_support::case::{Case, State, cast};
use articulated_test_support::random::Random;
use articulated_test_support::random_effects::random_effects;
use articulated_test_support::random_tree::Flavour;
use nalgebra::Vector3;

use crate::trees::{for_each_tree, share};

/// No followers: they have laws of their own, and the articulated-body algorithm does not support
/// them.
const FREE: Flavour = Flavour { mimic: false, ..Flavour::REGULAR };

fn subject(case: &Case, random: &mut Random, wanted: impl Fn(EffectId) -> bool) -> (Model<f64>, State) {
    let applied = random_effects(random, &case.model, wanted);
    (case.model.clone().with_effects(&applied).expect("effects that can be had"), case.state(random))
}

fn not_a_motor(effect: EffectId) -> bool {
    effect.row().enters != Enters::Drive
}

/// One function of the table.
pub(crate) fn call<S: Scalar>(model: &Model<S>, name: &str, arguments: &[&[S]]) -> Vec<S> {
    let function = dynamics::function::<S>(name).expect("in the table");
    let mut out = vec![S::zero(); function.len(model.shape())];
    function.call(model, &mut Workspace::new(model), arguments, &mut out).expect("lengths as the table says");
    out
}

pub(crate) fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let scale = expected.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * scale, "{what}: element {k}: {a}, expected {b}");
    }
}

#[test]
fn forward_and_inverse_dynamics_are_each_others() {
    for_each_tree(60, FREE, |case, random| {
        let (model, State { q, v, a, .. }) = subject(case, random, not_a_motor);
        let tau = call(&model, "inverse_dynamics", &[&q, &v, &a]);
        for way in dynamics::function::<f64>("forward_dynamics").expect("in the table").ways {
            let mut out = vec![0.0; model.nv()];
            let row = dynamics::function::<f64>("forward_dynamics").expect("in the table");
            row.call_by(way, &model, &mut Workspace::new(&model), &[&q, &v, &tau], &mut out).expect("lengths");
            assert_near(&out, &a, 1e-8, way.name);
        }
    });
}

#[test]
fn inverse_dynamics_is_m_a_and_bias_forces_and_followers_too() {
    for_each_tree(60, Flavour::BENT, |case, random| {
        let (model, State { q, v, a, .. }) = subject(case, random, not_a_motor);
        let (tau, bias) = (call(&model, "inverse_dynamics", &[&q, &v, &a]), call(&model, "bias_forces", &[&q, &v]));
        let matrix = call(&model, "mass_matrix", &[&q]);
        let n = model.nv();
        let expected: Vec<f64> = (0..n).map(|i| bias[i] + (0..n).map(|j| matrix[i * n + j] * a[j]).sum::<f64>()).collect();
        assert_near(&tau, &expected, 1e-12, &case.name);
    });
}

/// Y (d, μ, I) is what damping, friction and armature add to the torques; of a coordinate that
/// others follow with Σ d c² and Σ I c².
#[test]
fn joint_regressor_times_parameters_is_what_damping_friction_and_armature_add() {
    const LINEAR: [EffectId; 3] = [EffectId::damping, EffectId::friction, EffectId::armature];
    for (flavour, most) in [(FREE, 3), (Flavour::ANY, 2)] {
        let met = std::cell::Cell::new(0);
        for_each_tree(60, flavour, |case, random| {
            // Friction of followers is not linear in the numbers of their leader.
            let is_wanted = |e| LINEAR.contains(&e) && (most == 3 || e != EffectId::friction);
            let (model, State { q, v, a, .. }) = subject(case, random, is_wanted);
            // A joint that follows several has no column: its torque depends on the rates of all.
            let mut numbers = vec![[0.0; effect::JOINT_PARAMETERS]; model.nv()];
            for body in model.outward().map(|i| &model.bodies()[i]) {
                let at = &body.coordinates;
                let ratio = at.rate_of_one(&q).unwrap_or(1.0);
                for one in &body.effects.joint {
                    let k = LINEAR.iter().position(|e| *e == one.effect).expect("one of three");
                    let p = &one.parameters;
                    numbers[at.v + one.freedom][k] += p[0] * ratio * ratio * if k == 2 { p[1] * p[1] } else { 1.0 };
                    met.set(met.get() + 1);
                }
            }
            let torques = |model: &Model<f64>| call(model, "inverse_dynamics", &[&q, &v, &a]);
            let rows = call(&model, "joint_regressor", &[&v, &a]);
            let added = rows.chunks(effect::JOINT_PARAMETERS).zip(&numbers).map(|(y, p)| y.iter().zip(p).map(|(y, p)| y * p).sum::<f64>());
            let expected: Vec<f64> = torques(&case.model).iter().zip(added).map(|(tau, more)| tau + more).collect();
            assert_near(&torques(&model), &expected, 1e-13, &case.name);
        });
        assert!(met.get() > 100, "{} effects", met.get());
    }
}

/// d(T + U)/dt along the motion, by duals, is the power of torques and of dissipative effects.
#[test]
fn what_torques_give_and_effects_take_is_the_change_of_energy() {
    for_each_tree(60, Flavour::BENT, |case, random| {
        let (model, State { q, v, a, .. }) = subject(case, random, not_a_motor);
        let tau = call(&model, "inverse_dynamics", &[&q, &v, &a]);
        let given: f64 = tau.iter().zip(&v).map(|(t, v)| t * v).sum();
        let lost = call(&model, "dissipation", &[&q, &v])[0];
        let moving: Model<Dual<f64>> = model.cast();
        let along: Vec<Dual<f64>> = v.iter().map(|x| Dual::new(0.0, *x)).collect();
        let q = call(&moving, "integrate", &[&cast::<Dual<f64>>(&q), &along]);
        let v: Vec<Dual<f64>> = v.iter().zip(&a).map(|(v, a)| Dual::new(*v, *a)).collect();
        let energy = call(&moving, "kinetic_energy", &[&q, &v])[0] + call(&moving, "potential_energy", &[&q])[0];
        let scale = tau.iter().zip(&v).map(|(t, v)| (t * v.value).abs()).sum::<f64>() + energy.value.abs();
        assert!((energy.slope - given - lost).abs() <= 1e-11 * (1.0 + scale), "{}: {} = {given} + {lost}", case.name, energy.slope);
    });
}

/// Stops the wind, which gives energy.
fn calm(applied: &mut Applied) {
    let (mut at, parameters) = (0, &mut applied.parameters);
    for field in applied.effect.row().fields {
        if field.name == "wind" {
            parameters[at..at + field.len].fill(0.0);
        }
        at += field.len;
    }
}

#[test]
fn effects_take_energy_and_never_give_any() {
    for effect in effects().iter().filter(|row| !row.conservative && row.enters != Enters::Drive).map(|row| row.id) {
        let felt = std::cell::Cell::new(0_u64);
        for_each_tree(40, Flavour::ANY, |case, random| {
            let mut applied = random_effects(random, &case.model, |e| e == effect);
            applied.iter_mut().for_each(calm);
            let model = case.model.clone().with_effects(&applied).expect("effects that can be had");
            let State { q, v, .. } = case.state(random);
            let power = call(&model, "dissipation", &[&q, &v])[0];
            assert!(power <= 0.0 || power < 1e-15, "{}: {power} W by {}", case.name, effect.name());
            felt.set(felt.get() + u64::from(power < 0.0));
        });
        assert!(felt.get() > share(5), "{}: felt {} times", effect.name(), felt.get());
    }
}

/// The cone of a contact is that of the force that presses, its damping included: across the normal
/// a free body feels μ F v_t/√(v_t² + s²), against v_t, where F is what it feels along the normal.
#[test]
fn friction_of_a_contact_is_that_of_its_whole_normal_force() {
    let pressed = std::cell::Cell::new(0_u64);
    for_each_tree(80, Flavour { links: 1, ..Flavour::ANY }, |case, random| {
        if case.base == Base::Fixed {
            return;
        }
        let name = case.model.frames()[FrameId(0)].name.clone();
        let (friction, smooth) = (0.7, 0.4);
        let [radius, stiffness, damping, time] = [0.3, 50.0, 0.6, 0.8];
        let at = Origin { xyz: random.three(0.5), ..Origin::default() };
        let normal = effect::unit(random.three(1.0)).expect("a direction");
        let height = 3.0;
        let parameters = [&[radius, stiffness, damping, friction, smooth][..], &normal, &[height, time]].concat();
        let applied = Applied { effect: EffectId::contact, on: name, at, parameters };
        let model = case.model.clone().with_effects(&[applied]).expect("a contact");
        let State { q, v, .. } = case.state(random);
        let wrench = call(&model, "effect_forces", &[&q, &v]);
        // In world axes: the base's rotation times its force, and the velocity of the lowest point.
        let turn = from_quaternion([q[3], q[4], q[5], q[6]]);
        let [omega, linear, moment, force] =
            [&v[..3], &v[3..6], &wrench[..3], &wrench[3..6]].map(|x| turn * Vector3::new(x[0], x[1], x[2]));
        let normal = Vector3::from(normal);
        let arm = turn * Vector3::from(at.xyz) - normal * radius;
        let velocity = linear + omega.cross(&arm);
        let sliding = velocity - normal * normal.dot(&velocity);
        let press = normal.dot(&force);
        let expected = sliding * (-friction * press / (sliding.norm_squared() + smooth * smooth).sqrt());
        let across = force - normal * press;
        assert!(press >= 0.0 && (across - expected).norm() <= 1e-13 * (1.0 + press), "{}: {across}, not {expected}", case.name);
        assert!((moment - arm.cross(&force)).norm() <= 1e-12 * (1.0 + press), "{}: {moment}", case.name);
        pressed.set(pressed.get() + u64::from(press > 0.0));
    });
    assert!(pressed.get() > share(20), "only {}", pressed.get());
}

#[test]
fn effect_forces_are_what_inverse_dynamics_needs_less() {
    for_each_tree(40, Flavour::ANY, |case, random| {
        let inert = |e: EffectId| matches!(e.row().enters, Enters::Inertia | Enters::Added | Enters::Drive);
        let (model, State { q, v, a, .. }) = subject(case, random, |e| !inert(e));
        let [with, without] = [&model, &case.model].map(|m| call(m, "inverse_dynamics", &[&q, &v, &a]));
        let expected: Vec<f64> = with.iter().zip(&without).map(|(x, y)| y - x).collect();
        let scale = with.iter().chain(&without).fold(1.0, |m: f64, x| m.max(x.abs()));
        assert_near(&call(&model, "effect_forces", &[&q, &v]), &expected, 1e-13 * scale, &case.name);
    });
}

/// Columns of a function's derivative by duals: of each argument in its tangent space.
pub(crate) fn by_duals(model: &Model<f64>, name: &str, state: [&[f64]; 3]) -> Vec<f64> {
    let (moving, n): (Model<Dual<f64>>, usize) = (model.cast(), model.nv());
    let mut out = vec![0.0; 3 * n * n];
    for block in 0..3 {
        for k in 0..n {
            let unit: Vec<Dual<f64>> = (0..n).map(|i| Dual::new(0.0, f64::from(u8::from(i == k)))).collect();
            let mut arguments = state.map(cast::<Dual<f64>>);
            if block == 0 {
                arguments[0] = call(&moving, "integrate", &[&arguments[0], &unit]);
            } else {
                arguments[block].iter_mut().zip(&unit).for_each(|(x, u)| *x += *u);
            }
            let column = call(&moving, name, &[&arguments[0], &arguments[1], &arguments[2]]);
            (0..n).for_each(|i| out[block * n * n + i * n + k] = column[i].slope);
        }
    }
    out
}

#[test]
fn derivatives_are_those_of_duals() {
    for_each_tree(40, FREE, |case, random| {
        let (model, State { q, v, a, tau, .. }) = subject(case, random, |_| true);
        let found = call(&model, "inverse_dynamics_derivatives", &[&q, &v, &a]);
        assert_near(&found, &by_duals(&model, "inverse_dynamics", [&q, &v, &a]), 1e-11, &format!("{} ID", case.name));
        let found = call(&model, "forward_dynamics_derivatives", &[&q, &v, &tau]);
        assert_near(&found, &by_duals(&model, "forward_dynamics", [&q, &v, &tau]), 1e-8, &format!("{} FD", case.name));
    });
    for_each_tree(30, Flavour::ANY, |case, random| {
        let (model, State { q, v, a, .. }) = subject(case, random, |_| true);
        let found = call(&model, "inverse_dynamics_derivatives", &[&q, &v, &a]);
        assert_near(&found, &by_duals(&model, "inverse_dynamics", [&q, &v, &a]), 1e-11, &case.name);
        let (wrenches, zero) = (vec![0.0; 6 * model.frames().len()], vec![0.0; model.nv()]);
        let at_rest = by_duals(&model, "inverse_dynamics", [&q, &zero, &zero]);
        let found = call(&model, "static_torque_derivative", &[&q, &wrenches]);
        assert_near(&found, &at_rest[..found.len()], 1e-11, &format!("{} at rest", case.name));
    });
}

#[test]
fn nothing_of_nothing_is_nothing() {
    for_each_tree(20, Flavour::ANY, |case, random| {
        let State { q, v, tau, .. } = case.state(random);
        assert!(call(&case.model, "effect_forces", &[&q, &v]).iter().all(|x| *x == 0.0));
        assert_eq!(call(&case.model, "dissipation", &[&q, &v]), [0.0]);
        assert_eq!(call(&case.model, "motor_torques", &[&v, &tau]), tau);
    });
}

/// An effect is left out if its numbers make it vanish, and only then: put on a body by hand, it
/// changes accelerations then and only then.
#[test]
fn what_is_left_out_does_nothing_and_what_stays_does_something() {
    let arm = Case::bundled(articulated_models::robot("ur5_like").expect("a bundled robot")).model;
    let state = [[0.7, -1.2, 1.4, 0.6, -0.9, 0.8], [0.3, -0.2, 0.4, 0.5, 0.7, -0.6], [3.0, 2.0, -2.5, 1.5, -2.0, 1.8]];
    let [q, v, tau] = &state;
    let accelerations = |model: &Model<f64>| call(model, "forward_dynamics", &[q, v, tau]);
    let plain = accelerations(&arm);
    for row in effects() {
        let full: Vec<f64> = row.fields.iter().flat_map(|f| numbers(row.id, f)).collect();
        let mut start = 0;
        let each = row.fields.iter().map(|field| {
            let mut some = full.clone();
            some[start..start + field.len].fill(0.0);
            start += field.len;
            // Fields that must not be zero are not tried, nor is the place of a stop or a plane.
            let place = ["lower", "upper", "normal", "height"].contains(&field.name);
            if field.range.strictly || place { full.clone() } else { some }
        });
        for parameters in each.chain([full.clone(), vec![0.0; full.len()]]).filter(|p| row.id != EffectId::motor || p[0] > 0.0) {
            let model = arm.clone().changed(|parts| {
                let body = &mut parts.bodies[BodyId(3)].effects;
                match row.on {
                    On::Joint => body.joint.push(JointEffect { effect: row.id, freedom: 0, parameters: parameters.clone() }),
                    On::Link => {
                        let (link, placement) = (String::new(), Placement::identity());
                        body.body.push(BodyEffect { effect: row.id, link, placement, parameters: parameters.clone() });
                    }
                }
            });
            let with = accelerations(&model);
            // A law divided by zero, friction at the speed 0, is not tested.
            let same = with == plain || with.iter().any(|x| x.is_nan());
            assert_eq!(row.is_nothing(&parameters), same, "{} of {parameters:?}: {with:?}, without {plain:?}", row.name);
        }
    }
}

/// Numbers with which each effect acts on the third joint's body.
fn numbers(id: EffectId, field: &effect::Field) -> Vec<f64> {
    match (id, field.name) {
        (EffectId::limit, "lower") => vec![2.0],
        (EffectId::limit, "upper") => vec![3.0],
        (EffectId::contact, "height") => vec![9.0],
        (EffectId::contact, "normal") => vec![0.0, 0.0, 1.0],
        (EffectId::added_mass, "angular" | "linear") => vec![1.0, 0.0, 0.0, 1.0, 0.0, 1.0],
        (EffectId::added_mass, _) => vec![0.1, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1],
        _ => vec![0.4; field.len],
    }
}

/// All errors are reported, each with the expected value.
#[test]
fn effects_that_cannot_be_had_are_refused() {
    let arm = Case::bundled(articulated_models::robot("ur5_like").expect("a bundled robot")).model;
    let joint =
        |effect, on: &str, parameters: &[f64]| Applied { effect, on: on.into(), at: Default::default(), parameters: parameters.to_vec() };
    let first = arm.joints()[0].name.clone();
    let wrong = [
        joint(EffectId::damping, "elbo_joint", &[1.0]),
        joint(EffectId::damping, &first, &[-1.0]),
        joint(EffectId::damping, &first, &[f64::NAN]),
        joint(EffectId::damping, &first, &[]),
        joint(EffectId::limit, &first, &[1.0, 1.0, 10.0, 0.0]),
        joint(EffectId::motor, &first, &[1.0, 1.0, 1.0, 1.5, 1e-3]),
        joint(EffectId::drag, "no such link at all", &[1.0]),
        joint(EffectId::drag, &arm.frames()[FrameId(0)].name, &[1.0]),
        joint(EffectId::contact, &arm.frames()[FrameId(3)].name, &[0.1, 1e4, 0.0, 0.5, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0]),
        joint(EffectId::added_mass, &arm.frames()[FrameId(3)].name, &[[1.0, 2.0, 0.0, 1.0, 0.0, 1.0].as_slice(), &[0.0; 15]].concat()),
    ];
    let errors = arm.clone().with_effects(&wrong).expect_err("all of them are wrong");
    let found: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(errors.iter().map(|e| e.index).collect::<Vec<_>>(), (0..wrong.len()).collect::<Vec<_>>(), "{found:#?}");
    for (text, part) in found.iter().zip([
        "nearest",
        "found -1, expected a finite number, at least 0",
        "NaN",
        "found 0 parameters, expected 1",
        "above the lower bound",
        "at most 1",
        "no frame of this name",
        "fixed to the base",
        "a direction",
        "semidefinite",
    ]) {
        assert!(text.contains(part), "{text:?} does not say {part:?}");
    }
    let twice = [joint(EffectId::damping, &first, &[1.0]), joint(EffectId::damping, &first, &[2.0])];
    assert!(arm.with_effects(&twice).expect_err("given twice")[0].to_string().contains("twice"));
}

/// Effects that would create energy, or divide by it, or have no place to act.
#[test]
fn effects_that_are_half_right_are_refused_too() {
    let arm = Case::bundled(articulated_models::robot("ur5_like").expect("a bundled robot")).model;
    let (joint, link) = (arm.joints()[0].name.clone(), arm.frames()[FrameId(3)].name.clone());
    let on = |effect: EffectId, parameters: &[f64]| {
        let on = if effect.row().on == articulated_core::effect::On::Joint { &joint } else { &link };
        Applied { effect, on: on.clone(), at: Default::default(), parameters: parameters.to_vec() }
    };
    let told = |one: Applied| match arm.clone().with_effects(std::slice::from_ref(&one)) {
        Err(errors) => errors[0].to_string(),
        Ok(_) => panic!("{one:?}"),
    };
    // Zero where a number must be greater. Nor may a law be smooth below a number whose square
    // underflows.
    for speed in [0.0, 1e-200] {
        let text = told(on(EffectId::friction, &[1.0, speed]));
        assert!(text.contains("speed: found ") && text.contains("expected a finite number, at least 1e-15"), "{text}");
    }
    assert!(told(on(EffectId::motor, &[1.0, 0.0, 1.0, 1.0, 1e-3])).contains("speed: found 0"));
    // Σ ≥ 0 in its blocks alone is not enough: m w² + I ω² + 2 c ω w < 0 for some motion with c² >
    // I m.
    let coupled = |c: f64| {
        [[2.0, 0.0, 0.0, 2.0, 0.0, 2.0].as_slice(), &[3.0, 0.0, 0.0, 3.0, 0.0, 3.0], &[0.0, c, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]].concat()
    };
    assert!(told(on(EffectId::added_mass, &coupled(2.5))).contains("semidefinite"));
    assert!(arm.clone().with_effects(&[on(EffectId::added_mass, &coupled(2.4))]).is_ok());
    // A motor drives a joint that others follow.
    let gripper = Case::bundled(articulated_models::robot("gripper_arm").expect("a bundled robot")).model;
    let follower = gripper.bodies().iter().find(|body| body.coordinates.mimic.is_some()).expect("one that follows").name.clone();
    let motor = Applied { on: follower, ..on(EffectId::motor, &[5.0, 2.0, 1.0, 1.0, 1e-3]) };
    let refused = gripper.with_effects(&[motor]).expect_err("a motor on one that follows")[0].to_string();
    assert!(refused.contains("the joint follows another"), "{refused}");
    // Each of the numbers that is wrong.
    let bad = on(EffectId::contact, &[-1.0, -2.0, 0.0, 0.5, 1e-2, 0.0, 0.0, 1.0, f64::NAN, 0.0]);
    let all = arm.clone().with_effects(&[bad]).expect_err("three wrong numbers").to_string();
    assert!(
        all.lines().count() == 3 && ["radius: found -1", "stiffness: found -2", "height: found NaN"].iter().all(|x| all.contains(x)),
        "{all}"
    );
    let mut far = on(EffectId::drag, &[1.0]);
    far.at.xyz[1] = f64::INFINITY;
    assert!(told(far).contains("xyz or rpy: found inf"));
    // An effect that does nothing must also act on an existing target, and is then left out.
    let nothing = on(EffectId::damping, &[0.0]);
    assert!(told(Applied { on: "elbo_joint".into(), ..nothing.clone() }).contains("no joint of this name"));
    let count = |applied: &[Applied]| {
        let with = arm.clone().with_effects(applied).expect("effects that can be had");
        with.bodies().iter().map(|b| b.effects.joint.len() + b.effects.body.len()).sum::<usize>()
    };
    assert_eq!(count(&[nothing, on(EffectId::drag, &[0.0]), on(EffectId::buoyancy, &[0.0, 1000.0])]), 0);
    assert_eq!(count(&[on(EffectId::armature, &[1.0, -3.0]), on(EffectId::drag, &[0.1])]), 2);
    let quadruped = Case::bundled(articulated_models::robot("quadruped").expect("a bundled robot")).model;
    let base = Applied { on: quadruped.joints()[0].name.clone(), ..on(EffectId::damping, &[1.0]) };
    let refused = quadruped.with_effects(&[base]).expect_err("damping on the base")[0].to_string();
    assert!(refused.contains("the floating base is no joint of the robot"), "{refused}");
}
