//! Robots that are appended, with the worlds of their files, and attachments at frames.

use articulated_core::algorithm::{Workspace, inverse_dynamics};
use articulated_core::description::Base;
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_scene::{BuiltRobot, Controller, Opened, RobotInWorld, Scene, Signal};

/// An arm of one joint with a servo, a flange that is a site, a state "ready", and one of its own.
const ARM: &str = "<mujoco model='arm'><compiler angle='radian'/><worldbody>
  <geom type='plane' size='1 1 1'/>
  <body name='upper' pos='0 0 0.5'><joint name='lift' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0.5 0 0' size='0.04'/>
    <site name='flange' pos='0.5 0.1 0' euler='0.3 -0.4 1.1'/></body></worldbody>
  <actuator><position name='servo' joint='lift' kp='20'/></actuator>
  <keyframe><key name='ready' qpos='0.25' qvel='-1' ctrl='0.5'/><key name='flat' qpos='0.125'/></keyframe></mujoco>";

/// A hand of two fingers, the second of which follows the first, with a motor on the first, a
/// tendon with a spring, and states "ready" and "open".
const HAND: &str = "<mujoco model='hand'><compiler angle='radian'/><option gravity='0 0 -1.6'/><worldbody>
  <body name='palm'><geom size='0.05'/>
    <body name='f1' pos='0.1 0 0'><joint name='lead' axis='0 0 1' ref='0.2'/><geom type='capsule' fromto='0 0 0 0.1 0 0' size='0.01'/></body>
    <body name='f2' pos='0 0.1 0'><joint name='foll' axis='0 0 1' ref='-0.1' actuatorfrcrange='-3 3'/>
      <geom type='capsule' fromto='0 0 0 0.1 0 0' size='0.01'/></body></body></worldbody>
  <tendon><fixed name='band' stiffness='4' springlength='0.3'><joint joint='lead' coef='2'/></fixed></tendon>
  <equality><joint joint1='foll' joint2='lead' polycoef='0.3 -0.5 0 0 0'/></equality>
  <actuator><motor name='servo' joint='lead' gear='3'/></actuator>
  <keyframe><key name='ready' qpos='0.7 0.8' ctrl='0.4'/><key name='open' qpos='0.9 -0.6' qvel='2 3' ctrl='-0.2'/></keyframe></mujoco>";

const APPEND: &str = "append = { file = \"hand.xml\", at = \"flange\", prefix = \"g_\" }\n";

fn opened(text: &str, robot: &str, appended: &[&str]) -> Opened {
    let scene = Scene::read("s.toml", text).unwrap_or_else(|e| panic!("{e}"));
    Opened::new(scene, "arm.xml", robot.into(), Base::Fixed, appended.iter().map(|text| text.as_bytes().to_vec()).collect())
}

fn build(text: &str) -> Result<BuiltRobot, Diagnostics> {
    opened(text, ARM, &[HAND]).build()
}

fn built(text: &str) -> BuiltRobot {
    build(text).unwrap_or_else(|e| panic!("{e}"))
}

/// Functions with constraints refuse such a robot: else it would touch nothing, in silence.
#[test]
fn constraints_of_an_appended_file_are_reported() {
    let unread = |robot: &BuiltRobot| robot.reading.world.touching.as_ref().expect("an MJCF").unread.clone();
    let alone = opened("", ARM, &[]).build().unwrap_or_else(|e| panic!("{e}"));
    assert!(unread(&alone).is_empty());
    let found = unread(&built(APPEND));
    assert_eq!(found.len(), 1);
    assert!(found[0].what.contains("the appended robot \"g_\""), "{}", found[0].what);
}

/// The pose in the world of its own file would be another one here.
#[test]
fn stiffness_of_a_free_joint_of_an_appended_file_is_a_warning() {
    const BALL: &str = "<mujoco><worldbody><body name='ball' pos='1 0 0'><joint type='free' stiffness='3' damping='1'/><geom size='0.1'/>
      </body></worldbody></mujoco>";
    let robot = opened(APPEND, ARM, &[BALL]).build().unwrap_or_else(|e| panic!("{e}"));
    assert!(robot.reading.world.effects.is_empty());
    let warned: Vec<_> = robot.reading.warnings.iter().filter(|warning| warning.field == "stiffness").map(|warning| warning.code).collect();
    assert_eq!(warned, [Code::LostDynamics]);
}

