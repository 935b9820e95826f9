use articulated_codegen::{Request, generate};

use super::{File, run};

#[test]
fn the_source_is_that_of_the_library() {
    for name in ["cart_pole", "gripper_arm", "quadruped"] {
        let robot = articulated_models::robot(name).unwrap();
        let mut request = Request::new(format!("{name}.urdf"), robot.urdf);
        request.options.robot.base = robot.base;
        let made = run(&["generate", name]);
        assert_eq!(made.status, 0);
        assert!(made.out == generate(&request).unwrap().source, "{name}");
    }
}

#[test]
fn flags_arrive_in_the_request() {
    let robot = articulated_models::robot("cart_pole").unwrap();
    let mut request = Request::new("cart_pole.urdf", robot.urdf);
    request.options.functions = vec!["gravity_torque".into(), "bias_forces".into()];
    request.options.robot.gravity = Some([0.0, -1.5, 2.0]);
    request.options.rust_mut().runtime = Some("::articulated".into());
    let source = generate(&request).unwrap().source;
    let words =
        ["generate", "cart_pole", "--functions", "gravity_torque,bias_forces", "--gravity", "0,-1.5,2", "--runtime", "::articulated"];
    assert!(run(&words).out == source);
    let file = File::new("out.rs", b"");
    let written = run(&[&words[..], &["-o", file.name()]].concat());
    assert_eq!((written.status, written.out.as_str()), (0, ""));
    assert!(std::fs::read_to_string(&file.path).unwrap() == source);
    let json = run(&[&words[..], &["--format", "json"]].concat()).json();
    assert_eq!(json["source"], source);
    // A file to compile is one in any case.
    let both = run(&[&words[..], &["-o", file.name(), "--format", "json"]].concat()).json();
    assert_eq!((&both["source"], std::fs::read_to_string(file.name()).unwrap().as_str()), (&json["source"], source.as_str()));
    assert_eq!(json["functions"][0]["stages"][0]["stage"], "requested");
}

#[test]
fn c_is_a_header_and_a_source_in_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm");
    let words = ["generate", "cart_pole", "--functions", "inverse_dynamics", "--language", "c"];
    let made = run(&[&words[..], &["-o", path.to_str().unwrap()]].concat());
    assert_eq!((made.status, made.out.as_str()), (0, ""), "{}", made.err);
    let [header, source] = ["cart_pole.h", "cart_pole.c"].map(|name| std::fs::read_to_string(path.join(name)).unwrap());
    assert!(header.contains("void cart_pole_inverse_dynamics(") && source.contains("#include \"cart_pole.h\""));
    // One header, to a file or to the standard output.
    let single = folder.path().join("single.h");
    assert_eq!(run(&[&words[..], &["-o", single.to_str().unwrap()]].concat()).status, 0);
    let text = std::fs::read_to_string(single).unwrap();
    assert!(text.contains("static inline void cart_pole_inverse_dynamics(") && run(&words).out == text);
    let renamed = run(&[&words[..], &["--rename", "slide=cart"]].concat());
    assert!(renamed.out.contains("CART_POLE_JOINT_CART = 0"), "{}{}", renamed.out, renamed.err);
    assert!(run(&[&words[..], &["--prefix", "my"]].concat()).out.contains("void my_inverse_dynamics("));
    for (more, told) in [
        (&["--no-std", "--standalone"][..], "--language c: found --standalone, --no-std, which are for Rust alone"),
        (&["--rename", "slyde=S"], "rename: found \"slyde\", expected the name of a joint or of a link"),
        (&["--level", "double_double"], "level: found double_double, expected for target \"c\": f64, f32 or f32_f64"),
        (&["--prefix", "1st"], "prefix: found \"1st\""),
    ] {
        let made = run(&[&words[..], more].concat());
        assert!(made.status != 0 && made.err.contains(told), "{}", made.err);
    }
    assert!(run(&["generate", "cart_pole", "--prefix", "my"]).err.contains("--prefix my: expected --language c beside it"));
}

