//! From a robot file (URDF, xacro, MJCF or SDF) to straight-line Rust or C.
//!
//! A build script calls [`Build::new`], then [`Build::functions`], then [`Build::write`]:
//!
//! ```no_run
//! // build.rs, in `main`
//! articulated_codegen::Build::new("robots/arm.urdf").functions(["inverse_dynamics"]).write("arm"); // $OUT_DIR/arm.rs
//! ```
//!
//! A program that has the file in memory fills a [`Request`] and calls [`generate`]. It gets the
//! source as text, operation counts ([`Generated::ledger`]) and warnings:
//!
//! ```
//! use articulated_codegen::{Request, generate};
//!
//! let urdf = r#"<robot name="pendulum"><link name="base"/><link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
//!     <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
//!     <joint name="swing" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;
//! let mut request = Request::new("pendulum.urdf", urdf);
//! request.options.functions = vec!["gravity_torque".into()];
//! let generated = generate(&request)?;
//! assert!(generated.source.contains("pub fn gravity_torque(q: &[f64; NQ]) -> [f64; NV]"));
//! assert_eq!(generated.ledger.functions[0].emitted().multiplications(), 1); // 9.81 · sin q
//! # Ok::<(), articulated_codegen::diagnostic::Diagnostics>(())
//! ```
//!
//! The steps of [`generate`]:
//!
//! ```text
//! urdf → model → (model passes) → trace → graph → (graph passes) → LIR → (LIR passes) → source
//! ```
//!
//! The macro, the build script and the command all fill a [`Request`] and get the same source.
//! There is no physics here: the algorithms are those of `articulated-core`, run on symbols.

pub mod bound;
mod build;
mod cache;
mod capabilities;
mod checked;
mod differentiate;
pub mod function_groups;
mod function_spec;
pub mod graph;
pub mod language;
pub mod ledger;
mod limbs;
pub mod lir;
pub mod model_pass;
mod parameters;
pub mod pass;
mod plan;
mod program;
mod request;
pub mod scene;
mod size;
pub mod sym;
mod trace;

use std::fmt::Write as _;

use articulated_core::algorithm::{Function, functions};
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics, Place, Unused};
use articulated_core::model::Model;
use articulated_core::step;
use articulated_formats::Reading;
use articulated_scene::BuiltRobot;
use function_groups::Group;
use plan::Plan;

pub use articulated_core as core;
pub use articulated_core::description::{Base, Coupling, Origin, Payload, Shaft};
pub use articulated_core::diagnostic;
pub use articulated_core::effect::Applied;
pub use articulated_core::lanes::Real;
pub use articulated_core::precision::{Arithmetic, Precision, PrecisionError, TrigAccuracy};
pub use articulated_core::spatial::Reference;
pub use articulated_core::suggest::nearest;
pub use articulated_formats as formats;
pub use articulated_formats::{LeaveOut, MOST_SNAPPED};
pub use articulated_scene::{Appended, RobotOptions, RobotRequest};
pub use build::{BatchType, Build, Written};
pub use checked::checked_cost;
pub use function_spec::{Constant, Derivative, FunctionSpec, FunctionTerm, Output, Transform, UserFunctions};
pub use language::{COptions, File, RustOptions, Target, identifier, is_keyword};
pub use ledger::Ledger;
pub use parameters::Parameter;
pub use plan::{
    MOST_FREEDOMS, check_names, check_words, defined, forces_of_the_file, locked_actuators, massless, undefined, unread_constraints,
};
pub use request::{Options, Request};
pub use size::MAX_CODE_SIZE;
pub use sym::Sym;

/// Generated code, with its ledger and warnings.
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
    /// Precision of the functions, with the type of their numbers.
    pub level: Precision,
    /// Operation counts.
    pub ledger: Ledger,
    /// The graph of each function, in the order of the ledger: what the source computes.
    pub graphs: Vec<graph::Graph>,
    /// The statements of each function, in the order of the ledger: what the target prints.
    pub bodies: Vec<lir::Bodies>,
    /// Warnings about the document.
    pub warnings: Vec<Diagnostic>,
    /// Content that is understood but not used.
    pub unused: Vec<Unused>,
    /// Angles snapped to multiples of π/2 on request.
    pub snapped: Vec<Diagnostic>,
}

impl Generated {
    /// The source as a token stream.
    ///
    /// # Panics If the target is not Rust, or the source was changed and no longer parses.
    pub fn tokens(&self) -> proc_macro2::TokenStream {
        with_doc_attributes(&self.source).parse().expect("the target is Rust")
    }

    /// Guaranteed bounds of the rounding error of each result of a function, given by its index in
    /// the ledger, for all arguments in the box of [`bound::in_box`]; infinite where a divisor may
    /// be zero there. `None` if there is no such function, or if the precision has no bound.
    pub fn bounds_in_box(&self, place: usize) -> Option<Vec<f64>> {
        let graph = self.graphs.get(place)?;
        let arguments = &self.ledger.functions.get(place)?.arguments;
        let nominal: Vec<f64> = self.parameters.iter().flat_map(|p| &p.nominal).copied().collect();
        let input = |argument: usize, k: usize| match arguments.get(argument) {
            Some(a) => bound::in_box(&self.model, *a, k),
            None => (nominal[k], 0.0),
        };
        bound::bounds(graph, self.level, &input)
    }
}

