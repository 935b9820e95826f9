//! MJCF: masses and frames of bodies. The expected numbers are MuJoCo's (4.0.0).

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Inertial, JointId, Origin};
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_core::model::Model;
use articulated_formats::{Options, Reading, Sources, read_with};

/// Files by their names.
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
    Options { file: "arm.xml".to_owned(), ..Options::default() }
}

fn accepted_with(files: &[(&str, &str)], text: &str) -> Reading {
    read_with(&Files::of(files), text.as_bytes(), &options()).unwrap_or_else(|found| panic!("{found}\n{text}"))
}

fn accepted(text: &str) -> Reading {
    accepted_with(&[], text)
}

fn refused(text: &str) -> Diagnostics {
    read_with(&Files::of(&[]), text.as_bytes(), &options()).map(|_| ()).expect_err(text)
}

fn inertial(reading: &Reading, link: &str) -> Inertial {
    let link = reading.description.links.iter().find(|own| own.name == link).expect("a link of this name");
    link.inertial.expect("a mass")
}

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12 * b.abs().max(1.0))
}

/// A free body of two shapes, without children.
fn brick(compiler: &str, joint: &str) -> String {
    format!(
        "<mujoco><compiler {compiler}/><worldbody><body name=\"brick\" pos=\"1 2 3\" euler=\"40 50 60\">{joint}
         <geom type=\"box\" size=\"0.2 0.1 0.3\" pos=\"0.1 -0.2 0.05\" euler=\"15 25 35\"/>
         <geom type=\"capsule\" size=\"0.05 0.2\" pos=\"-0.1 0.3 0.2\" euler=\"70 10 20\"/>
         <site name=\"corner\" pos=\"0.3 0.1 0.2\"/></body></worldbody>
         <keyframe><key name=\"spin\" qpos=\"0 0 2 1 0 0 0\" qvel=\"1 2 3 4 5 6\"/></keyframe></mujoco>"
    )
}

/// The kinetic energy of the keyframe, J, and where the site is then, m.
fn state_of_keyframe(reading: &Reading) -> (f64, [f64; 3]) {
    let model: Model<f64> = Model::new(&reading.description, Base::Fixed).unwrap();
    let key = &reading.world.keyframes[0];
    let (q, v) = (&key.q[0].1, &key.v[0].1);
    let call = |name: &str| {
        let row = function::<f64>(name).unwrap();
        let mut out = vec![0.0; row.len(model.shape())];
        row.call(&model, &mut Workspace::new(&model), &[q], &mut out).unwrap();
        out
    };
    let matrix = call("mass_matrix");
    let energy: f64 = (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).map(|(i, j)| 0.5 * v[i] * matrix[6 * i + j] * v[j]).sum();
    let places = call("placements");
    let frame = model.frames().iter().position(|frame| frame.name == "corner").unwrap();
    (energy, [9, 10, 11].map(|k| places[12 * frame + k]))
}

#[test]
fn the_frame_of_an_aligned_free_body_is_that_of_its_inertia() {
    let aligned =
        [("", "<freejoint align=\"true\"/>"), ("alignfree=\"true\"", "<freejoint/>"), ("alignfree=\"true\"", "<joint type=\"free\"/>")];
    for (compiler, joint) in aligned {
        let reading = accepted(&brick(compiler, joint));
        let own = inertial(&reading, "brick");
        assert_eq!(own.origin, Origin::default(), "{joint}");
        assert!(near(&[own.mass], &[51.6651914291881]), "{own:?}");
        assert!(near(&own.inertia, &[2.786579840556844, 0.0, 0.0, 2.16537182872648, 0.0, 1.7992272325155856]), "{own:?}");
        let home = &reading.world.home.as_ref().unwrap().q[0].1;
        let expected = [
            1.1656218504825526,
            2.0601428190971047,
            2.915957298602105,
            0.5532128142416679,
            0.5204318108854222,
            0.5515282412668601,
            0.34485201385872405,
        ];
        assert!(near(home, &expected), "{home:?}");
        let (energy, corner) = state_of_keyframe(&reading);
        assert!(near(&[energy], &[443.4022167731328]), "{energy}");
        assert!(near(&corner, &[0.20256223855694475, 0.30698556687817047, 1.9987021701416117]), "{corner:?}");
        assert!(reading.unused.iter().all(|unused| !unused.tag.contains("align")), "{:?}", reading.unused);
    }
    // As written: the file turns it off, or another body is on it.
    let plain = accepted(&brick("alignfree=\"true\"", "<freejoint align=\"false\"/>"));
    let (energy, corner) = state_of_keyframe(&plain);
    assert!(near(&[energy], &[448.0194917929864]) && near(&corner, &[0.3, 0.1, 2.2]), "{energy} {corner:?}");
    let with_child = brick("alignfree=\"true\"", "<freejoint/>").replace("<site", "<body name=\"child\"/><site");
    assert_eq!(accepted(&with_child).world.home.unwrap().q[0].1[..3], [1.0, 2.0, 3.0]);
}

