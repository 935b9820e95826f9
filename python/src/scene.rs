//! Scenes and their motions: what the command `articulated simulate` does.

use std::path::PathBuf;

use articulated_cli::scene::{self, Changes, Refusal};
use numpy::PyArray1;
use pyo3::prelude::*;

/// A value and the warnings on the way to it.
pub(crate) type WithWarnings<T> = PyResult<(T, Vec<String>)>;

/// Steps between two looks at signals, so that a user can interrupt a motion.
const BLOCK: u64 = 1 << 8;

/// The bundled scenes: name and summary.
#[pyfunction]
pub(crate) fn bundled_scenes() -> Vec<(&'static str, &'static str)> {
    articulated_models::SCENES.iter().chain(articulated_models::LAW_SCENES).map(|scene| (scene.name, scene.summary())).collect()
}

/// `articulated.RobotError` with the findings of a refusal.
fn refused(py: Python<'_>, refusal: &Refusal) -> PyErr {
    let error = || {
        let errors = py.import("json")?.call_method1("loads", (&refusal.json,))?.get_item("errors")?;
        py.import("articulated._errors")?.getattr("RobotError")?.call1((&refusal.message, errors))
    };
    error().map_or_else(|failed| failed, PyErr::from_value)
}

/// The value, or the error that Python raises.
pub(crate) fn told<T>(py: Python<'_>, (out, warnings): scene::WithWarnings<T>) -> WithWarnings<T> {
    Ok((out.map_err(|refusal| refused(py, &refusal))?, warnings))
}

/// A scene. `articulated.Scene` opens one.
#[pyclass(frozen, module = "articulated._native")]
pub(crate) struct Scene(scene::Scene);

#[pymethods]
impl Scene {
    /// A bundled scene by its name, or that of a file.
    #[staticmethod]
    fn open(py: Python<'_>, scene: PathBuf) -> WithWarnings<Self> {
        let (scene, warnings) = told(py, py.detach(|| scene::Scene::open(&scene)))?;
        Ok((Self(scene), warnings))
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    #[allow(clippy::too_many_arguments)] // Why: what a scene's `[simulation]` has, one by one.
    fn run(
        &self,
        py: Python<'_>,
        end: Option<f64>,
        integrator: Option<String>,
        step: Option<f64>,
        rtol: Option<f64>,
        atol: Option<f64>,
        every: Option<f64>,
    ) -> WithWarnings<Recorded> {
        let changes = Changes { end, integrator, step, rtol, atol, every };
        let (mut steps, mut interrupt) = (0_u64, None);
        let mut go_on = || {
            steps += 1;
            if steps.is_multiple_of(BLOCK) {
                interrupt = Python::attach(|py| py.check_signals()).err();
            }
            interrupt.is_none()
        };
        let out = py.detach(|| self.0.run(&changes, &mut go_on));
        interrupt.map_or(Ok(()), Err)?;
        let (recorded, warnings) = told(py, out)?;
        Ok((Recorded(recorded), warnings))
    }
}

/// A motion with all that is recorded of it.
#[pyclass(frozen, module = "articulated._native")]
pub(crate) struct Recorded(scene::Recorded);

/// A column: its title, its unit, and a number for each time.
type Column<'py> = (String, String, Bound<'py, PyArray1<f64>>);

#[pymethods]
impl Recorded {
    fn columns<'py>(&self, py: Python<'py>) -> Vec<Column<'py>> {
        self.0.columns().into_iter().map(|column| (column.title, column.unit, PyArray1::from_vec(py, column.values))).collect()
    }

    /// nq and nv.
    fn sizes(&self) -> (usize, usize) {
        self.0.sizes()
    }

    /// JSON.
    fn summary(&self) -> String {
        self.0.summary()
    }

    /// Writes a folder, or a page. The names of the files.
    fn write(&self, py: Python<'_>, path: PathBuf, packages: Vec<PathBuf>) -> WithWarnings<Vec<String>> {
        told(py, py.detach(|| self.0.write(&path, &packages)))
    }
}
