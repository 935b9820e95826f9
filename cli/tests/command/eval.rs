use super::{File, articulated, end, run, run_with};

const STATES: &str = r#"{"states": [{"q": [0.3], "v": [0.7], "a": {"swing": -1}}, {"q": {"swing": 2}, "v": [0], "a": [0]}]}"#;

#[test]
fn the_pendulum_is_its_closed_form_in_both_ways() {
    let file = File::new("states.json", STATES.as_bytes());
    let words = ["eval", "simple_pendulum", "--function", "inverse_dynamics,gravity_torque", "--states", file.name(), "--format", "json"];
    let ended = run(&words);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    let inverse = &json["functions"][0];
    let tau = |state: usize, side: &str| inverse["states"][state][side]["swing"].as_f64().unwrap();
    for (state, q, a) in [(0, 0.3_f64, -1.0), (1, 2.0, 0.0)] {
        // m = 1 kg, l = 1 m, inertia 0.001 kg·m²: see the file
        let expected = 9.81 * q.sin() + a * inertia();
        assert!((tau(state, "generic") - expected).abs() < 1e-12, "{} {expected}", tau(state, "generic"));
        assert!((tau(state, "generated") - expected).abs() < 1e-12);
    }
    assert!(inverse["largest_difference"]["in_units_of_roundoff"].as_f64().unwrap() < 4.0);
    assert_eq!(json["functions"][1]["function"], "gravity_torque");
}

