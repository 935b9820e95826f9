//! Springs and limits on ball joints in generated code: every level, Rust and C, against the
//! generic library in 96 digits.

use articulated_codegen::{COptions, Generated, Options, RobotOptions, Target};
use articulated_core::Scalar;
use articulated_core::algorithm::{Shape, function};
use articulated_core::description::Base;
use articulated_core::effect::{Applied, EffectId};
use articulated_core::index::BodyId;
use articulated_core::spatial::Vector3;
use articulated_core::spatial::screw::Quaternion;
use articulated_lab::compiled::{Compiled, Rustc, Target as Processor};
use articulated_reference::Big;
use articulated_tests::c_program::{self, Vectors};
use articulated_tests::case::State;
use articulated_tests::random::Random;

use crate::robots::{Robot, with};

/// A trunk on a ball joint, and two alike that hang on it by a ball joint and a hinge.
const URDF: &str = r#"<robot name="balls"><link name="base"/>
  <link name="trunk"><inertial><origin xyz="0.05 0 -0.3"/><mass value="2"/><inertia ixx="0.2" ixy="0.01" ixz="0" iyy="0.3" iyz="0" izz="0.15"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0 0.1 -0.2"/><mass value="0.7"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.015"/></inertial></link>
  <link name="hand"><inertial><origin xyz="0 0 -0.1"/><mass value="0.3"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="hip" type="spherical"><parent link="base"/><child link="trunk"/></joint>
  <joint name="shoulder" type="spherical"><origin xyz="0.1 0.2 -0.5" rpy="0.3 -0.4 0.5"/><parent link="trunk"/><child link="arm"/></joint>
  <joint name="elbow" type="continuous"><origin xyz="0 0 -0.4"/><parent link="arm"/><child link="hand"/><axis xyz="0 1 0"/></joint>
</robot>"#;

const FUNCTIONS: [&str; 7] = [
    "inverse_dynamics",
    "forward_dynamics",
    "potential_energy",
    "effect_forces",
    "dissipation",
    "static_torque_derivative",
    "inverse_dynamics_derivatives",
];

fn effects() -> Vec<Applied> {
    let on =
        |effect, on: &str, parameters: &[f64]| Applied { effect, on: on.into(), at: Default::default(), parameters: parameters.to_vec() };
    vec![
        on(EffectId::armature, "shoulder", &[0.02, 1.0]),
        on(EffectId::damping, "hip", &[0.3]),
        on(EffectId::spring, "hip", &[3.0, 0.0, 0.0, 0.0, 1.0]),
        on(EffectId::spring, "shoulder", &[2.0, 0.3, -0.2, 0.1, 0.8]),
        on(EffectId::spring, "elbow", &[1.0, 0.2]),
        on(EffectId::limit, "hip", &[0.8, 50.0, 0.3]),
        on(EffectId::limit, "shoulder", &[0.4, 20.0, 0.0]),
    ]
}

fn robot(level: &str, target: Target) -> Robot {
    let robot = RobotOptions { effects: effects(), ..RobotOptions::default() };
    let options = Options { robot, target, level: level.parse().expect("a level"), ..Options::default() };
    with("balls".into(), URDF, Base::Fixed, false, options, |name| FUNCTIONS.contains(&name))
}

/// Random states, in numbers representable in `f32` if the robot's code is of single precision; in
/// some the hip is at its rest, or nearly half a turn away. With a quaternion of norm other than
/// one, some functions differ from those of the generic library, so the others are not rounded.
fn states(robot: &Robot) -> Vec<State> {
    let mut random = Random::new(41);
    let short = |x: &mut Vec<f64>| x.iter_mut().for_each(|x| *x = f64::from(*x as f32));
    let angles = [None, Some(0.0), Some(1e-6), Some(0.1), Some(1.0), Some(3.1)];
    let one = |k: usize| {
        let mut state = robot.case.state(&mut random);
        if let Some(angle) = angles[k % angles.len()] {
            let phi = Vector3::from(random.three(1.0)).normalize() * angle;
            let hip = robot.case.model.joints().iter().find(|joint| joint.name.starts_with("hip")).expect("a hip").q.0;
            state.q[hip..hip + 4].copy_from_slice(&Quaternion::exp(phi).to_array());
        }
        if robot.generated.level.is_single() {
            [&mut state.q, &mut state.v, &mut state.a, &mut state.tau].into_iter().for_each(short);
        }
        state
    };
    (0..24).map(one).collect()
}