#[test]
fn equations_of_an_appended_file_couple_its_joints() {
    let (free, coupled) = (built(APPEND), built(&format!("{APPEND}coupling = \"file\"")));
    assert_eq!((free.model.nv(), coupled.model.nv()), (3, 2));
    let warned = |robot: &BuiltRobot| robot.reading.warnings.iter().filter(|warning| warning.field == "coupling").count();
    assert_eq!((warned(&free), warned(&coupled)), (1, 0));
    let joints = &coupled.reading.description.joints;
    let find = |name: &str| joints.position(|joint| joint.name == name).unwrap();
    let mimic = joints[find("g_foll")].mimic.unwrap();
    // q + 0.1 = 0.3 − 0.5 (q₁ − 0.2)
    assert_eq!((mimic.joint, mimic.multiplier), (find("g_lead"), -0.5));
    assert!((mimic.offset - 0.3).abs() < 1e-15);
}

#[test]
fn a_refused_equation_of_an_appended_file_is_at_its_own_line() {
    let text = format!("{APPEND}coupling = \"file\"\nlock = {{ g_foll = 0 }}");
    let told = build(&text).map(drop).unwrap_err().to_string();
    assert!(told.contains("joint \"g_foll\" follows \"g_lead\": lock that one"), "{told}");
    let twice = HAND.replace("</equality>", "<joint joint1='lead' joint2='foll'/></equality>");
    let told = opened(&format!("{APPEND}coupling = \"file\""), ARM, &[&twice]).build().map(drop).unwrap_err().to_string();
    assert!(told.starts_with("hand.xml:7: joint \"g_lead\": joint \"g_lead\" cannot follow others"), "{told}");
    // Where a robot is refused, its equations are not missing.
    let told = build(&format!("{}coupling = \"file\"", APPEND.replace("g_", ""))).map(drop).unwrap_err().to_string();
    assert_eq!(told, "s.toml:1: append: name is taken: \"world\"; give another name or prefix");
}

/// τ of the file's actuators with the controls of a scene, at the start.
fn torques(text: &str) -> Vec<f64> {
    let text = format!("{APPEND}{text}");
    let robot = built(&text);
    let world = RobotInWorld { model: &robot.model, world: &robot.reading.world };
    let scene = Scene::read("s.toml", &text).unwrap();
    let (q, v) = scene.start(world).unwrap_or_else(|e| panic!("{e}"));
    let controller = scene.controller(world, &mut |_| Err("no files".into())).unwrap_or_else(|e| panic!("{e}"));
    let Controller::Actuators { actuators, controls } = controller else { panic!("{text}") };
    let Signal::Still(u) = &controls else { panic!("{text}") };
    let mut tau = vec![0.0; robot.model.nv()];
    actuators.add_torques(&actuators.inputs(&[], u, None), &q, &v, &mut tau);
    tau
}

fn close(found: &[f64], expected: &[f64]) {
    let alike = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-14);
    assert!(alike && found.len() == expected.len(), "{found:?} {expected:?}");
}

#[test]
fn actuators_and_springs_of_tendons_of_an_appended_file_act() {
    // The band pulls with 4 (0.3 − 2 q) on 2 q, from the `ref` of the file on.
    let band = |q: f64| 2.0 * 4.0 * (0.3 - 2.0 * q);
    close(&torques("control = { kind = \"actuators\" }"), &[0.0, band(0.2), 0.0]);
    close(&torques("control = { kind = \"actuators\", ctrl = { servo = 0.1, g_servo = 0.5 } }"), &[20.0 * 0.1, 1.5 + band(0.2), 0.0]);
    close(&torques("control = { kind = \"actuators\", ctrl = [0.1, 0.5] }"), &[20.0 * 0.1, 1.5 + band(0.2), 0.0]);
    close(&torques("control = { kind = \"actuators\", without = [\"g_band\", \"servo\"], ctrl = [0.5] }"), &[0.0, 1.5, 0.0]);
    let bounds = built(APPEND).reading.world.joint_forces;
    assert_eq!(bounds, [("g_foll".to_owned(), [-3.0, 3.0])]);
}

