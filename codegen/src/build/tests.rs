//! Build scripts: messages, errors and skipped work.

use super::*;

const ARM: &str = r#"<robot name="arm"><link name="base"/><link name="tip"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="hinge" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 2"/><limit effort="1" velocity="1"/></joint></robot>"#;

/// A folder of its own among temporary ones, with a robot in it.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("articulated-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("arm.urdf"), ARM).unwrap();
    folder
}

#[test]
fn cargo_is_told_each_error_on_a_line_and_once_that_it_is_one() {
    let folder = folder("errors");
    let path = folder.join("heavy.urdf");
    fs::write(&path, ARM.replace("mass value=\"1\"", "mass value=\"-1\"").replace("effort=\"1\"", "effort=\"much\"")).unwrap();
    let told = for_cargo(&Build::new(&path).try_write("heavy").unwrap_err());
    let told: Vec<(&str, &str)> = told.lines().filter_map(|line| line.split_once('=')).collect();
    let expected = [
        ("error", "a negative mass, -1 kg"),
        ("error", "effort: found \"much\""),
        ("warning", "axis: found (0.0 0.0 2.0) of length 2.0000"),
        ("warning", "limit: found no bounds"),
    ];
    assert_eq!(told.len(), expected.len(), "{told:?}");
    for ((kind, line), (of, text)) in told.iter().zip(expected) {
        assert!(kind.ends_with(of) && line.contains(text) && !line.contains(&format!("{of}: ")), "{kind} {line}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_second_robot_does_not_take_the_place_of_a_first() {
    let folder = folder("twice");
    let build = Build::new(folder.join("arm.urdf")).functions(["gravity_torque"]);
    names_written().insert(std::env::var_os("OUT_DIR").map(PathBuf::from).unwrap_or_default().join("taken"));
    let told = build.try_write("taken").unwrap_err().to_string();
    assert!(told.contains("taken: ") && told.contains("written already"), "{told}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_build_script_writes_c_with_its_name_as_the_prefix() {
    let folder = folder("c");
    let build = Build::new(folder.join("arm.urdf")).functions(["gravity_torque"]);
    let written = build.clone().language(Target::C(crate::COptions::default())).write_in(&folder, "our_arm").unwrap();
    assert_eq!(written.path, folder.join("our_arm.h"));
    assert!(fs::read_to_string(folder.join("our_arm.c")).unwrap().contains("void our_arm_gravity_torque(const double q[OUR_ARM_NQ]"));
    let header = crate::COptions { header_only: true, prefix: Some("a".into()), ..crate::COptions::default() };
    build.language(Target::C(header)).write_in(&folder, "our_arm").unwrap();
    assert!(folder.join("a.h").exists() && !folder.join("a.c").exists());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn each_choice_arrives_in_the_request() {
    let folder = folder("choices");
    let hand = folder.join("hand.urdf");
    fs::write(&hand, ARM.replace("mass value=\"1\"", "mass value=\"3\"")).unwrap();
    let build = Build::new(folder.join("arm.urdf"));
    let of = |build: Build| build.request().unwrap().options;
    let plain = of(build.clone());
    let mut expected = plain.clone();
    assert_eq!(plain.rust().runtime.as_deref(), Some("::articulated"));
    (expected.rust_mut().runtime, expected.limbs, expected.rust_mut().forbid_unsafe, expected.rust_mut().no_std) =
        (None, false, true, true);
    expected.max_code_size = 200;
    assert_eq!(of(build.clone().standalone().limbs(false).forbid_unsafe().no_std().max_code_size(200)), expected);
    let mut expected = plain.clone();
    (expected.robot.base, expected.robot.snap_angles, expected.robot.allow_unphysical_inertia) = (Base::Fixed, Some(1e-6), true);
    (expected.robot.first_of_duplicates, expected.robot.file_coupling) = (true, true);
    expected.robot.leave_out = [LeaveOut::Flex, LeaveOut::Plugin].into();
    expected.robot.allow_unknown_version = true;
    expected.rename = vec![("a-b".to_owned(), "A_MINUS_B".to_owned()).into()];
    let all = build
        .clone()
        .floating()
        .fixed()
        .snap_angles(1e-6)
        .allow_unphysical_inertia()
        .first_of_duplicates()
        .leave_out([LeaveOut::Plugin])
        .leave_out([LeaveOut::Flex])
        .allow_unknown_version()
        .file_coupling()
        .rename("a-b", "A_MINUS_B");
    assert_eq!(of(all.clone()), expected);
    expected.rename = vec![("c".to_owned(), "C".to_owned()).into(), ("a-b".to_owned(), "D".to_owned()).into()];
    assert_eq!(of(all.rename("c", "C").rename("a-b", "D")), expected);
    let both = of(build.clone().append(&hand, "tip", "left_", Origin::default()));
    assert_eq!(both.robot.append[0].document, fs::read(&hand).unwrap());
    assert_eq!((both.robot.append[0].at.as_str(), both.robot.append[0].prefix.as_str()), ("tip", "left_"));
    assert!(build.append(folder.join("none.urdf"), "tip", "left_", Origin::default()).request().is_err());
    fs::remove_dir_all(folder).unwrap();
}

const CART: &str = r#"<mujoco model="cart"><worldbody><body name="cart"><joint name="x" type="slide" damping="0.3" armature="0.1"/>
    <geom type="sphere" size="0.1"/></body></worldbody><actuator><motor name="push" joint="x"/></actuator></mujoco>"#;

/// A step with the actuators of a file warns of its smooth forces that do not act.
#[test]
fn forces_of_the_file_beside_its_actuators_act_or_are_a_warning() {
    let folder = folder("forces");
    fs::write(folder.join("cart.xml"), CART).unwrap();
    let build = Build::new(folder.join("cart.xml")).functions(["actuated_step_rk4"]);
    let generated = |build: &Build| {
        let generated = build.generate().unwrap();
        let warnings: Vec<String> = generated.warnings.iter().map(ToString::to_string).filter(|line| line.contains("effects")).collect();
        (generated.model.bodies().iter().map(|body| body.effects.joint.len()).sum::<usize>(), warnings)
    };
    let (effects, warnings) = generated(&build);
    assert!(effects == 0 && warnings.len() == 1 && warnings[0].contains("found armature, damping in the file"), "{warnings:?}");
    assert_eq!(generated(&build.clone().file_effects()), (2, vec![]));
    let of_scene = |effects: &str| {
        let text = format!("file = \"cart.xml\"\nfunctions = [\"actuated_step_rk4\"]\neffects = {effects}");
        fs::write(folder.join("cart.toml"), text).unwrap();
        generated(&Build::scene(folder.join("cart.toml")))
    };
    assert_eq!(of_scene("\"file\""), (2, vec![]));
    assert_eq!(of_scene("{ damping = 0.5, armature = \"off\" }"), (1, vec![]));
    let (effects, warnings) = of_scene("{ damping = 0.5 }");
    assert!(effects == 1 && warnings.len() == 1 && warnings[0].contains("found armature in the file"), "{warnings:?}");
    // Without controls, a scene chooses what acts.
    assert_eq!(generated(&Build::new(folder.join("cart.xml")).functions(["forward_dynamics"])).1, [""; 0]);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn each_name_is_a_file_of_its_own() {
    let folder = folder("names");
    let build = Build::new(folder.join("arm.urdf")).functions(["gravity_torque"]);
    for name in ["arm", "arm.v2", "arm.v3"] {
        let written = build.write_in(&folder, name).unwrap();
        assert!(written.generated, "{name}");
        assert_eq!(written.path, folder.join(format!("{name}.rs")));
        assert!(!build.write_in(&folder, name).unwrap().generated, "{name}");
    }
    for name in ["", "..", "../arm", "robots/arm", "/"] {
        let error = build.write_in(&folder, name).unwrap_err().to_string();
        assert!(error.contains("expected one"), "{name}: {error}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_scene_without_a_robot_asks_for_one() {
    let folder = folder("no-robot");
    let scene = folder.join("still.toml");
    fs::write(&scene, "gravity = [0, 0, 0]").unwrap();
    let build = Build::scene(&scene);
    let error = build.request().unwrap_err().to_string();
    assert!(error.contains("Build::urdf"), "{error}");
    assert_eq!(build.urdf(folder.join("arm.urdf")).request().unwrap().options.robot.gravity, Some([0.0; 3]));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_is_said_beside_a_scene_stands_in_its_place() {
    let folder = folder("beside");
    let scene = folder.join("named.toml");
    fs::write(&scene, "urdf = 'arm.urdf'\nfunctions = ['gravity_torque']\nrename = { tip = 'SCENE', base = 'GROUND' }").unwrap();
    let build = Build::scene(&scene).rename("tip", "TCP").functions(["mass_matrix"]);
    let source = build.generate().unwrap().source;
    for (part, there) in [("TCP", true), ("GROUND", true), ("SCENE", false), ("fn mass_matrix(", true), ("fn gravity_torque(", false)] {
        assert_eq!(source.contains(part), there, "{part}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn types_of_a_batch_may_be_their_names() {
    let build = Build::new("arm.urdf");
    let types = |build: &Build| build.request.options.batch.clone();
    let named = build.clone().batch(["f64", "f32"]);
    assert_eq!(types(&named), types(&build.clone().batch([crate::Real::F64, crate::Real::F32])));
    let folder = folder("batch");
    let wrong = Build::new(folder.join("arm.urdf")).batch(["f46", "f32"]);
    assert_eq!(wrong.generate().unwrap_err().to_string(), "batch: found \"f46\", expected \"f64\" or \"f32\"");
    assert!(wrong.batch(["f32"]).generate().is_ok());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_missing_file_is_told_with_the_nearest_and_with_the_other_mistakes() {
    let folder = folder("missing");
    let build = Build::new(folder.join("amr.urdf")).functions(["inverse_dynamic", "no_such"]).batch(["f16"]);
    let told = build.generate().unwrap_err().to_string();
    for part in ["did you mean \"arm.urdf\"?", "unknown function `inverse_dynamic`", "unknown function `no_such`", "batch: found \"f16\""] {
        assert_eq!(told.lines().filter(|line| line.contains(part)).count(), 1, "{part} in {told}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_unchanged_request_generates_nothing_and_warns_all_the_same() {
    let folder = folder("cache");
    let build = Build::new(folder.join("arm.urdf")).functions(["gravity_torque"]);
    let again = |build: &Build| build.write_in(&folder, "arm").unwrap();
    let first = again(&build);
    assert!(first.generated && !first.warnings.is_empty());
    let date = || fs::metadata(folder.join("arm.rs")).unwrap().modified().unwrap();
    let written = date();
    assert_eq!(again(&build), Written { generated: false, ..first.clone() });
    assert_eq!(date(), written);
    // Another request, a file that somebody wrote to, a file that is gone, a robot that changed.
    assert!(again(&build.clone().gravity([0.0; 3])).generated);
    assert!(again(&build).generated);
    fs::write(folder.join("arm.rs"), "").unwrap();
    assert!(again(&build).generated);
    fs::remove_file(folder.join("arm.rs")).unwrap();
    assert!(again(&build).generated && !again(&build).generated);
    fs::write(folder.join("arm.urdf"), ARM.replace("mass value=\"1\"", "mass value=\"2\"")).unwrap();
    assert!(again(&build).generated && !again(&build).generated);
    assert_eq!(fs::read_to_string(&first.path).unwrap(), build.generate().unwrap().source);
    // A failed request keeps the record of the existing file, and is not recorded itself.
    assert!(build.clone().functions(["no_function"]).write_in(&folder, "arm").is_err());
    assert!(!again(&build).generated);
    fs::remove_dir_all(folder).unwrap();
}

/// Keys, names and files of a scene are wrong in one run, with the calls.
#[test]
fn mistakes_of_a_scene_and_names_that_its_robot_does_not_have_come_together() {
    let folder = folder("mistakes");
    let told = |robot: &str| {
        let text = format!("file = '{robot}'\nsumary = 'an arm'\nframes = ['tipp']\neffects = {{ damping = {{ hinje = 1 }} }}");
        fs::write(folder.join("arm.toml"), text).unwrap();
        Build::scene(folder.join("arm.toml")).functions(["mass_matrx"]).generate().unwrap_err()
    };
    let fields = |told: &Diagnostics| told.errors.iter().map(|error| (error.line(), error.field.clone())).collect::<Vec<_>>();
    let is = |line: u32, field: &str| (Some(line), field.to_owned());
    let all = told("arm.urdf");
    let of_scene = [is(2, "sumary"), is(3, "frames"), is(4, "effects.damping.hinje")];
    assert!(of_scene.iter().all(|one| fields(&all).contains(one)) && all.errors.len() == 4, "{all}");
    assert!(all.to_string().contains("did you mean `mass_matrix`?"), "{all}");
    assert!(all.errors.iter().filter(|error| error.line().is_some()).all(|error| error.file().ends_with("arm.toml")), "{all}");
    let without = told("amr.urdf");
    assert!([is(1, "urdf"), is(2, "sumary")].iter().all(|one| fields(&without).contains(one)) && without.errors.len() == 3, "{without}");
    assert!(without.to_string().contains("did you mean \"arm.urdf\"?") && without.to_string().contains("mass_matrix"), "{without}");
    fs::remove_dir_all(folder).unwrap();
}
