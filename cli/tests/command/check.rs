use super::{File, articulated, end, run, run_with};

const MASSLESS: &str = r#"<robot name="r"><link name="a"/><link name="b"/>
<joint name="idle" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>"#;

#[test]
fn every_bundled_robot_is_usable() {
    for robot in articulated_models::ROBOTS {
        let text = run(&["check", robot.name]);
        assert_eq!(text.status, 0, "{}", text.out);
        assert!(text.out.contains(" of freedom") && text.lines_with("error") == 0);
        let json = run(&["check", robot.name, "--format", "json"]).json();
        assert_eq!(json["usable"], true);
        // One line for each sort of warning.
        let (listed, lines) = (json["warnings"].as_array().unwrap().len(), text.lines_with("warning"));
        assert!(lines <= listed && (lines == 0) == (listed == 0), "{}", text.out);
    }
}

/// Equal warnings are one line in text; as data, each is listed.
#[test]
fn warnings_of_one_sort_are_one_line_with_a_count() {
    let inertia = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
    let finger = |k: u32| {
        format!(
            "<link name='l{k}'>{inertia}</link><joint name='j{k}' type='revolute'><parent link='base'/><child link='l{k}'/>
             <axis xyz='0 0 2'/><origin rpy='1.57079632679 0 0'/><limit lower='-1' upper='1' effort='0' velocity='1'/></joint>"
        )
    };
    let hand = format!("<robot name='hand'><link name='base'/>{}</robot>", (0..28).map(finger).collect::<String>());
    let urdf = File::new("hand.urdf", hand.as_bytes());
    let scene = File::new("hand.toml", format!("urdf = {:?}\nsimulation = {{ end = 0.001 }}", urdf.name()).as_bytes());
    let states = File::new("states.json", format!("[{{\"q\": {:?}}}]", [0.0; 28]).as_bytes());
    let sorts = ["limit effort: found zero", "axis: found (0.0 0.0 2.0) of length 2.0000"];
    for words in [
        &["check", urdf.name()][..],
        &["generate", urdf.name(), "--functions", "gravity_torque"],
        &["eval", urdf.name(), "--function", "gravity_torque", "--states", states.name(), "--generic"],
        &["simulate", scene.name()],
    ] {
        let ended = run(words);
        assert_eq!(ended.status, 0, "{}", ended.err);
        let lines: Vec<&str> = ended.out.lines().chain(ended.err.lines()).filter(|line| line.starts_with("warning: ")).collect();
        for sort in sorts {
            let told: Vec<&&str> = lines.iter().filter(|line| line.contains(sort)).collect();
            assert_eq!(told.len(), 1, "{words:?}: {lines:?}");
            assert!(
                told[0].contains("joint \"j0\"") && told[0].contains("(and 27 more: joint \"j1\", joint \"j2\", joint \"j3\" and 24 more)"),
                "{told:?}"
            );
        }
    }
    let source = run(&["generate", urdf.name(), "--functions", "gravity_torque"]).out;
    assert!(source.contains("WARNINGS: [&str; 2]"), "{source}");
    let json = run(&["check", urdf.name(), "--format", "json"]).json();
    let told = json["warnings"].as_array().unwrap();
    assert_eq!(told.iter().filter(|w| w["message"].as_str().unwrap().contains(sorts[0])).count(), 28);
}

