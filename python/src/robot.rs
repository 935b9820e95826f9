//! The robot: a model with room for its calls.

use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use articulated::algorithm::{Function, Needs, functions};
use articulated::description::{Coupling, Limit, Origin, Payload};
use articulated::formats::world::GivenContact;
use articulated::formats::{Environment, Included, LeaveOut};
use articulated::spatial::Reference;
use articulated::{Base, Model};
use articulated_cli::still;
use articulated_codegen::scene::Scene;
use articulated_codegen::{Appended, COptions, Real, Request, Target, forces_of_the_file, generate, unread_constraints};
use articulated_core::actuator::ActuatorLaw;
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::arrays::{self, Argument, Real as _};
use crate::batch::{self, Call, Compute, Generic, Kernel, Workspaces};
use crate::contacts;
use crate::derived::Derived;
use crate::errors;
use crate::exchange;
use crate::given;
use crate::method::Keywords;
use crate::rollout;
use crate::scene;
use crate::signature::{Signature, signatures};

/// A robot's model. `articulated.load` makes one.
#[pyclass(frozen, subclass, module = "articulated._native")]
pub(crate) struct Robot {
    model: Model<f64>,
    /// The robot as code is generated from it.
    request: Request,
    pub(crate) signatures: Vec<Signature>,
    /// Names of the links that [`Model::links`] lists.
    links: Vec<String>,
    warnings: Vec<Diagnostic>,
    unused: Vec<String>,
    workspaces: Workspaces<f64>,
    /// The same in float32.
    single: OnceLock<(Model<f32>, Workspaces<f32>)>,
    lacks: OnceLock<Lacks>,
}

/// The first index and the end.
type Ends = (usize, usize);

/// A robot to append: its file's name, its document, whether it may include files, the link that
/// carries it, the prefix of its names, and the position and roll, pitch and yaw of its root there.
type AppendedRow = (String, Vec<u8>, bool, String, String, [f64; 3], [f64; 3]);

/// A joint that follows others: its name, the coefficient of each leader and the offset; or one
/// leader, the coefficients of a polynomial and the coordinate about which it is written.
type CouplingRow = (String, Vec<(String, f64)>, f64, Option<(String, Vec<f64>, f64)>);

/// Values by name.
type Names<T> = BTreeMap<String, T>;

/// A load: the link, its mass, its centre of mass, and xx, xy, xz, yy, yz, zz of its inertia.
type PayloadRow = (String, f64, [f64; 3], [f64; 6]);

/// Missing properties of the robot that some functions need.
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

fn base_of(name: &str) -> PyResult<Base> {
    let named = [Base::Fixed, Base::Floating].into_iter().find(|base| name_of(*base) == name);
    named.ok_or_else(|| PyValueError::new_err(format!("base: found {name:?}, expected \"fixed\" or \"floating\"")))
}

fn reference_of(name: &str) -> PyResult<Reference> {
    let named = [Reference::Body, Reference::World, Reference::WorldAligned].into_iter().find(|one| one.name() == name);
    let wrong = || PyValueError::new_err(format!("wrenches_in: found {name:?}, expected \"body\", \"world\" or \"world_aligned\""));
    named.ok_or_else(wrong)
}

/// Names of the two shapes of each of these pairs.
fn names_of_shapes(model: &Model<f64>, pairs: impl Iterator<Item = usize>) -> Vec<[String; 2]> {
    let constraints = model.constraints();
    pairs.map(|pair| constraints.pairs[pair].shapes.map(|shape| constraints.shapes[shape].name.clone())).collect()
}

/// Names of the moving links, in the order of [`Model::links`].
fn links(model: &Model<f64>) -> Vec<String> {
    model.links().filter_map(|i| model.bodies()[i].link.as_ref()).map(|link| link.name.clone()).collect()
}

/// The files that the document of a file includes, read with these arguments and packages; for a
/// text none, and includes are refused.
fn included(file: &str, document: &[u8], is_file: bool, arguments: &Names<String>, packages: &Names<PathBuf>) -> Included {
    let (arguments, packages) = (arguments.clone(), packages.clone());
    let options = articulated::formats::Options { file: file.to_owned(), arguments, packages, ..articulated::formats::Options::default() };
    if is_file { articulated::formats::included(&Environment, Path::new(""), document, &options) } else { Included::default() }
}

