//! All errors that keep a scene from moving are reported at once.

use articulated::simulate::{Settings, StateError, TableError};
use articulated::{Dynamics, FunctionError};
use articulated_core::control::Interpolation;
use articulated_models::panda_like;
use articulated_motion::{Controller, Fault, InitialState, MotionErrors, Scene, Session};
use articulated_scene::{Aim, Series};

use super::{ARM, CART, session};

fn lines(errors: &MotionErrors) -> Vec<String> {
    errors.to_string().lines().map(str::to_owned).collect()
}

/// The errors of a session that does not move on a robot.
fn refused<R: Dynamics<f64>>(session: &Session, robot: &R, frames: &[&str]) -> Vec<Fault> {
    session
        .run(robot, frames)
        .err()
        .unwrap_or_else(|| panic!("moved with {:?}", session.effects))
        .errors
        .into_iter()
        .map(|e| e.fault)
        .collect()
}

const TOUCHING: &str = "effects = { contact = { hand = { radius = 0.05, stiffness = 1e4, damping = 0.1, friction = 0.5 }, fore = { radius = 0.1, stiffness = 1e4, damping = 0.1, friction = 0.5 } } }
    impact = { link = 'upper', normal = [1, 0, 0], mass = 1, restitution = 1, time = 0.1 }
    simulation = { end = 1.0, events = ['contacts'] }";

#[test]
fn frames_that_events_need_and_the_robot_has_not_are_told_together() {
    let session = session(TOUCHING, ARM);
    let robot = session.model.clone().with_frames(&["fore"]).unwrap();
    let missing = |key, link: &str| Fault::NoFrame { key, link: link.into(), frames: vec!["fore".into()] };
    assert_eq!(refused(&session, &robot, &["fore"]), [missing("effects.contact", "hand"), missing("impact.link", "upper")]);
    let told = r#"s.toml: impact.link: found a robot that gives no frame of "upper", expected that among its frames (fore)"#;
    assert_eq!(lines(&session.run(&robot, &["fore"]).unwrap_err())[1], told);
    assert_eq!(session.frames(), ["fore", "hand", "upper"]);
    let robot = session.model.clone().with_frames(&["upper", "hand", "fore"]).unwrap();
    assert!(session.run(&robot, &["upper", "hand", "fore"]).is_ok());
}

/// A robot of the same joints, made from the URDF alone or with other gravity. It runs with
/// `Session::motion`.
#[test]
fn a_robot_without_the_effects_or_the_gravity_of_the_scene_is_another() {
    let pull = "gravity = [0, 0, -1.62]\n";
    let scenes = [
        "effects = { damping = { shoulder = 0.1 } }",
        "effects = { friction = { elbow = 0.2 } }",
        "effects = { armature = { elbow = 0.3 } }",
        "effects = { limit = { elbow = { lower = -1.2, upper = 1.2, stiffness = 100.0 } } }",
        "effects = { contact = { hand = { radius = 0.05, height = 0.3, stiffness = 1e4, damping = 0.1, friction = 0.5 } } }",
        "effects = { motor = { shoulder = { torque = 0.5, speed = 100.0 } } }",
        pull,
    ];
    let plain = session("simulation = { end = 0.01 }", ARM);
    assert!(plain.run(&plain.model, &plain.frame_names()).is_ok());
    for text in scenes {
        let session = session(&format!("{text}\nsimulation = {{ end = 0.01 }}"), ARM);
        assert!(session.run(&session.model, &session.frame_names()).is_ok(), "{text}");
        let told = refused(&session, &plain.model, &plain.frame_names());
        assert!(matches!(told[..], [Fault::Dynamics { .. }]), "{text}: {told:?}");
        let mut motion = session.motion(&plain.model, &plain.frame_names(), session.settings().unwrap()).unwrap();
        assert!(motion.run(&session.initial_state().unwrap(), &mut |_, _| true).is_ok(), "{text}");
    }
}

