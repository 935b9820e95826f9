//! Numbers of geoms and joints for the law of constraints.

use articulated_core::diagnostic::{Code, Diagnostics};

use super::simulation::Flags;
use super::values::Values;

/// MuJoCo's defaults of `solref` and `solimp`.
pub(crate) const REFERENCE: [f64; 2] = [0.02, 1.0];
pub(crate) const IMPEDANCE: [f64; 5] = [0.9, 0.95, 0.001, 0.5, 2.0];
/// Its defaults of friction: sliding, torsion, rolling.
pub(crate) const FRICTION: [f64; 3] = [1.0, 0.005, 0.0001];
/// Its default of `condim`.
pub(crate) const DIMENSION: i64 = 3;
/// Numbers of `solmix` below this one are zero.
const LEAST_MIX: f64 = 1e-15;

/// Numbers of a geom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surface {
    pub(crate) dimension: i64,
    priority: i64,
    friction: [f64; 3],
    mix: f64,
    reference: [f64; 2],
    impedance: [f64; 5],
    pub(crate) margin: f64,
    /// Whether it attracts, or its surface moves: that is not read.
    pub(crate) is_unread: bool,
}

/// What two geoms together have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Both {
    pub(crate) dimension: i64,
    pub(crate) friction: [f64; 3],
    pub(crate) reference: [f64; 2],
    pub(crate) impedance: [f64; 5],
}

/// 1, 3, 4 or 6; an error if it is another.
pub(crate) fn dimension(values: &Values<'_>, log: &mut Diagnostics) -> Option<i64> {
    let dimension = values.integer("condim", log)?;
    if ![1, 3, 4, 6].contains(&dimension) {
        values.error("condim", Code::Number, format!("{dimension}"), "1, 3, 4 or 6", log);
    }
    Some(dimension)
}

impl Surface {
    pub(crate) fn of(values: &Values<'_>, log: &mut Diagnostics) -> Self {
        Self {
            dimension: dimension(values, log).unwrap_or(DIMENSION),
            priority: values.integer("priority", log).unwrap_or(0),
            friction: values.at_most("friction", FRICTION, log),
            mix: values.number("solmix", log).unwrap_or(1.0),
            reference: values.at_most("solref", REFERENCE, log),
            impedance: values.at_most("solimp", IMPEDANCE, log),
            margin: values.number("margin", log).unwrap_or(0.0),
            is_unread: ["adhesion", "surfacevel"].iter().any(|name| values.has_numbers(name)),
        }
    }

    /// Those of the geom with the higher priority, or a mixture.
    pub(crate) fn with(&self, other: &Self) -> Both {
        let whole =
            |one: &Self| Both { dimension: one.dimension, friction: one.friction, reference: one.reference, impedance: one.impedance };
        match self.priority.cmp(&other.priority) {
            std::cmp::Ordering::Greater => return whole(self),
            std::cmp::Ordering::Less => return whole(other),
            std::cmp::Ordering::Equal => {}
        }
        let part = match (self.mix >= LEAST_MIX, other.mix >= LEAST_MIX) {
            (true, true) => self.mix / (self.mix + other.mix),
            (false, false) => 0.5,
            (false, true) => 0.0,
            (true, false) => 1.0,
        };
        let mixed = |a: f64, b: f64| part * a + (1.0 - part) * b;
        let [a, b] = [self.reference, other.reference];
        // Direct stiffness and damping are negative.
        let is_time = a[0] > 0.0 && b[0] > 0.0;
        Both {
            dimension: self.dimension.max(other.dimension),
            friction: std::array::from_fn(|k| self.friction[k].max(other.friction[k])),
            reference: std::array::from_fn(|k| if is_time { mixed(a[k], b[k]) } else { a[k].min(b[k]) }),
            impedance: std::array::from_fn(|k| mixed(self.impedance[k], other.impedance[k])),
        }
    }
}

/// Numbers of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SoftJoint {
    /// rad or m.
    pub(crate) margin: f64,
    pub(crate) limit: ([f64; 2], [f64; 5]),
    /// N·m or N.
    pub(crate) loss: f64,
    pub(crate) friction: ([f64; 2], [f64; 5]),
}

impl SoftJoint {
    pub(crate) fn of(values: &Values<'_>, flags: Flags, log: &mut Diagnostics) -> Self {
        let mut soft =
            |reference: &str, impedance: &str| (values.at_most(reference, REFERENCE, log), values.at_most(impedance, IMPEDANCE, log));
        let (limit, friction) = (soft("solreflimit", "solimplimit"), soft("solreffriction", "solimpfriction"));
        // The number itself is read with the other forces of the joint.
        let loss = values.number("frictionloss", &mut log.apart()).filter(|_| !flags.no_friction).unwrap_or(0.0);
        Self { margin: values.number("margin", log).unwrap_or(0.0), limit, loss, friction }
    }
}

impl Default for SoftJoint {
    fn default() -> Self {
        let soft = (REFERENCE, IMPEDANCE);
        Self { margin: 0.0, limit: soft, loss: 0.0, friction: soft }
    }
}
