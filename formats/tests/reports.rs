//! Reports about accepted documents: warnings, and unused content.

mod corpus;

use articulated_core::description::{Base, LinkId};
use articulated_core::diagnostic::{Code, Subject};
use articulated_formats::{Options, Reading, read};
use corpus::{CRANE, accepted, crane, described, joint, options};

/// A boom with these principal moments, in turn: the report about its inertia.
fn said_of(moments: [&str; 3]) -> Option<Code> {
    let [xx, yy, zz] = moments.map(|moment| format!("=\"{moment}\""));
    let text = crane("ixx=\"2\" ixy=\"0.1\"", &format!("ixx{xx} ixy=\"0\"")).replace("iyy=\"30\"", &format!("iyy{yy}"));
    let problems = match read(text.replace("izz=\"31\"", &format!("izz{zz}")).as_bytes(), &options()) {
        Ok(reading) => reading.warnings,
        Err(problems) => problems.errors,
    };
    problems.first().map(|problem| problem.code)
}

/// Files print some six digits.
#[test]
fn moments_are_forgiven_what_rounding_makes_of_them_and_no_more() {
    assert_eq!(said_of(["-5e-10", "1", "1"]), None);
    assert_eq!(said_of(["-5e-9", "1", "1"]), Some(Code::InertiaNotPositive));
    assert_eq!(said_of(["1", "2.000001", "1"]), None);
    assert_eq!(said_of(["1", "2.000004", "1"]), Some(Code::InertiaTriangle));
    // In any units.
    assert_eq!(said_of(["-5e-29", "1e-20", "1e-20"]), Some(Code::InertiaNotPositive));
    assert_eq!(said_of(["-1", "-1", "-1"]), Some(Code::InertiaNotPositive));
}

/// A published quadruped has a second `<axis>` equal to the first. It can be read once without
/// loss.
#[test]
fn a_second_tag_that_says_the_same_is_a_warning() {
    for (first, second) in [
        ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\" 0 1 0\"/>"),
        ("<dynamics damping=\"0.5\" friction=\"0.1\"/>", "<dynamics friction=\"0.1\" damping=\"0.5\"></dynamics>"),
        ("<child link=\"lamp\"/>", "<child link=\"lamp\"/>"),
    ] {
        let text = crane(first, &format!("{first}{second}"));
        let reading = accepted(&text);
        assert_eq!(reading.description, described(CRANE), "{second}");
        let [warning] = &reading.warnings[..] else { panic!("{:?}", reading.warnings) };
        assert_eq!(warning.code, Code::DuplicateTag, "{warning}");
        assert!(warning.to_string().contains("equal to the first in line"), "{warning}");
    }
}

