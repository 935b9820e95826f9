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
//!
//! Without the feature `measure` there are only the inputs, and parts of reports: nothing is
//! compiled, loaded or measured.

#[cfg(feature = "measure")]
pub mod accuracy;
#[cfg(feature = "measure")]
pub mod against;
#[cfg(feature = "measure")]
pub mod compare;
#[cfg(feature = "measure")]
pub mod compiled;
pub mod console;
pub mod error;
pub mod json;
pub mod ledger;
#[cfg(feature = "measure")]
mod native;
pub mod parallel;
pub mod plot;
#[cfg(feature = "measure")]
pub mod process;
pub mod residual;
pub mod robot;
#[cfg(feature = "measure")]
pub mod scaling;
pub mod session;
pub mod states;
#[cfg(feature = "measure")]
pub mod straight;
#[cfg(feature = "measure")]
pub mod stress;
pub mod table;
pub mod timing;
pub mod tips;
