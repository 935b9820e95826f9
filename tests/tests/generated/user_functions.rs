//! Functions of users: generated code against the same function on numbers, with its derivatives,
//! in Rust and in C.

use articulated_codegen::{COptions, Derivative, FunctionSpec, Request, Target, UserFunctions, generate};
use articulated_core::Scalar;
use articulated_core::algorithm::{UserFunction, Workspace, center_of_mass, inverse_dynamics, kinetic_energy, mass_matrix};
use articulated_core::description::Base;
use articulated_core::dual::Dual;
use articulated_core::model::Model;
use articulated_core::user_function;
use articulated_tests::case::{Case, cast, read};
use articulated_tests::random::Random;

user_function! {
    /// c = ½ τᵀ W τ + |p − place|, and the diagonal of M, at least 0.1.
    pub(crate) struct Effort {
        pub(crate) offset: f64,
    }
    fn effort<S>(&this, robot, work, q: [Nq] "rad", v: [Nv] "rad/s", place: [Of(3)] "m", weights: [Nv] "1/(N·m)²")
        -> (cost: [] "1", diagonal: [Nv] "kg·m²") {
        let n = robot.nv();
        let (mut tau, mut matrix, mut p) = (vec![S::zero(); n], vec![S::zero(); n * n], [S::zero(); 3]);
        inverse_dynamics(robot, work, q, v, v, &mut tau);
        for (tau, weight) in tau.iter().zip(weights) {
            cost[0] += S::from_f64(0.5) * *weight * *tau * *tau;
        }
        center_of_mass(robot, work, q, &mut p);
        let mut square = S::zero();
        for (p, place) in p.iter().zip(place) {
            let off = *p - *place + S::from_f64(this.offset);
            square += off * off;
        }
        cost[0] += square.sqrt();
        mass_matrix(robot, work, q, &mut matrix);
        for k in 0..n {
            let own = matrix[k * n + k];
            diagonal[k] = S::select((own - S::from_f64(0.1)).positive(), own, S::from_f64(0.1));
        }
    }
}

const WALKER: &str = include_str!("../../robots/walker.urdf");

fn request(functions: &[&str]) -> Request {
    let mut request = Request::new("walker.urdf", WALKER);
    request.options.robot.base = Base::Floating;
    request.options.users.push(Effort { offset: 0.25 });
    request.options.functions = functions.iter().map(|f| (*f).into()).collect();
    request
}

/// Arguments: those of the function.
fn numbers(model: &Model<f64>) -> Vec<Vec<f64>> {
    let mut random = Random::new(8);
    let state = Case::new("walker", read(WALKER), Base::Floating).state(&mut random);
    vec![state.q, state.v, random.vector(3, -1.0, 1.0), random.vector(model.nv(), 0.5, 1.0)]
}

fn called<S: Scalar>(model: &Model<f64>, given: &[Vec<S>]) -> Vec<S> {
    let model = model.cast::<S>();
    let slices: Vec<&[S]> = given.iter().map(Vec::as_slice).collect();
    let mut out = vec![S::zero(); 1 + model.nv()];
    Effort { offset: 0.25 }.call(&model, &mut Workspace::new(&model), &slices, &mut out).unwrap();
    out
}

#[test]
fn generated_code_of_a_users_function_gives_what_it_gives_on_numbers() {
    let generated = generate(&request(&["effort", "fixed = effort(v = 0)", "both = effort + mass_matrix"])).unwrap();
    let given = numbers(&generated.model);
    let expected = called(&generated.model, &given);
    let found = generated.graphs[0].evaluate(|argument, k| given[argument][k]);
    let close = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-11 * b.abs().max(1.0));
    assert!(close(&found, &expected), "{found:?} {expected:?}");
    assert!(generated.ledger.functions[0].lanes > 1, "limbs are computed side by side");
    let still: Vec<Vec<f64>> = given.iter().enumerate().map(|(k, x)| if k == 1 { vec![0.0; x.len()] } else { x.clone() }).collect();
    let fixed = generated.graphs[1].evaluate(|argument, k| given[[0, 2, 3][argument]][k]);
    assert!(close(&fixed, &called(&generated.model, &still)));
    // A struct with a field for each result, and documentation from the function.
    for part in
        ["pub struct Effort {", "pub cost: f64,", "pub diagonal: [f64; NV],", "/// c = ½ τᵀ W τ + |p − place|", "place: `[f64; 3]` m."]
    {
        assert!(generated.source.contains(part), "{part}");
    }
}

