//! Generated C, against the generic library and the graph, for every function.

use std::sync::LazyLock;

use articulated_codegen::{COptions, Options, Real, Target, generate};
use articulated_core::algorithm::{Shape, functions};
use articulated_core::description::Base;
use articulated_tests::c_program::{self, Vectors};
use articulated_tests::measure::{arguments, error};
use articulated_tests::program::Program;
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text;

use crate::robots::{Robot, single_states, with};

/// Functions so long that they are cut into pieces.
const LONG: [&str; 2] = ["coriolis_matrix", "mass_matrix_inverse"];

/// An arm in each level, every kind of joint on a floating base, limbs, joints that follow others,
/// long functions, and a link alone.
static ROBOTS: LazyLock<Vec<Robot>> = LazyLock::new(|| robots(false));

fn robots(header_only: bool) -> Vec<Robot> {
    let robot = |name: &str, urdf: &str, base: Base, level: &str, wanted: &dyn Fn(&str) -> bool| {
        let target = Target::C(COptions {
            prefix: Some(name.to_owned()),
            header_only,
            casadi: false,
            derivatives: None,
            no_libm: header_only || name.contains("own_math"),
        });
        // Headers are checked for warnings with all that they can have.
        let batch = if header_only { vec![Real::F64, Real::F32] } else { Vec::new() };
        let options = Options { target, batch, level: level.parse().expect("a level"), ..Options::default() };
        with(name.into(), urdf, base, false, options, wanted)
    };
    let bundled = |name: &str| articulated_models::robot(name).expect("a bundled robot").urdf;
    let tree = urdf_text(&random_tree(102, Flavour { massless: false, ..Flavour::WRITTEN }));
    let stone = "<robot name='stone'><link name='stone'/></robot>";
    let all = |_: &str| true;
    vec![
        robot("arm", bundled("ur5_like"), Base::Fixed, "f64", &all),
        robot("arm_single", bundled("ur5_like"), Base::Fixed, "f32", &all),
        robot("arm_by_double", bundled("ur5_like"), Base::Fixed, "f32_f64", &all),
        robot("tree", &tree, Base::Floating, "f64", &all),
        robot("gripper_arm", bundled("gripper_arm"), Base::Fixed, "f64", &all),
        robot("quadruped", bundled("quadruped"), Base::Floating, "f64", &|name| !name.contains("derivatives")),
        robot("humanoid", bundled("humanoid"), Base::Floating, "f64", &|name| LONG.contains(&name)),
        robot("tree_own_math", &tree, Base::Floating, "f64", &all),
        robot("arm_single_own_math", bundled("ur5_like"), Base::Fixed, "f32", &|name| !name.contains("derivatives")),
        robot("stone", stone, Base::Fixed, "f64", &all),
    ]
}

/// Without optimisation, which takes a minute: a test that is ignored optimises.
static PROGRAM: LazyLock<Program> = LazyLock::new(|| program("-O0"));

fn program(level: &str) -> Program {
    let shape = |robot: &Robot| robot.case.model.shape();
    let all: Vec<(&str, Shape, _)> = ROBOTS.iter().map(|r| (r.name.as_str(), shape(r), &r.generated)).collect();
    let program = c_program::build(&all, Vectors::Any, level);
    println!("compiled {} robots in {:.1?}", all.len(), program.time);
    program
}

/// Functions of every kind of argument and result; few, since they are compiled in three ways.
const SOME: [&str; 10] = [
    "placements",
    "twists_body",
    "inverse_dynamics",
    "inverse_dynamics_with_wrenches",
    "mass_matrix",
    "forward_dynamics",
    "kinetic_energy",
    "torque_regressor",
    "integrate",
    "difference",
];

