//! Additions to a URDF by other programs and by later versions: rotors, springs, joints of Drake,
//! settings of MuJoCo, limits of acceleration.

mod corpus;

use articulated_core::description::{CollisionShape, Joint, JointKind, Limit};
use articulated_core::diagnostic::{Code, Subject};
use articulated_formats::{Options, Reading, read, urdf};
use corpus::{CRANE, accepted, crane, described, refused};

/// The crane with tags at its end, in line 42.
fn with(tags: &str) -> Reading {
    accepted(&crane("</robot>", &format!("{tags}</robot>")))
}

fn joint<'a>(reading: &'a Reading, name: &str) -> &'a Joint {
    reading.description.joints.iter().find(|joint| joint.name == name).unwrap()
}

fn armature(tags: &str) -> Option<f64> {
    let reading = with(tags);
    assert!(reading.warnings.is_empty(), "{tags}: {:?}", reading.warnings);
    joint(&reading, "swing").dynamics.armature
}

fn transmission(joint: &str, actuator: &str) -> String {
    format!(
        "<transmission name='t'><type>transmission_interface/SimpleTransmission</type>\
         <joint name='swing'><hardwareInterface>EffortJointInterface</hardwareInterface>{joint}</joint>\
         <actuator name='m'>{actuator}</actuator></transmission>"
    )
}

/// 5.5e-6 · 113.9² = 0.071352655.
#[test]
fn a_rotor_behind_its_gear_is_kept() {
    const INERTIA: &str = "<motorInertia>5.5e-6</motorInertia>";
    const RATIO: &str = "<mechanicalReduction>113.9</mechanicalReduction>";
    const DRAKE: &str = "<drake:rotor_inertia value='5.5e-6'/><drake:gear_ratio value='113.9'/>";
    let cases = [
        transmission("", &format!("{RATIO}{INERTIA}")),
        transmission("", &format!("<rotorInertia> 5.5e-6 </rotorInertia>{RATIO}")),
        transmission(RATIO, INERTIA),
        transmission(INERTIA, RATIO),
        transmission("", DRAKE),
        transmission(RATIO, &format!("{DRAKE}{INERTIA}{RATIO}")),
        transmission("", &format!("{INERTIA}<mechanicalReduction>-113.9</mechanicalReduction>")),
        transmission("", INERTIA).replace("<type>", &format!("{RATIO}<type>")),
    ];
    for tags in &cases {
        let found = armature(tags).unwrap();
        assert!((found - 0.071352655).abs() < 1e-9, "{tags}: {found}");
        let reading = with(tags);
        let kept = reading.unused.iter().find(|unused| unused.tag == "joint armature").unwrap();
        assert_eq!((&kept.subject, kept.line), (&Subject::Joint("swing".into()), Some(42)));
        assert!(reading.unused.iter().all(|unused| unused.tag != "transmission"), "{:?}", reading.unused);
    }
    // Without a gear ratio it is one.
    assert_eq!(armature(&transmission("", INERTIA)), Some(5.5e-6));
    // Without an inertia no number is kept.
    let reading = with(&transmission("", RATIO));
    assert_eq!(joint(&reading, "swing").dynamics, joint(&accepted(CRANE), "swing").dynamics);
    assert!(reading.unused.iter().any(|unused| unused.tag == "transmission" && unused.line == Some(42)));
}

#[test]
fn a_rotor_that_is_not_clear_is_a_warning_and_not_used() {
    let simple = |inside: &str| transmission("", inside);
    let cases = [
        (
            simple("<motorInertia>1</motorInertia>").replace("<actuator", "<joint name='slew'/><actuator"),
            "motorInertia: found the inertia of a rotor in a transmission of 2 joints and 1 actuators, expected one <joint> and one <actuator>",
        ),
        (
            simple("<motorInertia>1</motorInertia><mechanicalReduction>2</mechanicalReduction><drake:gear_ratio value='3'/>"),
            "joint \"swing\": transmission: found the gear ratio 3 in <drake:gear_ratio> beside 2 in <mechanicalReduction>, expected one gear",
        ),
        (
            simple("<motorInertia>1</motorInertia><rotorInertia>2</rotorInertia>"),
            "found the inertia of the rotor 2 in <rotorInertia> beside 1 in <motorInertia>",
        ),
        (simple("<motorInertia>-1</motorInertia>"), "found the inertia -1 behind the gear ratio 1, expected an inertia of at least 0"),
        (simple("<motorInertia>1</motorInertia><mechanicalReduction>0</mechanicalReduction>"), "behind the gear ratio 0"),
        (simple("<motorInertia>1e-5 kg</motorInertia>"), "joint \"swing\": <motorInertia>: found \"1e-5 kg\", expected a decimal number"),
        (simple("<drake:rotor_inertia/>"), "<drake:rotor_inertia>: found \"\", expected a decimal number"),
        (
            simple("<motorInertia>1</motorInertia>").replace("swing", "swng"),
            "found \"swng\", which is not a joint of this file, expected the name of a joint (did you mean \"swing\"?)",
        ),
        (simple("").replace("swing", "swng"), "(did you mean \"swing\"?); the transmission is not used"),
    ];
    for (tags, expected) in cases {
        let reading = with(&tags);
        assert_eq!(reading.description, described(CRANE), "{tags}");
        let told: Vec<String> = reading.warnings.iter().map(ToString::to_string).collect();
        assert!(told.len() == 1 && told[0].starts_with("crane.urdf:42: ") && told[0].contains(expected), "{told:#?}");
        assert!(reading.unused.iter().any(|unused| unused.tag == "transmission"));
    }
    let twice = with(&simple("<motorInertia>1</motorInertia>").repeat(2));
    assert_eq!(joint(&twice, "swing").dynamics.armature, None);
    assert!(twice.warnings.len() == 1 && twice.warnings[0].to_string().contains("found 2 transmissions"), "{:?}", twice.warnings);
}

