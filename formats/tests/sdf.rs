//! SDF: results of files, and messages about them.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Description, JointId, JointKind, LinkId};
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_core::model::Model;
use articulated_formats::{Included, NoFiles, Options, Reading, Sources, included, read, read_with};

/// Files by their names.
#[derive(Default)]
struct Files(BTreeMap<PathBuf, Vec<u8>>);

impl Files {
    fn of(files: &[(&str, &str)]) -> Self {
        Self(files.iter().map(|(name, text)| (PathBuf::from(name), text.as_bytes().to_vec())).collect())
    }
}

impl Sources for Files {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| Error::new(ErrorKind::NotFound, "no such file"))
    }
}

fn options() -> Options {
    Options { file: "robots/arm.sdf".to_owned(), ..Options::default() }
}

fn accepted(text: &str) -> Reading {
    read(text.as_bytes(), &options()).unwrap_or_else(|found| panic!("{found}\n{text}"))
}

fn described(text: &str) -> Description {
    accepted(text).description
}

fn refused(text: &str) -> Diagnostics {
    read(text.as_bytes(), &options()).map(|_| ()).expect_err(text)
}

/// The only error of a text, with its line.
fn error(text: &str) -> (Code, Option<u32>, String) {
    let found = refused(text);
    assert_eq!(found.errors.len(), 1, "{found}\n{text}");
    (found.errors[0].code, found.errors[0].line(), found.errors[0].to_string())
}

const MASS: &str = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";

/// A model of this version with this content.
fn model(version: &str, content: &str) -> String {
    format!("<sdf version=\"{version}\">\n<model name=\"m\">\n{content}\n</model>\n</sdf>\n")
}

fn link(name: &str, pose: &str) -> String {
    format!("<link name=\"{name}\">{pose}{MASS}</link>\n")
}

fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], rest: &str) -> String {
    format!("<joint name=\"{name}\" type=\"{kind}\"><parent>{parent}</parent><child>{child}</child>{rest}</joint>\n")
}

/// Rotation by rows and position of a frame.
fn placement(description: &Description, frame: &str, q: &[f64]) -> [f64; 12] {
    let model: Model<f64> = Model::new(description, Base::Fixed).unwrap();
    let row = function::<f64>("placements").unwrap();
    let mut out = vec![0.0; row.len(model.shape())];
    row.call(&model, &mut Workspace::new(&model), &[q], &mut out).unwrap();
    let index = model.frames().iter().position(|own| own.name == frame).unwrap();
    std::array::from_fn(|k| out[12 * index + k])
}

fn position(description: &Description, frame: &str, q: &[f64]) -> [f64; 3] {
    let all = placement(description, frame, q);
    [all[9], all[10], all[11]]
}

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14)
}

#[track_caller]
fn at(description: &Description, frame: &str, q: &[f64], expected: [f64; 3]) {
    let found = position(description, frame, q);
    assert!(near(&found, &expected), "{found:?} {expected:?}");
}

fn kinds(description: &Description) -> Vec<(&str, JointKind)> {
    description.joints.iter().map(|joint| (joint.name.as_str(), joint.kind)).collect()
}

fn torques(description: &Description, q: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
    let model: Model<f64> = Model::new(description, Base::Fixed).unwrap();
    let row = function::<f64>("inverse_dynamics").unwrap();
    let mut out = vec![0.0; row.len(model.shape())];
    row.call(&model, &mut Workspace::new(&model), &[q, v, a], &mut out).unwrap();
    out
}

/// `tests/robots/arm.urdf`, written as Gazebo writes it: link poses in the model's frame.
const ARM: &str = r#"<?xml version="1.0"?>
<sdf version="1.9">
  <model name="arm">
    <link name="base"/>
    <link name="upper"><pose>0 0 0.3 0 0 0</pose>
      <inertial><pose>0 0 0.2 0 0 0</pose><mass>2</mass><inertia><ixx>0.0275</ixx><iyy>0.0275</iyy><izz>0.0016</izz></inertia></inertial>
    </link>
    <link name="fore"><pose>0 0 0.7 0 0 0</pose>
      <inertial><pose>0 0 0.175 0 0 0</pose><mass>1.5</mass><inertia><ixx>0.0159</ixx><iyy>0.0159</iyy><izz>0.0012</izz></inertia></inertial>
    </link>
    <link name="tool"><pose relative_to="wrist"/>
      <inertial><pose>0 0 0.05 0 0 0</pose><mass>0.4</mass><inertia><ixx>0.0005</ixx><iyy>0.0005</iyy><izz>0.0002</izz></inertia></inertial>
    </link>
    <joint name="bolt" type="fixed"><parent>world</parent><child>base</child></joint>
    <joint name="yaw" type="revolute"><parent>base</parent><child>upper</child>
      <axis><xyz>0 0 1</xyz><limit><lower>-3</lower><upper>3</upper><effort>80</effort><velocity>3</velocity></limit></axis></joint>
    <joint name="elbow" type="revolute"><parent>upper</parent><child>fore</child>
      <axis><xyz>0 1 0</xyz><limit><lower>-2.5</lower><upper>2.5</upper><effort>60</effort><velocity>4</velocity></limit></axis></joint>
    <joint name="wrist" type="revolute"><parent>fore</parent><child>tool</child><pose relative_to="fore">0 0 0.35 0 0 0</pose>
      <axis><xyz>0 1 0</xyz><limit><lower>-2</lower><upper>2</upper><effort>20</effort><velocity>6</velocity></limit></axis></joint>
  </model>
</sdf>
"#;

#[test]
fn an_arm_has_the_dynamics_of_its_urdf() {
    let urdf = include_bytes!("../../tests/robots/arm.urdf");
    let urdf = read(urdf, &options()).unwrap().description;
    let sdf = described(ARM);
    assert_eq!(kinds(&sdf)[1..], kinds(&urdf));
    assert_eq!(
        sdf.joints.iter().skip(1).map(|joint| joint.limit).collect::<Vec<_>>(),
        urdf.joints.iter().map(|joint| joint.limit).collect::<Vec<_>>()
    );
    for k in 0..5 {
        let of = |shift: f64| [0.0, 1.0, 2.0].map(|j: f64| (shift + 1.3 * j + f64::from(k)).sin());
        let (q, v, a) = (of(0.0), of(1.0), of(2.0));
        let (found, expected) = (torques(&sdf, &q, &v, &a), torques(&urdf, &q, &v, &a));
        assert!(near(&found, &expected), "{found:?} {expected:?}");
        assert!(near(&placement(&sdf, "tool", &q), &placement(&urdf, "tool", &q)));
    }
}

