//! The purpose of each bundled scene.

use crate::{File, run};

/// A motion in its files.
pub(crate) struct Motion {
    titles: Vec<String>,
    rows: Vec<Vec<f64>>,
    summary: serde_json::Value,
}

impl Motion {
    pub(crate) fn of(scene: &str, words: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let ended = run(&[&["simulate", scene, "-o", folder.path().to_str().unwrap()], words].concat());
        assert_eq!(ended.status, 0, "{scene}: {}", ended.err);
        let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let table = text("recording.csv");
        let mut lines = table.lines().map(|l| l.split(','));
        let titles = lines.next().unwrap().map(str::to_owned).collect();
        let rows = lines.map(|l| l.map(|x| x.parse().unwrap_or(f64::NAN)).collect()).collect();
        Self { titles, rows, summary: serde_json::from_str(&text("summary.json")).unwrap() }
    }

    /// A column, by its title.
    pub(crate) fn column(&self, title: &str) -> Vec<f64> {
        let at = self.titles.iter().position(|t| t == title).unwrap_or_else(|| panic!("{title} of {:?}", self.titles));
        self.rows.iter().map(|r| r[at]).collect()
    }

    /// The last numbers of all columns whose titles start with `start`.
    pub(crate) fn last(&self, start: &str) -> Vec<f64> {
        self.at(self.rows.len() - 1, start)
    }

    fn at(&self, row: usize, start: &str) -> Vec<f64> {
        self.titles.iter().zip(&self.rows[row]).filter(|(t, _)| t.starts_with(start)).map(|(_, x)| *x).collect()
    }

    fn number(&self, group: &str, name: &str) -> f64 {
        self.summary[group][name].as_f64().unwrap()
    }
}

