//! Errors that need the robot, or a table next to the scene, to be found.

use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_formats::world::World;
use articulated_scene::{Edited, Scene};

const ARM: &str = r#"<robot name="arm">
  <link name="world"/><link name="upper"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="lower"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><link name="tip"/>
  <joint name="shoulder" type="continuous"><parent link="world"/><child link="upper"/><axis xyz="0 1 0"/><dynamics damping="0.3"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="5" velocity="3"/></joint>
  <joint name="tool" type="fixed"><parent link="lower"/><child link="tip"/></joint></robot>"#;

/// Errors of a readable scene, against the arm.
fn against_the_arm(text: &str) -> Vec<String> {
    against(ARM, text)
}

fn against(urdf: &str, text: &str) -> Vec<String> {
    let scene = Scene::read("s.toml", text).unwrap();
    let reading = articulated_formats::read(urdf.as_bytes(), &articulated_formats::Options::default()).unwrap();
    let robot = Edited {
        description: &reading.description,
        file: "r.urdf",
        base: Base::Fixed,
        unused: &reading.unused,
        world: &World::default(),
        shafts: &[],
    };
    let model = Model::new(&reading.description, Base::Fixed).unwrap();
    let mut errors: Vec<_> = scene.resolve(&robot).err().into_iter().flat_map(|e| e.errors).collect();
    errors.extend(scene.start(&model).err().into_iter().flat_map(|e| e.errors));
    errors.extend(scene.controller(&model, &mut |_| Err("there is no such file".into())).err().into_iter().flat_map(|e| e.errors));
    errors.iter().map(ToString::to_string).collect()
}

/// Its joint has a name, which states and torques know.
#[test]
fn effects_on_joints_are_not_on_a_floating_base() {
    let scene = Scene::read("s.toml", "[effects.damping]\n__floating_base__ = 1").unwrap();
    let reading = articulated_formats::read(ARM.as_bytes(), &articulated_formats::Options::default()).unwrap();
    let robot = Edited {
        description: &reading.description,
        file: "r.urdf",
        base: Base::Floating,
        unused: &reading.unused,
        world: &World::default(),
        shafts: &[],
    };
    let told =
        "s.toml:2: effects.damping.__floating_base__: found the floating base, expected a joint: effects on joints do not act on the base";
    assert_eq!(scene.resolve(&robot).unwrap_err().to_string(), told);
}

