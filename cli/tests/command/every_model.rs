//! Every command over every model: bundled robots and scenes, and the files of the tests.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use articulated_cli::{Answer, answer, failure};
use serde_json::Value;

/// The folders of the repository with robots' files and scenes, with the minimum number of files,
/// so that an empty test cannot pass.
const FOLDERS: [(&str, usize); 8] = [
    ("models/urdf", 11),
    ("models/scenes", 11),
    ("tests/robots", 5),
    ("tests/ui/urdf", 9),
    ("tests/ui/scenes", 3),
    ("tests/mjcf/models", 3),
    ("tests/sdf/models", 4),
    ("tests/xacro/models", 2),
];

/// Functions of more code than this, MB, are not defined: large robots would take minutes.
const MAX_CODE_SIZE: &str = "1";

fn files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository");
    let is_read = |path: &PathBuf| {
        let ending = path.extension().and_then(|e| e.to_str());
        ending.is_some_and(|e| ["urdf", "xacro", "xml", "sdf", "toml"].contains(&e))
    };
    let mut found = Vec::new();
    for (folder, least) in FOLDERS {
        let entries = std::fs::read_dir(root.join(folder)).unwrap_or_else(|e| panic!("{folder}: {e}"));
        let before = found.len();
        found.extend(entries.map(|entry| entry.unwrap().path()).filter(is_read));
        assert!(found.len() - before >= least, "{folder}: {} files", found.len() - before);
    }
    found.sort();
    found
}

/// The answer of a command with these words.
///
/// # Panics
/// If the words are refused, the command panics, its status is not documented, or its two formats
/// disagree about whether there is a report.
fn checked(words: &[&str]) -> Answer {
    let all = std::iter::once("articulated").chain(words.iter().copied());
    let ended = catch_unwind(AssertUnwindSafe(|| answer(all.map(Into::into))));
    let ended = ended.unwrap_or_else(|_| panic!("{words:?} panicked")).unwrap_or_else(|usage| panic!("{words:?}: {usage}"));
    let documented = [failure::OK, failure::INPUT, failure::BOUND, failure::OUT_OF_TOLERANCE];
    assert!(documented.contains(&ended.status), "{words:?}: status {}: {:?}", ended.status, ended.errors);
    let json: Value = serde_json::from_str(&ended.json).unwrap_or_else(|e| panic!("{words:?}: {e}: {}", ended.json));
    if ended.text.is_empty() {
        assert!(!ended.errors.is_empty() && json["errors"].is_array(), "{words:?}: {}", ended.json);
    }
    if ended.status == failure::INPUT && ended.text.is_empty() {
        assert_eq!(json["errors"].as_array().map(Vec::len), Some(ended.errors.len()), "{words:?}");
    }
    ended
}

fn json(answer: &Answer) -> Value {
    serde_json::from_str(&answer.json).expect("JSON")
}

/// The report of `check`, whose text and JSON name the same links and joints.
fn check(file: &str) -> Option<Value> {
    let answer = checked(&["check", file]);
    let report = json(&answer);
    if answer.text.is_empty() {
        // A scene that names no robot has no report.
        assert_eq!(answer.status, failure::INPUT, "{file}");
        return None;
    }
    assert_eq!(report["usable"].as_bool(), Some(answer.status == failure::OK), "{file}");
    for (list, name) in [("links", "link"), ("joints", "joint")] {
        for row in report[list].as_array().into_iter().flatten() {
            let name = row[name].as_str().unwrap();
            // Text escapes control characters.
            assert!(name.contains(|c: char| !c.is_ascii_graphic()) || answer.text.contains(name), "{file}: {list}: {name}");
        }
    }
    let rows = |list: &str| report[list].as_array().map_or(0, Vec::len);
    assert_eq!(report["totals"]["links"].as_u64(), Some(rows("links") as u64), "{file}");
    let moving = report["joints"].as_array().into_iter().flatten().filter_map(|row| row["v"][1].as_u64()).sum::<u64>();
    assert_eq!(report["totals"]["degrees_of_freedom"].as_u64(), Some(moving), "{file}");
    (answer.status == failure::OK).then_some(report)
}