#[test]
fn a_spring_of_gazebo_at_a_joint_is_kept() {
    let tags = "<gazebo reference='swing'><springStiffness>30</springStiffness><springReference>0.5</springReference>\
                <implicitSpringDamper>1</implicitSpringDamper></gazebo>";
    let reading = with(tags);
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let dynamics = joint(&reading, "swing").dynamics;
    assert_eq!((dynamics.stiffness, dynamics.rest), (Some(30.0), Some(0.5)));
    for tag in ["joint stiffness", "joint springref"] {
        assert!(reading.unused.iter().any(|unused| unused.tag == tag && unused.line == Some(42)), "{tag}");
    }
    let twice = with(&tags.repeat(2));
    assert_eq!(twice.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(), [Code::LostDynamics]);
    let wrong = with("<gazebo reference='swing'><springStiffness>stiff</springStiffness></gazebo>");
    assert!(wrong.warnings[0].to_string().contains("found \"stiff\", expected a decimal number"), "{:?}", wrong.warnings);
}

/// The reader finds rotors, springs and open bounds where the writer has put them.
#[test]
fn forces_and_limits_are_written_and_read_back() {
    let tags = format!(
        "{}<gazebo reference='swing'><springStiffness>30</springStiffness></gazebo>",
        transmission("", "<motorInertia>0.1</motorInertia>")
    );
    let text = crane("</robot>", &format!("{tags}</robot>")).replace("<robot ", "<robot version=\"1.2\" ");
    let text = text.replace("<limit lower=\"-1\" upper=\"1\"", "<limit lower=\"-1\" jerk=\"3\"");
    let description = accepted(&text).description;
    let written = urdf::write(&description);
    let again = read(written.as_bytes(), &Options::default()).unwrap_or_else(|error| panic!("{error}\n{written}")).description;
    assert_eq!(again.joints, description.joints, "{written}");
}

const DRAKE: &str = "<link name='ball'/><link name='plane'/><link name='screw'/><link name='cross'/>
<drake:joint name='b' type='ball'><parent link='hook'/><child link='ball'/><dynamics damping='0.1'/></drake:joint>
<drake:joint name='p' type='planar'><drake:parent link='hook'/><drake:child link='plane'/><axis xyz='0 0 1'/></drake:joint>
<drake:joint name='s' type='screw'><parent link='hook'/><child link='screw'/><origin xyz='1 2 3'/><axis xyz='0 0 1'/>
<drake:screw_thread_pitch value='0.005'/></drake:joint>
<drake:joint name='u' type='universal'><parent link='hook'/><child link='cross'/><axis xyz='0 0 1'/><dynamics damping='0.2'/></drake:joint>";

