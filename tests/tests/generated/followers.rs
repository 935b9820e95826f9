//! Joints that follow by polynomials: generated = generic.

use std::sync::LazyLock;

use articulated_codegen::{COptions, Options, Target};
use articulated_core::description::{Base, Coupling};
use articulated_core::diagnostic::Spanned;
use articulated_tests::c_program::{self, Vectors};

use crate::robots::{Robot, native, with};
use crate::{equals_generic, interpreted};

/// Functions that have f′, f″ and f‴ in them.
const SOME: [&str; 6] = [
    "placements",
    "jacobian_rates_body",
    "inverse_dynamics",
    "forward_dynamics",
    "coriolis_matrix",
    "inverse_dynamics_derivatives_with_wrenches",
];

fn couplings(laws: &[(&str, &str, &[f64])]) -> Vec<Spanned<Coupling>> {
    let one = |(joint, leader, polynomial): &(&str, &str, &[f64])| Coupling::polynomial(joint, leader, polynomial, 0.3).expect("a law");
    laws.iter().map(one).map(Into::into).collect()
}

/// An arm whose fourth joint follows the second, and a quadruped whose knees follow its hips, each
/// by a law of its own: its legs are computed in lanes.
fn robots(target: &dyn Fn(&str) -> Target, wanted: &dyn Fn(&str) -> bool) -> Vec<Robot> {
    let arm = couplings(&[("wrist_1_joint", "shoulder_lift_joint", &[0.2, -0.9, 0.3, 0.15, -0.04])]);
    let legs = couplings(&[
        ("front_left_knee", "front_left_hip_flexion", &[0.1, -1.9, 0.25]),
        ("front_right_knee", "front_right_hip_flexion", &[0.1, -1.8, 0.2, 0.0, 0.05]),
        ("hind_left_knee", "hind_left_hip_flexion", &[-0.1, -2.1, 0.35, 0.1]),
        ("hind_right_knee", "hind_right_hip_flexion", &[0.3, -1.7, -0.15]),
    ]);
    let one = |name: &str, of: &str, coupling: Vec<Spanned<Coupling>>| {
        let bundled = articulated_models::robot(of).expect("it is bundled");
        let mut options = Options { target: target(name), ..Options::default() };
        options.robot.coupling = coupling;
        let base = if of == "quadruped" { Base::Floating } else { bundled.base };
        with(name.into(), bundled.urdf, base, false, options, wanted)
    };
    let all = vec![one("cam_arm", "ur5_like", arm), one("cam_legs", "quadruped", legs)];
    assert!(all.iter().all(|robot| robot.case.model.bodies().iter().any(|body| body.coordinates.is_bent())));
    all
}

static ROBOTS: LazyLock<Vec<Robot>> = LazyLock::new(|| robots(&|_| Options::default().target, &|_| true));

#[test]
fn statements_give_what_the_generic_library_gives() {
    for robot in ROBOTS.iter() {
        let (worst, count) = interpreted::compare(robot);
        println!("{}: {worst:.1} units of roundoff in {count} bodies", robot.name);
    }
    let legs = &ROBOTS[1].generated.ledger.functions;
    assert!(legs.iter().any(|function| function.lanes == 4), "no function of the legs is in lanes");
}

#[test]
fn compiled_rust_gives_what_the_generic_library_gives() {
    let some = robots(&|_| Options::default().target, &|name| SOME.contains(&name));
    let program = native(some.iter());
    for robot in &some {
        println!("{}: {:.1} units of roundoff", robot.name, equals_generic::compare(&program, robot));
    }
}

#[test]
fn compiled_c_gives_what_the_generic_library_gives() {
    let target = |name: &str| Target::C(COptions { prefix: Some(name.to_owned()), ..COptions::default() });
    let some = robots(&target, &|name| SOME.contains(&name));
    let all: Vec<_> = some.iter().map(|robot| (robot.name.as_str(), robot.case.model.shape(), &robot.generated)).collect();
    let program = c_program::build(&all, Vectors::Any, "-O1");
    for robot in &some {
        println!("{}: {:.1} units of roundoff", robot.name, equals_generic::compare(&program, robot));
    }
}
