use std::path::Path;

use crate::{Ended, File, run};

/// The outputs of a scene in a folder of their own.
fn written(scene: &str, words: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out/of/it");
    let ended = run(&[&["simulate", scene, "-o", out.to_str().unwrap()], words].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    folder
}

fn text(folder: &tempfile::TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join("out/of/it").join(name)).unwrap()
}

fn bytes(folder: &tempfile::TempDir, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join("out/of/it").join(name)).unwrap()
}

#[test]
fn everything_is_written_and_can_be_read() {
    let folder = written("cart_pole", &["--end", "0.2", "--every", "0.01"]);
    let summary: serde_json::Value = serde_json::from_str(&text(&folder, "summary.json")).unwrap();
    let files: Vec<&str> = summary["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap()).collect();
    let found = std::fs::read_dir(folder.path().join("out/of/it")).unwrap().count();
    assert_eq!(found, files.len());
    assert!(files.iter().all(|name| !bytes(&folder, name).is_empty()));

    let table = text(&folder, "recording.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(rows[0][..3], ["t", "q.slide", "q.pole"]);
    assert_eq!(rows.len(), 22);
    let number = |row: usize, title: &str| {
        let column = rows[0].iter().position(|t| *t == title).unwrap();
        rows[row][column].parse::<f64>().unwrap()
    };
    assert_eq!((number(1, "t"), number(21, "t")), (0.0, 0.2));
    // T + U − (T + U)₀ − work − dissipated − from events, to the rounding of its eight terms
    let energies = |sign: f64, row: usize| ["kinetic_energy", "potential_energy"].map(|title| sign * number(row, title));
    let others = ["work", "dissipated", "from_events", "imbalance"].map(|title| -number(21, title));
    let terms = [&energies(1.0, 21)[..], &energies(-1.0, 1), &others].concat();
    let magnitude: f64 = terms.iter().map(|x| x.abs()).sum();
    assert!(terms.iter().sum::<f64>().abs() < 8.0 * f64::EPSILON * magnitude, "{terms:?}");

    let summary: serde_json::Value = serde_json::from_str(&text(&folder, "summary.json")).unwrap();
    assert_eq!(summary["columns"][1], serde_json::json!({"column": "q.slide", "unit": "m"}));
    assert_eq!(summary["columns"].as_array().unwrap().len(), rows[0].len());
    // It has no drive.
    assert!(!files.iter().any(|f| f.starts_with("torques")));
    for picture in ["positions", "velocities", "energy"] {
        let drawn = text(&folder, &format!("{picture}.svg"));
        assert_eq!(roxmltree::Document::parse(&drawn).unwrap().root_element().tag_name().name(), "svg");
        assert!(drawn.contains("time, s"));
    }
    let moving = text(&folder, "motion.svg");
    assert!(
        roxmltree::Document::parse(&moving)
            .unwrap()
            .descendants()
            .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "animate")))
            .count()
            > 2
    );
    let page = text(&folder, "motion.html");
    assert!(!page.contains("http") && page.contains("<title>cart_pole</title>"));
    let data = page.split("application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
    let motion: serde_json::Value = serde_json::from_str(data).unwrap();
    assert_eq!((motion["moving"].as_u64(), motion["joints"].as_array().unwrap().len()), (Some(2), 2));
}

