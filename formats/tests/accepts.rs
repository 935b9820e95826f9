//! Accepted documents in all spellings.

mod corpus;

use std::f64::consts::FRAC_PI_2;

use articulated_core::description::{
    Collision, CollisionShape, Hull, JointDynamics, JointId, JointKind, Limit, LinkId, Mimic, Origin, Visual,
};
use articulated_core::diagnostic::{Code, Subject};
use articulated_formats::{Options, read};
use corpus::{CRANE, accepted, crane, described, joint, options};

#[test]
fn the_description_says_what_the_file_says() {
    let crane = described(CRANE);
    assert_eq!(crane.name, "crane");
    let names: Vec<&str> = crane.links.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["tower", "boom", "trolley", "hook", "lamp"]);
    let boom = crane.links[LinkId(1)].inertial.unwrap();
    assert_eq!(boom.origin, Origin::new([1.5, 0.0, 0.1], [0.0, 0.1, 0.0]));
    assert_eq!((boom.mass, boom.inertia), (40.0, [2.0, 0.1, 0.0, 30.0, 0.0, 31.0]));
    assert!(crane.links[LinkId(0)].inertial.is_none());
    let swing = &crane.joints[JointId(2)];
    assert_eq!((swing.kind, swing.parent, swing.child, swing.axis), (JointKind::Revolute, LinkId(2), LinkId(3), [0.0, 1.0, 0.0]));
    assert_eq!(swing.limit, Some(Limit { lower: -1.0, upper: 1.0, effort: 10.0, velocity: 2.0, ..Limit::NONE }));
    assert_eq!(swing.dynamics, JointDynamics { damping: Some(0.5), friction: Some(0.1), ..JointDynamics::default() });
    assert_eq!((crane.joints[JointId(0)].limit, crane.joints[JointId(0)].mimic), (None, None));
    assert_eq!(crane.joints[JointId(0)].origin.xyz, [0.0, 0.0, 12.0]);
    assert_eq!(crane.joints[JointId(3)].kind, JointKind::Fixed);
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