/// States of the same name are merged; others have the state of their own file, and rest elsewhere.
#[test]
fn states_of_both_files_are_merged_by_name() {
    let started = |name: &str| {
        let text = format!("{APPEND}initial = {{ keyframe = {name:?} }}");
        let robot = built(&text);
        let world = RobotInWorld { model: &robot.model, world: &robot.reading.world };
        Scene::read("s.toml", &text).unwrap().start(world).map_err(|e| e.to_string())
    };
    assert_eq!(started("ready"), Ok((vec![0.25, 0.7, 0.8], vec![-1.0, 0.0, 0.0])));
    assert_eq!(started("g_open"), Ok((vec![0.0, 0.9, -0.6], vec![0.0, 2.0, 3.0])));
    assert_eq!(started("flat"), Ok((vec![0.125, 0.2, -0.1], vec![0.0; 3])));
    let text = format!("{APPEND}initial = {{ keyframe = \"open\" }}");
    let told = build(&text).map(drop).unwrap_err().to_string();
    assert!(told.contains("expected one of ready, flat, g_open; did you mean \"g_open\"?"), "{told}");
    let without_band = |name: &str| {
        let tau = torques(&format!("control = {{ kind = \"actuators\", keyframe = {name:?}, without = [\"g_band\"] }}"));
        [tau[0], tau[1]]
    };
    close(&without_band("ready"), &[20.0 * 0.5, 3.0 * 0.4]);
    close(&without_band("g_open"), &[0.0, -3.0 * 0.2]);
    close(&without_band("flat"), &[0.0, 0.0]);
}

#[test]
fn a_robot_may_be_appended_twice_and_its_worlds_stay_apart() {
    let text = APPEND.replace("append = {", "append = [{").replace('}', "}, { file = \"hand.xml\", at = \"g_palm\", prefix = \"h_\" }]");
    let robot = opened(&text, ARM, &[HAND, HAND]).build().unwrap_or_else(|e| panic!("{e}"));
    let world = &robot.reading.world;
    let names: Vec<&str> = world.actuators.iter().map(|actuator| actuator.name.as_str()).collect();
    assert_eq!(names, ["servo", "g_servo", "h_servo"]);
    let states: Vec<(&str, &[f64])> = world.keyframes.iter().map(|own| (own.name.as_str(), own.control.as_slice())).collect();
    assert_eq!(
        states,
        [("ready", &[0.5, 0.4, 0.4][..]), ("flat", &[0.0, 0.0, 0.0]), ("g_open", &[0.0, -0.2, 0.0]), ("h_open", &[0.0, 0.0, -0.2])]
    );
}

#[test]
fn what_an_appended_file_cannot_bring_is_told() {
    let told = |robot: &BuiltRobot, code: Code| {
        let own = robot.reading.warnings.iter().filter(|warning| warning.code == code && warning.file() == "hand.xml");
        own.map(ToString::to_string).collect::<Vec<_>>()
    };
    let grounded = HAND.replace("<worldbody>", "<worldbody><geom name='floor' type='plane' size='1 1 1'/>");
    let robot = opened(APPEND, ARM, &[&grounded]).build().unwrap();
    assert_eq!(
        told(&robot, Code::NoContact),
        ["hand.xml:1: plane: found the plane \"floor\" in a robot that is appended, expected a plane of the robot that carries it: this \
          one makes no contact"]
    );
    assert_eq!(robot.reading.world.planes.len(), 1);
    assert!(robot.reading.unused.iter().any(|unused| unused.tag == "option gravity"), "{:?}", robot.reading.unused);
    assert_eq!(robot.model.gravity().z, -9.81);
    // Its geometry meets the planes according to the file.
    assert!(robot.reading.world.contact_masks.contains_key("g_palm"));
    let robot = opened(APPEND, &ARM.replace("name='servo'", "name='g_servo'"), &[HAND]).build().unwrap();
    assert_eq!(
        told(&robot, Code::DuplicateName),
        [
            "hand.xml:8: actuator: found a second actuator \"g_servo\", expected a name of its own, as a prefix gives it: it is \"g_servo_2\" \
          here"
        ]
    );
}

/// τ = ID(q, v, a) with numbers of no symmetry, with all effects.
fn inverse(robot: &BuiltRobot) -> Vec<f64> {
    let n = robot.model.nv();
    let numbers = |factor: f64| (0..n).map(|k| (factor * (k + 1) as f64).sin()).collect::<Vec<f64>>();
    let mut tau = vec![0.0; n];
    inverse_dynamics(&robot.model, &mut Workspace::new(&robot.model), &numbers(0.7), &numbers(1.3), &numbers(2.9), &mut tau);
    tau
}

