//! Each error alone: its kind, its line, its subject; and all errors of a file together.

mod corpus;

use articulated_core::description::{JointId, LinkId};
use articulated_core::diagnostic::{Code, Subject};
use articulated_formats::{MOST_SNAPPED, Options, read};
use corpus::{CRANE, as_kept, crane, only_error, options, refused, refused_bytes};

/// One error: the replaced text and its replacement; the kind and line of the error; words of the
/// message.
type Mistake = (&'static str, &'static str, Code, u32, &'static [&'static str]);

const MISTAKES: &[Mistake] = &[
    // Names.
    ("<robot name=\"crane\">", "<robot>", Code::MissingAttribute, 2, &["name"]),
    ("<robot name=\"crane\">", "<robot name=\" \">", Code::EmptyName, 2, &["name", "empty"]),
    ("<link name=\"hook\"/>", "<link name=\"hook\"/><link/>", Code::MissingAttribute, 17, &["name"]),
    ("<link name=\"hook\"/>", "<link name=\"hook\"/><link name=\"\"/>", Code::EmptyName, 17, &["empty"]),
    ("<link name=\"lamp\"/>", "<link name=\"lamp\"/><link name=\"boom\"/>", Code::DuplicateName, 18, &["boom", "already", "line 4"]),
    ("name=\"travel\"", "name=\"slew\"", Code::DuplicateName, 25, &["slew", "duplicate", "line 19"]),
    ("name=\"travel\"", "", Code::MissingAttribute, 25, &["name"]),
    // Numbers.
    ("value=\"40\"", "value=\"nan\"", Code::NotFinite, 7, &["boom", "mass value", "nan", "finite"]),
    ("value=\"40\"", "value=\"1e999\"", Code::NotFinite, 7, &["boom", "1e999"]),
    ("value=\"40\"", "value=\"1e-999\"", Code::NotFinite, 7, &["boom", "too small"]),
    ("value=\"40\"", "value=\"0x1p3\"", Code::NotANumber, 7, &["boom", "0x1p3", "number"]),
    ("value=\"40\"", "value=\"40 kg\"", Code::NotANumber, 7, &["boom", "kg"]),
    ("value=\"40\"", "value=\"\"", Code::WrongCount, 7, &["boom", "one number"]),
    ("value=\"40\"", "value=\"4 0\"", Code::WrongCount, 7, &["boom", "2 numbers"]),
    ("ixx=\"2\"", "ixx=\"2,5\"", Code::NotANumber, 8, &["boom", "inertia ixx", "2,5"]),
    ("0 0 12", "0 0 12abc", Code::NotANumber, 22, &["slew", "12abc"]),
    ("0 0 12", "0 12", Code::WrongCount, 22, &["slew", "three numbers"]),
    ("0 0 12", "0 0 12 0", Code::WrongCount, 22, &["slew", "4 numbers"]),
    ("0 1 0", "0 inf 0", Code::NotFinite, 34, &["swing", "axis xyz"]),
    ("upper=\"3\"", "upper=\"three\"", Code::NotANumber, 29, &["travel", "limit upper"]),
    ("damping=\"0.5\"", "damping=\"-\"", Code::NotANumber, 36, &["swing", "dynamics damping"]),
    ("\"0 0.1 0\"", "\"0 0.1 0\" quat_xyzw=\"0 0 0 1\"", Code::Unsupported, 6, &["boom", "rpy", "<robot version=\"1.1\">"]),
    // Mass.
    ("value=\"40\"", "value=\"-40\"", Code::NegativeMass, 5, &["boom", "negative", "mass"]),
    ("<mass value=\"40\"/>", "", Code::MissingTag, 5, &["boom", "<mass>"]),
    ("<mass value=\"40\"/>", "<density value=\"1000\"/>", Code::MissingTag, 7, &["boom", "<density> is an extension", "<inertia>"]),
    ("<mass value=\"40\"/>", "<mass>40</mass>", Code::MissingAttribute, 7, &["boom", "value"]),
    ("izz=\"31\"", "", Code::MissingAttribute, 8, &["boom", "izz"]),
    (
        "izz=\"31\"",
        "izz=\"-31\"",
        Code::InertiaNotPositive,
        5,
        &["boom", "inertia", "positive", "`--allow-unphysical-inertia`", "`allow_unphysical_inertia`", "Build::"],
    ),
    ("ixy=\"0.1\"", "ixy=\"20\"", Code::InertiaNotPositive, 5, &["boom", "inertia", "positive"]),
    ("<mass value=\"40\"/>", "<mass value=\"40\"/><mass value=\"4\"/>", Code::DuplicateTag, 7, &["boom", "second <mass>"]),
    ("<mass value=\"5\"/>", "<mass value=\"5\"/><origin/><origin xyz=\"1 0 0\"/>", Code::DuplicateTag, 13, &["trolley", "second <origin>"]),
    ("izz=\"0.1\"/>\n    </inertial>", "izz=\"0.1\"/></inertial>\n<inertial/>", Code::DuplicateTag, 15, &["trolley", "second <inertial>"]),
    // Joints.
    ("type=\"continuous\"", "", Code::MissingAttribute, 19, &["slew", "type"]),
    ("type=\"continuous\"", "type=\"continous\"", Code::UnknownJointType, 19, &["slew", "type", "continous", "mean \"continuous\""]),
    ("type=\"continuous\"", "type=\"Continuous\"", Code::UnknownJointType, 19, &["slew", "type"]),
    (
        "type=\"continuous\"",
        "type=\"ball\"",
        Code::UnknownJointType,
        19,
        &["slew", "ball", "spherical, helical or universal", "mean \"spherical\""],
    ),
    ("type=\"continuous\"", "type=\"Hinge\"", Code::UnknownJointType, 19, &["slew", "Hinge", "mean \"revolute\""]),
    ("type=\"continuous\"", "type=\"sperical\"", Code::UnknownJointType, 19, &["slew", "sperical", "mean \"spherical\""]),
    ("type=\"continuous\"", "type=\"helicall\"", Code::UnknownJointType, 19, &["slew", "mean \"helical\""]),
    // Extensions.
    ("type=\"continuous\"", "type=\"universal\"", Code::MissingTag, 19, &["slew", "<axis2>"]),
    ("0 0 1\"", "0 -0 0.0\"", Code::ZeroAxis, 23, &["slew", "axis", "zero"]),
    ("0 0 1\"", "0 1e-200 0\"", Code::ZeroAxis, 23, &["slew", "axis"]),
    ("0 0 1\"", "0 1e200 0\"", Code::ZeroAxis, 23, &["slew", "axis", "can be squared"]),
    ("<axis xyz=\"0 0 1\"/>", "<axis/>", Code::MissingAttribute, 23, &["slew", "xyz"]),
    ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/><axis xyz=\"0 0 2\"/>", Code::DuplicateTag, 23, &["slew", "<axis>"]),
    ("<child link=\"lamp\"/>", "<child/>", Code::MissingAttribute, 40, &["mount", "link"]),
    ("<child link=\"lamp\"/>", "<child link=\"\"/>", Code::EmptyName, 40, &["mount", "empty"]),
    ("<child link=\"lamp\"/>", "", Code::MissingTag, 38, &["mount", "<child>"]),
    ("<child link=\"lamp\"/>", "<child link=\"lamp\"/><child link=\"hook\"/>", Code::DuplicateTag, 40, &["mount", "<child>"]),
    // The tree.
    ("<parent link=\"boom\"/>", "<parent link=\"bom\"/>", Code::UnknownLink, 26, &["travel", "\"bom\"", "mean \"boom\""]),
    ("<child link=\"hook\"/>", "<child link=\"crook\"/>", Code::UnknownLink, 33, &["swing", "\"crook\"", "not"]),
    ("<child link=\"lamp\"/>", "<child link=\"mast\"/>", Code::UnknownLink, 40, &["mount", "\"mast\"", "not"]),
    ("<link name=\"lamp\"/>", "<link name=\"lamp\"/><link name=\"stray\"/>", Code::SeveralRoots, 18, &["stray", "tower", "root"]),
    // Mimics.
    ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"swing\"/>", Code::MimicRing, 34, &["swing", "mimic", "itself"]),
    (
        "<axis xyz=\"0 1 0\"/>",
        "<axis xyz=\"0 1 0\"/><mimic joint=\"slow\"/>",
        Code::UnknownLeader,
        34,
        &["swing", "\"slow\"", "mean \"slew\""],
    ),
    ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"mount\"/>", Code::LeaderCannotLead, 34, &["swing", "\"mount\""]),
    ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic/>", Code::MissingAttribute, 34, &["swing", "joint"]),
    ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"slew\" offset=\"x\"/>", Code::NotANumber, 34, &["swing", "offset"]),
    // The document.
    ("<robot name=\"crane\">", "<!DOCTYPE robot [<!ENTITY a \"b\">]><robot name=\"&a;\">", Code::Doctype, 2, &["DOCTYPE"]),
    ("name=\"crane\"", "name=\"&crane;\"", Code::Xml, 2, &["XML"]),
    ("</robot>", "", Code::Xml, 43, &["XML"]),
    ("<child link=\"lamp\"/>", "<child link=\"lamp\">", Code::Xml, 41, &["XML", "child"]),
    ("value=\"40\"", "value=\"40\" value=\"41\"", Code::Xml, 7, &["XML", "value"]),
    ("value=\"40\"", "value=\"${mass}\"", Code::Xacro, 7, &["link \"boom\": mass value:", "xacro", "${mass}"]),
    ("type=\"continuous\"", "type=\"$(arg type)\"", Code::Xacro, 19, &["joint \"slew\": joint type:"]),
    ("<child link=\"lamp\"/>", "<child link=\"${lamp}\"/>", Code::Xacro, 40, &["joint \"mount\": child link:"]),
    ("value=\"40\"", "value=\"$(arg mass)\"", Code::Xacro, 7, &["xacro"]),
    ("<link name=\"lamp\"/>", "<xacro:lamp/>", Code::Xacro, 18, &["xacro:lamp", "which is no macro"]),
];

