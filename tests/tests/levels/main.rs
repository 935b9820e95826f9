//! Levels of accuracy: what each promises, held to 96 digits. The same on a million states, and on
//! every `f32`, stands behind `--ignored`.

mod code;
mod sines;