#[test]
fn what_looks_wrong_is_a_warning_and_used_as_written() {
    let cases = [
        ("izz=\"31\"", "izz=\"33\"", Code::InertiaTriangle, "boom", 5),
        ("value=\"40\"", "value=\"0\"", Code::InertiaWithoutMass, "boom", 5),
        ("lower=\"0\"", "lower=\"4\"", Code::LimitOrder, "travel", 29),
        ("effort=\"100\"", "effort=\"-1\"", Code::Negative, "travel", 29),
        ("effort=\"100\"", "", Code::LimitIncomplete, "travel", 29),
        ("lower=\"0\" upper=\"3\"", "", Code::LimitIncomplete, "travel", 29),
        ("<limit lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"2\"/>", "", Code::LimitMissing, "swing", 31),
        ("damping=\"0.5\"", "damping=\"-0.5\"", Code::Negative, "swing", 36),
        ("<link name=\"hook\"/>", "<link name=\"hook\"><inertal/></link>", Code::Misspelt, "hook", 17),
        ("<link name=\"hook\"/>", "<link name=\"hook\"><joint name=\"swing\"/></link>", Code::Misplaced, "hook", 17),
        ("effort=\"100\"", "effort=\"100\" efort=\"1\"", Code::Misspelt, "travel", 29),
        ("<child link=\"hook\"/>", "<child link=\"hook\"/><origin rpy=\"0 -90 0\"/>", Code::MoreThanATurn, "swing", 33),
        ("<child link=\"hook\"/>", "<child link=\"hook\"/><origin xyz=\"0 0 -333\"/>", Code::Units, "swing", 33),
        ("value=\"40\"", "value=\"0.3\"", Code::Units, "boom", 5),
        ("<limit lower=\"-1\" upper=\"1\"", "<limit lower=\"-180\" upper=\"1\"", Code::MoreThanATurn, "swing", 35),
        ("xyz=\"0 1 0\"", "xyz=\"0 2 0\"", Code::AxisLength, "swing", 34),
        ("xyz=\"0 1 0\"", "xyz=\"0 0 1e-9\"", Code::AxisLength, "swing", 34),
        ("effort=\"100\"", "effort=\"0\"", Code::LimitZero, "travel", 29),
        ("velocity=\"0.5\"", "velocity=\"0\"", Code::LimitZero, "travel", 29),
        ("lower=\"0\" upper=\"3\"", "lower=\"3\" upper=\"3\"", Code::LimitEqual, "travel", 29),
        ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\" multiplier=\"0\"/>", Code::MimicZero, "swing", 34),
        ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\" offset=\"-1\"/>", Code::MimicRange, "swing", 34),
        ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\" multiplier=\"-0.5\"/>", Code::MimicRange, "swing", 34),
        ("<child link=\"lamp\"/>", "<child link=\"lamp\"/><mimic joint=\"slew\"/>", Code::UnusedMimic, "mount", 40),
        ("<robot name=\"crane\">", "<robot name=\"crane\u{202e}\">", Code::OddName, "not visible", 2),
        ("joint name=\"mount\"", "joint name=\" mount\"", Code::OddName, "blanks at an end", 38),
        ("joint name=\"mount\"", "joint name=\"mo&#10;unt\"", Code::OddName, "not visible", 38),
    ];
    let mut messages = Vec::new();
    for (from, to, kind, name, line) in cases {
        let warnings = accepted(&crane(from, to)).warnings;
        let found: Vec<_> = warnings.iter().map(|w| (w.code, w.line())).collect();
        assert_eq!(found, [(kind, Some(line))], "{to}");
        assert!(warnings[0].to_string().contains(name));
        messages.push(warnings[0].to_string());
    }
    corpus::as_kept("warnings.txt", &messages);
    // Rounded digits of a unit vector; a follower that stays within its limits except for rounding.
    for axis in ["0.577 0.577 0.577", "0 0.7071 -0.7071", "0 -1 0"] {
        assert!(accepted(&crane("0 1 0", axis)).warnings.is_empty(), "{axis}");
    }
    let follows = "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\" multiplier=\"0.667\" offset=\"-1\"/>";
    assert!(accepted(&crane("<axis xyz=\"0 1 0\"/>", follows)).warnings.is_empty());
    let turned = ("<child link=\"hook\"/>", "<child link=\"hook\"/><origin rpy=\"6.283185307 0 -6.28319\"/>");
    for (from, to) in [("effort=\"100\"", "effort=\"1e-9\""), ("damping=\"0.5\"", "damping=\"0\""), turned] {
        assert!(accepted(&crane(from, to)).warnings.is_empty(), "{to}");
    }
    let travel = joint(&crane("lower=\"0\"", "lower=\"4\""), "travel").limit.unwrap();
    assert_eq!((travel.lower, travel.upper), (4.0, 3.0));
}

/// Just above a turn, and from three turns in rad to three turns in degrees; larger bounds mean no
/// bound.
#[test]
fn angles_are_taken_for_degrees_where_they_look_like_it() {
    let told = |text: &str| accepted(text).warnings.iter().map(|w| w.code).collect::<Vec<_>>();
    let turned = |angle: &str| told(&crane("<child link=\"hook\"/>", &format!("<child link=\"hook\"/><origin rpy=\"0 {angle} 0\"/>")));
    let bound = |upper: &str| told(&crane("<limit lower=\"-1\" upper=\"1\"", &format!("<limit lower=\"-1\" upper=\"{upper}\"")));
    for angle in ["6.3", "-7", "1e4"] {
        assert_eq!(turned(angle), [Code::MoreThanATurn], "{angle}");
    }
    assert_eq!([bound("20"), bound("1080")], [[Code::MoreThanATurn]; 2]);
    assert_eq!([turned("6.28"), bound("19.9"), bound("1081"), bound("1e4")], [const { Vec::new() }; 4]);
}

