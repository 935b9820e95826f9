//! Every example runs and prints the result that its physics demands.

use std::path::Path;
use std::process::Command;

fn printed(program: &str) -> String {
    printed_in(program, Path::new("."))
}

fn printed_in(program: &str, folder: &Path) -> String {
    let done = Command::new(program).current_dir(folder).output().expect("the example starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).expect("UTF-8")
}

/// The last number of the first line that contains `words`.
fn number(text: &str, words: &str) -> f64 {
    let line = text.lines().find(|line| line.contains(words)).unwrap_or_else(|| panic!("no {words:?} in {text}"));
    let mut numbers = line.split(|c: char| c.is_whitespace() || "(),;".contains(c)).filter_map(|word| word.parse().ok());
    numbers.next_back().unwrap_or_else(|| panic!("no number in {line:?}"))
}

#[test]
fn the_arm_follows_its_reference_and_a_heavy_tool_disturbs_it() {
    let text = printed(env!("CARGO_BIN_EXE_computed_torque"));
    let errors: Vec<f64> = text.lines().skip(1).map(|line| line.split_whitespace().nth(1).unwrap().parse().unwrap()).collect();
    assert!(errors.len() == 3 && errors[0] < 0.5 && errors[0] < errors[1] && errors[1] < errors[2], "{text}");
}

#[test]
fn the_cart_balances_its_pole() {
    assert!(number(&printed(env!("CARGO_BIN_EXE_lqr")), "distance from the equilibrium") < 0.01);
}

#[test]
fn the_pole_swings_up() {
    let text = printed(env!("CARGO_BIN_EXE_swing_up"));
    assert!(number(&text, "distance from upright and rest") < 5e-3, "{text}");
}

#[test]
fn the_hand_reaches_its_place_by_sampled_torques() {
    let text = printed(env!("CARGO_BIN_EXE_reach"));
    assert!(number(&text.replace(" m\n", "\n"), "distance after 2 s") < 0.02, "{text}");
}

#[test]
fn a_known_payload_is_held_still() {
    let text = printed(env!("CARGO_BIN_EXE_gravity_compensation"));
    for line in text.lines().skip(1) {
        let [mass, _, known, unknown]: [f64; 4] =
            line.split_whitespace().map(|x| x.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap();
        assert!(known < 1e-10 && (unknown > 0.1) == (mass > 0.0), "{text}");
    }
}

#[test]
fn a_controller_of_ones_own_is_that_by_hand_in_fewer_instructions() {
    let text = printed(env!("CARGO_BIN_EXE_impedance"));
    assert!(number(&text, "largest difference") < 1e-12, "{text}");
    let counts: Vec<u32> = text.lines().nth(1).unwrap().split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    assert!(counts.len() == 2 && counts[0] < counts[1], "{text}");
    assert!(number(&text, "stiffness of the first joint") > 0.0, "{text}");
}

#[test]
fn the_hand_reaches_each_place_alone_and_in_vectors() {
    let text = printed(env!("CARGO_BIN_EXE_inverse_kinematics"));
    assert!(text.contains("100000 of 100000 places reached"), "{text}");
    assert!(number(&text.replace(" m\n", "\n"), "the farthest within") < 1e-9, "{text}");
    assert!(number(&text.replace(" rad", ""), "largest difference") < 1e-9, "{text}");
    assert!((number(&text, "a place that moves by 1") - 1.0).abs() < 1e-6, "{text}");
}

#[test]
fn steps_agree_in_vectors_and_their_gradient_with_differences() {
    let text = printed(env!("CARGO_BIN_EXE_rollouts"));
    assert!(number(&text.replace(" rad", ""), "largest difference") < 1e-9, "{text}");
    let line = text.lines().find(|line| line.contains("along a direction")).unwrap();
    let found: Vec<f64> = line.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    assert!(found.len() == 2 && (found[0] - found[1]).abs() < 1e-5 * found[1].abs(), "{text}");
}

#[test]
fn products_with_jacobians_agree_from_both_sides() {
    let text = printed(env!("CARGO_BIN_EXE_gradients"));
    assert!(number(&text, "arm: ") < 1e-12 && number(&text, "legs: ") < 1e-12, "{text}");
}

#[test]
fn the_quadruped_stands() {
    let text = printed(env!("CARGO_BIN_EXE_quadruped"));
    assert!(number(&text, "it stands at") < 1e-2, "{text}");
}

#[test]
fn momentum_is_conserved() {
    let text = printed(env!("CARGO_BIN_EXE_momentum"));
    assert!(number(&text, "largest change") < 1e-8, "{text}");
}

#[test]
fn batches_agree_with_single_calls() {
    assert!(number(&printed(env!("CARGO_BIN_EXE_batches")), "largest difference") < 1e-9);
}

/// The programs that `articulated new` writes.
#[test]
fn programs_of_new_crates_reach_their_targets_and_plot_the_way() {
    for (program, bound) in [(env!("CARGO_BIN_EXE_new_arm"), 1e-9), (env!("CARGO_BIN_EXE_new_walker"), 0.5)] {
        let folder = std::env::temp_dir().join(format!("articulated-examples-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let text = printed_in(program, &folder);
        assert!(number(&text.replace("rad or m", ""), "largest distance") < bound, "{program}: {text}");
        let plot = std::fs::read_to_string(folder.join("motion.svg")).unwrap();
        assert!(plot.contains("<polyline") && !plot.contains("NaN"), "{plot}");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn a_robot_is_read_at_run_time() {
    let text = printed(env!("CARGO_BIN_EXE_read_a_robot"));
    assert!(text.contains("gripper_arm") && text.contains("kg that move"), "{text}");
}
