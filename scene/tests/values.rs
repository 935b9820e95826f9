//! Numbers of scenes in the order of a robot.

use articulated_core::description::{Base, Description, Joint, JointDynamics, JointKind, Link, LinkId};
use articulated_core::diagnostic::{Subject, Unused};
use articulated_core::effect::EffectId;
use articulated_core::integrator::IntegratorId;
use articulated_core::model::{FLOATING_BASE, Model};
use articulated_core::spatial::{from_quaternion, from_rpy};
use articulated_formats::world::World;
use articulated_scene::{Controller, Edited, Output, Scene, Settings, Stiffness};

/// Two hinges, the second of which has limits, damping and an effort; a ball; a slide that follows
/// the first; a link without mass at its end.
const ROBOT: &str = r#"<robot name="r">
  <link name="trunk"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="b"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="c"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tip"/>
  <joint name="one" type="continuous"><parent link="trunk"/><child link="a"/><axis xyz="0 0 1"/></joint>
  <joint name="two" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/><dynamics damping="0.5" friction="0.25"/>
    <limit lower="-1" upper="2" effort="7" velocity="3"/></joint>
  <joint name="three" type="continuous"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/><mimic joint="one" multiplier="2" offset="0"/></joint>
  <joint name="end" type="fixed"><parent link="c"/><child link="tip"/></joint>
</robot>"#;

fn robot() -> Description {
    articulated_formats::read(ROBOT.as_bytes(), &articulated_formats::Options::default()).unwrap().description
}

fn model(base: Base) -> Model<f64> {
    Model::new(&robot(), base).unwrap()
}

fn scene(text: &str) -> Scene {
    Scene::read("s.toml", text).unwrap_or_else(|e| panic!("{e:?}"))
}

#[test]
fn a_base_stands_as_its_angles_say() {
    let rpy = [0.3, -0.7, 1.9];
    let text = "base = \"floating\"\n[initial]\nq = { one = 0.25, two = -0.5 }\nv = { two = 4 }\n\
                base = { xyz = [1, 2, 3], rpy = [0.3, -0.7, 1.9], angular = [0.1, 0.2, 0.3], linear = [4, 5, 6] }";
    let (q, v) = scene(text).start(&model(Base::Floating)).unwrap();
    assert_eq!((&q[..3], &q[7..]), (&[1.0, 2.0, 3.0][..], &[0.25, -0.5][..]));
    assert_eq!(v, [0.1, 0.2, 0.3, 4.0, 5.0, 6.0, 0.0, 4.0]);
    let turned = from_quaternion([q[3], q[4], q[5], q[6]]) - from_rpy(rpy);
    assert!(turned.amax() < 1e-15, "{turned}");
}

/// A gain for all is for those that something could drive, and one by name is before it.
#[test]
fn gains_are_those_of_their_joints() {
    let text =
        "base = \"floating\"\n[control]\nkind = \"pd\"\nkp = 3\nkd = { \"*\" = 5, two = 7 }\ntorque = { one = -1 }\ntarget = { two = 0.5 }";
    let found = scene(text).controller(&model(Base::Floating), &mut |_| Err("no files".into())).unwrap();
    let Controller::Pd { kp, kd, torque, .. } = found else { panic!("{found:?}") };
    let base = [0.0; 6];
    assert_eq!(model(Base::Floating).joints()[0].name, FLOATING_BASE);
    assert_eq!(kp, [&base[..], &[3.0, 3.0]].concat());
    assert_eq!(kd, [&base[..], &[5.0, 7.0]].concat());
    assert_eq!(torque, [&base[..], &[-1.0, 0.0]].concat());
}

/// Each effect: its joint or link, and its numbers.
fn on(text: &str) -> Vec<(EffectId, String, Vec<f64>)> {
    let description = robot();
    let edited =
        Edited { description: &description, file: "r.urdf", base: Base::Fixed, unused: &[], world: &World::default(), shafts: &[] };
    let resolved = scene(text).resolve(&edited).unwrap_or_else(|e| panic!("{e:?}"));
    resolved.effects.into_iter().map(|a| (a.effect, a.on, a.parameters)).collect()
}