#[test]
fn an_angle_that_is_nearly_right_names_the_option_that_makes_it_so() {
    let link = |k: usize| {
        format!(
            "<link name='l{k}'><inertial><origin xyz='0.1 0.02 0.3'/><mass value='2'/>\
             <inertia ixx='0.1' ixy='0.01' ixz='0.02' iyy='0.2' iyz='0.03' izz='0.15'/></inertial></link>"
        )
    };
    let joint = |k: usize, angle: &str| {
        format!(
            "<joint name='j{k}' type='continuous'><parent link='l{}'/><child link='l{k}'/>\
             <origin xyz='0.1 0.2 0.3' rpy='{angle} 0 0'/><axis xyz='0 0 1'/></joint>",
            k - 1
        )
    };
    // A tool that is fixed costs nothing, whatever its angle.
    let tool =
        "<link name='tool'/><joint name='mount' type='fixed'><parent link='l3'/><child link='tool'/><origin rpy='1.5708 0 0'/></joint>";
    let arm = |angle: &str| {
        let links: String = (0..4).map(link).chain((1..4).map(|k| joint(k, angle))).collect();
        File::new("arm.urdf", format!("<robot name='r'>{links}{tool}</robot>").as_bytes())
    };
    let told = |file: &File, words: &[&str]| {
        let ended = run(&[&["check", file.name()], words].concat());
        ended.out.lines().find(|line| line.contains("nearly a multiple of π/2")).map(str::to_owned)
    };
    let line = told(&arm("1.5708"), &[]).unwrap();
    assert!(line.contains("joint \"j1\": origin rpy: found 1.5708, nearly a multiple of π/2 (and 3 more)"), "{line}");
    assert!(line.contains("`--snap-angles 1e-5` (key `snap_angles`"), "{line}");
    let numbers = line.split_once("exact ones make ").and_then(|(_, rest)| rest.split_once(" instructions of inverse dynamics"));
    let (then, now) = numbers.and_then(|(numbers, _)| numbers.split_once(" of ")).unwrap_or_else(|| panic!("{line}"));
    assert!(then.parse::<u32>().unwrap() < now.parse::<u32>().unwrap(), "{line}");
    // The tolerance that the warning names makes the angles exact.
    assert_eq!(told(&arm("1.5708"), &["--snap-angles", "1e-5"]), None);
    assert!(told(&arm("1.57"), &[]).is_none() && told(&arm("1.57085"), &[]).unwrap().contains("`--snap-angles 1e-4`"));
    // Nothing is promised where there is no gain.
    assert_eq!((told(&arm("1.5707963267948966"), &[]), told(&arm("1.5"), &[])), (None, None));
}

#[test]
fn an_inertia_that_an_option_accepts_names_the_option() {
    let plate = MASSLESS.replace(
        "<link name=\"b\"/>",
        "<link name='b'><inertial><mass value='0.001'/><inertia ixx='3e-8' ixy='6e-8' ixz='0' iyy='3e-8' iyz='0' izz='5e-8'/></inertial></link>",
    );
    let file = File::new("plate.urdf", plate.as_bytes());
    let refused = run(&["check", file.name()]);
    let names = ["`--allow-unphysical-inertia`", "key `allow_unphysical_inertia`", "method `Build::allow_unphysical_inertia`"];
    assert!(refused.status == 1 && names.iter().all(|name| refused.out.contains(name)), "{}", refused.out);
    assert_eq!(run(&["check", file.name(), "--allow-unphysical-inertia"]).status, 0);
}

#[test]
fn a_gravity_that_no_place_has_is_warned_of() {
    for (gravity, warned) in [("0,0,-9810", 1), ("0,0,-274", 0), ("1e9,0,0", 1)] {
        let ended = run(&["check", "panda_like", "--gravity", gravity]);
        assert_eq!((ended.status, ended.lines_with("gravity: found")), (0, warned), "{}", ended.out);
    }
}

/// For a misspelt file name the error suggests the nearest file, not a bundled robot.
#[test]
fn a_file_that_is_not_there_is_told_with_the_nearest() {
    let file = File::new("elbow.urdf", MASSLESS.as_bytes());
    let ended = run(&["check", &file.name().replace("elbow", "elbwo")]);
    assert!(ended.status == 1 && ended.err.contains("did you mean \"elbow.urdf\"?"), "{}", ended.err);
}