#[test]
fn axes_of_a_diagonal_inertia_are_those_of_the_file() {
    // MuJoCo sorts only moments that it computes.
    let text = "<mujoco><worldbody><body name=\"b\" pos=\"1 2 3\"><freejoint align=\"true\"/>
        <inertial pos=\"0.5 0 0\" mass=\"2\" diaginertia=\"0.3 0.5 0.4\"/></body></worldbody></mujoco>";
    let reading = accepted(text);
    assert_eq!(inertial(&reading, "b").inertia, [0.3, 0.0, 0.0, 0.5, 0.0, 0.4]);
    assert_eq!(reading.world.home.unwrap().q[0].1, [1.5, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]);
    let sorted = accepted(&text.replace("diaginertia=\"0.3 0.5 0.4\"", "fullinertia=\"0.3 0.5 0.4 0 0 0\""));
    let found = inertial(&sorted, "b").inertia;
    assert!(near(&found, &[0.5, 0.0, 0.0, 0.4, 0.0, 0.3]), "{found:?}");
}

#[test]
fn a_height_field_has_the_mass_of_its_box() {
    let field = |size: &str, attributes: &str| {
        format!(
            "<mujoco><asset><hfield name=\"hills\" nrow=\"2\" ncol=\"2\" {size} elevation=\"0 1 2 3\"/></asset><worldbody>
             <body name=\"table\"><joint axis=\"0 1 0\"/><geom type=\"hfield\" hfield=\"hills\" pos=\"0.1 0.2 0.3\" {attributes}/></body></worldbody></mujoco>"
        )
    };
    let size = "size=\"2 1 0.8 0.2\"";
    let cases = [
        ("density=\"2\"", 9.6, [3.488, 13.088, 16.0]),
        ("mass=\"5\"", 5.0, [1.8166666666666667, 6.816666666666666, 8.333333333333334]),
        ("density=\"2\" shellinertia=\"true\"", 46.4, [25.17866666666667, 77.97866666666667, 96.53333333333333]),
    ];
    for (attributes, mass, [x, y, z]) in cases {
        let own = inertial(&accepted(&field(size, attributes)), "table");
        assert_eq!(own.origin.xyz, [0.1, 0.2, 0.3]);
        assert!(near(&[own.mass], &[mass]) && near(&own.inertia, &[x, 0.0, 0.0, y, 0.0, z]), "{attributes}: {own:?}");
    }
    let cases = [
        (field("", ""), Code::Number, "4 numbers above zero"),
        (field(size, "").replace("hfield=\"hills\"", ""), Code::MissingAttribute, "the name of a height field"),
        (field(size, "").replace("hfield=\"hills\"", "hfield=\"hill\""), Code::UnknownName, "did you mean \"hills\""),
        (field(size, "").replace("type=\"hfield\"", "size=\"1\""), Code::Together, "a height field in another shape"),
    ];
    for (text, code, part) in cases {
        let found = refused(&text);
        assert_eq!((found.errors.len(), found.errors[0].code), (1, code), "{found}");
        assert!(found.to_string().contains(part), "{found}");
    }
}