/// A torque difference above a thousandth, more than the error of any level of accuracy, means
/// another mass; a smaller one is not reported.
#[test]
fn a_robot_of_another_mass_is_another() {
    let session = session("simulation = { end = 0.01 }", CART);
    let fault = |mass: &str| {
        let urdf = CART.replace("<mass value=\"2\"/>", &format!("<mass value=\"{mass}\"/>"));
        let robot = articulated::load_bytes("cart.urdf", urdf.as_bytes(), articulated::Base::Fixed).unwrap();
        session.run(&robot, &session.frame_names()).err().map(|e| e.errors[0].fault.clone())
    };
    assert_eq!([fault("2.0002"), fault("1.9998")], [None, None]);
    assert!(["2.02", "1.98"].into_iter().all(|mass| matches!(fault(mass), Some(Fault::Dynamics { .. }))));
}

/// One gain may apply to all degrees of freedom of a joint; a torque rarely has the same number
/// about every axis.
#[test]
fn torques_of_a_ball_are_three() {
    let arm = session("simulation = { end = 0.1 }", ARM);
    let told = |torque: &str| {
        let text = format!("control = {{ kind = 'torque', torque = {{ wrist = {torque} }} }}");
        Scene::read("s.toml", &text).unwrap().controller(&arm.model, &mut |_| Err(String::new())).map_err(|e| e.to_string())
    };
    assert_eq!(told("2").unwrap_err(), "s.toml:1: control.torque.wrist: found one number, expected 3 numbers");
    assert_eq!(told("[1, 2, 3]"), Ok(Controller::Torque(vec![0.0, 0.0, 1.0, 2.0, 3.0])));
}

#[test]
fn contacts_that_nobody_looks_for_need_no_frames() {
    let session = session(
        "effects = { contact = { hand = { radius = 0.05, stiffness = 1e4, damping = 0.1, friction = 0.5 } } }\nsimulation = { end = 0.1 }",
        ARM,
    );
    let robot = session.model.clone().with_frames::<&str>(&[]).unwrap();
    assert!(session.frames().is_empty() && session.run::<_, &str>(&robot, &[]).is_ok());
}

#[test]
fn names_of_frames_are_those_of_the_robot_in_its_order() {
    let session = session(TOUCHING, ARM);
    let robot = session.model.clone().with_frames(&["upper", "hand", "fore"]).unwrap();
    let name = |index, found: &str, expected: &str| Fault::FrameName { index, found: found.into(), expected: expected.into() };
    assert_eq!(refused(&session, &robot, &["hand", "upper", "fore"]), [name(0, "hand", "upper"), name(1, "upper", "hand")]);
    assert_eq!(refused(&session, &robot, &["upper", "hand"])[0], Fault::Frames { found: 2, expected: 3 });
}

#[test]
fn functions_that_the_robot_has_not_are_told_together() {
    let scene = "control = { kind = 'pd', kp = 1.0 }
        impact = { link = 'link_7', normal = [1, 0, 0], mass = 1, restitution = 1, time = 0.1 }
        simulation = { end = 1.0, integrator = 'rodas4' }";
    let session = session(scene, articulated_models::robot("panda_like").unwrap().urdf);
    let lacks = |function| Fault::Function(FunctionError::NotGenerated { function });
    let functions = ["forward_dynamics_derivatives", "difference", "jacobians_world_aligned", "solve_mass_matrix"].map(lacks);
    assert_eq!(refused(&session, &panda_like::Robot, &panda_like::FRAME_NAMES), functions);
    let told = lines(&session.run(&panda_like::Robot, &panda_like::FRAME_NAMES).unwrap_err());
    assert_eq!(told[1], "s.toml: this robot was generated without difference: add it to `functions`");
}

/// The control may differ from the one that the motion starts with.
#[test]
fn a_controller_that_the_robot_has_not_the_functions_for_is_refused() {
    let session = session("simulation = { end = 0.1 }", articulated_models::robot("panda_like").unwrap().urdf);
    let mut motion = session.motion(&panda_like::Robot, &panda_like::FRAME_NAMES, session.settings().unwrap()).unwrap();
    let zeros = || vec![0.0; 7];
    let controller = Controller::Pd { target: Aim::Still(zeros()), kp: zeros(), kd: zeros(), torque: zeros() };
    let initial = InitialState { controller, ..session.initial_state().unwrap() };
    let told = motion.run(&initial, &mut |_, _| true).unwrap_err();
    assert_eq!(told.errors[0].fault, Fault::Function(FunctionError::NotGenerated { function: "difference" }));
    let initial = InitialState { controller: Controller::Torque(zeros()), ..initial };
    assert!(motion.run(&initial, &mut |_, _| true).is_ok());
}

