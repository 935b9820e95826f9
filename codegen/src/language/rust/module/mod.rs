//! The module of one robot.

pub(crate) mod bare;
pub(crate) mod header;
pub(crate) mod names;
pub(crate) mod sets;
pub(crate) mod style;
pub(crate) mod warnings;

use std::fmt::Write;

use articulated_core::actuator::Actuators;
use articulated_core::algorithm::{Dim, neutral};
use articulated_core::constraint::Constraints;
use articulated_core::description::Limit;
use articulated_core::model::{FLOATING_BASE, JointInfo, Model};

use crate::Parameter;
use crate::language::Module;
use crate::language::rust::RustOptions;
use crate::language::rust::batch::{Batch, batches};
use crate::language::rust::function::precision::real;
use crate::language::rust::function::{Context, IMPLEMENTATION, Text, function};
use crate::language::rust::literal::literal;
use crate::language::rust::module::header::header;
use crate::language::rust::module::names::Names;
use crate::language::rust::module::sets::support;
use crate::language::rust::spills;
use crate::lir::function::Function;

/// The contents of the module.
pub(crate) fn module(module: &Module, rust: &RustOptions) -> String {
    let Module { request, model, functions, parameters, warnings, .. } = module;
    let mut text = Text::default();
    header(&mut text.public, module, rust);
    constants(&mut text.public, model);
    let has_actuators = functions.iter().any(Function::is_of_actuators);
    if has_actuators {
        of_actuators(&mut text.public, model.actuators());
    }
    if functions.iter().any(Function::is_of_contacts) {
        of_contacts(&mut text.public, model.constraints());
    }
    if functions.iter().any(Function::is_of_given) {
        of_given(&mut text.public, model.constraints());
    }
    indices(&mut text.public, model, &Names::of(model, request));
    inputs(&mut text.public, parameters);
    let (forbid_unsafe, level) = (rust.forbid_unsafe, request.options.level);
    let context = Context { parameters: !parameters.is_empty(), forbid_unsafe, level };
    functions.iter().for_each(|f| function(&mut text, f, context));
    support(&mut text.implementation, functions, (forbid_unsafe, rust.no_std), level);
    let of_many: Vec<Batch> = functions.iter().filter_map(|f| Batch::of(f, level)).collect();
    batches(&mut text.implementation, &of_many, &request.options.batch, rust);
    if functions.iter().any(spills::is_used) {
        text.implementation += spills::MODULE;
    }
    if rust.no_std {
        text.implementation += &bare::float();
    }
    let Text { public: mut out, implementation } = text;
    for real in &request.options.batch {
        let _ = writeln!(out, "pub use self::{IMPLEMENTATION}::batch_{};\n", real.name());
    }
    if let Some(path) = &rust.runtime {
        robot(&mut out, (path, real(level)), model, functions, !parameters.is_empty());
        out.push('\n');
    }
    out += &warnings::warnings(warnings);
    out.push('\n');
    let mut more = if has_actuators { ", NA, NU".to_owned() } else { String::new() };
    if functions.iter().any(Function::is_of_contacts) {
        more += ", CONTACTS";
    }
    if functions.iter().any(Function::is_of_given) {
        more += ", GIVEN";
    }
    if !parameters.is_empty() {
        more += ", PARAMETERS";
    }
    let lint = if forbid_unsafe { "" } else { "unsafe_code, unused_unsafe, " };
    let _ = write!(
        out,
        "/// Bodies of the functions, and what they call.\n#[doc(hidden)]\n#[cfg_attr(rustfmt, rustfmt_skip)]\n\
         #[allow({lint}dead_code, non_snake_case, unreachable_pub, unused_imports, unused_results, clippy::all, clippy::pedantic)]\n\
         mod {IMPLEMENTATION} {{\nuse super::{{FRAMES, LINKS, NQ, NV{more}}};\n\n{}\n}}\n",
        implementation.trim_end()
    );
    out
}