/// Robots with functions of many states and limbs in lanes, in each way in which their C can be
/// compiled on this machine.
static MANY: LazyLock<Vec<Robot>> = LazyLock::new(|| {
    let robot = |name: &str, urdf: &str, base: Base, level: &str, own_math: bool, wanted: &dyn Fn(&str) -> bool| {
        let target = Target::C(COptions { prefix: Some(name.to_owned()), no_libm: own_math, ..COptions::default() });
        let batch = vec![Real::F64, Real::F32];
        let options = Options { target, batch, level: level.parse().expect("a level"), ..Options::default() };
        with(name.into(), urdf, base, false, options, wanted)
    };
    let bundled = |name: &str| articulated_models::robot(name).expect("a bundled robot").urdf;
    let tree = urdf_text(&random_tree(102, Flavour { massless: false, ..Flavour::WRITTEN }));
    let some = |name: &str| SOME.contains(&name);
    vec![
        robot("arm", include_str!("../../robots/arm.urdf"), Base::Fixed, "f64", false, &|name| some(name) || name == "coriolis_matrix"),
        robot("arm_own_math", include_str!("../../robots/arm.urdf"), Base::Fixed, "f32_f64", true, &some),
        robot("tree", &tree, Base::Floating, "f64", false, &|name| ["placements", "inverse_dynamics", "difference"].contains(&name)),
        robot("gripper_arm", bundled("gripper_arm"), Base::Fixed, "f64", false, &|name| {
            ["inverse_dynamics", "mass_matrix"].contains(&name)
        }),
        robot("quadruped", bundled("quadruped"), Base::Floating, "f64", false, &|name| ["inverse_dynamics", "mass_matrix"].contains(&name)),
        robot("strider", include_str!("../../robots/strider.urdf"), Base::Floating, "f64", false, &|name| {
            ["inverse_dynamics", "jacobians_world_aligned", "forward_dynamics_derivatives"].contains(&name)
        }),
        robot("seven_axes", bundled("panda_like"), Base::Fixed, "f64", false, &|name| name == "forward_dynamics_derivatives"),
        robot("stone", "<robot name='stone'><link name='stone'/></robot>", Base::Fixed, "f64", false, &some),
    ]
});

static WAYS: LazyLock<Vec<(Vectors, Program)>> = LazyLock::new(|| {
    let all: Vec<(&str, Shape, _)> = MANY.iter().map(|r| (r.name.as_str(), r.case.model.shape(), &r.generated)).collect();
    let ways = [Vectors::Any, Vectors::Own, Vectors::None];
    ways.into_iter().map(|vectors| (vectors, c_program::build(&all, vectors, "-O0"))).collect()
});

/// States one after the other, and in blocks with an incomplete last one.
#[test]
fn c_of_many_states_gives_what_the_generic_library_gives() {
    // In units of roundoff of the type: 3.6 were seen in f64, and 17 in f32, for a Coriolis matrix
    // without fused multiply-adds.
    const ALLOWED: [f64; 2] = [8.0, 32.0];
    for (vectors, program) in WAYS.iter() {
        for (robot, real) in MANY.iter().flat_map(|r| [(r, Real::F64), (r, Real::F32)]) {
            let (unit, allowed) = match real {
                Real::F32 => (f64::from(f32::EPSILON) / f64::EPSILON, ALLOWED[1]),
                Real::F64 => (1.0, ALLOWED[0]),
            };
            let states = single_states(robot, 37);
            for form in ["batch", "blocks"] {
                let mut worst = (0.0, "");
                for name in robot.functions() {
                    let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
                    let call = format!("{name} {form} {}", real.name());
                    for (state, found) in states.iter().zip(program.run(&robot.name, &call, &given)) {
                        let far = error(&robot.case, name, state, &found) / unit;
                        worst = if far > worst.0 { (far, name) } else { worst };
                    }
                }
                println!("{vectors:?} {} {real:?} {form}: {:.1} units of roundoff in {}", robot.name, worst.0, worst.1);
                assert!(worst.0 <= allowed, "{vectors:?} {} {real:?} {form}: {} units of roundoff in {}", robot.name, worst.0, worst.1);
            }
        }
    }
}

