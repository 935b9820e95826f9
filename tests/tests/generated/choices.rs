//! Options of a request besides names of functions: several functions in one, constant arguments,
//! forms by count.

use articulated::{Dynamics, Model};
use articulated_codegen::{Request, generate};
use articulated_core::algorithm::{FunctionId, Workspace};
use articulated_core::description::Base;
use articulated_core::diagnostic::{Code, Diagnostics, Spanned};
use articulated_tests::case::read;

articulated::robot! {
    /// Functions by themselves, with constants, and together.
    mod arm {
        urdf = "robots/arm.urdf",
        frames = [tool],
        functions = [
            inverse_dynamics,
            mass_matrix,
            jacobians_world_aligned,
            static_torque,
            bias = inverse_dynamics(a = 0),
            hold = inverse_dynamics(v = 0, a = [0, 0, 0]),
            push = static_torque(wrenches = [0, 0, 0, -1.5, 0, 2e1]),
            home = mass_matrix(q = 0),
            at_home = inverse_dynamics(q = 0, v = 0, a = 1) + placements(q = 0),
            quick = inverse_dynamics(q = sin_cos),
            step = inverse_dynamics + mass_matrix + jacobians_world_aligned,
        ],
    }
}

articulated::robot! {
    /// Four legs in the lanes of vectors.
    mod in_lanes {
        urdf = "robots/walker.urdf",
        base = floating,
        functions = [inverse_dynamics, mass_matrix, forward_dynamics, inverse_dynamics_derivatives, jacobians_body, quick = inverse_dynamics(q = sin_cos)],
    }
}

articulated::robot! {
    /// Each leg for itself.
    mod one_by_one {
        urdf = "robots/walker.urdf",
        base = floating,
        functions = [inverse_dynamics, mass_matrix, forward_dynamics, inverse_dynamics_derivatives, jacobians_body],
        limbs = false,
    }
}

articulated::robot! {
    /// Four wheels in lanes, three of them round.
    mod rover {
        urdf = "robots/rover.urdf",
        base = floating,
        functions = [inverse_dynamics, mass_matrix, inverse_dynamics_derivatives],
    }
}

articulated::robot! {
    /// Many states at once: vectors, matrices, and several results in one.
    mod many {
        urdf = "robots/arm.urdf",
        frames = [tool],
        functions = [inverse_dynamics, mass_matrix, kinetic_energy, static_torque, both = bias_forces + mass_matrix, home = mass_matrix(q = 0)],
        batch = [f64, f32],
    }
}

pub(crate) const URDF: &str = include_str!("../../robots/arm.urdf");
pub(crate) const Q: [f64; 3] = [0.4, -0.9, 1.3];
pub(crate) const V: [f64; 3] = [1.1, 0.3, -0.8];
pub(crate) const A: [f64; 3] = [-0.7, 2.0, 0.6];

/// Large results can also be written into the caller's array, whatever its contents; the trait uses
/// this form.
#[test]
fn a_large_result_goes_into_what_the_caller_has() {
    let q: [f64; in_lanes::NQ] =
        std::array::from_fn(|k| if k == 6 { 1.0 } else { 0.3 * k as f64 * f64::from(u8::from(!(3..6).contains(&k))) });
    let (v, a) = (std::array::from_fn(|k| 0.1 * k as f64 - 0.4), std::array::from_fn(|k| 1.0 - 0.2 * k as f64));
    let expected = in_lanes::inverse_dynamics_derivatives(&q, &v, &a);
    let mut out = [[[f64::NAN; in_lanes::NV]; in_lanes::NV]; 3];
    in_lanes::inverse_dynamics_derivatives_into(&q, &v, &a, &mut out);
    assert_eq!(out, expected);
    let mut flat = vec![f64::NAN; 3 * in_lanes::NV * in_lanes::NV];
    in_lanes::Robot.inverse_dynamics_derivatives(&mut (), &q, &v, &a, &mut flat).expect("lengths as they are");
    assert_eq!(flat, expected.as_flattened().as_flattened());
}

/// Equal except for some last digits: the same terms in another order.
pub(crate) fn same(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= 1e-14 * size), "{found:?} instead of {expected:?}");
}