#[test]
fn another_robot_than_the_scenes_is_refused() {
    let (session, cart) = (session(TOUCHING, ARM), session("", CART));
    let shape = |what, expected| Fault::Shape { what, found: 1, expected };
    let found = refused(&session, &cart.model, &cart.frame_names());
    assert!(found.contains(&shape("coordinates", 6)) && found.contains(&shape("degrees of freedom", 5)), "{found:?}");
}

#[test]
fn all_that_is_wrong_with_a_scene_is_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "initial = { q = { sholder = 1 }, v = { elbow = [1, 2] } }\ncontrol = { kind = 'table', file = 'no.csv' }";
    // The scene was not checked against its robot yet.
    let Session { description, model, .. } = session("", ARM);
    let unheld = Session::new(Scene::read("s.toml", scene).unwrap(), description, model.clone(), Vec::new());
    let told = lines(&unheld.in_folder(folder.path()).run::<_, &str>(&model, &[]).unwrap_err());
    assert_eq!(told.len(), 4, "{told:#?}");
    assert_eq!(told[0], "s.toml: simulation: found nothing, expected [simulation] with `end`, s");
    let parts = [("s.toml:1: initial.q.sholder: ", "shoulder"), ("s.toml:1: initial.v.elbow: ", "2 numbers"), ("s.toml:2: ", "no.csv")];
    for (line, (start, part)) in told[1..].iter().zip(parts) {
        assert!(line.starts_with(start) && line.contains(part), "{line}");
    }
}

#[test]
fn tables_that_are_no_text_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("odd.csv"), b"t,slide\n0,\xff\n").unwrap();
    for (name, length) in [("vast.csv", (4 << 30) + 1), ("hole.csv", 4 << 30)] {
        std::fs::File::create(folder.path().join(name)).unwrap().set_len(length).unwrap();
    }
    let begun = |file: &str| {
        let session = session(&format!("control = {{ kind = 'table', file = '{file}' }}"), CART).in_folder(folder.path());
        session.initial_state().unwrap_err().to_string()
    };
    assert_eq!(begun("odd.csv"), "odd.csv:2: found bytes that are not UTF-8, expected a CSV");
    let vast = begun("vast.csv");
    assert!(vast.contains("vast.csv: found 4294967297 bytes, expected at most 4294967296 bytes"), "{vast}");
    assert!(begun("hole.csv").starts_with("hole.csv:1: found more than 1048576 bytes without an end of line, expected "));
}

/// The pipe has no writer: a program that opens it waits forever.
#[cfg(unix)]
#[test]
fn tables_are_regular_files() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.csv");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("zeros.csv")).unwrap();
    std::fs::create_dir(folder.path().join("folder.csv")).unwrap();
    for kind in ["kind = 'table'", "kind = 'pd', kp = 1.0"] {
        for (file, found) in [("pipe.csv", "a pipe"), ("zeros.csv", "a device"), ("folder.csv", "a folder"), ("/dev/zero", "a device")] {
            let session = session(&format!("control = {{ {kind}, file = '{file}' }}"), CART).in_folder(folder.path());
            let told = session.initial_state().unwrap_err().to_string();
            let expected = format!("{file}: found {found}, expected a regular file), expected a CSV");
            assert!(told.starts_with("s.toml:1: control.file: ") && told.contains(&expected), "{told}");
        }
    }
}

#[test]
fn settings_that_cannot_be_used_are_told_together() {
    let session =
        session("simulation = { end = 1.0 }\nimpact = { link = 'cart', normal = [1, 0, 0], mass = 1, restitution = 1, time = 1.5 }", CART);
    let settings = session.settings().unwrap();
    let told = "s.toml:2: impact.time: found 1.5, expected a time from 0.0 s on and before 1.0 s";
    assert_eq!(session.check(&settings).unwrap_err().to_string(), told);
    assert_eq!(session.motion(&session.model, &session.frame_names(), settings.clone()).err().unwrap().to_string(), told);
    assert!(session.check(&Settings { end: 2.0, ..settings.clone() }).is_ok());
    let wrong = Settings { rtol: 2.0, end: -1.0, ..settings };
    let errors = session.motion(&session.model, &session.frame_names(), wrong).err().unwrap();
    assert_eq!(errors.errors.len(), 2, "{errors}");
    assert!(lines(&errors)[1].starts_with("s.toml: end = -1: "), "{errors}");
}