#[test]
fn what_is_asked_of_ten_thousand_joints_and_links_is_soon_resolved() {
    let count = 10_000;
    let dynamics = JointDynamics { damping: Some(0.5), friction: Some(0.0), ..JointDynamics::default() };
    let joint = |k: usize| Joint {
        name: format!("joint_{k}"),
        kind: JointKind::Continuous,
        parent: LinkId(k),
        child: LinkId(k + 1),
        dynamics,
        ..Joint::default()
    };
    let description = Description {
        links: (0..=count).map(|k| Link { name: format!("link_{k}"), ..Link::default() }).collect(),
        joints: (0..count).map(joint).collect(),
        ..Description::default()
    };
    let unused = |k| Unused {
        line: None,
        subject: Subject::Joint(format!("joint_{k}")),
        tag: if k == 7 { "dynamics friction" } else { "dynamics damping" }.to_owned(),
        why: String::new(),
    };
    let unused: Vec<Unused> = (0..count).map(unused).collect();
    let robot =
        Edited { description: &description, file: "r.urdf", base: Base::Fixed, unused: &unused, world: &World::default(), shafts: &[] };
    let each = |what: &str, number: &str| (1..count).map(|k| format!("{what}_{k} = {number}\n")).collect::<String>();
    let text = format!(
        "[effects.damping]\n\"*\" = \"urdf\"\n[effects.friction]\n{}[effects.drag]\n{}",
        each("joint", "0.1"),
        each("link", "{ coefficient = 1 }")
    );
    let resolved = scene(&text).resolve(&robot).unwrap();
    assert_eq!(resolved.effects.len(), count + 2 * (count - 1));
    assert_eq!(resolved.report.ignored, [unused[7].clone()]);
}

#[test]
fn what_is_asked_of_all_is_had_by_those_that_can() {
    let named = |effect, on: &str, numbers: &[f64]| (effect, on.to_owned(), numbers.to_vec());
    // A named entry has precedence; its missing numbers come from the entry of all.
    let friction = on("[effects.friction]\n\"*\" = { friction = 2, speed = 0.5 }\ntwo = { friction = 3 }");
    let (f, d) = (EffectId::friction, EffectId::damping);
    assert_eq!(friction, [named(f, "one", &[2.0, 0.5]), named(f, "two", &[3.0, 0.5]), named(f, "three", &[2.0, 0.5])]);
    // From the URDF, if requested.
    assert_eq!(on("[effects]\ndamping = \"urdf\""), [named(d, "two", &[0.5])]);
    assert_eq!(on("[effects.damping]\n\"*\" = \"urdf\"\none = 4"), [named(d, "one", &[4.0]), named(d, "two", &[0.5])]);
    let motor = on("[effects.motor]\n\"*\" = { torque = 5, speed = 6 }");
    // A joint that follows another has no motor of its own.
    assert_eq!(motor.iter().map(|m| m.1.as_str()).collect::<Vec<_>>(), ["one", "two"]);
    let motor = on("[effects]\nmotor = \"urdf\"");
    assert!(motor.len() == 1 && motor[0].2[..2] == [7.0, 3.0], "{motor:?}");
    // Numbers of a URDF are behind the gear.
    let geared = on("[effects.motor.\"*\"]\nfrom = \"urdf\"\ngear = 10");
    assert!(geared.len() == 1 && geared[0].2[..3] == [0.7, 30.0, 10.0], "{geared:?}");
    let own = on("[effects.motor.\"*\"]\nfrom = \"urdf\"\ngear = 10\ntorque = 2");
    assert_eq!(own.iter().map(|m| &m.2[..2]).collect::<Vec<_>>(), [[2.0, 30.0]]);
    // A named entry turns an effect of all off; missing numbers come from the file only if
    // requested.
    assert_eq!(on("[effects.damping]\n\"*\" = 1\ntwo = \"off\"").iter().map(|d| d.1.as_str()).collect::<Vec<_>>(), ["one", "three"]);
    let description = robot();
    let edited =
        Edited { description: &description, file: "r.urdf", base: Base::Fixed, unused: &[], world: &World::default(), shafts: &[] };
    let wrong = scene("[effects.motor]\ntwo = { gear = 2 }").resolve(&edited).unwrap_err().errors;
    assert!(wrong.len() == 1 && wrong[0].to_string().contains("no torque for joint \"two\""), "{wrong:?}");
    // No drag on a link without mass that was not named, nor on one that does not move.
    let drag = on("[effects.drag]\n\"*\" = { coefficient = 1 }");
    assert_eq!(drag.iter().map(|m| m.1.as_str()).collect::<Vec<_>>(), ["a", "b", "c"]);
    assert_eq!(on("[effects.drag]\ntip = { coefficient = 2 }"), [named(EffectId::drag, "tip", &[2.0])]);
}

