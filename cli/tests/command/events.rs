//! Reports of `articulated simulate` about events, and about robots of very small mass.

use super::{File, run};

/// A scene of a robot with these joints; every link has the same mass.
fn simulated(joints: &str, mass: f64, scene: &str) -> serde_json::Value {
    let link = |name: &str| {
        let inertial =
            format!("<inertial><mass value='{mass}'/><inertia ixx='{mass}' ixy='0' ixz='0' iyy='{mass}' iyz='0' izz='{mass}'/></inertial>");
        format!("<link name='{name}'>{}</link>", if mass > 0.0 { inertial.as_str() } else { "" })
    };
    let urdf = format!("<robot name='r'><link name='g'/>{}{}{joints}</robot>", link("a"), link("b"));
    let urdf = File::new("r.urdf", urdf.as_bytes());
    let scene = File::new("scene.toml", format!("urdf = {:?}\n{scene}", urdf.name()).as_bytes());
    let ended = run(&["simulate", scene.name(), "--format", "json"]);
    assert!(ended.status == 0 && !ended.err.contains("stick_slip"), "{}{}", ended.out, ended.err);
    ended.json()
}

fn told(summary: &serde_json::Value) -> Vec<String> {
    summary["events"].as_array().unwrap().iter().map(|e| e["what"].as_str().unwrap().to_owned()).collect()
}

const LEADER: &str = "<joint name='x' type='prismatic'><parent link='g'/><child link='a'/><axis xyz='1 0 0'/>
    <limit lower='-9' upper='9' effort='1' velocity='1'/></joint>";

