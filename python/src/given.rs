//! A step of states with constraints, among them contacts that a caller finds.

use articulated::Model;
use articulated_core::algorithm::{Group, Workspace};
use articulated_core::constraint::GIVEN;
use articulated_core::step::{CONTACTS, H, beside_the_table, step};
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::of_same_states;

/// q, v, activations and `warm` after the step, a row for each state.
pub(crate) type Ends<'py> = [Bound<'py, PyArray2<f64>>; 4];

/// The states after a step of `method`. `given`: q `[states][nq]`, v `[states][nv]`, act
/// `[states][na]`, ctrl `[states][nu]`, contacts `[states][given · 8]`, warm `[states][nv]`.
pub(crate) fn run<'py>(
    py: Python<'py>,
    model: &Model<f64>,
    method: &str,
    given: [&PyReadonlyArray2<'py, f64>; 6],
    h: f64,
) -> PyResult<Ends<'py>> {
    let shape = model.shape();
    let (group, ending) = if shape.given > 0 { (Group::GivenContacts, "_with_contacts") } else { (Group::Constraints, "") };
    let methods = || beside_the_table::<f64>().filter(|row| row.group == group && row.takes.contains(&H));
    let name_of = |name: &'static str| name.strip_prefix("constrained_step_").and_then(|name| name.strip_suffix(ending)).unwrap_or(name);
    let name = format!("constrained_step_{method}{ending}");
    let row = step::<f64>(&name).filter(|row| row.group == group && row.takes.contains(&H)).ok_or_else(|| {
        let all: Vec<&str> = methods().map(|row| name_of(row.name)).collect();
        PyValueError::new_err(format!("method: found {method:?}, expected one of {}", all.join(", ")))
    })?;
    let sizes = [shape.nq, shape.nv, shape.activations, shape.controls, GIVEN * shape.given, shape.nv];
    let states = given[0].shape()[0];
    let parts = of_same_states(given, sizes)?;
    let ends = [shape.nq, shape.nv, shape.activations, shape.nv];
    let length: usize = ends.iter().sum();
    let mut all = vec![0.0; states * length];
    let done = py.detach(|| {
        let mut ws = Workspace::new(model);
        all.chunks_mut(length.max(1)).enumerate().try_for_each(|(state, out)| {
            let [q, v, act, ctrl, contacts, warm] = [0, 1, 2, 3, 4, 5].map(|part| &parts[part][state * sizes[part]..][..sizes[part]]);
            let with: &[&[f64]] = &[q, v, act, ctrl, contacts, warm, &[h]];
            let without: &[&[f64]] = &[q, v, act, ctrl, warm, &[h]];
            row.call(model, &mut ws, if row.takes.contains(&CONTACTS) { with } else { without }, out)
        })
    });
    done.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let out = ends.map(|size| PyArray2::<f64>::zeros(py, [states, size], false));
    let mut at = 0;
    for (array, size) in out.iter().zip(ends) {
        // The array is new: no other reference to it exists.
        let mut array = array.readwrite();
        for (row, state) in array.as_slice_mut()?.chunks_mut(size.max(1)).zip(all.chunks(length.max(1))) {
            row.copy_from_slice(&state[at..][..size]);
        }
        at += size;
    }
    Ok(out)
}
