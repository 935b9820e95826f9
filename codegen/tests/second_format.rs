//! A second format, of a few keys in TOML: only its reader and its row know a format.

use articulated_codegen::formats::urdf::Urdf;
use articulated_codegen::formats::world::Document;
use articulated_codegen::formats::{Format, Formats, Input};
use articulated_codegen::{Origin, Request, generate};
use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{ById, Description, Frame, Inertial, Joint, JointId, JointKind, Link, LinkId, Rotation};
use articulated_core::diagnostic::{At, Code, Diagnostics, Place, Subject};
use articulated_core::index::BodyId;
use articulated_core::model::Model;
use toml::{Table, Value};

struct Tiny;

impl Format for Tiny {
    fn name(&self) -> &'static str {
        "tiny"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["tiny"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        bytes.starts_with(b"# tiny")
    }

    fn read(&self, input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<Document> {
        let text = std::str::from_utf8(input.bytes).ok()?;
        let table: Table = match text.parse() {
            Ok(table) => table,
            Err(error) => {
                diagnostics.error(Place::DOCUMENT, Code::Syntax, error.message(), "");
                return None;
            }
        };
        let tables = |key: &str| -> Vec<&Table> {
            table.get(key).and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table).collect()
        };
        let links: ById<LinkId, Link> = tables("link").into_iter().map(|link| read_link(link, diagnostics)).collect();
        let index = |name: &str| links.position(|link| link.name == name);
        let joint = |joint: &Table| {
            let name = text_of(joint, "name");
            let end = |key: &str| index(&text_of(joint, key));
            let found = (end("parent"), end("child"));
            let (Some(parent), Some(child)) = found else {
                let place = Place { at: At::Nowhere, subject: &Subject::Joint(name), field: "parent" };
                diagnostics.error(place, Code::UnknownLink, "a link that does not exist", "the name of a link");
                return None;
            };
            let origin = read_origin(joint);
            Some(Joint { name, kind: JointKind::Continuous, parent, child, origin, axis: numbers(joint, "axis"), ..Joint::default() })
        };
        let joints: ById<JointId, Joint> = tables("joint").into_iter().filter_map(joint).collect();
        let frame =
            |frame: &Table| Some(Frame { name: text_of(frame, "name"), link: index(&text_of(frame, "link"))?, origin: read_origin(frame) });
        let frames = tables("frame").into_iter().filter_map(frame).collect();
        Some(Description { name: text_of(&table, "name"), links, joints, frames }.into())
    }
}

fn text_of(table: &Table, key: &str) -> String {
    table.get(key).and_then(Value::as_str).unwrap_or_default().to_owned()
}

fn numbers<const N: usize>(table: &Table, key: &str) -> [f64; N] {
    let list = table.get(key).and_then(Value::as_array);
    std::array::from_fn(|k| list.and_then(|list| list.get(k)?.as_float()).unwrap_or_default())
}

fn read_origin(table: &Table) -> Origin {
    let rotation = match table.get("matrix") {
        Some(_) => {
            let rows = numbers::<9>(table, "matrix");
            Rotation::Matrix([0, 3, 6].map(|k| [rows[k], rows[k + 1], rows[k + 2]]))
        }
        None => Rotation::IDENTITY,
    };
    Origin { xyz: numbers(table, "xyz"), rotation }
}

fn read_link(link: &Table, diagnostics: &mut Diagnostics) -> Link {
    let name = text_of(link, "name");
    let mass = link.get("mass").and_then(Value::as_float);
    if mass.is_some_and(|mass| mass < 0.0) {
        let place = Place { at: At::Nowhere, subject: &Subject::Link(name.clone()), field: "mass" };
        diagnostics.error(place, Code::NegativeMass, "a negative mass", "a mass of at least 0 kg");
    }
    let origin = Origin { xyz: numbers(link, "com"), ..Origin::default() };
    let inertial = mass.map(|mass| Inertial { origin, mass, inertia: numbers(link, "inertia") });
    let intermediate = link.get("intermediate").and_then(Value::as_bool).unwrap_or_default();
    Link { name, inertial, intermediate, ..Link::default() }
}

const TINY: &str = r#"# tiny
name = "arm"
[[link]]
name = "base"
[[link]]
name = "upper"
mass = 2.0
com = [0.0, 0.1, -0.3]
inertia = [0.1, 0.0, 0.0, 0.2, 0.0, 0.1]
[[link]]
name = "fore"
mass = 1.0
com = [0.0, 0.0, -0.2]
inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.1]
[[joint]]
name = "shoulder"
parent = "base"
child = "upper"
xyz = [0.0, 0.0, 1.0]
axis = [0.0, 1.0, 0.0]
[[joint]]
name = "elbow"
parent = "upper"
child = "fore"
xyz = [0.0, 0.0, -0.6]
axis = [1.0, 0.0, 0.0]
"#;

const URDF: &str = r#"<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0.1 -0.3"/><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.1"/></inertial></link>
<link name="fore"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>
<joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/><origin xyz="0 0 -0.6"/><axis xyz="1 0 0"/></joint></robot>"#;

fn request(file: &str, document: &str) -> Request {
    static FORMATS: [&dyn Format; 2] = [&Tiny, &Urdf];
    let mut request = Request::new(file, document);
    request.options.robot.formats = Formats(&FORMATS);
    request.options.functions = ["inverse_dynamics", "mass_matrix"].map(Into::into).to_vec();
    request
}