/// The single functions of the same robots, with limbs in lanes, with the processor's own vectors
/// and without any.
#[test]
fn c_with_and_without_vectors_gives_what_the_generic_library_gives() {
    let in_lanes = MANY.iter().filter(|r| r.generated.source.contains("_LIMBS\n")).count();
    assert!(in_lanes >= 2, "{in_lanes} robots have limbs in lanes");
    let solves = MANY.iter().filter(|r| r.generated.source.contains("_columns(out);")).count();
    assert!(solves >= 2, "{solves} robots solve for many columns in a loop");
    for (vectors, program) in WAYS.iter() {
        for robot in MANY.iter() {
            let unit = if robot.generated.level.is_single() { f64::from(f32::EPSILON) / f64::EPSILON } else { 1.0 };
            let states = single_states(robot, STATES);
            for name in robot.functions() {
                let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
                for (state, found) in states.iter().zip(program.run(&robot.name, name, &given)) {
                    let far = error(&robot.case, name, state, &found) / unit;
                    assert!(far <= 64.0, "{vectors:?} {name} of {}: {far} units of roundoff", robot.name);
                }
            }
        }
    }
}

/// Angles beyond the fast reduction, and NaN or infinity, change no other state.
#[test]
fn a_state_in_c_ignores_its_neighbours() {
    let robot = &MANY[0];
    let good = single_states(robot, 37);
    for (vectors, program) in WAYS.iter() {
        for real in ["f64", "f32"] {
            let mut mixed = good.clone();
            for (state, x) in mixed.iter_mut().step_by(3).zip([f64::NAN, f64::INFINITY, 1e15, -3e5].into_iter().cycle()) {
                state.q[1] = x;
            }
            let run = |states: &[articulated_tests::case::State]| {
                let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments("inverse_dynamics", s)).collect();
                program.run("arm", &format!("inverse_dynamics batch {real}"), &given)
            };
            for (k, (expected, found)) in run(&good).iter().zip(&run(&mixed)).enumerate() {
                let q = mixed[k].q[1];
                match k % 3 {
                    0 if q.is_finite() => {
                        let mut state = mixed[k].clone();
                        state.q[1] = if real == "f32" { f64::from(q as f32) } else { q };
                        let unit = if real == "f32" { f64::from(f32::EPSILON) / f64::EPSILON } else { 1.0 };
                        let far = error(&robot.case, "inverse_dynamics", &state, found) / unit;
                        assert!(far <= 8.0, "{vectors:?} {real} at {q} rad: {far} units of roundoff");
                    }
                    0 => assert!(found[0].is_nan() || found[1].is_nan(), "{vectors:?} {real} at {q}"),
                    _ => assert_eq!(expected, found, "state {k}, {vectors:?} {real}"),
                }
            }
        }
    }
}

const STATES: usize = 8;

#[test]
fn c_gives_what_the_generic_library_gives() {
    compare(&PROGRAM);
}

#[test]
#[ignore = "the same as optimised code, which takes a compiler minutes: cargo test … -- --ignored"]
fn so_does_optimised_c() {
    compare(&program("-O2"));
}

fn compare(program: &Program) {
    for robot in ROBOTS.iter() {
        let single = robot.generated.level.is_single();
        // In doubles 14 units of roundoff were seen, in singles 40.
        let (unit, allowed) = if single { (f64::from(f32::EPSILON) / f64::EPSILON, 128.0) } else { (1.0, 64.0) };
        let states = single_states(robot, STATES);
        let mut worst = (0.0, "");
        for name in robot.functions() {
            let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
            for (state, found) in states.iter().zip(program.run(&robot.name, name, &given)) {
                let far = error(&robot.case, name, state, &found) / unit;
                worst = if far > worst.0 { (far, name) } else { worst };
            }
        }
        println!("{}: {:.1} units of roundoff in {}", robot.name, worst.0, worst.1);
        assert!(worst.0 <= allowed, "{} of {}: {} units of roundoff", worst.1, robot.name, worst.0);
    }
}