/// A frame that joints can move along y or turn about x only by way of z: zeros that generated code
/// computes in other axes have rounding errors.
#[test]
fn a_result_of_zeros_may_be_off_by_a_rounding_of_its_neighbours() {
    let body =
        "<inertial><origin xyz='0.1 0 0'/><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.02' iyz='0' izz='0.02'/></inertial>";
    let joint = |k: usize, place: &str, axis: &str| {
        format!(
            "<joint name='j{k}' type='continuous'><origin xyz='{place}'/><parent link='l{k}'/><child link='l{}'/><axis xyz='{axis}'/></joint>",
            k + 1
        )
    };
    let joints = joint(0, "0 0 0", "0 1 0") + &joint(1, "0.3 0.1 0.2", "0 0 1");
    let urdf = format!("<robot name='two'><link name='l0'/><link name='l1'>{body}</link><link name='l2'>{body}</link>{joints}</robot>");
    let file = File::new("two.urdf", urdf.as_bytes());
    let words =
        ["eval", file.name(), "--frames", "l2", "--function", "operational_space_inertia_inverse", "--states", "-", "--format", "json"];
    let ended = run_with(&words, br#"[{"q": [0.3, 0.7]}, {"q": [-1.2, 2.0]}]"#);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let difference = &ended.json()["functions"][0]["largest_difference"];
    assert!(difference["in_units_of_roundoff"].as_f64().unwrap() < 16.0, "{difference}");
}

/// A lever that vanishes at q = 0, in frames turned by a seventh of a turn: zero except for
/// rounding.
#[test]
fn where_levers_vanish_frames_that_were_turned_may_round() {
    let body = |at: &str| {
        format!(
            "<inertial><origin xyz='{at}'/><mass value='3'/><inertia ixx='0.1' ixy='0.02' ixz='0' iyy='0.2' iyz='0' izz='0.25'/></inertial>"
        )
    };
    let link = |name: &str, at: &str| format!("<link name='{name}'>{}</link>", body(at));
    let joint = |k: usize, place: &str, axis: &str| {
        format!(
            "<joint name='j{k}' type='continuous'><origin xyz='{place}'/><parent link='l{k}'/><child link='l{}'/><axis xyz='{axis}'/></joint>",
            k + 1
        )
    };
    let joints = joint(0, "0.1 0 0.2", "0 0 1") + &joint(1, "0.3 0 0", "0.6 0.35 0.1");
    let urdf = format!("<robot name='lever'>{}{}{}{joints}</robot>", link("l0", "0 0 0"), link("l1", "0.2 0 0"), link("l2", "0 0 0"));
    let file = File::new("lever.urdf", urdf.as_bytes());
    let functions = "mass_matrix,inverse_dynamics_derivatives,coriolis_matrix,jacobians_body";
    let zeros = br#"[{"q": [0, 0, 0, 0, 0, 0, 1, 0, 0], "v": [0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3], "a": [0, 0, 0, 0, 0, 0, 0, 0]}]"#;
    let ended = run_with(&["eval", file.name(), "--floating", "--function", functions, "--states", "-"], zeros);
    assert_eq!(ended.status, 0, "{}", ended.err);
}

/// About the joint's axis: the torque for a unit of acceleration at rest.
fn inertia() -> f64 {
    let torque = |a: f64| {
        let states = format!(r#"[{{"q": [0], "v": [0], "a": [{a}]}}]"#);
        let words = ["eval", "simple_pendulum", "--function", "inverse_dynamics", "--states", "-", "--generic", "--format", "json"];
        run_with(&words, states.as_bytes()).json()["functions"][0]["states"][0]["generic"]["swing"].as_f64().unwrap()
    };
    torque(1.0) - torque(0.0)
}

#[test]
fn a_table_and_a_tree_of_states_give_the_same() {
    let functions = ["--function", "bias_forces,placements", "--generic", "--format", "json"];
    let json = br#"[{"q": {"cart": 0.1, "pole": 0.2}, "v": {"cart": 0.3, "pole": 0.4}}]"#;
    let names = joint_names("cart_pole");
    let json = String::from_utf8(json.to_vec()).unwrap().replace("cart", &names[0]).replace("pole", &names[1]);
    let csv = format!("v.{1},v.{0},q.{0},q.{1}\n0.4,0.3,0.1,0.2\n", names[0], names[1]);
    let result = |text: &str| run_with(&[&["eval", "cart_pole", "--states", "-"], &functions[..]].concat(), text.as_bytes()).json();
    assert_eq!(result(&json)["functions"], result(&csv)["functions"]);
    assert!(result(&json)["functions"][1]["states"][0]["generic"].as_object().unwrap().len() >= 3);
}

fn joint_names(robot: &str) -> Vec<String> {
    let json = run(&["check", robot, "--format", "json"]).json();
    json["joints"].as_array().unwrap().iter().map(|j| j["joint"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn mistakes_name_the_state_and_the_joint() {
    let cases = [
        (r#"[{"q": [0.1]}]"#, "states[0]: v: found nothing"),
        (r#"[{"q": [0.1], "v": [1], "a": [1]}, {"q": [0.1, 0.2], "v": [1], "a": [1]}]"#, "states[1]: q: found 2 numbers, expected 1"),
        (r#"[{"q": {"swimg": 1}, "v": [1], "a": [1]}]"#, "did you mean \"swing\"?"),
        (r#"[{"q": {"base": 1}, "v": [1], "a": [1]}]"#, "not a coordinate of this robot; there are swing"),
        ("q.swing,v.swing,a.swing\n0,inf,0\n", "line 2: v: joint \"swing\": found inf"),
        ("", "no state"),
    ];
    for (text, message) in cases {
        let ended = run_with(&["eval", "simple_pendulum", "--function", "inverse_dynamics", "--states", "-"], text.as_bytes());
        assert_eq!(ended.status, 1);
        assert!(ended.err.contains(message) && ended.err.lines().all(|l| l.starts_with("error")), "{}", ended.err);
    }
    assert_eq!(run(&["eval", "simple_pendulum", "--function", "inverse_dynamics", "--states", "/no/such/file"]).status, 1);
}

/// Whether the reader of states or the functions find that something is missing.
#[test]
fn of_many_mistakes_the_first_hundred_are_told_and_how_many_more_there_are() {
    for (state, mistake) in [(r#"{"q": [0.1]}"#, "v: found nothing"), (r#"{"q": [0.1], "v": [1, 2]}"#, "v: found 2 numbers")] {
        let told = |count: usize| {
            let text = format!("[{}]", vec![state; count].join(","));
            let ended = run_with(&["eval", "simple_pendulum", "--function", "bias_forces", "--states", "-"], text.as_bytes());
            assert_eq!(ended.status, 1);
            (ended.err.matches(mistake).count(), ended.err.lines().last().unwrap().to_owned())
        };
        assert_eq!(told(500), (100, "error: -: and 400 more".to_owned()));
        let (count, last) = told(100);
        assert!(count == 100 && last.contains("states[99]: v"), "{last}");
    }
}

#[test]
fn the_examples_of_the_help_run_as_they_are_printed() {
    let help = run(&["eval", "--help"]).out;
    let lines: Vec<&str> = help.lines().map(str::trim).collect();
    let at = |start: &str| lines.iter().position(|line| line.starts_with(start)).unwrap();
    let after = |file: &str| lines[at(file)].split_once(':').unwrap().1.trim();
    let json = after("states.json:").to_owned();
    let csv = format!("{}\n{}\n", after("states.csv:"), lines[at("states.csv:") + 1]);
    for (name, content) in [("states.json", json), ("states.csv", csv)] {
        let file = File::new(name, content.as_bytes());
        let example = lines.iter().find(|line| line.starts_with("articulated eval ") && line.contains(name)).unwrap();
        let words: Vec<&str> = example.split(' ').skip(1).map(|word| if word == name { file.name() } else { word }).collect();
        let ended = run(&words);
        assert_eq!(ended.status, 0, "{example}: {}", ended.err);
    }
}

/// A mass on the axis of its joint, without inertia about it.
const ON_AXIS: &str = r#"<robot name="spinner"><link name="base"/><link name="mass"><inertial><mass value="1"/>
<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
<joint name="spin" type="continuous"><parent link="base"/><child link="mass"/><axis xyz="0 0 1"/></joint></robot>"#;

#[test]
fn what_no_code_can_be_generated_for_is_not_evaluated_either() {
    let file = File::new("spinner.urdf", ON_AXIS.as_bytes());
    let eval = |function: &str, way: &[&str]| {
        let words = ["eval", file.name(), "--function", function, "--states", "-"];
        run_with(&[&words[..], way].concat(), br#"[{"q": [0], "v": [0], "a": [1], "tau": [1]}]"#)
    };
    for function in ["forward_dynamics", "mass_matrix_inverse", "operational_space_inertia"] {
        let (generated, generic) = (eval(function, &["--generated"]), eval(function, &["--generic"]));
        assert_eq!((generated.status, generic.status), (1, 1), "{}", generic.out);
        assert_eq!(generated.err, generic.err);
        assert!(generic.err.contains("no inertia of its own for joint spin"), "{}", generic.err);
    }
    assert_eq!(eval("inverse_dynamics", &["--generic"]).status, 0);
    let scene = File::new("spinner.toml", format!("urdf = {:?}\n[simulation]\nend = 1\n", file.name()).as_bytes());
    let (generic, generated) = (run(&["simulate", scene.name()]), run(&["simulate", scene.name(), "--generated"]));
    assert!(generic.status == 1 && generic.err.contains("no inertia of its own for joint spin"), "{}", generic.err);
    assert_eq!((generic.status, generic.err), (generated.status, generated.err));
}

#[test]
fn without_a_compiler_there_are_generic_results() {
    let words = ["eval", "simple_pendulum", "--function", "gravity_torque", "--states", "-"];
    let without = |words: &[&str]| {
        let mut command = articulated(words);
        command.env("RUSTC", "/no/such/compiler");
        end(command, br#"[{"q": [1]}]"#)
    };
    let ended = without(&words);
    assert_eq!(ended.status, 0);
    assert!(ended.err.contains("warning: no Rust compiler") && ended.out.contains("swing"), "{}", ended.err);
    assert_eq!(without(&[&words[..], &["--generated"]].concat()).status, 3);
    assert_eq!(without(&[&words[..], &["--generic"]].concat()).err, "");
}

/// A state with every argument there is: [nq], [nv], and a wrench on each frame.
fn whole_state(nq: usize, nv: usize, frames: usize) -> String {
    let [q, v] = [nq, nv].map(|n| (0..n).map(|k| 0.1 + 0.07 * k as f64).collect::<Vec<_>>());
    serde_json::json!([{"q": q, "v": v, "a": v, "tau": v, "step": v, "target": q, "uniform": q, "wrenches": vec![[0.5; 6]; frames]}])
        .to_string()
}

#[test]
fn every_function_has_a_result_by_name() {
    let groups = "kinematics,dynamics,derivatives,momentum,regressors,operational_space_inertia_inverse,effects,configurations";
    let words = ["eval", "cart_pole", "--function", groups, "--states", "-", "--frames", "cart,pole_rod"];
    let state = whole_state(2, 2, 2);
    let ended = run_with(&[&words[..], &["--format", "json"]].concat(), state.as_bytes());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    let all = json["functions"].as_array().unwrap();
    assert_eq!(all.len(), articulated_core::algorithm::functions::<f64>().len() - 1);
    let of = |name: &str| &all.iter().find(|f| f["function"] == name).unwrap()["states"][0];
    let [cart, pole] = [0, 1].map(|k| joint_names("cart_pole")[k].clone());
    for side in ["generic", "generated"] {
        assert!(of("kinetic_energy")[side].is_number());
        assert_eq!(of("center_of_mass")[side].as_array().unwrap().len(), 3);
        assert_eq!(of("twists_world")[side]["pole_rod"].as_array().unwrap().len(), 6);
        assert_eq!(of("jacobians_world")[side]["cart"][3][&cart], 1.0);
        assert_eq!(of("jacobians_world")[side]["cart"][3][&pole], 0.0);
        assert_eq!(of("mass_matrix")[side][&cart][&pole], of("mass_matrix")[side][&pole][&cart]);
        assert_eq!(of("joint_wrenches")[side][&pole].as_array().unwrap().len(), 6);
        assert_eq!(of("torque_regressor")[side][&cart][&pole].as_array().unwrap().len(), 10);
        assert_eq!(of("inverse_dynamics_derivatives")[side][2][&cart][&pole], of("mass_matrix")[side][&cart][&pole]);
        assert!((of("integrate")[side][&pole].as_f64().unwrap() - 0.34).abs() < 1e-15);
    }
    let text = run_with(&words, state.as_bytes());
    assert_eq!(text.status, 0, "{}", text.err);
    assert!(text.lines_with("largest difference") == all.len() && text.lines_with(&format!("[1] {cart}")) >= 1, "{}", text.out);
}

/// Turned about z, y, z with y = 0, the first and the last axis coincide: M is singular there, and
/// nearly singular next to it.
#[test]
fn results_of_a_singular_mass_matrix_are_told() {
    let joint = |k: usize, axis: &str| {
        let (name, parent) = (["z1", "y", "z2"][k], ["base", "l0", "l1"][k]);
        format!("<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='l{k}'/><axis xyz='{axis}'/></joint>")
    };
    let text = format!(
        "<robot name='wrist'><link name='base'/><link name='l0'/><link name='l1'/><link name='l2'><inertial><mass value='1'/>\
         <inertia ixx='0.2' ixy='0' ixz='0' iyy='0.25' iyz='0' izz='0.3'/></inertial></link>{}{}{}</robot>",
        joint(0, "0 0 1"),
        joint(1, "0 1 0"),
        joint(2, "0 0 1")
    );
    let urdf = File::new("wrist.urdf", text.as_bytes());
    let states = r#"{"states": [{"q": [0.1, 0.8, 0.2]}, {"q": [0.1, 0.0, 0.2]}, {"q": [0.1, 1e-9, 0.2]}]}"#;
    let words = |function| ["eval", urdf.name(), "--function", function, "--states", "-", "--generic", "--format", "json"];
    let ended = run_with(&words("mass_matrix_inverse"), states.as_bytes());
    let warnings = ended.json()["warnings"].to_string();
    assert_eq!((ended.status, ended.lines_with("warning: -: states[0]")), (0, 0), "{}", ended.err);
    for k in [1, 2] {
        let singular = format!("states[{k}]: mass_matrix_inverse: joint \\\"z1\\\" (degree of freedom 0): the mass matrix is singular");
        assert!(warnings.contains(&singular), "{warnings}");
    }
    assert!(warnings.contains("states[1]: mass_matrix_inverse: number 0 of the result is not finite"), "{warnings}");
    // Functions without division by it are valid there.
    assert_eq!(run_with(&words("mass_matrix"), states.as_bytes()).lines_with("warning: -"), 0);
}

#[test]
fn a_moment_on_the_rod_is_a_torque_less() {
    let torque = |wrenches: serde_json::Value| {
        let states = serde_json::json!([{"q": [0.4], "v": [0], "a": [0], "wrenches": wrenches}]).to_string();
        let words = ["eval", "simple_pendulum", "--function", "inverse_dynamics_with_wrenches", "--states", "-", "--format", "json"];
        let ended = run_with(&[&words[..], &["--generic"]].concat(), states.as_bytes());
        assert_eq!(ended.status, 0, "{}", ended.err);
        ended.json()["functions"][0]["states"][0]["generic"]["swing"].as_f64().unwrap()
    };
    let links = run(&["check", "simple_pendulum", "--format", "json"]).json()["links"].clone();
    let rod = links[1]["link"].as_str().unwrap();
    let free = torque(serde_json::json!({}));
    let loaded = torque(serde_json::json!({rod: [0.25, 0.25, 0.25, 0, 0, 0]}));
    assert!((free - loaded - 0.25).abs() < 1e-14, "{free} {loaded}");
}

#[test]
fn a_floating_base_has_named_parts() {
    let mut q = vec![0.1; 19];
    q[3..7].copy_from_slice(&[0.0, 0.6, 0.0, 0.800_000_01]);
    let states = serde_json::json!([{"q": q, "v": vec![0.5; 18], "a": vec![-0.5; 18]}]).to_string();
    let ended = run_with(&["eval", "quadruped", "--function", "inverse_dynamics", "--states", "-"], states.as_bytes());
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert!(ended.err.contains("warning") && ended.err.contains("normalised"), "{}", ended.err);
    assert!(ended.out.contains("__floating_base__[5]") && ended.out.contains("largest difference"));
}

/// Generated code of such levels is off by more than rounding, and takes other numbers.
#[test]
fn levels_that_are_less_exact_than_the_library_are_refused() {
    let states = File::new("states.json", STATES.as_bytes());
    for level in ["f32", "f32_f64", "f64+fast_7"] {
        let scene = File::new("level.toml", format!("robot = \"simple_pendulum\"\nlevel = \"{level}\"\n").as_bytes());
        for words in [&["eval", scene.name(), "--function", "inverse_dynamics", "--states", states.name()][..], &["compare", scene.name()]]
        {
            let refused = run(words);
            assert_eq!(refused.status, 1, "{words:?}: {}", refused.out);
            assert!(
                refused.err.contains("level: found f") && refused.err.contains("expected f64 or what is more exact"),
                "{}",
                refused.err
            );
        }
    }
    let scene = File::new("level.toml", b"robot = \"simple_pendulum\"\nlevel = \"compensated\"\n");
    let ended = run(&["eval", scene.name(), "--function", "inverse_dynamics", "--states", states.name()]);
    assert_eq!(ended.status, 0, "{}", ended.err);
}

#[test]
fn one_standard_input_is_not_two_files() {
    let urdf = articulated_models::robot("simple_pendulum").unwrap().urdf;
    let ended = run_with(&["eval", "-", "--function", "mass_matrix", "--states", "-"], urdf.as_bytes());
    assert_eq!((ended.status, ended.err.as_str()), (1, "error: -: the standard input is another file of this command already\n"));
}

/// A workspace has room for a matrix of the number of degrees of freedom squared.
#[test]
fn a_robot_that_no_matrix_fits_is_refused() {
    let link = |k: usize| {
        format!("<link name='l{k}'/><joint name='j{k}' type='continuous'><parent link='l{}'/><child link='l{k}'/></joint>", k - 1)
    };
    let urdf = format!("<robot name='long'><link name='l0'/>{}</robot>", (1..=10_001).map(link).collect::<String>());
    let file = File::new("long.urdf", urdf.as_bytes());
    let scene = File::new("long.toml", format!("urdf = {:?}\nsimulation = {{ end = 0.1 }}", file.name()).as_bytes());
    let states = ["--function", "gravity_torque", "--generic", "--states", "-"];
    let words = [&["eval", file.name()][..], &states].concat();
    for words in [&words[..], &["stress", file.name()], &["functions", file.name()], &["simulate", scene.name()], &["check", scene.name()]]
    {
        let ended = run(words);
        let told = format!("{}{}", ended.out, ended.err);
        assert!(
            ended.status == 1 && told.contains("found 10001 degrees of freedom, expected at most 10000 to compute with"),
            "{words:?}: {told}"
        );
    }
}

/// Files as they are shipped, against closed forms: a hinge about y through the origin has
/// M = I_yy + m (x² + z²), summed over the carried links.
#[test]
fn robots_of_shipped_files_have_the_values_of_closed_forms() {
    let body = |name: &str, mass: &str, at: &str, moments: [&str; 4]| {
        let [xx, xz, yy, zz] = moments;
        format!(
            "<link name='{name}'><inertial><origin xyz='{at}'/><mass value='{mass}'/>
             <inertia ixx='{xx}' ixy='0' ixz='{xz}' iyy='{yy}' iyz='0' izz='{zz}'/></inertial></link>"
        )
    };
    let joint = |name: &str, kind: &str, ends: [&str; 2], rest: &str| {
        format!("<joint name='{name}' type='{kind}'><parent link='{}'/><child link='{}'/>{rest}</joint>", ends[0], ends[1])
    };
    let value = |version: &str, parts: &[String], function: &str| {
        let text = format!("<robot name='r' version='{version}'><link name='ground'/>{}</robot>", parts.concat());
        let urdf = File::new("r.urdf", text.as_bytes());
        let ended =
            run_with(&["eval", urdf.name(), "--function", function, "--states", "-", "--generic", "--format", "json"], b"[{\"q\": [0]}]");
        assert_eq!(ended.status, 0, "{}", ended.err);
        let given = &ended.json()["functions"][0]["states"][0]["generic"];
        let number = given.pointer("/hinge/hinge").or_else(|| given.get("hinge")).and_then(serde_json::Value::as_f64);
        number.unwrap_or_else(|| panic!("{given}"))
    };
    let near = |found: f64, right: f64| assert!((found / right - 1.0).abs() < 1e-14, "{found} {right}");
    // A fixed joint that kept its <mimic>: 0.02 + 1.5·0.2² + 0.001 + 0.25·(0.4² + 0.05²), and
    // −9.81·(1.5·0.2 + 0.25·0.4).
    let lamp = [
        body("arm", "1.5", "0.2 0 0", ["0.01", "0", "0.02", "0.02"]),
        body("lamp", "0.25", "0 0 0.05", ["0.001", "0", "0.001", "0.001"]),
        joint("hinge", "continuous", ["ground", "arm"], "<axis xyz='0 1 0'/>"),
        joint("bracket", "fixed", ["arm", "lamp"], "<origin xyz='0.4 0 0'/><mimic joint='hinge' multiplier='1' offset='0'/>"),
    ];
    near(value("1.0", &lamp, "mass_matrix"), 0.121625);
    near(value("1.0", &lamp, "gravity_torque"), -3.924);
    // A point mass whose inertia is a rounding error: 1.2·0.0185².
    let point = [
        body("bob", "1.2", "0.0185 -0.11 6.8e-18", ["0", "3.1e-35", "0", "0"]),
        joint("hinge", "continuous", ["ground", "bob"], "<axis xyz='0 1 0'/>"),
    ];
    near(value("1.0", &point, "mass_matrix"), 1.2 * 0.0185 * 0.0185);
    // A quarter turn about x as a quaternion: the axis z of the joint is −y of the ground, gravity
    // pulls along −y of the joint: τ = m g x.
    let turned = [
        body("bob", "2", "0.3 0 0", ["0.01", "0", "0.01", "0.01"]),
        joint(
            "hinge",
            "continuous",
            ["ground", "bob"],
            "<axis xyz='0 0 1'/><origin quat_xyzw='0.7071067811865476 0 0 0.7071067811865476'/>",
        ),
    ];
    near(value("1.1", &turned, "gravity_torque"), 2.0 * 9.81 * 0.3);
    near(value("1.1", &turned, "mass_matrix"), 0.01 + 2.0 * 0.3 * 0.3);
}

/// A light ball on a stiff plane, a kilometre below the joint: a rounding of its height is a
/// thousandth of its acceleration. The torque that the acceleration needs has a closed form.
#[test]
fn where_rounding_moves_the_result_it_is_judged_by_its_torques() {
    const MASS: f64 = 1e-3;
    const STIFFNESS: f64 = 1e9;
    let inertia = "<inertia ixx='1e-6' ixy='0' ixz='0' iyy='1e-6' iyz='0' izz='1e-6'/>";
    let urdf = format!(
        "<robot name='drop'><link name='top'/><link name='ball'><inertial><mass value='{MASS}'/>{inertia}</inertial></link>
        <joint name='fall' type='prismatic'><parent link='top'/><child link='ball'/><origin xyz='0 0 1000'/><axis xyz='0 0 1'/>
        <limit lower='-2000' upper='0' effort='1' velocity='1'/></joint></robot>"
    );
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap();
        folder.path().join(name).display().to_string()
    };
    at("drop.urdf", &urdf);
    let contact = |stiffness: f64| {
        format!(
            "file = 'drop.urdf'\neffects = {{ contact = {{ ball = {{ radius = 0.1, stiffness = {stiffness}, damping = 0, friction = 0 }} }} }}"
        )
    };
    let (steep, soft) = (at("steep.toml", &contact(STIFFNESS)), at("soft.toml", &contact(1e3)));
    let q = -999.900_000_000_01;
    let states = at("states.json", &format!("[{{\"q\": [{q:?}], \"v\": [0], \"tau\": [0.001]}}]"));
    let words = |scene: &str, way: &[&str]| {
        let eval = ["eval", scene, "--function", "forward_dynamics", "--states", &states, "--format", "json"];
        let ended = run(&[&eval[..], way].concat());
        assert_eq!(ended.status, 0, "{}", ended.err);
        ended.json()["functions"][0].clone()
    };
    // 1000 + q and the depth are exact.
    let applied = 0.001 + STIFFNESS * (0.1 - (1000.0 + q));
    let found = words(&steep, &[]);
    let torque = |side: &str| (MASS * (found["states"][0][side]["fall"].as_f64().unwrap() + 9.81) - applied).abs();
    let told = &found["largest_backward_error"];
    let expected = torque("generic").max(torque("generated"));
    assert!((told["torque"].as_f64().unwrap() - expected).abs() < 1e-12, "{told} {expected}");
    let units = told["in_units_of_roundoff"].as_f64().unwrap();
    // The height of the ball is a difference of numbers of 1000 m.
    let size = STIFFNESS * 2000.0 / 2.0_f64.powi(53);
    assert!(units <= 8.0 && expected <= 2.0 * units.max(f64::MIN_POSITIVE) * size, "{told}");
    assert_eq!((told["states"].as_u64(), told["state"].as_u64(), told["bound"].as_f64()), (Some(1), Some(0), Some(128.0)));
    assert!(found["largest_difference"].is_null(), "{found}");
    assert_eq!(words(&steep, &["--generic"])["largest_backward_error"]["states"], 1);
    // A soft contact is judged by its acceleration.
    let found = words(&soft, &[]);
    assert!(found["largest_backward_error"].is_null() && found["largest_difference"]["bound"] == 128.0, "{found}");
    let text = run(&["eval", &steep, "--function", "forward_dynamics", "--states", &states]).out;
    assert!(text.contains("one unit of rounding is more than 1e-3 of the result in 1 state: there the torque that"), "{text}");
}
