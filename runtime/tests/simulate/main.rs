//! Laws of motion, for every integrator.

mod closed_forms;
mod orders;
mod robots;
mod stiff;
