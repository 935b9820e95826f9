//! Shapes of links: valid ones are read. Invalid collision geometry is a warning, and appearance
//! has no effect on the dynamics.

mod corpus;

use std::f64::consts::FRAC_PI_2;

use articulated_core::description::{Collision, CollisionShape, Hull, LinkId, Origin};
use articulated_core::diagnostic::{Code, Subject};
use articulated_formats::{Reading, read};
use corpus::{CRANE, accepted, crane, described, options};

/// The crane, with this in its hook.
fn hook(content: &str) -> Reading {
    accepted(&crane("<link name=\"hook\"/>", &format!("<link name=\"hook\">\n{content}</link>")))
}

fn of_hook(reading: &Reading) -> &[Collision] {
    &reading.description.links[LinkId(3)].collision
}

fn geometry(shape: &str) -> String {
    format!("<collision><geometry>{shape}</geometry></collision>")
}

#[test]
fn shapes_are_read_with_their_places_in_the_order_of_the_file() {
    let text =
        "<collision name='ball'><origin xyz='1 2 3' rpy='0 1.5707963267948966 0'/><geometry><sphere radius='0.25'/></geometry></collision>
        <collision><geometry><box size='1 2.5 0'/></geometry></collision>
        <collision><geometry><cylinder length='2' radius='0.5'/></geometry><origin xyz='0 0 -1'/></collision>
        <collision><geometry><capsule radius='0.1' length='3'/></geometry></collision>
        <collision><geometry><mesh filename='package://crane/hook.stl' scale='1 2 0.001'/></geometry></collision>
        <collision><geometry><drake:capsule radius='0.2' length='4'/></geometry></collision>";
    let reading = hook(text);
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let at = |xyz: [f64; 3]| Origin::at(xyz);
    let expected = [
        (Origin::new([1.0, 2.0, 3.0], [0.0, FRAC_PI_2, 0.0]), CollisionShape::Sphere { radius: 0.25 }),
        (at([0.0; 3]), CollisionShape::Box { size: [1.0, 2.5, 0.0] }),
        (at([0.0, 0.0, -1.0]), CollisionShape::Cylinder { radius: 0.5, length: 2.0 }),
        (at([0.0; 3]), CollisionShape::Capsule { radius: 0.1, length: 3.0 }),
        (at([0.0; 3]), CollisionShape::Mesh { file: "package://crane/hook.stl".into(), scale: [1.0, 2.0, 0.001], hull: Hull::NotRead }),
        (at([0.0; 3]), CollisionShape::Capsule { radius: 0.2, length: 4.0 }),
    ];
    assert_eq!(of_hook(&reading), expected.map(|(origin, shape)| Collision { origin, shape }));
    // The rest is unchanged, and the geometry is listed as unused.
    let mut description = reading.description;
    description.links[LinkId(3)].collision.clear();
    assert_eq!(description, described(CRANE));
    let unused = reading.unused.iter().filter(|u| u.tag == "collision" && u.subject == Subject::Link("hook".into()));
    assert_eq!(unused.count(), 6);
}

/// Content of `<collision>`, kind and field of the error, and parts of its text.
const WRONG: &[(&str, Code, &str, &[&str])] = &[
    ("", Code::MissingTag, "geometry", &["none", "<geometry>"]),
    ("<geometry/>", Code::MissingTag, "geometry", &["no shape", "<box>", "<mesh>"]),
    ("<geometry><sphere radius='1'/><sphere radius='2'/></geometry>", Code::DuplicateTag, "geometry", &["2 shapes", "one of"]),
    ("<geometry><cone radius='1'/></geometry>", Code::Unsupported, "geometry", &["<cone>", "<capsule>"]),
    ("<geometry><sphere/></geometry>", Code::MissingAttribute, "radius", &["none", "radius in <sphere>"]),
    ("<geometry><sphere radius='-0.5'/></geometry>", Code::Negative, "sphere radius", &["\"-0.5\"", "at least 0 m"]),
    ("<geometry><box size='1 -2 3'/></geometry>", Code::Negative, "box size", &["\"1 -2 3\"", "at least 0 m"]),
    ("<geometry><box size='1 2'/></geometry>", Code::WrongCount, "box size", &["2 numbers", "three numbers"]),
    ("<geometry><box/></geometry>", Code::MissingAttribute, "size", &["none"]),
    ("<geometry><sphere radius='inf'/></geometry>", Code::NotFinite, "sphere radius", &["\"inf\"", "a finite number"]),
    ("<geometry><cylinder radius='1' length='1e999'/></geometry>", Code::NotFinite, "cylinder length", &["\"1e999\""]),
    ("<geometry><cylinder radius='1'/></geometry>", Code::MissingAttribute, "length", &["none"]),
    ("<geometry><capsule radius='x' length='1'/></geometry>", Code::NotANumber, "capsule radius", &["\"x\""]),
    ("<geometry><mesh scale='1 1 1'/></geometry>", Code::MissingAttribute, "filename", &["none"]),
    ("<origin xyz='0 0'/><geometry><sphere radius='1'/></geometry>", Code::WrongCount, "origin xyz", &["2 numbers"]),
];

