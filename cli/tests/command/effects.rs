use crate::{File, run};

#[test]
fn every_effect_is_on_or_off_and_what_each_adds_is_counted() {
    let ended = run(&["effects", "arm", "--format", "json"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let report = ended.json();
    let names =
        |key: &str| -> Vec<String> { report[key].as_array().unwrap().iter().map(|e| e["effect"].as_str().unwrap().to_owned()).collect() };
    let (on, off) = (names("on"), names("off"));
    for effect in articulated_core::effect::effects() {
        let name = effect.name.to_owned();
        assert!(on.contains(&name) != off.contains(&name), "{name}: {report}");
    }
    assert!(report["on"].as_array().unwrap().iter().all(|e| e["line"].as_u64().is_some()));
    assert!(!report["ignored"].as_array().unwrap().is_empty());

    let costs = report["costs"].as_array().unwrap();
    assert_eq!(costs.iter().map(|c| c["function"].as_str().unwrap()).collect::<Vec<_>>(), ["inverse_dynamics", "forward_dynamics"]);
    let inverse = costs[0]["adds"].as_array().unwrap();
    let of = |what: &str| inverse.iter().find(|a| a["what"] == what).unwrap_or_else(|| panic!("{what}: {report}"));
    // One addition per joint, and the places are those that the scene requests.
    assert_eq!((of("damping")["places"].as_u64(), of("damping")["operations"]["additions"].as_i64()), (Some(7), Some(7)));
    // The first joint's acceleration already has a constant factor.
    assert_eq!(of("armature")["operations"]["instructions"], 6);
    assert!(of("gravity")["operations"]["additions"].as_i64().unwrap() > 0);
    // The same operations; the number of fused additions depends on the splitting of sums.
    for kind in ["multiplications", "additions"] {
        let each = inverse.iter().filter(|a| a["what"] != "gravity" && a["what"] != "all together");
        let sum: i64 = each.map(|a| a["operations"][kind].as_i64().unwrap()).sum();
        let together = of("all together")["operations"][kind].as_i64().unwrap();
        assert!(together > 0 && together <= sum, "{kind}: {together} {sum}");
    }
}

#[test]
fn people_are_told_in_groups() {
    let out = run(&["effects", "arm", "--functions", "mass_matrix"]).out;
    for part in [
        "\non:\n",
        "\noff:\n",
        "in the robot's file, and not used:",
        "armature: 7 of 7 joints, from the scene",
        "joint_5, joint_6, joint_7: inertia 0.2 kg·m²",
        "mass_matrix: what",
        "without effects",
    ] {
        assert!(out.contains(part), "{part}: {out}");
    }
    assert!(!out.contains("inverse_dynamics:"));
}

#[test]
fn times_are_told_where_they_are_asked_for() {
    let report =
        run(&["effects", "cart_pole", "--time", "--functions", "forward_dynamics", "--repetitions", "5", "--format", "json"]).json();
    let cost = &report["costs"][0];
    assert!(cost["without"]["ns"]["median"].as_f64().unwrap() > 0.0, "{report}");
    assert!(cost["adds"].as_array().unwrap().iter().all(|a| a["ns"]["median"].as_f64().is_some()), "{report}");
    assert!(report["compiler"].as_str().is_some());
}

#[test]
fn a_function_that_only_effects_define_is_told_with_all_of_them() {
    let urdf = "<robot name='r'><link name='base'/><link name='body'/><joint name='j' type='continuous'><parent link='base'/>\
                <child link='body'/><axis xyz='0 0 1'/></joint></robot>";
    let urdf = File::new("r.urdf", urdf.as_bytes());
    let scene = |effects: &str| File::new("s.toml", format!("urdf = {:?}\n[effects]\n{effects}\n", urdf.name()).as_bytes());
    let rotor = scene("armature = 0.1\ndamping = 0.2");
    let names = "forward_dynamics,inverse_dynamics";
    let report = run(&["effects", rotor.name(), "--functions", names, "--format", "json"]).json();
    let [forward, inverse] = [0, 1].map(|i| &report["costs"][i]);
    assert_eq!((&forward["function"], &inverse["function"]), (&"forward_dynamics".into(), &"inverse_dynamics".into()));
    assert!(forward["without"].is_null() && forward["adds"].as_array().unwrap().is_empty(), "{report}");
    assert_eq!(forward["only_with"]["why"], "no inertia of its own for joint j");
    assert!(forward["only_with"]["cost"]["operations"]["instructions"].as_i64().unwrap() > 0, "{report}");
    assert!(inverse["only_with"].is_null() && inverse["without"].is_object() && inverse["adds"].as_array().unwrap().len() == 4, "{report}");
    let ended = run(&["effects", rotor.name(), "--functions", "forward_dynamics"]);
    let said = "forward_dynamics: without the effects it is not defined (no inertia of its own for joint j)";
    assert!(ended.status == 0 && ended.out.contains(said) && ended.out.contains("with all effects"), "{}{}", ended.out, ended.err);
    assert!(!ended.out.contains("without effects"), "{}", ended.out);
    let none = run(&["effects", scene("damping = 0.2").name()]);
    assert!(none.status == 1 && none.err.contains("forward_dynamics: found no inertia of its own for joint j, expected"), "{}", none.err);
}

/// One number applies to the slides and the turns of a planar or a free joint: its unit is not that
/// of an angle alone.
#[test]
fn numbers_have_the_units_of_what_their_joint_does() {
    let joint = |name: &str, kind: &str, parent: &str, child: &str| {
        format!(
            "<link name='{child}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
             <joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><axis xyz='0 0 1'/>\
             <limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
        )
    };
    let kinds = [("rail", "prismatic"), ("table", "planar"), ("hinge", "revolute"), ("air", "floating")];
    let joints: Vec<String> =
        kinds.iter().enumerate().map(|(k, (name, kind))| joint(name, kind, &format!("l{k}"), &format!("l{}", k + 1))).collect();
    let urdf = format!("<robot name='r'><link name='l0'/>{}</robot>", joints.concat());
    let urdf = File::new("r.urdf", urdf.as_bytes());
    let scene = File::new(
        "s.toml",
        format!("urdf = {:?}\n[effects]\nspring = {{ \"*\" = {{ stiffness = 2.0 }} }}\ndamping = 0.1\n", urdf.name()).as_bytes(),
    );
    let report = run(&["effects", scene.name(), "--functions", "effect_forces", "--format", "json"]).json();
    let units = |effect: &str, joint: &str| -> Vec<String> {
        let is = |e: &&serde_json::Value| e["on"] == joint && e["effect"] == effect;
        let on = report["on"].as_array().unwrap().iter().find(is).unwrap_or_else(|| panic!("{joint}: {report}"));
        on["numbers"].as_array().unwrap().iter().map(|n| n["unit"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(units("spring", "rail"), ["N/m", "m"]);
    assert_eq!(units("spring", "hinge"), ["N·m/rad", "rad"]);
    assert_eq!(units("spring", "table"), ["N·m/rad|N/m", "rad|m"]);
    assert_eq!(units("damping", "air"), ["N·m·s/rad|N·s/m"]);
}
