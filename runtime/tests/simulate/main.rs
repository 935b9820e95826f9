//! Laws of motion, for every integrator.

mod blows;
mod closed_forms;
mod driven;
mod events;
mod orders;
mod refused;
mod robots;
mod stiff;