/// Attribute of constants with numbers of the file, which are kept as they are: also 3.14, and
/// 6.283185307179586.
const NUMBERS: &str = "#[allow(clippy::all, clippy::pedantic)]";

fn constants(out: &mut String, model: &Model<f64>) {
    let joints: Vec<&str> = model.joints().iter().map(|j| j.name.as_str()).collect();
    let frames: Vec<&str> = model.frames().iter().map(|f| f.name.as_str()).collect();
    let _ = writeln!(out, "/// The robot's name.\npub const NAME: &str = {:?};", model.name());
    let floats = model.joints().first().is_some_and(|joint| joint.name == FLOATING_BASE);
    let of_base = |text: &'static str| if floats { text } else { "" };
    let q = of_base(" First the base's position, m, and quaternion x, y, z, w.");
    let v = of_base(" First the base's six: angular, then linear, in its own axes; of τ moment, then force.");
    let _ = writeln!(out, "/// Number of coordinates: the length of q.{q}\npub const NQ: usize = {};", model.nq());
    let _ = writeln!(out, "/// Number of degrees of freedom: the length of v, a and τ.{v}\npub const NV: usize = {};", model.nv());
    let _ = writeln!(out, "/// Number of degrees of freedom.\npub const DOF: usize = NV;");
    let _ = writeln!(out, "/// Number of joints that are coordinates.\npub const JOINTS: usize = {};", joints.len());
    let links: Vec<&str> = model.links().map(|i| model.bodies()[i].name.as_str()).collect();
    let _ = writeln!(out, "/// Number of frames: links of the file, or those chosen.\npub const FRAMES: usize = {};", frames.len());
    let _ = writeln!(out, "/// Number of moving links, one for each joint that moves.\npub const LINKS: usize = {};", links.len());
    for (doc, name, length, names) in [
        ("Names of the joints, in the order of their coordinates.", "JOINT_NAMES", "JOINTS", joints),
        ("Names of the frames.", "FRAME_NAMES", "FRAMES", frames),
        ("For each moving link, the joint that carries it.", "LINK_JOINTS", "LINKS", links),
    ] {
        constant(out, doc, &format!("pub const {name}: [&str; {length}] = {names:?};"));
    }
    // One for each coordinate of the joint, in q or in v.
    let each = |count: fn(&JointInfo) -> usize, of: fn(&Limit) -> f64, none: f64| -> Vec<f64> {
        model.joints().iter().flat_map(|j| vec![j.limit.as_ref().map_or(none, of); count(j)]).collect()
    };
    let mut rest = vec![0.0; model.nq()];
    neutral(model, &mut rest);
    let rows = [
        ("NEUTRAL", "NQ", "The neutral configuration: coordinates are zero, quaternions are the identity.", rest),
        (
            "Q_LOWER",
            "NQ",
            "Lower bounds of the coordinates, rad or m; −∞ where there is none.",
            each(|j| j.q.1, |l| l.lower, f64::NEG_INFINITY),
        ),
        ("Q_UPPER", "NQ", "Upper bounds of the coordinates, rad or m; ∞ where there is none.", each(|j| j.q.1, |l| l.upper, f64::INFINITY)),
        ("V_LIMIT", "NV", "Largest rates, rad/s or m/s; ∞ where none is given.", each(|j| j.v.1, |l| l.velocity, f64::INFINITY)),
        ("TAU_LIMIT", "NV", "Largest torques and forces, N·m or N; ∞ where none is given.", each(|j| j.v.1, |l| l.effort, f64::INFINITY)),
    ];
    for (name, length, doc, values) in rows {
        let values: Vec<String> = values.into_iter().map(literal).collect();
        constant(out, doc, &format!("{NUMBERS}\npub const {name}: [f64; {length}] = [{}];", values.join(", ")));
    }
}