/// A name that ends with .html is that of the page, and no other file is written.
#[test]
fn the_page_alone_is_written_where_its_name_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("swing.html");
    let write = |scene: &str, words: &[&str]| run(&[&["simulate", scene, "-o", page.to_str().unwrap()], words].concat());
    let ended = write("cart_pole", &["--end", "0.1"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(std::fs::read_to_string(&page).unwrap().contains("<title>cart_pole</title>"));
    assert!(ended.out.contains("swing.html"), "{}", ended.out);
    let scene = File::new("ends.toml", b"robot = \"cart_pole\"\n[simulation]\nend = 1\noutput = \"ends\"\n");
    let ended = write(scene.name(), &[]);
    assert!(ended.status == 2 && ended.err.contains("--every"), "{}", ended.err);
}

/// The data of a page.
fn data(page: &Path) -> serde_json::Value {
    let page = std::fs::read_to_string(page).unwrap();
    serde_json::from_str(page.split("application/json\">").nth(1).unwrap().split("</script>").next().unwrap()).unwrap()
}

#[test]
fn meshes_are_drawn_where_they_are_found_and_told_where_they_are_not() {
    const PENDULUM: &str = r#"<robot name="pendulum"><link name="base"/>
        <link name="rod"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
          <visual><geometry><mesh filename="package://parts/mesh/rod.stl"/></geometry><material name="red"><color rgba="1 0 0 1"/></material></visual>
          <visual><geometry><mesh filename="fine.obj"/></geometry></visual>
          <collision><geometry><box size="1 1 1"/></geometry></collision></link>
        <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>"#;
    const STL: &str =
        "solid rod\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid rod\n";
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("robot")).unwrap();
    std::fs::create_dir_all(at("store/mesh")).unwrap();
    std::fs::write(at("robot/p.urdf"), PENDULUM).unwrap();
    std::fs::write(at("robot/p.toml"), "urdf = \"p.urdf\"\n[simulation]\nend = 0.1\noutput = 0.01\n").unwrap();
    std::fs::write(at("store/mesh/rod.stl"), STL).unwrap();
    // A sheet of n by n squares.
    const N: usize = 360;
    let corners = (0..=N).flat_map(|i| (0..=N).map(move |k| format!("v {i} {k} 0\n")));
    let square = |i: usize, k: usize| {
        format!(
            "f {0} {1} {2}\nf {1} {3} {2}\n",
            (N + 1) * i + k + 1,
            (N + 1) * i + k + 2,
            (N + 1) * (i + 1) + k + 1,
            (N + 1) * (i + 1) + k + 2
        )
    };
    let faces = (0..N).flat_map(|i| (0..N).map(move |k| square(i, k)));
    std::fs::write(at("robot/fine.obj"), corners.chain(faces).collect::<String>()).unwrap();
    let scene = at("robot/p.toml");
    let write = |words: &[&str]| {
        let page = at("p.html");
        let ended = run(&[&["simulate", scene.to_str().unwrap(), "-o", page.to_str().unwrap(), "--format", "json"], words].concat());
        assert_eq!(ended.status, 0, "{}", ended.err);
        (data(&page), ended)
    };
    let count = |data: &serde_json::Value, kind: &str| data["solids"].as_array().unwrap().iter().filter(|s| s["kind"] == kind).count();

    let (page, ended) = write(&[]);
    assert_eq!((count(&page, "visual"), count(&page, "collision")), (1, 1));
    for part in ["p.urdf: link \"rod\": mesh: found no file package://parts/mesh/rod.stl", "--package NAME=FOLDER"] {
        assert!(ended.err.contains(part), "{}", ended.err);
    }
    let warnings = ended.json()["warnings"].to_string();
    assert!(warnings.contains("fine.obj: a mesh of 259200 triangles, expected at most 200000"), "{warnings}");

    std::fs::write(at("robot/fine.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let package = format!("parts={}", at("store").display());
    let (page, ended) = write(&["--package", &package]);
    assert_eq!(count(&page, "visual"), 2);
    assert_eq!((&page["solids"][0]["material"], &page["solids"][0]["color"]), (&"red".into(), &serde_json::json!([1.0, 0.0, 0.0, 1.0])));
    assert!(!ended.err.contains("rod.stl"), "{}", ended.err);
    // A scene names packages too.
    let scene_alone = std::fs::read_to_string(&scene).unwrap();
    std::fs::write(&scene, format!("packages = {{ parts = \"../store\" }}\n{scene_alone}")).unwrap();
    assert_eq!(count(&write(&[]).0, "visual"), 2);
    std::fs::write(&scene, scene_alone).unwrap();
    // A package next to the robot needs no option.
    std::fs::rename(at("store"), at("parts")).unwrap();
    assert_eq!(count(&write(&[]).0, "visual"), 2);
    assert_eq!(count(&write(&["--package", at("parts").to_str().unwrap()]).0, "visual"), 2);
    // Nor does a package of another folder's name, whose `package.xml` declares it.
    std::fs::rename(at("parts"), at("robot/store")).unwrap();
    std::fs::write(at("package.xml"), "<package><name>parts</name></package>").unwrap();
    std::fs::rename(at("robot/store/mesh"), at("mesh")).unwrap();
    assert_eq!(count(&write(&[]).0, "visual"), 2);
    std::fs::remove_file(at("package.xml")).unwrap();
    std::fs::create_dir_all(at("parts")).unwrap();
    std::fs::rename(at("mesh"), at("parts/mesh")).unwrap();
    // A file that is not a mesh is a warning.
    std::fs::write(at("parts/mesh/rod.stl"), "solid").unwrap();
    let (page, ended) = write(&[]);
    assert!(count(&page, "visual") == 1 && ended.err.contains("rod.stl"), "{}", ended.err);
    let ended = run(&["simulate", "cart_pole", "-o", at("p.html").to_str().unwrap(), "--package", "parts=nowhere"]);
    assert!(ended.status == 2 && ended.err.contains("nowhere"), "{}", ended.err);
}

/// Content read by a program that knows the format.
#[test]
fn the_mcap_file_has_every_record_and_the_transforms_of_forward_kinematics() {
    use articulated_core::dynamics::Dynamics;
    use articulated_core::spatial::Placement;
    let folder = tempfile::tempdir().unwrap();
    let (out, path) = (folder.path().join("out"), folder.path().join("drop.mcap"));
    let words = ["simulate", "quadruped_drop", "--end", "0.5", "--every", "0.001", "-o", out.to_str().unwrap(), "--mcap"];
    let ended = run(&[&words[..], &[path.to_str().unwrap()]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let file = std::fs::read(&path).unwrap();

    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    let statistics = summary.stats.as_ref().unwrap();
    assert_eq!((statistics.message_count, statistics.channel_count, statistics.schema_count), (1002, 2, 2));
    assert_eq!((statistics.message_start_time, statistics.message_end_time), (0, 500_000_000));
    assert!(summary.chunk_indexes.len() > 1);
    let of_chunks = summary.chunk_indexes.iter().map(|chunk| summary.stream_chunk(&file, chunk).unwrap().count());
    assert_eq!(of_chunks.sum::<usize>(), 1002);
    let indexes: usize = summary
        .chunk_indexes
        .iter()
        .flat_map(|chunk| summary.read_message_indexes(&file, chunk).unwrap().into_values())
        .map(|all| all.len())
        .sum();
    assert_eq!(indexes, 1002);

    let table = std::fs::read_to_string(out.join("recording.csv")).unwrap();
    let rows: Vec<Vec<f64>> = table.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    let bundled = articulated_models::robot("quadruped").unwrap();
    let options = articulated_formats::Options { base: bundled.base, ..articulated_formats::Options::default() };
    let description = articulated_formats::read(bundled.urdf.as_bytes(), &options).unwrap().description;
    let foot = "front_left_foot";
    let model = articulated_core::model::Model::new(&description, bundled.base).unwrap().with_frames(&[foot]).unwrap();
    let (mut ws, mut place) = (Dynamics::workspace(&model), [0.0; 12]);
    let mut counts = std::collections::BTreeMap::new();
    for message in mcap::MessageStream::new(&file).unwrap() {
        let message = message.unwrap();
        let (topic, schema) = (message.channel.topic.as_str(), message.channel.schema.as_ref().unwrap());
        assert_eq!((message.channel.message_encoding.as_str(), schema.encoding.as_str()), ("json", "jsonschema"));
        let content: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
        let schema_says: serde_json::Value = serde_json::from_slice(&schema.data).unwrap();
        assert!(content.as_object().unwrap().keys().all(|key| schema_says["properties"].get(key).is_some()), "{schema_says}");
        let row = &rows[message.sequence as usize];
        assert_eq!(message.log_time, (row[0] * 1e9).round() as u64);
        *counts.entry(format!("{topic} {}", schema.name)).or_insert(0) += 1;
        let stamp = |at: &serde_json::Value| at["sec"].as_u64().unwrap() * 1_000_000_000 + at["nsec"].as_u64().unwrap();
        if topic == "/joint_states" {
            assert_eq!(stamp(&content["header"]["stamp"]), message.log_time);
            // Twelve joints of one coordinate; the base is a transform.
            assert_eq!(content["name"].as_array().unwrap().len(), 12);
            assert_eq!(content["position"][0].as_f64().unwrap(), row[1 + 7]);
            assert_eq!(content["velocity"][11].as_f64().unwrap(), row[1 + 19 + 17]);
            assert_eq!(content["effort"].as_array().unwrap().len(), 12);
            continue;
        }
        let all = content["transforms"].as_array().unwrap();
        assert_eq!(all.len(), description.links.len());
        let found = all.iter().find(|t| t["child_frame_id"] == foot).unwrap();
        assert_eq!((found["parent_frame_id"].as_str(), stamp(&found["timestamp"])), (Some("world"), message.log_time));
        model.placements(&mut ws, &row[1..20], &mut place).unwrap();
        let number = |part: &str, key: &str| found[part][key].as_f64().unwrap();
        for (k, key) in ["x", "y", "z"].into_iter().enumerate() {
            assert!((number("translation", key) - place[9 + k]).abs() < 1e-12);
        }
        let [x, y, z, w] = ["x", "y", "z", "w"].map(|key| number("rotation", key));
        let turn = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z)).to_rotation_matrix();
        let expected = Placement { rotation: nalgebra::Matrix3::from_row_slice(&place[..9]), position: nalgebra::Vector3::zeros() };
        assert!((turn.matrix() - expected.rotation).amax() < 1e-12);
    }
    let each = [("/joint_states sensor_msgs/msg/JointState".to_owned(), 501), ("/tf foxglove.FrameTransforms".to_owned(), 501)];
    assert_eq!(counts, each.into());

    // With a fixed base, the root link is the frame of all others; no folder is needed.
    let ended = run(&["simulate", "arm", "--end", "0.1", "--mcap", path.to_str().unwrap()]);
    assert!(ended.status == 0 && ended.out.contains("drop.mcap"), "{}", ended.err);
    let file = std::fs::read(&path).unwrap();
    let first = mcap::MessageStream::new(&file).unwrap().next().unwrap().unwrap();
    assert!(String::from_utf8(first.data.to_vec()).unwrap().contains("\"parent_frame_id\":\"base_link\",\"child_frame_id\":\"link_1\""));
}

#[test]
fn the_ball_of_a_scene_is_on_its_page() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("swing.html");
    assert_eq!(run(&["simulate", "golf_swing", "-o", page.to_str().unwrap()]).status, 0);
    let ball = &data(&page)["projectile"];
    assert_eq!(ball["place"], serde_json::json!([1.215, 0.15, 0.09]));
    // The radius of a golf ball, to a tenth.
    assert!((ball["radius"].as_f64().unwrap() / 0.02135 - 1.0).abs() < 0.1, "{ball}");
    assert!(ball["time"].as_f64().unwrap() > 0.2 && ball["after"][1].as_f64().unwrap() > 50.0, "{ball}");
}

#[test]
fn every_bundled_scene_runs() {
    for scene in articulated_models::SCENES {
        let ended = run(&["simulate", scene.name, "--end", "0.004", "--format", "json"]);
        assert_eq!(ended.status, 0, "{}: {}", scene.name, ended.err);
        let summary = ended.json();
        assert_eq!(summary["end_s"], 0.004, "{}", scene.name);
        assert!(summary["counts"]["steps"].as_u64().unwrap() > 0);
        let imbalance = summary["energy"]["relative_imbalance"].as_f64().unwrap();
        assert!(imbalance < 1e-4, "{}: {imbalance}", scene.name);
    }
}

#[test]
fn generated_code_gives_the_motion_that_generic_code_gives() {
    let run = |words: &[&str]| run(&[&["simulate", "cart_pole", "--end", "0.3", "--format", "json"], words].concat()).json();
    let (generic, generated) = (run(&[]), run(&["--generated"]));
    assert_eq!((generic["code"].as_str(), generated["code"].as_str()), (Some("generic"), Some("generated")));
    let energy = |x: &serde_json::Value, what: &str| x["energy"][what].as_f64().unwrap();
    for what in ["end", "kinetic_end", "dissipated"] {
        assert!((energy(&generic, what) - energy(&generated, what)).abs() < 1e-9, "{what}: {generic} {generated}");
    }
}

#[test]
fn the_command_line_goes_before_the_scene() {
    let ended = run(&["simulate", "double_pendulum", "--end", "0.1", "--integrator", "rk4", "--step", "0.001", "--format", "json"]).json();
    assert_eq!((ended["integrator"]["name"].as_str(), ended["counts"]["steps"].as_u64()), (Some("rk4"), Some(100)));
    let text = run(&["simulate", "double_pendulum", "--end", "0.1"]).out;
    for part in
        ["energy T + U", "largest imbalance", "rejected", "shortest step", "longest step", "simulated seconds per second", "kg·m²/s"]
    {
        assert!(text.contains(part), "{text}");
    }
}

const BAD: &str = r#"robot = "cart_pole"
[effects.dampin]
"*" = 0.1
[effects.damping]
slid = 0.1
pole = -1.0
[simulation]
end = -1
"#;

#[test]
fn all_that_is_wrong_with_a_scene_is_said_with_its_line_and_what_would_be_right() {
    let file = File::new("bad.toml", BAD.as_bytes());
    for command in ["simulate", "effects"] {
        let ended = run(&[command, file.name()]);
        assert_eq!(ended.status, 1, "{}", ended.err);
        let first = format!("error: {}:2: effects.dampin", file.name());
        assert!(ended.err.contains(&first) && ended.err.contains("did you mean \"damping\"?"), "{}", ended.err);
        assert!(ended.err.contains("bad.toml:8: simulation.end"), "{}", ended.err);
        // Each with its line of the file below.
        let of_file = |line: &str| line.split_once("| ").is_some_and(|(number, _)| number.chars().all(|c| c.is_ascii_digit() || c == ' '));
        assert!(ended.err.lines().all(|line| line.starts_with("error: ") || of_file(line)), "{}", ended.err);
        assert!(ended.err.contains("2 | [effects.dampin]\n"), "{}", ended.err);
    }
    let file = File::new(
        "bad.toml",
        BAD.replace("[effects.dampin]\n\"*\" = 0.1\n", "").replace("end = -1", "end = 1").replace("-1.0", "1").as_bytes(),
    );
    let ended = run(&["simulate", file.name()]);
    assert!(ended.status == 1 && ended.err.contains("did you mean \"slide\"?"), "{}", ended.err);
    // Errors that only the robot shows, at any place; then errors that only its motion and its
    // files show.
    let effects = "[effects.damping]\nslid = 0.1\n[initial]\nq = { pol = 1 }\n[control]\nkind = \"pd\"\nkp = { slde = 1 }\n";
    let table = "[control]\nkind = \"table\"\nfile = \"nowhere.csv\"\n";
    for (lines, told) in [(effects, &["slid", "pol", "slde"][..]), (table, &["nowhere.csv", "[simulation]"])] {
        let file = File::new("bad.toml", format!("robot = \"cart_pole\"\n{lines}").as_bytes());
        let ended = run(&["simulate", file.name()]);
        assert!(ended.status == 1 && told.iter().all(|word| ended.err.contains(word)), "{}", ended.err);
        assert_eq!(ended.err.lines().filter(|line| line.starts_with("error: ")).count(), told.len(), "{}", ended.err);
    }
}

#[test]
fn names_that_only_generated_code_needs_are_checked_too() {
    let scene = |line: &str| File::new("named.toml", format!("robot = \"cart_pole\"\n{line}\n[simulation]\nend = 0.01\n").as_bytes());
    let cases = [
        ("functions = [\"inverse_dynamic\"]", "unknown function `inverse_dynamic`, did you mean `inverse_dynamics`?"),
        ("functions = [\"x = mass_matrix(v = 0)\"]", "functions: `"),
        ("parameters = [\"payload(pole_rd)\"]", "parameters: `payload(pole_rd)`: there is no link \"pole_rd\", did you mean \"pole_rod\"?"),
        ("frames = [\"pole_rd\"]", "the robot has no link or frame \"pole_rd\""),
    ];
    for (line, said) in cases {
        let file = scene(line);
        let generated = run(&["generate", file.name()]);
        for command in ["simulate", "effects"] {
            let ended = run(&[command, file.name()]);
            assert_eq!((ended.status, ended.err.as_str()), (generated.status, generated.err.as_str()), "{command} {line}");
            assert!(ended.status > 0 && ended.err.contains(said), "{}", ended.err);
        }
        let checked = run(&["check", file.name()]);
        assert!(checked.status == 1 && checked.lines_with(said) == 1, "{}{}", checked.out, checked.err);
    }
    let right = scene("functions = [\"inverse_dynamics\"]\nparameters = [\"payload(pole_rod)\"]\nframes = [\"pole_rod\"]");
    assert_eq!(run(&["simulate", right.name()]).status, 0);
}

/// A file of a robot is simulated as the scene that `--print-scene` prints.
#[test]
fn a_file_of_a_robot_moves_smoothly() {
    const MODEL: &[u8] = br#"<mujoco model="pendulum">
  <option gravity="0 0 -3.7" timestep="0.01"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" pos="0 0 -2"/>
    <body name="arm">
      <joint name="hinge" axis="0 1 0" damping="0.1" armature="0.01" range="-90 90" frictionloss="0.1"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.03" mass="1"/>
    </body>
  </worldbody>
  <actuator><position name="servo" joint="hinge" kp="20" ctrlrange="-1 1"/></actuator>
  <keyframe><key name="bent" qpos="0.5" ctrl="0.25"/></keyframe>
</mujoco>"#;
    let file = File::new("pendulum.xml", MODEL);
    let ended = run(&["simulate", file.name(), "--integrator", "dopri5"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert!(ended.err.contains("pendulum.xml: the smooth motion, without dry friction, limits, contacts; --print-scene"), "{}", ended.err);
    assert!(ended.out.contains("armature, damping"), "{}", ended.out);
    let printed = run(&["simulate", file.name(), "--print-scene", "--smooth"]).out;
    let expected = r#"# The smooth motion of "pendulum.xml".
file = "pendulum.xml"

[effects]
armature = "file"
damping = "file"
# friction = "file"  # dry friction
# limit = { from = "file", stiffness = 1e4, damping = 10 }  # limits
# contact = { "*" = { from = "collision", plane = "file", stiffness = 1.8e4, damping_time = 1.0e-2, friction = 0.8 } }  # against the planes of the file; 1 kg at rest on 2 points

[initial]
# keyframe = "bent"

[control]
kind = "actuators"
ctrl."servo" = 0.0  # -1.0 to 1.0

[simulation]
end = 5.0
# integrator = "semi_implicit_euler"
# step = "file"  # 0.01 s
"#;
    assert_eq!(printed, expected);
    // Lines that are comments work as well. The servo holds the arm where kp (u − q) is its weight.
    let scene = printed.replace("\n# limit", "\nlimit").replace("\n# contact", "\ncontact").replace("\n# keyframe", "\nkeyframe");
    let scene = scene.replace("\n# integrator = \"semi_implicit_euler\"", "\nintegrator = \"rk4\"").replace("\n# step", "\nstep");
    let scene = scene.replace("ctrl.\"servo\" = 0.0", "ctrl.\"servo\" = 0.5").replace("end = 5.0", "end = 20.0");
    std::fs::write(Path::new(file.name()).with_extension("toml"), scene).unwrap();
    let toml = Path::new(file.name()).with_extension("toml");
    let out = tempfile::tempdir().unwrap();
    let ended = run(&["simulate", toml.to_str().unwrap(), "-o", out.path().to_str().unwrap()]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let table = std::fs::read_to_string(out.path().join("recording.csv")).unwrap();
    let of_row = |row: &str| row.split(',').nth(1).unwrap().parse::<f64>().unwrap();
    let (first, last) = (table.lines().nth(1).unwrap(), table.lines().last().unwrap());
    assert_eq!(of_row(first), 0.5);
    let q = of_row(last);
    assert!((20.0 * (0.5 - q) + 3.7 * 0.25 * q.cos()).abs() < 1e-3, "{q}");
}

/// At rest (1 − d) g = k d² |p|: the ball sinks in by p. Its energy went to the contact.
#[test]
fn a_ball_falls_onto_the_floor_of_its_file() {
    const BALL: &str = r#"<mujoco model="ball">
  <option timestep="0.005"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" condim="1" solimp="0.9 0.9 0.001"/>
    <body name="ball" pos="0 0 0.3"><freejoint/><geom type="sphere" size="0.1" mass="2" condim="1" solimp="0.9 0.9 0.001"/></body>
  </worldbody>
</mujoco>"#;
    let file = File::new("ball.xml", BALL.as_bytes());
    let out = tempfile::tempdir().unwrap();
    let ended = run(&["simulate", file.name(), "--constraints", "--end", "3", "-o", out.path().to_str().unwrap()]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert!(ended.err.contains("steps of 0.005 s by constrained_step_"), "{}", ended.err);
    assert!(ended.out.contains("brought by constraints") && !ended.out.contains("imbalance"), "{}", ended.out);
    let table = std::fs::read_to_string(out.path().join("recording.csv")).unwrap();
    let column = |name: &str| {
        let place = table.lines().next().unwrap().split(',').position(|own| own == name).unwrap_or_else(|| panic!("{name}"));
        table.lines().last().unwrap().split(',').nth(place).unwrap().parse::<f64>().unwrap()
    };
    let depth = 0.1 * 9.81 * 0.02 * 0.02;
    let height = table.lines().last().unwrap().split(',').nth(3).unwrap().parse::<f64>().unwrap();
    assert!((height - (0.1 - depth)).abs() < 1e-9, "{height}");
    assert!((column("from_events") - 2.0 * 9.81 * (height - 0.3)).abs() < 1e-6, "{}", column("from_events"));

    // That is the default; with an integrator it falls on, and the note says so.
    let default = run(&["simulate", file.name(), "--end", "3"]);
    assert!(
        default.out.contains("brought by constraints") && default.err.contains("`--smooth` is the motion without them"),
        "{}",
        default.err
    );
    assert!(run(&["simulate", file.name(), "--integrator", "dopri5"]).err.contains("the smooth motion, without contacts"));
    let told = |words: &[&str]| run(&[&["simulate"], words].concat());
    assert!(told(&["pendulum", "--constraints"]).err.contains("--constraints: found no file of a robot"));
    assert!(told(&[file.name(), "--constraints", "--smooth"]).err.contains("cannot be used with"));
    assert!(told(&[file.name(), "--integrator", "dopri5", "--keyframe", "a"]).err.contains("--keyframe a: found no motion of a file"));
    let free = File::new("free.xml", BALL.replace("condim=\"1\" solimp", "contype=\"0\" conaffinity=\"0\" solimp").as_bytes());
    assert!(told(&[free.name(), "--constraints"]).err.contains("no constraint"), "{}", told(&[free.name(), "--constraints"]).err);
    // An ellipsoid and a ball touch by no law here.
    let round = BALL.replace("type=\"plane\" size=\"1 1 1\"", "type=\"ellipsoid\" size=\"0.1 0.1 0.2\"");
    let egg = File::new("egg.xml", round.as_bytes());
    let refused = told(&[egg.name(), "--constraints"]);
    assert!(refused.status == 1 && refused.err.contains("`--leave-out contact`"), "{}", refused.err);
    let two = BALL.replace("<body name", "<geom type=\"ellipsoid\" size=\"0.1 0.1 0.05\"/><body name");
    let two = File::new("two.xml", two.as_bytes());
    let without = told(&[two.name(), "--constraints", "--leave-out", "contact", "--end", "0.1"]);
    assert!(without.status == 0 && without.err.contains("`leave_out` has \"contact\""), "{}", without.err);
    // Another solver is an error, and Newton's method where an option allows it.
    let pgs =
        File::new("pgs.xml", BALL.replace("timestep=\"0.005\"", "timestep=\"0.005\" solver=\"PGS\" noslip_iterations=\"2\"").as_bytes());
    let refused = told(&[pgs.name(), "--constraints"]);
    assert!(refused.status == 1 && refused.err.contains("`--leave-out solver`"), "{}", refused.err);
    let solved = told(&[pgs.name(), "--constraints", "--leave-out", "solver", "--end", "0.1"]);
    assert!(solved.status == 0 && solved.err.contains("the solver PGS: Newton's method finds the optimum"), "{}", solved.err);
}

#[test]
fn what_cannot_be_found_or_run_is_said() {
    let ended = run(&["simulate", "quadruped_drp"]);
    assert!(ended.status == 1 && ended.err.contains("did you mean \"quadruped_drop\"?"), "{}", ended.err);
    assert!(run(&["effects", "cart_pol"]).err.contains("bundled: "));
    let file = File::new("still.toml", b"robot = \"cart_pole\"\n");
    assert!(run(&["simulate", file.name()]).err.contains("[simulation]"));
    assert_eq!(run(&["simulate", file.name(), "--end", "0.01"]).status, 0);
    for words in [["--integrator", "rk5"], ["--end", "x"], ["--step", "-0.01"], ["--every", "0"]] {
        let ended = run(&[&["simulate", "cart_pole"][..], &words].concat());
        assert!(ended.status == 2 && ended.err.contains("expected") | ended.err.contains("did you mean"), "{words:?}: {}", ended.err);
    }
    let ended = run(&["simulate", "pendulum", "--integrator", "rk4"]);
    assert!(ended.status == 1 && ended.err.contains("--integrator rk4: found no length of its steps, expected --step"), "{}", ended.err);
    let urdf = File::new("arm.urdf", b"<robot name='arm'><link name='base'/></robot>");
    for command in ["simulate", "effects"] {
        assert_eq!(run(&[command, urdf.name()]).status, 0, "{command}");
    }
    // The content defines the format.
    let xacro = File::new("arm.xacro", b"<robot name='arm'><link name='base'/></robot>");
    assert_eq!(run(&["simulate", xacro.name()]).status, 0);
    let ended = run(&["simulate", "pendulum", "--print-scene"]);
    assert!(ended.status == 1 && ended.err.contains("--print-scene: found no file of a robot"), "{}", ended.err);
    let ended = run(&["simulate", "pendulum", "-o", urdf.name()]);
    assert!(ended.status == 1 && ended.err.contains("found a file, expected a folder"), "{}", ended.err);
    // A scene may begin before 0 s. Errors of the command line are not reported at the scene.
    for (words, told) in [
        (["--end", "-1"], "--end: found -1, expected a time after start = 0, s"),
        (["--end", "0"], "--end: found 0, expected a time after start = 0, s"),
        (["--rtol", "-1"], "--rtol: found -1, expected 0, or at least"),
        (["--every", "1e-12"], "--every: found 1e-12, expected at least 9e-8 s, for no more than 1e9 numbers in all"),
    ] {
        let ended = run(&[&["simulate", "cart_pole"][..], &words].concat());
        assert!(ended.status == 1 && ended.err.starts_with(&format!("error: {told}")), "{words:?}: {}", ended.err);
    }
    assert_eq!(run(&["simulate", "cart_pole", "--step", "0.01", "--rtol", "1e-3"]).status, 2);
}

#[test]
fn steps_that_do_not_reach_the_end_are_told_before_they_are_made() {
    let scene =
        |most: u32| format!("robot = \"simple_pendulum\"\n[simulation]\nend = 1\nintegrator = \"rk4\"\nstep = 0.01\nmax_steps = {most}\n");
    for (most, status) in [(30, 1), (100, 0)] {
        let file = File::new("short.toml", scene(most).as_bytes());
        let ended = run(&["simulate", file.name()]);
        let told = ended.err.contains("1.0e2 steps to the end, of which max_steps = 30 are made, up to t = 0.3 s");
        assert_eq!((ended.status, told), (status, status == 1), "{}", ended.err);
    }
}

#[test]
fn a_step_that_is_not_stable_is_refused_and_what_was_up_to_then_is_there() {
    let text = "robot = \"simple_pendulum\"\n[effects.damping]\n\"*\" = 5e3\n[initial]\nv = [1.0]\n[simulation]\nend = 1\nintegrator = \"rk4\"\nstep = 0.01\n";
    let (file, folder) = (File::new("stiff.toml", text.as_bytes()), tempfile::tempdir().unwrap());
    let ended = run(&["simulate", file.name(), "-o", folder.path().to_str().unwrap()]);
    assert!(ended.status == 1 && ended.err.contains("stable"), "{}", ended.err);
    assert!(folder.path().join("recording.csv").is_file(), "{}", ended.out);
    assert!(ended.out.contains("from 0 s to 0 s of 1 s, ended by an error\n"), "{}", ended.out);
    let told = run(&["simulate", file.name(), "--format", "json"]).json();
    assert!(told["requested_end_s"] == 1.0 && told["last_record_s"] == 0.0 && told["end_s"] == 0.0, "{told}");
    assert!(told["error"].as_str().unwrap().contains("at t = "), "{told}");
}

/// The end of a motion, and the last time with a record.
#[test]
fn what_is_told_of_the_end_is_told_with_its_time() {
    let scene = |output: &str| format!("robot = \"simple_pendulum\"\n[initial]\nv = [1.0]\n[simulation]\nend = 2\noutput = {output}\n");
    let file = File::new("early.toml", scene("[0.3]").as_bytes());
    let told = run(&["simulate", file.name(), "--format", "json"]).json();
    assert_eq!((&told["end_s"], &told["requested_end_s"], &told["last_record_s"]), (&2.0.into(), &2.0.into(), &0.3.into()));
    let out = run(&["simulate", file.name()]).out;
    assert!(out.contains("from 0 s to 2 s, ended at its end; last record at 0.3 s") && out.contains("last record     unit"), "{out}");
    let at = |part: &str| out.find(part).unwrap();
    assert!(at("linear momentum") < at("\nin all\n") && at("\nin all\n") < at("\nsteps "), "{out}");
    let file = File::new("ends.toml", scene("\"ends\"").as_bytes());
    let out = run(&["simulate", file.name()]).out;
    assert!(out.contains("from 0 s to 2 s, ended at its end\n") && !out.contains("last record"), "{out}");
}

/// The folder holds what the scene requests: two records, and no drawings, not even of an earlier
/// motion.
#[test]
fn of_a_scene_of_its_ends_two_records_are_written() {
    let text = "robot = \"simple_pendulum\"\n[initial]\nv = [1.0]\n[simulation]\nend = 0.5\noutput = \"ends\"\n";
    let (file, folder) = (File::new("ends.toml", text.as_bytes()), tempfile::tempdir().unwrap());
    let words = ["simulate", file.name(), "-o", folder.path().to_str().unwrap()];
    let there = || {
        let names = std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    };
    assert_eq!(run(&[&words[..], &["--every", "0.1"]].concat()).status, 0);
    assert!(there().contains(&"motion.html".to_owned()) && there().contains(&"energy.svg".to_owned()));
    let ended = run(&words);
    assert_eq!((ended.status, there()), (0, ["recording.csv", "summary.json"].map(str::to_owned).to_vec()));
    let said = "not written, since the ends alone are recorded (--every SECONDS records a motion): pictures, motion.html\n";
    assert!(ended.out.ends_with(said), "{}", ended.out);
    let table = std::fs::read_to_string(folder.path().join("recording.csv")).unwrap();
    let times: Vec<&str> = table.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(times, ["0.0", "0.5"]);
    let summary: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(folder.path().join("summary.json")).unwrap()).unwrap();
    assert_eq!((&summary["counts"]["records"], &summary["page_left_out"]), (&2.into(), &true.into()));
    assert_eq!(summary["pictures_left_out"], serde_json::json!(["positions", "velocities", "torques", "energy"]));
}

/// A pendulum has 1 + 1 + 2 + 12 = 16 columns, so a row has 400 bytes at most.
#[test]
fn much_is_told_before_it_is_written_and_more_than_may_be_is_refused() {
    let scene = |end: &str, output: &str| {
        let text = format!("robot = \"simple_pendulum\"\n[initial]\nv = [1.0]\n[simulation]\nend = {end}\noutput = {output}\n");
        File::new("much.toml", text.as_bytes())
    };
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let long = scene("1e6", "0.1");
    let refused = run(&["simulate", long.name(), "-o", out]);
    let told = format!("--output {out}: found 10000001 rows of 16 columns: up to 4000 MB, expected at most 1000 MB: ");
    assert!(refused.status == 1 && refused.err.contains(&told) && refused.err.contains("--max-output-size"), "{}", refused.err);
    assert!(!folder.path().join("out").exists());

    // 26 001 rows are 10.4 MB, 24 001 are 9.6 MB.
    for (end, expected) in [("2.6", 1), ("2.4", 0)] {
        let file = scene(end, "0.0001");
        let ended = run(&["simulate", file.name(), "-o", out]);
        assert_eq!((ended.status, ended.lines_with("note: ")), (0, expected), "{}", ended.err);
        assert_eq!(run(&["simulate", file.name(), "-o", out, "--max-output-size", "9"]).status, 1);
    }

    // The number of steps is known only after the motion.
    let steps = scene("1e4", "\"steps\"");
    let ended = run(&["simulate", steps.name(), "-o", out, "--max-output-size", "1", "--rtol", "1e-9", "--atol", "1e-9"]);
    assert!(ended.status == 1 && ended.err.contains("unless --max-output-size allows more than 1 MB"), "{}", ended.err);
    let size = |name: &str| std::fs::metadata(folder.path().join("out").join(name)).unwrap().len();
    let written = size("recording.csv");
    assert!((500_000..1_010_000).contains(&written), "{written}");
    assert_eq!(run(&["simulate", steps.name(), "--max-output-size", "1"]).status, 2, "an option of what is written");
}

/// A pendulum that hangs: its angle and its rate are not drawn.
#[test]
fn a_picture_of_nothing_is_not_written_and_that_is_said() {
    let file = File::new("still.toml", b"robot = \"simple_pendulum\"\n[simulation]\nend = 0.1\n");
    let folder = tempfile::tempdir().unwrap();
    let ended = run(&["simulate", file.name(), "-o", folder.path().to_str().unwrap()]);
    assert!(
        ended.status == 0 && ended.out.ends_with("not written, since zero throughout: positions, velocities, torques\n"),
        "{}",
        ended.out
    );
    let summary: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(folder.path().join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["pictures_left_out"], serde_json::json!(["positions", "velocities", "torques"]));
    assert!(!folder.path().join("positions.svg").exists() && folder.path().join("energy.svg").is_file());
}

/// Pictures of another motion would look like those of this one.
#[test]
fn pictures_that_a_motion_has_not_are_removed() {
    let scene = |v: f64| {
        File::new("again.toml", format!("robot = \"simple_pendulum\"\n[initial]\nv = [{v:?}]\n[simulation]\nend = 0.1\n").as_bytes())
    };
    let folder = tempfile::tempdir().unwrap();
    let there = |name: &str| folder.path().join(name).exists();
    let pictures = ["positions.svg", "velocities.svg"];
    std::fs::write(folder.path().join("torques.txt"), "mine").unwrap();
    for (v, expected) in [(1.0, true), (0.0, false)] {
        assert_eq!(run(&["simulate", scene(v).name(), "-o", folder.path().to_str().unwrap()]).status, 0);
        assert!(pictures.iter().all(|name| there(name) == expected) && there("energy.svg") && there("torques.txt"), "{v}");
    }
}

#[test]
fn a_parquet_file_and_a_raster_chart_are_refused_with_the_way_to_get_them() {
    let ended = run(&["simulate", "pendulum", "-o", "motion.parquet"]);
    assert!(ended.status == 2 && ended.err.contains("expected a folder: recording.csv is written into it"), "{}", ended.err);
    let ended = run(&["compare", "simple_pendulum", "--chart", "times.PNG"]);
    assert!(ended.status == 2 && ended.err.contains("found a name that ends with .PNG, expected .svg"), "{}", ended.err);
}

#[test]
fn peers_are_given_bare_scenes_only() {
    let missing = Path::new("/nowhere/peers.json").to_str().unwrap().to_owned();
    let ended = run(&["simulate", "cart_pole", "--against", &missing]);
    assert!(ended.status == 1 && ended.err.contains("found effects, expected none for --against"), "{}", ended.err);
    assert_eq!(run(&["simulate", "chain", "--against", &missing, "-o", "x"]).status, 2);
}

/// Their code would be called with doubles.
#[test]
fn levels_of_single_precision_are_refused_where_states_are_doubles() {
    let scene = File::new("single.toml", b"robot = \"cart_pole\"\nlevel = \"f32_f64\"\n[simulation]\nend = 0.1\n");
    for words in [&["simulate", scene.name(), "--generated"][..], &["effects", scene.name(), "--time"]] {
        let refused = run(words);
        assert_eq!(refused.status, 1, "{words:?}: {}", refused.out);
        assert!(refused.err.contains("level: found f32_f64, expected one whose functions take f64"), "{}", refused.err);
    }
}

/// A tolerance does not choose a fixed step: it is refused, unless the integrator changes too.
#[test]
fn tolerances_of_fixed_steps_are_refused() {
    let text = "robot = \"simple_pendulum\"\n[simulation]\nend = 0.1\nintegrator = \"rk4\"\nstep = 0.01\n";
    let file = File::new("steps.toml", text.as_bytes());
    let ended = run(&["simulate", file.name(), "--rtol", "1e-3", "--atol", "1e-3"]);
    let lines: Vec<&str> = ended.err.lines().filter(|line| line.contains("found a fixed step of 0.01 s (`step` in [simulation]")).collect();
    assert!(ended.status == 1 && lines.len() == 2, "{}", ended.err);
    assert_eq!(run(&["simulate", file.name(), "--integrator", "dopri5", "--rtol", "1e-3"]).status, 0);
}

/// A light body that tumbles fast about all three axes, without forces: its energy is constant.
fn tumbling_body_warns(integrator: &str) {
    let urdf = "<robot name='top'><link name='top'><inertial><mass value='0.1'/>
        <inertia ixx='1e-5' ixy='0' ixz='0' iyy='2e-5' iyz='0' izz='2.8e-5'/></inertial></link></robot>";
    let scene = "urdf = \"top.urdf\"\nbase = \"floating\"\ngravity = [0, 0, 0]
        [initial]\nbase = { angular = [300, 200, 250] }\n[simulation]\nend = 9\noutput = \"ends\"\n";
    let file = File::new("top.toml", scene.as_bytes());
    std::fs::write(file.path.with_extension("urdf"), urdf).unwrap();
    let told = |tolerances: &[&str]| {
        let words = ["simulate", file.name(), "--integrator", integrator, "--format", "json"];
        let ended = run(&[&words[..], tolerances].concat());
        let summary = ended.json();
        let lines: Vec<&str> = ended.err.lines().filter(|line| line.contains("the balance of energy lacks")).collect();
        assert!(ended.status == 0 && summary["status"] == "ok" && lines.len() < 2, "{}", ended.err);
        assert_eq!(summary["warnings"].to_string().contains("the balance of energy lacks"), lines.len() == 1);
        (summary["energy"]["relative_imbalance"].as_f64().unwrap(), lines.first().map(|line| (*line).to_owned()))
    };
    let (part, warned) = told(&[]);
    let warned = warned.unwrap_or_else(|| panic!("{integrator}: {part:e}"));
    assert!((1e-4..0.1).contains(&part) && warned.contains("take smaller tolerances (rtol, atol)"), "{integrator}: {part:e} {warned}");
    let (part, warned) = told(&["--rtol", "1e-7", "--atol", "1e-9"]);
    assert!(part < 5e-5 && warned.is_none(), "{integrator}: {part:e} {warned:?}");
}

#[test]
fn energy_that_dopri5_loses_by_loose_tolerances_is_warned_of() {
    tumbling_body_warns("dopri5");
}

#[test]
fn energy_that_dop853_loses_by_loose_tolerances_is_warned_of() {
    tumbling_body_warns("dop853");
}

/// Two steps, both too long for the balance of energy in three of the scenes.
#[test]
fn bundled_scenes_outside_their_tolerance_are_the_status_of_all() {
    let ended = run(&["simulate", "--all", "--end", "0.04", "--integrator", "rodas4", "--step", "0.02", "--format", "json"]);
    let rows = ended.json();
    let rows = rows.as_array().unwrap();
    let outside: Vec<&str> = rows.iter().filter(|row| row["status"] != "ok").map(|row| row["scene"].as_str().unwrap()).collect();
    assert_eq!(
        (ended.status, rows.len(), outside),
        (5, articulated_models::SCENES.len(), vec!["underwater_arm", "quadruped_drop", "humanoid_float"]),
        "{}",
        ended.err
    );
    for code in ["generated", "generic"] {
        assert_eq!(ended.lines_with(&format!("humanoid_float: {code} code: all steps pass over a stiff layer")), 1, "{}", ended.err);
    }
}

/// `UPDATE_GOLDEN=1` writes it anew. Other processors round other numbers.
#[test]
fn the_picture_of_the_readme_is_what_the_command_writes() {
    let folder = tempfile::tempdir().unwrap();
    let out = run(&["simulate", "quadruped_drop", "-o", folder.path().to_str().unwrap()]);
    assert_eq!(out.status, 0, "{}", out.err);
    let made = std::fs::read_to_string(folder.path().join("motion.svg")).unwrap();
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/motion.svg");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&file, &made).unwrap();
    }
    let kept = std::fs::read_to_string(file).unwrap();
    assert_eq!(made.matches("<animate").count(), kept.matches("<animate").count());
    let sticks = |text: &str| -> Vec<f64> {
        let values = text.rsplit("values=\"").next().unwrap().split('"').next().unwrap().to_owned();
        values.split(['M', 'L', ' ', ';']).filter_map(|word| word.parse().ok()).collect()
    };
    let (made, kept) = (sticks(&made), sticks(&kept));
    assert!(made.len() == kept.len() && made.len() > 1000);
    assert!(made.iter().zip(&kept).all(|(a, b)| (a - b).abs() <= 2.0), "docs/motion.svg is out of date: run with UPDATE_GOLDEN=1");
}

/// A scene with a law is the motion of its robot's file: printed, bundled, and with other controls.
#[test]
fn scenes_with_a_law_touch() {
    let ended = run(&["simulate", "quadruped_lands", "--format", "json"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let summary: serde_json::Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!((&summary["base"], &summary["constraints"]["most_contacts"]), (&"floating".into(), &4.into()));
    assert!(summary["constraints"]["largest_relative_error"].as_f64().unwrap() < 1e-10, "{}", ended.out);
    // It has come to rest on its feet: 15.2 kg, about 0.29 m up.
    assert!(
        summary["energy"]["kinetic_end"].as_f64().unwrap() < 1e-3 && summary["energy"]["end"].as_f64().unwrap() > 35.0,
        "{}",
        ended.out
    );

    // The printed scene is that of the file's motion.
    let robot = articulated_models::robot("landing_quadruped").unwrap();
    let file = File::new("quadruped.xml", robot.urdf.as_bytes());
    let printed = run(&["simulate", file.name(), "--print-scene"]);
    assert!(printed.out.contains("law = \"mujoco\"") && printed.out.contains("keyframe = \"home\""), "{}", printed.out);
    let folder = std::path::Path::new(file.name()).parent().unwrap();
    let scene = folder.join("scene.toml");
    let with = |text: &str| {
        std::fs::write(&scene, text).unwrap();
        run(&["simulate", scene.to_str().unwrap(), "--end", "0.4", "--format", "json"])
    };
    let last = |ended: &Ended| {
        assert_eq!(ended.status, 0, "{}", ended.err);
        let summary: serde_json::Value = serde_json::from_str(&ended.out).unwrap();
        summary["energy"]["end"].as_f64().unwrap()
    };
    let by_scene = with(&printed.out);
    let by_file = run(&["simulate", file.name(), "--end", "0.4", "--format", "json"]);
    assert_eq!(last(&by_scene), last(&by_file));
    // Controls over time, by a table of actuators.
    let table = printed.out.replace("keyframe = \"home\"\n# ctrl", "columns = [\"actuator_2\"]\nrows = [[0.0, -1.6], [0.4, -1.2]]\n# ctrl");
    assert!(last(&with(&table)).is_finite() && last(&with(&table)) != last(&by_scene), "{table}");

    for (from, to, lines) in [
        ("law = \"mujoco\"", "law = \"bullet\"", vec!["simulation.law: found \"bullet\", expected one of \"mujoco\""]),
        (
            "law = \"mujoco\"",
            "law = \"mujoco\"\nrtol = 1e-3\nevents = [\"limits\"]",
            vec!["simulation.rtol: found", "simulation.events: found"],
        ),
        ("[effects]", "[effects]\nfriction = \"file\"", vec!["effects.friction", "beside simulation.law"]),
        ("kind = \"actuators\"\nkeyframe = \"home\"", "kind = \"torque\"", vec!["control.kind: found torques beside simulation.law"]),
    ] {
        let ended = with(&printed.out.replace(from, to));
        assert_eq!(ended.status, 1, "{to}: {}", ended.err);
        assert!(lines.iter().all(|line| ended.err.contains(line)), "{to}: {}", ended.err);
    }
    let ended = run(&["simulate", "quadruped_lands", "--integrator", "dopri5"]);
    assert!(ended.status == 2 && ended.err.contains("--integrator: found simulation.law"), "{}", ended.err);
    let ended = run(&["check", "quadruped_lands"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
}

/// What touches after a rollout, and how exact the accelerations are.
#[test]
fn a_rollout_lists_its_contacts() {
    let robot = File::new("humanoid.xml", articulated_models::robot("standing_humanoid").unwrap().urdf.as_bytes());
    let words = ["rollout", robot.name(), "--constraints", "--contacts", "--steps", "500"];
    let ended = run(&words);
    assert!(ended.status == 0 && ended.out.contains("8 contacts") && ended.out.contains("floor, left_foot"), "{}{}", ended.out, ended.err);
    let ended = run(&[&words[..], &["--format", "json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&ended.out).unwrap();
    let state = &report["states"][0];
    assert!(state["relative_error"].as_f64().unwrap() < 1e-10, "{}", ended.out);
    // The feet carry the weight, but for a sway of less than 2 %.
    let up: f64 = state["contacts"].as_array().unwrap().iter().map(|contact| contact["force"][2].as_f64().unwrap()).sum();
    let info = run(&["check", robot.name(), "--format", "json"]);
    let mass = serde_json::from_str::<serde_json::Value>(&info.out).unwrap()["totals"]["mass"].as_f64().unwrap();
    assert!((up / (9.81 * mass) - 1.0).abs() < 0.02, "{up} N of {mass} kg");
    assert!(run(&["rollout", robot.name(), "--contacts", "--steps", "5"]).status == 2);
}
