//! What a scene's motion in a program has to be.

mod by_hand;
mod errors;
mod events;
mod generated;

use articulated::urdf::{Options, read};
use articulated::{Base, Model};
use articulated_motion::{Outcome, Scene, Stage};
use articulated_scene::Edited;

/// An arm of two hinges, with a hand on a ball joint.
const ARM: &str = include_str!("arm.urdf");

/// A cart of 2 kg that slides along x, up to 0.9 m.
const CART: &str = r#"<robot name="cart"><link name="rail"/>
    <link name="cart"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/>
      <limit lower="-0.5" upper="0.9" effort="9" velocity="9"/></joint></robot>"#;

/// A scene, called `s.toml`, with a robot that it does not edit.
fn stage(scene: &str, urdf: &str) -> Stage {
    let scene = Scene::read("s.toml", scene).unwrap_or_else(|e| panic!("{e}"));
    let robot = read(urdf.as_bytes(), &Options::default()).unwrap();
    let base = scene.base.unwrap_or(Base::Fixed);
    let edited = Edited { description: &robot.description, base, unused: &robot.unused, shafts: &[] };
    let effects = scene.resolve(&edited).unwrap_or_else(|e| panic!("{e}")).effects;
    let model = Model::new(&robot.description, base).unwrap();
    let model = model.with_gravity(scene.gravity.unwrap_or([0.0, 0.0, -9.81])).with_effects(&effects).unwrap();
    Stage::new(scene, robot.description, model, effects)
}

/// Moved by the generic model.
fn moved(stage: &Stage) -> Outcome {
    stage.run(&stage.model, &stage.frame_names()).unwrap_or_else(|e| panic!("{e}"))
}

/// What happened, in words.
fn words(outcome: &Outcome) -> Vec<&str> {
    outcome.happenings.iter().map(|h| h.what.as_str()).collect()
}
