//! MJCF: elements that options turn off or leave out, and those refused as in MuJoCo. The expected
//! numbers are MuJoCo's (4.0.0).

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_core::description::{JointDynamics, JointId, JointKind, LinkId};
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_core::effect::EffectId;
use articulated_formats::{LeaveOut, Options, Reading, Sources, read_with};

/// Files by their names.
struct Files(BTreeMap<PathBuf, Vec<u8>>);

impl Sources for Files {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| Error::new(ErrorKind::NotFound, "no such file"))
    }
}

fn with(files: &[(&str, &str)], leave_out: &[LeaveOut], text: &str) -> std::result::Result<Reading, Diagnostics> {
    let files = Files(files.iter().map(|(name, text)| (PathBuf::from(name), text.as_bytes().to_vec())).collect());
    let options = Options { file: "arm.xml".to_owned(), leave_out: leave_out.iter().copied().collect(), ..Options::default() };
    read_with(&files, text.as_bytes(), &options)
}

fn accepted(text: &str) -> Reading {
    with(&[], &[], text).unwrap_or_else(|found| panic!("{found}\n{text}"))
}

fn refused(text: &str) -> Diagnostics {
    with(&[], &[], text).map(|_| ()).expect_err(text)
}

fn warnings(reading: &Reading) -> Vec<String> {
    reading.warnings.iter().map(ToString::to_string).collect()
}

/// A hinge with all numbers, a ball, a spring-damper and a tendon, above a plane; with these flags.
fn arm(flags: &str) -> Reading {
    accepted(&format!(
        "<mujoco><option>\n<flag {flags}/></option><worldbody><geom type=\"plane\" size=\"1 1 1\"/>
         <body gravcomp=\"1\"><joint name=\"h\" damping=\"0.5\" stiffness=\"4\" springref=\"20\" frictionloss=\"0.2\" armature=\"0.1\" range=\"-30 40\"
           actuatorfrcrange=\"-1 2\"/><geom size=\"0.1\" pos=\"0.1 0 0\"/>
         <body><joint name=\"b\" type=\"ball\" range=\"0 30\" damping=\"0.3\"/><geom size=\"0.1\"/></body></body>
         <body><joint name=\"s\" springdamper=\"0.1 1\"/><geom size=\"0.1\"/></body></worldbody>
         <tendon><fixed name=\"t\" stiffness=\"3\" damping=\"2\" frictionloss=\"1\" range=\"0 1\"><joint joint=\"h\" coef=\"1\"/><joint joint=\"s\" coef=\"2\"/></fixed></tendon>
         <actuator><motor name=\"m\" joint=\"h\" damping=\"3\"/></actuator></mujoco>"
    ))
}

