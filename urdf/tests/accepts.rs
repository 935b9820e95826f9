//! What is quietly right, what is right with a warning, and what is reported as unused.

mod corpus;

use std::f64::consts::FRAC_PI_2;

use articulated_core::description::{Base, Joint, JointDynamics, JointKind, Limit, Mimic, Origin};
use articulated_urdf::{Kind, Options, Reading, Subject, read};
use corpus::{CRANE, accepted, crane, described, options};

fn joint(text: &str, name: &str) -> Joint {
    let description = described(text);
    description.joints[description.joint(name).unwrap()].clone()
}

#[test]
fn the_description_says_what_the_file_says() {
    let crane = described(CRANE);
    assert_eq!(crane.name, "crane");
    let names: Vec<&str> = crane.links.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["tower", "boom", "trolley", "hook", "lamp"]);
    let boom = crane.links[1].inertial.unwrap();
    assert_eq!(boom.origin, Origin { xyz: [1.5, 0.0, 0.1], rpy: [0.0, 0.1, 0.0] });
    assert_eq!((boom.mass, boom.inertia), (40.0, [2.0, 0.1, 0.0, 30.0, 0.0, 31.0]));
    assert!(crane.links[0].inertial.is_none());
    let swing = &crane.joints[2];
    assert_eq!((swing.kind, swing.parent, swing.child, swing.axis), (JointKind::Revolute, 2, 3, [0.0, 1.0, 0.0]));
    assert_eq!(swing.limit, Some(Limit { lower: -1.0, upper: 1.0, effort: 10.0, velocity: 2.0 }));
    assert_eq!(swing.dynamics, Some(JointDynamics { damping: 0.5, friction: 0.1 }));
    assert_eq!((crane.joints[0].limit, crane.joints[0].mimic), (None, None));
    assert_eq!(crane.joints[0].origin.xyz, [0.0, 0.0, 12.0]);
    assert_eq!(crane.joints[3].kind, JointKind::Fixed);
}

#[test]
fn other_spellings_of_the_same_document_are_the_same_robot() {
    let same = [
        format!("\u{feff}{CRANE}"),
        CRANE.replace('\n', "\r\n"),
        format!("\n \n{CRANE}"),
        CRANE.replace("<?xml version=\"1.0\"?>\n", ""),
        CRANE.replace('"', "'"),
        crane("<robot ", "<!-- a -- comment --><robot xmlns=\"http://example.org/urdf\" "),
        crane("\"0 0 12\"", "\"\n 0\t+0.\r\n1.2E+1 \""),
        crane("value=\"40\"", "value=\" 4e1 \""),
        crane("ixy=\"0.1\"", "ixy=\"+.1\""),
        crane("<link name=\"lamp\"/>", "<link name=\"&#108;amp\"/>"),
    ];
    for text in same {
        assert_eq!(described(&text), described(CRANE), "{text}");
    }
}

#[test]
fn numbers_are_read_to_the_last_bit() {
    let spellings = ["0.1", "1e-20", "123456789.123456789", "4.9e-324", "1.7976931348623157e308", "-2.2250738585072014e-308", "3e22"];
    for word in spellings {
        let origin = joint(&crane("0 0 12", &format!("{word} 0 -0")), "slew").origin.xyz;
        assert_eq!(origin[0].to_bits(), word.parse::<f64>().unwrap().to_bits(), "{word}");
        assert_eq!(origin[2].to_bits(), (-0.0_f64).to_bits());
    }
}

#[test]
fn joints_and_links_stand_in_any_order() {
    let start = CRANE.find("  <link name=\"tower\"").unwrap();
    let middle = CRANE.find("  <joint name=\"slew\"").unwrap();
    let end = CRANE.find("</robot>").unwrap();
    let text = [&CRANE[..start], &CRANE[middle..end], &CRANE[start..middle], &CRANE[end..]].concat();
    assert_eq!(described(&text), described(CRANE));
}

#[test]
fn names_may_be_anything_and_links_and_joints_may_share_them() {
    for name in ["left arm", " a ", "a/b:c[0]", "π-Gelenk", "🦾", "&lt;&amp;&quot;", "fn", "1", "a&#10;b"] {
        let text = CRANE.replace("\"boom\"", &format!("\"{name}\"")).replace("\"slew\"", &format!("\"{name}\""));
        let description = described(&text);
        assert_eq!(description.links[1].name, description.joints[0].name);
        assert_eq!(description.joints[1].parent, 1);
    }
}