/// A state of the robot: every quaternion is the identity, all other numbers are small.
fn state(report: &Value) -> String {
    let total = |name: &str| report["totals"][name].as_u64().unwrap() as usize;
    let (nq, nv) = (total("coordinates"), total("degrees_of_freedom"));
    let mut q: Vec<f64> = (0..nq).map(|k| 0.01 * (k + 1) as f64).collect();
    for row in report["joints"].as_array().unwrap() {
        let Some(first) = row["q"][0].as_u64() else { continue };
        let quaternion = match row["kind"].as_str().unwrap() {
            "floating" => first as usize + 3,
            "spherical" => first as usize,
            _ => continue,
        };
        q[quaternion..quaternion + 4].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
    }
    let small = |scale: f64| (0..nv).map(|k| scale * (k + 1) as f64).collect::<Vec<f64>>();
    serde_json::json!([{"q": q, "v": small(0.1), "a": small(-0.2)}]).to_string()
}

/// `is_listed`: whether all functions are listed, which takes most of the time.
fn every_command(file: &Path, is_listed: bool) -> (bool, usize) {
    let name = file.to_str().unwrap();
    let Some(report) = check(name) else {
        // Other commands refuse the files that `check` refuses, with a reason.
        for words in [&["generate", name][..], &["simulate", name, "--end", "0"]] {
            let answer = checked(words);
            assert!(answer.status != failure::OK && !answer.errors.is_empty(), "{words:?} accepts what `check` refuses");
        }
        return (false, 3);
    };
    for words in [
        &["generate", name, "--functions", "inverse_dynamics"][..],
        &["generate", name, "--functions", "inverse_dynamics", "--language", "c", "--prefix", "robot"],
        &["effects", name, "--functions", "inverse_dynamics"],
        &["simulate", name, "--print-scene"],
        &["simulate", name, "--end", "0.002"],
    ]
    .into_iter()
    .chain(is_listed.then_some(&["functions", name, "--max-code-size", MAX_CODE_SIZE][..]))
    {
        let answer = checked(words);
        assert!(answer.errors.is_empty() == (answer.status == failure::OK), "{words:?}: {} {:?}", answer.status, answer.errors);
    }
    let folder = tempfile::tempdir().unwrap();
    let states = folder.path().join("states.json");
    std::fs::write(&states, state(&report)).unwrap();
    let functions = "placements,inverse_dynamics,mass_matrix,torque_regressor,kinetic_energy_regressor";
    let words = ["eval", name, "--function", functions, "--states", states.to_str().unwrap(), "--generic"];
    let answer = checked(&words);
    assert_eq!(answer.status, failure::OK, "{words:?}: {:?}", answer.errors);
    (true, 7 + usize::from(is_listed))
}

#[test]
fn every_command_answers_on_every_model() {
    let files = files();
    let (next, ran) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let (read, wrong) = (Mutex::new(BTreeSet::new()), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(file) = files.get(index) else { break };
                    // tests/every_command.py lists the functions of many more files.
                    match catch_unwind(AssertUnwindSafe(|| every_command(file, index % 4 == 0))) {
                        Ok((is_read, count)) => {
                            ran.fetch_add(count, Ordering::Relaxed);
                            if is_read {
                                read.lock().unwrap().insert(file);
                            }
                        }
                        Err(panic) => {
                            let text = panic.downcast_ref::<String>().cloned().unwrap_or_default();
                            wrong.lock().unwrap_or_else(PoisonError::into_inner).push(format!("{}: {text}", file.display()));
                        }
                    }
                }
            });
        }
    });
    let (read, wrong) = (read.into_inner().unwrap(), wrong.into_inner().unwrap());
    println!("{} of {} files are usable, {} answers", read.len(), files.len(), ran.into_inner());
    assert!(wrong.is_empty(), "{} files:\n{}", wrong.len(), wrong.join("\n"));
    assert!(read.len() >= 40, "{read:?}");
}