/// Written to fewer digits than there are.
#[test]
fn a_quaternion_that_is_nearly_of_norm_one_is_made_so() {
    let (q, _) = scene("base = \"floating\"\n[initial.base]\nquaternion = [0, 0, 0, 1.0005]").start(&model(Base::Floating)).unwrap();
    assert_eq!(q[3..7], [0.0, 0.0, 0.0, 1.0]);
    let (q, _) = scene("base = \"floating\"\n[initial]\nq = [0, 0, 0, 0, 0, 0, 1.0005, 0.25, 0.5]").start(&model(Base::Floating)).unwrap();
    assert_eq!(q[3..], [0.0, 0.0, 0.0, 1.0, 0.25, 0.5]);
}

/// A named entry without a place takes that of all; one with a place has its own.
#[test]
fn what_is_asked_of_all_says_where_too() {
    let text = "[effects.drag]\n\"*\" = { coefficient = 1, xyz = [0, 0, 0.1] }\na = { coefficient = 2 }\nb = { coefficient = 3, xyz = [0.5, 0, 0] }";
    let description = robot();
    let edited =
        Edited { description: &description, file: "r.urdf", base: Base::Fixed, unused: &[], world: &World::default(), shafts: &[] };
    let resolved = scene(text).resolve(&edited).unwrap_or_else(|e| panic!("{e:?}"));
    let places: Vec<(&str, f64, [f64; 3])> = resolved.effects.iter().map(|a| (a.on.as_str(), a.parameters[0], a.at.xyz)).collect();
    assert_eq!(places, [("a", 2.0, [0.0, 0.0, 0.1]), ("b", 3.0, [0.5, 0.0, 0.0]), ("c", 1.0, [0.0, 0.0, 0.1])]);
}

fn said(keys: &str) -> Settings {
    scene(&format!("[simulation]\n{keys}")).simulation.unwrap().settings
}

/// Absent keys keep their defaults.
#[test]
fn every_key_of_a_scene_is_a_setting() {
    let keys =
        "start = 0.5\nend = 2.5\nintegrator = 'rodas4'\nrtol = 1e-4\natol = 1e-5\nmin_step = 1e-7\nmax_step = 0.25\nfirst_step = 1e-3
        max_steps = 77\noutput = [0.75, 1.5]\nevent_tolerance = 1e-6\nstiffness = 'note'";
    let expected = Settings {
        integrator: IntegratorId::rodas4,
        start: 0.5,
        end: 2.5,
        step: None,
        rtol: 1e-4,
        atol: 1e-5,
        atol_each: Vec::new(),
        min_step: 1e-7,
        max_step: 0.25,
        first_step: Some(1e-3),
        max_steps: 77,
        output: Output::At(vec![0.75, 1.5]),
        event_tolerance: 1e-6,
        stiffness: Stiffness::Note,
    };
    assert_eq!(said(keys), expected);
    assert_eq!(said("end = 1\nstep = 0.125").step, Some(0.125));
    for (word, output) in [("0.5", Output::Every(0.5)), ("'steps'", Output::Steps), ("'ends'", Output::Ends)] {
        assert_eq!(said(&format!("end = 1\noutput = {word}")).output, output);
    }
    assert_eq!(said("end = 1"), Settings::default());
}