#[test]
fn several_functions_in_one_give_what_each_gives() {
    let arm::Step { inverse_dynamics, mass_matrix, jacobians_world_aligned } = arm::step(&Q, &V, &A);
    same(&inverse_dynamics, &arm::inverse_dynamics(&Q, &V, &A));
    same(mass_matrix.as_flattened(), arm::mass_matrix(&Q).as_flattened());
    same(jacobians_world_aligned[0].as_flattened(), arm::jacobians_world_aligned(&Q)[0].as_flattened());
}

#[test]
fn constants_are_what_the_argument_would_have_been() {
    same(&arm::bias(&Q, &V), &arm::inverse_dynamics(&Q, &V, &[0.0; 3]));
    same(&arm::hold(&Q), &arm::inverse_dynamics(&Q, &[0.0; 3], &[0.0; 3]));
    same(&arm::push(&Q), &arm::static_torque(&Q, &[[0.0, 0.0, 0.0, -1.5, 0.0, 20.0]]));
}

#[test]
fn where_all_arguments_are_constants_none_is_left() {
    let (zero, matrix) = ([0.0; 3], arm::mass_matrix(&[0.0; 3]));
    same(arm::home().as_flattened(), matrix.as_flattened());
    let mut out = [[f64::NAN; 3]; 3];
    arm::home_into(&mut out);
    same(out.as_flattened(), matrix.as_flattened());
    same(&arm::at_home().inverse_dynamics, &arm::inverse_dynamics(&zero, &zero, &[1.0; 3]));
    let mut all = vec![[[f64::NAN; 3]; 3]; 11];
    many::batch_f64::home(&mut all).expect("one slice has its own length");
    all.iter().for_each(|m| same(m.as_flattened(), matrix.as_flattened()));
}

#[test]
fn sines_that_are_given_are_taken() {
    let sines = |q: &[f64; 3]| q.map(|q| [q.sin(), q.cos()]);
    same(&arm::quick(&Q, &V, &A, &sines(&Q)), &arm::inverse_dynamics(&Q, &V, &A));
    // They replace the angles, whatever the value of q.
    let other = [2.0, 0.1, -0.5];
    same(&arm::quick(&Q, &V, &A, &sines(&other)), &arm::inverse_dynamics(&other, &V, &A));
}

/// A number that looks random, in [−1, 1).
fn number(k: usize) -> f64 {
    (k as f64 * 0.754_877_666_246_692_7).fract() * 2.0 - 1.0
}

pub(crate) fn states(n: usize, salt: usize) -> Vec<[f64; 3]> {
    (0..n).map(|i| std::array::from_fn(|k| number(3 * i + k + salt))).collect()
}

#[test]
fn a_batch_gives_what_each_state_gives() {
    // Every remainder of a block, and more than one block.
    for n in 0..=35 {
        let [q, v, a] = [1, 101, 211].map(|salt| states(n, salt));
        let wrenches: Vec<[[f64; 6]; 1]> = (0..n).map(|i| [std::array::from_fn(|k| number(6 * i + k + 307))]).collect();
        let mut tau = vec![[f64::NAN; 3]; n];
        many::batch_f64::inverse_dynamics(&q, &v, &a, &mut tau).unwrap();
        let mut pushed = tau.clone();
        many::batch_f64::static_torque(&q, &wrenches, &mut pushed).unwrap();
        let (mut energy, mut mass, mut bias) = (vec![f64::NAN; n], vec![[[f64::NAN; 3]; 3]; n], tau.clone());
        many::batch_f64::kinetic_energy(&q, &v, &mut energy).unwrap();
        many::batch_f64::both(&q, &v, &mut bias, &mut mass).unwrap();
        for i in 0..n {
            same(&tau[i], &many::inverse_dynamics(&q[i], &v[i], &a[i]));
            same(&pushed[i], &many::static_torque(&q[i], &wrenches[i]));
            same(&[energy[i]], &[many::kinetic_energy(&q[i], &v[i])]);
            same(&bias[i], &many::both(&q[i], &v[i]).bias_forces);
            same(mass[i].as_flattened(), many::mass_matrix(&q[i]).as_flattened());
        }
    }
}