#[test]
fn names_that_the_robot_does_not_have_are_told_with_the_nearest() {
    let cases = [
        (
            "[effects.damping]\nelbwo = 1",
            "s.toml:2: effects.damping.elbwo: found no such joint, expected a joint of the robot that moves; did you mean \"elbow\"?",
        ),
        (
            "[effects.drag]\nlowr = 1",
            "s.toml:2: effects.drag.lowr: found no such link, expected a link or frame of the robot; did you mean \"lower\"?",
        ),
        ("[effects.drag]\nworld = 1", "s.toml:2: effects.drag.world: found a link that is fixed to the base, expected a link that moves"),
        ("[effects.damping]\ntool = 1", "s.toml:2: effects.damping.tool: found a fixed joint, expected a joint that moves"),
        (
            "[effects.damping]\nelbow = \"urdf\"",
            "s.toml:2: effects.damping.elbow: found no damping for joint \"elbow\", whose file has no <dynamics damping>, expected damping, N·m·s/rad|N·s/m",
        ),
        (
            "[effects.limit.shoulder]\nlower = 1",
            "s.toml:1: effects.limit.shoulder: found no upper for joint \"shoulder\", expected upper, rad|m",
        ),
        (
            "[initial]\nq = { elbo = 1 }",
            "s.toml:2: initial.q.elbo: found a joint that is not there, or is locked, expected a joint that moves; did you mean \
             \"elbow\"?",
        ),
        ("[initial]\nq = [1, 2, 3]", "s.toml:2: initial.q: found 3 numbers, expected 2 numbers for this robot"),
        ("[initial]\nv = { elbow = [1, 2] }", "s.toml:2: initial.v.elbow: found 2 numbers, expected one number for a revolute joint"),
        (
            "[initial]\nbase = { xyz = [0, 0, 1] }",
            "s.toml:2: initial.base: found a base that is fixed, expected base = \"floating\", or no initial.base",
        ),
        (
            "[control]\nkind = \"table\"\nfile = \"t.csv\"",
            "s.toml:3: control.file: found \"t.csv\", which cannot be read (there is no such file), expected a CSV with a first line that names its \
             columns",
        ),
        (
            "[impact]\nlink = \"tipp\"\nnormal = [1, 0, 0]\nmass = 1\nrestitution = 1\ntime = 0",
            "s.toml:2: impact.link: found no such link, expected a link or frame of the robot; did you mean \"tip\"?",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(against_the_arm(text), [expected]);
    }
}

/// A ball joint, a free one behind it, and a hinge.
const BALL: &str = r#"<robot name="ball"><link name="world"/>
  <link name="rod"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="bob"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="kite"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="hip" type="spherical"><parent link="world"/><child link="rod"/></joint>
  <joint name="knee" type="continuous"><parent link="rod"/><child link="bob"/><axis xyz="0 1 0"/></joint>
  <joint name="string" type="floating"><parent link="world"/><child link="kite"/></joint></robot>"#;

#[test]
fn numbers_that_a_ball_joint_does_not_have_are_told() {
    let limit = "upper with 1 number (largest angle of the rotation from the identity, about any axis; no bound from π on), stiffness with 1 \
                 number (torque per unit of depth), damping with 1 number (what a unit rate into the stop adds to the torque, in parts of it)";
    let cases = [
        (
            "[effects.limit.hip]\nlower = -0.5\nupper = 0.5\nstiffness = 100",
            format!("s.toml:1: effects.limit.hip: found lower with 1 number for a spherical joint, expected {limit}"),
        ),
        (
            "[effects.spring.hip]\nstiffness = 3\nrest = 0.1",
            "s.toml:1: effects.spring.hip: found rest with 1 number for a spherical joint, expected stiffness with 1 number (torque per unit of the \
             angle), rest with 4 numbers (quaternion (x, y, z, w) at which it is slack, of any length)"
                .to_owned(),
        ),
        (
            "[effects.spring.knee]\nstiffness = 3\nrest = [0, 0, 0, 1]",
            "s.toml:1: effects.spring.knee: found rest with 4 numbers for a continuous joint, expected stiffness with 1 number (torque per unit of \
             the coordinate), rest with 1 number (coordinate at which it is slack)"
                .to_owned(),
        ),
        ("[effects.limit.hip]\nstiffness = 100", "s.toml:1: effects.limit.hip: found no upper for joint \"hip\", expected upper, rad|m".to_owned()),
        (
            "[effects.spring]\nstring = 3",
            "s.toml:2: effects.spring.string: found a floating joint, which has no coordinate of its own for each degree of freedom, expected \
             another joint"
                .to_owned(),
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(against(BALL, text), [expected]);
    }
    let told = Scene::read("s.toml", "[effects.spring.hip]\nstiffness = 3\nrest = [0, 0, 0, 0]").unwrap_err().to_string();
    assert!(told.contains("effects.spring.hip.rest: found 0.0, 0.0, 0.0, 0.0, expected a quaternion"), "{told}");
    let told = Scene::read("s.toml", "[effects.spring.hip]\nstiffness = 3\nrest = [0, 0, 1]").unwrap_err().to_string();
    assert!(told.contains("effects.spring.hip.rest"), "{told}");
}

/// `*` applies to the joints that have the given numbers.
#[test]
fn effects_on_all_joints_are_on_balls_where_they_have_such_numbers() {
    let reading = articulated_formats::read(BALL.as_bytes(), &articulated_formats::Options::default()).unwrap();
    let robot = Edited {
        description: &reading.description,
        file: "r.urdf",
        base: Base::Fixed,
        unused: &reading.unused,
        world: &World::default(),
        shafts: &[],
    };
    let on = |text: &str| {
        let resolved = Scene::read("s.toml", text).unwrap().resolve(&robot).unwrap_or_else(|errors| panic!("{errors}"));
        resolved.effects.into_iter().map(|e| (e.on, e.parameters)).collect::<Vec<_>>()
    };
    let ball = |p: &[f64]| ("hip".to_owned(), p.to_vec());
    let hinge = |p: &[f64]| ("knee".to_owned(), p.to_vec());
    assert_eq!(on("effects = { spring = 3 }"), [ball(&[3.0, 0.0, 0.0, 0.0, 1.0]), hinge(&[3.0, 0.0])]);
    assert_eq!(on("[effects.spring.\"*\"]\nstiffness = 3\nrest = 0.2"), [hinge(&[3.0, 0.2])]);
    assert_eq!(on("[effects.spring.\"*\"]\nstiffness = 3\nrest = [0, 0, 2, 0]"), [ball(&[3.0, 0.0, 0.0, 2.0, 0.0])]);
    assert_eq!(on("[effects.limit.\"*\"]\nlower = -1\nupper = 2\nstiffness = 3"), [hinge(&[-1.0, 2.0, 3.0, 0.0])]);
    let both = "[effects.limit]\n\"*\" = { lower = -1, upper = 2, stiffness = 3 }\nhip = { upper = 1, stiffness = 4, damping = 0.5 }";
    assert_eq!(on(both), [ball(&[1.0, 4.0, 0.5]), hinge(&[-1.0, 2.0, 3.0, 0.0])]);
}

#[test]
fn all_that_is_wrong_with_a_csv_is_told_of_its_lines() {
    let scene = Scene::read("there/s.toml", "\n[control]\nkind = \"table\"\nfile = \"t.csv\"").unwrap();
    let model = Model::new(&articulated_formats::read(ARM.as_bytes(), &Default::default()).unwrap().description, Base::Fixed).unwrap();
    let read = |text: &str| {
        let (result, text) = (scene.controller(&model, &mut |_| Ok(Box::new(std::io::Cursor::new(text.to_owned())))), text.len());
        result.map(|_| text).map_err(|e| e.errors.iter().map(|e| e.to_string().replace('\\', "/")).collect::<Vec<_>>())
    };
    let told = |text: &str, expected: &[&str]| {
        let expected: Vec<String> = expected.iter().map(|line| format!("there/t.csv:{line}")).collect();
        assert_eq!(read(text), Err(expected), "{text}");
    };
    assert!(read("\u{feff}time, \"elbow\",shoulder\n\n0,1,2\n").is_ok(), "a byte order mark, as spreadsheets write it");
    assert!(read("\"t\",\"elbow\"\n\"0\",\" 1.5 \"\n1,2\n").is_ok(), "quotation marks");
    told(
        "t,elbow\n\"0\",\"one\"\n1,\"\n",
        &["2: elbow: found \"one\", expected a finite number", "3: elbow: found \"\"\", expected a finite number"],
    );
    told("t\n0\n1\n", &["1: found a single column, expected columns of joints that move after t: shoulder, elbow"]);
    let each = "each of the columns";
    told(
        "t,elbo,shoulder,shoulder\n0,1,2,3\n\n1,one,2,inf\n2,3\n-1,0,0,0\n",
        &[
            "1: found the column \"shoulder\" twice, expected each once",
            "1: found the column \"elbo\", expected a joint that moves, as elbow, or one of its numbers, as ball[0]; did you mean \"elbow\"?",
            "4: elbo: found \"one\", expected a finite number",
            "4: shoulder: found \"inf\", expected a finite number",
            &format!("5: found 2 numbers, expected 4 numbers: the time and one for {each}"),
            "6: found the time -1.0 after 0.0, expected times in order",
        ],
    );
    told("t,elbow,elbow[0]\n0,1,2\n", &["1: found the column \"elbow[0]\", which is \"elbow\" again, expected each once"]);
    told(
        "t,elbow[0],elbow,elbow\n0,1,2,3\n",
        &[
            "1: found the column \"elbow\" twice, expected each once",
            "1: found the column \"elbow\", which is \"elbow[0]\" again, expected each once",
        ],
    );
    told("x,elbow\n0,1\n", &["1: found \"x\" as the first column, expected t"]);
    told("t,elbow\n", &[&format!(" found no rows, expected lines of numbers: the time and one for {each}")]);
    told("\n", &[" found nothing, expected a first line that names the columns, t and joints"]);
}

#[test]
fn a_number_of_a_joint_has_one_column_whatever_its_names() {
    let ball = "<link name='hand'/><joint name='ball' type='spherical'><parent link='tip'/><child link='hand'/></joint></robot>";
    let urdf = ARM.replace("</robot>", ball);
    let told = |keys: &str, columns: [&str; 3]| {
        let rows = "rows = [[0, 0, 0, 1]]";
        against(&urdf, &format!("[control]\n{keys}\ncolumns = [\n\"{}\"]\n{rows}", columns.join("\",\n\"")))
    };
    let twice = |line: usize, column: usize, names: [&str; 2]| {
        let [first, again] = names;
        format!("s.toml:{line}: control.columns[{column}]: found the column {again:?}, which is {first:?} again, expected each once")
    };
    let [table, pd] = ["kind = \"table\"", "kind = \"pd\"\nkp = 1\nkd = 1"];
    assert_eq!(told(table, ["shoulder", "elbow", "shoulder[0]"]), [twice(6, 2, ["shoulder", "shoulder[0]"])]);
    assert_eq!(
        told(table, ["ball[0]", "ball[00]", "ball[+0]"]),
        [twice(5, 1, ["ball[0]", "ball[00]"]), twice(6, 2, ["ball[00]", "ball[+0]"])]
    );
    assert_eq!(told(pd, ["ball[00]", "ball[0]", "ball[3]"]), [twice(7, 1, ["ball[00]", "ball[0]"])]);
    for (keys, columns) in [
        (table, ["shoulder[0]", "elbow", "ball[0]"]),
        (table, ["ball[0]", "ball[1]", "ball[2]"]),
        (pd, ["shoulder", "elbow[0]", "ball[3]"]),
    ] {
        assert_eq!(told(keys, columns), [""; 0]);
    }
}

#[test]
fn a_joint_that_follows_another_has_neither_motor_nor_coordinates() {
    let follower = ARM.replace("</robot>", FOLLOWER);
    let told = |text: &str| against(&follower, text);
    let expected = "expected the joint that it follows: that is what a motor drives";
    assert_eq!(
        told("[effects.motor]\nfinger = { torque = 1, speed = 1 }"),
        [format!("s.toml:2: effects.motor.finger: found a joint that follows another, {expected}")]
    );
    assert_eq!(told("[effects.motor]\n\"*\" = { torque = 1, speed = 1 }\nfinger = \"off\""), Vec::<String>::new());
    assert_eq!(
        told("[initial]\nq = { finger = 1 }"),
        ["s.toml:2: initial.q.finger: found a joint that follows another, expected the joint that it follows, whose coordinates it has"]
    );
}

const FOLLOWER: &str = "<link name='finger'/><joint name='finger' type='continuous'><parent link='tip'/><child link='finger'/>\
    <mimic joint='elbow'/></joint></robot>";

#[test]
fn a_joint_has_as_many_columns_as_numbers() {
    let urdf = "<robot name='r'><link name='base'/><link name='bob'/><joint name='ball' type='spherical'><parent link='base'/><child link='bob'/></joint></robot>";
    let told =
        |kind: &str, k: usize| against(urdf, &format!("[control]\nkind = \"{kind}\"\ncolumns = [\"ball[{k}]\"]\nrows = [[0, 1], [1, 1]]"));
    let expected = "s.toml:3: control.columns[0]: found the column \"ball[3]\", expected a joint that moves, as elbow, or one of its numbers, as ball[0]";
    assert_eq!((told("table", 2), told("table", 3)), (vec![], vec![expected.to_owned()]));
    assert_eq!(told("table", 4).len(), 1);
}
