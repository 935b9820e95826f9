//! Steps with actuators: the library's against closed forms and halved steps, generated code
//! against the library's, and their derivatives.

use articulated_codegen::lir::interpret::interpret;
use articulated_codegen::{COptions, Generated, Options, Real, Request, Target, generate};
use articulated_core::actuator::{Activation, ActuatorLaw, Actuators, Filter, Transmission};
use articulated_core::algorithm::{Workspace, difference, function, integrate};
use articulated_core::dual::Dual;
use articulated_core::model::Model;
use articulated_core::step::{of_actuators, order, step};
use articulated_tests::c_program;
use articulated_tests::case::cast;
use articulated_tests::random::Random;

/// Every kind of actuator, joints of one and three degrees, and tendons across branches.
const ACTUATED: &str = include_str!("../../mjcf/models/actuated.xml");
/// Actuators at frames, alone and against others.
const DRONE: &str = include_str!("../../mjcf/models/drone.xml");
/// q, v, act, ctrl, h.
type Given = [Vec<f64>; 5];

fn request(functions: &[&str], options: Options) -> Request {
    of_file("actuated.xml", ACTUATED, functions, options)
}

fn of_file(file: &str, text: &str, functions: &[&str], options: Options) -> Request {
    let mut request = Request::new(file, text);
    request.options = options;
    request.options.functions = functions.iter().map(|f| (*f).into()).collect();
    request
}

fn stepped(name: &str, model: &Model<f64>, [q, v, act, ctrl, h]: &Given) -> Vec<f64> {
    let (row, mut out) = (step(name).unwrap(), vec![0.0; model.nq() + model.nv() + model.actuators().activations()]);
    let all: [&[f64]; 5] = [q, v, act, ctrl, h];
    out.truncate(if row.takes.len() == 5 { out.len() } else { model.nv() });
    row.call(model, &mut Workspace::new(model), &all[..row.takes.len()], &mut out).unwrap();
    out
}

/// Arguments in some states: some controls and forces are at their bounds.
fn given(model: &Model<f64>, count: usize) -> Vec<Given> {
    let mut random = Random::new(11);
    let (nv, actuators) = (model.nv(), model.actuators());
    let state = |_| {
        let uniform: Vec<f64> = (0..model.nq()).map(|_| random.within(0.3, 0.7)).collect();
        let mut q = vec![0.0; model.nq()];
        function::<f64>("random_configuration").unwrap().call(model, &mut Workspace::new(model), &[&uniform], &mut q).unwrap();
        let act = random.vector(actuators.activations(), -0.5, 0.5);
        [q, random.vector(nv, -1.0, 1.0), act, random.vector(actuators.laws.len(), -1.0, 1.0), vec![2e-3]]
    };
    (0..count).map(state).collect()
}

/// The difference of two results, in the tangent space.
fn apart(model: &Model<f64>, one: &[f64], other: &[f64]) -> f64 {
    let (mut way, nq) = (vec![0.0; model.nv()], model.nq());
    let mut rest = 0;
    if one.len() > nq {
        difference(model, &mut Workspace::new(model), &one[..nq], &other[..nq], &mut way);
        rest = nq;
    }
    way.into_iter().chain(one[rest..].iter().zip(&other[rest..]).map(|(a, b)| a - b)).fold(0.0, |most, x| most.max(x.abs()))
}

fn assert_close(model: &Model<f64>, name: &str, given: &Given, found: &[f64]) {
    let expected = stepped(name, model, given);
    let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let far = apart(model, found, &expected);
    assert!(found.len() == expected.len() && far <= 1e-11 * scale, "{name}: {far:e} of {scale:e}");
}

/// Graphs and statements of generated functions against the library's functions of these names.
fn assert_generated(generated: &Generated, names: &[&str], states: usize) {
    let model = &generated.model;
    for (k, name) in names.iter().enumerate() {
        for given in given(model, states) {
            let input = |argument: usize, k: usize| given[argument][k];
            assert_close(model, name, &given, &generated.graphs[k].evaluate(input));
            for (_, body) in generated.bodies[k].all() {
                assert_close(model, name, &given, &interpret(body, input));
            }
        }
    }
}

