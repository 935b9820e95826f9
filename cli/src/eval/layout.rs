//! Names of the numbers of a result.

use articulated_core::algorithm::{Dim, Function};
use articulated_core::model::{JointInfo, Model};
use serde::{Serialize, Serializer};

/// The names along one dimension.
struct Names {
    /// (name, number of its indices); without names, indices are numbers.
    parts: Option<Vec<(String, usize)>>,
    length: usize,
}

impl Names {
    fn of(dim: Dim, model: &Model<f64>) -> Self {
        let joints = |count: fn(&JointInfo) -> usize| model.joints().iter().map(|j| (j.name.clone(), count(j))).collect();
        let parts = match dim {
            Dim::Nq => Some(joints(|j| j.q.1)),
            Dim::Nv => Some(joints(|j| j.v.1)),
            Dim::Frames => Some(model.frames().iter().map(|f| (f.name.clone(), 1)).collect()),
            // A moving link has the name of its joint.
            Dim::Links => Some(model.links().map(|i| (model.bodies()[i].name.clone(), 1)).collect()),
            Dim::Controls => Some(model.actuators().laws.iter().map(|law| (law.name.clone(), 1)).collect()),
            Dim::Activations => {
                let own = model.actuators().laws.iter().filter(|law| law.activation.is_some());
                Some(own.map(|law| (law.name.clone(), 1)).collect())
            }
            Dim::Contacts | Dim::Given | Dim::Of(_) => None,
        };
        Self { parts, length: dim.len(model.shape()) }
    }

    /// One for each index.
    fn each(&self) -> Vec<String> {
        let part = |(name, n): &(String, usize)| match n {
            1 => vec![name.clone()],
            n => (0..*n).map(|k| format!("{name}[{k}]")).collect(),
        };
        self.parts.as_ref().map_or_else(|| (0..self.length).map(|k| format!("[{k}]")).collect(), |p| p.iter().flat_map(part).collect())
    }
}

/// A result with its names: objects by joint or link, a list if a joint has several numbers or a
/// dimension has no names.
pub(super) fn labelled(function: &Function<f64>, out: &[f64], model: &Model<f64>) -> Labelled {
    let names: Vec<Names> = function.gives.iter().map(|d| Names::of(*d, model)).collect();
    nested(&names, out)
}

/// Numbers with their names, as JSON.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Labelled {
    Number(f64),
    List(Vec<Labelled>),
    /// In the order of the model.
    Object(Vec<(String, Labelled)>),
}

impl Serialize for Labelled {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(x) => x.serialize(to),
            Self::List(all) => all.serialize(to),
            Self::Object(entries) => to.collect_map(entries.iter().map(|(name, value)| (name, value))),
        }
    }
}

fn nested(names: &[Names], out: &[f64]) -> Labelled {
    let [first, rest @ ..] = names else { return Labelled::Number(out.first().copied().unwrap_or(f64::NAN)) };
    let width = rest.iter().map(|n| n.length).product::<usize>();
    let at = |k: usize| nested(rest, &out[k * width..][..width]);
    let Some(parts) = &first.parts else { return Labelled::List((0..first.length).map(at).collect()) };
    let mut object = Vec::new();
    let mut next = 0;
    for (name, count) in parts {
        let value = if *count == 1 { at(next) } else { Labelled::List((next..next + count).map(at).collect()) };
        object.push((name.clone(), value));
        next += count;
    }
    Labelled::Object(object)
}

/// A result as a table: names of the rows, all dimensions but the last put together, and of the
/// columns.
pub(super) struct Grid {
    pub(super) rows: Vec<String>,
    pub(super) columns: Vec<String>,
}

/// Rotation row by row, then position.
const PLACEMENT: [&str; 12] = ["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33", "x", "y", "z"];

impl Grid {
    /// The layout of a function's result; one column without a name for at most one dimension.
    pub(super) fn of(function: &Function<f64>, model: &Model<f64>) -> Self {
        let each = |d: &Dim| Names::of(*d, model).each();
        let (rows, columns) = match function.gives {
            [] => return Self { rows: vec![function.name.to_owned()], columns: vec![String::new()] },
            [one] => return Self { rows: each(one), columns: vec![String::new()] },
            [rows @ .., Dim::Of(12)] => (rows, PLACEMENT.map(str::to_owned).to_vec()),
            [rows @ .., last] => (rows, each(last)),
        };
        let joined = |rows: Vec<String>, d: &Dim| {
            rows.iter().flat_map(|r| each(d).into_iter().map(move |n| format!("{r} {n}").trim_start().to_owned())).collect()
        };
        Self { rows: rows.iter().fold(vec![String::new()], joined), columns }
    }
}
