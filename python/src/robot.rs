//! The robot: a model with room for its calls.

use std::ops::Range;
use std::sync::OnceLock;

use articulated::algorithm::{Dim, Function, Needs, functions};
use articulated::description::{Description, Limit};
use articulated::formats::{Disk, NoFiles, Options, Sources, read_with};
use articulated::model::FLOATING_BASE;
use articulated::{Base, Model, Shape};
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics, Place};
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::arrays::{self, Argument};
use crate::batch::{self, Call, Workspaces};
use crate::errors;

/// A robot's model. `articulated.load` makes one.
#[pyclass(frozen, subclass, module = "articulated._native")]
pub(crate) struct Robot {
    model: Model<f64>,
    /// The model's sizes; counting its links takes time.
    shape: Shape,
    /// Names of the links that [`Model::links`] lists.
    links: Vec<String>,
    warnings: Vec<Diagnostic>,
    unused: Vec<String>,
    workspaces: Workspaces,
    lacks: OnceLock<Lacks>,
}

/// Arguments that may be read as they are.
type Arrays<'py> = Vec<Bound<'py, PyArrayDyn<f64>>>;

/// The first index and the end.
type Ends = (usize, usize);

/// What the robot does not have and some functions need.
struct Lacks {
    massless: Vec<String>,
    mass: bool,
    bound_frames: Vec<String>,
}

/// A base's name.
pub(crate) fn name_of(base: Base) -> &'static str {
    match base {
        Base::Fixed => "fixed",
        Base::Floating => "floating",
    }
}

pub(crate) fn base_of(name: &str) -> PyResult<Base> {
    let named = [Base::Fixed, Base::Floating].into_iter().find(|base| name_of(*base) == name);
    named.ok_or_else(|| PyValueError::new_err(format!("base: found {name:?}, expected \"fixed\" or \"floating\"")))
}

/// Names of the moving links, in the order of [`Model::links`].
fn links(description: &Description, model: &Model<f64>) -> Vec<String> {
    let link = |index: Option<usize>| index.and_then(|i| description.links.get(i)).map(|link| link.name.clone());
    let child = |name: &str| link(description.joints.iter().find(|joint| joint.name == name).map(|joint| joint.child));
    let name = |body: &str| if body == FLOATING_BASE { link(description.root()) } else { child(body) };
    model.links().map(|i| model.bodies()[i].name.as_str()).map(|body| name(body).unwrap_or_else(|| body.to_owned())).collect()
}

/// A row of the table.
fn row(index: usize) -> PyResult<&'static Function<f64>> {
    functions::<f64>().get(index).ok_or_else(|| PyValueError::new_err("found no such function"))
}

impl Robot {
    fn with(&self, model: Model<f64>) -> Self {
        let (links, warnings, unused) = (self.links.clone(), self.warnings.clone(), self.unused.clone());
        let shape = model.shape();
        Self { model, shape, links, warnings, unused, workspaces: Workspaces::default(), lacks: OnceLock::new() }
    }

    fn lacks(&self) -> &Lacks {
        self.lacks.get_or_init(|| {
            let model = &self.model;
            let mut massless: Vec<String> = model.massless_joints().into_iter().map(|i| model.bodies()[i].name.clone()).collect();
            // A joint of several degrees of freedom is several bodies, which follow one another.
            massless.dedup();
            let bound = model.frames().iter().filter(|frame| model.freedoms_of(frame.body).len() < 6);
            Lacks { massless, mass: model.moving_mass() > 0.0, bound_frames: bound.map(|frame| frame.name.clone()).collect() }
        })
    }

    /// Refuses a function that is not defined for this robot.
    fn check_defined(&self, py: Python<'_>, function: &Function<f64>) -> PyResult<()> {
        if function.needs == Needs::Nothing {
            return Ok(());
        }
        let lacks = self.lacks();
        let refuse = |code, found: String, expected: &str| {
            let finding = Diagnostic::error("", (Default::default(), function.name), code, found, expected);
            Err(errors::refused(py, &finding.into()))
        };
        if function.needs == Needs::Mass && !lacks.mass {
            return refuse(Code::NoMass, "no moving link with mass".into(), "a link with mass that moves");
        }
        if function.inverts_mass_matrix() && !lacks.massless.is_empty() {
            let found = format!("no inertia of its own for joint {}", lacks.massless.join(", joint "));
            return refuse(
                Code::SingularMassMatrix,
                found,
                "a link behind it with an inertia, or one joint fewer: M is singular in every configuration",
            );
        }
        if function.needs == Needs::FreeFrames && !lacks.bound_frames.is_empty() {
            let found = format!("fewer than six degrees of freedom for {}", lacks.bound_frames.join(", "));
            let expected = "six for each frame; choose others with `frames=` or `with_frames`, or take operational_space_inertia_inverse";
            return refuse(Code::BoundFrames, found, expected);
        }
        Ok(())
    }