#[test]
fn each_mistake_is_one_error_with_its_line_and_names() {
    let mut messages = Vec::new();
    for (from, to, kind, line, words) in MISTAKES {
        let error = only_error(&crane(from, to));
        let message = error.to_string();
        assert_eq!((error.code, error.line()), (*kind, Some(*line)), "{message}");
        assert!(message.starts_with(&format!("crane.urdf:{line}: ")), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}\n{words:?}");
        assert!(!message.contains('\n'), "{message}");
        messages.push(message);
    }
    as_kept("mistakes.txt", &messages);
}

#[test]
fn all_mistakes_of_a_file_are_reported_at_once() {
    let text = crane("value=\"40\"", "value=\"-40\"")
        .replace("0 0 12", "0 0 x")
        .replace("<parent link=\"boom\"/>", "<parent link=\"bom\"/>")
        .replace("xyz=\"0 1 0\"", "xyz=\"0 0 0\"");
    let problems = refused(&text);
    let kinds: Vec<Code> = problems.errors.iter().map(|e| e.code).collect();
    assert_eq!(kinds, [Code::NegativeMass, Code::NotANumber, Code::ZeroAxis, Code::UnknownLink]);
    assert_eq!(problems.to_string().lines().count(), 4);
}

/// A missing tag does not hide an invalid number.
#[test]
fn half_an_inertial_is_looked_at_too() {
    let kinds = |from: &str, to: &str, and: (&str, &str)| {
        let text = crane(from, to).replace(and.0, and.1);
        let kinds: Vec<Code> = refused(&text).errors.iter().map(|e| e.code).collect();
        assert_eq!(kinds.len(), 2, "{kinds:?}");
        kinds
    };
    let without_moments = kinds("<mass value=\"40\"/>", "<mass value=\"-40\"/>", ("izz=\"31\"", ""));
    assert!([Code::NegativeMass, Code::MissingAttribute].iter().all(|kind| without_moments.contains(kind)), "{without_moments:?}");
    let without_mass = kinds("<mass value=\"40\"/>", "", ("izz=\"31\"", "izz=\"-31\""));
    assert!([Code::InertiaNotPositive, Code::MissingTag].iter().all(|kind| without_mass.contains(kind)), "{without_mass:?}");
}

