//! Robots at the limits: accepted ones, and refused ones.

use std::time::Instant;

use articulated_codegen::function_groups::Group;
use articulated_codegen::{Request, generate};
use articulated_core::algorithm::functions;
use articulated_core::description::Base;
use articulated_core::step::beside_the_table;
use articulated_tests::program::Program;

use crate::robots::{NATIVE, ROBOTS};

/// No coordinate: arrays without numbers, and placements that are constants.
#[test]
fn a_robot_that_cannot_move_is_generated_and_compiles() {
    let stone = ROBOTS.iter().find(|r| r.name == "stone").unwrap();
    assert_eq!((stone.generated.model.nq(), stone.generated.model.nv()), (0, 0));
    let found = NATIVE.run("stone", "inverse_dynamics", &[vec![&[], &[], &[]]]);
    assert_eq!(found, [Vec::<f64>::new()]);
    let found = NATIVE.run("stone", "placements", &[vec![&[]]]);
    assert_eq!(found, [[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]);
}

/// Its time as in a build script, unoptimised:
/// `cargo test -p articulated-tests --test generated -- --nocapture a_chain_of_a_thousand` with
/// `--config profile.dev.package.articulated-core.opt-level=0` and the same of `articulated-codegen`.
#[test]
fn a_chain_of_a_thousand_joints_is_generated() {
    let n = 1000;
    let request = chain(n, "inverse_dynamics");
    let start = Instant::now();
    let generated = generate(&request).unwrap();
    let operations = generated.ledger.functions[0].emitted().instructions();
    println!("1000 joints: {operations} instructions generated in {:.1?}", start.elapsed());
    assert_eq!(generated.model.nv(), n);
    // Linear in the joints: no more a joint than some three hundred instructions.
    assert!(operations < 300_000, "{operations}");
    assert!(generated.warnings.is_empty(), "{:?}", generated.warnings);
}

/// A matrix has n² numbers, and each is written out: users should learn that before a compiler that
/// does not end.
#[test]
fn code_that_is_too_long_to_be_of_use_is_a_warning() {
    let mut request = chain(400, "mass_matrix");
    request.options.max_code_size = 1000;
    let generated = generate(&request).unwrap();
    let told: Vec<String> = generated.warnings.iter().map(ToString::to_string).collect();
    let instructions = generated.ledger.functions[0].emitted().instructions();
    assert!(
        told.len() == 1 && told[0].starts_with(&format!("chain.urdf: mass_matrix: found {instructions} instructions, for which")),
        "{told:?}"
    );
}

/// A serial chain of this number of joints, and one function of it.
fn chain(joints: usize, function: &str) -> Request {
    use std::fmt::Write;
    let mut urdf = String::from("<robot name='chain'><link name='l0'/>");
    for k in 1..=joints {
        let axis = ["1 0 0", "0 1 0", "0 0 1"][k % 3];
        let _ = write!(
            urdf,
            "<link name='l{k}'><inertial><mass value='0.1'/><inertia ixx='1e-3' ixy='0' ixz='0' iyy='1e-3' iyz='0' izz='1e-3'/></inertial></link>\
             <joint name='j{k}' type='continuous'><origin xyz='0 0 0.01'/><parent link='l{}'/><child link='l{k}'/><axis xyz='{axis}'/></joint>",
            k - 1
        );
    }
    let mut request = Request::new("chain.urdf", urdf + "</robot>");
    request.options.functions = vec![function.into()];
    request
}

/// Only slides: no Coriolis force, and a large matrix of zeros, which compiles without a warning.
#[test]
fn a_result_of_zeros_compiles() {
    use std::fmt::Write;
    let mut urdf = String::from("<robot name='gantry'><link name='l0'/>");
    for k in 1..=9 {
        let _ = write!(
            urdf,
            "<link name='l{k}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
             <joint name='j{k}' type='prismatic'><parent link='l{}'/><child link='l{k}'/><axis xyz='0 0 1'/>\
             <limit lower='-1' upper='1' effort='1' velocity='1'/></joint>",
            k - 1
        );
    }
    let mut request = Request::new("gantry.urdf", urdf + "</robot>");
    request.options.functions = vec!["coriolis_matrix".into()];
    let program = Program::build(&[("gantry", &generate(&request).unwrap())], &["-C", "opt-level=0"]);
    assert_eq!(program.run("gantry", "coriolis_matrix", &[vec![&[0.5; 9], &[1.0; 9]]]), [vec![0.0; 81]]);
}

/// No function requested: a module of constants.
#[test]
fn a_robot_without_functions_compiles() {
    let mut request = Request::new("arm.urdf", articulated_models::robot("panda_like").unwrap().urdf);
    request.options.functions.clear();
    Program::build(&[("arm", &generate(&request).unwrap())], &["-C", "opt-level=0"]);
}

#[test]
fn an_unknown_function_is_refused_with_the_nearest_and_all() {
    let mut request = Request::new("arm.urdf", articulated_models::robot("panda_like").unwrap().urdf);
    request.options.functions = vec!["inverse_dynamic".into()];
    let told = generate(&request).unwrap_err().to_string();
    assert_eq!(told, "functions: unknown function `inverse_dynamic`, did you mean `inverse_dynamics`?");
    request.options.functions = vec!["nothing_like_it".into()];
    let told = generate(&request).unwrap_err().to_string();
    let known =
        told.split_once("there are: ").expect("a list").1.split_once("; a function of your own").expect("advice").0.split(", ").count();
    // With the word `all`.
    assert_eq!(known, functions::<f64>().len() + beside_the_table::<f64>().count() + Group::ALL.len() + Group::BESIDE.len() + 1);
}

#[test]
fn gravity_and_base_are_the_requests() {
    let urdf = articulated_models::robot("double_pendulum").unwrap().urdf;
    let mut request = Request::new("double_pendulum.urdf", urdf);
    request.options.functions = vec!["gravity_torque".into()];
    let standing = generate(&request).unwrap();
    request.options.robot.gravity = Some([0.0; 3]);
    let weightless = generate(&request).unwrap();
    assert_eq!(weightless.ledger.functions[0].emitted().instructions(), 0, "no gravity, no operation");
    request.options.robot.base = Base::Floating;
    let floating = generate(&request).unwrap();
    assert_eq!((standing.model.nv(), floating.model.nv()), (2, 8));
    let program = Program::build(&[("weightless", &weightless), ("standing", &standing)], &["-C", "opt-level=0"]);
    assert_eq!(program.run("weightless", "gravity_torque", &[vec![&[0.3, 0.4]]]), [[0.0, 0.0]]);
    assert_ne!(program.run("standing", "gravity_torque", &[vec![&[0.3, 0.4]]]), [[0.0, 0.0]]);
}

/// As cargo compiles by default: with all names for a debugger, where statements must not be inside
/// of one another by the thousand.
#[test]
fn a_long_function_compiles_with_names_for_debuggers() {
    let robot = articulated_models::robot("golfer").expect("a bundled robot");
    let mut request = Request::new("golfer.urdf", robot.urdf);
    request.options.robot.base = robot.base;
    request.options.functions = vec!["coriolis_matrix".into()];
    let generated = generate(&request).expect("a robot");
    assert!(generated.ledger.functions[0].emitted().instructions() > 2900);
    assert!(!generated.source.contains("fn piece_"), "it is cut into pieces, where no statement is inside of many");
    Program::build(&[("golfer", &generated)], &["-C", "debuginfo=2"]);
}
