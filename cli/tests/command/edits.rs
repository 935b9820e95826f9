use super::{File, run};

const GRIPPER: &str = r#"<robot name="gripper"><link name="palm"/>
<link name="finger"><inertial><mass value="0.25"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
<joint name="close" type="prismatic"><parent link="palm"/><child link="finger"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.1" effort="1" velocity="1"/></joint></robot>"#;

#[test]
fn check_tells_what_an_edited_robot_is_made_of() {
    let gripper = File::new("gripper.urdf", GRIPPER.as_bytes());
    let plain = run(&["check", "double_pendulum", "--format", "json"]).json();
    let link = plain["links"][2]["link"].as_str().unwrap();
    let joint = plain["joints"][0]["joint"].as_str().unwrap();
    let append = format!("{}@{link}:left_:0,0,0.1", gripper.name());
    let (payload, lock) = ("left_palm=1.5@0,0,0.1".to_owned(), format!("{joint}=0.5"));
    let words = ["check", "double_pendulum", "--append", &append, "--payload", &payload, "--lock", &lock];
    let json = run(&[&words[..], &["--format", "json"]].concat()).json();
    assert_eq!(json["totals"]["degrees_of_freedom"], plain["totals"]["degrees_of_freedom"]);
    let mass = |report: &serde_json::Value| report["totals"]["mass"].as_f64().unwrap();
    assert!((mass(&json) - mass(&plain) - 1.75).abs() < 1e-12);
    let locked = json["joints"].as_array().unwrap().iter().find(|j| j["joint"] == joint).unwrap();
    assert_eq!((locked["locked"][0].as_f64(), locked["q"].is_null()), (Some(0.5), true));
    let text = run(&words);
    assert!(text.status == 0 && text.lines_with("locked at 0.5") == 1 && text.lines_with("left_close") >= 1, "{}", text.out);
}

/// A body that floats, with a site on the arm that it carries.
const FLYER: &str = "<mujoco><worldbody><body name='hull'><freejoint name='air'/><geom size='0.1'/>
<body name='arm' pos='0.1 0 0'><joint name='turn' axis='0 1 0'/><geom size='0.05'/><site name='tip' pos='0.2 0 0'/></body></body></worldbody></mujoco>";

/// Two fingers, the second of which follows the first.
const CLAW: &str = "<mujoco><worldbody><body name='a'><joint name='lead' axis='0 1 0'/><geom size='0.05'/></body>
<body name='b'><joint name='foll' axis='0 1 0' ref='0.5'/><geom size='0.05'/></body></worldbody>
<compiler angle='radian'/><equality><joint joint1='foll' joint2='lead' polycoef='0.25 -2 0 0 0'/></equality></mujoco>";

#[test]
fn a_robot_hangs_at_a_site_with_the_equations_of_its_file() {
    let (flyer, claw) = (File::new("flyer.xml", FLYER.as_bytes()), File::new("claw.xml", CLAW.as_bytes()));
    let append = format!("{}@tip:g_", claw.name());
    let report = |coupling: &[&str]| {
        let ended = run(&[&["check", flyer.name(), "--append", &append, "--format", "json"], coupling].concat());
        assert_eq!(ended.status, 0, "{}{}", ended.out, ended.err);
        ended.json()["totals"]["degrees_of_freedom"].as_u64()
    };
    assert_eq!((report(&[]), report(&["--coupling", "file"])), (Some(9), Some(8)));
    let wrong = run(&["check", flyer.name(), "--append", &append.replace("@tip", "@tap")]);
    assert!(wrong.status == 1 && wrong.lines_with("no link or frame \"tap\", did you mean \"tip\"?") == 1, "{}{}", wrong.out, wrong.err);
}

#[test]
fn a_floating_base_beside_a_free_joint_is_refused() {
    let flyer = File::new("flyer.xml", FLYER.as_bytes());
    for command in ["check", "generate", "functions"] {
        let ended = run(&[command, flyer.name(), "--floating"]);
        let told = "\"hull\" has the free joint \"air\" already: leave out --floating";
        assert!(ended.status == 1 && ended.lines_with(told) == 1, "{command}: {}{}", ended.out, ended.err);
    }
}

