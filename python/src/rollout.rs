//! Many steps of many states, one after the other.

use articulated::Model;
use articulated_core::algorithm::Workspace;
use articulated_core::step::{CONTACTS, CTRL, H, State, beside_the_table, rollout, step};
use numpy::{PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::other_states;
use crate::batch;

/// How names of steps begin: with torques, with controls of actuators, and with constraints too.
const KINDS: [&str; 3] = ["step_", "actuated_step_", "constrained_step_"];

/// Coordinates, rates and activations after steps, state by state.
pub(crate) type Ends<'py> = [Bound<'py, PyArray3<f64>>; 3];

/// The states after every so many steps, `[states][records][nq]`, `[…][nv]` and `[…][na]`. q:
/// `[states][nq]`, v: `[states][nv]`, act: `[states][na]`; held: torques `[states][steps][nv]`, or
/// controls `[states][steps][nu]` of a step with actuators.
pub(crate) fn run<'py>(
    py: Python<'py>,
    model: &Model<f64>,
    method: &str,
    (start, held): ([&PyReadonlyArray2<'py, f64>; 3], &PyReadonlyArray3<'py, f64>),
    h: f64,
    every: usize,
    threads: usize,
) -> PyResult<Ends<'py>> {
    let row = step::<f64>(method).filter(|row| row.takes.contains(&H) && !row.takes.contains(&CONTACTS)).ok_or_else(|| {
        let prefix = KINDS.into_iter().find(|kind| method.starts_with(kind)).unwrap_or(KINDS[0]);
        let found = method.strip_prefix(prefix).unwrap_or(method);
        let all: Vec<&str> = beside_the_table::<f64>()
            .filter(|row| !row.takes.contains(&CONTACTS))
            .filter_map(|row| row.name.strip_prefix(prefix))
            .collect();
        PyValueError::new_err(format!("method: found {found:?}, expected one of {}", all.join(", ")))
    })?;
    let is_actuated = row.takes.contains(&CTRL);
    let shape = model.shape();
    let width = if is_actuated { shape.controls } else { shape.nv };
    let sizes = [shape.nq, shape.nv, if is_actuated { shape.activations } else { 0 }];
    let [states, count, _] = [held.shape()[0], held.shape()[1], held.shape()[2]];
    let fits = held.shape()[2] == width
        && start.iter().zip(sizes).take(2 + usize::from(is_actuated)).all(|(own, size)| own.shape() == [states, size]);
    if !fits || every == 0 {
        return Err(other_states());
    }
    let mut given: [&[f64]; 3] = [&[]; 3];
    for (into, own) in given.iter_mut().zip(&start).take(2 + usize::from(is_actuated)) {
        *into = own.as_slice().map_err(|_| other_states())?;
    }
    let held = held.as_slice().map_err(|_| other_states())?;
    let records = count / every;
    let mut out = sizes.map(|size| vec![0.0; states * records * size]);
    let one = |(state, mut rows): (usize, [&mut [f64]; 3])| {
        let inputs = (0..count).map(|k| &held[(state * count + k) * width..][..width]);
        let [q, v, act] =
            [0, 1, 2].map(|part| given[part].get(state * sizes[part]..(state + 1) * sizes[part]).unwrap_or_default().to_vec());
        let see = |k: usize, now: &State| {
            if (k + 1) % every == 0 {
                let at = (k + 1) / every - 1;
                let parts = [&now.q, &now.v, &now.act];
                rows.iter_mut().zip(parts).zip(sizes).for_each(|((row, part), size)| row[at * size..][..size].copy_from_slice(part));
            }
        };
        rollout(row, (model, &mut Workspace::new(model)), &mut State { q, v, act, warm: Vec::new() }, h, inputs, see)
    };
    let pool = batch::pool(threads)?;
    let done = py.detach(|| {
        // A part without numbers has no chunks: an empty row for each state.
        let [q, v, act] = &mut out;
        let mut rows: [Vec<&mut [f64]>; 3] = [(q, 0), (v, 1), (act, 2)].map(|(all, part)| match records * sizes[part] {
            0 => (0..states).map(|_| Default::default()).collect(),
            size => all.chunks_mut(size).collect(),
        });
        let [q, v, act] = rows.each_mut().map(|rows| rows.drain(..));
        let mut all: Vec<_> = q.zip(v).zip(act).map(|((q, v), act)| [q, v, act]).enumerate().collect();
        match pool {
            Some(pool) => pool.install(|| all.into_par_iter().try_for_each(one)),
            None => all.drain(..).try_for_each(one),
        }
    });
    done.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let [q, v, act] = [0, 1, 2].map(|part| array(py, [states, records, sizes[part]], &out[part]));
    Ok([q?, v?, act?])
}

pub(crate) fn array<'py>(py: Python<'py>, shape: [usize; 3], numbers: &[f64]) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let array = PyArray3::<f64>::zeros(py, shape, false);
    // The array is new: no other reference to it exists.
    array.readwrite().as_slice_mut()?.copy_from_slice(numbers);
    Ok(array)
}
