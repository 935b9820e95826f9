//! Scenes with their robots: documents read, edited, and compared with the scene.

use std::path::Path;

use articulated_core::description::Base;
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_core::effect::EffectId;
use articulated_scene::{Bundled, Opened, Scene, open, open_in};

const LINK: &str = r#"<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"#;

/// Two hinges in a row, and a tool fixed to the second link.
fn arm() -> String {
    format!(
        r#"<robot name="arm"><link name="base"/><link name="upper">{LINK}</link><link name="fore">{LINK}</link><link name="tool"/>
        <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
          <limit lower="-1" upper="2" effort="5" velocity="3"/><dynamics damping="0.25"/></joint>
        <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/><origin xyz="0 0 -0.5"/><axis xyz="1 0 0"/></joint>
        <joint name="mount" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="0 0 -0.3"/></joint></robot>"#
    )
}

fn finger() -> String {
    format!(
        r#"<robot name="finger"><link name="palm">{LINK}</link><link name="tip">{LINK}</link>
        <joint name="bend" type="continuous"><parent link="palm"/><child link="tip"/><axis xyz="0 0 1"/></joint></robot>"#
    )
}

const EDITED: &str = "gravity = [0, 0, -1.625]
append = { urdf = \"finger.urdf\", at = \"tool\", prefix = \"left_\" }
payload = { link = \"tool\", mass = 2.5 }
lock = { elbow = 0.5 }
[effects]
damping = { \"*\" = \"urdf\", left_bend = 0.125 }
";

fn opened(scene: &str, urdf: String) -> Opened {
    Opened::new(Scene::read("s.toml", scene).unwrap(), "arm.urdf", urdf.into_bytes(), Base::Fixed, vec![finger().into_bytes()])
}

#[test]
fn a_scenes_robot_is_edited_and_has_its_gravity_and_effects() {
    let settled = opened(EDITED, arm()).build().unwrap_or_else(|e| panic!("{e}"));
    let joints: Vec<&str> = settled.model.joints().iter().map(|j| j.name.as_str()).collect();
    assert_eq!(joints, ["shoulder", "left_bend"]);
    assert_eq!((settled.model.nv(), settled.model.gravity()), (2, [0.0, 0.0, -1.625].into()));
    // Two links of the arm, two of the finger, and the load.
    assert_eq!(settled.model.moving_mass(), 6.5);
    let effects: Vec<(EffectId, &str, &[f64])> =
        settled.resolved.effects.iter().map(|a| (a.effect, a.on.as_str(), a.parameters.as_slice())).collect();
    assert_eq!(effects, [(EffectId::damping, "shoulder", &[0.25][..]), (EffectId::damping, "left_bend", &[0.125][..])]);
    let on: usize = settled.model.bodies().iter().map(|b| b.effects.joint.len()).sum();
    assert_eq!(on, 2);
    assert!(settled.reading.description.joints.iter().any(|j| j.name == "elbow" && j.locked == Some(vec![0.5])));
}

#[test]
fn everything_that_does_not_fit_the_robot_is_told_at_once_by_its_lines() {
    let scene = "payload = { link = \"too\", mass = 1 }
lock = { elbo = 0 }
frames = [\"tool\", \"tol\"]
[effects]
damping = { shouder = 0.1 }
[initial]
q = { elbow = [1, 2], wrist = 0 }
[control]
kind = \"pd\"
kp = { elbw = 1 }
kd = 1
";
    let told = opened(scene, arm()).build().unwrap_err();
    let told = told.to_string();
    let expected = [
        "1: payload: the robot has no link or frame \"too\", did you mean \"tool\"?",
        "2: lock.elbo: ",
        "3: frames: the robot has no link or frame \"tol\"",
        "5: effects.damping.shouder: ",
        "7: initial.q.elbow: ",
        "7: initial.q.wrist: ",
        "10: control.kp.elbw: ",
    ];
    assert_eq!(told.lines().count(), expected.len(), "{told}");
    assert!(told.lines().zip(expected).all(|(line, expected)| line.starts_with(&format!("s.toml:{expected}"))), "{told}");
}

#[test]
fn a_robot_that_cannot_be_read_is_told_alone() {
    let scene = "lock = { elbo = 0 }\n[effects]\ndamping = { shouder = 0.1 }\n";
    let told = opened(scene, arm().replace("parent link=\"base\"", "parent link=\"bse\"")).build();
    assert!(told.unwrap_err().errors.iter().all(|error| error.code == Code::UnknownLink && error.file() == "arm.urdf"));
}

#[test]
fn files_are_seen_from_the_scenes_folder_and_those_that_are_not_there_are_told_at_their_lines() {
    let folder = std::env::temp_dir().join(format!("articulated-opened-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name);
    std::fs::write(path("arm.urdf"), arm()).unwrap();
    std::fs::write(path("finger.urdf"), finger()).unwrap();
    std::fs::write(path("whole.toml"), format!("urdf = 'arm.urdf'\n{EDITED}")).unwrap();
    std::fs::write(path("alone.toml"), "\nurdf = 'no.urdf'").unwrap();
    std::fs::write(path("robot.toml"), "robot = 'arm'").unwrap();
    std::fs::write(path("nothing.toml"), "").unwrap();
    let [whole, alone, robot, nothing, nowhere] =
        ["whole.toml", "alone.toml", "robot.toml", "nothing.toml", "nowhere.toml"].map(|name| open(&path(name), &[]));
    std::fs::remove_dir_all(&folder).unwrap();
    let whole = whole.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(whole.files, ["whole.toml", "arm.urdf", "finger.urdf"].map(path));
    assert_eq!(whole.build().unwrap().model.nv(), 2);
    let told = |result: Result<Opened, Diagnostics>| result.unwrap_err().to_string();
    assert!(told(alone).starts_with(&format!("{}:2: urdf: {}: ", path("alone.toml").display(), path("no.urdf").display())));
    assert!(told(robot).contains("robot.toml:1: robot: found \"arm\", no such robot, expected urdf: no robot is known by name here"));
    assert!(told(nothing).contains("nothing.toml: found no robot, expected robot, or urdf"));
    assert!(told(nowhere).starts_with(&format!("{}: ", path("nowhere.toml").display())));
}

#[test]
fn a_bundled_robot_stands_on_its_own_base_unless_the_scene_says_another_and_of_others_the_nearest_is_told() {
    let urdf = format!("<robot name='stone'><link name='stone'>{LINK}</link></robot>");
    let bundled = [Bundled { name: "stone", document: &urdf, base: Base::Floating }];
    let nv = |text: &str| {
        let opened = open_in(Scene::read("s.toml", text).unwrap(), Path::new(""), &bundled)?;
        opened.build().map(|settled| settled.model.nv())
    };
    assert_eq!([nv("robot = 'stone'"), nv("robot = 'stone'\nbase = 'fixed'")].map(Result::unwrap), [6, 0]);
    let told = nv("\nrobot = 'stne'").unwrap_err().to_string();
    assert_eq!(told, "s.toml:2: robot: found \"stne\", no such robot, expected one of stone; did you mean \"stone\"?");
}
