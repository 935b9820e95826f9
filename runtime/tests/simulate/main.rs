//! Laws of motion, for every integrator.

mod closed_forms;
mod driven;
mod events;
mod orders;
mod robots;
mod stiff;