#[test]
fn mass_on_a_fixed_base_is_told_as_not_used() {
    let mass = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>";
    let text = crane("<link name=\"tower\"/>", &format!("<link name=\"tower\">{mass}"))
        .replace("<link name=\"lamp\"/>", &format!("<link name=\"lamp\">{mass}"));
    let reading = accepted(&text);
    let held = |reading: &Reading| {
        let of_held = reading.unused.iter().filter(|u| u.tag == "inertial");
        of_held.map(|u| u.subject.to_string()).collect::<Vec<_>>()
    };
    assert!(reading.warnings.is_empty());
    assert_eq!(held(&reading), ["link \"tower\"", "link \"lamp\""]);
    assert_eq!(reading.description.links[LinkId(0)].inertial.unwrap().mass, 1.0);
    let mut edited = reading.clone();
    edited.release(|link| link == "tower");
    assert_eq!(held(&edited), ["link \"lamp\""]);
    edited.release(|_| true);
    assert!(held(&edited).is_empty());
    let floating = read(text.as_bytes(), &Options { base: Base::Floating, ..options() }).unwrap();
    assert!(floating.warnings.is_empty() && held(&floating).is_empty());
}

/// A point of mass, and inertia without mass, which has a warning of its own.
#[test]
fn a_mass_or_an_inertia_alone_on_a_fixed_base_is_told_and_zeros_are_not() {
    let told = |mass: &str, moment: &str| {
        let inertial = format!(
            "<link name='tower'><inertial><mass value='{mass}'/>
             <inertia ixx='{moment}' ixy='0' ixz='0' iyy='{moment}' iyz='0' izz='{moment}'/></inertial></link>"
        );
        accepted(&crane("<link name=\"tower\"/>", &inertial)).unused.iter().any(|u| u.tag == "inertial")
    };
    assert!(told("1", "0") && told("0", "1") && !told("0", "0"));
}

/// A number with a unit, an angle in degrees, a loop to be closed: the intended robot differs from
/// the one read. Extensions of others do not count.
#[test]
fn what_nobody_knows_is_warned_of() {
    let told = |from: &str, to: &str| {
        let reading = accepted(&crane(from, to));
        assert!(reading.warnings.iter().all(|w| w.code == Code::Unknown), "{:?}", reading.warnings);
        reading.warnings.iter().map(|w| w.to_string().split_once(": ").unwrap().1.to_owned()).collect::<Vec<_>>()
    };
    let hook = "<child link=\"hook\"/>";
    let cases = [
        (
            hook,
            "<child link=\"hook\"/><origin rpy_deg=\"90 0 0\"/>",
            "origin rpy_deg: found what is not known and not used, expected nothing but xyz, rpy, quat_xyzw",
        ),
        (
            "<dynamics ",
            "<dynamics armature=\"1\" ",
            "dynamics armature: found what is not known and not used, expected nothing but damping, friction",
        ),
    ];
    for (from, to, expected) in cases {
        let told = told(from, to);
        assert!(told.len() == 1 && told[0].ends_with(expected), "{told:?}");
    }
    let end = told("</robot>", "<odd_joint name=\"l\"/><odd:joint name=\"d\"/><plugin/></robot>");
    assert!(end.len() == 1 && end[0].contains("<odd_joint>: found what is not known"), "{end:?}");
}

