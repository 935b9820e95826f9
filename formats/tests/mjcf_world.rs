//! MJCF: content of a file besides its robot.

use articulated_core::description::JointId;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_core::actuator::Terms;
use articulated_core::diagnostic::{At, Code};
use articulated_formats::world::{Actuator, OnFrames, TouchingLaw, TouchingLength, World};
use articulated_formats::{Options, Reading, Sources, read, read_with};

fn options() -> Options {
    Options { file: "arm.xml".to_owned(), ..Options::default() }
}

fn accepted(text: &str) -> Reading {
    read(text.as_bytes(), &options()).unwrap_or_else(|found| panic!("{found}\n{text}"))
}

/// An arm with a slide `x` (ref 0.5), a hinge `h` (ref 90°) and a ball `b`; line 6 is `rest`.
fn with(head: &str, rest: &str) -> String {
    format!(
        "<mujoco>{head}<worldbody>\n<body><joint name=\"x\" type=\"slide\" ref=\"0.5\" range=\"-1 3\" actuatorfrcrange=\"-4 5\"/><geom size=\"1\"/>\n\
         <body><joint name=\"h\" ref=\"90\" springref=\"90\" range=\"-90 90\"/><geom size=\"1\"/>\n\
         <body><joint name=\"b\" type=\"ball\"/><geom size=\"1\"/></body></body></body>\n\
         </worldbody>\n{rest}\n</mujoco>"
    )
}

fn world(rest: &str) -> World {
    accepted(&with("", rest)).world
}

fn actuators(tags: &str) -> Vec<Actuator> {
    world(&format!("<actuator>{tags}</actuator>")).actuators
}

fn actuator(tag: &str) -> Actuator {
    let all = actuators(tag);
    assert_eq!(all.len(), 1, "{tag}");
    all[0].clone()
}

/// The law of an actuator on `h` with these defaults.
fn law(defaults: &str, tag: &str) -> ([f64; 3], [f64; 3]) {
    let text = with(&format!("<default>{defaults}</default>"), &format!("<actuator>{tag}</actuator>"));
    let all = accepted(&text).world.actuators;
    assert_eq!(all.len(), 1, "{text}");
    (all[0].gain, all[0].bias)
}

fn drive(name: &str, gear: &[f64]) -> (String, Vec<f64>) {
    (name.to_owned(), gear.to_vec())
}

#[test]
fn options_are_those_of_a_simulation() {
    let option = |text: &str| accepted(&with(text, "")).world;
    let found = option("<option gravity=\"1 2 -3\" timestep=\"0.004\"/><option integrator=\"RK4\"/>");
    assert_eq!((found.gravity, found.step, found.integrator.as_deref()), (Some([1.0, 2.0, -3.0]), Some(0.004), Some("RK4")));
    let found = option("");
    assert_eq!((found.gravity, found.step, found.integrator), (None, None, None));
    assert_eq!(option("<option gravity=\"1 2 -3\"><flag gravity=\"disable\"/></option>").gravity, Some([0.0; 3]));
    for wrong in ["timestep=\"0\"", "integrator=\"euler\"", "gravity=\"1 2\""] {
        let found = read(with(&format!("\n<option {wrong}/>"), "").as_bytes(), &options()).unwrap_err();
        assert_eq!((found.errors.len(), found.errors[0].line()), (1, Some(2)), "{found}");
    }
}

#[test]
fn a_motor_has_a_gear_and_bounds() {
    let found = actuator("<motor name=\"m\" joint=\"x\" gear=\"-3\" ctrlrange=\"-1 2\" forcerange=\"-7 8\"/>");
    assert_eq!((found.name.as_str(), found.drives), ("m", vec![drive("x", &[-3.0])]));
    assert_eq!((found.gain, found.bias), ([1.0, 0.0, 0.0], [0.0; 3]));
    assert_eq!((found.control_range, found.force_range), (Some([-1.0, 2.0]), Some([-7.0, 8.0])));
    assert_eq!(found.place.line(), Some(6));
    let found = actuator("<motor jointinparent=\"h\" ctrlrange=\"-1 2\" ctrllimited=\"false\"/>");
    assert_eq!((found.name.as_str(), found.control_range, found.drives), ("actuator_0", None, vec![drive("h", &[1.0])]));
    let found = actuator("<motor joint=\"b\" gear=\"1 2 3\"/>");
    assert_eq!(found.drives, [drive("b", &[1.0, 2.0, 3.0])]);
}

