//! Derivatives by transforms of graphs: against dual numbers in 96 digits, which share no code with
//! them, on random trees with every kind of joint and effect.
//!
//! For y = f(x), weights λ and directions s, r in the tangent space:
//!
//! ```text
//! jvp(s) = d f(x ⊕ εs)/dε,   vjp(λ)·s = λᵀ jvp(s),   hvp(λ, s)·r = ∂²(λᵀ f(x ⊕ (εs + ηr)))/∂ε∂η
//! ```

use articulated_codegen::{Derivative, FunctionSpec, Generated, Options, Request, generate};
use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Function, Needs, Workspace, functions, integrate};
use articulated_core::description::Base;
use articulated_core::dual::Dual;
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;
use articulated_reference::Big;
use articulated_tests::case::{Case, State, cast, read};
use articulated_tests::random::Random;
use articulated_tests::random_effects::random_effects;
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text;
use num_traits::Zero;

/// Error allowed, relative to the largest term: generated code has constants of double precision.
/// Seen: 2e-12.
const NEAR: f64 = 1e-10;

/// A direction for each argument of a function, in the tangent space.
type Directions = Vec<Vec<f64>>;

fn directions(function: &Function<Big>, model: &Model<f64>, random: &mut Random) -> Directions {
    let length = |a: &Argument| a.tangent_dims().iter().map(|d| d.len(model.shape())).product();
    function.takes.iter().map(|a| random.vector(length(a), -1.0, 1.0)).collect()
}

/// The result where the arguments are moved by steps.
fn moved<S: Scalar>(function: &str, model: &Model<f64>, state: &State, steps: &[Vec<S>]) -> Vec<S> {
    let (row, model) = (articulated_core::algorithm::function::<S>(function).expect("it is in the table"), model.cast::<S>());
    let mut work = Workspace::new(&model);
    let arguments: Vec<Vec<S>> = row
        .takes
        .iter()
        .zip(steps)
        .map(|(argument, step)| {
            let given: Vec<S> = cast(state.argument(*argument));
            if argument.is_configuration() {
                let mut out = given.clone();
                integrate(&model, &mut Workspace::new(&model), &given, step, &mut out);
                return out;
            }
            given.into_iter().zip(step).map(|(x, dx)| x + *dx).collect()
        })
        .collect();
    let given: Vec<&[S]> = arguments.iter().map(Vec::as_slice).collect();
    let mut out = vec![S::zero(); row.len(model.shape())];
    row.call(&model, &mut work, &given, &mut out).expect("the robot has the function");
    out
}

/// d f(x ⊕ εs)/dε.
fn slope(function: &str, model: &Model<f64>, state: &State, along: &Directions) -> Vec<Big> {
    let step: Vec<Vec<Dual<Big>>> = along.iter().map(|s| s.iter().map(|x| Dual::new(Big::zero(), Big::from_f64(*x))).collect()).collect();
    moved(function, model, state, &step).into_iter().map(|y| y.slope).collect()
}

/// ∂² f(x ⊕ (εs + ηr))/∂ε∂η.
fn curvature(function: &str, model: &Model<f64>, state: &State, [one, other]: [&Directions; 2]) -> Vec<Big> {
    let both = |(s, r): (&Vec<f64>, &Vec<f64>)| {
        let step = |(s, r): (&f64, &f64)| Dual::new(Dual::new(Big::zero(), Big::from_f64(*s)), Dual::constant(Big::from_f64(*r)));
        s.iter().zip(r).map(step).collect()
    };
    let steps: Vec<Vec<Dual<Dual<Big>>>> = one.iter().zip(other).map(both).collect();
    moved(function, model, state, &steps).into_iter().map(|y| y.slope.slope).collect()
}

/// Results of generated function `place`. Its arguments are those of the table, weights,
/// directions.
fn found(generated: &Generated, place: usize, state: &State, weights: &[f64], along: &Directions) -> Vec<Big> {
    let arguments = &generated.ledger.functions[place].arguments;
    let table = arguments.iter().filter(|a| !state.argument(**a).is_empty() || Argument::ALL.contains(a)).count();
    let takes_weights = arguments.get(table).is_some_and(|a| a.name() == "weights");
    generated.graphs[place].evaluate_as(|argument, k| {
        Big::from_f64(match argument {
            a if a < table => state.argument(arguments[a])[k],
            a if takes_weights && a == table => weights[k],
            a => along[a - table - usize::from(takes_weights)][k],
        })
    })
}

fn dot(a: &[Big], b: impl IntoIterator<Item = f64>) -> (Big, f64) {
    let terms: Vec<Big> = a.iter().zip(b).map(|(x, y)| *x * Big::from_f64(y)).collect();
    let size = terms.iter().map(|x| x.to_f64().abs()).sum();
    (terms.into_iter().fold(Big::zero(), |sum, x| sum + x), size)
}

