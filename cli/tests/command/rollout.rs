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
fn what_is_wrong_is_told() {
    let cart = File::new("cart.urdf", CART.as_bytes());
    let told = |words: &[&str]| {
        let answer = run(&[&["rollout", cart.name(), "--steps", "10"], words].concat());
        (answer.status, answer.err)
    };
    let (status, text) = told(&["--method", "rk5"]);
    assert!(status == 2 && text.contains("expected one of step_semi_implicit_euler, step_implicit_damping, step_rk4"), "{status} {text}");
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
