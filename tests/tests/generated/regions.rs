//! Loops in functions: iterations, statements that run where a mask holds, and turns over a table.
//! Generated code, its derivatives and its bounds against the same functions on numbers and in 96
//! digits.

use articulated_codegen::lir::interpret::interpret;
use articulated_codegen::{COptions, Options, Real, Request, RustOptions, Target, generate};
use articulated_core::Scalar;
use articulated_core::algorithm::{UserFunction, Workspace, forward_dynamics, gravity_torque, inverse_dynamics, mass_matrix_inverse};
use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_core::running::Running;
use articulated_core::user_function;
use articulated_reference::Big;
use articulated_tests::batch_program::{BatchProgram, STATES};
use articulated_tests::c_program::{self, Vectors};
use articulated_tests::case::{Case, State, read};
use articulated_tests::program::Program;
use articulated_tests::random::Random;

const ARM: &str = include_str!("../../robots/arm.urdf");

/// A relative change of a few roundings.
fn small<S: Scalar>() -> S {
    S::from_f64(2_f64.powi(10 - S::BITS as i32))
}

user_function! {
    /// √(1 + vₖ²) by Newton's iteration, and whether it converged.
    struct Roots;
    fn roots<S>(robot, work, v: [Nv] "rad/s") -> (roots: [Nv] "1") {
        for (root, v) in roots.iter_mut().zip(v) {
            let square = S::one() + *v * *v;
            let mut x = [square];
            let converged = S::repeat(40, &mut x, |x| {
                let before = x[0];
                x[0] = S::from_f64(0.5) * (before + square / before);
                (small::<S>() * x[0] - (x[0] - before).abs()).positive()
            });
            *root = S::select(converged, x[0], -x[0]);
        }
    }
}

user_function! {
    /// Where springs of stiffness k hold the arm against gravity: k (q − q₀) + g(q) = 0.
    struct Rest;
    fn rest<S>(robot, work, q: [Nq] "rad", stiffness: [] "N·m/rad") -> (rest: [Nq] "rad") {
        rest.copy_from_slice(q);
        let mut torque = vec![S::zero(); robot.nv()];
        let _ = S::repeat(200, rest, |rest| {
            gravity_torque(robot, work, rest, &mut torque);
            let mut moves = S::zero();
            for ((rest, q), torque) in rest.iter_mut().zip(q).zip(&torque) {
                let next = *q - *torque / stiffness[0];
                moves = S::select(((next - *rest).abs() - small::<S>()).positive(), S::one(), moves);
                *rest = next;
            }
            (S::from_f64(0.5) - moves).positive()
        });
    }
}

user_function! {
    /// Torques of a joint that moves fast: of an inverse dynamics where it does, else zero.
    struct Fast;
    fn fast<S>(robot, work, q: [Nq] "rad", v: [Nv] "rad/s", a: [Nv] "rad/s²") -> (torque: [Nv] "N·m") {
        let mut tau = vec![S::zero(); robot.nv()];
        S::when((v[0] - S::from_f64(0.2)).positive(), &mut tau, |tau| {
            let outer = v[1];
            inverse_dynamics(robot, work, q, v, a, tau);
            // A value of outside and a mask of outside in a region in the region.
            S::when((v[2] - a[0]).positive(), tau, |tau| tau[1] = tau[1] * outer + tau[0]);
        });
        torque.copy_from_slice(&tau);
    }
}

user_function! {
    /// An integrator, x ← x + h tanh-like(u), over the controls of six knots, with its path.
    struct Path;
    fn path<S>(robot, work, q: [Nq] "rad", controls: [Of(6)] "rad/s") -> (path: [Of(8)] "rad") {
        let mut state = [q[0], q[1]];
        let (path, end) = path.split_at_mut(6);
        S::for_each(6, controls, &mut state, path, |control, state, now| {
            let (sin, _) = (state[1] + control[0]).sin_cos();
            // The values change places, and a root is found in each turn.
            let mut root = [S::one()];
            let square = S::from_f64(2.0) + sin * q[2].sin_cos().1;
            let _ = S::repeat(30, &mut root, |x| {
                let before = x[0];
                x[0] = S::from_f64(0.5) * (before + square / before);
                (small::<S>() * x[0] - (x[0] - before).abs()).positive()
            });
            (state[0], state[1]) = (state[1], state[0] + S::from_f64(0.1) * sin * root[0]);
            now[0] = state[0] * control[0];
        });
        end.copy_from_slice(&state);
    }
}