/// Tags inside the robot, the texts of each warning, and their number.
const LOST: &[(&str, &[&str])] = &[
    (
        "<loop_joint name='d' type='continuous'><link1 link='boom'/><link2 link='hook'/></loop_joint>",
        &["<loop_joint>: found a closed loop or a constraint \"d\", expected a tree of joints"],
    ),
    (
        "<gazebo><joint name='d' type='revolute'><parent>boom</parent><child>hook</child></joint></gazebo>",
        &[
            "<joint>: found a closed loop between the links \"boom\" and \"hook\" by the joint \"d\" inside <gazebo>, expected a tree of joints: it is not closed",
        ],
    ),
    (
        "<gazebo reference='hook'><joint name='d' type='ball'><parent link='crane::boom'/><child link='hook'/></joint></gazebo>",
        &["found a closed loop between the links \"boom\" and \"hook\" by the joint \"d\" inside <gazebo reference=\"hook\">"],
    ),
    (
        "<gazebo><joint name='d' type='fixed'><parent>boom</parent><child>ground</child></joint></gazebo>",
        &["<joint>: found a joint \"d\" inside <gazebo>, expected <joint> directly inside <robot>"],
    ),
    (
        "<gazebo><joint name='d' type='gearbox'><parent>boom</parent><child>hook</child></joint></gazebo>",
        &["found a coupling of two joints by the gearbox \"d\" inside <gazebo>, expected <mimic> inside <joint>"],
    ),
    (
        "<gazebo><plugin name='p' filename='libroboticsgroup_gazebo_mimic_joint_plugin.so'><joint>swing</joint><mimicJoint>slew</mimicJoint>\
         <multiplier>-0.5</multiplier></plugin></gazebo>",
        &["<plugin>: found a coupling of joint \"swing\" with joint \"slew\", -0.5 · q + 0, by the plugin \"p\" inside <gazebo>, \
           expected <mimic joint=\"slew\" multiplier=\"-0.5\" offset=\"0\"/> inside joint \"swing\": it is not read, and the joint moves by itself"],
    ),
    (
        "<plugin name='finger_mimic'/>",
        &["<plugin>: found a coupling of joints by the plugin \"finger_mimic\", expected <mimic> inside <joint>: it is not read"],
    ),
    ("<gazebo><plugin name='p' filename='libClosedLoopPlugin.so'/></gazebo>", &["found a closed loop by the plugin \"p\" inside <gazebo>"]),
    (
        "<ros2_control name='c' type='system'><joint name='swing'><param name='mimic'>slew</param><param name='multiplier'>2</param></joint></ros2_control>",
        &[
            "<joint>: found a coupling of joint \"swing\" with joint \"slew\", 2 · q + 0, by a parameter of the joint \"swing\" inside <ros2_control>",
        ],
    ),
    (
        "<gazebo reference='hook'><springStiffness>30</springStiffness><springReference>0</springReference></gazebo>",
        &["<springStiffness>: found a spring inside <gazebo reference=\"hook\">, expected the name of a joint with one coordinate"],
    ),
    ("<gazebo reference='hook'><turnGravityOff>true</turnGravityOff></gazebo>", &["found a link without gravity"]),
    ("<gazebo reference='hook'><gravity>0</gravity></gazebo>", &["found a link without gravity"]),
    ("<gazebo><joint><axis><mimic joint='slew'/></axis></joint></gazebo>", &["found a joint that follows another"]),
    (
        "<mujoco><equality><connect body1='hook'/></equality><tendon><spatial/></tendon></mujoco>",
        &["<equality>: found a closed loop", "<tendon>: found a spring"],
    ),
    ("<drake:linear_bushing_rpy/>", &["<drake:linear_bushing_rpy>: found a spring and damper between two links"]),
    ("<drake:ball_constraint/>", &["<drake:ball_constraint>: found a closed loop"]),
    ("<odd:joint name='d' type='ball'><parent link='hook'/><child link='boom'/></odd:joint>", &["<odd:joint>: found a joint \"d\""]),
    ("<group><link name='ghost'/><joint name='g'/></group>", &["<group>: found 1 links and 1 joints inside <group>"]),
    // Not lost, or without effect.
    ("<gazebo reference='swing'><springStiffness>0</springStiffness><implicitSpringDamper>1</implicitSpringDamper></gazebo>", &[]),
    ("<gazebo><plugin name='p'><joint>swing</joint><joint name='swing'/></plugin><gravity>true</gravity></gazebo>", &[]),
    ("<gazebo reference='hook'><kp>1e6</kp><turnGravityOff>false</turnGravityOff></gazebo>", &[]),
    ("<transmission name='t'><joint name='slew'><stiffness>3</stiffness></joint></transmission>", &[]),
    ("<a:group><link name='ghost'/></a:group>", &[]),
];

