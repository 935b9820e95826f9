use super::{File, run};

/// A cart on a rail without friction.
const CART: &str = r#"<robot name="cart"><link name="base"/><link name="cart"><inertial><mass value="2"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="rail" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="-9" upper="9" effort="9" velocity="9"/></joint></robot>"#;

#[test]
fn a_pushed_cart_moves_as_its_equation_says() {
    let cart = File::new("cart.urdf", CART.as_bytes());
    let states = File::new("states.json", br#"{"states": [{"q": [0.5], "v": [1], "tau": [4]}, {"q": [0], "v": [0]}]}"#);
    let words = ["rollout", cart.name(), "--steps", "100", "--states", states.name(), "--time-step", "0.01", "--method", "rk4"];
    let json = run(&[&words[..], &["--format", "json"]].concat()).json();
    // x = 0.5 + t + t², v = 1 + 2 t at t = 1, and a cart at rest.
    let number = |k: usize, vector: &str| json["states"][k][vector][0].as_f64().unwrap();
    assert!((number(0, "q") - 2.5).abs() < 1e-12 && (number(0, "v") - 3.0).abs() < 1e-12, "{json}");
    assert_eq!((number(1, "q"), number(1, "v"), json["method"].as_str()), (0.0, 0.0, Some("step_rk4")));
    let (text, hash) = (run(&words), run(&[&words[..], &["--hash"]].concat()));
    assert!(text.out.contains("cart: 2 states by step_rk4, 100 steps of 0.01 s"), "{}", text.out);
    assert_eq!(hash.out.trim(), json["hash"].as_str().unwrap());
    // The same random states for the same seed.
    let random = |seed: &str| run(&["rollout", "double_pendulum", "--steps", "20", "--states", "3", "--seed", seed, "--hash"]).out;
    assert!(random("1") == random("1") && random("1") != random("2"));
}

#[test]
fn the_error_estimate_is_that_of_the_step() {
    let cart = File::new("cart.urdf", CART.as_bytes());
    let states = File::new("states.json", br#"{"states": [{"q": [0.5], "v": [1], "tau": [4]}, {"q": [0], "v": [0]}]}"#);
    let words = ["rollout", cart.name(), "--steps", "100", "--states", states.name(), "--time-step", "0.01", "--error-estimate"];
    let estimate = |more: &[&str]| run(&[&words[..], more, &["--format", "json"]].concat()).json()["error_estimate"].clone();
    // x = 0.5 + t + a t (t + h)/2 with a = 2 m/s²: the error is a t h/2.
    let euler = estimate(&[]);
    assert!((euler["q"].as_f64().unwrap() - 0.01).abs() < 1e-12 && euler["v"].as_f64().unwrap() < 1e-13, "{euler}");
    assert_eq!(euler["states"], 2);
    let rk4 = estimate(&["--method", "rk4"]);
    assert!(rk4["q"].as_f64().unwrap() < 1e-13, "{rk4}");
    let text = run(&words).out;
    assert!(text.contains("error of the last states, estimated by half the step: q 0.01 rad|m, v "), "{text}");
    // States that are not finite have no estimate.
    let scene = File::new("stiff.toml", b"robot = \"simple_pendulum\"\n[effects]\ndamping = 1e4\n");
    let text = run(&["rollout", scene.name(), "--steps", "500", "--states", "2", "--error-estimate"]).out;
    assert!(text.contains("no estimate of the error"), "{text}");
}

#[test]
fn what_is_wrong_is_told() {
    let cart = File::new("cart.urdf", CART.as_bytes());
    let told = |words: &[&str]| {
        let answer = run(&[&["rollout", cart.name(), "--steps", "10"], words].concat());
        (answer.status, answer.err)
    };
    let (status, text) = told(&["--method", "rk5"]);
    assert!(
        status == 2 && text.contains("expected one of step_semi_implicit_euler, step_implicit_damping, step_implicit_velocity"),
        "{status} {text}"
    );
    assert!(told(&["--time-step=-1"]).1.contains("expected a positive number of seconds"));
    let states = File::new("states.json", br#"{"states": [{"q": [0.5]}, {"q": [1, 2], "v": [0]}]}"#);
    let (status, text) = told(&["--states", states.name()]);
    assert!(status == 1 && text.contains("states[1]: q"), "{status} {text}");
    let states = File::new("states.json", br#"{"states": [{"q": [0.5]}]}"#);
    let (status, text) = told(&["--states", states.name()]);
    assert!(status == 1 && text.contains("states[0]: v: found nothing, expected 1 number"), "{status} {text}");
    let (status, text) = told(&["--states", "no_such_file.json"]);
    assert!(status == 1 && text.contains("no_such_file.json"), "{status} {text}");
    // A joint that moves no mass has no acceleration.
    let idle = "<robot name='idle'><link name='a'/><link name='b'/>\
        <joint name='turn' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>";
    let answer = run(&["rollout", File::new("idle.urdf", idle.as_bytes()).name(), "--steps", "1"]);
    assert!(answer.status == 1 && answer.err.contains("turn"), "{} {}", answer.status, answer.err);
    // A step that is too long for a stiff joint.
    let scene = "robot = \"simple_pendulum\"\n[effects]\ndamping = 1e4\n";
    let scene = File::new("stiff.toml", scene.as_bytes());
    let answer = run(&["rollout", scene.name(), "--steps", "500", "--states", "2"]);
    assert!(answer.status == 0 && answer.err.contains("2 states are not finite at the end"), "{} {}", answer.status, answer.err);
    let answer = run(&["rollout", scene.name(), "--steps", "500", "--states", "2", "--method", "implicit_damping"]);
    assert!(answer.status == 0 && !answer.err.contains("not finite"), "{}", answer.err);
}

/// A slide with a servo whose activation follows the control, damping and two keyframes.
const SERVO: &str = r#"<mujoco model="cart"><option timestep="0.004" integrator="implicitfast"/>
<worldbody><body><joint name="x" type="slide" axis="1 0 0" damping="0.5"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/></body></worldbody>
<actuator><position name="servo" joint="x" kp="40" kv="3" timeconst="0.1"/><motor name="push" joint="x"/></actuator>
<keyframe><key name="home" qpos="0.1" ctrl="0.5 0.2" act="0.3"/><key name="rest" qpos="0.4"/></keyframe></mujoco>"#;

#[test]
fn the_motion_of_a_file_is_that_of_its_step_and_starts_at_home() {
    let file = File::new("cart.xml", SERVO.as_bytes());
    let rolled = |more: &[&str]| run(&[&["rollout", file.name(), "--steps", "250", "--format", "json"], more].concat());
    let json = rolled(&[]).json();
    assert_eq!((json["method"].as_str(), json["time_step"].as_f64()), (Some("actuated_step_implicit_velocity"), Some(0.004)));
    assert_eq!(json["actuators"], serde_json::json!(["servo", "push"]));
    let end = |vector: &str| json["states"][0][vector][0].as_f64().unwrap();
    // The activation: an exact filter, w = u + (w₀ − u) exp(−t/T).
    assert!((end("act") - (0.5 - 0.2 * (-10.0_f64).exp())).abs() < 1e-14, "{json}");
    // (m + h (d + kv)) (v₁ − v₀) = h (kp (w − x) − (kv + d) v₀ + u), by hand.
    let (mut x, mut v, mut w, h) = (0.1, 0.0, 0.3, 0.004);
    for _ in 0..250 {
        v += h * (40.0 * (w - x) - 3.5 * v + 0.2) / (2.0 + h * 3.5);
        x += h * v;
        w = 0.5 + (w - 0.5) * f64::exp(-h / 0.1);
    }
    assert!((end("q") - x).abs() < 1e-13 && (end("v") - v).abs() < 1e-13, "{json} {x} {v}");
    // The same motion with its records, energies and files.
    let simulated = run(&["simulate", file.name(), "--smooth", "--end", "1", "--format", "json"]);
    let summary = simulated.json();
    assert!(simulated.status == 0 && simulated.err.contains("the keyframe \"home\""), "{}", simulated.err);
    assert_eq!((summary["integrator"]["name"].as_str(), summary["counts"]["steps"].as_u64()), (json["method"].as_str(), Some(250)));
    let kinetic = summary["energy"]["kinetic_end"].as_f64().unwrap();
    assert!((kinetic - v * v).abs() < 1e-14, "{kinetic} {}", v * v);
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().to_str().unwrap();
    let written = run(&["simulate", file.name(), "--smooth", "--end", "1", "--every", "0.5", "-o", to]);
    assert_eq!(written.status, 0, "{}", written.err);
    let table = std::fs::read_to_string(folder.path().join("recording.csv")).unwrap();
    let times: Vec<f64> = table.lines().skip(1).map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!(times, [0.0, 0.5, 1.0]);
    // Another keyframe, whose controls and activations are 0.
    let rest = rolled(&["--keyframe", "rest"]);
    assert!(rest.err.contains("the keyframe \"rest\"") && rest.json()["states"][0]["act"][0] == 0.0, "{}", rest.err);
    let unknown = rolled(&["--keyframe", "hom"]);
    assert!(unknown.status == 1 && unknown.err.contains("expected one of home, rest"), "{}", unknown.err);
    // Torques are of steps with torques.
    let states = File::new("states.json", br#"{"states": [{"q": [0.5], "v": [1], "tau": [4]}]}"#);
    assert_eq!(rolled(&["--states", states.name()]).json()["method"], "step_implicit_velocity");
    let both = rolled(&["--states", states.name(), "--method", "actuated_step_rk4"]);
    assert!(both.status == 1 && both.err.contains("states[0]: found tau, expected ctrl"), "{}", both.err);
}

#[test]
fn a_smooth_motion_is_of_a_file() {
    let told = |words: &[&str]| run(&[&["simulate"], words].concat()).err;
    assert!(told(&["pendulum", "--smooth"]).contains("--smooth: found no file of a robot"));
    let file = File::new("cart.xml", SERVO.as_bytes());
    assert!(told(&[file.name(), "--smooth", "--integrator", "rk4"]).contains("cannot be used with"));
    // A scene has no activations.
    assert!(told(&[file.name()]).contains("the actuator \"servo\", which gives no force in a scene"), "{}", told(&[file.name()]));
    // A step that is too long for its motion is a warning, and a motion without a bound an error.
    let stiff = SERVO.replace("implicitfast", "Euler").replace("kp=\"40\"", "kp=\"4e4\"");
    let stiff = File::new("stiff.xml", stiff.as_bytes());
    let long = run(&["simulate", stiff.name(), "--smooth", "--step", "0.0141", "--end", "0.3"]);
    assert!(long.status == 0 && long.err.contains("the steps of the file are long for this motion"), "{} {}", long.status, long.err);
    let lost = run(&["simulate", stiff.name(), "--smooth", "--step", "1", "--end", "500"]);
    assert!(lost.status == 1 && lost.err.contains("is not finite"), "{} {}", lost.status, lost.err);
}
