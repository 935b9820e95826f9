//! From a URDF to straight-line Rust.
//!
//! ```text
//! urdf → model → (model passes) → trace → graph → (graph passes) → ledger → emit → source
//! ```
//!
//! [`generate`] is that list. The macro, the build-script interface ([`Build`]) and the command line all fill a [`Request`] and get the
//! same source. There is no physics here: the algorithms are those of `articulated-core`, run on symbols.

pub mod bound;
mod build;
mod cache;
mod capabilities;
mod checked;
mod error;
mod faults;
pub mod function_groups;
pub mod graph;
mod joint_blocks;
pub mod ledger;
mod limbs;
pub mod lir;
pub mod model_pass;
mod parameters;
pub mod pass;
mod program;
mod request;
pub mod scene;
mod size;
mod spec;
mod sym;
pub mod target;
mod trace;

use articulated_core::Scalar;
use articulated_core::algorithm::{Function, Needs, functions};
use articulated_core::description::Description;
use articulated_core::model::Model;
use articulated_urdf::{Kind, Problem, Reading, Subject, Unused};
use function_groups::Group;

pub use articulated_core as core;
pub use articulated_core::description::{Base, Origin, Payload, Shaft};
pub use articulated_core::effect::Applied;
pub use articulated_core::lanes::Real;
pub use articulated_core::level::{Arithmetic, Level, LevelError, Sines};
pub use articulated_core::spatial::Reference;
pub use articulated_core::suggest::nearest;
pub use articulated_scene::{Appended, Edit, Reason, Refusal, RobotError, RobotOptions};
pub use articulated_urdf as urdf;
pub use articulated_urdf::MOST_SNAPPED;
pub use build::{BatchType, Build, Written};
pub use checked::checked_cost;
pub use error::Error;
pub use faults::entry_of;
pub use ledger::Ledger;
pub use parameters::Parameter;
pub use request::{Options, Request, choose_frames, model, read};
pub use size::MAX_CODE_SIZE;
pub use spec::{Constant, FunctionSpec, FunctionTerm, is_keyword};
pub use sym::Sym;
pub use target::{COptions, File, RustOptions, Target, identifier};

/// What was generated, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The last of the files: in Rust the contents of a module, in C the source behind the header.
    /// The same request always gives the same bytes.
    pub source: String,
    /// All files of the target.
    pub files: Vec<File>,
    /// The model as it was read, before model passes.
    pub model: Model<f64>,
    /// Constants of the model that stayed inputs.
    pub parameters: Vec<Parameter>,
    /// How accurate the functions are, and what numbers they take.
    pub level: Level,
    /// Costs.
    pub ledger: Ledger,
    /// The graph of each function, in the order of the ledger: what the source computes. Empty where the source leaves a loop
    /// ([`unsolved`](articulated_core::algorithm::Function::unsolved)): the graph is not all of it then.
    pub graphs: Vec<graph::Graph>,
    /// Things in the document that are odd but used as written.
    pub warnings: Vec<Problem>,
    /// Content that is understood but not used.
    pub unused: Vec<Unused>,
    /// Angles taken as multiples of π/2 because the request asked for it.
    pub snapped: Vec<Problem>,
}

impl Generated {
    /// The source as tokens.
    ///
    /// # Panics
    /// If the target is not Rust, or the source was changed into something that is not.
    pub fn tokens(&self) -> proc_macro2::TokenStream {
        self.source.parse().expect("the target is Rust")
    }

    /// How far each result of a function, by its place in the ledger, can be off by rounding, guaranteed, wherever the arguments are in the box of [`bound::in_box`]; infinite where a
    /// divisor could be nothing there. `None` where there is no such function, where the source leaves a loop, and at levels that have no bound.
    pub fn bounds_in_box(&self, place: usize) -> Option<Vec<f64>> {
        let graph = self.graphs.get(place).filter(|graph| !graph.outputs.is_empty())?;
        let arguments = &self.ledger.functions.get(place)?.arguments;
        let nominal: Vec<f64> = self.parameters.iter().flat_map(|p| &p.nominal).copied().collect();
        let input = |argument: usize, k: usize| match arguments.get(argument) {
            Some(a) => bound::in_box(&self.model, *a, k),
            None => (nominal[k], 0.0),
        };
        bound::bounds(graph, self.level, &input)
    }
}