/// With products and sums rounded separately, only sines of the two mathematical libraries may
/// differ.
#[test]
fn c_computes_what_the_graph_does() {
    for robot in ROBOTS.iter().filter(|r| !r.generated.level.is_single()) {
        let states = single_states(robot, STATES);
        for (name, graph) in robot.functions().zip(&robot.generated.graphs) {
            let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
            for (given, found) in given.iter().zip(PROGRAM.run(&robot.name, name, &given)) {
                let expected = graph.evaluate(|argument, k| given[argument][k]);
                let scale = expected.iter().fold(f64::MIN_POSITIVE, |max: f64, x| max.max(x.abs()));
                let far = expected.iter().zip(&found).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max);
                assert!(
                    far <= 1e-12 && expected.len() == found.len(),
                    "{name} of {}: {far:e}, {} of {}",
                    robot.name,
                    expected.len(),
                    found.len()
                );
            }
        }
    }
}

/// One header for each robot, by each compiler of C and C++ that is there.
#[test]
fn headers_compile_without_a_warning_as_c_and_as_cplusplus() {
    let (robots, mut compilers) = (robots(true), 0);
    for (compiler, language) in [("gcc", "c99"), ("clang", "c99"), ("g++", "c++17"), ("clang++", "c++17")] {
        if c_program::is_there(compiler) {
            robots.iter().for_each(|robot| c_program::check_header(compiler, language, &robot.generated.files[0]));
            compilers += 1;
        } else {
            println!("not run: {compiler}, which is not installed");
        }
    }
    assert!(compilers > 0, "a compiler of C is there");
}

/// Each level with mathematical functions of its own and with those of the library, alone and with
/// batches: what no function calls is not there.
#[test]
fn sources_compile_without_a_warning_of_a_function_that_is_not_called() {
    let compilers: Vec<&str> = ["gcc", "clang"].into_iter().filter(|compiler| c_program::is_there(compiler)).collect();
    assert!(!compilers.is_empty(), "a compiler of C is there");
    let urdf = articulated_models::robot("ur5_like").expect("a bundled robot").urdf;
    for (level, no_libm) in ["f64", "f32", "f32_f64"].into_iter().flat_map(|level| [(level, false), (level, true)]) {
        for names in
            [&["inverse_dynamics"][..], &["mass_matrix"], &["forward_dynamics_derivatives", "difference", "energy_like = kinetic_energy"]]
        {
            for batch in [vec![], vec![Real::F32]] {
                let mut request = articulated_codegen::Request::new("arm.urdf", urdf);
                let target = Target::C(COptions { prefix: Some("arm".into()), no_libm, ..COptions::default() });
                let functions = names.iter().map(|name| (*name).into()).collect();
                request.options = Options { target, functions, batch, level: level.parse().expect("a level"), ..Options::default() };
                let files = generate(&request).expect("a robot").files;
                compilers.iter().for_each(|compiler| c_program::check_source(compiler, &files));
            }
        }
    }
}

/// The first program of docs/embedded.md, as printed, with the robot of the README.
#[test]
fn the_program_of_the_documentation_compiles_and_prints_what_the_library_computes() {
    let page = include_str!("../../../docs/embedded.md");
    let (_, rest) = page.split_once("```c\n").expect("a program");
    let (program, _) = rest.split_once("```").expect("its end");
    let mut request = articulated_codegen::Request::new("robots/arm.urdf", include_str!("../../robots/arm.urdf"));
    request.options.functions = vec!["inverse_dynamics".into(), "mass_matrix".into()];
    request.options.target = Target::C(COptions { prefix: Some("arm".into()), ..COptions::default() });
    let generated = generate(&request).expect("a robot");
    let printed = c_program::run_program(program, &generated.files);
    let mut q = vec![0.0; generated.model.nq()];
    q[generated.model.joints().iter().find(|j| j.name == "elbow").expect("a joint").q.0] = 0.5;
    let zeros = vec![0.0; generated.model.nv()];
    let mut tau = zeros.clone();
    let function = articulated_core::algorithm::function::<f64>("inverse_dynamics").expect("a function");
    let mut workspace = articulated_core::algorithm::Workspace::new(&generated.model);
    function.call(&generated.model, &mut workspace, &[&q, &zeros, &zeros], &mut tau).expect("lengths that fit");
    let expected: String = tau.iter().map(|x| format!("{x:.3}\n")).collect();
    assert_eq!(printed, expected);
    assert!(tau.iter().any(|x| x.abs() > 0.1), "{tau:?}");
}