/// Several joints on a body and joints away from the origin of their body: each link moves with the
/// last joint before it, and each joint carries the links behind it. Sites are not links.
#[test]
fn joints_in_sequence_and_beside_the_origin_have_their_own_rows() {
    let crane = File::new(
        "crane.xml",
        b"<mujoco model='crane'><worldbody><site name='ground'/><body name='cab'><joint name='turn' pos='0.2 0 0'/>
          <geom size='0.1' mass='8'/><site name='seat'/><body name='boom' pos='0.5 0 0'>
          <joint name='raise' axis='0 1 0' pos='-0.1 0 0'/><joint name='reach' type='slide' axis='1 0 0'/>
          <joint name='roll' axis='1 0 0'/><geom size='0.1' mass='3'/><site name='end'/>
          <body name='hook' pos='0 0 -1'><joint name='swing' type='ball' pos='0 0 0.4'/><geom size='0.05' mass='1'/></body>
          </body></body></worldbody></mujoco>",
    );
    let ended = run(&["check", crane.name()]);
    assert!(ended.status == 0 && ended.out.contains("crane, fixed base: 4 links"), "{}{}", ended.out, ended.err);
    let json = run(&["check", crane.name(), "--format", "json"]).json();
    let rows = |list: &str, name: &str, value: &str| -> Vec<(String, serde_json::Value)> {
        let rows = json[list].as_array().unwrap();
        rows.iter().map(|row| (row[name].as_str().unwrap().to_owned(), row[value].clone())).collect()
    };
    let moves_with = [("world", None), ("cab", Some("turn")), ("boom", Some("roll")), ("hook", Some("swing"))];
    assert_eq!(rows("links", "link", "moves_with"), moves_with.map(|(link, joint)| (link.to_owned(), joint.into())));
    let carries = [("turn", 12.0), ("raise", 4.0), ("reach", 4.0), ("roll", 4.0), ("swing", 1.0)];
    let moving: Vec<_> = rows("joints", "joint", "carries").into_iter().filter(|(_, mass)| *mass != 0.0).collect();
    assert_eq!(moving, carries.map(|(joint, mass)| (joint.to_owned(), mass.into())));
}

#[test]
fn the_mass_table_adds_up() {
    let golfer = run(&["check", "golfer", "--format", "json"]).json();
    assert!((golfer["totals"]["mass"].as_f64().unwrap() - 73.26).abs() < 0.01);
    assert_eq!(golfer["totals"]["degrees_of_freedom"], 15);
    let sum: f64 = golfer["links"].as_array().unwrap().iter().map(|l| l["mass"].as_f64().unwrap()).sum();
    assert!((sum - golfer["totals"]["mass"].as_f64().unwrap()).abs() < 1e-9);
    let gripper = run(&["check", "gripper_arm", "--format", "json"]).json();
    let follows = |name: &str| {
        let joint = gripper["joints"].as_array().unwrap().iter().find(|j| j["joint"] == name).unwrap();
        joint["mimic"]["leaders"][0]["multiplier"].as_f64()
    };
    assert_eq!((follows("pinion"), follows("yaw")), (Some(80.0), None));
    assert!(!gripper["unused"].as_array().unwrap().is_empty());
}

/// A wrist driven by two motors: both are in the report, with the sum of the offsets.
#[test]
fn a_joint_that_follows_several_is_reported_with_all_of_them() {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>"
        )
    };
    let joint = |name: &str, child: &str, mimics: &str| {
        format!("<joint name='{name}' type='continuous'><parent link='trunk'/><child link='{child}'/><axis xyz='0 0 1'/>{mimics}</joint>")
    };
    let links = ["trunk", "left", "right", "hand"].map(link).concat();
    let mimics = "<mimic joint='m1' multiplier='0.5' offset='0.25'/><mimic joint='m2' multiplier='-0.75' offset='-0.125'/>";
    let joints = [joint("m1", "left", ""), joint("m2", "right", ""), joint("roll", "hand", mimics)].concat();
    let file = File::new("wrist.urdf", format!("<robot name='wrist'>{links}{joints}</robot>").as_bytes());
    let text = run(&["check", file.name()]);
    assert!(text.status == 0 && text.out.contains(" 0.5 · m1 - 0.75 · m2 + 0.125 "), "{}{}", text.out, text.err);
    let json = run(&["check", file.name(), "--format", "json"]).json();
    let row = json["joints"].as_array().unwrap().iter().find(|row| row["joint"] == "roll").unwrap();
    let leaders = serde_json::json!([{"joint": "m1", "multiplier": 0.5}, {"joint": "m2", "multiplier": -0.75}]);
    assert_eq!(row["mimic"], serde_json::json!({"leaders": leaders, "offset": 0.125}));
    // It is two bodies of the model.
    assert!(text.out.contains("that follows several have a row for each of their stages"), "{}", text.out);
}