/// Degrees of freedom from which on no code is written: a workspace has room for a matrix of their number squared.
pub const MOST_FREEDOMS: usize = 10_000;

/// What can be refused of a request, settled.
struct Plan {
    reading: Reading,
    model: Model<f64>,
    parameters: Vec<Parameter>,
    wanted: Vec<FunctionSpec>,
}

/// Everything that comes before programs are made.
fn plan(request: &Request) -> Result<Plan, Error> {
    let options = &request.options;
    // What needs no robot comes first, to be told of one that cannot be read too.
    words(options)?;
    let mut reading = read(request)?;
    let whole = model(request, &reading.description)?;
    if whole.nv > MOST_FREEDOMS {
        return Err(Error::TooLarge { file: request.file.clone(), found: whole.nv, most: MOST_FREEDOMS });
    }
    // Mass that stays an input is mass all the same.
    let massless = massless(&whole);
    let parameters = parameters::parse(&options.parameters, &options.rename, &mut reading.description, &whole)?;
    let model = choose_frames(request, if parameters.is_empty() { whole } else { model(request, &reading.description)? })?;
    let wanted = wanted(request, &model, &massless)?;
    size::within_limit(request, &model, &wanted)?;
    options.target.check_names(&model, request)?;
    Ok(Plan { reading, model, parameters, wanted })
}

/// Whether the words of the options mean something, whatever the robot.
fn words(options: &Options) -> Result<(), Error> {
    options.target.check(options)?;
    options.functions.iter().try_for_each(|text| FunctionSpec::parse(text).map(drop))
}

/// As [`generate`] for a robot whose file is missing. Errors: all that is wrong with the request whatever the robot, as functions that do not exist.
pub fn check_words(request: &Request) -> Result<(), Error> {
    faults::all(&request.settled(), |request| words(&request.options))
}

/// Generates the code that `request` asks for. Pure: nothing is read or written. Errors: everything that is wrong with the document and what of the request can be told without it, or else everything that is wrong with the request.
pub fn generate(request: &Request) -> Result<Generated, Error> {
    let request = &*request.settled();
    let known = |request: &Request| Error::of(parameters::of_effects_that_are_off(&request.options)).map_or(Ok(()), Err);
    let Plan { reading, model, parameters, wanted } =
        faults::all(request, |request| plan(request).and_then(|plan| known(request).map(|()| plan)))?;
    let Reading { mut warnings, unused, snapped, .. } = reading;
    let can = request.options.target.capabilities(&request.options);
    let mut ledger = Ledger::default();
    let mut programs = Vec::new();
    for function in wanted {
        let program = program::program(function, &model, &parameters, &request.options, can);
        ledger.functions.push(program.entry.clone());
        programs.push(program);
    }
    warnings.extend(ledger.functions.iter().filter_map(|entry| long_code(&request.file, entry)));
    let functions = programs.iter().map(|p| lir::function::Function::of(p, model.shape(), !parameters.is_empty(), can)).collect();
    let module = target::Module {
        request,
        model: &model,
        functions,
        parameters: &parameters,
        unused: &unused,
        snapped: &snapped,
        warnings: &warnings,
    };
    let files = request.options.target.print(&module);
    let graphs = programs.into_iter().map(|p| if p.columns.is_some() { graph::Graph::default() } else { p.graph }).collect();
    let source = files.last().map(|file| file.text.clone()).unwrap_or_default();
    Ok(Generated { source, files, model, parameters, level: request.options.level, ledger, graphs, warnings, unused, snapped })
}

/// So many instructions, straight-line code beyond which is of little use: a compiler takes minutes for it, and loops over joints are faster.
const LONG: u64 = 400_000;