/// Several functions in one, an argument that is constant, and sines from the caller.
#[test]
fn c_of_groups_and_of_given_sines_computes_what_their_parts_do() {
    const MAIN: &str = "\
#include <math.h>
#include <stdio.h>
#include \"arm.h\"

static void print(const double *x, int count) {
    for (int k = 0; k < count; k++) {
        printf(\"%.17g\\n\", x[k]);
    }
}

int main(void) {
    const double q[ARM_NQ] = {0.3, -1.1, 2.0, 0.4, -0.7, 5.0};
    const double v[ARM_NV] = {1.0, -2.0, 0.5, 3.0, 0.25, -1.5};
    const double a[ARM_NV] = {-1.0, 0.5, 2.0, 1.0, -3.0, 0.75};
    const double zeros[ARM_NV] = {0.0};
    double sines[ARM_NQ * 2], tau[ARM_NV], mass[ARM_NV * ARM_NV];
    for (int k = 0; k < ARM_NQ; k++) {
        sines[2 * k] = sin(q[k]);
        sines[2 * k + 1] = cos(q[k]);
    }
    arm_inverse_dynamics(q, v, a, tau);
    print(tau, ARM_NV);
    arm_quick(q, v, a, sines, tau);
    print(tau, ARM_NV);
    arm_both(q, v, a, tau, mass);
    print(tau, ARM_NV);
    print(mass, ARM_NV * ARM_NV);
    arm_mass_matrix(q, mass);
    print(mass, ARM_NV * ARM_NV);
    arm_inverse_dynamics(q, v, zeros, tau);
    print(tau, ARM_NV);
    arm_bias(q, v, tau);
    print(tau, ARM_NV);
    return 0;
}
";
    let mut request = articulated_codegen::Request::new("arm.urdf", articulated_models::robot("ur5_like").expect("a bundled robot").urdf);
    let quick = "quick = inverse_dynamics(q = sin_cos)";
    let functions = ["inverse_dynamics", "mass_matrix", "both = inverse_dynamics + mass_matrix", quick, "bias = inverse_dynamics(a = 0)"];
    request.options.functions = functions.map(Into::into).to_vec();
    request.options.target = Target::C(COptions { prefix: Some("arm".into()), ..COptions::default() });
    let generated = generate(&request).expect("a robot");
    let (_, quick) = generated.files[1].text.split_once("arm_quick(").expect("the function");
    let quick = quick.split("\n}").next().unwrap_or_default();
    assert!(!quick.contains("sin(") && !quick.contains("cos("), "it takes the caller's: {quick}");
    let printed = c_program::run_program(MAIN, &generated.files);
    let numbers: Vec<f64> = printed.lines().map(|line| line.parse().expect("a number")).collect();
    let (n, mut rest) = (6, numbers.as_slice());
    let mut next = |count: usize| {
        let (first, others) = rest.split_at(count);
        rest = others;
        first
    };
    let (tau, quick, both, mass, alone) = (next(n), next(n), next(n), next(n * n), next(n * n));
    let (at_rest, bias) = (next(n), next(n));
    for (what, expected, found) in
        [("quick", tau, quick), ("both", tau, both), ("mass matrix of both", alone, mass), ("bias", at_rest, bias)]
    {
        let scale = expected.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let far = expected.iter().zip(found).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max);
        assert!(scale > 0.0 && far <= 1e-14, "{what}: {found:?}, expected {expected:?}");
    }
    assert_ne!(tau, at_rest);
}