#[test]
fn shortcuts_are_affine_laws() {
    let laws = [
        ("<position joint=\"h\" kp=\"5\" kv=\"2\"/>", [5.0, 0.0, 0.0], [0.0, -5.0, -2.0]),
        ("<position joint=\"h\"/>", [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
        ("<velocity joint=\"h\" kv=\"3\"/>", [3.0, 0.0, 0.0], [0.0, 0.0, -3.0]),
        ("<damper joint=\"h\" kv=\"4\" ctrlrange=\"0 1\"/>", [0.0, 0.0, -4.0], [0.0; 3]),
        (
            "<general joint=\"h\" gaintype=\"affine\" gainprm=\"1 2 3\" biastype=\"affine\" biasprm=\"4 5 6\"/>",
            [1.0, 2.0, 3.0],
            [4.0, 5.0, 6.0],
        ),
        ("<general joint=\"h\" gainprm=\"1 2 3\" biasprm=\"4 5 6\"/>", [1.0, 0.0, 0.0], [0.0; 3]),
    ];
    for (tag, gain, bias) in laws {
        assert_eq!(law("", tag), (gain, bias), "{tag}");
    }
    assert_eq!(actuator("<damper joint=\"h\" kv=\"4\" ctrlrange=\"0 1\"/>").control_range, Some([0.0, 1.0]));
}

#[test]
fn activations_of_first_order_are_read() {
    use articulated_core::actuator::{Activation, Filter};
    let state = |filter, range, is_early| Some(Activation { filter, range, is_early });
    let found = actuator("<intvelocity joint=\"h\" kp=\"5\" kv=\"2\" actrange=\"-1 1\"/>");
    assert_eq!((found.gain, found.bias), ([5.0, 0.0, 0.0], [0.0, -5.0, -2.0]));
    assert_eq!(found.activation, state(Filter::Integrator, Some([-1.0, 1.0]), false));
    let found = actuator("<position joint=\"h\" kp=\"5\" timeconst=\"0.1\"/>");
    assert_eq!((found.gain, found.activation), ([5.0, 0.0, 0.0], state(Filter::Exact(0.1), None, false)));
    let found = actuator("<cylinder joint=\"h\" diameter=\"2\" timeconst=\"0.2\" bias=\"1 2 3\"/>");
    assert_eq!((found.gain, found.bias), ([2.0 * FRAC_PI_2, 0.0, 0.0], [1.0, 2.0, 3.0]));
    assert_eq!(found.activation, state(Filter::Euler(0.2), None, false));
    let found =
        actuator("<general joint=\"h\" dyntype=\"filter\" dynprm=\"0.3\" actearly=\"true\" actrange=\"0 1\" actlimited=\"false\"/>");
    assert_eq!(found.activation, state(Filter::Euler(0.3), None, true));
    assert_eq!(actuator("<motor joint=\"h\"/>").activation, None);
}

/// Armature of an actuator on one joint is that of the joint: I gear².
#[test]
fn armature_of_an_actuator_is_that_of_its_joint() {
    let text = with("", "<actuator><motor joint=\"h\" gear=\"3\" armature=\"0.5\"/><motor joint=\"h\" armature=\"2\"/></actuator>");
    let reading = accepted(&text);
    let joint = reading.description.joints.iter().find(|joint| joint.name == "h").expect("the hinge");
    let without = accepted(&with("", "")).description;
    let before = without.joints.iter().find(|joint| joint.name == "h").and_then(|joint| joint.dynamics.armature).unwrap_or(0.0);
    assert_eq!(joint.dynamics.armature, Some(before + 0.5 * 9.0 + 2.0));
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
}

#[test]
fn an_actuator_may_push_a_site() {
    let sites = "<site name=\"s\" pos=\"1 2 3\"/></worldbody>";
    let text = with("", "<actuator><motor site=\"s\" gear=\"1 2 3 4 5 6\"/><motor site=\"s\" refsite=\"own\"/></actuator>")
        .replace("</worldbody>", sites)
        .replace("<joint name=\"h\"", "<site name=\"own\" pos=\"0 0 1\"/><joint name=\"h\"");
    let reading = accepted(&text);
    let all = &reading.world.actuators;
    assert!(reading.warnings.is_empty() && all.len() == 2 && all.iter().all(|own| own.drives.is_empty()), "{:?}", reading.warnings);
    let [Some(OnFrames::Site(site)), Some(OnFrames::Site(moved))] = [0, 1].map(|k| &all[k].frames) else { panic!("{all:?}") };
    assert_eq!(
        (site.at.0.as_str(), site.at.1.xyz, site.gear, &site.reference),
        ("world", [1.0, 2.0, 3.0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], &None)
    );
    let (link, at) = moved.reference.as_ref().expect("a reference");
    assert_eq!((reading.description.links.iter().any(|own| own.name == *link), at.xyz), (true, [0.0, 0.0, 1.0]));
    assert_eq!(moved.gear, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn the_law_comes_from_a_default_of_the_same_kind_or_of_general() {
    let servo = "<position joint=\"h\"/>";
    assert_eq!(law("<position kp=\"5\" kv=\"2\"/>", servo), ([5.0, 0.0, 0.0], [0.0, -5.0, -2.0]));
    assert_eq!(law("<velocity kv=\"5\"/>", servo), ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0]));
    assert_eq!(law("<general gainprm=\"3\"/>", servo), ([3.0, 0.0, 0.0], [0.0, -3.0, 0.0]));
    assert_eq!(law("<position kp=\"5\"/>", "<motor joint=\"h\"/>"), ([1.0, 0.0, 0.0], [0.0; 3]));
    assert_eq!(law("<position kp=\"5\" kv=\"2\"/>", "<general joint=\"h\"/>"), ([5.0, 0.0, 0.0], [0.0, -5.0, -2.0]));
    // The nearest class that has one
    let nested =
        "<position kp=\"5\"/><default class=\"a\"><velocity kv=\"3\"/><default class=\"c\"><motor gear=\"2\"/></default></default>";
    assert_eq!(law(nested, "<position joint=\"h\" class=\"c\"/>"), ([5.0, 0.0, 0.0], [0.0, -5.0, 0.0]));
    assert_eq!(law(nested, "<velocity joint=\"h\" class=\"c\"/>"), ([3.0, 0.0, 0.0], [0.0, 0.0, -3.0]));
    // Numbers of an unsupported kind are not used.
    let text =
        with("<default><adhesion gain=\"5\"/><general biastype=\"none\"/></default>", "<actuator><velocity joint=\"h\"/></actuator>");
    assert_eq!(accepted(&text).world.actuators, []);
    // Gear and bounds apply to any kind.
    let text = with("<default><motor gear=\"4\" ctrlrange=\"-1 1\"/></default>", "<actuator><velocity joint=\"h\"/></actuator>");
    let found = &accepted(&text).world.actuators[0];
    assert_eq!((&found.drives, found.control_range), (&vec![drive("h", &[4.0])], Some([-1.0, 1.0])));
}

#[test]
fn a_range_is_inherited_from_the_joint() {
    let found = actuator("<position joint=\"h\" inheritrange=\"0.5\"/>");
    assert_eq!(found.control_range, Some([-FRAC_PI_2 / 2.0, FRAC_PI_2 / 2.0]));
    let found = actuator("<position joint=\"x\" inheritrange=\"1.5\"/>");
    assert_eq!(found.control_range, Some([-2.0, 4.0]));
    // A range that is inherited replaces that of the defaults, also for other kinds.
    let defaults = "<default><motor ctrlrange=\"0 9\"/><default class=\"a\"><position inheritrange=\"1\"/></default></default>";
    let found = accepted(&with(defaults, "<actuator><motor joint=\"x\" class=\"a\"/><velocity joint=\"x\"/></actuator>")).world.actuators;
    assert_eq!((found[0].control_range, found[1].control_range), (None, Some([0.0, 9.0])));
    // The nearer one counts.
    let ranges = [
        ("<position inheritrange=\"1\"/>", "ctrlrange=\"0 9\"", [0.0, 9.0]),
        ("<motor ctrlrange=\"0 9\"/>", "inheritrange=\"1\"", [-1.0, 3.0]),
    ];
    for (default, own, expected) in ranges {
        let text = with(&format!("<default>{default}</default>"), &format!("<actuator><position joint=\"x\" {own}/></actuator>"));
        assert_eq!(accepted(&text).world.actuators[0].control_range, Some(expected));
    }
}

#[test]
fn a_ratio_of_damping_is_of_the_mass_that_the_actuator_feels() {
    // A point on a rod: m = 2 (0.5² + 2/5 0.1²) + 0.3; b₂ = −2 ζ √(kp m)
    let text = "<mujoco><worldbody><body><joint name=\"j\" axis=\"0 1 0\" armature=\"0.3\"/><geom size=\"0.1\" mass=\"2\" pos=\"0 0 0.5\"/></body></worldbody>
        <actuator><position joint=\"j\" kp=\"7\" dampratio=\"0.6\" gear=\"2\"/></actuator></mujoco>";
    let found = &accepted(text).world.actuators[0];
    let mass = (2.0 * (0.25 + 0.4 * 0.01) + 0.3) / 4.0;
    assert!((found.bias[2] + 2.0 * 0.6 * f64::sqrt(7.0 * mass)).abs() < 1e-13, "{found:?}");
}

#[test]
fn an_actuator_of_a_fixed_tendon_drives_its_joints() {
    let found = world(
        "<tendon><fixed name=\"t\"><joint joint=\"x\" coef=\"2\"/><joint joint=\"h\" coef=\"-0.5\"/></fixed></tendon><actuator><motor tendon=\"t\" gear=\"3\"/></actuator>",
    );
    assert_eq!(found.actuators[0].drives, [drive("x", &[6.0]), drive("h", &[-1.5])]);
    assert_eq!(found.passive, []);
}

#[test]
fn springs_of_tendons_are_actuators_without_gain() {
    let tendon = |attributes: &str| {
        world(&format!(
            "<tendon><fixed name=\"t\" {attributes}><joint joint=\"x\" coef=\"2\"/><joint joint=\"h\" coef=\"-0.5\"/></fixed></tendon>"
        ))
        .passive
    };
    // f = −4 (l − 0.3) − 0.5 l̇
    let found = tendon("stiffness=\"4\" damping=\"0.5\" springlength=\"0.3\"");
    assert_eq!((found[0].name.as_str(), found[0].gain, found[0].bias), ("t", [0.0; 3], [1.2, -4.0, -0.5]));
    assert_eq!(found[0].drives, [drive("x", &[2.0]), drive("h", &[-0.5])]);
    // At rest x is 0 and h is π/2.
    assert_eq!(tendon("stiffness=\"4\"")[0].bias, [-FRAC_PI_2 * 2.0, -4.0, 0.0]);
    assert_eq!(tendon("stiffness=\"0\""), []);
    // A spring that is slack between two lengths pushes below the first and pulls above the second.
    let found = tendon("stiffness=\"4\" damping=\"0.5\" springlength=\"0.3 0.7\"");
    let laws: Vec<_> = found.iter().map(|law| (law.bias, law.force_range)).collect();
    let (push, pull) = (Some([0.0, f64::INFINITY]), Some([f64::NEG_INFINITY, 0.0]));
    assert_eq!(laws, [([0.0, 0.0, -0.5], None), ([1.2, -4.0, 0.0], push), ([2.8, -4.0, 0.0], pull)]);
    // Terms of higher degree are a law of their own.
    let found = tendon("stiffness=\"4 5 6\" damping=\"0.5 0 2\" springlength=\"0.3 0.7\"");
    let terms = Terms { rest: [0.3, 0.7], stiffness: [5.0, 6.0], damping: [0.0, 2.0] };
    assert_eq!((found.len(), found[3].bias, &found[3].terms), (4, [0.0; 3], &Some(terms)));
    assert_eq!(tendon("damping=\"0 1\"")[0].terms, Some(Terms { rest: [-FRAC_PI_2 * 0.5; 2], stiffness: [0.0; 2], damping: [1.0, 0.0] }));
    // The damping of an actuator acts on its target.
    let found = world("<actuator><motor name=\"m\" joint=\"x\" gear=\"3\" damping=\"0.2\"/></actuator>").passive;
    assert_eq!((&found[0].drives, found[0].bias), (&vec![drive("x", &[3.0])], [0.0, 0.0, -0.2]));
}

/// k = m/(T ζ)² and d = 2 m/T, with the mass m = 1/(M⁻¹)ᵢᵢ of the joint where the file starts.
#[test]
fn a_springdamper_is_a_spring_and_a_damper() {
    let rod = |joint: &str, inside: &str| {
        format!("<body pos=\"0 0 1\"><joint {joint}/><inertial pos=\"0 0 0.5\" mass=\"2\" diaginertia=\"0.3 0.3 0.1\"/>{inside}</body>")
    };
    let joints = |world: &str| accepted(&format!("<mujoco><worldbody>{world}</worldbody></mujoco>")).description.joints;
    // About x: 0.3 + 2 · 0.5² + armature.
    let hinge = "axis=\"1 0 0\" armature=\"0.2\" springref=\"90\" stiffness=\"7\" springdamper=\"0.1 0.5\"";
    let found = joints(&rod(hinge, ""))[JointId(0)].dynamics;
    assert!((found.stiffness.unwrap() - 400.0).abs() < 1e-12 && (found.damping.unwrap() - 20.0).abs() < 1e-13, "{found:?}");
    assert_eq!((found.rest, found.armature), (Some(FRAC_PI_2), Some(0.2)));
    // For a ball, the mean of the diagonal of M⁻¹, over all three axes.
    let found = joints(&rod("type=\"ball\" springdamper=\"0.1 0.5\"", ""))[JointId(0)].dynamics;
    let mass = 3.0 / (2.0 / 0.8 + 1.0 / 0.1);
    assert!((found.stiffness.unwrap() - 400.0 * mass).abs() < 1e-11 && (found.damping.unwrap() - 20.0 * mass).abs() < 1e-12, "{found:?}");
    assert_eq!(found.rest, None);
    // Two hinges of one axis: M⁻¹ is that of a double pendulum, hanging straight.
    let inner = rod("axis=\"1 0 0\" springdamper=\"0.1 0.5\"", "");
    let found = joints(&rod("axis=\"1 0 0\"", &inner));
    let ([a, b, c], own) = ([0.8 + 0.3 + 2.0 * 1.5 * 1.5, 0.3 + 2.0 * 1.5 * 0.5, 0.8_f64], found[JointId(1)].dynamics.damping.unwrap());
    assert!((own - 20.0 * (a * c - b * b) / a).abs() < 1e-12, "{own}");
    assert_eq!(found[JointId(0)].dynamics.damping, None);
    // Both numbers have to be above zero.
    assert_eq!(joints(&rod("stiffness=\"7\" springdamper=\"0.1 0\"", ""))[JointId(0)].dynamics.stiffness, Some(7.0));
}

#[test]
fn equations_of_joints_are_couplings() {
    let coupling = |tags: &str| {
        let found = world(&format!(
            "<tendon><fixed name=\"t\"><joint joint=\"x\" coef=\"2\"/></fixed><fixed name=\"u\"><joint joint=\"h\" coef=\"4\"/></fixed>
             <fixed name=\"w\"><joint joint=\"x\" coef=\"2\"/><joint joint=\"h\" coef=\"4\"/></fixed></tendon><equality>{tags}</equality>"
        ));
        assert_eq!((found.couplings.len(), found.loops.len()), (1, 0), "{tags}");
        let own = &found.couplings[0].0;
        (own.joint.clone(), own.leaders.clone(), own.offset)
    };
    // x − 0.5 = 0.1 + 3 (h − π/2)
    let found = coupling("<joint joint1=\"x\" joint2=\"h\" polycoef=\"0.1 3\"/>");
    assert_eq!((found.0.as_str(), &found.1), ("x", &vec![("h".to_owned(), 3.0)]));
    assert!((found.2 - (0.6 - 3.0 * FRAC_PI_2)).abs() < 1e-15, "{found:?}");
    // 2 (x − 0.5) = 0.1 + 3 · 4 (h − π/2)
    let found = coupling("<tendon tendon1=\"t\" tendon2=\"u\" polycoef=\"0.1 3\"/>");
    assert_eq!((found.0.as_str(), &found.1), ("x", &vec![("h".to_owned(), 6.0)]));
    assert!((found.2 - (0.55 - 6.0 * FRAC_PI_2)).abs() < 1e-14, "{found:?}");
    // 2 (x − 0.5) + 4 (h − π/2) = 0.1
    let found = coupling("<tendon tendon1=\"w\" polycoef=\"0.1\"/>");
    assert_eq!((found.0.as_str(), &found.1), ("x", &vec![("h".to_owned(), -2.0)]));
    assert!((found.2 - (0.55 + 2.0 * FRAC_PI_2)).abs() < 1e-15, "{found:?}");
}

/// y − y₀ = Σ cₖ (x − x₀)ᵏ, of joints and of tendons of one joint each.
#[test]
fn equations_of_higher_degree_are_polynomial_couplings() {
    let coupling = |tags: &str| {
        let found = world(&format!(
            "<tendon><fixed name=\"t\"><joint joint=\"x\" coef=\"2\"/></fixed><fixed name=\"u\"><joint joint=\"h\" coef=\"4\"/></fixed></tendon>
             <equality>{tags}</equality>"
        ));
        assert_eq!((found.couplings.len(), found.loops.len()), (1, 0), "{tags}");
        found.couplings[0].0.clone()
    };
    let c = [0.1, 3.0, -0.5, 0.25, 0.125];
    let expected = |d: f64| c.iter().enumerate().map(|(k, c)| c * d.powi(k as i32)).sum::<f64>();
    for (tag, own, factor) in [("joint joint1=\"x\" joint2=\"h\"", 1.0, 1.0), ("tendon tendon1=\"t\" tendon2=\"u\"", 2.0, 4.0)] {
        let found = coupling(&format!("<{tag} polycoef=\"0.1 3 -0.5 0.25 0.125\"/>"));
        assert_eq!((found.joint.as_str(), found.leaders[0].0.as_str(), found.leaders.len()), ("x", "h", 1));
        let [c2, c3, c4] = found.higher;
        for h in [-0.4, 0.3, 1.9] {
            let x = found.offset + h * (found.leaders[0].1 + h * (c2 + h * (c3 + h * c4)));
            let by_hand = 0.5 + expected(factor * (h - FRAC_PI_2)) / own;
            assert!((x - by_hand).abs() < 1e-13 * (1.0 + factor.powi(4) * 20.0), "{tag} at {h}: {x}, {by_hand}");
        }
    }
}

#[test]
fn what_is_no_coupling_is_a_loop() {
    let tags = [
        ("<joint joint1=\"x\" joint2=\"x\" polycoef=\"0 1 2\"/>", "joint"),
        ("<joint joint1=\"x\"/>", "joint"),
        ("<connect body1=\"c\" body2=\"d\" anchor=\"0 0 0\"/>", "connect"),
        ("<weld body1=\"c\"/>", "weld"),
    ];
    for (tag, kind) in tags {
        let text = with("", &format!("<equality>\n{tag}\n</equality>"))
            .replace("</worldbody>", "<body name=\"c\"/><body name=\"d\"/></worldbody>");
        let reading = accepted(&text);
        assert_eq!((reading.world.couplings.len(), reading.world.loops.len()), (0, 1), "{tag}");
        assert_eq!(reading.world.loops[0].kind, kind);
        let lines: Vec<_> = reading.warnings.iter().map(|warning| (warning.code, warning.line())).collect();
        assert_eq!(lines, [(Code::LostDynamics, Some(7))], "{tag}");
        assert!(reading.unused.iter().any(|unused| (unused.line, unused.tag.as_str()) == (Some(7), kind)), "{tag}");
    }
    let off = accepted(&with("", "<equality><joint joint1=\"x\" joint2=\"h\" active=\"false\"/></equality>"));
    assert_eq!((off.world.couplings.len(), off.world.loops.len(), off.warnings.len()), (0, 0, 0));
    assert!(off.unused.iter().any(|unused| unused.tag == "joint" && unused.why.contains("not active")));
    let on = accepted(&with("", "<equality><joint joint1=\"x\" joint2=\"h\"/></equality>"));
    assert!(on.warnings[0].to_string().contains("coupling = \"file\""), "{}", on.warnings[0]);
}

#[test]
fn frames_that_are_held_together_have_their_places() {
    let bodies = "<site name=\"s\" pos=\"1 0 0\"/><body name=\"c\"/><body name=\"d\"><site name=\"t\"/></body></worldbody>";
    let anchors = |tags: &str| {
        let text = with("", &format!("<equality>{tags}</equality>")).replace("</worldbody>", bodies);
        accepted(&text).world.touching.expect("constraints").anchors
    };
    let found = anchors(
        "<connect body1=\"c\" body2=\"d\" anchor=\"1 2 3\"/><connect body1=\"c\" body2=\"world\" anchor=\"0 0 0\"/>
         <connect site1=\"s\" site2=\"t\"/><weld body1=\"d\" anchor=\"4 5 6\"/>
         <weld body1=\"c\" body2=\"d\" relpose=\"7 8 9 1 0 0 0\" torquescale=\"0.5\"/>",
    );
    let places = |k: usize| found[k].frames.map(|frame| frame.map(|frame| frame.xyz));
    assert_eq!(places(0), [Some([1.0, 2.0, 3.0]), None]);
    assert_eq!((places(1), found[1].links[1] == found[2].links[0]), ([Some([0.0; 3]), None], true));
    assert_eq!(places(2), [Some([1.0, 0.0, 0.0]), Some([0.0; 3])]);
    assert_eq!((places(3), found[3].turns), ([None, Some([4.0, 5.0, 6.0])], Some(1.0)));
    assert_eq!((places(4), found[4].turns), ([Some([7.0, 8.0, 9.0]), Some([0.0; 3])], Some(0.5)));
    assert_eq!(found.iter().filter(|own| own.turns.is_none()).count(), 3);
    for (tag, expected) in [
        ("<connect body1=\"c\" body2=\"d\"/>", "body1 and anchor, or site1 and site2"),
        ("<connect site1=\"s\"/>", "body1 and anchor, or site1 and site2"),
        ("<weld body2=\"c\"/>", "body1, or site1 and site2"),
        ("<weld site1=\"s\" site2=\"t\" anchor=\"1 2 3\"/>", "both site1 and anchor"),
        ("<connect site1=\"s\" site2=\"t\" body1=\"c\"/>", "both site1 and body1"),
        ("<weld body1=\"c\" body2=\"nobody\"/>", "the name of a body"),
        ("<weld body1=\"c\" relpose=\"1 2 x\"/>", "a decimal number"),
    ] {
        let text = with("", &format!("<equality>{tag}</equality>")).replace("</worldbody>", bodies);
        let error = read(text.as_bytes(), &options()).expect_err("an error").to_string();
        assert!(error.contains(expected), "{tag}: {error}");
    }
}

#[test]
fn what_gives_no_force_is_a_warning_with_its_line() {
    let actuators = [
        "<muscle joint=\"h\"/>",
        "<adhesion body=\"c\"/>",
        "<dcmotor joint=\"h\" motorconst=\"1\" resistance=\"1\"/>",
        "<orientation joint=\"b\"/>",
        "<pid joint=\"h\"/>",
        "<general joint=\"h\" dyntype=\"user\"/>",
        "<general joint=\"h\" dyntype=\"filter\" actdim=\"2\"/>",
        "<general joint=\"h\" gaintype=\"user\"/>",
        "<general joint=\"h\" biastype=\"muscle\"/>",
        "<motor jointinparent=\"b\"/>",
        "<motor joint=\"f\"/>",
        "<motor cranksite=\"s\" slidersite=\"s\" cranklength=\"1\"/>",
        "<motor joint=\"h\" delay=\"0.1\" nsample=\"3\"/>",
        "<motor joint=\"h\" group=\"3\"/>",
    ];
    for tag in actuators {
        let text = with("<option actuatorgroupdisable=\"3\"/>", &format!("<actuator>\n{tag}\n<motor name=\"m\" joint=\"h\"/></actuator>"))
            .replace("</worldbody>", "<site name=\"s\"/><body name=\"c\"><freejoint name=\"f\"/><geom size=\"1\"/></body></worldbody>");
        let reading = accepted(&text);
        let names: Vec<&str> = reading.world.actuators.iter().map(|own| own.name.as_str()).collect();
        assert_eq!(names, ["m"], "{tag}");
        let found: Vec<_> = reading.warnings.iter().map(|warning| (warning.code, warning.line())).collect();
        assert_eq!(found, [(Code::LostDynamics, Some(7))], "{tag}");
        assert!(reading.warnings[0].to_string().contains("no force"), "{}", reading.warnings[0]);
        assert!(reading.unused.iter().any(|unused| unused.line == Some(7) && tag.starts_with(&format!("<{}", unused.tag))), "{tag}");
    }
    let tendon = |attributes: &str, tag: &str| {
        format!(
            "<tendon>\n<{tag} name=\"t\" {attributes}>{}</{tag}></tendon>",
            match tag {
                "fixed" => "<joint joint=\"x\" coef=\"1\"/>",
                _ => "<site site=\"s\"/><geom geom=\"round\"/><site site=\"s2\"/>",
            }
        )
    };
    let tendons = [
        tendon("range=\"0 1\"", "fixed"),
        tendon("frictionloss=\"1\"", "fixed"),
        tendon("armature=\"1\"", "fixed"),
        tendon("actuatorfrcrange=\"-1 1\"", "fixed"),
        tendon("stiffness=\"1\"", "spatial"),
        "<actuator>\n<motor joint=\"b\" armature=\"1\"/></actuator>".to_owned(),
        "<actuator>\n<position joint=\"b\"/></actuator>".to_owned(),
    ];
    for tag in tendons {
        let text =
            with("", &tag).replace("</worldbody>", "<site name=\"s\"/><geom name=\"round\" size=\"0.1\"/><site name=\"s2\"/></worldbody>");
        let found: Vec<_> = accepted(&text).warnings.iter().map(|warning| (warning.code, warning.line())).collect();
        assert_eq!(found, [(Code::LostDynamics, Some(7))], "{tag}");
    }
    assert_eq!(accepted(&with("", &tendon("", "fixed"))).warnings.len(), 0);
}

#[test]
fn mistakes_are_errors_with_their_lines() {
    let actuator = |tag: &str| with("", &format!("<actuator>\n{tag}\n</actuator>"));
    let tendon = |inside: &str| {
        let sites = "<site name=\"s\"/><site name=\"r\"/><geom name=\"g\" size=\"1\"/></worldbody>";
        with("", &format!("<tendon>\n{inside}\n</tendon>")).replace("</worldbody>", sites)
    };
    let key = |attributes: &str| with("", &format!("<keyframe>\n<key {attributes}/>\n</keyframe>"));
    let mistakes = [
        (actuator("<motor joint=\"y\"/>"), Code::UnknownName, "the name of a joint"),
        (actuator("<motor tendon=\"h\"/>"), Code::UnknownName, "the name of a tendon"),
        (actuator("<motor/>"), Code::MissingAttribute, "one of joint"),
        (actuator("<motor joint=\"x\" jointinparent=\"h\"/>"), Code::Together, "two things"),
        (actuator("<motor joint=\"x\" kp=\"1\"/>"), Code::Unknown, "attribute of <motor>"),
        (actuator("<motr joint=\"x\"/>"), Code::Unknown, "motor, perhaps"),
        (actuator("<motor joint=\"x\" ctrlrange=\"1\"/>"), Code::WrongCount, "2 numbers"),
        (actuator("<motor joint=\"x\" ctrlrange=\"2 1\" ctrllimited=\"true\"/>"), Code::LimitOrder, "2 and 1"),
        (actuator("<motor joint=\"x\" gear=\"1 2 3 4 5 6 7\"/>"), Code::WrongCount, "1 to 6 numbers"),
        (actuator("<position joint=\"x\" kv=\"-1\"/>"), Code::Number, "zero or more"),
        (actuator("<position joint=\"x\" kv=\"1\" dampratio=\"1\"/>"), Code::Together, "both kv and dampratio"),
        (actuator("<position joint=\"x\" ctrlrange=\"0 1\" inheritrange=\"1\"/>"), Code::Together, "both ctrlrange and inheritrange"),
        (actuator("<position joint=\"b\" inheritrange=\"1\"/>"), Code::LimitMissing, "no range to inherit"),
        (actuator("<damper joint=\"x\" kv=\"1\"/>"), Code::LimitOrder, "0 and 0"),
        (actuator("<damper joint=\"x\" kv=\"-1\" ctrlrange=\"0 1\"/>"), Code::Number, "zero or more"),
        (actuator("<general joint=\"x\" gaintype=\"fix\"/>"), Code::Word, "did you mean \"fixed\""),
        (tendon("<fixed><joint joint=\"x\"/></fixed>"), Code::MissingAttribute, "coef"),
        (tendon("<fixed/>"), Code::MissingAttribute, "the joints of the tendon"),
        (tendon("<fixed><joint joint=\"b\" coef=\"1\"/></fixed>"), Code::Unsupported, "several coordinates"),
        (tendon("<fixed><joint joint=\"x\" coef=\"1\"/><joint joint=\"x\" coef=\"1\"/></fixed>"), Code::DuplicateName, "each joint once"),
        (tendon("<spatial/>"), Code::Misplaced, "less than two points"),
        (tendon("<spatial><site site=\"s\"/><site site=\"s\"/></spatial>"), Code::Misplaced, "the same site again"),
        (tendon("<spatial><site site=\"s\"/><site site=\"z\"/></spatial>"), Code::UnknownName, "the name of a site"),
        (tendon("<spatial><site site=\"s\"/><geom geom=\"g\"/></spatial>"), Code::Misplaced, "not between two sites"),
        (tendon("<spatial><pulley divisor=\"0\"/><site site=\"s\"/><site site=\"r\"/></spatial>"), Code::Number, "above zero"),
        (tendon("<spatial><pulley/><site site=\"s\"/><site site=\"r\"/></spatial>"), Code::MissingAttribute, "divisor"),
        (tendon("<spatial><site site=\"s\"/><site site=\"r\"/><pulley divisor=\"1\"/></spatial>"), Code::Misplaced, "pulley at the end"),
        (tendon("<spatial><site site=\"s\"/><joint joint=\"x\"/><site site=\"r\"/></spatial>"), Code::Unknown, "<joint>"),
        (tendon("<fixed springlength=\"2 1\"><joint joint=\"x\" coef=\"1\"/></fixed>"), Code::LimitOrder, "the shorter length first"),
        (with("", "<equality>\n<joint joint2=\"x\"/>\n</equality>"), Code::MissingAttribute, "joint1"),
        (with("", "<equality>\n<joint joint1=\"x\" joint2=\"y\"/>\n</equality>"), Code::UnknownName, "the name of a joint"),
        (key("qpos=\"1 2 3 4 5 6 7\""), Code::WrongCount, "7 numbers"),
        (key("qvel=\"1 2 3 4 5 6\""), Code::WrongCount, "6 numbers"),
        (key("ctrl=\"1\""), Code::WrongCount, "1 numbers"),
        (key("qpos=\"x\""), Code::NotANumber, "\"x\""),
    ];
    for (text, code, part) in mistakes {
        let found = read(text.as_bytes(), &options()).map(|_| ()).expect_err(&text);
        assert_eq!(found.errors.len(), 1, "{found}\n{text}");
        assert_eq!((found.errors[0].code, found.errors[0].line()), (code, Some(7)), "{found}");
        assert!(found.to_string().contains(part), "{part}: {found}");
    }
}

/// A free body, turned by a quarter about z, and a ball.
const FREE: &str = "<mujoco><worldbody><body pos=\"1 2 3\" quat=\"1 0 0 1\"><freejoint name=\"f\"/><geom size=\"1\"/>
    <body><joint name=\"b\" type=\"ball\"/><geom size=\"1\"/></body></body><body><joint name=\"h\" ref=\"90\"/><geom size=\"1\"/></body></worldbody>";

#[test]
fn states_are_in_the_conventions_of_the_library() {
    let text = format!(
        "{FREE}<actuator><motor joint=\"h\"/><muscle joint=\"h\"/><motor joint=\"h\"/></actuator><keyframe>\n<key name=\"k\" qpos=\"4 5 6 2 0 0 2 0 3 0 0 7\" qvel=\"1 2 3 4 5 6 7 8 9 10\" ctrl=\"1 2 3\"/>\n\
         <key qpos=\"9\" qvel=\"\"/><key/></keyframe></mujoco>"
    );
    let found = accepted(&text).world;
    let r = FRAC_1_SQRT_2;
    let home = found.home.unwrap();
    assert_eq!(home.q[0].0, "f");
    assert!(near(&home.q[0].1, &[1.0, 2.0, 3.0, 0.0, 0.0, r, r]) && home.q[2] == ("h".to_owned(), vec![FRAC_PI_2]), "{home:?}");
    assert_eq!(home.q[1].1, [0.0, 0.0, 0.0, 1.0]);
    let names: Vec<&str> = found.keyframes.iter().map(|key| key.name.as_str()).collect();
    assert_eq!(names, ["k", "key_1", "key_2"]);
    let key = &found.keyframes[0];
    assert!(near(&key.q[0].1, &[4.0, 5.0, 6.0, 0.0, 0.0, r, r]), "{key:?}");
    assert_eq!((&key.q[1].1, &key.q[2].1), (&vec![1.0, 0.0, 0.0, 0.0], &vec![7.0]));
    // x of the world is −y of the body, y of the world its x.
    assert!(near(&key.v[0].1, &[4.0, 5.0, 6.0, 2.0, -1.0, 3.0]), "{key:?}");
    assert_eq!((&key.v[1].1, &key.v[2].1), (&vec![7.0, 8.0, 9.0], &vec![10.0]));
    assert_eq!((key.control.as_slice(), key.place.line()), (&[1.0, 3.0][..], Some(3)));
    // Missing numbers are completed by those at the start; an empty list means all of those.
    let key = &found.keyframes[1];
    assert!(near(&key.q[0].1, &[9.0, 2.0, 3.0, 0.0, 0.0, r, r]) && key.v.is_empty() && key.control.is_empty(), "{key:?}");
    assert_eq!(found.keyframes[2].q, home.q);
}

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15)
}