/// A wheel on an axle with an inertia of 0.25 kg·m².
fn wheel(law: ActuatorLaw) -> Model<f64> {
    let urdf = "<robot name='wheel'><link name='base'/><link name='rim'><inertial><mass value='1'/>\
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='0.25'/></inertial></link>\
        <joint name='axle' type='continuous'><parent link='base'/><child link='rim'/><axis xyz='0 0 1'/></joint></robot>";
    let model = Request::new("wheel.urdf", urdf).build_robot().unwrap().model;
    let drives = vec![Transmission { gear: vec![2.0], ..Transmission::default() }];
    model.with_actuators(Actuators { laws: vec![ActuatorLaw { drives, ..law }], ..Actuators::default() })
}

/// f = 3 (u − l̇), l̇ = 2 v: v₁ (I + 12 h) = I v₀ + 6 h u, whatever the step; not at a bound of f.
#[test]
fn slopes_in_the_rate_are_implicit() {
    let servo = ActuatorLaw { gain: [3.0, 0.0, 0.0], bias: [0.0, 0.0, -3.0], force_range: Some([-9.0, 9.0]), ..ActuatorLaw::default() };
    let model = wheel(servo);
    for h in [1e-3, 0.1, 10.0] {
        let implicit = |u: f64| stepped("actuated_step_implicit_velocity", &model, &[vec![0.3], vec![0.5], vec![], vec![u], vec![h]]);
        let (found, expected) = (implicit(2.0), (0.25 * 0.5 + 6.0 * h * 2.0) / (0.25 + 12.0 * h));
        assert!((found[1] - expected).abs() < 1e-14 * expected && (found[0] - 0.3 - h * expected).abs() < 1e-13 * (1.0 + h), "{found:?}");
        let bounded = 0.5 + h * 2.0 * 9.0 / 0.25;
        assert!((implicit(50.0)[1] - bounded).abs() < 1e-12 * bounded);
    }
}

/// Closed forms of an activation with a held control, and the force of an early one.
#[test]
fn activations_follow_their_control() {
    let h: f64 = 0.05;
    let law = |filter, is_early| {
        let activation = Some(Activation { filter, range: Some([-0.4, 0.9]), is_early });
        wheel(ActuatorLaw { gain: [1.5, 0.0, 0.0], activation, control_range: Some([-1.0, 1.0]), ..ActuatorLaw::default() })
    };
    let cases = [
        (Filter::Integrator, 0.2 + h * 0.5),
        (Filter::Euler(0.1), 0.2 + h * 0.3 / 0.1),
        (Filter::Exact(0.1), 0.5 - 0.3 * (-h / 0.1).exp()),
    ];
    for (filter, expected) in cases {
        for is_early in [false, true] {
            let model = law(filter.clone(), is_early);
            let from =
                |u: f64, w: f64| stepped("actuated_step_semi_implicit_euler", &model, &[vec![0.0], vec![0.0], vec![w], vec![u], vec![h]]);
            let found = from(0.5, 0.2);
            assert!((found[2] - expected).abs() < 1e-15, "{filter:?}: {found:?} {expected}");
            let force = 1.5 * if is_early { expected } else { 0.2 };
            assert!((found[1] - h * 2.0 * force / 0.25).abs() < 1e-15, "{filter:?}: {found:?}");
            // The midpoint: exact for the exact filter, of the second order for the other.
            let given = [vec![0.0], vec![0.0], vec![0.2], vec![0.5], vec![h]];
            let middle = stepped("actuated_step_lie_midpoint", &model, &given)[2];
            let second = if matches!(filter, Filter::Euler(_)) { 0.2 + h * (0.3 - 0.3 * h / 0.2) / 0.1 } else { expected };
            assert!((middle - second).abs() < 1e-15, "{filter:?}: {middle} {second}");
            // Bounds of the control, then of the activation.
            assert_eq!(from(9.0, 0.2)[2].to_bits(), from(1.0, 0.2)[2].to_bits());
            assert_eq!(from(1.0, 0.89)[2], if matches!(filter, Filter::Integrator) { 0.9 } else { from(1.0, 0.89)[2].min(0.9) });
            assert_eq!(stepped("actuator_torques", &model, &[vec![0.0], vec![0.0], vec![0.2], vec![0.5], vec![]]), [2.0 * 1.5 * 0.2]);
        }
    }
}

