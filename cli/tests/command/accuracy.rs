use crate::{File, run};

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
    let none = run(&["accuracy", "--simulate", "pendulum", "--advise", "--error", "1e-30", "--repetitions", "1"]);
    assert!(none.status == 4 && none.out.contains("no run is accurate to 1e-30"), "{} {}", none.status, none.out);
}

#[test]
fn files_that_cannot_be_written_do_not_cost_the_report() {
    let taken = tempfile::tempdir().unwrap();
    for name in ["report.html", "integrators.html"] {
        std::fs::create_dir(taken.path().join(name)).unwrap();
    }
    let folder = taken.path().to_str().unwrap().to_owned();
    let functions = ["simple_pendulum", "--functions", "gravity_torque", "--levels", "f64", "--states", "2"];
    let motion = ["--simulate", "pendulum"];
    for (words, list) in [(&functions[..], "functions"), (&motion[..], "curves")] {
        let words = [&["accuracy", "--repetitions", "1", "--format", "json", "--output", &folder], words].concat();
        let ended = run(&words);
        assert!(ended.status == 1 && ended.err.contains(&format!("error: {folder}/")), "{}", ended.err);
        assert!(ended.json()[list].as_array().is_some_and(|l| !l.is_empty()), "{}", ended.out);
    }
    // An impossible folder is reported before any measurement.
    let file = File::new("taken", b"");
    for words in [&functions[..], &motion] {
        let ended = run(&[&["accuracy", "--output", file.name()], words].concat());
        assert!(ended.status == 1 && ended.out.is_empty() && ended.err.contains("found a file, expected a folder"), "{}", ended.err);
    }
}

#[test]
fn what_would_be_ignored_is_status_2() {
    let of_functions: [&[&str]; 15] = [
        &["--floating"],
        &["--fixed"],
        &["--gravity", "0,0,-1"],
        &["--allow-unphysical-inertia"],
        &["--snap-angles", "1e-3"],
        &["--rename", "a=b"],
        &["--append", "gripper.urdf@tool"],
        &["--payload", "bob=1"],
        &["--lock", "swing=0"],
        &["--frames", "bob"],
        &["--wrenches-in", "world"],
        &["--functions", "mass_matrix"],
        &["--levels", "f64"],
        &["--states", "5"],
        &["--seed", "2"],
    ];
    for words in of_functions {
        let ended = run(&[&["accuracy", "--simulate", "pendulum"], words].concat());
        assert!(ended.status == 2 && ended.err.contains("cannot be used with"), "{words:?}: {}", ended.err);
    }
    for (error, status) in [("1e-9", 0), ("1e-30", 4)] {
        let words = [
            "accuracy",
            "simple_pendulum",
            "--functions",
            "inverse_dynamics",
            "--levels",
            "f64",
            "--repetitions",
            "1",
            "--advise",
            "--error",
            error,
        ];
        let ended = run(&words);
        assert_eq!(
            (ended.status, ended.err.contains("nothing measured is accurate to 1e-30")),
            (status, status == 4),
            "{}{}",
            ended.out,
            ended.err
        );
    }
    let ended = run(&["accuracy", "simple_pendulum", "--error", "1e-9"]);
    assert!(ended.status == 2 && ended.err.contains("--advise"), "{}", ended.err);
}
