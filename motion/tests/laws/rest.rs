//! Statistics over the steps of a motion, and contacts at rest.

use articulated_motion::Outcome;

use super::{moved, session};

/// A hinge about y of 2 kg·m² (1 kg at 1.4142 m, no more).
const HINGE: &str = r#"<robot name="hinge"><link name="base"/>
    <link name="bob"><inertial><mass value="1"/><inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="2"/></inertial></link>
    <joint name="h" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;

/// A box of 2 kg, 0.2 m.
const BOX: &str = r#"<robot name="box"><link name="box"><inertial><mass value="2"/>
    <inertia ixx="0.0133333" iyy="0.0133333" izz="0.0133333" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>"#;

const BALL: &str = r#"<robot name="ball"><link name="ball"><inertial><mass value="3"/>
    <inertia ixx="0.0108" iyy="0.0108" izz="0.0108" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.09"/></geometry></collision></link></robot>"#;

/// A hinge of 5 N·m of dry friction under 3 N·m.
fn held(output: &str) -> String {
    format!(
        "effects = {{ friction = {{ h = 5.0 }} }}\ngravity = [0, 0, 0]\ncontrol = {{ kind = 'torque', torque = {{ h = 3.0 }} }}
        simulation = {{ end = 8.0, output = {output} }}"
    )
}

/// The box on a slope of 24°, from 2 mm above it or on it. `law` is the law of its contacts.
fn slope(height: f64, law: &str, simulation: &str) -> String {
    let (sine, cosine) = 24_f64.to_radians().sin_cos();
    format!(
        "base = 'floating'\ngravity = [{}, 0.0, {}]
        [effects.contact]\nfrom = 'collision'\nstiffness = 1e5\nfriction = 0.6\n{law}
        [initial.base]\nxyz = [0.0, 0.0, {height}]
        [simulation]\n{simulation}\n",
        9.81 * sine,
        -9.81 * cosine
    )
}

/// The outputs do not change the statistics: creep and depths are those of the steps.
#[test]
fn creep_is_the_same_whatever_is_recorded() {
    let outputs = ["'ends'", "4.0", "0.3", "0.01", "'steps'"];
    let creep = |outcome: &Outcome| {
        let [creep] = &outcome.creep[..] else { panic!("{:?}", outcome.creep) };
        (creep.distance, creep.time)
    };
    // A joint: s x/√(1 − x²) with x = 3/5, for 8 s.
    let joint = outputs.map(|output| creep(&moved(&session(&held(output), HINGE))));
    assert!(joint.iter().all(|other| *other == joint[0]), "{joint:?}");
    assert!((joint[0].0 / (1e-5 * 0.75 * 8.0) - 1.0).abs() < 1e-3 && joint[0].1 > 7.99, "{joint:?}");
    // A box that lands on a slope and rests.
    let lands = |output: &str| slope(0.102, "damping_time = 5e-3", &format!("end = 1.0\noutput = {output}"));
    let contact = outputs.map(|output| creep(&moved(&session(&lands(output), BOX))));
    assert!(contact.iter().all(|other| *other == contact[0]) && contact[0].0 > 5e-6, "{contact:?}");
}

/// A damper of 4·10⁵ N·m·s on 2 kg·m² stops within 5 µs: one step of 20 ms goes over it. All of the
/// kinetic energy is lost, and the hinge turns by I v/d.
#[test]
fn a_step_over_a_stiff_layer_loses_the_energy_that_there_is() {
    let scene = |damping: f64, control: &str| {
        format!(
            "gravity = [0, 0, 0]\ninitial = {{ v = {{ h = 3.0 }} }}\neffects = {{ damping = {{ h = {damping:?} }} }}\n{control}
            simulation = {{ end = 0.2, integrator = 'rodas4', step = 0.02 }}"
        )
    };
    let energies = |outcome: &Outcome| {
        let (balance, last) = (outcome.recording.balance.unwrap(), outcome.recording.len() - 1);
        (outcome.recording.work[last], outcome.recording.dissipated[last], balance.largest_imbalance, outcome.recording.counts.layers)
    };
    let outcome = moved(&session(&scene(4e5, ""), HINGE));
    assert!((outcome.recording.q_at(outcome.recording.len() - 1)[0] / 1.5e-5 - 1.0).abs() < 1e-6);
    let (work, dissipated, lacks, layers) = energies(&outcome);
    assert!((dissipated + 9.0).abs() < 1e-9 && work.abs() < 1e-12 && lacks < 1e-9 && (1..5).contains(&layers), "{:?}", energies(&outcome));
    // The same layer by a control: its torque does the work. A parallel damper dissipates a part.
    let kd = "control = { kind = 'pd', kd = 3e5, target = {} }";
    let outcome = moved(&session(&scene(0.0, kd), HINGE));
    let (work, dissipated, lacks, layers) = energies(&outcome);
    assert!((work + 9.0).abs() < 1e-6 && dissipated.abs() < 1e-6 && lacks < 1e-6 && layers >= 1, "{:?}", energies(&outcome));
    let (work, dissipated, lacks, layers) = energies(&moved(&session(&scene(1e5, kd), HINGE)));
    assert!(
        (work + 6.75).abs() < 1e-3 && (dissipated + 2.25).abs() < 1e-3 && lacks < 1e-6 && layers >= 1,
        "{work} {dissipated} {lacks} {layers}"
    );
    // Slow motion through stiff friction has no layer, though h·λ is large, nor has a step that
    // resolves the decay.
    let creeping = moved(&session(&held("'ends'"), HINGE));
    assert_eq!(creeping.recording.counts.layers, 0);
    let (_, dissipated, lacks, layers) = energies(&moved(&session(&scene(20.0, ""), HINGE)));
    assert!(layers == 0 && lacks < 1e-4 && (dissipated + 9.0 * (1.0 - (-4.0_f64).exp())).abs() < 1e-3, "{dissipated} {lacks} {layers}");
}

