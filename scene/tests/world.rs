//! States, actuators, gravity and steps of the robot's file, as scenes use them.

use articulated_core::description::{Base, JointId};
use articulated_core::model::Model;
use articulated_formats::world::{Actuator, Keyframe, World};
use articulated_scene::{Controller, RobotInWorld, Scene, Signal};

const ROBOT: &str = r#"<robot name="r"><link name="base"/><link name="a"/><link name="b"/>
  <joint name="one" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
  <joint name="two" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="9" velocity="9"/></joint>
</robot>"#;

fn model() -> Model<f64> {
    let description = articulated_formats::read(ROBOT.as_bytes(), &Default::default()).unwrap().description;
    Model::new(&description, Base::Fixed).unwrap()
}

fn world() -> World {
    let actuator = |name: &str, drives: &[(&str, f64)]| Actuator {
        name: name.into(),
        drives: drives.iter().map(|(joint, gear)| ((*joint).to_owned(), vec![*gear])).collect(),
        gain: [2.0, 0.0, 0.0],
        ..Actuator::default()
    };
    World {
        home: Some(Keyframe { q: vec![("one".into(), vec![0.5])], ..Keyframe::default() }),
        keyframes: vec![Keyframe {
            name: "bent".into(),
            q: vec![("two".into(), vec![0.25])],
            v: vec![("one".into(), vec![3.0])],
            control: vec![1.0, -1.0],
            ..Keyframe::default()
        }],
        actuators: vec![actuator("turn", &[("one", 1.0)]), actuator("both", &[("one", 0.5), ("two", -2.0)])],
        passive: vec![Actuator { bias: [0.0, -3.0, 0.0], ..actuator("string", &[("two", 1.0)]) }],
        joint_forces: vec![("two".into(), [-1.0, 1.0])],
        step: Some(0.002),
        ..World::default()
    }
}

fn scene(text: &str) -> Scene {
    Scene::read("s.toml", text).unwrap_or_else(|e| panic!("{e}"))
}

fn started(text: &str) -> Result<(Vec<f64>, Vec<f64>), String> {
    let (model, world) = (model(), world());
    scene(text).start(RobotInWorld { model: &model, world: &world }).map_err(|e| e.to_string())
}

fn controlled(text: &str, world: &World) -> Result<Controller, String> {
    let model = model();
    scene(text).controller(RobotInWorld { model: &model, world }, &mut |_| Err("no files".into())).map_err(|e| e.to_string())
}

#[test]
fn a_motion_starts_where_the_file_says_and_the_scene_changes_it() {
    assert_eq!(started(""), Ok((vec![0.5, 0.0], vec![0.0, 0.0])));
    assert_eq!(started("initial = { q = { two = 0.1 } }"), Ok((vec![0.5, 0.1], vec![0.0, 0.0])));
    assert_eq!(started("initial = { keyframe = \"bent\" }"), Ok((vec![0.5, 0.25], vec![3.0, 0.0])));
    assert_eq!(started("initial = { keyframe = \"bent\", q = { two = 0.75 }, v = [0, 1] }"), Ok((vec![0.5, 0.75], vec![0.0, 1.0])));
    let told = "s.toml:1: initial.keyframe: found the keyframe \"bend\", expected one of bent; did you mean \"bent\"?";
    assert_eq!(started("initial = { keyframe = \"bend\" }"), Err(told.to_owned()));
}