/// Which derivatives of a function are tested.
fn kinds(function: &Function<Big>) -> Vec<Derivative> {
    let mut kinds = vec![Derivative::Vjp, Derivative::Jvp];
    if function.gives.is_empty() {
        kinds.push(Derivative::Gradient);
    }
    let with_hessian =
        ["inverse_dynamics", "forward_dynamics", "kinetic_energy", "potential_energy", "placements", "center_of_mass", "integrate"];
    if with_hessian.contains(&function.name) {
        kinds.extend([Derivative::Hvp, Derivative::Hessian]);
    }
    if ["inverse_dynamics", "forward_dynamics", "center_of_mass", "potential_energy", "twists_world"].contains(&function.name) {
        kinds.push(Derivative::Jacobian);
    }
    kinds
}

/// The largest error of any derivative of any function that the robot has; `only` of these, with
/// limbs in lanes, if there are any.
fn check(name: &str, urdf: &str, base: Base, effects: Vec<Applied>, only: &[&str], random: &mut Random) -> f64 {
    let mut case = Case::new(name, read(urdf), base);
    let frame = case.model.frames().iter().last().expect("a link").name.clone();
    case.model = case.model.with_effects(&effects).expect("effects that can be had").with_frames(std::slice::from_ref(&frame)).unwrap();
    let has = |f: &Function<Big>| match f.needs {
        Needs::FreeFrames => false,
        Needs::Mass => case.model.moving_mass() > 0.0,
        Needs::Nothing | Needs::MassMatrix => true,
    };
    // Of the others the general function has the same derivatives.
    let is_tested = |f: &Function<Big>| (f.id == f.general || kinds(f).len() > 2) && f.name != "random_configuration" && has(f);
    let is_tested = |f: &Function<Big>| is_tested(f) && (only.is_empty() || only.contains(&f.name));
    let tested: Vec<(&Function<Big>, Derivative)> =
        functions::<Big>().iter().filter(|f| is_tested(f)).flat_map(|f| kinds(f).into_iter().map(move |kind| (f, kind))).collect();
    let mut request = Request::new(format!("{name}.urdf"), urdf);
    request.options = Options { limbs: !only.is_empty(), ..Options::default() };
    request.options.robot.base = base;
    request.options.robot.effects = effects;
    request.options.robot.set_frames([frame]);
    let text = |(k, (f, kind)): (usize, &(&Function<Big>, Derivative))| format!("d{k} = {}({})", kind.name(), f.name).into();
    request.options.functions = tested.iter().enumerate().map(text).collect();
    let generated = generate(&request).unwrap_or_else(|e| panic!("{name}: {e}"));
    let state = case.state(random);
    let mut worst = 0.0_f64;
    for (place, (function, kind)) in tested.into_iter().enumerate() {
        let (along, other) = (directions(function, &case.model, random), directions(function, &case.model, random));
        let results = function.len(case.model.shape());
        let weights = if kind == Derivative::Gradient { vec![1.0] } else { random.vector(results, -1.0, 1.0) };
        let values = found(&generated, place, &state, &weights, &along);
        let flat: Vec<f64> = other.concat();
        let pairs: Vec<((Big, f64), (Big, f64))> = match kind {
            Derivative::Jvp => {
                let expected = slope(function.name, &case.model, &state, &along);
                let largest = expected.iter().map(|x| x.to_f64().abs()).fold(1.0, f64::max);
                values.iter().zip(expected).map(|(found, expected)| ((*found, largest), (expected, largest))).collect()
            }
            Derivative::Vjp | Derivative::Gradient => {
                let expected = slope(function.name, &case.model, &state, &other);
                vec![(dot(&values, flat.iter().copied()), dot(&expected, weights.iter().copied()))]
            }
            Derivative::Hvp => {
                let expected = curvature(function.name, &case.model, &state, [&along, &other]);
                vec![(dot(&values, flat.iter().copied()), dot(&expected, weights.iter().copied()))]
            }
            Derivative::Hessian => {
                let expected = curvature(function.name, &case.model, &state, [&along, &other]);
                let (mut sum, mut size, mut at) = (Big::zero(), 0.0, 0);
                for rows in &other {
                    for columns in &along {
                        for r in rows {
                            let (value, terms) = dot(&values[at..at + columns.len()], columns.iter().map(|s| s * r));
                            (sum, size, at) = (sum + value, size + terms, at + columns.len());
                        }
                    }
                }
                vec![((sum, size), dot(&expected, weights.iter().copied()))]
            }
            Derivative::Jacobian => {
                let expected = slope(function.name, &case.model, &state, &other);
                let largest = expected.iter().map(|x| x.to_f64().abs()).fold(1.0, f64::max);
                let (mut sums, mut at) = (vec![(Big::zero(), largest); results], 0);
                for part in &other {
                    for sum in &mut sums {
                        let (value, size) = dot(&values[at..at + part.len()], part.iter().copied());
                        *sum = (sum.0 + value, sum.1.max(size));
                        at += part.len();
                    }
                }
                sums.into_iter().zip(expected).map(|(found, expected)| (found, (expected, largest))).collect()
            }
        };
        for ((found, size), (expected, other)) in pairs {
            let far = (found - expected).to_f64().abs() / size.max(other).max(1.0);
            assert!(far < NEAR, "{name}: {} of {}: {} instead of {}", kind.name(), function.name, found.to_f64(), expected.to_f64());
            worst = worst.max(far);
        }
    }
    worst
}

