//! Whole steps of time: the library's against simulations, closed forms and halved steps, generated
//! code against the library's, and their derivatives.

use articulated::simulate::{IntegratorId, Settings, Simulation};
use articulated_codegen::ledger::Entry;
use articulated_codegen::lir::interpret::interpret;
use articulated_codegen::{COptions, Options, Real, Request, Target, generate};
use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, UserFunction, Workspace, difference, function, integrate};
use articulated_core::description::{Base, Coupling, Origin};
use articulated_core::dual::Dual;
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;
use articulated_core::step::{order, step, steps};
use articulated_core::user_function;
use articulated_tests::c_program;
use articulated_tests::case::{Case, State, cast, read};
use articulated_tests::random::Random;
use articulated_tests::random_tree::{Flavour, random_tree};

const WALKER: &str = include_str!("../../robots/walker.urdf");

/// A floating robot with limbs, with damped joints.
fn request(functions: &[&str], options: Options) -> Request {
    let mut request = Request::new("walker.urdf", WALKER);
    request.options = options;
    request.options.robot.base = Base::Floating;
    request.options.functions = functions.iter().map(|f| (*f).into()).collect();
    let joints =
        read(WALKER).joints.iter().filter(|joint| !joint.kind.coordinates().is_empty()).map(|joint| joint.name.clone()).collect::<Vec<_>>();
    let damping = |on: String| Applied { effect: EffectId::damping, on, at: Origin::default(), parameters: vec![0.7] };
    request.options.robot.effects.extend(joints.into_iter().map(damping));
    request
}

fn stepped(name: &str, model: &Model<f64>, [q, v, tau]: [&[f64]; 3], h: f64) -> (Vec<f64>, Vec<f64>) {
    let mut out = vec![0.0; model.nq() + model.nv()];
    step(name).unwrap().call(model, &mut Workspace::new(model), &[q, v, tau, &[h]], &mut out).unwrap();
    let v = out.split_off(model.nq());
    (out, v)
}

/// The difference of two states, in the tangent space.
fn apart(model: &Model<f64>, one: &(Vec<f64>, Vec<f64>), other: &(Vec<f64>, Vec<f64>)) -> f64 {
    let mut way = vec![0.0; model.nv()];
    difference(model, &mut Workspace::new(model), &one.0, &other.0, &mut way);
    let rates = one.1.iter().zip(&other.1).map(|(a, b)| a - b);
    way.iter().copied().chain(rates).fold(0.0, |most, x| most.max(x.abs()))
}

fn state(model: &Model<f64>, random: &mut Random) -> State {
    let uniform: Vec<f64> = (0..model.nq()).map(|_| random.within(0.0, 1.0)).collect();
    let mut q = vec![0.0; model.nq()];
    function::<f64>("random_configuration").unwrap().call(model, &mut Workspace::new(model), &[&uniform], &mut q).unwrap();
    State::new(q, random.vector(model.nv(), -1.0, 1.0), random.vector(model.nv(), -1.0, 1.0))
}

#[test]
fn steps_are_those_of_simulations() {
    for seed in 0..20 {
        let base = if seed % 2 == 0 { Base::Floating } else { Base::Fixed };
        let description = random_tree(seed, Flavour { massless: false, ..Flavour::WRITTEN });
        let model = Model::<f64>::new(&description, base).unwrap();
        let State { q, v, a: tau, .. } = state(&model, &mut Random::new(seed));
        for (name, integrator) in [
            ("step_semi_implicit_euler", IntegratorId::semi_implicit_euler),
            ("step_lie_midpoint", IntegratorId::lie_midpoint),
            ("step_rk4", IntegratorId::rk4),
        ] {
            let h = 1e-3;
            let settings = Settings { integrator, step: Some(h), end: 1.0, ..Settings::default() };
            let mut simulation = Simulation::new(&model, settings).unwrap();
            simulation.start(&q, &v).unwrap();
            assert!(simulation.step(&mut |_: f64, _: &[f64], _: &[f64], out: &mut [f64]| out.copy_from_slice(&tau)).unwrap());
            let expected = (simulation.q().to_vec(), simulation.v().to_vec());
            let found = stepped(name, &model, [&q, &v, &tau], h);
            let scale = expected.1.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            let far = apart(&model, &found, &expected);
            assert!(far < 1e-11 * scale, "{name}, tree {seed}: {far:e} of {scale:e}");
        }
    }
}