#[test]
fn a_joint_of_an_unknown_type_is_read_on() {
    let text = crane("type=\"continuous\"", "type=\"continous\"")
        .replace("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/><dynamics damping=\"x\"/>");
    let kinds: Vec<Code> = refused(&text).errors.iter().map(|e| e.code).collect();
    for kind in [Code::UnknownJointType, Code::ZeroAxis, Code::NotANumber] {
        assert!(kinds.contains(&kind), "{kind:?} among {kinds:?}");
    }
}

#[test]
fn of_very_many_roots_the_first_are_named_and_the_rest_counted() {
    let strays: String = (0..13).map(|k| format!("<link name='stray{k}'/>")).collect();
    let error = only_error(&crane("<link name=\"lamp\"/>", &format!("<link name=\"lamp\"/>{strays}")));
    assert_eq!(error.code, Code::SeveralRoots);
    assert!(error.found.starts_with("14 roots") && error.found.ends_with("link \"stray10\" and 2 more"), "{error}");
}

/// The example of other programs' joints: without the ignored joint, the file would not have two
/// roots.
#[test]
fn joints_of_other_programs_are_named_where_links_hang_on_nothing() {
    let text = crane("<link name=\"lamp\"/>", "<link name=\"lamp\"/><link name=\"ball\"/>")
        .replace("</robot>", "<b:joint name='swivel' type='ball'><parent link='hook'/><child link='ball'/></b:joint></robot>");
    let problems = refused(&text);
    assert_eq!(problems.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [Code::SeveralRoots], "{problems}");
    let message = problems.errors[0].to_string();
    assert!(message.contains("one root; <b:joint> \"swivel\" in line 42 is not read: write it as <joint>"), "{message}");
    let two = text.replace("</robot>", "<a:joint><parent link='hook'/><child link='ball'/></a:joint></robot>");
    let message = refused(&two).errors[0].to_string();
    assert!(message.contains("<b:joint> \"swivel\" in line 42, <a:joint> in line 42 are not read"), "{message}");
}