#[test]
fn flags_turn_off_what_they_name() {
    let dynamics = |reading: &Reading, name: &str| reading.description.joints[reading.description.joint(name).unwrap()].dynamics;
    let limit = |reading: &Reading, name: &str| reading.description.joints[reading.description.joint(name).unwrap()].limit;
    let all = arm("");
    let full = JointDynamics {
        damping: Some(0.5),
        friction: Some(0.2),
        armature: Some(0.1),
        stiffness: Some(4.0),
        rest: Some(20.0_f64.to_radians()),
        ..JointDynamics::default()
    };
    assert_eq!(dynamics(&all, "h"), full);
    let spring = dynamics(&all, "s");
    assert!(spring.damping.is_some() && spring.stiffness.is_some());
    // The spring and the damper of the tendon, the damper of the actuator
    let passive = |reading: &Reading| reading.world.passive.iter().map(|own| own.bias).collect::<Vec<_>>();
    let rest = 3.0 * full.rest.unwrap();
    assert_eq!(passive(&all), [[rest, -3.0, -2.0], [0.0, 0.0, -3.0]]);
    assert!(all.description.links.iter().any(|link| !link.collision.is_empty()));

    let no_spring = arm("spring=\"disable\"");
    assert_eq!(dynamics(&no_spring, "h"), JointDynamics { stiffness: None, rest: None, ..full });
    assert_eq!(dynamics(&no_spring, "s"), JointDynamics { stiffness: None, rest: None, ..spring });
    assert_eq!(passive(&no_spring), [[0.0, 0.0, -2.0], [0.0, 0.0, -3.0]]);
    let no_damper = arm("damper=\"disable\"");
    assert_eq!(dynamics(&no_damper, "h"), JointDynamics { damping: None, ..full });
    assert_eq!(dynamics(&no_damper, "b"), JointDynamics::default());
    assert_eq!(dynamics(&no_damper, "s"), JointDynamics { damping: None, ..spring });
    assert_eq!(passive(&no_damper), [[rest, -3.0, 0.0]]);
    // Without both there is no passive force at all.
    let no_passive = arm("spring=\"disable\" damper=\"disable\"");
    assert_eq!((passive(&no_passive).len(), dynamics(&no_passive, "s")), (0, JointDynamics::default()));
    let is_compensated = |reading: &Reading| reading.world.effects.iter().any(|(own, _)| own.effect == EffectId::gravity_compensation);
    assert!(is_compensated(&all) && is_compensated(&no_spring) && !is_compensated(&no_passive));

    for flags in ["frictionloss=\"disable\"", "constraint=\"disable\""] {
        let reading = arm(flags);
        assert_eq!(dynamics(&reading, "h"), JointDynamics { friction: None, ..full });
        assert!(warnings(&reading).iter().all(|warning| !warning.contains("friction of a tendon")), "{flags}");
    }
    for flags in ["limit=\"disable\"", "constraint=\"disable\""] {
        let reading = arm(flags);
        let own = limit(&reading, "h").unwrap();
        // The bound of actuators does not limit the motion.
        assert_eq!((own.lower, own.upper, own.effort, limit(&reading, "b")), (f64::NEG_INFINITY, f64::INFINITY, 2.0, None));
        assert_eq!(reading.description.joints[reading.description.joint("h").unwrap()].kind, JointKind::Continuous);
        assert!(warnings(&reading).iter().all(|warning| !warning.contains("limits of a tendon")), "{flags}");
    }
    assert_eq!(limit(&all, "h").unwrap().upper, 40.0_f64.to_radians());
    for flags in ["contact=\"disable\"", "constraint=\"disable\""] {
        let reading = arm(flags);
        assert!(reading.world.planes.is_empty() && reading.description.links.iter().all(|link| link.collision.is_empty()), "{flags}");
    }
    assert_eq!(all.world.planes.len(), 1);
    // Elements that a flag turns off are listed with the line of the flag.
    for flag in ["spring", "damper", "limit", "frictionloss", "contact", "constraint"] {
        let reading = arm(&format!("{flag}=\"disable\""));
        let found = reading.unused.iter().find(|unused| unused.tag == format!("flag {flag}")).expect(flag);
        assert_eq!((found.line, found.why.contains("as in MuJoCo")), (Some(2), true), "{flag}");
        assert!(arm(&format!("{flag}=\"enable\"")).unused.iter().all(|unused| !unused.tag.starts_with("flag")), "{flag}");
    }
}

const KID: &str = "<mujoco><option gravity=\"0 0 -1\" timestep=\"0.001\" integrator=\"RK4\" density=\"3\" actuatorgroupdisable=\"2\"><flag spring=\"disable\"/></option>
    <worldbody><body name=\"b\"><joint name=\"j\" stiffness=\"1\"/><geom size=\"0.1\"/></body></worldbody></mujoco>";

fn attaching(conflict: &str, option: &str) -> std::result::Result<Reading, Diagnostics> {
    let text = format!(
        "<mujoco><compiler {conflict}/><option {option}/><asset><model name=\"kid\" file=\"kid.xml\"/></asset><worldbody>\n\
         <attach model=\"kid\" body=\"b\" prefix=\"k_\"/></worldbody><actuator><motor joint=\"k_j\" group=\"2\"/></actuator></mujoco>"
    );
    with(&[("kid.xml", KID)], &[], &text)
}

