//! Strategies: how to compute a term of a function.

use std::borrow::Cow;

use articulated_core::algorithm::{Function, Variant};

use crate::model_pass::FoldedRotations;
use crate::sym::Sym;

/// How to compute a term of a function.
#[derive(Clone, Copy)]
pub(crate) struct Strategy {
    pub(crate) way: &'static Variant<Sym>,
    /// Number of model passes to apply.
    pub(crate) passes: usize,
    /// Bodies whose rotations are folded into constants.
    pub(crate) folded: Option<FoldedRotations>,
    /// The unit of length, m, if it is not the metre.
    pub(crate) unit: Option<f64>,
    /// Whether inverse dynamics uses shifted masses
    /// ([`View::with_shifted_masses`](crate::model_pass::View::with_shifted_masses)).
    pub(crate) shifted: bool,
    /// Whether angular kinematics uses the accelerations of joint axes
    /// ([`View::with_axis_accelerations`](crate::model_pass::View::with_axis_accelerations)).
    pub(crate) axes: bool,
}

impl Strategy {
    /// A way after this number of model passes, without further transforms.
    pub(crate) fn plain(way: &'static Variant<Sym>, passes: usize) -> Self {
        Self { way, passes, folded: None, unit: None, shifted: false, axes: false }
    }

    /// The strategy for a term that serves another function: its way of this name, or else its
    /// first. A part before a loop is no way of the table, and serves no other.
    pub(crate) fn for_function(&self, function: &'static Function<Sym>) -> Self {
        let serves = self.way.name != "columns in a loop";
        let named = function.ways.iter().find(|way| way.name == self.way.name);
        let way = if serves { named.unwrap_or(&function.ways[0]) } else { self.way };
        Self { way, ..*self }
    }

    /// Whether the strategy includes the transform.
    pub(super) fn adds(&self, what: Transform) -> bool {
        match what {
            Transform::ShiftedMasses => self.shifted,
            Transform::AxisAccelerations => self.axes,
            Transform::FoldedRotations => self.folded.is_some(),
            Transform::Unit => self.unit.is_some(),
        }
    }

    /// The same strategy without the transforms after `last`.
    pub(super) fn up_to(&self, last: Transform) -> Self {
        let has = |what| what <= last && self.adds(what);
        let (folded, unit) = (self.folded.filter(|_| has(Transform::FoldedRotations)), self.unit.filter(|_| has(Transform::Unit)));
        Self { shifted: has(Transform::ShiftedMasses), axes: has(Transform::AxisAccelerations), folded, unit, ..*self }
    }

    /// Its names in the ledger.
    pub(crate) fn names(&self) -> impl Iterator<Item = Cow<'static, str>> {
        let folded = match self.folded {
            None => "",
            Some(FoldedRotations::Parallel) => "parallel rotations folded",
            Some(FoldedRotations::ParallelAndLast) => "parallel and last rotations folded",
        };
        let unit = self.unit.map(|metres| Cow::Owned(format!("length unit {} m", to_four_digits(metres))));
        let shifted = if self.shifted { "mass shifted" } else { "" };
        let axes = if self.axes { "axis rates" } else { "" };
        [self.way.name, shifted, axes, folded].into_iter().filter(|name| !name.is_empty()).map(Cow::Borrowed).chain(unit)
    }
}

/// A transform beyond the model passes, in the order in which the ledger counts it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Transform {
    ShiftedMasses,
    AxisAccelerations,
    FoldedRotations,
    Unit,
}

impl Transform {
    /// All of them with their names in the ledger and their descriptions.
    pub(crate) const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::ShiftedMasses, "shift_masses", "mass moved to the body beyond a joint, so that numbers vanish"),
        (Self::AxisAccelerations, "axis_rates", "angular kinematics by the second derivatives of joint axes, not by ω̇"),
        (Self::FoldedRotations, "fold_rotations", "constants rotated in place of vectors"),
        (Self::Unit, "unit", "lengths in a unit in which a constant is one"),
    ];
}

fn to_four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
