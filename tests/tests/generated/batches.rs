//! Functions of many states at once, in each instruction set that this processor has.

use std::sync::LazyLock;

use articulated_codegen::{Generated, Options, Real, RustOptions, Target};
use articulated_core::description::Base;
use articulated_tests::batch_program::{BatchProgram, STATES, is_state_by_state};
use articulated_tests::case::State;
use articulated_tests::machine::{is_arm, is_x86_64};
use articulated_tests::measure::{arguments, error};
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text;

use crate::robots::{Robot, single_states, with};

/// Functions of every kind of argument and result.
const FUNCTIONS: [&str; 13] = [
    "placements",
    "twists_body",
    "jacobians_world_aligned",
    "inverse_dynamics",
    "inverse_dynamics_with_wrenches",
    "joint_wrenches",
    "mass_matrix",
    "forward_dynamics",
    "kinetic_energy",
    "center_of_mass",
    "torque_regressor",
    "integrate",
    "difference",
];

/// Functions so long that their texts for sixteen registers contain the spills to memory.
const LONG: [&str; 2] = ["coriolis_matrix", "inverse_dynamics_derivatives"];

/// An arm, every kind of joint on a floating base, joints that follow others, a long function, and
/// an empty robot: small ones, since they are compiled for each instruction set. The computation is
/// that of single evaluation, which is tested on many robots.
fn robots(forbid_unsafe: bool) -> Vec<Robot> {
    let robot = |name: &str, urdf: &str, base: Base, functions: &[&str]| {
        let options = Options {
            target: Target::Rust(RustOptions { forbid_unsafe, ..RustOptions::default() }),
            batch: vec![Real::F64, Real::F32],
            ..Options::default()
        };
        with(name.into(), urdf, base, false, options, |name| functions.contains(&name))
    };
    let [gripper, seven_axes] = ["gripper_arm", "panda_like"].map(|name| articulated_models::robot(name).expect("a bundled robot").urdf);
    let tree = urdf_text(&random_tree(102, Flavour { massless: false, ..Flavour::WRITTEN }));
    vec![
        robot("arm", include_str!("../../robots/arm.urdf"), Base::Fixed, &FUNCTIONS),
        robot("tree", &tree, Base::Floating, &["placements", "inverse_dynamics_with_wrenches", "difference"]),
        robot("gripper_arm", gripper, Base::Fixed, &["inverse_dynamics", "mass_matrix"]),
        robot("seven_axes", seven_axes, Base::Fixed, &LONG),
        robot("stone", "<robot name='stone'><link name='stone'/></robot>", Base::Fixed, &FUNCTIONS),
    ]
}

/// The robots, with `unsafe` allowed and without it.
static ROBOTS: LazyLock<[Vec<Robot>; 2]> = LazyLock::new(|| [robots(false), robots(true)]);

/// A program of one instruction set, if this processor has that.
struct Variant {
    set: &'static str,
    /// Whether a·b + c has one rounding.
    fused: bool,
    robots: &'static [Robot],
    program: BatchProgram,
}

