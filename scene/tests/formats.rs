//! Numbers of effects that robots of all formats have in their files.

use std::fs;

use articulated_core::algorithm::{Workspace, function};

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

const ROTOR: &str = "<robot name='r' xmlns:drake='http://drake.mit.edu'><link name='b'/><link name='c'><inertial><origin xyz='0 0 0.1'/>\
    <mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>\
    <joint name='j' type='continuous'><parent link='b'/><child link='c'/><axis xyz='0 1 0'/></joint>\
    <transmission name='t'><type>transmission_interface/SimpleTransmission</type><joint name='j'/><actuator name='m'>\
    <mechanicalReduction>113.9</mechanicalReduction><motorInertia>5.5e-6</motorInertia></actuator></transmission>\
    <gazebo reference='j'><springStiffness>3</springStiffness><springReference>0.5</springReference></gazebo></robot>";

/// M = I + m c² + I_rotor n² = 0.01 + 1 · 0.1² + 5.5e-6 · 113.9² = 0.091352655.
#[test]
fn a_scene_takes_rotors_and_springs_of_a_urdf() {
    let folder = std::env::temp_dir().join(format!("articulated-scene-rotor-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("r.urdf"), ROTOR).unwrap();
    let built = |effects: &str| {
        fs::write(folder.join("scene.toml"), format!("urdf = \"r.urdf\"\n[effects]\n{effects}")).unwrap();
        articulated_scene::open(&folder.join("scene.toml"), &[]).unwrap().robot().build().unwrap_or_else(|found| panic!("{found}"))
    };
    let mass = |effects: &str| {
        let robot = built(effects);
        let row = function::<f64>("mass_matrix").unwrap();
        let mut out = vec![0.0; row.len(robot.model.shape())];
        row.call(&robot.model, &mut Workspace::new(&robot.model), &[&[0.3]], &mut out).unwrap();
        out[0]
    };
    for source in ["armature = \"file\"", "armature = { '*' = \"urdf\" }", "armature = { j = \"file\" }"] {
        assert!((mass(source) - 0.091352655).abs() < 1e-15, "{source}: {}", mass(source));
    }
    assert!((mass("") - 0.02).abs() < 1e-15);
    let robot = built("armature = \"file\"\nspring = \"file\"");
    assert!(robot.reading.unused.iter().all(|unused| !unused.tag.starts_with("joint ")), "{:?}", robot.reading.unused);
    assert!(robot.reading.warnings.is_empty(), "{:?}", robot.reading.warnings);
    let spring = robot.effects.iter().find(|effect| format!("{:?}", effect.effect) == "spring").unwrap();
    assert_eq!(spring.parameters[..2], [3.0, 0.5]);
    assert_eq!(built("").reading.unused.iter().filter(|unused| unused.tag.starts_with("joint ")).count(), 3);
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_robot_has_one_file() {
    let found = articulated_scene::Scene::read("s.toml", "file = \"a.xml\"\nurdf = \"b.urdf\"").unwrap_err().to_string();
    assert!(found.contains("urdf and file, expected one of them"), "{found}");
}
