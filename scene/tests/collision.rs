//! `contact.from = "collision"`: contact of the geometry that a robot's file has.

use articulated_core::description::{Base, Collision};
use articulated_core::diagnostic::{Code, Diagnostics, Subject};
use articulated_core::effect::{Applied, EffectId};
use articulated_formats::{Options, Reading, read};
use articulated_scene::{Edited, Resolved, Scene};

/// A trunk that is a box with a ball; a shin with a capsule, and a sole without mass fixed to it
/// that is a plate; a hand of a mesh, and one of a mesh and a ball; a bare link.
const ROBOT: &str = r#"<robot name="r">
  <link name="trunk"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><origin xyz="0 0 0.5"/><geometry><box size="2 4 6"/></geometry></collision>
    <collision><geometry><sphere radius="0.75"/></geometry></collision></link>
  <link name="shin"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><capsule radius="0.1" length="2"/></geometry></collision></link>
  <link name="sole"><collision><geometry><box size="2 2 0"/></geometry></collision></link>
  <link name="hand"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><mesh filename="hand.stl"/></geometry></collision></link>
  <link name="palm"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><mesh filename="palm.stl"/></geometry></collision>
    <collision><geometry><sphere radius="0.5"/></geometry></collision></link>
  <link name="bare"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="knee" type="continuous"><parent link="trunk"/><child link="shin"/></joint>
  <joint name="ankle" type="fixed"><parent link="shin"/><child link="sole"/></joint>
  <joint name="wrist" type="continuous"><parent link="trunk"/><child link="hand"/></joint>
  <joint name="other" type="continuous"><parent link="trunk"/><child link="palm"/></joint>
  <joint name="last" type="continuous"><parent link="trunk"/><child link="bare"/></joint>
</robot>"#;

fn reading(urdf: &str) -> Reading {
    read(urdf.as_bytes(), &Options { file: "r.urdf".into(), base: Base::Floating, ..Options::default() }).unwrap_or_else(|e| panic!("{e}"))
}

fn resolve_on(urdf: &str, text: &str, base: Base) -> Result<Resolved, Diagnostics> {
    let reading = reading(urdf);
    let scene = Scene::read("s.toml", text).unwrap_or_else(|e| panic!("{e}"));
    scene.resolve(&Edited {
        description: &reading.description,
        file: "r.urdf",
        base,
        unused: &reading.unused,
        world: &reading.world,
        shafts: &[],
    })
}

fn resolved(text: &str) -> Resolved {
    resolve_on(ROBOT, text, Base::Floating).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    resolve_on(ROBOT, text, Base::Floating).unwrap_err().to_string()
}

/// Link, centre and radius of each sphere.
fn spheres(resolved: &Resolved) -> Vec<(&str, [f64; 3], f64)> {
    resolved.effects.iter().filter(|a| a.effect == EffectId::contact).map(|a| (a.on.as_str(), a.at.xyz, a.parameters[0])).collect()
}

const LAW: &str = "stiffness = 1e4\ndamping = 1\nfriction = 0.5\n";