#[test]
fn actuators_of_the_file_drive_their_joints() {
    let (world, q, v) = (world(), [0.1, 0.5], [0.0, 0.0]);
    let torques = |text: &str| {
        let Ok(Controller::Actuators { actuators, controls }) = controlled(text, &world) else { panic!("{text}") };
        let Signal::Still(u) = &controls else { panic!("{text}") };
        let mut tau = [0.0; 2];
        actuators.add_torques(&actuators.inputs(&[], u, None), &q, &v, &mut tau);
        tau
    };
    // The string pulls with −3 · 0.5.
    assert_eq!(torques("control = { kind = \"actuators\" }"), [0.0, -1.5]);
    assert_eq!(torques("control = { kind = \"actuators\", ctrl = { turn = 4 } }"), [8.0, -1.5]);
    // The bound of joint two is of actuators alone: −2 · 2 · 3 becomes −1.
    assert_eq!(torques("control = { kind = \"actuators\", ctrl = [0, 3] }"), [3.0, -1.0 - 1.5]);
    assert_eq!(torques("control = { kind = \"actuators\", keyframe = \"bent\", ctrl = { both = 0.25 } }"), [2.25, -1.0 - 1.5]);
}

#[test]
fn controls_over_time_have_the_names_of_actuators() {
    let text = "control = { kind = \"actuators\", columns = [\"both\"], rows = [[0, 1], [2, 3]] }";
    let Ok(Controller::Actuators { controls, .. }) = controlled(text, &world()) else { panic!("actuators") };
    let Signal::Moving(series) = controls else { panic!("a table") };
    let mut u = [9.0; 2];
    series.at(0.5, &mut u);
    assert_eq!(u, [0.0, 1.5]);
    let told = controlled(&text.replace("both", "bots"), &world()).unwrap_err();
    assert!(
        told.starts_with("s.toml:1: control.columns[0]: found the column \"bots\", expected an actuator of the robot's file"),
        "{told}"
    );
    let told = Scene::read("s.toml", &text.replace("rows", "ctrl = [1, 2], rows")).unwrap_err().to_string();
    assert_eq!(told, "s.toml:1: control: found controls and a table of controls, expected one of them");
}

#[test]
fn actuators_that_cannot_be_are_refused() {
    let told = |text: &str, world: &World| controlled(text, world).unwrap_err();
    let plain = "control = { kind = \"actuators\" }";
    assert_eq!(
        told(plain, &World::default()),
        "s.toml:1: control.kind: found actuators, of which the robot's file has none, expected another kind of control"
    );
    let text = "control = { kind = \"actuators\", ctrl = [1] }";
    assert_eq!(
        told(text, &world()),
        "s.toml:1: control.ctrl: found one number, expected 2 numbers, one for each actuator of the robot's file"
    );
    let text = "control = { kind = \"actuators\", ctrl = { trun = 1, both = [1, 2] } }";
    let both = told(text, &world());
    assert!(both.contains("control.ctrl.trun: found no such actuator") && both.contains("did you mean \"turn\"?"), "{both}");
    assert!(both.contains("control.ctrl.both: found 2 numbers, expected one number"), "{both}");
    let mut other = world();
    other.actuators[0].drives[0].0 = "three".into();
    assert_eq!(
        told(plain, &other),
        "s.toml:1: control.kind: found the actuator \"turn\" on joint \"three\", which is locked, expected joints that move, or \
         `without = [\"turn\"]`, which leaves it out"
    );
    let told = Scene::read("s.toml", "control = { kind = \"actuators\", kp = 1 }").unwrap_err().to_string();
    assert!(told.contains("expected one of ctrl, keyframe, without, file, columns, rows, interpolation, period"), "{told}");
}