/// A slide without a spring, with bounds and a damping of 0; a hinge without bounds.
const PLAIN: &str = "<robot name='p'><link name='base'/>
  <link name='a'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
  <link name='b'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
  <joint name='slide' type='prismatic'><parent link='base'/><child link='a'/><axis xyz='1 0 0'/>
    <limit lower='-3' upper='3' effort='9' velocity='9'/><dynamics damping='0'/></joint>
  <joint name='hinge' type='continuous'><parent link='a'/><child link='b'/><axis xyz='1 0 0'/></joint></robot>";

/// Numbers of the file that no joint has are an error for a joint by its name, and a warning for
/// all.
#[test]
fn an_effect_whose_numbers_the_file_has_for_no_joint_is_told() {
    let built = |effects: &str| {
        let scene = Scene::read("s.toml", &format!("[effects]\n{effects}")).unwrap_or_else(|e| panic!("{e}"));
        articulated_scene::Opened::new(scene, "plain.urdf", PLAIN.into(), Base::Fixed, vec![]).build()
    };
    let warned = |effects: &str| {
        let found = built(effects).unwrap_or_else(|e| panic!("{e}")).reading.warnings;
        let own = found.iter().filter(|warning| warning.code == articulated_core::diagnostic::Code::NoNumbers);
        own.map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(
        warned("spring = \"urdf\""),
        [
            "s.toml:2: effects.spring: found no joint of plain.urdf has numbers for effects.spring, expected joints with <joint stiffness> or \
          <joint springref>, or numbers in the scene: the effect does nothing"
        ]
    );
    for effects in ["friction = \"file\"", "armature = { from = \"file\", gear = 2 }", "spring = { \"*\" = \"file\", slide = 3 }"] {
        assert_eq!(warned(effects).len(), 1, "{effects}");
    }
    assert!(warned("damping = \"file\"")[0].contains("found no joint of plain.urdf has numbers other than 0 for effects.damping"));
    assert!(warned("damping.slide = \"file\"")[0].contains("joint \"slide\": effects.damping.slide: found 0 in the robot's file"));
    // The hinge has no bounds, the slide has.
    let limit = |stiffness: f64| format!("limit = {{ from = \"urdf\", stiffness = {stiffness} }}");
    for effects in [&limit(1e4), &limit(0.0), "spring = 1", "spring = \"off\"", "damping = { slide = 0, hinge = 1 }", ""] {
        assert_eq!(warned(effects), Vec::<String>::new(), "{effects}");
    }
    for (effects, tag) in [("spring.slide = \"file\"", "stiffness"), ("limit.hinge = { from = \"file\", stiffness = 1 }", "limit lower")] {
        let told = built(effects).unwrap_err().to_string();
        assert!(told.contains(tag) && told.contains("whose file has no"), "{told}");
    }
}

/// Joints by the source of their numbers.
#[test]
fn effects_are_counted_by_their_sources() {
    let counted = |effects: &str| {
        let scene = Scene::read("s.toml", &format!("[effects]\n{effects}")).unwrap_or_else(|e| panic!("{e}"));
        let built = articulated_scene::Opened::new(scene, "plain.urdf", PLAIN.into(), Base::Fixed, vec![]).build();
        let counts = built.unwrap_or_else(|e| panic!("{e}")).resolved.report.counts();
        counts.iter().map(|count| format!("{}: {count}", count.effect.name())).collect::<Vec<_>>()
    };
    let limit = "limit = { from = \"file\", stiffness = 1e4 }";
    assert_eq!(counted(limit), ["limit: 1 of 2 joints, from the file"]);
    let both = "limit = { \"*\" = { from = \"file\", stiffness = 1e4 }, hinge = { lower = -1, upper = 1, stiffness = 3 } }\ndrag.b = 1";
    assert_eq!(counted(both), ["limit: 2 of 2 joints: 1 from the file, 1 from the scene", "drag: 1 of 2 links, from the scene"]);
}