#[test]
fn joints_of_drake_are_read() {
    let reading = with(DRAKE);
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let kinds = ["b", "p", "s", "u"].map(|name| joint(&reading, name).kind);
    assert_eq!(kinds, [JointKind::Spherical, JointKind::Planar, JointKind::Helical, JointKind::Universal]);
    let screw = joint(&reading, "s");
    assert_eq!((screw.pitch, screw.axis, screw.origin.xyz, screw.limit), (0.005, [0.0, 0.0, 1.0], [1.0, 2.0, 3.0], None));
    // Drake reads no axes of it.
    let cross = joint(&reading, "u");
    assert_eq!((cross.axis, cross.second_axis), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    let links: Vec<&str> = reading.description.joints.iter().map(|j| reading.description.links[j.child].name.as_str()).collect();
    assert!(links.ends_with(&["ball", "plane", "screw", "cross"]), "{links:?}");
    let unused: Vec<String> = reading.unused.iter().map(|u| format!("{} {}", u.subject, u.tag)).collect();
    assert!(["joint \"u\" axis", "joint \"b\" dynamics damping"].iter().all(|tag| unused.iter().any(|u| u == tag)), "{unused:?}");
    assert_eq!((joint(&reading, "b").dynamics.damping, joint(&reading, "u").dynamics.damping), (Some(0.1), Some(0.2)));
}

#[test]
fn what_is_wrong_with_joints_of_drake_is_an_error() {
    let told = |from: &str, to: &str| {
        let log = refused(&crane("</robot>", &format!("{}</robot>", DRAKE.replace(from, to))));
        log.errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let cases = [
        (
            "'ball'>",
            "'revolute'>",
            "the type \"revolute\", expected ball, planar, screw or universal in <drake:joint>; write this type as <joint>",
        ),
        ("'ball'>", "'curvilinear'>", "found the type \"curvilinear\", expected ball, planar, screw or universal in <drake:joint>"),
        ("<drake:screw_thread_pitch value='0.005'/>", "", "crane.urdf:45: joint \"s\": drake:screw_thread_pitch: found none, expected"),
        ("pitch value", "pitch valu", "crane.urdf:46: joint \"s\": value: found none"),
        ("<drake:parent link='hook'/>", "", "crane.urdf:44: joint \"p\": parent: found none, expected <parent> inside <drake:joint>"),
        ("'0.005'", "'x'", "joint \"s\": drake:screw_thread_pitch value: found \"x\""),
    ];
    for (from, to, expected) in cases {
        let told = told(from, to);
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn a_follower_of_drake_follows() {
    let text = crane(
        "</robot>",
        "<link name='l'/><joint name='f' type='continuous'><parent link='hook'/><child link='l'/>\
                      <drake:mimic joint='swing' multiplier='2' offset='0.5'/></joint><drake:collision_filter_group name='g'/></robot>",
    );
    let reading = accepted(&text);
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let mimic = joint(&reading, "f").mimic.unwrap();
    assert_eq!((mimic.multiplier, mimic.offset), (2.0, 0.5));
}

const SWING: &str = "<limit lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"2\"/>";

#[test]
fn limits_of_acceleration_are_those_of_version_1_2() {
    let limits = " acceleration=\"3\" deceleration=\"4\" jerk=\"5\"/>";
    let text = crane(SWING, &SWING.replace("/>", limits));
    let old = accepted(&text);
    let limit = |reading: &Reading| joint(reading, "swing").limit.unwrap();
    let plain = Limit { lower: -1.0, upper: 1.0, effort: 10.0, velocity: 2.0, ..Limit::NONE };
    assert_eq!(limit(&old), plain);
    assert!(old.warnings.is_empty() && old.unused.iter().any(|u| u.tag == "limit jerk" && u.why.contains("version=\"1.2\"")), "{old:?}");
    let new = accepted(&text.replace("<robot ", "<robot version=\"1.2\" "));
    assert_eq!(limit(&new), Limit { acceleration: 3.0, deceleration: 4.0, jerk: 5.0, ..plain });
    assert!(new.warnings.is_empty() && new.unused.iter().all(|u| u.tag != "limit jerk"), "{new:?}");
    let drake = accepted(&crane(SWING, &SWING.replace("/>", " drake:acceleration=\"6\"/>")));
    assert_eq!(limit(&drake), Limit { acceleration: 6.0, ..plain });
    let negative = accepted(&text.replace("<robot ", "<robot version=\"1.2\" ").replace("jerk=\"5\"", "jerk=\"-5\""));
    assert!(negative.warnings[0].to_string().contains("limit jerk: found a negative value, -5"), "{:?}", negative.warnings);
}

#[test]
fn a_capsule_is_collision_geometry_and_appearance() {
    let capsule = "<geometry><capsule radius='0.2' length='4'/></geometry>";
    let inside = format!("<link name=\"hook\"><collision>{capsule}</collision><visual>{capsule}</visual></link>");
    let reading = accepted(&crane("<link name=\"hook\"/>", &inside).replace("<robot ", "<robot version=\"1.2\" "));
    let link = reading.description.links.iter().find(|link| link.name == "hook").unwrap();
    let shape = CollisionShape::Capsule { radius: 0.2, length: 4.0 };
    assert_eq!((&link.collision[0].shape, &link.visual[0].shape), (&shape, &shape));
}

/// MuJoCo's compiler changes inertias; settings that keep those of this robot unchanged are not
/// reported.
#[test]
fn settings_of_mujoco_that_change_inertias_are_warned_of() {
    let count = |setting: &str| {
        let reading = with(&format!("<mujoco><compiler {setting}/></mujoco>"));
        assert_eq!(reading.description, described(CRANE));
        let is_meant = |w: &articulated_core::diagnostic::Diagnostic| w.code == Code::LostDynamics && w.to_string().contains("MuJoCo");
        assert!(reading.warnings.iter().all(is_meant), "{:?}", reading.warnings);
        reading.warnings.len()
    };
    for (setting, expected) in [
        ("inertiafromgeom='true'", 1),
        ("inertiafromgeom='auto'", 0),
        ("balanceinertia='true'", 0),
        ("boundmass='1e-3'", 0),
        ("boundmass='1e6' boundinertia='1e6'", 2),
        ("settotalmass='-1'", 0),
        ("settotalmass='17'", 1),
        ("fusestatic='true' discardvisual='false'", 0),
    ] {
        assert_eq!(count(setting), expected, "{setting}");
    }
    let slender = crane("izz=\"31\"", "izz=\"33\"").replace("</robot>", "<mujoco><compiler balanceinertia='true'/></mujoco></robot>");
    let codes: Vec<Code> = accepted(&slender).warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, [Code::InertiaTriangle, Code::LostDynamics]);
}
