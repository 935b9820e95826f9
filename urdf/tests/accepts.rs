//! What documents say that are accepted, spelled in whatever way.

mod corpus;

use std::f64::consts::FRAC_PI_2;

use articulated_core::description::{JointDynamics, JointKind, Limit, Mimic, Origin};
use articulated_urdf::{Kind, Options, Subject, read};
use corpus::{CRANE, accepted, crane, described, joint, options};

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