#[test]
fn the_place_of_a_free_body_is_where_a_motion_starts() {
    let reading = accepted(&format!("{FREE}</mujoco>"));
    assert!(reading.unused.iter().all(|unused| !unused.tag.starts_with("body")), "{:?}", reading.unused);
    let at_rest = accepted("<mujoco><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>");
    assert_eq!(at_rest.world.home, None);
}

#[test]
fn bounds_of_forces_and_planes_are_read() {
    let found = world("");
    assert_eq!(found.joint_forces, [("x".to_owned(), [-4.0, 5.0])]);
    let text = "<mujoco><worldbody>\n<geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>\n<body pos=\"0 0 2\" euler=\"90 0 0\"><geom type=\"plane\" size=\"1 1 1\" pos=\"0 1 0\"/>
        <geom type=\"plane\" size=\"1 1 1\" contype=\"0\" conaffinity=\"0\"/></body></worldbody></mujoco>";
    let reading = accepted(text);
    let planes = &reading.world.planes;
    assert_eq!(planes.len(), 2);
    assert_eq!(
        (planes[0].name.as_str(), planes[0].point, planes[0].normal, planes[0].place),
        ("floor", [0.0; 3], [0.0, 0.0, 1.0], At::Text { line: 2, column: 1 })
    );
    assert_eq!((planes[1].point, planes[1].normal), ([0.0, 0.0, 3.0], [0.0, -1.0, 0.0]));
}

