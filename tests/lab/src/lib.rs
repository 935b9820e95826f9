//! The laboratory: measures generated code.
//!
//! * [`compare`]: against the generic library and peers, on one robot.
//! * [`accuracy`]: the cost of accuracy for each level; integrators on the motion of a scene.
//! * [`scaling`]: how costs grow with the length of a robot.
//! * [`stress`]: a corpus of hard cases, each with its limit.
//! * [`against`]: whole simulations compared with peers.
//!
//! The inputs are a robot, [`robot::Robot`], and a scene, [`session::Session`]. A measurement
//! returns a report, which can be printed as text, as JSON ([`json::json`]), and as files. The
//! command `articulated` reads the command line, loads, and prints; tests use [`states`],
//! [`compiled::Compiled`] and [`scaling::chain::chain`].

pub mod accuracy;
pub mod against;
pub mod compare;
pub mod compiled;
pub mod console;
pub mod error;
pub mod json;
pub mod ledger;
mod native;
pub mod parallel;
pub mod plot;
pub mod process;
pub mod robot;
pub mod scaling;
pub mod session;
pub mod states;
pub mod straight;
pub mod stress;
pub mod table;
pub mod tips;
