//! Many steps of many states, one after the other.

use articulated::Model;
use articulated_core::algorithm::Workspace;
use articulated_core::step::{State, rollout, step, steps};
use numpy::{PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::batch;

/// States and rates after steps, state by state.
type Ends<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>);

/// The states after every so many steps, `[states][records][nq]` and `[…][nv]`. q: `[states][nq]`,
/// v: `[states][nv]`, tau: `[states][steps][nv]`.
pub(crate) fn run<'py>(
    py: Python<'py>,
    model: &Model<f64>,
    method: &str,
    (q, v, tau): (&PyReadonlyArray2<'py, f64>, &PyReadonlyArray2<'py, f64>, &PyReadonlyArray3<'py, f64>),
    h: f64,
    every: usize,
    threads: usize,
) -> PyResult<Ends<'py>> {
    let name = if method.starts_with("step_") { method.to_owned() } else { format!("step_{method}") };
    let row = step::<f64>(&name).ok_or_else(|| {
        let all: Vec<&str> = steps::<f64>().iter().filter_map(|row| row.name.strip_prefix("step_")).collect();
        PyValueError::new_err(format!("method: found {method:?}, expected one of {}", all.join(", ")))
    })?;
    let (nq, nv) = (model.nq(), model.nv());
    let ([states, _], [_, count, _]) = ([q.shape()[0], nq], [states_of(tau), tau.shape()[1], nv]);
    let fits = q.shape() == [states, nq] && v.shape() == [states, nv] && tau.shape() == [states, count, nv];
    let wrong = || PyValueError::new_err("found arrays of other shapes, expected q, v and tau of the same states");
    if !fits || every == 0 {
        return Err(wrong());
    }
    let [given_q, given_v, given_tau] = [q.as_slice(), v.as_slice(), tau.as_slice()].map(|slice| slice.map_err(|_| wrong()));
    let (given_q, given_v, given_tau) = (given_q?, given_v?, given_tau?);
    let records = count / every;
    let (mut out_q, mut out_v) = (vec![0.0; states * records * nq], vec![0.0; states * records * nv]);
    let one = |(state, (out_q, out_v)): (usize, (&mut [f64], &mut [f64]))| {
        let torques = (0..count).map(|k| &given_tau[(state * count + k) * nv..][..nv]);
        let (q, v) = (given_q[state * nq..][..nq].to_vec(), given_v[state * nv..][..nv].to_vec());
        let mut state = State { q, v, act: Vec::new() };
        let see = |k: usize, State { q, v, .. }: &State| {
            if (k + 1) % every == 0 {
                let at = (k + 1) / every - 1;
                out_q[at * nq..][..nq].copy_from_slice(q);
                out_v[at * nv..][..nv].copy_from_slice(v);
            }
        };
        rollout(row, (model, &mut Workspace::new(model)), &mut state, h, torques, see)
    };
    let pool = batch::pool(threads)?;
    let done = py.detach(|| {
        let chunks = (out_q.chunks_mut((records * nq).max(1)), out_v.chunks_mut((records * nv).max(1)));
        let mut all: Vec<_> = chunks.0.zip(chunks.1).enumerate().collect();
        match pool {
            Some(pool) => pool.install(|| all.into_par_iter().try_for_each(one)),
            None => all.drain(..).try_for_each(one),
        }
    });
    done.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok((array(py, [states, records, nq], &out_q)?, array(py, [states, records, nv], &out_v)?))
}

fn states_of(tau: &PyReadonlyArray3<'_, f64>) -> usize {
    tau.shape()[0]
}

fn array<'py>(py: Python<'py>, shape: [usize; 3], numbers: &[f64]) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let array = PyArray3::<f64>::zeros(py, shape, false);
    // The array is new: no other reference to it exists.
    array.readwrite().as_slice_mut()?.copy_from_slice(numbers);
    Ok(array)
}