/// A body that turns about its middle axis, and flips, for 4000 steps of 10 ms.
#[test]
fn the_midpoint_keeps_momentum_and_energy_of_a_free_body() {
    let urdf = "<robot name='body'><link name='body'><inertial><origin xyz='0.1 0 0'/><mass value='2'/>\
        <inertia ixx='1' ixy='0' ixz='0' iyy='2' iyz='0' izz='2.5'/></inertial></link></robot>";
    let model = Model::<f64>::new(&read(urdf), Base::Floating).unwrap().with_gravity([0.0; 3]);
    let invariants = |(q, v): &(Vec<f64>, Vec<f64>)| {
        let call = |name: &str, inputs: &[&[f64]], n: usize| {
            let mut out = vec![0.0; n];
            function::<f64>(name).unwrap().call(&model, &mut Workspace::new(&model), inputs, &mut out).unwrap();
            out
        };
        [call("kinetic_energy", &[q, v], 1), call("centroidal_momentum", &[q, v], 6)].concat()
    };
    let mut at = (vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], vec![0.01, 3.0, 0.02, 0.1, -0.2, 0.3]);
    let first = invariants(&at);
    let mut least = f64::INFINITY;
    for _ in 0..4000 {
        at = stepped("step_lie_midpoint", &model, [&at.0, &at.1, &[0.0; 6]], 0.01);
        least = least.min(at.1[1]);
    }
    assert!(least < -2.9, "it flips: {least}");
    let scale = first.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let worst = invariants(&at).iter().zip(&first).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(worst < 1e-11 * scale, "{worst:e} of {scale:e}");
    // A step that is too long does not converge, and is marked.
    let (_, v) = stepped("step_lie_midpoint", &model, [&at.0, &at.1, &[0.0, 0.0, 0.0, 0.0, 9.0, 0.0]], 10.0);
    assert!(v.iter().all(|v| !v.is_finite()), "{v:?}");
}

/// Halved steps: the local error falls as the power of the order and one.
#[test]
fn errors_fall_with_the_order_of_the_method() {
    let model = generate(&request(&["kinetic_energy"], Options::default())).unwrap().model;
    let State { q, v, a: tau, .. } = state(&model, &mut Random::new(4));
    let reference = |h: f64| {
        let mut at = (q.clone(), v.clone());
        (0..64).for_each(|_| at = stepped("step_rk4", &model, [&at.0, &at.1, &tau], h / 64.0));
        at
    };
    for name in ALL {
        let order = order(step::<f64>(name).unwrap());
        let error = |h: f64| apart(&model, &stepped(name, &model, [&q, &v, &tau], h), &reference(h));
        let (coarse, fine) = (error(4e-3), error(2e-3));
        let power = (coarse / fine).log2();
        assert!((power - f64::from(order + 1)).abs() < 0.35, "{name}: h^{power:.2}, errors {coarse:e} {fine:e}");
    }
}

/// A wheel of inertia I on an axle with damping d: v₁ (I + h d) = I v₀ + h τ, whatever the step.
#[test]
fn damping_is_implicit() {
    let urdf = "<robot name='wheel'><link name='base'/><link name='rim'><inertial><mass value='1'/>\
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='0.25'/></inertial></link>\
        <joint name='axle' type='continuous'><parent link='base'/><child link='rim'/><axis xyz='0 0 1'/></joint></robot>";
    let mut request = Request::new("wheel.urdf", urdf);
    request.options.robot.effects.push(Applied {
        effect: EffectId::damping,
        on: "axle".into(),
        at: Origin::default(),
        parameters: vec![8.0],
    });
    let model = request.build_robot().unwrap().model;
    for (h, name) in [(1e-3, "step_implicit_damping"), (0.1, "step_implicit_velocity"), (10.0, "step_implicit_damping")] {
        let (q, v) = stepped(name, &model, [&[0.3], &[2.0], &[0.5]], h);
        let expected = (0.25 * 2.0 + h * 0.5) / (0.25 + h * 8.0);
        assert!((v[0] - expected).abs() < 1e-14 && (q[0] - 0.3 - h * expected).abs() < 1e-13, "{q:?} {v:?} {expected}");
        let explicit = stepped("step_semi_implicit_euler", &model, [&[0.3], &[2.0], &[0.5]], h).1[0];
        assert!((explicit - (2.0 + h * (0.5 - 16.0) / 0.25)).abs() < 1e-11 * explicit.abs());
    }
}