#[test]
fn dynamics_that_are_stated_where_they_are_not_read_are_warned_of() {
    for (tags, expected) in LOST {
        let reading = accepted(&crane("</robot>", &format!("{tags}</robot>")));
        assert_eq!(reading.description, described(CRANE));
        let told: Vec<String> = reading.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(told.len(), expected.len(), "{tags}: {told:#?}");
        for (told, expected) in told.iter().zip(*expected) {
            assert!(told.starts_with("crane.urdf:42: ") && told.contains(expected), "{told}");
        }
    }
    // A plugin that repeats <mimic> is not reported; one that contradicts it is.
    for (multiplier, expected) in [("0.5", None), ("-0.5", Some("the law of <mimic> inside joint \"swing\": that one is used"))] {
        let plugin = "<plugin filename='libgazebo_mimic_joint_plugin.so'><joint>swing</joint><mimicJoint>travel</mimicJoint><multiplier>0.5</multiplier>";
        let text =
            crane("<axis xyz=\"0 1 0\"/>", &format!("<axis xyz=\"0 1 0\"/><mimic joint='travel' multiplier='{multiplier}' offset='0'/>"))
                .replace("lower=\"-1\" upper=\"1\"", "lower=\"-2\" upper=\"2\"")
                .replace("</robot>", &format!("<gazebo>{plugin}</plugin></gazebo></robot>"));
        let told: Vec<String> = accepted(&text).warnings.iter().map(|w| w.expected.clone()).collect();
        assert_eq!(told, expected.into_iter().collect::<Vec<_>>());
    }
    // Inside a joint and a link too.
    let spring = accepted(&crane("<child link=\"hook\"/>", "<child link=\"hook\"/><drake:spring stiffness='3'/>"));
    assert!(
        spring.warnings.len() == 1 && spring.warnings[0].to_string().contains("joint \"swing\": <drake:spring>"),
        "{:?}",
        spring.warnings
    );
}

#[test]
fn declarations_of_prefixes_are_no_content() {
    let reading = accepted(&crane("<robot ", "<robot xmlns='http://a' xmlns:xacro='http://b' "));
    assert!(reading.unused.iter().all(|u| u.subject != Subject::Document), "{:?}", reading.unused);
}

const EXTENSIONS: &str = r#"
  <transmission name="t"><joint name="slew"><x/></joint><actuator name="${motor}"/></transmission>
  <gazebo reference="boom"><link name="ghost"/><sensor:x y:z="1"/></gazebo>
  <ros2_control name="c" type="system"><joint name="slew"/></ros2_control>
  <odd:joint name="d"/>
  <material name="red"><color rgba="1 0 0 1"/></material>
</robot>"#;

#[test]
fn extensions_are_no_part_of_the_tree_and_are_reported() {
    let reading = accepted(&crane("</robot>", EXTENSIONS));
    assert_eq!(reading.description, described(CRANE));
    assert!(reading.warnings.is_empty());
    let mut tags: Vec<(&str, Option<u32>)> =
        reading.unused.iter().filter(|u| u.subject == Subject::Document).map(|u| (u.tag.as_str(), u.line)).collect();
    tags.sort_by_key(|(_, line)| *line);
    let lines = [43, 44, 45, 46, 47].map(Some);
    let names = ["transmission", "gazebo", "ros2_control", "odd:joint", "material"];
    assert_eq!(tags, names.into_iter().zip(lines).collect::<Vec<_>>());
}