/// The law of each point is the scene's, and the geometry is used.
#[test]
fn all_links_with_shapes_get_a_contact_for_each_of_their_points() {
    let resolved = resolved(&format!("[effects.contact]\nfrom = 'collision'\n{LAW}height = 0.25"));
    let found = spheres(&resolved);
    let of = |link: &str| -> Vec<([f64; 3], f64)> { found.iter().filter(|(on, ..)| *on == link).map(|(_, at, r)| (*at, *r)).collect() };
    let corners = [-1.0, 1.0].map(|z| [-1.0, 1.0].map(|y| [-1.0, 1.0].map(|x| ([x, 2.0 * y, 3.0 * z + 0.5], 0.0))));
    let trunk = [corners.as_flattened().as_flattened(), &[([0.0; 3], 0.75)]].concat();
    assert_eq!(of("trunk"), trunk);
    assert_eq!(of("shin"), [([0.0, 0.0, -1.0], 0.1), ([0.0, 0.0, 1.0], 0.1)]);
    // A link without mass, which has this foot, too.
    assert_eq!(of("sole"), [-1.0, 1.0].map(|y| [-1.0, 1.0].map(|x| ([x, y, 0.0], 0.0))).as_flattened());
    assert_eq!(of("palm"), [([0.0; 3], 0.5)]);
    assert_eq!(found.len(), 9 + 2 + 4 + 1);
    for one in &resolved.effects {
        assert_eq!((&one.parameters[1..], one.at.rotation.rpy()), (&[1e4, 1.0, 0.5, 1e-5, 0.0, 0.0, 1.0, 0.25, 0.0][..], [0.0; 3]));
    }
    let told: Vec<(Code, &Subject, Option<u32>)> = resolved.warnings.iter().map(|w| (w.code, &w.subject, w.line())).collect();
    let [hand, palm] = ["hand", "palm"].map(|name| Subject::Link(name.into()));
    assert_eq!(told, [(Code::NoContact, &hand, Some(1)), (Code::PartOfContact, &palm, Some(1))]);
    assert!(
        resolved.warnings[0].to_string().starts_with("s.toml:1: link \"hand\": effects.contact: found a mesh that makes no contact"),
        "{:?}",
        resolved.warnings
    );
    let unused: Vec<&Subject> = resolved.report.ignored.iter().filter(|u| u.tag == "collision").map(|u| &u.subject).collect();
    assert_eq!(unused, [&hand]);
    assert!(resolved.report.to_string().contains("contact on link \"shin\": radius 0.1 m (file: collision)"), "{}", resolved.report);
    assert!(resolved.report.to_string().contains("xyz [0.0, 0.0, -1.0] m (file: collision)"), "{}", resolved.report);
}

#[test]
fn what_a_link_itself_says_comes_first() {
    let all = format!("[effects.contact.'*']\nfrom = 'collision'\n{LAW}");
    let of_shin = |own: &str| -> Vec<Applied> { resolved(&format!("{all}{own}")).effects.into_iter().filter(|a| a.on == "shin").collect() };
    // Its own numbers, at the points of its geometry.
    let stiff = of_shin("[effects.contact.shin]\nstiffness = 7");
    assert!(stiff.len() == 2 && stiff.iter().all(|a| a.parameters[..4] == [0.1, 7.0, 1.0, 0.5]), "{stiff:?}");
    // Its own sphere in place of its geometry.
    let own = of_shin("[effects.contact.shin]\nradius = 0.3\nxyz = [0, 0, 2]");
    assert!(own.len() == 1 && own[0].parameters[..2] == [0.3, 1e4] && own[0].at.xyz == [0.0, 0.0, 2.0], "{own:?}");
    // Beside it.
    let both = of_shin(&format!("[[effects.contact.shin]]\nradius = 0.3\n{LAW}[[effects.contact.shin]]\nfrom = 'collision'\n"));
    assert_eq!(both.iter().map(|a| a.parameters[0]).collect::<Vec<_>>(), [0.3, 0.1, 0.1]);
    assert_eq!(of_shin("").len(), 2);
    // Off, by a word or by a zero.
    assert_eq!(of_shin("[effects.contact.shin]\nstiffness = 0").len(), 0);
    let off = resolved(&format!("[effects.contact]\nshin = 'off'\n{all}"));
    assert_eq!(spheres(&off).len(), 14);
    // By a word, with the law of all.
    let word = resolved(&format!("[effects.contact]\nshin = 'collision'\n[effects.contact.'*']\nradius = 9\n{LAW}"));
    let shin: Vec<f64> = spheres(&word).iter().filter(|(on, ..)| *on == "shin").map(|(.., radius)| *radius).collect();
    assert_eq!(shin, [0.1, 0.1]);
}

/// A single link, in a scene without an entry for the others.
#[test]
fn a_link_by_its_name_gets_its_own_points_alone() {
    let resolved = resolved(&format!("[effects.contact.sole]\nfrom = 'collision'\n{LAW}"));
    assert_eq!(spheres(&resolved).len(), 4);
    assert!(resolved.effects.iter().all(|a| a.on == "sole") && resolved.warnings.is_empty());
}