/// What is odd about a function that is as long.
fn long_code(file: &str, entry: &ledger::Entry) -> Option<Problem> {
    let instructions = entry.emitted().instructions();
    (instructions > LONG).then(|| Problem {
        file: file.to_owned(),
        line: None,
        subject: Subject::Document,
        kind: Kind::LongCode,
        field: entry.function.clone(),
        found: format!("{instructions} instructions, for which a compiler takes minutes"),
        expected: "the library's function of the same name, a loop over the joints, for a robot like this".to_owned(),
    })
}

/// The functions that the request names.
fn wanted(request: &Request, model: &Model<f64>, massless: &[String]) -> Result<Vec<FunctionSpec>, Error> {
    let mut wanted: Vec<FunctionSpec> = Vec::new();
    for text in &request.options.functions {
        let function = FunctionSpec::parse(text)?;
        function.check(model)?;
        function.parts.iter().try_for_each(|part| defined(&request.file, model, massless, part.function))?;
        let same_type = |f: &FunctionSpec| f.group().is_some() && f.group() == function.group();
        let into = |f: &FunctionSpec, other: &FunctionSpec| {
            ["_into", "_blocks"].iter().any(|form| f.name.strip_suffix(form) == Some(other.name.as_str()))
        };
        if wanted.iter().any(|f| f.name == function.name || same_type(f) || into(&function, f)) {
            return Err(Error::SameName { name: function.name });
        }
        // A form of this one has the name of the other.
        if let Some(other) = wanted.iter().find(|f| into(f, &function)) {
            return Err(Error::SameName { name: other.name.clone() });
        }
        wanted.push(function);
    }
    Ok(wanted)
}

/// Whether there are the functions, parameters and frames that the request names; `whole`: the model with a frame for every link. Errors: all that are not there.
pub fn check_names(request: &Request, description: &Description, whole: &Model<f64>) -> Result<(), Error> {
    let names = |request: &Request| {
        parameters::parse(&request.options.parameters, &request.options.rename, &mut description.clone(), whole)?;
        let model = choose_frames(request, whole.clone())?;
        request.options.functions.iter().try_for_each(|text| FunctionSpec::parse(text)?.check(&model))
    };
    faults::all(&request.settled(), names)
}

/// Whether all joints and links have names of their own in Rust. Errors: all names of which two are the same, and renamings that cannot be.
pub fn check_identifiers(request: &Request, model: &Model<f64>) -> Result<(), Error> {
    faults::all(request, |request| request.options.target.check_names(model, request))
}

/// The names of the joints that have no inertia of their own.
pub fn massless(model: &Model<f64>) -> Vec<String> {
    let mut names: Vec<String> = model.massless_joints().into_iter().map(|i| model.bodies[i].name.clone()).collect();
    // A joint of several degrees of freedom is several bodies, which follow one another.
    names.dedup();
    names
}

/// Whether the robot has what the function needs; `massless`: what [`massless`] gives of it.
pub fn defined<S: Scalar>(file: &str, model: &Model<f64>, massless: &[String], function: &Function<S>) -> Result<(), Error> {
    let (file, name) = (file.to_owned(), function.name.to_owned());
    if function.needs == Needs::Mass && model.moving_mass() == 0.0 {
        return Err(Error::NoMass { file, function: name });
    }
    if function.inverts_mass_matrix() && !massless.is_empty() {
        return Err(Error::Singular { file, function: name, joints: massless.to_vec() });
    }
    let bound = |f: &articulated_core::model::Frame<f64>| {
        let n = model.freedoms_of(f.body).len();
        (n < 6).then(|| format!("link {:?} ({n})", f.name))
    };
    let frames: Vec<String> = match function.needs {
        Needs::FreeFrames => model.frames.iter().filter_map(bound).collect(),
        _ => Vec::new(),
    };
    let has_others = model.outward().any(|i| model.freedoms_of(i).len() >= 6);
    if frames.is_empty() { Ok(()) } else { Err(Error::BoundFrames { file, function: name, frames, has_others }) }
}