/// A ball of mass m in a medium, drag −(c |v| + b) v along each axis and damping d of its free joint:
/// v₁ − v₀ = −h (c |v₀| + b + d) v₀/(m + h (2 c |v₀| + b + d)), whatever the step.
#[test]
fn the_medium_and_the_damping_of_a_free_joint_are_implicit() {
    let mjcf = "<mujoco><option gravity='0 0 0' density='300' viscosity='40'/><worldbody><body name='ball'>\
        <joint name='free' type='free' damping='0.7'/><geom size='0.2' mass='3'/></body></worldbody></mujoco>";
    let mut request = Request::new("ball.xml", mjcf);
    // The box of a ball's inertia: its sides are r √(12/5).
    let side = 0.2 * (12.0_f64 / 5.0).sqrt();
    let (c, b, d) = (0.5 * 300.0 * side * side, 3.0 * std::f64::consts::PI * side * 40.0, 0.7);
    let world = request.build_robot().unwrap().reading.world;
    assert_eq!(world.effects.len(), 1);
    request.options.robot.effects = world.effects.into_iter().map(|(effect, _)| effect).collect();
    let (on, at) = ("free".to_owned(), Origin::default());
    request.options.robot.effects.push(Applied { effect: EffectId::damping, on, at, parameters: vec![d] });
    let model = request.build_robot().unwrap().model;
    let q = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    for h in [1e-3, 0.3, 20.0] {
        let v0 = [1.5, -0.5];
        let (_, v) = stepped("step_implicit_velocity", &model, [&q, &[0.0, 0.0, 0.0, v0[0], v0[1], 0.0], &[0.0; 6]], h);
        for (k, v0) in v0.into_iter().enumerate() {
            let expected = v0 - h * (c * f64::abs(v0) + b + d) * v0 / (3.0 + h * (2.0 * c * f64::abs(v0) + b + d));
            assert!((v[3 + k] - expected).abs() < 1e-14, "{h}: {v:?} {expected}");
        }
        // Damping of joints alone
        let (_, v) = stepped("step_implicit_damping", &model, [&q, &[0.0, 0.0, 0.0, v0[0], v0[1], 0.0], &[0.0; 6]], h);
        let expected = v0[0] - h * (c * v0[0] + b + d) * v0[0] / (3.0 + h * d);
        assert!((v[3] - expected).abs() < 1e-13 * expected.abs().max(1.0), "{h}: {v:?} {expected}");
    }
}

/// A body that turns alone and without forces: (I + h ∂b/∂ω) Δω = −h ω × I ω, b = ω × I ω.
#[test]
fn the_gyroscopic_force_of_a_body_alone_is_implicit() {
    let urdf = "<robot name='top'><link name='top'><inertial><mass value='2'/>\
        <inertia ixx='0.3' ixy='0' ixz='0' iyy='0.5' iyz='0' izz='0.7'/></inertial></link></robot>";
    let model = Case::new("top", read(urdf), Base::Floating).with_gravity([0.0; 3]).model;
    let (w, i) = ([4.0, -6.0, 9.0], [0.3, 0.5, 0.7]);
    let q = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    for h in [1e-3, 0.05] {
        let (_, v) = stepped("step_implicit_velocity", &model, [&q, &[w[0], w[1], w[2], 0.0, 0.0, 0.0], &[0.0; 6]], h);
        let d = [v[0] - w[0], v[1] - w[1], v[2] - w[2]];
        for k in 0..3 {
            let (one, other) = ((k + 1) % 3, (k + 2) % 3);
            let moment = i[other] - i[one];
            // b_k = (I_other − I_one) ω_one ω_other, and its slope along Δω.
            let slope = moment * (d[one] * w[other] + w[one] * d[other]);
            let rest = i[k] * d[k] + h * slope + h * moment * w[one] * w[other];
            assert!(rest.abs() < 1e-13, "{h}: {rest:e}");
        }
    }
}