#[test]
fn one_robot_in_two_formats_is_one_module() {
    // Without the line that names the file.
    let source = |file: &str, document: &str| {
        let source = generate(&request(file, document)).unwrap_or_else(|e| panic!("{e}")).source;
        source.split_once('\n').unwrap().1.to_owned()
    };
    let urdf = source("arm.urdf", URDF);
    assert_eq!(source("arm.tiny", TINY), urdf);
    // The document decides, whatever the file is called.
    assert_eq!(source("-", TINY), urdf);
}

const MJCF: &str = r#"<mujoco model="arm"><worldbody><body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0"/>
<inertial pos="0 0.1 -0.3" mass="2" diaginertia="0.1 0.2 0.1"/>
<body name="fore" pos="0 0 -0.6"><joint name="elbow" axis="1 0 0"/><inertial pos="0 0 -0.2" mass="1" diaginertia="0.1 0.1 0.1"/></body>
</body></worldbody></mujoco>"#;

#[test]
fn one_robot_as_mjcf_and_as_urdf_is_one_module() {
    let source = |file: &str, document: &str| {
        let mut request = Request::new(file, document);
        request.options.functions = ["inverse_dynamics", "mass_matrix", "placements"].map(Into::into).to_vec();
        let source = generate(&request).unwrap_or_else(|e| panic!("{e}")).source;
        source.split_once('\n').unwrap().1.to_owned()
    };
    let urdf = URDF.replace("base", "world");
    assert_eq!(source("arm.xml", MJCF), source("arm.urdf", &urdf));
}

#[test]
fn edits_and_findings_are_those_of_every_format() {
    let mut request = request("arm.tiny", TINY);
    request.options.robot.lock.push(("elbow".to_owned(), vec![0.5]).into());
    assert_eq!(generate(&request).unwrap().model.nv(), 1);
    let broken = TINY.replace("mass = 2.0", "mass = -2.0").replace("parent = \"upper\"", "parent = \"uper\"");
    request.document = broken.into();
    request.options.functions.push("no_such".into());
    let told = generate(&request).unwrap_err().to_string();
    for part in ["arm.tiny: link \"upper\": mass: found a negative mass", "joint \"elbow\": parent: found a link", "`no_such`"] {
        assert_eq!(told.lines().filter(|line| line.contains(part)).count(), 1, "{part} in {told}");
    }
}

/// Features of this format that URDF lacks: two joints in sequence on one body, a frame that is no
/// link, a rotation by its matrix.
const WIDE: &str = r#"# tiny
name = "gimbal"
[[link]]
name = "base"
[[link]]
name = "rotor_1"
intermediate = true
[[link]]
name = "rotor"
mass = 2.0
com = [0.0, 0.1, -0.3]
inertia = [0.1, 0.0, 0.0, 0.2, 0.0, 0.1]
[[joint]]
name = "yaw"
parent = "base"
child = "rotor_1"
xyz = [0.0, 0.0, 1.0]
matrix = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
axis = [0.0, 0.0, 1.0]
[[joint]]
name = "pitch"
parent = "rotor_1"
child = "rotor"
axis = [0.0, 1.0, 0.0]
[[frame]]
name = "tool"
link = "rotor"
xyz = [0.0, 0.0, 0.5]
matrix = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
"#;

/// The same as a universal joint and a fixed link.
const UNIVERSAL: &str = r#"<robot name="gimbal"><link name="base"/>
<link name="rotor"><inertial><origin xyz="0 0.1 -0.3"/><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.1"/></inertial></link>
<link name="tool"/>
<joint name="yaw_pitch" type="universal"><parent link="base"/><child link="rotor"/><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/>
<axis xyz="0 0 1"/><axis2 xyz="0 1 0"/></joint>
<joint name="mount" type="fixed"><parent link="rotor"/><child link="tool"/><origin xyz="0 0 0.5" rpy="1.5707963267948966 0 1.5707963267948966"/></joint></robot>"#;

#[test]
fn joints_in_sequence_on_a_body_and_free_frames_are_those_of_the_equal_robot() {
    let model = |file: &str, document: &str| {
        let request = request(file, document);
        generate(&request).unwrap_or_else(|e| panic!("{e}")).model
    };
    let (wide, universal) = (model("gimbal.tiny", WIDE), model("gimbal.urdf", UNIVERSAL));
    let names = |model: &Model| model.frames().iter().map(|frame| frame.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&wide), ["base", "rotor", "tool"]);
    assert_eq!(names(&wide), names(&universal));
    assert_eq!(wide.links().collect::<Vec<_>>(), [BodyId(2)]);
    assert_eq!(wide.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["yaw", "pitch"]);
    let [q, v, a] = [[0.3, -0.8], [0.7, 0.4], [-0.2, 1.1]];
    for (name, arguments) in [("placements", &[&q[..]][..]), ("inverse_dynamics", &[&q, &v, &a]), ("joint_wrenches", &[&q, &v, &a])] {
        let of = |model: &Model| {
            let row = function::<f64>(name).unwrap();
            let mut out = vec![0.0; row.len(model.shape())];
            row.call(model, &mut Workspace::new(model), arguments, &mut out).unwrap();
            out
        };
        let (found, expected) = (of(&wide), of(&universal));
        assert!(
            found.len() == expected.len() && found.iter().zip(&expected).all(|(x, y)| (x - y).abs() < 1e-14),
            "{name}: {found:?} {expected:?}"
        );
    }
}