/// The model with these frames. Errors: those that it does not have.
fn framed(py: Python<'_>, model: Model<f64>, names: &[String]) -> PyResult<Model<f64>> {
    let all = model.frames();
    let mut findings = Diagnostics::new("");
    for name in names.iter().filter(|name| all.iter().all(|frame| frame.name != **name)) {
        let known = all.iter().map(|frame| frame.name.as_str());
        findings.unknown(((Default::default(), "frames"), Code::UnknownName), (format!("{name:?}"), name), "a frame of the robot", known);
    }
    findings.result(()).map_err(|findings| errors::refused(py, &findings))?;
    model.with_frames(names).map_err(|error| PyValueError::new_err(error.to_string()))
}

impl Robot {
    fn made(model: Model<f64>, request: Request, (links, warnings, unused): (Vec<String>, Vec<Diagnostic>, Vec<String>)) -> Self {
        let signatures = signatures(model.shape());
        Self {
            model,
            request,
            signatures,
            links,
            warnings,
            unused,
            workspaces: Workspaces::default(),
            single: OnceLock::new(),
            lacks: OnceLock::new(),
        }
    }

    /// Implementation of a row of the table.
    pub(crate) fn kernel(&self, index: usize) -> Kernel<'_> {
        Kernel::Generic(Generic { function: self.signatures[index].function, model: &self.model, workspaces: &self.workspaces })
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

    /// Whether a function is defined for this robot.
    pub(crate) fn is_defined(&self, function: &Function<f64>) -> bool {
        if function.needs == Needs::Nothing {
            return true;
        }
        let lacks = self.lacks();
        let mass = function.needs != Needs::Mass || lacks.mass;
        let inertia = lacks.massless.is_empty() || !function.inverts_mass_matrix();
        mass && inertia && (function.needs != Needs::FreeFrames || lacks.bound_frames.is_empty())
    }

    /// Refuses a function that is not defined for this robot.
    fn check_defined(&self, py: Python<'_>, function: &Function<f64>) -> PyResult<()> {
        if self.is_defined(function) {
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

    /// The arguments of a call, of one type of numbers.
    fn checked<'py, T: arrays::Real>(
        &self,
        signature: &Signature,
        given: &Bound<'py, PyTuple>,
    ) -> PyResult<(Vec<usize>, Vec<Argument<'py, T>>)> {
        let names: Vec<&str> = signature.function.takes.iter().map(|argument| argument.name()).collect();
        let mut arguments = Vec::with_capacity(names.len());
        for ((name, size), value) in names.iter().zip(&signature.arguments).zip(given.iter()) {
            arguments.push(arrays::argument::<T>(name, &value, &size.lengths())?);
        }
        let batch = arrays::batch(&names, &arguments)?;
        let arguments = arguments.into_iter().map(|argument| argument.broadcast(given.py(), &batch)).collect::<PyResult<_>>()?;
        Ok((batch, arguments))
    }

    /// Row `index` of the table at these arguments, one state or many. float32 in, float32 out.
    pub(crate) fn call<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        kernel: &Kernel<'_>,
        given: &Bound<'py, PyTuple>,
        keywords: &Keywords<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let signature = self.signatures.get(index).ok_or_else(|| PyValueError::new_err("found no such function"))?;
        self.check_defined(py, signature.function)?;
        let takes = signature.function.takes;
        if given.len() != takes.len() {
            let names: Vec<&str> = takes.iter().map(|argument| argument.name()).collect();
            let (name, found, expected) = (signature.function.name, given.len(), names.len());
            return Err(PyTypeError::new_err(format!("{name}: found {found} arguments, expected {expected}: {}", names.join(", "))));
        }
        if takes.is_empty() || !given.iter().all(|value| arrays::is_single(&value)) {
            return self.of_numbers::<f64, _>(py, signature, kernel, given, keywords);
        }
        match kernel {
            Kernel::Generic(_) => {
                let (model, workspaces) = self.single.get_or_init(|| (self.model.cast(), Workspaces::default()));
                let function = &functions::<f32>()[index];
                self.of_numbers::<f32, _>(py, signature, &Generic { function, model, workspaces }, given, keywords)
            }
            // Compiled functions compute in float64.
            Kernel::Compiled(_) => {
                let wide = Keywords { threads: keywords.threads.clone(), out: None };
                let wide = self.of_numbers::<f64, _>(py, signature, kernel, given, &wide)?;
                py.import("articulated._errors")?.getattr("narrow")?.call1((wide, keywords.out.as_ref()))
            }
        }
    }

