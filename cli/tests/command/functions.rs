use std::path::Path;

use super::{File, run};

/// A joint without moving mass, and a link that does not move.
const IDLE: &str = r#"<robot name="idle"><link name="a"/><link name="b"/><link name="c"/>
<joint name="turn" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="weld" type="fixed"><parent link="a"/><child link="c"/></joint></robot>"#;

#[test]
fn every_function_has_its_cost_or_the_reason_why_not() {
    let file = File::new("idle.urdf", IDLE.as_bytes());
    let words = ["functions", "double_pendulum", file.name()];
    let json = run(&[&words[..], &["--format", "json"]].concat()).json();
    let functions = json["functions"].as_array().unwrap();
    let beside = articulated_core::step::beside_the_table::<f64>().count();
    assert_eq!(functions.len(), articulated_core::algorithm::functions::<f64>().len() + beside);
    assert_eq!(json["robots"][1]["frames"], serde_json::json!(["b"]));
    let of = |name: &str| functions.iter().find(|f| f["function"] == name).unwrap();
    assert_eq!(of("jacobians_body")["gives"], "[frames][6][nv]");
    assert_eq!((&of("step_rk4")["gives"], &of("step_rk4")["group"]), (&"q_next [nq], v_next [nv]".into(), &"steps".into()));
    assert!(of("forward_dynamics")["costs"][0]["cost"]["instructions"].as_u64().unwrap() > 10);
    assert_eq!(of("forward_dynamics")["costs"][1]["undefined"], "no inertia of its own for joint turn");
    let few = "fewer than six degrees of freedom carry each tip";
    assert!((0..2).all(|k| of("operational_space_inertia")["costs"][k]["undefined"] == few));
    assert!(of("inverse_dynamics")["costs"][1]["cost"].is_object());
    let preset = serde_json::json!({ "function": "inverse_dynamics_with_wrenches", "zeros": ["a", "wrenches"] });
    assert_eq!((&of("bias_forces")["preset_of"], &of("mass_matrix")["preset_of"]), (&preset, &serde_json::Value::Null));
    let text = run(&words);
    assert_eq!(text.status, 0, "{}", text.err);
    for part in [
        "not defined: no inertia of its own for joint turn",
        "not defined: no moving link with mass",
        "not defined: fewer than six",
        "– (3)",
        "inverse_dynamics_with_wrenches at a = wrenches = 0",
    ] {
        assert!(text.out.contains(part), "{part}: {}", text.out);
    }
}

#[test]
fn a_file_may_float() {
    let robot = articulated_models::robot("ur5_like").unwrap();
    let file = File::new("arm.urdf", robot.urdf.as_bytes());
    let json = run(&["functions", file.name(), "simple_pendulum", "--floating", "--format", "json"]).json();
    assert_eq!((json["robots"][0]["base"].as_str(), json["robots"][1]["base"].as_str()), (Some("floating"), Some("fixed")));
    assert_eq!(run(&["functions", "no_such_robot"]).status, 1);
}

/// `UPDATE_GOLDEN=1` writes it anew.
#[test]
fn the_document_of_all_functions_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/functions.md");
    let made = run(&["functions", "--markdown"]);
    assert_eq!(made.status, 0, "{}", made.err);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &made.out).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let changed = made.out.lines().zip(kept.lines()).find(|(a, b)| a != b);
    assert!(made.out == kept, "docs/functions.md: {changed:?}; run with UPDATE_GOLDEN=1");
}

/// Numbers in the README.
#[test]
fn the_readme_counts_what_there_is() {
    let readme = include_str!("../../../README.md");
    let functions = articulated_core::algorithm::functions::<f64>().len();
    assert!(readme.contains(&format!("[{functions} functions](docs/functions.md)")), "{functions} functions");
    let numbers = ["Zero", "One", "Two", "Three", "Four", "Five", "Six", "Seven", "Eight", "Nine", "Ten", "Eleven", "Twelve"];
    let integrators = articulated_core::integrator::integrators().len();
    assert!(readme.contains(&format!("[{} integrators]", numbers[integrators])), "{integrators} integrators");
}

/// It is the first page: two minutes of reading.
#[test]
fn the_readme_is_short() {
    let length = include_str!("../../../README.md").len();
    assert!(length <= 12 * 1024, "README.md: found {length} bytes, expected at most 12 KB; move details to a page of docs");
}