#[test]
fn derivatives_of_every_function_are_those_of_dual_numbers() {
    let mut worst = 0.0_f64;
    for seed in 0..4 {
        let base = if seed % 2 == 0 { Base::Fixed } else { Base::Floating };
        let flavour = Flavour { massless: false, links: 5, ..Flavour::WRITTEN };
        let urdf = urdf_text(&random_tree(300 + seed, flavour));
        let mut random = Random::new(seed);
        let model = Case::new("tree", read(&urdf), base).model;
        let effects = if seed < 2 { Vec::new() } else { random_effects(&mut random, &model, |effect| effect != EffectId::motor) };
        worst = worst.max(check(&format!("tree_{seed}"), &urdf, base, effects, &[], &mut random));
    }
    println!("largest error {worst:.1e}");
}

#[test]
fn limbs_in_lanes_have_the_same_derivatives() {
    let walker = include_str!("../../robots/walker.urdf");
    let only = ["inverse_dynamics", "forward_dynamics", "kinetic_energy", "center_of_mass"];
    println!("largest error {:.1e}", check("walker", walker, Base::Floating, Vec::new(), &only, &mut Random::new(5)));
}

/// In coordinates a derivative is that of f(q/|q|).
#[test]
fn derivatives_in_coordinates_are_by_the_numbers_of_q() {
    let urdf = "<robot name='stone'><link name='stone'><inertial><origin xyz='0.1 0.2 0.3'/><mass value='2'/>\
        <inertia ixx='0.1' ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.3'/></inertial></link></robot>";
    let mut request = Request::new("stone.urdf", urdf);
    request.options.robot.base = Base::Floating;
    request.options.functions = vec!["g = gradient(potential_energy, q in coordinates)".into()];
    let generated = generate(&request).unwrap();
    let q = [0.3, -0.2, 0.5, 0.1, 0.3, -0.2, 0.9];
    let found = generated.graphs[0].evaluate(|_, k| q[k]);
    // U = m g (z + row 3 of R times c) at the quaternion p = q/|q|, and ∂p/∂q = (1 − p pᵀ)/|q|:
    // R_3 = (2 (x z − w y), 2 (y z + w x), 1 − 2 (x² + y²))
    let length = q[3..].iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
    let (mg, [x, y, z, w], c) = (2.0 * 9.81, [3, 4, 5, 6].map(|k| q[k] / length), [0.1, 0.2, 0.3]);
    let by = |rows: [f64; 3]| mg * (rows[0] * c[0] + rows[1] * c[1] + rows[2] * c[2]);
    let by_p =
        [by([2.0 * z, 2.0 * w, -4.0 * x]), by([-2.0 * w, 2.0 * z, -4.0 * y]), by([2.0 * x, 2.0 * y, 0.0]), by([-2.0 * y, 2.0 * x, 0.0])];
    let p = [x, y, z, w];
    let along: f64 = by_p.iter().zip(p).map(|(d, p)| d * p).sum();
    let by_q = [0, 1, 2, 3].map(|k| (by_p[k] - along * p[k]) / length);
    let expected = [&[0.0, 0.0, mg][..], &by_q].concat();
    assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
}

#[test]
fn requests_for_derivatives_are_checked() {
    let told = |text: &str| FunctionSpec::parse(text).err().map(|e| e.to_string()).unwrap_or_default();
    for (text, part) in [
        ("vjp(inverse_dynamics)", "a derivative needs a name"),
        ("g = vjp(inverse_dynamics, tau)", "`tau`: expected some of q v a"),
        ("g = vjp(inverse_dynamics, q q)", "`q` is given twice"),
        ("g = vjp(inverse_dynamics(a = 0), a)", "`a`: expected some of q v"),
        ("g = gradient(inverse_dynamics)", "expected vjp, or jacobian"),
        ("g = vjp(mass_matrix + placements)", "takes one function, and not a sum"),
        ("g = vjp(gravity_torque(q = 0))", "takes no arguments to differentiate by"),
        ("g = vjp(mass_matrx)", "did you mean `mass_matrix`?"),
        ("g = vjp(mass_matrix", "expected `)`"),
        ("mass_matrix = vjp(mass_matrix)", "what another function is called"),
    ] {
        assert!(told(text).contains(part), "{text}: {}", told(text));
    }
    let spec = FunctionSpec::parse("g = hvp ( inverse_dynamics ( a = 0 ) , v , q )").unwrap();
    let names: Vec<&str> = spec.arguments().iter().map(|a| a.name()).collect();
    assert_eq!(names, ["q", "v", "weights", "dq", "dv"]);
    assert_eq!(spec.outputs().iter().map(|output| output.name).collect::<Vec<_>>(), ["hvp_q", "hvp_v"]);
}