/// The humanoid's file has its legs before its arms, and q has them after.
#[test]
fn joints_are_in_the_order_of_q_and_those_without_come_last() {
    for (robot, without) in [("humanoid", false), ("gripper_arm", true)] {
        let json = run(&["check", robot, "--format", "json"]).json();
        let places: Vec<u64> = json["joints"].as_array().unwrap().iter().map(|j| j["q"][0].as_u64().unwrap_or(u64::MAX)).collect();
        assert!(places.is_sorted() && places[0] == 0, "{robot}: {places:?}");
        assert_eq!(places.contains(&u64::MAX), without, "{robot}: {places:?}");
    }
}

#[test]
fn what_is_not_known_is_not_said_to_be_understood() {
    let urdf = MASSLESS.replace("<link name=\"b\"/>", "<link name=\"b\"><foo/></link>");
    let told = run_with(&["check", "-"], urdf.as_bytes()).out;
    let (head, lines) = told.split_once("\nNot used, and why:\n").unwrap_or_else(|| panic!("{told}"));
    assert!(lines.contains("foo: not known\n") && !head.contains("nderstood"), "{told}");
}

#[test]
fn the_base_can_be_chosen() {
    let freedoms = |words: &[&str]| run(&[&["check", "--format", "json"], words].concat()).json()["totals"]["degrees_of_freedom"].clone();
    assert_eq!(freedoms(&["quadruped"]), 18);
    assert_eq!(freedoms(&["quadruped", "--fixed"]), 12);
    assert_eq!(freedoms(&["panda_like", "--floating"]), 13);
}

#[test]
fn every_error_has_its_own_line() {
    let urdf = r#"<robot name="r"><link name="a"><inertial><mass value="-1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <link name="b"/><joint name="j" type="hinge"><parent link="a"/><child link="c"/></joint></robot>"#;
    let file = File::new("bad.urdf", urdf.as_bytes());
    let text = run(&["check", file.name()]);
    let json = run(&["check", file.name(), "--format", "json"]);
    let errors = json.json()["errors"].as_array().unwrap().len();
    assert_eq!((text.status, json.status), (1, 1));
    assert!(errors >= 3, "{}", text.out);
    assert_eq!(text.lines_with("error"), errors, "{}", text.out);
}

#[test]
fn a_joint_that_moves_no_mass_is_a_warning() {
    let file = File::new("idle.urdf", MASSLESS.as_bytes());
    let text = run(&["check", file.name(), "--function", "inverse_dynamics"]);
    assert_eq!(text.status, 0);
    assert_eq!(text.lines_with("warning"), 1, "{}", text.out);
    assert!(text.out.contains("forward dynamics is undefined") && text.out.contains("inverse_dynamics can be generated"), "{}", text.out);
}

#[test]
fn names_that_are_one_in_rust_are_a_warning() {
    let robot = r#"<robot name="r"><link name="a"/><link name="b b"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><link name="b-b"/><link name="b_b"/>
<joint name="turn" type="continuous"><parent link="a"/><child link="b b"/><axis xyz="0 0 1"/></joint>
<joint name="w" type="fixed"><parent link="a"/><child link="b-b"/></joint><joint name="u" type="fixed"><parent link="a"/><child link="b_b"/></joint></robot>"#;
    let file = File::new("r.urdf", robot.as_bytes());
    let checked = run(&["check", file.name()]);
    assert_eq!(
        (checked.status, checked.lines_with("`B_B` in Rust; `--rename` (key `rename`, method `Build::rename`) gives one another name")),
        (0, 2),
        "{}",
        checked.out
    );
    let renamed = run(&["check", file.name(), "--rename", "b-b=B", "--rename", "b b=B_1"]);
    assert_eq!((renamed.status, renamed.lines_with("rename")), (0, 0), "{}", renamed.out);
}

#[test]
fn an_unphysical_inertia_is_an_error_unless_allowed() {
    let urdf = r#"<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="-2"/></inertial></link>
        <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>"#;
    let file = File::new("odd.urdf", urdf.as_bytes());
    assert_eq!(run(&["check", file.name()]).status, 1);
    let allowed = run(&["check", file.name(), "--allow-unphysical-inertia"]);
    assert_eq!(allowed.status, 0);
    assert!(allowed.lines_with("warning") >= 1);
}