/// Halved steps: the local error falls as the power of the order and one.
#[test]
fn errors_fall_with_the_order_of_the_method() {
    let mut model = generate(&request(&["kinetic_energy"], Options::default())).unwrap().model;
    // Bounds are corners, and exact filters and early forces do not depend on h as a method does.
    let mut smooth = model.actuators().clone();
    smooth.bounds.clear();
    for law in &mut smooth.laws {
        (law.control_range, law.force_range) = (None, None);
        if let Some(activation) = &mut law.activation {
            (activation.range, activation.is_early) = (None, false);
            if let Filter::Exact(time) = activation.filter {
                activation.filter = Filter::Euler(time);
            }
        }
    }
    model = model.with_actuators(smooth);
    let [q, v, act, ctrl, _] = given(&model, 1).remove(0);
    let after = |name: &str, h: f64, count: usize| {
        let mut at = [q.clone(), v.clone(), act.clone(), ctrl.clone(), vec![h / count as f64]];
        for _ in 0..count {
            let out = stepped(name, &model, &at);
            (at[0], at[1]) = (out[..model.nq()].to_vec(), out[model.nq()..][..model.nv()].to_vec());
            at[2] = out[model.nq() + model.nv()..].to_vec();
        }
        at[..3].concat()
    };
    for row in of_actuators::<f64>().iter().filter(|row| row.name != "actuator_torques") {
        let order = order(row);
        let error = |h: f64| apart(&model, &after(row.name, h, 1), &after("actuated_step_rk4", h, 64));
        // Servos of a light joint are fast: h is small beside the time in which they act.
        let (coarse, fine) = (error(2e-4), error(1e-4));
        let power = (coarse / fine).log2();
        assert!((power - f64::from(order + 1)).abs() < 0.35, "{}: h^{power:.2}, errors {coarse:e} {fine:e}", row.name);
    }
}

#[test]
fn graphs_and_statements_are_the_library() {
    let generated = generate(&request(
        &["actuators", "fixed = actuated_step_rk4(h = 0.002)"],
        Options { batch: vec![Real::F64], ..Options::default() },
    ))
    .unwrap();
    let names: Vec<&str> = generated.ledger.functions.iter().map(|entry| entry.function.as_str()).collect();
    let all: Vec<&str> = of_actuators::<f64>().iter().map(|row| row.name).collect();
    assert_eq!(names[..all.len()], all);
    let twins: Vec<&str> = names.iter().map(|name| if *name == "fixed" { "actuated_step_rk4" } else { name }).collect();
    assert_generated(&generated, &twins, 6);
    // Constants of the controls, and without them none.
    for part in ["pub const NU: usize = 12;", "pub const NA: usize = 6;", "\"servo\"", "pub act_next: [f64; NA],"] {
        assert!(generated.source.contains(part), "{part}");
    }
    let without = generate(&request(&["steps"], Options::default())).unwrap();
    assert!(!without.source.contains("NU: usize"));
}

/// The same of frames that are pushed, and the closed form of a drone: the thrusts are felt at its
/// centre, R Σ f along its axes.
#[test]
fn actuators_of_frames_push_bodies() {
    let generated =
        generate(&of_file("drone.xml", DRONE, &["actuators"], Options { batch: vec![Real::F64], ..Options::default() })).unwrap();
    let model = &generated.model;
    let names: Vec<&str> = of_actuators::<f64>().iter().map(|row| row.name).collect();
    assert_generated(&generated, &names, 3);
    let [q, v, act, mut ctrl, h] = given(model, 1).remove(0);
    let torques = |ctrl: &[f64]| stepped("actuator_torques", model, &[q.clone(), v.clone(), act.clone(), ctrl.to_vec(), h.clone()]);
    let before = torques(&ctrl);
    ctrl[3] = 3.0;
    let lower = torques(&ctrl);
    ctrl[3] = 4.5;
    let change: Vec<f64> = torques(&ctrl).iter().zip(&lower).map(|(a, b)| a - b).collect();
    // The right rotor is at (0.1, −0.1, 0.02) and pushes along z with a moment of 0.02 per newton.
    let expected = [1.5 * -0.1, 1.5 * -0.1, 1.5 * 0.02, 0.0, 0.0, 1.5];
    assert!(change.iter().zip(expected.into_iter().chain([0.0; 7])).all(|(a, b)| (a - b).abs() < 1e-14), "{change:?} {before:?}");
}

