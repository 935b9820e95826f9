//! Levels of accuracy: the contract of each, compared with 96 digits. The same on a million states,
//! and on every `f32`, runs with `--ignored`.

mod code;
mod sines;