#[test]
fn a_joint_that_turns_a_mass_on_its_axis_is_said_to_lack_inertia() {
    let mass = r#"<link name="b"><inertial><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>"#;
    let file = File::new("spinner.urdf", MASSLESS.replace(r#"<link name="b"/>"#, mass).as_bytes());
    let out = run(&["check", file.name()]).out;
    assert!(out.contains("has no inertia of its own") && !out.contains("moves no mass"), "{out}");
}

#[test]
fn a_snapped_angle_is_told() {
    let urdf = MASSLESS.replace("<parent", "<origin rpy=\"1.5708 0 0\"/><parent");
    let file = File::new("almost.urdf", urdf.as_bytes());
    let snapped = run(&["check", file.name(), "--snap-angles", "1e-4"]);
    assert_eq!((snapped.status, snapped.lines_with("warning")), (0, 2), "{}", snapped.out);
}

#[test]
fn a_tolerance_of_angles_is_above_nothing() {
    for tolerance in ["0", "0.6", "nan", "much"] {
        let ended = run(&["check", "panda_like", "--snap-angles", tolerance]);
        assert_eq!(ended.status, 2, "{tolerance}");
        let expected = "expected a finite number above 0, at most 0.5 rad; leave it out to snap none";
        assert!(ended.err.contains(tolerance) && ended.err.contains(expected), "{}", ended.err);
    }
}

/// Errors that prevent a simulation are errors of the scene in every command.
#[test]
fn a_scene_is_usable_if_its_motion_can_begin() {
    let table = File::new("table.csv", b"t,nobody\n0,1\n");
    let simulation = "[simulation]\nend = 1.0\n";
    for (text, told) in [
        ("[control]\nkind = \"table\"\nfile = \"no_such.csv\"\n".to_owned(), "which cannot be read"),
        (format!("[control]\nkind = \"table\"\nfile = {:?}\n", table.name()), "nobody"),
        (
            "[impact]\nlink = \"lower_rod\"\nnormal = [1, 0, 0]\nmass = 0.1\nrestitution = 0.5\ntime = 5.0\n".to_owned(),
            "impact.time: found 5.0",
        ),
    ] {
        let scene = File::new("motion.toml", format!("robot = \"double_pendulum\"\n{simulation}{text}").as_bytes());
        let checked = run(&["check", scene.name()]);
        assert!(checked.status == 1 && checked.out.contains(told), "{text}: {}{}", checked.out, checked.err);
        assert!(checked.out.contains(&format!("of {}: not usable", scene.name())), "{}", checked.out);
    }
    let far = File::new("far.toml", format!("robot = \"panda_like\"\n[initial]\nq = {{ joint_1 = 9.0 }}\n{simulation}").as_bytes());
    let checked = run(&["check", far.name()]);
    assert!(checked.status == 0 && checked.out.contains("initial.q.joint_1: found 9, beyond its limits"), "{}{}", checked.out, checked.err);
}

#[test]
fn an_unknown_name_is_guessed() {
    let wrong = run(&["check", "panda_lik"]);
    assert_eq!(wrong.status, 1);
    assert!(wrong.err.contains("error") && wrong.err.contains("did you mean \"panda_like\"?"), "{}", wrong.err);
}

#[test]
fn of_files_larger_than_may_be_nothing_is_read_and_sizes_are_told() {
    let vast = File::new("vast.csv", b"");
    std::fs::File::create(vast.name()).unwrap().set_len(1 << 40).unwrap();
    let scene = |keys: &str| File::new("s.toml", format!("robot = 'simple_pendulum'\nsimulation = {{ end = 1 }}\n{keys}").as_bytes());
    let table = scene(&format!("control = {{ kind = 'table', file = {:?} }}", vast.name()));
    let append = scene(&format!("append = {{ urdf = {:?}, at = 'bob', prefix = 'x' }}", vast.name()));
    let cases = [
        (&["check", vast.name()][..], 64 << 20),
        (&["check", append.name()], 64 << 20),
        (&["eval", "simple_pendulum", "--function", "bias_forces", "--states", vast.name()], 64 << 20),
        (&["simulate", table.name()], 4_u64 << 30),
    ];
    for (words, most) in cases {
        let ended = run(words);
        let told = format!("found 1099511627776 bytes, expected at most {most} bytes");
        assert!(ended.status == 1 && ended.err.contains(vast.name()) && ended.err.contains(&told), "{words:?}: {}", ended.err);
    }
}

#[test]
fn what_is_there_and_cannot_be_read_is_not_taken_for_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let name = folder.path().to_str().unwrap();
    for words in [&["check", name][..], &["check", "panda_like", "--append", &format!("{name}@hand")], &["simulate", name]] {
        let ended = run(words);
        assert_eq!(ended.status, 1, "{}", ended.err);
        assert!(ended.err.starts_with(&format!("error: {name}: ")) && !ended.err.contains("bundled"), "{}", ended.err);
    }
    assert!(run(&["check", name]).err.contains(": cannot be read: "));
}

#[test]
fn any_bytes_are_refused_with_an_error() {
    let mut numbers = articulated_lab::states::SplitMix64::new(3);
    let pendulum = articulated_models::robot("simple_pendulum").unwrap().urdf.as_bytes();
    for round in 0..40 {
        let bytes: Vec<u8> = match round % 4 {
            0 => (0..round * 50).map(|_| numbers.bits() as u8).collect(),
            1 => pendulum[..numbers.bits() as usize % pendulum.len()].to_vec(),
            2 => b"<robot name='\0\x1b[31m'>".repeat(round),
            _ => {
                let mut bytes = pendulum.to_vec();
                let at = numbers.bits() as usize % bytes.len();
                bytes[at] = numbers.bits() as u8;
                bytes
            }
        };
        let ended = run_with(&["check", "-"], &bytes);
        assert!(ended.status <= 1, "{} {}", ended.status, ended.err);
        assert!(ended.status == 0 || ended.lines_with("error") > 0);
    }
}

/// Published: 43 (Gaz et al., IEEE RA-L 4, 2019).
#[test]
fn base_parameters_are_counted_and_listed() {
    let json = run(&["check", "panda_like", "--format", "json"]).json();
    let base = &json["base_parameters"];
    assert_eq!((base["parameters"].as_u64(), base["identifiable"].as_u64()), (Some(70), Some(43)));
    assert_eq!(base["joints"][0]["joint"], "joint_7");
    let text = run(&["check", "panda_like"]);
    assert!(text.out.contains("torques determine 43"), "{}", text.out);
}

/// Errors of `simulate`, and its warnings.
#[test]
fn a_scene_whose_motion_would_be_refused_is_not_usable() {
    let inertia = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
    let arm = |hand: &str| {
        let links = format!("<link name='a'/><link name='b'>{inertia}</link><link name='c'>{hand}</link>");
        let joint = |name, parent, child| {
            format!("<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/><axis xyz='0 1 0'/></joint>")
        };
        File::new("arm.urdf", format!("<robot name='arm'>{links}{}{}</robot>", joint("j", "a", "b"), joint("k", "b", "c")).as_bytes())
    };
    let checked = |urdf: &File, rest: &str| {
        let scene = File::new("s.toml", format!("urdf = {:?}\n{rest}", urdf.name()).as_bytes());
        let ended = run(&["check", scene.name(), "--format", "json"]);
        (ended.status, run(&["simulate", scene.name()]).status, ended.json())
    };
    let (checks, moves, json) = checked(&arm(""), "simulation = { end = 0.01 }");
    assert_eq!((checks, moves, json["usable"].as_bool()), (1, 1, Some(false)));
    assert!(
        json["errors"].to_string().contains("forward_dynamics: found no inertia of its own for joint k, expected"),
        "{}",
        json["errors"]
    );
    let (checks, moves, json) = checked(&arm(inertia), "simulation = { end = 0.01, events = ['contacts', 'limits'] }");
    assert_eq!((checks, moves), (0, 0));
    assert_eq!(json["warnings"].to_string().matches("nothing to look for").count(), 2, "{}", json["warnings"]);
}

#[test]
fn effects_are_no_inertial_parameters_and_what_they_take_of_the_file_is_used() {
    for (scene, robot) in [("arm", "panda_like"), ("underwater_arm", "ur5_like")] {
        let felt = |name: &str| run(&["check", name, "--format", "json"]).json()["base_parameters"]["identifiable"].as_u64().unwrap();
        assert_eq!(felt(scene), felt(robot), "{scene}");
    }
    let urdf = br#"<robot name="arm"><link name="a"/><link name="b"><inertial><mass value="1"/>
        <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <joint name="j" type="continuous"><parent link="a"/><child link="b"/><dynamics damping="0.5" friction="0.25"/></joint></robot>"#;
    let urdf = File::new("arm.urdf", urdf);
    let unused = |effects: &str| {
        let scene = File::new("s.toml", format!("urdf = {:?}\n{effects}", urdf.name()).as_bytes());
        let told = run(&["check", scene.name(), "--format", "json"]).json()["unused"].to_string();
        ["damping", "friction"].map(|tag| told.contains(&format!("dynamics {tag}")))
    };
    assert_eq!(unused(""), [true, true]);
    assert_eq!(unused("effects.damping = \"urdf\""), [false, true]);
    assert_eq!(unused("effects.damping.j = 0.1"), [true, true]);
}

/// A folder or a file of that name is reached by `./`.
#[test]
fn a_bundled_name_is_the_bundled_one_wherever_it_is_said() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("pendulum")).unwrap();
    std::fs::write(folder.path().join("golf_swing"), "robot = 3").unwrap();
    let run_there = |words: &[&str]| {
        let mut command = articulated(words);
        command.current_dir(folder.path());
        end(command, b"")
    };
    for words in [&["check", "pendulum"][..], &["check", "golf_swing"], &["simulate", "pendulum", "--end", "0.01"]] {
        let ended = run_there(words);
        assert_eq!(ended.status, 0, "{words:?}: {}", ended.err);
    }
    let own = run_there(&["simulate", "./golf_swing"]);
    assert!(own.status == 1 && own.err.contains("./golf_swing:1: robot: found 3"), "{}", own.err);
    let near = run(&["check", "golf_swng"]);
    assert!(near.status == 1 && near.err.contains("did you mean \"golf_swing\"?"), "{}", near.err);
    std::fs::write(folder.path().join("s.TOML"), "robot = \"cart_pole\"").unwrap();
    assert_eq!(run_there(&["check", "s.TOML"]).status, 0);
}

