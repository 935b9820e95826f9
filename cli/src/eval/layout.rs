//! What the numbers of a result belong to.

use articulated_core::algorithm::{Function, ResultKind};
use articulated_core::model::Model;
use serde_json::{Map, Value, json};

/// How a result is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// One number for each degree of freedom.
    Joints,
    /// Rotation and position of each frame.
    Frames,
    /// A row and a column for each degree of freedom.
    Square,
}

impl Layout {
    /// That of a function's result.
    pub(super) fn of(function: &Function<f64>) -> Self {
        match function.gives {
            ResultKind::Placements => Self::Frames,
            ResultKind::Torque | ResultKind::Acceleration => Self::Joints,
            ResultKind::MassMatrix => Self::Square,
        }
    }

    /// The result with its names.
    pub(super) fn json(self, out: &[f64], model: &Model<f64>) -> Value {
        match self {
            Self::Joints => by_joint(out, model),
            Self::Frames => by_frame(out, model),
            Self::Square => Value::Array(out.chunks(model.nv.max(1)).map(|row| by_joint(row, model)).collect()),
        }
    }
}

fn by_joint(out: &[f64], model: &Model<f64>) -> Value {
    let one = |(at, n): (usize, usize)| if n == 1 { json!(out[at]) } else { json!(out[at..at + n]) };
    Value::Object(model.joints.iter().map(|j| (j.name.clone(), one(j.v))).collect::<Map<_, _>>())
}

fn by_frame(out: &[f64], model: &Model<f64>) -> Value {
    let frame = |x: &[f64]| json!({"rotation": [x[0..3], x[3..6], x[6..9]], "position": x[9..12]});
    Value::Object(model.frames.iter().zip(out.chunks_exact(12)).map(|(f, x)| (f.name.clone(), frame(x))).collect::<Map<_, _>>())
}

/// The name of each degree of freedom: the joint's, with a number where it has several.
pub(super) fn freedom_names(model: &Model<f64>) -> Vec<String> {
    let names = |j: &articulated_core::model::JointInfo| match j.v.1 {
        1 => vec![j.name.clone()],
        n => (0..n).map(|k| format!("{}[{k}]", j.name)).collect(),
    };
    model.joints.iter().flat_map(names).collect()
}