#[test]
fn a_mesh_of_several_objects_is_the_first() {
    let first = "v 0 0 0\nv 0.4 0 0\nv 0 0.3 0\nv 0 0 0.5\n{1}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n{2}\n\
                 v 1 1 1\nv 1.4 1 1\nv 1 1.3 1\nv 1 1 1.5\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    let obj = |one: &str, two: &str| first.replace("{1}", one).replace("{2}", two);
    let text = "<mujoco><asset><mesh name=\"m\" file=\"two.obj\" inertia=\"exact\"/><mesh name=\"hull\" file=\"two.obj\" inertia=\"convex\"/></asset><worldbody>
        <body name=\"a\"><joint/><geom type=\"mesh\" mesh=\"m\" density=\"100\"/></body>
        <body name=\"b\"><joint/><geom type=\"mesh\" mesh=\"hull\" density=\"100\"/></body></worldbody></mujoco>";
    for (one, two) in [("o left", "o right"), ("g left", "  g\tright"), ("o left\ng left", "o right")] {
        let reading = accepted_with(&[("two.obj", &obj(one, two))], text);
        assert!((inertial(&reading, "a").mass - 1.0000000546375918).abs() < 1e-9, "{one}");
        // A hull surrounds all vertices, including those of other objects.
        assert!((inertial(&reading, "b").mass - 24.499999115864462).abs() < 1e-8, "{one}");
        let found: Vec<String> = reading.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].contains("two.obj") && found[0].contains("the first one alone gives the mass"), "{found:?}");
    }
    // A material or a smoothing group begins no object, and neither does an `o` without a name.
    for (one, two) in [("usemtl red", "usemtl blue"), ("s 1", "s 2"), ("", "o"), ("", "object b")] {
        let reading = accepted_with(&[("two.obj", &obj(one, two))], text);
        assert!((inertial(&reading, "a").mass - 2.0).abs() < 1e-6 && reading.warnings.is_empty(), "{two}: {:?}", reading.warnings);
    }
}

const WEDGE: &str = "v 0 0 0\nv 0.4 0 0.1\nv 0.1 0.3 0\nv 0.1 0.1 0.5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn shapes_are_fitted_to_meshes_as_the_main_file_says() {
    let cases = [
        ("true", "false", 6.357800616448698, [0.21405600187345394, 0.04998840187966925, 0.23318957176734872]),
        ("false", "true", 1.3477982768509658, [0.1500000022351742, 0.10000000335276128, 0.15000000037252906]),
    ];
    for (own, other, mass, center) in cases {
        let kid = format!(
            "<mujoco><compiler fitaabb=\"{other}\"/><asset><mesh name=\"w\" file=\"wedge.obj\"/></asset><worldbody><body name=\"b\"><joint/>
             <geom type=\"box\" mesh=\"w\" density=\"100\"/></body></worldbody></mujoco>"
        );
        let main = format!(
            "<mujoco><compiler fitaabb=\"{own}\"/><asset><model name=\"kid\" file=\"kid.xml\"/></asset><worldbody>
             <attach model=\"kid\" body=\"b\" prefix=\"k_\"/></worldbody></mujoco>"
        );
        let found = inertial(&accepted_with(&[("kid.xml", &kid), ("wedge.obj", WEDGE)], &main), "k_b");
        assert!(near(&[found.mass], &[mass]) && near(&found.origin.xyz, &center), "{own}: {found:?}");
    }
}

#[test]
fn a_shape_that_cannot_be_fitted_is_an_error() {
    let fitted = |geom: &str| {
        let text = format!(
            "<mujoco><compiler fitaabb=\"true\"/><asset><mesh name=\"w\" vertex=\"0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\"/></asset>
             <worldbody><body><joint/><geom mesh=\"w\" {geom}/></body></worldbody></mujoco>"
        );
        let found = refused(&text);
        assert_eq!(found.errors.len(), 1, "{found}");
        found.to_string()
    };
    // A capsule around a cube would be a sphere.
    assert!(fitted("type=\"capsule\"").contains("the mesh is too flat"));
    assert!(fitted("type=\"plane\"").contains("a plane or a height field with a mesh"));
    assert!(fitted("type=\"box\" fromto=\"0 0 0 1 0 0\"").contains("both mesh and fromto"));
    assert!(fitted("type=\"mesh\" shellinertia=\"true\"").contains("a mesh with shellinertia"));
}