#[test]
fn all_expressions_of_xacro_are_listed_with_the_other_mistakes() {
    let text = crane("0 0 12\" rpy=\"0 0 0\"", "0 0 $(env Z)\" rpy=\"$(arg r) 0 0\"")
        .replace("value=\"40\"", "value=\"${m}\"")
        .replace("iyy=\"30\"", "iyy=\"bad\"");
    let problems = refused(&text);
    let fields: Vec<String> = problems.errors.iter().map(|e| format!("{} {}", e.subject, e.field)).collect();
    let expected = ["link \"boom\" mass value", "joint \"slew\" origin xyz", "joint \"slew\" origin rpy", "link \"boom\" inertia iyy"];
    assert_eq!(fields, expected, "{problems}");
    assert_eq!(problems.errors.iter().filter(|e| e.code == Code::Xacro).count(), 3);
}

/// A norm of 1 within a thousandth; one rotation; a version that has quaternions.
#[test]
fn quaternions_that_are_wrong_are_refused() {
    let turned = |version: &str, attributes: &str| {
        let text = crane("xyz=\"0 0 12\" rpy=\"0 0 0\"", attributes).replace("<robot ", &format!("<robot version='{version}' "));
        only_error(&text).code
    };
    let unit = "quat_xyzw='0 0 0 1'";
    assert_eq!(turned("1.0", unit), Code::Unsupported);
    assert_eq!(turned("1.1", &format!("{unit} rpy='0 0 0'")), Code::TwoRotations);
    for text in ["0 0 0 0", "0 0 0 1.0011", "0 0 0 0.9989", "1e200 0 0 1", "0.5 0.5 0.5 0"] {
        assert_eq!(turned("1.1", &format!("quat_xyzw='{text}'")), Code::QuaternionNorm, "{text}");
    }
    assert_eq!(turned("1.2", "quat_xyzw='0 0 1'"), Code::WrongCount);
    assert_eq!(turned("1.1", "quat_xyzw='0 0 0 nan'"), Code::NotFinite);
}

#[test]
fn a_ring_beside_the_tree_is_named() {
    let text = crane("<link name=\"lamp\"/>", "<link name=\"lamp\"/><link name=\"a\"/><link name=\"b\"/>").replace(
        "</robot>",
        "<joint name='ab' type='fixed'><parent link='a'/><child link='b'/></joint>
         <joint name='ba' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
    );
    let error = only_error(&text);
    assert_eq!(error.code, Code::Ring);
    assert!(error.found.contains("\"ab\"") && error.found.contains("\"ba\""), "{error}");
}

