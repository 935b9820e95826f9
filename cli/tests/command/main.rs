//! The command as its users run it.

mod accuracy;
mod check;
mod collision;
mod compare;
mod drives;
mod edits;
mod effects;
mod eval;
mod events;
mod every_model;
mod functions;
mod generate;
mod inputs;
mod mistakes;
mod new;
mod rollout;
mod scaling;
mod scenes;
mod simulate;
mod stress;
mod units;

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde_json::Value;

/// How a command ended.
struct Ended {
    status: i32,
    out: String,
    err: String,
}

impl Ended {
    fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|e| panic!("{e}: {}\n{}", self.out, self.err))
    }

    /// Lines of either stream that contain the word.
    fn lines_with(&self, word: &str) -> usize {
        self.out.lines().chain(self.err.lines()).filter(|l| l.contains(word)).count()
    }
}

/// The command with these words.
fn articulated(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_articulated"));
    command.args(words);
    command
}

fn run(words: &[&str]) -> Ended {
    end(articulated(words), b"")
}

/// With this on the standard input.
fn run_with(words: &[&str], input: &[u8]) -> Ended {
    end(articulated(words), input)
}

fn end(mut command: Command, input: &[u8]) -> Ended {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // A command that does not read has closed its end.
    let _ = child.stdin.take().unwrap().write_all(input);
    let output = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Ended { status: output.status.code().expect("no signal ends the command"), out: text(output.stdout), err: text(output.stderr) }
}

/// A file with this content, in a folder of its own.
struct File {
    path: PathBuf,
    _folder: tempfile::TempDir,
}

impl File {
    fn new(name: &str, content: &[u8]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        Self { path, _folder: folder }
    }

    fn name(&self) -> &str {
        self.path.to_str().unwrap()
    }
}

#[test]
fn help_tells_examples_and_statuses() {
    for command in ["check", "generate", "eval", "compare", "functions", "scaling", "simulate", "effects", "accuracy", "stress"] {
        let help = run(&[command, "--help"]);
        assert_eq!(help.status, 0);
        assert!(help.out.contains(&format!("articulated {command} ")) && help.out.contains("Exit status"), "{}", help.out);
    }
    let help = run(&["--help"]).out;
    assert!(["humanoid", "kinematics:", "twists_world_aligned"].iter().all(|part| help.contains(part)), "{help}");
}

#[test]
fn a_robot_may_be_that_of_a_scene_and_help_says_so() {
    for command in ["check", "generate", "eval", "compare", "functions", "accuracy", "stress"] {
        let help = run(&[command, "--help"]).out;
        assert!(help.lines().any(|l| l.contains("URDF") && l.contains("(.toml)")), "{help}");
    }
    for command in ["check", "functions", "stress"] {
        let ended = run(&[command, "pendulum"]);
        assert!(ended.status == 0 && ended.out.contains("pendulum"), "{command}: {}", ended.err);
    }
    // A path is a path: no other robot replaces a missing file.
    for command in ["check", "generate", "simulate", "effects", "stress"] {
        let ended = run(&[command, "pendulum.toml"]);
        assert!(
            ended.status == 1 && ended.err.contains("pendulum.toml: found n") && ended.err.contains("\"pendulum\""),
            "{command}: {}",
            ended.err
        );
    }
}

#[test]
fn a_wrong_command_line_is_status_2() {
    let wrong: [&[&str]; 7] = [
        &[],
        &["chek"],
        &["check"],
        &["check", "panda_like", "--fixed", "--floating"],
        &["generate", "panda_like", "--functions", "inverse_dynamic"],
        &["compare", "panda_like", "--repetitions", "3"],
        &["functions", "simple_pendulum", "--markdown", "--format", "json"],
    ];
    for words in wrong {
        assert_eq!(run(words).status, 2, "{words:?}");
    }
    assert!(run(wrong[4]).err.contains("did you mean inverse_dynamics?"));
}

#[test]
fn a_failure_is_json_too_where_that_was_asked_for() {
    let failed = run(&["eval", "no_such_robot", "--function", "mass_matrix", "--states", "-", "--format", "json"]);
    let (json, status) = (failed.json(), failed.status);
    assert_eq!((json["status"].as_str(), json["exit_status"].as_i64(), status), (Some("error"), Some(1), 1));
    let told = json["errors"][0]["message"].as_str().unwrap();
    assert!(told.contains("no_such_robot") && failed.err.contains(told), "{}", failed.err);
    assert_eq!(run(&["eval", "no_such_robot", "--function", "mass_matrix", "--states", "-"]).out, "");
}

#[test]
fn a_command_line_that_cannot_be_read_is_told_as_data_too() {
    for words in
        [&["check", "panda_like", "--gravity", "1", "--format", "json"][..], &["--format=json", "simulate", "pendulum", "--step", "-1"]]
    {
        let ended = run(words);
        let told = ended.json();
        assert_eq!((ended.status, told["status"].as_str(), told["exit_status"].as_u64()), (2, Some("error"), Some(2)), "{}", ended.out);
        let error = told["errors"][0]["message"].as_str().unwrap();
        assert!(error.starts_with("invalid value '") && ended.err.contains(error), "{error}");
    }
    assert_eq!(run(&["check", "panda_like", "--gravity", "1"]).out, "");
    // The list under the sentence is part of it.
    let missing = [(&["check"][..], "<ROBOT>"), (&["simulate"], "<SCENE>"), (&["accuracy", "panda_like", "--error", "1"], "--advise")];
    for (words, what) in missing {
        let told = run(&[words, &["--format", "json"]].concat()).json();
        let expected = format!("the following required arguments were not provided: {what}");
        let errors = told["errors"].as_array().unwrap();
        let [error] = errors.as_slice() else { panic!("{words:?}: {errors:?}") };
        assert_eq!((&error["severity"], &error["message"]), (&"error".into(), &expected.into()), "{words:?}");
        let keys = ["code", "file", "line", "column", "subject", "field", "found", "expected", "hint"];
        assert!(keys.iter().all(|key| error[key].is_null()), "{words:?}: {error}");
    }
}
