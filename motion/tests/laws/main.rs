//! Tests of a scene's motion in a program.

mod by_hand;
mod collision;
mod errors;
mod events;
mod friction;
mod generated;
mod opened;
mod rest;

use articulated::Base;
use articulated_motion::{Outcome, Scene, Session};
use articulated_scene::Opened;

/// An arm of two hinges, with a hand on a ball joint.
const ARM: &str = include_str!("arm.urdf");

/// A cart of 2 kg that slides along x, up to 0.9 m.
const CART: &str = r#"<robot name="cart"><link name="rail"/>
    <link name="cart"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/>
      <limit lower="-0.5" upper="0.9" effort="9" velocity="9"/></joint></robot>"#;

/// A scene, called `s.toml`, with its robot.
fn session(scene: &str, urdf: &str) -> Session {
    let scene = Scene::read("s.toml", scene).unwrap_or_else(|e| panic!("{e}"));
    let opened = Opened::new(scene, "robot.urdf", urdf.into(), Base::Fixed, Vec::new());
    Session::of(opened).unwrap_or_else(|e| panic!("{e}"))
}

/// Moved by the generic model.
fn moved(session: &Session) -> Outcome {
    session.run(&session.model, &session.frame_names()).unwrap_or_else(|e| panic!("{e}"))
}

/// The events, in words.
fn words(outcome: &Outcome) -> Vec<&str> {
    outcome.occurrences.iter().map(|h| h.what.as_str()).collect()
}