/// The number of roots is found once the ring is removed.
#[test]
fn a_ring_beside_two_roots_is_the_one_error() {
    let links: String = ["one", "two", "a", "b"].map(|name| format!("<link name='{name}'/>")).concat();
    let joint = |[parent, child]: [&str; 2]| {
        format!("<joint name='{parent}{child}' type='fixed'><parent link='{parent}'/><child link='{child}'/></joint>")
    };
    let error = only_error(&format!("<robot name='r'>{links}{}</robot>", [["a", "b"], ["b", "a"]].map(joint).concat()));
    assert_eq!(error.code, Code::Ring, "{error}");
}

#[test]
fn a_robot_that_is_a_ring_has_no_root() {
    let error =
        only_error("<robot name='r'><link name='a'/><joint name='aa' type='fixed'><parent link='a'/><child link='a'/></joint></robot>");
    assert_eq!((error.code, error.subject), (Code::Ring, Subject::Link("a".to_owned())));
}

#[test]
fn a_link_with_two_parents_is_named_with_both_joints() {
    let joint = "<joint name='again' type='fixed'><parent link='tower'/><child link='hook'/></joint></robot>";
    let error = only_error(&crane("</robot>", joint));
    assert_eq!(error.code, Code::TwoParents);
    let message = error.to_string();
    assert!(["\"hook\"", "\"swing\"", "\"again\""].iter().all(|name| message.contains(name)), "{message}");
}

/// A follower with an unread law would be another mechanism.
#[test]
fn what_may_change_the_law_of_a_follower_is_an_error_that_names_joint_and_attribute() {
    let with = |mimic: &str| crane("<axis xyz=\"0 1 0\"/>", &format!("<axis xyz=\"0 1 0\"/>\n{mimic}"));
    let wrong = [
        ("<mimic joint='slew' cubic='-0.2'/>", Code::Unknown, "mimic cubic: found the attribute cubic = \"-0.2\""),
        ("<mimic joint='slew' law='sine'/>", Code::Unknown, "mimic law: found the attribute law = \"sine\""),
        ("<mimic joint='slew' a:gain='1e-3'/>", Code::Unknown, "mimic a:gain: found the attribute a:gain = \"1e-3\""),
        (
            "<mimic joint='slew' multiplyer='0'/>",
            Code::Misspelt,
            "multiplyer = \"0\", expected the attributes joint, multiplier and offset (did you mean \"multiplier\"?)",
        ),
        ("<mimic joint='slew'><multiplier>2</multiplier></mimic>", Code::Misspelt, "mimic multiplier: found the tag <multiplier>"),
        ("<mimic joint='slew'><poly c='1 2'/></mimic>", Code::Unknown, "mimic poly: found the tag <poly>"),
    ];
    for (mimic, code, words) in wrong {
        let error = only_error(&with(mimic));
        assert_eq!((error.code, error.line()), (code, Some(35)), "{error}");
        assert!(error.to_string().contains("joint \"swing\": ") && error.to_string().contains(words), "{error}");
        assert!(error.to_string().contains("q = multiplier · q of the joint + offset is the one law that is read"), "{error}");
    }
    // All of them at once, and an error in an attribute of the format.
    let all = refused(&with("<mimic joint='slew' quadratic='3' cubic='4' offset='x'/>"));
    assert_eq!(all.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [Code::Unknown, Code::Unknown, Code::NotANumber]);
    // Content that does not concern the law is a warning.
    for mimic in [
        "<mimic joint='slew' name='m' quadratic='0' smooth='false' unit=''/>",
        "<mimic joint='slew' a:comment='' xmlns:a='b'><note/></mimic>",
    ] {
        let reading = read(with(mimic).as_bytes(), &options()).unwrap();
        assert!(
            reading.warnings.iter().all(|w| w.code == Code::Unknown) && reading.description.joints[JointId(2)].mimic.is_some(),
            "{:?}",
            reading.warnings
        );
    }
}

