//! States in MuJoCo's conventions, and back.

use articulated::Model;
use articulated_core::algorithm::{Group, Workspace};
use articulated_core::step::step;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{of_same_states, other_states};

/// Positions `[states][nq]` and rates `[states][nv]` of each state, by a function of the group
/// `mujoco`.
pub(crate) fn run<'py>(
    py: Python<'py>,
    model: &Model<f64>,
    name: &str,
    positions: &PyReadonlyArray2<'py, f64>,
    rates: &PyReadonlyArray2<'py, f64>,
) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
    let row = step::<f64>(name).filter(|row| row.group == Group::Mujoco).ok_or_else(other_states)?;
    let (nq, nv, states) = (model.nq(), model.nv(), positions.shape()[0]);
    let [positions, rates] = of_same_states([positions, rates], [nq, nv])?;
    let out = [PyArray2::<f64>::zeros(py, [states, nq], false), PyArray2::<f64>::zeros(py, [states, nv], false)];
    // The arrays are new: no other reference to them exists.
    let [mut first, mut second] = out.each_ref().map(PyArrayMethods::readwrite);
    let (first, second) = (first.as_slice_mut()?, second.as_slice_mut()?);
    let (mut ws, mut both) = (Workspace::new(model), vec![0.0; nq + nv]);
    for k in 0..states {
        let inputs = [&positions[k * nq..][..nq], &rates[k * nv..][..nv]];
        row.call(model, &mut ws, &inputs, &mut both).map_err(|error| PyValueError::new_err(error.to_string()))?;
        first[k * nq..][..nq].copy_from_slice(&both[..nq]);
        second[k * nv..][..nv].copy_from_slice(&both[nq..]);
    }
    Ok(out)
}