#[test]
fn options_of_an_attached_model_are_merged_where_the_file_says_so() {
    let merged = attaching("conflict=\"merge\"", "timestep=\"0.01\"").unwrap();
    let world = &merged.world;
    let found = (world.gravity, world.step, world.integrator.as_deref(), world.actuators.len());
    assert_eq!(found, (Some([0.0, 0.0, -1.0]), Some(0.001), Some("RK4"), 0));
    assert_eq!(merged.description.joints[JointId(0)].dynamics.stiffness, None);
    assert!(merged.world.effects.iter().any(|(own, _)| own.effect == EffectId::box_drag), "{:?}", merged.world.effects);
    assert_eq!(attaching("conflict=\"merge\"", "timestep=\"0.0001\"").unwrap().world.step, Some(0.0001));
    // Two values without an order
    for option in ["gravity=\"0 0 -2\"", "integrator=\"Euler\"", "density=\"4\""] {
        let found = attaching("conflict=\"merge\"", option).map(|_| ()).unwrap_err();
        assert_eq!((found.errors.len(), found.errors[0].code, found.errors[0].line()), (1, Code::Together, Some(2)), "{found}");
    }
    for option in ["gravity=\"0 0 -2\"", "timestep=\"0.01\""] {
        let found = attaching("conflict=\"error\"", option).map(|_| ()).unwrap_err();
        assert_eq!((found.errors.len(), found.errors[0].code), (1, Code::Together), "{found}");
    }
    // Otherwise the attaching file counts, and the options of the model are warnings.
    for conflict in ["", "conflict=\"warning\"", "conflict=\"error\""] {
        let kept = attaching(conflict, "").unwrap();
        assert_eq!((kept.world.gravity, kept.world.step, kept.world.integrator.as_deref()), (None, None, None));
        assert_eq!((kept.description.joints[JointId(0)].dynamics.stiffness, kept.world.actuators.len()), (Some(1.0), 1));
        let found = warnings(&kept);
        for name in ["gravity", "timestep", "integrator", "density", "spring", "actuatorgroupdisable"] {
            assert!(
                found.iter().any(|warning| warning.contains(&format!("the {name} of the attached model \"kid\""))),
                "{name}: {found:?}"
            );
        }
        assert_eq!(found.len(), 6, "{found:?}");
    }
    let equal = attaching("", "gravity=\"0 0 -1\" timestep=\"0.001\" integrator=\"RK4\" density=\"3\" actuatorgroupdisable=\"2\"").unwrap();
    let found = warnings(&equal);
    assert_eq!(found.iter().filter(|warning| warning.contains("attached model")).count(), 1, "{found:?}");
}

#[test]
fn what_changes_the_motion_and_is_not_read_is_an_error_unless_it_is_left_out() {
    use LeaveOut::{Composite, Flex, Plugin};
    let body = |inside: &str| {
        format!("<mujoco><worldbody><body name=\"a\"><joint name=\"j\"/><geom size=\"0.1\"/>\n{inside}</body></worldbody></mujoco>")
    };
    let cases = [
        (body("<flexcomp name=\"cloth\" type=\"grid\"/>"), Flex, "a flexible body \"cloth\""),
        (
            "<mujoco><worldbody><body name=\"a\"><joint name=\"j\"/><geom size=\"0.1\"/></body></worldbody><deformable>\n<flex name=\"soft\"/></deformable></mujoco>"
                .to_owned(),
            Flex,
            "a flexible body \"soft\"",
        ),
        (body("<composite type=\"cable\" prefix=\"rope\"/>"), Composite, "a composite of bodies \"rope\""),
        (body("<plugin plugin=\"mujoco.elasticity.cable\"/>"), Plugin, "a plugin of a body \"mujoco.elasticity.cable\""),
        (body("<geom type=\"sdf\">\n<plugin plugin=\"mujoco.sdf.nut\"/></geom>").replace("/>\n<geom", "/><geom"), Plugin, "a plugin of a geom \"mujoco.sdf.nut\""),
        (
            body("<geom type=\"sdf\" mesh=\"m\"/>").replace("<worldbody>", "<asset><mesh name=\"m\">\n<plugin instance=\"gear\"/></mesh></asset><worldbody>").replace("/>\n<geom", "/><geom"),
            Plugin,
            "a plugin of a mesh \"gear\"",
        ),
    ];
    for (text, kind, part) in cases {
        let found = refused(&text);
        assert_eq!((found.errors.len(), found.errors[0].code, found.errors[0].line()), (1, Code::Unsupported, Some(2)), "{found}");
        let message = found.to_string();
        assert!(message.contains(part) && message.contains(&format!("`--leave-out {kind}`")), "{message}");
        let others: Vec<LeaveOut> = LeaveOut::ALL.into_iter().filter(|other| *other != kind).collect();
        assert!(with(&[], &others, &text).is_err(), "{text}");
        let reading = with(&[], &[kind], &text).unwrap();
        let found: Vec<_> = reading.warnings.iter().map(|warning| (warning.code, warning.line())).collect();
        assert_eq!(found, [(Code::LostDynamics, Some(2))], "{:?}", warnings(&reading));
        assert!(warnings(&reading)[0].contains(part));
        let mass = reading.description.links[LinkId(1)].inertial.unwrap().mass;
        assert!((mass - 4.1887902047863905).abs() < 1e-12, "{mass}");
    }
    // Copies of one tag are one finding.
    let copies = "<mujoco><worldbody><replicate count=\"3\"><body><joint/><geom size=\"1\"/><plugin plugin=\"p\"/></body></replicate></worldbody></mujoco>";
    assert_eq!(refused(copies).errors.len(), 1);
    // Elements that are not attached are not in the model.
    let kid = "<mujoco><worldbody><body name=\"b\"><joint/><geom size=\"1\"/></body><flexcomp name=\"cloth\"/></worldbody></mujoco>";
    let main = |how: &str| {
        format!(
            "<mujoco><asset><model name=\"kid\" file=\"kid.xml\"/></asset><worldbody><attach model=\"kid\" {how} prefix=\"k_\"/></worldbody></mujoco>"
        )
    };
    assert!(with(&[("kid.xml", kid)], &[], &main("body=\"b\"")).is_ok());
    assert!(with(&[("kid.xml", kid)], &[], &main("")).is_err());
}

