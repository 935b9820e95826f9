//! How a motion is stepped, as data.

use serde::Serialize;

/// An integrator, or the steps of a robot's file.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Method {
    pub(super) name: &'static str,
    pub(super) order: u32,
    /// Fixed steps of this length.
    pub(super) step_s: Option<f64>,
    pub(super) rtol: f64,
    pub(super) atol: f64,
}
