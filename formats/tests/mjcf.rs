//! MJCF: results of files, and messages about them.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Description, JointDynamics, JointId, JointKind, LinkId};
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_core::model::Model;
use articulated_formats::{Included, NoFiles, Options, Reading, Sources, included, read, read_with};

#[path = "corpus/grammar.rs"]
mod grammar;

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
    Options { file: "robots/arm.xml".to_owned(), ..Options::default() }
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

/// A world with this content.
fn world(content: &str) -> String {
    format!("<mujoco model=\"arm\">\n<worldbody>\n{content}\n</worldbody>\n</mujoco>\n")
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

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14)
}

#[test]
fn content_decides_which_format_a_file_has() {
    let text = "<?xml version=\"1.0\"?><!-- <robot> --><mujoco><worldbody><body name=\"b\"><joint name=\"j\"/><geom size=\"1\"/></body></worldbody></mujoco>";
    for file in ["robot.urdf", "robot.xml", "-"] {
        let options = Options { file: file.to_owned(), ..Options::default() };
        assert_eq!(read(text.as_bytes(), &options).unwrap().description.joints[JointId(0)].name, "j", "{file}");
    }
    let urdf = "<robot name='r'><link name='a'/></robot>";
    assert_eq!(described(urdf).links[LinkId(0)].name, "a");
}

#[test]
fn bodies_hang_on_the_world_by_their_joints() {
    let robot = described(&world(
        "<body name=\"a\" pos=\"1 0 0\"><geom size=\"1\"/><body name=\"b\" pos=\"0 2 0\"><joint name=\"slide\" type=\"slide\" axis=\"1 0 0\" range=\"-1 1\"/><geom size=\"1\"/></body></body>
         <body name=\"c\"><freejoint name=\"root\"/><geom size=\"1\"/><body><joint type=\"ball\"/><geom size=\"1\"/></body></body>",
    ));
    let links: Vec<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(links, ["world", "a", "b", "c", "body_4"]);
    let joints: Vec<_> = robot.joints.iter().map(|joint| (joint.name.as_str(), joint.kind, joint.parent)).collect();
    use JointKind::{Fixed, Floating, Prismatic, Spherical};
    assert_eq!(
        joints,
        [("a_fixed", Fixed, 0), ("slide", Prismatic, 1), ("root", Floating, 0), ("body_4_ball", Spherical, 3)]
            .map(|(name, kind, parent)| (name, kind, LinkId(parent)))
    );
    assert_eq!(robot.joints[JointId(1)].limit.map(|limit| (limit.lower, limit.upper)), Some((-1.0, 1.0)));
    assert_eq!(robot.name, "arm");
}

#[test]
fn a_joint_beside_the_origin_turns_the_body_about_its_anchor() {
    // A quarter turn about z through (1, 0, 0) takes the origin to (1, −1, 0).
    let text = world("<body name=\"a\" pos=\"0 0 5\"><joint name=\"j\" pos=\"1 0 0\" axis=\"0 0 1\"/><geom size=\"1\"/></body>");
    let robot = described(&text);
    assert_eq!(robot.links.iter().filter(|link| link.intermediate).count(), 1);
    let found = placement(&robot, "a", &[std::f64::consts::FRAC_PI_2]);
    assert!(near(&found, &[0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, -1.0, 5.0]), "{found:?}");
    // At its reference the body has its `pos`.
    let text = text.replace("axis=", "ref=\"90\" axis=");
    let found = placement(&described(&text), "a", &[std::f64::consts::FRAC_PI_2]);
    assert!(near(&found[9..], &[0.0, 0.0, 5.0]) && near(&found[..3], &[1.0, 0.0, 0.0]), "{found:?}");
}