#[test]
fn a_plane_does_not_move() {
    let plane =
        |joint: &str, inside: &str| format!("<mujoco><worldbody><body>{joint}<geom size=\"0.1\"/>\n{inside}</body></worldbody></mujoco>");
    let geom = "<geom type=\"plane\" size=\"1 1 1\"/>";
    let unseen = "<geom type=\"plane\" size=\"1 1 1\" contype=\"0\" conaffinity=\"0\"/>";
    for inside in [geom.to_owned(), unseen.to_owned(), format!("<body>{geom}</body>")] {
        let found = refused(&plane("<joint/>", &inside));
        assert_eq!((found.errors.len(), found.errors[0].code, found.errors[0].line()), (1, Code::Misplaced, Some(2)), "{found}");
        accepted(&plane("", &inside));
    }
}

#[test]
fn a_ball_joint_may_be_limited_to_zero() {
    let ball = |class: &str, attributes: &str| {
        format!(
            "<mujoco><default><joint limited=\"true\" range=\"-30 30\"/><default class=\"still\"><joint {class}/></default></default><worldbody>
             <body><joint name=\"b\" class=\"still\" type=\"ball\" {attributes}/><geom size=\"0.1\"/></body></worldbody></mujoco>"
        )
    };
    // MuJoCo takes the greater of both numbers.
    for text in [ball("range=\"0 0\"", ""), ball("", "range=\"0 0\""), ball("", "range=\"0 -5\"")] {
        let reading = accepted(&text);
        assert_eq!(reading.description.joints[JointId(0)].limit.unwrap().upper, 0.0, "{text}");
        assert!(warnings(&reading)[0].contains("a ball joint that is limited to 0"), "{:?}", warnings(&reading));
    }
    assert_eq!(accepted(&ball("", "range=\"0 0\" limited=\"auto\"")).description.joints[JointId(0)].limit, None);
    assert_eq!(refused(&ball("", "")).errors[0].code, Code::LimitOrder);
}

/// A hub with two arms, and a tendon across them.
const ARMS: &str = "<mujoco><worldbody><body><joint name=\"hub\" axis=\"0 1 0\"/><geom type=\"box\" size=\"0.2 0.1 0.1\"/>
    <body pos=\"0.2 0 0\"><joint name=\"one\" axis=\"0 1 0\"/><geom type=\"capsule\" size=\"0.02\" fromto=\"0 0 0 0.3 0 0.1\"/><site name=\"a\"/></body>
    <body pos=\"-0.2 0 0\"><joint name=\"two\" axis=\"0 1 0\"/><geom type=\"capsule\" size=\"0.03\" fromto=\"0 0 0 -0.2 0.1 0\"/><site name=\"b\"/></body></body></worldbody>
    <tendon><fixed name=\"both\" armature=\"0.2\"><joint joint=\"one\" coef=\"2\"/><joint joint=\"two\" coef=\"-1\"/><joint joint=\"hub\" coef=\"0.5\"/></fixed></tendon>
    <actuator><position name=\"servo\" joint=\"one\" kp=\"20\" dampratio=\"0.7\"/></actuator></mujoco>";