#[test]
fn its_derivatives_are_those_of_dual_numbers() {
    let generated =
        generate(&request(&["pull = vjp(effort, v place)", "push = jvp(effort, v place)", "rows = jacobian(effort, place)"])).unwrap();
    let (model, given) = (&generated.model, numbers(&generated.model));
    let mut random = Random::new(3);
    let (n, dv, dplace) = (model.nv(), random.vector(model.nv(), -1.0, 1.0), random.vector(3, -1.0, 1.0));
    let weights = random.vector(1 + n, -1.0, 1.0);
    let mut moved: Vec<Vec<Dual<f64>>> = given.iter().map(|x| cast(x)).collect();
    for (place, direction) in [(1, &dv), (2, &dplace)] {
        moved[place].iter_mut().zip(direction).for_each(|(x, dx)| x.slope = *dx);
    }
    let expected: Vec<f64> = called(model, &moved).into_iter().map(|y| y.slope).collect();
    let push = generated.graphs[1].evaluate(|argument, k| match argument {
        4 => dv[k],
        5 => dplace[k],
        _ => given[argument][k],
    });
    let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    assert!(push.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-11 * scale), "{push:?} {expected:?}");
    let names: Vec<&str> = generated.ledger.functions[0].arguments.iter().map(|a| a.name()).collect();
    assert_eq!(names, ["q", "v", "place", "weights", "weights_cost", "weights_diagonal"]);
    let pull = generated.graphs[0].evaluate(|argument, k| match argument {
        4 => weights[0],
        5 => weights[1 + k],
        _ => given[argument][k],
    });
    let (left, right) = (
        pull.iter().zip(dv.iter().chain(&dplace)).map(|(a, b)| a * b).sum::<f64>(),
        expected.iter().zip(&weights).map(|(a, b)| a * b).sum::<f64>(),
    );
    assert!((left - right).abs() < 1e-11 * scale * 10.0, "{left} {right}");
    let rows = generated.graphs[2].evaluate(|argument, k| given[argument][k]);
    let along: f64 = rows[..3].iter().zip(&dplace).map(|(a, b)| a * b).sum();
    let mut only: Vec<Vec<Dual<f64>>> = given.iter().map(|x| cast(x)).collect();
    only[2].iter_mut().zip(&dplace).for_each(|(x, dx)| x.slope = *dx);
    assert!((along - called(model, &only)[0].slope).abs() < 1e-11 * scale);
    assert_eq!(rows.len(), 3 + 3 * n);
}

#[test]
fn c_has_an_array_for_each_result() {
    let mut request = request(&["effort", "pull = vjp(effort, q)"]);
    request.options.target = Target::C(COptions::default());
    let generated = generate(&request).unwrap();
    let header = &generated.files[0].text;
    for part in ["const double place[3]", "double cost[1]", "double diagonal[WALKER_NV]", "void walker_pull("] {
        assert!(header.contains(part), "{part}\n{header}");
    }
}

/// Seeds of the second result are an array of their own.
#[test]
fn seeds_of_casadi_fit_their_arrays() {
    let mut request = request(&["effort"]);
    request.options.target = Target::C(COptions { casadi: true, derivatives: Some(2), ..COptions::default() });
    let source = generate(&request).unwrap().source;
    let numbers = |text: &str| -> Vec<usize> { text.split([',', ' ', '\n']).filter_map(|word| word.parse().ok()).collect() };
    for function in ["adj1_effort", "jac_adj1_effort"] {
        let (_, body) = source.split_once(&format!("EXPORT int {function}(")).expect("it is exported");
        for part in body.split_once("\n}\n").unwrap().0.split("double seed_").skip(1) {
            let (number, rest) = part.split_once('[').unwrap();
            let size: usize = rest.split_once(']').unwrap().0.parse().unwrap();
            let table = source.split_once(&format!("{function}_places_in_{number}[")).expect("a table of places").1;
            let places = numbers(table.split_once('{').unwrap().1.split_once('}').unwrap().0);
            assert!(!places.is_empty() && places.iter().all(|place| *place < size), "{function} {number}: {size} {places:?}");
        }
    }
}

user_function! {
    /// Arguments in another order than the table's.
    struct Turned;
    fn turned<S>(robot, work, place: [Of(3)] "m", v: [Nv] "rad/s", q: [Nq] "rad") -> (energy: [] "J") {
        kinetic_energy(robot, work, q, v, energy);
        energy[0] *= place[0];
    }
}

