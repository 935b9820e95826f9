use crate::run;

#[test]
fn advice_on_a_motion_is_json_too() {
    let ended = run(&["accuracy", "--simulate", "pendulum", "--advise", "--error", "1e-6", "--repetitions", "1", "--format", "json"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    assert_eq!((&json["scene"], &json["wish"], &json["units"]["runs[].wall"]), (&"pendulum".into(), &1e-6.into(), &"s".into()));
    let runs = json["runs"].as_array().unwrap();
    assert_eq!(runs.iter().map(|r| &r["least"]).collect::<Vec<_>>(), ["evaluations", "wall"]);
    for run in runs {
        assert!(run["error"].as_f64().unwrap() <= 1e-6 && run["integrator"].is_string(), "{run}");
        assert!(run["step"].is_number() != run["tolerance"].is_number(), "{run}");
    }
    assert_eq!(json.get("curves"), None);
}