/// A stone that turns, without gravity: every method keeps the velocity of its centre.
#[test]
fn a_free_body_keeps_its_velocity() {
    let urdf = "<robot name='stone'><link name='stone'><inertial><mass value='2'/>\
        <inertia ixx='0.3' ixy='0' ixz='0' iyy='0.5' iyz='0' izz='0.7'/></inertial></link></robot>";
    let case = Case::new("stone", read(urdf), Base::Floating).with_gravity([0.0; 3]);
    let model = &case.model;
    let (mut q, mut v) = (vec![0.0; 7], vec![3.0, -2.0, 1.0, 0.5, 0.25, -1.0]);
    (q[6], v[3]) = (1.0, 0.5);
    for row in steps::<f64>() {
        let mut at = (q.clone(), v.clone());
        (0..100).for_each(|_| at = stepped(row.name, model, [&at.0, &at.1, &[0.0; 6]], 1e-2));
        let expected = [0.5, 0.25, -1.0];
        let far = (0..3).map(|k| (at.0[k] - expected[k]).abs()).fold(0.0, f64::max);
        // The position is a sum of steps; in these methods the error of the rotation turns them.
        let allowed = match row.name {
            "step_rk4" => 1e-5,
            "step_lie_midpoint" => 1e-3,
            _ => 1e-12,
        };
        assert!(far < allowed, "{}: {far:e}", row.name);
    }
}

const ALL: [&str; 6] =
    ["step_semi_implicit_euler", "step_implicit_damping", "step_implicit_velocity", "step_lie_midpoint", "step_rk4", "step_rk4_mujoco"];

/// Arguments of a step in some states.
fn given(model: &Model<f64>, count: usize) -> Vec<[Vec<f64>; 4]> {
    let mut random = Random::new(9);
    let of = |state: State| [state.q, state.v, state.a, vec![2e-3]];
    (0..count).map(|_| of(state(model, &mut random))).collect()
}

fn assert_steps(model: &Model<f64>, name: &str, given: &[Vec<f64>; 4], found: &[f64], allowed: f64) {
    let expected = stepped(name, model, [&given[0], &given[1], &given[2]], given[3][0]);
    let found = (found[..model.nq()].to_vec(), found[model.nq()..].to_vec());
    let scale = expected.1.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let far = apart(model, &found, &expected);
    assert!(far <= allowed * scale, "{name}: {far:e} of {scale:e}");
}

#[test]
fn graphs_and_statements_are_the_library() {
    let generated =
        generate(&request(&["steps", "fixed = step_rk4(h = 0.002)"], Options { batch: vec![Real::F64], ..Options::default() })).unwrap();
    let names: Vec<&str> = generated.ledger.functions.iter().map(|entry| entry.function.as_str()).collect();
    assert_eq!(names[..ALL.len()], ALL);
    // A loop has no limbs.
    let is_loop = |entry: &&Entry| entry.function == "step_lie_midpoint";
    assert!(
        generated.ledger.functions.iter().filter(|entry| !is_loop(entry)).all(|entry| entry.lanes > 1),
        "limbs are computed side by side"
    );
    let model = &generated.model;
    for (k, name) in names.iter().enumerate() {
        let twin = if *name == "fixed" { "step_rk4" } else { name };
        for given in given(model, 3) {
            let input = |argument: usize, k: usize| given[argument][k];
            assert_steps(model, twin, &given, &generated.graphs[k].evaluate(input), 1e-11);
            for (_, body) in generated.bodies[k].all() {
                assert_steps(model, twin, &given, &interpret(body, input), 1e-11);
            }
        }
    }
}

/// The velocity of a free joint is the rate of its position, quaternions begin with w, and the way
/// back ends where it began.
#[test]
fn states_of_mujoco_are_translated() {
    let call = |name: &str, model: &Model<f64>, inputs: [&[f64]; 2]| {
        let mut out = vec![0.0; model.nq() + model.nv()];
        step(name).unwrap().call(model, &mut Workspace::new(model), &inputs, &mut out).unwrap();
        let rates = out.split_off(model.nq());
        (out, rates)
    };
    let h = 1e-6;
    for seed in 0..10 {
        let description = random_tree(seed, Flavour { massless: false, ..Flavour::WRITTEN });
        let model = Model::new(&description, Base::Floating).unwrap();
        let state = state(&model, &mut Random::new(seed));
        let (qpos, qvel) = call("mujoco_state", &model, [&state.q, &state.v]);
        assert_eq!(qpos[3..7], [state.q[6], state.q[3], state.q[4], state.q[5]]);
        assert_eq!(qvel[3..6], state.v[..3]);
        let moved = |h: f64| {
            let step: Vec<f64> = state.v.iter().map(|v| h * v).collect();
            let mut q = vec![0.0; model.nq()];
            integrate(&model, &mut Workspace::new(&model), &state.q, &step, &mut q);
            call("mujoco_state", &model, [&q, &state.v]).0
        };
        let (after, before) = (moved(h), moved(-h));
        for k in 0..3 {
            let rate = (after[k] - before[k]) / (2.0 * h);
            assert!((rate - qvel[k]).abs() < 1e-8, "seed {seed}: {rate} {}", qvel[k]);
        }
        let (q, v) = call("state_of_mujoco", &model, [&qpos, &qvel]);
        assert_eq!(q, state.q);
        assert!(v.iter().zip(&state.v).all(|(a, b)| (a - b).abs() < 1e-14), "seed {seed}");
    }
}