/// One file.
struct File(&'static str);

impl Sources for File {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        let files = BTreeMap::from([(PathBuf::from("cart.xml"), self.0)]);
        files.get(path).map(|text| text.as_bytes().to_vec()).ok_or_else(|| Error::new(ErrorKind::NotFound, "no such file"))
    }
}

#[test]
fn attached_models_and_copies_bring_their_actuators() {
    let cart = "<mujoco><worldbody><body name=\"c\"><joint name=\"a\"/><geom size=\"1\"/></body><body name=\"d\"><joint name=\"b\"/><geom size=\"1\"/></body></worldbody>
        <tendon><fixed name=\"t\" stiffness=\"1\"><joint joint=\"a\" coef=\"1\"/><joint joint=\"b\" coef=\"2\"/></fixed></tendon>
        <actuator><motor name=\"m\" joint=\"a\"/><motor name=\"n\" joint=\"b\"/><motor name=\"t\" tendon=\"t\"/></actuator>
        <equality><joint joint1=\"a\" joint2=\"b\"/></equality><keyframe><key name=\"k\" qpos=\"5 6\" ctrl=\"1 2 3\"/></keyframe></mujoco>";
    let main = "<mujoco><asset><model name=\"m\" file=\"cart.xml\"/></asset><worldbody>
        <replicate count=\"2\" sep=\"-\"><body><joint name=\"r\"/><geom size=\"1\"/></body></replicate>
        <attach model=\"m\" prefix=\"l_\"/><attach model=\"m\" body=\"d\" prefix=\"p_\"/></worldbody>
        <actuator><motor name=\"r\" joint=\"r\"/><motor name=\"far\" joint=\"l_a\"/></actuator><keyframe><key name=\"own\" ctrl=\"1 2 3 4 5 6 7\"/></keyframe></mujoco>";
    let found = read_with(&File(cart), main.as_bytes(), &options()).unwrap().world;
    let drives: Vec<(&str, &str)> = found.actuators.iter().map(|own| (own.name.as_str(), own.drives[0].0.as_str())).collect();
    // As in MuJoCo: those of the file, then of each copy and attached model in order of the tree
    let expected = [("far", "l_a"), ("r-0", "r-0"), ("r-1", "r-1"), ("l_m", "l_a"), ("l_n", "l_b"), ("l_t", "l_a"), ("p_n", "p_b")];
    assert_eq!(drives, expected);
    assert_eq!(found.passive.iter().map(|own| own.name.as_str()).collect::<Vec<_>>(), ["l_t"]);
    assert_eq!((found.couplings.len(), found.couplings[0].0.joint.as_str(), found.couplings[0].1), (1, "l_a", At::Nowhere));
    let keys: Vec<_> = found.keyframes.iter().map(|key| (key.name.as_str(), key.control.clone())).collect();
    assert_eq!(keys[0], ("own", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]));
    assert_eq!(keys[1], ("l_k", vec![0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 0.0]));
    assert_eq!(keys.len(), 2);
    let q: Vec<(&str, f64)> = found.keyframes[1].q.iter().map(|(name, q)| (name.as_str(), q[0])).collect();
    assert_eq!(q, [("r-0", 0.0), ("r-1", 0.0), ("l_a", 5.0), ("l_b", 6.0), ("p_b", 0.0)]);
}