/// Rust source with `#[doc = "…"]` in place of `///` at the beginning of a line. Both mean the
/// same, but rust-analyzer 1.95 leaves a slash in comments that a macro parses: hover texts began
/// with "/ ".
fn with_doc_attributes(source: &str) -> String {
    let mut out = String::with_capacity(source.len() + source.len() / 16);
    for line in source.split_inclusive('\n') {
        let text = line.trim_start();
        match text.strip_prefix("///").filter(|doc| !doc.starts_with('/')) {
            Some(doc) => {
                out += &line[..line.len() - text.len()];
                let _ = writeln!(out, "#[doc = {:?}]", doc.trim_end_matches(['\r', '\n']));
            }
            None => out += line,
        }
    }
    out
}

/// Generates the requested code. Pure: reads and writes no files.
///
/// # Errors All findings about the document and the robot-independent parts of the request, or else
/// all findings about the request.
pub fn generate(request: &Request) -> Result<Generated, Diagnostics> {
    let members = function_groups::members(&request.options.functions);
    let request = &*request.normalized();
    let mut log = Diagnostics::new(request.scene.as_ref().map_or(&request.file, |scene| &scene.file));
    let Some(Plan { robot, model, parameters, functions }) = plan::plan(request, &members, &mut log) else {
        return Err(log.result(()).err().unwrap_or_default());
    };
    let BuiltRobot { reading, effects, .. } = robot;
    let Reading { mut warnings, unused, snapped, .. } = reading;
    let can = request.options.target.capabilities(&request.options);
    let mut ledger = Ledger::default();
    let mut programs = Vec::new();
    for function in functions {
        let program = program::program(function, &model, &parameters, &request.options, can);
        ledger.functions.push(program.entry.clone());
        programs.push(program);
    }
    warnings.extend(programs.iter().filter_map(|program| long_code(&request.file, program)));
    let functions = programs.iter().map(|p| lir::function::Function::of(p, model.shape(), !parameters.is_empty(), can)).collect();
    let module = language::Module {
        request,
        effects: &effects,
        model: &model,
        functions,
        parameters: &parameters,
        unused: &unused,
        snapped: &snapped,
        warnings: &warnings,
    };
    let files = request.options.target.print(&module);
    let bodies = module.functions.into_iter().map(lir::function::Function::into_bodies).collect();
    let graphs = programs.into_iter().map(|p| p.with_loop.unwrap_or(p.graph)).collect();
    let source = files.last().map(|file| file.text.clone()).unwrap_or_default();
    Ok(Generated { source, files, model, parameters, level: request.options.level, ledger, graphs, bodies, warnings, unused, snapped })
}

/// Instructions beyond which straight-line code is of little use: compilation takes minutes, and
/// loops over joints are faster.
const LONG: u64 = 400_000;

/// The warning about such a function.
fn long_code(file: &str, program: &program::Program) -> Option<Diagnostic> {
    let (entry, graph) = (&program.entry, &program.graph);
    // The text of a loop is there once.
    let instructions = if graph.has_regions() { graph.written() } else { entry.emitted().instructions() };
    let found = format!("{instructions} instructions, for which a compiler takes minutes");
    let expected = "the library's function of the same name, a loop over the joints, for a robot like this";
    let warning = || Diagnostic::error(file, (Default::default(), &entry.function), Code::LongCode, found, expected).into_warning();
    (instructions > LONG).then(warning)
}

/// The function of the table, or the step, called `name`.
///
/// # Errors An unknown name; the error names the nearest function.
pub fn function(name: &str) -> Result<&'static Function<Sym>, Diagnostic> {
    articulated_core::algorithm::function(name).or_else(|| step::step(name)).ok_or_else(|| {
        if name == function_groups::MOTION {
            let sentence =
                format!("`{name}`: it stands for what the motion of a scene calls, by itself in a list: found no scene with [simulation]");
            return Diagnostic::refusal("", Place::DOCUMENT, Code::FunctionSpec, sentence);
        }
        // In a sum of functions, a group is not allowed.
        let groups = Group::ALL.into_iter().chain(Group::BESIDE).map(Group::name).chain([function_groups::ALL]);
        let groups = groups.filter(|_| function_groups::functions_of(name).is_none());
        let known: Vec<&str> = functions::<Sym>().iter().chain(step::beside_the_table()).map(|f| f.name).chain(groups).collect();
        let nearest = resolve_synonym(name, known.iter().copied());
        let rest = nearest.map_or_else(
            || format!("there are: {}; a function of your own is given to a build script, by Build::function", known.join(", ")),
            |nearest| format!("did you mean `{nearest}`?"),
        );
        Diagnostic::refusal("", Place::DOCUMENT, Code::UnknownFunction, format!("unknown function `{name}`, {rest}"))
    })
}

/// The name that an unknown name probably means: a synonym in other libraries, or the nearest.
pub fn resolve_synonym<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let plain: String = name.chars().filter(|c| *c != '_').collect();
    match ELSEWHERE.iter().find(|(theirs, _)| plain.eq_ignore_ascii_case(theirs)) {
        Some((_, ours)) => (!ours.is_empty()).then(|| (*ours).to_owned()),
        None => nearest(name, known),
    }
}

/// Synonyms of functions in other libraries and textbooks, in lower case without `_`, with our
/// names; `None` where we have no such function and the nearest name would mislead.
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

    #[test]
    fn comments_of_documentation_are_attributes_of_the_tokens() {
        let source = "/// τ = \"a\"\\b.\n///\n//// none\nmod m {\n    /// Its `x`.\n    pub const X: f64 = 1.0; // /// none\n}\n";
        let expected = "#[doc = \" τ = \\\"a\\\"\\\\b.\"]\n#[doc = \"\"]\n//// none\nmod m {\n    #[doc = \" Its `x`.\"]\n    pub const X: f64 = 1.0; // /// none\n}\n";
        assert_eq!(with_doc_attributes(source), expected);
    }
}