#[test]
fn content_decides_which_format_a_file_has() {
    for file in ["robot.urdf", "robot.xml", "robot.sdf", "-"] {
        let options = Options { file: file.to_owned(), ..Options::default() };
        assert_eq!(read(ARM.as_bytes(), &options).unwrap().description.name, "arm", "{file}");
    }
}

#[test]
fn a_model_without_a_joint_to_the_world_floats_and_a_static_one_does_not_move() {
    let links = link("a", "<pose>1 0 0 0 0 0</pose>") + &link("b", "<pose>1 2 0 0 0 0</pose>");
    let slide = joint("j", "prismatic", ["a", "b"], "<axis><xyz>0 0 1</xyz></axis>");
    let free = accepted(&model("1.9", &format!("<pose>0 0 7 0 0 0</pose>{links}{slide}")));
    assert_eq!(kinds(&free.description), [("a_free", JointKind::Floating), ("j", JointKind::Prismatic)]);
    let start = free.world.home.as_ref().expect("a pose to start from");
    assert_eq!(start.q, [("a_free".to_owned(), vec![1.0, 0.0, 7.0, 0.0, 0.0, 0.0, 1.0])]);
    at(&free.description, "b", &[5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 3.0], [5.0, 2.0, 3.0]);
    let still = accepted(&model("1.9", &format!("<static>true</static><pose>0 0 7 0 0 0</pose>{links}{slide}")));
    assert_eq!(kinds(&still.description), [("a_fixed", JointKind::Fixed), ("b_fixed", JointKind::Fixed)]);
    at(&still.description, "b", &[], [1.0, 2.0, 7.0]);
    assert!(still.unused.iter().any(|unused| unused.why.contains("static")));
    // Two trees without a joint between them float both.
    assert_eq!(described(&model("1.9", &links)).joints.iter().filter(|joint| joint.kind == JointKind::Floating).count(), 2);
}

#[test]
fn a_joint_beside_the_origin_turns_the_link_about_its_anchor() {
    // A quarter turn about z through (1, 0, 0) takes the origin to (1, −1, 0).
    let turn = |pose: &str| {
        described(&model(
            "1.7",
            &(link("a", "<pose>0 0 5 0 0 0</pose>")
                + &joint("j", "revolute", ["world", "a"], &format!("{pose}<axis><xyz>0 0 1</xyz></axis>"))),
        ))
    };
    let robot = turn("<pose>1 0 0 0 0 0</pose>");
    assert_eq!(robot.links.iter().filter(|link| link.intermediate).count(), 1);
    assert_eq!(kinds(&robot), [("j", JointKind::Continuous), ("j_fixed", JointKind::Fixed)]);
    at(&robot, "a", &[FRAC_PI_2], [1.0, -1.0, 5.0]);
    // Along the axis it is the same joint.
    let robot = turn("<pose>0 0 3 0 0 0</pose>");
    assert_eq!(kinds(&robot), [("j", JointKind::Continuous)]);
    at(&robot, "a", &[FRAC_PI_2], [0.0, 0.0, 5.0]);
}

#[test]
fn the_axis_is_in_the_frame_that_the_version_says() {
    // A link that is turned by a quarter about z: x of the link is y of the model.
    let robot = |version: &str, xyz: &str| {
        let axis = format!("<axis>{xyz}</axis>");
        let content = link("a", "<pose>0 0 0 0 0 1.5707963267948966</pose>") + &joint("j", "prismatic", ["world", "a"], &axis);
        position(&described(&model(version, &content)), "a", &[2.0])
    };
    let (own, of_model) = ([0.0, 2.0, 0.0], [2.0, 0.0, 0.0]);
    let x = "<xyz>1 0 0</xyz>";
    let flagged = format!("{x}<use_parent_model_frame>1</use_parent_model_frame>");
    for (version, xyz, expected) in [
        ("1.4", x, of_model),
        ("1.5", x, own),
        ("1.6", x, own),
        ("1.5", &flagged, of_model),
        ("1.6", &flagged, of_model),
        ("1.7", x, own),
        ("1.7", "<xyz expressed_in=\"__model__\">1 0 0</xyz>", of_model),
        ("1.12", "<xyz expressed_in=\"a\">1 0 0</xyz>", own),
    ] {
        let found = robot(version, xyz);
        assert!(near(&found, &expected), "{version} {xyz} {found:?}");
    }
}

#[test]
fn poses_are_relative_to_what_they_say() {
    let text = model(
        "1.9",
        &[
            "<pose>0 0 10 0 0 0</pose><frame name=\"f\" attached_to=\"a\"><pose>0 1 0 0 0 0</pose></frame>",
            "<frame name=\"g\"><pose relative_to=\"f\" degrees=\"true\">0 0 0 0 0 90</pose></frame>",
            &link("a", "<pose>1 0 0 0 0 0</pose>"),
            &link("b", "<pose relative_to=\"g\" rotation_format=\"quat_xyzw\">1 0 0 0 0 -0.70710678118654752 0.70710678118654752</pose>"),
            &joint("j", "prismatic", ["world", "a"], "<axis><xyz>1 0 0</xyz></axis>"),
            &joint("k", "fixed", ["f", "b"], ""),
        ]
        .concat(),
    );
    let robot = described(&text);
    let b = placement(&robot, "b", &[0.5]);
    assert!(near(&b, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.5, 2.0, 10.0]), "{b:?}");
    at(&robot, "f", &[0.5], [1.5, 1.0, 10.0]);
    // g names no link: it is attached to the model, whose first link counts.
    at(&robot, "g", &[0.5], [1.5, 1.0, 10.0]);
    // Before 1.7 the attribute is called frame.
    let old = model(
        "1.6",
        &(link("a", "<pose>1 0 0 0 0 0</pose>")
            + &link("b", "<pose frame=\"a\">0 1 0 0 0 0</pose>")
            + &joint("k", "fixed", ["a", "b"], "")
            + &joint("l", "fixed", ["world", "a"], "")),
    );
    at(&described(&old), "b", &[], [1.0, 1.0, 0.0]);
}