static WAYS: LazyLock<Vec<Variant>> = LazyLock::new(|| {
    #[cfg(target_arch = "x86_64")]
    let (avx2, avx512) = {
        let avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        (avx2, avx2 && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq"))
    };
    #[cfg(not(target_arch = "x86_64"))]
    let (avx2, avx512) = (false, false);
    let sets = [
        ("avx512", avx512 && is_x86_64(), true),
        ("avx2", avx2 && is_x86_64(), true),
        ("sse2", is_x86_64(), false),
        ("neon", is_arm(), true),
        ("portable", true, is_arm()),
    ];
    let way = |(set, has, fused): (&'static str, bool, bool)| {
        if !has {
            println!("{set} is not tried: this processor does not have it");
            return None;
        }
        let robots = &ROBOTS[usize::from(set == "portable")];
        let named: Vec<(&str, &Generated)> = robots.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
        // As for any machine of this kind.
        let program = BatchProgram::build(&named, set, &["-C", "opt-level=0", "-C", "debug-assertions=on"]);
        println!("compiled {} robots in {set} in {:.1?}", named.len(), program.time());
        Some(Variant { set, fused, robots, program })
    };
    sets.into_iter().filter_map(way).collect()
});

/// The results of a program.
fn run(way: &Variant, robot: &Robot, name: &str, real: Real, states: &[State]) -> Vec<Vec<f64>> {
    let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
    way.program.run(&robot.name, name, real, &given)
}

/// Unit roundoff of a type in units of that of `f64`.
fn unit(real: Real) -> f64 {
    if real == Real::F32 { f64::from(f32::EPSILON) / f64::EPSILON } else { 1.0 }
}

/// The largest error that is allowed, in unit roundoffs of the type. Seen: 3.4.
const ALLOWED: f64 = 8.0;

/// And each program checks its functions for the laws of batches. Blocks return the same bits as
/// states one after the other; if states are computed one by one, they have the bits of the single
/// function instead. So does every number of states. Slices of different lengths are refused
/// without any output.
#[test]
fn batches_give_what_the_generic_library_gives() {
    for way in WAYS.iter() {
        for (robot, real) in way.robots.iter().flat_map(|r| [(r, Real::F64), (r, Real::F32)]) {
            let states = single_states(robot, STATES);
            let mut worst = (0.0, "");
            for name in robot.functions() {
                for (state, found) in states.iter().zip(run(way, robot, name, real, &states)) {
                    let far = error(&robot.case, name, state, &found) / unit(real);
                    worst = if far > worst.0 { (far, name) } else { worst };
                }
            }
            println!("{} {real:?} {}: {:.1} units of roundoff in {}", way.set, robot.name, worst.0, worst.1);
            assert!(worst.0 <= ALLOWED, "{} of {} {real:?} in {}: {} units of roundoff", worst.1, robot.name, way.set, worst.0);
        }
    }
}

#[test]
fn a_long_function_has_a_text_for_sixteen_registers_where_unsafe_is_allowed() {
    for name in LONG {
        let text = format!("{name}_in_block_that_spills");
        let found = ROBOTS.each_ref().map(|robots| robots.iter().any(|r| r.generated.source.contains(&text)));
        assert_eq!(found, [true, false], "{name}");
    }
}

#[test]
fn sparse_and_symmetric_results_are_computed_state_by_state_in_doubles() {
    let is_any = |real| ROBOTS[0].iter().any(|r| r.functions().any(|name| is_state_by_state(&r.generated.source, name, real)));
    assert_eq!([Real::F64, Real::F32].map(is_any), [true, false]);
}

#[test]
fn instruction_sets_that_round_alike_agree_to_the_bit() {
    let [fused, split]: [Vec<&Variant>; 2] = [true, false].map(|fused| WAYS.iter().filter(|w| w.fused == fused).collect());
    for pair in fused.windows(2).chain(split.windows(2)) {
        for (robot, real) in pair[0].robots.iter().flat_map(|r| [(r, Real::F64), (r, Real::F32)]) {
            let states = single_states(robot, STATES);
            // A function of one state that is safe may compute limbs one after the other.
            let is_of_blocks = |name: &&str| !is_state_by_state(&robot.generated.source, name, real);
            for name in robot.functions().filter(is_of_blocks) {
                let [a, b] = [pair[0], pair[1]].map(|way| bits(&run(way, robot, name, real, &states)));
                assert!(a == b, "{name} of {} {real:?}: {} is not {}", robot.name, pair[0].set, pair[1].set);
            }
        }
    }
}

fn bits(numbers: &[Vec<f64>]) -> Vec<u64> {
    numbers.iter().flatten().map(|x| x.to_bits()).collect()
}

/// Angles beyond the fast reduction, and NaN or infinity, affect only their own lane.
#[test]
fn a_state_takes_no_notice_of_its_neighbours() {
    for way in WAYS.iter() {
        let robot = &way.robots[0];
        let good = single_states(robot, STATES);
        for real in [Real::F64, Real::F32] {
            let mut mixed = good.clone();
            for (state, x) in mixed.iter_mut().step_by(3).zip([f64::NAN, f64::INFINITY, 1e15, -3e5].into_iter().cycle()) {
                state.q[1] = x;
            }
            let [expected, found] = [&good, &mixed].map(|states| run(way, robot, "inverse_dynamics", real, states));
            for (k, (expected, found)) in expected.iter().zip(&found).enumerate() {
                let state = &mixed[k];
                if k % 3 != 0 {
                    assert_eq!(expected, found, "state {k} in {}", way.set);
                } else if state.q[1].is_finite() {
                    let state = State {
                        q: state.q.iter().map(|q| if real == Real::F32 { f64::from(*q as f32) } else { *q }).collect(),
                        ..state.clone()
                    };
                    let far = error(&robot.case, "inverse_dynamics", &state, found) / unit(real);
                    assert!(far <= ALLOWED, "{} {real:?} at {} rad: {far} units of roundoff", way.set, state.q[1]);
                } else {
                    assert!(found[0].is_nan() || found[1].is_nan(), "{} at {}", way.set, state.q[1]);
                }
            }
        }
    }
}
