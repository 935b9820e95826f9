//! Regressors times the inertial parameters of the links of a file: torques and energies.

use articulated_core::algorithm::FunctionId;
use articulated_core::description::Description;
use articulated_core::dynamics::Dynamics;
use articulated_core::index::BodyId;
use articulated_core::model::Model;
use articulated_core::spatial::{Placement, SpatialInertia};

use crate::case::State;

/// Relative to the terms of a sum.
const BOUND: f64 = 1e-12;

/// π of each moving link, `[links][10]`, from the inertial data of the description: those of all
/// links of its body, moved to the frame of the moving link. The model has the frames of all links.
pub fn parameters_of_links(description: &Description, model: &Model<f64>) -> Vec<f64> {
    let frame = |name: &str| &model.frames().iter().find(|frame| frame.name == name).expect("a frame of each link").placement;
    let bodies = model.bodies_of_links(description);
    let one = |body: BodyId| {
        let own = frame(&model.bodies()[body].link.as_ref().expect("a link").name);
        let turn = own.rotation.transpose();
        let back = Placement { rotation: turn, position: -(turn * own.position) };
        let parts = description.links.iter().zip(&bodies).filter(|(_, of)| **of == body);
        let inertias = parts.filter_map(|(link, _)| Some((link.inertial?, back.compose(frame(&link.name)))));
        inertias
            .fold(SpatialInertia::<f64>::zero(), |mut sum, (own, at)| {
                sum += own.spatial_inertia().moved(&at);
                sum
            })
            .parameters()
    };
    model.links().flat_map(one).collect()
}

/// Violations of τ = Y π, T = yᵀπ or U = yᵀπ for a model without effects, with π of the inertial
/// data of the description, or of the model.
pub fn broken_laws(description: &Description, model: &Model<f64>, state: &State) -> Vec<String> {
    let mut ws = model.workspace();
    let mut called = |function: FunctionId, given: &[&[f64]]| {
        let mut out = vec![0.0; function.row::<f64>().len(model.shape())];
        model.call(function, &mut ws, given, &mut out).expect("arguments of the right lengths");
        out
    };
    let (of_file, of_model) = (parameters_of_links(description, model), model.inertial_parameters().concat());
    let mut broken = Vec::new();
    for (regressor, function, given) in [
        (FunctionId::torque_regressor, FunctionId::inverse_dynamics, &[&state.q[..], &state.v, &state.a][..]),
        (FunctionId::kinetic_energy_regressor, FunctionId::kinetic_energy, &[&state.q[..], &state.v]),
        (FunctionId::potential_energy_regressor, FunctionId::potential_energy, &[&state.q[..]]),
    ] {
        let (y, expected) = (called(regressor, given), called(function, given));
        for (source, pi) in [("file", &of_file), ("model", &of_model)] {
            for (k, expected) in expected.iter().enumerate() {
                let row = &y[k * pi.len()..][..pi.len()];
                let (found, size) = row.iter().zip(pi).fold((0.0, 0.0), |(sum, size), (y, p)| (sum + y * p, size + (y * p).abs()));
                // A sum of no terms is zero. A number that is NaN breaks the law.
                let is_kept = (found - expected).abs() <= BOUND * size.max(f64::MIN_POSITIVE);
                if !is_kept {
                    broken.push(format!("{} [{k}], π of the {source}: found {found}, expected {expected}", regressor.name()));
                }
            }
        }
    }
    broken
}