#[test]
fn axes_stay_as_written_and_default_to_x() {
    assert_eq!(joint(&crane("0 1 0", "0 2 -2e-3"), "swing").axis, [0.0, 2.0, -2e-3]);
    assert_eq!(joint(&crane("<axis xyz=\"0 0 1\"/>", ""), "slew").axis, [1.0, 0.0, 0.0]);
}

#[test]
fn what_a_joint_has_no_use_for_is_reported_and_not_read() {
    let text = crane("<child link=\"lamp\"/>", "<child link=\"lamp\"/><axis xyz=\"0 0 0\"/><limit/><dynamics/>");
    let reading = accepted(&text);
    let mount = &reading.description.joints[3];
    assert_eq!((mount.axis, mount.limit, mount.dynamics), ([1.0, 0.0, 0.0], None, None));
    let tags: Vec<&str> = reading.unused.iter().filter(|u| u.subject == Subject::Joint("mount".into())).map(|u| u.tag.as_str()).collect();
    assert_eq!(tags, ["axis", "limit", "dynamics"]);
}

#[test]
fn floating_and_planar_joints_are_described() {
    for (name, kind) in [("floating", JointKind::Floating), ("planar", JointKind::Planar)] {
        let slew = joint(&CRANE.replace("\"continuous\"", &format!("\"{name}\"")), "slew");
        assert_eq!(slew.kind, kind);
        let axis = if kind == JointKind::Planar { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        assert_eq!(slew.axis, axis);
    }
}

/// Programs differ in what they take for its plane.
#[test]
fn a_planar_joint_without_an_axis_moves_across_x_and_is_warned_of() {
    let reading = accepted(&slew("planar", ""));
    let warning = reading.warnings.iter().find(|w| w.kind == Kind::NoAxis).expect("a warning");
    assert!(warning.to_string().contains("slew") && warning.to_string().contains("the plane y and z"), "{warning}");
    assert_eq!(joint(&slew("planar", ""), "slew").axis, [1.0, 0.0, 0.0]);
    assert!(accepted(&slew("planar", "<axis xyz='0 0 1'/>")).warnings.iter().all(|w| w.kind != Kind::NoAxis));
    assert!(accepted(&slew("continuous", "")).warnings.iter().all(|w| w.kind != Kind::NoAxis));
}

/// The crane with a slew of another type and other tags in place of its axis.
fn slew(kind: &str, tags: &str) -> String {
    crane("<axis xyz=\"0 0 1\"/>", tags).replace("\"continuous\"", &format!("\"{kind}\""))
}

#[test]
fn the_extensions_are_read_and_agree_with_the_second_reader() {
    let spherical = joint(&slew("spherical", ""), "slew");
    assert_eq!((spherical.kind, spherical.limit), (JointKind::Spherical, None));
    let helical =
        joint(&slew("helical", "<axis xyz='0 2 0'/><thread pitch='-5e-3'/><limit lower='-9' upper='9' effort='1' velocity='2'/>"), "slew");
    assert_eq!((helical.kind, helical.axis, helical.pitch), (JointKind::Helical, [0.0, 2.0, 0.0], -0.005));
    assert_eq!(helical.limit, Some(Limit { lower: -9.0, upper: 9.0, effort: 1.0, velocity: 2.0 }));
    let universal = joint(&slew("universal", "<axis xyz='0 0 3'/><axis2 xyz='1 0 1'/>"), "slew");
    assert_eq!((universal.kind, universal.axis, universal.second_axis), (JointKind::Universal, [0.0, 0.0, 3.0], [1.0, 0.0, 1.0]));
    assert_eq!((universal.pitch, helical.second_axis), (0.0, [0.0; 3]));
}

#[test]
fn a_helical_joint_leads_and_follows() {
    let text = slew("helical", "<thread pitch='0.01'/><limit effort='1' velocity='1' lower='-1' upper='1'/><mimic joint='travel'/>")
        .replace("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"slew\"/>");
    let crane = described(&text);
    assert_eq!([0, 2].map(|i| crane.joints[i].mimic.unwrap().joint), [1, 0]);
}

#[test]
fn what_only_an_extension_uses_is_reported_elsewhere() {
    let reading = accepted(&slew("revolute", "<axis2 xyz='x'/><thread pitch='x'/><limit effort='1' velocity='1' lower='0' upper='1'/>"));
    let tags: Vec<&str> = reading.unused.iter().filter(|u| u.subject == Subject::Joint("slew".into())).map(|u| u.tag.as_str()).collect();
    assert_eq!(tags, ["axis2", "thread"]);
    let reading = accepted(&slew("spherical", "<axis xyz='0 0 1'/><limit/>"));
    let tags: Vec<&str> = reading.unused.iter().filter(|u| u.subject == Subject::Joint("slew".into())).map(|u| u.tag.as_str()).collect();
    assert_eq!(tags, ["axis", "limit"]);
}

#[test]
fn a_pitch_of_zero_is_a_warning_and_no_limit_too() {
    let kinds: Vec<Kind> = accepted(&slew("helical", "<thread pitch='0'/>")).warnings.iter().map(|w| w.kind).collect();
    assert_eq!(kinds, [Kind::ZeroPitch, Kind::LimitMissing]);
}

#[test]
fn limits_that_are_left_open_are_infinite() {
    let text = crane("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/><limit lower=\"-1\" effort=\"9\" velocity=\"2\"/>");
    let reading = accepted(&text);
    let limit = reading.description.joints[0].limit.unwrap();
    assert_eq!(limit, Limit { lower: f64::NEG_INFINITY, upper: f64::INFINITY, effort: 9.0, velocity: 2.0 });
    assert!(reading.unused.iter().any(|u| u.tag == "limit lower" && u.line == Some(23)));
    assert!(reading.warnings.is_empty());
    let open = CRANE.replace("<robot ", "<robot version=\"1.2\" ").replace("lower=\"0\" upper=\"3\" effort=\"100\"", "");
    let travel = joint(&open, "travel").limit.unwrap();
    assert_eq!((travel.lower, travel.upper, travel.effort), (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY));
}

/// As the format has it before version 1.2; from then on, nothing is amiss with a bound that is left open.
#[test]
fn bounds_that_are_left_out_are_zero_before_version_1_2_and_open_from_then_on() {
    let travel = |version: &str, given: &str| {
        let text = crane("lower=\"0\" upper=\"3\" effort=\"100\" velocity=\"0.5\"", given);
        let reading = accepted(&text.replace("<robot ", &format!("<robot version='{version}' ")));
        let limit = reading.description.joints[1].limit.unwrap();
        let warned: Vec<String> = reading.warnings.iter().map(|w| w.field.clone()).collect();
        ([limit.lower, limit.upper, limit.effort, limit.velocity], warned.join(", "))
    };
    let (none, open) = (String::new(), f64::INFINITY);
    assert_eq!(travel("1.0", "upper='3' effort='1' velocity='2'"), ([0.0, 3.0, 1.0, 2.0], none.clone()));
    assert_eq!(travel("1.1", "lower='-3' effort='1' velocity='2'"), ([-3.0, 0.0, 1.0, 2.0], none.clone()));
    assert_eq!(travel("1.0", ""), ([0.0, 0.0, open, open], "limit, limit effort, limit velocity".to_owned()));
    assert_eq!(travel("1.2", "upper='3'"), ([-open, 3.0, open, open], none.clone()));
    assert_eq!(travel(" 1.2 ", ""), ([-open, open, open, open], none));
}

#[test]
fn coefficients_that_are_left_out_are_zero() {
    for (given, damping, friction) in [("friction='2'", 0.0, 2.0), ("damping='3'", 3.0, 0.0), ("", 0.0, 0.0)] {
        let swing = joint(&crane("damping=\"0.5\" friction=\"0.1\"", given), "swing");
        assert_eq!(swing.dynamics, Some(JointDynamics { damping, friction }), "{given}");
    }
}

#[test]
fn mimics_have_defaults_and_chains() {
    let text = crane("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\"/>")
        .replace("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"1 0 0\"/><mimic joint=\"slew\" multiplier=\"-2\" offset=\".5\"/>");
    let crane = described(&text);
    assert_eq!(crane.joints[2].mimic, Some(Mimic { joint: 1, multiplier: 1.0, offset: 0.0 }));
    assert_eq!(crane.joints[1].mimic, Some(Mimic { joint: 0, multiplier: -2.0, offset: 0.5 }));
}

#[test]
fn angles_snap_only_where_that_is_asked_for() {
    let text = crane("rpy=\"0 0 0\"", "rpy=\"1.5708 0 -3.1416\"");
    let plain = accepted(&text);
    assert!(plain.snapped.is_empty());
    assert_eq!(plain.description.joints[0].origin.rpy[0].to_string(), "1.5708");
    let snapping = Options { snap_angles: Some(1e-5), ..options() };
    let reading = read(text.as_bytes(), &snapping).unwrap();
    assert_eq!(reading.description.joints[0].origin.rpy, [FRAC_PI_2, 0.0, -2.0 * FRAC_PI_2]);
    assert_eq!(reading.snapped.len(), 2);
    assert!(reading.snapped[0].to_string().contains("\"slew\": origin rpy: found 1.5708"), "{}", reading.snapped[0]);
    let fine = Options { snap_angles: Some(1e-6), ..options() };
    assert!(read(text.as_bytes(), &fine).unwrap().snapped.is_empty());
}

#[test]
fn the_size_of_units_does_not_matter() {
    let nano = crane("ixx=\"2\" ixy=\"0.1\"", "ixx=\"2e-20\" ixy=\"1e-21\"")
        .replace("iyy=\"30\"", "iyy=\"3e-19\"")
        .replace("\"31\"", "\"3.1e-19\"");
    assert!(accepted(&nano).warnings.is_empty());
    // A thin rod, and a plate whose moments were rounded.
    for (xx, yy, zz) in [("0", "1e-3", "1e-3"), ("1e-3", "2e-3", "3.0000001e-3"), ("-1e-13", "1e-3", "1e-3"), ("0", "0", "0")] {
        let text = crane("ixx=\"2\" ixy=\"0.1\"", &format!("ixx=\"{xx}\" ixy=\"0\"")).replace("\"30\"", &format!("\"{yy}\""));
        assert!(accepted(&text.replace("\"31\"", &format!("\"{zz}\""))).warnings.is_empty(), "{xx} {yy} {zz}");
    }
}

/// A boom of these principal moments, in turn: what is said of its inertia.
fn said_of(moments: [&str; 3]) -> Option<Kind> {
    let [xx, yy, zz] = moments.map(|moment| format!("=\"{moment}\""));
    let text = crane("ixx=\"2\" ixy=\"0.1\"", &format!("ixx{xx} ixy=\"0\"")).replace("iyy=\"30\"", &format!("iyy{yy}"));
    let problems = match read(text.replace("izz=\"31\"", &format!("izz{zz}")).as_bytes(), &options()) {
        Ok(reading) => reading.warnings,
        Err(problems) => problems.errors,
    };
    problems.first().map(|problem| problem.kind)
}

/// Files print some six digits.
#[test]
fn moments_are_forgiven_what_rounding_makes_of_them_and_no_more() {
    assert_eq!(said_of(["-5e-10", "1", "1"]), None);
    assert_eq!(said_of(["-5e-9", "1", "1"]), Some(Kind::InertiaNotPositive));
    assert_eq!(said_of(["1", "2.000001", "1"]), None);
    assert_eq!(said_of(["1", "2.000004", "1"]), Some(Kind::InertiaTriangle));
    // In any units.
    assert_eq!(said_of(["-5e-29", "1e-20", "1e-20"]), Some(Kind::InertiaNotPositive));
    assert_eq!(said_of(["-1", "-1", "-1"]), Some(Kind::InertiaNotPositive));
}

#[test]
fn axes_of_a_universal_joint_may_be_nearly_parallel_but_not_quite() {
    let leaning = |by: &str| slew("universal", &format!("<axis xyz='1 0 0'/><axis2 xyz='-1 {by} 0'/>"));
    assert_eq!(joint(&leaning("3e-6"), "slew").second_axis, [-1.0, 3e-6, 0.0]);
    assert_eq!(corpus::only_error(&leaning("3e-7")).kind, Kind::ParallelAxes);
    let askew = |second: &str| slew("universal", &format!("<axis xyz='1 2 3'/><axis2 xyz='{second}'/>"));
    assert_eq!(corpus::only_error(&askew("-2 -4 -6")).kind, Kind::ParallelAxes);
    for second in ["3 2 1", "-2 -4 6", "-2 4 -6", "2 -4 -6", "-2 -4 -6.001"] {
        accepted(&askew(second));
    }
}

#[test]
fn what_looks_wrong_is_a_warning_and_used_as_written() {
    let cases = [
        ("izz=\"31\"", "izz=\"33\"", Kind::InertiaTriangle, "boom", 5),
        ("value=\"40\"", "value=\"0\"", Kind::InertiaWithoutMass, "boom", 5),
        ("lower=\"0\"", "lower=\"4\"", Kind::LimitOrder, "travel", 29),
        ("effort=\"100\"", "effort=\"-1\"", Kind::Negative, "travel", 29),
        ("effort=\"100\"", "", Kind::LimitIncomplete, "travel", 29),
        ("lower=\"0\" upper=\"3\"", "", Kind::LimitIncomplete, "travel", 29),
        ("<limit lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"2\"/>", "", Kind::LimitMissing, "swing", 31),
        ("damping=\"0.5\"", "damping=\"-0.5\"", Kind::Negative, "swing", 36),
        ("<link name=\"hook\"/>", "<link name=\"hook\"><inertal/></link>", Kind::Misspelt, "hook", 17),
        ("<link name=\"hook\"/>", "<link name=\"hook\"><joint name=\"swing\"/></link>", Kind::Misplaced, "hook", 17),
        ("effort=\"100\"", "effort=\"100\" efort=\"1\"", Kind::Misspelt, "travel", 29),
        ("<robot ", "<robot version=\"7\" ", Kind::Version, "", 2),
        ("<child link=\"hook\"/>", "<child link=\"hook\"/><origin rpy=\"0 -90 0\"/>", Kind::MoreThanATurn, "swing", 33),
        ("<child link=\"hook\"/>", "<child link=\"hook\"/><origin xyz=\"0 0 -333\"/>", Kind::Units, "swing", 33),
        ("value=\"40\"", "value=\"0.3\"", Kind::Units, "boom", 5),
        ("<limit lower=\"-1\" upper=\"1\"", "<limit lower=\"-180\" upper=\"1\"", Kind::MoreThanATurn, "swing", 35),
    ];
    let mut messages = Vec::new();
    for (from, to, kind, name, line) in cases {
        let warnings = accepted(&crane(from, to)).warnings;
        let found: Vec<_> = warnings.iter().map(|w| (w.kind, w.line)).collect();
        assert_eq!(found, [(kind, Some(line))], "{to}");
        assert!(warnings[0].to_string().contains(name));
        messages.push(warnings[0].to_string());
    }
    corpus::as_kept("warnings.txt", &messages);
    let turned = ("<child link=\"hook\"/>", "<child link=\"hook\"/><origin rpy=\"6.283185307 0 -6.28319\"/>");
    for (from, to) in [("effort=\"100\"", "effort=\"0\""), ("damping=\"0.5\"", "damping=\"0\""), turned] {
        assert!(accepted(&crane(from, to)).warnings.is_empty(), "{to}");
    }
    let travel = joint(&crane("lower=\"0\"", "lower=\"4\""), "travel").limit.unwrap();
    assert_eq!((travel.lower, travel.upper), (4.0, 3.0));
}

/// Just above a turn, and from three turns in rad to three turns in degrees; bounds beyond stand for none.
#[test]
fn angles_are_taken_for_degrees_where_they_look_like_it() {
    let told = |text: &str| accepted(text).warnings.iter().map(|w| w.kind).collect::<Vec<_>>();
    let turned = |angle: &str| told(&crane("<child link=\"hook\"/>", &format!("<child link=\"hook\"/><origin rpy=\"0 {angle} 0\"/>")));
    let bound = |upper: &str| told(&crane("<limit lower=\"-1\" upper=\"1\"", &format!("<limit lower=\"-1\" upper=\"{upper}\"")));
    for angle in ["6.3", "-7", "1e4"] {
        assert_eq!(turned(angle), [Kind::MoreThanATurn], "{angle}");
    }
    assert_eq!([bound("20"), bound("1080")], [[Kind::MoreThanATurn]; 2]);
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
    assert_eq!(reading.description.links[0].inertial.unwrap().mass, 1.0);
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

/// A number with a unit, an angle in degrees, a loop that is to be closed: another robot is meant than is read. Extensions of others are not.
#[test]
fn what_nobody_knows_is_warned_of() {
    let told = |from: &str, to: &str| {
        let reading = accepted(&crane(from, to));
        assert!(reading.warnings.iter().all(|w| w.kind == Kind::Unknown), "{:?}", reading.warnings);
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
    let end = told("</robot>", "<loop_joint name=\"l\"/><drake:joint name=\"d\"/><plugin/></robot>");
    assert!(end.len() == 1 && end[0].contains("<loop_joint>: found what is not known"), "{end:?}");
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
  <drake:joint name="d"/>
  <material name="red"><color rgba="1 0 0 1"/></material>
</robot>"#;

#[test]
fn extensions_are_no_part_of_the_tree_and_are_reported() {
    let reading = accepted(&crane("</robot>", EXTENSIONS));
    assert_eq!(reading.description, described(CRANE));
    assert!(reading.warnings.is_empty());
    let tags: Vec<(&str, Option<u32>)> =
        reading.unused.iter().filter(|u| u.subject == Subject::Document).map(|u| (u.tag.as_str(), u.line)).collect();
    let lines = [43, 44, 45, 46, 47].map(Some);
    let names = ["transmission", "gazebo", "ros2_control", "drake:joint", "material"];
    assert_eq!(tags, names.into_iter().zip(lines).collect::<Vec<_>>());
}

/// Text is no tag, and a tag that is text is none either.
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