/// Servos p1 and p2 of two joints, a spring of a tendon over both, and a state. With joint two
/// locked, the rest of the control is the file's.
#[test]
fn actuators_of_a_locked_joint_are_left_out_by_name() {
    const SERVOS: &str = "<mujoco><worldbody><body><joint name='one' axis='0 1 0'/><geom size='0.1'/>
      <body pos='0.3 0 0'><joint name='two' axis='0 1 0'/><geom size='0.1'/></body></body></worldbody>
      <tendon><fixed name='string' stiffness='5' springlength='0'><joint joint='one' coef='1'/><joint joint='two' coef='1'/></fixed></tendon>
      <actuator><position name='p2' joint='two' kp='7'/><position name='p1' joint='one' kp='11'/></actuator>
      <keyframe><key name='k' qpos='0.1 0.2' ctrl='0.6 0.5'/></keyframe></mujoco>";
    let built = |control: &str| {
        let text = scene(&format!("lock = {{ two = 0.2 }}\ncontrol = {{ kind = \"actuators\", {control} }}"));
        articulated_scene::Opened::new(text.clone(), "m.xml", SERVOS.into(), Base::Fixed, vec![]).build().map(|robot| (robot, text))
    };
    let torque = |control: &str| {
        let (robot, text) = built(control).unwrap_or_else(|e| panic!("{e}"));
        let world = RobotInWorld { model: &robot.model, world: &robot.reading.world };
        let Ok(Controller::Actuators { actuators, controls }) = text.controller(world, &mut |_| Err("no files".into())) else {
            panic!("{control}")
        };
        let Signal::Still(u) = &controls else { panic!("{control}") };
        let mut tau = [0.0];
        actuators.add_torques(&actuators.inputs(&[], u, None), &[0.1], &[0.0], &mut tau);
        tau[0]
    };
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    close(torque("without = [\"p2\", \"string\"], keyframe = \"k\""), 11.0 * (0.5 - 0.1));
    close(torque("without = [\"p2\", \"string\"], ctrl = { p1 = 0.3 }"), 11.0 * (0.3 - 0.1));
    close(torque("without = [\"p2\", \"string\"], ctrl = [0.3]"), 11.0 * (0.3 - 0.1));
    close(torque("without = [\"p2\", \"p1\", \"string\"]"), 0.0);
    let told = built("without = [\"p3\", \"string\", \"string\"]").map(drop).unwrap_err().to_string();
    for part in [
        "control.without[0]: found no such actuator, expected an actuator or a tendon of the robot's file; did you mean \"p2\"?",
        "control.without[2]: found \"string\" a second time, expected each name once",
        "the actuator \"p2\" on joint \"two\", which is locked, expected joints that move, or `without = [\"p2\"]`",
    ] {
        assert!(told.contains(part), "{part} in {told}");
    }
    let told = Scene::read("s.toml", "control = { kind = \"pd\", kp = 1, without = [\"p2\"] }").unwrap_err().to_string();
    assert!(told.contains("control.without: found a key that control of kind \"pd\" does not have"), "{told}");
}

#[test]
fn a_step_may_be_that_of_the_file() {
    let text = "simulation = { end = 1, integrator = \"rk4\", step = \"file\" }";
    let stepped = |world: &World| scene(text).with_step_of(world).simulation.unwrap().settings.step;
    assert_eq!((stepped(&world()), stepped(&World::default())), (Some(0.002), None));
    let refused = articulated_scene::Opened::new(scene(text), "r.urdf", ROBOT.into(), Base::Fixed, vec![]).build().unwrap_err().to_string();
    assert_eq!(refused, "s.toml:1: simulation.step: found \"file\", and the robot's file has no time step, expected a number, s");
}

