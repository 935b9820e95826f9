//! The module of one robot.

use std::fmt::Write;

use articulated_core::algorithm::{Function, Shape as Sizes};
use articulated_core::model::{JointInfo, Model};
use articulated_urdf::Unused;

use super::function::{BATCH_FROM, function};
use super::header::header;
use super::literal::literal;
use super::names::Names;
use super::order::{Step, order};
use super::shape::{Shape, length, shape};
use crate::graph::Graph;
use crate::{Ledger, Request, Sym};

/// The contents of the module.
pub(crate) fn module(
    request: &Request,
    model: &Model<f64>,
    names: &Names,
    programs: &[(&'static Function<Sym>, Graph)],
    ledger: &Ledger,
    unused: &[Unused],
) -> String {
    let mut out = String::new();
    header(&mut out, request, model, unused);
    constants(&mut out, model);
    indices(&mut out, model, names);
    for ((f, graph), entry) in programs.iter().zip(&ledger.functions) {
        function(&mut out, f, graph, entry, model.shape());
    }
    if programs.iter().any(|(_, g)| g.counts().fused() > 0) {
        out += FMA;
    }
    if programs.iter().any(|(_, g)| has_batch(g)) {
        sines(&mut out, request.options.forbid_unsafe);
    }
    robot(&mut out, request, model.shape(), programs);
    out
}

/// The module of sines and cosines.
fn sines(out: &mut String, forbid_unsafe: bool) {
    use articulated_core::trig::{PORTABLE_SOURCE, SOURCE};
    let (source, lint) = if forbid_unsafe { (PORTABLE_SOURCE, "") } else { (SOURCE, "unsafe_code, ") };
    let _ = writeln!(out, "#[allow({lint}dead_code, unreachable_pub, clippy::all, clippy::pedantic)]\nmod trig {{\n{source}}}\n");
}

fn has_batch(graph: &Graph) -> bool {
    order(graph).iter().any(|s| matches!(s, Step::Batch(angles) if angles.len() >= BATCH_FROM))
}

const FMA: &str = "\
/// a·b + c: one instruction, and one rounding, where the target has it.
#[inline(always)]
#[allow(clippy::all, clippy::pedantic)]
fn fma(a: f64, b: f64, c: f64) -> f64 {
    if ::core::cfg!(any(target_feature = \"fma\", target_arch = \"aarch64\")) { a.mul_add(b, c) } else { a * b + c }
}

";

fn constants(out: &mut String, model: &Model<f64>) {
    let joints: Vec<&str> = model.joints.iter().map(|j| j.name.as_str()).collect();
    let frames: Vec<&str> = model.frames.iter().map(|f| f.name.as_str()).collect();
    let _ = writeln!(out, "/// The robot's name.\npub const NAME: &str = {:?};", model.name);
    let _ = writeln!(out, "/// Number of coordinates: the length of q.\npub const NQ: usize = {};", model.nq);
    let _ = writeln!(out, "/// Number of degrees of freedom: the length of v, a and τ.\npub const NV: usize = {};", model.nv);
    let _ = writeln!(out, "/// Number of degrees of freedom.\npub const DOF: usize = NV;");
    let _ = writeln!(out, "/// Number of joints that are coordinates.\npub const JOINTS: usize = {};", joints.len());
    let _ = writeln!(out, "/// Number of links, each a frame.\npub const FRAMES: usize = {};", frames.len());
    let _ =
        writeln!(out, "/// Names of the joints, in the order of their coordinates.\npub const JOINT_NAMES: [&str; JOINTS] = {joints:?};");
    let _ = writeln!(out, "/// Names of the links, in the order of the file.\npub const FRAME_NAMES: [&str; FRAMES] = {frames:?};");
    limits(
        out,
        "Q_LOWER",
        "Lower bounds of the coordinates, rad or m; −∞ where there is none.",
        model,
        |j| j.limit.map(|l| l.lower),
        f64::NEG_INFINITY,
    );
    limits(
        out,
        "Q_UPPER",
        "Upper bounds of the coordinates, rad or m; ∞ where there is none.",
        model,
        |j| j.limit.map(|l| l.upper),
        f64::INFINITY,
    );
}

fn limits(out: &mut String, name: &str, doc: &str, model: &Model<f64>, limit: impl Fn(&JointInfo) -> Option<f64>, none: f64) {
    let values: Vec<String> = model.joints.iter().flat_map(|j| vec![literal(limit(j).unwrap_or(none)); j.q.1]).collect();
    let _ = writeln!(out, "/// {doc}\npub const {name}: [f64; NQ] = [{}];", values.join(", "));
}

fn indices(out: &mut String, model: &Model<f64>, names: &Names) {
    let joint = |value: fn(usize, &JointInfo) -> usize| {
        let rows = names.joints.iter().zip(&model.joints).enumerate();
        rows.map(|(k, (ident, j))| (ident.clone(), format!("{} joint {:?}", j.kind.name(), j.name), value(k, j))).collect::<Vec<_>>()
    };
    list(out, "joint", "Indices into [`JOINT_NAMES`].", &joint(|k, _| k));
    list(out, "q_index", "Index in q of each joint's first coordinate.", &joint(|_, j| j.q.0));
    list(out, "v_index", "Index in v, a and τ of each joint's first degree of freedom.", &joint(|_, j| j.v.0));
    let frames = names.frames.iter().zip(&model.frames).enumerate();
    let frames: Vec<_> = frames.map(|(k, (ident, f))| (ident.clone(), format!("link {:?}", f.name), k)).collect();
    list(out, "frame", "Indices into [`FRAME_NAMES`].", &frames);
}

fn list(out: &mut String, module: &str, doc: &str, rows: &[(String, String, usize)]) {
    let _ = writeln!(out, "/// {doc}\npub mod {module} {{");
    for (ident, doc, value) in rows {
        let _ = writeln!(out, "    /// The {doc}.\n    pub const {ident}: usize = {value};");
    }
    let _ = writeln!(out, "}}\n");
}

/// The type that stands for the robot where code is written over the trait `Dynamics`.
fn robot(out: &mut String, request: &Request, sizes: Sizes, programs: &[(&'static Function<Sym>, Graph)]) {
    let Some(path) = &request.options.runtime else { return };
    let _ = writeln!(
        out,
        "/// The robot as a value, for code over the trait `Dynamics`.\n#[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default)]\npub struct Robot;\n"
    );
    let _ = writeln!(out, "#[allow(clippy::all, clippy::pedantic)]\nimpl {path}::Dynamics<f64> for Robot {{");
    let _ = writeln!(out, "    type Workspace = ();\n    fn workspace(&self) {{}}");
    let _ = writeln!(out, "    fn shape(&self) -> {path}::Shape {{ {path}::Shape {{ nq: NQ, nv: NV, frames: FRAMES }} }}");
    let _ = writeln!(out, "    fn name(&self) -> &str {{ NAME }}");
    for (f, _) in programs {
        method(out, path, f, sizes);
    }
    let _ = writeln!(out, "}}");
}

fn method(out: &mut String, path: &str, f: &Function<Sym>, sizes: Sizes) {
    let Shape { slice: (element, slots), as_slice, .. } = shape(f.gives, sizes);
    let result = if f.name == "inverse_dynamics" { "tau" } else { "out" };
    let arguments: String = f.takes.iter().map(|a| format!(", {}: &[f64]", a.name())).collect();
    let _ = writeln!(
        out,
        "    fn {}(&self, _: &mut (){arguments}, {result}: &mut [{element}]) -> ::core::result::Result<(), {path}::FunctionError> {{",
        f.name
    );
    for a in f.takes {
        let _ = writeln!(out, "        let {0} = {path}::exactly::<{1}, f64>({0:?}, {0})?;", a.name(), length(*a));
    }
    let _ = writeln!(out, "        {path}::check_length({result:?}, {result}.len(), {slots})?;");
    let names: Vec<&str> = f.takes.iter().map(|a| a.name()).collect();
    let _ = writeln!(out, "        {result}.copy_from_slice(&self::{}({}){as_slice});", f.name, names.join(", "));
    let _ = writeln!(out, "        ::core::result::Result::Ok(())\n    }}");
}
