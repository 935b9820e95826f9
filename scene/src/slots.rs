//! The numbers in a row of a table over time: those of a robot's joints, or of its actuators.

use std::collections::HashMap;

use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
use articulated_core::model::{JointInfo, Model};
use articulated_formats::world::Actuator;

use crate::initial::{neutral, normalise};

/// Coordinates or rates.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Side {
    Q,
    V,
}

/// The numbers of a row, by name.
pub(crate) struct Slots<'a> {
    /// Names, each with its first number and the count of its numbers.
    names: Vec<(&'a str, (usize, usize))>,
    by_name: HashMap<&'a str, (usize, usize)>,
    /// A row that no column changes.
    pub(crate) neutral: Vec<f64>,
    /// The robot, where some numbers may be quaternions.
    quaternions: Option<&'a Model<f64>>,
    /// Kind of the names, for messages.
    kind: &'static str,
    expected: &'static str,
}

impl<'a> Slots<'a> {
    /// A row has the coordinates or the rates of a robot.
    pub(crate) fn of_joints(model: &'a Model<f64>, side: Side) -> Self {
        let range = |joint: &JointInfo| if side == Side::Q { joint.q } else { joint.v };
        let names = model.joints().iter().map(|joint| (joint.name.as_str(), range(joint))).collect();
        let neutral = if side == Side::Q { neutral(model) } else { vec![0.0; model.nv()] };
        let quaternions = Some(model).filter(|_| side == Side::Q);
        let expected = "a joint that moves, as elbow, or one of its numbers, as ball[0]";
        Self { by_name: HashMap::new(), names, neutral, quaternions, kind: "joints", expected }.indexed()
    }

    /// A row has the controls of actuators.
    pub(crate) fn of_actuators(actuators: &'a [Actuator]) -> Self {
        let names = actuators.iter().enumerate().map(|(k, actuator)| (actuator.name.as_str(), (k, 1))).collect();
        let neutral = vec![0.0; actuators.len()];
        Self { by_name: HashMap::new(), names, neutral, quaternions: None, kind: "actuators", expected: "an actuator of the robot's file" }
            .indexed()
    }

    /// Of names that are there twice the first counts.
    fn indexed(mut self) -> Self {
        for (name, range) in &self.names {
            self.by_name.entry(name).or_insert(*range);
        }
        self
    }

    /// Kind of the names.
    pub(crate) fn kind(&self) -> &'static str {
        self.kind
    }

    /// The place of `name` or `name[k]`.
    pub(crate) fn place(&self, name: &str, (at, key): (At, &str), log: &mut Diagnostics) -> Option<usize> {
        if let Some((first, 1)) = self.by_name.get(name).copied() {
            return Some(first);
        }
        let indexed = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
        if let Some((whole, k)) = indexed
            && let (Some((first, count)), Ok(k)) = (self.by_name.get(whole).copied(), k.parse::<usize>())
            && k < count
        {
            return Some(first + k);
        }
        let found = format!("the column {}", quote(name));
        log.unknown(((at, key), Code::UnknownName), (found, name), self.expected, self.names.iter().map(|(name, _)| *name));
        None
    }

    /// Normalises the quaternions of a row; `place`: where the numbers of a joint are given.
    pub(crate) fn normalise(&self, row: &mut [f64], key: (&str, &dyn Fn(&str) -> At), log: &mut Diagnostics) {
        if let Some(model) = self.quaternions {
            normalise(model, row, key, log);
        }
    }

    /// The columns that there may be.
    pub(crate) fn listed(&self) -> String {
        let name = |(name, (_, count)): &(&str, (usize, usize))| match count {
            1 => (*name).to_owned(),
            n => format!("{name}[0] to {name}[{}]", n - 1),
        };
        let moving = if self.kind == "joints" { " that move" } else { "" };
        format!("{}{moving} after t: {}", self.kind, articulated_core::listed(self.names.iter().map(name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_list_of_columns_is_cut() {
        let link = |i: usize| {
            let kind = if i == 0 { "spherical" } else { "continuous" };
            format!("<link name='l{i}'/><joint name='j{i}' type='{kind}'><parent link='base'/><child link='l{i}'/></joint>")
        };
        let urdf = format!("<robot name='r'><link name='base'/>{}</robot>", (0..14).map(link).collect::<String>());
        let description = articulated_formats::read(urdf.as_bytes(), &Default::default()).unwrap().description;
        let model = Model::new(&description, articulated_core::description::Base::Fixed).unwrap();
        let listed = |side| Slots::of_joints(&model, side).listed();
        assert_eq!(listed(Side::Q), "joints that move after t: j0[0] to j0[3], j1, j2, j3, j4, j5, j6, j7, j8, j9, j10, j11 and 2 more");
        assert!(listed(Side::V).starts_with("joints that move after t: j0[0] to j0[2], j1"));
    }
}