#[test]
fn two_laws_for_one_leader_are_an_error() {
    let twice = |again: &str| {
        let tags = format!("<axis xyz=\"0 1 0\"/>\n<mimic joint='slew' multiplier='2'/><mimic joint='travel'/>\n{again}");
        crane("<axis xyz=\"0 1 0\"/>", &tags)
    };
    let found = "joint \"swing\": mimic: found a second <mimic> of joint \"slew\" (the first is in line 35)";
    let error = only_error(&twice("<mimic joint='slew' multiplier='3'/>"));
    assert_eq!((error.code, error.line()), (Code::DuplicateTag, Some(36)));
    assert!(error.to_string().contains(found) && error.expected.contains("`--first-of-duplicates`"), "{error}");
    assert!(
        only_error(&twice("<drake:mimic joint='slew' multiplier='3'/>")).to_string().contains("a second <drake:mimic> of joint \"slew\"")
    );
    // The first one, if requested; and one with the same content.
    let first = Options { first_of_duplicates: true, ..options() };
    for (again, options) in [("<mimic joint='slew' multiplier='3'/>", first), ("<mimic multiplier='2' joint='slew'/>", options())] {
        let reading = read(twice(again).as_bytes(), &options).unwrap();
        let swing = &reading.description.joints[JointId(2)];
        let laws: Vec<_> = swing.mimic.iter().chain(&swing.also).map(|law| (law.joint, law.multiplier)).collect();
        assert_eq!(laws, [(JointId(0), 2.0), (JointId(1), 1.0)]);
        assert_eq!(reading.warnings.iter().map(|w| w.code).collect::<Vec<_>>(), [Code::DuplicateTag]);
    }
}

#[test]
fn a_ring_of_mimics_is_one_error() {
    let text = crane("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"travel\"/>")
        .replace("<axis xyz=\"1 0 0\"/>", "<axis xyz=\"1 0 0\"/><mimic joint=\"swing\"/>");
    let error = only_error(&text);
    assert_eq!(error.code, Code::MimicRing);
    assert!(error.found.contains("travel") && error.found.contains("swing"), "{error}");
}

#[test]
fn leaders_with_several_coordinates_are_refused() {
    for kind in ["floating", "planar", "spherical"] {
        let text = crane("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"slew\"/>");
        let error = only_error(&text.replace("\"continuous\"", &format!("\"{kind}\"")));
        assert_eq!(error.code, Code::LeaderCannotLead, "{kind}");
    }
}

/// The crane with a universal or helical slew: the replacement of its axis; the kind and line of
/// the error; words of the message.
type Special = (&'static str, &'static str, Code, u32, &'static [&'static str]);

const SPECIALS: &[Special] = &[
    ("universal", "<axis2 xyz='0 1 0'/>", Code::MissingTag, 19, &["slew", "<axis>"]),
    ("universal", "<axis xyz='1 0 0'/><axis2 xyz='0 0 0'/>", Code::ZeroAxis, 23, &["slew", "axis2", "not zero"]),
    ("universal", "<axis xyz='1 0 0'/><axis2/>", Code::MissingAttribute, 23, &["slew", "xyz", "<axis2>"]),
    ("universal", "<axis xyz='1 0 0'/><axis2 xyz='0 1'/>", Code::WrongCount, 23, &["slew", "axis2 xyz", "three"]),
    ("universal", "<axis xyz='1 2 0'/><axis2 xyz='-3 -6 0'/>", Code::ParallelAxes, 19, &["slew", "axis2", "(-3.0 -6.0 0.0)", "across"]),
    ("universal", "<axis xyz='1e-120 0 0'/><axis2 xyz='1e120 1e110 0'/>", Code::ParallelAxes, 19, &["slew", "axis2"]),
    ("universal", "<axis xyz='1 0 0'/><axis2 xyz='0 1 0'/><axis2 xyz='0 1 1'/>", Code::DuplicateTag, 23, &["slew", "second <axis2>"]),
    ("helical", "<axis xyz='0 0 1'/>", Code::MissingTag, 19, &["slew", "<thread>"]),
    ("helical", "<thread/>", Code::MissingAttribute, 23, &["slew", "pitch", "<thread>"]),
    ("helical", "<thread pitch='inf'/>", Code::NotFinite, 23, &["slew", "thread pitch", "inf"]),
    ("helical", "<thread pitch='5 mm'/>", Code::NotANumber, 23, &["slew", "thread pitch", "mm"]),
];

#[test]
fn each_mistake_in_an_extension_is_one_error() {
    let mut messages = Vec::new();
    for (name, axes, kind, line, words) in SPECIALS {
        let text = crane("<axis xyz=\"0 0 1\"/>", axes).replace("\"continuous\"", &format!("\"{name}\""));
        let error = only_error(&text);
        let message = error.to_string();
        assert_eq!((error.code, error.line()), (*kind, Some(*line)), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}\n{words:?}");
        messages.push(message);
    }
    as_kept("special_mistakes.txt", &messages);
}