#[test]
fn errors_of_scenes_have_their_lines_in_json() {
    let scene = File::new("wrong.toml", b"robot = \"cart_pole\"\ngravity = [0]\n[initial]\nq = 3\n");
    for command in ["check", "simulate"] {
        let errors = run(&[command, scene.name(), "--format", "json"]).json()["errors"].clone();
        let at: Vec<_> = errors.as_array().unwrap().iter().map(|e| (e["line"].as_u64(), e["field"].as_str())).collect();
        assert_eq!(at, [(Some(2), Some("gravity")), (Some(4), Some("initial.q"))], "{command}: {errors}");
    }
}

#[test]
fn what_is_not_read_can_be_left_out() {
    let text =
        "<mujoco><worldbody><body name='a'><joint name='j'/><geom size='0.1'/></body>\n<flexcomp name='cloth'/></worldbody></mujoco>";
    let robot = File::new("cloth.xml", text.as_bytes());
    let refused = run(&["check", robot.name()]);
    assert!(refused.status == 1 && refused.out.contains(":2: flexcomp: found a flexible body \"cloth\""), "{}", refused.out);
    assert!(refused.out.contains("`--leave-out flex` (key `leave_out`, method `Build::leave_out`)"), "{}", refused.out);
    let scene = File::new("cloth.toml", format!("file = {:?}\nleave_out = [\"flex\"]", robot.name()).as_bytes());
    for words in [&["check", robot.name(), "--leave-out", "plugin,flex"][..], &["check", scene.name()]] {
        let accepted = run(&[words, &["--format", "json"]].concat()).json();
        assert_eq!((&accepted["usable"], &accepted["warnings"][0]["line"]), (&true.into(), &2.into()), "{accepted}");
    }
    let wrong = run(&["check", robot.name(), "--leave-out", "flexible"]);
    assert!(wrong.status == 2 && wrong.err.contains("expected flex, composite, plugin, constraint, solver or contact"), "{}", wrong.err);
}