/// tan 24° = 0.445 of μ = 0.6: the cone holds. A contact that is not damped under its load walks.
#[test]
fn a_box_rests_on_a_slope_that_its_friction_holds() {
    let end = |outcome: &Outcome| {
        assert_eq!(outcome.error, None);
        let q = outcome.recording.q_at(outcome.recording.len() - 1);
        (q[0], q[2])
    };
    let rest = 0.1 - 2.0 * 9.81 * 24_f64.to_radians().cos() / 4e5;
    for (height, allowed) in [(0.1, 1e-4), (0.102, 2e-3)] {
        let outcome = moved(&session(&slope(height, "damping_time = 5e-3", "end = 2.0\noutput = 'ends'"), BOX));
        let (x, z) = end(&outcome);
        assert!(x > 0.0 && x < allowed && (z - rest).abs() < 1e-8, "{x} {z}");
        assert_eq!(outcome.slides, []);
    }
    let outcome = moved(&session(&slope(0.1, "damping = 1.0", "end = 1.5\noutput = 'ends'"), BOX));
    let (x, _) = end(&outcome);
    let [slide] = &outcome.slides[..] else { panic!("{x} {:?}", outcome.slides) };
    assert!(slide.on == "box" && slide.distance > 0.25 * x && slide.distance < 1.1 * x && x > 1e-2, "{slide:?} {x}");
    // The friction that the slope needs, and 2 √(m/k).
    let needed = 24_f64.to_radians().tan() / 0.6;
    assert!((slide.part / needed - 1.0).abs() < 0.2, "{slide:?} {needed}");
    assert!(slide.damping_time > 2e-3 && slide.damping_time < 1e-2, "{slide:?}");
    let told = slide.to_string();
    assert!(
        told.starts_with("s.toml: effects.contact.box: slides although its cone holds: found ") && told.contains("damping_time = "),
        "{told}"
    );
}

/// A box beyond its friction cone slides with its full friction, which is correct.
#[test]
fn a_box_that_slides_with_all_its_friction_is_not_told() {
    let outcome =
        moved(&session(&slope(0.1, "damping_time = 5e-3", "end = 1.0\noutput = 'ends'").replace("friction = 0.6", "friction = 0.3"), BOX));
    let x = outcome.recording.q_at(outcome.recording.len() - 1)[0];
    let (sine, cosine) = 24_f64.to_radians().sin_cos();
    assert!((x / (0.5 * 9.81 * (sine - 0.3 * cosine)) - 1.0).abs() < 1e-2, "{x}");
    assert_eq!(outcome.slides, []);
}

/// It rolls at 4 m/s: the tolerance of its rates, 10⁻⁶ of two times that, is more than 10⁻⁵ m/s.
#[test]
fn a_ball_that_rolls_faster_than_the_tolerance_resolves_is_told() {
    let scene = |simulation: &str, speed: &str| {
        format!(
            "base = 'floating'\n[effects.contact]\nfrom = 'collision'\nstiffness = 1e6\ndamping_time = 1e-3\nfriction = 0.3\n{speed}
            [initial.base]\nxyz = [0.0, 0.0, 0.08997057]\nlinear = [4.0, 0.0, 0.0]\nangular = [0.0, 44.44444444444444, 0.0]
            [simulation]\nend = 0.02\noutput = 'ends'\n{simulation}\n"
        )
    };
    let told = |simulation: &str, speed: &str| moved(&session(&scene(simulation, speed), BALL)).rolling;
    let [rolling] = &told("", "")[..] else { panic!("none") };
    assert!((rolling.rates - 8.0).abs() < 0.01 && (rolling.tolerance / (8e-6 * 12_f64.sqrt()) - 1.0).abs() < 0.01, "{rolling:?}");
    let text = rolling.to_string();
    assert!(
        text.starts_with("s.toml: effects.contact.ball.speed: found 1e-5 m/s, which rtol = 1e-6 does not resolve where it rolls at 4"),
        "{text}"
    );
    assert_eq!(
        (told("rtol = 1e-8", ""), told("", "speed = 1e-3"), told("integrator = 'rodas4'\nstep = 1e-4", "")),
        (vec![], vec![], vec![])
    );
}