user_function! {
    /// Turns that read a whole argument and whose results are the whole result.
    struct Turns;
    fn turns<S>(robot, work, q: [Nq] "rad", pushes: [Of(7), Of(2)] "rad") -> (turns: [Of(7), Of(3)] "rad") {
        let mut state = [q[0], q[1]];
        S::for_each(7, pushes, &mut state, turns, |push, state, now| {
            let (sin, cos) = (state[0] + push[0]).sin_cos();
            (state[0], state[1]) = (state[1] + sin * push[1], cos * q[2]);
            now.copy_from_slice(&[state[0], state[1], sin]);
        });
    }
}

const ALL: [&str; 5] = ["roots", "rest", "fast", "path", "turns"];

fn request(options: Options, functions: &[&str]) -> Request {
    let mut request = Request::new("arm.urdf", ARM);
    request.options = options;
    request.options.users.push(Roots);
    request.options.users.push(Rest);
    request.options.users.push(Fast);
    request.options.users.push(Path);
    request.options.users.push(Turns);
    request.options.functions = functions.iter().map(|f| (*f).into()).collect();
    request
}

/// The arguments of a function in a state, argument by argument.
fn given(function: &str, state: &State, random: &mut Random) -> Vec<Vec<f64>> {
    let State { q, v, a, .. } = state;
    match function {
        "roots" => vec![v.clone()],
        "rest" => vec![q.clone(), vec![random.within(200.0, 400.0)]],
        "fast" => vec![q.clone(), v.clone(), a.clone()],
        "turns" => vec![q.clone(), random.vector(14, -1.0, 1.0)],
        _ => vec![q.clone(), random.vector(6, -1.0, 1.0)],
    }
}

fn called<S: Scalar>(function: &str, model: &Model<S>, given: &[Vec<S>]) -> Vec<S> {
    let slices: Vec<&[S]> = given.iter().map(Vec::as_slice).collect();
    let work = &mut Workspace::new(model);
    let count = match function {
        "path" => 8,
        "turns" => 21,
        _ => model.nv(),
    };
    let mut out = vec![S::zero(); count];
    match function {
        "roots" => Roots.call(model, work, &slices, &mut out),
        "rest" => Rest.call(model, work, &slices, &mut out),
        "fast" => Fast.call(model, work, &slices, &mut out),
        "turns" => Turns.call(model, work, &slices, &mut out),
        _ => Path.call(model, work, &slices, &mut out),
    }
    .unwrap();
    out
}

fn states(count: usize) -> Vec<State> {
    let (case, mut random) = (Case::new("arm", read(ARM), Base::Fixed), Random::new(5));
    (0..count).map(|_| case.state(&mut random)).collect()
}

fn assert_close(found: &[f64], expected: &[f64], allowed: f64, what: &str) {
    let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let far = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == expected.len() && far <= allowed * scale, "{what}: {far:e}\n{found:?}\n{expected:?}");
}

