//! The robot in the header: sizes, names, limits, and indices of joints and frames.

use std::collections::BTreeMap;
use std::fmt::Write;

use articulated_core::algorithm::neutral;
use articulated_core::description::Limit;
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics};
use articulated_core::model::{JointInfo, Model};

use crate::Request;
use crate::language::Module;
use crate::lir::function::Function;

/// A name in upper case: letters and digits of ASCII stay, everything else is `_`.
fn upper(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).collect()
}

/// The same with all other characters as code points, for names that [`upper`] makes equal.
fn by_code_points(name: &str) -> String {
    let one = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase().to_string() } else { format!("U{:X}_", u32::from(c)) };
    name.chars().map(one).collect()
}

/// Distinct names for all: as renamed, else in upper case, else by code points.
fn distinct<'a>(names: impl Iterator<Item = &'a str> + Clone, request: &Request) -> Vec<String> {
    let renamed: BTreeMap<&str, &str> = request.options.rename.iter().map(|pair| (pair.0.as_str(), pair.1.as_str())).collect();
    let plain = |name: &str| renamed.get(name).map_or_else(|| upper(name), |to| upper(to));
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    names.clone().for_each(|name| *count.entry(plain(name)).or_default() += 1);
    let one = |name: &str| if count[&plain(name)] > 1 && !renamed.contains_key(name) { by_code_points(name) } else { plain(name) };
    names.map(one).collect()
}

/// Reports renames of unknown names, and equal new names of two joints or two links.
pub(in crate::language) fn check_names(model: &Model<f64>, request: &Request, log: &mut Diagnostics) {
    let groups = [("joint", joints(model)), ("link", frames(model))];
    let mut error = |code, found: String, expected: &str| {
        log.push(Diagnostic::error(&request.file, (Default::default(), "rename"), code, found, expected));
    };
    for pair in &request.options.rename {
        if !groups.iter().any(|(_, names)| names.contains(&pair.0.as_str())) {
            error(Code::Rename, format!("{:?}", pair.0), "the name of a joint or of a link");
        }
    }
    for (kind, names) in groups {
        let mut seen = BTreeMap::new();
        for (name, own) in names.iter().zip(distinct(names.iter().copied(), request)) {
            if let Some(first) = seen.insert(own.clone(), *name) {
                error(Code::NameClash, format!("{own} for the {kind}s {first:?} and {name:?}"), "another name for one of them");
            }
        }
    }
}

fn joints(model: &Model<f64>) -> Vec<&str> {
    model.joints().iter().map(|j| j.name.as_str()).collect()
}

fn frames(model: &Model<f64>) -> Vec<&str> {
    model.frames().iter().map(|f| f.name.as_str()).collect()
}

/// What the enumerations and the tables are called, behind the prefix.
pub(super) const NAMES: [&str; 9] = ["joint", "q_index", "v_index", "frame", "neutral", "q_lower", "q_upper", "v_limit", "tau_limit"];

/// A table of the header: its name, its length, what it says, and its numbers.
struct Table {
    name: &'static str,
    length: &'static str,
    says: &'static str,
    values: Vec<f64>,
}

fn tables(model: &Model<f64>) -> Vec<Table> {
    type Count = fn(&JointInfo) -> usize;
    // One for each coordinate of the joint, in q or in v.
    let each = |count: Count, of: fn(&Limit) -> f64, none: f64| -> Vec<f64> {
        model.joints().iter().flat_map(|j| vec![j.limit.as_ref().map_or(none, of); count(j)]).collect()
    };
    let mut rest = vec![0.0; model.nq()];
    neutral(model, &mut rest);
    let table = |name, length, says, values| Table { name, length, says, values };
    let (q, v): (Count, Count) = (|j| j.q.1, |j| j.v.1);
    vec![
        table("neutral", "NQ", "The neutral configuration: zeros, and quaternions of the identity", rest),
        table("q_lower", "NQ", "Lower bounds of the coordinates, rad or m", each(q, |l| l.lower, f64::NEG_INFINITY)),
        table("q_upper", "NQ", "Upper bounds of the coordinates, rad or m", each(q, |l| l.upper, f64::INFINITY)),
        table("v_limit", "NV", "Largest rates, rad/s or m/s", each(v, |l| l.velocity, f64::INFINITY)),
        table("tau_limit", "NV", "Largest torques and forces, N*m or N", each(v, |l| l.effort, f64::INFINITY)),
    ]
}