    fn of_numbers<'py, T: arrays::Real, K: Compute<T>>(
        &self,
        py: Python<'py>,
        signature: &Signature,
        kernel: &K,
        given: &Bound<'py, PyTuple>,
        keywords: &Keywords<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (batch, arguments) = self.checked::<T>(signature, given)?;
        let threads = batch::threads(keywords.threads.as_ref())?;
        let shape: Vec<usize> = batch.iter().copied().chain(signature.result.lengths()).collect();
        let mut slices = Vec::with_capacity(arguments.len());
        for argument in &arguments {
            slices.push((argument.numbers()?, argument.len, if argument.batch.is_empty() { 0 } else { argument.len }));
        }
        let call = Call { kernel, arguments: slices, len: signature.result.len };
        if shape.is_empty() && keywords.out.is_none() && T::NAME == f64::NAME {
            let mut number = [T::from_f64(0.0)];
            call.run(py, &mut number, threads)?;
            return Ok(number[0].wide().into_pyobject(py)?.into_any());
        }
        let out = match &keywords.out {
            Some(out) => arrays::given_output::<T>(out, &shape)?,
            None => arrays::output::<T>(py, &shape)?,
        };
        // Refuses an array that is read-only, or that is an argument too.
        let overlap = |error: numpy::BorrowError| PyValueError::new_err(format!("out: found {error}, expected an array of its own"));
        let mut numbers = out.try_readwrite().map_err(overlap)?;
        call.run(py, numbers.as_slice_mut().map_err(|error| PyValueError::new_err(error.to_string()))?, threads)?;
        drop(numbers);
        match &keywords.out {
            // The caller's object, of whatever class it is.
            Some(out) => Ok(out.clone()),
            // One number: as NumPy returns it.
            None if shape.is_empty() => out.get_item(()),
            None => Ok(out.into_any()),
        }
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
    /// `like`: the same robot, of which only gravity, frames and the reference of wrenches differ.
    #[new]
    #[pyo3(signature = (file, document, base, gravity, includes, wrenches_in, frames, append, payloads, locks, args, packages, reading, coupling, effects, like=None))]
    #[allow(clippy::too_many_arguments)] // Why: what makes a robot, one by one.
    fn new(
        py: Python<'_>,
        file: &str,
        document: &[u8],
        base: &str,
        gravity: Option<[f64; 3]>,
        includes: bool,
        wrenches_in: &str,
        frames: Option<Vec<String>>,
        append: Vec<AppendedRow>,
        payloads: Vec<PayloadRow>,
        locks: Vec<(String, Vec<f64>)>,
        args: Vec<(String, String)>,
        packages: Vec<(String, PathBuf)>,
        reading: ((bool, bool, bool), Vec<String>, Option<f64>, Vec<(String, String, usize)>),
        coupling: (bool, Vec<CouplingRow>),
        effects: bool,
        like: Option<&Bound<'_, Self>>,
    ) -> PyResult<Self> {
        let reference = reference_of(wrenches_in)?;
        if let Some(like) = like {
            let like = like.get();
            let mut request = like.request.clone();
            (request.options.robot.gravity, request.options.robot.wrench_reference) = (gravity, reference);
            let mut model = like.model.clone().with_wrenches_in(reference);
            if let Some(gravity) = gravity {
                model = model.with_gravity(gravity);
            }
            if let Some(frames) = frames {
                model = framed(py, model, &frames)?;
                request.set_frames(&frames);
            }
            return Ok(Self::made(model, request, (like.links.clone(), like.warnings.clone(), like.unused.clone())));
        }
        let mut request = Request::new(file, document);
        request.scene = effects.then(|| Scene::of_file_effects(file));
        let options = &mut request.options.robot;
        (options.base, options.gravity, options.wrench_reference) = (base_of(base)?, gravity, reference);
        (options.arguments, options.packages) = (args.into_iter().collect(), packages.into_iter().collect());
        options.included = included(file, document, includes, &options.arguments, &options.packages);
        // Only the robot itself has arguments.
        for (file, document, includes, ..) in &append {
            options.included.extend(included(file, document, *includes, &Names::default(), &options.packages));
        }
        options.append = append
            .into_iter()
            .map(|(file, document, _, at, prefix, xyz, rpy)| {
                let origin = if rpy == [0.0; 3] { Origin::at(xyz) } else { Origin::new(xyz, rpy) };
                Appended { document, file: file.into(), at: at.into(), prefix, origin }
            })
            .collect();
        let payload =
            |(link, mass, center_of_mass, inertia): PayloadRow| Payload { link, name: None, mass, center_of_mass, inertia }.into();
        options.payloads = payloads.into_iter().map(payload).collect();
        options.lock = locks.into_iter().map(Into::into).collect();
        let (allowed, leave_out, snap_angles, given) = reading;
        options.snap_angles = snap_angles;
        let pair = |(first, second, places)| GivenContact { shapes: [first, second], places };
        options.given_contacts = given.into_iter().map(pair).map(Into::into).collect();
        (options.allow_unphysical_inertia, options.first_of_duplicates, options.allow_unknown_version) = allowed;
        let kinds =
            leave_out.iter().map(|kind| kind.parse::<LeaveOut>().map_err(|error| PyValueError::new_err(format!("leave_out: {error}"))));
        options.leave_out = kinds.collect::<PyResult<_>>()?;
        options.file_coupling = coupling.0;
        let follower = |(joint, leaders, offset, polynomial): CouplingRow| match polynomial {
            None => Ok(Coupling { joint, leaders, offset, ..Coupling::default() }),
            Some((leader, numbers, reference)) => Coupling::polynomial(&joint, &leader, &numbers, reference),
        };
        let coupled =
            coupling.1.into_iter().map(|row| follower(row).map(Into::into).map_err(|error| PyValueError::new_err(error.to_string())));
        options.coupling = coupled.collect::<PyResult<_>>()?;
        let built = py.detach(|| request.build_robot()).map_err(|findings| errors::refused(py, &findings))?;
        let mut model = built.model;
        let about = links(&model);
        if let Some(frames) = frames {
            model = framed(py, model, &frames)?;
            request.set_frames(&frames);
        }
        let unused = built.reading.unused.iter().map(ToString::to_string).collect();
        let warnings = built.reading.warnings.into_iter().chain(built.reading.snapped).collect();
        Ok(Self::made(model, request, (about, warnings, unused)))
    }