/// Parallel joints, floating bases, balls: every strategy that a bundled robot has.
#[test]
fn steps_of_bundled_robots_are_the_library() {
    for robot in articulated_models::ROBOTS {
        let mut request = Request::new(format!("{}.urdf", robot.name), robot.urdf);
        request.options.robot.base = robot.base;
        request.options.functions = vec!["step_implicit_damping".into(), "step_rk4".into(), "step_rk4_mujoco".into()];
        let generated = generate(&request).unwrap();
        let model = &generated.model;
        for (k, graph) in generated.graphs.iter().enumerate() {
            let name = generated.ledger.functions[k].function.as_str();
            for given in given(model, 2) {
                let input = |argument: usize, k: usize| given[argument][k];
                assert_steps(model, name, &given, &graph.evaluate(input), 1e-10);
            }
        }
    }
}

/// Results are a struct in Rust, and arrays in C, where a program prints them.
#[test]
fn compiled_steps_are_the_library() {
    let rust = generate(&request(&ALL, Options::default())).unwrap();
    for part in ["pub struct StepRk4 {", "pub q_next: [f64; NQ],", "pub v_next: [f64; NV],"] {
        assert!(rust.source.contains(part), "{part}");
    }
    let options = Options { target: Target::C(COptions::default()), batch: vec![Real::F64], ..Options::default() };
    let generated = generate(&request(&ALL, options)).unwrap();
    let (model, given) = (&generated.model, given(&generated.model, 3));
    let list = |x: &[f64]| x.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let mut main = String::from(
        "#include <stdio.h>\n#include \"walker.h\"\nint main(void) {\n    double q_next[3 * WALKER_NQ], v_next[3 * WALKER_NV];\n",
    );
    let (mut names, print) = (Vec::new(), |n: &str| {
        format!(
            "    for (int i = 0; i < {n} * WALKER_NQ; i++) {{ printf(\"%.17g\\n\", q_next[i]); }}\n    \
             for (int i = 0; i < {n} * WALKER_NV; i++) {{ printf(\"%.17g\\n\", v_next[i]); }}\n"
        )
    });
    for (k, name) in ["q", "v", "tau", "h"].into_iter().enumerate() {
        let all: Vec<f64> = given.iter().flat_map(|given| given[k].clone()).collect();
        main += &format!("    const double {name}[] = {{{}}};\n", list(&all));
    }
    for name in ALL {
        for k in 0..given.len() {
            main += &format!(
                "    walker_{name}(q + {k} * WALKER_NQ, v + {k} * WALKER_NV, tau + {k} * WALKER_NV, h + {k}, q_next, v_next);\n{}",
                print("1")
            );
            names.push((name, k, 1));
        }
        main += &format!("    walker_{name}_batch_f64(3, q, v, tau, h, q_next, v_next);\n{}", print("3"));
        names.push((name, 0, 3));
    }
    let printed = c_program::run_program(&(main + "    return 0;\n}\n"), &generated.files);
    let mut numbers = printed.lines().map(|line| line.parse::<f64>().unwrap());
    for (name, first, count) in names {
        let q: Vec<f64> = numbers.by_ref().take(count * model.nq()).collect();
        let v: Vec<f64> = numbers.by_ref().take(count * model.nv()).collect();
        for k in 0..count {
            let found = [&q[k * model.nq()..][..model.nq()], &v[k * model.nv()..][..model.nv()]].concat();
            assert_steps(model, name, &given[first + k], &found, 1e-11);
        }
    }
}