/// A joint that follows another has stops and friction of its own, at its own coordinate and rate:
/// y = 0.5 − 2 x.
#[test]
fn joints_that_follow_come_to_their_limits_and_stick() {
    let follower = "<joint name='y' type='prismatic'><parent link='g'/><child link='b'/><axis xyz='1 0 0'/>
        <limit lower='-1' upper='1' effort='1' velocity='1'/><mimic joint='x' multiplier='-2' offset='0.5'/></joint>";
    let scene = "initial = { v = { x = 1.0 } }\n[effects]\nfriction = { y = { friction = 1.0, speed = 0.01 } }
        limit = { y = { lower = -1.0, upper = 1.0, stiffness = 1e3 } }\n[simulation]\nend = 1.0\nevents = [\"limits\", \"stick_slip\"]\n";
    let summary = simulated(&format!("{LEADER}{follower}"), 1.0, scene);
    let events = told(&summary);
    assert_eq!(events[0], "y reaches its lower limit", "{events:?}");
    assert!(events.contains(&"y stops sliding".to_owned()) && events.iter().all(|what| what.starts_with("y ")), "{events:?}");
    // y = −1 at x = 0.75; friction of 1 N at y slows x by 2 N of an inertia of 1 + 4 kg.
    let expected = (1.0 - (1.0_f64 - 2.0 * 0.4 * 0.75).sqrt()) / 0.4;
    let first = &summary["events"][0];
    assert_eq!((&first["kind"], &first["on"], &first["begins"]), (&"lower_limit".into(), &"y".into(), &true.into()));
    let time = first["time"].as_f64().unwrap();
    assert!((time - expected).abs() < 1e-3, "{time} {expected}");
}

/// Bounds of the file apply to their own joint, not to the one that it follows.
#[test]
fn a_follower_has_its_own_bounds_in_the_file() {
    let bounds = |upper: &str| match upper {
        "" => String::new(),
        upper => format!("<limit lower='-1' upper='{upper}' effort='1' velocity='1'/>"),
    };
    let told_of = |upper: &str| {
        let kind = if upper.is_empty() { "continuous" } else { "revolute" };
        let follower = format!(
            "<joint name='y' type='{kind}'><parent link='g'/><child link='b'/><axis xyz='1 0 0'/>{}<mimic joint='x' multiplier='2'/></joint>",
            bounds(upper)
        );
        let scene = "initial = { v = { x = 10.0 } }\ngravity = [0, 0, 0]\n[simulation]\nend = 1.0\nevents = [\"limits\"]\n";
        let summary = simulated(&format!("{LEADER}{follower}"), 1.0, scene);
        let times = summary["events"].as_array().unwrap().iter().map(|e| (e["time"].as_f64().unwrap() * 1e6).round());
        told(&summary).into_iter().zip(times).collect::<Vec<_>>()
    };
    let leader = ("x reaches its upper limit".to_owned(), 9e5);
    assert_eq!(told_of("10"), [("y reaches its upper limit".to_owned(), 5e5), leader.clone()]);
    assert_eq!(told_of(""), [leader]);
}

/// Both angles of a universal joint have the bounds of its effect.
#[test]
fn universal_joints_come_to_their_limits() {
    let joints = "<joint name='u' type='universal'><parent link='g'/><child link='a'/><axis xyz='1 0 0'/><axis2 xyz='0 1 0'/></joint>
        <joint name='w' type='fixed'><parent link='a'/><child link='b'/></joint>";
    let scene = "initial = { v = { u = [0.0, 1.0] } }\ngravity = [0, 0, 0]\n[effects]
        limit = { u = { lower = -0.3, upper = 0.3, stiffness = 1e3 } }\n[simulation]\nend = 0.5\nevents = [\"limits\"]\n";
    let summary = simulated(joints, 1.0, scene);
    assert_eq!(told(&summary)[0], "u[1] reaches its upper limit");
    assert!((summary["events"][0]["time"].as_f64().unwrap() - 0.3).abs() < 1e-6, "{}", summary["events"]);
}

/// Only rotors move, and there is no centre of mass: no number of the summary is missing.
#[test]
fn a_robot_of_rotors_alone_moves() {
    let scene = "initial = { v = { x = 1.0 } }\neffects = { armature = { x = 0.5 } }\n[simulation]\nend = 0.1\n";
    let still = "<joint name='w' type='fixed'><parent link='a'/><child link='b'/></joint>";
    let summary = simulated(&format!("{LEADER}{still}"), 0.0, scene);
    let text = summary.to_string();
    assert!(summary["energy"]["kinetic_start"].as_f64() == Some(0.25) && !text.contains("NaN"), "{text}");
    let momentum = summary["momentum"].to_string();
    assert!(!momentum.contains("null"), "{momentum}");
}

/// Generated code of a motion has few frames; a link may still have another name in Rust.
#[test]
fn links_that_a_motion_does_not_need_may_be_renamed() {
    let text = "robot = \"ur5_like\"\nrename = { flange = \"FLANGE\" }\n[simulation]\nend = 0.01\n";
    let scene = File::new("renamed.toml", text.as_bytes());
    let ended = run(&["simulate", scene.name(), "--generated"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
}

/// A ball joint at 10 rad/s would turn by more than π in a step of 1 s: `check` reports it, like
/// the run.
#[test]
fn check_makes_the_first_step_of_a_motion() {
    let urdf = File::new(
        "ball.urdf",
        b"<robot name='r'><link name='g'/><link name='a'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
        <joint name='ball' type='spherical'><parent link='g'/><child link='a'/></joint></robot>",
    );
    for (step, status) in [(1.0, 1), (0.01, 0)] {
        let scene = format!(
            "urdf = {:?}\ngravity = [0, 0, 0]\ninitial = {{ v = {{ ball = [0.0, 0.0, 10.0] }} }}
            simulation = {{ end = 2.0, integrator = 'lie_midpoint', step = {step} }}",
            urdf.name()
        );
        let scene = File::new("scene.toml", scene.as_bytes());
        let (checked, ran) = (run(&["check", scene.name()]), run(&["simulate", scene.name()]));
        assert_eq!((checked.status, ran.status), (status, status), "{}{}", checked.out, checked.err);
        if status == 1 {
            let told = "at t = 0 s a step of 1.000e0 s turns by 10.000 rad (joint `ball`)";
            assert!(checked.out.contains(told) && checked.out.contains("the motion ends with its first step"), "{}", checked.out);
            assert!(ran.err.contains(told), "{}", ran.err);
        }
    }
}

/// A link of 2 kg held by 6 N·m of friction against 4.905 N·m: 26 steps, no event, and 0.142 mrad
/// of creep in 10 s.
#[test]
fn what_friction_holds_is_told_with_its_creep() {
    let joint = "<joint name='s' type='revolute'><parent link='g'/><child link='a'/><axis xyz='0 1 0'/><origin xyz='0 0 0'/>
        <limit lower='-1.2' upper='1.2' effort='40' velocity='3'/></joint>
        <joint name='f' type='fixed'><parent link='a'/><child link='b'/><origin xyz='0.5 0 0'/></joint>";
    // b of 1 kg at 0.5 m.
    let summary = simulated(joint, 1.0, "effects = { friction = { s = 6.0 } }\n[simulation]\nend = 10.0\nevents = [\"stick_slip\"]\n");
    assert!(told(&summary).is_empty() && summary["counts"]["steps"].as_u64().unwrap() < 60, "{summary}");
    let (creep, x) = (&summary["creep"][0], 9.81 * 0.5 / 6.0_f64);
    assert_eq!((&creep["effect"], &creep["on"]), (&"friction".into(), &"s".into()));
    let expected = 10.0 * 1e-5 * x / (1.0 - x * x).sqrt();
    assert!((creep["distance"].as_f64().unwrap() / expected - 1.0).abs() < 2e-3, "{creep} {expected}");
    assert_eq!(summary["integrator"]["name"], "rodas4");
}