/// A pair has MuJoCo's defaults, not the numbers of its geoms; tendons around geoms with limits are
/// listed.
#[test]
fn pairs_have_defaults_of_their_own() {
    let text = "<mujoco><worldbody><geom name='a' size='0.1' condim='1' solref='0.03 1' margin='0.01'/>\
        <body><joint name='j'/><geom name='b' size='0.1' friction='0.4'/></body></worldbody>\
        <contact><pair geom1='b' geom2='a' friction='0.7'/></contact>\
        <tendon><spatial name='t' limited='true' range='0 1'><site site='p'/><geom geom='b'/><site site='o'/></spatial></tendon></mujoco>";
    let text = text.replace("<body>", "<site name='p'/><body><site name='o'/>");
    let touching = accepted(&text).world.touching.unwrap();
    let [pair] = &touching.pairs[..] else { panic!("{:?}", touching.pairs) };
    assert_eq!((pair.dimension, pair.reference, pair.margin), (3, [0.02, 1.0], 0.0));
    assert_eq!(pair.friction, [0.7, 1.0, 0.005, 0.0001, 0.0001]);
    let what: Vec<&str> = touching.unread.iter().map(|own| own.what.as_str()).collect();
    assert_eq!(what, ["limits of the tendon t"]);
}

/// Sums of coordinates: limits and dry friction of fixed tendons, and equations, of any degree.
#[test]
fn tendons_and_equations_are_constraints_of_sums() {
    let text = "<mujoco><compiler angle='radian'/><worldbody><body><joint name='a' ref='0.2'/><geom size='0.1'/>\
        <body><joint name='b'/><geom size='0.1'/></body></body></worldbody>\
        <tendon><fixed name='t' limited='true' range='-1 2' margin='0.1' frictionloss='3' solreflimit='0.05 1'>\
        <joint joint='a' coef='2'/><joint joint='b' coef='-1'/></fixed></tendon>\
        <equality><joint name='e' joint1='b' joint2='a' polycoef='0.1 1 2' solref='0.03 1'/><tendon tendon1='t'/>\
        <joint joint1='a' active='false'/></equality></mujoco>";
    let read = accepted(text);
    let touching = read.world.touching.unwrap();
    let [limit, friction, quadratic, held] = &touching.sums[..] else { panic!("{:?}", touching.sums) };
    let terms = |own: &[(&str, f64)]| TouchingLength::Sum(own.iter().map(|(joint, factor)| ((*joint).to_owned(), *factor)).collect());
    let t = terms(&[("a", 2.0), ("b", -1.0)]);
    assert_eq!((&limit.length, limit.reference), (&t, [0.05, 1.0]));
    assert_eq!(limit.law, TouchingLaw::Between { range: [-1.0, 2.0], margin: 0.1 });
    assert_eq!((&friction.length, &friction.law), (&t, &TouchingLaw::DryFriction(3.0)));
    assert_eq!((&quadratic.length, quadratic.reference, &quadratic.coupling), (&terms(&[("b", 1.0)]), [0.03, 1.0], &Some("b".to_owned())));
    let coefficients = [0.1, 1.0, 2.0, 0.0, 0.0];
    assert_eq!(quadratic.law, TouchingLaw::Equation { other: Some(terms(&[("a", 1.0)])), references: [0.0, 0.2], coefficients });
    let TouchingLaw::Equation { other, references, .. } = &held.law else { panic!("{held:?}") };
    assert_eq!((&held.length, other, *references), (&t, &None, [0.4, 0.0]));
    assert_eq!(held.coupling.as_deref(), Some("a"));
    assert!(read.world.loops.iter().all(|own| own.is_computed) && touching.unread.is_empty());
}