#[test]
fn a_mass_without_inertia_does_not_move() {
    let body = |joint: &str, inside: &str| {
        format!(
            "<mujoco><worldbody><body name=\"b\">{joint}\n<inertial pos=\"1 0 0\" mass=\"3\"/>{inside}<geom size=\"0.1\"/></body></worldbody></mujoco>"
        )
    };
    let found = refused(&body("<joint name=\"j\"/>", ""));
    assert_eq!((found.errors.len(), found.errors[0].code, found.errors[0].line()), (1, Code::MissingAttribute, Some(2)), "{found}");
    assert!(found.to_string().contains("a mass without inertia, expected diaginertia or fullinertia"), "{found}");
    // For a body that carries it as well
    let carried = body("", "").replace("<worldbody>", "<worldbody><body><joint/>").replace("</worldbody>", "</body></worldbody>");
    assert_eq!(refused(&carried).errors[0].code, Code::MissingAttribute);
    // As in MuJoCo: on a body that does not move, with another body that has inertia, or unused.
    let accepts = [
        body("", ""),
        body("<joint/>", "<body><geom size=\"0.1\"/></body>"),
        body("<joint/>", "").replace("<worldbody>", "<compiler boundinertia=\"0.01\"/><worldbody>"),
        body("<joint/>", "").replace("<worldbody>", "<compiler inertiafromgeom=\"true\"/><worldbody>"),
    ];
    accepts.iter().for_each(|text| drop(accepted(text)));
    // The joint of a child moves another body.
    let other = body("<joint/>", "<body><joint/><geom size=\"0.1\"/></body>");
    assert_eq!(refused(&other).errors.len(), 1);
}

#[test]
fn an_empty_list_is_an_absent_one() {
    let text = "<mujoco><default><joint damping=\"2\"/><geom size=\"0.1\"/></default><worldbody><body name=\"b\" pos=\"\" quat=\"\">
        <joint name=\"j\" axis=\"\" range=\"\" ref=\"\" damping=\"\" stiffness=\" \"/>
        <geom rgba=\"\" size=\"\" mass=\"\" density=\"\" contype=\"\" fromto=\"\" pos=\"0.1 0 0\"/></body></worldbody></mujoco>";
    let reading = accepted(text);
    assert!(near(&[inertial(&reading, "b").mass], &[4.1887902047863905]));
    let joint = &reading.description.joints[JointId(0)];
    assert_eq!((joint.axis, joint.dynamics.damping, joint.dynamics.stiffness), ([0.0, 0.0, 1.0], Some(2.0), None));
    let found =
        refused(&text.replace("size=\"\"", "size=\"0.1\"").replace("<joint name=\"j\"", "<inertial pos=\"\" mass=\"\"/><joint name=\"j\""));
    assert_eq!(found.errors.iter().map(|error| error.code).collect::<Vec<_>>(), [Code::MissingAttribute; 2], "{found}");
}

#[test]
fn a_number_that_is_not_used_is_not_parsed() {
    let body = |inside: &str| format!("<mujoco><worldbody><body>{inside}</body></worldbody></mujoco>");
    let texts = [
        body(
            "<joint type=\"free\" pos=\"x\" axis=\"x\" range=\"x\" ref=\"x\" springref=\"x\" actuatorfrcrange=\"x\"/><geom size=\"0.1\"/>",
        ),
        body("<joint type=\"ball\" axis=\"x\" ref=\"x\" springref=\"x\" actuatorfrcrange=\"x\"/><geom size=\"0.1\"/>"),
        body("<joint/><geom size=\"0.1\" mass=\"1\" density=\"x\" fitscale=\"x\"/>"),
        body("<joint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/><geom type=\"mesh\" mesh=\"m\" size=\"x\"/>")
            .replace("<worldbody>", "<asset><mesh name=\"m\" file=\"none.stl\" scale=\"x\"/></asset><worldbody>"),
    ];
    texts.iter().for_each(|text| drop(accepted(text)));
}
