//! How to compute a part of a function.

use std::borrow::Cow;

use articulated_core::algorithm::Way;
use articulated_core::model::Unturned;

use crate::sym::Sym;

/// How to compute a part.
#[derive(Clone, Copy)]
pub(crate) struct Choice {
    pub(crate) way: &'static Way<Sym>,
    /// How many model passes to take.
    pub(crate) passes: usize,
    /// Bodies whose frames do not turn.
    pub(crate) unturned: Option<Unturned>,
    /// The unit of length, m, if it is not the metre.
    pub(crate) unit: Option<f64>,
    /// Whether bodies have other inertias for inverse dynamics ([`Model::lent`]).
    pub(crate) lent: bool,
    /// Whether bodies have their rates by the axes of their joints ([`Model::with_rates_by_axes`]).
    pub(crate) axes: bool,
}

impl Choice {
    /// A way after so many model passes, with all frames turning and lengths in metres.
    pub(crate) fn plain(way: &'static Way<Sym>, passes: usize) -> Self {
        Self { way, passes, unturned: None, unit: None, lent: false, axes: false }
    }

    /// What a choice may add to a way and its model passes, as the ledger calls it, and what that does.
    pub(crate) const ADDED: [(&'static str, &'static str); 4] = [
        ("lent", "mass in the body beyond a joint for torques, where numbers vanish for it"),
        ("axes", "rates by the second derivatives of joints' axes, not by ω̇"),
        ("unturned", "constants turned in place of vectors"),
        ("unit", "lengths in a unit in which a constant is one"),
    ];

    /// Whether it has number `k` of these.
    pub(super) fn adds(&self, k: usize) -> bool {
        [self.lent, self.axes, self.unturned.is_some(), self.unit.is_some()][k]
    }

    /// The same with no more of these than the first `n`.
    pub(super) fn with_first(&self, n: usize) -> Self {
        let (unturned, unit) = (self.unturned.filter(|_| n > 2), self.unit.filter(|_| n > 3));
        Self { lent: self.lent && n > 0, axes: self.axes && n > 1, unturned, unit, ..*self }
    }

    /// What it is called in the ledger.
    pub(crate) fn names(&self) -> impl Iterator<Item = Cow<'static, str>> {
        let unturned = match self.unturned {
            None => "",
            Some(Unturned::Parallel) => "parallel joints unturned",
            Some(Unturned::ParallelAndLast) => "parallel and last joints unturned",
        };
        let unit = self.unit.map(|metres| Cow::Owned(format!("lengths in {} m", to_four_digits(metres))));
        let lent = if self.lent { "mass lent" } else { "" };
        let axes = if self.axes { "rates by axes" } else { "" };
        [self.way.name, lent, axes, unturned].into_iter().filter(|name| !name.is_empty()).map(Cow::Borrowed).chain(unit)
    }
}

fn to_four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