#[test]
fn graphs_and_statements_compute_what_numbers_do() {
    let options = Options { batch: vec![Real::F64], ..Options::default() };
    let generated = generate(&request(options, &ALL)).unwrap();
    let mut random = Random::new(1);
    for (k, function) in ALL.into_iter().enumerate() {
        generated.graphs[k].verify().unwrap();
        let (before, _) = generated.source.split_once(&format!("pub fn {function}(")).unwrap();
        let is_bound = before.rsplit("///").next().unwrap_or_default().contains(" at most (multiply-adds");
        assert_eq!(is_bound, function != "turns", "{function}");
        assert!(generated.graphs[k].has_regions());
        for state in states(20) {
            let given = given(function, &state, &mut random);
            let expected = called(function, &generated.model, &given);
            let input = |argument: usize, k: usize| given[argument][k];
            assert_close(&generated.graphs[k].evaluate(input), &expected, 1e-13, function);
            for (which, body) in generated.bodies[k].all() {
                assert_close(&interpret(body, input), &expected, 1e-13, &format!("{function}, {which}"));
            }
            let mut many = vec![0.0; 3 * expected.len()];
            generated.graphs[k].evaluate_many(3, |argument, k, _| given[argument][k], &mut many);
            assert_close(&many, &expected.repeat(3), 1e-13, function);
        }
    }
}

/// Arguments of many states, each as the slices of a program.
fn many(function: &str, count: usize) -> Vec<Vec<Vec<f64>>> {
    let mut random = Random::new(2);
    states(count).iter().map(|state| given(function, state, &mut random)).collect()
}

fn compare(model: &Model<f64>, allowed: f64, what: &str, run: impl Fn(&str, &[Vec<&[f64]>]) -> Vec<Vec<f64>>) {
    for function in ALL {
        let all = many(function, STATES);
        let slices: Vec<Vec<&[f64]>> = all.iter().map(|given| given.iter().map(Vec::as_slice).collect()).collect();
        for (found, given) in run(function, &slices).iter().zip(&all) {
            assert_close(found, &called(function, model, given), allowed, &format!("{what}: {function}"));
        }
    }
}

#[test]
fn rust_computes_what_numbers_do() {
    let pairs = Options { level: "double_double".parse().unwrap(), ..Options::default() };
    for (what, options, allowed) in [("f64", Options::default(), 1e-13), ("dd", pairs, 1e-13)] {
        let generated = generate(&request(options, &ALL)).unwrap();
        let program = Program::build(&[("arm", &generated)], &[]);
        compare(&generated.model, allowed, what, |function, states| program.run("arm", function, states));
    }
}

#[test]
fn lanes_in_rust_compute_what_numbers_do() {
    for forbid_unsafe in [false, true] {
        let target = Target::Rust(RustOptions { forbid_unsafe, ..RustOptions::default() });
        let options = Options { target, batch: vec![Real::F64, Real::F32], ..Options::default() };
        let generated = generate(&request(options, &ALL)).unwrap();
        let sets: &[&str] = if cfg!(target_arch = "x86_64") && !forbid_unsafe { &["portable", "sse2", "avx2"] } else { &["portable"] };
        for set in sets.iter().filter(|set| **set != "avx2" || std::arch::is_x86_feature_detected!("avx2")) {
            let program = BatchProgram::build(&[("arm", &generated)], set, &[]);
            for (real, allowed) in [(Real::F64, 1e-13), (Real::F32, 2e-5)] {
                compare(&generated.model, allowed, &format!("{set} {real:?}"), |function, states| {
                    program.run("arm", function, real, states)
                });
            }
        }
    }
}

#[test]
fn c_computes_what_numbers_do() {
    let options = Options { target: Target::C(COptions::default()), batch: vec![Real::F64, Real::F32], ..Options::default() };
    let generated = generate(&request(options, &ALL)).unwrap();
    for vectors in [Vectors::Any, Vectors::Own, Vectors::None] {
        let program = c_program::build(&[("arm", generated.model.shape(), &generated)], vectors, "-O1");
        compare(&generated.model, 1e-13, &format!("C, {vectors:?}"), |function, states| program.run("arm", function, states));
        for (form, real, allowed) in [("batch", "f64", 1e-13), ("blocks", "f64", 1e-13), ("batch", "f32", 2e-5)] {
            compare(&generated.model, allowed, &format!("C, {vectors:?}, {form} {real}"), |function, states| {
                program.run("arm", &format!("{function} {form} {real}"), states)
            });
        }
    }
}