/// Four legs, computed side by side: their actuators have laws of their own, and two feet are
/// pushed.
#[test]
fn limbs_in_lanes_have_their_own_actuators() {
    let (mut legs, mut drives) = (String::new(), String::new());
    for (k, (x, y)) in [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)].into_iter().enumerate() {
        legs += &format!(
            "<body pos='{x} {y} 0'><joint name='hip{k}' axis='0 1 0' damping='0.1'/><inertial pos='0 0 -0.1' mass='0.6' diaginertia='0.004 0.004 0.001'/>\
             <body pos='0 0 -0.2'><joint name='knee{k}' axis='0 1 0'/><inertial pos='0 0 -0.1' mass='0.3' diaginertia='0.002 0.002 0.0005'/>\
             <site name='foot{k}' pos='0 0 -0.2'/></body></body>"
        );
        let gain = 10.0 + 3.0 * k as f64;
        drives += &format!(
            "<position joint='hip{k}' kp='{gain}' kv='0.4' timeconst='0.1'/><position joint='knee{k}' kp='8' kv='{}'/>",
            0.1 * k as f64
        );
    }
    let text = format!(
        "<mujoco><worldbody><body name='trunk'><freejoint/><inertial pos='0 0 0' mass='5' diaginertia='0.1 0.2 0.25'/>{legs}</body></worldbody>\
         <actuator>{drives}<motor site='foot1' gear='0 0 1 0 0 0'/><motor site='foot2' gear='1 0 0 0 0 0'/></actuator></mujoco>"
    );
    let generated = generate(&of_file("legs.xml", &text, &["actuators"], Options::default())).unwrap();
    assert!(generated.ledger.functions.iter().any(|entry| entry.lanes > 1), "limbs are computed side by side");
    let names: Vec<&str> = of_actuators::<f64>().iter().map(|row| row.name).collect();
    assert_generated(&generated, &names, 3);
}

/// A C program prints results alone and in a batch.
#[test]
fn compiled_steps_are_the_library() {
    let all: Vec<&str> = of_actuators::<f64>().iter().map(|row| row.name).collect();
    let options = Options { target: Target::C(COptions::default()), batch: vec![Real::F64], ..Options::default() };
    let generated = generate(&request(&all, options)).unwrap();
    let (model, given) = (&generated.model, given(&generated.model, 3));
    let list = |x: &[f64]| x.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let mut main = String::from("#include <stdio.h>\n#include \"actuated.h\"\nint main(void) {\n    double out[3][3 * ACTUATED_NQ];\n");
    for (k, name) in ["q", "v", "act", "ctrl", "h"].into_iter().enumerate() {
        let all: Vec<f64> = given.iter().flat_map(|given| given[k].clone()).collect();
        main += &format!("    const double {name}[] = {{{}}};\n", list(&all));
    }
    let sizes = [model.nq(), model.nv(), model.actuators().activations()];
    let (mut names, print) = (Vec::new(), |sizes: &[usize], n: usize| -> String {
        let one =
            |(k, size): (usize, &usize)| format!("    for (int i = 0; i < {}; i++) {{ printf(\"%.17g\\n\", out[{k}][i]); }}\n", n * size);
        sizes.iter().enumerate().map(one).collect()
    });
    for name in &all {
        let is_step = *name != "actuator_torques";
        let own = if is_step { &sizes[..] } else { &sizes[1..2] };
        let outputs = if is_step { "out[0], out[1], out[2]" } else { "out[0]" };
        for k in 0..given.len() {
            let h = if is_step { format!(", h + {k}") } else { String::new() };
            main += &format!(
                "    actuated_{name}(q + {k} * ACTUATED_NQ, v + {k} * ACTUATED_NV, act + {k} * ACTUATED_NA, ctrl + {k} * ACTUATED_NU{h}, \
                 {outputs});\n{}",
                print(own, 1)
            );
            names.push((*name, own, k, 1));
        }
        let h = if is_step { ", h" } else { "" };
        main += &format!("    actuated_{name}_batch_f64(3, q, v, act, ctrl{h}, {outputs});\n{}", print(own, 3));
        names.push((*name, own, 0, 3));
    }
    let printed = c_program::run_program(&(main + "    return 0;\n}\n"), &generated.files);
    let mut numbers = printed.lines().map(|line| line.parse::<f64>().unwrap());
    for (name, sizes, first, count) in names {
        let parts: Vec<Vec<f64>> = sizes.iter().map(|size| numbers.by_ref().take(count * size).collect()).collect();
        for k in 0..count {
            let found: Vec<f64> = parts.iter().zip(sizes).flat_map(|(part, size)| part[k * size..][..*size].to_vec()).collect();
            assert_close(model, name, &given[first + k], &found);
        }
    }
}