#[test]
fn nested_models_have_names_and_frames_of_their_own() {
    let inner = format!(
        "<model name=\"arm\" placement_frame=\"tip\"><pose relative_to=\"f\">0 0 1 0 0 0</pose>{}<frame name=\"tip\"><pose>0 0 0.25 0 0 0</pose></frame></model>",
        link("a", "<pose>1 0 0 0 0 0</pose>")
    );
    let text = model(
        "1.8",
        &[
            &inner,
            "<frame name=\"f\"><pose>0 3 0 0 0 0</pose></frame>",
            &link("base", ""),
            &joint("j", "revolute", ["base", "arm::a"], "<axis><xyz>0 0 1</xyz></axis>"),
            &joint("k", "fixed", ["world", "base"], ""),
        ]
        .concat(),
    );
    let robot = described(&text);
    assert_eq!(robot.links.iter().map(|link| link.name.as_str()).collect::<Vec<_>>(), ["world", "arm::a", "base"]);
    // The tip is at its pose: 0.25 above the frame of the inner model.
    at(&robot, "arm::a", &[0.0], [1.0, 3.0, 0.75]);
    at(&robot, "arm::tip", &[0.0], [0.0, 3.0, 1.0]);
    // A joint on the model moves its canonical link.
    let text = text.replace("<child>arm::a</child>", "<child>arm</child>");
    at(&described(&text), "arm::a", &[FRAC_PI_2], [0.0, 4.0, 0.75]);
}

#[test]
fn joints_of_all_types_are_read() {
    let limits = "<limit><lower>-1</lower><upper>2</upper></limit>";
    let axis = |xyz: &str| format!("<axis><xyz>{xyz}</xyz></axis>");
    let robot = |kind: &str, rest: &str| described(&model("1.10", &(link("a", "") + &joint("j", kind, ["world", "a"], rest))));
    let two = |rest: &str| format!("<axis><xyz>1 0 0</xyz>{rest}</axis><axis2><xyz>0 1 0</xyz></axis2>");
    use JointKind::{Continuous, Fixed, Helical, Prismatic, Revolute, Spherical, Universal};
    assert_eq!(kinds(&robot("revolute", &format!("<axis>{limits}</axis>"))), [("j", Revolute)]);
    assert_eq!(kinds(&robot("continuous", &axis("1 0 0"))), [("j", Continuous)]);
    assert_eq!(kinds(&robot("prismatic", &axis("1 0 0"))), [("j", Prismatic)]);
    assert_eq!(kinds(&robot("fixed", "")), [("j", Fixed)]);
    assert_eq!(kinds(&robot("ball", "")), [("j", Spherical)]);
    let cardan = robot("universal", &two(""));
    assert_eq!(kinds(&cardan), [("j", Universal)]);
    let split = robot("universal", &two("<dynamics><damping>3</damping></dynamics>"));
    assert_eq!(kinds(&split), [("j", Continuous), ("j_2", Continuous)]);
    assert_eq!(split.joints[JointId(0)].dynamics.damping, Some(3.0));
    let series = robot("revolute2", &two(""));
    let q = [0.3, 0.7];
    for other in [&split, &series] {
        assert!(near(&placement(&cardan, "a", &q), &placement(other, "a", &q)));
    }
    // A right-handed thread of 2 m per revolution, and its form in older versions.
    let screw = robot("screw", &("<screw_thread_pitch>2</screw_thread_pitch>".to_owned() + &axis("0 0 1")));
    assert_eq!(kinds(&screw), [("j", Helical)]);
    at(&screw, "a", &[TAU], [0.0, 0.0, 2.0]);
    let old = robot("screw", &("<thread_pitch>4</thread_pitch>".to_owned() + &axis("0 0 1")));
    at(&old, "a", &[4.0], [0.0, 0.0, -1.0]);
    // A joint that a file cuts is not needed.
    let cut = "<physics><simbody><must_be_loop_joint>1</must_be_loop_joint></simbody></physics>";
    let text = link("a", "") + &joint("j", "fixed", ["world", "a"], "") + &link("b", "") + &joint("k", "fixed", ["a", "b"], "");
    let robot = described(&model("1.9", &(text + &joint("g", "gearbox", ["world", "b"], cut))));
    assert_eq!(kinds(&robot), [("j", Fixed), ("k", Fixed)]);
    let gearbox = error(&model("1.9", &(link("a", "") + &joint("j", "gearbox", ["world", "a"], &axis("1 0 0")))));
    assert!(gearbox.0 == Code::Unsupported && gearbox.2.contains("<mimic>"), "{gearbox:?}");
}

#[test]
fn limits_and_forces_are_kept() {
    let axis = "<axis><xyz>0 0 1</xyz><limit><lower>-inf</lower><upper>1e16</upper><effort>-1</effort><velocity>4</velocity><stiffness>1</stiffness></limit>
        <dynamics><damping>1</damping><friction>2</friction><spring_stiffness>3</spring_stiffness><spring_reference>0.5</spring_reference></dynamics></axis>";
    let reading = accepted(&model("1.9", &(link("a", "") + &joint("j", "revolute", ["world", "a"], axis))));
    let joint = &reading.description.joints[JointId(0)];
    let limit = joint.limit.unwrap();
    assert_eq!(
        (joint.kind, limit.lower, limit.upper, limit.effort, limit.velocity),
        (JointKind::Continuous, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY, 4.0)
    );
    let dynamics = joint.dynamics;
    assert_eq!([dynamics.damping, dynamics.friction, dynamics.stiffness, dynamics.rest], [1.0, 2.0, 3.0, 0.5].map(Some));
    let unused: Vec<&str> = reading.unused.iter().map(|unused| unused.tag.as_str()).collect();
    for tag in ["dynamics damping", "dynamics friction", "joint stiffness", "joint springref", "stiffness"] {
        assert!(unused.contains(&tag), "{tag} {unused:?}");
    }
}

/// 5.5e-6 · 113.9² = 0.071352655, in the tags of Drake.
#[test]
fn a_rotor_behind_its_gear_is_kept() {
    let tags = "<axis><xyz>0 0 1</xyz></axis><drake:rotor_inertia>5.5e-6</drake:rotor_inertia><drake:gear_ratio>113.9</drake:gear_ratio>";
    let read = |kind: &str, tags: &str| accepted(&model("1.9", &(link("a", "") + &joint("j", kind, ["world", "a"], tags))));
    let reading = read("revolute", tags);
    let found = reading.description.joints[JointId(0)].dynamics.armature.unwrap();
    assert!((found - 0.071352655).abs() < 1e-15 && reading.warnings.is_empty(), "{found} {:?}", reading.warnings);
    assert!(reading.unused.iter().any(|unused| unused.tag == "joint armature") && reading.unused.len() == 1, "{:?}", reading.unused);
    let negative = read("revolute", &tags.replace("5.5e-6", "-1"));
    assert!(negative.warnings.len() == 1 && negative.description.joints[JointId(0)].dynamics.armature.is_none(), "{:?}", negative.warnings);
    let ball = read("ball", &tags.replace("<axis><xyz>0 0 1</xyz></axis>", ""));
    assert_eq!(ball.unused.iter().map(|unused| unused.tag.as_str()).collect::<Vec<_>>(), ["drake:rotor_inertia", "drake:gear_ratio"]);
}