    /// The states in MuJoCo's conventions, or back, by the function of this name.
    fn _exchange<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        positions: PyReadonlyArray2<'py, f64>,
        rates: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        exchange::run(py, &self.model, name, &positions, &rates)
    }

    /// What touches in states, and how exact their accelerations are: see [`contacts::run`].
    fn _contacts<'py>(
        &self,
        py: Python<'py>,
        q: PyReadonlyArray2<'py, f64>,
        v: PyReadonlyArray2<'py, f64>,
        act: PyReadonlyArray2<'py, f64>,
        ctrl: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<contacts::Found<'py>> {
        contacts::run(py, &self.model, [&q, &v, &act, &ctrl])
    }

    /// A step with constraints and with contacts that the caller found: see [`given::run`].
    #[expect(clippy::too_many_arguments, reason = "those of the method in Python")]
    fn _given_step<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        q: PyReadonlyArray2<'py, f64>,
        v: PyReadonlyArray2<'py, f64>,
        act: PyReadonlyArray2<'py, f64>,
        ctrl: PyReadonlyArray2<'py, f64>,
        contacts: PyReadonlyArray2<'py, f64>,
        warm: PyReadonlyArray2<'py, f64>,
        h: f64,
    ) -> PyResult<given::Ends<'py>> {
        given::run(py, &self.model, method, [&q, &v, &act, &ctrl, &contacts, &warm], h)
    }

    /// Names of the two shapes of each contact that a caller gives.
    fn _given_contacts(&self) -> Vec<[String; 2]> {
        names_of_shapes(&self.model, self.model.constraints().pair_of_given())
    }

    /// Names of the two shapes of each place where shapes may touch.
    fn _contact_shapes(&self) -> Vec<[String; 2]> {
        names_of_shapes(&self.model, self.model.constraints().pair_of_contacts())
    }

    /// A warning of smooth forces of the file that do not act beside its actuators, if there are
    /// any.
    fn _forces_off(&self) -> Option<String> {
        let built = self.request.build_robot().ok()?;
        forces_of_the_file(&self.request.file, &built).map(|warning| warning.to_string())
    }

    /// What an option leaves out of the constraints of the file, as warnings.
    fn _check_constraints(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let refused = |findings: &Diagnostics| errors::refused(py, findings);
        let (file, built) = (&self.request.file, self.request.build_robot().map_err(|findings| refused(&findings))?);
        let mut log = Diagnostics::new(file);
        let robot = (&built.reading.description, &built.reading.world, &built.model);
        let warnings = unread_constraints(file, robot, &mut log);
        if built.model.constraints().is_empty() && log.is_ok() {
            let found = "no limit, dry friction, equation or contact".to_owned();
            let at = (Default::default(), "constrained_rollout");
            log.push(Diagnostic::error(file, at, Code::NoConstraints, found, "an MJCF with one".to_owned()));
        }
        log.result(Some(())).map_err(|findings| refused(&findings))?;
        Ok(warnings.iter().map(ToString::to_string).collect())
    }

    /// The page of the robot at `q`, and warnings about its meshes. `packages`: folders of ROS
    /// packages.
    fn _page(&self, py: Python<'_>, q: Vec<f64>, title: &str, packages: Vec<PathBuf>) -> scene::WithWarnings<String> {
        scene::told(py, py.detach(|| still::page(&self.request, &q, title, &packages)))
    }

    /// C99 of functions: its files, each with a name and a text. All names begin with `prefix`.
    /// `batch`: functions of many states too.
    fn _generate_c(&self, py: Python<'_>, functions: Vec<String>, prefix: String, batch: bool) -> PyResult<Vec<(String, String)>> {
        let mut request = self.request.clone();
        request.options.functions = functions.into_iter().map(Into::into).collect();
        request.options.target = Target::C(COptions { prefix: Some(prefix), ..COptions::default() });
        request.options.batch = if batch { vec![Real::F64] } else { Vec::new() };
        request.options.stages = false;
        let generated = py.detach(|| catch_unwind(AssertUnwindSafe(|| generate(&request)))).map_err(|_| batch::mistake())?;
        let generated = generated.map_err(|findings| errors::refused(py, &findings))?;
        Ok(generated.files.into_iter().map(|file| (file.name, file.text)).collect())
    }

    /// The derivative of this request, such as `g = vjp(inverse_dynamics)`, traced for the robot.
    fn _derived(&self, py: Python<'_>, text: String) -> PyResult<Derived> {
        Derived::of(py, self.model.shape(), self.request.clone(), text)
    }

    /// The states after every so many steps: q, v, activations, and torques or controls of all
    /// steps, a row for each state.
    #[pyo3(signature = (method, q, v, act, held, h, every, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "those of the method in Python")]
    fn _rollout<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        q: PyReadonlyArray2<'py, f64>,
        v: PyReadonlyArray2<'py, f64>,
        act: PyReadonlyArray2<'py, f64>,
        held: PyReadonlyArray3<'py, f64>,
        h: f64,
        every: usize,
        threads: Option<Bound<'py, PyAny>>,
    ) -> PyResult<rollout::Ends<'py>> {
        rollout::run(py, &self.model, method, ([&q, &v, &act], &held), h, every, batch::threads(threads.as_ref())?)
    }

    /// Row `index` of the table at these arguments, one state or many.
    #[pyo3(signature = (index, given, threads=None, out=None))]
    fn _call<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        given: &Bound<'py, PyTuple>,
        threads: Option<Bound<'py, PyAny>>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if index >= functions::<f64>().len() {
            return Err(PyValueError::new_err("found no such function"));
        }
        self.call(py, index, &self.kernel(index), given, &Keywords { threads, out })
    }

    /// "fixed" or "floating".
    #[getter]
    fn base(&self) -> &'static str {
        name_of(self.request.options.robot.base)
    }

    /// What external wrenches are given in: "body", "world" or "world_aligned".
    #[getter]
    fn wrenches_in(&self) -> &'static str {
        self.model.wrench_reference().name()
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
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.model.frames().iter().map(|frame| frame.name.as_str()))
    }

    /// Names of the moving links, in the order of `joint_wrenches`.
    #[getter]
    fn links<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.links)
    }

    /// Name, bounds of the control, and whether it has an activation, of each actuator.
    #[getter]
    fn _actuators(&self) -> Vec<(&str, f64, f64, bool)> {
        let whole = [f64::NEG_INFINITY, f64::INFINITY];
        let row = |law: &'_ ActuatorLaw| (law.control_range.unwrap_or(whole), law.activation.is_some());
        let laws = self.model.actuators().laws.iter();
        laws.map(|law| (law.name.as_str(), row(law))).map(|(name, ([lower, upper], has))| (name, lower, upper, has)).collect()
    }

    /// Whether there are actuators, or springs and dampers of tendons.
    #[getter]
    fn _has_actuators(&self) -> bool {
        !self.model.actuators().is_empty()
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
    fn unused<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.unused)
    }
}
