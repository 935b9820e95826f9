//! Generated = generic, function by function.

use articulated_core::algorithm::{Argument, function};
use articulated_tests::case::State;
use articulated_tests::measure::{arguments, error};
use articulated_tests::program::Program;
use articulated_tests::random::Random;

use crate::robots::{CHOSEN, ELSEWHERE, LANES, NATIVE, PORTABLE, ROBOTS, Robot, is_compiled, native};

/// Error allowed, in units of u times the yardstick.
fn allowed(function: &str) -> f64 {
    // A solution is judged by its backward error, which has its own bound; all else by its
    // difference. Seen: 14.
    if function == "forward_dynamics" { 64.0 } else { 16.0 }
}

const STATES: usize = 32;

/// The largest difference of any function of a robot from the generic library.
pub(crate) fn compare(program: &Program, robot: &Robot) -> f64 {
    let mut random = Random::new(17);
    let states: Vec<State> = (0..STATES).map(|_| robot.case.state(&mut random)).collect();
    let mut worst: f64 = 0.0;
    for name in robot.functions() {
        let given: Vec<Vec<&[f64]>> = states.iter().map(|s| arguments(name, s)).collect();
        for (state, found) in states.iter().zip(program.run(&robot.name, name, &given)) {
            let far = error(&robot.case, name, state, &found);
            assert!(far <= allowed(name), "{}::{name}: {far} units of roundoff in {state:?}", robot.name);
            worst = worst.max(far);
        }
    }
    worst
}

#[test]
fn generated_code_gives_what_the_generic_library_gives() {
    for robot in ROBOTS.iter().filter(is_compiled) {
        println!("{}: {:.1} units of roundoff", robot.name, compare(&NATIVE, robot));
    }
}

#[test]
#[ignore = "all robots, of which the test above compiles some; rustc takes minutes: cargo test … -- --ignored"]
fn so_does_compiled_code_of_every_robot() {
    let program = native(ROBOTS.iter());
    for robot in ROBOTS.iter() {
        println!("{}: {:.1} units of roundoff", robot.name, compare(&program, robot));
    }
}

#[test]
fn so_does_code_for_any_machine_whatever_instructions_it_has() {
    for robot in ROBOTS.iter().filter(is_compiled) {
        let [chosen, portable] = [&CHOSEN, &PORTABLE].map(|program| compare(program, robot));
        println!("{}: {chosen:.1} units of roundoff, without multiply-add {portable:.1}", robot.name);
        if let Some((_, lanes)) = LANES.iter().find(|l| l.0 == robot.name) {
            assert!(
                robot.generated.ledger.functions.iter().any(|f| f.lanes == *lanes),
                "no {lanes} limbs or joints of {} in lanes",
                robot.name
            );
            println!("{}: {:.1} units of roundoff on another processor", robot.name, compare(&ELSEWHERE, robot));
        }
    }
}

/// Otherwise the test above would compare one path twice.
#[cfg(target_arch = "x86_64")]
#[test]
fn a_program_without_multiply_adds_rounds_otherwise() {
    let robot = ROBOTS.iter().find(|robot| robot.name == "panda_like").expect("it is bundled");
    let mut random = Random::new(19);
    let states: Vec<State> = (0..STATES).map(|_| robot.case.state(&mut random)).collect();
    let given: Vec<Vec<&[f64]>> = states.iter().map(|state| arguments("forward_dynamics", state)).collect();
    let [chosen, portable] = [&CHOSEN, &PORTABLE].map(|program| program.run(&robot.name, "forward_dynamics", &given));
    assert_eq!(chosen != portable, std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma"));
}

/// Not even with NaN or infinity; the checks of the compiler are on.
#[test]
fn no_value_makes_generated_code_panic() {
    for robot in ROBOTS.iter().filter(|r| ["panda_like", "gripper_arm", "tree_1", "walker", "strider"].contains(&r.name.as_str())) {
        let shape = robot.case.model.shape();
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 1e300, -1e6, 5e-324, -0.0] {
            let state = State::of(shape, |_, n| vec![x; n]);
            for row in robot.functions().map(|name| function::<f64>(name).unwrap()) {
                PORTABLE.run(&robot.name, row.name, &[arguments(row.name, &state)]);
                let found = CHOSEN.run(&robot.name, row.name, &[arguments(row.name, &state)]);
                assert_eq!(found[0].len(), row.len(shape));
                // Random numbers are between 0 and 1, and quaternions that are normalised have a
                // norm.
                let any = ![Argument::Uniform, Argument::Step, Argument::Target].iter().any(|a| row.takes.contains(a));
                let finite = x.is_finite() && x.abs() < 1e7 && any;
                assert!(!finite || found[0].iter().all(|y| y.is_finite()), "{}::{} of {x}", robot.name, row.name);
            }
        }
    }
}

/// Angles beyond the fast reduction are turned over to the standard library: the result is as good.
#[test]
fn angles_of_many_turns_are_as_good_as_any() {
    for robot in ROBOTS.iter().filter(|r| ["panda_like", "six_axes"].contains(&r.name.as_str())) {
        let mut state = robot.case.state(&mut Random::new(23));
        for turns in [1e3, 1e5, 1e8, 1e15] {
            state.q.iter_mut().for_each(|q| *q += turns);
            let given = arguments("inverse_dynamics", &state);
            let found = NATIVE.run(&robot.name, "inverse_dynamics", &[given]);
            let far = error(&robot.case, "inverse_dynamics", &state, &found[0]);
            assert!(far <= allowed("inverse_dynamics"), "{} after {turns} rad: {far} units of roundoff", robot.name);
        }
    }
}