/// Differences of 96 digits: the derivative of where an iteration ends, however it gets there.
#[test]
fn derivatives_are_those_of_ninety_digits() {
    let wrt = [("roots", "v"), ("rest", "q stiffness"), ("fast", "q v a"), ("path", "q controls"), ("turns", "q pushes")];
    let of = |kind: &str| wrt.map(|(name, by)| format!("{kind}_{name} = {kind}({name}, {by})"));
    let functions = [of("jacobian"), of("vjp"), of("jvp"), of("hvp")].concat();
    let functions: Vec<&str> = functions.iter().map(String::as_str).collect();
    let generated = generate(&request(Options::default(), &functions)).unwrap();
    let exact = generated.model.cast::<Big>();
    let mut random = Random::new(7);
    let step = Big::from_f64(2_f64.powi(-90));
    for (which, (function, _)) in wrt.into_iter().enumerate() {
        for state in states(3) {
            let given = given(function, &state, &mut random);
            // Columns of the Jacobian, argument by argument.
            let at = |shift: &[Vec<f64>], by: Big| -> Vec<Big> {
                let moved = |(x, d): (&Vec<f64>, &Vec<f64>)| -> Vec<Big> {
                    x.iter().zip(d).map(|(x, d)| Big::from_f64(*x) + by * Big::from_f64(*d)).collect()
                };
                called(function, &exact, &given.iter().zip(shift).map(moved).collect::<Vec<_>>())
            };
            let slope = |shift: &[Vec<f64>]| -> Vec<f64> {
                let (up, down) = (at(shift, step), at(shift, -step));
                up.into_iter().zip(down).map(|(a, b)| ((a - b) / (step + step)).to_f64()).collect()
            };
            let rows = generated.graphs[which].outputs.len() / given.iter().map(Vec::len).sum::<usize>();
            let jacobian = generated.graphs[which].evaluate(|argument, k| given[argument][k]);
            let mut blocks = jacobian.as_slice();
            for argument in 0..given.len() {
                let (block, rest) = blocks.split_at(rows * given[argument].len());
                blocks = rest;
                for column in 0..given[argument].len() {
                    let mut shift: Vec<Vec<f64>> = given.iter().map(|x| vec![0.0; x.len()]).collect();
                    shift[argument][column] = 1.0;
                    let found: Vec<f64> = (0..rows).map(|row| block[row * given[argument].len() + column]).collect();
                    assert_close(&found, &slope(&shift), 1e-11, &format!("{function}, column {column} of argument {argument}"));
                }
            }
            let direction: Vec<Vec<f64>> = given.iter().map(|x| random.vector(x.len(), -1.0, 1.0)).collect();
            let along = slope(&direction);
            let weights = random.vector(rows, -1.0, 1.0);
            let last = given.len();
            let of = |place: usize, more: &dyn Fn(usize, usize) -> f64| {
                generated.graphs[place].evaluate(|argument, k| if argument < last { given[argument][k] } else { more(argument - last, k) })
            };
            let pull = of(wrt.len() + which, &|_, k| weights[k]);
            let left: f64 = pull.iter().zip(direction.iter().flatten()).map(|(a, b)| a * b).sum();
            let right: f64 = along.iter().zip(&weights).map(|(a, b)| a * b).sum();
            assert!((left - right).abs() < 1e-11 * right.abs().max(1.0), "{function}: {left} {right}");
            assert_close(&of(2 * wrt.len() + which, &|argument, k| direction[argument][k]), &along, 1e-11, function);
            // λᵀ ∂²y/∂x² d from both sides, by a second difference: λᵀ y'' (d, d).
            let hvp = of(3 * wrt.len() + which, &|argument, k| if argument == 0 { weights[k] } else { direction[argument - 1][k] });
            let found: f64 = hvp.iter().zip(direction.iter().flatten()).map(|(a, b)| a * b).sum();
            let (up, here, down) = (at(&direction, step), at(&direction, Big::from_f64(0.0)), at(&direction, -step));
            let second = |k: usize| ((up[k] - here[k] - here[k] + down[k]) / (step * step)).to_f64();
            let expected: f64 = weights.iter().enumerate().map(|(k, weight)| weight * second(k)).sum();
            assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{function}: {found} {expected}");
        }
    }
}