/// The sizes of controls and activations, and the names and bounds of controls.
fn of_actuators(out: &mut String, actuators: &Actuators) {
    let laws = &actuators.laws;
    let names: Vec<&str> = laws.iter().map(|law| law.name.as_str()).collect();
    let _ = writeln!(out, "/// Number of actuators: the length of ctrl.\npub const NU: usize = {};", laws.len());
    let _ =
        writeln!(out, "/// Number of actuators with an activation: the length of act.\npub const NA: usize = {};", actuators.activations());
    constant(out, "Names of the actuators, in the order of ctrl.", &format!("pub const ACTUATOR_NAMES: [&str; NU] = {names:?};"));
    for (name, side, none, doc) in [
        ("CTRL_LOWER", 0, f64::NEG_INFINITY, "Lower bounds of the controls; −∞ where there is none."),
        ("CTRL_UPPER", 1, f64::INFINITY, "Upper bounds of the controls; ∞ where there is none."),
    ] {
        let values: Vec<String> = laws.iter().map(|law| literal(law.control_range.map_or(none, |range| range[side]))).collect();
        constant(out, doc, &format!("{NUMBERS}\npub const {name}: [f64; NU] = [{}];", values.join(", ")));
    }
}

/// The number of places of contact, and their shapes.
fn of_contacts(out: &mut String, constraints: &Constraints) {
    let _ = writeln!(out, "/// Number of places where shapes may touch.\npub const CONTACTS: usize = {};", constraints.contacts());
    shapes_of(
        out,
        constraints,
        constraints.pair_of_contacts(),
        "Names of the two shapes of each such place.",
        "CONTACT_SHAPES: [[&str; 2]; CONTACTS]",
    );
}

/// The number of contacts that a caller gives, and their shapes.
fn of_given(out: &mut String, constraints: &Constraints) {
    let count = constraints.pair_of_given().count();
    let _ = writeln!(out, "/// Number of contacts that a caller gives.\npub const GIVEN: usize = {count};");
    let doc = "Names of the two shapes of each of them.";
    shapes_of(out, constraints, constraints.pair_of_given(), doc, "GIVEN_SHAPES: [[&str; 2]; GIVEN]");
}

fn shapes_of(out: &mut String, constraints: &Constraints, pairs: impl Iterator<Item = usize>, doc: &str, name: &str) {
    let shapes = |pair: usize| constraints.pairs[pair].shapes.map(|shape| constraints.shapes[shape].name.as_str());
    let names: Vec<[&str; 2]> = pairs.map(shapes).collect();
    constant(out, doc, &format!("pub const {name} = {names:?};"));
}

/// A constant, which stays one line however long it is.
fn constant(out: &mut String, doc: &str, line: &str) {
    let is_long = line.lines().any(|line| line.chars().count() > 80);
    let _ = writeln!(out, "/// {doc}\n{}{line}", if is_long { "#[cfg_attr(rustfmt, rustfmt_skip)]\n" } else { "" });
}

fn indices(out: &mut String, model: &Model<f64>, names: &Names) {
    let joint = |value: fn(usize, &JointInfo) -> usize| {
        let rows = names.joints.iter().zip(model.joints()).enumerate();
        rows.map(|(k, (ident, j))| (ident.clone(), format!("{} joint {:?}", j.kind.name(), j.name), value(k, j))).collect::<Vec<_>>()
    };
    list(out, "joint", "Indices into [`JOINT_NAMES`].", &joint(|k, _| k));
    list(out, "q_index", "Index in q of each joint's first coordinate.", &joint(|_, j| j.q.0));
    list(out, "v_index", "Index in v, a and τ of each joint's first degree of freedom.", &joint(|_, j| j.v.0));
    let frames = names.frames.iter().zip(model.frames()).enumerate();
    let frames: Vec<_> = frames.map(|(k, (ident, f))| (ident.clone(), format!("link {:?}", f.name), k)).collect();
    list(out, "frame", "Indices into [`FRAME_NAMES`].", &frames);
}

