//! Simulation of any robot, generated or loaded: integrators, events, controllers, recordings.
//!
//! Everything is written over [`crate::Dynamics`]. States are points of the manifold: a step is
//! made in step vectors from where it begins, with the exact correction for joints that turn
//! freely, so that every method keeps its order and quaternions keep their norm.
//!
//! ```
//! use articulated::simulate::{IntegratorId, NoTorque, Settings, Simulation};
//! use articulated::{Base, load_bytes};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let urdf = r#"<robot name="pendulum"><link name="base"/>
//!   <link name="bob"><inertial><origin xyz="0 0 -1"/><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
//!   <joint name="hinge" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;
//! let robot = load_bytes("pendulum.urdf", urdf.as_bytes(), Base::Fixed)?;
//! let settings = Settings { integrator: IntegratorId::dop853, end: 10.0, rtol: 1e-10, atol: 1e-10, ..Settings::default() };
//! let motion = Simulation::new(&robot, settings)?.with_energy_balance().run(&[1.0], &[0.0], &mut NoTorque, &mut [])?;
//! let last = motion.len() - 1;
//! assert!(motion.imbalance(last).is_some_and(|joules| joules.abs() < 1e-8));
//! # Ok(()) }
//! ```
//!
//! Choice of integrators, their properties, and the search for events: `docs/simulation.md`.

mod control;
mod curve;
mod effects;
mod erased;
mod error;
mod event;
mod integrator;
mod manifold;
mod output;
mod recording;
mod simulation;
mod stability;
mod step_control;
mod system;

pub use articulated_core::control::{Aim, Controller, Interpolation, Series, TableError};
pub use articulated_core::integrator::{Integrator, IntegratorId, integrator, integrators, resolve_synonym};
pub use articulated_core::settings::{Output, SettingError, Settings, Stiffness};
pub use control::{Constant, Control, Dependence, Drive, Hold, NoTorque, Pd, TorqueTable};
pub use error::{SimulateError, StateError};
pub use event::{Action, ContactPoint, Direction, Event, Impact, Map, SLIDING, Struck};
pub use recording::{Balance, Counts, Ended, Hit, Recording};
pub use simulation::{Reached, Simulation};
