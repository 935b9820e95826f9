//! `articulated new`.

use std::path::{Path, PathBuf};

use crate::run;

/// A path in the temporary folder that does not exist.
fn fresh(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("articulated-new-{}", std::process::id())).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

/// The program of a new crate, with the robot's path in the examples.
fn program(folder: &Path, robot: &str) -> String {
    let text = std::fs::read_to_string(folder.join("src/main.rs")).unwrap();
    text.replace("\"robot.urdf\"", &format!("\"../models/urdf/{robot}.urdf\""))
}

/// The examples contain the programs, so that they are compiled, run and formatted there.
#[test]
fn programs_are_those_of_the_examples() {
    for (example, robot) in [("new_arm", "panda_like"), ("new_walker", "quadruped")] {
        let folder = fresh(example);
        let made = run(&["new", folder.to_str().unwrap(), "--file", robot, "--format", "json"]);
        assert_eq!(made.status, 0, "{}", made.err);
        // A floating robot has a scene in which it falls on its tips.
        assert_eq!(made.json()["files"].as_array().unwrap().len(), if robot == "quadruped" { 5 } else { 4 });
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        assert!(manifest.contains(&format!("[profile.dev.package.{example}]")), "{manifest}");
        let urdf = std::fs::read(folder.join("robot.urdf")).unwrap();
        assert_eq!(urdf, articulated_models::robot(robot).unwrap().urdf.as_bytes());
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../examples/src/bin/{example}.rs"));
        let text = program(&folder, robot);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        assert!(std::fs::read_to_string(&path).unwrap_or_default() == text, "{}: run with UPDATE_GOLDEN=1", path.display());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn nothing_is_written_where_something_is_wrong() {
    let folder = fresh("refused");
    let (path, bad_name) = (folder.to_str().unwrap(), fresh("9lives"));
    let bad_name = bad_name.to_str().unwrap();
    let cases: [(&[&str], &str); 5] = [
        (&["new", path, "--file", "no_such.urdf"], "no_such.urdf"),
        (&["new", path, "--file", "quadruped", "--controller", "computed-torque"], "found a floating base"),
        (&["new", path, "--file", "golf_swing"], "found a bundled scene"),
        (&["new", bad_name, "--file", "panda_like"], "found the name \"9lives\""),
        (&["new", path, "--file", "panda_like", "--library", "/nowhere"], "--library /nowhere: found no crate"),
    ];
    for (words, part) in cases {
        let ended = run(words);
        assert!(ended.status != 0 && ended.err.contains(part), "{words:?}: {} {}", ended.status, ended.err);
        assert!(!folder.exists(), "{words:?}");
    }
    // A folder with files stays as it is.
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("mine.txt"), "mine").unwrap();
    let ended = run(&["new", path, "--file", "panda_like"]);
    assert!(ended.status != 0 && ended.err.contains("an empty one"), "{}", ended.err);
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
}

/// What `check` takes, `new` takes, and the crate's robot is the same.
#[test]
fn options_of_the_robot_are_keys_of_a_scene_in_the_crate() {
    let arm = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/robots/arm.urdf");
    let arm = arm.to_str().unwrap();
    let (folder, append) = (fresh("edited"), format!("{arm}@tool:second_:0.1,0,0,0,0.5,0"));
    let options = [
        &["--payload", "fore=0.3@0,0,0.1:1e-3,0,0,1e-3,0,2e-3", "--lock", "yaw=0.5", "--gravity", "0,0,-1.6", "--rename", "fore=FORE"][..],
        &["--append", &append, "--coupling", "elbow=second_yaw:0.5,0.1", "--snap-angles", "1e-9", "--first-of-duplicates"],
    ]
    .concat();
    let made = run(&[&["new", folder.to_str().unwrap(), "--file", arm][..], &options].concat());
    assert_eq!(made.status, 0, "{}", made.err);
    let main = std::fs::read_to_string(folder.join("src/main.rs")).unwrap();
    assert!(main.contains("scene = \"robot.toml\","), "{main}");
    let report = |robot: &str, options: &[&str]| {
        let ended = run(&[&["check", robot, "--format", "json"][..], options].concat());
        assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
        let json = ended.json();
        ["gravity", "totals", "links", "joints"].map(|key| {
            assert!(!json[key].is_null(), "{key}");
            json[key].clone()
        })
    };
    assert_eq!(report(folder.join("robot.toml").to_str().unwrap(), &[]), report(arm, &options));
    std::fs::remove_dir_all(&folder).unwrap();
    // A scene is used where it is; options of a robot belong into it.
    let scene = crate::File::new("own.toml", format!("urdf = {arm:?}\nlock = {{ yaw = 0.5 }}\n").as_bytes());
    let made = run(&["new", folder.to_str().unwrap(), "--file", scene.name()]);
    assert_eq!(made.status, 0, "{}", made.err);
    assert!(std::fs::read_to_string(folder.join("src/main.rs")).unwrap().contains("scene = \"/"));
    std::fs::remove_dir_all(&folder).unwrap();
    let ended = run(&["new", folder.to_str().unwrap(), "--file", scene.name(), "--lock", "elbow=0"]);
    assert!(ended.status == 2 && ended.err.contains("expected these options in the scene"), "{}", ended.err);
}

/// It falls on its feet and stays there.
#[test]
fn the_scene_of_a_floating_robot_runs() {
    for robot in ["quadruped", "humanoid"] {
        let folder = fresh(robot);
        assert_eq!(run(&["new", folder.to_str().unwrap(), "--file", robot]).status, 0);
        let ended = run(&["simulate", folder.join("drop.toml").to_str().unwrap(), "--end", "0.4", "--format", "json"]);
        assert_eq!(ended.status, 0, "{}", ended.err);
        let events = ended.json()["events"].as_array().unwrap().len();
        assert!(events >= 2, "{robot}: {events} touch the ground");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