#[test]
fn a_function_keeps_the_order_of_its_arguments() {
    let mut users = UserFunctions::default();
    users.push(Turned);
    let names = |text: &str| FunctionSpec::parse_with(text, &users).unwrap().arguments().iter().map(|a| a.name()).collect::<Vec<_>>();
    assert_eq!(names("turned"), ["place", "v", "q"]);
    assert_eq!(names("g = jvp(turned, q v)"), ["place", "v", "q", "dv", "dq"]);
    assert_eq!(names("both = mass_matrix + turned"), ["q", "v", "place"]);
    // Numbers that follow each other in either order.
    let mut request = request(&["g = gradient(turned, q place)"]);
    request.options.users = users.clone();
    let generated = generate(&request).unwrap();
    let given = numbers(&generated.model);
    let of = [&given[2], &given[1], &given[0]];
    let found = generated.graphs[0].evaluate(|argument, k| of[argument][k]);
    let (mut energy, mut work) = ([0.0], Workspace::new(&generated.model));
    kinetic_energy(&generated.model, &mut work, &given[0], &given[1], &mut energy);
    assert!((found[0] - energy[0]).abs() < 1e-10 * energy[0], "∂/∂place comes first: {found:?}");
}

user_function! {
    /// A name that a group has.
    struct Momentum;
    fn momentum<S>(robot, work, q: [Nq] "rad") -> (out_1: [] "1") {
        out_1[0] = q[0];
    }
}

user_function! {
    /// Ports with names that generated code uses.
    struct Odd;
    fn odd<S>(robot, work, q: [Nq] "rad", out: [] "1", x12: [] "1", double: [] "1") -> (double: [] "1", fine: [] "1") {
        fine[0] = q[0] + out[0] + x12[0];
    }
}

#[test]
fn ports_have_names_that_every_language_has_room_for() {
    let told = |function: fn(&mut UserFunctions)| {
        let mut request = request(&["mass_matrix"]);
        function(&mut request.options.users);
        generate(&request).map(|_| String::new()).unwrap_or_else(|e| e.to_string())
    };
    let odd = told(|users| users.push(Odd));
    assert!(odd.contains("`odd`: `out` is a name that generated code uses for itself"), "{odd}");
    let momentum = told(|users| users.push(Momentum));
    assert!(momentum.contains("`momentum`: is a name of the table of functions, or of a group"), "{momentum}");
    assert_eq!(told(|users| users.push(Effort { offset: 1.0 })), "");
}

/// A trait's function without results, as a user may write one, and a good one of the same name.
struct Empty;

impl UserFunction for Empty {
    const NAME: &'static str = "effort";
    const SUMMARY: &'static str = "nothing";
    const INPUTS: &'static [articulated_core::algorithm::Argument] = &[];
    const OUTPUTS: &'static [articulated_core::algorithm::Port] = &[];

    fn run<S: Scalar>(&self, _: &Model<S>, _: &mut Workspace<S>, _: &articulated_core::algorithm::Inputs<'_, S>, _: &mut [S]) {}
}

#[test]
fn a_function_replaces_an_earlier_one_of_its_name() {
    let mut request = request(&["effort"]);
    request.options.users.push(Empty);
    let told = generate(&request).map(|_| String::new()).unwrap_or_else(|e| e.to_string());
    assert!(told.contains("`effort`"), "{told}");
    request.options.users.push(Effort { offset: 0.25 });
    assert!(generate(&request).is_ok());
    assert_eq!(request.options.users.iter().filter(|function| function.name == "effort").count(), 1);
}

#[test]
fn requests_may_name_it_and_others_may_not_be_called_like_it() {
    let mut users = UserFunctions::default();
    users.push(Effort { offset: 0.0 });
    assert!(FunctionSpec::parse("effort").is_err());
    let spec = FunctionSpec::parse_with("g = hvp(effort, place)", &users).unwrap();
    assert_eq!(spec.transform.as_ref().map(|t| t.kind), Some(Derivative::Hvp));
    assert_eq!(spec.outputs().len(), 1);
    let told = |text: &str| FunctionSpec::parse_with(text, &users).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(told("g = gradient(effort)").contains("expected vjp, or jacobian"));
    assert!(told("effort(place = x)").contains("expected a constant"));
    assert!(told("efort").contains("unknown function `efort`"));
}