#[test]
fn a_joint_with_several_coordinates_follows_none() {
    for (name, axes) in [("spherical", ""), ("planar", ""), ("universal", "<axis xyz='1 0 0'/><axis2 xyz='0 1 0'/>")] {
        let text = crane("<axis xyz=\"0 0 1\"/>", &format!("{axes}<mimic joint='swing'/>"));
        let error = only_error(&text.replace("\"continuous\"", &format!("\"{name}\"")));
        assert_eq!(error.code, Code::FollowerCannotFollow, "{name}");
    }
}

#[test]
fn documents_that_are_no_robots_are_refused() {
    let cases: &[(&[u8], Code)] = &[
        (b"", Code::Xml),
        (b"   \n", Code::Xml),
        (b"robot", Code::Xml),
        (b"<robot name='r'/>", Code::NoLinks),
        (b"<robot name='r'></robot>", Code::NoLinks),
        (b"<crane><link name='l'/></crane>", Code::NotARobot),
        (b"<Robot name='r'><link name='l'/></Robot>", Code::NotARobot),
        (b"<robot name='r'><link name='\xe9'/></robot>", Code::NotUtf8),
        (b"\xff\xfe<\0r\0/\0>\0", Code::NotUtf8),
        (b"<robot name='r'><link name='l'/></robot><robot/>", Code::Xml),
        (b"<robot name='r'><gazebo><link name='l'/></gazebo></robot>", Code::NoLinks),
        (b"<robot name='r'><!-- <link name='l'/> --></robot>", Code::NoLinks),
        (b"<!DOCTYPE robot SYSTEM 'other.dtd'><robot name='r'><link name='l'/></robot>", Code::Doctype),
    ];
    let mut messages = Vec::new();
    for (bytes, kind) in cases {
        let problems = refused_bytes(bytes);
        assert_eq!(problems.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [*kind], "{problems}");
        assert!(problems.errors[0].line().is_some(), "{problems}");
        messages.push(problems.errors[0].to_string());
    }
    as_kept("no_robots.txt", &messages);
}

#[test]
fn an_inertia_may_be_unphysical_where_that_is_asked_for() {
    let text = crane("izz=\"31\"", "izz=\"-31\"");
    let options = Options { allow_unphysical_inertia: true, ..options() };
    let reading = read(text.as_bytes(), &options).unwrap();
    assert_eq!(reading.warnings.len(), 1);
    assert_eq!(reading.warnings[0].code, Code::InertiaNotPositive);
    assert_eq!(reading.description.links[LinkId(1)].inertial.unwrap().inertia[5], -31.0);
}

/// Changes of a later version are unknown.
#[test]
fn another_version_is_an_error_unless_it_is_allowed() {
    for version in ["7", "1.3", "1.0.0", "0.9", ""] {
        let text = crane("<robot ", &format!("<robot version=\"{version}\" "));
        let error = only_error(&text);
        assert_eq!((error.code, error.line()), (Code::Version, Some(2)));
        let (found, option) =
            (format!("version: found the version \"{version}\", expected 1.0, 1.1 or 1.2; "), "`--allow-unknown-version` (key");
        assert!(error.to_string().contains(&(found.clone() + option)), "{error}");
        let allowed = Options { allow_unknown_version: true, ..options() };
        let reading = read(text.as_bytes(), &allowed).unwrap();
        assert_eq!(reading.description, corpus::described(CRANE));
        assert!(
            reading.warnings.len() == 1 && reading.warnings[0].to_string().contains(&(found + "read as 1.0")),
            "{:?}",
            reading.warnings
        );
    }
    for version in ["1", "1.0", "1.1", "1.2", " 1.2 "] {
        assert!(read(crane("<robot ", &format!("<robot version=\"{version}\" ")).as_bytes(), &options()).is_ok(), "{version}");
    }
}

#[test]
fn the_first_of_tags_that_contradict_each_other_counts_where_that_is_asked_for() {
    let text = crane("<mass value=\"40\"/>", "<mass value=\"40\"/><mass value=\"4\"/>");
    let told = read(text.as_bytes(), &options()).unwrap_err();
    assert_eq!(told.errors.len(), 1);
    assert!(told.errors[0].expected.contains("`--first-of-duplicates` (key `first_of_duplicates`"), "{}", told.errors[0]);
    let reading = read(text.as_bytes(), &Options { first_of_duplicates: true, ..options() }).unwrap();
    assert_eq!(reading.warnings.iter().filter(|w| w.code == Code::DuplicateTag && w.expected.ends_with("the first is used")).count(), 1);
    assert_eq!(reading.description.links[LinkId(1)].inertial.unwrap().mass, 40.0);
}

