//! Results of the oracle; its format is described in `tests/oracles/README.md`.

use std::fs;
use std::path::Path;

use serde::Deserialize;

/// One robot's reference values.
#[derive(Clone, Debug, Deserialize)]
pub struct Fixture {
    /// The robot's name.
    pub robot: String,
    /// `fixed` or `floating`.
    pub base: String,
    /// m/s², world frame.
    pub gravity: [f64; 3],
    /// Names in the order of the coordinates.
    pub joints: Vec<String>,
    /// Length of q.
    pub nq: usize,
    /// Length of v.
    pub nv: usize,
    /// Names in the order of the file.
    pub links: Vec<String>,
    /// The states.
    pub states: Vec<Reference>,
}

/// One state and its expected results.
#[derive(Clone, Debug, Deserialize)]
pub struct Reference {
    /// `[nq]`.
    pub q: Vec<f64>,
    /// `[nv]`.
    pub v: Vec<f64>,
    /// `[nv]`.
    pub a: Vec<f64>,
    /// τ, `[nv]`.
    pub inverse_dynamics: Vec<f64>,
    /// The scale of errors in τ, `[nv]`.
    pub torque_scale: Vec<f64>,
    /// T, J.
    pub kinetic_energy: f64,
    /// U, J; 0 at the origin of the world frame.
    pub potential_energy: f64,
    /// For each link [R by rows, p]; in some states only.
    pub placements: Option<Vec<[f64; 12]>>,
}

/// The fixture of a robot.
///
/// # Panics
/// If it is missing or unreadable: every bundled robot must have one.
pub fn fixture(robot: &str) -> Fixture {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("oracles/fixtures/{robot}.json"));
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("no reference for {robot} ({e}): run python3 tests/oracles/make.py"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("the reference for {robot}: {e}"))
}