#[test]
fn a_batch_in_f32_is_as_good_as_f32_is() {
    let single = |x: Vec<[f64; 3]>| x.into_iter().map(|y| y.map(|z| z as f32)).collect::<Vec<[f32; 3]>>();
    let [q, v, a] = [1, 101, 211].map(|salt| single(states(37, salt)));
    let mut tau = vec![[f32::NAN; 3]; 37];
    many::batch_f32::inverse_dynamics(&q, &v, &a, &mut tau).unwrap();
    for i in 0..37 {
        let [q, v, a] = [q[i], v[i], a[i]].map(|x| x.map(f64::from));
        let expected = many::inverse_dynamics(&q, &v, &a);
        let size = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        assert!(
            (0..3).all(|k| (f64::from(tau[i][k]) - expected[k]).abs() <= 16.0 * f64::from(f32::EPSILON) * size),
            "{i}: {:?} {expected:?}",
            tau[i]
        );
    }
}

#[test]
fn blocks_of_states_are_states() {
    use many::batch_f64::Lanes;
    let [q, v, a] = [1, 101, 211].map(|salt| states(3 * Lanes::LEN, salt));
    let blocks = |x: &[[f64; 3]]| -> Vec<[Lanes; 3]> {
        x.chunks(Lanes::LEN).map(|c| std::array::from_fn(|k| Lanes(std::array::from_fn(|lane| c[lane][k])))).collect()
    };
    let mut tau = vec![[Lanes::ZERO; 3]; 3];
    many::batch_f64::inverse_dynamics_blocks(&blocks(&q), &blocks(&v), &blocks(&a), &mut tau).unwrap();
    for i in 0..q.len() {
        let found: [f64; 3] = std::array::from_fn(|k| tau[i / Lanes::LEN][k].0[i % Lanes::LEN]);
        same(&found, &many::inverse_dynamics(&q[i], &v[i], &a[i]));
    }
}

#[test]
fn slices_of_different_lengths_are_an_error_and_nothing_is_written() {
    let (q, v) = (states(5, 1), states(4, 2));
    let mut out = vec![[7.0; 3]; 5];
    let error = many::batch_f64::inverse_dynamics(&q, &v, &q, &mut out).unwrap_err();
    assert_eq!((error.argument, error.found, error.expected), ("v", 4, 5));
    assert_eq!(many::batch_f64::inverse_dynamics(&q, &q, &q, &mut out[..3]).unwrap_err().argument, "out");
    assert_eq!(out, [[7.0; 3]; 5]);
}

#[test]
fn limbs_in_lanes_give_what_each_gives_for_itself() {
    const NQ: usize = in_lanes::NQ;
    for state in 0..20 {
        let mut q: [f64; NQ] = std::array::from_fn(|k| number(k + 31 * state));
        let size = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[3..7].iter_mut().for_each(|x| *x /= size);
        let [v, a]: [[f64; in_lanes::NV]; 2] = [7, 11].map(|m| std::array::from_fn(|k| number(m * k + state + 3)));
        same(&in_lanes::inverse_dynamics(&q, &v, &a), &one_by_one::inverse_dynamics(&q, &v, &a));
        same(in_lanes::mass_matrix(&q).as_flattened(), one_by_one::mass_matrix(&q).as_flattened());
        // Solved with another factorisation: judged by the torque that comes back.
        let back = in_lanes::inverse_dynamics(&q, &v, &in_lanes::forward_dynamics(&q, &v, &a));
        assert!(back.iter().zip(&a).all(|(b, a)| (b - a).abs() <= 1e-12), "{back:?} instead of {a:?}");
        let [found, expected] = [in_lanes::inverse_dynamics_derivatives(&q, &v, &a), one_by_one::inverse_dynamics_derivatives(&q, &v, &a)];
        same(found.as_flattened().as_flattened(), expected.as_flattened().as_flattened());
        let [found, expected] = [in_lanes::jacobians_body(&q), one_by_one::jacobians_body(&q)];
        same(found.as_flattened().as_flattened(), expected.as_flattened().as_flattened());
        let sines = q.map(|q| [q.sin(), q.cos()]);
        same(&in_lanes::quick(&q, &v, &a, &sines), &one_by_one::inverse_dynamics(&q, &v, &a));
    }
}