#[test]
fn a_follower_follows() {
    let content = [
        link("a", ""), link("b", ""),
        joint("j", "prismatic", ["world", "a"], "<axis><xyz>1 0 0</xyz></axis>"),
        joint("k", "prismatic", ["a", "b"], "<axis><xyz>1 0 0</xyz><mimic joint=\"j\"><multiplier>3</multiplier><offset>0.5</offset><reference>0.25</reference></mimic></axis>"),
    ].concat();
    let robot = described(&model("1.11", &content));
    // 3 (1 − 0.25) + 0.5 + 1
    at(&robot, "b", &[1.0], [3.75, 0.0, 0.0]);
    let unknown = error(&model("1.11", &content.replace("joint=\"j\"", "joint=\"i\"")));
    assert_eq!((unknown.0, unknown.1), (Code::UnknownLeader, Some(6)));
    let own = error(&model("1.11", &content.replace("joint=\"j\"", "joint=\"k\"")));
    assert_eq!(own.0, Code::MimicRing);
}

#[test]
fn links_without_mass_properties_have_the_defaults_of_the_format() {
    let reading = accepted(&model("1.9", &("<link name=\"a\"/>".to_owned() + &joint("j", "continuous", ["world", "a"], "<axis/>"))));
    let inertial = reading.description.links[LinkId(1)].inertial.unwrap();
    assert_eq!((inertial.mass, inertial.inertia), (1.0, [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]));
    assert_eq!(reading.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(), [Code::MissingTag]);
    let auto = error(&model("1.11", "<link name=\"a\"><inertial auto=\"true\"/></link>"));
    assert_eq!((auto.0, auto.1), (Code::MissingTag, Some(3)));
}

#[test]
fn a_joint_that_is_met_from_its_child_is_reversed() {
    // The base is the child of j: the tree goes from it to a.
    let content = |kind: &str, rest: &str| {
        model(
            "1.9",
            &[
                link("a", "<pose>1 0 0 0 0 0</pose>"),
                link("base", ""),
                joint("bolt", "fixed", ["world", "base"], ""),
                joint("j", kind, ["a", "base"], &format!("<pose relative_to=\"a\">0 0 0 0 0 0</pose>{rest}")),
            ]
            .concat(),
        )
    };
    let reading = accepted(&content("prismatic", "<axis><xyz>0 0 1</xyz></axis>"));
    // The base is q above a, and does not move.
    at(&reading.description, "a", &[2.0], [1.0, 0.0, -2.0]);
    assert!(reading.unused.iter().any(|unused| unused.why.contains("reversed")));
    let robot = described(&content("revolute", "<axis><xyz>0 0 1</xyz></axis>"));
    let found = placement(&robot, "a", &[FRAC_PI_2]);
    assert!(near(&found, &[0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]), "{found:?}");
    // Two axes: R = Rx(q₁) Ry(q₂) of the base in a.
    let axes = "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>";
    let robot = described(&content("universal", axes));
    assert_eq!(robot.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["bolt", "j_2", "j"]);
    let forward = described(&model("1.9", &(link("base", "") + &joint("j", "universal", ["world", "base"], axes))));
    let (q1, q2) = (0.4, -0.9);
    let (reversed, forward) = (placement(&robot, "a", &[q2, q1]), placement(&forward, "base", &[q1, q2]));
    let transposed: [f64; 9] = std::array::from_fn(|k| forward[3 * (k % 3) + k / 3]);
    assert!(near(&reversed[..9], &transposed));
}

#[test]
fn a_loop_is_an_error_that_names_its_joints_and_can_be_cut() {
    let content = |physics: &str| {
        model(
            "1.9",
            &[
                link("a", ""),
                link("b", ""),
                link("c", ""),
                joint("ab", "continuous", ["a", "b"], "<axis/>"),
                joint("ac", "continuous", ["a", "c"], "<axis/>"),
                joint("bc", "ball", ["b", "c"], physics),
            ]
            .concat(),
        )
    };
    let (code, line, message) = error(&content(""));
    assert_eq!((code, line), (Code::Ring, Some(8)));
    for part in ["\"ab\"", "\"ac\"", "\"bc\"", "must_be_loop_joint"] {
        assert!(message.contains(part), "{message}");
    }
    let cut = accepted(&content("<physics><simbody><must_be_loop_joint>true</must_be_loop_joint></simbody></physics>"));
    assert_eq!(cut.description.joints.len(), 3);
    assert!(cut.warnings.iter().any(|warning| warning.code == Code::LostDynamics && warning.message().contains("bc")));
}

#[test]
fn a_world_has_one_model() {
    let one = |models: &str| {
        format!(
            "<sdf version=\"1.9\"><world name=\"w\"><gravity>0 0 -1.6</gravity><light name=\"sun\" type=\"point\"/>{models}</world></sdf>"
        )
    };
    let a = format!("<model name=\"a\"><pose>0 0 2 0 0 0</pose>{}{}</model>", link("l", ""), joint("j", "fixed", ["world", "l"], ""));
    let reading = accepted(&one(&a));
    assert_eq!((reading.description.name.as_str(), reading.warnings.len()), ("a", 0));
    assert_eq!(reading.world.gravity, Some([0.0, 0.0, -1.6]));
    assert!(reading.unused.iter().any(|unused| unused.tag == "light"));
    at(&reading.description, "l", &[], [0.0, 0.0, 2.0]);
    let two = error(&format!("<sdf version=\"1.9\">{a}{}</sdf>", a.replace("\"a\"", "\"b\"")));
    assert!(two.2.contains("\"a\"") && two.2.contains("\"b\"") && two.2.contains("one <model>"), "{two:?}");
    assert_eq!(error("<sdf version=\"1.9\"/>").0, Code::NoLinks);
    assert_eq!(error(&one("")).0, Code::NoLinks);
}

