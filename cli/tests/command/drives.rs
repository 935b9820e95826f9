//! Drives of the robots of scenes: sampled tables, targets that turn, and steps that are too long.

use crate::scenes::{Motion, largest};
use crate::{File, run};

/// A free body of 0.1 kg·m² about z, and one that turns freely.
fn robot(joint: &str) -> File {
    let text = format!(
        "<robot name='r'><link name='base'/><link name='body'><inertial><mass value='2'/>\
         <inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>{joint}</robot>"
    );
    File::new("r.urdf", text.as_bytes())
}

fn hinge() -> File {
    robot("<joint name='j' type='continuous'><parent link='base'/><child link='body'/><axis xyz='0 0 1'/></joint>")
}

fn ball() -> File {
    robot("<joint name='j' type='spherical'><parent link='base'/><child link='body'/></joint>")
}

/// q̈ = u/I with u held from sample to sample is a recursion: rows of the table between samples
/// have no effect.
#[test]
fn a_table_that_is_sampled_is_the_recursion_of_its_samples() {
    let (urdf, period, spacing, inertia) = (hinge(), 0.025, 0.013, 0.1);
    let (kp, kd) = (20.0, 2.0);
    let row = |k: usize| (spacing * k as f64, (3.0 * spacing * k as f64).sin());
    let rows: Vec<String> = (0..78).map(|k| format!("[{:?}, {:?}]", row(k).0, row(k).1)).collect();
    let text = format!(
        "urdf = {:?}\n[control]\nkind = \"pd\"\nkp = {kp}\nkd = {kd}\nperiod = {period}\ncolumns = [\"j\"]\nrows = [{}]\n\
         [simulation]\nend = 3.0\nintegrator = \"dop853\"\nrtol = 1e-11\natol = 1e-12\noutput = \"ends\"\n",
        urdf.name(),
        rows.join(", ")
    );
    let motion = Motion::of(File::new("sampled.toml", text.as_bytes()).name(), &[]);
    let (mut q, mut v) = (0.0, 0.0);
    for k in 0..120 {
        let t = period * f64::from(k);
        let before = ((t / spacing) as usize).min(77);
        let (target, rate) = match before {
            77 => (row(77).1, 0.0),
            _ => {
                let rate = (row(before + 1).1 - row(before).1) / spacing;
                (row(before).1 + rate * (t - row(before).0), rate)
            }
        };
        let a = (kp * (target - q) + kd * (rate - v)) / inertia;
        (q, v) = (q + period * v + 0.5 * period * period * a, v + period * a);
    }
    let found = [motion.last("q.")[0], motion.last("v.")[0]];
    assert!((found[0] - q).abs() < 1e-9 && (found[1] - v).abs() < 1e-9, "{found:?}, expected {q} {v}");
}

/// A body that already turns as the target does needs no torque, whichever of its two quaternions
/// the last row has.
#[test]
fn a_target_turns_the_shortest_way_at_one_rate() {
    let urdf = ball();
    for (angle, sign) in [(3.0_f64, 1.0), (3.0, -1.0), (0.2, 1.0), (0.2, -1.0)] {
        let (s, c) = (sign * (0.5 * angle).sin(), sign * (0.5 * angle).cos());
        let text = format!(
            "urdf = {:?}\ngravity = [0, 0, 0]\n[initial]\nv = {{ j = [{angle:?}, 0, 0] }}\n[control]\nkind = \"pd\"\nkp = 10\nkd = 1\n\
             columns = [\"j[0]\", \"j[1]\", \"j[2]\", \"j[3]\"]\nrows = [[0, 0, 0, 0, 1], [1, {s:?}, 0, 0, {c:?}]]\n\
             [simulation]\nend = 0.999\noutput = 0.01\nrtol = 1e-10\natol = 1e-12\n",
            urdf.name()
        );
        for code in [&[][..], &["--generated"]] {
            let motion = Motion::of(File::new("turn.toml", text.as_bytes()).name(), code);
            let torques = [0, 1, 2].map(|k| largest(&motion.column(&format!("tau.j[{k}]"))));
            assert!(torques.iter().all(|tau| *tau < 1e-9), "{angle} rad, sign {sign}: {torques:?} N·m");
        }
    }
}