/// An unbalanced wheel has a preferred angle; the three others in the same vectors do not depend on
/// it.
#[test]
fn one_wheel_of_four_may_be_out_of_balance() {
    pub(crate) const URDF: &str = include_str!("../../robots/rover.urdf");
    let model = Model::new(&read(URDF), Base::Floating).unwrap();
    for state in 0..10 {
        let mut q: [f64; rover::NQ] = std::array::from_fn(|k| number(k + 31 * state));
        let size = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[3..7].iter_mut().for_each(|x| *x /= size);
        let [v, a]: [[f64; rover::NV]; 2] = [7, 11].map(|m| std::array::from_fn(|k| number(m * k + state + 3)));
        let generic = |id: FunctionId, arguments: &[&[f64]]| {
            let mut out = vec![0.0; id.row::<f64>().len(model.shape())];
            id.row().call(&model, &mut Workspace::new(&model), arguments, &mut out).unwrap();
            out
        };
        same(&rover::inverse_dynamics(&q, &v, &a), &generic(FunctionId::inverse_dynamics, &[&q, &v, &a]));
        same(rover::mass_matrix(&q).as_flattened(), &generic(FunctionId::mass_matrix, &[&q]));
        let found = rover::inverse_dynamics_derivatives(&q, &v, &a);
        same(found.as_flattened().as_flattened(), &generic(FunctionId::inverse_dynamics_derivatives, &[&q, &v, &a]));
        // ∂τ/∂q of the round wheels: only rounding errors.
        let column = |wheel: usize| found[0].map(|row| row[wheel]);
        let round = [rover::v_index::FL_ROLL, rover::v_index::FR_ROLL, rover::v_index::HL_ROLL, rover::v_index::HR_ROLL]
            .map(|k| column(k).iter().all(|x| x.abs() < 1e-15));
        assert_eq!(round, [true, true, false, true]);
    }
    let sines = |urdf: &str| {
        let mut request = Request::new("rover.urdf", urdf);
        (request.options.robot.base, request.options.functions) = (Base::Floating, vec!["inverse_dynamics".into()]);
        let entry = &generate(&request).unwrap().ledger.functions[0];
        (entry.lanes, entry.emitted().trigonometric())
    };
    let balanced = URDF.replace("0.011 0 0", "0 0 0");
    assert_eq!([sines(URDF), sines(&balanced)], [(4, 4), (4, 2)]);
}

#[test]
fn limbs_go_into_lanes_where_that_costs_less() {
    let lanes = |limbs: bool, forbid_unsafe: bool| {
        let mut request = Request::new("walker.urdf", include_str!("../../robots/walker.urdf"));
        (request.options.robot.base, request.options.limbs, request.options.rust_mut().forbid_unsafe) =
            (Base::Floating, limbs, forbid_unsafe);
        request.options.functions = vec!["inverse_dynamics".into(), "integrate".into()];
        generate(&request).unwrap().ledger.functions.iter().map(|e| e.lanes).collect::<Vec<_>>()
    };
    assert_eq!([lanes(true, false), lanes(false, false), lanes(true, true)], [[4, 1], [1, 1], [1, 1]]);
}

/// Instructions and sines of the functions of a request.
fn costs(robot: &str, functions: &[&str]) -> Vec<(u64, u64)> {
    let robot = articulated_models::robot(robot).unwrap();
    let mut request = Request::new(robot.name, robot.urdf);
    request.options.robot.base = robot.base;
    request.options.functions = functions.iter().map(|f| (*f).into()).collect();
    let ledger = generate(&request).unwrap().ledger;
    ledger.functions.iter().map(|e| (e.emitted().instructions(), e.emitted().trigonometric())).collect()
}

#[test]
fn several_functions_in_one_share_their_work() {
    let of = |functions: &[&str]| costs("panda_like", functions);
    let dynamics = of(&["inverse_dynamics", "mass_matrix", "both = inverse_dynamics + mass_matrix"]);
    assert_eq!([dynamics[0].1, dynamics[1].1, dynamics[2].1], [12, 12, 12], "one set of sines");
    assert!(dynamics[2].0 <= dynamics[0].0 + dynamics[1].0, "{dynamics:?}");
    let kinematics = of(&["placements", "jacobians_body", "both = placements + jacobians_body"]);
    assert!(kinematics[2].0 + kinematics[0].0 / 2 < kinematics[0].0 + kinematics[1].0, "{kinematics:?}");
}

#[test]
fn of_what_is_constant_no_dead_term_remains() {
    let costs = costs("humanoid", &["bias_forces", "h = inverse_dynamics(a = 0)", "gravity_torque", "g = inverse_dynamics(v = 0, a = 0)"]);
    assert_eq!((costs[0], costs[2]), (costs[1], costs[3]));
}