/// Compares a program's results for each function and state with 96 digits of the generic library,
/// relative to the largest number.
fn hold(robot: &Robot, tolerance: f64, mut run: impl FnMut(&str, &State, &[&[f64]], usize) -> Vec<f64>) {
    let mut worst = (0.0, "");
    for state in states(robot) {
        for name in robot.functions() {
            let row = function::<f64>(name).expect("in the table");
            let given: Vec<&[f64]> = row.takes.iter().map(|a| state.argument(*a)).collect();
            let found = run(name, &state, &given, row.len(robot.case.model.shape()));
            Big::scope(|| {
                let many: Vec<Vec<Big>> = given.iter().map(|x| x.iter().map(|x| Big::from_f64(*x)).collect()).collect();
                let many: Vec<&[Big]> = many.iter().map(Vec::as_slice).collect();
                let expected = robot.case.call::<Big>(name, &many);
                let scale = expected.iter().fold(1.0, |most: f64, x| most.max(x.to_f64().abs()));
                let far = expected.iter().zip(&found).map(|(e, f)| (*e - Big::from_f64(*f)).to_f64().abs() / scale).fold(0.0, f64::max);
                assert!(far.is_finite() && expected.len() == found.len(), "{name}");
                worst = if far > worst.0 { (far, row.name) } else { worst };
            });
        }
    }
    println!("{}: {:.1e} in {}", robot.generated.level, worst.0, worst.1);
    assert!(worst.0 <= tolerance, "{}: {:e} in {}", robot.generated.level, worst.0, worst.1);
}

#[test]
fn springs_and_limits_of_balls_are_those_of_the_generic_library_in_every_level() {
    let rustc = Rustc::find().expect("a compiler");
    for (level, tolerance) in [("f64", 1e-13), ("compensated", 1e-14), ("double_double", 1e-14), ("f32_f64", 1e-5), ("f32", 1e-4)] {
        let robot = robot(level, Target::default());
        let compiled = Compiled::build_for(Processor::Own, &rustc, &robot.generated).expect("code that compiles");
        hold(&robot, tolerance, |name, _, given, count| {
            let mut out = vec![0.0; count];
            compiled.call(name, given, &mut out).expect("a function");
            out
        });
    }
}

#[test]
fn springs_and_limits_of_balls_are_those_of_the_generic_library_in_c() {
    let levels = [("balls", "f64", 1e-13), ("balls_single", "f32", 1e-4)];
    let of = |name: &str, level: &str| robot(level, Target::C(COptions { prefix: Some(name.into()), ..COptions::default() }));
    let robots = levels.map(|(name, level, _)| of(name, level));
    let all: Vec<(&str, Shape, &Generated)> =
        levels.iter().zip(&robots).map(|((name, ..), robot)| (*name, robot.case.model.shape(), &robot.generated)).collect();
    let program = c_program::build(&all, Vectors::Any, "-O1");
    for ((name, _, tolerance), robot) in levels.iter().zip(&robots) {
        hold(robot, *tolerance, |function, _, given, _| program.run(name, function, &[given.to_vec()]).remove(0));
    }
}