/// 10⁵ doubles of any size in the origins of joints, in the shortest spelling and in 17 digits by
/// turns.
#[test]
fn very_many_numbers_are_read_to_the_nearest_double() {
    let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
    let doubles = std::iter::repeat_with(|| {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from_bits(bits)
    });
    let doubles: Vec<f64> = doubles.filter(|x| x.is_finite()).take(100_002).collect();
    let mut text = String::from("<robot name='r'><link name='w'/>");
    for (k, six) in doubles.chunks(6).enumerate() {
        let word = |i: usize| if i % 2 == k % 2 { format!("{:?}", six[i]) } else { format!("{:.16e}", six[i]) };
        let words: Vec<String> = (0..6).map(word).collect();
        text += &format!("<link name='l{k}'/><joint name='j{k}' type='fixed'><parent link='w'/><child link='l{k}'/>");
        text += &format!("<origin xyz='{}' rpy='{}'/></joint>", words[..3].join(" "), words[3..].join(" "));
    }
    let description = described(&(text + "</robot>"));
    let read = description.joints.iter().flat_map(|j| j.origin.xyz.into_iter().chain(j.origin.rotation.rpy()));
    assert!(read.map(f64::to_bits).eq(doubles.iter().map(|x| x.to_bits())));
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
        assert_eq!(description.links[LinkId(1)].name, description.joints[JointId(0)].name);
        assert_eq!(description.joints[JointId(1)].parent, LinkId(1));
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
    let mount = &reading.description.joints[JointId(3)];
    assert_eq!((mount.axis, mount.limit, mount.dynamics), ([1.0, 0.0, 0.0], None, JointDynamics::default()));
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

/// Other programs use different planes for it.
#[test]
fn a_planar_joint_without_an_axis_moves_across_x_and_is_warned_of() {
    let reading = accepted(&slew("planar", ""));
    let warning = reading.warnings.iter().find(|w| w.code == Code::NoAxis).expect("a warning");
    assert!(warning.to_string().contains("slew") && warning.to_string().contains("the plane y and z"), "{warning}");
    assert_eq!(joint(&slew("planar", ""), "slew").axis, [1.0, 0.0, 0.0]);
    assert!(accepted(&slew("planar", "<axis xyz='0 0 1'/>")).warnings.iter().all(|w| w.code != Code::NoAxis));
    assert!(accepted(&slew("continuous", "")).warnings.iter().all(|w| w.code != Code::NoAxis));
}

/// A gripper that was welded: its joints are fixed, and still have the tags of movable ones.
#[test]
fn a_fixed_joint_with_a_left_over_mimic_is_a_fixed_joint() {
    for leader in ["slew", "no_such_joint", "mount"] {
        let tags = format!("<child link=\"lamp\"/><axis xyz='0 1 0'/><limit lower='0'/><mimic joint='{leader}' multiplier='x'/>");
        let reading = accepted(&crane("<child link=\"lamp\"/>", &tags));
        assert_eq!(reading.description, described(CRANE), "{leader}");
        let of_mount = reading.unused.iter().filter(|u| u.subject == Subject::Joint("mount".into()));
        assert_eq!(of_mount.map(|u| u.tag.as_str()).collect::<Vec<_>>(), ["axis", "limit", "mimic"]);
        let warned: Vec<Code> = reading.warnings.iter().map(|w| w.code).collect();
        assert_eq!(warned, [Code::UnusedMimic]);
    }
}

/// An inertia as `ixx ixy ixz iyy iyz izz` of a trolley of `mass` with its centre at `xyz`.
fn trolley(mass: &str, xyz: &str, moments: [&str; 6]) -> String {
    let [xx, xy, xz, yy, yz, zz] = moments;
    let inertia = format!("<inertia ixx='{xx}' ixy='{xy}' ixz='{xz}' iyy='{yy}' iyz='{yz}' izz='{zz}'/>");
    crane("<inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/>", &inertia)
        .replace("<mass value=\"5\"/>", &format!("<origin xyz='{xyz}'/><mass value='{mass}'/>"))
}

/// Principal moments of ±3.1e-35 kg·m² on 1.2 kg, as exporters leave them; of −5.4e-20 on 0.5 kg;
/// and of −3e-8 on a gram, which no rounding makes.
#[test]
fn a_moment_that_is_negative_by_rounding_is_a_warning() {
    for (mass, moments) in [
        ("1.2", ["0", "0", "3.1e-35", "0", "0", "0"]),
        ("0.5", ["0", "5.4e-20", "0", "0", "0", "0"]),
        ("0.5", ["-4e-13", "0", "0", "0", "0", "0"]),
    ] {
        let reading = accepted(&trolley(mass, "0.0185 -0.11 6.8e-18", moments));
        let warned: Vec<Code> = reading.warnings.iter().map(|w| w.code).collect();
        assert_eq!(warned, [Code::InertiaNotPositive], "{mass} {moments:?}");
        assert!(reading.warnings[0].to_string().contains("negative by rounding alone"), "{}", reading.warnings[0]);
        let kept = reading.description.links[LinkId(2)].inertial.unwrap().inertia;
        assert_eq!(kept, moments.map(|m| m.parse::<f64>().unwrap()));
    }
    for (mass, moments) in [
        ("0.001", ["3e-8", "6e-8", "0", "3e-8", "0", "5e-8"]),
        ("0.5", ["-6e-13", "0", "0", "0", "0", "0"]),
        ("0", ["-1e-30", "0", "0", "0", "0", "0"]),
    ] {
        let problems = corpus::refused(&trolley(mass, "0.0185 -0.11 6.8e-18", moments));
        assert_eq!(problems.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [Code::InertiaNotPositive], "{mass} {moments:?}");
    }
}

/// In a robot of a millimetre, rounding is a millionth of that in a robot of a metre.
#[test]
fn what_rounding_is_depends_on_the_size_of_the_robot() {
    let tiny = |moment: &str| {
        trolley("1", "0.001 0 0", [moment, "0", "0", "0", "0", "0"])
            .replace("1.5 0 0.1", "1e-3 0 0")
            .replace("0 0 12", "0 0 -1e-3")
            .replace("ixx=\"2\" ixy=\"0.1\"", "ixx=\"40\" ixy=\"0.1\"")
    };
    assert!(read(tiny("-0.9e-18").as_bytes(), &options()).is_ok());
    assert_eq!(corpus::only_error(&tiny("-1.1e-18")).code, Code::InertiaNotPositive);
    // Without any length, a metre is the reference.
    let point = "<robot name='r'><link name='b'/><link name='c'><inertial><mass value='1'/>\
        <inertia ixx='M' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/></inertial></link>\
        <joint name='j' type='continuous'><parent link='b'/><child link='c'/></joint></robot>";
    assert!(read(point.replace('M', "-0.9e-12").as_bytes(), &options()).is_ok());
    assert_eq!(corpus::only_error(&point.replace('M', "-1.1e-12")).code, Code::InertiaNotPositive);
}

/// The rotation of roll, pitch and yaw, and that of a quaternion, each by its own textbook matrix.
fn rotation_of_rpy([r, p, y]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((sr, cr), (sp, cp), (sy, cy)) = (r.sin_cos(), p.sin_cos(), y.sin_cos());
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
}

fn rotation_of_quaternion([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    let n = x * x + y * y + z * z + w * w;
    [
        [n - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), n - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), n - 2.0 * (x * x + y * y)],
    ]
    .map(|row| row.map(|entry| entry / n))
}