#[test]
fn forward_dynamics_goes_the_way_that_costs_least() {
    let ways = |robot: &str| {
        let robot = articulated_models::robot(robot).unwrap();
        let mut request = Request::new(robot.name, robot.urdf);
        (request.options.robot.base, request.options.functions) = (robot.base, vec!["forward_dynamics".into()]);
        generate(&request).unwrap().ledger.functions[0].ways.clone()
    };
    // Short arms, a tree, and a robot with a joint that follows, which no recursion along a branch
    // can invert.
    assert_eq!(ways("panda_like"), ["LTDL", "mass shifted", "axis rates", "parallel and last rotations folded", "length unit 0.0825 m"]);
    assert_eq!(ways("humanoid"), ["ABA"]);
    assert_eq!(ways("gripper_arm"), ["LTDL", "axis rates"]);
    assert_eq!(ways("ur5_like"), ["LTDL", "mass shifted", "axis rates", "parallel rotations folded", "length unit 28.44 m"]);
}

#[test]
fn what_a_robot_cannot_have_is_said_when_it_is_built() {
    let refusal = |urdf: &str, change: &dyn Fn(&mut Request)| {
        let mut request = Request::new("arm.urdf", urdf);
        change(&mut request);
        generate(&request).map(|_| ()).unwrap_err()
    };
    let asks = |functions: &[&str]| {
        let functions: Vec<Spanned<String>> = functions.iter().map(|f| (*f).into()).collect();
        move |r: &mut Request| r.options.functions.clone_from(&functions)
    };
    let link =
        |k: usize| format!("<link name='l{k}'/><joint name='j{k}' type='continuous'><parent link='root'/><child link='l{k}'/></joint>");
    let star = format!("<robot name='star'><link name='root'/>{}</robot>", (0..=10_000).map(link).collect::<String>());
    let error = refusal(&star, &asks(&["gravity_torque"]));
    let is = |error: &Diagnostics, code: Code| error.errors.len() == 1 && error.errors[0].code == code;
    assert!(is(&error, Code::TooLarge) && error.to_string().contains("found 10001 degrees of freedom, expected at most 10000"), "{error}");
    let error = refusal(URDF, &asks(&["operational_space_inertia"]));
    assert!(is(&error, Code::BoundFrames) && error.to_string().matches("link \"").count() == 4, "{error}");
    assert!(error.to_string().contains("link \"tool\" (3)"), "{error}");
    let error = refusal("<robot name='stone'><link name='stone'/></robot>", &asks(&["center_of_mass"]));
    assert!(is(&error, Code::NoMass), "{error}");
    let error = refusal(URDF, &asks(&["mass_matrix", "mass_matrix = mass_matrix(q = 0)"]));
    assert!(is(&error, Code::SameName), "{error}");
    let error = refusal(URDF, &asks(&["x = mass_matrix", "x_blocks = gravity_torque"]));
    assert!(is(&error, Code::SameName), "{error}");
    let error = refusal(URDF, &asks(&["a_1 = mass_matrix + placements", "a1 = mass_matrix + gravity_torque"]));
    assert!(is(&error, Code::SameName), "{error}");
    let error = refusal(&URDF.replace("\"fore\"", "\"to-ol\"").replace("\"tool\"", "\"to_ol\""), &|r| {
        r.options.parameters = vec!["payload(to-ol)".into(), "payload(to_ol)".into()];
    });
    // Both are reported: the parameters, and the links themselves.
    let codes: Vec<Code> = error.errors.iter().map(|error| error.code).collect();
    assert!(codes.contains(&Code::Parameter) && codes.contains(&Code::NameClash) && codes.len() == 2, "{error}");
    assert!(error.to_string().contains("TO_OL_PAYLOAD"), "{error}");
    let error = refusal(URDF, &asks(&["x = bias_forces(v = [0, 0])"]));
    assert!(error.to_string().contains("found 2 numbers, expected 3"), "{error}");
    for (parameter, part) in
        [("payload(tol)", "did you mean \"tool\"?"), ("mass(tool)", "expected payload(link)"), ("origin(elbo)", "\"elbow\"")]
    {
        let error = refusal(URDF, &|r| r.options.parameters = vec![parameter.into()]);
        assert!(error.to_string().contains(part), "{error}");
    }
}