/// λᵀ J d from both sides, and J d by dual numbers; A and B of x₁ = f(x, u) are the Jacobian.
#[test]
fn derivatives_of_a_step_are_those_of_dual_numbers() {
    let short = |name: &&&str| !name.contains("rk4") && !name.contains("midpoint");
    for (name, follows) in ALL.iter().map(|name| (*name, false)).chain(ALL.iter().filter(short).map(|name| (*name, true))) {
        // Matrices of four stages, and of a loop, are long, and made of the same rules.
        let kinds = ["pull = vjp", "push = jvp", "matrices = jacobian"];
        let kinds = if short(&&name) { &kinds[..] } else { &kinds[..2] };
        let functions: Vec<String> = kinds.iter().map(|kind| format!("{kind}({name}, q v tau h)")).collect();
        let functions: Vec<&str> = functions.iter().map(String::as_str).collect();
        let mut options = Options::default();
        if follows {
            let law = |joint, leader, powers: &[f64]| Coupling::polynomial(joint, leader, powers, 0.1).expect("a law");
            let laws = [law("fl_leg", "fl_thigh", &[0.1, 0.3, -0.4, 0.2]), law("neck", "hr_hip", &[0.2, -0.7, 0.5, 0.1, 0.3])];
            options.robot.coupling = laws.map(Into::into).to_vec();
        }
        let generated = generate(&request(&functions, options)).unwrap();
        assert_eq!(generated.model.bodies().iter().any(|body| body.coordinates.is_bent()), follows);
        let model = &generated.model;
        let (nq, nv) = (model.nq(), model.nv());
        let exact = model.cast::<Dual<f64>>();
        let mut random = Random::new(2);
        for given in given(model, 2) {
            let direction = [random.vector(nv, -1.0, 1.0), random.vector(nv, -1.0, 1.0), random.vector(nv, -1.0, 1.0), vec![0.3]];
            let mut moved: Vec<Vec<Dual<f64>>> = given.iter().map(|x| cast(x)).collect();
            let along: Vec<Dual<f64>> = direction[0].iter().map(|d| Dual::new(0.0, *d)).collect();
            let mut q = moved[0].clone();
            integrate(&exact, &mut Workspace::new(&exact), &moved[0], &along, &mut q);
            moved[0] = q;
            for k in 1..4 {
                moved[k].iter_mut().zip(&direction[k]).for_each(|(x, d)| x.slope = *d);
            }
            let slices: Vec<&[Dual<f64>]> = moved.iter().map(Vec::as_slice).collect();
            let mut out = vec![Dual::constant(0.0); nq + nv];
            step(name).unwrap().call(&exact, &mut Workspace::new(&exact), &slices, &mut out).unwrap();
            // In the tangent space where the step ends.
            let ends: Vec<Dual<f64>> = out[..nq].iter().map(|x| Dual::constant(x.value)).collect();
            let mut way = vec![Dual::constant(0.0); nv];
            difference(&exact, &mut Workspace::new(&exact), &ends, &out[..nq], &mut way);
            let expected: Vec<f64> = way.iter().chain(&out[nq..]).map(|x| x.slope).collect();
            let push =
                generated.graphs[1].evaluate(|argument, k| if argument < 4 { given[argument][k] } else { direction[argument - 4][k] });
            let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for (a, b) in push.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-9 * scale, "{name}: {a} {b}");
            }
            let weights = random.vector(2 * nv, -1.0, 1.0);
            let pull = generated.graphs[0].evaluate(|argument, k| match argument {
                0..4 => given[argument][k],
                4 => weights[k],
                _ => weights[nv + k],
            });
            let left: f64 = pull.iter().zip(direction.iter().flatten()).map(|(a, b)| a * b).sum();
            let right: f64 = expected.iter().zip(&weights).map(|(a, b)| a * b).sum();
            assert!((left - right).abs() < 1e-9 * scale * nv as f64, "{name}: {left} {right}");
            // Blocks of ∂q₁ and ∂v₁ by q, v, τ and h.
            let Some(matrices) = generated.graphs.get(2) else { continue };
            let matrices = matrices.evaluate(|argument, k| given[argument][k]);
            let mut rest = matrices.as_slice();
            let mut product = vec![0.0; 2 * nv];
            for half in product.chunks_mut(nv) {
                for d in &direction {
                    let (block, others) = rest.split_at(nv * d.len());
                    rest = others;
                    half.iter_mut()
                        .zip(block.chunks(d.len()))
                        .for_each(|(x, row)| *x += row.iter().zip(d).map(|(a, b)| a * b).sum::<f64>());
                }
            }
            assert!(rest.is_empty() && product.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9 * scale), "{name}");
        }
    }
}