#[test]
fn armature_of_a_tendon_couples_joints_of_one_branch_alone() {
    let kv = -accepted(ARMS).world.actuators[0].bias[2];
    assert!((kv - 5.20529187160878).abs() < 1e-12, "{kv}");
}

/// The mass that a servo of a spatial tendon feels: with the numbers of MuJoCo 4.0.0.
#[test]
fn a_servo_of_a_spatial_tendon_is_damped_by_its_ratio() {
    let rope = "<position name=\"rope\" tendon=\"line\" gear=\"2\" kp=\"5\" dampratio=\"0.8\"/></actuator>";
    let line = "<spatial name=\"line\" armature=\"0.1\"><site site=\"a\"/><site site=\"b\"/></spatial></tendon>";
    let text = ARMS.replace("</actuator>", rope).replace("</tendon>", line).replace("<site name=", "<site pos=\"0.1 0 0.2\" name=");
    let kv: Vec<f64> = accepted(&text).world.actuators.iter().map(|own| -own.bias[2]).collect();
    for (kv, expected) in kv.iter().zip([5.220864905589416, 3.3916683920975643]) {
        assert!((kv - expected).abs() < 1e-12, "{kv} and {expected}");
    }
}

#[test]
fn a_mass_that_is_not_known_has_its_reason() {
    let around = |rest: &str| {
        let tendon =
            "<spatial name=\"line\" armature=\"0.1\"><site site=\"a\"/><geom geom=\"round\"/><site site=\"b\"/></spatial></tendon>";
        let named = ARMS.replacen("<geom type", "<geom name=\"round\" type", 1);
        named.replace("</tendon>", tendon).replace("<joint name=\"two\"", &format!("<joint name=\"two\" {rest}"))
    };
    let found = warnings(&accepted(&around("springdamper=\"0.1 1\"")));
    for part in ["a springdamper beside a tendon around a geom with armature", "a dampratio beside a tendon around a geom with armature"] {
        assert!(found.iter().any(|warning| warning.contains(part)), "{found:?}");
    }
    assert!(found.iter().all(|warning| !warning.contains("singular")), "{found:?}");
    let light = "<mujoco><worldbody><body><joint springdamper=\"0.1 1\"/></body></worldbody></mujoco>";
    assert!(warnings(&accepted(light))[0].contains("a springdamper in a robot whose mass matrix is singular"));
}

/// So that users need not count lines, and the comparison with MuJoCo identifies elements with a
/// warning.
#[test]
fn a_warning_names_what_is_not_read() {
    let rest = "<equality><connect name=\"knee\" body1=\"arm\" body2=\"hub\" anchor=\"0 0 0\"/></equality>
        <tendon><spatial name=\"line\" stiffness=\"1\"><site site=\"a\"/><geom geom=\"round\"/><site site=\"b\"/></spatial></tendon>
        <actuator><muscle name=\"biceps\" joint=\"one\"/><motor name=\"push\" cranksite=\"a\" slidersite=\"b\" cranklength=\"1\"/></actuator></mujoco>";
    let text = ARMS
        .replacen("<geom type", "<geom name=\"round\" type", 1)
        .replace("</mujoco>", rest)
        .replace("<body>", "<body name=\"hub\">")
        .replacen("<body pos", "<body name=\"arm\" pos", 1);
    let found = warnings(&accepted(&text));
    let parts =
        ["a tendon \"both\"", "around a geom with forces \"line\"", "at a point \"knee\"", "<muscle> \"biceps\"", "of a crank \"push\""];
    for part in parts {
        assert_eq!(found.iter().filter(|warning| warning.contains(part)).count(), 1, "{part}: {found:#?}");
    }
    assert_eq!(found.len(), parts.len(), "{found:#?}");
}