/// The function called `name`, or the error that names the nearest.
pub fn function(name: &str) -> Result<&'static Function<Sym>, Error> {
    articulated_core::algorithm::function(name).ok_or_else(|| {
        if name == function_groups::MOTION {
            let reason = "it stands for what the motion of a scene calls, by itself in a list: found no scene with [simulation]".into();
            return Error::FunctionSpec { found: name.into(), reason };
        }
        // In a sum of functions a group is none of them.
        let groups = Group::ALL.map(Group::name).into_iter().filter(|_| Group::named(name).is_none());
        let known: Vec<&str> = functions::<Sym>().iter().map(|f| f.name).chain(groups).collect();
        let nearest = meant(name, known.iter().copied());
        Error::UnknownFunction { found: name.into(), nearest, known: known.into_iter().map(str::to_owned).collect() }
    })
}

/// Which of the names is meant by one that is none of them: what other libraries call so, or the nearest.
pub fn meant<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let plain: String = name.chars().filter(|c| *c != '_').collect();
    match ELSEWHERE.iter().find(|(theirs, _)| plain.eq_ignore_ascii_case(theirs)) {
        Some((_, ours)) => (!ours.is_empty()).then(|| (*ours).to_owned()),
        None => nearest(name, known),
    }
}

/// What other libraries and textbooks call functions by, whatever the capitals and without `_`, with our names; nothing where we have no such function and the nearest name is of another.
const ELSEWHERE: &[(&str, &str)] = &[
    ("fk", "placements"),
    ("forwardkinematics", "placements"),
    ("framesforwardkinematics", "placements"),
    ("ik", ""),
    ("inversekinematics", ""),
    ("jacobian", "jacobians_body"),
    ("framejacobian", "jacobians_body"),
    ("getframejacobian", "jacobians_body"),
    ("jdotv", "bias_accelerations_body"),
    ("biasacceleration", "bias_accelerations_body"),
    ("id", "inverse_dynamics"),
    ("rnea", "inverse_dynamics"),
    ("nle", "bias_forces"),
    ("nonlineareffects", "bias_forces"),
    ("computegeneralizedgravity", "gravity_torque"),
    ("crba", "mass_matrix"),
    ("computecoriolismatrix", "coriolis_matrix"),
    ("minv", "mass_matrix_inverse"),
    ("minverse", "mass_matrix_inverse"),
    ("computeminverse", "mass_matrix_inverse"),
    ("fd", "forward_dynamics"),
    ("aba", "forward_dynamics"),
    ("rneaderivatives", "inverse_dynamics_derivatives"),
    ("computerneaderivatives", "inverse_dynamics_derivatives"),
    ("abaderivatives", "forward_dynamics_derivatives"),
    ("computeabaderivatives", "forward_dynamics_derivatives"),
    ("com", "center_of_mass"),
    ("jacobiancenterofmass", "center_of_mass_jacobian"),
    ("ccrba", "centroidal_momentum_matrix"),
    ("dccrba", "centroidal_momentum_rate"),
    ("jointtorqueregressor", "torque_regressor"),
    ("computejointtorqueregressor", "torque_regressor"),
    ("dintegrate", "integrate_derivatives"),
    ("ddifference", "difference_derivatives"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_other_libraries_lead_to_ours() {
        for (theirs, ours) in ELSEWHERE {
            let told = function(theirs).err().unwrap().to_string();
            if ours.is_empty() {
                assert!(told.starts_with(&format!("unknown function `{theirs}`, there are: placements, ")), "{told}");
            } else {
                assert!(function(ours).is_ok(), "{ours}");
                assert_eq!(told, format!("unknown function `{theirs}`, did you mean `{ours}`?"));
            }
        }
        assert!(function("nonLinearEffects").err().unwrap().to_string().ends_with("did you mean `bias_forces`?"));
        assert!(function("forward_kinematics").err().unwrap().to_string().ends_with("did you mean `placements`?"));
        assert!(function("RNEA").err().unwrap().to_string().ends_with("did you mean `inverse_dynamics`?"));
    }
}