/// Spatial tendons: points over pulleys, a spring at rest where springs of joints are, limits and
/// equations. Lengths by hand.
#[test]
fn a_spatial_tendon_is_a_path() {
    let text = "<mujoco><compiler angle='radian'/><worldbody><site name='o' pos='0 0 2'/><body name='b'><joint name='a' type='slide'
        axis='0 0 1' ref='0.25' springref='0.75'/><geom size='0.1'/><site name='p' pos='0 0 0.5'/><site name='r' pos='3 0 0.5'/></body>
        </worldbody><tendon><spatial name='t' stiffness='2' limited='true' range='0 5' frictionloss='1'><site site='o'/><site site='p'/>
        <pulley divisor='2'/><site site='p'/><site site='r'/></spatial></tendon><equality><tendon tendon1='t'/></equality>
        <actuator><motor tendon='t' gear='3'/></actuator></mujoco>";
    let read = accepted(text);
    let touching = read.world.touching.unwrap();
    let [limit, friction, held] = &touching.sums[..] else { panic!("{:?}", touching.sums) };
    let TouchingLength::Path(strands) = &limit.length else { panic!("{limit:?}") };
    let all: Vec<(f64, Vec<(&str, [f64; 3])>)> =
        strands.iter().map(|own| (own.factor, own.points.iter().map(|(link, at)| (link.as_str(), at.xyz)).collect())).collect();
    let p = ("b", [0.0, 0.0, 0.5]);
    assert_eq!(all, [(1.0, vec![("world", [0.0, 0.0, 2.0]), p]), (0.5, vec![p, ("b", [3.0, 0.0, 0.5])])]);
    assert_eq!((&friction.length, &held.length), (&limit.length, &limit.length));
    let TouchingLaw::Equation { references, .. } = held.law else { panic!("{held:?}") };
    // In the reference pose the site is at 0.5: 1.5 and 3/2. Springs are at rest half a metre
    // above.
    assert_eq!(references, [3.0, 0.0]);
    let [spring] = &read.world.passive[..] else { panic!("{:?}", read.world.passive) };
    assert_eq!(spring.bias, [2.0 * 2.5, -2.0, 0.0]);
    let Some(OnFrames::Path(pulled)) = &read.world.actuators[0].frames else { panic!("{:?}", read.world.actuators) };
    assert_eq!(pulled.iter().map(|own| own.factor).collect::<Vec<_>>(), [3.0, 1.5]);
    assert!(touching.unread.is_empty() && read.warnings.len() == 3, "{:?}", read.warnings);
}