/// The states after each step of 2 ms, a row of torques each; returns ½|v|² at the end.
fn rolled<S: Scalar>((robot, work): (&Model<S>, &mut Workspace<S>), [q, v, torques]: [&[S]; 3], path: &mut [S]) -> S {
    let n = robot.nv();
    let mut state = [q, v].concat();
    let step = step::<S>("step_semi_implicit_euler").expect("a row");
    S::for_each(torques.len() / n, torques, &mut state, path, |tau, state, now| {
        let (q, v) = state.split_at(n);
        step.call(robot, work, &[q, v, tau, &[S::from_f64(2e-3)]], now).expect("vectors made to measure");
        state.copy_from_slice(now);
    });
    state[n..].iter().fold(S::zero(), |sum, v| sum + S::from_f64(0.5) * *v * *v)
}

user_function! {
    /// The states after each of twelve steps of 2 ms, and ½|v|² at the end: a loop over one step.
    struct Roll;
    fn roll<S>(robot, work, q: [Nq] "rad", v: [Nv] "rad/s", torques: [Of(12), Nv] "N·m")
        -> (path: [Of(12), Of(6)] "q and v", cost: [] "rad²/s²") {
        cost[0] = rolled((robot, work), [q, v, torques], path);
    }
}

user_function! {
    /// The states after each of 400 steps of 2 ms, and ½|v|² at the end.
    struct Long;
    fn long<S>(robot, work, q: [Nq] "rad", v: [Nv] "rad/s", torques: [Of(400), Nv] "N·m")
        -> (path: [Of(400), Of(6)] "q and v", cost: [] "rad²/s²") {
        cost[0] = rolled((robot, work), [q, v, torques], path);
    }
}

/// The body of the loop is traced once; its gradient goes back through stored states.
#[test]
fn a_rollout_is_a_loop_over_a_step() {
    let mut request = Request::new("arm.urdf", include_str!("../../robots/arm.urdf"));
    request.options.users.push(Roll);
    request.options.users.push(Long);
    let functions = ["roll", "step_semi_implicit_euler", "pull = vjp(roll)", "push = jvp(roll)", "long", "long_pull = vjp(long)"];
    request.options.functions = functions.map(Into::into).to_vec();
    let generated = generate(&request).unwrap();
    let model = &generated.model;
    let nv = model.nv();
    assert_eq!(2 * nv, 6);
    let text = |name: &str| generated.source.split_once(&format!("pub fn {name}(")).unwrap().1.split("pub fn ").next().unwrap().len();
    assert!(text("roll") < 3 * text("step_semi_implicit_euler"), "{} {}", text("roll"), text("step_semi_implicit_euler"));
    // Names have more digits.
    for (few, many) in [("roll", "long"), ("pull", "long_pull")] {
        assert!(9 * text(many) < 10 * text(few), "{many}: {} {}", text(few), text(many));
    }
    let mut random = Random::new(5);
    let State { q, v, .. } = state(model, &mut random);
    let given = [q, v, random.vector(12 * nv, -1.0, 1.0)];
    let input = |argument: usize, k: usize| given[argument][k];
    let (mut at, mut expected) = ((given[0].clone(), given[1].clone()), Vec::new());
    for tau in given[2].chunks(nv) {
        at = stepped("step_semi_implicit_euler", model, [&at.0, &at.1, tau], 2e-3);
        expected.extend(at.0.iter().chain(&at.1));
    }
    expected.push(0.5 * at.1.iter().map(|v| v * v).sum::<f64>());
    let close = |found: &[f64]| found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12 * b.abs().max(1.0));
    assert!(close(&generated.graphs[0].evaluate(input)));
    assert!(generated.bodies[0].all().all(|(_, body)| close(&interpret(body, input))));
    // Dual numbers run through all turns.
    let exact = model.cast::<Dual<f64>>();
    let direction = given.each_ref().map(|x| random.vector(x.len(), -1.0, 1.0));
    let moved: Vec<Vec<Dual<f64>>> =
        given.iter().zip(&direction).map(|(x, d)| x.iter().zip(d).map(|(x, d)| Dual::new(*x, *d)).collect()).collect();
    let slices: Vec<&[Dual<f64>]> = moved.iter().map(Vec::as_slice).collect();
    let mut out = vec![Dual::constant(0.0); expected.len()];
    Roll.call(&exact, &mut Workspace::new(&exact), &slices, &mut out).unwrap();
    let slopes: Vec<f64> = out.iter().map(|x| x.slope).collect();
    let scale = slopes.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let push = generated.graphs[3].evaluate(|argument, k| if argument < 3 { given[argument][k] } else { direction[argument - 3][k] });
    assert!(push.iter().zip(&slopes).all(|(a, b)| (a - b).abs() < 1e-10 * scale), "{push:?} {slopes:?}");
    let weights = random.vector(expected.len(), -1.0, 1.0);
    let pull = generated.graphs[2].evaluate(|argument, k| match argument {
        0..3 => given[argument][k],
        3 => weights[k],
        _ => weights[weights.len() - 1],
    });
    let left: f64 = pull.iter().zip(direction.iter().flatten()).map(|(a, b)| a * b).sum();
    let right: f64 = slopes.iter().zip(&weights).map(|(a, b)| a * b).sum();
    assert!((left - right).abs() < 1e-10 * scale * 10.0, "{left} {right}");
}