/// Random ones, and those near and at a pitch of ±π/2, where roll and yaw are one.
#[test]
fn a_quaternion_is_the_rotation_that_it_stands_for() {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let mut all =
        vec![[half, 0.0, 0.0, half], [0.5, 0.5, 0.5, 0.5], [0.0, half, 0.0, half], [0.0, -half, 0.0, half], [0.0, 0.0, 0.0, -1.0]];
    all.extend((0..200).map(|_| std::array::from_fn(|_| random())));
    all.extend((0..200).map(|k| {
        let tilt = 10.0_f64.powi(-(k % 17));
        [tilt * random(), half + tilt * random(), tilt * random(), half * (1.0 + tilt * random())]
    }));
    for q in all {
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let q = q.map(|x| x / norm);
        let text = crane("xyz=\"0 0 12\" rpy=\"0 0 0\"", &format!("quat_xyzw='{:?} {:?} {:?} {:?}'", q[0], q[1], q[2], q[3]));
        let rpy = joint(&text.replace("<robot ", "<robot version='1.1' "), "slew").origin.rotation.rpy();
        let (found, right) = (rotation_of_rpy(rpy), rotation_of_quaternion(q));
        for (found, right) in found.iter().flatten().zip(right.iter().flatten()) {
            assert!((found - right).abs() < 1e-15, "{q:?} {rpy:?}");
        }
        assert!(rpy.iter().all(|angle| angle.abs() <= std::f64::consts::PI), "{rpy:?}");
    }
}

/// A quarter turn about x is the double π/2 itself, whatever the digits of √½; from 1.1 on.
#[test]
fn a_quarter_turn_as_a_quaternion_is_exact() {
    for (version, half, warned) in [("1.1", "0.7071067811865476", 0), ("1.2", "0.70710678", 0), ("1.1", "0.707", 1)] {
        let text = crane("xyz=\"0 0 12\" rpy=\"0 0 0\"", &format!("xyz='0 0 12' quat_xyzw='{half} 0 0 {half}'"));
        let reading = accepted(&text.replace("<robot ", &format!("<robot version='{version}' ")));
        let origin = reading.description.joints[JointId(0)].origin;
        let quarter = Origin::new([0.0, 0.0, 12.0], [FRAC_PI_2, 0.0, 0.0]);
        assert_eq!(origin.placement::<f64>().rotation, quarter.placement().rotation, "{half}");
        let kinds: Vec<Code> = reading.warnings.iter().map(|w| w.code).collect();
        assert_eq!(kinds, vec![Code::QuaternionNorm; warned]);
    }
}

#[test]
fn expressions_of_xacro_in_names_of_files_play_no_part() {
    let mesh = "<link name=\"hook\"><visual><geometry><mesh filename=\"file://$(find crane)/${name}.stl\"/></geometry></visual>\
        <collision><geometry><mesh filename=\"$(arg folder)/hook.stl\"/></geometry></collision></link>";
    let reading = accepted(&crane("<link name=\"hook\"/>", mesh));
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let mut description = reading.description;
    // Only the names of meshes are kept.
    let named = std::mem::take(&mut description.links[LinkId(3)].collision);
    let shape = CollisionShape::Mesh { file: "$(arg folder)/hook.stl".into(), scale: [1.0; 3], hull: Hull::NotRead };
    assert_eq!(named, [Collision { origin: Origin::default(), shape }]);
    let seen = std::mem::take(&mut description.links[LinkId(3)].visual);
    assert!(matches!(&seen[..], [Visual { shape: CollisionShape::Mesh { file, .. }, .. }] if file.ends_with("${name}.stl")), "{seen:?}");
    assert_eq!(description, described(CRANE));
}

/// As others read it: a link `world` that joints hang on and no tag declares.
#[test]
fn world_is_added_where_joints_hang_on_it_and_no_link_is_called_so() {
    let declared = CRANE.replace("\"tower\"", "\"world\"");
    let text = declared.replace("  <link name=\"world\"/>\n", "");
    let reading = accepted(&text);
    let warned: Vec<(Code, Option<u32>)> = reading.warnings.iter().map(|w| (w.code, w.line())).collect();
    assert_eq!(warned, [(Code::UndeclaredWorld, Some(19))]);
    let moved = declared
        .replace("  <link name=\"world\"/>\n", "")
        .replace("  <link name=\"lamp\"/>\n", "  <link name=\"lamp\"/>\n  <link name=\"world\"/>\n");
    assert_eq!(reading.description, described(&moved));
    // Another name stays an error, and so does a second root.
    let other = corpus::refused(&text.replace("\"world\"", "\"World\""));
    assert_eq!(other.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [Code::UnknownLink; 2], "{other}");
    let second = text.replace("<link name=\"lamp\"/>", "<link name=\"lamp\"/><link name=\"stray\"/>");
    assert_eq!(corpus::only_error(&second).code, Code::SeveralRoots);
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
    assert_eq!(helical.limit, Some(Limit { lower: -9.0, upper: 9.0, effort: 1.0, velocity: 2.0, ..Limit::NONE }));
    let universal = joint(&slew("universal", "<axis xyz='0 0 3'/><axis2 xyz='1 0 1'/>"), "slew");
    assert_eq!((universal.kind, universal.axis, universal.second_axis), (JointKind::Universal, [0.0, 0.0, 3.0], [1.0, 0.0, 1.0]));
    assert_eq!((universal.pitch, helical.second_axis), (0.0, [0.0; 3]));
}

