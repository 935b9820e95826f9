//! Generated C: what the generic library gives, and what the graph does, for every function.

use std::sync::LazyLock;

use articulated_codegen::{COptions, Options, Target, generate};
use articulated_core::algorithm::{Shape, functions};
use articulated_core::description::Base;
use articulated_tests::c_program;
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
            no_libm: header_only || name.contains("own_math"),
        });
        let options = Options { target, level: level.parse().expect("a level"), ..Options::default() };
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

static PROGRAM: LazyLock<Program> = LazyLock::new(|| {
    let shape = |robot: &Robot| robot.case.model.shape();
    let all: Vec<(&str, Shape, _)> = ROBOTS.iter().map(|r| (r.name.as_str(), shape(r), &r.generated)).collect();
    let program = c_program::build(&all);
    println!("compiled {} robots in {:.1?}", all.len(), program.time);
    program
});

const STATES: usize = 8;

#[test]
fn c_gives_what_the_generic_library_gives() {
    for robot in ROBOTS.iter() {
        let single = robot.generated.level.is_single();
        // In doubles 14 units of roundoff were seen, in singles 40.
        let (unit, allowed) = if single { (f64::from(f32::EPSILON) / f64::EPSILON, 128.0) } else { (1.0, 64.0) };
        let states = single_states(robot, STATES);
        let mut worst = (0.0, "");
        for name in robot.functions() {
            let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
            for (state, found) in states.iter().zip(PROGRAM.run(&robot.name, name, &given)) {
                let far = error(&robot.case, name, state, &found) / unit;
                worst = if far > worst.0 { (far, name) } else { worst };
            }
        }
        println!("{}: {:.1} units of roundoff in {}", robot.name, worst.0, worst.1);
        assert!(worst.0 <= allowed, "{} of {}: {} units of roundoff", worst.1, robot.name, worst.0);
    }
}

/// With products and sums rounded one after the other, only sines of the two mathematical libraries
/// may differ.
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
                assert!(far <= 1e-12 && expected.len() == found.len(), "{name} of {}: {far:e}", robot.name);
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