/// Text is not a tag, and a tag inside text is not one either.
#[test]
fn text_between_tags_is_reported() {
    let reading = accepted(&crane("<link name=\"hook\"/>", "<![CDATA[<link name='ghost'/>]]><link name=\"hook\"> steel\n </link>"));
    assert_eq!(reading.description, described(CRANE));
    let told: Vec<String> =
        reading.unused.iter().filter(|u| u.tag.starts_with("text")).map(|u| format!("{} {} {}", u.subject, u.tag, u.why)).collect();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(
        told.iter().any(|t| t.contains("<robot>") && t.contains("<link name='ghost'/>")) && told.iter().any(|t| t.contains("\"steel\"")),
        "{told:?}"
    );
}

#[test]
fn content_of_links_and_joints_that_is_not_used_is_reported() {
    let text = crane(
        "<link name=\"hook\"/>",
        "<link name=\"hook\" type=\"steel\"><visual><geometry><mesh filename=\"/no/such/file.stl\"/></geometry></visual>
         <collision/><odd/></link>",
    )
    .replace("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\" frame=\"child\"/><calibration rising=\"x\"/><safety_controller/>");
    let reading = accepted(&text);
    let tags: Vec<String> = reading.unused.iter().map(|u| format!("{} {}", u.subject, u.tag)).collect();
    for expected in [
        "link \"hook\" link type",
        "link \"hook\" visual",
        "link \"hook\" collision",
        "link \"hook\" <odd>",
        "joint \"slew\" axis frame",
        "joint \"slew\" calibration",
        "joint \"slew\" safety_controller",
        "joint \"swing\" dynamics damping",
        "joint \"swing\" dynamics friction",
    ] {
        let expected = expected.replace(['<', '>'], "");
        assert!(tags.contains(&expected), "{expected} in {tags:#?}");
    }
}

/// No link has a thousand tonnes: most often the mass is in grams, or a placeholder.
#[test]
fn a_mass_beyond_any_link_is_a_warning_in_every_format() {
    let moments = "ixx='1e7' ixy='0' ixz='0' iyy='1e7' iyz='0' izz='1e7'";
    let urdf = |mass: &str| {
        format!(
            "<robot name='r'><link name='base'/>\n<link name='tip'><inertial><mass value='{mass}'/><inertia {moments}/></inertial></link>
            <joint name='j' type='continuous'><parent link='base'/><child link='tip'/><axis xyz='0 0 1'/></joint></robot>"
        )
    };
    let mjcf = |mass: &str| {
        format!("<mujoco><worldbody>\n<body name='tip'><joint/><geom name='ball' size='1' mass='{mass}'/></body></worldbody></mujoco>")
    };
    let tags = ["ixx", "iyy", "izz"].map(|tag| format!("<{tag}>1e7</{tag}>")).concat();
    let sdf = |mass: &str| {
        format!(
            "<sdf version='1.7'><model name='m'>\n<link name='tip'><inertial><mass>{mass}</mass><inertia>{tags}</inertia></inertial></link></model></sdf>"
        )
    };
    let told = |text: String| {
        let reading = read(text.as_bytes(), &Options { base: Base::Floating, ..options() }).unwrap_or_else(|e| panic!("{e}"));
        let heavy = reading.warnings.into_iter().filter(|warning| warning.code == Code::Units && warning.field == "mass");
        heavy.map(|warning| (warning.line(), warning.subject, warning.found)).collect::<Vec<_>>()
    };
    for text in [&urdf as &dyn Fn(&str) -> String, &mjcf, &sdf] {
        assert_eq!(told(text("1e6")), []);
        let found = told(text("1000001"));
        let expected = (Subject::Link("tip".into()), "a mass of 1000001 kg, more than any link has");
        assert!(found.len() == 1 && found[0].0 == Some(2) && (found[0].1.clone(), found[0].2.as_str()) == expected, "{found:?}");
    }
    // The masses due to `settotalmass` are those of the robot.
    let total = mjcf("1").replace("<worldbody>", "<compiler settotalmass='2e6'/><worldbody>");
    assert_eq!(told(total).len(), 1);
}