#[test]
fn what_a_scene_does_not_take_from_the_file_is_listed() {
    const MODEL: &str = "<mujoco><option timestep='0.005'/><worldbody><body><joint name='j'/><geom size='0.1'/></body></worldbody>
      <actuator><motor joint='j'/></actuator>
      <keyframe><key name='k' qpos='1'/><key qpos='2'/></keyframe></mujoco>";
    let unused = |text: &str| {
        let built = articulated_scene::Opened::new(scene(text), "m.xml", MODEL.into(), Base::Fixed, vec![]).build().unwrap();
        built.reading.unused.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let all = unused("");
    for part in [
        "line 2: actuator: one actuator: used in scenes with control = { kind = \"actuators\" }, and by functions of the group actuators",
        "line 3: keyframe: 2 states: used in scenes with initial = { keyframe = … }",
        "option timestep: 0.005 s: used in scenes with simulation = { step = \"file\" }",
    ] {
        assert!(all.iter().any(|line| line.contains(part)), "{part} in {all:#?}");
    }
    let text = "control = { kind = \"actuators\" }\ninitial = { keyframe = \"k\" }\nsimulation = { end = 1, integrator = \"rk4\", step = \"file\" }";
    assert_eq!(unused(text), Vec::<String>::new());
}

#[test]
fn equations_of_the_file_are_couplings_where_the_scene_says_so() {
    let refused = |text: &str| {
        articulated_scene::Opened::new(scene(text), "r.urdf", ROBOT.into(), Base::Fixed, vec![]).build().map(|robot| robot.model.nv())
    };
    let told = refused("coupling = \"file\"").unwrap_err().to_string();
    assert_eq!(
        told,
        "s.toml: coupling: found \"file\", and the robot's file has no equations that joints can follow, expected no key coupling, or a table of joints"
    );
    assert_eq!(refused("").unwrap(), 2);
    const GRIPPER: &str = "<mujoco><option gravity='0 0 -3.7'/><worldbody>
      <body name='a'><joint name='one' axis='0 0 1'/><geom size='0.1'/></body>
      <body name='b'><joint name='two' axis='0 0 1' ref='10'/><geom size='0.1'/></body></worldbody>
      <equality><joint joint1='two' joint2='one' polycoef='0 -2 0 0 0'/></equality></mujoco>";
    let built = |text: &str| articulated_scene::Opened::new(scene(text), "g.xml", GRIPPER.into(), Base::Fixed, vec![]).build().unwrap();
    let (free, coupled) = (built(""), built("coupling = \"file\""));
    assert_eq!((free.model.nv(), coupled.model.nv()), (2, 1));
    let warned = |robot: &articulated_scene::BuiltRobot| robot.reading.warnings.iter().filter(|w| w.field == "coupling").count();
    assert_eq!((warned(&free), warned(&coupled)), (1, 0));
    let mimic = coupled.reading.description.joints[JointId(1)].mimic.unwrap();
    assert_eq!((mimic.joint, mimic.multiplier, mimic.offset), (JointId(0), -2.0, 10.0_f64.to_radians()));
    // A servo of the follower, q = −2 q₁ + 10°: its torque on the leader is −2 f.
    let servo =
        Actuator { drives: vec![("two".into(), vec![3.0])], gain: [0.5, 0.25, 0.0], bias: [1.0, -7.0, -0.5], ..Actuator::default() };
    let world = World { actuators: vec![servo], ..World::default() };
    let of = |robot: &articulated_scene::BuiltRobot, q: &[f64], v: &[f64]| torques(robot, &world, q, v);
    let (q, v) = (-2.0 * 0.3 + 10.0_f64.to_radians(), -2.0 * 0.7);
    let (apart, together) = (of(&free, &[0.3, q], &[0.7, v]), of(&coupled, &[0.3], &[0.7]));
    assert!(
        apart[0] == 0.0 && (together[0] + 2.0 * apart[1]).abs() < 1e-14 * apart[1].abs() && apart[1].abs() > 1.0,
        "{apart:?} {together:?}"
    );
    // The bounds of the joints count for each by itself: those of the follower before the
    // transmission.
    let bounded = World { joint_forces: vec![("one".into(), [-0.1, 0.1]), ("two".into(), [-2.0, 0.75])], ..world.clone() };
    let [plain, clamped] = [&world, &bounded].map(|world| torques(&coupled, world, &[0.3], &[0.7])[0]);
    assert_eq!((plain, clamped), (together[0], -2.0 * (plain / -2.0).clamp(-2.0, 0.75)));
    assert!(plain != clamped);
    assert_eq!((free.model.gravity().z, built("gravity = [0, 0, -1]").model.gravity().z), (-3.7, -1.0));
}

/// The torques of one actuator with the control 2, of a scene.
fn torques(robot: &articulated_scene::BuiltRobot, world: &World, q: &[f64], v: &[f64]) -> Vec<f64> {
    let text = scene("control = { kind = \"actuators\", ctrl = [2] }");
    let controller = text.controller(RobotInWorld { model: &robot.model, world }, &mut |_| Err(String::new())).unwrap();
    let (Controller::Actuators { actuators, .. }, mut tau) = (controller, vec![0.0; v.len()]) else { panic!("actuators") };
    actuators.add_torques(&actuators.inputs(&[], &[2.0], None), q, v, &mut tau);
    tau
}

/// q = f(q₁) = 0.2 − 2 q₁ + 0.6 q₁² + 0.1 q₁³: the torque of a servo of the follower acts on the
/// leader times f′, by the equation of the file and by the scene's key alike.
#[test]
fn a_servo_of_a_follower_by_a_polynomial_acts_by_its_slope() {
    const CAM: &str = "<mujoco><worldbody>
      <body name='a'><joint name='one' axis='0 0 1'/><geom size='0.1'/></body>
      <body name='b'><joint name='two' axis='0 0 1'/><geom size='0.1'/></body></worldbody>
      <equality><joint joint1='two' joint2='one' polycoef='0.2 -2 0.6 0.1'/></equality></mujoco>";
    let built = |text: &str| articulated_scene::Opened::new(scene(text), "g.xml", CAM.into(), Base::Fixed, vec![]).build().unwrap();
    let servo =
        Actuator { drives: vec![("two".into(), vec![3.0])], gain: [0.5, 0.25, 0.0], bias: [1.0, -7.0, -0.5], ..Actuator::default() };
    let damper = Actuator { drives: vec![("two".into(), vec![2.0])], bias: [0.3, -1.0, -0.4], ..Actuator::default() };
    let world = World { actuators: vec![servo], passive: vec![damper], ..World::default() };
    let of = |robot: &articulated_scene::BuiltRobot, q: &[f64], v: &[f64]| torques(robot, &world, q, v);
    let (q, v): (f64, f64) = (0.7, -0.4);
    let (value, slope) = (0.2 - 2.0 * q + 0.6 * q * q + 0.1 * q * q * q, -2.0 + 1.2 * q + 0.3 * q * q);
    let apart = of(&built(""), &[q, value], &[v, slope * v]);
    assert!(apart[0] == 0.0 && apart[1].abs() > 1.0, "{apart:?}");
    let key = "coupling = { two = { joint = ['one'], polynomial = [-0.4976, -1.472, 0.72, 0.1], reference = 0.4 } }";
    for text in ["coupling = \"file\"", key] {
        let robot = built(text);
        assert_eq!(robot.model.nv(), 1);
        let together = of(&robot, &[q], &[v]);
        assert!((together[0] - slope * apart[1]).abs() < 1e-13 * apart[1].abs(), "{apart:?} {together:?}");
    }
}

/// A follower that its polynomial takes beyond its limits is used, with a warning.
#[test]
fn a_follower_that_leaves_its_limits_is_warned_of() {
    let robot = |upper: f64| {
        let slide = |name: &str, child: &str, upper: f64| {
            format!(
                "<joint name='{name}' type='prismatic'><parent link='base'/><child link='{child}'/><axis xyz='0 0 1'/>
                 <limit lower='-1' upper='{upper}' effort='1' velocity='1'/></joint>"
            )
        };
        let urdf = format!(
            "<robot name='w'><link name='base'/><link name='a'/><link name='b'/>{}{}</robot>",
            slide("one", "a", 1.0),
            slide("two", "b", upper)
        );
        let text = scene("coupling = { two = { joint = ['one'], polynomial = [0.5, 0, -1] } }");
        articulated_scene::Opened::new(text, "r.urdf", urdf.into_bytes(), Base::Fixed, vec![]).build().unwrap()
    };
    // 0.5 − x² is from −0.5 to 0.5.
    let warned = |upper: f64| {
        let robot = robot(upper);
        robot.reading.warnings.iter().filter(|w| w.field == "coupling").map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(warned(0.6), Vec::<String>::new());
    let told = warned(0.4);
    assert!(told.len() == 1 && told[0].contains("a range of -0.5000 to 0.5000, as joint \"one\" moves within its limits"), "{told:?}");
}

/// q = 0.5 m1 − 0.7 m2 + 0.2: an actuator on it drives both motors, within the bounds of the joint.
#[test]
fn an_actuator_on_a_joint_that_follows_several_drives_each() {
    const WRIST: &str = "<robot name='w'><link name='base'/><link name='a'/><link name='b'/>
      <joint name='m1' type='continuous'><parent link='base'/><child link='a'/><axis xyz='0 0 1'/></joint>
      <joint name='m2' type='continuous'><parent link='base'/><child link='b'/><axis xyz='0 0 1'/></joint>
      <joint name='pitch' type='continuous'><parent link='base'/><child link='hand'/><axis xyz='0 1 0'/>
        <mimic joint='m1' multiplier='0.5' offset='0.2'/><mimic joint='m2' multiplier='-0.7'/></joint>
      <link name='hand'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>";
    let robot = articulated_scene::Opened::new(scene(""), "w.urdf", WRIST.into(), Base::Fixed, vec![]).build().unwrap();
    let servo =
        Actuator { drives: vec![("pitch".into(), vec![3.0])], gain: [2.0, 0.0, 0.0], bias: [0.0, -2.0, 0.0], ..Actuator::default() };
    let torque = |range: Option<[f64; 2]>| {
        let joint_forces = range.map(|range| ("pitch".into(), range)).into_iter().collect();
        let world = World { actuators: vec![servo.clone()], joint_forces, ..World::default() };
        let text = scene("control = { kind = \"actuators\", ctrl = [1] }");
        let controller = text.controller(RobotInWorld { model: &robot.model, world: &world }, &mut |_| Err(String::new())).unwrap();
        let (Controller::Actuators { actuators, .. }, mut tau) = (controller, vec![0.0; 2]) else { panic!("actuators") };
        actuators.add_torques(&actuators.inputs(&[], &[1.0], None), &[0.3, -0.4], &[0.0; 2], &mut tau);
        tau
    };
    let expected: f64 = 3.0 * 2.0 * (1.0 - 3.0 * (0.5 * 0.3 + 0.7 * 0.4 + 0.2));
    for (range, on_pitch) in [(None, expected), (Some([-1.5, 1.5]), expected.clamp(-1.5, 1.5))] {
        let found = torque(range);
        assert!((found[0] - 0.5 * on_pitch).abs() < 1e-14 && (found[1] + 0.7 * on_pitch).abs() < 1e-14, "{found:?} {on_pitch}");
    }
    assert!(expected < -1.5);
}

const SWIMMER: &str = "<mujoco><option density='100' viscosity='2'/><worldbody><body name='fish' gravcomp='1'>
  <joint name='f' type='free' damping='0.5'/><geom size='0.1' mass='2'/>
  <body name='fin' pos='0.2 0 0'><joint name='j'/><geom size='0.05' mass='0.5'/></body></body></worldbody>
  <actuator><position name='slow' joint='j' kp='3' timeconst='0.2'/></actuator></mujoco>";

/// Effects on links are taken from the file whole, for all links or for those that are named.
#[test]
fn effects_of_the_file_on_links_are_taken_where_the_scene_says_so() {
    use articulated_core::effect::EffectId::{box_drag, damping, gravity_compensation};
    let built = |text: &str| articulated_scene::Opened::new(scene(text), "m.xml", SWIMMER.into(), Base::Fixed, vec![]).build();
    let effects = |text: &str| {
        let mut all: Vec<_> = built(text).unwrap().effects.iter().map(|own| (own.effect, own.on.clone())).collect();
        all.sort();
        all
    };
    let on = |effect, name: &str| (effect, name.to_owned());
    assert_eq!(effects(""), []);
    assert_eq!(effects("effects = { box_drag = \"file\" }"), [on(box_drag, "fin"), on(box_drag, "fish")]);
    assert_eq!(effects("effects = { box_drag = { fin = \"file\" } }"), [on(box_drag, "fin")]);
    assert_eq!(effects("effects = { box_drag = { \"*\" = \"file\", fin = \"off\" } }"), [on(box_drag, "fish")]);
    let both = "effects = { gravity_compensation = \"file\", damping = \"file\" }";
    assert_eq!(effects(both), [on(damping, "f"), on(gravity_compensation, "fish")]);
    // The whole weight is carried: what is left is that of the fin.
    let robot = built(both).unwrap();
    let carried = robot.effects.iter().find(|own| own.effect == gravity_compensation).unwrap();
    assert_eq!(carried.parameters, [2.0]);
    // What no link has, and what a scene does not use
    let none = built("effects = { gravity_compensation = { fin = \"file\" } }").unwrap_err().to_string();
    assert!(none.contains("found no gravity_compensation of link \"fin\" in m.xml"), "{none}");
    let nothing = built("effects = { added_mass = \"file\" }").unwrap();
    assert!(nothing.resolved.warnings.iter().any(|warning| warning.to_string().contains("no link of m.xml has numbers")));
    let unused: Vec<String> = built("").unwrap().reading.unused.iter().map(ToString::to_string).collect();
    assert!(unused.iter().any(|line| line.contains("box_drag: 2 links: used in scenes with effects.box_drag = \"file\"")), "{unused:#?}");
}

/// All smooth effects of the file by one word, but for those that the scene names itself.
#[test]
fn one_word_takes_the_smooth_effects_of_the_file() {
    use articulated_core::effect::EffectId::{box_drag, damping, gravity_compensation};
    let built = |text: &str| articulated_scene::Opened::new(scene(text), "m.xml", SWIMMER.into(), Base::Fixed, vec![]).build().unwrap();
    let effects =
        |text: &str| -> Vec<_> { built(text).effects.iter().map(|own| (own.effect, own.on.clone(), own.parameters[0])).collect() };
    let each = "effects = { damping = \"file\", box_drag = \"file\", gravity_compensation = \"file\" }";
    for all in ["effects = \"file\"", "[effects]\n\"*\" = \"file\""] {
        assert_eq!(effects(all), effects(each), "{all}");
        // It has no springs, and that is no warning.
        assert!(built(all).resolved.warnings.is_empty());
    }
    let kinds = |text: &str| effects(text).iter().map(|(effect, ..)| *effect).collect::<Vec<_>>();
    assert_eq!(kinds("effects = \"file\""), [damping, box_drag, box_drag, gravity_compensation]);
    assert_eq!(kinds("effects = { \"*\" = \"file\", box_drag = \"off\" }"), [damping, gravity_compensation]);
    let own = effects("effects = { \"*\" = \"file\", damping = { j = 7.0 } }");
    assert_eq!(own.iter().find(|(effect, ..)| *effect == damping), Some(&(damping, "j".into(), 7.0)));
    let wrong = |text: &str| Scene::read("s.toml", text).unwrap_err().to_string();
    assert!(wrong("effects = \"all\"").contains("expected a table of effects, or \"file\""));
    assert!(wrong("effects = { \"*\" = 0.1 }").contains("expected \"file\""));
}

/// A scene has no activations: an actuator with one gives no force, and a warning says so.
#[test]
fn an_actuator_with_an_activation_is_a_warning_in_a_scene() {
    let warnings = |text: &str| {
        let built = articulated_scene::Opened::new(scene(text), "m.xml", SWIMMER.into(), Base::Fixed, vec![]).build().unwrap();
        built.reading.warnings.iter().map(ToString::to_string).filter(|line| line.contains("activation")).count()
    };
    assert_eq!(warnings("control = { kind = \"actuators\" }"), 1);
    assert_eq!(warnings("control = { kind = \"actuators\", without = [\"slow\"] }"), 0);
    assert_eq!(warnings(""), 0);
}
