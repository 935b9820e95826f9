//! Effects in generated code: active ones equal the generic library's, inactive ones are absent.

use std::collections::BTreeMap;
use std::fmt::Write;

use articulated_codegen::{Applied, Generated, Options, Request, RobotOptions, generate};
use articulated_core::description::Base;
use articulated_core::effect::{EffectId, Field, On, effects};
use articulated_tests::case::{State, read};
use articulated_tests::golden;
use articulated_tests::program::Program;
use articulated_tests::random::Random;
use articulated_tests::random_effects::random_effects;
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text;

use crate::robots::{Robot, with};

const ARM: &str = include_str!("../../robots/arm.urdf");
const WALKER: &str = include_str!("../../robots/walker.urdf");

/// Functions that depend on effects.
const FUNCTIONS: [&str; 11] = [
    "inverse_dynamics",
    "mass_matrix",
    "forward_dynamics",
    "gravity_torque",
    "static_torque_derivative",
    "inverse_dynamics_derivatives",
    "kinetic_energy",
    "potential_energy",
    "effect_forces",
    "dissipation",
    "motor_torques",
];

/// The same on every joint or on links.
fn all_of(effect: EffectId, names: &[&str], parameters: &[f64]) -> Vec<Applied> {
    names.iter().map(|on| Applied { effect, on: (*on).into(), at: Default::default(), parameters: parameters.to_vec() }).collect()
}

fn subject(name: &str, urdf: &str, base: Base, effects: Vec<Applied>) -> Robot {
    let options = Options { robot: RobotOptions { effects, ..RobotOptions::default() }, ..Options::default() };
    with(name.into(), urdf, base, false, options, |f| FUNCTIONS.contains(&f))
}

/// A wrist between two motors: pitch is 0.5 m1 − 0.7 m2 + 0.2.
const DIFFERENTIAL: &str = include_str!("../../robots/differential.urdf");

/// An arm with everything, four legs alike on the ground and in water, a tree of every kind of
/// joint, and a joint that follows two.
fn robots() -> Vec<Robot> {
    let everything = |seed: u64, urdf: &str, base: Base| {
        let case = articulated_tests::case::Case::new("", read(urdf), base);
        random_effects(&mut Random::new(seed), &case.model, |_| true)
    };
    let joints: Vec<String> = read(WALKER).joints.iter().map(|j| j.name.clone()).collect();
    let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
    let links: Vec<String> = read(WALKER).links.iter().map(|l| l.name.clone()).collect();
    let links: Vec<&str> = links.iter().map(String::as_str).collect();
    let alike = [
        all_of(EffectId::damping, &joints, &[0.2]),
        all_of(EffectId::armature, &joints, &[1e-3, 6.0]),
        all_of(EffectId::friction, &joints, &[0.3, 0.05]),
        all_of(EffectId::contact, &links, &[0.05, 800.0, 0.4, 0.6, 0.05, 0.0, 0.0, 1.0, 0.0, 0.03]),
        all_of(EffectId::box_drag, &links, &[1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.5, 0.05, 0.0, 0.0, 0.0]),
        all_of(EffectId::buoyancy, &links, &[1e-3, 1000.0]),
        all_of(EffectId::gravity_compensation, &links, &[0.6]),
    ]
    .concat();
    let on_pitch = |(effect, parameters): (EffectId, &[f64])| all_of(effect, &["pitch"], parameters);
    let forces = [EffectId::damping, EffectId::friction, EffectId::spring, EffectId::limit];
    let on_pitch = ON_JOINTS.into_iter().filter(|(effect, _)| forces.contains(effect)).flat_map(on_pitch).collect();
    let tree = urdf_text(&random_tree(111, Flavour { massless: false, links: 5, ..Flavour::WRITTEN }));
    vec![
        subject("arm", ARM, Base::Fixed, everything(3, ARM, Base::Fixed)),
        subject("walker", WALKER, Base::Floating, alike),
        subject("tree", &tree, Base::Floating, everything(5, &tree, Base::Floating)),
        subject("differential", DIFFERENTIAL, Base::Fixed, on_pitch),
    ]
}

fn assert_generic(program: &Program, robot: &Robot, states: &[State]) {
    for name in robot.functions() {
        let function = articulated_core::algorithm::function::<f64>(name).expect("in the table");
        let given: Vec<Vec<&[f64]>> = states.iter().map(|s| function.takes.iter().map(|a| s.argument(*a)).collect()).collect();
        for (found, arguments) in program.run(&robot.name, name, &given).iter().zip(&given) {
            let expected = robot.case.call(name, arguments);
            let scale = expected.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            let far = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(far <= 1e-9 * scale, "{name} of {}: {far} of {scale}", robot.name);
        }
    }
}

fn states(robot: &Robot, n: usize) -> Vec<State> {
    let random = &mut Random::new(11);
    (0..n).map(|_| robot.case.state(random)).collect()
}

#[test]
fn effects_are_those_of_the_generic_library() {
    let robots = robots();
    assert!(robots[1].generated.ledger.functions.iter().any(|f| f.lanes == 4), "legs that are alike go in lanes, effects and all");
    let named: Vec<(&str, &Generated)> = robots.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&named, &["-C", "opt-level=1", "-C", "target-cpu=native"]);
    println!("compiled in {:.1?}", program.time);
    for robot in &robots {
        assert_generic(&program, robot, &states(robot, 40));
    }
}

/// The effects that act on joints, each with some parameters.
const ON_JOINTS: [(EffectId, &[f64]); 6] = [
    (EffectId::armature, &[2e-4, 100.0]),
    (EffectId::damping, &[0.3]),
    (EffectId::friction, &[0.5, 1e-3]),
    (EffectId::spring, &[7.0, 0.1]),
    (EffectId::limit, &[-1.0, 1.5, 1e3, 0.1]),
    (EffectId::motor, &[0.8, 300.0, 100.0, 0.9, 1e-3]),
];

