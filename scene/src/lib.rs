//! Scenes: a robot, its base, its gravity, the effects that matter, and a motion, read from TOML.
//!
//! [`Scene::read`] reads a scene's text, [`open`] reads the files that it names too, and
//! [`Opened::build`] returns the robot with the scene's edits and effects:
//!
//! ```
//! use articulated_scene::Scene;
//!
//! let scene = Scene::read("arm.toml", "robot = \"panda_like\"\n[effects.damping]\n\"*\" = 0.1\n").unwrap();
//! assert_eq!(scene.effects.len(), 1);
//!
//! let errors = Scene::read("arm.toml", "robot = \"panda_like\"\n[effects.dampign]\n\"*\" = 0.1\n").unwrap_err();
//! assert!(errors.to_string().starts_with("arm.toml:2: effects.dampign: found a key that is not known"));
//! ```
//!
//! [`open`] reads a scene's file and all files that it names. With documents in memory:
//!
//! ```
//! use articulated_core::description::Base;
//! use articulated_scene::{Opened, Scene};
//!
//! let urdf = r#"<robot name="door"><link name="frame"/>
//!   <link name="leaf"><inertial><mass value="8"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="0.2"/></inertial></link>
//!   <joint name="hinge" type="continuous"><parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/></joint></robot>"#;
//! let scene = Scene::read("door.toml", "effects = { damping = { hinge = 0.1 } }")?;
//! let door = Opened::new(scene, "door.urdf", urdf.into(), Base::Fixed, vec![]).build()?;
//! assert_eq!((door.model.nv(), door.effects.len()), (1, 1)); // the model has the damping, N·m·s/rad
//! # Ok::<(), articulated_core::diagnostic::Diagnostics>(())
//! ```
//!
//! The way of a scene: text → tree (tables and numbers with their lines) → [`Scene`] (checked, by
//! tables of keys) → against a robot: [`Scene::resolve`] (effects with all their numbers),
//! [`Scene::start`] and [`Scene::controller`] (vectors). [`open`] reads the files that a scene
//! names, and [`Opened::build`] edits the robot and returns its model and effects. No input makes
//! the reader panic or hang. The keys are listed in `docs/scenes.md`.

mod calls;
mod control;
mod csv;
mod document;
mod doubt;
mod edits;
mod effects;
mod impact;
mod initial;
pub mod manual;
mod report;
mod robot;
mod scene;
mod series;
mod shaft;
mod simulation;
mod slots;
mod table;
mod tree;
mod world;

pub use articulated_core::actuator::{ActuatorLaw, Actuators, Transmission};
pub use articulated_core::control::{Aim, Controller, Series, Signal};
pub use articulated_core::settings::{Output, Settings, Stiffness};
pub use calls::Calls;
pub use control::{Control, Drive, PerJoint, Target};
pub use edits::{Append, Follower, Load, Lock};
pub use effects::{Edited, EffectRequest, Numbers, Resolved, Selector, smooth_in_file, still};
pub use impact::{Impact, When};
pub use initial::{BaseState, Coordinates, Initial, Named};
pub use report::{EffectCount, EffectOff, EffectOn, Number, Report, Why};
pub use robot::{
    Appended, BuiltRobot, Bundled, Loader, Opened, RobotOptions, RobotRequest, beside, beyond_sense, folder_of, open, open_in,
    open_in_into, open_into,
};
pub use scene::{CodeOptions, Places, Robot, Scene};
pub use series::{Between, Reader, Source, open_table};
pub use shaft::ShaftRequest;
pub use simulation::{EventClass, Law, Simulation};
pub use tree::{Entry, Node, Value};
pub use world::RobotInWorld;