#[test]
fn joints_in_sequence_move_one_after_the_other() {
    let robot = described(&world(
        "<body name=\"a\"><joint name=\"x\" type=\"slide\" axis=\"1 0 0\" ref=\"0.5\"/><joint name=\"t\" axis=\"0 0 1\" pos=\"0 1 0\"/><geom size=\"1\"/><site name=\"tip\" pos=\"0 1 2\"/></body>",
    ));
    let kinds: Vec<_> = robot.joints.iter().map(|joint| joint.kind).collect();
    assert_eq!(kinds, [JointKind::Prismatic, JointKind::Continuous, JointKind::Fixed]);
    // The tip is on the second axis.
    let found = placement(&robot, "tip", &[2.5, 0.7]);
    assert!(near(&found[9..], &[2.0, 1.0, 2.0]), "{found:?}");
}

#[test]
fn classes_frames_and_copies_apply() {
    let text = "<mujoco><compiler angle=\"radian\"/>
        <default><joint damping=\"1\"/><default class=\"arm\"><joint type=\"slide\" armature=\"2\"/><default class=\"hand\"><joint armature=\"3\"/></default></default></default>
        <worldbody><replicate count=\"2\" offset=\"1 0 0\" sep=\"_\"><frame pos=\"0 0 1\" euler=\"0 0 1.5707963267948966\" childclass=\"arm\">
        <body name=\"a\" pos=\"0 1 0\"><joint name=\"j\" axis=\"1 0 0\"/><joint name=\"k\" class=\"hand\"/><geom size=\"1\"/></body></frame></replicate></worldbody></mujoco>";
    let robot = described(text);
    let joints: Vec<_> = robot.joints.iter().map(|joint| (joint.name.as_str(), joint.dynamics.armature, joint.dynamics.damping)).collect();
    let expected = [("j_0", 2.0, 1.0), ("k_0", 3.0, 1.0), ("j_1", 2.0, 1.0), ("k_1", 3.0, 1.0)];
    assert_eq!(joints, expected.map(|(name, armature, damping)| (name, Some(armature), Some(damping))));
    assert!(robot.joints.iter().all(|joint| joint.kind == JointKind::Prismatic));
    let found = placement(&robot, "a_1", &[0.0; 4]);
    assert!(near(&found[9..], &[0.0, 0.0, 1.0]), "{found:?}");
    assert_eq!(found[..9], [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn masses_come_from_geoms_or_from_the_file() {
    let geoms =
        "<geom type=\"box\" size=\"0.5 1 1.5\" density=\"2\"/><geom type=\"sphere\" size=\"1\" pos=\"0 0 3\" mass=\"6\" group=\"4\"/>";
    let body = |compiler: &str, inertial: &str| {
        let text =
            format!("<mujoco><compiler {compiler}/><worldbody><body name=\"a\"><joint/>{inertial}{geoms}</body></worldbody></mujoco>");
        described(&text).links[LinkId(1)].inertial.unwrap()
    };
    // A box of 12 kg and a ball of 6 kg, 3 m apart: the centre is a third of the way.
    let both = body("", "");
    assert_eq!((both.mass, both.origin.xyz), (18.0, [0.0, 0.0, 1.0]));
    let ixx = 12.0 * (4.0 + 9.0) / 12.0 + 12.0 + 6.0 * 0.4 + 6.0 * 4.0;
    assert!(near(&[both.inertia[0]], &[ixx]), "{both:?}");
    let one = body("inertiagrouprange=\"0 2\"", "");
    assert_eq!((one.mass, one.inertia[5]), (12.0, 12.0 * (1.0 + 4.0) / 12.0));
    let inertial = "<inertial pos=\"1 0 0\" mass=\"5\" diaginertia=\"3 2 2\"/>";
    let own = body("", inertial);
    assert_eq!((own.mass, own.inertia), (5.0, [3.0, 0.0, 0.0, 2.0, 0.0, 2.0]));
    assert_eq!(body("inertiafromgeom=\"true\"", inertial).mass, 18.0);
    assert_eq!(body("settotalmass=\"36\"", "").inertia[0], 2.0 * both.inertia[0]);
    let bounded = body("boundmass=\"7\" boundinertia=\"2.5\"", inertial);
    assert_eq!((bounded.mass, bounded.inertia), (7.0, [3.0, 0.0, 0.0, 2.5, 0.0, 2.5]));
    let balanced = body("balanceinertia=\"true\"", "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 4\"/>");
    assert_eq!(balanced.inertia, [2.0, 0.0, 0.0, 2.0, 0.0, 2.0]);
}

#[test]
fn names_that_are_taken_or_missing_are_made() {
    let reading = accepted(&world("<body name=\"a\"><joint/><joint/><geom size=\"1\"/><site name=\"a\"/><site/></body>"));
    let robot = reading.description;
    assert_eq!(robot.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["a_hinge", "a_hinge_2"]);
    assert_eq!(robot.frames.iter().map(|frame| frame.name.as_str()).collect::<Vec<_>>(), ["a_site", "a_site_2"]);
    assert!(reading.unused.iter().any(|unused| unused.tag == "site name" && unused.line == Some(3)), "{:?}", reading.unused);
}

#[test]
fn what_is_not_used_is_listed_with_its_line() {
    let reading = accepted(
        "<mujoco>\n<option impratio=\"10\"/>\n<visual/>\n<worldbody>\n<light/>\n<body name=\"a\">\n<joint name=\"j\" damping=\"1\"/>\n<geom size=\"1\" rgba=\"1 0 0 1\" friction=\"1\"/>\n</body>\n</worldbody>\n\
         <actuator>\n<muscle joint=\"j\"/>\n</actuator>\n<sensor>\n<gyro site=\"s\"/>\n</sensor>\n</mujoco>",
    );
    let found: Vec<_> = reading.unused.iter().map(|unused| (unused.line.unwrap(), unused.tag.as_str())).collect();
    let expected =
        [(2, "option impratio"), (3, "visual"), (5, "light"), (7, "dynamics damping"), (8, "geom friction"), (12, "muscle"), (15, "gyro")];
    for one in expected {
        assert!(found.contains(&one), "{one:?} in {found:?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:?}");
}

#[test]
fn dynamics_that_are_not_read_are_warnings() {
    let body = |attributes: &str| world(&format!("<body name=\"a\" {attributes}><joint name=\"j\"/><geom size=\"1\"/></body>"));
    let option = |attributes: &str| body("").replace("<worldbody>", &format!("<option {attributes}/><worldbody>"));
    let joint = |attributes: &str| body("").replace("name=\"j\"", attributes);
    let texts = [
        joint("type=\"free\" damping=\"1 2\""),
        joint("stiffness=\"1\" springyield=\"0.1\""),
        joint("type=\"free\" frictionloss=\"1\""),
        joint("actuatorgravcomp=\"true\" actuatorfrcrange=\"-1 1\""),
    ];
    for text in texts {
        let codes: Vec<Code> = accepted(&text).warnings.iter().map(|warning| warning.code).collect();
        assert_eq!(codes, [Code::LostDynamics], "{text}");
    }
    assert!(accepted(&option("gravity=\"0 0 0\"")).warnings.is_empty());
}

/// Damping and stiffness of higher degree are kept, but those that are 0 or turned off.
#[test]
fn coefficients_of_higher_degree_are_kept() {
    let dynamics = |attributes: &str| {
        let joint = format!("<joint name=\"j\" {attributes}/><inertial pos=\"0 0 1\" mass=\"6\" diaginertia=\"13 10 5\"/>");
        accepted(&world(&format!("<body name=\"a\">{joint}</body>"))).description.joints[JointId(0)].dynamics
    };
    let own = dynamics("damping=\"1 2 3\" stiffness=\"4 0 -5\" springref=\"90\"");
    assert_eq!((own.damping, own.damping_terms), (Some(1.0), Some([2.0, 3.0])));
    assert_eq!((own.stiffness, own.stiffness_terms), (Some(4.0), Some([0.0, -5.0])));
    assert_eq!(own.rest, Some(std::f64::consts::FRAC_PI_2));
    assert_eq!(dynamics("damping=\"1 0 0\"").damping_terms, None);
    assert_eq!(dynamics("stiffness=\"0 2\"").stiffness_terms, Some([2.0, 0.0]));
}

/// Compensated weight, the medium, and armature of a free joint: effects of the world.
#[test]
fn what_acts_on_links_is_kept() {
    use articulated_core::effect::EffectId::{added_mass, box_drag, gravity_compensation};
    let reading = accepted(
        &world(
            "<body name=\"a\" gravcomp=\"0.5\"><joint name=\"j\" type=\"free\" damping=\"2\" armature=\"3\"/>\
         <inertial pos=\"0 0 1\" mass=\"6\" diaginertia=\"13 10 5\"/></body>",
        )
        .replace("<worldbody>", "<option density=\"2\" viscosity=\"5\"/><worldbody>"),
    );
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    assert_eq!(reading.description.joints[JointId(0)].dynamics, JointDynamics { damping: Some(2.0), ..JointDynamics::default() });
    let found: Vec<_> = reading.world.effects.iter().map(|(own, _)| (own.effect, own.at.xyz, own.parameters.clone())).collect();
    let isotropic = [3.0, 0.0, 0.0, 3.0, 0.0, 3.0];
    assert_eq!(found[0], (added_mass, [0.0; 3], [&isotropic[..], &isotropic, &[0.0; 9]].concat()));
    assert_eq!(found[1], (gravity_compensation, [0.0, 0.0, 1.0], vec![3.0]));
    // The box has the sides s² = 6 (I_j + I_k − I_i)/m: √2, √8, √18.
    let [x, y, z] = [2.0_f64, 8.0, 18.0].map(f64::sqrt);
    let diameter = (x + y + z) / 3.0;
    let about = |own: f64, one: f64, other: f64| 2.0 * own * (one.powi(4) + other.powi(4)) / 64.0;
    let viscous = [3.0 * std::f64::consts::PI * diameter * 5.0, std::f64::consts::PI * diameter.powi(3) * 5.0];
    let expected = [y * z, z * x, x * y, about(x, y, z), about(y, z, x), about(z, x, y), viscous[0], viscous[1], 0.0, 0.0, 0.0];
    let (effect, at, drag) = &found[2];
    assert_eq!((*effect, *at, found.len()), (box_drag, [0.0, 0.0, 1.0], 3));
    assert!(drag.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-13 * b), "{drag:?} {expected:?}");
}

/// One ellipsoid turns off the box of its body, and the wind is that of all effects.
#[test]
fn a_medium_acts_on_ellipsoids() {
    use articulated_core::effect::EffectId::{box_drag, ellipsoid_drag};
    let of = |geom: &str| {
        let body = format!("<body name=\"a\"><joint name=\"j\"/><geom pos=\"1 0 0\" {geom}/><geom size=\"1\"/></body>");
        let option = "<option density=\"2\" viscosity=\"5\" wind=\"1 2 -3\"/><worldbody>";
        let reading = accepted(&world(&body).replace("<worldbody>", option));
        assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
        let effects = reading.world.effects.into_iter();
        effects.map(|(own, _)| (own.effect, own.at.xyz, own.parameters)).collect::<Vec<_>>()
    };
    let boxes = of("size=\"1\"");
    assert_eq!((boxes.len(), boxes[0].0, &boxes[0].2[8..]), (1, box_drag, &[1.0, 2.0, -3.0][..]));
    let shape = "fluidshape=\"ellipsoid\"";
    let own = |geom: &str| {
        let found = of(&format!("{geom} {shape}"));
        assert_eq!((found.len(), found[0].0, found[0].1), (1, ellipsoid_drag, [1.0, 0.0, 0.0]));
        found[0].2.clone()
    };
    let ball = own("size=\"2\" fluidcoef=\"0.7 0.1\"");
    assert_eq!(ball[..10], [2.0, 2.0, 2.0, 2.0, 5.0, 0.7, 0.1, 1.5, 1.0, 1.0]);
    assert_eq!(ball[16..], [1.0, 2.0, -3.0]);
    let semi_axes = |geom: &str| own(geom)[..3].to_vec();
    assert_eq!(semi_axes("type=\"capsule\" size=\"1 2\""), [1.0, 1.0, 3.0]);
    assert_eq!(semi_axes("type=\"cylinder\" size=\"1 2\""), [1.0, 1.0, 2.0]);
    assert_eq!(semi_axes("type=\"box\" size=\"1 2 3\""), [1.0, 2.0, 3.0]);
    // As MuJoCo 4.0.0 computes `geom_fluid`
    let masses = own("type=\"ellipsoid\" size=\"0.2 0.07 0.11\"");
    let expected = [
        0.0011177547622650073,
        0.007275573809294669,
        0.0030673997292870736,
        3.7887574756163986e-6,
        9.323879657358633e-6,
        3.3892035685152316e-5,
    ];
    assert!(masses[10..16].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-13 * b), "{masses:?}");
}

/// The stiffness of a free joint is a spring to the pose in the file.
#[test]
fn a_free_joint_has_a_tether() {
    use articulated_core::effect::EffectId::tether;
    let of = |attributes: &str, option: &str| {
        let inertial = "<inertial pos=\"0 0 0\" mass=\"6\" diaginertia=\"3 3 3\"/>";
        let body =
            format!("<body name=\"a\" pos=\"1 2 3\" quat=\"1 0 0 2\"><joint name=\"j\" type=\"free\" {attributes}/>{inertial}</body>");
        let reading = accepted(&world(&body).replace("<worldbody>", &format!("<option>{option}</option><worldbody>")));
        assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
        let damping = reading.description.joints[JointId(0)].dynamics.damping;
        (reading.world.effects.into_iter().map(|(own, _)| (own.effect, own.parameters)).collect::<Vec<_>>(), damping)
    };
    let (found, _) = of("stiffness=\"5 6 7\"", "");
    assert_eq!((found.len(), found[0].0, &found[0].1[..9]), (1, tether, &[5.0, 6.0, 7.0, 5.0, 6.0, 7.0, 1.0, 2.0, 3.0][..]));
    let [x, y, z, w] = found[0].1[9..] else { panic!("a quaternion") };
    assert!(x == 0.0 && y == 0.0 && (z - 2.0 * w).abs() < 1e-15);
    assert!(of("stiffness=\"5\"", "<flag spring=\"disable\"/>").0.is_empty());
    assert!(of("stiffness=\"0\"", "").0.is_empty());
    // The mean of the inverse masses is (3/6 + 3/3)/6 = 1/4.
    let (found, damping) = of("springdamper=\"0.5 2\"", "");
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-13 * expected, "{found} {expected}");
    near(found[0].1[0], 4.0 / (0.5_f64 * 2.0).powi(2));
    near(damping.unwrap(), 2.0 * 4.0 / 0.5);
}

#[test]
fn what_acts_on_ball_joints_is_kept() {
    let ball =
        |attributes: &str| world(&format!("<body name=\"a\"><joint name=\"j\" type=\"ball\" {attributes}/><geom size=\"1\"/></body>"));
    let reading =
        accepted(&ball("stiffness=\"3\" damping=\"0.5\" armature=\"0.02\" frictionloss=\"0.1\" springref=\"0.7\" range=\"0 90\""));
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
    let joint = &reading.description.joints[JointId(0)];
    let expected =
        JointDynamics { stiffness: Some(3.0), damping: Some(0.5), armature: Some(0.02), friction: Some(0.1), ..JointDynamics::default() };
    assert_eq!((joint.kind, joint.dynamics), (JointKind::Spherical, expected));
    let limit = joint.limit.expect("a range");
    assert_eq!((limit.lower, limit.upper), (f64::NEG_INFINITY, std::f64::consts::FRAC_PI_2));
    let without = accepted(&ball("")).description.joints[JointId(0)].clone();
    assert_eq!((without.limit, without.dynamics), (None, JointDynamics::default()));
    // As MuJoCo does.
    let found = refused(&ball("range=\"-10 90\""));
    assert_eq!((found.errors.len(), found.errors[0].code), (1, Code::LimitOrder), "{found}");
}

#[test]
fn each_mistake_is_one_error_with_its_line() {
    let body = |inside: &str| world(&format!("<body name=\"a\">{inside}<geom size=\"1\"/></body>"));
    let mistakes = [
        (body("<joint axis=\"0 0 0\"/>"), Code::ZeroAxis, "a vector that is not zero"),
        (body("<joint typ=\"hinge\"/>"), Code::Unknown, "type, perhaps"),
        (body("<jiont/>"), Code::Unknown, "joint, perhaps"),
        (body("<joint type=\"revolute\"/>"), Code::Word, "free, ball, slide, hinge"),
        (body("<joint range=\"1 0\" limited=\"true\"/>"), Code::LimitOrder, "1 and 0"),
        (body("<joint pos=\"1 0\"/>"), Code::WrongCount, "3 numbers"),
        (body("<joint pos=\"1 0 x\"/>"), Code::NotANumber, "\"x\""),
        (body("<joint class=\"b\"/>"), Code::UnknownName, "the name of a default class"),
        (body("<geom type=\"mesh\" mesh=\"m\"/>"), Code::UnknownName, "the name of a mesh"),
        (body("<geom size=\"-1\"/>"), Code::Number, "above zero"),
        (body("<geom size=\"1\" quat=\"1 0 0 0\" euler=\"0 0 0\"/>"), Code::TwoRotations, "quat and euler"),
        (body("<geom size=\"1\" quat=\"0 0 0 0\"/>"), Code::ZeroAxis, "a quaternion that is not zero"),
        (body("<inertial mass=\"1\"/>"), Code::MissingAttribute, "the attribute pos in <inertial>"),
        (body("<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 3\"/>"), Code::InertiaTriangle, "balanceinertia"),
        (body("<body name=\"a\"/>"), Code::DuplicateName, "a second body"),
        (body("<body name=\"b\"><freejoint/></body>"), Code::Misplaced, "a free joint inside a moving body"),
        (body("<include file=\"b.xml\"/>"), Code::File, "b.xml"),
        (body("<attach model=\"b\" prefix=\"\"/>"), Code::UnknownName, "<model>"),
        (body("<replicate/>"), Code::MissingAttribute, "how many copies"),
    ];
    for (text, code, part) in mistakes {
        let found = refused(&text);
        assert_eq!(found.errors.len(), 1, "{found}\n{text}");
        let error = &found.errors[0];
        assert_eq!((error.code, error.line(), error.file()), (code, Some(3), "robots/arm.xml"), "{found}");
        assert!(found.to_string().contains(part), "{part}: {found}");
    }
    assert_eq!(refused("<mujoco><compiler coordinate=\"global\"/></mujoco>").errors[0].code, Code::Unsupported);
}

const MAIN: &str = "<mujoco><include file=\"parts/common.xml\"/><worldbody><body name=\"a\"><joint/><geom class=\"big\"/><geom type=\"mesh\" mesh=\"m\"/></body></worldbody></mujoco>";
const COMMON: &str =
    "<mujoco>\n<default><default class=\"big\"><geom size=\"2\"/></default></default>\n<include file=\"more.xml\"/>\n</mujoco>";
const MORE: &str = "<mujocoinclude><asset><mesh file=\"m.obj\"/></asset></mujocoinclude>";
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

#[test]
fn included_files_are_in_the_place_of_their_tags() {
    let files = Files::of(&[("robots/parts/common.xml", COMMON), ("robots/parts/more.xml", MORE), ("robots/m.obj", MESH)]);
    let reading = read_with(&files, MAIN.as_bytes(), &options()).unwrap();
    let mass = reading.description.links[LinkId(1)].inertial.unwrap().mass;
    assert!((mass - 1000.0 * (32.0 * std::f64::consts::PI / 3.0 + 1.0 / 6.0)).abs() < 1e-9, "{mass}");
    // Recorded files give the same result as the original ones.
    let kept = included(&files, Path::new(""), MAIN.as_bytes(), &options());
    let names: Vec<_> = kept.files().map(|(path, _)| path.to_str().unwrap()).collect();
    assert_eq!(names, ["robots/m.obj", "robots/parts/common.xml", "robots/parts/more.xml"]);
    assert_eq!(read_with(&kept, MAIN.as_bytes(), &options()).unwrap().description, reading.description);
    assert_eq!(included(&NoFiles, Path::new(""), b"<robot name='r'><link name='a'/></robot>", &options()), Included::default());
}

#[test]
fn mistakes_in_included_files_name_them() {
    let broken = COMMON.replace("size=\"2\"", "size=\"2 x\"");
    let files = Files::of(&[("robots/parts/common.xml", &broken), ("robots/parts/more.xml", "<mujoco>"), ("robots/m.obj", MESH)]);
    let found = read_with(&files, MAIN.as_bytes(), &options()).unwrap_err().to_string();
    for part in ["robots/parts/common.xml:2: geom", "robots/parts/more.xml:1: XML", "robots/arm.xml:1: mesh"] {
        assert!(found.contains(part) || part.contains("geom") && found.contains("robots/parts/common.xml:2: size"), "{part} in {found}");
    }
    let twice = MAIN.replace("<worldbody>", "<include file=\"parts/common.xml\"/><worldbody>");
    let files = Files::of(&[("robots/parts/common.xml", COMMON), ("robots/parts/more.xml", MORE), ("robots/m.obj", MESH)]);
    let found = read_with(&files, twice.as_bytes(), &options()).unwrap_err();
    assert!(found.to_string().contains("included already"), "{found}");
}

#[test]
fn a_mesh_that_gives_no_mass_is_not_read() {
    let text = "<mujoco><asset><mesh name=\"m\" file=\"none.stl\"/></asset><worldbody><body name=\"a\"><joint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/><geom type=\"mesh\" mesh=\"m\"/></body></worldbody></mujoco>";
    assert_eq!(described(text).links[LinkId(1)].visual.len(), 1);
    let without = text.replace("<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>", "");
    assert_eq!(refused(&without).errors[0].code, Code::File);
}

#[test]
fn models_are_attached_with_their_own_settings() {
    let main = "<mujoco><compiler angle=\"radian\"/><asset><model name=\"m\" file=\"m.xml\"/></asset><worldbody>
        <body name=\"a\"><joint/><geom size=\"1\"/><frame pos=\"0 0 1\"><attach model=\"m\" body=\"hand\" prefix=\"left_\"/></frame></body></worldbody></mujoco>";
    let model = "<mujoco><worldbody><body name=\"hand\" euler=\"0 0 90\"><joint name=\"j\" range=\"0 180\"/><geom size=\"1\"/></body></worldbody></mujoco>";
    let robot = read_with(&Files::of(&[("robots/m.xml", model)]), main.as_bytes(), &options()).unwrap().description;
    let joint = &robot.joints[robot.joint("left_j").unwrap()];
    assert_eq!(joint.limit.unwrap().upper, std::f64::consts::PI);
    assert_eq!(placement(&robot, "left_hand", &[0.0, 0.0])[..3], [0.0, -1.0, 0.0]);
    // A model that attaches itself ends.
    let endless = model.replace("<geom", "<attach body=\"hand\" prefix=\"x\"/><attach body=\"hand\" prefix=\"y\"/><geom");
    assert_eq!(refused(&endless).errors[0].code, Code::TooLarge);
}

#[test]
fn copies_and_depth_are_bounded() {
    let copies = |inside: &str| world(&format!("<replicate count=\"1000000\">{inside}</replicate>"));
    let nested = copies("<replicate count=\"1000000\"><replicate count=\"1000000\"><geom size=\"1\"/></replicate></replicate>");
    assert_eq!(refused(&nested).errors[0].code, Code::TooLarge);
    assert_eq!(refused(&copies("")).errors[0].code, Code::TooLarge);
    let deep = world(&format!("{}{}", "<body>".repeat(250), "</body>".repeat(250)));
    assert_eq!(described(&deep).links.len(), 251);
    let deeper = world(&format!("{}{}", "<body>".repeat(300), "</body>".repeat(300)));
    assert_eq!(refused(&deeper).errors[0].code, Code::TooLarge);
}

#[test]
fn copies_are_bounded_in_number_and_in_the_length_of_their_names() {
    let document = |world: &str| format!("<mujoco><worldbody>{world}</worldbody></mujoco>");
    let has = |text: &str, found: &str| {
        let errors = refused(text).errors;
        assert!(errors.iter().any(|error| error.code == Code::TooLarge && error.found.contains(found)), "{errors:?}");
    };
    // A frame that attaches itself twice: 2¹⁶ copies, with duplicate names of bodies.
    let twice = "<frame name=\"f\"><attach frame=\"f\"/><attach frame=\"f\"/><body name=\"b\"/></frame>";
    has(&document(twice), "models in models");
    let long = "s".repeat(100_000);
    has(&document(&format!("<replicate count=\"90000\" sep=\"{long}\"><body name=\"b\"/></replicate>")), "very long names");
    has(&document(&format!("<replicate count=\"40000\"><body name=\"{long}\"/></replicate>")), "very long names");
    // The name of an actuator is also too long, if there are very many copies of it.
    let copies =
        "<replicate count=\"20000\"><body><joint name=\"j\"/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/></body></replicate>";
    let actuator = format!("<actuator><motor name=\"{long}\" joint=\"j\"/></actuator></mujoco>");
    has(&document(copies).replace("</mujoco>", &actuator), "very many copies");
}

#[test]
fn no_part_of_a_file_makes_the_reader_panic() {
    let text = include_str!("corpus/mjcf/arm.xml");
    assert!(accepted(text).warnings.len() < 3);
    for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
        drop(read(&text.as_bytes()[..end], &options()));
    }
    for word in ["0", "1e308", "-1", "", "1 2 3", "true", "<", "nan"] {
        for (start, _) in text.match_indices("=\"") {
            let end = start + 2 + text[start + 2..].find('"').unwrap();
            drop(read(format!("{}{word}{}", &text[..start + 2], &text[end..]).as_bytes(), &options()));
        }
    }
}

/// `DOCUMENTS=1000000 cargo test --release -p articulated-formats --test mjcf random` makes more.
#[test]
fn random_documents_are_robots_or_lists_of_mistakes() {
    let count: u64 = std::env::var("DOCUMENTS").ok().and_then(|count| count.parse().ok()).unwrap_or(2000);
    let (mut state, mut robots) = (0x2545_f491_4f6c_dd1d_u64, 0);
    let mut next = move || {
        // xorshift64
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    for _ in 0..count {
        let bytes: Vec<u8> = (0..next() % 400).map(|_| (next() >> 32) as u8).collect();
        let text = grammar::document(&bytes);
        let start = std::time::Instant::now();
        match read(text.as_bytes(), &options()) {
            Ok(reading) => {
                robots += 1;
                drop(Model::<f64>::new(&reading.description, Base::Fixed));
            }
            Err(found) => assert!(!found.errors.is_empty()),
        }
        assert!(start.elapsed().as_secs() < 30, "{text}");
    }
    assert!(robots > 0);
}