#[test]
fn names_that_c_does_not_have_are_spelled_out() {
    let link = |name: &str| format!("<link name='{name}'/>");
    let joint = |name: &str, child: &str| {
        format!("<joint name='{name}' type='continuous'><parent link='base'/><child link='{child}'/><axis xyz='0 0 1'/></joint>")
    };
    let names = ["a-b", "a b", "*/ int x;", "größe", "int", "1"];
    let links: String = (0..names.len()).map(|k| link(&format!("l{k}"))).collect();
    let joints: String = names.iter().enumerate().map(|(k, name)| joint(name, &format!("l{k}"))).collect();
    let urdf = format!("<robot name='2 arms'>{}{links}{joints}</robot>", link("base"));
    let mut request = articulated_codegen::Request::new("arms.urdf", urdf);
    request.options.functions = vec!["mass_matrix".into()];
    request.options.target = Target::C(COptions { header_only: true, ..COptions::default() });
    let generated = generate(&request).expect("a robot");
    for part in
        ["ROBOT_2_ARMS_JOINT_AU2D_B = 0", "ROBOT_2_ARMS_JOINT_AU20_B = 1", "ROBOT_2_ARMS_JOINT_GR__E = 3", "ROBOT_2_ARMS_JOINT_INT = 4"]
    {
        assert!(generated.source.contains(part), "{part} in {}", generated.source);
    }
    c_program::check_header("cc", "c99", &generated.files[0]);
    request.options.rename = vec![("a-b".to_owned(), "x".to_owned()).into(), ("a b".to_owned(), "x".to_owned()).into()];
    let told = generate(&request).unwrap_err().to_string();
    assert!(told.contains("found X for the joints \"a-b\" and \"a b\", expected another name for one of them"), "{told}");
}

#[test]
fn every_function_is_in_the_header_with_its_units_and_lengths() {
    let arm = &ROBOTS[0].generated;
    let [header, source] = [0, 1].map(|k| &arm.files[k]);
    assert_eq!((header.name.as_str(), source.name.as_str()), ("arm.h", "arm.c"));
    for function in robot_functions() {
        assert!(header.text.contains(&format!("arm_{function}(")), "{function}");
    }
    for part in ["#define ARM_NV 6", "const double q[ARM_NQ]", "double out[ARM_NV * ARM_NV]", "@param v ARM_NV: rad/s|m/s", "extern \"C\""]
    {
        assert!(header.text.contains(part), "{part} in {}", header.text);
    }
    let outlined = ROBOTS.iter().any(|r| r.generated.source.contains("coriolis_matrix_piece_1("));
    assert!(outlined, "a long function is cut into pieces");
}

fn robot_functions() -> impl Iterator<Item = &'static str> {
    functions::<f64>().iter().map(|f| f.name).filter(|name| ROBOTS[0].functions().any(|own| own == *name))
}

#[test]
fn what_c_does_not_have_is_refused_with_what_it_has() {
    let mut request = articulated_codegen::Request::new("arm.urdf", articulated_models::robot("ur5_like").expect("a bundled robot").urdf);
    request.options.target = Target::C(COptions { prefix: Some("2nd".into()), ..COptions::default() });
    request.options.level = "double_double".parse().expect("a level");
    let told = generate(&request).unwrap_err().to_string();
    request.options.target = Target::C(COptions { header_only: true, casadi: true, prefix: Some("2nd".into()), ..COptions::default() });
    let with_casadi = generate(&request).unwrap_err().to_string();
    for part in ["abi: found double_double, expected level f64", "abi: found one header, expected a header and a source"] {
        assert!(with_casadi.contains(part), "{with_casadi}");
    }
    for part in ["level: found double_double, expected for target \"c\": f64, f32 or f32_f64", "prefix: found \"2nd\", expected a letter"] {
        assert!(told.contains(part), "{told}");
    }
}
