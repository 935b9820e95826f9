//! Contact from collision geometry, and the command's warnings about links that fall through the
//! ground.

use crate::{File, run};

/// A trunk on a leg. Only the foot has contact, so the robot falls to its side and its trunk falls
/// through the floor.
const ROBOT: &str = "<robot name='r'><link name='trunk'><inertial><mass value='5'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>
    <collision><geometry><box size='0.4 0.2 0.2'/></geometry></collision></link>
  <link name='foot'><inertial><mass value='0.5'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial>
    <collision><geometry><sphere radius='0.05'/></geometry></collision></link>
  <link name='hand'><inertial><mass value='0.1'/><inertia ixx='0.001' ixy='0' ixz='0' iyy='0.001' iyz='0' izz='0.001'/></inertial>
    <collision><geometry><mesh filename='hand.stl'/></geometry></collision></link>
  <joint name='hip' type='continuous'><parent link='trunk'/><child link='foot'/><origin xyz='0 0 -0.5'/><axis xyz='0 1 0'/></joint>
  <joint name='wrist' type='continuous'><parent link='trunk'/><child link='hand'/><origin xyz='0 0 0.2'/><axis xyz='0 1 0'/></joint></robot>";

fn scene(urdf: &File, z: f64, effects: &str) -> File {
    let text = format!(
        "urdf = {:?}\nbase = 'floating'\n[initial]\nbase = {{ xyz = [0, 0, {z}], rpy = [0.2, 0, 0] }}\n[simulation]\nend = 1.5\nintegrator = 'rodas4'\n{effects}",
        urdf.name()
    );
    File::new("fall.toml", text.as_bytes())
}

const FOOT: &str = "[effects.contact.foot]\nradius = 0.05\nstiffness = 1e4\ndamping = 1\nfriction = 0.5\n";
const ALL: &str = "[effects.contact]\nfrom = 'collision'\nstiffness = 1e4\ndamping = 1\nfriction = 0.5\n";

#[test]
fn a_link_that_falls_through_the_ground_is_warned_of_by_simulate() {
    let urdf = File::new("r.urdf", ROBOT.as_bytes());
    let scene = scene(&urdf, 0.6, FOOT);
    let ended = run(&["simulate", scene.name(), "--format", "json"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let warnings = ended.json()["warnings"].clone();
    let told: Vec<&str> =
        warnings.as_array().unwrap().iter().map(|w| w.as_str().unwrap()).filter(|w| w.contains("below a contact plane")).collect();
    let [told] = told[..] else { panic!("{warnings}") };
    for part in ["found 2 links that go below", "\"trunk\" from t = ", "\"hand\" from t = ", " m deep at t = ", "`from = \"collision\"`"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(ended.err.contains(told), "{}", ended.err);
    // It starts above: `check` reports nothing.
    assert!(!run(&["check", scene.name()]).out.contains("below a contact plane"));
}

#[test]
fn a_start_below_the_ground_is_warned_of_by_check_and_simulate() {
    let urdf = File::new("r.urdf", ROBOT.as_bytes());
    let scene = scene(&urdf, -0.3, FOOT);
    for ended in [run(&["check", scene.name()]), run(&["simulate", scene.name()])] {
        let said = format!("{}{}", ended.out, ended.err);
        assert!(
            ended.status == 0 && said.contains("links below a contact plane at the start where no contact holds them: \"trunk\" ("),
            "{said}"
        );
    }
}

/// An STL of the box from −size to size, with a grid of vertices on two of its sides.
fn stl([a, b, c]: [f32; 3]) -> Vec<u8> {
    let side = |z: f32| (0..16).map(move |k| [a * (2.0 * (k % 4) as f32 / 3.0 - 1.0), b * (2.0 * (k / 4) as f32 / 3.0 - 1.0), z]);
    let vertices: Vec<[f32; 3]> = side(-c).chain(side(c)).chain([[0.0; 3]]).collect();
    let mut bytes = vec![0; 80];
    bytes.extend((vertices.len() as u32 / 3).to_le_bytes());
    for face in vertices.chunks_exact(3) {
        bytes.extend([0; 12]);
        bytes.extend(face.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// The mesh lies in a package that its `package.xml` declares, and in words beside the robot.
#[test]
fn a_mesh_touches_the_ground_on_the_points_of_its_hull() {
    const MASS: &str = "<inertial><mass value='2'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>";
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let robot =
        |mesh: &str| format!("<robot name='r'><link name='stone'>{MASS}<collision><geometry>{mesh}</geometry></collision></link></robot>");
    write("things/package.xml", b"<package><name>stones</name></package>");
    write("things/meshes/stone.STL", &stl([300.0, 200.0, 100.0]));
    let words: String =
        [-0.3, 0.3].map(|x| [-0.2, 0.2].map(|y| [-0.1, 0.1].map(|z| format!("vertex {x} {y} {z}\n")))).concat().concat().concat();
    write("things/urdf/stone.stl", format!("solid stone\n{words}").as_bytes());
    let law = "[effects.contact]\nfrom = 'collision'\nstiffness = 1e4\ndamping_time = 2e-2\nfriction = 0.5\n";
    let states = ["package://stones/meshes/stone.STL' scale='0.001 0.001 0.001", "stone.stl"].map(|file| {
        write("things/urdf/stone.urdf", robot(&format!("<mesh filename='{file}'/>")).as_bytes());
        let scene = write("things/urdf/s.toml", format!("urdf = 'stone.urdf'\nbase = 'floating'\n[initial]\nbase = {{ xyz = [0, 0, 0.15] }}\n[simulation]\nend = 2\nintegrator = 'rodas4'\n{law}").as_bytes());
        let ended = run(&["simulate", &scene, "--format", "json"]);
        assert_eq!((ended.status, ended.json()["warnings"].as_array().map_or(0, Vec::len)), (0, 0), "{}", ended.err);
        assert_eq!(run(&["effects", &scene]).out.matches("stone: radius 0 m (file: collision)").count(), 8);
        ended.json()["energy"]["potential_end"].as_f64().unwrap() / (2.0 * 9.81)
    });
    // On four corners m g = 4 k d, and the springs have the energy 4 k d²/2 = m g d/2.
    let sunk = 2.0 * 9.81 / (4.0 * 1e4);
    let rest = 0.1 - sunk + sunk / 2.0;
    assert!(states.iter().all(|z| (z - rest).abs() < 1e-6), "{states:?} {rest}");
}

#[test]
fn contact_of_geometry_keeps_the_robot_above_the_ground_and_names_meshes() {
    let urdf = File::new("r.urdf", ROBOT.as_bytes());
    let scene = scene(&urdf, 0.6, ALL);
    let ended = run(&["simulate", scene.name(), "--format", "json"]);
    let report = ended.json();
    let warnings = report["warnings"].as_array().unwrap();
    assert!(
        ended.status == 0
            && warnings.iter().any(|w| w.as_str().unwrap().contains("link \"hand\": effects.contact: found a mesh that makes no contact")),
        "{report}"
    );
    assert!(warnings.iter().all(|w| !w.as_str().unwrap().contains("\"trunk\" from t")), "{report}");
    let out = run(&["check", scene.name()]).out;
    assert!(out.contains("link \"hand\": effects.contact: found a mesh that makes no contact"), "{out}");
    assert_eq!(out.lines().filter(|line| line.contains("collision: no effect of a scene takes it")).count(), 1, "{out}");
    // The head of generated code has it too.
    let generated = run(&["generate", scene.name(), "--functions", "forward_dynamics"]);
    assert!(generated.status == 0 && generated.out.contains("found a mesh that makes no contact"), "{}", generated.err);
}
