//! `articulated stress`.

use super::{run, run_with};

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

/// A robot whose joint moves nothing is judged by what it has.
#[test]
fn a_robot_of_ones_own_is_judged_and_watched() {
    let urdf = br#"<robot name="bare"><link name="a"/><link name="b"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
        <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="c"/>
        <joint name="arm" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint>
        <joint name="bare" type="continuous"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/></joint></robot>"#;
    let ended = run_with(&["stress", "-", "--rows"], urdf);
    assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
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
    assert_eq!(run_with(&["stress", "-", "--levels", "f32"], urdf).status, 2);
}

/// Magnitudes of terms have those of effects among them: stops are stiff, and far beyond them forces are large.
#[test]
fn a_scene_with_effects_is_within_its_limits() {
    let ended = run(&["stress", "arm.toml"]);
    assert_eq!(ended.status, 0, "{}", ended.out);
}