/// An attachment at a site moves like one at the link that carries the site, placed by hand.
#[test]
fn robots_loads_and_effects_at_a_frame_are_those_of_its_link_at_its_pose() {
    let upright = ARM.replace("euler='0.3 -0.4 1.1'", "");
    let both = |at_site: &str, at_link: &str| {
        let [site, link] = [at_site, at_link].map(|text| {
            let hands = if text.starts_with("append") { &[HAND][..] } else { &[] };
            opened(text, &upright, hands).build().unwrap_or_else(|e| panic!("{e}"))
        });
        close(&inverse(&site), &inverse(&link));
        assert!(inverse(&site).iter().any(|tau| tau.abs() > 0.1));
    };
    let append = |place: &str| format!("append = {{ file = \"hand.xml\", prefix = \"g_\", {place} }}");
    both(&append("at = \"flange\""), &append("at = \"upper\", xyz = [0.5, 0.1, 0]"));
    both(
        &append("at = \"flange\", xyz = [0, 0, 0.25], rpy = [0.1, 0.2, 0.3]"),
        &append("at = \"upper\", xyz = [0.5, 0.1, 0.25], rpy = [0.1, 0.2, 0.3]"),
    );
    both(
        "payload = { link = \"flange\", mass = 3, center_of_mass = [0, 0.5, 0] }",
        "payload = { link = \"upper\", mass = 3, center_of_mass = [0.5, 0.6, 0] }",
    );
    both("effects.drag.flange = 5", "effects.drag.upper = { coefficient = 5, xyz = [0.5, 0.1, 0] }");
    both(
        "effects.contact = { \"*\" = { stiffness = 30, damping = 0, friction = 0, radius = 3 }, flange = { radius = 4, xyz = [0, 0, 0.5] } }",
        "effects.contact.upper = { stiffness = 30, damping = 0, friction = 0, radius = 4, xyz = [0.5, 0.1, 0.5] }",
    );
}

/// The site turns by Rx(0.3) Ry(−0.4) Rz(1.1).
#[test]
fn a_load_at_a_frame_turns_with_it() {
    let payload = |link: &str, place: [f64; 3]| {
        let text = format!("payload = {{ link = {link:?}, mass = 3, center_of_mass = {place:?} }}");
        inverse(&opened(&text, ARM, &[]).build().unwrap_or_else(|e| panic!("{e}")))
    };
    let ([a, b, c], [x, y, z]) = ([0.3_f64, -0.4, 1.1], [0.2, 0.3, -0.1]);
    let at_site = payload("flange", [x, y, z]);
    let (x, y) = (c.cos() * x - c.sin() * y, c.sin() * x + c.cos() * y);
    let (x, z) = (b.cos() * x + b.sin() * z, -b.sin() * x + b.cos() * z);
    let (y, z) = (a.cos() * y - a.sin() * z, a.sin() * y + a.cos() * z);
    close(&at_site, &payload("upper", [0.5 + x, 0.1 + y, z]));
}

#[test]
fn frames_are_chosen_and_hit_and_what_they_cannot_have_is_told() {
    let impact = "impact = { link = \"flange\", normal = [1, 0, 0], mass = 0.1, restitution = 0.5, time = 0.1 }";
    let robot = built(&format!("{APPEND}frames = [\"flange\"]\n{impact}"));
    assert_eq!(robot.frames.as_deref(), Some(&["flange".to_owned()][..]));
    let told = |text: &str| build(&format!("{APPEND}{text}")).map(drop).unwrap_err().to_string();
    let found = told(&impact.replace("\"flange", "\"flang"));
    assert!(found.contains("impact.link: found no such link, expected a link or frame of the robot; did you mean \"flange\"?"), "{found}");
    for text in ["effects.contact.flange = { from = \"collision\", stiffness = 1 }", "effects.drag.flange = \"off\""] {
        let found = told(text);
        let expected =
            "found the frame \"flange\", which has no geometry and no effects of its own, expected the link \"upper\" that carries it";
        assert!(found.contains(expected), "{found}");
    }
    let found = told("frames = [\"flang\"]");
    assert!(found.contains("frames: the robot has no link or frame \"flang\", did you mean \"flange\"?"), "{found}");
    let fixed = "payload = { link = \"mark\", mass = 1 }";
    let marked = ARM.replace("<worldbody>", "<worldbody><site name='mark'/>");
    let robot = opened(&format!("{APPEND}{fixed}"), &marked, &[HAND]).build().unwrap();
    assert!(robot.reading.warnings.iter().any(|warning| warning.field == "payload"), "{:?}", robot.reading.warnings);
}