/// The way back of a gradient reads stored states, controls and weights where they are, from the
/// last turn to the first.
#[test]
fn gradients_of_turns_are_the_same_in_every_language() {
    const BACK: [(&str, &str); 2] = [("vjp_path", "path"), ("vjp_turns", "turns")];
    let functions = ["vjp_path = vjp(path, controls)", "vjp_turns = vjp(turns, pushes)"];
    let generate = |target: Target, batch: &[Real]| {
        let generated = generate(&request(Options { target, batch: batch.to_vec(), ..Options::default() }, &functions)).unwrap();
        assert!(generated.source.contains("_results[6 - "), "the states are not read in place");
        generated
    };
    let rust = generate(Target::Rust(RustOptions::default()), &[]);
    let mut random = Random::new(11);
    let mut all: Vec<Vec<Vec<Vec<f64>>>> = Vec::new();
    for (_, function) in BACK {
        let weights = |random: &mut Random| random.vector(if function == "path" { 8 } else { 21 }, -1.0, 1.0);
        let one = |state: &State, random: &mut Random| [given(function, state, random), vec![weights(random)]].concat();
        all.push(states(STATES).iter().map(|state| one(state, &mut random)).collect());
    }
    let compare = |what: &str, run: &dyn Fn(&str, &[Vec<&[f64]>]) -> Vec<Vec<f64>>| {
        for (k, (name, _)) in BACK.iter().enumerate() {
            let slices: Vec<Vec<&[f64]>> = all[k].iter().map(|given| given.iter().map(Vec::as_slice).collect()).collect();
            for (found, given) in run(name, &slices).iter().zip(&all[k]) {
                assert_close(found, &rust.graphs[k].evaluate(|argument, k| given[argument][k]), 1e-13, &format!("{what}: {name}"));
            }
        }
    };
    for (k, all) in all.iter().enumerate() {
        let input = |argument: usize, k: usize| all[0][argument][k];
        for (which, body) in rust.bodies[k].all() {
            assert_close(&interpret(body, input), &rust.graphs[k].evaluate(input), 1e-13, which);
        }
    }
    let program = Program::build(&[("arm", &rust)], &[]);
    compare("Rust", &|function, states| program.run("arm", function, states));
    let many = generate(Target::Rust(RustOptions::default()), &[Real::F64]);
    let program = BatchProgram::build(&[("arm", &many)], "portable", &[]);
    compare("Rust, lanes", &|function, states| program.run("arm", function, Real::F64, states));
    let c = generate(Target::C(COptions::default()), &[Real::F64]);
    let program = c_program::build(&[("arm", c.model.shape(), &c)], Vectors::Any, "-O1");
    for form in ["", " batch f64", " blocks f64"] {
        compare(&format!("C{form}"), &|function, states| program.run("arm", &format!("{function}{form}"), states));
    }
}

#[test]
fn bounds_hold_where_an_end_is_certain() {
    let generated = generate(&request(Options::default(), &["roots"])).unwrap();
    for state in states(5) {
        let bounded = generated.graphs[0].evaluate_as(|_, k| Running::<53, 0>::within(state.v[k], 0.0));
        let exact = called("roots", &generated.model.cast::<Big>(), &[state.v.iter().map(|x| Big::from_f64(*x)).collect()]);
        let found = generated.graphs[0].evaluate(|_, k| state.v[k]);
        for ((Running { error, .. }, exact), found) in bounded.iter().zip(exact).zip(found) {
            let off = (Big::from_f64(found) - exact).abs().to_f64();
            assert!(off <= *error && *error < 1e-13, "{off:e} {error:e}");
        }
    }
}