/// J d by dual numbers, and λᵀ J d from both sides, by state, activations, controls and h.
#[test]
fn derivatives_of_a_step_are_those_of_dual_numbers() {
    let rows = of_actuators::<f64>().iter().filter(|row| row.name != "actuator_torques" && !row.name.contains("rk4"));
    let of_drone = ("drone.xml", DRONE, "actuated_step_implicit_velocity");
    for (file, text, name) in rows.map(|row| ("actuated.xml", ACTUATED, row.name)).chain([of_drone]) {
        let functions = ["pull = vjp", "push = jvp"].map(|kind| format!("{kind}({name}, q v act ctrl h)"));
        let functions: Vec<&str> = functions.iter().map(String::as_str).collect();
        let generated = generate(&of_file(file, text, &functions, Options::default())).unwrap();
        let model = &generated.model;
        let (nq, nv, exact) = (model.nq(), model.nv(), model.cast::<Dual<f64>>());
        let mut random = Random::new(2);
        for given in given(model, 4) {
            let sizes = [nv, nv, given[2].len(), given[3].len(), 1];
            let direction = sizes.map(|size| random.vector(size, -1.0, 1.0));
            let mut moved: Vec<Vec<Dual<f64>>> = given.iter().map(|x| cast(x)).collect();
            let along: Vec<Dual<f64>> = direction[0].iter().map(|d| Dual::new(0.0, *d)).collect();
            let mut q = moved[0].clone();
            integrate(&exact, &mut Workspace::new(&exact), &moved[0], &along, &mut q);
            moved[0] = q;
            for k in 1..5 {
                moved[k].iter_mut().zip(&direction[k]).for_each(|(x, d)| x.slope = *d);
            }
            let slices: Vec<&[Dual<f64>]> = moved.iter().map(Vec::as_slice).collect();
            let mut out = vec![Dual::constant(0.0); nq + nv + given[2].len()];
            step(name).unwrap().call(&exact, &mut Workspace::new(&exact), &slices, &mut out).unwrap();
            let ends: Vec<Dual<f64>> = out[..nq].iter().map(|x| Dual::constant(x.value)).collect();
            let mut way = vec![Dual::constant(0.0); nv];
            difference(&exact, &mut Workspace::new(&exact), &ends, &out[..nq], &mut way);
            let expected: Vec<f64> = way.iter().chain(&out[nq..]).map(|x| x.slope).collect();
            let push =
                generated.graphs[1].evaluate(|argument, k| if argument < 5 { given[argument][k] } else { direction[argument - 5][k] });
            let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for (a, b) in push.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-9 * scale, "{name}: {a} {b}");
            }
            let weights = random.vector(expected.len(), -1.0, 1.0);
            let pull = generated.graphs[0].evaluate(|argument, k| match argument {
                0..5 => given[argument][k],
                5 => weights[k],
                6 => weights[nv + k],
                _ => weights[2 * nv + k],
            });
            let left: f64 = pull.iter().zip(direction.iter().flatten()).map(|(a, b)| a * b).sum();
            let right: f64 = expected.iter().zip(&weights).map(|(a, b)| a * b).sum();
            assert!((left - right).abs() < 1e-9 * scale * nv as f64, "{name}: {left} {right}");
        }
    }
}

#[test]
fn a_robot_without_actuators_has_no_step_of_them() {
    let mut request = Request::new("walker.urdf", include_str!("../../robots/walker.urdf"));
    request.options.functions = vec!["actuated_step_rk4".into()];
    let error = generate(&request).err().unwrap().to_string();
    assert!(error.contains("actuator"), "{error}");
}
