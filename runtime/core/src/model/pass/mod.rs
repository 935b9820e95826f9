//! Model passes: `Model → Model`, keeping the physics.

mod regroup;

pub use regroup::regroup;

use super::Model;

/// A pass over models.
pub type ModelPass = fn(Model<f64>) -> Model<f64>;

/// The passes in order; each row: name, pass, and what holds after it.
pub const MODEL_PASSES: &[(&str, ModelPass, &str)] = &[(
    "regroup",
    regroup,
    "no revolute body has m, h_z or Σ_zz, no prismatic body has Σ, no spherical body has m: its parent has them; joint torques are the same, wrenches between bodies are not",
)];