user_function! {
    /// A long function with a loop in its middle, which reads and is read by what is around it.
    struct Long;
    fn long<S>(robot, work, q: [Nq] "rad", v: [Nv] "rad/s", tau: [Nv] "N·m") -> (long: [Nv] "1") {
        let n = robot.nv();
        let (mut inverse, mut a) = (vec![S::zero(); n * n], vec![S::zero(); n]);
        mass_matrix_inverse(robot, work, q, &mut inverse);
        let mut x = [S::one(), S::zero()];
        let square = S::one() + inverse[0] * inverse[0] + inverse[n * n - 1] * inverse[n * n - 1];
        let _ = S::repeat(40, &mut x, |x| {
            let before = x[0];
            x[0] = S::from_f64(0.5) * (before + square / before);
            x[1] = x[0] * inverse[1];
            (small::<S>() * x[0] - (x[0] - before).abs()).positive()
        });
        forward_dynamics(robot, work, q, v, tau, &mut a);
        for k in 0..n {
            long[k] = a[k] * x[0] + x[1] + inverse[k];
        }
    }
}

/// Pieces of a long function keep what a region reads and what it makes.
#[test]
fn a_region_is_in_one_piece_of_a_long_function() {
    let urdf = articulated_models::robot("humanoid").expect("a bundled robot").urdf;
    let mut request = Request::new("humanoid.urdf", urdf);
    request.options.robot.base = Base::Floating;
    request.options.users.push(Long);
    request.options.functions = vec!["long".into()];
    request.options.batch = vec![Real::F64];
    let generated = generate(&request).unwrap();
    let case = Case::new("humanoid", read(urdf), Base::Floating);
    let state = case.state(&mut Random::new(3));
    let arguments = [&state.q[..], &state.v, &state.tau];
    let mut expected = vec![0.0; generated.model.nv()];
    Long.call(&generated.model, &mut Workspace::new(&generated.model), &arguments, &mut expected).unwrap();
    let input = |argument: usize, k: usize| arguments[argument][k];
    assert_close(&generated.graphs[0].evaluate(input), &expected, 1e-9, "graph");
    assert!(generated.bodies[0].single.pieces.len() > 1, "it is cut");
    for (which, body) in generated.bodies[0].all() {
        assert_close(&interpret(body, input), &expected, 1e-9, which);
    }
}

/// Derivatives of forward dynamics end with a loop over the columns of M X = B. Their graph has it
/// as a region, and so a bound.
#[test]
fn the_graph_of_a_solution_column_by_column_is_complete() {
    for (name, base) in [("panda_like", Base::Fixed), ("quadruped", Base::Floating)] {
        let urdf = articulated_models::robot(name).expect("a bundled robot").urdf;
        let mut request = Request::new("robot.urdf", urdf);
        request.options.robot.base = base;
        request.options.functions = vec!["forward_dynamics_derivatives".into()];
        let generated = generate(&request).unwrap();
        assert!(generated.bodies[0].is_followed_by_columns, "{name}");
        let case = Case::new(name, read(urdf), base);
        let state = case.state(&mut Random::new(3));
        let arguments = [&state.q[..], &state.v, &state.tau];
        let exact: Vec<Vec<Big>> = arguments.iter().map(|x| x.iter().map(|x| Big::from_f64(*x)).collect()).collect();
        let exact: Vec<&[Big]> = exact.iter().map(Vec::as_slice).collect();
        let expected = case.call::<Big>("forward_dynamics_derivatives", &exact);
        let graph = &generated.graphs[0];
        let found = graph.evaluate(|argument, k| arguments[argument][k]);
        let bounded = graph.evaluate_as(|argument, k| Running::<53, 0>::within(arguments[argument][k], 0.0));
        assert_eq!((found.len(), bounded.len()), (expected.len(), expected.len()));
        let largest = found.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for ((found, bound), expected) in found.iter().zip(bounded).zip(expected) {
            let off = (Big::from_f64(*found) - expected).abs().to_f64();
            assert!(off <= bound.error && bound.error < 1e-6 * largest, "{name}: {off:e} {:e} of {largest}", bound.error);
        }
    }
}
