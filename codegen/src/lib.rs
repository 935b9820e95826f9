//! From a URDF to straight-line Rust.
//!
//! ```text
//! urdf → model → (model passes) → trace → graph → (graph passes) → ledger → emit → source
//! ```
//!
//! [`generate`] is that list. The macro, the build-script interface ([`Build`]) and the command line all fill a [`Request`] and get the
//! same source. There is no physics here: the algorithms are those of `articulated-core`, run on symbols.

mod build;
mod emit;
mod error;
pub mod graph;
pub mod ledger;
pub mod pass;
mod request;
mod sym;
mod trace;

use articulated_core::algorithm::{Function, functions};
use articulated_core::model::Model;
use articulated_core::model::pass::MODEL_PASSES;
use articulated_urdf::{Problem, Reading, Unused};

pub use articulated_core as core;
pub use articulated_urdf as urdf;
pub use build::Build;
pub use emit::identifier;
pub use error::{Error, nearest};
pub use ledger::Ledger;
pub use request::{Options, Request};
pub use sym::Sym;

/// What was generated, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The contents of a module: Rust, formatted, with comments. The same request always gives the same bytes.
    pub source: String,
    /// The model as it was read, before model passes.
    pub model: Model<f64>,
    /// Costs.
    pub ledger: Ledger,
    /// Things in the document that are odd but used as written.
    pub warnings: Vec<Problem>,
    /// Content that is understood but not used.
    pub unused: Vec<Unused>,
    /// Angles taken as multiples of π/2 because the request asked for it.
    pub snapped: Vec<Problem>,
}

impl Generated {
    /// The source as tokens.
    pub fn tokens(&self) -> proc_macro2::TokenStream {
        self.source.parse().expect("the emitter writes Rust")
    }
}

/// Generates the code that `request` asks for. Pure: nothing is read or written.
pub fn generate(request: &Request) -> Result<Generated, Error> {
    let options = &request.options;
    let Reading { description, warnings, unused, snapped } = articulated_urdf::read(&request.urdf, &reader_options(request))?;
    let model = Model::new(&description, options.base).map_err(|error| Error::Model { file: request.file.clone(), error })?;
    let model = model.with_gravity(options.gravity);
    let wanted = wanted(request, &model)?;
    let names = emit::Names::new(&model, request)?;
    let mut models = vec![("trace", model.clone())];
    for (name, pass, _) in MODEL_PASSES {
        models.push((name, pass(models[models.len() - 1].1.clone())));
    }
    let mut ledger = Ledger::default();
    let mut programs = Vec::new();
    for function in wanted {
        let (program, entry) = program(function, &models);
        programs.push((function, program));
        ledger.functions.push(entry);
    }
    let source = emit::module(request, &model, &names, &programs, &ledger, &unused) + &emit::warnings(&warnings);
    Ok(Generated { source, model, ledger, warnings, unused, snapped })
}

/// One function, traced on the model as it was read and after each model pass, and taken through the graph passes.
fn program(function: &'static Function<Sym>, models: &[(&'static str, Model<f64>)]) -> (graph::Graph, ledger::Entry) {
    let mut graph = graph::Graph::default();
    let mut stages = Vec::new();
    for (name, model) in models {
        graph = trace::trace(function, model);
        if stages.is_empty() {
            stages.push(("asked", graph.asked().clone()));
        }
        stages.push((*name, graph.counts()));
    }
    for (name, pass, _) in pass::GRAPH_PASSES {
        graph = pass::run(name, *pass, &graph);
        stages.push((name, graph.counts()));
    }
    let depth = ledger::depth(&graph);
    (graph, ledger::Entry { function: function.name.into(), stages, depth })
}

fn reader_options(request: &Request) -> articulated_urdf::Options {
    articulated_urdf::Options {
        file: request.file.clone(),
        base: request.options.base,
        allow_unphysical_inertia: request.options.allow_unphysical_inertia,
        snap_angles: request.options.snap_angles,
    }
}

/// The functions that the request names, each once.
fn wanted(request: &Request, model: &Model<f64>) -> Result<Vec<&'static Function<Sym>>, Error> {
    let massless = model.massless_joints();
    let mut wanted: Vec<&Function<Sym>> = Vec::new();
    for name in &request.options.functions {
        let function = function(name)?;
        if function.inverts_mass_matrix() && !massless.is_empty() {
            let joints = massless.iter().map(|&i| model.bodies[i].name.clone()).collect();
            return Err(Error::Singular { file: request.file.clone(), function: name.clone(), joints });
        }
        if !wanted.iter().any(|f| f.name == function.name) {
            wanted.push(function);
        }
    }
    Ok(wanted)
}

/// The function called `name`, or the error that names the nearest.
pub fn function(name: &str) -> Result<&'static Function<Sym>, Error> {
    articulated_core::algorithm::function(name).ok_or_else(|| {
        let known: Vec<String> = functions::<Sym>().iter().map(|f| f.name.to_owned()).collect();
        Error::UnknownFunction { found: name.into(), nearest: nearest(name, known.iter().map(String::as_str)), known }
    })
}