fn list(out: &mut String, module: &str, doc: &str, rows: &[(String, String, usize)]) {
    if rows.is_empty() {
        let _ = writeln!(out, "/// {doc}\npub mod {module} {{}}\n");
        return;
    }
    let _ = writeln!(out, "/// {doc}\npub mod {module} {{");
    for (ident, doc, value) in rows {
        let _ = writeln!(out, "    /// The {doc}.\n    {}pub const {ident}: usize = {value};", style::of_constant(ident));
    }
    let _ = writeln!(out, "}}\n");
}

/// The constants of the model that stayed inputs.
fn inputs(out: &mut String, parameters: &[Parameter]) {
    if parameters.is_empty() {
        return;
    }
    let values: Vec<String> = parameters.iter().flat_map(|p| &p.nominal).map(|x| literal(*x)).collect();
    let _ = writeln!(out, "/// Nominal values of the parameters; [`parameter`] has the index at which each begins.");
    if parameters.iter().any(Parameter::is_inertial) {
        let _ = writeln!(
            out,
            "///\n/// Inertial parameters: m, m·c and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz, about the origin and in axes of the link; kg, kg·m, kg·m²."
        );
    }
    let _ = writeln!(
        out,
        "#[cfg_attr(rustfmt, rustfmt_skip)]\n{NUMBERS}\npub const PARAMETERS: [f64; {}] = [{}];",
        values.len(),
        values.join(", ")
    );
    let names = names::identifiers(parameters.iter().map(|p| p.name.as_str()));
    let rows: Vec<_> = names.into_iter().zip(parameters).map(|(name, p)| (name, p.what.clone(), p.at)).collect();
    list(out, "parameter", "Index in [`PARAMETERS`] of the first number of each.", &rows);
}

/// The type that represents the robot for code generic over the trait `Dynamics`.
fn robot(out: &mut String, (path, real): (&str, &str), model: &Model<f64>, functions: &[Function], parameters: bool) {
    let default = if parameters { "" } else { ", ::core::default::Default" };
    let _ = writeln!(out, "/// The robot as a value, for code over the trait `Dynamics`.");
    let _ = writeln!(out, "#[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug{default})]");
    if parameters {
        let _ = writeln!(out, "pub struct Robot {{\n    /// As [`PARAMETERS`].\n    pub parameters: [f64; PARAMETERS.len()],\n}}\n");
        let _ = writeln!(out, "impl ::core::default::Default for Robot {{");
        let _ =
            writeln!(out, "    fn default() -> Self {{\n        Self {{\n            parameters: PARAMETERS,\n        }}\n    }}\n}}\n");
    } else {
        let _ = writeln!(out, "pub struct Robot;\n");
    }
    let _ = writeln!(
        out,
        "#[cfg_attr(rustfmt, rustfmt_skip)]\n#[allow(unused_qualifications, clippy::all, clippy::pedantic)]\nimpl {path}::Dynamics<{real}> for Robot {{"
    );
    let _ = writeln!(out, "    type Workspace = ();\n    fn workspace(&self) {{}}");
    let _ = writeln!(
        out,
        "    fn shape(&self) -> {path}::Shape {{ {path}::Shape {{ nq: NQ, nv: NV, frames: FRAMES, links: LINKS, ..::core::default::Default::default() }} }}"
    );
    let _ = writeln!(out, "    fn name(&self) -> &str {{ NAME }}");
    names_by_number(out, path, model);
    if model.has_motors() {
        let _ = writeln!(out, "    fn has_motors(&self) -> bool {{ true }}");
    }
    let _ = writeln!(out, "    #[inline]");
    let _ = writeln!(
        out,
        "    fn call(&self, function: {path}::FunctionId, _: &mut (), arguments: &[&[{real}]], out: &mut [{real}]) -> ::core::result::Result<(), {path}::FunctionError> {{"
    );
    let _ = writeln!(out, "        match (function, arguments) {{");
    for function in functions.iter().filter_map(|f| f.spec.as_function()) {
        let takes: Vec<_> = function.takes.iter().map(|a| (a.name(), a.dims())).collect();
        let is_empty = function.len(model.shape()) == 0;
        arm(out, (path, real), function.name, &takes, (function.gives, is_empty), parameters);
    }
    let has: Vec<String> =
        functions.iter().filter_map(|f| f.spec.as_function()).map(|f| format!("{path}::FunctionId::{}", f.name)).collect();
    let _ = writeln!(
        out,
        "            _ => ::core::result::Result::Err({path}::FunctionError::of_call(function, arguments.len(), &[{}])),",
        has.join(", ")
    );
    let _ = writeln!(out, "        }}\n    }}\n}}");
}