#[test]
fn the_models_of_a_world_are_one_robot() {
    let files = Files::of(&[("robots/sun/model.sdf", "<sdf version=\"1.9\"><light name=\"sun\" type=\"point\"/></sdf>")]);
    let arm = link("l", "") + &joint("j", "revolute", ["world", "l"], "<axis><xyz>0 0 1</xyz></axis>");
    let world = |more: &str| {
        let (arm, box_, ground) = (
            format!("<model name=\"arm\"><pose>0 0 2 0 0 0</pose>{arm}</model>"),
            format!("<model name=\"box\"><pose relative_to=\"corner\">0 0 1 0 0 0</pose>{}</model>", link("l", "")),
            format!("<model name=\"ground\"><static>true</static>{}</model>", link("l", "")),
        );
        let corner = "<frame name=\"corner\"><pose>3 0 0 0 0 0</pose></frame>";
        format!(
            "<sdf version=\"1.9\"><world name=\"room\"><include><uri>model://sun</uri></include>{ground}{arm}{box_}{corner}{more}</world></sdf>"
        )
    };
    let reading = read_with(&files, world("").as_bytes(), &options()).unwrap_or_else(|found| panic!("{found}"));
    let robot = &reading.description;
    let links: Vec<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!((robot.name.as_str(), links.as_slice()), ("room", &["world", "ground::l", "arm::l", "box::l"][..]));
    let joints: Vec<_> = robot.joints.iter().map(|joint| (joint.name.as_str(), joint.kind)).collect();
    let expected = [("ground::l_fixed", JointKind::Fixed), ("box::l_free", JointKind::Floating), ("arm::j", JointKind::Continuous)];
    assert_eq!(joints, expected);
    at(robot, "arm::l", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.3], [0.0, 0.0, 2.0]);
    assert_eq!(
        reading.world.home.as_ref().map(|home| home.q.clone()),
        Some(vec![("box::l_free".to_owned(), vec![3.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])])
    );
    assert!(reading.unused.iter().any(|unused| unused.why.contains("no model")));
    // Names are unique, and a joint may be between models.
    let twice = read_with(&files, world("<model name=\"box\"/>").as_bytes(), &options()).expect_err("the name is taken");
    assert!(twice.errors.iter().any(|error| error.code == Code::DuplicateName), "{twice}");
    let held = world(&joint("hold", "fixed", ["arm::l", "box::l"], ""));
    let reading = read_with(&files, held.as_bytes(), &options()).unwrap_or_else(|found| panic!("{found}"));
    assert!(reading.world.home.is_none() && reading.description.joints.iter().all(|joint| joint.kind != JointKind::Floating));
}

#[test]
fn names_of_nested_models_are_bounded_together() {
    let links: String = (0..40_000).map(|k| format!("<link name=\"l{k}\"/>")).collect();
    let found = error(&model("1.9", &format!("<model name=\"{}\">{links}</model>", "m".repeat(900))));
    assert_eq!((found.0, found.2.contains("very long names")), (Code::TooLarge, true), "{found:?}");
}

#[test]
fn planes_of_still_models_are_planes_of_the_world() {
    let ground = |normal: &str| {
        let shape = format!("<collision name=\"c\"><pose>0 0 0.5 0 0 0</pose><geometry><plane>{normal}</plane></geometry></collision>");
        format!("<static>true</static><pose>0 0 1 {FRAC_PI_2} 0 0</pose><link name=\"ground\">{shape}</link>")
    };
    let planes = |content: &str| accepted(&model("1.9", content)).world.planes;
    let found = planes(&ground("<normal>0 0 3</normal><size>1 1</size>"));
    assert_eq!((found.len(), found[0].name.as_str()), (1, "ground"));
    assert!(near(&found[0].normal, &[0.0, -1.0, 0.0]) && near(&found[0].point, &[0.0, -0.5, 1.0]), "{found:?}");
    assert_eq!(planes(&ground(""))[0].normal, found[0].normal);
    let wrong = accepted(&model("1.9", &ground("<normal>0 0 0</normal>")));
    assert!(wrong.world.planes.is_empty() && wrong.warnings[0].to_string().contains("makes no contact"), "{:?}", wrong.warnings);
    // A moving one is a shape that is not read.
    let moves = accepted(&model("1.9", &ground("").replace("true", "false")));
    assert!(moves.world.planes.is_empty() && moves.warnings.iter().any(|warning| warning.to_string().contains("<plane>")));
}

#[test]
fn files_are_included_by_their_paths() {
    let arm = model("1.7", &(link("a", "<pose>1 0 0 0 0 0</pose>") + "<frame name=\"f\"/>"));
    let files = Files::of(&[
        ("robots/../arm/model.config", "<model><sdf version=\"1.5\">old.sdf</sdf><sdf version=\"1.10\">new.sdf</sdf></model>"),
        ("robots/../arm/new.sdf", &arm),
    ]);
    let main = model(
        "1.9",
        &[
            &link("base", ""),
            "<include><uri>model://arm</uri><name>left</name><pose>0 2 0 0 0 0</pose></include>",
            "<include merge=\"true\"><uri>model://arm</uri><pose>0 -2 0 0 0 0</pose></include>",
            &joint("j", "fixed", ["world", "base"], ""),
            &joint("k", "fixed", ["base", "left::a"], ""),
            &joint("l", "fixed", ["base", "a"], ""),
        ]
        .concat(),
    );
    let reading = read_with(&files, main.as_bytes(), &options()).unwrap_or_else(|found| panic!("{found}"));
    let robot = &reading.description;
    at(robot, "left::a", &[], [1.0, 2.0, 0.0]);
    at(robot, "a", &[], [1.0, -2.0, 0.0]);
    at(robot, "left::f", &[], [0.0, 2.0, 0.0]);
    // Read once, then again without the file system.
    let kept: Included = included(&files, Path::new(""), main.as_bytes(), &options());
    assert_eq!(&read_with(&kept, main.as_bytes(), &options()).unwrap().description, robot);
    let missing = read_with(&NoFiles, main.as_bytes(), &options()).unwrap_err();
    assert!(missing.errors.iter().any(|error| error.code == Code::File && error.line() == Some(4)), "{missing}");
    // An error in an included file has that file's name.
    let bad =
        Files::of(&[("robots/arm.sdf", "<sdf version=\"1.9\">\n<model name='x'><include><uri>arm.sdf</uri></include></model></sdf>")]);
    let ring =
        read_with(&bad, "<sdf version='1.9'><model name='y'><include><uri>arm.sdf</uri></include></model></sdf>".as_bytes(), &options());
    assert!(ring.unwrap_err().errors.iter().any(|error| error.code == Code::Ring));
}

