//! Robots in other formats than URDF.

use std::fs;

const ARM: &str = "<mujoco><include file=\"parts/common.xml\"/><worldbody><body name=\"upper\"><joint name=\"elbow\" class=\"arm\"/>\
    <geom size=\"0.1\"/></body></worldbody></mujoco>";
const COMMON: &str = "<mujoco><compiler angle=\"radian\"/><default><default class=\"arm\">\
    <joint damping=\"0.5\" armature=\"0.25\" stiffness=\"2\" springref=\"0.75\" frictionloss=\"0.125\" range=\"-1 1\"/></default></default></mujoco>";
const SCENE: &str = "file = \"arm.xml\"\n[effects]\ndamping = \"file\"\narmature = \"file\"\nspring = \"urdf\"\nfriction = { from = \"file\", speed = 0.01 }\n";

#[test]
fn a_scene_takes_an_mjcf_with_the_files_that_it_includes() {
    let folder = std::env::temp_dir().join(format!("articulated-scene-mjcf-{}", std::process::id()));
    fs::create_dir_all(folder.join("parts")).unwrap();
    fs::write(folder.join("arm.xml"), ARM).unwrap();
    fs::write(folder.join("parts/common.xml"), COMMON).unwrap();
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    let opened = articulated_scene::open(&folder.join("scene.toml"), &[]).unwrap();
    assert!(opened.files.contains(&folder.join("parts/common.xml")), "{:?}", opened.files);
    fs::remove_dir_all(&folder).unwrap();
    // All files have been read.
    let robot = opened.robot().build().unwrap_or_else(|found| panic!("{found}"));
    assert!(robot.reading.unused.iter().all(|unused| !unused.tag.contains("joint ") && !unused.tag.contains("dynamics")));
    let mut found: Vec<String> = robot.effects.iter().map(|effect| format!("{effect:?}")).collect();
    found.sort();
    assert_eq!(found.len(), 4, "{found:?}");
    let all = found.concat();
    for number in ["0.5", "0.25", "2.0", "0.75", "0.125"] {
        assert!(all.contains(number), "{number} in {all}");
    }
}

#[test]
fn a_robot_has_one_file() {
    let found = articulated_scene::Scene::read("s.toml", "file = \"a.xml\"\nurdf = \"b.urdf\"").unwrap_err().to_string();
    assert!(found.contains("urdf and file, expected one of them"), "{found}");
}
