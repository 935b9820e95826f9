//! Laws of motion, for every integrator.

mod balls;
mod blows;
mod closed_forms;
mod driven;
mod endings;
mod events;
mod free_flight;
mod orders;
mod refused;
mod robots;
mod stepping;
mod stiff;