/// Four legs alike, each on a ball joint with a spring and a limit of its own numbers, go in lanes.
#[test]
fn limbs_on_balls_go_in_lanes() {
    let leg = |k: usize| {
        let (x, y, mass) = ([1, 1, -1, -1][k], [1, -1, 1, -1][k], 0.5 + 0.1 * k as f64);
        format!(
            "<link name='thigh{k}'><inertial><origin xyz='0 0 -0.2'/><mass value='{mass}'/>
            <inertia ixx='0.02' ixy='0' ixz='0' iyy='0.03' iyz='0' izz='0.01'/></inertial></link>
            <link name='shank{k}'><inertial><origin xyz='0 0 -0.1'/><mass value='0.3'/>
            <inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>
            <joint name='hip{k}' type='spherical'><origin xyz='{x} {y} 0'/><parent link='trunk'/><child link='thigh{k}'/></joint>
            <joint name='knee{k}' type='continuous'><origin xyz='0 0 -0.4'/><parent link='thigh{k}'/><child link='shank{k}'/><axis xyz='0 1 0'/></joint>"
        )
    };
    let legs: String = (0..4).map(leg).collect();
    let urdf = format!(
        "<robot name='spider'><link name='trunk'><inertial><mass value='4'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>
        </link>{legs}</robot>"
    );
    let on = |effect, k: usize, p: Vec<f64>| Applied { effect, on: format!("hip{k}"), at: Default::default(), parameters: p };
    let effects: Vec<Applied> = (0..4)
        .flat_map(|k| {
            let x = k as f64;
            [on(EffectId::spring, k, vec![2.0 + x, 0.1 * x, 0.2, -0.3, 0.9]), on(EffectId::limit, k, vec![0.5 + 0.2 * x, 30.0, 0.1 * x])]
        })
        .collect();
    let options = Options { robot: RobotOptions { effects, ..RobotOptions::default() }, ..Options::default() };
    let wanted = |name: &str| ["inverse_dynamics", "forward_dynamics", "inverse_dynamics_derivatives"].contains(&name);
    let robot = with("spider".into(), &urdf, Base::Floating, false, options, wanted);
    assert!(robot.generated.ledger.functions.iter().any(|f| f.lanes == 4), "legs that are alike go in lanes");
    let compiled = Compiled::build_for(Processor::Own, &Rustc::find().expect("a compiler"), &robot.generated).expect("code that compiles");
    hold(&robot, 1e-12, |name, _, given, count| {
        let mut out = vec![0.0; count];
        compiled.call(name, given, &mut out).expect("a function");
        out
    });
}

/// A branch on an angle would be a branch on a value: generated code has none.
#[test]
fn numbers_of_springs_and_limits_of_balls_can_be_inputs() {
    let parameters = vec!["spring(hip)".into(), "limit(shoulder)".into()];
    let robot_options = RobotOptions { effects: effects(), ..RobotOptions::default() };
    let options = Options { robot: robot_options, parameters, ..Options::default() };
    let robot = with("balls".into(), URDF, Base::Fixed, false, options, |name| ["effect_forces", "potential_energy"].contains(&name));
    let mut changed = robot.case.model.clone();
    changed = changed.changed(|parts| {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        parts.bodies[BodyId(1)]
            .effects
            .joint
            .iter_mut()
            .filter(|e| e.effect == EffectId::spring)
            .for_each(|e| e.parameters = vec![5.0, half, 0.0, 0.0, half]);
        parts.bodies[BodyId(2)]
            .effects
            .joint
            .iter_mut()
            .filter(|e| e.effect == EffectId::limit)
            .for_each(|e| e.parameters = vec![0.2, 7.0, 0.1]);
    });
    // The quaternion of any length.
    let given = [5.0, 3.0, 0.0, 0.0, 3.0, 0.2, 7.0, 0.1];
    for (name, graph) in robot.functions().zip(&robot.generated.graphs) {
        let row = function::<f64>(name).expect("in the table");
        for state in states(&robot) {
            let mut arguments: Vec<&[f64]> = row.takes.iter().map(|a| state.argument(*a)).collect();
            let mut expected = vec![0.0; row.len(changed.shape())];
            row.call(&changed, &mut articulated_core::algorithm::Workspace::new(&changed), &arguments, &mut expected).expect("lengths");
            arguments.push(&given);
            let found = graph.evaluate(|argument, k| arguments[argument][k]);
            let scale = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            let far = expected.iter().zip(&found).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max);
            assert!(far < 1e-13 && expected.len() == found.len(), "{name}: {far:e}");
        }
    }
}