/// Those of higher degree, which are with all others and in no subset: they double the subsets.
const OF_HIGHER_DEGREE: [(EffectId, &[f64]); 2] =
    [(EffectId::polynomial_damping, &[0.2, -0.1]), (EffectId::polynomial_spring, &[3.0, 5.0, 0.1])];

const JOINTS: [&str; 3] = ["yaw", "elbow", "wrist"];

/// A subset of the effects on joints, by the bits of `k`; the one after the last has those of
/// higher degree.
fn subset(k: usize) -> Robot {
    let on = ON_JOINTS.iter().enumerate().filter(|(bit, _)| k >> bit & 1 == 1);
    let more = OF_HIGHER_DEGREE.iter().filter(|_| k == 1 << ON_JOINTS.len());
    let effects = on.map(|(_, one)| one).chain(more).flat_map(|(effect, parameters)| all_of(*effect, &JOINTS, parameters)).collect();
    let options = Options { robot: RobotOptions { effects, ..RobotOptions::default() }, ..Options::default() };
    with(format!("subset_{k}"), ARM, Base::Fixed, false, options, |f| matches!(f, "inverse_dynamics" | "forward_dynamics" | "mass_matrix"))
}

#[test]
fn every_subset_of_effects_builds_and_costs_what_the_ledger_says() {
    let on_joints = effects().iter().filter(|e| e.on == On::Joint).map(|e| e.id);
    let higher = OF_HIGHER_DEGREE.map(|(effect, _)| effect);
    assert!(on_joints.filter(|id| !higher.contains(id)).eq(ON_JOINTS.iter().map(|(effect, _)| *effect)), "each has its parameters");
    let subsets: Vec<Robot> = (0..1 << ON_JOINTS.len()).map(subset).collect();
    let mut out = String::from(
        "# Operations of an arm with three joints subject to each subset of the effects on joints: mul+add of each function.\n",
    );
    let mut counts: BTreeMap<(usize, &str), (i64, i64)> = BTreeMap::new();
    for (k, robot) in subsets.iter().enumerate() {
        let names: Vec<&str> = ON_JOINTS.iter().enumerate().filter(|(bit, _)| k >> bit & 1 == 1).map(|(_, (e, _))| e.name()).collect();
        for entry in &robot.generated.ledger.functions {
            let c = entry.emitted();
            counts.insert((k, &entry.function), (c.multiplications() as i64, c.additions() as i64));
            let _ = writeln!(out, "{:<20}{:>4}+{:<4}{}", entry.function, c.multiplications(), c.additions(), names.join(" "));
        }
    }
    golden::check("effects.txt", &out);
    let cost = |k: usize, name: &'static str| {
        let ((m, a), (m0, a0)) = (counts[&(k, name)], counts[&(0, name)]);
        (m - m0, a - a0)
    };
    let joints = JOINTS.len() as i64;
    let only = |effect: EffectId| 1 << ON_JOINTS.iter().position(|(other, _)| *other == effect).expect("it is on joints");
    let (armature, motor) = (only(EffectId::armature), only(EffectId::motor));
    let forces = [EffectId::damping, EffectId::friction, EffectId::spring].map(only).iter().sum::<usize>() + motor;
    assert_eq!(cost(only(EffectId::damping), "inverse_dynamics"), (joints, joints), "damping: a multiplication and an addition a joint");
    assert_eq!(
        cost(armature, "mass_matrix"),
        (0, 1),
        "armature: an addition that two joints share without it; each inertia has a constant that it is added to"
    );
    assert_eq!(
        cost(armature, "inverse_dynamics"),
        (1, 0),
        "armature: a multiplication where the acceleration has no factor that is a constant"
    );
    assert_eq!(cost(forces, "mass_matrix"), (0, 0), "forces do not change the mass matrix");
    assert_eq!(cost(motor, "inverse_dynamics"), (0, 0), "motors do not change inverse dynamics");
    let subsets: Vec<Robot> = subsets.into_iter().chain([subset(1 << ON_JOINTS.len())]).collect();
    let named: Vec<(&str, &Generated)> = subsets.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&named, &[]);
    println!("compiled in {:.1?}", program.time);
    for robot in &subsets {
        assert_generic(&program, robot, &states(robot, 3));
    }
}

/// Without any number of an effect the module equals the one without the effect, except for the
/// line that names it.
#[test]
fn an_effect_that_is_off_costs_nothing() {
    let module = |effects: Vec<Applied>| {
        let mut request = Request::new("arm.urdf", ARM);
        request.options.robot.effects = effects;
        request.options.functions = FUNCTIONS.map(Into::into).to_vec();
        generate(&request).expect("an arm").tokens().to_string()
    };
    let bare = module(Vec::new());
    for effect in effects().iter().filter(|e| !matches!(e.id, EffectId::motor | EffectId::limit | EffectId::contact)) {
        // No stiffness, no damping, no mass, no density: other fields keep their defaults.
        let without = |f: &Field| if f.name == "semi_axes" { vec![0.1; f.len] } else { vec![0.0; f.len] };
        let parameters: Vec<f64> = effect.fields.iter().flat_map(|f| f.default.map_or_else(|| without(f), <[f64]>::to_vec)).collect();
        let on: &[&str] = if effect.on == On::Joint { &JOINTS } else { &["upper", "tool"] };
        assert!(module(all_of(effect.id, on, &parameters)) == bare, "{} of nothing is something", effect.name);
    }
    assert!(module(all_of(EffectId::damping, &JOINTS, &[0.1])) != bare);
}
