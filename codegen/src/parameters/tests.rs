//! With the parameters of another robot, a robot becomes that robot.

use super::*;
use crate::Request;
use crate::function_spec::FunctionSpec;
use crate::program::Strategy;
use crate::trace::{trace, ways};

/// A table that slides and turns in a plane, and on it an arm with a tool; these numbers are the
/// robot's.
fn robot([origin, mass, com, shoulder]: [&str; 4]) -> Request {
    let inertial = |mass: &str, com: &str| {
        format!(
            "<inertial><origin xyz='{com}' rpy='0.3 0.1 -0.2'/><mass value='{mass}'/>\
             <inertia ixx='0.3' ixy='0.01' ixz='0.02' iyy='0.4' iyz='-0.01' izz='0.5'/></inertial>"
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, xyz: &str| {
        format!(
            "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><origin xyz='{xyz}' rpy='0.4 -0.7 1.1'/>\
             <axis xyz='0 0.6 0.8'/></joint>"
        )
    };
    let links = ["ground", "rail"].map(|name| format!("<link name='{name}'/>")).concat()
        + &["table", "arm"].map(|name| format!("<link name='{name}'>{}</link>", inertial("1.5", "0.1 0 0.2"))).concat()
        + &format!("<link name='tool'>{}</link>", inertial(mass, com));
    let joints = joint("foot", "fixed", "ground", "rail", "0.1 0.2 0.3")
        + &joint("slide", "planar", "rail", "table", origin)
        + &joint("shoulder", "continuous", "table", "arm", shoulder)
        + &joint("grip", "fixed", "arm", "tool", "0.3 0.1 -0.2");
    Request::new("robot.urdf", format!("<robot name='robot'>{links}{joints}</robot>"))
}

/// The model without the numbers that stay inputs.
fn read(request: &Request, list: &[&str]) -> (Model<f64>, Vec<Parameter>) {
    let mut robot = request.build_robot().unwrap();
    let parameters = parsed(&mut robot, list, &[]).unwrap();
    (request.robot().model_of(&robot).unwrap(), parameters)
}

/// The parameters of a list, or all that is wrong with it.
fn parsed(robot: &mut BuiltRobot, list: &[&str], rename: &[(&str, &str)]) -> Result<Vec<Parameter>, String> {
    let parameters = list.iter().map(|one| (*one).into()).collect();
    let rename = rename.iter().map(|(from, to)| ((*from).to_owned(), (*to).to_owned()).into()).collect();
    let mut log = Diagnostics::default();
    let parameters = parse(&Options { parameters, rename, ..Options::default() }, robot, &mut log);
    log.result(parameters).map_err(|findings| findings.to_string())
}

#[test]
fn the_numbers_of_another_robot_make_it_that_robot() {
    const LIST: [&str; 3] = ["origin(slide)", "inertia(tool)", "origin(\"shoulder\")"];
    let here = robot(["0.1 0.5 -0.3", "2", "0.05 0.2 0.1", "0 0 0.4"]);
    let there = robot(["-0.4 0.2 0.7", "3.5", "-0.1 0.3 0.2", "0.6 -0.1 0.2"]);
    let numbers = nominal(&there, &LIST);
    held(["inverse_dynamics", "placements", "potential_energy"], (&here, &LIST), &numbers, &there);
}

/// The nominal parameters of a request.
fn nominal(request: &Request, list: &[&str]) -> Vec<f64> {
    read(request, list).1.into_iter().flat_map(|p| p.nominal).collect()
}

fn input(argument: usize, k: usize) -> f64 {
    (argument * 5 + k * 3) as f64 * 0.37 % 1.9 - 0.8
}

/// With these numbers in place of its own, one robot equals the other, before and after passes.
fn held<const N: usize>(functions: [&str; N], (here, list): (&Request, &[&str]), numbers: &[f64], there: &Request) {
    let (model, parameters) = read(here, list);
    for name in functions {
        let spec = FunctionSpec::parse(name).unwrap();
        for passes in [0, usize::MAX] {
            let strategy = [Strategy::plain(ways(&spec.parts[0], &model)[0].0, passes)];
            let found = trace(&spec, &strategy, &model, &parameters);
            let expected = trace(&spec, &strategy, &read(there, &[]).0, &[]);
            let given = |argument: usize, k: usize| if argument == spec.arguments().len() { numbers[k] } else { input(argument, k) };
            for (found, expected) in found.evaluate(given).into_iter().zip(expected.evaluate(input)) {
                assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{name}: {found} {expected}");
            }
        }
    }
}

/// On a joint of several bodies too.
#[test]
fn other_gravity_and_other_effects_are_those_of_a_request_that_asks_for_them() {
    let robot = |gravity: [f64; 3], numbers: [f64; 5]| {
        let mut request = robot(["0.1 0.5 -0.3", "2", "0.05 0.2 0.1", "0 0 0.4"]);
        let on = |effect, on: &str, parameters: &[f64]| crate::Applied {
            effect,
            on: on.into(),
            at: crate::Origin::default(),
            parameters: parameters.to_vec(),
        };
        let [damping, loss, speed, inertia, ratio] = numbers;
        request.options.robot.gravity = Some(gravity);
        request.options.robot.effects = vec![
            on(EffectId::damping, "slide", &[damping]),
            on(EffectId::friction, "shoulder", &[loss, speed]),
            on(EffectId::armature, "shoulder", &[inertia, ratio]),
            on(EffectId::damping, "shoulder", &[0.4]),
            on(EffectId::drag, "table", &[0.3]),
            // On one body with what stays an input, and on one link with it.
            on(EffectId::drag, "arm", &[0.6]),
            on(EffectId::drag, "tool", &[loss]),
            on(EffectId::contact, "arm", &[0.05, 1e3 * inertia, damping, loss, 0.01, 0.0, 0.6, 0.8, 9.0, loss]),
        ];
        request
    };
    let list = ["damping(slide)", "gravity", "friction(shoulder)", "armature(\"shoulder\")", "drag(tool)", "contact(arm)"];
    let here = robot([0.0, 0.0, -9.81], [0.5, 0.2, 0.01, 0.03, 10.0]);
    let there = robot([0.3, -1.6, 0.7], [1.5, 0.7, 0.2, 0.02, -30.0]);
    assert_eq!(read(&here, &list).1[1].nominal, [0.0, 0.0, -9.81]);
    let mut numbers = nominal(&there, &list);
    // The contact's normal; the height and the time of its damping follow it.
    let n = numbers.len();
    numbers[n - 5..n - 2].iter_mut().for_each(|x| *x *= 3.0);
    let functions = ["inverse_dynamics", "forward_dynamics", "effect_forces", "potential_energy", "inverse_dynamics_derivatives"];
    held(functions, (&here, &list), &numbers, &there);
}

#[test]
fn a_payload_is_added_to_what_the_link_has() {
    let request = robot(["0.1 0.5 -0.3", "2", "0.05 0.2 0.1", "0 0 0.4"]);
    let own = read(&request, &["inertia(tool)"]).1.remove(0).nominal;
    let spec = FunctionSpec::parse("inverse_dynamics").unwrap();
    let values = |list: &[&str], factor: f64| {
        let (model, parameters) = read(&request, list);
        let strategy = [Strategy::plain(ways(&spec.parts[0], &model)[0].0, usize::MAX)];
        trace(&spec, &strategy, &model, &parameters)
            .evaluate(|argument, k| if argument == 3 { factor * own[k] } else { input(argument, k) })
    };
    for (twice, with) in values(&["inertia(tool)"], 2.0).into_iter().zip(values(&["payload(tool)"], 1.0)) {
        assert!((twice - with).abs() < 1e-12 * (1.0 + twice.abs()), "{twice} {with}");
    }
    assert_eq!(read(&request, &["payload(tool)"]).1[0].nominal, [0.0; PARAMETERS]);
}

#[test]
fn what_there_is_not_is_told_with_what_was_meant() {
    let request = robot(["0 0 0", "2", "0 0 0", "0 0 0"]);
    let mut robot = request.build_robot().unwrap();
    let mut told = |one: &str| parsed(&mut robot, &[one], &[]).map(drop).unwrap_err();
    for (one, said) in [
        ("payload(tol)", "there is no link \"tol\", did you mean \"tool\"?"),
        ("inertia(slide)", "there is no link \"slide\""),
        ("origin(slid)", "there is no joint \"slid\", did you mean \"slide\"?"),
        ("origin(grip)", "joint \"grip\" does not move; only the origin of a moving joint can stay an input"),
        ("payload(ground)", "link \"ground\" is fixed to the base: no function depends on it"),
        ("inertia(rail)", "link \"rail\" is fixed to the base: no function depends on it"),
        ("mass(tool)", EXPECTED),
        ("payload(tool", EXPECTED),
        ("drag(tol)", "there is no link \"tol\", did you mean \"tool\"?"),
        ("damping(grip)", "there is no joint \"grip\" that moves"),
    ] {
        assert_eq!(told(one), format!("parameters: `{one}`: {said}"));
    }
    let mut request = request;
    request.options.parameters = ["damping(shoulder)", " friction(shoulder)", "gravity"].map(Into::into).to_vec();
    let friction = |loss: f64| Applied {
        effect: EffectId::friction,
        on: "shoulder".into(),
        at: crate::Origin::default(),
        parameters: vec![loss, 0.01],
    };
    request.options.robot.effects = vec![friction(0.0)];
    let off = |kind: &str| {
        format!(
            "parameters: `{kind}(shoulder)`: {kind} is off on joint \"shoulder\"; ask for it among `effects` with numbers that are not all 0"
        )
    };
    let told = |request: &Request| crate::generate(request).unwrap_err().to_string();
    assert_eq!(told(&request), [off("damping"), off("friction")].join("\n"));
    request.options.robot.effects = vec![friction(0.3)];
    assert_eq!(told(&request), off("damping"));
    // Of two effects of one kind on a link, the parameter would be ambiguous.
    let drag = Applied { effect: EffectId::drag, on: "tool".into(), at: crate::Origin::default(), parameters: vec![0.1] };
    request.options.robot.effects = vec![drag.clone(), drag];
    request.options.parameters = vec!["drag(tool)".into(), "drag(arm)".into()];
    let expected = ["drag(tool)`: there are 2 on link \"tool\", expected one", "drag(arm)`: drag is off on link \"arm\"; ask"];
    assert!(expected.iter().all(|words| told(&request).contains(words)), "{}", told(&request));
}

#[test]
fn two_that_have_one_name_in_rust_are_refused() {
    let request = robot(["0 0 0", "2", "0 0 0", "0 0 0"]);
    let list = ["payload(tool)", "payload(\"tool\")"];
    let told = parsed(&mut request.build_robot().unwrap(), &list, &[]).map(drop).unwrap_err();
    assert_eq!(told, "parameters: `payload(\"tool\")`: is there twice, expected once");
    // Constants of Rust have one case.
    let mut request = request;
    request.document = String::from_utf8(request.document).unwrap().replace("'table'", "'TOOL'").into_bytes();
    let mut robot = request.build_robot().unwrap();
    let mut told = |list: [&str; 2]| parsed(&mut robot, &list, &[]).err();
    assert!(told(["payload(tool)", "payload(TOOL)"]).is_some_and(|told| told.contains("is TOOL_PAYLOAD in Rust, as the")));
    assert_eq!(told(["payload(tool)", "inertia(TOOL)"]), None);
    // As for all constants of a joint or link, another name in Rust distinguishes them.
    let names = parsed(&mut robot, &["payload(tool)", "payload(TOOL)", "gravity"], &[("TOOL", "TABLE")]);
    let names = names.map(|all| all.iter().map(|p| identifier(&p.name)).collect::<Vec<_>>());
    assert_eq!(names.unwrap(), ["TOOL_PAYLOAD", "TABLE_PAYLOAD", "GRAVITY"]);
}