/// A URDF with every type of joint that SDF has, turned frames, a follower and forces.
const PARTS: &str = "<robot name='crane'>\
  <link name='foot'><inertial><origin xyz='0.1 0 0.2'/><mass value='3'/><inertia ixx='0.3' ixy='0.01' ixz='0' iyy='0.4' iyz='-0.02' izz='0.2'/></inertial></link>\
  <link name='boom'><inertial><origin xyz='0.4 0 0' rpy='0.3 -0.2 0.1'/><mass value='2'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.25'/></inertial>\
    <collision><origin xyz='0 0 1'/><geometry><capsule radius='0.1' length='0.5'/></geometry></collision></link>\
  <link name='frame'/>\
  <link name='hook'><inertial><origin xyz='0 0.2 0'/><mass value='1.5'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>\
  <link name='nut'><inertial><mass value='0.5'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.02' iyz='0' izz='0.02'/></inertial></link>\
  <joint name='boom' type='revolute'><parent link='foot'/><child link='boom'/><origin xyz='0.1 0.2 1' rpy='0.4 -0.3 0.2'/><axis xyz='0 2 1'/>\
    <limit lower='-1' upper='2' effort='50' velocity='3'/><dynamics damping='0.4' friction='0.1'/></joint>\
  <joint name='weld' type='fixed'><parent link='boom'/><child link='frame'/><origin xyz='1 0 0' rpy='0 0 1'/></joint>\
  <joint name='swing' type='continuous'><parent link='frame'/><child link='hook'/><origin xyz='0 0.1 0'/><axis xyz='1 0 0'/><mimic joint='boom' multiplier='-0.5' offset='0.2'/></joint>\
  <joint name='thread' type='helical'><parent link='hook'/><child link='nut'/><origin xyz='0 0 -0.3'/><axis xyz='0 0 1'/><thread pitch='0.02'/>\
    <limit lower='-9' upper='9' effort='1' velocity='1'/></joint></robot>";

#[test]
fn a_urdf_in_an_include_is_read() {
    let of = |include: &str, urdf: &str| {
        let files = Files::of(&[("robots/crane/crane.urdf", urdf)]);
        let text = model("1.9", &[link("cart", ""), include.to_owned()].concat());
        read_with(&files, text.as_bytes(), &options())
    };
    let include = "<include><uri>model://crane/crane.urdf</uri><name>c</name><pose>1 2 3 0.1 0.2 0.3</pose></include>";
    let reading = of(include, PARTS).unwrap();
    let robot = &reading.description;
    let alone = read(PARTS.as_bytes(), &Options { file: "crane.urdf".into(), ..Options::default() }).unwrap();
    assert_eq!(
        robot.links.iter().map(|l| l.name.as_str()).collect::<Vec<_>>(),
        ["world", "cart", "c::foot", "c::boom", "c::frame", "c::hook", "c::nut"]
    );
    for joint in &alone.description.joints {
        let own = &robot.joints[robot.joint(&format!("c::{}", joint.name)).unwrap()];
        assert_eq!((own.kind, own.pitch, own.limit, own.dynamics), (joint.kind, joint.pitch, joint.limit, joint.dynamics));
        assert!(own.axis == joint.axis || joint.kind == JointKind::Fixed);
        assert!(
            near(&own.origin.xyz, &joint.origin.xyz) && near(&own.origin.rotation.rpy(), &joint.origin.rotation.rpy()),
            "{}",
            joint.name
        );
        let law = |d: &Description, m: articulated_core::description::Mimic| {
            (d.joints[m.joint].name.rsplit("::").next().unwrap().to_owned(), m.multiplier, m.offset)
        };
        assert_eq!(own.mimic.map(|m| law(robot, m)), joint.mimic.map(|m| law(&alone.description, m)));
    }
    for link in &alone.description.links {
        let own = &robot.links[robot.link(&format!("c::{}", link.name)).unwrap()];
        assert_eq!(&own.collision, &link.collision);
        assert_eq!(own.inertial.map(|i| (i.mass, i.inertia, i.origin.xyz)), link.inertial.map(|i| (i.mass, i.inertia, i.origin.xyz)));
        let turn = |link: &articulated_core::description::Link| link.inertial.map_or([0.0; 3], |i| i.origin.rotation.rpy());
        assert!(near(&turn(own), &turn(link)), "{}", link.name);
    }
    // It floats, and starts at the pose of its tag. A link and a joint of the same name are valid
    // in a URDF.
    let home = reading.world.home.unwrap();
    assert_eq!((home.q[0].0.as_str(), &home.q[0].1[..3]), ("c::foot_free", &[1.0, 2.0, 3.0][..]));
    assert!(reading.warnings.iter().all(|w| w.code != Code::DuplicateName && w.code != Code::MissingTag), "{:?}", reading.warnings);
    // A URDF whose root is the world hangs on the world; its errors have its name and line.
    let held = of(
        include,
        "<robot name='r'><link name='world'/><link name='a'/><joint name='j' type='continuous'><parent link='world'/><child link='a'/></joint></robot>",
    );
    let held = held.unwrap().description;
    assert_eq!(
        held.joints.iter().map(|j| (j.name.as_str(), j.parent)).collect::<Vec<_>>(),
        [("cart_free", LinkId(0)), ("c::j", LinkId(0))]
    );
    let wrong =
        of(include, "<robot name='r'>\n<link name='a'><inertial><mass value='x'/></inertial></link></robot>").unwrap_err().to_string();
    assert!(wrong.contains("robots/crane/crane.urdf:2: link \"a\": mass value: found \"x\""), "{wrong}");
    let planar = of(include, &PARTS.replace("continuous", "planar").replace("<mimic joint='boom' multiplier='-0.5' offset='0.2'/>", ""));
    let planar = planar.unwrap_err().to_string();
    assert!(planar.contains("robots/crane/crane.urdf: joint \"swing\": type: found a planar joint"), "{planar}");
}

