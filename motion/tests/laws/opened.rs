//! Stages opened by the name of a scene's file.

use articulated_motion::Session;

use super::{moved, words};

fn path(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/laws").join(name)
}

#[test]
fn a_scene_that_is_opened_moves_as_the_one_that_is_put_together() {
    let opened = Session::open(path("arm.toml")).unwrap_or_else(|e| panic!("{e}"));
    let together = super::session(include_str!("arm.toml"), super::ARM);
    let (a, b) = (moved(&opened), moved(&together));
    assert_eq!((&a.recording, words(&a)), (&b.recording, words(&b)));
    assert!(opened.report.on.len() == opened.effects.len() && !opened.effects.is_empty());
}

#[test]
fn what_the_scene_edits_moves_and_what_is_odd_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(path("arm.urdf"), folder.path().join("arm.urdf")).unwrap();
    let scene = "urdf = 'arm.urdf'\nlock = { wrist = [0, 0, 0, 1], elbow = -9.5 }\npayload = { link = 'hand', mass = 3 }\nsimulation = { end = 0.5 }";
    std::fs::write(folder.path().join("edited.toml"), scene).unwrap();
    let edited = Session::open(folder.path().join("edited.toml")).unwrap_or_else(|e| panic!("{e}"));
    let plain = super::session("", super::ARM);
    assert_eq!((edited.model.nv(), plain.model.nv()), (1, 5));
    assert!((edited.model.moving_mass() - plain.model.moving_mass() - 3.0).abs() < 1e-12);
    assert!(edited.warnings.iter().any(|warning| warning.to_string().contains("joint \"elbow\"")), "{:?}", edited.warnings);
    let r = moved(&edited).recording;
    // No torques and no losses.
    assert!(r.imbalance(r.len() - 1).is_some_and(|joules| joules.abs() < 1e-4) && r.q_at(0) != r.q_at(r.len() - 1));
}

#[test]
fn scenes_that_cannot_be_had_say_why() {
    let told = |name: &str| Session::open(path(name)).unwrap_err().to_string();
    assert!(told("no.toml").starts_with(&format!("{}: ", path("no.toml").display())));
    assert!(told("arm.urdf").starts_with(&format!("{}:1: ", path("arm.urdf").display())));
}