/// A floor and a wall: each entry of a list for all links applies.
#[test]
fn there_may_be_several_planes() {
    let resolved = resolved(&format!(
        "[[effects.contact.'*']]\nfrom = 'collision'\n{LAW}[[effects.contact.'*']]\nfrom = 'collision'\n{LAW}normal = [1, 0, 0]\nheight = -9"
    ));
    assert_eq!(spheres(&resolved).len(), 2 * 16);
    assert_eq!(resolved.effects.iter().filter(|a| a.parameters[5] == 1.0).count(), 16);
}

#[test]
fn what_a_fixed_base_holds_touches_nothing() {
    let resolved = resolve_on(ROBOT, &format!("[effects.contact]\nfrom = 'collision'\n{LAW}"), Base::Fixed).unwrap();
    assert!(resolved.effects.iter().all(|a| a.on != "trunk") && resolved.effects.len() == 7);
}

#[test]
fn points_of_ones_own_beside_those_of_the_geometry_are_refused() {
    let text = format!("[effects.contact.shin]\nfrom = 'collision'\n{LAW}radius = 1\nxyz = [0, 0, 0]\nrpy = [0, 0, 0]\n");
    let errors = Scene::read("s.toml", &text).unwrap_err().errors;
    let told: Vec<(Code, &str, Option<u32>)> = errors.iter().map(|e| (e.code, e.field.as_str(), e.line())).collect();
    let [radius, xyz, rpy] = ["radius", "xyz", "rpy"].map(|key| format!("effects.contact.shin.{key}"));
    assert_eq!(told, [(Code::Together, radius.as_str(), Some(6)), (Code::Together, &xyz, Some(7)), (Code::Together, &rpy, Some(8))]);
    assert_eq!(
        errors[0].to_string(),
        "s.toml:6: effects.contact.shin.radius: found radius beside from = \"collision\", expected one of both: the shapes of the robot's file give radii and places"
    );
}

#[test]
fn words_that_an_effect_does_not_have_are_refused() {
    let told = |text: &str| Scene::read("s.toml", text).unwrap_err().to_string();
    assert_eq!(
        told("[effects.contact]\nfrom = 'urdf'"),
        "s.toml:2: effects.contact.from: found \"urdf\", which has no numbers for it, expected \"collision\""
    );
    assert_eq!(
        told("[effects.damping]\nfrom = 'collision'"),
        "s.toml:2: effects.damping.from: found \"collision\", which has no geometry for it, expected \"urdf\""
    );
    assert!(told("[effects]\ncontact.shin = 'colision'").ends_with("\"collision\" or \"off\"; did you mean \"collision\"?"));
}

#[test]
fn a_link_that_is_named_and_has_no_shape_is_an_error() {
    for (link, what) in
        [("hand", "with no mesh that can be read: files of meshes are not read here"), ("bare", "with no collision geometry")]
    {
        let told = refused(&format!("[effects.contact.{link}]\nfrom = 'collision'\n{LAW}"));
        let expected = "expected a mesh that can be read, a box, cylinder, sphere or capsule in <collision>, or contact with `radius`";
        assert_eq!(told, format!("s.toml:1: effects.contact.{link}: found link \"{link}\" {what}, {expected}"));
    }
    let told = refused("[effects.contact.shin]\nfrom = 'collision'\ndamping = 1\nfriction = 1");
    assert_eq!(told, "s.toml:1: effects.contact.shin: found no stiffness for link \"shin\", expected stiffness, N/m");
}

/// A file with a negative size is readable, and refused if a scene requests contact of it.
#[test]
fn geometry_that_cannot_be_read_is_an_error_where_it_is_asked_for() {
    let urdf = ROBOT.replace("radius=\"0.1\"", "radius=\"-0.1\"");
    let told = |text: &str| resolve_on(&urdf, text, Base::Floating).map(|r| r.effects.len()).map_err(|e| e.to_string());
    for key in ["'*'", "shin"] {
        let error = told(&format!("[effects.contact.{key}]\nfrom = 'collision'\n{LAW}")).unwrap_err();
        let line = "collision geometry of link \"shin\" that cannot be read: r.urdf:6: link \"shin\": capsule radius: found a negative size in \"-0.1\"";
        assert!(error.contains(line) && error.ends_with("expected geometry that can be read, or \"off\" for this link"), "{error}");
    }
    assert_eq!(told(&format!("[effects.contact]\nshin = 'off'\n[effects.contact.'*']\nfrom = 'collision'\n{LAW}")), Ok(14));
    assert_eq!(told(&format!("[effects.contact.sole]\nradius = 1\n{LAW}")), Ok(1));
}