/// Closed forms of each shape, and the parallel axes of two by hand.
#[test]
fn inertias_are_computed_of_shapes_where_the_file_says_so() {
    let shape = |pose: &str, density: &str, geometry: &str| {
        format!("<collision name='c'>{pose}{density}<geometry>{geometry}</geometry></collision>")
    };
    let of = |inertial: &str, shapes: &str| model("1.11", &format!("<link name='a'>{inertial}{shapes}</link>"));
    let own = |text: &str| accepted(text).description.links[LinkId(1)].inertial.unwrap();
    let auto = "<inertial auto='true'/>";
    let pi = std::f64::consts::PI;
    // One shape of density 800 in its own frame: volume, squared radii of gyration, centre.
    let alone: [(&str, f64, [f64; 3], f64); 6] = [
        ("<box><size>1 2 3</size></box>", 6.0, [13.0 / 12.0, 10.0 / 12.0, 5.0 / 12.0], 0.0),
        ("<sphere><radius>0.5</radius></sphere>", pi / 6.0, [0.1; 3], 0.0),
        ("<cylinder><radius>0.2</radius><length>0.6</length></cylinder>", 0.024 * pi, [0.04, 0.04, 0.02], 0.0),
        ("<ellipsoid><radii>1 2 3</radii></ellipsoid>", 8.0 * pi, [2.6, 2.0, 1.0], 0.0),
        ("<cone><radius>0.2</radius><length>0.6</length></cone>", 0.008 * pi, [0.0195, 0.0195, 0.012], -0.15),
        // ∫ over the cylinder and both half balls: (0.024 · 0.04 + (4/3) 0.008 (0.016 + 0.09 +
        // 0.045)) / (0.024 + (4/3) 0.008).
        (
            "<capsule><radius>0.2</radius><length>0.6</length></capsule>",
            (0.024 + 0.032 / 3.0) * pi,
            {
                let across = (0.024 * 0.04 + 0.032 / 3.0 * 0.151) / (0.024 + 0.032 / 3.0);
                [across, across, (0.024 * 0.02 + 0.032 / 3.0 * 0.016) / (0.024 + 0.032 / 3.0)]
            },
            0.0,
        ),
    ];
    for (geometry, volume, [x, y, z], centre) in alone {
        let found = own(&of(auto, &shape("", "<density>800</density>", geometry)));
        let mass = 800.0 * volume;
        assert!((found.mass - mass).abs() < 1e-12 * mass && near(&found.origin.xyz, &[0.0, 0.0, centre]), "{geometry}: {found:?}");
        let scaled = found.inertia.map(|moment| moment / mass);
        assert!(near(&scaled, &[x, 0.0, 0.0, y, 0.0, z]), "{geometry}: {scaled:?}");
    }
    // A ball of 2 kg at (1, 0, 0) and a box of 1 kg, turned by 90° about x, at (-2, 0, 3).
    let ball =
        shape("<pose>1 0 0 0 0 0</pose>", &format!("<density>{}</density>", 2.0 / (pi / 6.0)), "<sphere><radius>0.5</radius></sphere>");
    let boxed = shape("<pose degrees='true'>-2 0 3 90 0 0</pose>", "", "<box><size>1 2 0.5</size></box>");
    let both = own(&of("<inertial auto='true'><density>1</density></inertial>", &(ball.clone() + &boxed)));
    // About the centre (0, 0, 1): 0.2 of the ball itself and its 2 kg at (1, 0, -1), the box with y
    // and z exchanged and 1 kg at (-2, 0, 2).
    let turned = [0.2 + 4.25 / 12.0 + 2.0 + 4.0, 0.0, 2.0 + 4.0, 0.2 + 5.0 / 12.0 + 4.0 + 8.0, 0.0, 0.2 + 1.25 / 12.0 + 2.0 + 4.0];
    assert!(near(&[both.mass], &[3.0]) && near(&both.origin.xyz, &[0.0, 0.0, 1.0]) && near(&both.inertia, &turned), "{both:?} {turned:?}");
    // A mass in the file scales it; pose and inertia of the file are not used.
    let scaled =
        "<inertial auto='true'><mass>1.5</mass><pose>9 9 9 0 0 0</pose><inertia><ixx>7</ixx></inertia><density>1</density></inertial>";
    let reading = accepted(&of(scaled, &(ball + &boxed)));
    let half = reading.description.links[LinkId(1)].inertial.unwrap();
    assert!(
        near(&[half.mass], &[1.5]) && near(&half.inertia, &turned.map(|moment| moment / 2.0)) && near(&half.origin.xyz, &[0.0, 0.0, 1.0])
    );
    assert_eq!(reading.unused.iter().filter(|u| matches!(u.tag.as_str(), "pose" | "inertia")).count(), 2);
    // Without a density, water's, with a warning.
    let reading = accepted(&of(auto, &shape("", "", "<box><size>1 1 1</size></box>")));
    assert_eq!(reading.description.links[LinkId(1)].inertial.unwrap().mass, 1000.0);
    assert!(reading.warnings.len() == 1 && reading.warnings[0].to_string().contains("1000 kg/m³"), "{:?}", reading.warnings);
    // Shapes without a computable inertia.
    let mesh = shape("", "<density>1</density>", "<mesh><uri>a.stl</uri></mesh>");
    let plane = shape("", "<density>1</density>", "<plane/>");
    for (shapes, words) in [
        (mesh.as_str(), "link \"a\": auto: found the mesh \"a.stl\", expected a box, capsule, cone, cylinder, ellipsoid or sphere"),
        (&plane, "found <plane>, expected a box"),
        ("", "found no shapes, expected <collision> with a shape"),
        (&shape("", "<density>0</density>", "<box><size>1 1 1</size></box>"), "density: found 0, expected a density above 0 kg/m³"),
        (&shape("", "<density>1</density>", "<box><size>1 1 0</size></box>"), "found shapes without volume"),
    ] {
        let (.., told) = error(&of(auto, shapes));
        assert!(told.contains(words), "{told}");
    }
    // The mass of a link that does not move has no effect.
    let still = "<sdf version='1.11'><model name='m'><static>true</static><link name='a'><inertial auto='true'/><collision name='c'><geometry><plane/></geometry></collision></link></model></sdf>";
    assert!(accepted(still).description.links[LinkId(1)].inertial.is_none());
}

/// A law that is not read is an error, and a plugin that couples joints is called so.
#[test]
fn couplings_that_are_not_read_are_named() {
    let follower = |law: &str| {
        let links = ["a", "b"].map(|name| link(name, "")).concat();
        let leads = joint("j", "revolute", ["world", "a"], "<axis><xyz>1 0 0</xyz></axis>");
        let mimic = format!("<axis><xyz>1 0 0</xyz><mimic joint=\"j\"{law}</mimic></axis>");
        model("1.11", &[links, leads, joint("k", "revolute", ["a", "b"], &mimic)].concat())
    };
    for (law, name) in [(" square='2'>", "attribute"), ("><square>2</square>", "tag")] {
        let (code, _, told) = error(&follower(law));
        assert!(code == Code::Unknown && told.contains("joint \"k\"") && told.contains(name) && told.contains("square"), "{told}");
    }
    assert!(accepted(&follower("><multiplier>2</multiplier>")).warnings.is_empty());
    let plugin = |file: &str| {
        let content = link("a", "") + &format!("<plugin name='p' filename='{file}'/>");
        accepted(&model("1.11", &content)).warnings.into_iter().map(|w| (w.code, w.found)).collect::<Vec<_>>()
    };
    assert_eq!(plugin("libgazebo_mimic_joint_plugin.so"), [(Code::LostDynamics, "a coupling of joints by the plugin \"p\"".to_owned())]);
    assert_eq!(plugin("libcamera.so"), []);
}

#[test]
fn a_name_of_a_link_and_a_joint_is_a_warning() {
    let text = model("1.9", &[link("a", ""), joint("a", "revolute", ["world", "a"], "<axis><xyz>0 0 1</xyz></axis>")].concat());
    let warnings = accepted(&text).warnings;
    assert_eq!(warnings.iter().map(|w| w.code).collect::<Vec<_>>(), [Code::DuplicateName]);
    let told = warnings[0].to_string();
    assert!(
        told.contains("found a joint with the name of the link of line 3, \"a\"") && told.contains("references mean the link"),
        "{told}"
    );
}