/// Lengths of very many tendons of a large file would take minutes.
#[test]
fn very_many_spatial_tendons_are_an_error() {
    let bodies: String = (0..1200).map(|k| format!("<body><joint/><geom size='1'/><site name='{k}'/></body>")).collect();
    let sites: String = (0..20).map(|k| format!("<site site='{k}'/>")).collect();
    let tendons = format!("<spatial>{sites}</spatial>").repeat(800);
    let text = format!("<mujoco><worldbody>{bodies}</worldbody><tendon>{tendons}</tendon></mujoco>");
    let error = read(text.as_bytes(), &options()).expect_err("an error");
    assert_eq!(error.errors[0].code, Code::TooLarge, "{error}");
    assert!(error.errors.len() == 1 && error.to_string().contains("very many points of spatial tendons"), "{error}");
}

/// A pair that is twice in a file makes contact twice, as in MuJoCo.
#[test]
fn a_pair_may_be_there_twice() {
    let text = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/>\
        <body><freejoint/><geom name='ball' size='0.1' contype='0' conaffinity='0'/></body></worldbody>\
        <contact><pair geom1='floor' geom2='ball' condim='1'/><pair geom1='ball' geom2='floor'/></contact></mujoco>";
    let reading = articulated_formats::read(text.as_bytes(), &articulated_formats::Options::default()).unwrap();
    let touching = reading.world.touching.unwrap();
    let dimensions: Vec<usize> = touching.pairs.iter().map(|pair| pair.dimension).collect();
    assert_eq!((dimensions.as_slice(), touching.shapes.len()), ([1, 3].as_slice(), 2));
}