/// A file that is valid except its collision geometry is read as before; the error is kept for
/// scenes that request contact.
#[test]
fn geometry_that_cannot_be_read_is_a_warning_and_says_why() {
    for (text, kind, field, parts) in WRONG {
        let reading = hook(&format!("<collision>{text}</collision>"));
        let [warning] = reading.warnings.as_slice() else { panic!("{text}: {:?}", reading.warnings) };
        assert_eq!((warning.code, warning.field.as_str(), &warning.subject), (*kind, *field, &Subject::Link("hook".into())), "{text}");
        assert!(warning.line().is_some() && parts.iter().all(|part| warning.to_string().contains(part)), "{warning}");
        assert!(warning.expected.ends_with("; the shape makes no contact"), "{warning}");
        let [Collision { shape: CollisionShape::Unread { why }, .. }] = of_hook(&reading) else { panic!("{text}: {reading:?}") };
        assert!(why.starts_with("crane.urdf:") && parts.iter().all(|part| why.contains(part)), "{why}");
    }
    let reading = hook("<collision><geometry><cylinder radius='-1' length='-1'/></geometry></collision>");
    let [Collision { shape: CollisionShape::Unread { why }, .. }] = of_hook(&reading) else { panic!("{reading:?}") };
    assert!(reading.warnings.len() == 2 && why.ends_with(", and 1 more"), "{why}");
}

/// An unreadable one leaves the others unchanged.
#[test]
fn each_piece_is_read_by_itself() {
    let reading = hook(&[geometry("<sphere radius='-1'/>"), geometry("<sphere radius='2'/>")].concat());
    assert!(matches!(
        of_hook(&reading),
        [Collision { shape: CollisionShape::Unread { .. }, .. }, Collision { shape: CollisionShape::Sphere { radius: 2.0 }, .. }]
    ));
}

#[test]
fn what_is_not_known_of_geometry_is_reported_and_what_is_meant_for_others_is_listed() {
    let reading = hook(
        "<collision group='3'><material name='red'/><verbose value='1'/><geometry><sphere radius='1' radus='2'/></geometry><odd/></collision>",
    );
    let warned: Vec<(&str, Code)> = reading.warnings.iter().map(|w| (w.field.as_str(), w.code)).collect();
    assert_eq!(warned, [("<odd>", Code::Unknown), ("sphere radus", Code::Misspelt)]);
    let listed: Vec<&str> = reading.unused.iter().filter(|u| u.subject == Subject::Link("hook".into())).map(|u| u.tag.as_str()).collect();
    assert_eq!(listed, ["collision", "collision group", "material", "verbose", "odd", "sphere radus"]);
    assert_eq!(of_hook(&reading).len(), 1);
}

/// An expression of xacro in a size is an error, as everywhere except in names of files.
#[test]
fn expressions_of_xacro_in_sizes_are_errors() {
    let text = crane("<link name=\"hook\"/>", &format!("<link name=\"hook\">{}</link>", geometry("<sphere radius='${r}'/>")));
    let problems = read(text.as_bytes(), &options()).unwrap_err();
    assert_eq!(problems.errors.iter().map(|e| (e.code, e.field.as_str())).collect::<Vec<_>>(), [(Code::Xacro, "sphere radius")]);
}

#[test]
fn appearance_is_read_with_the_colours_of_materials_and_is_never_a_finding() {
    let text = "<visual><origin xyz='0 0 1'/><geometry><box size='1 2 3'/></geometry><material name='steel'/></visual>
        <visual><geometry><mesh filename='hook.dae'/></geometry><material name=''><color rgba='1 0 0 0.5'/></material></visual>
        <visual><geometry><cone/></geometry><material name='unknown'/></visual>";
    let with_link = crane("<link name=\"hook\"/>", &format!("<link name=\"hook\">\n{text}</link>"));
    let end = "</robot>";
    let reading = accepted(&with_link.replace(end, &format!("<material name='steel'><color rgba='0.5 0.5 2 1'/></material>{end}")));
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let [boxed, mesh, cone] = &reading.description.links[LinkId(3)].visual[..] else { panic!("three pieces") };
    assert_eq!((boxed.origin, &boxed.shape), (Origin::at([0.0, 0.0, 1.0]), &CollisionShape::Box { size: [1.0, 2.0, 3.0] }));
    assert_eq!((boxed.material.as_str(), boxed.color), ("steel", Some([0.5, 0.5, 1.0, 1.0])));
    assert_eq!(mesh.shape, CollisionShape::Mesh { file: "hook.dae".into(), scale: [1.0; 3], hull: Hull::NotRead });
    assert_eq!((mesh.material.as_str(), mesh.color), ("", Some([1.0, 0.0, 0.0, 0.5])));
    assert!(matches!(&cone.shape, CollisionShape::Unread { why } if why.contains("cone")), "{cone:?}");
    assert_eq!(cone.color, None);
    // It is listed as unused.
    assert_eq!(reading.unused.iter().filter(|u| u.tag == "visual").count(), 3);
}