/// The joints and frames by their numbers.
fn names_by_number(out: &mut String, path: &str, model: &Model<f64>) {
    let option = "::core::option::Option";
    let _ = writeln!(out, "    fn frame_name(&self, frame: usize) -> {option}<&str> {{ FRAME_NAMES.get(frame).copied() }}");
    let _ = writeln!(out, "    fn joint(&self, index: usize) -> {option}<{path}::JointRow<'_>> {{");
    if model.joints().is_empty() {
        let _ = writeln!(out, "        let _ = index;\n        {option}::None\n    }}");
        return;
    }
    let _ = writeln!(out, "        let (kind, q, v) = match index {{");
    for (k, joint) in model.joints().iter().enumerate() {
        let _ = writeln!(out, "            {k} => ({path}::JointKind::{:?}, {:?}, {:?}),", joint.kind, joint.q, joint.v);
    }
    let _ = writeln!(out, "            _ => return {option}::None,\n        }};");
    let limit = "lower: Q_LOWER[q.0], upper: Q_UPPER[q.0], effort: TAU_LIMIT[v.0], velocity: V_LIMIT[v.0]";
    let _ = writeln!(out, "        let limit = {path}::Limit {{ {limit}, ..{path}::Limit::NONE }};");
    let _ = writeln!(out, "        {option}::Some({path}::JointRow {{ name: JOINT_NAMES[index], kind, q, v, limit }})\n    }}");
}