/// The error has lines that work.
#[test]
fn contact_where_nothing_can_touch_is_an_error() {
    const BODY: &str = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
    let leg = |name: &str, shape: &str| {
        format!(
            "<link name='{name}'>{BODY}{shape}</link><joint name='{name}' type='continuous'><parent link='b'/><child link='{name}'/></joint>"
        )
    };
    let robot =
        |shape: &str| format!("<robot name='r'><link name='b'>{BODY}</link>{}{}</robot>", leg("left", shape), leg("right foot", shape));
    let scene = |lines: &str| format!("[effects.contact]\n{lines}\n[effects.contact.'*']\nfrom = 'collision'\n{LAW}");
    let mesh = "<collision><geometry><mesh filename='a.stl'/></geometry></collision>";
    for (shape, found) in [
        ("", "without collision geometry"),
        (mesh, "with meshes alone as collision geometry, and none that can be read: files of meshes are not read here"),
    ] {
        let told = resolve_on(&robot(shape), &scene(""), Base::Floating).map(|_| ()).unwrap_err().to_string();
        let (before, lines) = told.split_once(" with the lines ").unwrap_or_else(|| panic!("{told}"));
        let expected = "expected <collision> of boxes, cylinders, spheres or capsules, or spheres of the scene, such as [effects.contact]";
        assert_eq!(before, format!("s.toml:3: effects.contact.\"*\": found a robot {found}, {expected}"));
        assert_eq!(lines, "left = { radius = 0.02 } and \"right foot\" = { radius = 0.02 }");
        let resolved = resolve_on(&robot(shape), &scene(&lines.replace(" and ", "\n")), Base::Floating).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(resolved.effects.len(), 2);
    }
}

/// The points are those of the description's own.
#[test]
fn appended_robots_bring_their_geometry_along() {
    let (mut robot, other) = (reading(ROBOT).description, reading(ROBOT).description);
    robot.append("bare", &other, "left_", Default::default()).unwrap();
    let link = &robot.links[robot.link("left_shin").unwrap()];
    assert_eq!(link.collision.iter().flat_map(Collision::contact_spheres).count(), 2);
}

/// Two planes, through one of which a sphere passes.
const IN_ROOM: &str = r#"<mujoco><worldbody>
  <geom name="floor" type="plane" size="1 1 1" pos="0 0 -0.5"/>
  <body pos="2 0 0" euler="0 -90 0"><geom name="wall" type="plane" size="1 1 1" contype="2" conaffinity="2"/></body>
  <body name="ball"><freejoint/><geom size="0.1"/><geom size="0.2" pos="0 0 1" contype="3"/></body>
  <body name="stick"><freejoint/><geom type="capsule" size="0.1 0.3" contype="2"/><geom size="0.1" contype="4" conaffinity="4"/></body>
  </worldbody></mujoco>"#;