#[test]
fn the_pose_of_home_has_quaternions_of_norm_one() {
    let text = model("1.9", &link("a", "<pose rotation_format='quat_xyzw'>1 2 3 0.6 0 0 0.9</pose>"));
    let home = accepted(&text).world.home.unwrap();
    let norm = 0.6_f64.hypot(0.9);
    assert!(near(&home.q[0].1, &[1.0, 2.0, 3.0, 0.6 / norm, 0.0, 0.0, 0.9 / norm]), "{:?}", home.q);
}

#[test]
fn the_first_of_tags_that_contradict_each_other_counts_where_that_is_asked_for() {
    let of = |again: &str| model("1.9", &link("a", "").replace("<mass>1</mass>", &format!("<mass>1</mass>\n<mass>{again}</mass>")));
    let (code, _, told) = error(&of("2"));
    assert!(code == Code::DuplicateTag && told.contains("`--first-of-duplicates` (key `first_of_duplicates`"), "{told}");
    let first = Options { first_of_duplicates: true, ..options() };
    for (text, options, word) in [(of("2"), first, "the first is used"), (of("1"), options(), "used once")] {
        let reading = read(text.as_bytes(), &options).unwrap();
        assert_eq!(reading.description.links[LinkId(1)].inertial.unwrap().mass, 1.0);
        assert!(reading.warnings.len() == 1 && reading.warnings[0].expected.ends_with(word), "{:?}", reading.warnings);
    }
}

#[test]
fn all_mistakes_of_a_file_come_at_once_with_their_lines() {
    let found = refused(&model(
        "1.9",
        &[
            "<link name=\"a\"><pose>0 0 x 0 0 0</pose><inertial><mass>-1</mass></inertial></link>\n",
            "<link name=\"a\"/>\n",
            "<link name=\"b\"><pose relative_to=\"nothing\"/></link>\n",
            "<joint name=\"j\" type=\"revolut\"><parent>a</parent><child>b</child></joint>\n",
            "<joint name=\"k\" type=\"revolute\"><parent>c</parent><child>b</child></joint>\n",
            "<joint name=\"l\" type=\"prismatic\"><parent>e</parent><child>d</child><axis><xyz>0 0 0</xyz></axis></joint>\n",
            "<joint name=\"m\" type=\"fixed\"><parent>e</parent><child>d</child></joint>\n",
            "<link name=\"x::y\"><inertial><mass>1</mass><inertia><ixx>-1</ixx></inertia></inertial></link>\n",
        ]
        .concat(),
    ));
    let all: Vec<_> = found.errors.iter().map(|error| (error.line().unwrap_or(0), error.code)).collect();
    for expected in [
        (3, Code::NotANumber),
        (3, Code::NegativeMass),
        (4, Code::DuplicateName),
        (5, Code::UnknownName),
        (6, Code::UnknownJointType),
        (7, Code::MissingTag),
        (8, Code::ZeroAxis),
        (9, Code::UnknownLink),
        (10, Code::InertiaNotPositive),
    ] {
        assert!(all.contains(&expected), "{expected:?} {all:?}\n{found}");
    }
    assert!(found.errors.iter().all(|error| error.span.at.column().is_some()), "{found}");
}

#[test]
fn what_is_not_used_is_listed_with_its_line() {
    let reading = accepted(&model("1.9", &[
        "<plugin name=\"p\" filename=\"f\"><x/></plugin>\n",
        &link("a", "<sensor name=\"s\" type=\"imu\"/>\n<visual name=\"v\"><geometry><mesh><uri>a.dae</uri></mesh></geometry><material><diffuse>1 0 0 1</diffuse><ambient>1 1 1 1</ambient></material></visual>\n"),
        "<drake:joint xmlns:drake=\"d\" name=\"p\" type=\"planar\"/>\n<limk name=\"b\"/>\n",
        &joint("j", "fixed", ["world", "a"], ""),
    ].concat()));
    let unused: Vec<_> = reading.unused.iter().map(|unused| (unused.line.unwrap_or(0), unused.tag.as_str())).collect();
    for expected in [(3, "plugin"), (4, "sensor"), (5, "visual"), (5, "ambient"), (7, "drake:joint"), (8, "limk")] {
        assert!(unused.contains(&expected), "{expected:?} {unused:?}");
    }
    let codes: Vec<_> = reading.warnings.iter().map(|warning| (warning.line().unwrap_or(0), warning.code)).collect();
    assert_eq!(codes, [(7, Code::LostDynamics), (8, Code::Misspelt)]);
    assert_eq!(reading.description.links[LinkId(1)].visual[0].color, Some([1.0, 0.0, 0.0, 1.0]));
}

#[test]
fn frames_that_depend_on_each_other_are_an_error() {
    let ring = error(&model("1.9", &(link("a", "<pose relative_to=\"b\"/>") + &link("b", "<pose relative_to=\"a\"/>"))));
    assert!(ring.0 == Code::Ring && ring.2.contains("\"a\"") && ring.2.contains("\"b\""), "{ring:?}");
    let ring = refused(&model("1.9", &(link("a", "") + "<frame name=\"f\" attached_to=\"g\"/><frame name=\"g\" attached_to=\"f\"/>")));
    assert!(ring.errors.iter().any(|error| error.code == Code::Ring));
    for own in [
        "<frame name=\"f\" attached_to=\"f\"/>",
        "<frame name=\"f\"><pose relative_to=\"f\"/></frame>",
        "<link name=\"f\"><pose relative_to=\"f\"/></link>",
        "<model name=\"f\" canonical_link=\"__model__\"><link name=\"b\"/></model>",
        "<model name=\"f\"><pose relative_to=\"f::b\"/><link name=\"b\"/></model>",
    ] {
        let ring = refused(&model("1.9", &(link("a", "") + own)));
        assert!(ring.errors.iter().any(|error| error.code == Code::Ring), "{own} {ring}");
    }
}

#[test]
fn versions_are_checked() {
    let of = |version: &str| model(version, &link("a", ""));
    assert_eq!(error(&of("1.3")).0, Code::Version);
    assert_eq!(accepted(&of("1.13")).warnings[0].code, Code::Version);
    assert!((4..=12).all(|minor| accepted(&of(&format!("1.{minor}"))).warnings.is_empty()));
    assert_eq!(error(&of("1.9").replace(" version=\"1.9\"", "")).0, Code::MissingAttribute);
}