#[test]
fn limbs_are_each_for_itself_where_asked_for() {
    let words = ["generate", "quadruped", "--functions", "inverse_dynamics"];
    let (together, apart) = (run(&words), run(&[&words[..], &["--no-limbs"]].concat()));
    assert_eq!((together.status, apart.status), (0, 0), "{}", apart.err);
    // Numbers of four legs, one a lane; sines of four angles at once are something else.
    let lanes = |code: &str| code.contains("fmadd(lanes([");
    assert!(lanes(&together.out) && !lanes(&apart.out), "{}", apart.out);
    let robot = articulated_models::robot("quadruped").unwrap();
    let mut request = Request::new("quadruped.urdf", robot.urdf);
    (request.options.robot.base, request.options.limbs) = (robot.base, false);
    request.options.functions = vec!["inverse_dynamics".into()];
    assert!(apart.out == generate(&request).unwrap().source);
}

#[test]
fn a_scene_gives_what_it_gives_in_a_build_script() {
    let scene = "../tests/ui/scenes/three.toml";
    let build = articulated_codegen::Build::scene(scene);
    let made = run(&["generate", scene, "--runtime", "::articulated"]);
    assert_eq!(made.status, 0, "{}", made.err);
    assert!(made.out == build.generate().unwrap().source);
    let made =
        run(&["generate", scene, "--runtime", "::articulated", "--functions", "gravity_torque", "--gravity", "0,0,-1.62", "--floating"]);
    let other = build.functions(["gravity_torque"]).gravity([0.0, 0.0, -1.62]).floating();
    assert!(made.out == other.generate().unwrap().source);
    let wrong = run(&["generate", "../tests/ui/scenes/wrong.toml"]);
    assert_eq!(wrong.status, 1);
    assert!(wrong.err.contains("wrong.toml:2: gravty:") && wrong.err.contains("wrong.toml:5: effects.damping.elbow:"), "{}", wrong.err);
}

#[test]
fn functions_of_many_states_are_those_of_the_types_asked_for() {
    let of = |types: &str| run(&["generate", "cart_pole", "--functions", "gravity_torque", "--batch", types]);
    for (types, [double, single]) in [("f64", [true, false]), ("f32", [false, true]), ("f64,f32", [true, true])] {
        let made = of(types);
        assert_eq!(made.status, 0, "{}", made.err);
        assert_eq!(["pub mod batch_f64", "pub mod batch_f32"].map(|m| made.out.contains(m)), [double, single], "{types}");
        assert!(made.out.contains("pub fn gravity_torque_blocks("));
    }
    let wrong = of("f16");
    assert!(wrong.status == 2 && wrong.err.contains("expected f64 or f32"), "{}", wrong.err);
}

#[test]
fn functions_may_be_put_together_and_have_constants() {
    let words = [
        "generate",
        "cart_pole",
        "--functions",
        "still = inverse_dynamics(v = 0, a = [0, 0]), both = gravity_torque + jacobians_body, regressors",
    ];
    let made = run(&[&words[..], &["--frames", "pole_rod"]].concat());
    assert_eq!(made.status, 0, "{}", made.err);
    for part in ["pub fn still(q: &[f64; NQ]) -> [f64; NV]", "pub fn both(", "pub struct Both", "pub fn kinetic_energy_regressor("] {
        assert!(made.out.contains(part), "{part}");
    }
    let wrong = run(&["generate", "cart_pole", "--functions", "gravity_torque + placements"]);
    assert!(wrong.status == 2 && wrong.err.contains("need a name"), "{}", wrong.err);
}