/// Writes the macros, the enumerations and the tables: declared, or with their numbers.
pub(super) fn declare(out: &mut String, module: &Module, prefix: &str, infinity: &str, with_numbers: bool) {
    let (model, up) = (module.model, upper(prefix));
    for (name, what, n) in [
        ("NQ", "Number of coordinates: the length of q.", model.nq()),
        ("NV", "Number of degrees of freedom: the length of v, a and tau.", model.nv()),
        ("JOINTS", "Number of joints that are coordinates.", model.joints().len()),
        ("FRAMES", "Number of frames.", model.frames().len()),
        ("LINKS", "Number of moving links.", model.links().count()),
    ] {
        let _ = writeln!(out, "/** {what} */\n#define {up}_{name} {n}");
    }
    let has_actuators = module.functions.iter().any(Function::is_of_actuators);
    if has_actuators {
        let (controls, activations) = (model.actuators().laws.len(), model.actuators().activations());
        let _ = writeln!(out, "/** Number of actuators: the length of ctrl. */\n#define {up}_NU {controls}");
        let _ = writeln!(out, "/** Number of actuators with an activation: the length of act. */\n#define {up}_NA {activations}");
    }
    if module.functions.iter().any(Function::is_of_contacts) {
        let _ = writeln!(out, "/** Number of places where shapes may touch. */\n#define {up}_CONTACTS {}", model.shape().contacts);
    }
    if module.functions.iter().any(Function::is_of_given) {
        let _ = writeln!(out, "/** Number of contacts that a caller gives. */\n#define {up}_GIVEN {}", model.shape().given);
    }
    if !module.parameters.is_empty() {
        let n: usize = module.parameters.iter().map(|p| p.nominal.len()).sum();
        let _ = writeln!(out, "/** Number of parameters. */\n#define {up}_PARAMETERS {n}");
    }
    out.push('\n');
    let names = distinct(joints(model).into_iter(), module.request);
    let of = |value: fn(usize, &JointInfo) -> usize| {
        let rows = names.iter().zip(model.joints()).enumerate();
        rows.map(|(k, (own, j))| (own.clone(), value(k, j), format!("the {} joint {}", j.kind.name(), quoted(&j.name)))).collect::<Vec<_>>()
    };
    enumeration(out, prefix, "joint", "Indices of the joints", &of(|k, _| k));
    enumeration(out, prefix, "q_index", "Index in q of the first coordinate of each joint", &of(|_, j| j.q.0));
    enumeration(out, prefix, "v_index", "Index in v, a and tau of the first rate of each joint", &of(|_, j| j.v.0));
    let links = distinct(frames(model).into_iter(), module.request);
    let rows = links.into_iter().zip(frames(model)).enumerate().map(|(k, (own, f))| (own, k, format!("the link {}", quoted(f))));
    enumeration(out, prefix, "frame", "Indices of the frames", &rows.collect::<Vec<_>>());
    for Table { name, length, says, values } in tables(model).iter().filter(|table| !table.values.is_empty()) {
        let unbounded = if values.iter().any(|x| x.is_infinite()) { "; infinite where there is none" } else { "" };
        let _ = writeln!(out, "/** {says}{unbounded}. */");
        let _ = if with_numbers {
            writeln!(out, "static const double {prefix}_{name}[{up}_{length}] = {};\n", numbers(values, infinity))
        } else {
            writeln!(out, "extern const double {prefix}_{name}[{up}_{length}];")
        };
    }
    out.push('\n');
}

/// Writes the numbers of the tables.
pub(super) fn define(out: &mut String, module: &Module, prefix: &str, infinity: &str) {
    let up = upper(prefix);
    for Table { name, length, values, .. } in tables(module.model).iter().filter(|table| !table.values.is_empty()) {
        let _ = writeln!(out, "const double {prefix}_{name}[{up}_{length}] = {};\n", numbers(values, infinity));
    }
}

/// The numbers of a table in braces.
fn numbers(values: &[f64], infinity: &str) -> String {
    let literal = |x: &f64| match *x {
        f64::INFINITY => infinity.to_owned(),
        f64::NEG_INFINITY => format!("-{infinity}"),
        x => format!("{x:?}"),
    };
    let rows: Vec<String> = values.chunks(6).map(|row| row.iter().map(literal).collect::<Vec<_>>().join(", ")).collect();
    format!("{{\n    {}\n}}", rows.join(",\n    "))
}

fn enumeration(out: &mut String, prefix: &str, name: &str, says: &str, rows: &[(String, usize, String)]) {
    if rows.is_empty() {
        return;
    }
    let start = format!("{}_{}", upper(prefix), upper(name));
    let _ = writeln!(out, "/** {says}. */\nenum {prefix}_{name} {{");
    for (k, (own, value, what)) in rows.iter().enumerate() {
        let comma = if k + 1 < rows.len() { "," } else { "" };
        let _ = writeln!(out, "    /** {what} */\n    {start}_{own} = {value}{comma}");
    }
    let _ = writeln!(out, "}};\n");
}

/// A name of the file in a comment.
fn quoted(name: &str) -> String {
    format!("\"{}\"", name.escape_debug().to_string().replace("*/", "* /").replace("/*", "/ *").replace('\\', "|"))
}