#[test]
fn a_lock_beyond_the_limits_is_a_warning() {
    let gripper = File::new("gripper.urdf", GRIPPER.as_bytes());
    let text = run(&["check", gripper.name(), "--lock", "close=0.2"]);
    assert!(text.status == 0 && text.lines_with("found 0.2, beyond its limits, expected 0 to 0.1") == 1, "{}", text.out);
}

#[test]
fn edits_that_cannot_be_made_are_told_all_at_once() {
    let gripper = File::new("gripper.urdf", GRIPPER.as_bytes());
    let wrong = ["--lock", "clos=0", "--lock", "close=0,1", "--payload", "plam=1", "--frames", "finger,thumb"];
    for command in ["check", "generate"] {
        let ended = run(&[&[command, gripper.name()][..], &wrong].concat());
        assert_eq!(ended.status, 1);
        for words in
            ["joint \"clos\", did you mean \"close\"?", "locked at [0.0, 1.0]", "did you mean \"palm\"?", "no link or frame \"thumb\""]
        {
            assert_eq!(ended.lines_with(words), 1, "{words}: {}{}", ended.out, ended.err);
        }
    }
    assert_eq!(run(&["check", gripper.name(), "--lock", "close"]).status, 2);
    assert_eq!(run(&["check", gripper.name(), "--append", "nothing.urdf@palm"]).status, 1);
}

#[test]
fn generated_code_says_how_the_robot_was_edited() {
    let gripper = File::new("gripper.urdf", GRIPPER.as_bytes());
    let append = format!("{}@finger:second_", gripper.name());
    let words =
        ["generate", gripper.name(), "--append", &append, "--payload", "palm=2", "--lock", "close=0.05", "--frames", "second_finger"];
    let ended = run(&[&words[..], &["--wrenches-in", "world_aligned"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    for words in [
        "// Appended: ",
        "// Payload: 2.0 kg on link \"palm\"",
        "// Locked: joint \"close\" at [0.05].",
        "// Frames: second_finger.",
        "// Wrenches in: world_aligned.",
    ] {
        assert_eq!(ended.lines_with(words), 1, "{words}: {}", ended.out);
    }
    assert!(ended.out.contains("JOINT_NAMES: [&str; JOINTS] = [\"second_close\"]"));
    assert!(ended.out.contains("FRAME_NAMES: [&str; FRAMES] = [\"second_finger\"]"));
}

#[test]
fn a_locked_joint_is_missing_in_states() {
    let states = File::new("states.json", br#"{"states": [{"q": [0.3], "v": [0.0], "a": [0.0]}]}"#);
    let plain = run(&["check", "double_pendulum", "--format", "json"]).json();
    let lock = format!("{}=0.0", plain["joints"][1]["joint"].as_str().unwrap());
    let words = ["eval", "double_pendulum", "--function", "gravity_torque", "--states", states.name(), "--generic", "--lock", &lock];
    let ended = run(&words);
    assert_eq!(ended.status, 0, "{}", ended.err);
}

/// An appended joint has as much damping as the scene's own joints, and a locked one has none.
#[test]
fn effects_of_a_scene_are_on_the_joints_of_the_edited_robot() {
    let gripper = File::new("gripper.urdf", GRIPPER.as_bytes());
    let scene = File::new("damped.toml", b"robot = \"double_pendulum\"\n[effects]\ndamping = 0.1\n");
    let plain = run(&["check", "double_pendulum", "--format", "json"]).json();
    let link = plain["links"][2]["link"].as_str().unwrap();
    let joint = plain["joints"][0]["joint"].as_str().unwrap();
    let states = File::new("states.json", br#"{"states":[{"q":[0,0],"v":[0,1],"a":[0,0]}]}"#);
    let (append, lock) = (format!("{}@{link}:left_", gripper.name()), format!("{joint}=0"));
    let words = ["eval", scene.name(), "--append", &append, "--lock", &lock, "--function", "effect_forces", "--states", states.name()];
    let json = run(&[&words[..], &["--format", "json"]].concat()).json();
    assert!(json.to_string().contains("-0.1"), "{json}");
}