/// The call of one function through slices. For a robot without degrees of freedom, numbers and
/// rows may be empty.
fn arm(
    out: &mut String,
    (path, real): (&str, &str),
    name: &str,
    takes: &[(&str, &[Dim])],
    (gives, is_empty): (&[Dim], bool),
    parameters: bool,
) {
    let mut names: Vec<String> = takes.iter().map(|(name, _)| (*name).to_owned()).collect();
    let _ = writeln!(out, "            ({path}::FunctionId::{name}, &[{}]) => {{", names.join(", "));
    for (name, dims) in takes {
        let _ = match dims {
            [length, Dim::Of(width)] => {
                writeln!(out, "                let {name} = {path}::exactly_rows::<{length}, {width}, {real}>({name:?}, {name})?;")
            }
            [length, ..] => writeln!(out, "                let {name} = {path}::exactly::<{length}, {real}>({name:?}, {name})?;"),
            [] => Ok(()),
        };
    }
    let lengths: Vec<String> = gives.iter().map(Dim::to_string).collect();
    let length = if lengths.is_empty() { "1".to_owned() } else { lengths.join(" * ") };
    let _ = writeln!(out, "                {path}::check_length(\"out\", out.len(), {length})?;");
    if parameters {
        names.push("&self.parameters".into());
    }
    let names = names.join(", ");
    let _ = if is_empty {
        writeln!(out, "                let _ = ({names},);")
    } else if gives.is_empty() {
        writeln!(out, "                out[0] = self::{name}({names});")
    } else {
        let inner = gives.iter().skip(1).rev().map(|d| format!(".as_chunks_mut::<{d}>().0"));
        let rows = format!("out{}", inner.collect::<String>());
        let _ = writeln!(out, "                if let ::core::result::Result::Ok(out) = ::core::convert::TryInto::try_into({rows}) {{");
        writeln!(out, "                    self::{name}_into({names}, out);\n                }}")
    };
    let _ = writeln!(out, "                ::core::result::Result::Ok(())\n            }}");
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base;

    use crate::{Options, Real, Request, generate};

    /// Names of helpers, of modules and of their types, each as a function or as the type of
    /// several results.
    const FUNCTIONS: &str = "add mul fma trig k lanes lane sin_cos store put body whole fused spill at gather scatter implementation \
                             piece_0 columns derivatives four joint frame half robot links float few drop clone";
    const TYPES: &str = "f fma multiply_add v m t n lanes group kept shelf far line float block option vec result string";

    fn source(robot: &str, change: &dyn Fn(&mut Options)) -> String {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf");
        let mut request = Request::new(robot, std::fs::read(format!("{folder}/{robot}.urdf")).unwrap());
        request.options.robot.base = if robot == "ur5_like" { Base::Fixed } else { Base::Floating };
        let functions = FUNCTIONS.split_whitespace().map(|name| format!("{name} = inverse_dynamics(v = 0)"));
        let types = TYPES.split_whitespace().map(|name| format!("{name}_ = gravity_torque + kinetic_energy"));
        let more = ["forward_dynamics", "integrate", "forward_dynamics_derivatives", "odd__name = mass_matrix"].map(str::to_owned);
        request.options.functions = functions.chain(types).chain(more).map(Into::into).collect();
        change(&mut request.options);
        generate(&request).unwrap_or_else(|error| panic!("{error}")).source
    }

    /// As in a crate that has other things under the names of the prelude, with the lints that
    /// rustc has.
    #[test]
    fn no_name_of_a_user_is_taken_and_no_lint_is_broken() {
        let folder = std::env::temp_dir().join(format!("articulated-kept-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let (file, out) = (folder.join("robot.rs"), folder.join("robot.rmeta"));
        let level = |name: &'static str| move |o: &mut Options| o.level = name.parse().unwrap();
        let of_many = |forbid_unsafe: bool| {
            move |o: &mut Options| {
                o.batch = vec![Real::F64, Real::F32];
                o.rust_mut().forbid_unsafe = forbid_unsafe;
            }
        };
        let sources = [
            source("quadruped", &|_| {}),
            source("quadruped", &of_many(false)),
            source("ur5_like", &of_many(true)),
            source("ur5_like", &level("f32")),
            source("ur5_like", &level("compensated + two")),
            source("ur5_like", &level("f64 + correct")),
            source("ur5_like", &level("double_double")),
        ];
        for text in sources {
            let text = format!(
                "#![no_implicit_prelude]\n#![deny(warnings, unused_results, trivial_numeric_casts, unused_qualifications)]\n{text}"
            );
            std::fs::write(&file, text).unwrap();
            let mut rustc = std::process::Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
            rustc.args(["--crate-type=lib", "--edition=2024", "--emit=metadata", "-o"]).args([&out, &file]);
            let done = rustc.output().unwrap();
            assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr).chars().take(4000).collect::<String>());
        }
        std::fs::remove_dir_all(folder).unwrap();
    }

    /// Users may format the files that they keep.
    #[test]
    fn rustfmt_leaves_generated_code_as_it_is() {
        let rustfmt = || std::process::Command::new("rustfmt");
        if !rustfmt().arg("--version").output().is_ok_and(|done| done.status.success()) {
            println!("not run: rustfmt is not installed (rustup component add rustfmt)");
            return;
        }
        let folder = std::env::temp_dir().join(format!("articulated-format-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("robot.rs");
        let inputs = |o: &mut Options| {
            (o.parameters, o.batch) = (vec!["gravity".into()], vec![Real::F64]);
            o.rust_mut().runtime = Some("::articulated".into());
        };
        for text in [source("quadruped", &|_| {}), source("ur5_like", &inputs)] {
            std::fs::write(&file, text).unwrap();
            let done = rustfmt().args(["--check", "--edition=2024"]).arg(&file).output().unwrap();
            assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout).chars().take(4000).collect::<String>());
        }
        std::fs::remove_dir_all(folder).unwrap();
    }
}