#[test]
fn warnings_are_on_the_other_stream_and_errors_are_status_1() {
    let odd = articulated_models::robot("gripper_arm").unwrap().urdf.replacen("<robot ", "<robot unit=\"mm\" ", 1);
    let arm = File::new("arm.urdf", odd.as_bytes());
    let made = run(&["generate", arm.name(), "--standalone"]);
    assert!(made.err.lines().all(|l| l.contains("warning")) && !made.err.is_empty(), "{}", made.err);
    assert_eq!(run(&["generate", "gripper_arm"]).err, "");
    let file = File::new("bad.urdf", b"<robot name='r'/>");
    let refused = run(&["generate", file.name()]);
    assert_eq!((refused.status, refused.out.as_str()), (1, ""));
    assert!(refused.lines_with("error") >= 1);
    assert_eq!(run(&["generate", "cart_pole", "-o", "/no/such/folder/x.rs"]).status, 1);
}

#[test]
fn a_robot_is_not_replaced_by_its_code() {
    let urdf = articulated_models::robot("cart_pole").unwrap().urdf;
    let file = File::new("cart_pole.urdf", urdf.as_bytes());
    let again = format!("{}/../{}/cart_pole.urdf", file.path.parent().unwrap().display(), folder_of(&file));
    let scene = File::new("cart.toml", format!("urdf = {:?}\n", file.name()).as_bytes());
    let onto = format!("{}@pole_rod:other_", file.name());
    let cases: [&[&str]; 5] = [
        &[file.name(), "-o", file.name()],
        &[file.name(), "-o", &again],
        &["cart_pole", "--append", &onto, "-o", file.name()],
        &[scene.name(), "-o", scene.name()],
        &[scene.name(), "-o", file.name()],
    ];
    for words in cases {
        let refused = run(&[&["generate"], words].concat());
        assert!(refused.status == 2 && refused.err.contains("found a file that the robot is read from"), "{words:?}: {}", refused.err);
    }
    let refused = run(&["compare", file.name(), "--functions", "gravity_torque", "--chart", file.name()]);
    assert!(refused.status == 2 && refused.err.contains("--chart") && refused.err.contains("read from"), "{}", refused.err);
    assert_eq!(std::fs::read_to_string(&file.path).unwrap(), urdf);
    assert!(std::fs::read_to_string(&scene.path).unwrap().starts_with("urdf"));
}

/// The last part of the path of the file's folder.
fn folder_of(file: &File) -> String {
    file.path.parent().and_then(|folder| folder.file_name()).unwrap().to_string_lossy().into_owned()
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_not_success() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status = super::articulated(&["generate", "cart_pole"]).stdout(full).stderr(std::process::Stdio::null()).status().unwrap();
    assert_eq!(status.code(), Some(1));
}

#[test]
fn names_that_are_one_in_rust_can_be_told_apart() {
    let urdf = r#"<robot name="r"><link name="base"/><link name="a-b"/><link name="a_b"/>
        <joint name="j" type="fixed"><parent link="base"/><child link="a-b"/></joint>
        <joint name="k" type="fixed"><parent link="base"/><child link="a_b"/></joint></robot>"#;
    let file = File::new("two.urdf", urdf.as_bytes());
    let words = ["generate", file.name(), "--functions", "placements"];
    let refused = run(&words);
    assert!(refused.status == 1 && refused.err.contains("`A_B`") && refused.err.contains("rename"), "{}", refused.err);
    let made = run(&[&words[..], &["--rename", "a-b=A_MINUS_B"]].concat());
    assert_eq!(made.status, 0, "{}", made.err);
    assert!(made.out.contains("pub const A_MINUS_B: usize = 1;") && made.out.contains("pub const A_B: usize = 2;"));
    assert_eq!(run(&[&words[..], &["--rename", "a-b"]].concat()).status, 2);
}

#[test]
fn what_is_asked_for_twice_is_refused() {
    let cases: [(&[&str], &str); 4] = [
        (&["generate", "--batch", "f64,f64"], "--batch: found a type that is there twice, f64, expected each once"),
        (&["compare", "--batch", "f32", "--batch", "f64,f32"], "--batch: found a type that is there twice, f32, expected each once"),
        (
            &["generate", "--rename", "cart=A", "--rename", "cart=B"],
            "--rename cart=B: found a name that is renamed twice, \"cart\", expected each once",
        ),
        (&["generate", "--parameters", "payload(cart),payload(cart)"], "parameters: `payload(cart)`: is there twice, expected once"),
    ];
    for (words, told) in cases {
        let refused = run(&[&words[..1], &["cart_pole"], &words[1..]].concat());
        assert!(refused.status != 0 && refused.err.contains(told), "{words:?}: {}", refused.err);
    }
}

