//! Generated code, compiled and run as a user's would be: against the generic library, against an
//! independent program, and on unusual input.

mod actuated_steps;
mod balls;
mod batches;
mod c;
mod choices;
mod constrained_steps;
mod derivatives;
mod effects;
mod equals_generic;
mod followers;
mod hard_contacts;
mod interpreted;
mod limbs;
mod odd_robots;
mod oracles;
mod parameters;
mod regions;
mod robots;
mod scenes;
mod steps;
mod user_functions;