#[test]
fn a_tolerance_of_angles_that_cannot_be_is_told_with_the_rest() {
    for (tolerance, found) in [(0.0, "0"), (-1e-9, "-0.000000001"), (0.6, "0.6"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let asked = Options { snap_angles: Some(tolerance), ..options() };
        let error = read(CRANE.as_bytes(), &asked).unwrap_err().to_string();
        let expected = "expected a finite number above 0, at most 0.5 rad; leave it out to snap none";
        assert_eq!(error, format!("crane.urdf: snap_angles: found {found}, {expected}"));
        let problems = read(crane("0 0 12", "0 0 x").as_bytes(), &asked).unwrap_err();
        assert_eq!(problems.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [Code::SnapAngles, Code::NotANumber]);
    }
    assert!([1e-300, MOST_SNAPPED].into_iter().all(|x| read(CRANE.as_bytes(), &Options { snap_angles: Some(x), ..options() }).is_ok()));
}

#[test]
fn warnings_come_with_the_errors() {
    let text = crane("value=\"5\"", "value=\"0\"").replace("0 0 12", "0 0 x");
    let problems = refused(&text);
    assert_eq!((problems.errors.len(), problems.warnings.len()), (1, 1));
    assert!(problems.warnings[0].to_string().starts_with("crane.urdf:12: link \"trolley\""));
}

#[test]
fn a_message_stays_on_one_line_and_short() {
    let long = format!("<link name=\"boom&#10;{}\">", "x".repeat(10_000));
    let message = refused(&crane("<link name=\"boom\">", &long).replace("value=\"40\"", "value=\"-40\"")).errors[0].to_string();
    assert!(message.len() < 500 && !message.contains('\n'), "{message}");
}

#[test]
fn an_attribute_is_in_the_line_where_it_is_written() {
    for (from, to, kind) in [
        ("type=\"continuous\"", "\n\ntype=\"continous\"", Code::UnknownJointType),
        ("<joint name=\"slew\"", "<joint\n\nname=\"\"", Code::EmptyName),
    ] {
        let error = only_error(&crane(from, to));
        assert_eq!((error.code, error.line()), (kind, Some(21)), "{error}");
    }
}

#[test]
fn a_name_may_be_as_long_as_this_and_no_longer() {
    let named = |length: usize| crane("<link name=\"lamp\"/>", &format!("<link name=\"lamp\"/><link\nname=\"{}\"/>", "x".repeat(length)));
    assert_eq!(only_error(&named(1024)).code, Code::SeveralRoots);
    let error = only_error(&named(1025));
    assert_eq!((error.code, error.line()), (Code::TooLarge, Some(19)), "{error}");
    assert!(error.to_string().contains("1025 bytes"), "{error}");
}

#[test]
fn very_many_warnings_are_counted() {
    let tag = "<link name='lamp'><inertial><mass value='0'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>";
    let links: String = (0..1003).map(|k| tag.replace("lamp", &format!("lamp{k}"))).collect();
    let joints: String = (0..1003)
        .map(|k| format!("<joint name='mount{k}' type='continuous'><parent link='boom'/><child link='lamp{k}'/></joint>"))
        .collect();
    let warnings = corpus::accepted(&crane("</robot>", &format!("{links}{joints}</robot>"))).warnings;
    assert_eq!((warnings.len(), warnings[1000].code), (1001, Code::More));
    assert!(warnings[1000].to_string().contains("3 more that"), "{}", warnings[1000]);
}

#[test]
fn very_many_errors_are_counted() {
    let joints = "<joint name='j' type='?'><parent link='x'/><child link='y'/></joint>".repeat(2000);
    let problems = refused(&crane("</robot>", &format!("{joints}</robot>")));
    assert_eq!(problems.errors.len(), 1001);
    assert_eq!(problems.errors[1000].code, Code::More);
}

#[test]
fn the_sound_robot_is_sound() {
    assert!(corpus::accepted(CRANE).warnings.is_empty());
}
