//! What touches in states with constraints, and how exact their accelerations are.

use articulated::Model;
use articulated_core::algorithm::{FunctionError, Workspace};
use articulated_core::constraint::CONTACT;
use articulated_core::step::step;
use numpy::{PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::of_same_states;
use crate::rollout::array;

/// Places of contact, and how exact the accelerations are.
pub(crate) type Found<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f64>>);

/// Numbers of each place of contact, `[states][contacts][13]`, and the relative error and the steps
/// of the search, `[states][2]`. `given`: q `[states][nq]`, v `[states][nv]`, act `[states][na]`
/// and ctrl `[states][nu]`.
pub(crate) fn run<'py>(py: Python<'py>, model: &Model<f64>, given: [&PyReadonlyArray2<'py, f64>; 4]) -> PyResult<Found<'py>> {
    let shape = model.shape();
    let sizes = [shape.nq, shape.nv, shape.activations, shape.controls];
    let states = given[0].shape()[0];
    let parts = of_same_states(given, sizes)?;
    let (nv, length) = (shape.nv, CONTACT * shape.contacts);
    let (mut places, mut certificates) = (vec![0.0; states * length], vec![0.0; states * 2]);
    let one = |ws: &mut Workspace<f64>, state: usize, places: &mut [f64], certificate: &mut [f64]| -> Result<(), FunctionError> {
        let [q, v, act, ctrl] = [0, 1, 2, 3].map(|part| &parts[part][state * sizes[part]..][..sizes[part]]);
        let (zeros, mut found) = (vec![0.0; nv], vec![0.0; nv + 3]);
        if let (Some(search), Some(forces)) = (step("constrained_search"), step("contact_forces")) {
            search.call(model, ws, &[q, v, act, ctrl, &zeros], &mut found)?;
            forces.call(model, ws, &[q, v, &found[..nv]], places)?;
        }
        let [error, size, steps] = [found[nv], found[nv + 1], found[nv + 2]];
        certificate.copy_from_slice(&[if error > 0.0 { error / size } else { error }, steps]);
        Ok(())
    };
    let done = py.detach(|| {
        let mut ws = Workspace::new(model);
        (0..states).try_for_each(|k| one(&mut ws, k, &mut places[k * length..][..length], &mut certificates[2 * k..][..2]))
    });
    done.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let of_states = PyArray2::<f64>::zeros(py, [states, 2], false);
    // The array is new: no other reference to it exists.
    of_states.readwrite().as_slice_mut()?.copy_from_slice(&certificates);
    Ok((array(py, [states, shape.contacts, CONTACT], &places)?, of_states))
}