#[test]
fn a_target_that_is_no_turn_is_an_error() {
    let urdf = ball();
    let told = |control: &str| {
        let text = format!("urdf = {:?}\n[control]\nkind = \"pd\"\nkp = 1\nkd = 1\n{control}\n[simulation]\nend = 0.1\n", urdf.name());
        let ended = run(&["simulate", File::new("norm.toml", text.as_bytes()).name()]);
        (ended.status, ended.err)
    };
    let (status, text) = told("target = { j = [0, 0, 0, 2] }");
    assert!(
        status == 1 && text.contains(":6: control.target: found a quaternion of norm 2.0000 for joint \"j\", expected norm one"),
        "{text}"
    );
    let columns = "columns = [\"j[0]\", \"j[1]\", \"j[2]\", \"j[3]\"]";
    let (status, text) = told(&format!("{columns}\nrows = [[0, 0, 0, 0, 1], [1, 0, 0, 0, 0.5], [2, 0, 0, 0, 0]]"));
    for (row, norm) in [(1, "0.5000"), (2, "0.0000")] {
        assert!(text.contains(&format!("control.rows[{row}]: found a quaternion of norm {norm}")), "{text}");
    }
    assert!(status == 1 && !text.contains("rows[0]"), "{text}");
}

/// Steps of a hundredth of a second on a stop of 1e9 N·m/rad, whose half period is fifty
/// microseconds: the motion is stable, but wrong.
#[test]
fn a_motion_without_balance_of_energy_is_told() {
    let urdf = robot(
        "<joint name='j' type='revolute'><parent link='base'/><child link='body'/><axis xyz='0 0 1'/>\
         <limit lower='0' upper='9' effort='1' velocity='1'/></joint>",
    );
    let told = |simulation: &str, (status, word): (i32, &str)| {
        let text = format!(
            "urdf = {:?}\n[effects.limit]\nj = {{ from = \"urdf\", stiffness = 1e9, damping = 0 }}\n[initial]\nq = [1.0]\nv = [-3.0]\n\
             [simulation]\nend = 2.0\nintegrator = \"rodas4\"\n{simulation}\n",
            urdf.name()
        );
        let ended = run(&["simulate", File::new("stop.toml", text.as_bytes()).name(), "--format", "json"]);
        assert_eq!((ended.status, ended.json()["status"].as_str()), (status, Some(word)), "{}", ended.err);
        ended.lines_with("the balance of energy lacks")
    };
    let (lost, kept) = ((5, "out_of_tolerance"), (0, "ok"));
    // The status is the same whatever is recorded.
    for output in ["", "\noutput = \"ends\"", "\noutput = 0.001"] {
        // In words and in the JSON.
        assert_eq!(told(&format!("step = 1e-2{output}"), lost), 2, "{output}");
    }
    assert_eq!(told("rtol = 1e-9\natol = 1e-11", kept), 0);
    let urdf = robot(
        "<joint name='j' type='prismatic'><parent link='base'/><child link='body'/><axis xyz='1 0 0'/><limit effort='1' velocity='1'/></joint>",
    );
    let text = format!("urdf = {:?}\n[initial]\nv = [1e200]\n[simulation]\nend = 0.1\n", urdf.name());
    let ended = run(&["simulate", File::new("huge.toml", text.as_bytes()).name(), "--format", "json"]);
    let odd = "energy is beyond the largest number";
    assert!(ended.status == 5 && ended.err.contains(odd) && ended.json()["warnings"].to_string().contains(odd), "{}", ended.err);
    assert!(ended.json()["energy"]["largest_imbalance"].is_null());
}
