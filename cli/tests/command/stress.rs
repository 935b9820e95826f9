//! `articulated stress`.

use super::{File, run, run_with};

#[test]
fn a_chapter_is_a_table_and_its_rows_are_in_the_json() {
    let ended = run(&["stress", "--chapters", "screws"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert!(
        ended.out.starts_with("screws\n") && ended.out.contains("a turn by exactly π") && ended.out.contains(", 0 beyond their limits")
    );
    let json = run(&["stress", "--chapters", "screws", "--format", "json"]).json();
    let rows = json["rows"].as_array().unwrap();
    assert!(json["pass"] == true && rows.len() as u64 == json["rows_measured"].as_u64().unwrap() && rows.len() > 10);
    assert!(rows.iter().all(|r| r["measured"].as_f64().unwrap() <= r["limit"].as_f64().unwrap() && !r["why"].as_str().unwrap().is_empty()));
    assert_eq!(run(&["stress", "--chapters", "screw"]).status, 2);
}

/// Infinite bounds are not samples: URDF 1.2 has infinite ones if none are written.
#[test]
fn limits_that_are_open_or_far_away_are_within_their_limits() {
    for limit in ["", " lower='-1'", " lower='-1.7e308' upper='1.7e308'"] {
        let urdf = format!(
            "<robot name='r' version='1.2'><link name='b'/><link name='l'><inertial><origin xyz='0.1 0 0.1'/><mass value='1'/>
            <inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>
            <joint name='j' type='revolute'><parent link='b'/><child link='l'/><axis xyz='0 1 0'/><limit{limit} effort='1' velocity='1'/></joint></robot>"
        );
        let ended = run_with(&["stress", "-"], urdf.as_bytes());
        assert_eq!(ended.status, 0, "{limit}: {}{}", ended.out, ended.err);
    }
}

/// A robot whose joint moves no mass is judged by its other numbers.
#[test]
fn a_robot_of_ones_own_is_judged_and_watched() {
    let urdf = br#"<robot name="bare"><link name="a"/><link name="b"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
        <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="c"/>
        <joint name="arm" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint>
        <joint name="bare" type="continuous"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/></joint></robot>"#;
    let ended = run_with(&["stress", "-", "--rows"], urdf);
    assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
    let notes = ["forward_dynamics", "solve_mass_matrix"].map(|f| format!("{f} is left out: no inertia of its own for joint bare"));
    assert!(notes.iter().all(|note| ended.out.contains(&format!("\nnote: {note}\n"))), "{}", ended.out);
    let json = run_with(&["stress", "-", "--format", "json"], urdf).json();
    assert!(json["notes"] == serde_json::json!(notes) && json["pass"] == true, "{}", json["notes"]);
    let ends = json["rows"].as_array().unwrap().iter().filter(|r| r["what"].as_str().unwrap().contains("an error of joint \"bare\""));
    assert_eq!(ends.count(), 16, "eight sets of states in two precisions");
    assert!(ended.out.contains("smallest pivot, of joint \"bare\"") && ended.out.contains("condition number of Ad"), "{}", ended.out);
    assert_eq!(run_with(&["stress", "-"], b"<robot/>").status, 1);
    // Its code too, at levels: each a case of its own.
    let ended = run_with(&["stress", "-", "--rows", "--generated", "--levels", "f32,double_double"], urdf);
    assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
    assert!(
        ["generated, f32: ", "generated, double_double: ", "beyond one rounding"].iter().all(|x| ended.out.contains(x)),
        "{}",
        ended.out
    );
    assert!(ended.out.contains("note: forward_dynamics_derivatives is left out: "), "{}", ended.out);
    assert_eq!(run_with(&["stress", "-", "--levels", "f32"], urdf).status, 2);
    let whole = run(&["stress", "simple_pendulum", "--format", "json"]).json();
    assert_eq!(whole["notes"], serde_json::json!([]));
}

/// A round tool about its own axis has velocity forces that cancel to the last digit: the remainder
/// is not a measure.
#[test]
fn what_cancels_to_nothing_is_measured_by_its_terms() {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.1 0 0'/><mass value='1'/>\
             <inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>"
        )
    };
    let urdf = format!(
        "<robot name='two'><link name='base'/>{}{}\
         <joint name='shoulder' type='continuous'><parent link='base'/><child link='upper'/><axis xyz='0 1 0'/></joint>\
         <joint name='wrist' type='continuous'><parent link='upper'/><child link='tool'/><origin xyz='0.3 0 0'/><axis xyz='1 0 0'/></joint></robot>",
        link("upper"),
        link("tool")
    );
    let ended = run_with(&["stress", "-", "--generated", "--levels", "f64,f32"], urdf.as_bytes());
    assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
}

/// Magnitudes of terms include those of effects: stops are stiff, and forces are large far beyond
/// them.
#[test]
fn a_scene_with_effects_is_within_its_limits() {
    let ended = run(&["stress", "arm"]);
    assert_eq!(ended.status, 0, "{}", ended.out);
}

/// Two links that stay level: M and h are differences between two joints. And one whose angle is a
/// sum itself.
const FOLLOWED: &str = "<robot name='arm'><link name='base'/>LINKS\
    <joint name='shoulder' type='continuous'><parent link='base'/><child link='l1'/><axis xyz='0 -1 0'/></joint>\
    <joint name='elbow' type='continuous'><parent link='l1'/><child link='l2'/><origin xyz='0.5 0 0'/><axis xyz='0 -1 0'/>MIMIC</joint></robot>";

fn arm(mimic: &str) -> String {
    let link = |name: &str, x: f64| {
        format!(
            "<link name='{name}'><inertial><origin xyz='{x} 0 0'/><mass value='2'/>\
             <inertia ixx='0.01' ixy='0' ixz='0' iyy='0.03' iyz='0' izz='0.03'/></inertial></link>"
        )
    };
    FOLLOWED.replace("LINKS", &(link("l1", 0.25) + &link("l2", 0.2))).replace("MIMIC", mimic)
}

#[test]
fn what_joints_that_follow_leave_of_each_other_is_within_its_limits() {
    for mimic in ["<mimic joint='shoulder' multiplier='-1'/>", "<mimic joint='shoulder' multiplier='-2' offset='0.1'/>"] {
        let ended = run_with(&["stress", "-"], arm(mimic).as_bytes());
        assert_eq!(ended.status, 0, "{mimic}: {}", ended.out);
    }
}

/// Motor torques are below the requested ones, and drag is nearly as large as Coriolis forces, in
/// the library and in generated code.
#[test]
fn motors_and_drag_are_within_their_limits() {
    let urdf = File::new("arm.urdf", arm("").as_bytes());
    let text = format!("urdf = {:?}\n[effects.motor]\nshoulder = {{ torque = 2.0, speed = 3.0 }}\n", urdf.name());
    let scene = File::new("motor.toml", text.as_bytes());
    for words in [&[][..], &["--generated"]] {
        let ended = run(&[&["stress", scene.name()], words].concat());
        assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
    }
    let ended = run(&["compare", scene.name(), "--functions", "forward_dynamics", "--repetitions", "31"]);
    assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
    let ended = run(&["stress", "underwater_arm", "--generated", "--levels", "f64"]);
    assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
}