/// From the start on and before the end.
#[test]
fn a_ball_is_hit_while_the_robot_moves() {
    let told = |time: &str| {
        let ball = format!("impact = {{ link = 'cart', normal = [1, 0, 0], mass = 1, restitution = 1, time = {time} }}");
        let session = session(&format!("simulation = {{ start = 0.5, end = 1.0 }}\n{ball}"), CART);
        session.check(&session.settings().unwrap()).map_err(|e| e.to_string())
    };
    assert_eq!([told("0.5"), told("0.999")], [const { Ok(()) }; 2]);
    for (time, found) in [("1", "1.0"), ("0.499", "0.499")] {
        let expected = format!("s.toml:2: impact.time: found {found}, expected a time from 0.5 s on and before 1.0 s");
        assert_eq!(told(time), Err(expected));
    }
}

#[test]
fn a_begin_that_does_not_fit_the_robot_is_refused() {
    let session = session("simulation = { end = 0.1 }", ARM);
    let mut motion = session.motion(&session.model, &session.frame_names(), session.settings().unwrap()).unwrap();
    let initial = session.initial_state().unwrap();
    let mut told = |initial: &InitialState| -> Vec<Fault> {
        motion.run(initial, &mut |_, _| true).unwrap_err().errors.into_iter().map(|e| e.fault).collect()
    };
    let length = |vector, found, expected| Fault::State(StateError::Length { vector, found, expected });
    assert_eq!(told(&InitialState { q: vec![0.0], v: vec![], ..initial.clone() }), [length("q", 1, 6), length("v", 0, 5)]);
    let torque = InitialState { controller: Controller::Torque(vec![]), ..initial.clone() };
    assert_eq!(told(&torque), [length("control.torque", 0, 5)]);
    let table = |wrong| Fault::State(StateError::Table { table: "control.rows", wrong });
    let series = Series { times: vec![0.0, 1.0], rows: vec![vec![0.0; 2]], between: Interpolation::Linear };
    let pd = Controller::Pd { target: Aim::Moving(series), kp: vec![], kd: vec![0.0; 5], torque: vec![0.0; 5] };
    let expected = [
        table(TableError::Rows { found: 1, expected: 2 }),
        table(TableError::Width { row: 0, found: 2, expected: 6 }),
        length("control.kp", 0, 5),
    ];
    assert_eq!(told(&InitialState { controller: pd, ..initial.clone() }), expected);
    let nowhere = InitialState { q: [0.0, f64::NAN].into_iter().chain([0.0; 3]).chain([1.0]).collect(), ..initial };
    assert!(matches!(&told(&nowhere)[..], [Fault::State(StateError::NotFinite { vector: "q", index: 1, .. })]));
}

#[test]
fn a_start_beyond_its_limits_is_odd_and_used() {
    let session = session("initial = { q = { shoulder = 1.75, elbow = -1.0 } }\nsimulation = { end = 0.1 }", ARM);
    let initial = session.initial_state().unwrap();
    let [beyond] = &session.beyond(&initial.q)[..] else { panic!("one joint") };
    assert_eq!((beyond.joint.as_str(), beyond.found, beyond.lower, beyond.upper), ("shoulder", 1.75, -1.5, 1.5));
    let told = "s.toml: initial.q.shoulder: found 1.75, beyond its limits, expected -1.5 to 1.5; used as given";
    assert_eq!((beyond.to_string().as_str(), initial.q[0]), (told, 1.75));
    // A joint at its bound is not beyond it.
    let beyond = |shoulder: f64, elbow: f64| session.beyond(&[shoulder, elbow, 0.0, 0.0, 0.0, 1.0]).len();
    assert_eq!([beyond(1.5, 0.3), beyond(-1.5, -2.0), beyond(1.5, 0.301), beyond(-1.501, -2.0)], [0, 0, 1, 1]);
}