pub(crate) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// K(k) by the arithmetic–geometric mean (Abramowitz & Stegun 1964, 17.6).
fn complete_elliptic(k: f64) -> f64 {
    let (mut a, mut g) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..10 {
        (a, g) = (f64::midpoint(a, g), (a * g).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}

#[test]
fn a_pendulum_comes_back_after_its_period() {
    let robot = articulated_models::robot("simple_pendulum").unwrap();
    let model = articulated::load_bytes("simple_pendulum.urdf", robot.urdf.as_bytes(), robot.base).unwrap();
    let value = |name: &str, q: f64| {
        let mut out = [0.0];
        let function = articulated::algorithm::function::<f64>(name).unwrap();
        function.call(&model, &mut articulated::Workspace::new(&model), &[&[q]], &mut out).unwrap();
        out[0]
    };
    let (inertia, weight) = (value("mass_matrix", 0.0), value("gravity_torque", std::f64::consts::FRAC_PI_2).abs());
    let period = 4.0 * (inertia / weight).sqrt() * complete_elliptic(1.0_f64.sin());
    let end = format!("{period:?}");
    let motion = Motion::of("pendulum", &["--end", &end, "--every", &end]);
    assert!((motion.last("q.swing")[0] - 2.0).abs() < 1e-10);
    // At the turning point the rate shows the delay.
    let late = motion.last("v.swing")[0] * inertia / (weight * 2.0_f64.sin());
    assert!(late.abs() < 1e-10 * period, "{late} s late");
}

#[test]
fn two_rods_keep_their_energy_for_a_hundred_seconds() {
    let motion = Motion::of("double_pendulum", &["--every", "1"]);
    let moved = motion.number("energy", "relative_imbalance");
    assert!(moved < 1e-10, "{moved}");
    assert_eq!(motion.rows.len(), 101);
}

#[test]
fn a_cart_comes_to_the_end_of_its_track_and_not_through() {
    let motion = Motion::of("cart_pole", &[]);
    assert!(motion.summary["events"].as_array().unwrap().iter().any(|e| e["what"].as_str().unwrap().contains("slide")));
    let slide = largest(&motion.column("q.slide"));
    // ½ m v² = ½ k x² at some 3 m/s and 1.1 kg: 3 cm.
    assert!(slide > 2.4 && slide < 2.44, "{slide}");
    assert!(motion.number("energy", "relative_imbalance") < 1e-5);
}

#[test]
fn an_arm_with_friction_falls_and_comes_to_rest_within_its_bounds() {
    let motion = Motion::of("arm", &["--end", "8"]);
    let kinetic = motion.column("kinetic_energy");
    assert!(kinetic[kinetic.len() - 1] < 1e-3 * largest(&kinetic), "{}", kinetic[kinetic.len() - 1]);
    assert!(motion.number("energy", "dissipated") < -1.0);
    // ½ k x², if all kinetic energy went into one stop, plus the work of the weight.
    let depth = 1.2 * (2.0 * largest(&kinetic) / 2e3).sqrt();
    let model = articulated_models::robot("panda_like").unwrap();
    let model = articulated::load_bytes("panda_like.urdf", model.urdf.as_bytes(), model.base).unwrap();
    for joint in model.joints() {
        let limit = joint.limit.unwrap();
        let q = motion.column(&format!("q.{}", joint.name));
        assert!(q.iter().all(|q| *q > limit.lower - depth && *q < limit.upper + depth), "{}", joint.name);
    }
}

/// A free head would give (1 + e)/(1 + m_b/m_h) = 1.49 of its speed; with the shaft behind it a
/// little more, a wall 1 + e.
#[test]
fn a_golf_ball_leaves_faster_than_the_head_that_hits_it() {
    let motion = Motion::of("golf_swing", &["--generated", "--every", "0.01"]);
    let hit = &motion.summary["events"][0];
    let time = hit["time"].as_f64().unwrap();
    let what = hit["what"].as_str().unwrap();
    let speed: f64 = what.split("leaves at ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(speed > 40.0 && speed < 80.0 && time > 0.1, "{what} at {time}");
    // The impulse m_b v_ball equals the loss of all others along y: weight and feet contribute some
    // tenths of 1e-3 N·s in the microsecond around.
    let toml = articulated_models::scene("golf_swing").unwrap().toml;
    let around = toml.replace("output = 2e-3", &format!("output = [0.0, {:?}, {:?}]", time - 5e-7, time + 5e-7));
    assert_ne!(toml, around);
    let blow = Motion::of(File::new("around.toml", around.as_bytes()).name(), &["--generated"]);
    let y = blow.column("momentum.linear.y");
    let lost = y[1] - y[2];
    assert!((0.04593 * speed - lost).abs() < 1e-3 * 0.04593 * speed, "{lost} N·s for {}", 0.04593 * speed);
    // The energy taken by the blow is in the balance, and exceeds the ball's gain.
    let (taken, ball) = (-motion.number("energy", "from_events"), motion.number("energy", "ball"));
    assert!((ball - 0.5 * 0.04593 * speed * speed).abs() < 1e-3 * ball && taken > ball, "{taken} J, {ball} J");
    assert!(motion.number("energy", "relative_imbalance") < 1e-8, "{}", motion.number("energy", "relative_imbalance"));
    assert_eq!(blow.column("from_events").iter().map(|e| *e < 0.0).collect::<Vec<_>>(), [false, false, true]);
}

/// The bob comes down at once and passes the lowest point forth and back: one blow there. A ball
/// faster than the bob is not hit.
#[test]
fn a_ball_is_hit_once_and_only_by_what_moves_towards_it() {
    let file = File::new("pendulum.urdf", articulated_models::robot("simple_pendulum").unwrap().urdf.as_bytes());
    let events = |impact: &str| {
        let text = format!(
            "urdf = {:?}\n[initial]\nq = [1.0]\n[simulation]\nend = 4.0\n[impact]\nlink = \"bob\"\nnormal = [1, 0, 0]\n\
             mass = 0.1\nrestitution = 1.0\n{impact}\n",
            file.name()
        );
        let scene = File::new("ball.toml", text.as_bytes());
        let motion = Motion::of(scene.name(), &[]);
        let told = motion.summary["events"].as_array().unwrap().iter().map(|e| e["what"].as_str().unwrap().to_owned());
        let speed = motion.summary["ball_speed_m_per_s"].as_f64();
        assert_eq!(motion.summary["events"][0]["ball_speed_m_per_s"].as_f64(), speed);
        (told.collect::<Vec<_>>(), motion.summary["energy"]["ball"].clone(), speed.unwrap())
    };
    let (hit, got, speed) = events("point = [0, 0, -1]\nball = [0, 0, -1]");
    assert!(hit.len() == 1 && hit[0].starts_with("bob hits the ball, which leaves at"), "{hit:?}");
    assert!(got.as_f64().unwrap() > 0.1 && hit[0].ends_with(&format!(" {speed:.4} m/s")), "{got} {speed} {hit:?}");
    let (missed, got, speed) = events("time = 0.05\nball_speed = 40.0");
    assert_eq!(speed, 40.0);
    assert_eq!((missed, got.is_null()), (vec!["bob is not moving towards the ball, which keeps 40.0000 m/s".to_owned()], true));
}

/// A pendulum without weight that turns at 2 rad/s, its bob a metre below the hinge: the ball is
/// hit at its place or at its time, also at the start; the changed motion is reported even if the
/// blow ends it.
#[test]
fn a_ball_is_hit_at_the_start_and_not_outside_of_the_motion() {
    let file = File::new("pendulum.urdf", articulated_models::robot("simple_pendulum").unwrap().urdf.as_bytes());
    let scene = |q: f64, impact: &str| {
        let text = format!(
            "urdf = {:?}\ngravity = [0, 0, 0]\n[initial]\nq = [{q}]\nv = [2.0]\n[simulation]\nend = 1.0\n[impact]\nlink = \"bob\"\n\
             normal = [-1, 0, 0]\npoint = [0, 0, -1]\nmass = 0.1\nrestitution = 0.7\n{impact}\n",
            file.name()
        );
        File::new("ball.toml", text.as_bytes())
    };
    let hit = |q: f64, impact: &str| {
        let motion = Motion::of(scene(q, impact).name(), &[]);
        let times: Vec<f64> = motion.summary["events"].as_array().unwrap().iter().map(|e| e["time"].as_f64().unwrap()).collect();
        (times, motion.summary["ball_reached"].as_bool(), motion.number("energy", "from_events"), motion.number("energy", "kinetic_end"))
    };
    // By time at the start, and by place where the point starts.
    for (q, impact) in [(-0.1, "time = 0.0"), (0.0, "ball = [0, 0, -1]")] {
        let (times, reached, ..) = hit(q, impact);
        assert!(times.len() == 1 && times[0].abs() < 1e-9 && reached == Some(true), "{impact}: {times:?} {reached:?}");
    }
    let (times, reached, brought, kinetic) = hit(-0.1, "time = 0.5\nstop = true");
    let before = hit(-0.1, "ball = [9, 0, 0]");
    assert_eq!((times.as_slice(), reached), (&[0.5][..], Some(true)));
    assert!(brought < 0.0 && (kinetic - before.3 - brought).abs() < 1e-9, "{kinetic} J, {brought} J");
    assert_eq!((before.0, before.1), (vec![], Some(false)));
    for time in ["-1.0", "1.0", "2.0"] {
        let ended = run(&["simulate", scene(-0.1, &format!("time = {time}")).name()]);
        let told = format!("impact.time: found {time}, expected a time from 0.0 s on and before 1.0 s");
        assert!(ended.status == 1 && ended.err.contains(&told), "{}", ended.err);
    }
}

#[test]
fn a_start_beyond_a_limit_is_told_and_used() {
    let urdf = articulated_models::robot("cart_pole").unwrap().urdf;
    let file = File::new("cart_pole.urdf", urdf.as_bytes());
    let warned = |q: &str| {
        let text = format!("urdf = {:?}\n[initial]\nq = {q}\n[simulation]\nend = 0.01\n", file.name());
        let scene = File::new("start.toml", text.as_bytes());
        let ended = run(&["simulate", scene.name()]);
        assert_eq!(ended.status, 0, "{}", ended.err);
        ended.lines_with("beyond its limits")
    };
    assert_eq!([warned("[0.0, 0.0]"), warned("[50.0, 0.0]"), warned("[-50.0, 0.0]")], [0, 1, 1]);
}

#[test]
fn an_event_of_what_the_scene_has_not_is_told() {
    let urdf = articulated_models::robot("cart_pole").unwrap().urdf;
    let file = File::new("cart_pole.urdf", urdf.as_bytes());
    let text = format!("urdf = {:?}\n[simulation]\nend = 0.01\nevents = [\"limits\", \"contacts\", \"stick_slip\"]\n", file.name());
    let ended = run(&["simulate", File::new("events.toml", text.as_bytes()).name()]);
    let told = |what: &str| ended.lines_with(&format!("simulation.events: found {what:?}, expected an effect"));
    assert_eq!((ended.status, told("limits"), told("contacts"), told("stick_slip")), (0, 0, 1, 1), "{}", ended.err);
}

#[test]
fn a_quadruped_comes_to_rest_where_the_ground_holds_its_weight() {
    let motion = Motion::of("quadruped_drop", &["--every", "0.1"]);
    assert_eq!(motion.summary["events"].as_array().unwrap().len(), 4);
    assert!(motion.number("energy", "kinetic_end") < 1e-4);
    // ΣF − m g is the rate of momentum: zero, relative to a weight of 883 N.
    let p = motion.column("momentum.linear.z");
    let rate = (p[p.len() - 1] - p[p.len() - 6]) / 0.5;
    assert!(rate.abs() < 1e-3 * 883.0, "{rate} N");
    let height = motion.column("q.__floating_base__[2]");
    assert!(height.iter().all(|z| *z > 0.3) && height[0] > height[height.len() - 1]);
}

#[test]
fn a_humanoid_without_weight_turns_without_momentum() {
    let motion = Motion::of("humanoid_float", &["--generated", "--every", "0.5"]);
    let change = motion.summary["momentum"]["largest_change_angular"].as_f64().unwrap();
    let linear = motion.summary["momentum"]["largest_change_linear"].as_f64().unwrap();
    assert!(change < 1e-10 && linear < 1e-10, "{change} {linear}");
    // The quaternion of the base: the cosine of half the angle that it was turned by.
    let w = motion.last("q.__floating_base__[6]")[0];
    let angle = 2.0 * w.abs().min(1.0).acos();
    assert!(angle > 0.05, "turned by {angle} rad");
}

#[test]
fn an_arm_under_water_only_loses_energy() {
    let motion = Motion::of("underwater_arm", &["--every", "0.25"]);
    let energy: Vec<f64> = motion.column("kinetic_energy").iter().zip(motion.column("potential_energy")).map(|(t, u)| t + u).collect();
    assert!(energy.windows(2).all(|e| e[1] < e[0]), "{energy:?}");
    assert!(motion.number("energy", "relative_imbalance") < 1e-6);
}

#[test]
fn a_top_goes_round_steadily() {
    let motion = Motion::of("spinning_top", &["--every", "0.0628318530717959"]);
    for (i, time) in motion.column("t").into_iter().enumerate() {
        let [x, y, z, w]: [f64; 4] = motion.at(i, "q.point").try_into().unwrap();
        // The axis of the top in the base: at cos θ = 0.8, and turned by 10 rad/s.
        let axis = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)];
        let turned = 10.0 * time;
        let expected = [0.6 * turned.cos(), 0.6 * turned.sin(), 0.8];
        let off = largest(&[0, 1, 2].map(|k| axis[k] - expected[k]));
        assert!(off < 1e-9, "off by {off} at {turned} rad");
    }
}

#[test]
fn a_t_handle_flips_a_hundred_times_and_turns_as_before() {
    let motion = Motion::of("t_handle", &[]);
    let v = motion.column("v.__floating_base__[0]");
    assert_eq!(v.windows(2).filter(|w| w[0] * w[1] < 0.0).count(), 100);
    let (first, last) = (motion.at(0, "v.__"), motion.last("v.__"));
    let off = first.iter().zip(&last).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(off < 1e-9 * 20.0, "{off} rad/s after a hundred flips");
}