#[test]
fn a_helical_joint_leads_and_follows() {
    let text = slew("helical", "<thread pitch='0.01'/><limit effort='1' velocity='1' lower='-1' upper='1'/><mimic joint='travel'/>")
        .replace("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"slew\"/>");
    let crane = described(&text);
    assert_eq!([0, 2].map(|i| crane.joints[JointId(i)].mimic.unwrap().joint), [JointId(1), JointId(0)]);
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
    let kinds: Vec<Code> = accepted(&slew("helical", "<thread pitch='0'/>")).warnings.iter().map(|w| w.code).collect();
    assert_eq!(kinds, [Code::ZeroPitch, Code::LimitMissing]);
}

#[test]
fn limits_that_are_left_open_are_infinite() {
    let text = crane("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/><limit lower=\"-1\" effort=\"9\" velocity=\"2\"/>");
    let reading = accepted(&text);
    let limit = reading.description.joints[JointId(0)].limit.unwrap();
    assert_eq!(limit, Limit { lower: f64::NEG_INFINITY, upper: f64::INFINITY, effort: 9.0, velocity: 2.0, ..Limit::NONE });
    assert!(reading.unused.iter().any(|u| u.tag == "limit lower" && u.line == Some(23)));
    assert!(reading.warnings.is_empty());
    let open = CRANE.replace("<robot ", "<robot version=\"1.2\" ").replace("lower=\"0\" upper=\"3\" effort=\"100\"", "");
    let travel = joint(&open, "travel").limit.unwrap();
    assert_eq!((travel.lower, travel.upper, travel.effort), (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY));
}

/// As the format defines it before version 1.2; from then on, a missing bound is valid.
#[test]
fn bounds_that_are_left_out_are_zero_before_version_1_2_and_open_from_then_on() {
    let travel = |version: &str, given: &str| {
        let text = crane("lower=\"0\" upper=\"3\" effort=\"100\" velocity=\"0.5\"", given);
        let reading = accepted(&text.replace("<robot ", &format!("<robot version='{version}' ")));
        let limit = reading.description.joints[JointId(1)].limit.unwrap();
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
        assert_eq!(
            swing.dynamics,
            JointDynamics { damping: Some(damping), friction: Some(friction), ..JointDynamics::default() },
            "{given}"
        );
    }
}

#[test]
fn mimics_have_defaults_and_chains() {
    let text = crane("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\"/>")
        .replace("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"1 0 0\"/><mimic joint=\"slew\" multiplier=\"-2\" offset=\".5\"/>");
    let crane = described(&text);
    assert_eq!(crane.joints[JointId(2)].mimic, Some(Mimic::linear(JointId(1), 1.0, 0.0)));
    assert_eq!(crane.joints[JointId(1)].mimic, Some(Mimic::linear(JointId(0), -2.0, 0.5)));
}

#[test]
fn angles_snap_only_where_that_is_asked_for() {
    let text = crane("rpy=\"0 0 0\"", "rpy=\"1.5708 0 -3.1416\"");
    let plain = accepted(&text);
    assert!(plain.snapped.is_empty());
    assert_eq!(plain.description.joints[JointId(0)].origin.rotation.rpy()[0].to_string(), "1.5708");
    let snapping = Options { snap_angles: Some(1e-5), ..options() };
    let reading = read(text.as_bytes(), &snapping).unwrap();
    assert_eq!(reading.description.joints[JointId(0)].origin.rotation.rpy(), [FRAC_PI_2, 0.0, -2.0 * FRAC_PI_2]);
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
    assert_eq!(corpus::only_error(&leaning("3e-7")).code, Code::ParallelAxes);
    let askew = |second: &str| slew("universal", &format!("<axis xyz='1 2 3'/><axis2 xyz='{second}'/>"));
    assert_eq!(corpus::only_error(&askew("-2 -4 -6")).code, Code::ParallelAxes);
    for second in ["3 2 1", "-2 -4 6", "-2 4 -6", "2 -4 -6", "-2 -4 -6.001"] {
        accepted(&askew(second));
    }
}