user_function! {
    /// Steps of 2 ms until the first joint is beyond a limit, 200 at most, and how many these are.
    struct UntilBeyond;
    fn until_beyond<S>(robot, work, q: [Nq] "rad", v: [Nv] "rad/s", limit: [] "rad") -> (end: [Of(6)] "q and v", turns: [] "1") {
        let n = robot.nv();
        let mut state = [q, v, &[S::zero()]].concat();
        let step = step::<S>("step_semi_implicit_euler").expect("a row");
        let still = vec![S::zero(); n];
        let _ended = S::repeat(200, &mut state, |state| {
            let mut now = vec![S::zero(); 2 * n];
            let (q, v) = state[..2 * n].split_at(n);
            step.call(robot, work, &[q, v, &still, &[S::from_f64(2e-3)]], &mut now).expect("vectors made to measure");
            state[..2 * n].copy_from_slice(&now);
            state[2 * n] += S::one();
            (now[0] - limit[0]).positive()
        });
        end.copy_from_slice(&state[..2 * n]);
        turns[0] = state[2 * n];
    }
}

/// Each state ends by itself: alone, and in the lanes of a batch.
#[test]
fn a_motion_ends_where_a_function_of_its_state_says() {
    let mut request = Request::new("arm.urdf", include_str!("../../robots/arm.urdf"));
    request.options.users.push(UntilBeyond);
    request.options.functions = vec!["until_beyond".into()];
    request.options.batch = vec![Real::F64];
    let generated = generate(&request).unwrap();
    let (model, mut random) = (&generated.model, Random::new(3));
    let mut counts = Vec::new();
    for _ in 0..12 {
        let State { q, v, .. } = state(model, &mut random);
        let limit = q[0] + random.within(0.0, 0.3);
        let given = [q, v, vec![limit]];
        let mut at = (given[0].clone(), given[1].clone());
        let mut count = 0;
        while count < 200 && (count == 0 || at.0[0] <= limit) {
            at = stepped("step_semi_implicit_euler", model, [&at.0, &at.1, &[0.0; 3]], 2e-3);
            count += 1;
        }
        counts.push(count);
        let expected: Vec<f64> = at.0.iter().chain(&at.1).copied().chain([f64::from(count)]).collect();
        let close = |found: &[f64]| found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-11 * b.abs().max(1.0));
        let input = |argument: usize, k: usize| given[argument][k];
        assert!(close(&generated.graphs[0].evaluate(input)));
        assert!(generated.bodies[0].all().all(|(_, body)| close(&interpret(body, input))));
    }
    assert!(counts.contains(&200) && counts.iter().any(|count| (2..150).contains(count)), "{counts:?}");
}

#[test]
fn a_step_is_named_in_requests_and_nothing_else_may_be() {
    let told = |function: &str| generate(&request(&[function], Options::default())).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(told("step_rk5").contains("did you mean `step_rk4`?"), "{}", told("step_rk5"));
    assert!(told("step_rk4 = mass_matrix").contains("is what another function is called"), "{}", told("step_rk4 = mass_matrix"));
    assert!(told("s = step_rk4(h = x)").contains("expected a constant"), "{}", told("s = step_rk4(h = x)"));
    assert_eq!(steps::<f64>()[0].takes[0], Argument::Q);
}