    /// The number of states, if it has a dimension of its own, and the arguments.
    fn checked<'py>(&self, function: &Function<f64>, given: &Bound<'py, PyTuple>) -> PyResult<(Option<usize>, Vec<Argument<'py>>)> {
        let names: Vec<&str> = function.takes.iter().map(|argument| argument.name()).collect();
        if given.len() != names.len() {
            let (name, found, expected) = (function.name, given.len(), names.len());
            return Err(PyTypeError::new_err(format!("{name}: found {found} arguments, expected {expected}: {}", names.join(", "))));
        }
        let mut arguments = Vec::with_capacity(names.len());
        for (argument, value) in function.takes.iter().zip(given.iter()) {
            arguments.push(arrays::argument(argument.name(), &value, &self.lengths(argument.dims()))?);
        }
        Ok((arrays::states(&names, &arguments)?, arguments))
    }

    fn lengths(&self, dims: &[Dim]) -> Vec<usize> {
        dims.iter().map(|dim| dim.len(self.shape)).collect()
    }

    fn for_each_joint(
        &self,
        count: usize,
        open: f64,
        fill: impl Fn(Limit) -> f64,
        range: impl Fn((usize, usize), (usize, usize)) -> Range<usize>,
    ) -> Vec<f64> {
        let mut out = vec![open; count];
        for joint in self.model.joints() {
            if let Some(limit) = joint.limit {
                out[range(joint.q, joint.v)].fill(fill(limit));
            }
        }
        out
    }

    fn of_coordinates(&self, open: f64, fill: impl Fn(Limit) -> f64) -> Vec<f64> {
        self.for_each_joint(self.model.nq(), open, fill, |(first, n), _| first..first + n)
    }

    fn of_freedoms(&self, fill: impl Fn(Limit) -> f64) -> Vec<f64> {
        self.for_each_joint(self.model.nv(), f64::INFINITY, fill, |_, (first, n)| first..first + n)
    }
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (file, document, base, gravity, includes))]
    fn new(py: Python<'_>, file: &str, document: &[u8], base: &str, gravity: [f64; 3], includes: bool) -> PyResult<Self> {
        let base = base_of(base)?;
        let options = Options { file: file.into(), base, ..Options::default() };
        let sources: &(dyn Sources + Sync) = if includes { &Disk } else { &NoFiles };
        let reading = py.detach(|| read_with(sources, document, &options)).map_err(|findings| errors::refused(py, &findings))?;
        let model = Model::new(&reading.description, base).map_err(|error| {
            let finding = Diagnostic::refusal(file, Place::DOCUMENT, Code::Model, error.to_string());
            let mut all = Diagnostics::from(finding);
            all.extend(reading.warnings.iter().cloned());
            errors::refused(py, &all)
        })?;
        Ok(Self {
            shape: model.shape(),
            links: links(&reading.description, &model),
            model: model.with_gravity(gravity),
            warnings: reading.warnings,
            unused: reading.unused.iter().map(ToString::to_string).collect(),
            workspaces: Workspaces::default(),
            lacks: OnceLock::new(),
        })
    }

    fn _with_gravity(&self, gravity: [f64; 3]) -> Self {
        self.with(self.model.clone().with_gravity(gravity))
    }

    fn _with_frames(&self, py: Python<'_>, names: Vec<String>) -> PyResult<Self> {
        let all = self.model.frames();
        let mut findings = Diagnostics::new("");
        for name in names.iter().filter(|name| all.iter().all(|frame| frame.name != **name)) {
            let known = all.iter().map(|frame| frame.name.as_str());
            findings.unknown(
                ((Default::default(), "frames"), Code::UnknownName),
                (format!("{name:?}"), name),
                "a frame of the robot",
                known,
            );
        }
        findings.result(()).map_err(|findings| errors::refused(py, &findings))?;
        let model = self.model.clone().with_frames(&names);
        Ok(self.with(model.map_err(|error| PyValueError::new_err(error.to_string()))?))
    }

    /// Row `index` of the table at these arguments, one state or many.
    fn _call<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        given: &Bound<'py, PyTuple>,
        threads: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let function = row(index)?;
        self.check_defined(py, function)?;
        let (states, arguments) = self.checked(function, given)?;
        let threads = batch::threads(threads)?;

        let mut shape = self.lengths(function.gives);
        let len = shape.iter().product();
        if let Some(states) = states {
            shape.insert(0, states);
        }
        let mut slices = Vec::with_capacity(arguments.len());
        for argument in &arguments {
            slices.push((argument.numbers()?, if argument.states.is_some() { argument.len } else { 0 }, argument.len));
        }
        let call = Call { function, model: &self.model, workspaces: &self.workspaces, arguments: slices, len };
        if shape.is_empty() {
            let mut number = [0.0];
            call.run(py, &mut number, threads)?;
            return Ok(number[0].into_pyobject(py)?.into_any());
        }
        let out = arrays::output(py, &shape)?;
        let mut numbers = out.try_readwrite().map_err(|error| PyValueError::new_err(error.to_string()))?;
        call.run(py, numbers.as_slice_mut().map_err(|error| PyValueError::new_err(error.to_string()))?, threads)?;
        drop(numbers);
        Ok(out.into_any())
    }

    /// The arguments of row `index`, checked: the number of states, the arrays, and the shape of the result.
    fn _arguments<'py>(&self, index: usize, given: &Bound<'py, PyTuple>) -> PyResult<(Option<usize>, Arrays<'py>, Vec<usize>)> {
        let function = row(index)?;
        let (states, arguments) = self.checked(function, given)?;
        let shape = states.into_iter().chain(self.lengths(function.gives)).collect();
        Ok((states, arguments.iter().map(|argument| argument.array()).collect(), shape))
    }

    /// The robot's name.
    #[getter]
    fn name(&self) -> &str {
        self.model.name()
    }

    /// Number of coordinates.
    #[getter]
    fn nq(&self) -> usize {
        self.model.nq()
    }

    /// Number of degrees of freedom.
    #[getter]
    fn nv(&self) -> usize {
        self.model.nv()
    }

    /// Names of the frames, in the order of results.
    #[getter]
    fn frames(&self) -> Vec<&str> {
        self.model.frames().iter().map(|frame| frame.name.as_str()).collect()
    }

    /// Names of the moving links, in the order of `joint_wrenches`.
    #[getter]
    fn links(&self) -> Vec<&str> {
        self.links.iter().map(String::as_str).collect()
    }

    /// Name, kind, range in q and range in v of each joint.
    #[getter]
    fn _joints(&self) -> Vec<(&str, &'static str, Ends, Ends)> {
        let ends = |(first, n): (usize, usize)| (first, first + n);
        self.model.joints().iter().map(|joint| (joint.name.as_str(), joint.kind.name(), ends(joint.q), ends(joint.v))).collect()
    }

    /// Lower bounds of q, rad or m; -inf where there are none.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.of_coordinates(f64::NEG_INFINITY, |limit| limit.lower))
    }

    /// Upper bounds of q, rad or m; inf where there are none.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.of_coordinates(f64::INFINITY, |limit| limit.upper))
    }

    /// Largest rates, rad/s or m/s; inf where there are none.
    #[getter]
    fn velocity_limit<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.of_freedoms(|limit| limit.velocity))
    }

    /// Largest torques or forces, N·m or N; inf where there are none.
    #[getter]
    fn effort_limit<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.of_freedoms(|limit| limit.effort))
    }

    /// Gravity in the world frame, m/s².
    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.model.gravity().as_slice())
    }

    /// The configuration of zeros, with quaternions (0, 0, 0, 1).
    #[getter]
    fn neutral<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.model.neutral())
    }

    /// Mass of the moving links, kg.
    #[getter]
    fn moving_mass(&self) -> f64 {
        self.model.moving_mass()
    }

    /// Warnings of the reader, as dicts.
    #[getter]
    fn _warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        errors::list(py, &self.warnings)
    }

    /// What the file says and the dynamics do not use.
    #[getter]
    fn unused(&self) -> Vec<&str> {
        self.unused.iter().map(String::as_str).collect()
    }
}
