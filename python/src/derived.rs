//! Functions that are traced for a robot when they are first requested: derivatives by name. They
//! run node by node on blocks of states, without a compiler.

use std::panic::{AssertUnwindSafe, catch_unwind};

use articulated::algorithm::{Argument, Shape};
use articulated_codegen::graph::{Graph, Op};
use articulated_codegen::{COptions, FunctionSpec, Output, Request, Target, generate};
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyList;
use rayon::prelude::*;

use crate::{batch, dimensions, errors};

/// States of a part that one thread computes.
pub(crate) const PART: usize = 256;

/// A function that was traced.
#[pyclass(frozen, module = "articulated._native")]
pub(crate) struct Derived {
    graph: Graph,
    arguments: Vec<Argument>,
    outputs: Vec<Output>,
    /// Numbers of each result.
    sizes: Vec<usize>,
}

#[pymethods]
impl Derived {
    /// Names, dimensions and units of the arguments.
    fn takes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for argument in &self.arguments {
            list.append((argument.name(), dimensions(py, argument.dims())?, argument.unit()))?;
        }
        Ok(list)
    }

    /// The same of the results.
    fn gives<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for output in &self.outputs {
            list.append((output.name, dimensions(py, &output.dims)?, output.unit.as_str()))?;
        }
        Ok(list)
    }

    /// The results: arrays with a row for each state. So are the arguments.
    fn run<'py>(&self, py: Python<'py>, arguments: Vec<PyReadonlyArray2<'py, f64>>, threads: usize) -> PyResult<Parts<'py>> {
        let (states, lengths, given) = rows(&arguments)?;
        if arguments.len() != self.arguments.len() {
            return Err(wrong());
        }
        let needed = self.graph.nodes().iter().filter(|node| node.op == Op::Input);
        if needed.into_iter().any(|node| lengths.get(node.args[0] as usize).is_none_or(|length| node.args[1] as usize >= *length)) {
            return Err(wrong());
        }
        let results = self.graph.outputs.len();
        let mut out = vec![0.0; states * results];
        py.detach(|| {
            let part = |(first, out): (usize, &mut [f64])| {
                let input = |argument: usize, k: usize, state: usize| given[argument][(first * PART + state) * lengths[argument] + k];
                self.graph.evaluate_many(out.len() / results.max(1), input, out);
            };
            let size = (PART * results).max(1);
            if threads == 1 || states <= PART {
                out.chunks_mut(size).enumerate().for_each(part);
            } else {
                out.par_chunks_mut(size).enumerate().for_each(part);
            }
        });
        let mut at = 0;
        let part = |&size: &usize| {
            let array = PyArray2::<f64>::zeros(py, [states, size], false);
            // The array is new: no other reference to it exists.
            for (row, all) in array.readwrite().as_slice_mut()?.chunks_mut(size.max(1)).zip(out.chunks(results.max(1))) {
                row.copy_from_slice(&all[at..][..size]);
            }
            at += size;
            Ok(array)
        };
        self.sizes.iter().map(part).collect()
    }
}

/// Results, each with a row for each state.
pub(crate) type Parts<'py> = Vec<Bound<'py, PyArray2<f64>>>;

/// The number of states, the lengths of rows and the numbers of arrays with a row for each state.
pub(crate) fn rows<'a>(arrays: &'a [PyReadonlyArray2<'_, f64>]) -> PyResult<(usize, Vec<usize>, Vec<&'a [f64]>)> {
    let states = arrays.first().map_or(1, |array| array.shape()[0]);
    if arrays.iter().any(|array| array.shape()[0] != states) {
        return Err(wrong());
    }
    let given = arrays.iter().map(|array| array.as_slice().map_err(|_| wrong())).collect::<PyResult<_>>()?;
    Ok((states, arrays.iter().map(|array| array.shape()[1]).collect(), given))
}

pub(crate) fn wrong() -> PyErr {
    PyValueError::new_err("found arguments of other shapes, expected a row for each state")
}

impl Derived {
    /// The function of this request, such as `g = vjp(inverse_dynamics)`.
    pub(crate) fn of(py: Python<'_>, shape: Shape, mut request: Request, text: String) -> PyResult<Self> {
        let spec = FunctionSpec::parse(&text).map_err(|error| PyValueError::new_err(error.to_string()))?;
        if spec.transform.is_none() {
            return Err(PyValueError::new_err(format!("found {text:?}, expected a derivative, such as vjp(inverse_dynamics)")));
        }
        request.options.functions = vec![text.into()];
        (request.options.limbs, request.options.stages) = (false, false);
        // The text is not used: names are those of the target that has the fewest rules for them.
        request.options.target = Target::C(COptions { prefix: Some("robot".into()), ..COptions::default() });
        request.options.max_code_size = u64::MAX;
        let generated = py.detach(|| catch_unwind(AssertUnwindSafe(|| generate(&request)))).map_err(|_| batch::mistake())?;
        let mut generated = generated.map_err(|findings| errors::refused(py, &findings))?;
        let graph = generated.graphs.pop().unwrap_or_default();
        let outputs = spec.outputs();
        let sizes = outputs.iter().map(|output| output.dims.iter().map(|dim| dim.len(shape)).product()).collect();
        Ok(Self { graph, arguments: spec.arguments(), outputs, sizes })
    }
}
