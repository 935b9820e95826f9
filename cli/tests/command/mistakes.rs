//! Errors of scenes and of names of files: all in one run, with their places and the intended
//! names.

use std::path::Path;

use super::{Ended, run};

const INERTIA: &str = "<inertial><mass value='1'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>";

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    folder
}

fn arm() -> String {
    let joint = |k: u32| {
        format!(
            "<link name='part_{k}'>{INERTIA}</link><joint name='turn_{k}' type='continuous'><parent link='part_{}'/><child link='part_{k}'/>
            <axis xyz='0 1 0'/><dynamics damping='0.5'/></joint>",
            k - 1
        )
    };
    format!("<robot name='arm'><link name='part_0'/>{}</robot>", (1..4).map(joint).collect::<String>())
}

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

/// Keys of errors in the order of the report.
fn fields(ended: &Ended) -> Vec<String> {
    let errors = ended.json()["errors"].as_array().unwrap().clone();
    errors.iter().map(|error| error["field"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn all_mistakes_of_a_scene_are_told_in_one_run() {
    let scene = "file = 'arm.urdf'
free_flyer = true
frames = ['part_3', 'prt_1']
functions = ['invers_dynamics']
[effects.damping]
turn_9 = 1.0
[effects.drag.part_x]
coefficient = 0.1
[initial]
q = { tern_2 = 1.0 }
[simulaton]
end = 1.0
[control]
kind = 'tabel'
file = 'torqes.csv'
";
    let folder = folder(&[("arm.urdf", &arm()), ("arm.toml", scene), ("torques.csv", "t,turn_1\n0,1\n")]);
    for command in [&["check"][..], &["simulate"], &["generate"], &["effects"]] {
        let ended = run(&[command, &[&path(folder.path(), "arm.toml"), "--format", "json"]].concat());
        let told = fields(&ended);
        let expected = [
            "free_flyer",
            "frames",
            "functions",
            "effects.damping.turn_9",
            "effects.drag.part_x",
            "initial.q.tern_2",
            "simulaton",
            "control.kind",
            "control.file",
        ];
        for key in expected {
            assert_eq!(told.iter().filter(|field| *field == key).count(), 1, "{command:?}: {key}: {told:?}");
        }
        assert_eq!((ended.status, ended.json()["exit_status"].as_i64()), (1, Some(1)));
        for meant in
            ["did you mean \"part_1\"", "did you mean `inverse_dynamics`", "did you mean \"turn_2\"", "did you mean \"torques.csv\""]
        {
            assert!(ended.err.contains(meant), "{meant}: {}", ended.err);
        }
    }
}

#[test]
fn without_its_robot_the_other_mistakes_of_a_scene_are_told() {
    let scene = "urdf = 'amr.urdf'
functions = ['mass_matrx']
append = { file = 'hnd.urdf', at = 'part_3', prefix = 'hand_' }
[simulation]
end = -1.0
[control]
kind = 'table'
file = 'torqes.csv'
";
    let folder = folder(&[("arm.urdf", &arm()), ("arm.toml", scene), ("hand.urdf", &arm()), ("torques.csv", "t,turn_1\n0,1\n")]);
    let ended = run(&["simulate", &path(folder.path(), "arm.toml"), "--format", "json"]);
    let mut told = fields(&ended);
    told.sort();
    assert_eq!(told, ["append.urdf", "control.file", "functions", "simulation.end", "urdf"], "{}", ended.err);
    for meant in ["\"arm.urdf\"?", "\"hand.urdf\"?", "\"torques.csv\"?", "`mass_matrix`?"] {
        assert!(ended.err.contains(&format!("did you mean {meant}")), "{meant}: {}", ended.err);
    }
    // A refused scene has the status of a failed motion.
    assert_eq!((ended.status, ended.json()["status"].as_str()), (1, Some("error")));
    assert!(ended.json()["exit_status"] == 1);
}

#[test]
fn a_file_that_is_not_there_is_told_with_the_one_that_was_meant() {
    let folder = folder(&[("arm.urdf", &arm()), ("arm.toml", "file = 'arm.urdf'\n"), ("states.json", "[]")]);
    let at = |name: &str| path(folder.path(), name);
    let told = |words: &[&str], meant: &str| {
        let ended = run(words);
        assert!(ended.status == 1 && ended.err.contains(&format!("did you mean {meant:?}?")), "{words:?}: {}", ended.err);
    };
    for wrong in ["arm.ursf", "amr.urdf", "arm.urd"] {
        told(&["check", &at(wrong)], "arm.urdf");
        told(&["check", &at("arm.urdf"), "--append", &format!("{}@part_3:x_", at(wrong))], "arm.urdf");
    }
    told(&["simulate", &at("arm.tomll")], "arm.toml");
    told(&["eval", &at("arm.urdf"), "--function", "mass_matrix", "--states", &at("stats.json")], "states.json");
    // A different ending alone is no typing error.
    let ended = run(&["check", &at("arm.step")]);
    assert!(ended.status == 1 && !ended.err.contains("arm.urdf"), "{}", ended.err);
}

/// A scene made by the command has no file: its numbers are those of the robot's file.
#[test]
fn what_is_wrong_with_a_number_of_the_file_is_told_where_that_stands() {
    let model = "<mujoco>
<worldbody><body name='arm'>
<joint name='turn' damping='1' stiffness='2'/>
<geom name='ball' size='.1'/></body></worldbody></mujoco>";
    for (right, wrong, told) in [
        ("damping='1'", "damping='-1'", "joint \"turn\": damping: found -1, expected a finite number, at least 0"),
        ("stiffness='2'", "stiffness='-2'", "joint \"turn\": stiffness: found -2, expected a finite number, at least 0"),
    ] {
        let folder = folder(&[("arm.xml", &model.replace(right, wrong))]);
        let file = path(folder.path(), "arm.xml");
        let ended = run(&["simulate", &file, "--format", "json"]);
        let expected = format!("{file}:3: {told}");
        let error = &ended.json()["errors"][0];
        assert_eq!(ended.status, 1, "{}", ended.err);
        assert!(error["message"].as_str().unwrap().starts_with(&expected) && error["line"] == 3, "{error}");
        assert!(ended.err.contains(&format!("{file}:3: joint \"turn\"")) && ended.err.contains(wrong), "{}", ended.err);
    }
}