#[test]
fn planes_may_be_those_of_the_file() {
    let against = |text: &str| -> Vec<(String, f64, Vec<f64>)> {
        let found = resolve_on(IN_ROOM, text, Base::Fixed).unwrap_or_else(|e| panic!("{e}"));
        // The radius, the normal and the height
        found
            .effects
            .iter()
            .map(|one| (one.on.clone(), one.parameters[0], one.parameters[5..9].iter().map(|x| x + 0.0).collect()))
            .collect()
    };
    let (floor, wall) = (vec![0.0, 0.0, 1.0, -0.5], vec![-1.0, 0.0, 0.0, -2.0]);
    let expected = |on: &str, radius: f64, plane: &Vec<f64>| (on.to_owned(), radius, plane.clone());
    let balls = [expected("ball", 0.1, &floor), expected("ball", 0.2, &floor), expected("ball", 0.2, &wall)];
    // A capsule is two spheres. It meets the floor by the floor's bit, the wall by its own.
    let sticks = [&floor, &floor, &wall, &wall].map(|plane| expected("stick", 0.1, plane));
    let all = format!("[effects.contact.'*']\nfrom = 'collision'\nplane = 'file'\n{LAW}");
    assert_eq!(against(&all), [&balls[..], &sticks].concat());
    // A link with numbers of its own is against the same planes, unless it has its own.
    let own = against(&format!("[effects.contact]\nstick = {{ stiffness = 7 }}\nball = {{ height = -9 }}\n{all}"));
    let deep = vec![0.0, 0.0, 1.0, -9.0];
    assert_eq!(own, [&[expected("ball", 0.1, &deep), expected("ball", 0.2, &deep)][..], &sticks].concat());
    // A point of the scene's own meets each plane.
    let point = against(&format!("[effects.contact.ball]\nradius = 0.3\nplane = 'file'\n{LAW}"));
    assert_eq!(point, [expected("ball", 0.3, &floor), expected("ball", 0.3, &wall)]);
}

#[test]
fn planes_that_are_not_there_or_said_twice_are_errors() {
    let none = refused(&format!("[effects.contact]\nfrom = 'collision'\nplane = 'file'\n{LAW}"));
    assert_eq!(
        none,
        "s.toml:1: effects.contact.plane: found \"file\", and the robot's file has no plane that makes contact, expected `normal` and `height`"
    );
    let said = |text: &str| Scene::read("s.toml", &format!("[effects.contact]\nfrom = 'collision'\n{LAW}{text}")).unwrap_err().to_string();
    let twice = said("plane = 'file'\nheight = 1");
    assert!(twice.contains("found height beside plane = \"file\", expected one of both"), "{twice}");
    assert!(said("plane = 'flor'").contains("found \"flor\", expected \"file\""));
    assert!(said("plane = 3").contains("expected \"file\""));
    let many = IN_ROOM.replace("<worldbody>", &format!("<worldbody>{}", "<geom type=\"plane\" size=\"1 1 1\"/>".repeat(100)));
    let many = resolve_on(&many, &format!("[effects.contact]\nfrom = 'collision'\nplane = 'file'\n{LAW}"), Base::Fixed).unwrap_err();
    assert!(many.errors.len() == 1 && many.to_string().contains("has 102 planes, expected at most 100"), "{many}");
}

/// Old scenes have `damping`; `damping_time` alone is enough, and both add up.
#[test]
fn a_contact_is_damped_by_one_of_two_keys_or_by_both() {
    let law = |damping: &str| format!("[effects.contact]\nfrom = 'collision'\nstiffness = 1e4\nfriction = 0.5\n{damping}");
    let numbers = |damping: &str| {
        let resolved = resolved(&law(damping));
        let parameters = &resolved.effects[0].parameters;
        (parameters[2], parameters[9])
    };
    assert_eq!(
        ["damping = 2.0", "damping_time = 0.01", "damping = 2.0\ndamping_time = 0.01"].map(numbers),
        [(2.0, 0.0), (0.0, 0.01), (2.0, 0.01)]
    );
    // One entry for all links, the other for one link.
    let hand = resolved(&format!(
        "{}[effects.contact.palm]\ndamping_time = 0.02",
        law("").replace("[effects.contact]", "[effects.contact.'*']") + "damping = 1.0\n"
    ));
    let of_palm = hand.effects.iter().find(|a| a.on == "palm").unwrap();
    assert_eq!((of_palm.parameters[2], of_palm.parameters[9]), (1.0, 0.02));
    let told = refused(&law(""));
    assert!(told.contains("found no damping for link \"trunk\", expected damping, s/m, or damping_time"), "{told}");
    let negative = Scene::read("s.toml", &law("damping_time = -1.0")).unwrap_err().to_string();
    assert!(negative.contains("damping_time: found -1.0, expected a finite number, at least 0"), "{negative}");
}