#[test]
fn what_is_said_stands_in_place_of_what_the_scene_says() {
    let scene = b"robot = \"cart_pole\"\nlevel = \"f32\"\nrename = { cart = \"SCENE\", pole_rod = \"ROD\" }\n";
    let scene = File::new("cart.toml", scene);
    let of = |words: &[&str]| {
        let made = run(&[&["generate", scene.name(), "--functions", "placements"], words].concat());
        assert_eq!(made.status, 0, "{}", made.err);
        made.out
    };
    let (own, other) = (of(&[]), of(&["--level", "f64", "--rename", "cart=CAR"]));
    assert!(own.contains("-> [[f32; 12]; FRAMES]") && own.contains("pub const SCENE: usize"), "{own}");
    assert!(other.contains("-> [[f64; 12]; FRAMES]") && other.contains("pub const CAR: usize"), "{other}");
    assert!(other.contains("pub const ROD: usize") && !other.contains("SCENE"), "{other}");
}

/// Names with two `_` side by side come from names that end in one; names in lower case are the
/// requested ones.
#[test]
fn code_with_odd_names_has_no_warnings() {
    let functions =
        "tau_ = gravity_torque, a__b = forward_dynamics(v = 0), d_ = inverse_dynamics_derivatives, both_ = mass_matrix + placements";
    for (robot, rename) in [("quadruped", "trunk=body"), ("panda_like", "flange=tcp")] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("robot.rs");
        let words = ["generate", robot, "--functions", functions, "--batch", "f64", "--rename", rename, "-o", file.to_str().unwrap()];
        let made = run(&words);
        assert_eq!(made.status, 0, "{}", made.err);
        let mut rustc = std::process::Command::new("rustc");
        rustc.args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "-D", "warnings"]);
        let ended = rustc.arg("--out-dir").arg(folder.path()).arg(&file).output().unwrap();
        assert!(ended.status.success(), "{robot}: {}", String::from_utf8_lossy(&ended.stderr));
    }
}

/// Contacts that a caller finds are an argument, with the names of their geoms.
#[test]
fn contacts_of_meshes_may_be_given() {
    let text = include_str!("../../../tests/mjcf/models/given.xml");
    let file = File::new("given.xml", text.as_bytes());
    let name = "constrained_step_implicit_damping_with_contacts";
    let words = ["generate", file.name(), "--effects", "file", "--functions", name, "--leave-out", "contact"];
    let ended = run(&[&words[..], &["--given-contact", "floor,gem,3", "--given-contact", "egg,step"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    for line in [
        "pub const GIVEN: usize = 4;",
        "[\"floor\", \"gem\"], [\"egg\", \"step\"]]",
        "Given by the caller: contacts of \"floor\" and \"gem\" in 3 places.",
    ] {
        assert!(ended.out.contains(line), "{line}");
    }
    for (given, expected) in [
        ("floor,gam", "given_contacts[0]: found no pair of the geoms \"floor\" and \"gam\" that may touch"),
        ("floor,gem,0", "given_contacts[0]: found 0 places, expected 1 to 64 places"),
        ("floor", "expected two names of geoms"),
    ] {
        let ended = run(&[&words[..], &["--given-contact", given]].concat());
        assert!(ended.status != 0 && ended.err.contains(expected), "{given}: {}", ended.err);
    }
    assert!(run(&words).err.contains("no contact that a caller gives"), "{}", run(&words).err);
    // Without the option the error names both ways on.
    let refused = run(&[&words[..6], &["--given-contact", "floor,gem"]].concat());
    assert!(refused.err.contains("--leave-out contact") && refused.err.contains("--given-contact"), "{}", refused.err);
}
